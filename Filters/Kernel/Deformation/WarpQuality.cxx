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

/// The shape of a moved element relative to the element at rest.
struct ElementShape
{
  double similarity = 0; ///< (4.22)
  double ratio = 0;      ///< the inverse mean ratio
};

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

/// Two directions in the mean plane of a cell, the first along its first edge.
std::array<Vec3, 2> frameOf(const CellTopology& t, const Vec3* p)
{
  Vec3 normal = vectorArea(t, p);
  normal = (1 / norm(normal)) * normal;
  Vec3 along = p[1] - p[0];
  along -= dot(along, normal) * normal;
  along = (1 / norm(along)) * along;
  return { along, cross(normal, along) };
}

/// The sum of the areas of the cells at each point of a surface, as vectors.
std::vector<Vec3> pointNormals(const Mesh& mesh, const double* points)
{
  const MeshView& view = mesh.view();
  std::vector<Vec3> normals(view.numberOfPoints, Vec3{ 0, 0, 0 });
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    for (Index i = 0; t.dimension == 2 && i < block.count; ++i)
    {
      const Index* node = view.connectivity + view.offsets[block.cell(i)];
      Vec3 p[MaxNodes];
      for (int k = 0; k < t.nodes; ++k)
      {
        std::copy_n(points + 3 * node[k], 3, p[k].begin());
      }
      const Vec3 area = vectorArea(t, p);
      for (int k = 0; k < t.nodes; ++k)
      {
        normals[node[k]] += area;
      }
    }
  }
  return normals;
}

/// The means over the corners of a valid cell.
ElementShape shapeOf(const CellTopology& t, const Mesh& mesh, const Vec3* before, const Vec3* after)
{
  ElementShape sum;
  // On a surface, each cell has its own frames.
  std::array<std::array<Vec3, 2>, 2> frames = { mesh.frame(), mesh.frame() };
  if (mesh.dimension() == Dimension::Surface)
  {
    frames = { frameOf(t, before), frameOf(t, after) };
  }
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
        old(c, k) = t.dimension == 3 ? a[c] : dot(frames[0][c], a);
        now(c, k) = t.dimension == 3 ? b[c] : dot(frames[1][c], b);
      }
    }
    const Matrix T = now * old.inverse();
    // In the plane, the third row and column are taken from the identity.
    if (t.dimension == 3)
    {
      const double root = std::cbrt(std::abs(T.determinant()));
      sum.similarity += similarity3D(T);
      sum.ratio += T.squaredNorm() / (3.0 * root * root);
    }
    else
    {
      const Eigen::Matrix2d plane = T.topLeftCorner<2, 2>();
      sum.similarity += similarity2D(plane);
      sum.ratio += plane.squaredNorm() / (2.0 * std::abs(plane.determinant()));
    }
  }
  sum.similarity /= t.samples;
  sum.ratio /= t.samples;
  return sum;
}

/// Calls visit(chunk, cell, shape) for each cell that is an element; the numbers are NaN if it is
/// not valid.
template <class Visit>
void forEachElement(const Mesh& mesh, const double* points, int threads, const Visit& visit)
{
  const MeshView& view = mesh.view();
  const bool surface = mesh.dimension() == Dimension::Surface;
  const std::vector<Vec3> normals = surface ? pointNormals(mesh, points) : std::vector<Vec3>();
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
          // A cell of a surface is folded if its normal opposes the surrounding cells.
          Vec3 around = { 0, 0, 0 };
          for (int k = 0; surface && k < t.nodes; ++k)
          {
            around += normals[node[k]];
          }
          const double length = norm(around);
          around = length > 0 ? (1 / length) * around : around;
          const bool valid = mesh.classifyCell(t, after, surface ? &around : nullptr) == Valid;
          constexpr double none = std::numeric_limits<double>::quiet_NaN();
          visit(firstChunk + chunk, cell,
            valid ? shapeOf(t, mesh, before, after) : ElementShape{ none, none });
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
  forEachElement(mesh, points, threads,
    [&values](Index, Index cell, const ElementShape& shape) { values[cell] = shape.similarity; });
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
    double sum = 0, worst = 0, worstRatio = 0;
  };
  Index chunks = 0;
  for (const CellBlock& block : mesh.blocks())
  {
    chunks += numberOfChunks(block.count);
  }
  std::vector<Part> parts(chunks);
  forEachElement(mesh, points, threads,
    [&](Index chunk, Index cell, const ElementShape& shape)
    {
      Part& part = parts[chunk];
      if (!ranks.ownsCell(cell))
      {
        return;
      }
      if (std::isnan(shape.similarity))
      {
        ++part.inverted;
        return;
      }
      ++part.valid;
      part.sum += shape.similarity;
      part.worst = std::max(part.worst, shape.similarity);
      part.worstRatio = std::max(part.worstRatio, shape.ratio);
    });
  WarpQuality quality;
  Index valid = 0;
  // Sum in the order of the chunks.
  for (const Part& part : parts)
  {
    valid += part.valid;
    quality.inverted += part.inverted;
    quality.worst = std::max(quality.worst, part.worst);
    quality.worstRatio = std::max(quality.worstRatio, part.worstRatio);
    quality.mean += part.sum;
  }
  valid = ranks.sum(valid);
  quality.inverted = ranks.sum(quality.inverted);
  quality.worst = ranks.maximum(quality.worst);
  quality.worstRatio = ranks.maximum(quality.worstRatio);
  quality.mean = ranks.sum(quality.mean);
  quality.mean /= std::max<double>(1.0, static_cast<double>(valid));
  return quality;
}
}
