// SPDX-License-Identifier: BSD-3-Clause
#include "Femwarp.h"

#include "tautline/Core/Parallel.h"

#include <Eigen/Dense>

#include <limits>
#include <numeric>

namespace tautline
{
namespace
{
/// Smallest over largest eigenvalue at which a tensor counts as singular.
constexpr double singular = 1e-12;
/// Couplings below this fraction of the isotropic couplings are treated as 0.
constexpr double coupled = 1e-12;

bool isSingular(const SymmetricTensor& t, const Mesh& mesh)
{
  if (mesh.dimension() == Dimension::Planar)
  {
    const auto times = [&t](const Vec3& v)
    {
      return Vec3{ t[0] * v[0] + t[3] * v[1] + t[5] * v[2], t[3] * v[0] + t[1] * v[1] + t[4] * v[2],
        t[5] * v[0] + t[4] * v[1] + t[2] * v[2] };
    };
    const Vec3 &e = mesh.frame()[0], &f = mesh.frame()[1];
    const double a = dot(e, times(e)), b = dot(e, times(f)), c = dot(f, times(f));
    const double largest = 0.5 * (a + c + std::hypot(a - c, 2.0 * b));
    return !(a * c - b * b > singular * largest * largest);
  }
  Eigen::Matrix3d c;
  c << t[0], t[3], t[5], t[3], t[1], t[4], t[5], t[4], t[2];
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(c, Eigen::EigenvaluesOnly);
  return !(solver.eigenvalues()[0] > singular * solver.eigenvalues()[2]);
}

double largestOf(const SymmetricTensor& t)
{
  return *std::max_element(t.begin(), t.begin() + 3);
}

/// The matrix of the local cells; a rank may have none.
SparseMatrix matrixOf(
  const Mesh& mesh, const DiffusionOperator& pde, const AssemblyOptions& options)
{
  if (mesh.view().numberOfCells > 0)
  {
    return stiffnessMatrix(mesh, pde, options);
  }
  SparseMatrix empty;
  empty.size = mesh.view().numberOfPoints;
  empty.offsets.assign(empty.size + 1, 0);
  return empty;
}

/// K M^-1 K: M is diagonal. Points outside all cells have empty rows. On several ranks: the terms
/// K_ij K_jk / M_jj of the owned points j, whose rows of K are complete; the terms of all ranks
/// must be summed.
SparseMatrix squared(const SparseMatrix& K, const std::vector<double>& mass, const Ranks& ranks)
{
  SparseMatrix result;
  result.size = K.size;
  result.offsets.reserve(K.size + 1);
  std::vector<double> row(K.size, 0.0);
  std::vector<char> there(K.size, 0);
  std::vector<std::int32_t> columns;
  for (Index i = 0; i < K.size; ++i)
  {
    columns.clear();
    for (Index e = K.offsets[i]; e < K.offsets[i + 1]; ++e)
    {
      const std::int32_t j = K.columns[e];
      if (!ranks.owns(j))
      {
        continue;
      }
      const double scale = mass[j] > 0 ? K.values[e] / mass[j] : 0.0;
      for (Index f = K.offsets[j]; f < K.offsets[j + 1]; ++f)
      {
        const std::int32_t k = K.columns[f];
        if (!there[k])
        {
          there[k] = 1;
          columns.push_back(k);
        }
        row[k] += scale * K.values[f];
      }
    }
    std::sort(columns.begin(), columns.end());
    for (std::int32_t k : columns)
    {
      result.columns.push_back(k);
      result.values.push_back(row[k]);
      row[k] = 0;
      there[k] = 0;
    }
    result.offsets.push_back(result.nonzeros());
  }
  symmetrize(result); // removes rounding errors
  return result;
}
}

//------------------------------------------------------------------------------
Femwarp::Femwarp(const Mesh& mesh, const WarpParts& parts, Operator kind,
  const SymmetricTensor& tensor, const double* tensors, WarpControl& control)
  : Input(mesh)
  , Parts(parts)
  , Kind(kind)
{
  this->Pde.tensor = tensor;
  this->Pde.tensors = tensors;
  this->Singular = kind == Operator::Harmonic &&
    (tensors || parts.ranks().any(mesh.dimension() != Dimension::None && isSingular(tensor, mesh)));
  this->partition(control);
}

//------------------------------------------------------------------------------
SparseMatrix Femwarp::assemble(double regularization, WarpControl& control) const
{
  const double before = control.elapsed();
  AssemblyOptions options;
  options.threads = control.options().threads;
  DiffusionOperator pde = this->Pde;
  std::vector<double> tensors;
  if (regularization > 0)
  {
    if (pde.tensors)
    {
      tensors.assign(pde.tensors, pde.tensors + 6 * this->Input.view().numberOfCells);
      for (std::size_t i = 0; i < tensors.size(); i += 6)
      {
        const double size = *std::max_element(&tensors[i], &tensors[i] + 3);
        for (int k = 0; k < 3; ++k)
        {
          tensors[i + k] += regularization * (size > 0 ? size : 1.0);
        }
      }
      pde.tensors = tensors.data();
    }
    else
    {
      const double size = largestOf(pde.tensor);
      for (int k = 0; k < 3; ++k)
      {
        pde.tensor[k] += regularization * (size > 0 ? size : 1.0);
      }
    }
  }
  SparseMatrix matrix;
  this->Parts.ranks().together([&] { matrix = matrixOf(this->Input, pde, options); });
  if (this->Kind == Operator::Biharmonic)
  {
    this->Parts.ranks().together(
      [&]
      {
        std::vector<double> mass(this->Input.view().numberOfPoints, 1.0);
        if (this->Input.view().numberOfCells > 0)
        {
          mass = loadVector(this->Input, mass.data(), 1, options);
        }
        matrix = squared(matrix, mass, this->Parts.ranks());
      });
  }
  control.result().assembleSeconds += control.elapsed() - before;
  return matrix;
}

void Femwarp::partition(WarpControl& control)
{
  const SparseMatrix matrix = this->assemble(this->Regularization, control);
  const double before = control.elapsed();
  this->Held = this->Parts.held();
  this->Decoupled = 0;
  if (this->Regularization == 0 && this->Singular)
  {
    this->findDecoupled(matrix, control);
  }
  const int dimension = this->Parts.dimension() == Dimension::Volume ? 3 : 2;
  const double* points = this->Input.view().points;
  WarpMatrix given(matrix);
  given.shared = this->Kind == Operator::Biharmonic;
  this->System = std::make_unique<WarpSystem>(
    given, 1, this->Held, points, dimension, control.options(), this->Parts.ranks());
  this->Second.reset();
  if (this->Decoupled > 0)
  {
    AssemblyOptions options;
    options.threads = control.options().threads;
    this->Second = std::make_unique<WarpSystem>(matrixOf(this->Input, DiffusionOperator(), options),
      1, this->Others, points, dimension, control.options(), this->Parts.ranks());
  }
  control.result().assembleSeconds += control.elapsed() - before;
}

//------------------------------------------------------------------------------
/// Finds points that no chain of couplings joins to a prescribed one.
void Femwarp::findDecoupled(const SparseMatrix& matrix, WarpControl& control)
{
  AssemblyOptions options;
  options.threads = control.options().threads;
  const SparseMatrix isotropic = matrixOf(this->Input, DiffusionOperator(), options);
  const Ranks& ranks = this->Parts.ranks();
  const Index n = matrix.size;
  double size = this->Pde.tensors ? 0.0 : largestOf(this->Pde.tensor);
  for (Index i = 0; this->Pde.tensors && i < this->Input.view().numberOfCells; ++i)
  {
    const double* t = this->Pde.tensors + 6 * i;
    size = std::max(size, *std::max_element(t, t + 3));
  }
  size = ranks.maximum(size);
  std::vector<double> scale(n);
  for (Index i = 0; i < n; ++i)
  {
    scale[i] = coupled * size * isotropic.at(i, i);
  }
  ranks.exchange(scale.data(), 1);
  // Breadth-first from the held points along the couplings.
  std::vector<unsigned char> reached(n, 0);
  std::vector<Index> front;
  for (Index i = 0; i < n; ++i)
  {
    if (this->Held[i])
    {
      reached[i] = 1;
      front.push_back(i);
    }
  }
  do
  {
    while (!front.empty())
    {
      const Index i = front.back();
      front.pop_back();
      for (Index e = matrix.offsets[i]; ranks.owns(i) && e < matrix.offsets[i + 1]; ++e)
      {
        const Index j = matrix.columns[e];
        if (!reached[j] && std::abs(matrix.values[e]) > std::min(scale[i], scale[j]))
        {
          reached[j] = 1;
          front.push_back(j);
        }
      }
    }
    // Continue from the points that other ranks have reached.
    const std::vector<unsigned char> before = reached;
    ranks.either(reached.data());
    for (Index i = 0; i < n; ++i)
    {
      if (reached[i] && !before[i])
      {
        front.push_back(i);
      }
    }
  } while (ranks.any(!front.empty()));
  this->Others.assign(n, 1);
  for (Index i = 0; i < n; ++i)
  {
    if (!reached[i])
    {
      this->Others[i] = 0;
      this->Held[i] = 1;
      this->Decoupled += ranks.owns(i);
    }
  }
  this->Decoupled = ranks.sum(this->Decoupled);
}

//------------------------------------------------------------------------------
/// Splits the prescribed displacements into affine motions and the rest.
/// @return a bound on the rounding error of the rest; a smaller rest is treated as zero
double Femwarp::splitAffine(
  const double* displacement, std::vector<double>& rest, std::vector<double>& result) const
{
  const MeshView& view = this->Input.view();
  const Index n = view.numberOfPoints;
  const std::vector<AffineMotion> affine = this->Parts.affine(view.points, displacement);
  const std::vector<unsigned char>& prescribed = this->Parts.prescribed();
  rest.assign(3 * n, 0.0);
  result.assign(3 * n, 0.0);
  double largest = 0, position = 0;
  for (Index i = 0; i < n; ++i)
  {
    const Index part = this->Parts.part(i);
    const Vec3 x = pointOf(view, i);
    const Vec3 moved = part >= 0 ? affine[part].at(x) : Vec3{ 0, 0, 0 };
    for (int c = 0; c < 3; ++c)
    {
      const double given = displacement[3 * i + c];
      result[3 * i + c] = prescribed[i] ? given : moved[c];
      if (prescribed[i] && part >= 0)
      {
        rest[3 * i + c] = given - moved[c];
        largest = std::max(largest, std::abs(given));
        position = std::max(position, std::abs(x[c] - affine[part].center[c]));
      }
    }
  }
  largest = this->Parts.ranks().maximum(largest);
  position = this->Parts.ranks().maximum(position);
  double slope = 0;
  for (const AffineMotion& motion : affine)
  {
    for (const Vec3& column : motion.linear)
    {
      slope = std::max(slope, norm(column));
    }
  }
  constexpr double roundings = 32;
  return roundings * std::numeric_limits<double>::epsilon() * (largest + slope * position);
}

//------------------------------------------------------------------------------
std::vector<double> Femwarp::warp(const double* displacement, WarpControl& control)
{
  std::vector<double> rest, affine;
  const double nothing = this->splitAffine(displacement, rest, affine);
  // A singular operator is regularized more and more until the motion is bounded.
  constexpr double first = 1e-10, factor = 100, last = 1e-1;
  for (;;)
  {
    std::vector<double> moved = affine;
    const ComponentSolution outcome = solveComponents(
      { this->System.get(), this->Second.get() }, this->Parts, rest, nothing, control, moved);
    control.result().decoupled = this->Decoupled;
    control.result().regularization = this->Regularization;
    if (control.stopped() || !this->Singular || (outcome.converged && outcome.bounded) ||
      this->Regularization >= last)
    {
      if (!outcome.converged && !control.stopped())
      {
        control.addMessage("The linear solver did not converge: " + outcome.failure);
      }
      return moved;
    }
    this->Regularization = this->Regularization > 0 ? factor * this->Regularization : first;
    this->partition(control);
  }
}
}
