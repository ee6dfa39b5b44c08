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

/// An error.
constexpr const char* NoTarget =
  "There is no Target: choose the data set that has the boundary in its new place.";

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
}
#endif
