// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file NastranFile.h
 * @brief The mesh of bulk data of Nastran: .bdf, .nas, .fem.
 *
 * Read are GRID, GRDSET, CORD2R, CORD2C and CORD2S (for the places of grid points), INCLUDE, and
 * the elements CTRIA3, CTRIAR, CTRIA6, CQUAD4, CQUADR, CQUAD8, CQUAD, CSHEAR, CTETRA, CPYRAM,
 * CPENTA, CHEXA, CROD, CONROD, CTUBE, CBAR, CBEAM: in small, large and free fields, with
 * continuation lines (marked or not) and blank fields. Other cards that begin with C are left out,
 * with a warning; those without a shape (CELAS2, CONM2, ...) without one. A grid point in a system
 * that is not given, an element of second order that lacks some of its middle nodes, and wrong
 * fields are refused, with their line.
 *
 * Points keep the order of the file. `Reference` (cells, int64) is the number of the property.
 */
#ifndef tautline_NastranFile_h
#define tautline_NastranFile_h

#include "MeshFile.h"

namespace tautline
{
/**
 * @brief Reads a file.
 * @param lowerCells whether cells of lower dimension than the mesh are kept
 *
 * Throws FileError with file and line.
 */
TAUTLINEREADERS_EXPORT MeshFile readNastran(const std::string& name, bool lowerCells);
}
#endif
