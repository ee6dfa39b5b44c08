// SPDX-License-Identifier: BSD-3-Clause
// Operations in the metric of the points: for the lengths of edges, and for shapes in it.
#include "CavityOperations.h"

#include "Constants.h"
#include "NewtonStep.h"

#include <limits>

namespace tautline
{
namespace
{
/// A split may reduce the smallest surrounding quality to this fraction, or to this quality,
/// whichever is less: it is improved later.
constexpr double SplitShare = 0.3, SplitQuality = 0.02;
/// The same for contractions.
constexpr double ContractionShare = 0.6, ContractionQuality = 0.2;
/// Weight of the squared logarithm of the length of an edge relative to the inverse mean ratio of a
/// tetrahedron.
constexpr double LengthWeight = 1.0;
/// The inverse mean ratio is S / (12 (d / 2)^(2/3)), see metricShape() for S and d.
constexpr double ShapeFactor = 12.0;
/// A motion must decrease the sum by this fraction.
constexpr double LeastRelaxation = 1e-3;
/// A motion for the sum may reduce the smallest surrounding quality to this fraction.
constexpr double RelaxationShare = 0.8;
/// Squared lengths below this are treated as zero.
constexpr double LeastLength2 = 1e-200;

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d matrixOf(const MetricTensor& m)
{
  Matrix3d matrix;
  matrix << m[0], m[3], m[5], m[3], m[1], m[4], m[5], m[4], m[2];
  return matrix;
}

Vec3 product(const MetricTensor& m, const Vec3& e)
{
  return { m[0] * e[0] + m[3] * e[1] + m[5] * e[2], m[3] * e[0] + m[1] * e[1] + m[4] * e[2],
    m[5] * e[0] + m[4] * e[1] + m[2] * e[2] };
}

/// A sum with its derivatives with respect to the position of a point, with fixed metrics.
struct StarSum
{
  bool derivatives = true; ///< whether these are needed
  double value = 0;
  Vector3d gradient = Vector3d::Zero();
  Matrix3d hessian = Matrix3d::Zero();

  /// Adds the inverse mean ratio of a tetrahedron in a metric.
  void addShape(const Vec3& p, const std::array<Vec3, 3>& f, const MetricTensor& m)
  {
    const Vec3 u = f[0] - p, v = f[1] - p, w = f[2] - p;
    const double root = std::sqrt(std::max(determinantOf(m), 0.0));
    const double volume = dot(u, cross(v, w)), d = volume * root;
    if (!(d > 0.0))
    {
      this->value = std::numeric_limits<double>::infinity();
      return;
    }
    const double s = squaredLength(u, m) + squaredLength(v, m) + squaredLength(w, m) +
      squaredLength(f[1] - f[0], m) + squaredLength(f[2] - f[1], m) + squaredLength(f[0] - f[2], m);
    const double scale = 1.0 / (ShapeFactor * std::cbrt(0.25 * d * d));
    this->value += scale * s;
    if (!this->derivatives)
    {
      return;
    }
    // d is linear in p, S quadratic.
    const Vector3d gs = -2.0 * toEigen(product(m, u + v + w));
    const Vector3d gd = (-1.0 / volume) * toEigen(cross(f[1] - f[0], f[2] - f[0]));
    this->gradient += scale * (gs - (2.0 / 3.0) * s * gd);
    this->hessian += scale *
      (6.0 * matrixOf(m) - (2.0 / 3.0) * (gs * gd.transpose() + gd * gs.transpose()) +
        (10.0 / 9.0) * s * gd * gd.transpose());
  }

  /// Adds the squared logarithm of the length of an edge from p, in the sum of two metrics.
  void addLength(const Vec3& p, const Vec3& q, const MetricTensor& m)
  {
    const Vec3 e = q - p, me = product(m, e);
    // m is the sum of the metrics at both ends, so its half is their mean.
    const double square = std::max(0.5 * dot(e, me), LeastLength2);
    const double logarithm = 0.5 * std::log(square);
    this->value += LengthWeight * logarithm * logarithm;
    if (!this->derivatives)
    {
      return;
    }
    // The gradient of the logarithm: -(M e) / (e . M e).
    const Vector3d g = (-0.5 / square) * toEigen(me);
    this->gradient += 2.0 * LengthWeight * logarithm * g;
    this->hessian += 2.0 * LengthWeight * g * g.transpose(); // Gauss-Newton
  }
};

/// The fraction of an edge from a at which it is halved in the metric: the length varies
/// geometrically from the metric at a to the metric at b.
double middleOf(const Vec3& e, const MetricTensor& a, const MetricTensor& b)
{
  constexpr double nearlyEqual = 1e-3;
  const double ratio = std::sqrt(squaredLength(e, b) / squaredLength(e, a));
  const double logarithm = std::log(ratio);
  // If both lengths are nearly equal, the quotient of the logarithms would cancel.
  return std::abs(logarithm) < nearlyEqual || !std::isfinite(logarithm)
    ? 0.5
    : std::log(0.5 * (1.0 + ratio)) / logarithm;
}
}

//------------------------------------------------------------------------------
/// A cell of the input near a point.
TetId CavityOperations::cellNear(PointId v) const
{
  const TetId known = v < static_cast<PointId>(this->Cells.size()) ? this->Cells[v] : NoId;
  return known != NoId ? known : std::max(this->Mesh.origin(this->Mesh.tetOf(v)), 0);
}

//------------------------------------------------------------------------------
/// The freedom of a point on an edge at the walls `Walls`. @return whether the edge may be divided
bool CavityOperations::freedomOfSplit(PointId a, PointId b, PointFreedom& freedom) const
{
  if (this->Walls.empty())
  {
    return true;
  }
  if (!this->swapsBoundary)
  {
    return false;
  }
  const Vec3& x = this->Mesh.point(a);
  const Vec3 e = this->Mesh.point(b) - x;
  Vec3 normal = { 0, 0, 0 };
  std::int32_t first = NoId;
  PointId thirdOfFirst = NoId;
  bool flat = true, single = true; // single: an interior wall ends at the edge
  for (std::int32_t wall : this->Walls)
  {
    const TriangleVertices f = this->Mesh.face(wall >> 2, wall & 3);
    // The exclusive or removes both ends of the edge from the three points of the face.
    const PointId third = f[0] ^ f[1] ^ f[2] ^ a ^ b;
    const Vec3 n = cross(e, this->Mesh.point(third) - x);
    const Vec3 unit = (1.0 / norm(n)) * n;
    const std::int32_t kind = this->classOf(this->Mesh.label(wall >> 2, wall & 3));
    if (first == NoId)
    {
      normal = unit;
      first = kind;
      thirdOfFirst = third;
    }
    single = single && third == thirdOfFirst;
    flat = flat && kind == first && norm(cross(normal, unit)) <= this->flatTolerance;
  }
  // In a common plane the point may move freely within it, otherwise only along the edge.
  freedom = flat && !single ? PointFreedom{ PointFreedom::InPlane, normal }
                            : PointFreedom{ PointFreedom::OnLine, (1.0 / norm(e)) * e };
  return true;
}

//------------------------------------------------------------------------------
/// The position and the freedom of a point on an edge of a curved boundary. If the curve of the
/// edge is ambiguous, the point stays on the edge.
/// @return false if the edge does not only belong to the outer boundary
bool CavityOperations::curvedSplit(PointId a, PointId b, Vec3& x, PointFreedom& freedom) const
{
  freedom = PointFreedom();
  freedom.fix();
  std::array<TriangleVertices, 2> facets;
  std::size_t count = 0;
  for (std::int32_t wall : this->Walls)
  {
    if (this->Mesh.tet(wall >> 2).neighbors[wall & 3] != NoId || count == facets.size())
    {
      return false;
    }
    facets[count++] = this->Mesh.face(wall >> 2, wall & 3);
  }
  if (count != facets.size())
  {
    return false;
  }
  const PointFreedom &atA = this->freedoms[a], &atB = this->freedoms[b];
  const int patch = this->patchOf(facets[0]), other = this->patchOf(facets[1]);
  const bool inside = atA.kind == PointFreedom::InPlane || atB.kind == PointFreedom::InPlane;
  if (patch == NoId || other == NoId)
  {
    return false;
  }
  PointFreedom found;
  if (patch == other && inside)
  {
    found = this->surface->inPatch(patch);
  }
  else
  {
    found = atA.kind == PointFreedom::OnLine ? atA : atB;
    if (found.kind != PointFreedom::OnLine || !found.isCurved() ||
      (atB.kind == PointFreedom::OnLine && atB.part != found.part))
    {
      return false;
    }
  }
  x = this->surface->closest(x, found);
  freedom = this->surface->at(x, found);
  // Each facet is divided into two halves, which must both stay close to the boundary.
  for (const TriangleVertices& f : facets)
  {
    for (const PointId end : { a, b })
    {
      std::array<Vec3, 3> half = this->facetOf(f);
      for (int k = 0; k < 3; ++k)
      {
        half[k] = f[k] == end ? x : half[k];
      }
      if (!this->surface->accepts(half, patch == other || f == facets[0] ? patch : other))
      {
        return false;
      }
    }
  }
  return true;
}

//------------------------------------------------------------------------------
/// Divides the edge whose tetrahedra are `Fan` at a position, unless qualities become too bad.
bool CavityOperations::splitAt(PointId a, PointId b, const Vec3& x, const PointFreedom& freedom)
{
  TetId cell = this->cellNear(a);
  const EdgeMetric metric = this->field->at(x, cell);
  const PointId p = this->Mesh.addPoint(x, metric);
  double least = 1.0, before = 1.0;
  std::vector<double> qualities;
  bool positive = true;
  for (TetId t : this->Fan)
  {
    before = std::min(before, this->Mesh.quality(t));
    for (const PointId end : { b, a })
    {
      TetVertices v = this->Mesh.tet(t).vertices;
      *std::find(v.begin(), v.end(), end) = p;
      qualities.push_back(this->Mesh.computeExactQuality(v));
      // A split must not create inverted tetrahedra, unless the divided one was not positive
      // either.
      positive = positive && (qualities.back() > 0.0 || !(this->Mesh.quality(t) > 0.0));
      least = std::min(least, qualities.back());
    }
  }
  if (!positive || !(least >= std::min(SplitShare * before, SplitQuality)))
  {
    this->Mesh.releasePoint(p);
    return false;
  }
  this->Mesh.splitEdge(a, b, p, this->Fan, qualities, this->Created);
  this->freedoms.resize(this->Mesh.pointSlots());
  this->freedoms[p] = freedom;
  this->Cells.resize(this->Mesh.pointSlots(), NoId);
  this->Cells[p] = cell;
  this->prepareStamps();
  this->touch(this->Created);
  ++this->Counts.insertions;
  return true;
}

//------------------------------------------------------------------------------
bool CavityOperations::splitEdge(TetId t, int i, int j)
{
  const PointId a = this->Mesh.tet(t).vertices[i], b = this->Mesh.tet(t).vertices[j];
  this->Mesh.fan(t, i, j, this->Fan, this->Walls);
  PointFreedom freedom;
  const bool outside = std::any_of(this->Fan.begin(), this->Fan.end(),
    [this](TetId s) { return this->Mesh.region(s) == OutsideRegion; });
  // If both ends are non-manifold points, the fan may miss a part of the tetrahedra at the edge.
  if (outside || (this->isNonManifold(a) && this->isNonManifold(b)) ||
    !this->freedomOfSplit(a, b, freedom))
  {
    return false;
  }
  const Vec3& start = this->Mesh.point(a);
  const Vec3 e = this->Mesh.point(b) - start;
  const Vec3 x = start + middleOf(e, this->Mesh.metric(a), this->Mesh.metric(b)) * e;
  if (!this->surface || this->Walls.empty())
  {
    return this->splitAt(a, b, x, freedom);
  }
  Vec3 onSurface = x;
  if (this->curvedSplit(a, b, onSurface, freedom) && this->splitAt(a, b, onSurface, freedom))
  {
    return true;
  }
  // On the edge, where the boundary is unchanged.
  freedom.fix();
  return this->splitAt(a, b, x, freedom);
}

//------------------------------------------------------------------------------
/// Whether vertex i may be contracted into vertex j: along its walls, if any.
bool CavityOperations::canContractInMetric(TetId t, int i, int j)
{
  const PointId v = this->Mesh.tet(t).vertices[i], w = this->Mesh.tet(t).vertices[j];
  const PointFreedom& freedom = this->freedoms[v];
  if (freedom.kind == PointFreedom::Free)
  {
    return true;
  }
  if (freedom.isCurved())
  {
    this->Mesh.ring(t, i, j, this->Ring);
    return this->canContract(v, w, this->Ring);
  }
  const Vec3 d = this->Mesh.point(w) - this->Mesh.point(v);
  if (freedom.kind == PointFreedom::Fixed ||
    norm(d - freedom.project(d)) > this->flatTolerance * norm(d))
  {
    return false;
  }
  // An edge that crosses the volume between two points of walls must not be contracted.
  this->Mesh.fan(t, i, j, this->Fan, this->Walls);
  return !this->Walls.empty();
}

//------------------------------------------------------------------------------
/// Prepares the replacement that contracts v into w. @return its smallest quality, or -1 if a wall
/// would move, an edge would become too long, or the qualities too bad
double CavityOperations::prepareContractionInMetric(PointId v, PointId w)
{
  constexpr double impossible = -1.0;
  this->Mesh.star(v, this->Star);
  this->Change.clear();
  this->Change.before = this->Star;
  this->Change.opensBoundary = this->freedoms[v].kind != PointFreedom::Free;
  double least = 1.0, before = 1.0;
  std::vector<PointId> around;
  for (TetId s : this->Star)
  {
    const Tetrahedron& tet = this->Mesh.tet(s);
    const int at = tet.indexOf(v), other = tet.indexOf(w);
    before = std::min(before, this->Mesh.quality(s));
    if (this->Mesh.region(s) == OutsideRegion || (other != NoId && this->Mesh.isWall(s, other)))
    {
      return impossible; // the face opposite w would become the face opposite v
    }
    if (other != NoId)
    {
      // All points of a tetrahedron that vanishes are already connected to w.
      around.insert(around.end(), tet.vertices.begin(), tet.vertices.end());
      continue;
    }
    TetVertices vertices = tet.vertices;
    vertices[at] = w;
    const double q = this->Mesh.computeQuality(vertices);
    if (!(q > 0.0))
    {
      return impossible;
    }
    least = std::min(least, q);
    this->Change.add(vertices, q);
    this->Change.regions.push_back(this->Mesh.region(s));
    if (this->Mesh.hasLabels())
    {
      this->Change.labels.push_back(this->Mesh.labels(s));
    }
  }
  if (least < std::min(ContractionShare * before, ContractionQuality))
  {
    return impossible;
  }
  // Only points that were not neighbors of w get an edge with it.
  const double longest2 = this->edgeFactor * this->edgeFactor;
  for (const TetVertices& vertices : this->Change.after)
  {
    for (PointId u : vertices)
    {
      const Vec3 e = this->Mesh.point(u) - this->Mesh.point(w);
      if (u != w && squaredLength(e, this->Mesh.metric(u), this->Mesh.metric(w)) > longest2 &&
        std::find(around.begin(), around.end(), u) == around.end())
      {
        return impossible;
      }
    }
  }
  return least;
}

//------------------------------------------------------------------------------
bool CavityOperations::contractEdge(TetId t, int i, int j)
{
  const PointId v = this->Mesh.tet(t).vertices[i], w = this->Mesh.tet(t).vertices[j];
  const double forward =
    this->canContractInMetric(t, i, j) ? this->prepareContractionInMetric(v, w) : -1.0;
  const double backward =
    this->canContractInMetric(t, j, i) ? this->prepareContractionInMetric(w, v) : -1.0;
  // Try the better one first.
  for (int attempt = 0; attempt < 2; ++attempt)
  {
    const bool first = (forward >= backward) == (attempt == 0);
    if (!((first ? forward : backward) > 0.0))
    {
      continue;
    }
    // The preparation of the other direction may have overwritten this replacement.
    this->prepareContractionInMetric(first ? v : w, first ? w : v);
    if (this->isValidChange() && this->applyChange())
    {
      this->touch(this->Created);
      ++this->Counts.contractions;
      return true;
    }
  }
  return false;
}

//------------------------------------------------------------------------------
/// Moves v to p if the smallest surrounding quality exceeds a bound there, in the local metric.
/// `Star` is the star of v.
bool CavityOperations::acceptMotion(PointId v, const Vec3& p, double least)
{
  const Vec3 start = this->Mesh.point(v);
  const EdgeMetric metric = this->Mesh.metric(v);
  std::vector<double> former, qualities;
  for (TetId t : this->Star)
  {
    former.push_back(this->Mesh.quality(t));
  }
  TetId cell = this->cellNear(v);
  // The point moves before the test, because the qualities are computed from the mesh.
  this->Mesh.setMetric(v, this->field->at(p, cell));
  this->Mesh.movePoint(v, p, {}, nullptr);
  bool kept = true;
  for (std::size_t n = 0; n < this->Star.size() && kept; ++n)
  {
    qualities.push_back(this->Mesh.computeExactQuality(this->Mesh.tet(this->Star[n]).vertices));
    kept = qualities.back() > least;
  }
  if (!kept)
  {
    this->Mesh.setMetric(v, metric);
    this->Mesh.movePoint(v, start, this->Star, former.data());
    return false;
  }
  this->Mesh.movePoint(v, p, this->Star, qualities.data());
  this->Cells.resize(this->Mesh.pointSlots(), NoId);
  this->Cells[v] = cell;
  this->Created = this->Star;
  this->touch(this->Created);
  ++this->Counts.moves;
  return true;
}

//------------------------------------------------------------------------------
bool CavityOperations::relax(PointId v)
{
  // Already tried without success since the last change of the star.
  const bool known = this->RelaxedAt[v] > this->Stamps[v];
  if (this->freedoms[v].kind == PointFreedom::Fixed || known)
  {
    return false;
  }
  const PointFreedom freedom = this->freedomAt(v);
  this->Mesh.star(v, this->Star);
  // The faces opposite v, and the sum of the metrics of their corners.
  std::vector<std::pair<std::array<Vec3, 3>, EdgeMetric>> faces;
  std::vector<PointId> neighbors;
  double least = 1.0;
  for (TetId t : this->Star)
  {
    const auto [a, b, c] = this->Mesh.face(t, this->Mesh.tet(t).indexOf(v));
    neighbors.insert(neighbors.end(), { a, b, c });
    least = std::min(least, this->Mesh.quality(t));
    faces.push_back({ { this->Mesh.point(a), this->Mesh.point(b), this->Mesh.point(c) },
      this->Mesh.metric(a) + this->Mesh.metric(b) + this->Mesh.metric(c) });
  }
  std::sort(neighbors.begin(), neighbors.end());
  neighbors.erase(std::unique(neighbors.begin(), neighbors.end()), neighbors.end());
  const auto sumAt = [&](const Vec3& p, const EdgeMetric& own, bool derivatives)
  {
    StarSum sum;
    sum.derivatives = derivatives;
    for (const auto& [corners, metrics] : faces)
    {
      sum.addShape(p, corners, own + metrics);
    }
    for (PointId u : neighbors)
    {
      sum.addLength(p, this->Mesh.point(u), own + this->Mesh.metric(u));
    }
    return sum;
  };
  const Vec3 start = this->Mesh.point(v);
  const StarSum before = sumAt(start, this->Mesh.metric(v), true);
  if (!std::isfinite(before.value))
  {
    return false;
  }
  // The derivatives treat the metric as constant; the line search evaluates it at each position.
  Vec3 step = newtonStep(before.gradient, before.hessian, freedom);
  for (int k = 0; k < Halvings; ++k, step = 0.5 * step)
  {
    const Vec3 p =
      freedom.isCurved() ? this->surface->closest(start + step, freedom) : start + step;
    TetId cell = this->cellNear(v);
    const double after = sumAt(p, this->field->at(p, cell), false).value;
    if (before.value - after > LeastRelaxation * before.value &&
      (!freedom.isCurved() || this->keepsSurface(v, p)) &&
      this->acceptMotion(v, p, RelaxationShare * least))
    {
      return true;
    }
  }
  this->RelaxedAt[v] = this->Clock + 1;
  return false;
}

//------------------------------------------------------------------------------
/// Like smooth(), with steps in coordinates in which the metric of the point is the identity.
bool CavityOperations::smoothInMetric(PointId v, int steps)
{
  const Vec3 start = this->Mesh.point(v);
  const PointFreedom freedom = this->freedomAt(v);
  // With the Cholesky factor R of M = R^t R, the length of y = R x is the length of x in M.
  const Matrix3d root = matrixOf(this->Mesh.metric(v)).llt().matrixU();
  const Matrix3d back = root.inverse();
  const auto transformed = [&](const Vec3& x) { return fromEigen(root * toEigen(x - start)); };
  const auto original = [&](const Vec3& y) { return start + fromEigen(back * toEigen(y)); };
  this->Mesh.star(v, this->Star);
  if (this->Star.size() > StarSmoothing::MaxFaces)
  {
    return false;
  }
  this->Smoothing.clear();
  this->Smoothing.weights = this->Mesh.weights();
  double before = 1.0;
  for (TetId t : this->Star)
  {
    const TriangleVertices f = this->Mesh.face(t, this->Mesh.tet(t).indexOf(v));
    this->Smoothing.addFace(transformed(this->Mesh.point(f[0])),
      transformed(this->Mesh.point(f[1])), transformed(this->Mesh.point(f[2])));
    before = std::min(before, this->Mesh.quality(t));
  }
  PointFreedom turned = freedom;
  if (freedom.kind != PointFreedom::Free)
  {
    // A normal is transformed by the transposed inverse, a tangent by the matrix itself.
    const Vector3d d = toEigen(freedom.direction);
    const Vector3d image =
      freedom.kind == PointFreedom::InPlane ? Vector3d(back.transpose() * d) : Vector3d(root * d);
    turned.direction = fromEigen(image.normalized());
  }
  std::function<Vec3(const Vec3&)> project;
  if (freedom.isCurved())
  {
    project = [&](const Vec3& y)
    { return transformed(this->surface->closest(original(y), freedom)); };
  }
  Vec3 y = { 0, 0, 0 };
  this->Smoothing.maximize(y, steps, turned, project);
  // Rounding of the transformations must not move the point out of its plane or line.
  const Vec3 p = freedom.isCurved() ? original(y) : start + freedom.project(original(y) - start);
  if (norm(y) > 0.0 && (!freedom.isCurved() || this->keepsSurface(v, p)) &&
    this->acceptMotion(v, p, before * (1.0 + this->Smoothing.leastGain)))
  {
    return true;
  }
  this->SmoothedAt[v] = this->Clock + 1;
  return false;
}

//------------------------------------------------------------------------------
/// Whether the two facets at an open ring are of the same class; sets the label of the facets that
/// a swap creates.
bool CavityOperations::labelBoundarySwap(const EdgeRing& ring)
{
  const std::array<std::array<PointId, 2>, 2> ends = { { { ring.tets[0], ring.ring[1] },
    { ring.tets[ring.size - 1], ring.ring[ring.vertices - 2] } } };
  std::array<std::int32_t, 2> labels;
  for (int k = 0; k < 2; ++k)
  {
    labels[k] = this->Mesh.label(ends[k][0], this->Mesh.tet(ends[k][0]).indexOf(ends[k][1]));
  }
  this->Change.boundaryLabel = labels[0];
  return this->classOf(labels[0]) == this->classOf(labels[1]);
}
}
