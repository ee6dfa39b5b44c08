/**
 * @file WarpBoundary.h
 * @brief Where a moved boundary runs into itself. Internal: not installed.
 */
#ifndef tautline_WarpBoundary_h
#define tautline_WarpBoundary_h

#include "tautline/Mesh/Mesh.h"

namespace tautline
{
/**
 * @class tautline::WarpBoundary
 * @brief The prescribed boundary of a mesh, and where it crosses itself after a motion.
 */
class WarpBoundary
{
public:
  /// Finds the edges (2D) or faces (3D) of one cell alone whose points are all prescribed.
  WarpBoundary(const Mesh& mesh, const std::vector<unsigned char>& prescribed);

  struct Crossing
  {
    Index pairs = 0;                       ///< of edges, or of triangles, that cross
    std::array<Index, 2> first = { 0, 0 }; ///< a point of each of the first pair
  };
  /**
   * @brief Counts pairs without a common point that meet: edges that cross or touch, triangles that
   * an edge of the other goes right through.
   * @param points 3 per point of the mesh
   */
  Crossing crossings(const double* points) const;

private:
  const Mesh& Input;
  int Nodes; ///< of a facet: 2 or 3
  std::vector<std::array<Index, 3>> Facets;
};
}
#endif
