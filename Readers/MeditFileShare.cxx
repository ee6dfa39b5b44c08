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

/// The sections of a file up to End; Dimension comes first, and none twice.
std::vector<SharedSection> findSections(
  const FileRanges& ranges, const std::string& name, bool solution)
{
  const std::vector<Index> starts = ranges.lineStarts(
    name, [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; });
  std::vector<SharedSection> sections = ranges.agreed(
    [&]
    {
      std::vector<SharedSection> found;
      for (std::size_t i = 0; i + 1 < starts.size(); ++i)
      {
        found.push_back(
          readSectionHead(firstLines(name, starts[i], starts[i + 1]), i == 0, solution));
        found.back().begin += starts[i];
        found.back().end = starts[i + 1];
        const FileContent next = firstLines(name, starts[i + 1], fileSize(name));
        if (TextCursor(next, Comment).word() == "End")
        {
          return found;
        }
      }
      throw FileError(name + ": no keyword End");
    });
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

/// Calls read(cursor, count) for a rank's records of a section.
template <class Read>
void shareRecords(
  const FileRanges& ranges, const std::string& name, const SharedSection& section, const Read& read)
{
  const LineShare lines = ranges.lines(name, section.begin, section.end, Comment, section.count);
  ranges.together(
    [&]
    {
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

/// Sends numbers of points or cells to the ranks that have these.
/// @param rankAndPlace the rank of a number, and which of its points or cells it is
template <class RankAndPlace>
std::vector<Index> sendNumbers(
  RankGroup& group, const std::vector<Index>& numbers, const RankAndPlace& rankAndPlace)
{
  std::vector<std::vector<Index>> sent(static_cast<std::size_t>(group.size()));
  for (const Index number : numbers)
  {
    const auto [rank, place] = rankAndPlace(number);
    sent[static_cast<std::size_t>(rank)].push_back(place);
  }
  std::vector<Index> own;
  for (const std::vector<Index>& some : group.exchangeItems(sent))
  {
    own.insert(own.end(), some.begin(), some.end());
  }
  return own;
}

/// Which ranks have the cells: numbers begin at 0 for each section.
using SectionBegins = std::map<unsigned char, std::vector<Index>>;

/// The numbers of the lists become those that a rank's cells and points have in its share.
void shareLists(const FileRanges& ranges, const std::vector<Index>& pointBegins,
  const SectionBegins& cellBegins, Contents& contents)
{
  RankGroup& group = ranges.group();
  for (auto& [name, numbers] : contents.lists)
  {
    const bool points = name == "Corners" || name == "RequiredVertices";
    const std::vector<Index>& begins =
      points ? pointBegins : cellBegins.at(name == "RequiredTriangles" ? FileTriangle : FileLine);
    ranges.require(std::all_of(
      numbers.begin(), numbers.end(), [&](Index number) { return number < begins.back(); }));
    numbers = sendNumbers(group, numbers,
      [&](Index number)
      {
        const int rank = rankOf(begins, number);
        return std::pair(rank, number - begins[static_cast<std::size_t>(rank)]);
      });
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
      shareRecords(ranges, name, section, [](TextCursor&, Index) {});
      continue;
    }
    const std::vector<Index>& begins = points ? pointBegins : cellBegins.at(cells->type);
    ranges.require(section.count == begins.back());
    SolutionArrays read, result;
    const auto arrays = [&](std::size_t tuples)
    { return solutionArrays(head, section.fields, arrayTitle(points), tuples); };
    shareRecords(ranges, name, section,
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
    const RankRows rows = realignedRows(group, rankBegins(group, count), begins);
    std::vector<MeshArray>& to = points ? pointArrays : cellArrays;
    continueArrays(result, to);
    const std::size_t first = points
      ? 0
      : static_cast<std::size_t>(
          std::find(mesh.cellTypes.begin(), mesh.cellTypes.end(), cells->type) -
          mesh.cellTypes.begin());
    for (std::size_t i = 0; i < read.arrays.size(); ++i)
    {
      const MeshArray values = sendTuples(group, read.arrays[i], rows);
      std::visit(
        [&](const auto& from)
        {
          using Values = std::decay_t<decltype(from)>;
          auto& all = std::get<Values>(result.arrays[i].values);
          std::copy(from.begin(), from.end(),
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
  ranges.expectLarge({ meshName });
  const bool solution = ranges.exists(solutionName);
  ranges.require(solution || extension != "sol");
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
    keepHighestDimension(group, share);
  }
  std::vector<MeshArray>& arrays = share.mesh.cellArrays;
  for (auto array = arrays.begin(); array != arrays.end();)
  {
    array = group.any(!isUnused(*array)) ? array + 1 : arrays.erase(array);
  }
  return share;
}
}
