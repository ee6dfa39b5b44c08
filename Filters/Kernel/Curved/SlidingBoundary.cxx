// SPDX-License-Identifier: BSD-3-Clause
#include "SlidingBoundary.h"

#include "ElementFaces.h"
#include "tautline/Core/UnionFind.h"

#include <Eigen/LU>

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

namespace tautline
{
namespace
{
constexpr int MaxDegree = 2 * MaxElementOrder; ///< of a facet, with bubbles
constexpr Index None = -1;

/// A point of a piece with its derivatives.
struct PiecePoint
{
  Vec3 x, byS, byT;
};

/// The powers of x and of 1 - x.
void powersOf(double x, int degree, double* powers)
{
  powers[0] = 1;
  for (int k = 1; k <= degree; ++k)
  {
    powers[k] = powers[k - 1] * x;
  }
}

PiecePoint evaluate(const CurvedPiece& piece, double s, double t)
{
  const FacetForm& form = *piece.form;
  const int p = form.degrees[0], q = form.degrees[1];
  double ofS[MaxDegree + 1], ofT[MaxDegree + 1], ofRest[MaxDegree + 1], ofRestT[MaxDegree + 1];
  powersOf(s, p, ofS);
  powersOf(t, q, ofT);
  powersOf(form.triangle ? 1 - s - t : 1 - s, p, ofRest);
  powersOf(1 - t, q, ofRestT);
  const auto lowered = [](const double* powers, int k) { return k > 0 ? k * powers[k - 1] : 0.0; };
  PiecePoint at = { { 0, 0, 0 }, { 0, 0, 0 }, { 0, 0, 0 } };
  for (std::size_t k = 0; k < piece.controls.size(); ++k)
  {
    const auto [a, b, c] = form.exponents[k];
    const double m = form.multinomials[k];
    if (form.triangle)
    {
      const double rest = lowered(ofRest, c) * ofS[a] * ofT[b];
      at.x += m * ofS[a] * ofT[b] * ofRest[c] * piece.controls[k];
      at.byS += m * (lowered(ofS, a) * ofT[b] * ofRest[c] - rest) * piece.controls[k];
      at.byT += m * (ofS[a] * lowered(ofT, b) * ofRest[c] - rest) * piece.controls[k];
    }
    else
    {
      const double alongS = ofS[a] * ofRest[p - a], alongT = ofT[b] * ofRestT[q - b];
      const double slopeS = lowered(ofS, a) * ofRest[p - a] - ofS[a] * lowered(ofRest, p - a);
      const double slopeT = lowered(ofT, b) * ofRestT[q - b] - ofT[b] * lowered(ofRestT, q - b);
      at.x += m * alongS * alongT * piece.controls[k];
      at.byS += m * slopeS * alongT * piece.controls[k];
      at.byT += m * alongS * slopeT * piece.controls[k];
    }
  }
  return at;
}

Vec3 unit(const Vec3& v)
{
  const double length = norm(v);
  return length > 0 ? 1 / length * v : Vec3{ 0, 0, 0 };
}

Vec3 directionAt(const CurvedPiece& piece, const PiecePoint& at)
{
  return piece.form->line ? unit(at.byS) : piece.orientation * unit(cross(at.byS, at.byT));
}

BernsteinSpace spaceOf(const FacetForm& form)
{
  if (form.triangle)
  {
    return BernsteinSpace({ { 2, form.degrees[0] } });
  }
  return form.line ? BernsteinSpace({ { 1, form.degrees[0] } })
                   : BernsteinSpace({ { 1, form.degrees[0] }, { 1, form.degrees[1] } });
}

FacetForm makeForm(bool line, bool triangle, int first, int second)
{
  FacetForm form;
  form.line = line;
  form.triangle = triangle;
  form.degrees = { first, line ? 0 : second };
  const BernsteinSpace space = spaceOf(form);
  for (int k = 0; k < space.size(); ++k)
  {
    const BernsteinExponents& e = space.exponents(k);
    const int t = line ? 0 : e[1];
    form.exponents.push_back({ e[0], t, triangle ? first - e[0] - t : 0 });
    form.multinomials.push_back(space.multinomial(k));
  }
  return form;
}

/// The map from the element nodes on a face to the control points of the face.
struct FaceMap
{
  FacetForm form;
  std::vector<int> nodes;   ///< of the element
  std::vector<Vec2> places; ///< s and t of these
  Eigen::MatrixXd controls; ///< control points by node
};

FaceMap faceMap(const ElementType& type, const ElementFace& face)
{
  FaceMap map;
  const std::vector<BernsteinFactor>& factors = type.space().factors();
  const bool line = type.dimension() == 2;
  const auto degree = [&](int axis)
  {
    return face.factors[axis] < 0
      ? 0
      : factors[std::min<std::size_t>(face.factors[axis], factors.size() - 1)].degree;
  };
  map.form = makeForm(line, face.triangle, degree(0), face.triangle ? degree(0) : degree(1));
  for (int n = 0; n < type.nodes(); ++n)
  {
    const Vec3& at = type.coordinates()[n];
    if (face.distance(at) < OnFaceTolerance)
    {
      map.nodes.push_back(n);
      map.places.push_back(face.coordinates(at));
    }
  }
  // Interpolate the polynomial at the maxima of the Bernstein polynomials.
  const BernsteinSpace space = spaceOf(map.form);
  Eigen::MatrixXd bernstein(space.size(), space.size());
  Eigen::MatrixXd shapes(space.size(), static_cast<Eigen::Index>(map.nodes.size()));
  for (int k = 0; k < space.size(); ++k)
  {
    const auto [a, b, c] = map.form.exponents[k];
    const double s = static_cast<double>(a) / map.form.degrees[0];
    // For lines, the second degree is 0.
    const double t = b == 0 ? 0 : static_cast<double>(b) / map.form.degrees[1];
    const std::vector<long double> values = space.valuesAt({ s, t, 0 });
    const std::vector<double> functions = type.shapeFunctions(face.place(s, t));
    for (int j = 0; j < space.size(); ++j)
    {
      bernstein(k, j) = static_cast<double>(values[j]);
    }
    for (std::size_t j = 0; j < map.nodes.size(); ++j)
    {
      shapes(k, static_cast<Eigen::Index>(j)) = functions[map.nodes[j]];
    }
  }
  map.controls = bernstein.partialPivLu().solve(shapes);
  return map;
}

bool isCorner(const Vec2& place)
{
  const auto whole = [](double x) { return std::abs(x - std::round(x)) < OnFaceTolerance; };
  return whole(place[0]) && whole(place[1]);
}

/// The maps of the faces of each type.
using FaceMaps = std::map<std::pair<const ElementType*, int>, FaceMap>;

/// A face of an element, by its corners.
struct FaceCandidate
{
  std::array<Index, MaxFaceNodes> corners;
  Index element;
  int face;
  bool operator<(const FaceCandidate& other) const
  {
    return std::tie(this->corners, this->element, this->face) <
      std::tie(other.corners, other.element, other.face);
  }
};

/// The faces of all elements sorted by their corners; faces that occur once form the boundary.
std::vector<FaceCandidate> candidatesOf(const std::vector<CurvedElement>& elements, FaceMaps& maps)
{
  std::vector<FaceCandidate> candidates;
  for (std::size_t e = 0; e < elements.size(); ++e)
  {
    const CurvedElement& element = elements[e];
    const std::vector<ElementFace>& faces = facesOf(element.type->shape());
    for (std::size_t f = 0; f < faces.size(); ++f)
    {
      const auto key = std::make_pair(element.type, static_cast<int>(f));
      auto found = maps.find(key);
      if (found == maps.end())
      {
        found = maps.emplace(key, faceMap(*element.type, faces[f])).first;
      }
      FaceCandidate candidate = { {}, static_cast<Index>(e), static_cast<int>(f) };
      candidate.corners.fill(None);
      std::size_t corners = 0;
      const FaceMap& map = found->second;
      for (std::size_t n = 0; n < map.nodes.size(); ++n)
      {
        if (isCorner(map.places[n]) && corners < candidate.corners.size())
        {
          candidate.corners[corners++] = element.nodes[map.nodes[n]];
        }
      }
      std::sort(candidate.corners.begin(), candidate.corners.end());
      candidates.push_back(candidate);
    }
  }
  std::sort(candidates.begin(), candidates.end());
  return candidates;
}

/// The edges of a facet: t = 0, s = 0, s + t = 1 for a triangle; t = 0, 1 and s = 0, 1 for a
/// square.
struct FacetLine
{
  double (*distance)(const Vec2& place);
  double (*along)(const Vec2& place);
  Vec2 middle;
};

const std::vector<FacetLine>& linesOf(const FacetForm& form)
{
  static const std::vector<FacetLine> triangle = {
    { [](const Vec2& p) { return p[1]; }, [](const Vec2& p) { return p[0]; }, { 0.5, 0 } },
    { [](const Vec2& p) { return p[0]; }, [](const Vec2& p) { return p[1]; }, { 0, 0.5 } },
    { [](const Vec2& p) { return 1 - p[0] - p[1]; }, [](const Vec2& p) { return p[1]; },
      { 0.5, 0.5 } },
  };
  static const std::vector<FacetLine> square = {
    { [](const Vec2& p) { return p[1]; }, [](const Vec2& p) { return p[0]; }, { 0.5, 0 } },
    { [](const Vec2& p) { return 1 - p[1]; }, [](const Vec2& p) { return p[0]; }, { 0.5, 1 } },
    { [](const Vec2& p) { return p[0]; }, [](const Vec2& p) { return p[1]; }, { 0, 0.5 } },
    { [](const Vec2& p) { return 1 - p[0]; }, [](const Vec2& p) { return p[1]; }, { 1, 0.5 } },
  };
  return form.triangle ? triangle : square;
}

/// The angle between two unit vectors in degrees.
double angleOf(const Vec3& a, const Vec3& b)
{
  return DegreesPerRadian * std::atan2(norm(cross(a, b)), dot(a, b));
}

/// Whether a position is not on the border of its piece.
bool isInside(const FacetForm& form, const Vec2& at)
{
  constexpr double border = 1e-9;
  const auto between = [](double x) { return x > border && x < 1 - border; };
  return between(at[0]) && (form.line || between(at[1])) &&
    (!form.triangle || at[0] + at[1] < 1 - border);
}

/// Keeps s and t in the domain of a piece.
void clamp(const FacetForm& form, double& s, double& t)
{
  s = std::min(std::max(s, 0.0), 1.0);
  t = std::min(std::max(t, 0.0), 1.0);
  const double beyond = s + t - 1;
  // A point beyond the slanted edge moves perpendicularly to it.
  if (form.triangle && beyond > 0)
  {
    s = std::min(std::max(s - 0.5 * beyond, 0.0), 1.0);
    t = 1 - s;
  }
}
}

//------------------------------------------------------------------------------
SlidingBoundary::SlidingBoundary(const std::vector<CurvedElement>& elements,
  const std::vector<double>& points, int dimension, double featureAngle)
  : Dimension(dimension)
  , Kinds(points.size() / 3, NotOnBoundary)
  , PieceOf(points.size() / 3, None)
  , PiecesAt(points.size() / 3)
{
  this->addFacets(elements, points);
  if (dimension == 3)
  {
    this->addCurves(featureAngle);
  }
  this->classifyPoints(featureAngle);
  this->joinParts();
}

//------------------------------------------------------------------------------
Index SlidingBoundary::addPiece(
  const FacetForm& form, std::vector<Vec3> controls, std::vector<Index> points)
{
  Vec3 center = { 0, 0, 0 };
  for (const Vec3& c : controls)
  {
    center += 1.0 / static_cast<double>(controls.size()) * c;
  }
  // A piece lies in the convex hull of its control points, hence in this ball.
  double radius = 0;
  for (const Vec3& c : controls)
  {
    radius = std::max(radius, norm(c - center));
  }
  this->Pieces.push_back({ &form, std::move(controls), std::move(points), -1, center, radius });
  return static_cast<Index>(this->Pieces.size()) - 1;
}

//------------------------------------------------------------------------------
void SlidingBoundary::addFacets(
  const std::vector<CurvedElement>& elements, const std::vector<double>& points)
{
  FaceMaps maps;
  const std::vector<FaceCandidate> candidates = candidatesOf(elements, maps);
  for (std::size_t i = 0, next = 0; i < candidates.size(); i = next)
  {
    for (next = i + 1;
         next < candidates.size() && candidates[next].corners == candidates[i].corners; ++next)
    {
    }
    // A face that occurs twice is inside the mesh.
    if (next > i + 1)
    {
      continue;
    }
    const CurvedElement& element = elements[candidates[i].element];
    const FaceMap& map = maps.at({ element.type, candidates[i].face });
    const std::array<int, 3> key = { map.form.line ? 0
        : map.form.triangle                        ? 1
                                                   : 2,
      map.form.degrees[0], map.form.degrees[1] };
    const FacetForm& form = this->Forms.emplace(key, map.form).first->second;
    std::vector<Vec3> controls(map.form.exponents.size(), Vec3{ 0, 0, 0 });
    std::vector<Index> own;
    for (std::size_t n = 0; n < map.nodes.size(); ++n)
    {
      const Index p = element.nodes[map.nodes[n]];
      own.push_back(p);
      for (std::size_t k = 0; k < controls.size(); ++k)
      {
        const double share =
          map.controls(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(n));
        controls[k] += share * Vec3{ points[3 * p], points[3 * p + 1], points[3 * p + 2] };
      }
    }
    const Index facet = this->addPiece(form, std::move(controls), own);
    this->Pieces[facet].orientation = element.mirrored ? -1 : 1;
    for (std::size_t n = 0; form.line && n < map.nodes.size(); ++n)
    {
      if (isCorner(map.places[n]))
      {
        this->Pieces[facet].ends[map.places[n][0] > 0.5] = own[n];
      }
    }
    if (this->Dimension == 3)
    {
      this->addEdges(facet, map.places);
    }
  }
}

//------------------------------------------------------------------------------
/// @param places s and t of the nodes of the facet
void SlidingBoundary::addEdges(Index facet, const std::vector<Vec2>& places)
{
  const FacetForm& form = *this->Pieces[facet].form;
  const std::vector<Index>& own = this->Pieces[facet].points;
  for (std::size_t l = 0; l < linesOf(form).size(); ++l)
  {
    const FacetLine& line = linesOf(form)[l];
    FacetEdge edge = { { None, None }, facet, {}, {}, { 0, 0, 0 } };
    for (std::size_t n = 0; n < places.size(); ++n)
    {
      if (line.distance(places[n]) < OnFaceTolerance)
      {
        edge.points.push_back(own[n]);
        if (isCorner(places[n]))
        {
          edge.ends[line.along(places[n]) > 0.5] = own[n];
        }
      }
    }
    // The control points of the edge are the facet control points on it, in order.
    const int degree = form.triangle || l < 2 ? form.degrees[0] : form.degrees[1];
    edge.controls.resize(degree + 1);
    for (std::size_t k = 0; k < form.exponents.size(); ++k)
    {
      const auto [a, b, c] = form.exponents[k];
      const Vec2 place = { static_cast<double>(a) / form.degrees[0],
        b == 0 ? 0.0 : static_cast<double>(b) / form.degrees[1] };
      if (line.distance(place) < OnFaceTolerance)
      {
        edge.controls[std::lround(line.along(place) * degree)] = this->Pieces[facet].controls[k];
      }
    }
    // Edges begin at the point with the lower number, so that both facets list them alike.
    if (edge.ends[0] > edge.ends[1])
    {
      std::swap(edge.ends[0], edge.ends[1]);
      std::reverse(edge.controls.begin(), edge.controls.end());
    }
    const PiecePoint middle = evaluate(this->Pieces[facet], line.middle[0], line.middle[1]);
    edge.normal = directionAt(this->Pieces[facet], middle);
    this->Edges.push_back(std::move(edge));
  }
}

//------------------------------------------------------------------------------
/// Adds the feature edges as pieces.
void SlidingBoundary::addCurves(double featureAngle)
{
  std::sort(this->Edges.begin(), this->Edges.end(),
    [](const FacetEdge& a, const FacetEdge& b)
    { return std::tie(a.ends, a.facet) < std::tie(b.ends, b.facet); });
  for (std::size_t i = 0, next = 0; i < this->Edges.size(); i = next)
  {
    for (next = i + 1; next < this->Edges.size() && this->Edges[next].ends == this->Edges[i].ends;
         ++next)
    {
    }
    FacetEdge& edge = this->Edges[i];
    // All other edges are features: sharp ones, and ones without exactly two facets.
    if (next == i + 2 && angleOf(edge.normal, this->Edges[i + 1].normal) <= featureAngle)
    {
      this->Smooth.push_back({ edge.facet, this->Edges[i + 1].facet });
      continue;
    }
    const int degree = static_cast<int>(edge.controls.size()) - 1;
    const FacetForm& form =
      this->Forms.emplace(std::array<int, 3>{ 0, degree, 0 }, makeForm(true, false, degree, 0))
        .first->second;
    const Index piece = this->addPiece(form, edge.controls, edge.points);
    this->Pieces[piece].ends = edge.ends;
  }
}

//------------------------------------------------------------------------------
void SlidingBoundary::classifyPoints(double featureAngle)
{
  for (std::size_t i = 0; i < this->Pieces.size(); ++i)
  {
    for (const Index p : this->Pieces[i].points)
    {
      this->PiecesAt[p].push_back(static_cast<Index>(i));
    }
  }
  for (std::size_t p = 0; p < this->PiecesAt.size(); ++p)
  {
    const std::vector<Index>& at = this->PiecesAt[p];
    if (at.empty())
    {
      continue;
    }
    std::vector<Vec3> tangents; // away from the point
    Index curve = None;
    bool inside = false;
    for (const Index i : at)
    {
      const CurvedPiece& piece = this->Pieces[i];
      if (!piece.form->line)
      {
        continue;
      }
      curve = i;
      const auto own = static_cast<Index>(p);
      const bool atFirst = piece.ends[0] == own, atLast = piece.ends[1] == own;
      if (atFirst || atLast)
      {
        const Vec3 along = unit(evaluate(piece, atFirst ? 0 : 1, 0).byS);
        tangents.push_back(atFirst ? along : -1.0 * along);
      }
      else
      {
        inside = true;
      }
    }
    if (curve == None)
    {
      this->Kinds[p] = PatchPoint;
      this->PieceOf[p] = at.front();
    }
    else if (inside ||
      (tangents.size() == 2 && angleOf(tangents[0], -1.0 * tangents[1]) <= featureAngle))
    {
      this->Kinds[p] = CurvePoint;
      this->PieceOf[p] = curve;
    }
    else
    {
      this->Kinds[p] = CornerPoint;
    }
  }
}

//------------------------------------------------------------------------------
void SlidingBoundary::joinParts()
{
  UnionFind sets(static_cast<Index>(this->Pieces.size()));
  for (const auto& [a, b] : this->Smooth)
  {
    sets.join(a, b);
  }
  // Pieces of curves that meet in a smooth point belong to one curve.
  for (std::size_t p = 0; p < this->PiecesAt.size(); ++p)
  {
    if (this->Kinds[p] != CurvePoint)
    {
      continue;
    }
    for (const Index i : this->PiecesAt[p])
    {
      if (this->Pieces[i].form->line)
      {
        sets.join(i, this->PieceOf[p]);
      }
    }
  }
  // Number the patches first.
  std::map<Index, int> numbers;
  for (const bool lines : { false, true })
  {
    for (std::size_t i = 0; i < this->Pieces.size(); ++i)
    {
      CurvedPiece& piece = this->Pieces[i];
      if (piece.form->line == lines)
      {
        const auto added = numbers.emplace(sets.find(static_cast<Index>(i)), this->Parts);
        this->Parts += added.second;
        piece.part = added.first->second;
      }
    }
    this->Patches = lines ? this->Patches : this->Parts;
  }
}

//------------------------------------------------------------------------------
CurvedPlace SlidingBoundary::closestOn(Index index, const Vec3& x, Vec2 from) const
{
  const CurvedPiece& piece = this->Pieces[index];
  const FacetForm& form = *piece.form;
  double s = from[0], t = from[1], least = std::numeric_limits<double>::infinity();
  if (s < 0)
  {
    // Without a start position, the Gauss-Newton method begins at the nearest lattice point.
    const int cuts = std::max(form.degrees[0], form.degrees[1]) + 1;
    for (int i = 0; i <= cuts; ++i)
    {
      for (int j = 0; j <= (form.line ? 0 : form.triangle ? cuts - i : cuts); ++j)
      {
        const double a = static_cast<double>(i) / cuts, b = static_cast<double>(j) / cuts;
        const Vec3 away = evaluate(piece, a, b).x - x;
        if (dot(away, away) < least)
        {
          least = dot(away, away);
          s = a;
          t = b;
        }
      }
    }
  }
  PiecePoint at = evaluate(piece, s, t);
  least = dot(at.x - x, at.x - x);
  constexpr int iterations = 20;
  constexpr double converged = 1e-12;
  for (int i = 0; i < iterations; ++i)
  {
    const Vec3 r = x - at.x;
    // Gauss-Newton method: the normal equations of the distance in s and t.
    const double ss = dot(at.byS, at.byS), st = dot(at.byS, at.byT), tt = dot(at.byT, at.byT);
    const double bs = dot(at.byS, r), bt = dot(at.byT, r), det = ss * tt - st * st;
    double ds = ss > 0 ? bs / ss : 0, dt = 0;
    if (!form.line && det > 1e-14 * ss * tt)
    {
      ds = (tt * bs - st * bt) / det;
      dt = (ss * bt - st * bs) / det;
      // A step that would leave the piece is projected onto its edge.
      const bool atS = (s <= 0 && ds < 0) || (!form.triangle && s >= 1 && ds > 0);
      const bool atT = (t <= 0 && dt < 0) || (!form.triangle && t >= 1 && dt > 0);
      if (form.triangle && s + t >= 1 && ds + dt > 0 && !atS && !atT)
      {
        const Vec3 along = at.byS - at.byT;
        ds = dot(along, r) / std::max(dot(along, along), 1e-300);
        dt = -ds;
      }
      else if (atS || atT)
      {
        ds = atS ? 0 : bs / ss;
        dt = atT ? 0 : bt / tt;
      }
    }
    // Halve a step that increases the distance.
    bool nearer = false;
    double newS = s, newT = t;
    for (int half = 0; half < 10 && !nearer; ++half, ds *= 0.5, dt *= 0.5)
    {
      newS = s + ds;
      newT = t + dt;
      clamp(form, newS, newT);
      const PiecePoint there = evaluate(piece, newS, newT);
      const Vec3 away = there.x - x;
      nearer = dot(away, away) < least;
      if (nearer)
      {
        least = dot(away, away);
        at = there;
      }
    }
    const double moved = std::abs(newS - s) + std::abs(newT - t);
    if (!nearer)
    {
      break;
    }
    s = newS;
    t = newT;
    if (moved < converged)
    {
      break;
    }
  }
  return { index, at.x, directionAt(piece, at), { s, t } };
}

//------------------------------------------------------------------------------
CurvedPlace SlidingBoundary::closest(const CurvedPlace& start, const Vec3& x) const
{
  const Index piece = start.piece;
  CurvedPlace best = this->closestOn(piece, x, start.at);
  double least = norm(best.point - x);
  if (isInside(*this->Pieces[piece].form, best.at))
  {
    return best; // a minimum on the piece, and no adjacent piece is nearer
  }
  constexpr int longestWalk = 16; // pieces
  std::vector<Index> seen = { piece };
  for (int step = 0; step < longestWalk; ++step)
  {
    const Index from = best.piece;
    for (const Index p : this->Pieces[from].points)
    {
      for (const Index next : this->PiecesAt[p])
      {
        // Only pieces of the same part count, and only if their ball is closer than the best point
        // so far.
        const CurvedPiece& other = this->Pieces[next];
        if (other.part != this->Pieces[piece].part ||
          norm(other.center - x) - other.radius >= least ||
          std::find(seen.begin(), seen.end(), next) != seen.end())
        {
          continue;
        }
        seen.push_back(next);
        const CurvedPlace place = this->closestOn(next, x);
        if (norm(place.point - x) < least)
        {
          best = place;
          least = norm(place.point - x);
        }
      }
    }
    if (best.piece == from)
    {
      break;
    }
  }
  return best;
}

//------------------------------------------------------------------------------
CurvedPlace SlidingBoundary::closestOfPart(int part, const Vec3& x) const
{
  CurvedPlace best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < this->Pieces.size(); ++i)
  {
    const CurvedPiece& piece = this->Pieces[i];
    if (piece.part != part || norm(piece.center - x) - piece.radius >= least)
    {
      continue;
    }
    const CurvedPlace place = this->closestOn(static_cast<Index>(i), x);
    if (norm(place.point - x) < least)
    {
      best = place;
      least = norm(place.point - x);
    }
  }
  return best;
}

//------------------------------------------------------------------------------
bool SlidingBoundary::isFlat(Index point, double angle) const
{
  const Index own = this->PieceOf[point];
  if (own < 0)
  {
    return false;
  }
  const CurvedPiece& first = this->Pieces[own];
  const auto directionOf = [](const CurvedPiece& piece)
  {
    constexpr double middle = 1.0 / 3.0;
    return directionAt(piece, evaluate(piece, middle, piece.form->line ? 0 : middle));
  };
  const Vec3 direction = directionOf(first);
  const double bend = std::sin(angle / DegreesPerRadian);
  for (const Index i : this->PiecesAt[point])
  {
    const CurvedPiece& piece = this->Pieces[i];
    if (piece.part != first.part)
    {
      continue;
    }
    // The orientation may differ between pieces, so opposite directions also count as parallel.
    if (angleOf(direction, directionOf(piece)) > angle &&
      angleOf(direction, -1.0 * directionOf(piece)) > angle)
    {
      return false;
    }
    for (const Vec3& c : piece.controls)
    {
      const Vec3 away = c - piece.center;
      const double off =
        piece.form->line ? norm(cross(away, direction)) : std::abs(dot(away, direction));
      if (off > bend * piece.radius)
      {
        return false;
      }
    }
  }
  return true;
}
}
