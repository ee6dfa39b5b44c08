// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryTerms.h"

#include <algorithm>

namespace tautline
{
namespace
{
/// Fraction of the tolerance: an excess of this size has the energy 1/2.
constexpr double unitOfExcess = 0.1;
/// Fraction of the tolerance: samples are pushed back starting this far before their limit.
constexpr double beforeLimit = 0.3;
/// Fraction of the tolerance: the distance of points from their parts without cost.
constexpr double freePart = 0.5;
}

//------------------------------------------------------------------------------
BoundaryTerms::BoundaryTerms(
  const Mesh& mesh, const ConstrainedPoints& constrained, const std::vector<Vec3>& x)
  : Constrained(constrained)
  , Samples(mesh, constrained, x)
  , X(x)
{
  for (std::size_t p = 0; p < x.size(); ++p)
  {
    const auto point = static_cast<Index>(p);
    if (constrained.band(point) >= 0)
    {
      const double distance = norm(this->offPart(point, x));
      this->Bands.push_back({ point, distance, distance });
    }
  }
  for (std::size_t i = 0; i < this->Samples.size(); ++i)
  {
    this->Upper.push_back(this->Samples.measure(i, x).value);
    this->Allowed.push_back(this->Samples.limit(i));
  }
  this->select(std::vector<char>(x.size(), 1));
}

//------------------------------------------------------------------------------
Vec3 BoundaryTerms::offPart(Index p, const std::vector<Vec3>& x) const
{
  return x[p] - this->Constrained.nearest(this->Constrained.band(p), x[p]);
}

double BoundaryTerms::stiffness() const
{
  const double unit = unitOfExcess * this->Constrained.tolerance();
  return this->Weight / (unit * unit);
}

double BoundaryTerms::freeBand() const
{
  return freePart * this->Constrained.tolerance();
}

/// Where the energy of a sample begins.
double BoundaryTerms::bound(std::size_t sample) const
{
  return this->Allowed[sample] - beforeLimit * this->Constrained.tolerance();
}

void BoundaryTerms::allowWhatIs()
{
  for (std::size_t i = 0; i < this->Allowed.size(); ++i)
  {
    this->Allowed[i] = std::max(this->Samples.limit(i), this->Upper[i]);
  }
}

//------------------------------------------------------------------------------
/// Computes the displacements of the points of the selected facets.
void BoundaryTerms::findMotion(const std::vector<Vec3>& x, std::vector<double>& ofFacets) const
{
  const std::vector<SurfaceFacet>& facets = this->Samples.facets();
  ofFacets.assign(facets.size(), 0.0);
  for (const std::int32_t f : this->Facets)
  {
    double most2 = 0;
    for (int k = 0; k < facets[f].size; ++k)
    {
      const Vec3 d = x[facets[f].nodes[k]] - this->X[facets[f].nodes[k]];
      most2 = std::max(most2, dot(d, d));
    }
    ofFacets[f] = std::sqrt(most2);
  }
}

//------------------------------------------------------------------------------
void BoundaryTerms::moveTo(const std::vector<Vec3>& x)
{
  for (const std::size_t i : this->Points)
  {
    Banded& band = this->Bands[i];
    band.upper += norm(x[band.point] - this->X[band.point]);
    if (band.upper > this->freeBand())
    {
      band.upper = norm(this->offPart(band.point, x));
    }
  }
  std::vector<double> motion;
  this->findMotion(x, motion);
  for (const std::size_t i : this->Chords)
  {
    this->Upper[i] += motion[this->Samples.facet(i)];
    if (this->Upper[i] > this->bound(i))
    {
      this->Samples.follow(i, x);
      this->Upper[i] = this->Samples.measure(i, x).value;
    }
  }
  this->X = x;
}

//------------------------------------------------------------------------------
double BoundaryTerms::value(const std::vector<Vec3>& x) const
{
  double sum = 0;
  const double free = this->freeBand();
  for (const std::size_t i : this->Points)
  {
    const Banded& band = this->Bands[i];
    if (band.upper + norm(x[band.point] - this->X[band.point]) > free)
    {
      const double over = std::max(0.0, norm(this->offPart(band.point, x)) - free);
      sum += over * over;
    }
  }
  std::vector<double> motion;
  this->findMotion(x, motion);
  for (const std::size_t i : this->Chords)
  {
    const double bound = this->bound(i);
    if (this->Upper[i] + motion[this->Samples.facet(i)] > bound)
    {
      const double over = std::max(0.0, this->Samples.measure(i, x).value - bound);
      sum += over * over;
    }
  }
  return 0.5 * this->stiffness() * sum;
}

//------------------------------------------------------------------------------
void BoundaryTerms::add(const std::vector<std::int32_t>& local, QuadraticModel& model) const
{
  const double free = this->freeBand(), w = this->stiffness();
  for (const std::size_t i : this->Points)
  {
    const Index p = this->Bands[i].point;
    if (!(this->Bands[i].upper > free) || local[p] < 0)
    {
      continue;
    }
    const Vec3 off = this->offPart(p, this->X);
    const double distance = norm(off), over = distance - free;
    if (over > 0)
    {
      const Vec3 n = (1.0 / distance) * off;
      model.addGradient(local[p], w * over * n);
      SymmetricBlock block;
      block.addOuter(n, w);
      model.addBlock(local[p], block);
    }
  }
  for (const std::size_t i : this->Chords)
  {
    if (!(this->Upper[i] > this->bound(i)))
    {
      continue;
    }
    const ChordSamples::Distance d = this->Samples.measure(i, this->X);
    const double over = d.value - this->bound(i);
    if (!(over > 0))
    {
      continue;
    }
    std::array<std::int32_t, MaxFaceNodes> points;
    std::array<Vec3, MaxFaceNodes> vectors;
    for (int k = 0; k < d.count; ++k)
    {
      points[k] = local[d.points[k]];
      vectors[k] = d.weights[k] * d.direction;
      model.addGradient(points[k], w * over * vectors[k]);
    }
    model.addRankOne(d.count, points.data(), vectors.data(), w);
  }
}

//------------------------------------------------------------------------------
void BoundaryTerms::select(const std::vector<char>& flags)
{
  this->Points.clear();
  for (std::size_t i = 0; i < this->Bands.size(); ++i)
  {
    if (flags[this->Bands[i].point])
    {
      this->Points.push_back(i);
    }
  }
  const std::vector<SurfaceFacet>& facets = this->Samples.facets();
  std::vector<char> moves(facets.size(), 0);
  this->Facets.clear();
  for (std::size_t f = 0; f < facets.size(); ++f)
  {
    moves[f] = std::any_of(facets[f].nodes.begin(), facets[f].nodes.begin() + facets[f].size,
      [&](Index p) { return flags[p] != 0; });
    if (moves[f])
    {
      this->Facets.push_back(static_cast<std::int32_t>(f));
    }
  }
  this->Chords.clear();
  for (std::size_t i = 0; i < this->Samples.size(); ++i)
  {
    if (moves[this->Samples.facet(i)])
    {
      this->Chords.push_back(i);
    }
  }
}

//------------------------------------------------------------------------------
void BoundaryTerms::flagBeyond(std::vector<char>& flags) const
{
  for (const Banded& band : this->Bands)
  {
    flags[band.point] |= band.upper > this->freeBand();
  }
  for (std::size_t i = 0; i < this->Upper.size(); ++i)
  {
    if (this->Upper[i] > this->Allowed[i])
    {
      const SurfaceFacet& facet = this->Samples.facets()[this->Samples.facet(i)];
      std::for_each(
        facet.nodes.begin(), facet.nodes.begin() + facet.size, [&](Index p) { flags[p] = 1; });
    }
  }
}

//------------------------------------------------------------------------------
void BoundaryTerms::indexSamples()
{
  const std::vector<SurfaceFacet>& facets = this->Samples.facets();
  this->FacetsAt.assign(this->X.size(), {});
  this->ChordsAt.assign(facets.size(), {});
  for (std::size_t f = 0; f < facets.size(); ++f)
  {
    for (int k = 0; k < facets[f].size; ++k)
    {
      this->FacetsAt[facets[f].nodes[k]].push_back(static_cast<std::int32_t>(f));
    }
  }
  for (std::size_t i = 0; i < this->Samples.size(); ++i)
  {
    this->ChordsAt[this->Samples.facet(i)].push_back(i);
  }
  this->BandAt.assign(this->X.size(), -1);
  for (std::size_t i = 0; i < this->Bands.size(); ++i)
  {
    this->BandAt[this->Bands[i].point] = static_cast<Index>(i);
  }
}

bool BoundaryTerms::allows(Index p, const std::vector<Vec3>& x) const
{
  for (const std::int32_t f : this->FacetsAt[p])
  {
    for (const std::size_t i : this->ChordsAt[f])
    {
      if (this->Samples.measure(i, x).value > std::max(this->Allowed[i], this->Upper[i]))
      {
        return false;
      }
    }
  }
  return true;
}

void BoundaryTerms::moveOne(Index p, const std::vector<Vec3>& x)
{
  for (const std::int32_t f : this->FacetsAt[p])
  {
    for (std::size_t k = 0; k < this->ChordsAt[f].size(); ++k)
    {
      const std::size_t i = this->ChordsAt[f][k];
      this->Samples.follow(i, x);
      this->Upper[i] = this->Samples.measure(i, x).value;
      if (this->Samples.facet(i) != f)
      {
        this->ChordsAt[this->Samples.facet(i)].push_back(i);
      }
    }
  }
  if (this->BandAt[p] >= 0)
  {
    this->Bands[this->BandAt[p]].upper = norm(this->offPart(p, x));
  }
  this->X[p] = x[p];
}

//------------------------------------------------------------------------------
bool BoundaryTerms::isWithin() const
{
  for (const Banded& band : this->Bands)
  {
    if (band.upper > band.atStart + this->Constrained.tolerance())
    {
      return false;
    }
  }
  for (std::size_t i = 0; i < this->Upper.size(); ++i)
  {
    if (this->Upper[i] > this->Allowed[i])
    {
      return false;
    }
  }
  return true;
}

double BoundaryTerms::farthestPoint() const
{
  double most = 0;
  for (const Banded& band : this->Bands)
  {
    most = std::max(most, band.upper - band.atStart);
  }
  return most;
}
}
