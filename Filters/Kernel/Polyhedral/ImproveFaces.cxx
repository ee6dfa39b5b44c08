// SPDX-License-Identifier: BSD-3-Clause
#include "ImproveFaces.h"

#include "FaceEnergy.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Core/Stopwatch.h"
#include "tautline/Optimization/Minimize.h"
#include "tautline/Sliding/ConstrainedPoints.h"

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
/// Points so many cells away from a wanting face move, at first and at most.
constexpr int FirstLayers = 2, MostLayers = 8;
/// Rounds without a better result before the search ends.
constexpr int MostFailures = 4;
/// After a round without one, targets are closer to the ideal by this factor.
constexpr double Tightening = 0.9;
/// Of the displacement of a round: tried in turn.
constexpr std::array<double, 4> Fractions = { 1.0, 0.5, 0.25, 0.1 };
/// Delta of the energy of inverted cells, over the smallest V / V0, and at least.
constexpr double DeltaPart = 0.5, LeastDelta = 1e-3;
/// While cells are inverted, the energy is one of volumes; angles keep it regular.
constexpr double UntanglingShrinking = 0.5, UntanglingPower = 1, UntanglingWeight = 10;

/// How far a mesh is from the targets.
struct Want
{
  Index faces = 0;    ///< beyond a target or of an inverted cell
  Index inverted = 0; ///< with a tetrahedron of no positive volume
  double excess = 0;  ///< sum of what is beyond, relative to the targets
  std::vector<Index> list;
};

bool isBetter(const Want& a, const Want& b)
{
  return a.inverted != b.inverted ? a.inverted < b.inverted : a.excess < b.excess;
}

Want wantOf(const FaceMesh& mesh, const FaceMeasures& measures, const ImproveFacesOptions& options)
{
  const FaceValues angles = measures.evaluate(Metric::NonOrthogonality);
  const FaceValues skews = measures.evaluate(Metric::FaceSkewness);
  const FaceValues tets = measures.evaluate(Metric::CenterTetQuality);
  const FaceValues fans = measures.evaluate(Metric::FanTetQuality);
  Want want;
  constexpr double ofInverted = 1;
  for (Index face = 0; face < mesh.faces(); ++face)
  {
    const double angle = angles.faces[face] / options.angle - 1;
    const double skew = skews.faces[face] / options.skewness - 1;
    const bool inverted = !(tets.faces[face] > 0 && fans.faces[face] > 0);
    const double excess =
      std::max(angle, 0.0) + std::max(skew, 0.0) + (inverted ? ofInverted : 0.0);
    if (excess > 0 || !std::isfinite(excess))
    {
      want.list.push_back(face);
      want.inverted += inverted;
      want.excess += std::isfinite(excess) ? excess : ofInverted;
    }
  }
  want.faces = static_cast<Index>(want.list.size());
  return want;
}

/// Whether no check is worse: in how much offends, and in the worst value beyond a limit.
bool isNoWorse(const MeshCheckReport& after, const MeshCheckReport& before)
{
  constexpr double rounding = 1e-9;
  for (std::size_t i = 0; i < after.checks.size(); ++i)
  {
    const MeshCheck &a = after.checks[i], &b = before.checks[i];
    // Where faces are in a plane, rounding makes cells concave; the others do not count as failed.
    const bool loose = a.kind == MeshCheckKind::CellConcavity || a.onlyWarns;
    if (loose && b.offending > 0)
    {
      continue;
    }
    if (a.offending > b.offending || a.warned > b.warned)
    {
      return false;
    }
    const double slack = rounding * (std::abs(b.most) + std::abs(b.least));
    const bool steeper = a.kind == MeshCheckKind::NonOrthogonality && a.warned > 0 &&
      a.most > std::max(b.most, SevereAngle) + slack;
    if (steeper)
    {
      return false;
    }
    if (a.offending == 0)
    {
      continue;
    }
    const bool above = b.most > b.limit && a.most > std::max(b.most, b.limit) + slack;
    const bool below =
      b.least < b.limit && b.most >= b.limit && a.least < std::min(b.least, b.limit) - slack;
    // Values are good on one side of their limit only; of counts both are 0.
    const bool largeIsBad = a.kind == MeshCheckKind::NonOrthogonality ||
      a.kind == MeshCheckKind::FaceSkewness || a.kind == MeshCheckKind::CellAspectRatio ||
      a.kind == MeshCheckKind::CellOpenness || a.kind == MeshCheckKind::CellConcavity;
    if (largeIsBad ? above : below)
    {
      return false;
    }
  }
  return true;
}

/// The energy as a function of the free points.
class FreePoints : public SmoothFunction
{
public:
  /// @param axis, mates of one layer, see Improver
  FreePoints(FaceEnergy& energy, const ConstrainedPoints& constrained,
    const std::vector<Vec3>& normals, const std::vector<double>& lengths, int axis,
    const std::vector<Index>& mates, std::vector<double>& points)
    : Energy(energy)
    , Constrained(constrained)
    , Normals(normals)
    , Lengths(lengths)
    , Axis(axis)
    , Points(points)
  {
    const std::vector<Index>& free = energy.freePoints();
    for (Index point : mates.empty() ? std::vector<Index>() : free)
    {
      const auto found = std::lower_bound(free.begin(), free.end(), mates[point]);
      this->MatePlaces.push_back(found - free.begin());
    }
  }

  std::size_t size() const override { return 3 * this->Energy.freePoints().size(); }

  double valueAndGradient(const double* x, double* gradient) override
  {
    const std::vector<Index>& free = this->Energy.freePoints();
    for (std::size_t i = 0; i < free.size(); ++i)
    {
      std::copy(x + 3 * i, x + 3 * i + 3, this->Points.begin() + 3 * free[i]);
    }
    const double value = this->Energy.evaluate(this->Points.data(), gradient);
    for (std::size_t i = 0; std::isfinite(value) && i < free.size(); ++i)
    {
      const Vec3 g = { gradient[3 * i], gradient[3 * i + 1], gradient[3 * i + 2] };
      const Vec3 slides = this->along(free[i], g);
      std::copy(slides.begin(), slides.end(), gradient + 3 * i);
    }
    // Both of a pair have the same mean gradient, in their plane, and so the same motion.
    for (std::size_t i = 0; std::isfinite(value) && i < this->MatePlaces.size(); ++i)
    {
      const auto mate = static_cast<std::size_t>(this->MatePlaces[i]);
      for (int c = 0; c < 3 && mate > i; ++c)
      {
        const double mean =
          c == this->Axis ? 0 : 0.5 * (gradient[3 * i + c] + gradient[3 * mate + c]);
        gradient[3 * i + c] = gradient[3 * mate + c] = mean;
      }
    }
    return value;
  }

  /// The inverse of a Hessian of size 1 over the square of the lengths.
  bool precondition(const double* r, double* z) override
  {
    const std::vector<Index>& free = this->Energy.freePoints();
    for (std::size_t i = 0; i < free.size(); ++i)
    {
      const double square = this->Lengths[free[i]] * this->Lengths[free[i]];
      for (int c = 0; c < 3; ++c)
      {
        z[3 * i + c] = square * r[3 * i + c];
      }
    }
    return true;
  }

private:
  Vec3 along(Index point, const Vec3& d) const
  {
    return this->Constrained.band(point) >= 0
      ? d - dot(d, this->Normals[point]) * this->Normals[point]
      : allowed(this->Constrained.freedom(point), this->Constrained.direction(point), d);
  }

  FaceEnergy& Energy;
  const ConstrainedPoints& Constrained;
  const std::vector<Vec3>& Normals;
  const std::vector<double>& Lengths;
  int Axis;
  std::vector<Index> MatePlaces; ///< per free point that of its mate among them; or empty
  std::vector<double>& Points;
};

class Improver
{
public:
  Improver(const FaceMesh& mesh, const double* points, const Mesh& solid,
    const BoundaryConstraints& constraints, const ImproveFacesOptions& options)
    : Mesh(mesh)
    , Options(options)
    , Constrained(solid, constraints)
    , Start(points, points + 3 * mesh.points)
    , Movable(mesh.points, 0)
    , Normals(mesh.points, Vec3{ 0, 0, 0 })
    , Lengths(mesh.points, 0.0)
  {
    this->findMovable();
    this->findLengths();
  }

  ImproveFacesResult run();

private:
  void findMates();
  void findMovable();
  void findLengths();
  std::vector<char> near(const std::vector<Index>& faces, int layers) const;
  std::vector<double> round(const std::vector<double>& from, const Want& want, int layers,
    double tightness, ImproveFacesResult& result);
  bool hold(const MeshCheckReport& now, const MeshCheckReport& before);
  void placeOnParts(const std::vector<double>& from, std::vector<double>& points) const;

  const FaceMesh& Mesh;
  const ImproveFacesOptions& Options;
  ConstrainedPoints Constrained;
  std::vector<double> Start;
  std::vector<char> Movable;
  int Axis = -1;               ///< across one layer of cells
  std::vector<Index> Mates;    ///< of such a layer, per point: that on the other side; else empty
  std::vector<Vec3> Normals;   ///< of points in a band, where they are
  std::vector<double> Lengths; ///< of the shortest edge of each point
};

//------------------------------------------------------------------------------
void Improver::findMovable()
{
  this->findMates();
  std::vector<char> used(this->Mesh.points, 0);
  for (Index node : this->Mesh.nodes)
  {
    used[node] = 1;
  }
  for (Index point = 0; point < this->Mesh.points; ++point)
  {
    const bool layered = this->Axis < 0 || this->Movable[point];
    this->Movable[point] = used[point] && layered &&
      (this->Constrained.freedom(point) != Freedom::None || this->Constrained.band(point) >= 0);
  }
  // What belongs together would move apart, and a border between patches would move.
  constexpr int none = -1;
  std::vector<std::array<int, 2>> patchesOf(this->Mesh.points, { none, none });
  for (int number = 0; number < static_cast<int>(this->Mesh.patches.size()); ++number)
  {
    const FacePatch& patch = this->Mesh.patches[number];
    if (patch.isEmpty() && this->Axis >= 0)
    {
      continue; // the sides of the layer, whose points move in their planes
    }
    const bool stays = patch.isEmpty() || patch.isWedge() || patch.isCoupled();
    for (Index i = this->Mesh.offsets[patch.first];
         i < this->Mesh.offsets[patch.first + patch.count]; ++i)
    {
      const Index point = this->Mesh.nodes[i];
      std::array<int, 2>& known = patchesOf[point];
      if (known[0] == none || known[0] == number)
      {
        known[0] = number;
      }
      else
      {
        // On a sharp edge between two patches a point slides along the border.
        const bool third = known[1] != none && known[1] != number;
        known[1] = number;
        this->Movable[point] =
          this->Movable[point] && !third && this->Constrained.freedom(point) == Freedom::Line;
      }
      this->Movable[point] = this->Movable[point] && !stays;
    }
  }
}

//------------------------------------------------------------------------------
/// Of one layer of cells between "empty" patches: the axis across it, and for each point of the one
/// side that of the other, which moves with it.
void Improver::findMates()
{
  if (std::none_of(this->Mesh.patches.begin(), this->Mesh.patches.end(),
        [](const FacePatch& patch) { return patch.isEmpty(); }))
  {
    return;
  }
  const FaceMeasures measures(
    this->Mesh, this->Start.data(), this->Options.convention, this->Options.threads);
  const FaceDirections& directions = measures.directions();
  if (directions.geometric != directions.solution || directions.count() != 2)
  {
    return;
  }
  const int axis = !directions.geometric[0] ? 0 : !directions.geometric[1] ? 1 : 2;
  std::vector<char> onSide(this->Mesh.points, 0);
  std::vector<char> isSide(this->Mesh.faces(), 0);
  for (const FacePatch& patch : this->Mesh.patches)
  {
    for (Index face = patch.first; patch.isEmpty() && face < patch.first + patch.count; ++face)
    {
      isSide[face] = 1;
      for (Index i = this->Mesh.offsets[face]; i < this->Mesh.offsets[face + 1]; ++i)
      {
        onSide[this->Mesh.nodes[i]] = 1;
      }
    }
  }
  std::vector<Index> mates(this->Mesh.points, -1);
  for (Index face = 0; face < this->Mesh.faces(); ++face)
  {
    const Index first = this->Mesh.offsets[face], size = this->Mesh.size(face);
    for (Index k = 0; !isSide[face] && k < size; ++k)
    {
      const Index a = this->Mesh.nodes[first + k], b = this->Mesh.nodes[first + (k + 1) % size];
      const double *p = &this->Start[3 * a], *q = &this->Start[3 * b];
      const bool across = p[axis] != q[axis] && p[(axis + 1) % 3] == q[(axis + 1) % 3] &&
        p[(axis + 2) % 3] == q[(axis + 2) % 3];
      if (!onSide[a] || !onSide[b] ||
        (across && ((mates[a] >= 0 && mates[a] != b) || (mates[b] >= 0 && mates[b] != a))))
      {
        return; // not one layer
      }
      if (across)
      {
        mates[a] = b;
        mates[b] = a;
      }
    }
  }
  this->Axis = axis;
  for (Index point = 0; point < this->Mesh.points; ++point)
  {
    // Points without a counterpart right across stay.
    this->Movable[point] = mates[point] >= 0;
  }
  this->Mates = std::move(mates);
}

//------------------------------------------------------------------------------
void Improver::findLengths()
{
  std::fill(this->Lengths.begin(), this->Lengths.end(), std::numeric_limits<double>::infinity());
  for (Index face = 0; face < this->Mesh.faces(); ++face)
  {
    pollInterruption(face);
    const Index first = this->Mesh.offsets[face], size = this->Mesh.size(face);
    for (Index k = 0; k < size; ++k)
    {
      const Index a = this->Mesh.nodes[first + k], b = this->Mesh.nodes[first + (k + 1) % size];
      const double* p = &this->Start[3 * a];
      const double* q = &this->Start[3 * b];
      const double length = norm(Vec3{ p[0] - q[0], p[1] - q[1], p[2] - q[2] });
      if (this->Mates.empty() || this->Mates[a] != b)
      {
        this->Lengths[a] = std::min(this->Lengths[a], length);
        this->Lengths[b] = std::min(this->Lengths[b], length);
      }
    }
  }
}

//------------------------------------------------------------------------------
/// The movable points of cells that are so many cells away from the faces.
std::vector<char> Improver::near(const std::vector<Index>& faces, int layers) const
{
  std::vector<char> points(this->Mesh.points, 0), cells(this->Mesh.cells, 0);
  const auto addPoints = [&](Index face)
  {
    for (Index i = this->Mesh.offsets[face]; i < this->Mesh.offsets[face + 1]; ++i)
    {
      points[this->Mesh.nodes[i]] = 1;
    }
  };
  std::for_each(faces.begin(), faces.end(), addPoints);
  for (int layer = 0; layer < layers; ++layer)
  {
    std::fill(cells.begin(), cells.end(), 0);
    for (Index face = 0; face < this->Mesh.faces(); ++face)
    {
      const bool reached = std::any_of(this->Mesh.nodes.begin() + this->Mesh.offsets[face],
        this->Mesh.nodes.begin() + this->Mesh.offsets[face + 1],
        [&](Index node) { return points[node] != 0; });
      cells[this->Mesh.owner[face]] |= reached;
      if (this->Mesh.internal(face))
      {
        cells[this->Mesh.neighbor[face]] |= reached;
      }
    }
    for (Index cell = 0; cell < this->Mesh.cells; ++cell)
    {
      for (Index i = this->Mesh.cellOffsets[cell];
           cells[cell] && i < this->Mesh.cellOffsets[cell + 1]; ++i)
      {
        addPoints(this->Mesh.cellFaces[i]);
      }
    }
  }
  for (Index point = 0; point < this->Mesh.points; ++point)
  {
    points[point] = points[point] && this->Movable[point];
  }
  // Of two that move together, both or none.
  for (Index point = 0; !this->Mates.empty() && point < this->Mesh.points; ++point)
  {
    const Index mate = this->Mates[point];
    if (mate > point)
    {
      points[point] = points[mate] =
        (points[point] || points[mate]) && this->Movable[point] && this->Movable[mate];
    }
  }
  return points;
}

//------------------------------------------------------------------------------
/// Fixes the points of faces and cells that fail a check that they did not fail before. @return
/// whether any could move
bool Improver::hold(const MeshCheckReport& now, const MeshCheckReport& before)
{
  bool any = false;
  const auto holdFace = [&](Index face)
  {
    for (Index i = this->Mesh.offsets[face]; i < this->Mesh.offsets[face + 1]; ++i)
    {
      any |= this->Movable[this->Mesh.nodes[i]] != 0;
      this->Movable[this->Mesh.nodes[i]] = 0;
    }
  };
  for (Index face = 0; face < this->Mesh.faces(); ++face)
  {
    if (now.faces[face] & ~before.faces[face])
    {
      holdFace(face);
    }
  }
  for (Index cell = 0; cell < this->Mesh.cells; ++cell)
  {
    for (Index i = this->Mesh.cellOffsets[cell];
         (now.cells[cell] & ~before.cells[cell]) != 0 && i < this->Mesh.cellOffsets[cell + 1]; ++i)
    {
      holdFace(this->Mesh.cellFaces[i]);
    }
  }
  for (Index point = 0; !this->Mates.empty() && point < this->Mesh.points; ++point)
  {
    const Index mate = this->Mates[point];
    this->Movable[point] = this->Movable[point] && mate >= 0 && this->Movable[mate];
  }
  return any;
}

//------------------------------------------------------------------------------
/// Puts points in a band back on their parts.
void Improver::placeOnParts(const std::vector<double>& from, std::vector<double>& points) const
{
  for (Index point = 0; point < this->Mesh.points; ++point)
  {
    const double* was = &from[3 * point];
    double* is = &points[3 * point];
    if (this->Constrained.band(point) >= 0 && !std::equal(was, was + 3, is))
    {
      const Vec3 placed = this->Constrained.onPart(point, { is[0], is[1], is[2] });
      std::copy(placed.begin(), placed.end(), is);
    }
  }
}

//------------------------------------------------------------------------------
/// Points that minimize the energy near the faces that are wanting.
std::vector<double> Improver::round(const std::vector<double>& from, const Want& want, int layers,
  double tightness, ImproveFacesResult& result)
{
  const std::vector<char> free = this->near(want.list, layers);
  FaceEnergyOptions energyOptions;
  energyOptions.angle = tightness * this->Options.angle;
  energyOptions.skewness = tightness * this->Options.skewness;
  energyOptions.threads = this->Options.threads;
  FaceEnergy energy(this->Mesh, this->Start.data(), free, energyOptions);
  result.freePoints = std::max(result.freePoints, static_cast<Index>(energy.freePoints().size()));
  if (energy.freePoints().empty())
  {
    return from;
  }
  energy.freeze(from.data());
  energy.evaluate(from.data(), nullptr);
  if (energy.leastTetrahedron() <= 0)
  {
    energyOptions.delta = std::max(LeastDelta, -DeltaPart * energy.leastTetrahedron());
    energyOptions.shrinking = UntanglingShrinking;
    energyOptions.weight = UntanglingWeight;
    energyOptions.power = UntanglingPower;
    energyOptions.skewWeight = 0;
    energy.setOptions(energyOptions);
  }
  for (Index point : energy.freePoints())
  {
    if (this->Constrained.band(point) >= 0)
    {
      const double* p = &from[3 * point];
      this->Constrained.facets(this->Constrained.band(point))
        .closest({ p[0], p[1], p[2] }, this->Normals[point]);
    }
  }
  std::vector<double> points = from;
  FreePoints function(
    energy, this->Constrained, this->Normals, this->Lengths, this->Axis, this->Mates, points);
  std::vector<double> x(function.size());
  for (std::size_t i = 0; i < energy.freePoints().size(); ++i)
  {
    std::copy_n(
      from.begin() + 3 * energy.freePoints()[i], 3, x.begin() + static_cast<std::ptrdiff_t>(3 * i));
  }
  MinimizeOptions minimizeOptions;
  minimizeOptions.method = Optimizer::LimitedMemoryBFGS;
  minimizeOptions.maximumIterations = this->Options.iterations;
  minimizeOptions.refresh = this->Options.iterations + 1;
  minimizeOptions.threads = this->Options.threads;
  const MinimizeResult found = minimize(function, x.data(), minimizeOptions);
  result.iterations += found.iterations;
  points = from;
  for (std::size_t i = 0; i < energy.freePoints().size(); ++i)
  {
    std::copy_n(x.begin() + static_cast<std::ptrdiff_t>(3 * i), 3,
      points.begin() + 3 * energy.freePoints()[i]);
  }
  this->placeOnParts(from, points);
  // Not even rounding separates the two sides of a layer.
  for (Index point = 0; !this->Mates.empty() && point < this->Mesh.points; ++point)
  {
    for (int c = 0; c < 3 && this->Mates[point] > point; ++c)
    {
      double& of = points[3 * this->Mates[point] + c];
      of = c == this->Axis ? of : points[3 * point + c];
    }
  }
  return points;
}

//------------------------------------------------------------------------------
ImproveFacesResult Improver::run()
{
  const Stopwatch watch;
  ImproveFacesResult result;
  const auto measure = [&](const std::vector<double>& at)
  { return FaceMeasures(this->Mesh, at.data(), this->Options.convention, this->Options.threads); };
  const auto report = [&](const FaceMeasures& measures, const std::vector<double>& at)
  { return checkMesh(measures, at.data(), this->Options.facts); };

  std::vector<double> at = this->Start;
  Want want;
  {
    const FaceMeasures measures = measure(at);
    want = wantOf(this->Mesh, measures, this->Options);
    result.before = report(measures, at);
  }
  Want best = want;
  result.after = result.before;
  result.points = at;
  result.wantingBefore = want.faces;
  result.wantingAfter = want.faces;
  if (std::none_of(this->Movable.begin(), this->Movable.end(), [](char m) { return m != 0; }))
  {
    result.reason = StopReason::NoFreeVertices;
    return result;
  }
  int layers = FirstLayers, failures = 0;
  double tightness = 1;
  result.reason = StopReason::IterationLimit;
  while (result.rounds < this->Options.rounds)
  {
    if (want.faces == 0)
    {
      result.reason = StopReason::AllValid;
      break;
    }
    if (failures >= MostFailures)
    {
      result.reason = StopReason::NoProgress;
      break;
    }
    if (watch.reached(this->Options.maximumSeconds))
    {
      result.reason = StopReason::TimeLimit;
      break;
    }
    if (this->Options.proceed &&
      !this->Options.proceed(result.rounds,
        static_cast<double>(result.rounds) / static_cast<double>(this->Options.rounds)))
    {
      result.reason = StopReason::Aborted;
      break;
    }
    ++result.rounds;
    const std::vector<double> to = this->round(at, want, layers, tightness, result);
    bool better = false;
    for (double fraction : Fractions)
    {
      std::vector<double> tried = at;
      for (std::size_t i = 0; i < tried.size(); ++i)
      {
        tried[i] = fraction == 1.0 ? to[i] : at[i] + fraction * (to[i] - at[i]);
      }
      if (fraction < 1.0)
      {
        this->placeOnParts(at, tried);
      }
      const FaceMeasures measures = measure(tried);
      Want found = wantOf(this->Mesh, measures, this->Options);
      if (!isBetter(found, want))
      {
        continue;
      }
      at = std::move(tried);
      want = std::move(found);
      better = true;
      MeshCheckReport now = report(measures, at);
      if (isNoWorse(now, result.before))
      {
        result.after = std::move(now);
        result.points = at;
        result.wantingAfter = want.faces;
        best = want;
      }
      else if (best.faces > 0 && want.inverted == 0 && this->hold(now, result.before))
      {
        // What would be worse stays where it was.
        at = result.points;
        want = best;
      }
      break;
    }
    failures = better ? 0 : failures + 1;
    if (!better)
    {
      layers = std::min(layers + 2, MostLayers);
      tightness *= Tightening;
    }
  }
  return result;
}
}

//------------------------------------------------------------------------------
ImproveFacesResult improveFaces(const FaceMesh& mesh, const double* points, const Mesh& solid,
  const BoundaryConstraints& constraints, const ImproveFacesOptions& options)
{
  return Improver(mesh, points, solid, constraints, options).run();
}
}
