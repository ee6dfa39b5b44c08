// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CellEdges.h
 * @brief The edges of the cells of a data set.
 */
#ifndef tautline_CellEdges_h
#define tautline_CellEdges_h

#include "tautline/Mesh/Mesh.h"

#include "vtkCellType.h"

namespace tautline
{
/// Calls visit(a, b) for the edges of all cells of a view, including lines and polygons.
template <class Visit>
void forEachEdge(const MeshView& view, const Visit& visit)
{
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const Index* node = view.connectivity + view.offsets[cell];
    const Index size = view.offsets[cell + 1] - view.offsets[cell];
    const int code = view.cellTypes[cell];
    const CellType type = cornerType(code);
    if (type != CellType::Unsupported)
    {
      const CellTopology& t = topology(type);
      for (int e = 0; e < t.edges; ++e)
      {
        visit(node[t.edgeNodes[e][0]], node[t.edgeNodes[e][1]]);
      }
    }
    else if (code == VTK_LINE || code == VTK_POLY_LINE || code == VTK_POLYGON)
    {
      for (Index i = 0; i + 1 < size; ++i)
      {
        visit(node[i], node[i + 1]);
      }
      if (code == VTK_POLYGON && size > 2)
      {
        visit(node[size - 1], node[0]);
      }
    }
  }
}
}
#endif
