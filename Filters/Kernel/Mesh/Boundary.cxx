// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh.h"

#include "FacetTable.h"

namespace tautline
{
Boundary Mesh::boundary() const
{
  Boundary result;
  result.isBoundaryPoint.assign(this->View.numberOfPoints, 0);
  FacetTable(*this).forEachFacet(
    [&](Index smallest, const FacetUse* uses, Index count)
    {
      result.nonManifold += count > 2;
      // Facets of three or more cells are treated as boundary: they must not move.
      if (count != 2)
      {
        result.facets += count == 1;
        result.isBoundaryPoint[smallest] = 1;
        for (Index node : uses->others)
        {
          if (node >= 0)
          {
            result.isBoundaryPoint[node] = 1;
          }
        }
      }
    });
  return result;
}
}
