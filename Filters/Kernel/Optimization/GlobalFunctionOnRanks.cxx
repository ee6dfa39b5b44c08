// SPDX-License-Identifier: BSD-3-Clause
#include "GlobalFunctionOnRanks.h"

#include "tautline/Core/Memory.h"

#include <algorithm>
#include <cmath>
#include <new>

namespace tautline
{
//------------------------------------------------------------------------------
GlobalFunctionOnRanks::GlobalFunctionOnRanks(const DistributedMesh& mesh, const MatrixRows& rows,
  OptimizationProblem* problem, const Scalarizer& scalarizer, std::size_t objectives,
  Optimizer optimizer, int coordinates, int threads)
  : TheMesh(mesh)
  , Rows(rows)
  , TheScalarizer(scalarizer)
  , Size(coordinates)
  , Newton(optimizer == Optimizer::NewtonConjugateGradient)
  , All(static_cast<std::size_t>(coordinates) * rows.rows())
  , Product(All.size())
  , Slopes(objectives, 1.0)
  , Grids(rows, threads)
{
  this->Terms.resize(mesh.view().numberOfCells);
  if (problem)
  {
    this->Local =
      std::make_unique<GlobalFunction>(*problem, optimizer, rows.rowOfPoint(), rows.rows());
  }
}

std::size_t GlobalFunctionOnRanks::size() const
{
  return static_cast<std::size_t>(this->Size) * this->Rows.numberOfOwned();
}

//------------------------------------------------------------------------------
void GlobalFunctionOnRanks::put(const double* x)
{
  this->Rows.spread(x, this->All.data(), this->Size);
  if (this->Local)
  {
    this->Local->put(this->All.data());
  }
}

//------------------------------------------------------------------------------
/// Of the terms of the owned cells of all ranks; +infinity where one is, or where an element of any
/// rank is less valid than at the start.
double GlobalFunctionOnRanks::sum(const std::vector<double>& terms)
{
  const double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> own;
  own.reserve(terms.size());
  for (std::size_t cell = 0; cell < terms.size(); ++cell)
  {
    if (this->TheMesh.ownedCells()[cell])
    {
      own.push_back(terms[cell]);
    }
  }
  if (!this->Allowed)
  {
    own.push_back(infinity);
  }
  const double sum = this->TheMesh.group().orderlessSum(own);
  return std::isnan(sum) ? infinity : sum;
}

//------------------------------------------------------------------------------
double GlobalFunctionOnRanks::valueAndGradient(const double* x, double* gradient)
{
  const std::size_t n = this->Slopes.size();
  this->Rows.spread(x, this->All.data(), this->Size);
  const auto find = [&](const auto& work)
  {
    if (this->Local && this->Allowed)
    {
      work();
    }
  };
  this->Allowed = true;
  find(
    [&]
    {
      this->Local->move(this->All.data());
      this->Allowed = this->Local->allowed();
    });
  std::vector<double> values(n);
  for (std::size_t i = 0; n > 1 && i < n; ++i)
  {
    find([&] { this->Local->findTerms(i, this->Terms.data()); });
    values[i] = this->sum(this->Terms);
  }
  double value = n > 1 ? this->TheScalarizer.value(values, this->Slopes) : 0.0;
  if (!std::isfinite(value))
  {
    return std::numeric_limits<double>::infinity();
  }
  find([&] { this->Local->findGradient(this->Slopes, this->Product.data(), this->Terms.data()); });
  value = n > 1 ? value : this->sum(this->Terms);
  this->Rows.pick(this->Product.data(), gradient, this->Size);
  return value;
}

//------------------------------------------------------------------------------
void GlobalFunctionOnRanks::makeMatrix()
{
  bool fits = true;
  try
  {
    if (this->Local && !this->Local->hasMatrix())
    {
      this->Local->makeMatrix();
    }
  }
  catch (const MemoryError&)
  {
    fits = false;
  }
  catch (const std::bad_alloc&)
  {
    fits = false;
  }
  if (this->TheMesh.group().any(!fits))
  {
    throw MemoryError("The matrix of Newton's method does not fit into memory: choose another "
                      "optimizer, such as Local Newton, or take more processes.");
  }
}

void GlobalFunctionOnRanks::linearize(const double* x)
{
  this->put(x);
  if (this->Local)
  {
    this->Local->rebase(this->All.data());
  }
  this->makeMatrix();
  bool convex = this->Newton;
  if (this->Local)
  {
    convex = this->Local->fillMatrix();
  }
  this->Convex = !this->TheMesh.group().any(!convex);
  if (this->Convex)
  {
    BlockMatrixView view;
    view.size = this->Size;
    this->Grids.build(this->Local ? this->Local->matrix().view() : view);
  }
  else if (this->Local)
  {
    this->Local->matrix().factorize();
  }
}

//------------------------------------------------------------------------------
bool GlobalFunctionOnRanks::precondition(const double* r, double* z)
{
  if (this->Convex)
  {
    this->Grids.apply(r, z);
    if (this->Local)
    {
      // The coarse grids do not have the planes and lines of the points.
      this->Rows.place(z, this->All.data(), this->Size);
      this->Local->keepSlides(this->All.data());
      this->Rows.pick(this->All.data(), z, this->Size);
    }
  }
  else if (this->Local)
  {
    this->Rows.place(r, this->All.data(), this->Size);
    this->Local->matrix().preconditionByDiagonal(this->All.data(), this->Product.data());
    this->Rows.pick(this->Product.data(), z, this->Size);
  }
  return true;
}

//------------------------------------------------------------------------------
bool GlobalFunctionOnRanks::hessianTimes(const double* d, double* product)
{
  if (!this->Newton)
  {
    return false;
  }
  this->Rows.spread(d, this->All.data(), this->Size);
  if (this->Local)
  {
    this->Local->matrix().times(this->All.data(), this->Product.data());
    this->Rows.pick(this->Product.data(), product, this->Size);
  }
  return true;
}
}
