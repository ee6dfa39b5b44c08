// SPDX-License-Identifier: BSD-3-Clause
#include "Targets.h"

#include "tautline/Mesh/CellBatch.h"

#include <Eigen/Dense>

#include <algorithm>

namespace tautline
{
namespace
{
using Matrix = Eigen::Matrix3d;

/// The relative deviation up to which a tensor on a surface is treated as isotropic.
constexpr double isotropyTolerance = 1e-6;

/// Whether numbers are outside the range that is measured without scaling.
bool anyExtreme(const std::vector<double>& numbers)
{
  return std::any_of(numbers.begin(), numbers.end(),
    [](double x)
    { return std::abs(x) >= LargestExtent || (x != 0 && std::abs(x) <= SmallestExtent); });
}

void setExtreme(Targets& targets)
{
  targets.extreme = anyExtreme(targets.inverse) || anyExtreme(targets.metricRoots);
}

/// Calls make(cell, sample, topology) for each sample of each cell and stores the matrix it
/// returns.
template <class Make>
Targets makeTargets(const Mesh& mesh, const Make& make)
{
  const Index cells = mesh.view().numberOfCells;
  Targets targets;
  // One matrix per sample of each cell; other cells have none.
  targets.offsets.assign(cells + 1, 0);
  for (const CellBlock& block : mesh.blocks())
  {
    for (Index i = 0; i < block.count; ++i)
    {
      targets.offsets[block.cell(i) + 1] = topology(block.type).samples;
    }
  }
  for (Index i = 0; i < cells; ++i)
  {
    targets.offsets[i + 1] += targets.offsets[i];
  }
  targets.inverse.resize(9 * targets.offsets[cells]);
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    for (Index i = 0; i < block.count; ++i)
    {
      const Index cell = block.cell(i);
      for (int s = 0; s < t.samples; ++s)
      {
        Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(
          targets.inverse.data() + 9 * (targets.offsets[cell] + s)) = make(cell, s, t);
      }
    }
  }
  setExtreme(targets);
  return targets;
}

Matrix idealInverse(const CellTopology& t, int sample)
{
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(
    t.idealInverse[sample].data());
}

[[noreturn]] void refuse(Index cell, const std::string& problem)
{
  throw Error("Cell " + std::to_string(cell) + " cannot have a target: " + problem);
}
}

//------------------------------------------------------------------------------
Targets referenceTargets(const Mesh& mesh, const Mesh& reference)
{
  const MeshView &view = mesh.view(), &other = reference.view();
  const char* remedy = "Use a reference mesh that only differs in its coordinates.";
  if (view.numberOfCells != other.numberOfCells || view.numberOfPoints != other.numberOfPoints)
  {
    throw Error("The reference mesh has " + std::to_string(other.numberOfPoints) + " points and " +
      std::to_string(other.numberOfCells) + " cells, the mesh has " +
      std::to_string(view.numberOfPoints) + " and " + std::to_string(view.numberOfCells) + ". " +
      remedy);
  }
  for (Index i = 0; i < view.numberOfCells; ++i)
  {
    const Index size = view.offsets[i + 1] - view.offsets[i];
    if (view.cellTypes[i] != other.cellTypes[i] ||
      size != other.offsets[i + 1] - other.offsets[i] ||
      !std::equal(view.connectivity + view.offsets[i], view.connectivity + view.offsets[i] + size,
        other.connectivity + other.offsets[i]))
    {
      throw Error("Cell " + std::to_string(i) +
        " of the reference mesh has another type or other points than in the mesh. " + remedy);
    }
  }
  return makeTargets(mesh,
    [&](Index cell, int s, const CellTopology& t) -> Matrix
    {
      const Index* node = other.connectivity + other.offsets[cell];
      Matrix w = Matrix::Identity();
      Vec3 edge[3];
      double extent = 0, scale = 1;
      for (int k = 0; k < t.dimension; ++k)
      {
        edge[k] =
          pointOf(other, node[t.cornerNodes[s][k + 1]]) - pointOf(other, node[t.cornerNodes[s][0]]);
        for (double x : edge[k])
        {
          extent = std::max(extent, std::abs(x));
        }
      }
      // Cells of extreme size are scaled for their determinants.
      const double unit = unitOfExtent(extent);
      for (int k = 0; k < t.dimension; ++k)
      {
        edge[k] = (1 / unit) * edge[k];
        scale *= norm(edge[k]);
      }
      if (t.dimension == 3)
      {
        // A mirrored mesh is evaluated with x reversed.
        const double mirror = reference.mirrored() ? -1.0 : 1.0;
        for (int k = 0; k < 3; ++k)
        {
          w.col(k) = Eigen::Vector3d(mirror * edge[k][0], edge[k][1], edge[k][2]);
        }
      }
      else if (mesh.dimension() == Dimension::Planar && reference.dimension() == Dimension::Planar)
      {
        for (int k = 0; k < 2; ++k)
        {
          const int first = reference.mirrored() ? 1 : 0;
          w(0, k) = dot(reference.frame()[first], edge[k]);
          w(1, k) = dot(reference.frame()[1 - first], edge[k]);
        }
      }
      else
      {
        // On a surface: the first edge along the first axis, as in the evaluation; a reflex corner
        // is negative.
        Vec3 p[MaxNodes];
        for (int k = 0; k < t.nodes; ++k)
        {
          p[k] = (1 / unit) * pointOf(other, node[k]);
        }
        const Vec3 own = cross(edge[0], edge[1]);
        const double length = norm(edge[0]), turn = dot(own, vectorArea(t, p)) < 0 ? -1 : 1;
        w(0, 0) = length;
        w(0, 1) = length > 0 ? dot(edge[0], edge[1]) / length : 0;
        w(1, 1) = length > 0 ? turn * norm(own) / length : 0;
      }
      const double det = w.determinant();
      if (!(det > Mesh::degenerateTolerance() * scale))
      {
        refuse(cell, "it is inverted or degenerate in the reference mesh. Repair that mesh first.");
      }
      return (1 / unit) * w.inverse();
    });
}

//------------------------------------------------------------------------------
Targets sizeTargets(const Mesh& mesh, const double* sizes)
{
  return makeTargets(mesh,
    [&](Index cell, int s, const CellTopology& t) -> Matrix
    {
      if (!(sizes[cell] > 0) || !std::isfinite(sizes[cell]))
      {
        refuse(cell,
          "its size is " + std::to_string(sizes[cell]) + "; sizes must be positive and finite.");
      }
      // The ideal cell has the size sizePerDeterminant / det W^-1.
      const Matrix inverse = idealInverse(t, s);
      const double ideal = t.sizePerDeterminant / inverse.determinant();
      const double factor = std::pow(ideal / sizes[cell], 1.0 / t.dimension);
      Matrix scaled = factor * inverse;
      // The third column is the unit normal, which is not scaled.
      if (t.dimension == 2)
      {
        scaled(2, 2) = 1;
      }
      return scaled;
    });
}

//------------------------------------------------------------------------------
void scaleTargets(Targets& targets, double unit)
{
  for (double& entry : targets.inverse)
  {
    entry *= unit;
  }
  setExtreme(targets);
}

//------------------------------------------------------------------------------
Targets tensorTargets(const Mesh& mesh, const double* tensors)
{
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  // The target is the ideal element; the metric is applied to the Jacobian from the left, by its
  // root.
  Targets targets =
    makeTargets(mesh, [](Index, int s, const CellTopology& t) { return idealInverse(t, s); });
  targets.metricRoots.assign(9 * mesh.view().numberOfCells, 0.0);
  for (const CellBlock& block : mesh.blocks())
  {
    const int dimension = topology(block.type).dimension;
    for (Index i = 0; i < block.count; ++i)
    {
      const Index cell = block.cell(i);
      Matrix m = Eigen::Map<const RowMajor>(tensors + 9 * cell);
      if (!m.allFinite())
      {
        refuse(cell, "its metric tensor is not finite.");
      }
      m = 0.5 * (m + m.transpose()).eval();
      if (dimension == 2 && mesh.dimension() == Dimension::Planar)
      {
        // The tensor in the frame of the plane.
        Eigen::Matrix<double, 3, 2> frame;
        for (int a = 0; a < 2; ++a)
        {
          const Vec3& axis = mesh.frame()[mesh.mirrored() ? 1 - a : a];
          frame.col(a) = Eigen::Vector3d(axis[0], axis[1], axis[2]);
        }
        Matrix flat = Matrix::Identity();
        flat.topLeftCorner<2, 2>() = frame.transpose() * m * frame;
        m = flat;
      }
      else if (dimension == 2)
      {
        // A curved surface defines no directions: only multiples of the unit tensor are allowed.
        const double third = m.trace() / 3;
        if ((m - third * Matrix::Identity()).norm() > isotropyTolerance * m.norm())
        {
          refuse(cell,
            "anisotropic tensors need a planar or a volume mesh; on a surface, use a size "
            "array instead.");
        }
        m = third * Matrix::Identity();
      }
      const Eigen::SelfAdjointEigenSolver<Matrix> solver(m);
      if (!(solver.eigenvalues()[0] > 0))
      {
        refuse(cell, "its metric tensor is not positive definite.");
      }
      // Lengths in the metric M are the lengths of the vectors M^(1/2) e.
      Matrix root = solver.operatorSqrt();
      if (mesh.mirrored() && dimension == 3)
      {
        // The mesh is evaluated with x reversed, so its tensor is too.
        root.row(0) *= -1;
        root.col(0) *= -1;
      }
      Eigen::Map<RowMajor>(targets.metricRoots.data() + 9 * cell) = root;
    }
  }
  setExtreme(targets);
  return targets;
}
}
