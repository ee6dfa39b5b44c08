// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TargetSurface.h
 * @brief The surface or curve that boundaries are projected to, of a target in pieces.
 */
#ifndef tautline_TargetSurface_h
#define tautline_TargetSurface_h

#include "vtkSmartPointer.h"

class vtkDataSet;

namespace tautline
{
class RankGroup;

/**
 * @brief What the boundary of a mesh can lie on, as surfaceOf() makes it of the whole target, on
 * every process. Of cells that have more dimensions only the facets that are not between two cells
 * are sent: those at the seams of the pieces are left out. Points on seams are one by their global
 * ids if all pieces have them, else by their coordinates. Without arrays. Collective; throws Error
 * on all processes.
 * @param piece of the target, or null; ghost cells in it do not count
 * @param ofVolume whether the mesh is one of volume cells
 */
vtkSmartPointer<vtkDataSet> targetSurfaceOnAll(RankGroup& group, vtkDataSet* piece, bool ofVolume);
}
#endif
