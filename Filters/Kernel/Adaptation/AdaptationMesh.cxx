// SPDX-License-Identifier: BSD-3-Clause
#include "AdaptationMesh.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Core/Parallel.h"
#include "tautline/Mesh/CoordinateOrder.h"
#include "tautline/Mesh/MeshElements.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace tautline
{
namespace
{
/// Calls visit(cell, facts of its type) for the elements.
template <class Visit>
void forEachElementOf(const Mesh& mesh, const Visit& visit)
{
  for (const CellBlock& block : mesh.blocks())
  {
    if (isElement(mesh, block.type))
    {
      const CellTopology& t = topology(block.type);
      for (Index i = 0; i < block.count; ++i)
      {
        pollInterruption(i);
        visit(block.cell(i), t);
      }
    }
  }
}

/// The sort key of elements; ties are broken by their points.
struct ElementKey
{
  Index least, sum; ///< of its points
  Index cell;
  int nodes;
};

/// The volume of a cell, with faces of four points divided from their centers.
double volumeOfCell(const CellTopology& t, const Vec3* p)
{
  Vec3 center = { 0, 0, 0 };
  for (int k = 0; k < t.nodes; ++k)
  {
    center += (1.0 / t.nodes) * p[k];
  }
  double volume = 0.0;
  for (int f = 0; f < t.faces; ++f)
  {
    const int size = t.faceSizes[f];
    Vec3 middle = { 0, 0, 0 };
    for (int k = 0; k < size; ++k)
    {
      middle += (1.0 / size) * (p[t.faceNodes[f][k]] - center);
    }
    for (int k = 0; k < size; ++k)
    {
      const Vec3 a = p[t.faceNodes[f][k]] - center;
      const Vec3 b = p[t.faceNodes[f][(k + 1) % size]] - center;
      volume += dot(middle, cross(a, b)) / 6.0;
    }
  }
  return std::abs(volume);
}

void cornersOf(const MeshView& view, Index cell, int nodes, std::array<Vec3, MaxNodes>& corners)
{
  for (int k = 0; k < nodes; ++k)
  {
    corners[k] = pointOf(view, view.connectivity[view.offsets[cell] + k]);
  }
}
}

//------------------------------------------------------------------------------
AdaptationMesh::AdaptationMesh(const Mesh& mesh, const std::vector<Index>& representative,
  const unsigned char* skip, int threads)
  : Dim(mesh.dimension() == Dimension::Volume ? 3 : 2)
  , Threads(threads)
{
  this->takePoints(mesh, representative);
  this->takeElements(mesh, skip);
  MeshView view;
  view.numberOfPoints = this->numberOfPoints();
  view.points = this->Coordinates.data();
  view.numberOfCells = static_cast<Index>(this->Types.size());
  view.cellTypes = this->Types.data();
  view.offsets = this->Offsets.data();
  view.connectivity = this->Connectivity.data();
  this->Elements = std::make_unique<Mesh>(view, threads);
  this->Around = this->Elements->vertexCells();
  this->measure();
  this->findNeighbors();
  if (this->Dim == 2)
  {
    this->findNormals();
  }
}

//------------------------------------------------------------------------------
void AdaptationMesh::takePoints(const Mesh& mesh, const std::vector<Index>& representative)
{
  const MeshView& view = mesh.view();
  // The points of elements come first.
  this->Places = coordinateOrder(mesh, view.points, representative);
  Index count = 0;
  forEachElementOf(mesh,
    [&](Index cell, const CellTopology& t)
    {
      const Index* node = view.connectivity + view.offsets[cell];
      for (int k = 0; k < t.nodes; ++k)
      {
        const Vec3 x = pointOf(view, node[k]);
        if (!std::isfinite(x[0]) || !std::isfinite(x[1]) || !std::isfinite(x[2]))
        {
          throw Error("Point " + std::to_string(node[k]) +
            " has a coordinate that is not a finite number: remove its cells.");
        }
        count = std::max(count, this->Places[node[k]] + 1);
      }
    });
  if (count == 0)
  {
    throw Error("The mesh has no elements: provide a mesh of triangles, quadrilaterals, "
                "tetrahedra, hexahedra, wedges or pyramids.");
  }
  this->Origins.assign(count, -1);
  this->Coordinates.resize(3 * count);
  for (Index p = view.numberOfPoints - 1; p >= 0; --p)
  {
    pollInterruption(p);
    Index& place = this->Places[p];
    place = place < count ? place : -1;
    if (place >= 0)
    {
      this->Origins[place] = p; // the first of merged points
      std::copy_n(view.points + 3 * p, 3, &this->Coordinates[3 * place]);
    }
  }
}

//------------------------------------------------------------------------------
void AdaptationMesh::takeElements(const Mesh& mesh, const unsigned char* skip)
{
  const MeshView& view = mesh.view();
  const auto placesOf = [&](const ElementKey& key)
  {
    std::array<Index, MaxNodes> places = {};
    for (int k = 0; k < key.nodes; ++k)
    {
      places[k] = this->Places[view.connectivity[view.offsets[key.cell] + k]];
    }
    return places;
  };
  std::vector<ElementKey> keys;
  forEachElementOf(mesh,
    [&](Index cell, const CellTopology& t)
    {
      ElementKey key = { 0, 0, cell, t.nodes };
      const std::array<Index, MaxNodes> places = placesOf(key);
      key.least = *std::min_element(places.begin(), places.begin() + t.nodes);
      key.sum = std::accumulate(places.begin(), places.begin() + t.nodes, Index(0));
      keys.push_back(key);
    });
  // An order that depends on coordinates only makes sums independent of the numbering of the input.
  std::sort(keys.begin(), keys.end(),
    [&](const ElementKey& a, const ElementKey& b)
    {
      if (a.least != b.least || a.sum != b.sum || a.nodes != b.nodes)
      {
        return std::tie(a.least, a.sum, a.nodes) < std::tie(b.least, b.sum, b.nodes);
      }
      // The places that an element does not use are 0 in both.
      std::array<Index, MaxNodes> ofA = placesOf(a), ofB = placesOf(b);
      std::sort(ofA.begin(), ofA.end());
      std::sort(ofB.begin(), ofB.end());
      return ofA < ofB;
    });
  this->Offsets = { 0 };
  for (const ElementKey& key : keys)
  {
    pollInterruption(static_cast<Index>(this->Types.size()));
    const std::array<Index, MaxNodes> places = placesOf(key);
    this->Connectivity.insert(this->Connectivity.end(), places.begin(), places.begin() + key.nodes);
    this->Offsets.push_back(static_cast<Index>(this->Connectivity.size()));
    this->Types.push_back(static_cast<unsigned char>(cornerType(view.cellTypes[key.cell])));
    this->Skip.push_back(skip && skip[key.cell]);
  }
}

//------------------------------------------------------------------------------
void AdaptationMesh::measure()
{
  const MeshView& view = this->Elements->view();
  this->Sizes.assign(view.numberOfCells, 0.0);
  this->Volumes.assign(view.numberOfPoints, 0.0);
  this->IdealVolumes = this->Volumes;
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    pollInterruption(cell);
    const CellTopology& t = topology(static_cast<CellType>(view.cellTypes[cell]));
    std::array<Vec3, MaxNodes> corners;
    cornersOf(view, cell, t.nodes, corners);
    this->Sizes[cell] = t.dimension == 2 ? 0.5 * norm(vectorArea(t, corners.data()))
                                         : volumeOfCell(t, corners.data());
    // Skipped elements complete the neighborhoods but do not count in integrals.
    const double share = this->Skip[cell] ? 0.0 : this->Sizes[cell] / t.nodes;
    // The edges of the ideal element have length 1, so that this factor is 1 / det W.
    const double ideal = t.sizePerDeterminant / t.scaledJacobianFactor;
    for (int k = 0; k < t.nodes; ++k)
    {
      const Index p = view.connectivity[view.offsets[cell] + k];
      this->Volumes[p] += share;
      this->IdealVolumes[p] += share / ideal;
    }
  }
}

//------------------------------------------------------------------------------
void AdaptationMesh::findNeighbors()
{
  const MeshView& view = this->Elements->view();
  const Index count = view.numberOfPoints;
  this->NeighborStarts.assign(count + 1, 0);
  std::vector<std::vector<Index>> parts(numberOfChunks(count));
  forEachChunk(count, this->Threads,
    [&](Index chunk, Index begin, Index end)
    {
      std::vector<Index> found;
      for (Index p = begin; p < end; ++p)
      {
        found.clear();
        for (const Index cell : this->elements(p))
        {
          found.insert(found.end(), view.connectivity + view.offsets[cell],
            view.connectivity + view.offsets[cell + 1]);
        }
        std::sort(found.begin(), found.end());
        found.erase(std::unique(found.begin(), found.end()), found.end());
        found.erase(std::remove(found.begin(), found.end(), p), found.end());
        this->NeighborStarts[p + 1] = static_cast<Index>(found.size());
        parts[chunk].insert(parts[chunk].end(), found.begin(), found.end());
      }
    });
  std::partial_sum(
    this->NeighborStarts.begin(), this->NeighborStarts.end(), this->NeighborStarts.begin());
  this->Neighbors.reserve(this->NeighborStarts.back());
  for (const std::vector<Index>& part : parts)
  {
    this->Neighbors.insert(this->Neighbors.end(), part.begin(), part.end());
  }
}

//------------------------------------------------------------------------------
void AdaptationMesh::findNormals()
{
  // Where facet normals cancel, as on a folded surface, the normal of the largest facet is used.
  constexpr double cancelled = 1e-6;
  const MeshView& view = this->Elements->view();
  const Vec3& plane = this->Elements->normal();
  this->Normals.assign(view.numberOfPoints, norm(plane) > 0.0 ? plane : Vec3{ 0, 0, 1 });
  if (this->Elements->dimension() == Dimension::Planar)
  {
    return;
  }
  forEachChunk(view.numberOfPoints, this->Threads,
    [&](Index, Index begin, Index end)
    {
      for (Index p = begin; p < end; ++p)
      {
        Vec3 sum = { 0, 0, 0 }, largest = { 0, 0, 0 };
        double total = 0.0;
        for (const Index cell : this->elements(p))
        {
          const CellTopology& t = topology(static_cast<CellType>(view.cellTypes[cell]));
          std::array<Vec3, MaxNodes> corners;
          cornersOf(view, cell, t.nodes, corners);
          const Vec3 area = vectorArea(t, corners.data());
          sum += area;
          total += norm(area);
          largest = norm(area) > norm(largest) ? area : largest;
        }
        sum = norm(sum) > cancelled * total ? sum : largest;
        this->Normals[p] = total > 0.0 ? (1.0 / norm(sum)) * sum : Vec3{ 0, 0, 1 };
      }
    });
}

//------------------------------------------------------------------------------
std::vector<double> AdaptationMesh::taken(const double* values, int components) const
{
  std::vector<double> result(components * this->Origins.size());
  for (std::size_t p = 0; p < this->Origins.size(); ++p)
  {
    pollInterruption(static_cast<Index>(p));
    std::copy_n(values + components * this->Origins[p], components, &result[components * p]);
  }
  return result;
}

//------------------------------------------------------------------------------
std::vector<double> AdaptationMesh::given(
  const std::vector<MetricTensor>& metrics, const MetricTensor& other) const
{
  std::vector<double> result;
  result.reserve(other.size() * this->Places.size());
  for (const Index place : this->Places)
  {
    const MetricTensor& m = place < 0 ? other : metrics[place];
    result.insert(result.end(), m.begin(), m.end());
  }
  return result;
}
}
