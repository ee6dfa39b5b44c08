// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Domains.h
 * @brief The geometric domains of the dissertation: boundaries for a mesher, structured meshes,
 * motions.
 *
 * The figures show the shapes without dimensions; lengths here are chosen to match them. A boundary
 * is sampled with a given spacing, so that its resolution matches the mesh size. Every segment or
 * facet has a marker (1 is the outer boundary); every moving domain defines the motion of its
 * boundary points.
 */
#ifndef tautline_Domains_h
#define tautline_Domains_h

#include "tautline/Core/Types.h"

#include <vector>

namespace tautline
{
/// Segments in the plane that bound a region to be meshed.
struct PlanarBoundary
{
  std::vector<double> points;  ///< x y each
  std::vector<Index> segments; ///< two points each
  std::vector<int> markers;    ///< one per segment
  std::vector<double> holes;   ///< x y of a point in each hole
};

/// A planar facet: polygons (the outline, then holes and inner polygons) and points in its holes.
struct SolidFacet
{
  std::vector<std::vector<Index>> polygons;
  std::vector<Vec3> holes;
  int marker = 1;
};

/// Facets in space that bound a region to be meshed.
struct SolidBoundary
{
  std::vector<double> points; ///< x y z each
  std::vector<SolidFacet> facets;
  std::vector<double> holes; ///< x y z of a point in each hole
};

/// A structured mesh of triangles.
struct StructuredMesh
{
  std::vector<double> points;      ///< x y z each
  std::vector<Index> triangles;    ///< three points each, counterclockwise
  std::vector<int> pointMarkers;   ///< 0 inside, otherwise the boundary that contains the point
  std::vector<int> cellReferences; ///< 1 in the domain, 2 in its interaction layer
};

/// How a domain is meshed.
enum class DomainKind
{
  Structured, ///< made here
  Planar,     ///< needs a mesher of triangles
  Solid       ///< needs a mesher of tetrahedra
};

/// Facts about a domain.
struct DomainInfo
{
  const char* name;   ///< as in Python and on the command line
  const char* label;  ///< as in a menu
  const char* source; ///< its location in the dissertation, or a remark
  DomainKind kind;
  Index cells; ///< default number of cells
  bool moving; ///< has a deformed boundary
  double size; ///< area or volume, roughly: for the first guess of a spacing
};

/// All domains, in the order of the menu.
TAUTLINE_KERNEL_EXPORT const std::vector<DomainInfo>& domains();
/// Throws Error, listing the available names, for an unknown name.
TAUTLINE_KERNEL_EXPORT const DomainInfo& findDomain(const std::string& name);

/**
 * @brief Throws Error if a mesh of this many cells needs more memory than is available. Estimated
 * from the number of cells before any allocation.
 */
TAUTLINE_KERNEL_EXPORT void checkDomainSize(double cells, DomainKind kind);

/// The boundary of a planar domain, sampled with segments of about the given length, 1e-5 to 1e3;
/// for a solid domain, from 1e-4. Throws Error otherwise.
TAUTLINE_KERNEL_EXPORT PlanarBoundary planarBoundary(const std::string& name, double spacing);
/// The boundary of a solid domain.
TAUTLINE_KERNEL_EXPORT SolidBoundary solidBoundary(const std::string& name, double spacing);

/**
 * @brief The rectangle (0,2) x (0,1) of Figure 4.20, in squares cut along alternating diagonals.
 * The number of triangles is the even number 4 n^2 nearest to `cells`.
 */
TAUTLINE_KERNEL_EXPORT StructuredMesh structuredRectangle(Index cells);

/**
 * @brief The square (0,1)^2 of right triangles of Figures 4.6 and 4.7 with an interaction layer of
 * width `layer`.
 *
 * The legs of a triangle are h sqrt(r) and h / sqrt(r), so that the number of triangles in the
 * square is 2 / h^2 for every aspect ratio r. 1 / (h sqrt(r)) and sqrt(r) / h must be whole
 * numbers; the interaction layer has the smallest number of whole layers that makes it at least
 * `layer` wide. Throws Error otherwise.
 */
TAUTLINE_KERNEL_EXPORT StructuredMesh structuredSquare(double h, double aspectRatio, double layer);

/**
 * @brief The motion of a boundary point: its displacement at the end of the motion, times `amount`.
 * Motions that are not linear in amount (bending, turning) are evaluated at that amount: the inner
 * box turns by 180 degrees times amount. Zero on fixed parts.
 */
TAUTLINE_KERNEL_EXPORT Vec3 domainDisplacement(
  const std::string& name, const Vec3& point, int marker, double amount);
}
#endif
