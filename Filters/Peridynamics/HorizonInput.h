// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HorizonInput.h
 * @brief Converts a vtkDataSet of planar triangles to the kernel's HorizonMesh, and back.
 */
#ifndef tautline_HorizonInput_h
#define tautline_HorizonInput_h

#include "tautline/Mesh/Mesh.h"
#include "tautline/Peridynamics/Peridynamics.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <string>
#include <vector>

class vtkAlgorithm;
class vtkDataArray;
class vtkDataObject;
class vtkDataSet;
class vtkInformation;

namespace tautline
{
/// A plane in space, with a coordinate system.
class HorizonPlane
{
public:
  HorizonPlane() = default;
  /// @param place a position in the plane
  HorizonPlane(const MeshSpace& space, const Vec3& place)
    : Frame(space.frame)
    , Offset(dot(place, space.normal) * space.normal)
  {
  }
  /// The position in space of a point of the plane.
  Vec3 lift(double x, double y) const { return this->liftVector(x, y) + this->Offset; }
  /// The direction in space of a vector in the plane.
  Vec3 liftVector(double x, double y) const { return x * this->Frame[0] + y * this->Frame[1]; }
  /// In-plane coordinates of a point or, without the plane's position, of a direction in space.
  std::array<double, 2> project(const Vec3& p) const
  {
    return { dot(p, this->Frame[0]), dot(p, this->Frame[1]) };
  }

private:
  std::array<Vec3, 2> Frame = { Vec3{ 1, 0, 0 }, Vec3{ 0, 1, 0 } };
  Vec3 Offset = { 0, 0, 0 }; ///< normal to the plane
};

class HorizonInput : public HorizonPlane
{
public:
  /**
   * @brief Takes the triangles of a planar mesh; points keep their indices.
   *
   * Vertices and lines are left out. Throws Error for other cells, surfaces in space, an input
   * without triangles and duplicate cells.
   * @param region cell array, may be null; @param layerValue its value in the interaction layer
   * @param mergePoints whether coincident points on seams are one; triangles then use their
   * representatives, and the other points belong to no triangle
   */
  HorizonInput(
    vtkDataSet* input, vtkDataArray* region, double layerValue, bool mergePoints, int threads);

  const HorizonMesh& mesh() const { return this->Mesh; }
  /// Marks the points where the continuous linear basis is given: where the array is not 0.
  void setGivenPoints(vtkDataArray* array);
  /// Gives merged points the values of their representatives.
  void spread(vtkDataArray* ofPoints) const;
  /// Remarks for the user on coincident points, as sentences, or "".
  const std::string& notice() const { return this->Notice; }
  /// One per point, see CoincidentPoints; empty if no points are merged.
  const std::vector<Index>& representative() const { return this->Representative; }
  /// The cell of a triangle.
  vtkIdType cell(Index triangle) const { return this->Cells[static_cast<std::size_t>(triangle)]; }

private:
  HorizonMesh Mesh;
  std::vector<vtkIdType> Cells;
  std::vector<Index> Representative;
  std::string Notice;
};

/**
 * @brief The mesh in a data object: a data set itself, or the data sets of composite data joined
 * into one unstructured grid, with the arrays that all of them have. Never null.
 */
vtkSmartPointer<vtkDataSet> wholeMesh(vtkDataObject* input);

/**
 * @brief The array named by the information of SetInputArrayToProcess, or null if it names none.
 *
 * Throws Error if the input has no such array. @param onPoints set to its association
 */
vtkDataArray* chosenArray(
  vtkInformation* choice, vtkDataSet* input, const char* purpose, bool& onPoints);
}
#endif
