// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LayerPieces.h
 * @brief An interaction layer around a mesh in pieces on several processes.
 */
#ifndef tautline_LayerPieces_h
#define tautline_LayerPieces_h

#include "HorizonPieces.h"
#include "tautline/Peridynamics/InteractionLayer.h"

#include <functional>

class vtkDataSet;
class vtkDataSetAttributes;
class vtkUnstructuredGrid;

namespace tautline
{
/// The name of the cell array of interaction layer and domain, and its values.
constexpr const char* ReferenceArray = "Reference";
constexpr int DomainValue = 1, LayerValue = 2;

/// Adds copies of arrays: `count` rows, row `from(i)` of the input as row i, zeros where that is
/// negative.
void passData(vtkDataSetAttributes* input, vtkDataSetAttributes* output, vtkIdType count,
  const std::function<vtkIdType(vtkIdType)>& from);

/**
 * @brief Fills the output of each process: the triangles of its piece without ghost cells, then
 * those of the layer that are nearest to edges of the boundary whose first point it owns.
 * Collective; throws Error on all processes.
 *
 * The first process gets the edges of the boundary and computes the layer.
 * @param seconds for the layer; 0 is no limit
 */
void addLayerToPieces(const HorizonPieces& pieces, vtkDataSet* input,
  const InteractionLayerOptions& options, double seconds, vtkUnstructuredGrid* output);

/// Whether addLayerToPieces() can compute with all triangles; else the mesh is to be gathered, and
/// what is wrong with it is found as with one process. Collective.
bool canSurround(const HorizonPieces& pieces);
}
#endif
