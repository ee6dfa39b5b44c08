// SPDX-License-Identifier: BSD-3-Clause
// The points and cells of one mesh in pieces that are those of another one, cut differently.
#include "RankPieces.h"

#include "PointKey.h"

#include <algorithm>
#include <sstream>

namespace tautline
{
namespace
{
constexpr char Differ[] = "The meshes have different connectivity: ";
constexpr char Remedy[] = ". Compare meshes that differ in their coordinates only.";
constexpr char NoIds[] =
  "The pieces of the two meshes are not the same, and their points have no global ids to match "
  "them "
  "by where they have moved: run Generate Global Ids on the mesh before its points are moved and "
  "before it is divided anew.";

using Names = std::vector<std::vector<Index>>; ///< one per point of each piece

/// A point of a piece.
struct PiecePoint
{
  PointKey key;
  Vec3 place;
};

bool hasLess(const PiecePoint& a, const PiecePoint& b)
{
  return a.key < b.key;
}

/// One point per key, in the order of these. Throws Error if one is at two places.
std::vector<PiecePoint> distinctPoints(const std::vector<std::vector<PiecePoint>>& lists)
{
  std::vector<PiecePoint> points;
  for (const std::vector<PiecePoint>& list : lists)
  {
    points.insert(points.end(), list.begin(), list.end());
  }
  std::stable_sort(points.begin(), points.end(), hasLess);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (kept == 0 || points[kept - 1].key != points[i].key)
    {
      points[kept++] = points[i];
    }
    else if (points[kept - 1].place != points[i].place &&
      std::isfinite(dot(points[i].place, points[i].place)))
    {
      throw Error("Points at different places have the global id " +
        std::to_string(points[i].key[0]) + ": run Generate Global Ids again.");
    }
  }
  points.resize(kept);
  return points;
}

/// The answer on a point.
struct NamedPoint
{
  Index number; ///< -1: the other mesh has no such point
  Vec3 place;
};

/**
 * @class PieceMatch
 * @brief Matches the pieces of a mesh to those of another one.
 */
class PieceMatch
{
public:
  PieceMatch(
    RankGroup& group, const std::vector<RankPiece>& mesh, const std::vector<RankPiece>& other)
    : Group(group)
    , Mesh(mesh)
    , Other(other)
    , Ranks(static_cast<std::size_t>(group.size()))
  {
  }

  std::vector<std::vector<double>> run();

private:
  std::vector<std::vector<PiecePoint>> listPoints(const std::vector<RankPiece>& pieces) const;
  Names namesOf(const std::vector<RankPiece>& pieces,
    const std::vector<std::vector<NamedPoint>>& answers,
    std::vector<std::vector<double>>* places) const;
  void matchPoints();
  void countCells();
  void requireAsManyCells() const;
  int homeOfCell(const MeshView& view, const std::vector<Index>& names, Index cell,
    std::vector<Index>& points) const;
  std::vector<std::vector<Index>> listCells(
    const std::vector<RankPiece>& pieces, const Names& names, bool copies) const;
  void matchCells();
  std::string pointText(const RankPiece& piece, Index point) const;
  std::string cellText(std::size_t piece, Index cell) const;

  RankGroup& Group;
  std::vector<RankPiece> Mesh, Other;
  std::size_t Ranks;
  bool ById = false;
  Index Cells = 0, OtherCells = 0;
  Names OfMesh, OfOther;
  std::vector<std::vector<double>> Places;
};

//------------------------------------------------------------------------------
std::string PieceMatch::pointText(const RankPiece& piece, Index point) const
{
  if (piece.globalIds)
  {
    return std::to_string(piece.globalIds[point]);
  }
  const Vec3 p = pointOf(piece.mesh->view(), point);
  std::ostringstream text;
  text << "(" << p[0] << ", " << p[1] << ", " << p[2] << ")";
  return text.str();
}

//------------------------------------------------------------------------------
std::string PieceMatch::cellText(std::size_t piece, Index cell) const
{
  const MeshView& view = this->Mesh[piece].mesh->view();
  std::string text = this->ById ? "with the global point ids" : "with the points";
  for (Index n = view.offsets[cell]; n < view.offsets[cell + 1]; ++n)
  {
    text += " " + this->pointText(this->Mesh[piece], view.connectivity[n]);
  }
  return text;
}

//------------------------------------------------------------------------------
/// The points of pieces, for the rank that each belongs to, in their order.
std::vector<std::vector<PiecePoint>> PieceMatch::listPoints(
  const std::vector<RankPiece>& pieces) const
{
  std::vector<std::vector<PiecePoint>> sent(this->Ranks);
  for (const RankPiece& piece : pieces)
  {
    for (Index p = 0; p < piece.mesh->view().numberOfPoints; ++p)
    {
      const PointKey key = keyOfPoint(piece, p);
      sent[homeOf(hashOf(key), this->Group)].push_back({ key, pointOf(piece.mesh->view(), p) });
    }
  }
  return sent;
}

//------------------------------------------------------------------------------
/// Takes the answers, which are in the order of listPoints().
/// @param places gets the places of the points of each piece; may be null
Names PieceMatch::namesOf(const std::vector<RankPiece>& pieces,
  const std::vector<std::vector<NamedPoint>>& answers,
  std::vector<std::vector<double>>* places) const
{
  Names names;
  std::vector<std::size_t> next(this->Ranks, 0);
  for (const RankPiece& piece : pieces)
  {
    names.emplace_back();
    std::vector<double> coordinates;
    for (Index p = 0; p < piece.mesh->view().numberOfPoints; ++p)
    {
      const int home = homeOf(hashOf(keyOfPoint(piece, p)), this->Group);
      const NamedPoint& answer = answers[home][next[home]++];
      names.back().push_back(answer.number);
      if (places)
      {
        coordinates.insert(coordinates.end(), answer.place.begin(), answer.place.end());
      }
      if (answer.number < 0 && !this->ById)
      {
        throw Error(NoIds);
      }
      if (answer.number < 0)
      {
        throw Error(Differ +
          ("the second mesh has a point of the global id " + this->pointText(piece, p) +
            ", the first has not") +
          Remedy);
      }
    }
    if (places)
    {
      places->push_back(std::move(coordinates));
    }
  }
  return names;
}

//------------------------------------------------------------------------------
/// Gives the points of both meshes numbers, and those of `Mesh` the places that they have in
/// `Other`.
void PieceMatch::matchPoints()
{
  std::vector<std::vector<PiecePoint>> known, asked;
  this->Group.together(
    [&]
    {
      known = this->listPoints(this->Other);
      asked = this->listPoints(this->Mesh);
    });
  known = this->Group.exchangeItems(known);
  asked = this->Group.exchangeItems(asked);
  std::vector<std::vector<NamedPoint>> ofKnown(this->Ranks), ofAsked(this->Ranks);
  Index distinct = 0, distinctAsked = 0;
  this->Group.together(
    [&]
    {
      const std::vector<PiecePoint> points = distinctPoints(known);
      distinct = static_cast<Index>(points.size());
      distinctAsked = static_cast<Index>(distinctPoints(asked).size());
      const auto answer = [&](const std::vector<std::vector<PiecePoint>>& questions,
                            std::vector<std::vector<NamedPoint>>& answers)
      {
        for (std::size_t rank = 0; rank < this->Ranks; ++rank)
        {
          for (const PiecePoint& question : questions[rank])
          {
            const auto at = std::lower_bound(points.begin(), points.end(), question, hasLess);
            const bool found = at != points.end() && at->key == question.key;
            const auto row = static_cast<std::size_t>(at - points.begin());
            const auto number = static_cast<Index>(row * this->Ranks) + this->Group.rank();
            answers[rank].push_back(
              { found ? number : Index(-1), found ? at->place : question.place });
          }
        }
      };
      answer(known, ofKnown);
      answer(asked, ofAsked);
    });
  known = {};
  asked = {};
  distinct = this->Group.sum(distinct);
  distinctAsked = this->Group.sum(distinctAsked);
  ofKnown = this->Group.exchangeItems(ofKnown);
  ofAsked = this->Group.exchangeItems(ofAsked);
  this->Group.together(
    [&]
    {
      if (!this->ById)
      {
        this->requireAsManyCells(); // rather than that points have moved
      }
      const bool differ = distinctAsked != distinct;
      if (!differ || !this->ById)
      {
        this->OfOther = this->namesOf(this->Other, ofKnown, nullptr);
        this->OfMesh = this->namesOf(this->Mesh, ofAsked, &this->Places);
      }
      if (differ)
      {
        throw Error(Differ +
          ("the first mesh has " + std::to_string(distinct) + " points, the second " +
            std::to_string(distinctAsked)) +
          Remedy);
      }
    });
}

//------------------------------------------------------------------------------
/// The rank that a cell belongs to, whatever the order of its points.
/// @param points gets their numbers
int PieceMatch::homeOfCell(const MeshView& view, const std::vector<Index>& names, Index cell,
  std::vector<Index>& points) const
{
  points.clear();
  std::uint64_t sum = 0;
  for (Index n = view.offsets[cell]; n < view.offsets[cell + 1]; ++n)
  {
    points.push_back(names[view.connectivity[n]]);
    sum += addToHash(0, static_cast<std::uint64_t>(points.back()));
  }
  return homeOf(addToHash(0, sum), this->Group);
}

//------------------------------------------------------------------------------
/// The cells of pieces, for the rank that each belongs to: type, number of points, points.
/// @param copies whether ghost cells count
std::vector<std::vector<Index>> PieceMatch::listCells(
  const std::vector<RankPiece>& pieces, const Names& names, bool copies) const
{
  std::vector<std::vector<Index>> sent(this->Ranks);
  std::vector<Index> points;
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    const MeshView& view = pieces[i].mesh->view();
    for (Index cell = 0; cell < view.numberOfCells; ++cell)
    {
      if (!copies && pieces[i].ghosts && pieces[i].ghosts[cell])
      {
        continue;
      }
      std::vector<Index>& list = sent[this->homeOfCell(view, names[i], cell, points)];
      list.push_back(static_cast<Index>(view.cellTypes[cell]));
      list.push_back(static_cast<Index>(points.size()));
      list.insert(list.end(), points.begin(), points.end());
    }
  }
  return sent;
}

/// A cell in a list: type, number of points, points.
struct ListedCell
{
  const Index* begin;
  std::size_t rank; ///< that has it
  const Index* end() const { return this->begin + 2 + this->begin[1]; }
  bool operator<(const ListedCell& other) const
  {
    return std::lexicographical_compare(this->begin, this->end(), other.begin, other.end());
  }
};

template <class Visit>
void forEachListed(const std::vector<Index>& list, std::size_t rank, const Visit& visit)
{
  for (const Index* at = list.data(); at < list.data() + list.size();)
  {
    const ListedCell cell = { at, rank };
    visit(cell);
    at = cell.end();
  }
}

//------------------------------------------------------------------------------
/// Counts the cells of the meshes; copies do not count.
void PieceMatch::countCells()
{
  const auto count = [this](const std::vector<RankPiece>& pieces)
  {
    Index number = 0;
    for (const RankPiece& piece : pieces)
    {
      for (Index cell = 0; cell < piece.mesh->view().numberOfCells; ++cell)
      {
        number += !(piece.ghosts && piece.ghosts[cell]);
      }
    }
    return this->Group.sum(number);
  };
  this->Cells = count(this->Mesh);
  this->OtherCells = count(this->Other);
}

void PieceMatch::requireAsManyCells() const
{
  if (this->Cells != this->OtherCells)
  {
    throw Error(Differ +
      ("the first mesh has " + std::to_string(this->OtherCells) + " cells, the second " +
        std::to_string(this->Cells)) +
      Remedy);
  }
}

//------------------------------------------------------------------------------
/// Throws Error unless the meshes have the same cells with the same points in the same order.
void PieceMatch::matchCells()
{
  std::vector<std::vector<Index>> known, asked;
  this->Group.together(
    [&]
    {
      known = this->listCells(this->Other, this->OfOther, false);
      asked = this->listCells(this->Mesh, this->OfMesh, true);
    });
  known = this->Group.exchangeItems(known);
  asked = this->Group.exchangeItems(asked);
  std::vector<std::vector<char>> answers(this->Ranks);
  this->Group.together(
    [&]
    {
      this->requireAsManyCells();
      std::vector<ListedCell> list;
      for (std::size_t rank = 0; rank < this->Ranks; ++rank)
      {
        forEachListed(known[rank], rank, [&](const ListedCell& cell) { list.push_back(cell); });
      }
      std::sort(list.begin(), list.end());
      const auto copy = std::adjacent_find(list.begin(), list.end(),
        [](const ListedCell& a, const ListedCell& b) { return a.rank != b.rank && !(a < b); });
      if (copy != list.end())
      {
        throw Error("Cells of the first mesh on processes " + std::to_string(copy->rank) + " and " +
          std::to_string(copy[1].rank) +
          " have the same points and are not marked as ghost cells: keep the array vtkGhostType, "
          "or take pieces without copies of cells.");
      }
      for (std::size_t rank = 0; rank < this->Ranks; ++rank)
      {
        forEachListed(asked[rank], rank,
          [&](const ListedCell& cell)
          {
            answers[rank].push_back(
              static_cast<char>(std::binary_search(list.begin(), list.end(), cell)));
          });
      }
    });
  answers = this->Group.exchangeItems(answers);
  this->Group.together(
    [&]
    {
      // The answers are in the order of the questions.
      std::vector<std::size_t> next(this->Ranks, 0);
      std::vector<Index> points;
      for (std::size_t i = 0; i < this->Mesh.size(); ++i)
      {
        const MeshView& view = this->Mesh[i].mesh->view();
        for (Index cell = 0; cell < view.numberOfCells; ++cell)
        {
          const int home = this->homeOfCell(view, this->OfMesh[i], cell, points);
          if (!answers[home][next[home]++])
          {
            throw Error(Differ +
              ("the second mesh has a cell " + this->cellText(i, cell) +
                ", the first has none with these points in this order") +
              Remedy);
          }
        }
      }
    });
}

//------------------------------------------------------------------------------
std::vector<std::vector<double>> PieceMatch::run()
{
  const auto lacksIds = [](const std::vector<RankPiece>& pieces)
  {
    return std::any_of(pieces.begin(), pieces.end(),
      [](const RankPiece& piece)
      { return piece.mesh->view().numberOfPoints > 0 && !piece.globalIds; });
  };
  this->ById = !this->Group.any(lacksIds(this->Mesh) || lacksIds(this->Other));
  for (std::vector<RankPiece>* pieces : { &this->Mesh, &this->Other })
  {
    for (RankPiece& piece : *pieces)
    {
      piece.globalIds = this->ById ? piece.globalIds : nullptr;
    }
  }
  this->countCells();
  this->matchPoints();
  this->matchCells();
  return std::move(this->Places);
}
}

//------------------------------------------------------------------------------
std::vector<std::vector<double>> pointsInOther(
  RankGroup& group, const std::vector<RankPiece>& mesh, const std::vector<RankPiece>& other)
{
  return PieceMatch(group, mesh, other).run();
}
}
