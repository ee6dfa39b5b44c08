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
 * A plane is where the sections are large (90 % of the largest or more): in the middle of these
 * places, of several of the one nearest to the middle of the bounds. That of a cube is in its
 * middle, that of a plate with a rib in the middle of the plate. It depends on the mesh only, and
 * is the same for all time steps.
 *
 * @param mesh a data set, or composite data with one array of the same name active in all blocks;
 * data sets without tetrahedra, hexahedra, voxels, wedges and pyramids are passed over
 * @param sections gets the part of this process, with the point and cell data, and the active point
 * scalars of the mesh; nothing is added if there are no volume meshes
 */
void cutVolumes(vtkDataObject* mesh, RankGroup& processes, vtkPolyData* sections);
}
#endif
