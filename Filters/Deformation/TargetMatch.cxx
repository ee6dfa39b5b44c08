// SPDX-License-Identifier: BSD-3-Clause
#include "TargetMatch.h"

#include "CellEdges.h"
#include "MeshAdapter.h"
#include "PointOrder.h"
#include "tautline/Mesh/BoundaryParts.h"

#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkDataSetSurfaceFilter.h"
#include "vtkFeatureEdges.h"
#include "vtkGenericCell.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStaticCellLocator.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <unordered_map>
#include <unordered_set>

namespace tautline
{
namespace
{
using Flags = std::vector<unsigned char>;
constexpr const char* OriginalIds = "vtkOriginalPointIds"; // as in vtkDataSetSurfaceFilter
constexpr Index None = -1;

constexpr const char* EmptyTarget = "The target is empty: choose another one.";
constexpr const char* NoIdsChosen =
  "No array of point ids is chosen: choose one of the target's point arrays.";
/// The remedy if the order of the target's points differs from the mesh's.
constexpr const char* OrderRemedy =
  "Choose Point Ids, an array that both have; or run Generate Global Ids on the mesh in one piece, "
  "before it is divided and the target is made from it; or give each process the same pieces of "
  "both; or choose Closest Point.";

/// Throws if the target is not the mesh in another position: the numbers of points differ.
Error otherMesh(Index points, Index ofMesh)
{
  return Error("The target has " + std::to_string(points) + " points and the mesh has " +
    std::to_string(ofMesh) + ": it is not the same mesh. Choose another Correspondence.");
}

/// The same if the cells differ.
Error otherCells()
{
  return Error("The target has as many points as the mesh, but, in the order of the global ids or "
               "of the pieces, other cells. " +
    std::string(OrderRemedy));
}

/// Throws if the target is neither the boundary nor the moving points.
Error otherBoundary(Index points, Index moving)
{
  return Error("The target has " + std::to_string(points) + " points, of the mesh " +
    std::to_string(moving) +
    " points move, and its cells are not the boundary's cells in the same order: choose another "
    "Correspondence, or another Moved Part.");
}

/// Throws if the target has an array of point ids that the mesh lacks, and the mesh has no point
/// order.
Error noNumbers(const std::string& array)
{
  return Error("The mesh has no array '" + array +
    "' of its own, and its points are on several processes, so that they have no numbers that the "
    "target could refer to: add the array to the mesh, or run Generate Global Ids before the mesh "
    "is divided.");
}

/// Throws if points of several processes would correspond by an order that they do not have.
Error noOrder(Index points)
{
  return Error("The target's " + std::to_string(points) +
    " points would correspond to the points of the mesh by their order, which is not known: mesh "
    "and target are on several processes in different pieces, without a common order of global "
    "ids. " +
    OrderRemedy);
}

/// "by projection: N points to the closest point of the target, ..."
std::string describeProjection(Index points, double farthest)
{
  return "by projection: " + std::to_string(points) +
    " points to the closest point of the target, the farthest of them " + std::to_string(farthest) +
    " away";
}

/// ": N of M points of the boundary", after the type of correspondence.
std::string describeMatched(Index given, Index matched)
{
  return ": " + std::to_string(given) + " of " + std::to_string(matched) +
    " points of the boundary";
}

/// Throws Error if used target points have coordinates that are not finite.
void requireFiniteTarget(Index wrong)
{
  if (wrong > 0)
  {
    throw Error("The target has " + std::to_string(wrong) +
      " points of the boundary with coordinates that are NaN or infinite: repair them, or leave "
      "them out "
      "(Correspondence: Point ids).");
  }
}

/// Throws Error if values of an array of the target do not occur in the mesh.
void requireKnownIds(Index unknown, const std::string& array, bool ofMesh)
{
  if (unknown > 0)
  {
    throw Error("The target's array '" + array + "' has " + std::to_string(unknown) +
      " values that do not occur " +
      (ofMesh ? "in the mesh's array of that name" : "as point numbers of the mesh") +
      ": choose another array, or None.");
  }
}

Index countMarked(const Flags& flags)
{
  return static_cast<Index>(flags.size()) - std::count(flags.begin(), flags.end(), 0);
}

/// "(0.5, 0, 1)"
std::string place(const double* p)
{
  std::ostringstream stream;
  stream << '(' << p[0] << ", " << p[1] << ", " << p[2] << ')';
  return stream.str();
}

struct EdgeHash
{
  std::size_t operator()(const std::pair<Index, Index>& e) const
  {
    return static_cast<std::size_t>(e.first) * 0x9E3779B97F4A7C15ULL ^
      static_cast<std::size_t>(e.second);
  }
};

/// The boundary of a mesh, as made by ParaView's Extract Surface, with vtkOriginalPointIds.
vtkSmartPointer<vtkPolyData> skinOf(vtkDataSet* mesh)
{
  vtkNew<vtkDataSetSurfaceFilter> surface;
  surface->SetInputData(mesh);
  surface->PassThroughPointIdsOn();
  surface->Update();
  return surface->GetOutput();
}

/// The boundary edges of a surface, as made by ParaView's Feature Edges.
vtkSmartPointer<vtkPolyData> rimOf(vtkPolyData* surface)
{
  vtkNew<vtkFeatureEdges> edges;
  edges->SetInputData(surface);
  edges->FeatureEdgesOff();
  edges->NonManifoldEdgesOff();
  edges->ColoringOff();
  edges->Update();
  return edges->GetOutput();
}

/// Throws Error if the cells of a target have too few dimensions for a boundary to lie on.
void requireSurface(int dimension, bool ofVolume)
{
  if (dimension < (ofVolume ? 2 : 1))
  {
    throw Error(std::string("The target has no ") + (ofVolume ? "surface" : "curve") +
      " that the boundary could be moved to, and its points do not correspond to the points of the "
      "mesh: give a " +
      (ofVolume ? "surface" : "curve") + ", or point ids.");
  }
}

/// Points that were projected.
struct Projection
{
  std::vector<double> displacement; ///< 3 per point, 0 where the flag is
  double farthest = 0;
};

/**
 * @brief The closest points on a surface, or on a curve for a planar mesh. Throws Error if it has
 * no cells or if a point has no closest point, with its position.
 * @param points 3 per point @param flags one per point, set for points that move
 */
Projection projected(
  vtkDataSet* surface, const double* points, const std::vector<unsigned char>& flags)
{
  if (surface->GetNumberOfCells() == 0)
  {
    throw Error("The target has no boundary that points could be moved to: it is closed. Give a "
                "curve, or a surface with a boundary.");
  }
  vtkNew<vtkStaticCellLocator> locator;
  locator->SetDataSet(surface);
  locator->BuildLocator();
  vtkNew<vtkGenericCell> cell;
  Projection result;
  result.displacement.assign(3 * flags.size(), 0.0);
  for (std::size_t i = 0; i < flags.size(); ++i)
  {
    if (!flags[i])
    {
      continue;
    }
    double closest[3], squared = -1;
    vtkIdType id = None;
    int part = 0;
    locator->FindClosestPoint(points + 3 * i, closest, cell, id, part, squared);
    if (id < 0)
    {
      throw Error("No point of the target is closest to the point at " + place(points + 3 * i) +
        " of the mesh: repair the target, which has coordinates that are NaN or infinite, or "
        "choose another one.");
    }
    for (std::size_t k = 0; k < 3; ++k)
    {
      result.displacement[3 * i + k] = closest[k] - points[3 * i + k];
    }
    result.farthest = std::max(result.farthest, std::sqrt(squared));
  }
  return result;
}

bool sameCells(const MeshView& a, const MeshView& b)
{
  return a.numberOfCells == b.numberOfCells &&
    std::equal(a.offsets, a.offsets + a.numberOfCells + 1, b.offsets) &&
    std::equal(a.connectivity, a.connectivity + a.offsets[a.numberOfCells], b.connectivity);
}

/// Finds the point of the mesh that each point of the target corresponds to.
class Matcher
{
public:
  explicit Matcher(const TargetRequest& request)
    : Request(request)
    , View(request.view->view())
    , Adapter(request.target, request.threads)
    , Order(commonOrder(request.mesh, request.target))
  {
  }

  /// For each point of the target, a point of the mesh or None; empty if there is no
  /// correspondence.
  std::vector<Index> match(std::string& how)
  {
    const Correspondence requested = this->Request.correspondence;
    if (requested == Correspondence::PointIds ||
      (requested == Correspondence::Automatic && this->Request.ids))
    {
      how = "by point ids";
      return this->byIds();
    }
    const Index points = this->Request.target->GetNumberOfPoints();
    if (requested == Correspondence::SameMesh && points != this->View.numberOfPoints)
    {
      throw otherMesh(points, this->View.numberOfPoints);
    }
    this->requireOrder(points);
    if (requested != Correspondence::SameBoundary && points == this->View.numberOfPoints)
    {
      std::vector<Index> ids(points);
      for (Index i = 0; i < points; ++i)
      {
        ids[i] = i;
      }
      const bool given = requested == Correspondence::SameMesh && this->Order == PointOrder::Given;
      if (given || this->fits(ids))
      {
        how = "as the same mesh, point by point";
        return ids;
      }
      // With ids of its own, the target appears to be another mesh.
      if (requested == Correspondence::SameMesh ||
        (this->Order != PointOrder::Given &&
          this->target().numberOfCells == this->View.numberOfCells))
      {
        throw otherCells();
      }
    }
    if (requested == Correspondence::SameBoundary || requested == Correspondence::Automatic)
    {
      std::vector<Index> ids =
        this->Order == PointOrder::Given ? this->bySurface() : this->bySurfaceIds();
      how = "as the boundary extracted from the mesh";
      if (ids.empty())
      {
        ids = this->byOrder();
        how = "by the order of the points that move";
      }
      if (requested == Correspondence::SameBoundary && ids.empty())
      {
        throw otherBoundary(points, countMarked(*this->Request.projected));
      }
      return ids;
    }
    return {};
  }

private:
  const MeshView& target() const { return this->Adapter.mesh().view(); }

  std::vector<Index> byIds() const
  {
    vtkDataArray* ids = this->Request.ids;
    if (!ids)
    {
      throw Error(NoIdsChosen);
    }
    std::unordered_map<double, Index> numbers;
    vtkDataArray* own = this->Request.mesh->GetPointData()->GetArray(ids->GetName());
    if (!own && pointOrder(this->Request.mesh) == PointOrder::Coordinates)
    {
      throw noNumbers(ids->GetName());
    }
    for (Index i = 0; own && i < this->View.numberOfPoints; ++i)
    {
      numbers[own->GetComponent(i, 0)] = i;
    }
    std::vector<Index> result(ids->GetNumberOfTuples(), None);
    Index unknown = 0;
    for (Index i = 0; i < static_cast<Index>(result.size()); ++i)
    {
      const double id = ids->GetComponent(i, 0);
      const auto found = numbers.find(id);
      if (own ? found != numbers.end() : id >= 0 && id < double(this->View.numberOfPoints))
      {
        result[i] = own ? found->second : static_cast<Index>(id);
      }
      unknown += result[i] == None;
    }
    requireKnownIds(unknown, ids->GetName(), own != nullptr);
    return result;
  }

  /// Whether each edge of the target is an edge of the mesh under this numbering of its points.
  bool fits(const std::vector<Index>& ids)
  {
    if (this->target().numberOfPoints == this->View.numberOfPoints &&
      sameCells(this->target(), this->View))
    {
      return true;
    }
    if (this->Edges.empty())
    {
      forEachEdge(this->View,
        [this](Index a, Index b) {
          this->Edges.insert({ std::min(a, b), std::max(a, b) });
        });
    }
    bool all = true;
    forEachEdge(this->target(),
      [&](Index a, Index b)
      {
        const auto edge = std::minmax(ids[a], ids[b]);
        all = all && this->Edges.count({ edge.first, edge.second }) > 0;
      });
    return all;
  }

  /// The points that move, in increasing order.
  std::vector<Index> byOrder()
  {
    const Flags& moved = *this->Request.projected;
    if (countMarked(moved) != this->target().numberOfPoints)
    {
      return {};
    }
    std::vector<Index> ids;
    for (Index i = 0; i < this->View.numberOfPoints; ++i)
    {
      if (moved[i])
      {
        ids.push_back(i);
      }
    }
    return this->fits(ids) ? ids : std::vector<Index>();
  }

  /// The mesh points of the points of a skin; may be empty.
  static std::vector<Index> pointsOf(vtkPolyData* skin)
  {
    std::vector<Index> ids;
    vtkDataArray* original = skin->GetPointData()->GetArray(OriginalIds);
    for (vtkIdType i = 0; original && i < skin->GetNumberOfPoints(); ++i)
    {
      ids.push_back(static_cast<Index>(original->GetComponent(i, 0)));
    }
    return ids;
  }

  /// In the numbering by ParaView's Extract Surface and Feature Edges for the mesh at rest.
  std::vector<Index> bySurface() const
  {
    const auto surface = skinOf(this->Request.mesh);
    const std::vector<Index> ids =
      this->isTarget(surface) ? pointsOf(surface) : std::vector<Index>();
    if (!ids.empty())
    {
      return ids;
    }
    const auto edges = rimOf(surface);
    return this->isTarget(edges) ? this->byPlace(edges) : std::vector<Index>();
  }

  /// The same boundaries with their points in the order of the mesh, as after assemble().
  std::vector<Index> bySurfaceIds()
  {
    const auto surface = skinOf(this->Request.mesh);
    for (const bool whole : { true, false })
    {
      std::vector<Index> ids = whole ? pointsOf(surface) : this->byPlace(rimOf(surface));
      std::sort(ids.begin(), ids.end());
      if (static_cast<Index>(ids.size()) == this->target().numberOfPoints && this->fits(ids))
      {
        return ids;
      }
    }
    return {};
  }

  /// Throws Error if points would correspond by an order that several processes do not have.
  void requireOrder(Index points) const
  {
    const Correspondence requested = this->Request.correspondence;
    if (this->Order != PointOrder::Coordinates || requested == Correspondence::ClosestPoint)
    {
      return;
    }
    bool ordered =
      requested == Correspondence::SameMesh || requested == Correspondence::SameBoundary;
    ordered = ordered || points == this->View.numberOfPoints ||
      points == countMarked(*this->Request.projected);
    if (!ordered) // a skin only if it is needed
    {
      const auto surface = skinOf(this->Request.mesh);
      ordered =
        points == surface->GetNumberOfPoints() || points == rimOf(surface)->GetNumberOfPoints();
    }
    if (ordered)
    {
      throw noOrder(points);
    }
  }

  bool isTarget(vtkPolyData* made) const
  {
    return made->GetNumberOfPoints() == this->target().numberOfPoints &&
      made->GetNumberOfCells() > 0 &&
      sameCells(MeshAdapter(made, this->Request.threads).mesh().view(), this->target());
  }

  /// The mesh points at the positions of the points of a part of it.
  std::vector<Index> byPlace(vtkPolyData* made) const
  {
    std::map<Vec3, Index> places;
    Vec3 x;
    for (Index i = 0; i < this->View.numberOfPoints; ++i)
    {
      this->Request.mesh->GetPoint(i, x.data());
      places.emplace(x, i);
    }
    std::vector<Index> ids;
    for (vtkIdType i = 0; i < made->GetNumberOfPoints(); ++i)
    {
      made->GetPoint(i, x.data());
      const auto found = places.find(x);
      if (found == places.end())
      {
        return {};
      }
      ids.push_back(found->second);
    }
    return ids;
  }

  const TargetRequest& Request;
  const MeshView& View;
  MeshAdapter Adapter;
  PointOrder Order; ///< common to the points of mesh and target
  std::unordered_set<std::pair<Index, Index>, EdgeHash> Edges;
};

/// The set that the boundary of a mesh can lie on: the target, or its boundary if it has the
/// dimension of the mesh.
vtkSmartPointer<vtkDataSet> surfaceOf(vtkDataSet* target, bool ofVolume)
{
  const int expected = ofVolume ? 2 : 1;
  int dimension = -1;
  for (vtkIdType i = 0; i < target->GetNumberOfCells(); ++i)
  {
    dimension = std::max(dimension, target->GetCell(i)->GetCellDimension());
  }
  requireSurface(dimension, ofVolume);
  if (dimension == expected)
  {
    return target;
  }
  const auto skin = skinOf(target);
  return ofVolume ? skin : rimOf(skin);
}

void project(const TargetRequest& request, TargetPlaces& places)
{
  const MeshView& view = request.view->view();
  const bool ofVolume = request.view->dimension() == Dimension::Volume;
  places.given = *request.projected;
  Projection found = projected(surfaceOf(request.target, ofVolume), view.points, places.given);
  places.displacement = std::move(found.displacement);
  places.how = describeProjection(countMarked(places.given), found.farthest);
}
}

//------------------------------------------------------------------------------
vtkDataArray* chosenTargetIds(vtkDataSet* target, const std::string& name)
{
  if (name.empty() || name == "None")
  {
    return nullptr;
  }
  vtkDataArray* array = target->GetPointData()->GetArray(name.c_str());
  if (!array)
  {
    throw Error(
      "The target has no point array '" + name + "' of point ids: choose another, or None.");
  }
  return array;
}

//------------------------------------------------------------------------------
TargetPlaces placesOf(const TargetRequest& request)
{
  const Index points = request.view->view().numberOfPoints;
  TargetPlaces places;
  places.displacement.assign(3 * points, 0.0);
  places.given.assign(points, 0);
  if (request.target->GetNumberOfPoints() == 0)
  {
    throw Error(EmptyTarget);
  }
  std::vector<Index> ids;
  if (request.correspondence != Correspondence::ClosestPoint)
  {
    ids = Matcher(request).match(places.how);
  }
  if (ids.empty())
  {
    project(request, places);
  }
  Index wrong = 0;
  for (Index i = 0; i < static_cast<Index>(ids.size()); ++i)
  {
    const Index point = ids[i];
    if (point == None || !(*request.matched)[point])
    {
      continue;
    }
    Vec3 x;
    request.target->GetPoint(i, x.data());
    const Vec3 d = x - pointOf(request.view->view(), point);
    wrong += !std::isfinite(d[0]) || !std::isfinite(d[1]) || !std::isfinite(d[2]);
    std::copy(d.begin(), d.end(), &places.displacement[3 * point]);
    places.given[point] = 1;
  }
  requireFiniteTarget(wrong);
  if (!ids.empty())
  {
    places.how += describeMatched(countMarked(places.given), countMarked(*request.matched));
  }
  return places;
}
}
