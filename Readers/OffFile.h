// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OffFile.h
 * @brief Reads and writes Geomview's text OFF, COFF, NOFF and CNOFF files of polygons.
 *
 * Colors of vertices and of faces become `Color`: bytes (3 or 4) if the file has integers,
 * otherwise doubles between 0 and 1. If only some faces have a color, the others get Geomview's
 * gray (170 170 170). Faces with one or two corners become vertices and lines.
 */
#ifndef tautline_OffFile_h
#define tautline_OffFile_h

#include "MeshFile.h"

namespace tautline
{
TAUTLINEREADERS_EXPORT MeshFile readOff(const std::string& name, bool lowerCells);

/// Writes OFF, with C for the point array `Color` and N for `Normals`.
TAUTLINEREADERS_EXPORT std::vector<std::string> writeOff(
  const MeshFile& mesh, const std::string& name);
}
#endif
