// SPDX-License-Identifier: BSD-3-Clause
#include "WarpQuality.h"

#include "tautline/Mesh/Ranks.h"

#include "tautline/Core/Parallel.h"

#include <Eigen/Dense>

#include <limits>

namespace tautline
{
namespace
{
using Matrix = Eigen::Matrix3d;

/// (4.22) of T.
double similarity2D(const Eigen::Matrix2d& T)
{
  // |T - adj(T)^t|^2 = 2 |T|^2 - 4 det T, without cancellation
  const double a = T(0, 0) - T(1, 1), b = T(0, 1) + T(1, 0);
  return 2.0 * (a * a + b * b);
}

double similarity3D(const Matrix& T)
{
  Matrix adjugate; // its transpose: the cofactors
  for (int c = 0; c < 3; ++c)
  {
    adjugate.col(c) = T.col((c + 1) % 3).cross(T.col((c + 2) % 3));
  }
  return (T.norm() / std::sqrt(3.0) * T - adjugate).squaredNorm();
}

/// The mean of (4.22) over the corners of a cell.
double similarity(const CellTopology& t, const Mesh& mesh, const Vec3* before, const Vec3* after)
{
  double sum = 0;
  for (int s = 0; s < t.samples; ++s)
  {
    Matrix old = Matrix::Identity(), now = Matrix::Identity();
    for (int k = 0; k < t.dimension; ++k)
    {
      const auto& corner = t.cornerNodes[s];
      const Vec3 a = before[corner[k + 1]] - before[corner[0]];
      const Vec3 b = after[corner[k + 1]] - after[corner[0]];
      for (int c = 0; c < t.dimension; ++c)
      {
        old(c, k) = t.dimension == 3 ? a[c] : dot(mesh.frame()[c], a);
        now(c, k) = t.dimension == 3 ? b[c] : dot(mesh.frame()[c], b);
      }
    }
    const Matrix T = now * old.inverse();
    sum += t.dimension == 3 ? similarity3D(T) : similarity2D(T.topLeftCorner<2, 2>());
  }
  return sum / t.samples;
}

/// Calls visit(chunk, cell, value) for each cell that is an element; the value is NaN where it is
/// not valid.
template <class Visit>
void forEachElement(const Mesh& mesh, const double* points, int threads, const Visit& visit)
{
  const MeshView& view = mesh.view();
  Index firstChunk = 0;
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    if (t.dimension != (mesh.dimension() == Dimension::Volume ? 3 : 2))
    {
      continue;
    }
    forEachChunk(block.count, threads,
      [&](Index chunk, Index begin, Index end)
      {
        for (Index i = begin; i < end; ++i)
        {
          const Index cell = block.cell(i);
          const Index* node = view.connectivity + view.offsets[cell];
          Vec3 before[MaxNodes], after[MaxNodes];
          for (int k = 0; k < t.nodes; ++k)
          {
            before[k] = pointOf(view, node[k]);
            std::copy_n(points + 3 * node[k], 3, after[k].begin());
          }
          const bool valid = mesh.classifyCell(t, after) == Valid;
          visit(firstChunk + chunk, cell,
            valid ? similarity(t, mesh, before, after) : std::numeric_limits<double>::quiet_NaN());
        }
      });
    firstChunk += numberOfChunks(block.count);
  }
}
}

//------------------------------------------------------------------------------
std::vector<double> shapeSimilarity(const Mesh& mesh, const double* points, int threads)
{
  std::vector<double> values(mesh.view().numberOfCells, std::numeric_limits<double>::quiet_NaN());
  forEachElement(
    mesh, points, threads, [&values](Index, Index cell, double value) { values[cell] = value; });
  return values;
}

//------------------------------------------------------------------------------
WarpQuality qualityOf(const Mesh& mesh, const double* points, int threads)
{
  return qualityOf(mesh, points, threads, Ranks());
}

//------------------------------------------------------------------------------
WarpQuality qualityOf(const Mesh& mesh, const double* points, int threads, const Ranks& ranks)
{
  struct Part
  {
    Index valid = 0, inverted = 0;
    double sum = 0, worst = 0;
  };
  Index chunks = 0;
  for (const CellBlock& block : mesh.blocks())
  {
    chunks += numberOfChunks(block.count);
  }
  std::vector<Part> parts(chunks);
  forEachElement(mesh, points, threads,
    [&](Index chunk, Index cell, double value)
    {
      Part& part = parts[chunk];
      if (!ranks.ownsCell(cell))
      {
        return;
      }
      if (std::isnan(value))
      {
        ++part.inverted;
        return;
      }
      ++part.valid;
      part.sum += value;
      part.worst = std::max(part.worst, value);
    });
  WarpQuality quality;
  Index valid = 0;
  // Summed in the order of the chunks.
  for (const Part& part : parts)
  {
    valid += part.valid;
    quality.inverted += part.inverted;
    quality.worst = std::max(quality.worst, part.worst);
    quality.mean += part.sum;
  }
  valid = ranks.sum(valid);
  quality.inverted = ranks.sum(quality.inverted);
  quality.worst = ranks.maximum(quality.worst);
  quality.mean = ranks.sum(quality.mean);
  quality.mean /= std::max<double>(1.0, static_cast<double>(valid));
  return quality;
}
}
