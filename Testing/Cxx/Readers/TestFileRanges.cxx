// SPDX-License-Identifier: BSD-3-Clause
// Ranks that read ranges of a file have the same parts as ranks that read all of it; what ranges
// cannot read, and every error, is noticed by all ranks.

#include "FileRanges.h"
#include "MeshFileChecks.h"
#include "MeshPart.h"
#include "PartExchange.h"
#include "ThreadRanks.h"
#include "tautline/Core/Interruption.h"

#include <atomic>
#include <functional>

using namespace tautline;

namespace
{
std::string data;
std::string output;

/// A rank's share, by the name's ending.
MeshShare shareByName(const FileRanges& ranges, const std::string& name, bool lowerCells)
{
  const std::string extension = splitExtension(name).second;
  if (extension == "msh")
  {
    return shareGmsh(ranges, name, lowerCells);
  }
  return extension == "mesh" || extension == "sol" ? shareMedit(ranges, name, lowerCells)
                                                   : shareTetGen(ranges, name, lowerCells);
}

/// The part of each rank; empty where the file is to be read whole.
std::vector<MeshFile> readRanges(
  const std::string& name, bool lowerCells, int ranks, int ghostLayers, Index smallSet = 0)
{
  std::vector<MeshFile> parts(static_cast<std::size_t>(ranks));
  std::atomic<int> unusual = 0;
  onRanks(ranks,
    [&](RankGroup& group)
    {
      try
      {
        const FileRanges ranges(group, smallSet);
        parts[static_cast<std::size_t>(group.rank())] =
          exchangeParts(ranges, shareByName(ranges, name, lowerCells), ghostLayers);
      }
      catch (const UnusualFile&)
      {
        ++unusual;
      }
    });
  TAUTLINE_CHECK(unusual == 0 || unusual == ranks);
  return unusual == 0 ? parts : std::vector<MeshFile>();
}

/// Everything equal, and arrays in the same order.
bool identical(const MeshFile& a, const MeshFile& b)
{
  const auto names = [](const MeshFile& mesh)
  {
    std::string all;
    for (const auto* arrays : { &mesh.pointArrays, &mesh.cellArrays, &mesh.fieldArrays })
    {
      for (const MeshArray& array : *arrays)
      {
        all += array.name + "|";
      }
      all += "\n";
    }
    for (const MeshStrings& strings : mesh.fieldStrings)
    {
      all += strings.name + "|";
      for (const std::string& value : strings.values)
      {
        all += value + "|";
      }
    }
    return all;
  };
  return same(a, b) && names(a) == names(b) && a.warnings == b.warnings;
}

/// Parts of 2 to 5 ranks by ranges and by reading the whole file.
void expectSame(const std::string& name)
{
  const Context file(name);
  for (const bool lowerCells : { true, false })
  {
    const MeshFile whole = readByName(name, lowerCells);
    for (int ranks = 2; ranks <= 5; ++ranks)
    {
      for (int layers = 0; layers <= 2; ++layers)
      {
        const Context division(std::to_string(ranks) + " ranks, " + std::to_string(layers) +
          " layers" + (lowerCells ? ", lower cells" : ""));
        const std::vector<MeshFile> parts = readRanges(name, lowerCells, ranks, layers);
        TAUTLINE_CHECK(parts.size() == static_cast<std::size_t>(ranks));
        for (std::size_t rank = 0; rank < parts.size(); ++rank)
        {
          const MeshFile expected = partOf(whole, { static_cast<int>(rank), ranks, layers });
          TAUTLINE_CHECK(identical(expected, parts[rank]));
        }
      }
    }
  }
}

/// All ranks give up ranges.
void expectWhole(const std::string& name, const std::string& what = "")
{
  const Context file(name + " " + what);
  for (int ranks = 2; ranks <= 4; ++ranks)
  {
    TAUTLINE_CHECK(readRanges(name, true, ranks, 1).empty());
  }
}

/// A number for tests: the same for the same place.
double noise(Index i)
{
  return static_cast<double>((i * 7919) % 1009) / 1009;
}

/// n^3 cubes of six tetrahedra, moved a little, in an order that is not that of their places; with
/// triangles, lines, points of no cell, and arrays.
MeshFile sample(Index n)
{
  MeshFile mesh;
  const Index side = n + 1, points = side * side * side;
  const auto shuffled = [](Index i, Index count) { return (i * 7 + 3) % count; };
  const Index step = points % 7 == 0 ? 1 : 7; // prime to the number of points
  std::vector<Index> place(static_cast<std::size_t>(points));
  for (Index i = 0; i < points; ++i)
  {
    place[static_cast<std::size_t>(i * step % points)] = i;
  }
  mesh.points.resize(static_cast<std::size_t>(3 * points));
  for (Index i = 0; i < points; ++i)
  {
    double* p = &mesh.points[static_cast<std::size_t>(3 * place[static_cast<std::size_t>(i)])];
    p[0] = static_cast<double>(i % side) + 0.1 * noise(i);
    p[1] = static_cast<double>(i / side % side);
    p[2] = static_cast<double>(i / (side * side)) - 0.1 * noise(i + 5);
  }
  const int corners[6][4] = { { 0, 1, 3, 7 }, { 0, 3, 2, 7 }, { 0, 2, 6, 7 }, { 0, 6, 4, 7 },
    { 0, 4, 5, 7 }, { 0, 5, 1, 7 } };
  const Index cubes = n * n * n;
  const auto corner = [&](Index cube, int c)
  {
    const Index x = cube % n + c % 2, y = cube / n % n + c / 2 % 2, z = cube / (n * n) + c / 4;
    return place[static_cast<std::size_t>(x + side * (y + side * z))];
  };
  MeshArray::Integers reference;
  for (Index i = 0; i < cubes; ++i)
  {
    const Index cube = cubes % 7 == 0 ? i : shuffled(i, cubes);
    for (const auto& tetrahedron : corners)
    {
      const Index nodes[] = { corner(cube, tetrahedron[0]), corner(cube, tetrahedron[1]),
        corner(cube, tetrahedron[2]), corner(cube, tetrahedron[3]) };
      mesh.addCell(FileTetrahedron, nodes, 4);
      reference.push_back(cube % 5);
    }
  }
  for (Index cube = 0; cube < cubes; cube += 3)
  {
    const Index nodes[] = { corner(cube, 0), corner(cube, 1), corner(cube, 3) };
    mesh.addCell(FileTriangle, nodes, 3);
    reference.push_back(-cube);
  }
  for (Index cube = 0; cube < cubes; cube += 4)
  {
    const Index nodes[] = { corner(cube, 0), corner(cube, 1) };
    mesh.addCell(FileLine, nodes, 2);
    reference.push_back(cube);
  }
  mesh.cellArrays.push_back({ "Reference", 1, reference });
  for (int i = 0; i < 5; ++i) // points that no cell has
  {
    mesh.points.insert(mesh.points.end(), { 50.0 + i, 1.0, 2.0 });
  }
  MeshArray::Doubles velocity, heat;
  MeshArray::Integers marker;
  for (Index i = 0; i < mesh.numberOfPoints(); ++i)
  {
    velocity.insert(velocity.end(), { noise(i), noise(i + 1), -noise(i + 2) });
    heat.push_back(noise(i + 3));
    marker.push_back(i % 4);
  }
  mesh.pointArrays.push_back({ "Velocity", 3, velocity });
  mesh.pointArrays.push_back({ "Heat", 1, heat });
  mesh.pointArrays.push_back({ "BoundaryMarker", 1, marker });
  return mesh;
}

/// Puts text before each line of a file whose number is a multiple of `every`.
std::string interleaved(const std::string& text, std::size_t every, const std::string& inserted)
{
  std::istringstream lines(text);
  std::string result, line;
  for (std::size_t i = 1; std::getline(lines, line); ++i)
  {
    result += (i % every == 0 ? inserted : "") + line + "\n";
  }
  return result;
}

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
  for (std::size_t at = text.find(from); at != text.npos; at = text.find(from, at + to.size()))
  {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// A file with the mark of another write.
std::string otherMark(std::string text)
{
  char& digit = text[text.size() - 2];
  digit = digit == '0' ? '1' : '0';
  return text;
}

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
  TAUTLINE_CHECK(readRanges(name, true, 3, 0, FileRanges::SmallSet).empty());
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
}

//------------------------------------------------------------------------------
/// Version 2.2, with numbers of nodes and elements that a function gives, and data of both.
std::string gmsh2(const MeshFile& mesh, const std::function<Index(Index)>& number)
{
  std::ostringstream text;
  text.precision(17);
  text << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Comments\n1 2\n$EndComments\n"
       << "$PhysicalNames\n1\n3 2 \"a group\"\n$EndPhysicalNames\n$Nodes\n"
       << mesh.numberOfPoints() << "\n";
  for (Index i = 0; i < mesh.numberOfPoints(); ++i)
  {
    const double* p = &mesh.points[static_cast<std::size_t>(3 * i)];
    text << number(i) << " " << p[0] << " " << p[1] << " " << p[2] << "\n";
  }
  text << "$EndNodes\n$Elements\n" << mesh.numberOfCells() << "\n";
  for (Index i = 0; i < mesh.numberOfCells(); ++i)
  {
    const auto cell = static_cast<std::size_t>(i);
    const int dimension = cellDimension(mesh.cellTypes[cell]);
    text << number(i) << " " << (dimension == 3 ? 4 : dimension) << " 2 " << i % 3 << " " << i % 7;
    for (Index node = mesh.offsets[cell]; node < mesh.offsets[cell + 1]; ++node)
    {
      text << " " << number(mesh.connectivity[static_cast<std::size_t>(node)]);
    }
    text << "\n";
  }
  text << "$EndElements\n";
  for (const bool points : { true, false })
  {
    const std::string name = points ? "NodeData" : "ElementData";
    const Index count = (points ? mesh.numberOfPoints() : mesh.numberOfCells()) / 2;
    for (int step = 0; step < 2; ++step) // the second replaces the first; both have gaps
    {
      text << "$" << name << "\n1\n\"some " << name << "\"\n1\n0.5\n3\n"
           << step << "\n3\n"
           << count << "\n";
      for (Index i = count; i > 0; --i)
      {
        text << number(2 * i - 1 - step) << " " << i << " " << noise(i) << " -1e-3\n";
      }
      text << "$End" << name << "\n";
    }
  }
  return text.str();
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
  for (const std::string& other : { replaced(plain, "$EndNodes", " $EndNodes"),
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
         replaced(plain, "some NodeData", "some \n"), plain + "1\n", "x\n" + plain,
         plain.substr(0, plain.rfind("-1e")), replaced(plain, "$Nodes", "$NOD"),
         blocks.substr(0, blocks.size() / 2), replaced(blocks, "\n9 ", "\n99999 ") })
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
        const FileRanges ranges(group, 0);
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

int TestFileRanges(int, char* argv[])
{
  data = argv[1];
  output = argv[2];
  testTetGen();
  testMedit();
  testGmsh();
  testInterruption();
  return exitCode();
}
