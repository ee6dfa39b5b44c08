// SPDX-License-Identifier: BSD-3-Clause
#include "ReconnectionInput.h"

#include "Constants.h"
#include "tautline/Core/Memory.h"
#include "tautline/Core/Parallel.h"

#include <limits>
#include <numeric>

namespace tautline
{
namespace
{
/// The memory for mesh, workspace and result.
constexpr double BytesPerTetrahedron = 250.0;
/// The additional memory for blocks.
constexpr double BlockBytesPerTetrahedron = 110.0;
constexpr double LargestTargetAngle = 60.0, LargestFlatAngle = 1.0;
constexpr double LargestFeatureAngle = 180.0, LargestSurfaceAngle = 90.0;

void requireTetrahedra(const Mesh& mesh)
{
  const MeshView& view = mesh.view();
  Index others = view.numberOfCells;
  for (const CellBlock& block : mesh.blocks())
  {
    others -= block.type == CellType::Tetrahedron ? block.count : 0;
  }
  if (mesh.higherOrderCells() > 0)
  {
    throw Error(std::to_string(mesh.higherOrderCells()) +
      " cells of higher order: reconnection requires linear tetrahedra. Run Curve Mesh with "
      "order 1 first, and with the original order on the result");
  }
  if (others > 0)
  {
    throw Error(std::to_string(others) +
      " cells are not tetrahedra: reconnection requires tetrahedra; extract them, or run "
      "Tetrahedralize first");
  }
  if (mesh.nonFinitePoints() > 0)
  {
    throw Error(std::to_string(mesh.nonFinitePoints()) +
      " points have a NaN or infinite coordinate: repair or remove them first");
  }
  // Faces are coded in 31 bits.
  if (view.numberOfCells > std::numeric_limits<std::int32_t>::max() / 8 ||
    view.numberOfPoints > std::numeric_limits<std::int32_t>::max() / 2)
  {
    throw Error("reconnection supports at most 268 million tetrahedra: split the mesh into parts");
  }
}

}

std::vector<std::int32_t> renumberRegions(const Index* regions, Index count)
{
  std::vector<std::int32_t> result(regions ? count : 0);
  if (!regions)
  {
    return result;
  }
  std::vector<Index> known(regions, regions + count);
  std::sort(known.begin(), known.end());
  known.erase(std::unique(known.begin(), known.end()), known.end());
  for (Index i = 0; i < count; ++i)
  {
    result[i] = static_cast<std::int32_t>(
      std::lower_bound(known.begin(), known.end(), regions[i]) - known.begin());
  }
  return result;
}

double targetQuality(const ReconnectionOptions& options)
{
  return options.adapt ? AdaptedQuality : std::sin(radians(options.targetAngle));
}

void checkReconnectionOptions(const ReconnectionOptions& options)
{
  const auto check = [](bool holds, const char* message)
  {
    if (!holds)
    {
      throw Error(message);
    }
  };
  check(options.targetAngle > 0.0 && options.targetAngle <= LargestTargetAngle,
    "the target angle must be above 0 and at most 60 degrees");
  check(options.boundary != BoundaryMotion::Free,
    "the boundary cannot move freely: it must be fixed, or slide on flat or smooth parts");
  check(options.flatAngle >= 0.0 && options.flatAngle <= LargestFlatAngle,
    "the flat angle must be from 0 to 1 degree");
  check(options.featureAngle >= 0.0 && options.featureAngle <= LargestFeatureAngle,
    "the feature angle must be 0 to 180 degrees");
  check(options.surfaceAngle >= 0.0 && options.surfaceAngle <= LargestSurfaceAngle,
    "the surface angle must be 0 to 90 degrees");
  check(options.surfaceTolerance >= 0.0 && options.surfaceTolerance <= 1.0,
    "the surface tolerance must be 0 to 1 times the diagonal of the mesh");
  check(options.smallestCount >= 0.0 && options.smallestCount <= 1.0,
    "the smallest count must be from 0 to 1 times the input count");
  check(options.largestCount >= 1.0 && std::isfinite(options.largestCount),
    "the largest count must be finite and at least 1 times the input count");
  check(options.size != ReconnectionSize::Length ||
      (options.edgeLength > 0.0 && std::isfinite(options.edgeLength)),
    "the target length of edges must be above 0");
  check(!options.adapt || options.size != ReconnectionSize::None,
    "an adaptation needs target lengths of edges: specify a length, or an array of lengths or "
    "metric tensors");
  check(options.edgeFactor > 1.0, "the factor of the lengths of edges must be above 1");
  check(options.blockSize >= 1, "the size of blocks must be at least 1");
  check(!(options.maximumSeconds < 0.0), "the time limit must not be negative");
}

ReconnectionInput convertInput(const Mesh& mesh, const ReconnectionOptions& options)
{
  requireTetrahedra(mesh);
  const MeshView& view = mesh.view();
  const bool inBlocks = view.numberOfCells >= 2 * options.blockSize;
  requireMemory((BytesPerTetrahedron + (inBlocks ? BlockBytesPerTetrahedron : 0.0)) *
      static_cast<double>(view.numberOfCells),
    "reconnection of this mesh", "use a smaller mesh");
  std::vector<signed char> validity(view.numberOfCells);
  mesh.classifyCells(validity.data(), options.threads);
  // Flat tetrahedra with four distinct corners are the worst ones, which are improved first.
  const auto isFlat = [&view](Index cell)
  {
    const Index* v = view.connectivity + view.offsets[cell];
    const CellTopology& t = topology(CellType::Tetrahedron);
    return std::all_of(t.edgeNodes.begin(), t.edgeNodes.begin() + t.edges,
      [&](const std::array<int, 2>& edge)
      { return norm(pointOf(view, v[edge[1]]) - pointOf(view, v[edge[0]])) > 0; });
  };
  Index inverted = 0;
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    inverted += validity[cell] != Valid && !(validity[cell] == Degenerate && isFlat(cell));
  }
  if (inverted > 0)
  {
    throw Error(std::to_string(inverted) +
      " inverted or degenerate tetrahedra: run Untangle Mesh first (or reorient the cells, if all "
      "are reversed)");
  }
  ReconnectionInput input;
  double largest = 0.0;
  for (Index n = 0; n < view.offsets[view.numberOfCells]; ++n)
  {
    const double* x = view.points + 3 * view.connectivity[n];
    largest = std::max({ largest, std::abs(x[0]), std::abs(x[1]), std::abs(x[2]) });
  }
  // Scaling by a power of two is exact; the largest coordinate is then between 1/2 and 1.
  std::frexp(largest, &input.exponent);
  input.points.resize(view.numberOfPoints);
  for (Index i = 0; i < 3 * view.numberOfPoints; ++i)
  {
    input.points[i / 3][i % 3] = std::ldexp(view.points[i], -input.exponent);
  }
  input.cells.resize(view.numberOfCells);
  for (Index c = 0; c < view.numberOfCells; ++c)
  {
    const Index* v = view.connectivity + view.offsets[c];
    for (int k = 0; k < 4; ++k)
    {
      input.cells[c][k] = static_cast<PointId>(v[k]);
    }
    // In a mirrored mesh, valid cells are negative: exchanging two corners makes them positive.
    if (mesh.mirrored())
    {
      std::swap(input.cells[c][2], input.cells[c][3]);
    }
  }
  input.regions = renumberRegions(options.regions, view.numberOfCells);
  if (options.outside)
  {
    input.regions.resize(view.numberOfCells, 0);
    for (Index c = 0; c < view.numberOfCells; ++c)
    {
      input.regions[c] = options.outside[c] ? OutsideRegion : input.regions[c];
    }
  }
  return input;
}

void checkFaces(const TetrahedronMesh& mesh, int threads)
{
  if (mesh.nonManifoldFaces() > 0)
  {
    throw Error(std::to_string(mesh.nonManifoldFaces()) +
      " faces are used by three or more tetrahedra: remove duplicate or overlapping cells first");
  }
  std::vector<Index> ofChunk(numberOfChunks(mesh.slots()), 0);
  forEachChunk(mesh.slots(), threads,
    [&](Index chunk, Index begin, Index end)
    {
      for (Index t = begin; t < end; ++t)
      {
        for (int i = 0; i < 4; ++i)
        {
          const auto id = static_cast<TetId>(t);
          const std::int32_t n = mesh.tet(id).neighbors[i];
          // Each face is counted from its side with the smaller id.
          ofChunk[chunk] += n >> 2 > id && mesh.isTurned(id, i);
        }
      }
    });
  const Index sameSide = std::accumulate(ofChunk.begin(), ofChunk.end(), Index(0));
  if (sameSide > 0)
  {
    throw Error(std::to_string(sameSide) +
      " faces have both tetrahedra on the same side: remove duplicate or overlapping cells first");
  }
}
}
