// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvedMotion.h
 * @brief A data set with curved cells, for filters that move all its nodes.
 */
#ifndef tautline_CurvedMotion_h
#define tautline_CurvedMotion_h

#include "TautlineCoreModule.h" // for export macro

#include "CurvedMesh.h"
#include "MovableMesh.h"
#include "tautline/Curved/CurvedOptions.h"

class vtkDataArray;
class vtkDataObject;

namespace tautline
{
struct InputBlock;

/**
 * @class tautline::CurvedMotion
 * @brief Holds the corners as a MovableMesh (for orientation, validity and output) and the mesh
 * with all nodes in the same frame (for the kernel).
 */
class TAUTLINECORE_EXPORT CurvedMotion
{
public:
  /// Throws Error, with the remedy, as MovableMesh does, and also for coincident points on seams.
  CurvedMotion(const InputBlock& block, int threads, bool mergePoints);

  MovableMesh& corners() { return this->Corners; }
  const Mesh& mesh() const { return *this->Full; }
  /// Options with the facts of the cells and the fixed points; the other options have their
  /// defaults.
  CurvedOptions options() const;

  /// Marks points that stay: points with a nonzero value in an array (null: none) and points of a
  /// selection.
  void fix(vtkDataArray* array);
  void fixSelected(vtkDataSet* selected);
  /// Frees the points of invalid elements, whatever fixed them, except points that always stay.
  void freeInvalid();

  /**
   * @brief The patches and curves of a surface, in the frame of the mesh, for
   * CurvedOptions::geometry.
   * Throws Error, with the remedy, if it has no facets or has volume cells.
   */
  SurfaceModel geometry(vtkDataObject* surface, double featureAngle, bool smooth) const;

private:
  void fixWhatStays();

  CurvedMesh Cells;
  MovableMesh Corners;
  int Threads;
  std::unique_ptr<Mesh> Full;
  std::vector<unsigned char> Fixed, Stays;
};
}
#endif
