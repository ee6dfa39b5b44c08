// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FoldedCells.h
 * @brief The elements of a surface in space that are folded over their neighbors.
 * Internal: not installed.
 */
#ifndef tautline_FoldedCells_h
#define tautline_FoldedCells_h

#include "Mesh.h"

namespace tautline
{
/**
 * @brief Marks the folded elements of a surface in space as Inverted. Elements connected across
 * edges that are not folds (of more than 150 degrees) form one group. A group of few elements is
 * folded if all its other edges are folds, and the groups beyond them have many more elements.
 * Thus, neither the sides of a thin plate nor sharp ridges are folded.
 * @param validity of the cells as Mesh::classifyCells() gives it; only Valid changes
 * @return the number of elements marked; 0 for other meshes
 */
TAUTLINE_KERNEL_EXPORT Index markFolded(const Mesh& mesh, signed char* validity);
}
#endif
