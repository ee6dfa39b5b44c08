// SPDX-License-Identifier: BSD-3-Clause
#include "EllipticChecks.h"

#include "ElementMatrices.h"
#include "FiniteElements.h"
#include "tautline/Core/UnionFind.h"
#include "tautline/Mesh/CoordinateFrame.h"
#include "tautline/Mesh/CurvedCells.h"

#include <limits>

namespace tautline
{
namespace
{
/// "3 elements (the first is cell 17)".
std::string elements(Index count, Index first)
{
  const std::string where =
    first >= 0 ? " (the first is cell " + std::to_string(first) + ")" : " (on other ranks)";
  return std::to_string(count) + (count == 1 ? " element" : " elements") + where;
}

/// Sylvester's criterion for a symmetric matrix with the rows a d f, d b e, f e c; c = 1, e = f = 0
/// for the plane.
bool positiveDefinite(double a, double b, double c, double d, double e, double f)
{
  const double second = a * b - d * d;
  const double third = c * second - e * (a * e - d * f) + f * (d * e - b * f);
  return a > 0 && second > 0 && third > 0;
}

bool isElliptic(const Mesh& mesh, const SymmetricTensor& c)
{
  if (mesh.dimension() != Dimension::Planar)
  {
    return positiveDefinite(c[0], c[1], c[2], c[3], c[4], c[5]);
  }
  const auto& e = mesh.frame();
  return positiveDefinite(dot(e[0], applyTensor(c, e[0])), dot(e[1], applyTensor(c, e[1])), 1,
    dot(e[0], applyTensor(c, e[1])), 0, 0);
}

/// Fixed points of a part that do not all coincide (or lie on one line), as far as needed.
struct Anchors
{
  int count = 0;
  Index first = -1, second = -1;

  void add(const MeshView& view, Index point)
  {
    constexpr double tolerance = 1e-10; // sine of the angle below which three points are collinear
    if (this->count == 0)
    {
      this->first = point;
      this->count = 1;
    }
    const Vec3 p = pointOf(view, point) - pointOf(view, this->first);
    if (this->count == 1 && norm(p) > 0)
    {
      this->second = point;
      this->count = 2;
    }
    if (this->count == 2)
    {
      const Vec3 q = pointOf(view, this->second) - pointOf(view, this->first);
      this->count = norm(cross(p, q)) > tolerance * norm(p) * norm(q) ? 3 : 2;
    }
  }
};
}

//------------------------------------------------------------------------------
EllipticChecks::EllipticChecks(const Mesh& mesh, const EllipticProblem& problem,
  const MeshPart& part, const PointNumbering& numbering, int threads)
  : Input(mesh)
  , Problem(problem)
  , Part(part)
  , Numbering(numbering)
  , Threads(threads)
{
}

void EllipticChecks::throwTogether(const std::string& message) const
{
  const bool anywhere = this->Numbering.maximum(message.empty() ? 0.0 : 1.0) > 0;
  if (anywhere)
  {
    throw Error(
      message.empty() ? "Another rank rejected its part of the mesh; see its message." : message);
  }
}

//------------------------------------------------------------------------------
void EllipticChecks::requireCoefficients() const
{
  const Index cells = this->Input.view().numberOfCells;
  if (cells > 0)
  {
    requireElements(this->Input, this->Part.skip);
  }
  if (this->Problem.pde != Pde::Elliptic)
  {
    return;
  }
  const DiffusionOperator& pde = this->Problem.diffusion;
  const std::string remedy = " is not positive definite: the equation is not elliptic. Make alpha, "
                             "beta (and gamma) positive.";
  if (!pde.tensors && !isElliptic(this->Input, pde.tensor))
  {
    throw Error("The coefficient matrix" + remedy);
  }
  for (Index cell = 0; pde.tensors && cell < cells; ++cell)
  {
    SymmetricTensor c;
    std::copy_n(pde.tensors + 6 * cell, 6, c.begin());
    if (!this->skipped(cell) && !isElliptic(this->Input, c))
    {
      throw Error("The coefficient matrix of cell " + std::to_string(cell) + remedy);
    }
  }
}

//------------------------------------------------------------------------------
void EllipticChecks::requireValidElements() const
{
  const Index cells = this->Input.view().numberOfCells;
  std::vector<signed char> validity(cells);
  this->Input.classifyCells(validity.data(), this->Threads);
  certifyCurvedCells(this->Input, {}, validity.data(), nullptr, this->Threads);
  // Counted over all ranks; the first cell of each kind is of this rank.
  struct Kind
  {
    Index count = 0, first = -1;
    void add(Index cell) { this->first = this->count++ == 0 ? cell : this->first; }
  } valid, degenerate, inverted, nonFinite;
  for (Index cell = 0; cell < cells; ++cell)
  {
    if (!this->skipped(cell))
    {
      Kind& kind = validity[cell] == Valid ? valid
        : validity[cell] == Degenerate     ? degenerate
        : validity[cell] == Inverted       ? inverted
                                           : nonFinite;
      kind.add(cell);
    }
  }
  for (Kind* kind : { &valid, &degenerate, &inverted, &nonFinite })
  {
    kind->count = this->Numbering.sum(kind->count);
  }
  if (valid.count + degenerate.count + inverted.count + nonFinite.count == 0)
  {
    throw Error("The mesh has no cells that finite elements support: triangles, quadrilaterals, "
                "tetrahedra, hexahedra, wedges or pyramids.");
  }
  Index linear = 0, quadratic = 0;
  for (Index cell = 0; cell < cells; ++cell)
  {
    const ElementKind kind = elementKind(this->Input.view(), cell);
    quadratic += !this->skipped(cell) && isQuadratic(kind);
    linear += !this->skipped(cell) && kind != ElementKind::None && !isQuadratic(kind);
  }
  linear = this->Numbering.sum(linear);
  quadratic = this->Numbering.sum(quadratic);
  if (linear > 0 && quadratic > 0)
  {
    refuseMixedOrders(linear, quadratic); // on different ranks
  }
  if (nonFinite.count > 0)
  {
    throw Error(elements(nonFinite.count, nonFinite.first) +
      " have coordinates that are not finite. Check the points array.");
  }
  // The range over the cells of all ranks, so that all ranks throw.
  const CoordinateRange range = coordinateRange(this->Input.view());
  if (this->Numbering.sum(Index(unitOfExtent(range.extent) != 1)) > 0)
  {
    requireOrdinaryScale(this->Input.view(), "A finite element matrix");
    throw Error(
      "A finite element matrix needs cells of ordinary size on every rank: scale the mesh "
      "first (filter Transform).");
  }
  if (degenerate.count > 0)
  {
    throw Error(elements(degenerate.count, degenerate.first) +
      " degenerate: no area or volume. Run Untangle Mesh, or remove them.");
  }
  // A fully reversed mesh is accepted.
  const Kind& odd = inverted.count <= valid.count ? inverted : valid;
  if (inverted.count > 0 && valid.count > 0)
  {
    throw Error(elements(odd.count, odd.first) +
      " inverted against the rest: a solution would be meaningless. Run Untangle Mesh first, "
      "or orient the cells consistently if only their point order differs.");
  }
}

//------------------------------------------------------------------------------
std::vector<unsigned char> EllipticChecks::usedPoints() const
{
  const MeshView& view = this->Input.view();
  std::vector<unsigned char> used(view.numberOfPoints, 0);
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    for (Index k = view.offsets[cell]; k < view.offsets[cell + 1] && !this->skipped(cell); ++k)
    {
      used[view.connectivity[k]] = 1;
    }
  }
  this->Numbering.either(used.data());
  return used;
}

//------------------------------------------------------------------------------
void EllipticChecks::requireData(
  const std::vector<unsigned char>& used, const std::vector<unsigned char>& fixed) const
{
  const int components = this->Problem.pde == Pde::Elasticity ? 3 : 1;
  const auto requireFinite = [&](const double* values, bool onlyFixed, const char* name)
  {
    for (std::size_t point = 0; values && point < used.size(); ++point)
    {
      for (int k = 0; used[point] && (fixed[point] || !onlyFixed) && k < components; ++k)
      {
        if (!std::isfinite(values[components * point + k]))
        {
          throw Error(
            std::string(name) + " is not a finite number at point " + std::to_string(point) + ".");
        }
      }
    }
  };
  for (int k = 0; !this->Problem.sources && k < components; ++k)
  {
    if (!std::isfinite(this->Problem.source[k]))
    {
      throw Error("The source f is not a finite number.");
    }
  }
  requireFinite(this->Problem.sources, false, "The source f");
  requireFinite(this->Problem.fixedValues, true, "The given value");
  if (components == 3)
  {
    if (!this->Problem.sources)
    {
      const std::vector<unsigned char> one = { 1 };
      this->requireInPlane(this->Problem.source.data(), one, "The body force f");
    }
    this->requireInPlane(this->Problem.sources, used, "The body force f");
    std::vector<unsigned char> usedFixed(used);
    for (std::size_t point = 0; point < used.size(); ++point)
    {
      usedFixed[point] = used[point] && fixed[point];
    }
    this->requireInPlane(this->Problem.fixedValues, usedFixed, "The given displacement");
  }
}

/// Checks vectors of a planar body, whose points only move in its plane.
void EllipticChecks::requireInPlane(
  const double* vectors, const std::vector<unsigned char>& where, const char* name) const
{
  if (!vectors || this->Input.dimension() != Dimension::Planar)
  {
    return;
  }
  constexpr double tolerance = 1e-6; // the tolerance of a planar mesh
  double most = 0, out = 0;
  for (std::size_t i = 0; i < where.size(); ++i)
  {
    if (where[i])
    {
      const Vec3 v = { vectors[3 * i], vectors[3 * i + 1], vectors[3 * i + 2] };
      most = std::max(most, norm(v));
      out = std::max(out, std::abs(dot(v, this->Input.normal())));
    }
  }
  if (out > tolerance * most)
  {
    throw Error(std::string(name) +
      " points out of the plane of the mesh, in which a planar body moves. Use a vector in "
      "that plane.");
  }
}

//------------------------------------------------------------------------------
/// A part held on one rank is held on all ranks that share its points: repeats until nothing
/// changes on any rank.
void EllipticChecks::spreadHeld(UnionFind& parts, std::vector<unsigned char>& held) const
{
  const auto points = static_cast<Index>(held.size());
  Index before = -1;
  for (Index count = 0; count != before && this->Numbering.ranks() > 1;)
  {
    before = count;
    std::vector<unsigned char> heldParts(held.size(), 0);
    for (Index point = 0; point < points; ++point)
    {
      heldParts[parts.find(point)] |= held[point];
    }
    for (Index point = 0; point < points; ++point)
    {
      held[point] = heldParts[parts.find(point)];
    }
    this->Numbering.either(held.data());
    count = this->Numbering.sum(
      static_cast<Index>(std::count(held.begin(), held.end(), static_cast<unsigned char>(1))));
  }
}

//------------------------------------------------------------------------------
void EllipticChecks::requireFixedParts(
  const std::vector<unsigned char>& used, const std::vector<unsigned char>& fixed) const
{
  const bool elastic = this->Problem.pde == Pde::Elasticity;
  if (this->Problem.pde == Pde::Elliptic && this->Problem.diffusion.reaction != 0)
  {
    return;
  }
  const MeshView& view = this->Input.view();
  // Points connected by cells form one part.
  UnionFind parts(view.numberOfPoints);
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    for (Index k = view.offsets[cell] + 1; k < view.offsets[cell + 1] && !this->skipped(cell); ++k)
    {
      parts.join(view.connectivity[view.offsets[cell]], view.connectivity[k]);
    }
  }
  // A body needs as many fixed points as prevent a rigid motion: 1, 2 or 3. On several ranks the
  // fixed points of a part may be spread, so that only one is required.
  const bool oneRank = this->Numbering.ranks() == 1;
  const int needed = !elastic || !oneRank          ? 1
    : this->Input.dimension() == Dimension::Planar ? 2
                                                   : 3;
  std::vector<Anchors> anchors(view.numberOfPoints);
  std::vector<unsigned char> held(view.numberOfPoints, 0); // points of parts that are held
  for (Index point = 0; point < view.numberOfPoints; ++point)
  {
    if (used[point] && fixed[point])
    {
      anchors[parts.find(point)].add(view, point);
    }
  }
  for (Index point = 0; point < view.numberOfPoints; ++point)
  {
    held[point] = anchors[parts.find(point)].count >= needed;
  }
  this->spreadHeld(parts, held);
  // Parts without sufficient fixed points, each counted once.
  Index loose = 0, first = -1;
  std::vector<unsigned char> counted(view.numberOfPoints, 0);
  for (Index point = 0; point < view.numberOfPoints; ++point)
  {
    const Index part = parts.find(point);
    if (used[point] && !fixed[point] && !held[point] && !counted[part])
    {
      counted[part] = 1;
      first = loose++ == 0 ? point : first;
    }
  }
  std::string message;
  if (loose > 0)
  {
    message = std::to_string(loose) + (loose == 1 ? " part" : " parts") +
      " of the mesh (the first holds point " + std::to_string(first) + ")";
    const std::string number = needed == 3 ? "three noncollinear points" : "two points";
    message += elastic
      ? " can move as a whole: too few of its points are fixed, and the matrix is singular. Fix at "
        "least " +
        (oneRank ? number : std::string("two points (in space three)")) + " of each part."
      : " without a fixed point: the solution there is determined only up to a constant, and the "
        "matrix is singular. Fix a point of each part, or choose a > 0.";
  }
  this->throwTogether(message);
}

//------------------------------------------------------------------------------
/// Planarity is determined from the corners; the other nodes of quadratic elements must also lie in
/// the plane.
void EllipticChecks::requireFlatElements() const
{
  constexpr double tolerance = 1e-6; // the tolerance of a planar mesh
  const MeshView& view = this->Input.view();
  double low = std::numeric_limits<double>::max(), high = -low;
  for (Index cell = 0; this->Input.higherOrderCells() > 0 && cell < view.numberOfCells; ++cell)
  {
    for (Index k = view.offsets[cell]; k < view.offsets[cell + 1] && !this->skipped(cell); ++k)
    {
      const double height = dot(pointOf(view, view.connectivity[k]), this->Input.normal());
      low = std::min(low, height);
      high = std::max(high, height);
    }
  }
  if (high - low > tolerance * coordinateRange(view).extent)
  {
    throw Error(
      "The corners of the elements lie in a plane, but their other nodes do not: this is a "
      "surface in space, a shell. Linear elasticity needs a planar mesh or a volume mesh.");
  }
}

//------------------------------------------------------------------------------
int EllipticChecks::elasticUnknowns() const
{
  int own = 0;
  this->everywhere(
    [&]()
    {
      own = this->Input.view().numberOfCells > 0 ? elasticComponents(this->Input) : 0;
      if (own == 2)
      {
        this->requireFlatElements();
      }
    });
  const int all = static_cast<int>(this->Numbering.maximum(own));
  // Parts that are each planar must share one plane and its axes.
  constexpr double tolerance = 1e-6, nothing = -10;
  double apart = 0;
  for (int k = 0; all == 2 && k < 6; ++k)
  {
    const double x = this->Input.frame()[k / 3][k % 3];
    const double most = this->Numbering.maximum(own == 2 ? x : nothing),
                 least = -this->Numbering.maximum(own == 2 ? -x : nothing);
    apart = std::max(apart, most - least);
  }
  this->throwTogether((own > 0 && own != all) || apart > tolerance
      ? "The parts of the mesh on the ranks are not in one plane: linear elasticity needs a "
        "planar mesh or a volume mesh, and this is a surface in space. Rotate a planar mesh in "
        "an oblique plane into the xy plane first."
      : "");
  return all;
}
}
