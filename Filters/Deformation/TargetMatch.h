// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TargetMatch.h
 * @brief The correspondence between the points of a mesh and positions given by a target data set.
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
/// The values of vtkMeshWarp::Correspondences.
enum class Correspondence : int
{
  Automatic = 0,
  SameMesh = 1,
  SameBoundary = 2,
  PointIds = 3,
  ClosestPoint = 4
};

/// An error.
constexpr const char* NoTarget =
  "There is no Target: choose the data set that has the boundary in its new position.";

struct TargetRequest
{
  vtkDataSet* mesh = nullptr; ///< the mesh whose boundary moves, with its arrays
  const Mesh* view = nullptr; ///< the same mesh as a kernel mesh
  vtkDataSet* target = nullptr;
  Correspondence correspondence = Correspondence::Automatic;
  vtkDataArray* ids = nullptr; ///< of the target, or null
  /// One flag per point of the mesh, set for moving points: by projection or SameBoundary, and
  /// otherwise.
  const std::vector<unsigned char>* projected = nullptr;
  const std::vector<unsigned char>* matched = nullptr;
  int threads = 0;
};

struct TargetPlaces
{
  std::vector<double> displacement; ///< 3 per point, 0 where not given
  std::vector<unsigned char> given; ///< one flag per point
  std::string how;                  ///< a sentence: type of correspondence, number, distance
};

/// Throws Error if the target does not fit.
TargetPlaces placesOf(const TargetRequest& request);

/// The named point array of a target; null for "" and "None". Throws Error if it is missing.
vtkDataArray* chosenTargetIds(vtkDataSet* target, const std::string& name);
}
#endif
