// SPDX-License-Identifier: BSD-3-Clause
#include "SlidingUntangler.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Core/Parallel.h"

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
/// The weight of the volume term in the energy.
constexpr double ofVolume = 0.1;
/// eps^2 is the first plus the second times the square of the smallest determinant, if that is
/// negative.
constexpr double leastEps2 = 1e-6, ofSmallest2 = 0.04;
/// A corner is valid if its determinant, in units of an ideal cell with the size of the surrounding
/// edges, exceeds this.
constexpr double validDeterminant = 1e-4;
/// Fraction of the size of the edges around a point: its largest step.
constexpr double longestStep = 0.5;
constexpr Index cellsOfChunk = 64;
}

//------------------------------------------------------------------------------
SlidingUntangler::SlidingUntangler(const SlidingCells& cells, const ConstrainedPoints& constrained,
  BoundaryTerms& boundary, std::vector<Vec3>& x, int threads)
  : Cells(cells)
  , Constrained(constrained)
  , Boundary(boundary)
  , X(x)
  , Threads(threads)
  , Local(x.size(), -1)
{
  this->findSizes();
}

//------------------------------------------------------------------------------
/// The mean edge of each cell and of its surrounding cells. In tangled meshes, this is too long,
/// and the volume term pushes the cells apart.
void SlidingUntangler::findSizes()
{
  const auto& cells = this->Cells.cells();
  this->Sizes.assign(cells.size(), 0.0);
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    const CellTopology& t = *cells[c].t;
    for (int e = 0; e < t.edges; ++e)
    {
      const auto& [a, b] = t.edgeNodes[e];
      this->Sizes[c] += norm(this->X[cells[c].nodes[b]] - this->X[cells[c].nodes[a]]) / t.edges;
    }
  }
  constexpr int rounds = 2;
  for (int round = 0; round < rounds; ++round)
  {
    // Smooth the sizes by averaging over the points and back.
    std::vector<double> ofPoints(this->X.size(), 0.0);
    for (std::size_t p = 0; p < ofPoints.size(); ++p)
    {
      const std::int32_t begin = this->Cells.starts()[p], end = this->Cells.starts()[p + 1];
      for (std::int32_t i = begin; i < end; ++i)
      {
        ofPoints[p] += this->Sizes[this->Cells.cellsOf()[i]] / (end - begin);
      }
    }
    for (std::size_t c = 0; c < cells.size(); ++c)
    {
      this->Sizes[c] = 0;
      for (int k = 0; k < cells[c].t->nodes; ++k)
      {
        this->Sizes[c] += ofPoints[cells[c].nodes[k]] / cells[c].t->nodes;
      }
    }
  }
  for (double& size : this->Sizes)
  {
    size = std::max(size, std::numeric_limits<double>::min());
  }
}

//------------------------------------------------------------------------------
SlidingUntangler::Corner SlidingUntangler::cornerOf(
  std::size_t index, int corner, const std::vector<Vec3>& x) const
{
  const SlidingCells::Cell& cell = this->Cells.cells()[index];
  const CellTopology& t = *cell.t;
  const std::array<int, 4>& nodes = t.cornerNodes[corner];
  const std::array<double, 9>& w = t.idealInverse[corner];
  const double scale = 1.0 / this->Sizes[index];
  const Vec3& origin = x[cell.nodes[nodes[0]]];
  Corner result = {};
  for (int k = 0; k < t.dimension; ++k)
  {
    const Vec3 edge = x[cell.nodes[nodes[k + 1]]] - origin;
    for (int j = 0; j < t.dimension; ++j)
    {
      result.weights[k][j] = scale * w[3 * k + j];
      result.jacobian[j] += result.weights[k][j] * edge;
    }
  }
  // The cofactors are the derivatives of the determinant by the columns of the Jacobian matrix.
  const auto& [a, b, c] = result.jacobian;
  const double s = this->Cells.sign();
  if (t.dimension == 2)
  {
    const Vec3& n = this->Cells.normal();
    result.cofactor = { s * cross(b, n), s * cross(n, a), { 0, 0, 0 } };
  }
  else
  {
    result.cofactor = { s * cross(b, c), s * cross(c, a), s * cross(a, b) };
  }
  result.determinant = dot(a, result.cofactor[0]);
  return result;
}

//------------------------------------------------------------------------------
bool SlidingUntangler::isInvalid(std::size_t cell) const
{
  const CellTopology& t = *this->Cells.cells()[cell].t;
  for (int corner = 0; corner < t.samples; ++corner)
  {
    if (!(this->cornerOf(cell, corner, this->X).determinant > validDeterminant))
    {
      return true;
    }
  }
  return false;
}

Index SlidingUntangler::invalid() const
{
  Index count = 0;
  for (std::size_t c = 0; c < this->Cells.cells().size(); ++c)
  {
    count += this->isInvalid(c);
  }
  return count;
}

//------------------------------------------------------------------------------
void SlidingUntangler::select(std::vector<char> moving)
{
  std::fill(this->Local.begin(), this->Local.end(), -1);
  this->Moving.clear();
  for (std::size_t p = 0; p < moving.size(); ++p)
  {
    const auto point = static_cast<Index>(p);
    moving[p] = moving[p] && this->Constrained.freedom(point) != Freedom::None &&
      this->Cells.starts()[p + 1] > this->Cells.starts()[p];
    if (moving[p])
    {
      this->Local[p] = static_cast<std::int32_t>(this->Moving.size());
      this->Moving.push_back(point);
    }
  }
  std::vector<char> near;
  this->Cells.flagCells(moving, near);
  this->Near.clear();
  for (std::size_t c = 0; c < near.size(); ++c)
  {
    if (near[c])
    {
      this->Near.push_back(static_cast<std::int32_t>(c));
    }
  }
  this->Boundary.select(moving);
  this->Shortest.assign(this->X.size(), 0.0);
  for (const std::int32_t c : this->Near)
  {
    const SlidingCells::Cell& cell = this->Cells.cells()[c];
    std::for_each(cell.nodes, cell.nodes + cell.t->nodes,
      [&](Index p) { this->Shortest[p] = std::max(this->Shortest[p], this->Sizes[c]); });
  }
}

//------------------------------------------------------------------------------
double SlidingUntangler::energyOf(const Corner& corner, int dimension) const
{
  const double det = corner.determinant;
  const double chi = 0.5 * (det + std::sqrt(this->Eps2 + det * det));
  const auto& [a, b, c] = corner.jacobian;
  const double size2 = dot(a, a) + dot(b, b) + dot(c, c);
  const double shape = dimension == 3 ? size2 / (3 * std::cbrt(chi * chi)) : size2 / (2 * chi);
  return (1 - ofVolume) * shape + ofVolume * (1 + det * det) / chi;
}

double SlidingUntangler::energy(const std::vector<Vec3>& x) const
{
  std::vector<double> ofCells(this->Near.size());
  parallelFor(static_cast<Index>(this->Near.size()), cellsOfChunk, this->Threads,
    [&](Index i)
    {
      const CellTopology& t = *this->Cells.cells()[this->Near[i]].t;
      double sum = 0;
      for (int corner = 0; corner < t.samples; ++corner)
      {
        sum += this->energyOf(this->cornerOf(this->Near[i], corner, x), t.dimension);
      }
      ofCells[i] = sum;
    });
  double sum = 0;
  for (const double value : ofCells)
  {
    sum += value;
  }
  return sum + this->Boundary.value(x);
}

//------------------------------------------------------------------------------
double SlidingUntangler::leastDeterminant() const
{
  double least = std::numeric_limits<double>::infinity();
  for (const std::int32_t c : this->Near)
  {
    for (int corner = 0; corner < this->Cells.cells()[c].t->samples; ++corner)
    {
      least = std::min(least, this->cornerOf(c, corner, this->X).determinant);
    }
  }
  return least;
}

//------------------------------------------------------------------------------
void SlidingUntangler::addCorner(std::size_t index, int number, QuadraticModel& model) const
{
  const SlidingCells::Cell& cell = this->Cells.cells()[index];
  const CellTopology& t = *cell.t;
  const Corner at = this->cornerOf(index, number, this->X);
  const double det = at.determinant, root = std::sqrt(this->Eps2 + det * det);
  const double chi = 0.5 * (det + root), slope = 0.5 * (1 + det / root);
  const double bend = 0.5 * this->Eps2 / (root * root * root);
  const auto& [a, b, c] = at.jacobian;
  const double size2 = dot(a, a) + dot(b, b) + dot(c, c), d = t.dimension, p = 2.0 / d;
  const double power = t.dimension == 3 ? 1.0 / std::cbrt(chi * chi) : 1.0 / chi;
  // Derivatives of |J|^2 chi^-p / d with respect to |J|^2 / 2 and chi.
  const double byNorm = (1 - ofVolume) * 2 * power / d;
  const double byChi = -(1 - ofVolume) * p * size2 * power / (d * chi);
  // Derivatives of (1 + D^2) / chi with respect to D.
  const double over = (1 + det * det) / chi;
  const double byDet = ofVolume * (2 * det - over * slope) / chi;
  const double bent =
    ofVolume * (2 - 4 * det * slope / chi + over * (2 * slope * slope / chi - bend)) / chi;

  CornerBlock block;
  block.weights = at.weights;
  block.jacobian = at.jacobian;
  block.cofactor = at.cofactor;
  block.ofNorm = byNorm;
  // Second derivatives by norm and determinant; only the convex part of the volume term is kept.
  block.ofMixed = -p * byNorm / chi * slope;
  block.ofDeterminant =
    (1 - ofVolume) * p * (p + 1) * size2 * power / (d * chi * chi) * slope * slope +
    std::max(bent, 0.0);
  block.points.fill(-1);
  for (int k = 0; k <= t.dimension; ++k)
  {
    block.points[k] = this->Local[cell.nodes[t.cornerNodes[number][k]]];
  }
  // The gradient by the chain rule; the first point has minus the sum of the others.
  const double ofDeterminant = byChi * slope + byDet;
  for (int k = 0; k < t.dimension; ++k)
  {
    Vec3 g = { 0, 0, 0 };
    for (int j = 0; j < t.dimension; ++j)
    {
      g += at.weights[k][j] * (byNorm * at.jacobian[j] + ofDeterminant * at.cofactor[j]);
    }
    model.addGradient(block.points[k + 1], g);
    model.addGradient(block.points[0], -1.0 * g);
  }
  model.addCorner(block);
}

//------------------------------------------------------------------------------
void SlidingUntangler::linearize(QuadraticModel& model) const
{
  model.start(this->Moving.size());
  for (std::size_t i = 0; i < this->Moving.size(); ++i)
  {
    model.setFreedom(static_cast<std::int32_t>(i), this->Constrained.freedom(this->Moving[i]),
      this->Constrained.direction(this->Moving[i]));
  }
  for (const std::int32_t cell : this->Near)
  {
    for (int corner = 0; corner < this->Cells.cells()[cell].t->samples; ++corner)
    {
      this->addCorner(cell, corner, model);
    }
  }
  this->Boundary.add(this->Local, model);
}

//------------------------------------------------------------------------------
/// One step; false if none reduces the energy.
bool SlidingUntangler::step()
{
  constexpr int trials = 6, halvings = 4;
  constexpr double enough = 1e-4, good = 0.75, poor = 0.25, least = 1e-8;
  QuadraticModel model;
  this->linearize(model);
  const double before = this->energy(this->X);
  std::vector<Vec3> d;
  std::vector<double> damping(this->Moving.size());
  for (int trial = 0; trial < trials; ++trial)
  {
    for (std::size_t i = 0; i < damping.size(); ++i)
    {
      damping[i] = this->Damping * model.sizeOf(i);
    }
    // Levenberg-Marquardt: the damping grows until a step reduces the energy.
    const double promised = model.solve(damping, SolutionLimits(), d);
    if (!(promised < 0))
    {
      return false;
    }
    for (std::size_t i = 0; i < d.size(); ++i)
    {
      // Limit each displacement relative to the shortest edge of its point.
      const double most = longestStep * this->Shortest[this->Moving[i]], length = norm(d[i]);
      d[i] = length > most ? (most / length) * d[i] : d[i];
    }
    double t = 1;
    for (int half = 0; half <= halvings; ++half, t *= 0.5)
    {
      std::vector<Vec3> x = this->X;
      for (std::size_t i = 0; i < d.size(); ++i)
      {
        x[this->Moving[i]] += t * d[i];
      }
      const double now = this->energy(x);
      if (now < before + enough * t * promised)
      {
        this->Boundary.moveTo(x);
        this->X.swap(x);
        // Adapt the damping to the ratio of actual to predicted decrease.
        const double ratio = (now - before) / (t * promised);
        this->Damping *= half > 0 || ratio < poor ? 3.0 : ratio > good ? 0.3 : 1.0;
        this->Damping = std::max(this->Damping, least);
        return true;
      }
    }
    this->Damping *= 10;
  }
  return false;
}

//------------------------------------------------------------------------------
bool SlidingUntangler::run(int rings, int steps, const std::function<bool(Index)>& proceed)
{
  constexpr int selectEvery = 10, patience = 30;
  Index invalid = this->invalid(), fewest = invalid;
  int without = 0;
  for (int k = 0; k < steps && invalid > 0 && without < patience; ++k)
  {
    throwIfInterrupted();
    if (k % selectEvery == 0)
    {
      std::vector<char> cells(this->Cells.cells().size()), moving(this->X.size(), 0);
      for (std::size_t c = 0; c < cells.size(); ++c)
      {
        cells[c] = this->isInvalid(c);
      }
      this->Cells.flagPoints(cells, moving);
      for (int ring = 0; ring < rings; ++ring)
      {
        this->Cells.flagCells(moving, cells);
        this->Cells.flagPoints(cells, moving);
      }
      this->Boundary.flagBeyond(moving);
      this->select(std::move(moving));
      this->Damping = 1e-3;
    }
    // The regularization follows the smallest determinant, so that the energy is finite and becomes
    // exact as elements become valid.
    const double worst = std::min(this->leastDeterminant(), 0.0);
    this->Eps2 = leastEps2 + ofSmallest2 * worst * worst;
    const bool moved = this->step();
    invalid = this->invalid();
    without = invalid < fewest ? 0 : without + 1;
    fewest = std::min(fewest, invalid);
    if (!proceed(invalid) || !moved)
    {
      break;
    }
  }
  return invalid == 0;
}

//------------------------------------------------------------------------------
double SlidingUntangler::invertedVolume() const
{
  double mean = 0, sum = 0;
  for (const double size : this->Sizes)
  {
    mean += size / static_cast<double>(this->Sizes.size());
  }
  for (std::size_t c = 0; c < this->Sizes.size(); ++c)
  {
    const CellTopology& t = *this->Cells.cells()[c].t;
    const double unit = std::pow(this->Sizes[c] / mean, t.dimension);
    for (int corner = 0; corner < t.samples; ++corner)
    {
      sum += unit * std::max(0.0, -this->cornerOf(c, corner, this->X).determinant);
    }
  }
  return sum;
}

//------------------------------------------------------------------------------
void SlidingUntangler::smooth(int steps)
{
  std::vector<char> moving(this->X.size(), 0);
  for (const Index p : this->Moving)
  {
    moving[p] = 1;
  }
  this->Boundary.flagBeyond(moving);
  this->select(std::move(moving));
  this->Eps2 = leastEps2;
  for (int k = 0; k < steps && !this->Moving.empty() && this->step(); ++k)
  {
  }
}

//------------------------------------------------------------------------------
void SlidingUntangler::relax(int sweeps)
{
  const std::int32_t* parts = this->Constrained.constraints().parts;
  const auto partOf = [&](Index p) { return parts ? parts[p] : -1; };
  const auto canMove = [&](Index p) { return this->Constrained.freedom(p) != Freedom::None; };
  // Points of a part move to the mean of their neighbors on the same part and of their fixed
  // neighbors.
  std::vector<std::array<Index, 2>> pulls;
  for (const SlidingCells::Cell& cell : this->Cells.cells())
  {
    for (int e = 0; e < cell.t->edges; ++e)
    {
      const auto& [i, j] = cell.t->edgeNodes[e];
      for (const auto& [p, q] :
        { std::pair(cell.nodes[i], cell.nodes[j]), std::pair(cell.nodes[j], cell.nodes[i]) })
      {
        const bool within = partOf(p) < 0 && this->Constrained.freedom(p) != Freedom::Line;
        if (canMove(p) && (within || !canMove(q) || partOf(q) >= partOf(p)))
        {
          pulls.push_back({ p, q });
        }
      }
    }
  }
  std::sort(pulls.begin(), pulls.end());
  pulls.erase(std::unique(pulls.begin(), pulls.end()), pulls.end());
  for (int sweep = 0; sweep < sweeps; ++sweep)
  {
    throwIfInterrupted();
    for (std::size_t i = 0; i < pulls.size();)
    {
      const Index p = pulls[i][0];
      Vec3 sum = { 0, 0, 0 };
      std::size_t end = i;
      for (; end < pulls.size() && pulls[end][0] == p; ++end)
      {
        sum += this->X[pulls[end][1]];
      }
      const Vec3 d = (1.0 / static_cast<double>(end - i)) * sum - this->X[p];
      i = end;
      this->X[p] += allowed(this->Constrained.freedom(p), this->Constrained.direction(p), d);
      if (this->Constrained.band(p) >= 0)
      {
        this->X[p] = this->Constrained.nearest(this->Constrained.band(p), this->X[p]);
      }
    }
  }
  this->Boundary.select(std::vector<char>(this->X.size(), 1));
  this->Boundary.moveTo(this->X);
}

//------------------------------------------------------------------------------
double SlidingUntangler::energyWith(double eps)
{
  this->Eps2 = eps * eps;
  this->select(std::vector<char>(this->X.size(), 1));
  return this->energy(this->X);
}

void SlidingUntangler::modelWith(double eps, QuadraticModel& model)
{
  this->energyWith(eps);
  this->linearize(model);
}
}
