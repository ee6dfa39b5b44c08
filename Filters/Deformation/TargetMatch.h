// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TargetMatch.h
 * @brief The correspondence between the points of a mesh and the places of a target data set.
 */
#ifndef tautline_TargetMatch_h
#define tautline_TargetMatch_h

#include "tautline/Mesh/Mesh.h"

#include "vtkSmartPointer.h"

#include <string>
#include <vector>

class vtkDataArray;
class vtkDataSet;
class vtkPolyData;

namespace tautline
{
/// The numbers of vtkMeshWarp::Correspondences.
enum class Correspondence : int
{
  Automatic = 0,
  SameMesh = 1,
  SameBoundary = 2,
  PointIds = 3,
  ClosestPoint = 4
};

// Errors.
constexpr const char* NoTarget =
  "There is no Target: choose the data set that has the boundary in its new place.";
constexpr const char* EmptyTarget = "The target is empty: choose another one.";
constexpr const char* NoIdsChosen =
  "No array of point ids is chosen: choose one of the target's point arrays.";
/// What to do where the order of a target's points is not that of the mesh's.
constexpr const char* OrderRemedy =
  "Choose Point Ids, an array that both have; or run Generate Global Ids on the mesh in one piece, "
  "before it is cut and the target is made of it; or let each process have the same pieces of "
  "both; or choose Closest Point.";

/// The target is not the mesh in another place: it has other numbers of points.
Error otherMesh(Index points, Index ofMesh);
/// The same, as it has other cells.
Error otherCells();
/// The target is not the boundary, or the points that move.
Error otherBoundary(Index points, Index moving);
/// The target has an array of point ids that the mesh has not, and the mesh no order.
Error noNumbers(const std::string& array);
/// Points of several processes would correspond by an order that they have not.
Error noOrder(Index points);

struct TargetRequest
{
  vtkDataSet* mesh = nullptr; ///< whose boundary moves, with its arrays
  const Mesh* view = nullptr; ///< the same to the kernel
  vtkDataSet* target = nullptr;
  Correspondence correspondence = Correspondence::Automatic;
  vtkDataArray* ids = nullptr; ///< of the target, or null
  /// One flag per point of the mesh: those that move; by projection or SameBoundary, and otherwise.
  const std::vector<unsigned char>* projected = nullptr;
  const std::vector<unsigned char>* matched = nullptr;
  int threads = 0;
};

struct TargetPlaces
{
  std::vector<double> displacement; ///< 3 per point, 0 where nothing is given
  std::vector<unsigned char> given; ///< one flag per point
  std::string how;                  ///< a sentence: which correspondence, how many, how far
};

/// Throws Error that names what does not fit.
TargetPlaces placesOf(const TargetRequest& request);

/// The point array of a target with a name; null for "" and "None". Throws Error if there is none.
vtkDataArray* chosenTargetIds(vtkDataSet* target, const std::string& name);

/// Points that were projected.
struct Projection
{
  std::vector<double> displacement; ///< 3 per point, 0 where the flag is
  double farthest = 0;
};

/// The boundary of a mesh as ParaView's Extract Surface makes it, with vtkOriginalPointIds.
vtkSmartPointer<vtkPolyData> skinOf(vtkDataSet* mesh);
/// The boundary edges of a surface as ParaView's Feature Edges makes them.
vtkSmartPointer<vtkPolyData> rimOf(vtkPolyData* surface);
/// Throws Error if the cells of a target have too few dimensions for a boundary to lie on.
void requireSurface(int dimension, bool ofVolume);

/**
 * @brief The closest points of a surface, or of a curve for a planar mesh. Throws Error if it has
 * no cells, and where none is closest, with the place.
 * @param points 3 per point @param flags one per point: the others do not move
 */
Projection projected(
  vtkDataSet* surface, const double* points, const std::vector<unsigned char>& flags);

/// "by projection: N points to the closest point of the target, ..."
std::string describeProjection(Index points, double farthest);
/// ": N of M points of the boundary", behind how they correspond.
std::string describeMatched(Index given, Index matched);
/// Throws Error if target points that are given have coordinates that are not finite.
void requireFiniteTarget(Index wrong);
/// Throws Error if values of an array of the target are none of the mesh.
void requireKnownIds(Index unknown, const std::string& array, bool ofMesh);
}
#endif
