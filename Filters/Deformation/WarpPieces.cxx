// SPDX-License-Identifier: BSD-3-Clause
#include "WarpPieces.h"

#include "PieceMotion.h"
#include "Processes.h"
#include "tautline/Core/Stopwatch.h"
#include "tautline/Mesh/BoundaryParts.h"
#include "tautline/Mesh/Ranks.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace tautline
{
namespace
{
/// The moved points of all processes, in the order of their ids.
struct MovedPoints
{
  std::vector<Index> ids;
  std::vector<double> places; ///< 3 each
};

/// A copy of everything except the points, which may not fit into memory twice.
WarpResult copyWithoutPoints(WarpResult& result)
{
  std::vector<double> points;
  points.swap(result.points);
  WarpResult copy = result;
  points.swap(result.points);
  return copy;
}

/**
 * @class PieceWarp
 * @brief The state of an execution.
 */
class PieceWarp
{
public:
  PieceWarp(WarpSession& session, MovableMesh& mesh, const InputBlock& piece, vtkDataObject* moved);
  void run(TableRows& history, TableRows& statistics, WarpTotals& totals);

private:
  DistributedMesh& local() { return this->Whole.distributed(); }
  /// Whether the piece has cells; a piece without cells need not have arrays.
  bool here() const
  {
    return this->Piece.input->GetNumberOfPoints() > 0 && this->Piece.input->GetNumberOfCells() > 0;
  }
  Index countOwned(const PointFlags& flags) { return tautline::countOwned(this->local(), flags); }
  Index countInvalid(const std::vector<double>& points);
  void requireElements();
  PointFlags chosenToMove();
  PointFlags staying();
  void findMotion();
  void moveByArray();
  void moveOverTime();
  void moveByTransform();
  void prescribe(WarpFacts& facts);
  void findTensors();
  std::vector<double> transformed(double fraction);
  WarpResult resultOfStep();
  WarpResult warpFromPrevious(const WarpResult& previous);
  WarpResult warp();
  WarpResult run(const WarpTask& task);
  void report(WarpResult& result, WarpFacts& facts, TableRows& history, TableRows& statistics,
    WarpTotals& totals);

  WarpSession& Session;
  const WarpSettings& Settings;
  RankGroup& Group;
  MovableMesh& Whole;
  const InputBlock& Piece; ///< at this time step; the mesh is the first step's
  vtkDataSet* Selected;    ///< with marks on the selected points, or null
  std::vector<Index> Ids;  ///< per local point
  PointFlags Boundary, Moved;
  WarpTask Task;     ///< for the local points and cells
  MovedPoints Cloud; ///< of a transform
};

//------------------------------------------------------------------------------
PieceWarp::PieceWarp(
  WarpSession& session, MovableMesh& mesh, const InputBlock& piece, vtkDataObject* moved)
  : Session(session)
  , Settings(session.settings)
  , Group(mesh.group())
  , Whole(mesh)
  , Piece(piece)
  , Selected(vtkDataSet::SafeDownCast(moved))
  , Ids(mesh.pointIds())
{
}

//------------------------------------------------------------------------------
/// Inverted and degenerate elements of the whole mesh with these local points.
Index PieceWarp::countInvalid(const std::vector<double>& points)
{
  const int threads = this->Settings.options.threads;
  const Mesh start = localMesh(this->local(), this->Whole.mirrored(), threads);
  std::vector<signed char> validity(start.view().numberOfCells);
  start.at(points.data()).classifyCells(validity.data(), threads);
  return Ranks(this->local()).countInvalid(start, validity);
}

//------------------------------------------------------------------------------
/// Like requireElements() for a mesh on one process.
void PieceWarp::requireElements()
{
  const MeshView& view = this->Whole.piece();
  Index shapeless = 0;
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    shapeless += cornerType(view.cellTypes[cell]) == CellType::Unsupported &&
      !hasNoInside(view.cellTypes[cell]);
  }
  requireShapes(this->Group.sum(shapeless));
  const DistributedMesh& mesh = this->local();
  const Index inverted = this->countInvalid(mesh.points());
  if (inverted > 0)
  {
    throw Error(std::to_string(inverted) +
      " elements are inverted or degenerate before the warp: run Untangle Mesh first.");
  }
}

//------------------------------------------------------------------------------
/// The points of the boundary that a transform moves, per local point.
PointFlags PieceWarp::chosenToMove()
{
  PartChoice choice = partChoice(this->Settings, this->Piece.input);
  const bool byPiece = choice.part == MovedPart::Values || choice.part == MovedPart::Selection;
  BoundaryParts parts;
  if (choice.part == MovedPart::Inner || choice.part == MovedPart::Numbered)
  {
    DistributedMesh& mesh = this->local();
    parts = boundaryParts(Mesh(mesh.view()), Ranks(mesh));
  }
  choice.parts = [&parts]() -> const BoundaryParts& { return parts; };
  if (!byPiece)
  {
    PointFlags moved;
    moved = movedPoints(Mesh(this->local().view()), this->Boundary, choice);
    return moved;
  }
  PointFlags marked(this->Whole.piece().numberOfPoints, 0);
  choice.selected = this->Selected;
  choice.elsewhere = this->Group.any(this->Selected != nullptr);
  if (this->here())
  {
    marked = markedPoints(Mesh(this->Whole.piece()), choice);
  }
  PointFlags moved = this->Whole.anyOf(marked);
  const Index chosen = this->countOwned(moved);
  std::transform(moved.begin(), moved.end(), this->Boundary.begin(), moved.begin(),
    [](unsigned char a, unsigned char b) { return a && b; });
  requireMoved(this->countOwned(moved), chosen);
  return moved;
}

//------------------------------------------------------------------------------
/// The points chosen to stay, per local point.
PointFlags PieceWarp::staying()
{
  PointFlags marked(this->Whole.piece().numberOfPoints, 0);
  markPoints(this->Whole.piece(),
    chosenArray(
      this->Settings.arrays, FixedArray, this->Piece.input, "of fixed points", ArrayOf::Points),
    false, marked);
  markPoints(this->Whole.piece(), this->Piece.selected, marked);
  return this->Whole.anyOf(marked);
}

//------------------------------------------------------------------------------
/// All pieces must have the same displacement for merged points.
void PieceWarp::moveByArray()
{
  const Index points = this->Whole.piece().numberOfPoints;
  std::vector<double> given(3 * points, 0.0);
  PointFlags boundary(points, 0);
  for (Index p = 0; p < points; ++p)
  {
    const Index at = this->local().localOfPiece()[p];
    boundary[p] = at >= 0 && this->Boundary[at];
  }
  if (this->here())
  {
    given = displacementsOf(displacementArray(this->Settings.arrays, this->Piece.input), boundary);
  }
  PieceMotion motion = motionOfPieces(this->Whole, this->Boundary, this->Settings.amount,
    [&given](Index p) {
      return Vec3{ given[3 * p], given[3 * p + 1], given[3 * p + 2] };
    });
  if (motion.farthest > 0)
  {
    throw Error("Coincident points are treated as one, but have different displacements: make them "
                "equal, or switch Merge Coincident Points off.");
  }
  this->Task.displacement = std::move(motion.displacement);
}

//------------------------------------------------------------------------------
/// The boundary moves to its position at this time step.
void PieceWarp::moveOverTime()
{
  if (this->Session.times.empty())
  {
    throw Error(NoTimeSteps);
  }
  const MeshView& piece = this->Whole.piece();
  PieceMotion motion = motionOfPieces(this->Whole, this->Boundary, this->Settings.amount,
    [&](Index p)
    {
      Vec3 place;
      this->Piece.input->GetPoint(p, place.data());
      return place - tautline::pointOf(piece, p);
    });
  if (motion.broken > 0)
  {
    throw Error("The displacements of " + std::to_string(motion.broken) +
      " prescribed points are NaN or infinite.");
  }
  constexpr double rounding = 1e-6; // relative to the size of the mesh: single precision has 1e-7
  if (motion.farthest > rounding * diagonalOf(this->local()))
  {
    throw Error("Coincident points are treated as one, but have different positions at this time "
                "step: make them equal, or switch Merge Coincident Points off.");
  }
  this->Task.displacement = std::move(motion.displacement);
}

//------------------------------------------------------------------------------
/// The displacements for a fraction of the transform, per local point.
std::vector<double> PieceWarp::transformed(double fraction)
{
  const auto count = static_cast<Index>(this->Cloud.ids.size());
  const PointFlags all(this->Cloud.ids.size() + 1, 1);
  const std::vector<double> moved = displacements(this->Settings.transform,
    fraction * this->Settings.amount, count, this->Cloud.places.data(), all.data());
  std::vector<double> result(3 * this->Ids.size(), 0.0);
  for (std::size_t p = 0; p < this->Ids.size(); ++p)
  {
    if (this->Moved[p])
    {
      const auto at =
        std::lower_bound(this->Cloud.ids.begin(), this->Cloud.ids.end(), this->Ids[p]);
      std::copy_n(&moved[3 * (at - this->Cloud.ids.begin())], 3, &result[3 * p]);
    }
  }
  return result;
}

//------------------------------------------------------------------------------
/// The motion depends on the positions of all moved points: every process gets them.
void PieceWarp::moveByTransform()
{
  struct MovedPoint
  {
    Index id;
    Vec3 place;
  };
  this->Moved = this->chosenToMove();
  std::vector<MovedPoint> own;
  for (Index p = 0; p < this->local().localPoints(); ++p)
  {
    if (this->Moved[p] && this->local().owned(p))
    {
      own.push_back({ this->Ids[p], pointOf(this->local().view(), p) });
    }
  }
  const std::vector<std::vector<MovedPoint>> lists = this->Group.gatherItems(own);
  std::vector<MovedPoint> all;
  for (const std::vector<MovedPoint>& list : lists)
  {
    all.insert(all.end(), list.begin(), list.end());
  }
  std::sort(
    all.begin(), all.end(), [](const MovedPoint& a, const MovedPoint& b) { return a.id < b.id; });
  for (const MovedPoint& point : all)
  {
    this->Cloud.ids.push_back(point.id);
    this->Cloud.places.insert(this->Cloud.places.end(), point.place.begin(), point.place.end());
  }
  this->Task.path = [this](double fraction) { return this->transformed(fraction); };
  this->Task.displacement = this->transformed(1.0);
}

//------------------------------------------------------------------------------
/// Converts coefficients per cell of the piece to the local cells.
void PieceWarp::findTensors()
{
  const WarpSettings& set = this->Settings;
  if (!set.anisotropic() || set.options.coefficients != WarpCoefficients::PerCell)
  {
    return;
  }
  const std::vector<double> ofPiece = chosenTensors(set, this->Piece.input);
  for (std::size_t cell = 0; 6 * cell < ofPiece.size(); ++cell)
  {
    if (!this->Whole.skipped()[cell])
    {
      requireTensor(&ofPiece[6 * cell], static_cast<Index>(cell), "piece");
    }
  }
  this->Task.tensors = this->Whole.ofCells(ofPiece, 6);
}

//------------------------------------------------------------------------------
/// The displacements and the prescribed points, including points that stay.
void PieceWarp::prescribe(WarpFacts& facts)
{
  this->Task.stay = this->staying();
  this->Task.prescribed = this->Boundary;
  holdStaying(this->Task);
  for (Index p = 0; p < this->local().localPoints(); ++p)
  {
    const double* d = &this->Task.displacement[3 * p];
    const double length = norm({ d[0], d[1], d[2] });
    facts.movedPoints += length > 0 && this->local().owned(p);
    facts.largestDisplacement = std::max(facts.largestDisplacement, length);
  }
  facts.movedPoints = this->Group.sum(facts.movedPoints);
  facts.largestDisplacement = this->Group.maximum(facts.largestDisplacement);
  facts.boundaryPoints = this->countOwned(this->Task.prescribed);
}

//------------------------------------------------------------------------------
/// The result at this time step, see WarpSession::warp().
WarpResult PieceWarp::resultOfStep()
{
  if (!this->Session.sequence() || !this->Settings.fromPreviousStep)
  {
    return this->warp();
  }
  WarpBlock& kept = this->Session.ownPiece();
  const int step = this->Session.current;
  const auto done = kept.frames.find(step), before = kept.frames.find(step - 1);
  if (done != kept.frames.end())
  {
    WarpResult result;
    result = copyWithoutPoints(done->second);
    result.points = localPoints(this->Whole, done->second.points);
    return result;
  }
  WarpResult result =
    before == kept.frames.end() ? this->warp() : this->warpFromPrevious(before->second);
  if (before != kept.frames.end())
  {
    notePrevious(before->second, result);
  }
  const Index most = this->Group.maximum(3 * this->Whole.piece().numberOfPoints);
  limitFrames(kept, static_cast<std::size_t>(most));
  WarpResult frame = copyWithoutPoints(result);
  frame.points = this->Whole.ofPiece(result.points);
  kept.frames[step] = std::move(frame);
  return result;
}

//------------------------------------------------------------------------------
/// Like WarpSession::warpFromPrevious().
WarpResult PieceWarp::warpFromPrevious(const WarpResult& previous)
{
  DistributedMesh& mesh = this->local();
  std::vector<double> points = localPoints(this->Whole, previous.points);
  if (this->countInvalid(points) > 0)
  {
    WarpResult result = this->run(this->Task);
    result.message += (result.message.empty() ? "" : " ") + std::string(PreviousInvalid);
    return result;
  }
  WarpTask rise = this->Task;
  for (std::size_t i = 0; i < rise.displacement.size(); ++i)
  {
    rise.displacement[i] += mesh.points()[i] - points[i];
  }
  const PlacedPoints placed(mesh, std::move(points));
  return this->run(rise);
}

//------------------------------------------------------------------------------
WarpResult PieceWarp::warp()
{
  return this->Group.any(!staysAtRest(this->Task))
    ? this->run(this->Task)
    : resultAtRest(this->Settings, this->local().points());
}

//------------------------------------------------------------------------------
/// Starts from the current points of the mesh.
WarpResult PieceWarp::run(const WarpTask& task)
{
  const WarpSettings& set = this->Settings;
  WarpOptions options = set.options;
  options.prescribed = task.prescribed.data();
  options.tensors = task.tensors.empty() ? nullptr : task.tensors.data();
  options.maximumSeconds = set.secondsLeft();
  options.progress = [&set](double fraction) { return set.progress(0, fraction); };
  Warper warper(
    this->local(), this->Whole.mirrored(), this->Ids, this->Group.communicator(), options);
  return runWarp(warper, task);
}

//------------------------------------------------------------------------------
/// Adds arrays and rows. The data of the motion are freed, because they are as large as the data of
/// the measurement.
void PieceWarp::report(WarpResult& result, WarpFacts& facts, TableRows& history,
  TableRows& statistics, WarpTotals& totals)
{
  this->Task = {};
  this->Ids = {};
  this->Cloud = {};
  this->Boundary = {};
  this->Moved = {};
  addWarpOutput(this->Whole, result, facts, this->Piece, history, statistics, totals);
}

//------------------------------------------------------------------------------
void PieceWarp::findMotion()
{
  switch (this->Settings.motion)
  {
    case MotionSource::Displacement:
      this->moveByArray();
      break;
    case MotionSource::TimeSteps:
      this->moveOverTime();
      break;
    case MotionSource::Transform:
      this->moveByTransform();
      break;
    case MotionSource::Target: // gathered
      break;
  }
}

//------------------------------------------------------------------------------
void PieceWarp::run(TableRows& history, TableRows& statistics, WarpTotals& totals)
{
  const Stopwatch clock;
  this->requireElements();
  this->Boundary = rankBoundary(this->local());
  if (this->countOwned(this->Boundary) == 0)
  {
    throw Error("The mesh has no boundary (it is closed) that its points could follow.");
  }
  this->findMotion();
  WarpFacts counts;
  this->prescribe(counts);
  this->findTensors();
  WarpResult result = this->resultOfStep();
  if (!this->Session.atRequested())
  {
    return;
  }
  WarpFacts facts = factsOf(this->Settings, this->Task);
  facts.movedPoints = counts.movedPoints;
  facts.boundaryPoints = counts.boundaryPoints;
  facts.largestDisplacement = counts.largestDisplacement;
  facts.seconds = clock.seconds();
  this->report(result, facts, history, statistics, totals);
}

/// Whether two pieces have equal numbers of points and the same cells; null counts as empty.
bool haveSameCells(vtkDataSet* piece, vtkDataSet* other)
{
  if (!other || other->GetNumberOfPoints() != piece->GetNumberOfPoints() ||
    other->GetNumberOfCells() != piece->GetNumberOfCells())
  {
    return !other && piece->GetNumberOfPoints() == 0;
  }
  vtkNew<vtkIdList> a, b;
  for (vtkIdType cell = 0; cell < piece->GetNumberOfCells(); ++cell)
  {
    piece->GetCellPoints(cell, a);
    other->GetCellPoints(cell, b);
    if (!std::equal(a->begin(), a->end(), b->begin(), b->end()))
    {
      return false;
    }
  }
  return true;
}

/// Whether two pieces have equal numbers of points and the same global ids, or both have none.
bool haveSameIds(vtkDataSet* piece, vtkDataSet* other)
{
  vtkDataArray* a = piece->GetPointData()->GetGlobalIds();
  vtkDataArray* b = other->GetPointData()->GetGlobalIds();
  const vtkIdType points = piece->GetNumberOfPoints();
  bool same = points == other->GetNumberOfPoints() && (points == 0 || !a == !b);
  for (vtkIdType i = 0; same && a && b && i < points; ++i)
  {
    same = a->GetComponent(i, 0) == b->GetComponent(i, 0);
  }
  return same;
}

/// Whether two pieces have the same points and cells, at any positions.
bool areAlike(vtkDataSet* piece, vtkDataSet* other)
{
  // Null stands for blocks; the other is also null if the first piece had no explicit points.
  return piece && other && haveSameCells(piece, other) && haveSameIds(piece, other);
}
}

//------------------------------------------------------------------------------
void warpPieces(WarpSession& session, MovableMesh& mesh, const InputBlock& block,
  vtkDataObject* moved, TableRows& history, TableRows& statistics, WarpTotals& totals)
{
  mesh.group().together(
    [&]
    {
      if (session.sequence() && mesh.group().any(!areAlike(block.input, session.ownPiece().first)))
      {
        session.beginGathered();
      }
      else if (session.atRequested() || session.settings.fromPreviousStep)
      {
        PieceWarp(session, mesh, block, moved).run(history, statistics, totals);
      }
    });
}
}
