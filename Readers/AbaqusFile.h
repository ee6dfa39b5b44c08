// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file AbaqusFile.h
 * @brief The mesh of input files of Abaqus and CalculiX, .inp.
 *
 * Read are *NODE, *ELEMENT, *NSET and *ELSET (GENERATE too), flat or in parts that are instanced in
 * an assembly (translation and rotation are applied), and *INCLUDE. Elements of first and second
 * order of solids, shells, membranes, plane and axisymmetric continua, trusses and beams become
 * cells; masses, springs, connectors and the like are left out, with a warning. Keywords that
 * generate nodes or elements (*NGEN, *NFILL, *NCOPY, *ELGEN, *ELCOPY, ...), other systems of
 * coordinates and unknown element types are refused, with their line.
 *
 * Points keep the order of the file, instance after instance. Each set is an array of 0 and 1 of
 * the points or cells with its name; sets that are marked INTERNAL are left out. Of several
 * instances, `Instance` (cells, int64) is the place in the field array `Instances` of their names.
 */
#ifndef tautline_AbaqusFile_h
#define tautline_AbaqusFile_h

#include "MeshFile.h"

#include <string_view>

namespace tautline
{
/**
 * @brief Reads a file.
 * @param lowerCells whether cells of lower dimension than the mesh are kept
 *
 * Throws FileError with file and line.
 */
TAUTLINEREADERS_EXPORT MeshFile readAbaqus(const std::string& name, bool lowerCells);

/// The cell of a type of elements (C3D8R, S4, CPS8R, B31, ...) and how its nodes are ordered.
struct AbaqusElement
{
  enum Kind
  {
    Cell,
    NoCell, ///< a mass, a spring, a connector, ...
    Unknown
  };
  Kind kind = Unknown;
  unsigned char type = 0;
  const int* order = nullptr; ///< as in NumberedCells::add()
};

/// @param name in capitals
TAUTLINEREADERS_EXPORT AbaqusElement abaqusElement(std::string_view name);
}
#endif
