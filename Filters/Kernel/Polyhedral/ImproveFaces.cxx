// SPDX-License-Identifier: BSD-3-Clause
#include "ImproveFaces.h"

#include "FaceEnergy.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Core/Stopwatch.h"
#include "tautline/Optimization/Minimize.h"
#include "tautline/Sliding/ConstrainedPoints.h"
#include "tautline/Untangling/Untangle.h"

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
/// Points within this many cells of a deficient face move, initially and at most.
constexpr int FirstLayers = 2, MostLayers = 8;
/// Cells within this many cells of an inverted one are untangled first.
constexpr int UntangledLayers = 3;
/// Opposite points of a layer match up to this fraction of the extent of the mesh.
constexpr double LayerTolerance = 1e-9;
/// The number of rounds without a better result before the search ends.
constexpr int MostFailures = 4;
/// After a round without a better result, targets are tightened by this factor.
constexpr double Tightening = 0.9;
/// Fractions of the displacement of a round that are tried in turn.
constexpr std::array<double, 4> Fractions = { 1.0, 0.5, 0.25, 0.1 };
/// Near faces that would get worse, points move by this fraction of the displacement, then its
/// square, then not at all.
constexpr double Backtracking = 0.3;
/// The number of times that faces may get worse before a round is abandoned.
constexpr int MostBacktracks = 8;
/// The energy is at least 0: the first step must not predict a decrease of more than this fraction
/// of it.
constexpr double FirstDecrease = 0.1;
/// Delta of the energy for inverted cells, relative to the smallest V / V0, and its minimum.
constexpr double DeltaPart = 0.5, LeastDelta = 1e-3;
/// While cells are inverted, the energy is dominated by volumes, with angles as regularization.
constexpr double UntanglingShrinking = 0.5, UntanglingPower = 1, UntanglingWeight = 10;

/// The distance of a mesh from the targets.
struct Want
{
  Index faces = 0; ///< number of faces beyond a target or of an inverted cell
  /// number of cells with a tetrahedron without positive volume; for untangleOnly: invalid cells
  Index inverted = 0;
  double excess = 0; ///< sum of the excesses, relative to the targets
  std::vector<Index> list;
};

bool isBetter(const Want& a, const Want& b)
{
  return a.inverted != b.inverted ? a.inverted < b.inverted : a.excess < b.excess;
}

/// Counts the faces of invalid cells, and the invalid cells in `inverted`.
Want invalidCells(const FaceMesh& mesh, const FaceMeasures& measures)
{
  const std::vector<signed char> validity = measures.validity();
  Want want;
  want.inverted = std::count_if(
    validity.begin(), validity.end(), [](signed char value) { return value != Valid; });
  for (Index face = 0; face < mesh.faces(); ++face)
  {
    if (validity[mesh.owner[face]] != Valid ||
      (mesh.internal(face) && validity[mesh.neighbor[face]] != Valid))
    {
      want.list.push_back(face);
    }
  }
  want.faces = static_cast<Index>(want.list.size());
  want.excess = static_cast<double>(want.faces);
  return want;
}

Want wantOf(const FaceMesh& mesh, const FaceMeasures& measures, const ImproveFacesOptions& options)
{
  if (options.untangleOnly)
  {
    return invalidCells(mesh, measures);
  }
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

/// Whether the values of a check are bad above or below its limit; for counts, neither.
bool isLargeBad(MeshCheckKind kind)
{
  return kind == MeshCheckKind::NonOrthogonality || kind == MeshCheckKind::FaceSkewness ||
    kind == MeshCheckKind::CellAspectRatio || kind == MeshCheckKind::CellOpenness ||
    kind == MeshCheckKind::CellConcavity || kind == MeshCheckKind::BoundaryOpenness ||
    kind == MeshCheckKind::FaceConcavity;
}

bool isSmallBad(MeshCheckKind kind)
{
  return kind == MeshCheckKind::FaceArea || kind == MeshCheckKind::CellVolume ||
    kind == MeshCheckKind::PyramidVolume || kind == MeshCheckKind::FaceTets ||
    kind == MeshCheckKind::EdgeLength || kind == MeshCheckKind::FaceFlatness ||
    kind == MeshCheckKind::CellDeterminant || kind == MeshCheckKind::FaceWeight ||
    kind == MeshCheckKind::VolumeRatio;
}

/// Whether no check is worse, in the number of offending items and in the worst value beyond a
/// limit.
bool isNoWorse(const MeshCheckReport& after, const MeshCheckReport& before)
{
  constexpr double rounding = 1e-9;
  for (std::size_t i = 0; i < after.checks.size(); ++i)
  {
    const MeshCheck &a = after.checks[i], &b = before.checks[i];
    // If faces are coplanar, rounding makes cells concave; the other loose checks do not count as
    // failed.
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
    const bool below = b.least < b.limit && a.least < std::min(b.least, b.limit) - slack;
    if ((isLargeBad(a.kind) && above) || (isSmallBad(a.kind) && below))
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
  /// @param axis, mates for one layer, see Improver
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
    // Both points of a pair have the same mean gradient, in their plane, and thus the same motion.
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

  /// The inverse of a model Hessian: a constant over the squared lengths.
  bool precondition(const double* r, double* z) override
  {
    const std::vector<Index>& free = this->Energy.freePoints();
    for (std::size_t i = 0; i < free.size(); ++i)
    {
      const double square = this->Scale * this->Lengths[free[i]] * this->Lengths[free[i]];
      for (int c = 0; c < 3; ++c)
      {
        z[3 * i + c] = square * r[3 * i + c];
      }
    }
    return true;
  }

  /// Chooses the constant of this Hessian, 1 or more, so that the first step predicts a decrease by
  /// a fraction of the energy. High powers for faces far beyond their targets have larger Hessians.
  void scaleAt(const std::vector<double>& x)
  {
    std::vector<double> gradient(x.size()), step(x.size());
    const double value = this->valueAndGradient(x.data(), gradient.data());
    this->Scale = 1;
    this->precondition(gradient.data(), step.data());
    double promised = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      promised += gradient[i] * step[i];
    }
    if (std::isfinite(value) && promised > FirstDecrease * value)
    {
      this->Scale = FirstDecrease * value / promised;
    }
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
  double Scale = 1;
  std::vector<Index> MatePlaces; ///< per free point: the position of its mate among them; or empty
  std::vector<double>& Points;
};

/// Elements that represent a part of a mesh for untangling.
class PartToUntangle
{
public:
  /// @return the number of the point
  Index add(const Vec3& place, bool fixed)
  {
    this->Places.insert(this->Places.end(), place.begin(), place.end());
    this->Fixed.push_back(fixed);
    return static_cast<Index>(this->Fixed.size()) - 1;
  }
  void addCell(CellType type, const std::vector<Index>& points)
  {
    this->Types.push_back(static_cast<unsigned char>(type));
    this->Connectivity.insert(this->Connectivity.end(), points.begin(), points.end());
    this->Offsets.push_back(static_cast<Index>(this->Connectivity.size()));
  }

  /// The final positions of the points. @param options without the constraints
  std::vector<double> untangle(UntangleOptions options) const
  {
    MeshView view;
    view.numberOfPoints = static_cast<Index>(this->Fixed.size());
    view.points = this->Places.data();
    view.numberOfCells = static_cast<Index>(this->Types.size());
    view.cellTypes = this->Types.data();
    view.offsets = this->Offsets.data();
    view.connectivity = this->Connectivity.data();
    options.fixed = this->Fixed.data();
    return tautline::untangle(Mesh(view), options).points;
  }

  /// Points of the mesh: local number, and number in the mesh.
  std::vector<std::pair<Index, Index>> original;

private:
  std::vector<double> Places;
  std::vector<unsigned char> Fixed, Types;
  std::vector<Index> Offsets = { 0 }, Connectivity;
};

Vec3 placeOf(const std::vector<double>& points, Index point)
{
  return { points[3 * point], points[3 * point + 1], points[3 * point + 2] };
}

/// The positions of the points, and their evaluation.
struct Placement
{
  std::vector<double> points;
  Want want;
  MeshCheckReport report;
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
  std::vector<char> cellsNear(const std::vector<Index>& faces, int layers) const;
  std::vector<char> near(const std::vector<Index>& faces, int layers) const;
  std::vector<double> round(const std::vector<double>& from, const Want& want, int layers,
    double tightness, ImproveFacesResult& result);
  Placement place(std::vector<double> points) const;
  std::vector<double> between(const std::vector<double>& from, const std::vector<double>& to,
    const std::vector<double>& fractions) const;
  bool findBetter(Placement& at, const std::vector<double>& to) const;
  bool findNoWorse(
    Placement& at, const std::vector<double>& to, const MeshCheckReport& before) const;
  bool markWorse(
    const MeshCheckReport& now, const MeshCheckReport& before, std::vector<char>& points) const;
  void placeOnParts(const std::vector<double>& from, std::vector<double>& points) const;
  void matchMates(std::vector<double>& points) const;
  std::vector<double> untangled(const Want& want) const;
  void smoothUntangled(Placement& at, const Want& tangled, ImproveFacesResult& result);
  PartToUntangle solidPart(const std::vector<char>& cells) const;
  PartToUntangle layerPart() const;

  const FaceMesh& Mesh;
  const ImproveFacesOptions& Options;
  ConstrainedPoints Constrained;
  std::vector<double> Start;
  std::vector<char> Movable;
  int Axis = -1; ///< perpendicular to one layer of cells
  /// for such a layer, per point: the point on the other side; otherwise empty
  std::vector<Index> Mates;
  std::vector<Vec3> Normals;   ///< of points in a band, at their current positions
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
  // Otherwise corresponding points would separate, and borders between patches would move.
  constexpr int none = -1;
  std::vector<std::array<int, 2>> patchesOf(this->Mesh.points, { none, none });
  for (int number = 0; number < static_cast<int>(this->Mesh.patches.size()); ++number)
  {
    const FacePatch& patch = this->Mesh.patches[number];
    if (patch.isEmpty() && this->Axis >= 0)
    {
      continue; // the sides of the layer, whose points move in their planes
    }
    const bool stays =
      patch.isEmpty() || patch.isWedge() || patch.isCoupled() || this->Options.patchesStay;
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
        // On a sharp edge between two patches, a point slides along the border.
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
/// For one layer of cells between "empty" patches: finds the axis perpendicular to it and, for each
/// point on one side, the point on the other side, which moves with it.
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
  const double slack = LayerTolerance * norm(measures.extent().high - measures.extent().low);
  std::vector<Index> mates(this->Mesh.points, -1);
  for (Index face = 0; face < this->Mesh.faces(); ++face)
  {
    const Index first = this->Mesh.offsets[face], size = this->Mesh.size(face);
    for (Index k = 0; !isSide[face] && k < size; ++k)
    {
      const Index a = this->Mesh.nodes[first + k], b = this->Mesh.nodes[first + (k + 1) % size];
      const double *p = &this->Start[3 * a], *q = &this->Start[3 * b];
      const auto same = [&](int c) { return std::abs(p[c] - q[c]) <= slack; };
      const bool across = !same(axis) && same((axis + 1) % 3) && same((axis + 2) % 3);
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
    // Points without an exact counterpart are fixed.
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
/// The cells within this many cells of the faces.
std::vector<char> Improver::cellsNear(const std::vector<Index>& faces, int layers) const
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
  return cells;
}

//------------------------------------------------------------------------------
/// The movable points of these cells.
std::vector<char> Improver::near(const std::vector<Index>& faces, int layers) const
{
  const std::vector<char> cells = this->cellsNear(faces, layers);
  std::vector<char> points(this->Mesh.points, 0);
  for (Index face = 0; face < this->Mesh.faces(); ++face)
  {
    const bool reached = cells[this->Mesh.owner[face]] ||
      (this->Mesh.internal(face) && cells[this->Mesh.neighbor[face]]);
    for (Index i = this->Mesh.offsets[face]; reached && i < this->Mesh.offsets[face + 1]; ++i)
    {
      points[this->Mesh.nodes[i]] = 1;
    }
  }
  for (Index point = 0; point < this->Mesh.points; ++point)
  {
    points[point] = points[point] && this->Movable[point];
  }
  // Mark both or none of two points that move together.
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
/// Flags the points of faces and cells that fail a check they passed before; false if there are
/// none.
bool Improver::markWorse(
  const MeshCheckReport& now, const MeshCheckReport& before, std::vector<char>& points) const
{
  std::fill(points.begin(), points.end(), 0);
  bool any = false;
  const auto markFace = [&](Index face)
  {
    any = true;
    for (Index i = this->Mesh.offsets[face]; i < this->Mesh.offsets[face + 1]; ++i)
    {
      points[this->Mesh.nodes[i]] = 1;
    }
  };
  for (Index face = 0; face < this->Mesh.faces(); ++face)
  {
    if (now.faces[face] & ~before.faces[face])
    {
      markFace(face);
    }
  }
  for (Index cell = 0; cell < this->Mesh.cells; ++cell)
  {
    for (Index i = this->Mesh.cellOffsets[cell];
         (now.cells[cell] & ~before.cells[cell]) != 0 && i < this->Mesh.cellOffsets[cell + 1]; ++i)
    {
      markFace(this->Mesh.cellFaces[i]);
    }
  }
  for (Index point = 0; !this->Mates.empty() && point < this->Mesh.points; ++point)
  {
    const Index mate = this->Mates[point];
    points[point] = points[point] || (mate >= 0 && points[mate]);
  }
  return any;
}

//------------------------------------------------------------------------------
/// Moves points in a band back onto their parts.
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
/// The points that minimize the energy near deficient faces.
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
  function.scaleAt(x);
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
  this->matchMates(points);
  return points;
}

//------------------------------------------------------------------------------
/// Removes rounding differences between the moved points on the two sides of a layer.
void Improver::matchMates(std::vector<double>& points) const
{
  const auto moved = [&](Index point)
  {
    const auto at = points.begin() + 3 * point;
    return !std::equal(at, at + 3, this->Start.begin() + 3 * point);
  };
  for (Index point = 0; !this->Mates.empty() && point < this->Mesh.points; ++point)
  {
    const Index mate = this->Mates[point];
    const bool both = mate > point && (moved(point) || moved(mate));
    for (int c = 0; both && c < 3; ++c)
    {
      double& of = points[3 * mate + c];
      of = c == this->Axis ? of : points[3 * point + c];
    }
  }
}

//------------------------------------------------------------------------------
Placement Improver::place(std::vector<double> points) const
{
  Placement placement;
  placement.points = std::move(points);
  const double* at = placement.points.data();
  const FaceMeasures measures(this->Mesh, at, this->Options.convention, this->Options.threads);
  placement.want = wantOf(this->Mesh, measures, this->Options);
  placement.report = checkMesh(measures, at, this->Options.facts);
  return placement;
}

//------------------------------------------------------------------------------
/// Interpolates the points between two sets of positions.
std::vector<double> Improver::between(const std::vector<double>& from,
  const std::vector<double>& to, const std::vector<double>& fractions) const
{
  std::vector<double> points = from;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const double fraction = fractions[i / 3];
    points[i] = fraction == 1.0 ? to[i] : from[i] + fraction * (to[i] - from[i]);
  }
  this->placeOnParts(from, points);
  return points;
}

//------------------------------------------------------------------------------
/// Moves toward other positions as far as the result improves, regardless of the checks; false if
/// it never improves.
bool Improver::findBetter(Placement& at, const std::vector<double>& to) const
{
  for (const double fraction : Fractions)
  {
    Placement tried =
      this->place(this->between(at.points, to, std::vector<double>(this->Mesh.points, fraction)));
    if (isBetter(tried.want, at.want))
    {
      at = std::move(tried);
      return true;
    }
  }
  return false;
}

//------------------------------------------------------------------------------
/// The same, but moves less or not at all near faces that would get worse.
bool Improver::findNoWorse(
  Placement& at, const std::vector<double>& to, const MeshCheckReport& before) const
{
  std::vector<double> fractions(this->Mesh.points, 1.0);
  std::vector<char> worse(this->Mesh.points, 0);
  for (int attempt = 0; attempt < MostBacktracks; ++attempt)
  {
    Placement tried = this->place(this->between(at.points, to, fractions));
    if (isNoWorse(tried.report, before))
    {
      const bool better = isBetter(tried.want, at.want);
      if (better)
      {
        at = std::move(tried);
      }
      return better;
    }
    if (!this->markWorse(tried.report, before, worse))
    {
      std::fill(worse.begin(), worse.end(), 1);
    }
    for (std::size_t point = 0; point < worse.size(); ++point)
    {
      const double less = fractions[point] < Backtracking ? 0.0 : Backtracking * fractions[point];
      fractions[point] = worse[point] ? less : fractions[point];
    }
  }
  return false;
}

//------------------------------------------------------------------------------
/// Represents the cells by tetrahedra of their centers and fans of their faces. @param cells one
/// flag per cell
PartToUntangle Improver::solidPart(const std::vector<char>& cells) const
{
  PartToUntangle part;
  // A point next to other cells is fixed.
  std::vector<char> stays(this->Mesh.points, 0);
  std::vector<Index> local(this->Mesh.points, -1);
  const auto has = [&](Index cell) { return cells[cell] != 0; };
  const auto forEachSide = [&](Index face, const auto& visit)
  {
    visit(this->Mesh.owner[face], false);
    if (this->Mesh.internal(face))
    {
      visit(this->Mesh.neighbor[face], true);
    }
  };
  for (Index face = 0; face < this->Mesh.faces(); ++face)
  {
    forEachSide(face,
      [&](Index cell, bool)
      {
        for (Index i = this->Mesh.offsets[face]; i < this->Mesh.offsets[face + 1]; ++i)
        {
          stays[this->Mesh.nodes[i]] |= !has(cell);
        }
      });
  }
  const auto localOf = [&](Index point)
  {
    if (local[point] < 0)
    {
      // Sliding points follow in later rounds.
      const bool moves =
        this->Movable[point] && !stays[point] && this->Constrained.freedom(point) == Freedom::Space;
      local[point] = part.add(placeOf(this->Start, point), !moves);
      part.original.emplace_back(local[point], point);
    }
    return local[point];
  };
  std::vector<Index> centers(this->Mesh.cells, -1);
  const FaceGeometry geometry =
    faceGeometry(this->Mesh, this->Start.data(), this->Options.convention, this->Options.threads);
  for (Index face = 0; face < this->Mesh.faces(); ++face)
  {
    const Index* nodes = this->Mesh.nodes.data() + this->Mesh.offsets[face];
    const Index size = this->Mesh.size(face);
    forEachSide(face,
      [&](Index cell, bool beyond)
      {
        for (Index i = 1; has(cell) && i + 1 < size; ++i)
        {
          const Index a = localOf(nodes[0]), b = localOf(nodes[i]), c = localOf(nodes[i + 1]);
          if (centers[cell] < 0)
          {
            centers[cell] = part.add(geometry.cellCenter[cell], false);
          }
          part.addCell(CellType::Tetrahedron, { a, beyond ? b : c, beyond ? c : b, centers[cell] });
        }
      });
  }
  return part;
}

//------------------------------------------------------------------------------
/// Represents one layer by its polygons in the plane; polygons with more than four corners are
/// divided into triangles around an extra point.
PartToUntangle Improver::layerPart() const
{
  PartToUntangle part;
  const auto inPlane = [this](const Vec3& v) {
    return Vec3{ v[(this->Axis + 1) % 3], v[(this->Axis + 2) % 3], 0 };
  };
  const auto isLow = [this](Index point)
  {
    const Index mate = this->Mates[point];
    return mate >= 0 && this->Start[3 * point + this->Axis] < this->Start[3 * mate + this->Axis];
  };
  std::vector<Index> local(this->Mesh.points, -1);
  const auto localOf = [&](Index point)
  {
    if (local[point] < 0)
    {
      const bool moves = this->Movable[point] && this->Constrained.freedom(point) != Freedom::Line;
      local[point] = part.add(inPlane(placeOf(this->Start, point)), !moves);
      part.original.emplace_back(local[point], point);
    }
    return local[point];
  };
  for (const FacePatch& patch : this->Mesh.patches)
  {
    for (Index face = patch.first; patch.isEmpty() && face < patch.first + patch.count; ++face)
    {
      const Index* nodes = this->Mesh.nodes.data() + this->Mesh.offsets[face];
      const Index size = this->Mesh.size(face);
      if (!std::all_of(nodes, nodes + size, isLow))
      {
        continue;
      }
      // As seen from inside, because the normal points out of the low side.
      std::vector<Index> polygon(size);
      Vec3 center = { 0, 0, 0 };
      for (Index k = 0; k < size; ++k)
      {
        polygon[size - 1 - k] = localOf(nodes[k]);
        center += (1.0 / static_cast<double>(size)) * inPlane(placeOf(this->Start, nodes[k]));
      }
      if (size <= 4)
      {
        part.addCell(size == 3 ? CellType::Triangle : CellType::Quadrilateral, polygon);
        continue;
      }
      const Index middle = part.add(center, false);
      for (Index k = 0; k < size; ++k)
      {
        part.addCell(CellType::Triangle, { polygon[k], polygon[(k + 1) % size], middle });
      }
    }
  }
  return part;
}

//------------------------------------------------------------------------------
/// The start after untangling the elements near inverted cells. The result has tetrahedra that do
/// not overlap; tetrahedra with the centers of cells and faces follow in later rounds.
std::vector<double> Improver::untangled(const Want& want) const
{
  const bool layer = this->Axis >= 0;
  const PartToUntangle part =
    layer ? this->layerPart() : this->solidPart(this->cellsNear(want.list, UntangledLayers));
  UntangleOptions options;
  options.maximumSeconds = this->Options.maximumSeconds;
  options.threads = this->Options.threads;
  options.observer = [this](const IterationState&)
  { return !this->Options.proceed || this->Options.proceed(0, 0); };
  const std::vector<double> found = part.untangle(options);
  std::vector<double> points = this->Start;
  for (const auto& [local, point] : part.original)
  {
    for (int c = 0; c < (layer ? 2 : 3); ++c)
    {
      points[3 * point + (layer ? (this->Axis + 1 + c) % 3 : c)] = found[3 * local + c];
    }
  }
  // The other side follows; it may have lower or higher numbers.
  for (const auto& [local, point] : part.original)
  {
    const auto at = points.begin() + 3 * point;
    const bool moved = layer && !std::equal(at, at + 3, this->Start.begin() + 3 * point);
    for (int c = 0; moved && c < 3; ++c)
    {
      double& of = points[3 * this->Mates[point] + c];
      of = c == this->Axis ? of : at[c];
    }
  }
  return points;
}

//------------------------------------------------------------------------------
/// Untangled cells are only just valid: minimizes the energy once in the formerly tangled region.
void Improver::smoothUntangled(Placement& at, const Want& tangled, ImproveFacesResult& result)
{
  Placement smooth = this->place(this->round(at.points, tangled, FirstLayers, 1, result));
  if (!isBetter(at.want, smooth.want) &&
    (!isNoWorse(at.report, result.before) || isNoWorse(smooth.report, result.before)))
  {
    at = std::move(smooth);
  }
}

//------------------------------------------------------------------------------
ImproveFacesResult Improver::run()
{
  const Stopwatch watch;
  ImproveFacesResult result;
  Placement at = this->place(this->Start);
  Placement good = at; // the best placement without a worse check
  result.before = at.report;
  result.wantingBefore = at.want.faces;
  const auto finish = [&](StopReason reason)
  {
    result.points = std::move(good.points);
    result.after = std::move(good.report);
    result.wantingAfter = good.want.faces;
    result.reason = good.want.faces == 0 ? StopReason::AllValid : reason;
    return std::move(result);
  };
  if (std::none_of(this->Movable.begin(), this->Movable.end(), [](char m) { return m != 0; }))
  {
    return finish(StopReason::NoFreeVertices);
  }
  // Whether `at` is `good`; a tangled mesh may temporarily fail other checks.
  bool isGood = true;
  const auto accept = [&]
  {
    isGood = this->Options.untangleOnly || isNoWorse(at.report, result.before);
    if (isGood && !isBetter(good.want, at.want))
    {
      good = at;
    }
  };
  if (at.want.inverted > 0)
  {
    const Want tangled = at.want;
    if (this->findBetter(at, this->untangled(at.want)))
    {
      accept();
      if (!watch.reached(this->Options.maximumSeconds) &&
        (!this->Options.proceed || this->Options.proceed(0, 0)))
      {
        this->smoothUntangled(at, tangled, result);
        accept();
      }
    }
  }
  int layers = FirstLayers, failures = 0;
  double tightness = 1;
  while (result.rounds < this->Options.rounds)
  {
    if (at.want.faces == 0 || failures >= MostFailures)
    {
      return finish(StopReason::NoProgress);
    }
    if (watch.reached(this->Options.maximumSeconds))
    {
      return finish(StopReason::TimeLimit);
    }
    if (this->Options.proceed &&
      !this->Options.proceed(result.rounds,
        static_cast<double>(result.rounds) / static_cast<double>(this->Options.rounds)))
    {
      return finish(StopReason::Aborted);
    }
    ++result.rounds;
    const std::vector<double> to = this->round(at.points, at.want, layers, tightness, result);
    const bool better = at.want.inverted == 0 && isGood ? this->findNoWorse(at, to, result.before)
                                                        : this->findBetter(at, to);
    if (better)
    {
      accept();
      failures = 0;
    }
    else
    {
      ++failures;
      layers = std::min(layers + 2, MostLayers);
      tightness *= Tightening;
    }
  }
  return finish(StopReason::IterationLimit);
}
}

//------------------------------------------------------------------------------
ImproveFacesResult improveFaces(const FaceMesh& mesh, const double* points, const Mesh& solid,
  const BoundaryConstraints& constraints, const ImproveFacesOptions& options)
{
  return Improver(mesh, points, solid, constraints, options).run();
}
}
