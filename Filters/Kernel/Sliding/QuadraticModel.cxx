// SPDX-License-Identifier: BSD-3-Clause
#include "QuadraticModel.h"

#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
double product(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    sum += dot(a[i], b[i]);
  }
  return sum;
}

/// The inverse of a positive definite block; otherwise, the inverse of its trace times the
/// identity.
SymmetricBlock inverseOf(const SymmetricBlock& block)
{
  const auto& [xx, xy, xz, yy, yz, zz] = block.entries;
  // The cofactors of the first row.
  const double a = yy * zz - yz * yz, b = xz * yz - xy * zz, c = xy * yz - xz * yy;
  const double det = xx * a + xy * b + xz * c, trace = xx + yy + zz;
  constexpr double singular = 1e-12;
  SymmetricBlock result;
  if (!(trace > 0))
  {
    return result;
  }
  if (!(det > singular * trace * trace * trace) || !(a > 0))
  {
    result.addIdentity(1.0 / trace);
    return result;
  }
  const double f = 1.0 / det;
  result.entries = { f * a, f * b, f * c, f * (xx * zz - xz * xz), f * (xy * xz - xx * yz),
    f * (xx * yy - xy * xy) };
  return result;
}
}

//------------------------------------------------------------------------------
void SymmetricBlock::addOuter(const Vec3& v, double factor)
{
  auto& e = this->entries;
  e[0] += factor * v[0] * v[0];
  e[1] += factor * v[0] * v[1];
  e[2] += factor * v[0] * v[2];
  e[3] += factor * v[1] * v[1];
  e[4] += factor * v[1] * v[2];
  e[5] += factor * v[2] * v[2];
}

void SymmetricBlock::addIdentity(double factor)
{
  this->entries[0] += factor;
  this->entries[3] += factor;
  this->entries[5] += factor;
}

Vec3 SymmetricBlock::operator*(const Vec3& v) const
{
  const auto& e = this->entries;
  return { e[0] * v[0] + e[1] * v[1] + e[2] * v[2], e[1] * v[0] + e[3] * v[1] + e[4] * v[2],
    e[2] * v[0] + e[4] * v[1] + e[5] * v[2] };
}

//------------------------------------------------------------------------------
Vec3 allowed(Freedom freedom, const Vec3& direction, const Vec3& d)
{
  switch (freedom)
  {
    case Freedom::Line:
      return dot(d, direction) * direction;
    case Freedom::Plane:
      return d - dot(d, direction) * direction;
    case Freedom::Space:
      return d;
    default:
      return { 0, 0, 0 };
  }
}

//------------------------------------------------------------------------------
void QuadraticModel::start(std::size_t points)
{
  this->Gradient.assign(points, { 0, 0, 0 });
  this->Directions.assign(points, { 0, 0, 0 });
  this->Freedoms.assign(points, Freedom::Space);
  this->Own.assign(points, {});
  this->Sums.assign(points, {});
  this->RankOnes.clear();
  this->Ends.clear();
  this->Vectors.clear();
  this->Edges.clear();
  this->Corners.clear();
}

void QuadraticModel::setFreedom(std::int32_t i, Freedom freedom, const Vec3& direction)
{
  this->Freedoms[i] = freedom;
  this->Directions[i] = direction;
}

void QuadraticModel::addGradient(std::int32_t i, const Vec3& g)
{
  if (i >= 0)
  {
    this->Gradient[i] += g;
  }
}

void QuadraticModel::addRankOne(
  int count, const std::int32_t* points, const Vec3* vectors, double factor)
{
  RankOne term = { static_cast<std::int32_t>(this->Ends.size()), 0, factor };
  for (int k = 0; k < count; ++k)
  {
    if (points[k] >= 0)
    {
      this->Ends.push_back(points[k]);
      this->Vectors.push_back(vectors[k]);
      this->Sums[points[k]].addOuter(vectors[k], factor);
      ++term.count;
    }
  }
  this->RankOnes.push_back(term);
}

void QuadraticModel::addEdge(std::int32_t a, std::int32_t b, double stiffness)
{
  for (std::int32_t i : { a, b })
  {
    if (i >= 0)
    {
      this->Sums[i].addIdentity(stiffness);
    }
  }
  if (a >= 0 && b >= 0)
  {
    this->Edges.push_back({ a, b, stiffness });
  }
  else if (a >= 0 || b >= 0)
  {
    this->Own[std::max(a, b)].addIdentity(stiffness);
  }
}

void QuadraticModel::addBlock(std::int32_t i, const SymmetricBlock& block)
{
  for (std::size_t k = 0; i >= 0 && k < block.entries.size(); ++k)
  {
    this->Own[i].entries[k] += block.entries[k];
    this->Sums[i].entries[k] += block.entries[k];
  }
}

//------------------------------------------------------------------------------
void QuadraticModel::addCorner(const CornerBlock& corner)
{
  this->Corners.push_back(corner);
  // The weights of the four points sum to zero, because a translation does not change the corner.
  Vec3 weights[4] = { { 0, 0, 0 }, corner.weights[0], corner.weights[1], corner.weights[2] };
  weights[0] = -1.0 * (weights[1] + weights[2] + weights[3]);
  for (int k = 0; k < 4; ++k)
  {
    const std::int32_t i = corner.points[k];
    if (i < 0)
    {
      continue;
    }
    Vec3 ofNorm = { 0, 0, 0 }, ofDeterminant = { 0, 0, 0 };
    for (int j = 0; j < 3; ++j)
    {
      ofNorm += weights[k][j] * corner.jacobian[j];
      ofDeterminant += weights[k][j] * corner.cofactor[j];
    }
    SymmetricBlock& block = this->Sums[i];
    block.addIdentity(corner.ofNorm * dot(weights[k], weights[k]));
    // Write the mixed form as a difference of squares.
    block.addOuter(ofNorm + ofDeterminant, 0.5 * corner.ofMixed);
    block.addOuter(ofNorm - ofDeterminant, -0.5 * corner.ofMixed);
    block.addOuter(ofDeterminant, corner.ofDeterminant);
  }
}

//------------------------------------------------------------------------------
void QuadraticModel::apply(const std::vector<Vec3>& d, std::vector<Vec3>& result) const
{
  for (std::size_t i = 0; i < d.size(); ++i)
  {
    result[i] = this->Own[i] * d[i];
  }
  for (const RankOne& term : this->RankOnes)
  {
    double along = 0;
    for (std::int32_t k = term.begin; k < term.begin + term.count; ++k)
    {
      along += dot(this->Vectors[k], d[this->Ends[k]]);
    }
    along *= term.factor;
    for (std::int32_t k = term.begin; k < term.begin + term.count; ++k)
    {
      result[this->Ends[k]] += along * this->Vectors[k];
    }
  }
  for (const Edge& edge : this->Edges)
  {
    // Edges act as springs.
    const Vec3 force = edge.stiffness * (d[edge.a] - d[edge.b]);
    result[edge.a] += force;
    result[edge.b] -= force;
  }
  for (const CornerBlock& corner : this->Corners)
  {
    const auto at = [&](int k) {
      return corner.points[k] < 0 ? Vec3{ 0, 0, 0 } : d[corner.points[k]];
    };
    // Corners: the change of the Jacobian matrix gives the changes of the norm and the determinant,
    // and the quadratic form in these three gives the forces.
    const Vec3 origin = at(0);
    Columns change = {};
    for (int k = 0; k < 3; ++k)
    {
      const Vec3 edge = at(k + 1) - origin;
      for (int j = 0; j < 3; ++j)
      {
        change[j] += corner.weights[k][j] * edge;
      }
    }
    double ofNorm = 0, ofDeterminant = 0;
    for (int j = 0; j < 3; ++j)
    {
      ofNorm += dot(corner.jacobian[j], change[j]);
      ofDeterminant += dot(corner.cofactor[j], change[j]);
    }
    const double alongNorm = corner.ofMixed * ofDeterminant;
    const double alongDeterminant = corner.ofMixed * ofNorm + corner.ofDeterminant * ofDeterminant;
    Columns force;
    for (int j = 0; j < 3; ++j)
    {
      force[j] = corner.ofNorm * change[j] + alongNorm * corner.jacobian[j] +
        alongDeterminant * corner.cofactor[j];
    }
    for (int k = 0; k < 3; ++k)
    {
      const Vec3& w = corner.weights[k];
      const Vec3 f = w[0] * force[0] + w[1] * force[1] + w[2] * force[2];
      if (corner.points[k + 1] >= 0)
      {
        result[corner.points[k + 1]] += f;
      }
      if (corner.points[0] >= 0)
      {
        result[corner.points[0]] -= f;
      }
    }
  }
}

//------------------------------------------------------------------------------
/// The inverse blocks of the points, each restricted to the freedom of the point.
std::vector<SymmetricBlock> QuadraticModel::preconditioner(const std::vector<double>& damping) const
{
  std::vector<SymmetricBlock> inverse(this->Sums);
  for (std::size_t i = 0; i < inverse.size(); ++i)
  {
    SymmetricBlock& block = inverse[i];
    block.addIdentity(damping[i]);
    const Vec3& n = this->Directions[i];
    if (this->Freedoms[i] == Freedom::Line)
    {
      const double along = dot(n, block * n);
      block = {};
      block.addOuter(n, along > 0 ? 1.0 / along : 0.0);
      continue;
    }
    if (this->Freedoms[i] == Freedom::Plane)
    {
      // P B P + t n n^T, where P projects out the normal n.
      const Vec3 bn = block * n;
      const double nbn = dot(n, bn);
      const double size = block.entries[0] + block.entries[3] + block.entries[5];
      block.addOuter(bn + n, -0.5);
      block.addOuter(bn - n, 0.5);
      block.addOuter(n, nbn + size);
    }
    block = inverseOf(block);
  }
  return inverse;
}

//------------------------------------------------------------------------------
double QuadraticModel::solve(
  const std::vector<double>& damping, const SolutionLimits& limits, std::vector<Vec3>& step) const
{
  const std::size_t n = this->Gradient.size();
  step.assign(n, { 0, 0, 0 });
  const std::vector<SymmetricBlock> inverse = this->preconditioner(damping);
  // Preconditioned conjugate gradients on the allowed displacements, up to a direction of negative
  // curvature.
  std::vector<Vec3> r(n), z(n), d, hd(n);
  const auto precondition = [&]
  {
    for (std::size_t i = 0; i < n; ++i)
    {
      z[i] = this->allow(i, inverse[i] * r[i]);
    }
  };
  for (std::size_t i = 0; i < n; ++i)
  {
    r[i] = -1.0 * this->allow(i, this->Gradient[i]);
  }
  precondition();
  d = z;
  double rz = product(r, z);
  const double enough = limits.relativeResidual * limits.relativeResidual * rz;
  for (int k = 0; k < limits.iterations && rz > enough; ++k)
  {
    throwIfInterrupted();
    this->apply(d, hd);
    for (std::size_t i = 0; i < n; ++i)
    {
      hd[i] = this->allow(i, hd[i] + damping[i] * d[i]);
    }
    const double curvature = product(d, hd);
    if (!(curvature > 0))
    {
      break;
    }
    const double length = rz / curvature;
    for (std::size_t i = 0; i < n; ++i)
    {
      step[i] += length * d[i];
      r[i] -= length * hd[i];
    }
    precondition();
    const double next = product(r, z), ratio = next / rz;
    rz = next;
    for (std::size_t i = 0; i < n; ++i)
    {
      d[i] = z[i] + ratio * d[i];
    }
  }
  // g.p + p.H p / 2, where H p = -g - r - damping p.
  double promised = 0;
  for (std::size_t i = 0; i < n; ++i)
  {
    promised += 0.5 * dot(this->Gradient[i] - r[i] - damping[i] * step[i], step[i]);
  }
  return std::min(promised, 0.0);
}
}
