#include "Mesh.h"

#include "Batch.h"
#include "FacetTable.h"
#include "Parallel.h"

#include <Eigen/Eigenvalues>

#include <atomic>
#include <limits>
#include <numeric>
#include <sstream>

namespace tautline
{
namespace
{
/// A mesh is planar when no vertex leaves its plane by more than this part of the mesh's diagonal.
constexpr double planarTolerance = 1e-6;

std::string cellMessage(Index cell, const std::string& what)
{
  return "Cell " + std::to_string(cell) + " " + what;
}
}

//------------------------------------------------------------------------------
Mesh::Mesh(const MeshView& view, int threads)
  : View(view)
{
  if (view.numberOfPoints < 0 || view.numberOfCells < 0 ||
    (view.numberOfPoints > 0 && !view.points) ||
    (view.numberOfCells > 0 && (!view.cellTypes || !view.offsets || !view.connectivity)))
  {
    throw Error("The mesh view is incomplete: points, cell types, offsets and connectivity are "
                "all needed.");
  }

  // One pass finds which of the 256 types occur, so that a mesh of one type needs no id lists.
  std::array<Index, 256> histogram{};
  for (Index i = 0; i < view.numberOfCells; ++i)
  {
    if (view.offsets[i] < 0 || view.offsets[i + 1] < view.offsets[i])
    {
      throw Error(cellMessage(i, "has no proper place in the connectivity: its offsets descend."));
    }
    ++histogram[view.cellTypes[i]];
  }
  std::array<Index, NumberOfCellTypes> counts{};
  std::array<int, 256> blockOfType;
  for (int type = 0; type < 256; ++type)
  {
    blockOfType[type] = topologyIndex(cornerType(type));
    if (blockOfType[type] >= 0)
    {
      counts[blockOfType[type]] += histogram[type];
      this->HigherOrder += isHigherOrder(type) ? histogram[type] : 0;
    }
    else
    {
      this->Unsupported += histogram[type];
    }
  }
  for (int b = 0; b < NumberOfCellTypes; ++b)
  {
    if (counts[b] == 0)
    {
      continue;
    }
    CellBlock block;
    block.type = topologies()[b].type;
    block.count = counts[b];
    if (counts[b] < view.numberOfCells)
    {
      block.cells.reserve(counts[b]);
      for (Index i = 0; i < view.numberOfCells; ++i)
      {
        if (blockOfType[view.cellTypes[i]] == b)
        {
          block.cells.push_back(i);
        }
      }
    }
    this->Blocks.push_back(std::move(block));
  }

  for (const CellBlock& block : this->Blocks)
  {
    const int nodes = topology(block.type).nodes;
    std::atomic<Index> wrong{ -1 };
    forEachChunk(block.count, threads,
      [&](Index, Index begin, Index end)
      {
        for (Index i = begin; i < end; ++i)
        {
          const Index cell = block.cell(i);
          const Index first = view.offsets[cell];
          bool good = first >= 0 && view.offsets[cell + 1] - first >= nodes;
          for (int k = 0; good && k < nodes; ++k)
          {
            const Index node = view.connectivity[first + k];
            good = node >= 0 && node < view.numberOfPoints;
          }
          Index least = wrong; // of several the one with the smallest id is reported
          while (!good && (least < 0 || cell < least))
          {
            good = wrong.compare_exchange_weak(least, cell);
          }
        }
      });
    if (wrong >= 0)
    {
      throw Error(cellMessage(wrong,
        std::string("is not a proper ") + topology(block.type).name +
          ": it lists too few points or a point id that is not in the mesh. Check the file or the "
          "connectivity array."));
    }
  }

  for (Index i = 0; i < view.numberOfPoints; ++i)
  {
    const Vec3 p = pointOf(view, i);
    this->NonFinitePoints += !(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]));
  }

  bool flat = false, solid = false;
  for (const CellBlock& block : this->Blocks)
  {
    (topology(block.type).dimension == 2 ? flat : solid) = true;
  }
  this->Dim = solid ? Dimension::Volume : flat ? Dimension::Surface : Dimension::None;
  if (this->Dim == Dimension::Surface)
  {
    this->findPlane(threads);
  }
}

//------------------------------------------------------------------------------
void Mesh::findPlane(int threads)
{
  // Principal directions of the corners of the cells; unused and non-finite points do not count.
  Vec3 low, high;
  low.fill(std::numeric_limits<double>::max());
  high.fill(-std::numeric_limits<double>::max());
  auto forEachCorner = [&](auto visit)
  {
    for (const CellBlock& block : this->Blocks)
    {
      const int nodes = topology(block.type).nodes;
      for (Index i = 0; i < block.count; ++i)
      {
        const Index* node = this->View.connectivity + this->View.offsets[block.cell(i)];
        for (int k = 0; k < nodes; ++k)
        {
          const Vec3 p = pointOf(this->View, node[k]);
          if (std::isfinite(p[0] + p[1] + p[2]))
          {
            visit(p);
          }
        }
      }
    }
  };
  forEachCorner(
    [&](const Vec3& p)
    {
      for (int c = 0; c < 3; ++c)
      {
        low[c] = std::min(low[c], p[c]);
        high[c] = std::max(high[c], p[c]);
      }
    });
  if (low[0] > high[0])
  {
    return;
  }
  const Vec3 extent = high - low;
  const double diagonal = norm(extent);
  if (!(diagonal > 0) || !std::isfinite(diagonal))
  {
    return;
  }

  int axis = -1;
  for (int c = 0; c < 3; ++c)
  {
    // A plane at right angles to an axis is taken exactly, without rounding in the frame.
    if (extent[c] <= planarTolerance * diagonal)
    {
      axis = c;
    }
  }
  Vec3 normal = { 0, 0, 0 };
  if (axis >= 0)
  {
    normal[axis] = 1.0;
  }
  else
  {
    const Vec3 middle = 0.5 * (low + high);
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Index count = 0;
    forEachCorner(
      [&](const Vec3& p)
      {
        const Vec3 r = (1.0 / diagonal) * (p - middle);
        const Eigen::Vector3d v(r[0], r[1], r[2]);
        moments += v * v.transpose();
        sum += v;
        ++count;
      });
    const Eigen::Vector3d mean = sum / static_cast<double>(count);
    moments = moments / static_cast<double>(count) - mean * mean.transpose();
    const Eigen::Vector3d n =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvectors().col(0);
    const Vec3 center = middle + diagonal * Vec3{ mean[0], mean[1], mean[2] };
    normal = { n[0], n[1], n[2] };
    double farthest = 0.0;
    forEachCorner(
      [&](const Vec3& p) { farthest = std::max(farthest, std::abs(dot(p - center, normal))); });
    if (farthest > planarTolerance * diagonal)
    {
      return;
    }
  }
  (void)threads;

  int largest = 0;
  for (int c = 1; c < 3; ++c)
  {
    largest = std::abs(normal[c]) > std::abs(normal[largest]) ? c : largest;
  }
  if (normal[largest] < 0)
  {
    normal = -1.0 * normal;
  }
  Vec3 first = { 0, 0, 0 };
  first[(largest + 1) % 3] = 1.0;
  first -= dot(first, normal) * normal;
  first = (1.0 / norm(first)) * first;
  this->Dim = Dimension::Planar;
  this->Normal = normal;
  this->Frame = { first, cross(normal, first) };
}

//------------------------------------------------------------------------------
Vec3 Mesh::center(Index cell, CellType type) const
{
  const int nodes = topology(type).nodes;
  const Index* node = this->View.connectivity + this->View.offsets[cell];
  Vec3 sum = { 0, 0, 0 };
  for (int k = 0; k < nodes; ++k)
  {
    sum += pointOf(this->View, node[k]);
  }
  return (1.0 / nodes) * sum;
}

//------------------------------------------------------------------------------
Validity Mesh::classifyCell(const CellTopology& t, const Vec3* p, const Vec3* against) const
{
  const bool surface = t.dimension == 2 && this->Dim != Dimension::Planar;
  const double sign = this->Mirrored && !surface ? -1.0 : 1.0;
  Vec3 normal = against ? *against : this->Normal;
  if (surface && !against)
  {
    // A surface quadrilateral is judged against its own mean normal.
    normal = vectorArea(t, p);
    const double length = norm(normal);
    normal = length > 0 ? (1.0 / length) * normal : normal;
  }
  Validity verdict = Valid;
  for (int c = 0; c < t.samples; ++c)
  {
    const auto& corner = t.cornerNodes[c];
    const Vec3 a = p[corner[1]] - p[corner[0]];
    const Vec3 b = p[corner[2]] - p[corner[0]];
    double det = 0, scale = norm(a) * norm(b);
    if (t.dimension == 2)
    {
      det = dot(cross(a, b), normal);
    }
    else
    {
      const Vec3 d = p[corner[3]] - p[corner[0]];
      det = dot(a, cross(b, d));
      scale *= norm(d);
    }
    det *= sign;
    if (!std::isfinite(scale))
    {
      return NonFinite;
    }
    if (std::abs(det) <= degenerateTolerance() * scale)
    {
      verdict = std::min(verdict, Degenerate);
    }
    else if (det < 0)
    {
      verdict = Inverted;
    }
  }
  return verdict;
}

namespace
{
/// Whether all cells of a batch are valid beyond doubt; what is near a limit is left to classifyCell().
bool clearlyValid(const Mesh& mesh, const CellTopology& t, const Batch& batch)
{
  constexpr double margin = 2, smallest = 1e-200, largest = 1e200;
  constexpr double tolerance = margin * Mesh::degenerateTolerance();
  Packet normal[3];
  for (int c = 0; c < 3; ++c)
  {
    normal[c] = broadcast((mesh.mirrored() ? -1.0 : 1.0) * mesh.normal()[c]);
  }
  Mask valid = ~Mask{};
  for (int s = 0; s < t.samples; ++s)
  {
    const auto& corner = t.cornerNodes[s];
    Packet a[3], b[3], d[3], ab[3];
    subtract(batch.points[corner[1]], batch.points[corner[0]], a);
    subtract(batch.points[corner[2]], batch.points[corner[0]], b);
    cross(a, b, ab);
    Packet det = dot(ab, normal), lengths2 = dot(a, a) * dot(b, b);
    if (t.dimension == 3)
    {
      subtract(batch.points[corner[3]], batch.points[corner[0]], d);
      det = dot(ab, d);
      lengths2 *= dot(d, d);
    }
    valid &= (det > 0.0) & (det * det > tolerance * tolerance * lengths2) & (lengths2 > smallest) &
      (lengths2 < largest);
  }
  return !any(~valid);
}
}

//------------------------------------------------------------------------------
void Mesh::classifyCells(signed char* validity, int threads) const
{
  if (this->Unsupported > 0)
  {
    std::fill(validity, validity + this->View.numberOfCells, NotMeasured);
  }
  for (const CellBlock& block : this->Blocks)
  {
    const CellTopology& t = topology(block.type);
    const BatchContext context = { this, &block, &t, nullptr, false };
    const bool surface = t.dimension == 2 && this->Dim != Dimension::Planar;
    withNodes(t,
      [&](auto nodesOfCell)
      {
        constexpr int Nodes = decltype(nodesOfCell)::value;
        forEachChunk(block.count, threads,
          [&](Index, Index begin, Index end)
          {
            Batch batch;
            BatchNodes nodes;
            for (Index i = begin; i < end; i += PacketWidth)
            {
              const int count = static_cast<int>(std::min<Index>(PacketWidth, end - i));
              gather<Nodes>(context, nullptr, i, count, batch, nodes);
              const bool allValid = !surface && clearlyValid(*this, t, batch);
              for (int l = 0; l < count; ++l)
              {
                Vec3 p[MaxNodes];
                for (int k = 0; !allValid && k < Nodes; ++k)
                {
                  p[k] = pointOf(this->View, nodes[l][k]);
                }
                validity[batch.cells[l]] = allValid ? Valid : this->classifyCell(t, p);
              }
            }
          });
      });
  }
}

//------------------------------------------------------------------------------
Boundary Mesh::boundary() const
{
  Boundary result;
  result.isBoundaryPoint.assign(this->View.numberOfPoints, 0);
  FacetTable(*this).forEachFacet(
    [&](Index smallest, const FacetUse* uses, Index count)
    {
      result.nonManifold += count > 2;
      // Facets of three or more cells count as boundary too: moving them is nobody's to decide.
      if (count != 2)
      {
        result.facets += count == 1;
        result.isBoundaryPoint[smallest] = 1;
        for (Index node : uses->others)
        {
          if (node >= 0)
          {
            result.isBoundaryPoint[node] = 1;
          }
        }
      }
    });
  return result;
}

//------------------------------------------------------------------------------
VertexCells Mesh::vertexCells() const
{
  VertexCells result;
  result.offsets.assign(this->View.numberOfPoints + 1, 0);
  auto forEachUse = [&](auto visit)
  {
    for (const CellBlock& block : this->Blocks)
    {
      const int nodes = topology(block.type).nodes;
      for (Index i = 0; i < block.count; ++i)
      {
        const Index cell = block.cell(i);
        const Index* node = this->View.connectivity + this->View.offsets[cell];
        for (int k = 0; k < nodes; ++k)
        {
          visit(node[k], cell);
        }
      }
    }
  };
  forEachUse([&](Index node, Index) { ++result.offsets[node + 1]; });
  std::partial_sum(result.offsets.begin(), result.offsets.end(), result.offsets.begin());
  result.cells.resize(result.offsets.back());
  std::vector<Index> next(result.offsets.begin(), result.offsets.end() - 1);
  forEachUse([&](Index node, Index cell) { result.cells[next[node]++] = cell; });
  if (this->Blocks.size() > 1)
  {
    for (Index v = 0; v < this->View.numberOfPoints; ++v)
    {
      std::sort(
        result.cells.begin() + result.offsets[v], result.cells.begin() + result.offsets[v + 1]);
    }
  }
  return result;
}

namespace
{
/**
 * Signed area or volume of a cell with its faces cut into triangles about their centres, so that the sum
 * over a mesh whose cells agree depends on its boundary only, however tangled its inside. Seen from one origin for all
 * cells, what an inner edge or face adds cancels to the last digit.
 */
double signedSize(const Mesh& mesh, const CellTopology& t, const Index* node, const Vec3& origin)
{
  const MeshView& view = mesh.view();
  Vec3 p[MaxNodes];
  for (int k = 0; k < t.nodes; ++k)
  {
    p[k] = pointOf(view, node[k]) - origin;
  }
  if (t.dimension == 2)
  {
    Vec3 area = { 0, 0, 0 };
    for (int k = 0; k < t.nodes; ++k)
    {
      area += cross(p[k], p[(k + 1) % t.nodes]);
    }
    return 0.5 * dot(mesh.normal(), area);
  }
  double sum = 0;
  for (int f = 0; f < t.faces; ++f)
  {
    const int size = t.faceSizes[f];
    Vec3 center = { 0, 0, 0 };
    for (int k = 0; k < size; ++k)
    {
      center += (1.0 / size) * p[t.faceNodes[f][k]];
    }
    for (int k = 0; k < size; ++k)
    {
      sum += dot(center, cross(p[t.faceNodes[f][k]], p[t.faceNodes[f][(k + 1) % size]])) / 6;
    }
  }
  return sum;
}
}

//------------------------------------------------------------------------------
Orientation Mesh::orientation(const signed char* validity) const
{
  Orientation result;
  const int dimension = this->Dim == Dimension::Volume ? 3 : 2;
  Index cells = 0;
  for (const CellBlock& block : this->Blocks)
  {
    if (topology(block.type).dimension == dimension)
    {
      cells += block.count;
      for (Index i = 0; i < block.count; ++i)
      {
        result.positiveCells += validity[block.cell(i)] == Valid;
        result.negativeCells += validity[block.cell(i)] == Inverted;
      }
    }
  }
  if (cells == 0)
  {
    return result;
  }
  const bool haveSigns = this->Dim != Dimension::Surface;
  if (haveSigns && result.negativeCells == 0)
  {
    return result;
  }
  if (haveSigns && result.positiveCells == 0)
  {
    result.state = Orientation::Reversed;
    return result;
  }

  // Signs differ (a tangled or a mixed mesh), or there are none (a surface): look at neighbours.
  std::vector<Index> parent(this->View.numberOfCells);
  std::iota(parent.begin(), parent.end(), Index(0));
  auto find = [&](Index cell)
  {
    while (parent[cell] != cell)
    {
      cell = parent[cell] = parent[parent[cell]];
    }
    return cell;
  };
  FacetTable(*this).forEachFacet(
    [&](Index, const FacetUse* uses, Index count)
    {
      if (count == 2)
      {
        result.disagreeing += uses[0].forward == uses[1].forward;
        parent[find(uses[0].cell)] = find(uses[1].cell);
      }
    });

  // The signed size of a part tells, tangled or not; where it is lost to rounding (a vertex far out), the majority.
  struct Part
  {
    double sum = 0, magnitude = 0;
    Index majority = 0; // positive less inverted cells
  };
  std::vector<Part> parts(this->View.numberOfCells);
  Vec3 origin = { 0, 0, 0 };
  for (Index i = 0; i < this->View.numberOfPoints; ++i)
  {
    origin = pointOf(this->View, i);
    if (std::isfinite(dot(origin, origin)))
    {
      break;
    }
  }
  for (const CellBlock& block : this->Blocks)
  {
    if (topology(block.type).dimension == dimension)
    {
      for (Index i = 0; i < block.count; ++i)
      {
        const Index cell = block.cell(i);
        if (haveSigns && validity[cell] >= Inverted) // flat ones, too: they may be long
        {
          const double size = signedSize(*this, topology(block.type),
            this->View.connectivity + this->View.offsets[cell], origin);
          Part& part = parts[find(cell)];
          part.sum += size;
          part.magnitude += std::abs(size);
          part.majority += validity[cell]; // 1, 0 or -1
        }
        result.parts += find(cell) == cell;
      }
    }
  }
  if (haveSigns)
  {
    constexpr double rounding = 1e-9;
    const double sign = this->Mirrored ? -1 : 1;
    result.reversedParts = std::count_if(parts.begin(), parts.end(),
      [=](const Part& p)
      { return std::abs(p.sum) > rounding * p.magnitude ? sign * p.sum < 0 : p.majority < 0; });
  }
  if (result.disagreeing > 0 || (result.reversedParts > 0 && result.reversedParts < result.parts))
  {
    result.state = Orientation::Mixed;
  }
  else if (result.reversedParts > 0)
  {
    result.state = Orientation::Reversed;
  }
  return result;
}
}
