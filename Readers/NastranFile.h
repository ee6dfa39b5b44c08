// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file NastranFile.h
 * @brief Reads the mesh in Nastran bulk data: .bdf, .nas, .fem.
 *
 * The supported cards are GRID, GRDSET, CORD2R, CORD2C and CORD2S (for the positions of grid
 * points), INCLUDE, and the elements CTRIA3, CTRIAR, CTRIA6, CQUAD4, CQUADR, CQUAD8, CQUAD, CSHEAR,
 * CTETRA, CPYRAM, CPENTA, CHEXA, CROD, CONROD, CTUBE, CBAR, CBEAM, in small, large and free fields,
 * with continuation lines (marked or not) and blank fields. Other cards that begin with C are left
 * out, with a warning unless they have no shape (CELAS2, CONM2, ...). A grid point in an undefined
 * coordinate system, a second-order element that lacks some of its midside nodes, and invalid
 * fields are an error that gives the line.
 *
 * Points keep the order of the file. `Reference` (cells, int64) is the property number.
 */
#ifndef tautline_NastranFile_h
#define tautline_NastranFile_h

#include "MeshFile.h"

namespace tautline
{
/**
 * @brief Reads a file.
 * @param lowerCells whether to keep cells of lower dimension than the mesh
 *
 * Throws FileError with file and line.
 */
TAUTLINEREADERS_EXPORT MeshFile readNastran(const std::string& name, bool lowerCells);
}
#endif
