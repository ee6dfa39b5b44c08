// SPDX-License-Identifier: BSD-3-Clause
#include "ValidityLevels.h"

#include "OptimizationProblem.h"

namespace tautline
{
void findValidityLevels(const Mesh& mesh, int threads, std::vector<signed char>& levels)
{
  levels.resize(mesh.view().numberOfCells);
  mesh.classifyCells(levels.data(), threads);
  for (std::size_t cell = 0; cell < levels.size(); ++cell)
  {
    const signed char validity = levels[cell];
    levels[cell] = validity == Valid ? ValidThroughout : InvalidCorners;
    if (isInvalid(validity) && cornerValidity(mesh, static_cast<Index>(cell)) == Valid)
    {
      levels[cell] = ValidCorners;
    }
  }
}
}
