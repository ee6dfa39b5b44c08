// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FoamFileAdapter.h
 * @brief Converts a mesh of OpenFOAM to VTK, with the arrays of vtkFoamMeshReader. Internal: not
 * installed.
 */
#ifndef tautline_FoamFileAdapter_h
#define tautline_FoamFileAdapter_h

#include "TautlineReadersModule.h" // for export macro

#include "FoamCase.h"

class vtkUnstructuredGrid;

namespace tautline
{
/// The field array (strings) with the directories polyMesh whose points a mesh has.
constexpr const char* FoamCaseArray = "FoamCase";

/// Number, name, type and size of each patch, one line each.
std::string patchList(const FoamMesh& mesh);

/// @param patchFaces whether the faces of the patches become cells after the volume cells
TAUTLINEREADERS_EXPORT void toGrid(FoamPiece piece, bool patchFaces, vtkUnstructuredGrid* grid);
}
#endif
