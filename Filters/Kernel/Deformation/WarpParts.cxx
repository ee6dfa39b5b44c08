// SPDX-License-Identifier: BSD-3-Clause
#include "WarpParts.h"

#include "tautline/Core/UnionFind.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>

namespace tautline
{
WarpParts::WarpParts(const Mesh& mesh, const unsigned char* prescribed, const Ranks& ranks)
  : TheRanks(ranks)
  , Dim(ranks.dimension(mesh))
{
  const MeshView& view = mesh.view();
  const Index n = view.numberOfPoints;
  this->Prescribed.assign(n, 0);
  if (prescribed)
  {
    std::transform(
      prescribed, prescribed + n, this->Prescribed.begin(), [](unsigned char f) { return f != 0; });
  }
  else
  {
    const Boundary boundary = mesh.boundary();
    std::copy(
      boundary.isBoundaryPoint.begin(), boundary.isBoundaryPoint.end(), this->Prescribed.begin());
  }

  // Parts are numbered in the order of their smallest points.
  UnionFind sets(n);
  std::vector<unsigned char> used(n, 0);
  for (const CellBlock& block : mesh.blocks())
  {
    const int nodes = topology(block.type).nodes;
    for (Index i = 0; i < block.count; ++i)
    {
      const Index* node = view.connectivity + view.offsets[block.cell(i)];
      used[node[0]] = 1;
      for (int k = 1; k < nodes; ++k)
      {
        used[node[k]] = 1;
        sets.join(node[0], node[k]);
      }
    }
  }
  this->Part = ranks.numberSets(sets, used, this->Count);

  // Parts without a prescribed point are loose: their points are held fixed.
  // the number of prescribed points of each part
  std::vector<double> prescribedOf(this->Count, 0.0);
  for (Index i = 0; i < n; ++i)
  {
    if (this->Prescribed[i] && used[i] && ranks.owns(i))
    {
      ++this->PrescribedPoints;
      ++prescribedOf[this->Part[i]];
    }
  }
  this->PrescribedPoints = ranks.sum(this->PrescribedPoints);
  ranks.sum(prescribedOf.data(), this->Count);
  this->Loose = std::count(prescribedOf.begin(), prescribedOf.end(), 0.0);
  this->Held.assign(n, 1);
  for (Index i = 0; i < n; ++i)
  {
    this->Held[i] = this->Prescribed[i] || !used[i] || prescribedOf[this->Part[i]] == 0;
    this->FreePoints += !this->Held[i] && ranks.owns(i);
  }
  this->FreePoints = ranks.sum(this->FreePoints);
}

//------------------------------------------------------------------------------
std::vector<char> WarpParts::moving(const double* displacement) const
{
  std::vector<double> moving(this->Count, 0.0); // the number of prescribed points of each part
  for (std::size_t i = 0; i < this->Part.size(); ++i)
  {
    const double* d = displacement + 3 * i;
    if (this->Prescribed[i] && this->Part[i] >= 0 && (d[0] != 0 || d[1] != 0 || d[2] != 0))
    {
      ++moving[this->Part[i]];
    }
  }
  this->TheRanks.sum(moving.data(), this->Count);
  std::vector<char> moves(moving.size());
  std::transform(moving.begin(), moving.end(), moves.begin(), [](double n) { return n > 0; });
  return moves;
}

//------------------------------------------------------------------------------
namespace
{
using Matrix = Eigen::Matrix3d;
using Vector = Eigen::Vector3d;

/// A least squares fit of displacements by offset + linear (x - center).
struct Fit
{
  double count = 0;
  Vector center = Vector::Zero();
  Matrix moments = Matrix::Zero(); ///< sum of x x^T from the center; later its pseudo-inverse
  Matrix linear = Matrix::Zero();  ///< its columns are derivatives
  Vector offset = Vector::Zero();

  double size() const { return std::max(1.0, this->count); }
};

constexpr std::size_t Components = 3; // of a vector

/// Replaces the second moments by their pseudo-inverse: directions in which the points extend by
/// less than a small fraction of their extent are treated as not spanned.
void invertMoments(Fit& fit)
{
  constexpr double flat = 1e-6;
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(fit.moments);
  Vector values = solver.eigenvalues();
  for (int k = 0; k < 3; ++k)
  {
    const bool spanned = values[k] > flat * flat * values[2];
    values[k] = spanned ? 1.0 / values[k] : 0.0;
  }
  fit.moments = solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
}

AffineMotion motionOf(const Fit& fit)
{
  AffineMotion motion;
  for (int c = 0; c < 3; ++c)
  {
    motion.center[c] = fit.center[c];
    motion.offset[c] = fit.offset[c];
    for (int k = 0; k < 3; ++k)
    {
      motion.linear[k][c] = fit.linear(c, k);
    }
  }
  return motion;
}
}

std::vector<AffineMotion> WarpParts::affine(const double* points, const double* displacement) const
{
  std::vector<Fit> fits(this->Count);
  const auto forEach = [&](const auto& visit)
  {
    for (std::size_t i = 0; i < this->Part.size(); ++i)
    {
      if (this->Prescribed[i] && this->Part[i] >= 0 && this->TheRanks.owns(static_cast<Index>(i)))
      {
        visit(fits[this->Part[i]], Eigen::Map<const Vector>(points + 3 * i),
          Eigen::Map<const Vector>(displacement + 3 * i));
      }
    }
  };
  forEach(
    [](Fit& fit, const auto& x, const auto&)
    {
      ++fit.count;
      fit.center += x;
    });
  addUp(this->TheRanks, fits,
    [](Fit& fit) {
      return std::array<double*, 2>{ &fit.count, fit.center.data() };
    },
    { 1, Components });
  for (Fit& fit : fits)
  {
    fit.center /= fit.size();
  }
  forEach([](Fit& fit, const auto& x, const auto&)
    { fit.moments += (x - fit.center) * (x - fit.center).transpose(); });
  addUp(this->TheRanks, fits, [](Fit& fit) { return std::array<double*, 1>{ fit.moments.data() }; },
    { Components * Components });
  std::for_each(fits.begin(), fits.end(), invertMoments);

  // The second round fits the rounding error of the first.
  constexpr int rounds = 2;
  for (int round = 0; round < rounds; ++round)
  {
    struct Sums
    {
      Vector rest = Vector::Zero();
      Matrix mixed = Matrix::Zero();
    };
    std::vector<Sums> sums(fits.size());
    forEach(
      [&](Fit& fit, const auto& x, const auto& d)
      {
        const Vector y = x - fit.center;
        const Vector rest = d - fit.offset - fit.linear * y;
        Sums& sum = sums[&fit - fits.data()];
        sum.rest += rest;
        sum.mixed += rest * y.transpose();
      });
    addUp(this->TheRanks, sums,
      [](Sums& sum) {
        return std::array<double*, 2>{ sum.rest.data(), sum.mixed.data() };
      },
      { Components, Components * Components });
    for (std::size_t p = 0; p < fits.size(); ++p)
    {
      fits[p].offset += sums[p].rest / fits[p].size();
      fits[p].linear += sums[p].mixed * fits[p].moments;
    }
  }
  std::vector<AffineMotion> motions(fits.size());
  std::transform(fits.begin(), fits.end(), motions.begin(), motionOf);
  return motions;
}

//------------------------------------------------------------------------------
std::vector<PrescribedPoint> WarpParts::prescribedOfAll(
  const MeshView& local, const double* displacement, const std::vector<WallPoint>& walls) const
{
  std::vector<PrescribedPoint> own, all;
  for (Index i = 0; i < local.numberOfPoints; ++i)
  {
    if (this->Prescribed[i] && this->TheRanks.owns(i))
    {
      own.push_back(
        { this->TheRanks.id(i), pointOf(local, i), {}, walls.empty() ? WallPoint() : walls[i] });
      std::copy_n(displacement + 3 * i, 3, own.back().displacement.begin());
    }
  }
  for (const std::vector<PrescribedPoint>& list : this->TheRanks.mesh().group().gatherItems(own))
  {
    all.insert(all.end(), list.begin(), list.end());
  }
  std::sort(all.begin(), all.end(),
    [](const PrescribedPoint& a, const PrescribedPoint& b) { return a.id < b.id; });
  return all;
}
}
