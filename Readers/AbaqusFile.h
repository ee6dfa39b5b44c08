// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file AbaqusFile.h
 * @brief Reads the mesh of input files of Abaqus and CalculiX (.inp).
 *
 * The supported keywords are *NODE, *ELEMENT, *NSET and *ELSET (including GENERATE), flat or in
 * parts that are instanced in an assembly (translation and rotation are applied), and *INCLUDE.
 * First- and second-order elements of solids, shells, membranes, plane and axisymmetric continua,
 * trusses and beams become cells; masses, springs, connectors and the like are left out, with a
 * warning. Keywords that generate nodes or elements (*NGEN, *NFILL, *NCOPY, *ELGEN, *ELCOPY, ...),
 * other coordinate systems and unknown element types are an error that gives the line.
 *
 * Points keep the order of the file, instance after instance. Each set becomes a point or cell
 * array of 0 and 1 with its name; sets marked INTERNAL are left out. With several instances,
 * `Instance` (cells, int64) is the index in the field array `Instances` of their names.
 */
#ifndef tautline_AbaqusFile_h
#define tautline_AbaqusFile_h

#include "MeshFile.h"

#include <string_view>

namespace tautline
{
/**
 * @brief Reads a file.
 * @param lowerCells whether to keep cells of lower dimension than the mesh
 *
 * Throws FileError with file and line.
 */
TAUTLINEREADERS_EXPORT MeshFile readAbaqus(const std::string& name, bool lowerCells);

/// The cell for an element type (C3D8R, S4, CPS8R, B31, ...) and the order of its nodes.
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

/// @param name in uppercase
TAUTLINEREADERS_EXPORT AbaqusElement abaqusElement(std::string_view name);
}
#endif
