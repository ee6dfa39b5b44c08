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
/// Whether a data set, or any data set of composite data, has cells of quadratic or higher order.
TAUTLINECORE_EXPORT bool hasCurvedCells(vtkDataObject* input);

/**
 * @class tautline::CurvedMesh
 * @brief Splits a mesh into the corners, which a filter moves like points of linear cells, and the
 * nodes between them, which follow the corners, see tautline::FollowingNodes.
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
  /// Throws Error, with the remedy, for curved cells that are not supported.
  CurvedMesh(vtkDataSet* input, int threads);
  ~CurvedMesh();

  /// The same points, and for each cell the linear cell of its corners; with the arrays of the
  /// input.
  vtkUnstructuredGrid* corners() const { return this->Corners; }

  /// Merges the nodes between merged points of corners(). Empty if no points are merged.
  void join(const std::vector<Index>& representative);
  const FollowingNodes& nodes() const { return *this->Nodes; }

  /// The mesh with all nodes, oriented as by MeshAdapter::orient(), and its data.
  const Mesh& mesh() const { return this->Adapter.mesh(); }
  const CurvedCellFacts& facts() const { return *this->Facts; }

  /**
   * @brief Replaces the validity of curved cells by the validity throughout the cell, see
   * certifyCurvedCells(). Other cells and NotMeasured cells keep their value.
   * @param points 3 coordinates per point
   * @param validity one per cell, initially for corners()
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
