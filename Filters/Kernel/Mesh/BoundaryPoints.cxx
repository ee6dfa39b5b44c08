// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryPoints.h"

#include "tautline/Core/CountingSort.h"
#include "tautline/Core/Random.h"

#include <algorithm>
#include <cstdint>

namespace tautline
{
namespace
{
/// The marks of the facets at a point.
struct Mark
{
  std::uint64_t parity = 0; ///< exclusive or of their numbers
  std::uint64_t sum = 0;    ///< of their numbers, with the sign of the orientation
  bool any() const { return this->parity != 0 || this->sum != 0; }
};

/// A number that changes its sign if the order is reversed, but not if it is rotated.
inline std::uint64_t signedNumber(const std::uint64_t* number, const int* member, int size)
{
  std::uint64_t sum = 0;
  for (int k = 0; k < (size == 2 ? 1 : size); ++k)
  {
    const std::uint64_t x = number[member[k]], y = number[member[k + 1 < size ? k + 1 : 0]];
    sum += x * y * (x - y);
  }
  return sum;
}

/// Adds the marks of the facets of a cell at its nodes.
void addMarks(const CellTopology& t, const Index* node, std::vector<Mark>& marks)
{
  std::uint64_t number[MaxNodes];
  // With mixed numbers, accidental cancellation of different facets is improbable.
  for (int k = 0; k < t.nodes; ++k)
  {
    number[k] = SplitMix::mixed(static_cast<std::uint64_t>(node[k]));
  }
  const int facets = t.dimension == 3 ? t.faces : t.edges;
  Mark own[MaxNodes] = {};
  for (int f = 0; f < facets; ++f)
  {
    const int size = t.dimension == 3 ? t.faceSizes[f] : 2;
    const int* member = t.dimension == 3 ? t.faceNodes[f].data() : t.edgeNodes[f].data();
    std::uint64_t facet = 0; // independent of the order of the nodes
    for (int k = 0; k < size; ++k)
    {
      facet += number[member[k]];
    }
    facet = SplitMix::mixed(facet);
    const std::uint64_t sense = signedNumber(number, member, size);
    // A facet of two consistently oriented cells cancels in both marks.
    for (int k = 0; k < size; ++k)
    {
      own[member[k]].parity ^= facet;
      own[member[k]].sum += sense;
    }
  }
  for (int k = 0; k < t.nodes; ++k)
  {
    marks[node[k]].parity ^= own[k].parity;
    marks[node[k]].sum += own[k].sum;
  }
}

/// The same for tetrahedra, vectorized over several cells: a face has the number of the vertex
/// opposite to it.
void addTetrahedra(
  const MeshView& view, const CellBlock& block, Index begin, Index end, std::vector<Mark>& marks)
{
  constexpr int most = 16;
  constexpr int round[4][3] = { { 1, 2, 3 }, { 2, 0, 3 }, { 0, 1, 3 }, { 0, 2, 1 } };
  std::uint64_t a[4][most] = {}, face[4][most], sense[4][most];
  for (; begin < end; begin += most)
  {
    const int count = static_cast<int>(std::min<Index>(most, end - begin));
    const Index* nodes[most];
    for (int l = 0; l < count; ++l)
    {
      nodes[l] = view.connectivity + view.offsets[block.cell(begin + l)];
      for (int k = 0; k < 4; ++k)
      {
        a[k][l] = static_cast<std::uint64_t>(nodes[l][k]);
      }
    }
    // All lanes are computed, so that the loops vectorize; lanes from `count` on are never read.
    for (auto& of : a)
    {
      for (std::uint64_t& number : of)
      {
        number = SplitMix::mixed(number);
      }
    }
    for (int k = 0; k < 4; ++k)
    {
      for (int l = 0; l < most; ++l)
      {
        const std::uint64_t x = a[round[k][0]][l], y = a[round[k][1]][l], z = a[round[k][2]][l];
        face[k][l] = SplitMix::mixed(x + y + z);
        sense[k][l] = (x - y) * (y - z) * (z - x);
      }
    }
    for (int l = 0; l < count; ++l)
    {
      const std::uint64_t all = face[0][l] ^ face[1][l] ^ face[2][l] ^ face[3][l];
      const std::uint64_t sum = sense[0][l] + sense[1][l] + sense[2][l] + sense[3][l];
      for (int k = 0; k < 4; ++k)
      {
        // A vertex is on all faces except the opposite one.
        Mark& mark = marks[nodes[l][k]];
        mark.parity ^= all ^ face[k][l];
        mark.sum += sum - sense[k][l];
      }
    }
  }
}

/// The same for triangles and quadrilaterals, consistent with addMarks().
template <int Nodes>
void addPolygons(
  const MeshView& view, const CellBlock& block, Index begin, Index end, std::vector<Mark>& marks)
{
  constexpr int most = 16;
  std::uint64_t a[Nodes][most] = {}, edge[Nodes][most], sense[Nodes][most];
  for (; begin < end; begin += most)
  {
    const int count = static_cast<int>(std::min<Index>(most, end - begin));
    const Index* nodes[most];
    for (int l = 0; l < count; ++l)
    {
      nodes[l] = view.connectivity + view.offsets[block.cell(begin + l)];
      for (int k = 0; k < Nodes; ++k)
      {
        a[k][l] = static_cast<std::uint64_t>(nodes[l][k]);
      }
    }
    for (auto& of : a)
    {
      for (std::uint64_t& number : of)
      {
        number = SplitMix::mixed(number);
      }
    }
    for (int k = 0; k < Nodes; ++k)
    {
      for (int l = 0; l < most; ++l)
      {
        const std::uint64_t x = a[k][l], y = a[(k + 1) % Nodes][l];
        edge[k][l] = SplitMix::mixed(x + y);
        sense[k][l] = x * y * (x - y);
      }
    }
    for (int l = 0; l < count; ++l)
    {
      for (int k = 0; k < Nodes; ++k)
      {
        constexpr int last = Nodes - 1;
        Mark& mark = marks[nodes[l][k]];
        mark.parity ^= edge[k][l] ^ edge[(k + last) % Nodes][l];
        mark.sum += sense[k][l] + sense[(k + last) % Nodes][l];
      }
    }
  }
}

int dimensionOf(const Mesh& mesh)
{
  return mesh.dimension() == Dimension::Volume ? 3 : 2;
}

/// Calls visit(cell, its type, its nodes) for the `part`-th of `parts` parts of the cells of the
/// mesh dimension.
template <class Visit>
void forEachElementOfPart(const Mesh& mesh, Index part, Index parts, const Visit& visit)
{
  const MeshView& view = mesh.view();
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    const Index begin = block.count * part / parts, end = block.count * (part + 1) / parts;
    for (Index i = begin; t.dimension == dimensionOf(mesh) && i < end; ++i)
    {
      pollInterruption(i);
      visit(block.cell(i), t, view.connectivity + view.offsets[block.cell(i)]);
    }
  }
}

/// Adds the marks of the facets of the `part`-th of `parts` parts of the cells of each block.
void addMarksOfPart(const Mesh& mesh, int part, int parts, std::vector<Mark>& marks)
{
  const MeshView& view = mesh.view();
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    const Index begin = block.count * part / parts, end = block.count * (part + 1) / parts;
    for (Index i = begin; t.dimension == dimensionOf(mesh) && i < end; i += ChunkSize)
    {
      throwIfInterrupted();
      const Index next = std::min(end, i + ChunkSize);
      switch (t.type)
      {
        case CellType::Tetrahedron:
          addTetrahedra(view, block, i, next, marks);
          break;
        case CellType::Triangle:
          addPolygons<3>(view, block, i, next, marks);
          break;
        case CellType::Quadrilateral:
          addPolygons<4>(view, block, i, next, marks);
          break;
        default:
          for (Index k = i; k < next; ++k)
          {
            addMarks(t, view.connectivity + view.offsets[block.cell(k)], marks);
          }
      }
    }
  }
}

/// Each part has separate marks, which are then combined: sums modulo 2^64 and exclusive or do not
/// depend on their order.
std::vector<Mark> marksOf(const Mesh& mesh, int threads)
{
  const Index points = mesh.view().numberOfPoints;
  const int parts = numberOfParts(mesh.view().numberOfCells, threads);
  std::vector<std::vector<Mark>> marks(parts);
  parallelFor(parts, 1, threads,
    [&](Index part)
    {
      marks[part].resize(points);
      addMarksOfPart(mesh, static_cast<int>(part), parts, marks[part]);
    });
  forEachChunk(parts > 1 ? points : 0, threads,
    [&](Index, Index begin, Index end)
    {
      for (int part = 1; part < parts; ++part)
      {
        for (Index p = begin; p < end; ++p)
        {
          marks[0][p].parity ^= marks[part][p].parity;
          marks[0][p].sum += marks[part][p].sum;
        }
      }
    });
  return std::move(marks[0]);
}

/// A cell with a number that depends on its points only, not on their order.
struct KeyedCell
{
  std::uint64_t key;
  Index cell;
};

/// Adds the cells of a group that have the same points as a cell with a smaller id.
void addDuplicates(
  const Mesh& mesh, std::vector<KeyedCell>& cells, std::vector<DuplicateCell>& duplicates)
{
  const MeshView& view = mesh.view();
  std::sort(cells.begin(), cells.end(),
    [](const KeyedCell& a, const KeyedCell& b)
    { return a.key != b.key ? a.key < b.key : a.cell < b.cell; });
  const auto same = [&view](Index a, Index b)
  {
    const CellType type = cornerType(view.cellTypes[a]);
    const Index *first = view.connectivity + view.offsets[a],
                *second = view.connectivity + view.offsets[b];
    return type == cornerType(view.cellTypes[b]) &&
      std::is_permutation(first, first + topology(type).nodes, second);
  };
  for (std::size_t i = 0; i < cells.size();)
  {
    std::size_t j = i + 1;
    for (; j < cells.size() && cells[j].key == cells[i].key; ++j)
    {
      if (same(cells[i].cell, cells[j].cell))
      {
        duplicates.push_back({ cells[j].cell, cells[i].cell });
      }
    }
    i = j;
  }
}

/// The duplicate cells among the cells with at least `least` points that satisfy a condition.
template <class Condition>
std::vector<DuplicateCell> duplicatesWhere(
  const Mesh& mesh, int least, int threads, const Condition& condition)
{
  // Cells with the same key belong to one group, regardless of their part.
  const int parts = numberOfParts(mesh.view().numberOfCells, threads);
  using Groups = std::vector<std::vector<KeyedCell>>;
  std::vector<Groups> groups(parts, Groups(parts));
  parallelFor(parts, 1, threads,
    [&](Index part)
    {
      forEachElementOfPart(mesh, part, parts,
        [&](Index cell, const CellTopology& t, const Index* node)
        {
          if (std::count_if(node, node + t.nodes, condition) >= least)
          {
            std::uint64_t key = static_cast<std::uint64_t>(t.type);
            std::for_each(node, node + t.nodes,
              [&key](Index point) { key += SplitMix::mixed(static_cast<std::uint64_t>(point)); });
            groups[part][key % parts].push_back({ key, cell });
          }
        });
    });
  std::vector<std::vector<DuplicateCell>> found(parts);
  parallelFor(parts, 1, threads,
    [&](Index group)
    {
      std::vector<KeyedCell>& cells = groups[0][group];
      for (int part = 1; part < parts; ++part)
      {
        cells.insert(cells.end(), groups[part][group].begin(), groups[part][group].end());
      }
      addDuplicates(mesh, cells, found[group]);
    });
  std::vector<DuplicateCell> duplicates;
  for (const std::vector<DuplicateCell>& some : found)
  {
    duplicates.insert(duplicates.end(), some.begin(), some.end());
  }
  std::sort(duplicates.begin(), duplicates.end(),
    [](const DuplicateCell& a, const DuplicateCell& b) { return a.cell < b.cell; });
  return duplicates;
}
}

//------------------------------------------------------------------------------
MeshSkin findSkin(const Mesh& mesh, int threads)
{
  MeshSkin skin;
  std::vector<char>& boundary = skin.boundaryPoints;
  boundary.resize(mesh.view().numberOfPoints);
  bool& consistent = skin.consistent;
  {
    const std::vector<Mark> marks = marksOf(mesh, threads);
    std::transform(
      marks.begin(), marks.end(), boundary.begin(), [](const Mark& mark) { return mark.any(); });
    // Otherwise there are duplicate cells or cells with opposite point orders: the parity of their
    // two uses of a facet vanishes, but not the sum.
    consistent = std::all_of(marks.begin(), marks.end(),
      [](const Mark& mark) { return (mark.parity == 0) == (mark.sum == 0); });
  }
  // A region of duplicates is surrounded by facets of three cells, or of two cells with the same
  // orientation: their points are marked as if they were on a boundary. Such a facet of a volume
  // has at least three points.
  const int ofFacet = dimensionOf(mesh);
  const auto marked = [&boundary](Index point) { return boundary[point] != 0; };
  const bool closed = std::find(boundary.begin(), boundary.end(), 1) == boundary.end();
  if (!consistent || !duplicatesWhere(mesh, ofFacet, threads, marked).empty())
  {
    skin.duplicates = duplicatesWhere(mesh, 0, threads, [](Index) { return true; });
  }
  if (closed || !consistent || !skin.duplicates.empty() || mesh.dimension() == Dimension::Surface)
  {
    boundary = mesh.boundary().isBoundaryPoint;
  }
  return skin;
}

//------------------------------------------------------------------------------
std::vector<char> boundaryPoints(const Mesh& mesh, int threads)
{
  // On surfaces, more than two cells often meet at an edge, which can only be detected from the
  // facets.
  return mesh.dimension() == Dimension::Surface ? mesh.boundary().isBoundaryPoint
                                                : findSkin(mesh, threads).boundaryPoints;
}
}
