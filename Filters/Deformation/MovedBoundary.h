// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MovedBoundary.h
 * @brief Derives the moving points of a mesh, their displacements, and the tensors per cell, from
 * arrays and selections.
 */
#ifndef tautline_MovedBoundary_h
#define tautline_MovedBoundary_h

#include "MovableMesh.h"
#include "tautline/Mesh/BoundaryParts.h"

#include <array>
#include <functional>

namespace tautline
{
using PointFlags = std::vector<unsigned char>; ///< one per point

/// The values of vtkMeshWarp::MovedParts.
enum class MovedPart : int
{
  Automatic = 0,
  Whole = 1,
  Inner = 2,
  Numbered = 3,
  Values = 4,
  Selection = 5
};

struct PartChoice
{
  std::function<const BoundaryParts&()> parts; ///< of the mesh; called only if needed
  MovedPart part = MovedPart::Automatic;
  std::vector<int> numbers;      ///< Numbered
  std::vector<double> values;    ///< Values; empty: all but 0
  vtkDataArray* array = nullptr; ///< Values
  bool ofCells = false;
  vtkDataSet* selected = nullptr; ///< Selection: the mesh with the marks of markSelected(), or null
  bool elsewhere = false; ///< Selection: other data sets have marks, so that this needs none
};

/**
 * @brief Throws Error for meshes that cannot be warped: with inverted elements, coordinates that
 * are not finite, cells that are not elements (polygons, polyhedra), or no boundary.
 */
void requireElements(const MovableMesh& mesh);

/// Throws Error if there are cells that are not elements.
void requireShapes(Index shapeless);
/// Whether cells of a type (points and lines) have no inside that could be inverted.
bool hasNoInside(int type);

/// Points on the boundary.
PointFlags boundaryOf(const Mesh& mesh);

/// The chosen points of the boundary. Throws Error if there are none.
PointFlags movedPoints(const Mesh& mesh, const PointFlags& boundary, const PartChoice& choice);

/// The points that an array or a selection chooses, on the boundary or not.
PointFlags markedPoints(const Mesh& mesh, const PartChoice& choice);
/// Throws Error if none of the chosen points is on the boundary.
void requireMoved(Index moved, Index chosen);

/// Marks the points of ghost cells.
void markGhosts(vtkDataSet* input, PointFlags& flags);

/// 3 per point, 0 where the flags are 0. Throws Error for other numbers of components, and values
/// that are not finite.
std::vector<double> displacementsOf(vtkDataArray* array, const PointFlags& flags);

/// 6 per cell, from 1, 3, 6 or 9 components.
std::vector<double> tensorsOf(vtkDataArray* array);
/// 6 per cell, by regions: value, alpha, beta, gamma.
std::vector<double> tensorsOf(vtkDataArray* regions,
  const std::vector<std::array<double, 4>>& coefficients, const double* otherwise);
/// Throws Error if the 6 coefficients of a cell are not finite or not positive semidefinite.
/// @param where the owner of the cell, "mesh" or "piece"
void requireTensor(const double* tensor, Index cell, const char* where);
}
#endif
