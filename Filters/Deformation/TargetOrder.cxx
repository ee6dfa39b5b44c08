// SPDX-License-Identifier: BSD-3-Clause
#include "TargetOrder.h"

#include "PieceMotion.h"
#include "RankMesh.h"
#include "tautline/Optimization/OptimizeOnRanks.h"

#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <memory>

namespace tautline
{
namespace
{
/**
 * @class OrderMatcher
 * @brief The counterpart on processes of the matcher of TargetMatch.cxx.
 */
class OrderMatcher
{
public:
  OrderMatcher(const WarpSettings& settings, RankGroup& group, RankMesh& mesh,
    const WarpPiece& piece, const PointFlags& moved, const PieceIds& ofMesh,
    const PieceIds& ofTarget);
  OrderMatch match();

private:
  PointFlags every(Index points);
  void requireOrder();
  bool fits(const PointFlags& chosen, const char* how);
  void findBoundary();
  PointFlags surface();
  PointFlags rim();
  PointFlags moving();
  Index countCells(vtkDataSet* piece);

  const WarpSettings& Settings;
  RankGroup& Group;
  RankMesh& Whole;
  const WarpPiece& Piece;
  const PointFlags& Moved;
  Index TargetPoints = 0; ///< of the piece
  bool Ordered = false, ById = false;
  std::vector<Index> Own, Other; ///< ids per point of the pieces of mesh and target
  Index Points = 0;              ///< of the whole target
  PointFlags Boundary;           ///< per point of the piece; found on first use
  bool BoundaryFound = false;
  OrderMatch Found;
};

//------------------------------------------------------------------------------
OrderMatcher::OrderMatcher(const WarpSettings& settings, RankGroup& group, RankMesh& mesh,
  const WarpPiece& piece, const PointFlags& moved, const PieceIds& ofMesh, const PieceIds& ofTarget)
  : Settings(settings)
  , Group(group)
  , Whole(mesh)
  , Piece(piece)
  , Moved(moved)
  , TargetPoints(piece.target ? piece.target->GetNumberOfPoints() : 0)
{
  const auto inOrder = [](const PieceIds& ids)
  { return ids.order == PointOrder::ById || (ids.order == PointOrder::Given && ids.increase); };
  const Index cells = piece.target ? piece.target->GetNumberOfCells() : 0;
  const bool alike = !group.any(this->TargetPoints != piece.rest->GetNumberOfPoints() ||
    cells != piece.rest->GetNumberOfCells());
  this->ById = inOrder(ofMesh) && inOrder(ofTarget);
  this->Ordered = this->ById || (alike && ofTarget.order != PointOrder::Given);
  if (this->Ordered && !this->ById)
  {
    this->Own = mesh.idsOfPiece(mesh.pointIds());
  }
  group.together(
    [&]
    {
      if (this->ById)
      {
        this->Own = ofMesh.ids;
      }
      this->Other = this->ById ? ofTarget.ids : this->Own;
    });
}

//------------------------------------------------------------------------------
/// One flag for each of so many points.
PointFlags OrderMatcher::every(Index points)
{
  PointFlags flags;
  this->Group.together([&] { flags.assign(points, 1); });
  return flags;
}

//------------------------------------------------------------------------------
/// Points on the boundary, per point of the piece. Coincident points with ids of their own are not
/// one here, as they are not in a surface that is extracted from the mesh.
void OrderMatcher::findBoundary()
{
  if (this->BoundaryFound)
  {
    return;
  }
  this->BoundaryFound = true;
  std::unique_ptr<RankMesh> apart;
  if (this->ById && this->Settings.mergePoints)
  {
    PointFlags used = this->every(static_cast<Index>(this->Own.size()));
    for (std::size_t p = 0; p < used.size(); ++p)
    {
      used[p] = this->Whole.mesh().localOfPiece()[p] >= 0;
    }
    Index count = 0;
    positionsOf(this->Group, this->Own, used, count);
    if (count != this->Whole.mesh().globalPoints())
    {
      apart = std::make_unique<RankMesh>(
        this->Group, this->Piece.rest, this->Settings.options.threads, false);
    }
  }
  const DistributedMesh& mesh = apart ? apart->mesh() : this->Whole.mesh();
  const std::vector<unsigned char> boundary = rankBoundary(mesh);
  this->Group.together([&] { this->Boundary.assign(mesh.localOfPiece().size(), 0); });
  for (std::size_t p = 0; p < this->Boundary.size(); ++p)
  {
    const Index at = mesh.localOfPiece()[p];
    this->Boundary[p] = at >= 0 && boundary[at];
  }
}

//------------------------------------------------------------------------------
/// The points that Extract Surface leaves: of a plane all that cells have; of a volume those of the
/// boundary, and of cells of lower dimension.
PointFlags OrderMatcher::surface()
{
  this->findBoundary();
  const MeshView& view = this->Whole.piece();
  PointFlags flags;
  this->Group.together(
    [&]
    {
      flags = this->Boundary;
      for (Index cell = 0; cell < view.numberOfCells; ++cell)
      {
        const CellType type = cornerType(view.cellTypes[cell]);
        const bool volume = type != CellType::Unsupported && topology(type).dimension == 3;
        for (Index n = view.offsets[cell]; !volume && n < view.offsets[cell + 1]; ++n)
        {
          flags[view.connectivity[n]] = 1;
        }
      }
    });
  return flags;
}

//------------------------------------------------------------------------------
/// The points that Feature Edges leaves of that; none of a closed surface.
PointFlags OrderMatcher::rim()
{
  this->findBoundary();
  PointFlags flags;
  this->Group.together(
    [&]
    {
      flags = this->Boundary;
      if (this->Whole.volume())
      {
        std::fill(flags.begin(), flags.end(), 0);
      }
    });
  return flags;
}

//------------------------------------------------------------------------------
/// The points that move; of those that are one that with the least id.
PointFlags OrderMatcher::moving()
{
  const std::vector<Index>& localOf = this->Whole.mesh().localOfPiece();
  const std::vector<Index> least = this->Ordered ? this->Whole.pointIds() : std::vector<Index>();
  PointFlags flags;
  this->Group.together(
    [&]
    {
      flags.assign(localOf.size(), 0);
      for (std::size_t p = 0; p < flags.size(); ++p)
      {
        const Index at = localOf[p];
        flags[p] = at >= 0 && this->Moved[at] && (!this->Ordered || this->Own[p] == least[at]);
      }
    });
  return flags;
}

//------------------------------------------------------------------------------
/// Throws Error if points would correspond by an order that is not known.
void OrderMatcher::requireOrder()
{
  const Correspondence requested = this->Settings.correspondence;
  const auto count = [this](vtkDataSet* piece, const PointFlags& flags)
  { return countByPlace(this->Group, piece, flags); };
  vtkDataSet* mesh = this->Piece.rest;
  this->Points = count(this->Piece.target, this->every(this->TargetPoints));
  const Index all = count(mesh, this->every(mesh->GetNumberOfPoints()));
  if (requested == Correspondence::SameMesh && this->Points != all)
  {
    throw otherMesh(this->Points, all);
  }
  const bool ordered = requested != Correspondence::Automatic || this->Points == all ||
    this->Points == countOwned(this->Group, this->Whole.mesh(), this->Moved) ||
    this->Points == count(mesh, this->surface()) || this->Points == count(mesh, this->rim());
  if (ordered)
  {
    throw noOrder(this->Points);
  }
}

//------------------------------------------------------------------------------
/// Whether the target has as many points as are chosen and no edge that the mesh has not.
bool OrderMatcher::fits(const PointFlags& chosen, const char* how)
{
  Index count = 0;
  std::vector<Index> positions = positionsOf(this->Group, this->Own, chosen, count);
  if (count != this->Points)
  {
    return false;
  }
  std::unique_ptr<MeshAdapter> target;
  this->Group.together(
    [&]
    {
      if (this->Piece.target)
      {
        target = std::make_unique<MeshAdapter>(this->Piece.target, this->Settings.options.threads);
      }
    });
  const MeshView cells = target ? target->inputView() : MeshView();
  if (!edgesFit(this->Group, this->Whole.piece(), positions, cells, this->Found.ofTarget))
  {
    return false;
  }
  this->Found.ofMesh = std::move(positions);
  this->Found.how = how;
  return true;
}

//------------------------------------------------------------------------------
/// Without ghost cells.
Index OrderMatcher::countCells(vtkDataSet* piece)
{
  Index count = 0;
  vtkUnsignedCharArray* ghosts = piece ? piece->GetCellGhostArray() : nullptr;
  for (vtkIdType cell = 0; piece && cell < piece->GetNumberOfCells(); ++cell)
  {
    count += !ghosts || (ghosts->GetValue(cell) & vtkDataSetAttributes::DUPLICATECELL) == 0;
  }
  return this->Group.sum(count);
}

//------------------------------------------------------------------------------
OrderMatch OrderMatcher::match()
{
  const Correspondence requested = this->Settings.correspondence;
  if (!this->Ordered)
  {
    this->requireOrder();
    return {};
  }
  this->Found.ofTarget = positionsOf(
    this->Group, this->Other, this->every(static_cast<Index>(this->Other.size())), this->Points);
  const PointFlags all = this->every(static_cast<Index>(this->Own.size()));
  Index points = 0;
  positionsOf(this->Group, this->Own, all, points);
  if (requested == Correspondence::SameMesh && this->Points != points)
  {
    throw otherMesh(this->Points, points);
  }
  if (requested != Correspondence::SameBoundary && this->Points == points)
  {
    if (this->fits(all, "as the same mesh, point by point"))
    {
      return std::move(this->Found);
    }
    if (requested == Correspondence::SameMesh ||
      this->countCells(this->Piece.target) == this->countCells(this->Piece.rest))
    {
      throw otherCells();
    }
  }
  constexpr char extracted[] = "as the boundary extracted from the mesh";
  if (this->fits(this->surface(), extracted) || this->fits(this->rim(), extracted) ||
    this->fits(this->moving(), "by the order of the points that move"))
  {
    return std::move(this->Found);
  }
  if (requested == Correspondence::SameBoundary)
  {
    throw otherBoundary(this->Points, countOwned(this->Group, this->Whole.mesh(), this->Moved));
  }
  return {};
}
}

//------------------------------------------------------------------------------
OrderMatch matchByOrder(const WarpSettings& settings, RankGroup& group, RankMesh& mesh,
  const WarpPiece& piece, const PointFlags& moved, const PieceIds& ofMesh, const PieceIds& ofTarget)
{
  return OrderMatcher(settings, group, mesh, piece, moved, ofMesh, ofTarget).match();
}
}
