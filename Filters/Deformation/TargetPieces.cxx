// SPDX-License-Identifier: BSD-3-Clause
#include "TargetPieces.h"

#include "RankMesh.h"
#include "TargetSurface.h"

#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

namespace tautline
{
namespace
{
/// A point of the target by its id.
struct TargetPoint
{
  double id;
  Vec3 place;

  /// By id, then bit by bit, so that coordinates that are NaN have a place in the order, too.
  bool operator<(const TargetPoint& other) const
  {
    return this->id != other.id ? this->id < other.id : this->compare(other) < 0;
  }
  bool operator==(const TargetPoint& other) const
  {
    return this->id == other.id && this->compare(other) == 0;
  }

private:
  int compare(const TargetPoint& other) const
  {
    return std::memcmp(this->place.data(), other.place.data(), sizeof(this->place));
  }
};

/// A point of a piece that asks for the place of its id.
struct IdQuery
{
  double id;
  Index point;
};

/// The answer.
struct FoundPlace
{
  Index point;
  Vec3 place;
};

/// The process that knows an id.
std::size_t homeOf(double id, int processes)
{
  return std::hash<double>()(id) % static_cast<std::size_t>(processes);
}

/// Whether points of a target correspond to those of the mesh by ids.
bool matchesByIds(const WarpSettings& settings)
{
  const bool chosen = !settings.targetIds.empty() && settings.targetIds != "None";
  return settings.correspondence == Correspondence::PointIds ||
    (settings.correspondence == Correspondence::Automatic && chosen);
}

/// Whether a piece of the target has the points and cells of a piece of the mesh.
bool isSamePiece(vtkDataSet* input, vtkDataSet* target)
{
  if (!target || target->GetNumberOfPoints() != input->GetNumberOfPoints() ||
    target->GetNumberOfCells() != input->GetNumberOfCells())
  {
    return !target && input->GetNumberOfPoints() == 0;
  }
  vtkNew<vtkIdList> a, b;
  for (vtkIdType cell = 0; cell < input->GetNumberOfCells(); ++cell)
  {
    input->GetCellPoints(cell, a);
    target->GetCellPoints(cell, b);
    if (!std::equal(a->begin(), a->end(), b->begin(), b->end()))
    {
      return false;
    }
  }
  return true;
}

/**
 * @class TargetPieces
 * @brief A motion to a target, on processes.
 */
class TargetPieces
{
public:
  TargetPieces(
    const WarpSettings& settings, RankGroup& group, RankMesh& mesh, const WarpPiece& piece)
    : Settings(settings)
    , Group(group)
    , Whole(mesh)
    , Piece(piece)
  {
  }
  PieceMotion run(const PointFlags& moved, const PointFlags& matched);

private:
  DistributedMesh& local() { return this->Whole.mesh(); }
  void takeLeast(const std::vector<double>& given);
  template <class PlaceOf>
  PointFlags moveTo(const PointFlags& matched, const PlaceOf& placeOf);
  std::vector<FoundPlace> placesById(Index& unknown);
  void moveByIds(const PointFlags& matched);

  const WarpSettings& Settings;
  RankGroup& Group;
  RankMesh& Whole;
  const WarpPiece& Piece;
  PieceMotion Motion;
};

//------------------------------------------------------------------------------
/// The displacements of local points from those of the piece's. Pieces may differ by rounding: of
/// each component the least, which does not depend on the processes. Pieces that differ by more do
/// not correspond to those of the mesh.
/// @param given infinite where no place is given
void TargetPieces::takeLeast(const std::vector<double>& given)
{
  constexpr double none = std::numeric_limits<double>::infinity();
  constexpr double torn = 1e-3; // of the size of the mesh; rounding of single precision is 1e-7
  std::vector<double> component, negative;
  this->Group.together(
    [&]
    {
      component.resize(this->Whole.piece().numberOfPoints);
      negative.resize(component.size());
      this->Motion.displacement.assign(3 * this->local().localPoints(), 0.0);
    });
  double farthest = 0;
  for (int c = 0; c < 3; ++c)
  {
    for (std::size_t p = 0; p < component.size(); ++p)
    {
      component[p] = given[3 * p + c];
      negative[p] = component[p] == none ? none : -component[p];
    }
    const std::vector<double> least = this->Whole.leastOf(component, none);
    const std::vector<double> most = this->Whole.leastOf(negative, none);
    for (Index p = 0; p < this->local().localPoints(); ++p)
    {
      if (least[p] != none)
      {
        farthest = std::max(farthest, -most[p] - least[p]);
        this->Motion.displacement[3 * p + c] = this->Settings.amount * least[p];
      }
    }
  }
  farthest = this->Group.maximum(farthest);
  const std::array<double, 6>& box = this->local().bounds();
  if (farthest > torn * norm({ box[3] - box[0], box[4] - box[1], box[5] - box[2] }))
  {
    throw Error("For points that several pieces of the mesh have, the target has different places, "
                "up to " +
      std::to_string(farthest) +
      " apart: its pieces are not those of the mesh with the same points. " + OrderRemedy);
  }
}

//------------------------------------------------------------------------------
/// Moves points of the boundary to places of the target.
/// @param placeOf a point of the piece; writes its place, or returns false
/// @return one flag per local point: it has a place
template <class PlaceOf>
PointFlags TargetPieces::moveTo(const PointFlags& matched, const PlaceOf& placeOf)
{
  const MeshView& piece = this->Whole.piece();
  std::vector<double> given;
  PointFlags placed, broken;
  this->Group.together(
    [&]
    {
      given.assign(3 * piece.numberOfPoints, std::numeric_limits<double>::infinity());
      placed.assign(piece.numberOfPoints, 0);
      broken = placed;
      for (Index p = 0; p < piece.numberOfPoints; ++p)
      {
        const Index at = this->local().localOfPiece()[p];
        Vec3 place;
        if (at < 0 || !matched[at] || !placeOf(p, place))
        {
          continue;
        }
        const Vec3 d = place - tautline::pointOf(piece, p);
        placed[p] = 1;
        broken[p] = !std::isfinite(d[0]) || !std::isfinite(d[1]) || !std::isfinite(d[2]);
        std::copy(d.begin(), d.end(), &given[3 * p]);
      }
    });
  requireFiniteTarget(countOwned(this->Group, this->local(), this->Whole.anyOf(broken)));
  this->takeLeast(given);
  return this->Whole.anyOf(placed);
}

//------------------------------------------------------------------------------
/// The places that the target has for the ids of this piece. Each id has a process that gets what
/// all have of it, so that none has the whole target.
/// @param unknown gets the number of target points, of all processes, whose id the mesh has not
std::vector<FoundPlace> TargetPieces::placesById(Index& unknown)
{
  const int processes = this->Group.size();
  vtkDataSet* target = this->Piece.target;
  std::vector<std::vector<TargetPoint>> offered;
  std::vector<std::vector<IdQuery>> asked;
  unknown = 0;
  this->Group.together(
    [&]
    {
      offered.resize(processes);
      asked.resize(processes);
      const std::string& name = this->Settings.targetIds;
      const vtkIdType points = target ? target->GetNumberOfPoints() : 0;
      vtkDataArray* ids = points > 0 ? chosenTargetIds(target, name) : nullptr;
      if (points > 0 && !ids)
      {
        throw Error(NoIdsChosen);
      }
      for (vtkIdType i = 0; i < points; ++i)
      {
        TargetPoint point = { ids->GetComponent(i, 0), {} };
        target->GetPoint(i, point.place.data());
        std::isnan(point.id) ? static_cast<void>(++unknown)
                             : offered[homeOf(point.id, processes)].push_back(point);
      }
      vtkDataArray* own = this->Piece.input->GetPointData()->GetArray(name.c_str());
      for (Index p = 0; p < this->Whole.piece().numberOfPoints; ++p)
      {
        const IdQuery query = { own->GetComponent(p, 0), p };
        if (!std::isnan(query.id))
        {
          asked[homeOf(query.id, processes)].push_back(query);
        }
      }
    });
  const std::vector<std::vector<TargetPoint>> offers = this->Group.exchangeItems(offered);
  const std::vector<std::vector<IdQuery>> queries = this->Group.exchangeItems(asked);
  std::vector<std::vector<FoundPlace>> answers;
  this->Group.together(
    [&]
    {
      offered = {};
      asked = {};
      std::vector<TargetPoint> known;
      for (const std::vector<TargetPoint>& list : offers)
      {
        known.insert(known.end(), list.begin(), list.end());
      }
      std::sort(known.begin(), known.end());
      known.erase(std::unique(known.begin(), known.end()), known.end());
      PointFlags wanted(known.size(), 0);
      answers.resize(processes);
      for (std::size_t process = 0; process < queries.size(); ++process)
      {
        for (const IdQuery& query : queries[process])
        {
          // Of points at different places the last, as one process takes it.
          const auto end = std::upper_bound(known.begin(), known.end(), query.id,
            [](double id, const TargetPoint& point) { return id < point.id; });
          if (end != known.begin() && std::prev(end)->id == query.id)
          {
            answers[process].push_back({ query.point, std::prev(end)->place });
            wanted[std::prev(end) - known.begin()] = 1;
          }
        }
      }
      for (std::size_t k = known.size(); k-- > 0;)
      {
        const bool same = k + 1 < known.size() && known[k + 1].id == known[k].id;
        wanted[k] = same ? wanted[k + 1] : wanted[k];
        unknown += wanted[k] == 0;
      }
    });
  unknown = this->Group.sum(unknown);
  std::vector<FoundPlace> found;
  const std::vector<std::vector<FoundPlace>> lists = this->Group.exchangeItems(answers);
  this->Group.together(
    [&]
    {
      for (const std::vector<FoundPlace>& list : lists)
      {
        found.insert(found.end(), list.begin(), list.end());
      }
      std::sort(found.begin(), found.end(),
        [](const FoundPlace& a, const FoundPlace& b) { return a.point < b.point; });
    });
  return found;
}

//------------------------------------------------------------------------------
/// By an array of ids that both have.
void TargetPieces::moveByIds(const PointFlags& matched)
{
  Index unknown = 0;
  const std::vector<FoundPlace> found = this->placesById(unknown);
  requireKnownIds(unknown, this->Settings.targetIds, true);
  auto next = found.begin(); // points are visited in their order
  const PointFlags placed = this->moveTo(matched,
    [&](Index p, Vec3& place)
    {
      next = std::find_if(next, found.end(), [p](const FoundPlace& one) { return one.point >= p; });
      const bool has = next != found.end() && next->point == p;
      place = has ? next->place : place;
      return has;
    });
  this->Motion.how = "by point ids" +
    describeMatched(countOwned(this->Group, this->local(), placed),
      countOwned(this->Group, this->local(), matched));
}

//------------------------------------------------------------------------------
PieceMotion TargetPieces::run(const PointFlags& moved, const PointFlags& matched)
{
  const WarpSettings& set = this->Settings;
  vtkDataSet* piece = this->Piece.target;
  if (set.correspondence == Correspondence::ClosestPoint)
  {
    const auto surface = targetSurfaceOnAll(this->Group, piece, this->Whole.volume());
    Projection found;
    this->Group.together([&] { found = projected(surface, this->local().points().data(), moved); });
    std::transform(found.displacement.begin(), found.displacement.end(), found.displacement.begin(),
      [&set](double d) { return set.amount * d; });
    this->Motion.displacement = std::move(found.displacement);
    this->Motion.how = describeProjection(
      countOwned(this->Group, this->local(), moved), this->Group.maximum(found.farthest));
    return std::move(this->Motion);
  }
  if (matchesByIds(set))
  {
    this->moveByIds(matched);
    return std::move(this->Motion);
  }
  const PointFlags placed = this->moveTo(matched,
    [this](Index p, Vec3& place)
    {
      this->Piece.target->GetPoint(p, place.data());
      return true;
    });
  this->Motion.how = "as the same mesh, point by point" +
    describeMatched(countOwned(this->Group, this->local(), placed),
      countOwned(this->Group, this->local(), matched));
  return std::move(this->Motion);
}
}

//------------------------------------------------------------------------------
Index countOwned(RankGroup& group, const DistributedMesh& mesh, const PointFlags& flags)
{
  Index count = 0;
  for (Index p = 0; p < mesh.localPoints(); ++p)
  {
    count += flags[p] != 0 && mesh.owned(p);
  }
  return group.sum(count);
}

//------------------------------------------------------------------------------
bool findsPlaces(const WarpSettings& settings, vtkDataSet* input, vtkDataSet* target)
{
  if (settings.correspondence == Correspondence::ClosestPoint)
  {
    return true;
  }
  if (matchesByIds(settings))
  {
    return input->GetNumberOfPoints() == 0 ||
      input->GetPointData()->GetArray(settings.targetIds.c_str());
  }
  return settings.correspondence != Correspondence::SameBoundary && isSamePiece(input, target);
}

//------------------------------------------------------------------------------
void requireTarget(RankGroup& group, vtkDataSet* piece)
{
  if (!group.any(piece != nullptr))
  {
    throw Error(NoTarget);
  }
  if (!group.any(piece && piece->GetNumberOfPoints() > 0))
  {
    throw Error(EmptyTarget);
  }
}

//------------------------------------------------------------------------------
PieceMotion moveToTarget(const WarpSettings& settings, RankGroup& group, RankMesh& mesh,
  const WarpPiece& piece, const PointFlags& moved, const PointFlags& matched)
{
  return TargetPieces(settings, group, mesh, piece).run(moved, matched);
}
}
