// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvedMotion.h
 * @brief A data set with curved cells for filters that move all its nodes.
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
 * @brief The corners as a MovableMesh, for orientation, validity and output, and the mesh with all
 * nodes in the same frame, for the kernel.
 */
class TAUTLINECORE_EXPORT CurvedMotion
{
public:
  /// Throws Error with the remedy as MovableMesh does, and for coincident points on seams.
  CurvedMotion(const InputBlock& block, int threads, bool mergePoints);

  MovableMesh& corners() { return this->Corners; }
  const Mesh& mesh() const { return *this->Full; }
  /// The facts of the cells and the fixed points; the rest is the default.
  CurvedOptions options() const;

  /// Marks points that stay: those with a value other than 0 in an array (null: none), and those of
  /// a selection.
  void fix(vtkDataArray* array);
  void fixSelected(vtkDataSet* selected);
  /// Frees the points of invalid elements, however they were fixed, except those that always stay.
  void freeInvalid();

  /**
   * @brief The patches and curves of a surface, in the frame of the mesh, for
   * CurvedOptions::geometry.
   * Throws Error with the remedy where it has no facets, or has volume cells.
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
