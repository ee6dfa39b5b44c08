// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Sections.h
 * @brief Planar sections of volume meshes, which show a solution inside.
 */
#ifndef tautline_Sections_h
#define tautline_Sections_h

class vtkDataObject;
class vtkPolyData;

namespace tautline
{
class RankGroup;

/**
 * @brief Cuts volume meshes by three planes, normal to the axes, on all processes. Collective.
 *
 * A plane is in the middle of the range where the sections are large (at least 90 % of the
 * largest), or of the range nearest to the middle of the bounds if there are several: in the middle
 * of a cube, or in the middle of the plate for a plate with a rib. It depends only on the mesh, and
 * is the same for all time steps.
 *
 * @param mesh a data set, or composite data with one array of the same name active in all blocks;
 * data sets without tetrahedra, hexahedra, voxels, wedges and pyramids are skipped
 * @param sections receives the part of this process, with the point and cell data, and the active
 * point scalars of the mesh; nothing is added if there are no volume meshes
 */
void cutVolumes(vtkDataObject* mesh, RankGroup& processes, vtkPolyData* sections);
}
#endif
