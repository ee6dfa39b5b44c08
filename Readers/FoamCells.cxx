// SPDX-License-Identifier: BSD-3-Clause
#include "ArrayIndex.h"
#include "FoamMesh.h"
#include "TextOutput.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Core/LoopProgress.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

namespace tautline
{
namespace
{
constexpr std::size_t FewestFaces = 4;

/// A face of a cell, seen from outside.
class OutwardFace
{
public:
  OutwardFace(const FoamMesh& mesh, Index face, Index cell)
    : First(mesh.facePoints.data() + mesh.faceOffsets[at(face)])
    , Size(mesh.faceOffsets[at(face) + 1] - mesh.faceOffsets[at(face)])
    , Number(face)
    , Reversed(mesh.owner[at(face)] != cell)
  {
  }

  Index size() const { return this->Size; }
  Index number() const { return this->Number; }
  /// The point i, counted around the face, at most twice; the first is the first in the file.
  Index point(Index i) const
  {
    const Index turned = i < this->Size ? i : i - this->Size;
    return this->First[this->Reversed && turned > 0 ? this->Size - turned : turned];
  }
  /// The index of a point in the face; -1 if it is not there.
  Index find(Index point) const
  {
    for (Index i = 0; i < this->Size; ++i)
    {
      if (this->point(i) == point)
      {
        return i;
      }
    }
    return -1;
  }
  std::vector<Index> sortedPoints() const
  {
    std::vector<Index> points(this->First, this->First + this->Size);
    std::sort(points.begin(), points.end());
    return points;
  }
  /// Whether the face has exactly these points in this cyclic order.
  bool is(std::initializer_list<Index> points) const
  {
    const Index begin =
      static_cast<Index>(points.size()) == this->Size ? this->find(*points.begin()) : -1;
    Index i = begin;
    return begin >= 0 &&
      std::all_of(points.begin(), points.end(), [&](Index p) { return this->point(i++) == p; });
  }

private:
  const Index* First;
  Index Size;
  Index Number;
  bool Reversed;
};

using OutwardFaces = std::vector<OutwardFace>;

/// Whether all faces except one are these, in any order.
bool matches(const OutwardFaces& faces, const OutwardFace& base,
  std::initializer_list<std::initializer_list<Index>> expected)
{
  return expected.size() + 1 == faces.size() &&
    std::all_of(expected.begin(), expected.end(),
      [&](const std::initializer_list<Index>& points)
      {
        return std::any_of(faces.begin(), faces.end(),
          [&](const OutwardFace& face)
          { return face.number() != base.number() && face.is(points); });
      });
}

/// The point after b in the face, other than the base, that runs from a to b; -1 if there is none.
Index pointAfter(const OutwardFaces& faces, const OutwardFace& base, Index a, Index b)
{
  for (const OutwardFace& face : faces)
  {
    const Index i = face.number() == base.number() ? -1 : face.find(a);
    if (i >= 0 && face.point(i + 1) == b)
    {
      return face.point(i + 2);
    }
  }
  return -1;
}

/// Appends the points of a tetrahedron or pyramid over the base, if the cell is one.
bool addCone(const OutwardFaces& faces, const OutwardFace& base, std::vector<Index>& points)
{
  const auto b = [&base](Index i) { return base.point(base.size() - i); }; // seen from inside
  const Index apex = pointAfter(faces, base, b(0), b(1));
  const bool quadrilateral = base.size() == 4;
  const bool found = apex >= 0 && base.find(apex) < 0 &&
    (quadrilateral ? matches(faces, base,
                       { { b(0), b(1), apex }, { b(1), b(2), apex }, { b(2), b(3), apex },
                         { b(3), b(0), apex } })
                   : matches(faces, base,
                       { { b(0), b(1), apex }, { b(1), b(2), apex }, { b(2), b(0), apex } }));
  for (Index i = 0; found && i < base.size(); ++i)
  {
    points.push_back(b(i));
  }
  if (found)
  {
    points.push_back(apex);
  }
  return found;
}

/// Appends the points of a wedge or hexahedron over the base, if the cell is one.
bool addPrism(const OutwardFaces& faces, const OutwardFace& base, std::vector<Index>& points)
{
  constexpr std::size_t Most = 4;
  const auto size = static_cast<std::size_t>(base.size());
  std::array<Index, Most> low{}, high{};
  for (std::size_t i = 0; i < size; ++i)
  {
    low[i] = base.point(base.size() - static_cast<Index>(i)); // seen from inside
  }
  for (std::size_t i = 0; i < size; ++i)
  {
    high[(i + 1) % size] = pointAfter(faces, base, low[i], low[(i + 1) % size]);
  }
  const std::array<Index, Most>&l = low, &h = high;
  const bool distinct = std::all_of(high.begin(), high.begin() + static_cast<std::ptrdiff_t>(size),
    [&](Index p) { return p >= 0 && base.find(p) < 0; });
  const bool found = distinct &&
    (size == Most
        ? matches(faces, base,
            { { l[0], l[1], h[1], h[0] }, { l[1], l[2], h[2], h[1] }, { l[2], l[3], h[3], h[2] },
              { l[3], l[0], h[0], h[3] }, { h[0], h[1], h[2], h[3] } })
        : matches(faces, base,
            { { l[0], l[1], h[1], h[0] }, { l[1], l[2], h[2], h[1] }, { l[2], l[0], h[0], h[2] },
              { h[0], h[1], h[2] } }));
  if (!found)
  {
    return false;
  }
  if (size < Most) // VTK lists the triangles of a wedge as seen from outside
  {
    std::swap(low[1], low[2]);
    std::swap(high[1], high[2]);
  }
  points.insert(points.end(), low.begin(), low.begin() + base.size());
  points.insert(points.end(), high.begin(), high.begin() + base.size());
  return true;
}

/// The VTK type of a cell, whose points are appended; for polyhedra nothing is appended.
unsigned char linearCell(const OutwardFaces& faces, std::vector<Index>& points)
{
  constexpr std::size_t Tetrahedron = 4, PyramidOrWedge = 5, Hexahedron = 6;
  std::array<std::size_t, 5> bySize{};
  for (const OutwardFace& face : faces)
  {
    if (face.size() > 4)
    {
      return FilePolyhedron;
    }
    ++bySize[at(face.size())];
  }
  const auto firstOf = [&faces](Index size) -> const OutwardFace&
  {
    return *std::find_if(
      faces.begin(), faces.end(), [&](const OutwardFace& face) { return face.size() == size; });
  };
  const std::size_t triangles = bySize[3], quadrilaterals = bySize[4];
  if (faces.size() == Tetrahedron && triangles == 4)
  {
    return addCone(faces, faces[0], points) ? FileTetrahedron : FilePolyhedron;
  }
  if (faces.size() == PyramidOrWedge && triangles == 4)
  {
    return addCone(faces, firstOf(4), points) ? FilePyramid : FilePolyhedron;
  }
  if (faces.size() == PyramidOrWedge && triangles == 2)
  {
    return addPrism(faces, firstOf(3), points) ? FileWedge : FilePolyhedron;
  }
  if (faces.size() == Hexahedron && quadrilaterals == Hexahedron)
  {
    return addPrism(faces, faces[0], points) ? FileHexahedron : FilePolyhedron;
  }
  return FilePolyhedron;
}

/// Finds the errors of polyhedra, with arrays that are reused from one to the next.
class PolyhedronCheck
{
public:
  /// Throws FoamDefect.
  void check(const OutwardFaces& faces, Index cell)
  {
    this->checkEdges(faces, cell);
    this->checkDuplicates(faces, cell);
  }

private:
  struct Edge
  {
    Index low, high, face;
    bool operator<(const Edge& other) const
    {
      return std::tie(this->low, this->high, this->face) <
        std::tie(other.low, other.high, other.face);
    }
  };

  void checkEdges(const OutwardFaces& faces, Index cell)
  {
    this->Edges.clear();
    for (const OutwardFace& face : faces)
    {
      for (Index i = 0; i < face.size(); ++i)
      {
        const Index a = face.point(i), b = face.point(i + 1);
        this->Edges.push_back({ std::min(a, b), std::max(a, b), face.number() });
      }
    }
    std::sort(this->Edges.begin(), this->Edges.end());
    for (std::size_t i = 0; i < this->Edges.size();)
    {
      const Edge& edge = this->Edges[i];
      std::size_t next = i;
      while (next < this->Edges.size() && this->Edges[next].low == edge.low &&
        this->Edges[next].high == edge.high)
      {
        ++next;
      }
      if ((next - i) % 2 != 0)
      {
        throw FoamDefect{ "faces", edge.face,
          "cell " + std::to_string(cell) + " is open: " + std::to_string(next - i) +
            " of its faces, face " + std::to_string(edge.face) +
            " among them, have the edge from " + "point " + std::to_string(edge.low) +
            " to point " + std::to_string(edge.high) };
      }
      i = next;
    }
  }

  void checkDuplicates(const OutwardFaces& faces, Index cell)
  {
    // a checksum of the points, independent of their order; size; face
    std::vector<Edge>& keys = this->Edges;
    keys.clear();
    for (std::size_t i = 0; i < faces.size(); ++i)
    {
      std::uint64_t sum = 0;
      for (Index k = 0; k < faces[i].size(); ++k)
      {
        sum += combine(0, static_cast<std::uint64_t>(faces[i].point(k)));
      }
      keys.push_back({ static_cast<Index>(sum), faces[i].size(), static_cast<Index>(i) });
    }
    std::sort(keys.begin(), keys.end());
    for (std::size_t i = 1; i < keys.size(); ++i)
    {
      const OutwardFace &a = faces[at(keys[i - 1].face)], &b = faces[at(keys[i].face)];
      if (keys[i].low == keys[i - 1].low && a.sortedPoints() == b.sortedPoints())
      {
        throw FoamDefect{ "faces", b.number(),
          "faces " + std::to_string(a.number()) + " and " + std::to_string(b.number()) +
            " of cell " + std::to_string(cell) + " have the same points" };
      }
    }
  }

  std::vector<Edge> Edges;
};

/// The faces shared by a nonOverlapPatch and a cyclicACMI patch, which a cell has only once.
std::vector<char> repeatedFaces(const FoamMesh& mesh)
{
  std::vector<char> repeated;
  for (const FoamPatch& patch : mesh.patches)
  {
    const auto rest = std::find_if(mesh.patches.begin(), mesh.patches.end(),
      [&patch](const FoamPatch& each)
      { return !patch.rest.empty() && each.name == patch.rest && each.rest.empty(); });
    if (rest == mesh.patches.end() || rest->size != patch.size)
    {
      continue;
    }
    repeated.resize(at(mesh.numberOfFaces()), 0);
    for (Index i = 0; i < patch.size; ++i)
    {
      const Index face = patch.start + i, other = rest->start + i;
      const Index cell = mesh.owner[at(face)];
      repeated[at(other)] = mesh.owner[at(other)] == cell &&
        OutwardFace(mesh, face, cell).sortedPoints() ==
          OutwardFace(mesh, other, cell).sortedPoints();
    }
  }
  return repeated;
}
}

//------------------------------------------------------------------------------
FoamCells cellsOf(const FoamMesh& mesh)
{
  constexpr std::size_t UsualPoints = 8;
  FoamCells cells;
  cells.cellFaces = cellFacesOf(mesh);
  cells.types.reserve(at(mesh.cells));
  cells.offsets.reserve(at(mesh.cells) + 1);
  cells.connectivity.reserve(at(mesh.cells) * UsualPoints);
  std::vector<Index> lastCell(at(mesh.numberOfPoints()), -1);
  OutwardFaces faces;
  PolyhedronCheck polyhedra;
  const std::vector<char> repeated = repeatedFaces(mesh);
  for (Index cell = 0; cell < mesh.cells; ++cell)
  {
    pollInterruption(cell);
    LoopProgress::atPass(cell, mesh.cells);
    faces.clear();
    const Index begin = cells.cellFaces.offsets[at(cell)];
    const Index end = cells.cellFaces.offsets[at(cell) + 1];
    for (Index i = begin; i < end; ++i)
    {
      const Index face = cells.cellFaces.faces[at(i)];
      if (repeated.empty() || !repeated[at(face)])
      {
        faces.emplace_back(mesh, face, cell);
      }
    }
    if (faces.size() < FewestFaces)
    {
      throw FoamDefect{ "owner", faces.empty() ? 0 : faces.back().number(),
        "cell " + std::to_string(cell) + " has " + std::to_string(faces.size()) +
          " faces; at least 4 are needed" };
    }
    const unsigned char type = linearCell(faces, cells.connectivity);
    if (type == FilePolyhedron)
    {
      polyhedra.check(faces, cell);
      cells.faceStarts.resize(at(cell), -1);
      cells.faceStarts.push_back(static_cast<Index>(cells.faceStreams.size()));
      cells.faceStreams.push_back(static_cast<Index>(faces.size()));
      for (const OutwardFace& face : faces)
      {
        cells.faceStreams.push_back(face.size());
        for (Index i = 0; i < face.size(); ++i)
        {
          cells.faceStreams.push_back(face.point(i));
          if (std::exchange(lastCell[at(face.point(i))], cell) != cell)
          {
            cells.connectivity.push_back(face.point(i));
          }
        }
      }
    }
    cells.types.push_back(type);
    cells.offsets.push_back(static_cast<Index>(cells.connectivity.size()));
  }
  if (!cells.faceStarts.empty())
  {
    cells.faceStarts.resize(at(mesh.cells), -1);
  }
  return cells;
}
}
