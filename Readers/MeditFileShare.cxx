// SPDX-License-Identifier: BSD-3-Clause
#include "MeditFile.h"

#include "FileNames.h"
#include "FileRanges.h"
#include "FileSet.h"
#include "MeditRecords.h"
#include "PartExchange.h"

#include <algorithm>

namespace tautline
{
using namespace medit;

namespace
{
/// A section of a file as the ranks find it: its keyword, what comes before its records, and where
/// these are.
struct SharedSection
{
  std::string name;
  Index count = 0; ///< of records
  std::vector<Field> fields;
  int dimension = 0; ///< of the section Dimension
  bool known = true;
  Index begin = 0, end = 0;
};

constexpr Index SectionHeadBytes = 4096;

/// Whether a line begins with the keyword of a section, rather than with a value that is no number.
bool beginsSection(std::string_view line)
{
  if (!std::isalpha(static_cast<unsigned char>(line[0])))
  {
    return false;
  }
  std::string word;
  for (const char c : line.substr(0, line.find_first_of(" \t\r#")))
  {
    word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return word != "inf" && word != "infinity" && word.substr(0, word.find('(')) != "nan";
}

/// Reads what comes before the records of a section, which is `first` in its file or not.
SharedSection readSectionHead(const FileContent& text, bool first, bool solution)
{
  TextCursor cursor(text, Comment);
  SharedSection section;
  if (first)
  {
    readHeader(cursor);
  }
  else
  {
    section.name = std::string(cursor.word());
    const bool field = section.name == "SolAtVertices" || findSolution(section.name);
    const bool records =
      section.name == "Vertices" || findCells(section.name) || isList(section.name);
    if (section.name == "Dimension")
    {
      section.dimension = static_cast<int>(nextInteger(cursor, "dimension", 2, 3));
    }
    else if (solution ? field : records)
    {
      section.count = nextInteger(cursor, "number of records", 0, Largest);
    }
    else
    {
      section.known = false;
    }
    if (solution && field)
    {
      section.fields = readFields(cursor);
    }
  }
  section.begin = cursor.place() - text.begin();
  if (section.known)
  {
    cursor.expectLineEnd();
  }
  return section;
}

/// All that a rank knows of a section.
std::string describe(const SharedSection& section)
{
  std::string text = section.name;
  for (const Index number :
    { section.count, Index(section.dimension), Index(section.known), section.begin, section.end })
  {
    text += " " + std::to_string(number);
  }
  for (const Field& field : section.fields)
  {
    text += " " + std::to_string(field.type);
  }
  return text + "\n";
}

/// The sections of a file up to End; Dimension comes first, and none twice.
std::vector<SharedSection> findSections(
  const FileRanges& ranges, const std::string& name, bool solution)
{
  const std::vector<Index> starts = ranges.lineStarts(name, beginsSection);
  std::string all;
  std::vector<SharedSection> sections = ranges.agreed(
    [&]
    {
      std::vector<SharedSection> found;
      const Index size = fileSize(name);
      for (std::size_t i = 0; i < starts.size(); ++i)
      {
        const Index end = i + 1 < starts.size() ? starts[i + 1] : size;
        const FileContent text = firstLines(name, starts[i], end, SectionHeadBytes);
        if (i > 0 && TextCursor(text, Comment).word() == "End")
        {
          return found;
        }
        SharedSection section = readSectionHead(text, i == 0, solution);
        section.begin += starts[i];
        section.end = end;
        all += describe(section);
        found.push_back(std::move(section));
      }
      throw FileError(name + ": no keyword End");
    });
  ranges.expectSame(all);
  int dimensions = 0;
  bool inOrder = true;
  for (const SharedSection& section : sections)
  {
    dimensions += section.dimension > 0;
    inOrder = inOrder && (dimensions == 1 || section.name.empty());
    const auto same = [&](const SharedSection& other)
    { return section.known && other.name == section.name; };
    inOrder = inOrder && std::count_if(sections.begin(), sections.end(), same) <= 1;
  }
  ranges.require(inOrder && dimensions == 1);
  return sections;
}

/// Sections that are skipped end at the next keyword, in whatever line.
void skipShared(const FileRanges& ranges, const std::string& name, const SharedSection& section)
{
  const LineShare lines = ranges.lines(name, section.begin, section.end, Comment);
  ranges.together(
    [&]
    {
      TextCursor cursor(lines.text, Comment);
      skipSection(cursor);
      if (!cursor.atEnd())
      {
        cursor.fail("a keyword inside of a line");
      }
    });
}

/// Calls read(cursor, count) for a rank's records of a section, of at least so many columns.
template <class Read>
void shareRecords(const FileRanges& ranges, const std::string& name, const SharedSection& section,
  Index columns, const Read& read)
{
  const LineShare lines = ranges.lines(name, section.begin, section.end, Comment, section.count);
  ranges.together(
    [&]
    {
      expectColumns(name, lines, columns);
      TextCursor cursor(lines.text, Comment);
      read(cursor, lines.count);
      cursor.expectFileEnd("record");
    });
}

/// A list may have several numbers in a line.
void shareList(const FileRanges& ranges, const std::string& name, const SharedSection& section,
  std::vector<Index>& ids)
{
  const LineShare lines = ranges.lines(name, section.begin, section.end, Comment);
  ranges.together(
    [&]
    {
      TextCursor cursor(lines.text, Comment);
      while (cursor.skipToToken())
      {
        ids.push_back(readListRecord(cursor, section.name));
        cursor.countRecord();
      }
    });
  ranges.require(ranges.group().sum(static_cast<Index>(ids.size())) == section.count);
}

/// Sends numbers of points or cells to the ranks that have these, and returns the own ones, counted
/// from the first own point or cell.
std::vector<Index> sendNumbers(
  const FileRanges& ranges, const std::vector<Index>& begins, const std::vector<Index>& numbers)
{
  std::vector<std::vector<Index>> sent(begins.size() - 1);
  ranges.together(
    [&]
    {
      for (const Index number : numbers)
      {
        const auto rank = static_cast<std::size_t>(rankOf(begins, number));
        sent[rank].push_back(number - begins[rank]);
      }
    });
  sent = sendLists(ranges, sent);
  return ranges.agreed(
    [&]
    {
      std::vector<Index> own;
      for (const std::vector<Index>& some : sent)
      {
        own.insert(own.end(), some.begin(), some.end());
      }
      return own;
    });
}

/// Which ranks have the cells: numbers begin at 0 for each section.
using SectionBegins = std::map<unsigned char, std::vector<Index>>;

/// The numbers of the lists become those that a rank's cells and points have in its share.
void shareLists(const FileRanges& ranges, const std::vector<Index>& pointBegins,
  const SectionBegins& cellBegins, Contents& contents)
{
  for (auto& [name, numbers] : contents.lists)
  {
    const bool points = name == "Corners" || name == "RequiredVertices";
    const std::vector<Index>& begins =
      points ? pointBegins : cellBegins.at(name == "RequiredTriangles" ? FileTriangle : FileLine);
    ranges.require(std::all_of(
      numbers.begin(), numbers.end(), [&](Index number) { return number < begins.back(); }));
    numbers = sendNumbers(ranges, begins, numbers);
  }
}

/// The fields of a .sol file, for the own points and cells.
void shareSolution(const FileRanges& ranges, const std::string& name,
  const std::vector<Index>& pointBegins, const SectionBegins& cellBegins, MeshFile& mesh)
{
  const FileContent head = ranges.head(name);
  int dimension = 0;
  std::vector<MeshArray> pointArrays, cellArrays;
  RankGroup& group = ranges.group();
  for (const SharedSection& section : findSections(ranges, name, true))
  {
    dimension = std::max(dimension, section.dimension);
    if (!section.known)
    {
      skipShared(ranges, name, section);
      continue;
    }
    const bool points = section.name == "SolAtVertices";
    const MeditSection* cells = findSolution(section.name);
    if (!points && !cells)
    {
      shareRecords(ranges, name, section, 1, [](TextCursor&, Index) {});
      continue;
    }
    const std::vector<Index>& begins = points ? pointBegins : cellBegins.at(cells->type);
    ranges.require(section.count == begins.back());
    SolutionArrays read, result;
    const auto arrays = [&](std::size_t tuples)
    { return solutionArrays(head, section.fields, arrayTitle(points), tuples); };
    Index columns = 0;
    for (const Field& field : section.fields)
    {
      columns += field.values(dimension);
    }
    shareRecords(ranges, name, section, columns,
      [&](TextCursor& cursor, Index count)
      {
        read = arrays(static_cast<std::size_t>(count));
        readSolutionRecords(cursor, section.fields, dimension, 0, count, read);
        result = arrays(points ? mesh.points.size() / 3 : mesh.cellTypes.size());
      });
    // from the ranks that have read them to those with the points or cells
    const Index count = read.arrays.empty()
      ? 0
      : static_cast<Index>(read.arrays[0].size()) / read.arrays[0].components;
    const std::vector<Index> from = rankBegins(group, count);
    const RankRows rows = ranges.agreed([&] { return realignedRows(group, from, begins); });
    std::vector<MeshArray>& to = points ? pointArrays : cellArrays;
    continueArrays(result, to);
    const std::size_t first = points
      ? 0
      : static_cast<std::size_t>(
          std::find(mesh.cellTypes.begin(), mesh.cellTypes.end(), cells->type) -
          mesh.cellTypes.begin());
    for (std::size_t i = 0; i < read.arrays.size(); ++i)
    {
      const MeshArray values = sendTuples(ranges, read.arrays[i], rows);
      std::visit(
        [&](const auto& some)
        {
          using Values = std::decay_t<decltype(some)>;
          auto& all = std::get<Values>(result.arrays[i].values);
          std::copy(some.begin(), some.end(),
            all.begin() + static_cast<std::ptrdiff_t>(first) * values.components);
        },
        values.values);
    }
    std::move(result.arrays.begin(), result.arrays.end(), std::back_inserter(to));
  }
  std::move(pointArrays.begin(), pointArrays.end(), std::back_inserter(mesh.pointArrays));
  std::move(cellArrays.begin(), cellArrays.end(), std::back_inserter(mesh.cellArrays));
}
}

//------------------------------------------------------------------------------
MeshShare shareMedit(const FileRanges& ranges, const std::string& name, bool lowerCells)
{
  const auto [stem, extension] = splitExtension(name);
  const std::string meshName = extension == "sol" ? stem + ".mesh" : name;
  const std::string solutionName = stem + ".sol";
  const bool solution = ranges.exists(solutionName);
  ranges.require(solution || extension != "sol");
  ranges.expectLarge(
    solution ? std::vector<std::string>{ meshName, solutionName } : std::vector{ meshName });
  SetCheck set;
  const FileContent tail = ranges.tail(meshName);
  ranges.together([&] { set.add(tail); });

  Contents contents;
  RankGroup& group = ranges.group();
  std::vector<Index> pointBegins;
  SectionBegins cellBegins;
  for (const SharedSection& section : findSections(ranges, meshName, false))
  {
    contents.dimension = std::max(contents.dimension, section.dimension);
    const MeditSection* cells = findCells(section.name);
    if (!section.known)
    {
      skipShared(ranges, meshName, section);
      continue;
    }
    if (isList(section.name))
    {
      shareList(ranges, meshName, section, contents.lists[section.name]);
      continue;
    }
    ranges.require(!cells || contents.points >= 0);
    shareRecords(ranges, meshName, section,
      1 + (cells ? cellNodes(cells->type) : contents.dimension),
      [&](TextCursor& cursor, Index count)
      {
        if (section.name == "Vertices")
        {
          contents.points = section.count;
          readVertexRecords(cursor, count, contents);
        }
        else if (cells)
        {
          readCellRecords(cursor, *cells, static_cast<std::size_t>(count), contents);
        }
      });
  }
  MeshShare share;
  Index cells = 0;
  for (const MeditSection& section : MeditSections)
  {
    const auto own = static_cast<Index>(contents.references[section.type].size());
    share.sectionCells.push_back(own);
    cellBegins[section.type] = rankBegins(group, own);
    cells += cellBegins[section.type].back();
  }
  ranges.require(contents.points > 0 && cells > 0);
  pointBegins = rankBegins(group, static_cast<Index>(contents.pointReferences.size()));
  shareLists(ranges, pointBegins, cellBegins, contents);
  share.mesh = ranges.agreed([&] { return assemble(TextCursor(tail), std::move(contents), true); });
  if (solution)
  {
    const FileContent solutionTail = ranges.tail(solutionName);
    ranges.together([&] { set.add(solutionTail); });
    shareSolution(ranges, solutionName, pointBegins, cellBegins, share.mesh);
  }
  if (!lowerCells)
  {
    keepHighestDimension(ranges, share);
  }
  std::vector<MeshArray>& arrays = share.mesh.cellArrays;
  for (auto array = arrays.begin(); array != arrays.end();)
  {
    array = group.any(!isUnused(*array)) ? array + 1 : arrays.erase(array);
  }
  return share;
}
}
