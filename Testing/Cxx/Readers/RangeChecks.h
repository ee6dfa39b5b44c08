// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RangeChecks.h
 * @brief Files that ranks read by ranges, and comparisons with what one reads, for tests.
 */
#ifndef tautline_RangeChecks_h
#define tautline_RangeChecks_h

#include "FileRanges.h"
#include "MeshFileChecks.h"
#include "MeshPart.h"
#include "PartExchange.h"
#include "ThreadRanks.h"

#include <atomic>
#include <functional>

namespace tautline
{
/// The directory with files, and one to write to.
inline std::string data, output;

/// A rank's share, by the name's ending.
inline MeshShare shareByName(const FileRanges& ranges, const std::string& name, bool lowerCells)
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
inline std::vector<MeshFile> readRanges(const std::string& name, bool lowerCells, int ranks,
  int ghostLayers, const RangeLimits& limits = { 0 })
{
  std::vector<MeshFile> parts(static_cast<std::size_t>(ranks));
  std::atomic<int> unusual = 0;
  onRanks(ranks,
    [&](RankGroup& group)
    {
      try
      {
        const FileRanges ranges(group, limits);
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

/// Arrays in the same order; several may have the same name.
inline bool inOrder(const std::vector<MeshArray>& a, const std::vector<MeshArray>& b)
{
  bool equal = a.size() == b.size();
  for (std::size_t i = 0; equal && i < a.size(); ++i)
  {
    equal = contains({ b[i] }, { a[i] });
  }
  return equal;
}

/// Everything equal, and arrays in the same order.
inline bool identical(const MeshFile& a, const MeshFile& b)
{
  const auto strings = [](const MeshFile& mesh)
  {
    std::string all;
    for (const MeshStrings& list : mesh.fieldStrings)
    {
      all += list.name + "|";
      for (const std::string& value : list.values)
      {
        all += value + "|";
      }
    }
    return all;
  };
  return same(a.points, b.points) && a.cellTypes == b.cellTypes && a.offsets == b.offsets &&
    a.connectivity == b.connectivity && inOrder(a.pointArrays, b.pointArrays) &&
    inOrder(a.cellArrays, b.cellArrays) && inOrder(a.fieldArrays, b.fieldArrays) &&
    strings(a) == strings(b) && a.warnings == b.warnings;
}

/// Parts of 2 to 5 ranks by ranges and by reading the whole file.
inline void expectSame(const std::string& name, const RangeLimits& limits = { 0 })
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
        const std::vector<MeshFile> parts = readRanges(name, lowerCells, ranks, layers, limits);
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
inline void expectWhole(const std::string& name, const std::string& what = "")
{
  const Context file(name + " " + what);
  for (int ranks = 2; ranks <= 4; ++ranks)
  {
    TAUTLINE_CHECK(readRanges(name, true, ranks, 1).empty());
  }
}

/// A number for tests: the same for the same place.
inline double noise(Index i)
{
  return static_cast<double>((i * 7919) % 1009) / 1009;
}

/// n^3 cubes of six tetrahedra, moved a little, in an order that is not that of their places; with
/// triangles, lines, points of no cell, and arrays.
inline MeshFile sample(Index n)
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
inline std::string interleaved(
  const std::string& text, std::size_t every, const std::string& inserted)
{
  std::istringstream lines(text);
  std::string result, line;
  for (std::size_t i = 1; std::getline(lines, line); ++i)
  {
    result += (i % every == 0 ? inserted : "") + line + "\n";
  }
  return result;
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to)
{
  for (std::size_t at = text.find(from); at != text.npos; at = text.find(from, at + to.size()))
  {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// A file with the mark of another write.
inline std::string otherMark(std::string text)
{
  char& digit = text[text.size() - 2];
  digit = digit == '0' ? '1' : '0';
  return text;
}

/// Version 2.2, with numbers of nodes and elements that a function gives, and data of both.
inline std::string gmsh2(const MeshFile& mesh, const std::function<Index(Index)>& number)
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
}
#endif
