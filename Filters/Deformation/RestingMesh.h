// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RestingMesh.h
 * @brief The initial mesh of Warp Mesh.
 */
#ifndef tautline_RestingMesh_h
#define tautline_RestingMesh_h

#include "CurvedMesh.h"
#include "MovedBoundary.h"
#include "tautline/Deformation/Warp.h"

#include "vtkPointSet.h"
#include "vtkSmartPointer.h"

#include <memory>
#include <vector>

namespace tautline
{
/// Points, cells, their orders and the ghost flags, without other arrays, whose changes do not
/// matter.
vtkSmartPointer<vtkPointSet> structureOf(vtkPointSet* input);

/// A mesh at rest, with derived data.
struct RestingMesh
{
  vtkSmartPointer<vtkPointSet> data;
  vtkMTimeType time = 0;              ///< modification time of data when it was taken
  std::unique_ptr<CurvedMesh> curved; ///< null: all cells are linear
  std::unique_ptr<MovableMesh> mesh;  ///< of the corners
  PointFlags boundary;                ///< also nodes between corners
  // The elements alone, if there are other cells (lines, vertices, the triangles around a volume).
  std::vector<unsigned char> types;
  std::vector<Index> offsets, connectivity, cells;
  std::unique_ptr<Mesh> elements;
  // The data that the warper was made with and refers to.
  PointFlags prescribed;
  std::vector<double> tensors, options, elementTensors;
  std::unique_ptr<Warper> warper;

  /// Takes a data set, unless it is already here. Throws Error if it cannot be warped.
  void take(vtkPointSet* input, int threads, bool mergePoints);
  /// The mesh to warp.
  const Mesh& warped() const { return this->elements ? *this->elements : this->mesh->mesh(); }

  /// The parts of its boundary; computed on first use.
  const BoundaryParts& parts() const;

private:
  bool sameAs(vtkPointSet* input, int threads) const;
  void takeElements(int threads);

  bool MergePoints = true;
  mutable std::unique_ptr<BoundaryParts> Parts;
};
}
#endif
