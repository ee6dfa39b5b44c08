// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvedMesh.h
 * @brief A data set with curved cells for filters that move corners: its straight mesh, the nodes
 * that follow, and the certified validity of the result.
 */
#ifndef tautline_CurvedMesh_h
#define tautline_CurvedMesh_h

#include "TautlineCoreModule.h" // for export macro

#include "CurvedFacts.h"
#include "MeshAdapter.h"
#include "tautline/Mesh/FollowingNodes.h"

#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h" // for what the pointer converts to

#include <memory>
#include <vector>

class vtkDataObject;
class vtkDataSet;

namespace tautline
{
/// Whether a data set has cells of quadratic or higher order; of composite data, any data set.
TAUTLINECORE_EXPORT bool hasCurvedCells(vtkDataObject* input);

/**
 * @class tautline::CurvedMesh
 * @brief Splits a mesh into corners, which a filter moves as those of linear cells, and the nodes
 * between them, which follow as tautline::FollowingNodes has it.
 *
 *     CurvedMesh curved(input, threads);
 *     MovableMesh mesh(curved.corners(), threads, true);
 *     curved.join(mesh.representative());
 *     ... // new corners
 *     curved.nodes().place(before, points, threads);
 *     curved.certify(points, validity);
 */
class TAUTLINECORE_EXPORT CurvedMesh
{
public:
  /// Throws Error for curved cells that are not supported; names the remedy.
  CurvedMesh(vtkDataSet* input, int threads);
  ~CurvedMesh();

  /// The same points, and of each cell the linear one of its corners; with the arrays of the input.
  vtkUnstructuredGrid* corners() const { return this->Corners; }

  /// Points that are one, of corners(): nodes between them are then one, too. Empty: none are.
  void join(const std::vector<Index>& representative);
  const FollowingNodes& nodes() const { return *this->Nodes; }

  /// The mesh with all nodes, oriented as MeshAdapter::orient() does, and what belongs to it.
  const Mesh& mesh() const { return this->Adapter.mesh(); }
  const CurvedCellFacts& facts() const { return *this->Facts; }

  /**
   * @brief Replaces the validity of curved cells by that in the whole cell, see
   * certifyCurvedCells(). That of other cells, and what is NotMeasured, is kept.
   * @param points 3 coordinates per point
   * @param validity one per cell, as that of corners()
   */
  void certify(const std::vector<double>& points, std::vector<signed char>& validity) const;

private:
  vtkSmartPointer<vtkUnstructuredGrid> Corners;
  int Threads;
  MeshAdapter Adapter; ///< of the input; its cells in the order of MeshAdapter::orient()
  std::unique_ptr<CurvedFacts> Facts;
  // The cells in VTK's order.
  std::vector<unsigned char> Types;
  std::vector<Index> Offsets, Connectivity;
  std::unique_ptr<FollowingNodes> Nodes;
};
}
#endif
