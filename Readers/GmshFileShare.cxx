// SPDX-License-Identifier: BSD-3-Clause
#include "FileRanges.h"
#include "GmshFile.h"
#include "MeshPart.h"
#include "PartExchange.h"
#include "SharedTags.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace tautline
{
namespace
{
constexpr char NoComment = '\0';
constexpr Index MostBetween = 4096; // bytes of blank lines between sections, and of keywords

/// A section: its name, and the bytes between the lines that begin and end it.
struct Section
{
  std::string name;
  Index begin, end, next; ///< `next`: behind the line that ends it
};

/// The keyword that is a line by itself, from its '$' on, and where the next line begins.
std::pair<std::string, Index> keywordLine(const std::string& name, Index start, Index size)
{
  const FileContent text = firstLines(name, start, size, MostBetween);
  TextCursor cursor(text);
  const std::string word(cursor.word());
  if (!cursor.lineIsOver() || (start > 0 && *FileContent(name, start - 1, start).begin() != '\n'))
  {
    cursor.fail("more than a keyword in a line");
  }
  return { word, std::min(size, start + (cursor.place() - text.begin()) + 1) };
}

void expectBlank(const std::string& name, Index begin, Index end)
{
  if (end - begin > MostBetween)
  {
    throw FileError(name + ": text between sections");
  }
  const FileContent text(name, begin, end);
  TextCursor(text).expectFileEnd("section");
}

/// All sections, $MeshFormat first.
std::vector<Section> findSections(const FileRanges& ranges, const std::string& name)
{
  const std::vector<Index> starts =
    ranges.lineStarts(name, [](std::string_view line) { return line[0] == '$'; });
  std::string found;
  std::vector<Section> sections = ranges.agreed(
    [&]
    {
      std::vector<Section> all;
      const Index size = fileSize(name);
      Index end = 0;
      for (std::size_t i = 0; i + 1 < starts.size(); i += 2)
      {
        const auto [word, begin] = keywordLine(name, starts[i], size);
        const auto [endWord, next] = keywordLine(name, starts[i + 1], size);
        expectBlank(name, end, starts[i]);
        if (word.size() < 2 || endWord != "$End" + word.substr(1) ||
          (i == 0) != (word == "$MeshFormat"))
        {
          throw FileError(name + ": sections in an unusual order");
        }
        all.push_back({ word.substr(1), begin, starts[i + 1], next });
        found += word + " " + std::to_string(begin) + " " + std::to_string(next) + " ";
        end = next;
      }
      if (starts.size() % 2 != 0 || starts.empty())
      {
        throw FileError(name + ": a section does not end");
      }
      expectBlank(name, end, size);
      return all;
    });
  ranges.expectSame(found);
  return sections;
}

/// A block of version 4 and the line that it begins at, of those after the header of its section.
struct SharedBlock
{
  GmshBlock4 block;
  Index line;
};

bool operator==(const GmshBlock4& a, const GmshBlock4& b)
{
  return a.dimension == b.dimension && a.entity == b.entity && a.kind == b.kind && a.size == b.size;
}

/// Reads the sections of a file on all ranks.
class SharedReader
{
public:
  SharedReader(const FileRanges& ranges, const std::string& name)
    : Ranges(ranges)
    , Name(name)
    , Budget(ranges.agreed([&] { return 1048576 + 64 * at(fileSize(name)); }))
    , Physical(4)
  {
  }

  MeshShare read()
  {
    const std::vector<Section> sections = findSections(this->Ranges, this->Name);
    const auto has = [&](const char* name)
    { return [name](const Section& section) { return section.name == name; }; };
    this->NeedsElementTags = std::any_of(sections.begin(), sections.end(), has("ElementData"));
    for (const char* name : { "MeshFormat", "Nodes", "Elements" })
    {
      this->Ranges.require(std::count_if(sections.begin(), sections.end(), has(name)) == 1);
    }
    for (const Section& section : sections)
    {
      this->readSection(section);
    }
    MeshFile& mesh = this->Share.mesh;
    const MeshArray* groups = findArray(mesh.fieldArrays, "PhysicalGroups");
    const auto* numbers = groups ? std::get_if<MeshArray::Integers>(&groups->values) : nullptr;
    for (std::size_t i = 0; numbers && i < numbers->size(); i += 2)
    {
      this->Ranges.require((*numbers)[i] != UnknownGmshDimension);
    }
    mesh.cellArrays.insert(mesh.cellArrays.begin(), { "Entity", 1, std::move(this->Entities) });
    mesh.cellArrays.insert(
      mesh.cellArrays.begin(), { "Reference", 1, std::move(this->References) });
    return std::move(this->Share);
  }

private:
  RankGroup& group() const { return this->Ranges.group(); }

  GmshInput input(const FileContent& text) const
  {
    return { TextCursor(text), false, {}, {}, {}, {}, {}, this->Budget, this->Version, 0, {},
      true };
  }

  void readSection(const Section& section)
  {
    if (section.name == "MeshFormat" || section.name == "PhysicalNames" ||
      (section.name == "Entities" && this->Version >= 4.0))
    {
      this->readByAll(section);
    }
    else if (section.name == "Nodes")
    {
      this->Version >= 4.0 ? this->readNodes4(section) : this->readNodes2(section);
    }
    else if (section.name == "Elements")
    {
      this->Ranges.require(this->Nodes.has_value());
      this->readElements(section);
    }
    else if (section.name == "NodeData" || section.name == "ElementData")
    {
      this->readData(section, section.name == "NodeData");
    }
  }

  /// Small sections.
  void readByAll(const Section& section)
  {
    const FileContent text =
      this->Ranges.agreed([&] { return FileContent(this->Name, section.begin, section.next); });
    this->Ranges.expectSame(viewOf(text));
    this->Ranges.together(
      [&]
      {
        GmshInput in = this->input(text);
        if (section.name == "MeshFormat")
        {
          this->Version = readGmshFormat(in);
        }
        else if (section.name == "PhysicalNames")
        {
          readGmshPhysicalNames(in);
          MeshFile& mesh = this->Share.mesh;
          std::move(in.mesh.fieldArrays.begin(), in.mesh.fieldArrays.end(),
            std::back_inserter(mesh.fieldArrays));
          std::move(in.mesh.fieldStrings.begin(), in.mesh.fieldStrings.end(),
            std::back_inserter(mesh.fieldStrings));
        }
        else
        {
          readGmshEntities4(in, this->Physical);
          in.cursor.skipToToken();
          in.cursor.word();
        }
        if (in.binary)
        {
          in.cursor.fail("binary files have no lines");
        }
        in.cursor.expectFileEnd("line");
      });
  }

  /// What `read` finds at the begin of a section, and where it ends.
  template <class Read>
  auto header(const Section& section, const Read& read) const
  {
    const FileContent text = this->Ranges.agreed(
      [&] { return firstLines(this->Name, section.begin, section.end, HeadBytes); });
    this->Ranges.expectSame(viewOf(text));
    return this->Ranges.agreed(
      [&]
      {
        GmshInput in = this->input(text);
        auto result = read(in);
        return std::pair(result, section.begin + (in.cursor.place() - text.begin()));
      });
  }

  /// Calls read(input, share) for a rank's lines.
  template <class Read>
  void parse(const LineShare& lines, const Read& read)
  {
    this->Ranges.together(
      [&]
      {
        GmshInput in = this->input(lines.text);
        read(in);
        in.cursor.expectFileEnd("record");
      });
  }

  void setNodes(std::vector<double> points, const std::vector<Index>& tags)
  {
    this->Share.mesh.points = std::move(points);
    this->Nodes.emplace(this->Ranges, tags);
    this->Ranges.require(this->Nodes->begins().back() > 0);
  }

  void readNodes2(const Section& section)
  {
    const auto [count, begin] =
      this->header(section, [](GmshInput& in) { return readGmshCount2(in, "number of nodes"); });
    const LineShare lines = this->Ranges.lines(this->Name, begin, section.end, NoComment, count);
    std::vector<Index> tags;
    std::vector<double> points;
    this->parse(lines,
      [&, &lines = lines](GmshInput& in)
      {
        readGmshNodeRecords2(in, lines.count, tags);
        points = std::move(in.mesh.points);
      });
    this->setNodes(std::move(points), tags);
  }

  /// The header of a section of version 4.
  std::pair<GmshHeader4, Index> header4(const Section& section, bool nodes) const
  {
    return this->header(section,
      [&](GmshInput& in)
      {
        const GmshHeader4 result = readGmshHeader4(in, nodes);
        in.cursor.expectLineEnd();
        return result;
      });
  }

  /// Lines that each node or element of a block has.
  Index linesPerRecord(bool nodes) const
  {
    const FileContent none(this->Name, std::string_view());
    return nodes && gmshNumbersAreApart(this->input(none)) ? 2 : 1;
  }

  /// The blocks of a section; one rank after the other finds those that begin in its lines.
  std::vector<SharedBlock> findBlocks(
    const LineShare& lines, const GmshHeader4& header, bool nodes) const
  {
    std::vector<SharedBlock> blocks;
    Index next = 0, records = 0;
    const Index perRecord = this->linesPerRecord(nodes);
    for (int rank = 0; rank < this->group().size(); ++rank)
    {
      std::vector<SharedBlock> found;
      this->Ranges.together(
        [&]
        {
          if (rank != this->group().rank())
          {
            return;
          }
          GmshInput in = this->input(lines.text);
          Index line = lines.first, begin = next;
          while (begin < lines.first + lines.count)
          {
            for (; in.cursor.skipToToken() && line < begin; ++line)
            {
              in.cursor.skipRestOfLine();
              in.cursor.countRecord();
            }
            const GmshBlock4 block = readGmshBlock4(in, nodes);
            in.cursor.expectLineEnd();
            ++line;
            if (block.size > lines.total)
            {
              in.cursor.fail("a block is too large");
            }
            found.push_back({ block, begin });
            begin += 1 + perRecord * block.size;
          }
        });
      const std::vector<std::vector<SharedBlock>> all = this->group().gatherItems(found);
      this->Ranges.together(
        [&]
        {
          for (const std::vector<SharedBlock>& some : all)
          {
            for (const SharedBlock& one : some)
            {
              blocks.push_back(one);
              next = one.line + 1 + perRecord * one.block.size;
              records += one.block.size;
            }
          }
        });
    }
    this->Ranges.require(static_cast<Index>(blocks.size()) == header.blocks &&
      records == header.count && next == lines.total);
    return blocks;
  }

  /// Of `size` lines from `begin` on, how many a rank has.
  static Index linesOf(const LineShare& lines, Index begin, Index size)
  {
    const Index end = std::min(begin + size, lines.first + lines.count);
    return std::max<Index>(0, end - std::max(begin, lines.first));
  }

  static void expectBlock(
    GmshInput& in, const LineShare& lines, const SharedBlock& expected, bool nodes)
  {
    if (linesOf(lines, expected.line, 1) == 1 && !(readGmshBlock4(in, nodes) == expected.block))
    {
      in.cursor.fail("records are no lines");
    }
  }

  void readNodes4(const Section& section)
  {
    const auto [header, begin] = this->header4(section, true);
    const LineShare lines = this->Ranges.lines(this->Name, begin, section.end, NoComment);
    const std::vector<SharedBlock> blocks = this->findBlocks(lines, header, true);
    std::vector<Index> tags;
    std::vector<double> points;
    this->parse(lines,
      [&](GmshInput& in)
      {
        for (const SharedBlock& one : blocks)
        {
          expectBlock(in, lines, one, true);
          const Index size = one.block.size;
          Index first = one.line + 1;
          if (gmshNumbersAreApart(in))
          {
            readGmshNodeNumbers4(in, linesOf(lines, first, size), tags);
            first += size;
          }
          readGmshNodePoints4(in, one.block, linesOf(lines, first, size), tags);
        }
        points = std::move(in.mesh.points);
      });
    const std::vector<Index> from = rankBegins(this->group(), static_cast<Index>(tags.size())),
                             to = rankBegins(this->group(), static_cast<Index>(points.size() / 3));
    this->Ranges.require(from.back() == to.back());
    const RankRows rows =
      this->Ranges.agreed([&] { return realignedRows(this->group(), from, to); });
    tags = sendRows(this->Ranges, tags, rows, 1);
    this->setNodes(std::move(points), tags);
  }

  void readElements(const Section& section)
  {
    GmshHeader4 header{};
    Index begin = 0;
    const bool inBlocks = this->Version >= 4.0;
    if (inBlocks)
    {
      std::tie(header, begin) = this->header4(section, false);
    }
    else
    {
      std::tie(header.count, begin) = this->header(
        section, [](GmshInput& in) { return readGmshCount2(in, "number of elements"); });
    }
    MeshFile& mesh = this->Share.mesh;
    {
      const LineShare lines = this->Ranges.lines(this->Name, begin, section.end, NoComment);
      const std::vector<SharedBlock> blocks =
        inBlocks ? this->findBlocks(lines, header, false) : std::vector<SharedBlock>();
      this->Ranges.require(header.count > 0 && (inBlocks || lines.total == header.count));
      this->parse(lines,
        [&](GmshInput& in)
        {
          in.reserveElements(at(lines.count));
          for (const SharedBlock& one : blocks)
          {
            expectBlock(in, lines, one, false);
            readGmshElementRecords4(
              in, one.block, linesOf(lines, one.line + 1, one.block.size), this->Physical);
          }
          if (!inBlocks)
          {
            readGmshElementRecords2(in, lines.count);
          }
          mesh.cellTypes = std::move(in.mesh.cellTypes);
          mesh.offsets = std::move(in.mesh.offsets);
          mesh.connectivity = std::move(in.mesh.connectivity);
          this->References = std::move(in.references);
          this->Entities = std::move(in.entities);
          if (this->NeedsElementTags)
          {
            this->ElementTags = std::move(in.elementTags);
          }
        });
    }
    this->Nodes->find(mesh.connectivity);
    this->Share.sectionCells.push_back(mesh.numberOfCells());
  }

  void readData(const Section& section, bool points)
  {
    const auto [header, begin] =
      this->header(section, [](GmshInput& in) { return readGmshDataHeader(in); });
    const LineShare lines =
      this->Ranges.lines(this->Name, begin, section.end, NoComment, header.count);
    const auto components = at(header.components);
    // a value of each point or element needs them
    this->Ranges.require(points ? this->Nodes.has_value() : !this->Share.sectionCells.empty());
    std::vector<Index> tags;
    std::vector<double> values;
    this->parse(lines,
      [&, &header = header](GmshInput& in)
      {
        expectColumns(this->Name, lines, 1 + header.components);
        tags.resize(at(lines.count));
        values.resize(tags.size() * components);
        for (std::size_t i = 0; i < tags.size(); ++i)
        {
          tags[i] = readGmshDataNumber(in);
          readGmshDataValues(in, header.components, &values[i * components]);
          in.cursor.countRecord();
        }
      });
    if (!points && !this->Elements)
    {
      this->Elements.emplace(this->Ranges, this->ElementTags);
    }
    const std::optional<SharedTags>& known = points ? this->Nodes : this->Elements;
    known->find(tags);

    MeshFile& mesh = this->Share.mesh;
    const std::vector<Index>& begins = known->begins();
    MeshArray array = this->Ranges.agreed(
      [&, &header = header]
      {
        const FileContent none(this->Name, std::string_view());
        GmshInput in = this->input(none);
        GmshDataHeader all = header;
        all.place = none.begin();
        // the budget is that of the whole mesh
        const auto size = sizeof(double) * at(begins.back()) * components;
        if (size > this->Budget)
        {
          in.cursor.fail("the arrays are too large");
        }
        in.dataBudget = size;
        MeshArray result = makeGmshData(
          in, all, begins[at(this->group().rank()) + 1] - begins[at(this->group().rank())]);
        this->Budget -= size;
        return result;
      });
    const RankRows rows = this->Ranges.agreed(
      [&]
      {
        RankRows result(at(this->group().size()));
        for (std::size_t i = 0; i < tags.size(); ++i)
        {
          result[at(rankOf(begins, tags[i]))].push_back(static_cast<Index>(i));
        }
        return result;
      });
    tags = sendRows(this->Ranges, tags, rows, 1);
    values = sendRows(this->Ranges, values, rows, static_cast<Index>(components));
    auto& to = std::get<MeshArray::Doubles>(array.values);
    const Index first = begins[at(this->group().rank())];
    for (std::size_t i = 0; i < tags.size(); ++i)
    {
      std::copy_n(&values[i * components], components, &to[at(tags[i] - first) * components]);
    }
    setGmshData(points ? mesh.pointArrays : mesh.cellArrays, std::move(array));
  }

  const FileRanges& Ranges;
  std::string Name;
  std::size_t Budget; ///< bytes that data of the whole mesh may still take
  double Version = 0.0;
  GmshPhysical Physical;
  MeshShare Share;
  std::vector<Index> References, Entities, ElementTags;
  bool NeedsElementTags = false;
  std::optional<SharedTags> Nodes, Elements;
};
}

//------------------------------------------------------------------------------
MeshShare shareGmsh(const FileRanges& ranges, const std::string& name, bool lowerCells)
{
  ranges.expectLarge({ name });
  MeshShare share = SharedReader(ranges, name).read();
  if (!lowerCells)
  {
    keepHighestDimension(ranges, share);
  }
  return share;
}
}
