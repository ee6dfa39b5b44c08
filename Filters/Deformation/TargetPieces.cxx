// SPDX-License-Identifier: BSD-3-Clause
#include "TargetPieces.h"

#include "RankMesh.h"
#include "TargetOrder.h"
#include "TargetSurface.h"

#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <numeric>

namespace tautline
{
namespace
{
/// How far copies of a point may be apart, of the size of the mesh; rounding of single precision is
/// 1e-7.
constexpr double Torn = 1e-3;

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

/// Whether points of pieces correspond as those of one process that has all of both.
bool areInOnePlace(RankGroup& group, vtkDataSet* mesh, vtkDataSet* target)
{
  const bool has = mesh->GetNumberOfPoints() > 0;
  const bool hasTarget = target && target->GetNumberOfPoints() > 0;
  return group.sum(static_cast<Index>(has)) == 1 && !group.any(has != hasTarget);
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
  template <class PlaceOf>
  PieceMotion moveTo(const PointFlags& matched, const PlaceOf& placeOf);
  PieceMotion moveToClosest(const PointFlags& moved);
  PieceMotion moveInOnePlace(const PointFlags& moved, const PointFlags& matched);
  PieceMotion moveByIds(const PointFlags& matched);
  PieceMotion moveByOrder(const PointFlags& moved, const PointFlags& matched);
  std::vector<FoundPlace> placesOf(const std::vector<double>& ofMesh,
    const std::vector<double>& ofTarget, Index& unknown, double& apart);
  PieceMotion moveTo(const PointFlags& matched, const std::vector<FoundPlace>& found);
  std::vector<double> targetIds();
  bool ownIds(std::vector<double>& ids);
  bool contradictsIds();

  const WarpSettings& Settings;
  RankGroup& Group;
  RankMesh& Whole;
  const WarpPiece& Piece;
};

//------------------------------------------------------------------------------
/// Moves points of the boundary to places of the target. Pieces may differ by rounding; those that
/// differ by more do not correspond to those of the mesh.
/// @param placeOf a point of the piece; writes its place, or returns false
template <class PlaceOf>
PieceMotion TargetPieces::moveTo(const PointFlags& matched, const PlaceOf& placeOf)
{
  const MeshView& piece = this->Whole.piece();
  PieceMotion motion = motionOfPieces(this->Group, this->Whole, matched, this->Settings.amount,
    [&](Index p, Vec3& d)
    {
      const bool has = placeOf(p, d);
      d = d - tautline::pointOf(piece, p);
      return has;
    });
  requireFiniteTarget(motion.broken);
  if (motion.farthest > Torn * diagonalOf(this->local()))
  {
    throw Error("For points that several pieces of the mesh have, the target has different places, "
                "up to " +
      std::to_string(motion.farthest) +
      " apart: its pieces are not those of the mesh with the same points. " + OrderRemedy);
  }
  motion.how = describeMatched(countOwned(this->Group, this->local(), motion.given),
    countOwned(this->Group, this->local(), matched));
  return motion;
}

//------------------------------------------------------------------------------
/// The array of the target that is chosen, one per point of the piece.
std::vector<double> TargetPieces::targetIds()
{
  std::vector<double> ids;
  this->Group.together(
    [&]
    {
      vtkDataSet* target = this->Piece.target;
      const vtkIdType points = target ? target->GetNumberOfPoints() : 0;
      vtkDataArray* array =
        points > 0 ? chosenTargetIds(target, this->Settings.targetIds) : nullptr;
      if (points > 0 && !array)
      {
        throw Error(NoIdsChosen);
      }
      for (vtkIdType i = 0; i < points; ++i)
      {
        ids.push_back(array->GetComponent(i, 0));
      }
    });
  return ids;
}

//------------------------------------------------------------------------------
/// What the ids of the target refer to, one per point of the piece: an array of that name that all
/// pieces have, or the numbers of points.
/// @return whether it is the array
bool TargetPieces::ownIds(std::vector<double>& ids)
{
  const std::string& name = this->Settings.targetIds;
  vtkDataArray* own = this->Piece.input->GetPointData()->GetArray(name.c_str());
  const Index points = this->Whole.piece().numberOfPoints;
  const bool has = !this->Group.any(points > 0 && !own);
  std::vector<Index> positions;
  if (!has)
  {
    const PieceIds known = idsOfPieces(this->Group, this->Piece.rest);
    if (known.order == PointOrder::Coordinates)
    {
      throw Error(noNumbers(name));
    }
    const bool given = known.order == PointOrder::Given;
    PointFlags all;
    this->Group.together(
      [&]
      {
        positions.resize(given ? points : 0);
        std::iota(positions.begin(), positions.end(), Index(0));
        all.assign(given ? 0 : points, 1);
      });
    Index count = 0;
    if (!given)
    {
      positions = positionsOf(this->Group, known.ids, all, count);
    }
  }
  this->Group.together(
    [&]
    {
      for (Index p = 0; p < points; ++p)
      {
        ids.push_back(has ? own->GetComponent(p, 0) : static_cast<double>(positions[p]));
      }
    });
  return has;
}

//------------------------------------------------------------------------------
/// The places that the target has for the ids of this piece. Each id has a process that gets what
/// all have of it, so that none has the whole target.
/// @param ofMesh, ofTarget one per point of the pieces; NaN: none
/// @param unknown gets the number of target points, of all processes, whose id the mesh has not
/// @param apart gets the largest distance between points of the target with one id
std::vector<FoundPlace> TargetPieces::placesOf(const std::vector<double>& ofMesh,
  const std::vector<double>& ofTarget, Index& unknown, double& apart)
{
  const int processes = this->Group.size();
  std::vector<std::vector<TargetPoint>> offered;
  std::vector<std::vector<IdQuery>> asked;
  unknown = 0;
  apart = 0;
  this->Group.together(
    [&]
    {
      offered.resize(processes);
      asked.resize(processes);
      for (std::size_t i = 0; i < ofTarget.size(); ++i)
      {
        TargetPoint point = { ofTarget[i], {} };
        this->Piece.target->GetPoint(static_cast<vtkIdType>(i), point.place.data());
        std::isnan(point.id) ? static_cast<void>(++unknown)
                             : offered[homeOf(point.id, processes)].push_back(point);
      }
      for (std::size_t p = 0; p < ofMesh.size(); ++p)
      {
        const IdQuery query = { ofMesh[p], static_cast<Index>(p) };
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
        apart = std::max(apart, same ? norm(known[k + 1].place - known[k].place) : 0.0);
        wanted[k] = same ? wanted[k + 1] : wanted[k];
        unknown += wanted[k] == 0;
      }
    });
  unknown = this->Group.sum(unknown);
  apart = this->Group.maximum(apart);
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
/// @param found in the order of the points
PieceMotion TargetPieces::moveTo(const PointFlags& matched, const std::vector<FoundPlace>& found)
{
  auto next = found.begin(); // points are visited in their order
  return this->moveTo(matched,
    [&](Index p, Vec3& place)
    {
      next = std::find_if(next, found.end(), [p](const FoundPlace& one) { return one.point >= p; });
      const bool has = next != found.end() && next->point == p;
      place = has ? next->place : Vec3{ 0, 0, 0 };
      return has;
    });
}

//------------------------------------------------------------------------------
/// By an array of ids that both have, or by numbers of points.
PieceMotion TargetPieces::moveByIds(const PointFlags& matched)
{
  std::vector<double> ofTarget = this->targetIds(), ofMesh;
  const bool byArray = this->ownIds(ofMesh);
  for (double& id : ofTarget)
  {
    id = byArray || !(id >= 0) ? id : std::floor(id);
  }
  Index unknown = 0;
  double apart = 0; // the last counts, as on one process
  const std::vector<FoundPlace> found = this->placesOf(ofMesh, ofTarget, unknown, apart);
  requireKnownIds(unknown, this->Settings.targetIds, byArray);
  PieceMotion motion = this->moveTo(matched, found);
  motion.how = "by point ids" + motion.how;
  return motion;
}

//------------------------------------------------------------------------------
/// By the order of the points; to the closest ones where that does not fit.
PieceMotion TargetPieces::moveByOrder(const PointFlags& moved, const PointFlags& matched)
{
  const PieceIds ofMesh = idsOfPieces(this->Group, this->Piece.rest);
  const PieceIds ofTarget = idsOfPieces(this->Group, this->Piece.target);
  const OrderMatch match =
    matchByOrder(this->Settings, this->Group, this->Whole, this->Piece, moved, ofMesh, ofTarget);
  if (match.how.empty())
  {
    return this->moveToClosest(moved);
  }
  const auto numbers = [this](const std::vector<Index>& positions)
  {
    std::vector<double> ids;
    this->Group.together(
      [&]
      {
        ids.assign(positions.begin(), positions.end());
        std::replace(ids.begin(), ids.end(), -1.0, std::numeric_limits<double>::quiet_NaN());
      });
    return ids;
  };
  Index unknown = 0;
  double apart = 0;
  const std::vector<double> ids = numbers(match.ofMesh), targetIds = numbers(match.ofTarget);
  const std::vector<FoundPlace> found = this->placesOf(ids, targetIds, unknown, apart);
  if (apart > Torn * diagonalOf(this->local()))
  {
    throw Error("Points of the target at different places, up to " + std::to_string(apart) +
      " apart, have the same global id: run Generate Global Ids again.");
  }
  PieceMotion motion = this->moveTo(matched, found);
  motion.how = match.how + motion.how;
  return motion;
}

//------------------------------------------------------------------------------
/// Of a mesh and a target that one process has: as if it were alone. The mesh may still be divided
/// among all.
PieceMotion TargetPieces::moveInOnePlace(const PointFlags& moved, const PointFlags& matched)
{
  const std::vector<Index>& localOf = this->local().localOfPiece();
  TargetPlaces places;
  this->Group.together(
    [&]
    {
      if (localOf.empty())
      {
        return;
      }
      // Of points that are one the first.
      PointFlags projected(localOf.size(), 0), chosen(projected);
      std::vector<char> seen(this->local().localPoints(), 0);
      for (std::size_t p = 0; p < localOf.size(); ++p)
      {
        const Index at = localOf[p];
        if (at >= 0 && !seen[at])
        {
          seen[at] = 1;
          projected[p] = moved[at];
          chosen[p] = matched[at];
        }
      }
      const Mesh view(this->Whole.piece());
      TargetRequest request;
      request.mesh = this->Piece.rest;
      request.view = &view;
      request.target = this->Piece.target;
      request.correspondence = this->Settings.correspondence;
      request.projected = &projected;
      request.matched = &chosen;
      request.threads = this->Settings.options.threads;
      places = tautline::placesOf(request);
    });
  PointFlags all;
  this->Group.together([&] { all.assign(this->local().localPoints(), 1); });
  PieceMotion motion = motionOfPieces(this->Group, this->Whole, all, this->Settings.amount,
    [&places](Index p, Vec3& d)
    {
      std::copy_n(&places.displacement[3 * p], 3, d.begin());
      return places.given[p] != 0;
    });
  for (const std::vector<char>& how :
    this->Group.gatherItems(std::vector<char>(places.how.begin(), places.how.end())))
  {
    motion.how += std::string(how.begin(), how.end());
  }
  return motion;
}

//------------------------------------------------------------------------------
PieceMotion TargetPieces::moveToClosest(const PointFlags& moved)
{
  const auto surface = targetSurfaceOnAll(this->Group, this->Piece.target, this->Whole.volume());
  Projection found;
  this->Group.together([&] { found = projected(surface, this->local().points().data(), moved); });
  PieceMotion motion;
  motion.displacement = std::move(found.displacement);
  for (double& d : motion.displacement)
  {
    d *= this->Settings.amount;
  }
  motion.how = describeProjection(
    countOwned(this->Group, this->local(), moved), this->Group.maximum(found.farthest));
  return motion;
}

//------------------------------------------------------------------------------
/// Whether all pieces of mesh and target have global ids, and those of points with the same number
/// in their pieces differ: the pieces are alike, but in other places.
bool TargetPieces::contradictsIds()
{
  const auto lacks = [](vtkDataSet* piece)
  { return piece && piece->GetNumberOfPoints() > 0 && !piece->GetPointData()->GetGlobalIds(); };
  vtkDataSet* target = this->Piece.target;
  const bool differ = target && !haveSameIds(this->Piece.rest, target);
  return !this->Group.any(lacks(this->Piece.rest) || lacks(target)) && this->Group.any(differ);
}

//------------------------------------------------------------------------------
PieceMotion TargetPieces::run(const PointFlags& moved, const PointFlags& matched)
{
  if (this->Settings.correspondence == Correspondence::ClosestPoint)
  {
    return this->moveToClosest(moved);
  }
  if (matchesByIds(this->Settings))
  {
    return this->moveByIds(matched);
  }
  const bool onePlace = areInOnePlace(this->Group, this->Piece.rest, this->Piece.target);
  const bool anywhere = this->Settings.correspondence != Correspondence::SameBoundary;
  if (anywhere && !this->Group.any(!haveSameCells(this->Piece.rest, this->Piece.target)) &&
    (onePlace || !this->contradictsIds()))
  {
    PieceMotion motion = this->moveTo(matched,
      [this](Index p, Vec3& place)
      {
        this->Piece.target->GetPoint(p, place.data());
        return true;
      });
    motion.how = "as the same mesh, point by point" + motion.how;
    return motion;
  }
  return onePlace ? this->moveInOnePlace(moved, matched) : this->moveByOrder(moved, matched);
}
}

//------------------------------------------------------------------------------
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

//------------------------------------------------------------------------------
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
