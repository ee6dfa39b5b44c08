// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TargetMatch.h
 * @brief The correspondence between the points of a mesh and the places of a target data set.
 */
#ifndef tautline_TargetMatch_h
#define tautline_TargetMatch_h

#include "tautline/Mesh/Mesh.h"

#include <string>
#include <vector>

class vtkDataArray;
class vtkDataSet;

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

/**
 * @brief The closest points of a target, or of its boundary if it has as many dimensions as the
 * mesh. Throws Error if the target has no surface (curve).
 * @param ofVolume whether it is a volume mesh whose points these are
 * @param points 3 per point
 */
Projection projected(
  vtkDataSet* target, bool ofVolume, const double* points, const std::vector<unsigned char>& flags);

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
