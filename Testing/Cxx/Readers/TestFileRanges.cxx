// SPDX-License-Identifier: BSD-3-Clause
// Ranks that read ranges of a file have the same parts as ranks that read all of it; what ranges
// cannot read, and every error, is noticed by all ranks.

#include "Registry.h"
#include "RangeChecks.h"
#include "tautline/Core/Interruption.h"

#include <fcntl.h>
#include <sys/stat.h>

using namespace tautline;

namespace
{
//------------------------------------------------------------------------------
void testTetGen()
{
  for (const char* name : { "/cube.1.ele", "/quadratic.1.ele" })
  {
    expectSame(data + name);
  }
  const std::string name = output + "/ranges.node";
  MeshFile mesh = sample(5);
  std::get<MeshArray::Integers>(mesh.cellArrays[0].values).resize(mesh.cellTypes.size());
  writeTetGen(mesh, name);
  expectSame(name);
  expectSame(output + "/ranges.ele");
  const std::string elements = readText(output + "/ranges.ele");
  const std::string nodes = readText(name);
  const auto withElements = [&](const std::string& text)
  { writeText(output + "/ranges.ele", text); };

  withElements(interleaved(elements, 7, "# a comment\n\n  \t\n"));
  writeText(name, interleaved(nodes, 3, "\n#5 5 5 5\n"));
  expectSame(name);
  withElements(replaced(elements, "\n", "\r\n"));
  expectSame(name);
  withElements(elements.substr(0, elements.rfind("\n#") + 1)); // no mark, and then no last line end
  expectSame(name);
  withElements(elements.substr(0, elements.rfind("\n#")));
  expectSame(name);
  // references that are whole numbers but for one of the last rank
  const std::size_t last = elements.rfind(' ', elements.rfind("\n#"));
  withElements(elements.substr(0, last) + " 0.5\n");
  expectSame(name);

  withElements(elements);
  expectSame(name);
  TAUTLINE_CHECK(readRanges(name, true, 3, 0, RangeLimits()).empty());
  const std::size_t middle = elements.find('\n', elements.size() / 2) + 1;
  const std::string head = elements.substr(0, middle), rest = elements.substr(middle);
  for (const std::string& bad : { head, head + "x " + rest, head + rest.substr(rest.find('\n') + 1),
         head + "1 " + rest, elements + "9 9\n", replaced(elements, " ", "  # "),
         replaced(elements, "\n2 ", "\n3 "), std::string() })
  {
    withElements(bad);
    TAUTLINE_CHECK(!complaint(name).empty());
    expectWhole(name, complaint(name));
  }
  withElements(elements);
  writeText(name, replaced(nodes, " 3 4 1\n", " 3 10000 0\n")); // columns that no line has
  TAUTLINE_CHECK(!complaint(name).empty());
  expectWhole(name, complaint(name));
  writeText(name, otherMark(nodes)); // of another write
  expectWhole(name);
  std::remove(name.c_str());
  expectWhole(name);
  expectWhole(data + "/box.poly");
  // only vertices, only faces
  for (const char* other : { ".ele", ".edge", ".face" })
  {
    std::remove((output + "/ranges" + other).c_str());
  }
  writeText(name, nodes.substr(0, nodes.rfind("\n#") + 1));
  expectSame(name);
  writeText(output + "/ranges.face", "3 1\n0 0 1 2 7\n1 1 2 3 -1\n2 4 5 6 1\n");
  expectSame(name);
  writeText(output + "/ranges.ele", "1 4\n0 0 1 2 3\n"); // fewer cells than ranks
  expectSame(name);
}

//------------------------------------------------------------------------------
void testMedit()
{
  expectSame(data + "/zoo.mesh");
  const std::string name = output + "/ranges.mesh", solution = output + "/ranges.sol";
  MeshFile mesh = sample(5);
  const std::size_t points = mesh.points.size() / 3, cells = mesh.cellTypes.size();
  mesh.pointArrays.push_back(MeshArray::make("Fixed", 1, 'u', points));
  mesh.pointArrays.push_back(MeshArray::make("Corner", 1, 'u', points));
  mesh.cellArrays.push_back(MeshArray::make("Ridge", 1, 'u', cells));
  mesh.cellArrays.push_back(MeshArray::make("Required", 1, 'u', cells));
  mesh.cellArrays.push_back(MeshArray::make("Energy", 1, 'f', cells));
  mesh.cellArrays.push_back(MeshArray::make("Stress", 9, 'f', 9 * cells));
  for (std::size_t i = 0; i < cells; ++i)
  {
    const bool line = mesh.cellTypes[i] == FileLine, triangle = mesh.cellTypes[i] == FileTriangle;
    setValue(mesh.cellArrays[1], i, line && i % 3 == 0);
    setValue(mesh.cellArrays[2], i, (line || triangle) && i % 2 == 0);
    setValue(mesh.cellArrays[3], i, noise(static_cast<Index>(i)));
    for (std::size_t c = 0; c < 9; ++c)
    {
      setValue(mesh.cellArrays[4], 9 * i + c, static_cast<double>(i + c % 3 + c / 3));
    }
  }
  for (std::size_t i = 0; i < points; i += 11)
  {
    setValue(mesh.pointArrays[3], i, 1);
    setValue(mesh.pointArrays[4], i, i % 2 == 0);
  }
  writeMedit(mesh, name);
  TAUTLINE_CHECK(findArray(readMedit(name, true).cellArrays, "Stress") != nullptr);
  expectSame(name);
  expectSame(solution);
  const std::string text = readText(name), fields = readText(solution);
  writeText(name, interleaved(text, 5, "\n# Vertices 5\n  \t\n"));
  writeText(solution, interleaved(fields, 50, "\n# End\n"));
  expectSame(name);
  writeText(name, replaced(text, "\n", "\r\n"));
  expectSame(name);
  writeText(name, replaced(text, "\nTriangles", " Triangles"));
  expectSame(name);
  writeText(name, replaced(text, "Tetrahedra\n", "Tangents\n2\n1 2\n3 4\nTetrahedra "));
  expectSame(name);
  writeText(name, text);
  writeText(solution, fields);
  expectSame(name);

  // read whole: good, but laid out in another way
  const std::size_t middle = text.find('\n', text.find("\nTetrahedra") + 500);
  const std::string head = text.substr(0, middle), rest = text.substr(middle + 1);
  for (const std::string& other : { head + " " + rest, replaced(text, "\n", " "),
         replaced(text, "Tetrahedra\n", "Foo 1 2 Bar 3\n4\nTetrahedra\n"),
         replaced(text, "\n\nTriangles", " Triangles"), "\xef\xbb\xbf" + text })
  {
    writeText(name, other);
    TAUTLINE_CHECK(complaint(name).empty());
    expectWhole(name, "laid out in another way");
  }
  for (const std::string& bad :
    { head, head + "\nx " + rest, head + "\n1 " + rest, replaced(text, "\nEnd", "\n"),
      replaced(text, "Dimension", "# "), replaced(text, "Vertices\n", "Vertices\n9"), "MFEM" + text,
      replaced(text, "Triangles\n", "Triangles\n-"), std::string() })
  {
    writeText(name, bad);
    TAUTLINE_CHECK(!complaint(name).empty());
    expectWhole(name, complaint(name));
  }
  writeText(name, text);
  for (const std::string& bad :
    { fields.substr(0, fields.size() / 2), replaced(fields, "SolAtVertices\n", "SolAtVertices\n1"),
      otherMark(fields), replaced(fields, "Dimension 3", "Foo 3\nDimension 3") })
  {
    writeText(solution, bad);
    TAUTLINE_CHECK(!complaint(name).empty());
    expectWhole(name, complaint(name));
  }
  std::remove(solution.c_str());
  writeText(name,
    "MeshVersionFormatted 2\nDimension\n3\nVertices\n4\n0 0 0 1\n1 0 0 2\n0 1 0 3\n0 0 1 4\n"
    "Ridges\n0\nTetrahedra\n1\n1 2 3 4 5\nCorners\n1\n4\nEnd\nVertices\nfoo\n");
  expectSame(name); // fewer cells than ranks
  writeText(name,
    "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 1\n1 0 0 2\n0 1 0 3\n0 0 1 4\n"
    "Tetrahedra\n1\n1 2 3 4 5\nTriangles\n1\n1 2 3 4\nEnd\n");
  writeText(solution, // arrays of one name, which cannot be one
    "MeshVersionFormatted 2\nDimension 3\nSolAtVertices\n4\n1 1\nnan\nINF\ninfinity\nNaN\n"
    "SolAtTetrahedra\n1\n1 1\n7\nSolAtTriangles\n1\n1 2\n1 2 3\nEnd\n");
  expectSame(name);
}

//------------------------------------------------------------------------------
/// A file with a section of data without values before another section.
std::string before(std::string text, const std::string& section, const std::string& other)
{
  const std::string end = "$End" + section.substr(1) + "\n";
  return text.insert(text.find(other + "\n"), section + "\n1\n\"none\"\n1\n0\n3\n0\n1\n0\n" + end);
}

void testGmsh()
{
  for (const char* name : { "/part.msh", "/cylinder.msh", "/wedges.msh" })
  {
    expectSame(data + name);
  }
  expectWhole(data + "/part22-binary.msh", "binary");
  expectWhole(data + "/tent.msh", "of FreeFem++");
  const std::string name = output + "/ranges.msh";
  const MeshFile mesh = sample(4);
  writeGmsh(mesh, name, false);
  expectSame(name);
  const std::string blocks = readText(name);
  const std::string plain = gmsh2(mesh, [](Index i) { return i + 1; });
  std::vector<std::string> others = { plain, gmsh2(mesh, [](Index i) { return i + 1000000000000; }),
    gmsh2(mesh, [](Index i) { return 5000 - 3 * i; }),
    gmsh2(mesh, [](Index i) { return i * i * i; }), replaced(plain, "\n", "\r\n"),
    interleaved(plain, 7, "\n \t\n"), replaced(blocks, "\n", "\r\n"),
    interleaved(blocks, 11, "\n") };
  for (const std::string& text : others)
  {
    writeText(name, text);
    expectSame(name);
  }

  // read whole: good, but laid out in another way
  std::string unknown; // sections, in two halves of the file and more than ranks look at
  for (Index i = 0; i < RangeLimits().starts / 4 + 1; ++i)
  {
    unknown += "$Foo\n$EndFoo\n";
  }
  writeText(name, replaced(plain, "$Nodes", unknown + "$Nodes") + unknown);
  expectSame(name, { 0, 1 << 20, 1 << 20, 2 * RangeLimits().starts });
  for (const std::string& other : { readText(name), replaced(plain, "$EndNodes", " $EndNodes"),
         plain + "\n$Foo\n$Bar\n$EndFoo\n", replaced(blocks, "\n2 \n", " 2 \n") })
  {
    writeText(name, other);
    TAUTLINE_CHECK(complaint(name).empty());
    expectWhole(name, "laid out in another way");
  }
  const std::size_t middle = plain.find('\n', plain.find("$Elements") + 500) + 1;
  const std::string head = plain.substr(0, middle), rest = plain.substr(middle);
  for (const std::string& bad : { head, head + "x " + rest, head + "1 4 0 1 2 3 4\n" + rest,
         replaced(plain, "\n7 ", "\n8 "), replaced(plain, "$EndElements", "$EndElement"),
         replaced(plain, "2.2 0", "3.0 0"), replaced(plain, "$EndNodes\n", "1 2 3 4\n$EndNodes\n"),
         replaced(plain, "some NodeData", "some \n"),
         replaced(plain, "\n3\n0\n3\n", "\n3\n0\n1000\n"), // components that no line has
         before(plain, "$ElementData", "$Elements"), before(plain, "$NodeData", "$Nodes"),
         plain + "1\n", "x\n" + plain, plain.substr(0, plain.rfind("-1e")),
         replaced(plain, "$Nodes", "$NOD"), blocks.substr(0, blocks.size() / 2),
         replaced(blocks, "\n9 ", "\n99999 ") })
  {
    writeText(name, bad);
    TAUTLINE_CHECK(!complaint(name).empty());
    expectWhole(name, complaint(name));
  }
  writeText(name,
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n9 0 0 0\n7 1 0 0\n5 0 1 0\n3 0 0 1\n"
    "$EndNodes\n$Elements\n1\n1 4 2 5 6 3 5 7 9\n$EndElements\n");
  expectSame(name); // fewer cells than ranks
  writeText(name,
    "$MeshFormat\n4.0 0 8\n$EndMeshFormat\n$Entities\n0 0 0 1\n3 0 0 0 1 1 1 1 42 0\n"
    "$EndEntities\n$Nodes\n2 5\n1 0 0 2\n9 0 0 0\n7 1 0 0\n3 3 1 3\n5 0 1 0 .1 .2 .3\n"
    "3 0 0 1 1 1 1\n4 0 0 2 1 1 1\n$EndNodes\n$Elements\n1 2\n3 3 4 2\n1 3 5 7 9\n2 4 5 7 9\n"
    "$EndElements\n");
  expectSame(name);
  writeText(name,
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n5 \"old\"\n$EndPhysicalNames\n"
    "$Nodes\n4\n9 0 0 0\n7 1 0 0\n5 0 1 0\n3 0 0 1\n"
    "$EndNodes\n$Elements\n1\n1 4 2 5 6 3 5 7 9\n$EndElements\n");
  expectWhole(name, "a group without its dimension");
}

//------------------------------------------------------------------------------
/// Whether all of three ranks notice that the first of them has another file.
bool noticed(const std::function<void(const FileRanges&, const std::string& name)>& read,
  const std::string& name, const std::string& other)
{
  constexpr int ranks = 3;
  std::atomic<int> unusual = 0;
  onRanks(ranks,
    [&](RankGroup& group)
    {
      try
      {
        read(FileRanges(group, { 0 }), group.rank() == 0 ? other : name);
      }
      catch (const UnusualFile&)
      {
        ++unusual;
      }
    });
  TAUTLINE_CHECK(unusual == 0 || unusual == ranks);
  return unusual == ranks;
}

/// Files that differ between the ranks, as copies on their machines may.
void testDifferences()
{
  const std::string name = output + "/ranges.msh", other = output + "/other.msh";
  const auto write = [&](const std::string& file, const std::string& text, time_t seconds)
  {
    writeText(file, text);
    const timespec times[2] = { { seconds, 0 }, { seconds, 0 } };
    TAUTLINE_CHECK(utimensat(AT_FDCWD, file.c_str(), times, 0) == 0);
  };
  const auto large = [](const FileRanges& ranges, const std::string& file)
  { ranges.expectLarge({ file }); };
  const auto share = [](const FileRanges& ranges, const std::string& file)
  { exchangeParts(ranges, shareByName(ranges, file, true), 1); };
  const std::string text = gmsh2(sample(2), [](Index i) { return i + 1; }) + "$Foo\n1 2\n$EndFoo\n";
  write(name, text, 5);
  write(other, text, 5);
  TAUTLINE_CHECK(!noticed(large, name, other) && !noticed(share, name, other));
  write(other, text, 6);
  TAUTLINE_CHECK(noticed(large, name, other) && noticed(share, name, other));
  write(other, text + " ", 5);
  TAUTLINE_CHECK(noticed(large, name, other) && noticed(share, name, other));
  // other sections, counts and fields in as many bytes
  for (const char* change : { "$Foo\n|$Bar\n", "\n3\n0\n3\n|\n3\n7\n3\n", "\"a group|\"a troop" })
  {
    const std::string both(change);
    const std::string from = both.substr(0, both.find('|')), to = both.substr(both.find('|') + 1);
    TAUTLINE_CHECK(text.find(from) != std::string::npos);
    write(
      other, replaced(replaced(text, from, to), "EndFoo", from[1] == 'F' ? "EndBar" : "EndFoo"), 5);
    TAUTLINE_CHECK(!noticed(large, name, other) && noticed(share, name, other));
  }
  const std::string mesh = output + "/ranges.mesh", copy = output + "/other.mesh";
  const std::string medit = "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 1\n1 0 0 2\n"
                            "0 1 0 3\n0 0 1 4\nNormals\n1\n0 0 1\nTetrahedra\n1\n1 2 3 4 5\nEnd\n";
  std::remove((output + "/ranges.sol").c_str());
  write(mesh, medit, 5);
  write(copy, replaced(medit, "Normals", "Numbers"), 5);
  TAUTLINE_CHECK(noticed(
    [](const FileRanges& ranges, const std::string& file)
    {
      ranges.expectLarge({ file });
      shareMedit(ranges, file, true);
    },
    mesh, copy));
}

//------------------------------------------------------------------------------
/// A rank that is interrupted leaves none waiting, and none reads the whole file instead.
void testInterruption()
{
  const std::string name = output + "/ranges.msh";
  writeText(name, gmsh2(sample(4), [](Index i) { return i + 1; }));
  std::atomic<int> interrupted = 0, errors = 0;
  onRanks(3,
    [&](RankGroup& group)
    {
      const InterruptScope scope(false);
      if (group.rank() == 1)
      {
        InterruptScope::cancel();
      }
      try
      {
        const FileRanges ranges(group, { 0 });
        exchangeParts(ranges, shareGmsh(ranges, name, true), 1);
      }
      catch (const Interrupted&)
      {
        ++interrupted;
      }
      catch (const Error&)
      {
        ++errors;
      }
    });
  TAUTLINE_CHECK(interrupted == 1 && errors == 2);
}
}

TAUTLINE_TEST(TestFileRanges)
{
  data = argv[1];
  output = argv[2];
  TAUTLINE_RUN(testTetGen());
  TAUTLINE_RUN_SLOW(testMedit());
  TAUTLINE_RUN_SLOW(testGmsh());
  TAUTLINE_RUN(testDifferences());
  TAUTLINE_RUN(testInterruption());
}
