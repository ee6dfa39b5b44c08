// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshFile.h
 * @brief The contents of a mesh file in plain C++ arrays, between a format's parser and VTK.
 *
 * The parsers and formatters of this directory (TetGenFile, MeditFile, GmshFile, MfemFile, OffFile)
 * read and write a MeshFile and do not use VTK; MeshFileAdapter converts it to data sets and back.
 *
 * All formats share the following array names, so that filters do not depend on the format:
 *
 * - `BoundaryMarker` (points, int64): TetGen, Triangle: 0 inside, other numbers name the boundary
 * - `BoundaryMarker` (cells, int64): TetGen, Triangle: marker of a facet, face, edge or segment
 * - `Reference` (points, int64): Medit, FreeFem++: label of a vertex
 * - `Reference` (cells, int64): material or region: TetGen's first element attribute (double if not
 *   an integer), Medit and FreeFem++ label, Gmsh's physical tag
 * - `Entity` (cells, int64): Gmsh: tag of the geometric entity
 * - `Fixed` (points, uint8): Medit: 1 for required vertices and corners
 * - `Corner` (points, uint8): Medit: 1 for corners
 * - `Ridge` (cells, uint8): Medit: 1 for ridges (edges)
 * - `Required` (cells, uint8): Medit: 1 for required edges and triangles
 * - `Normals` (points, double): NOFF
 * - `Color` (both, uint8 or double): COFF, colors of OFF faces: 3 or 4 components
 * - `Facet` (cells, int64): TetGen .poly: the facet of a polygon, from 0
 * - `Holes` (field, double): .poly, .smesh: a point x y z in each hole
 * - `Regions` (field, double): .poly, .smesh: x y z, attribute, largest size
 * - `FacetHoles` (field, double): TetGen .poly: facet, then a point x y z in the hole of the facet
 *
 * Other arrays keep their names in the file (Gmsh), or are called `Attribute1`, ... (TetGen) and
 * `Solution1`, ... (Medit .sol), unless the file was written by Tautline, which stores the names in
 * a comment that other programs skip.
 */
#ifndef tautline_MeshFile_h
#define tautline_MeshFile_h

#include "TautlineReadersModule.h" // for export macro

#include "tautline/Core/Types.h"

#include <string>
#include <variant>
#include <vector>

namespace tautline
{
/// VTK's codes of the cell types in files.
enum FileCell : unsigned char
{
  FileVertex = 1,
  FileLine = 3,
  FileTriangle = 5,
  FilePolygon = 7,
  FileQuadrilateral = 9,
  FileTetrahedron = 10,
  FileHexahedron = 12,
  FileWedge = 13,
  FilePyramid = 14,
  FileLine3 = 21,
  FileTriangle6 = 22,
  FileQuadrilateral8 = 23,
  FileTetrahedron10 = 24,
  FileHexahedron20 = 25,
  FileWedge15 = 26,
  FilePyramid13 = 27,
  FileQuadrilateral9 = 28,
  FileHexahedron27 = 29,
  FileWedge18 = 32,
  FilePolyhedron = 42,   ///< only for FoamMesh
  FileLagrangeLine = 68, ///< of any order, like all below
  FileLagrangeTriangle = 69,
  FileLagrangeQuadrilateral = 70,
  FileLagrangeTetrahedron = 71,
  FileLagrangeHexahedron = 72,
  FileLagrangeWedge = 73
};

/// The dimension, 0 to 3; -1 for a type that no supported format has.
TAUTLINEREADERS_EXPORT int cellDimension(unsigned char type);
/// Nodes of a cell; 0 for polygons, Lagrange cells and unknown types.
TAUTLINEREADERS_EXPORT int cellNodes(unsigned char type);
/// The name for messages: "tetrahedra", "quadratic triangles", ...
TAUTLINEREADERS_EXPORT const char* cellPlural(unsigned char type);

/// A named array of tuples.
struct TAUTLINEREADERS_EXPORT MeshArray
{
  using Doubles = std::vector<double>;
  using Integers = std::vector<Index>;
  using Bytes = std::vector<unsigned char>;

  std::string name;
  int components = 1;
  std::variant<Doubles, Integers, Bytes> values;

  std::size_t size() const;       ///< number of values, over all components
  double at(std::size_t i) const; ///< a value of any type as a double
  void resize(std::size_t count); ///< new values are 0
  char code() const;              ///< f, i, u: the type in Tautline's comments
  static MeshArray make(std::string name, int components, char code, std::size_t size);
};

/// Strings stored with a mesh (names of Gmsh's physical groups).
struct MeshStrings
{
  std::string name;
  std::vector<std::string> values;
};

/// A mesh as stored in a file. Cell i has the nodes connectivity[offsets[i]] .. offsets[i + 1] - 1.
struct TAUTLINEREADERS_EXPORT MeshFile
{
  std::vector<double> points; ///< x y z each; z = 0 in the plane
  std::vector<unsigned char> cellTypes;
  std::vector<Index> offsets = { 0 };
  std::vector<Index> connectivity;
  std::vector<MeshArray> pointArrays;
  std::vector<MeshArray> cellArrays;
  std::vector<MeshArray> fieldArrays;
  std::vector<MeshStrings> fieldStrings;
  std::vector<std::string> warnings; ///< content of the file not in the mesh, one sentence each

  Index numberOfPoints() const { return static_cast<Index>(this->points.size() / 3); }
  Index numberOfCells() const { return static_cast<Index>(this->cellTypes.size()); }

  /// The largest dimension of a cell; -1 without cells.
  int dimension() const;
  /// Whether every z is 0 and there is no volume cell.
  bool planar() const;
  /// Removes the cells of lower dimension.
  void keepHighestDimension();
  /// Appends cells of one type, nodes one cell after the other.
  void addCells(unsigned char type, std::vector<Index> nodes);
  /// Appends one cell.
  void addCell(unsigned char type, const Index* nodes, Index count);
};

/// The array of this name, or null.
TAUTLINEREADERS_EXPORT const MeshArray* findArray(
  const std::vector<MeshArray>& arrays, const std::string& name);

/// The error thrown by readers: "file:line: problem" or "file: problem".
class FileError : public Error
{
public:
  using Error::Error;
};
}
#endif
