// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvedProblem.h
 * @brief The elements and points of a mesh with curved cells, and the regions that are processed.
 * Internal: not installed.
 */
#ifndef tautline_CurvedProblem_h
#define tautline_CurvedProblem_h

#include "CurvedGuard.h"
#include "CurvedOptions.h"
#include "CurvedSlides.h"

namespace tautline
{
/// Some elements, with local point numbers.
struct CurvedRegion
{
  std::vector<CurvedElement> elements;
  std::vector<Index> points; ///< of the mesh
  std::vector<double> x;     ///< 3 coordinates per point; for a planar mesh, in its frame
  std::unique_ptr<CurvedSlides> slides;
  Index free = 0; ///< points that are not fixed
};

class CurvedProblem
{
public:
  /**
   * @brief All cells of the dimension of the mesh, including linear ones.
   * @throws Error with the remedy for surfaces in space, cells that ElementType does not support,
   * and arrays that are out of range
   */
  CurvedProblem(const Mesh& mesh, const CurvedOptions& options);

  int dimension() const { return this->Dimension; }
  const std::vector<CurvedElement>& elements() const { return this->Elements; }
  /// Coordinates in the frame of a planar mesh, otherwise the mesh coordinates.
  std::vector<double>& x() { return this->X; }
  /// Converts mesh coordinates, 3 per point, to that frame.
  std::vector<double> inFrame(const double* points) const;
  /// In mesh coordinates; points that have not moved keep their original coordinates.
  std::vector<double> points() const;
  std::vector<double> points(const std::vector<double>& x) const;
  const CurvedGuard& guard() const { return *this->Guard; }
  const SlidingBoundary& boundary();

  /**
   * @brief The elements within some rings around the given ones, and the constraints on their
   * points: points shared with outside elements are fixed.
   * @param rings below 0: all elements of the mesh
   */
  CurvedRegion region(const std::vector<WeakPlace>& around, int rings);
  /// Copies the points of a region back.
  void take(const CurvedRegion& region, const std::vector<double>& x);

private:
  void makeSlides(CurvedRegion& region, const std::vector<char>& held);
  void matchGeometry();

  const Mesh& TheMesh;
  const CurvedOptions& Options;
  int Dimension;
  std::vector<CurvedElement> Elements;
  std::vector<double> X, Start;
  std::unique_ptr<CurvedGuard> Guard;
  std::unique_ptr<SlidingBoundary> Boundary;
  std::vector<SurfaceProjection> Geometry; ///< parts of the geometry
  std::vector<int> GeometryOf;             ///< by part of the boundary
  std::vector<Index> CellsAtOffsets, CellsAt;
};
}
#endif
