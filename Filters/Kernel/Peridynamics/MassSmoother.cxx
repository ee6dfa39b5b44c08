// SPDX-License-Identifier: BSD-3-Clause
#include "MassSmoother.h"

#include "PeridynamicsGeometry.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Solvers/Lanczos.h"

#include <cmath>

namespace tautline
{
namespace
{
/// Bounds of the eigenvalues of a mass matrix relative to its diagonal, for linear triangles.
constexpr double Smallest = 0.5, Largest = 2.0;
constexpr int Steps = 3;
}

//------------------------------------------------------------------------------
double formOrder(const PeridynamicOptions& options)
{
  if (options.kernel.shape != KernelShape::Power)
  {
    return -2.0; // as p = 0
  }
  return options.kernel.exponent - (isElastic(options.model) ? 4.0 : 2.0);
}

//------------------------------------------------------------------------------
MassSmoother::MassSmoother(
  const HorizonMesh& mesh, const PeridynamicOptions& options, const PeridynamicSystem& system)
  : Components(system.components)
  , Inverse(inverseDiagonal(system.matrix))
{
  // Constant functions have a diagonal mass matrix; with kernels whose form grows for short waves,
  // the mass matrix does not represent the form.
  if (options.basis == PeridynamicBasis::Constant || formOrder(options) >= 0.0)
  {
    return;
  }
  const PlanarTriangles triangles(mesh);
  std::vector<double> diagonal(system.functionOf.size(), 0.0);
  for (Index t = 0; t < triangles.size(); ++t)
  {
    pollInterruption(t);
    std::array<std::int32_t, 3> functions;
    for (int k = 0; k < 3; ++k)
    {
      const Index corner = 3 * t + k;
      const Index f = options.basis == PeridynamicBasis::Linear ? mesh.triangles[corner] : corner;
      functions[k] = static_cast<std::int32_t>(system.unknownOf[f]);
      if (functions[k] >= 0)
      {
        diagonal[functions[k]] += triangles.areas[t] / 6.0;
      }
    }
    if (functions[0] >= 0 || functions[1] >= 0 || functions[2] >= 0)
    {
      this->Functions.push_back(functions);
      this->Areas.push_back(triangles.areas[t]);
    }
  }
  const auto rows = static_cast<std::size_t>(system.matrix.size);
  this->Scale.resize(rows);
  this->Residual.resize(rows);
  this->Step.resize(rows);
  // S scales the mass matrix so that it has the diagonal of the stiffness matrix.
  for (std::size_t row = 0; row < rows; ++row)
  {
    this->Scale[row] = 1.0 / std::sqrt(this->Inverse[row] * diagonal[row / this->Components]);
  }
}

//------------------------------------------------------------------------------
/// y -= S M S x, triangle by triangle.
void MassSmoother::subtractProduct(const std::vector<double>& x, std::vector<double>& y) const
{
  const Index c = this->Components;
  for (std::size_t t = 0; t < this->Areas.size(); ++t)
  {
    const auto& functions = this->Functions[t];
    for (Index i = 0; i < c; ++i)
    {
      double values[3], sum = 0.0;
      for (int k = 0; k < 3; ++k)
      {
        const Index row = c * functions[k] + i;
        values[k] = functions[k] >= 0 ? this->Scale[row] * x[row] : 0.0;
        sum += values[k];
      }
      for (int k = 0; k < 3; ++k)
      {
        // The mass matrix of a linear triangle has area / 12 off the diagonal, and twice as much on
        // it.
        if (functions[k] >= 0)
        {
          const Index row = c * functions[k] + i;
          y[row] -= this->Scale[row] * this->Areas[t] / 12.0 * (sum + values[k]);
        }
      }
    }
  }
}

//------------------------------------------------------------------------------
void MassSmoother::apply(const double* r, double* z)
{
  const std::size_t rows = this->Inverse.size();
  if (this->Areas.empty())
  {
    for (std::size_t i = 0; i < rows; ++i)
    {
      z[i] = this->Inverse[i] * r[i];
    }
    return;
  }
  // Chebyshev iteration for the eigenvalues from Smallest to Largest (Y. Saad, "Iterative Methods
  // for Sparse Linear Systems", Section 12.3).
  constexpr double centre = 0.5 * (Largest + Smallest), radius = 0.5 * (Largest - Smallest);
  constexpr double sigma = centre / radius;
  for (std::size_t i = 0; i < rows; ++i)
  {
    this->Residual[i] = r[i];
    this->Step[i] = z[i] = this->Inverse[i] * r[i] / centre;
  }
  double rho = 1.0 / sigma;
  for (int step = 1; step < Steps; ++step)
  {
    this->subtractProduct(this->Step, this->Residual);
    const double next = 1.0 / (2.0 * sigma - rho);
    for (std::size_t i = 0; i < rows; ++i)
    {
      this->Step[i] =
        next * rho * this->Step[i] + 2.0 * next / radius * this->Inverse[i] * this->Residual[i];
      z[i] += this->Step[i];
    }
    rho = next;
  }
}
}
