// SPDX-License-Identifier: BSD-3-Clause
// The plane of a mesh of 2D cells.
#include "PlaneSearch.h"

namespace tautline
{
//------------------------------------------------------------------------------
void Mesh::findPlane()
{
  const auto corners = [this](const auto& visit)
  { forEachFiniteCorner(this->View, this->Blocks, nullptr, visit); };
  OneProcessTotals totals;
  MeshSpace space = this->space();
  PlaneSearch(corners, totals).run(space);
  this->setSpace(space);
}
}
