// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvedProblem.h
 * @brief The elements and points of a mesh with curved cells, and regions of it that are worked on.
 * Internal: not installed.
 */
#ifndef tautline_CurvedProblem_h
#define tautline_CurvedProblem_h

#include "CurvedGuard.h"
#include "CurvedOptions.h"
#include "CurvedSlides.h"

namespace tautline
{
/// Some elements, with points numbered among themselves.
struct CurvedRegion
{
  std::vector<CurvedElement> elements;
  std::vector<Index> points; ///< of the mesh
  std::vector<double> x;     ///< 3 coordinates per point, in a plane in its frame
  std::unique_ptr<CurvedSlides> slides;
  Index free = 0; ///< points that are not fixed
};

class CurvedProblem
{
public:
  /**
   * @brief All cells of the dimension of the mesh, linear ones too.
   * @throws Error with the remedy for surfaces in space, cells that ElementType does not support,
   * and arrays that are out of range
   */
  CurvedProblem(const Mesh& mesh, const CurvedOptions& options);

  int dimension() const { return this->Dimension; }
  const std::vector<CurvedElement>& elements() const { return this->Elements; }
  /// Coordinates in the frame of a plane, else of the mesh.
  std::vector<double>& x() { return this->X; }
  /// Coordinates of the mesh, 3 per point, in that frame.
  std::vector<double> inFrame(const double* points) const;
  /// As coordinates of the mesh; points that have not moved keep theirs.
  std::vector<double> points() const;
  std::vector<double> points(const std::vector<double>& x) const;
  const CurvedGuard& guard() const { return *this->Guard; }
  const SlidingBoundary& boundary();

  /**
   * @brief The elements within some rings around others, and what their points may do: those of
   * elements outside stay.
   * @param rings below 0: all elements of the mesh
   */
  CurvedRegion region(const std::vector<WeakPlace>& around, int rings);
  /// Takes the points of a region over.
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
