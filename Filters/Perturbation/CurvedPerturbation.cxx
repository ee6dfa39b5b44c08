// SPDX-License-Identifier: BSD-3-Clause
#include "CurvedPerturbation.h"

#include "PointMerge.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
CurvedPerturbation::CurvedPerturbation(const CurvedMesh& curved, const MeshAdapter& corners,
  const std::vector<unsigned char>& fixed, bool single, int threads)
  : Curved(curved)
  , Corners(corners)
  , Fixed(fixed)
  , Single(single)
  , Threads(threads)
  , Before(corners.inputView().points)
{
}

//------------------------------------------------------------------------------
Index CurvedPerturbation::finish(Perturbation& result, bool keepValid) const
{
  std::vector<double>& points = result.points;
  const std::vector<signed char> before =
    this->validity({ this->Before, this->Before + points.size() });
  std::vector<double> corners = points;
  std::vector<unsigned char> times(points.size() / 3, 0);
  this->place(points);
  std::vector<signed char> after = this->validity(points);
  while (keepValid && this->retreat(this->aroundWorse(before, after), times, corners, result))
  {
    points = corners;
    this->place(points);
    after = this->validity(points);
  }
  this->report(before, after, result);
  return std::count_if(times.begin(), times.end(), [](unsigned char n) { return n > 0; });
}

//------------------------------------------------------------------------------
/// Halves the displacements of flagged corners; finally they return to their original positions.
/// @return whether any moved
bool CurvedPerturbation::retreat(const std::vector<unsigned char>& around,
  std::vector<unsigned char>& times, std::vector<double>& corners, Perturbation& result) const
{
  constexpr int halvings = 4;
  bool changed = false;
  for (std::size_t i = 0; i < around.size(); ++i)
  {
    double* p = &corners[3 * i];
    const double* rest = this->Before + 3 * i;
    if (!around[i] || std::equal(p, p + 3, rest))
    {
      continue;
    }
    const bool back = ++times[i] > halvings;
    for (int c = 0; c < 3; ++c)
    {
      p[c] = back ? rest[c] : this->rounded(rest[c] + 0.5 * (p[c] - rest[c]));
    }
    changed = true;
    result.moved -= std::equal(p, p + 3, rest);
  }
  return changed;
}

//------------------------------------------------------------------------------
double CurvedPerturbation::rounded(double x) const
{
  return this->Single ? static_cast<double>(static_cast<float>(x)) : x;
}

//------------------------------------------------------------------------------
void CurvedPerturbation::place(std::vector<double>& points) const
{
  spread(points, 3, this->Corners.coincident().representative);
  const FollowingNodes& nodes = this->Curved.nodes();
  nodes.place(this->Before, points, this->Threads);
  for (const Index point : nodes.points())
  {
    const bool stays = this->Fixed[point] || nodes.boundary()[point];
    for (Index c = 3 * point; c < 3 * point + 3; ++c)
    {
      points[c] = stays ? this->Before[c] : this->rounded(points[c]);
    }
  }
  nodes.unite(points);
}

//------------------------------------------------------------------------------
std::vector<signed char> CurvedPerturbation::validity(const std::vector<double>& points) const
{
  std::vector<double> inFrame = points;
  this->Corners.frame().enter(inFrame);
  const Mesh mesh = this->Corners.mesh().at(inFrame.data());
  std::vector<signed char> validity(mesh.view().numberOfCells);
  mesh.classifyCells(validity.data(), this->Threads);
  this->Curved.certify(points, validity);
  return validity;
}

//------------------------------------------------------------------------------
/// The corners of the cells around invalidated cells: their motions move the nodes of these cells.
std::vector<unsigned char> CurvedPerturbation::aroundWorse(
  const std::vector<signed char>& before, const std::vector<signed char>& after) const
{
  const MeshView& view = this->Corners.mesh().view();
  std::vector<unsigned char> marked(view.numberOfPoints, 0), around = marked;
  const auto markCell = [&view](Index cell, std::vector<unsigned char>& flags)
  {
    for (Index n = view.offsets[cell]; n < view.offsets[cell + 1]; ++n)
    {
      flags[view.connectivity[n]] = 1;
    }
  };
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    if (before[cell] == Valid && after[cell] != Valid)
    {
      markCell(cell, marked);
    }
  }
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const auto *begin = view.connectivity + view.offsets[cell],
               *end = view.connectivity + view.offsets[cell + 1];
    if (std::any_of(begin, end, [&](Index point) { return marked[point] != 0; }))
    {
      markCell(cell, around);
    }
  }
  return around;
}

//------------------------------------------------------------------------------
void CurvedPerturbation::report(const std::vector<signed char>& before,
  const std::vector<signed char>& after, Perturbation& result) const
{
  const Mesh& mesh = this->Corners.mesh();
  const int dimension = mesh.dimension() == Dimension::Volume ? 3 : 2;
  result.invertedBefore = result.invertedAfter = 0;
  for (const CellBlock& block : mesh.blocks())
  {
    const bool elements = topology(block.type).dimension == dimension;
    for (Index i = 0; elements && i < block.count; ++i)
    {
      result.invertedBefore += before[block.cell(i)] == Inverted;
      result.invertedAfter += after[block.cell(i)] == Inverted;
    }
  }
  result.largestDisplacement = 0;
  for (std::size_t i = 0; i < result.points.size(); i += 3)
  {
    const double length = std::hypot(result.points[i] - this->Before[i],
      result.points[i + 1] - this->Before[i + 1], result.points[i + 2] - this->Before[i + 2]);
    result.largestDisplacement = std::max(result.largestDisplacement, length); // not NaN
  }
}
}
