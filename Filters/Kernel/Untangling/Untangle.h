/**
 * @file Untangle.h
 * @brief Makes the elements of a mesh valid by moving its free vertices.
 *
 * First vertex by vertex around the inverted elements with a regularised determinant (J. M. Escobar et
 * al., "Simultaneous untangling and smoothing of tetrahedral meshes", CMAME 192, 2003), then, for what
 * is left, all vertices at once: from the harmonic map of the mesh, by a foldover-free map energy (V. Garanzha
 * et al., "Foldover-free maps in 50 lines of code", ACM TOG 40, 2021) whose regularisation is driven to zero;
 * around holes that were turned by more than a quarter, by way of meshes with the holes turned back.
 * A cell counts as valid when its corner Jacobians are (Mesh::classifyCells()). The connectivity never changes.
 * Planar and volume meshes.
 */
#ifndef tautline_Untangle_h
#define tautline_Untangle_h

#include "Optimize.h"

namespace tautline
{
/// How hard to try before giving up. The numbers are stable: ParaView state files hold them.
enum class Effort : int
{
  Local = 0,   ///< only the neighbourhood of inverted elements moves; at most 60 sweeps
  Normal = 1,  ///< then all vertices, at most 1500 iterations
  Thorough = 2 ///< at most 5000 iterations, restarts with slower schedules
};

struct UntangleOptions
{
  Effort effort = Effort::Normal;
  /// Seconds of wall time; 0: no limit. Honoured within one iteration.
  double maximumSeconds = 0.0;
  const unsigned char* fixed = nullptr; ///< as in OptimizeOptions
  SurfaceConstraint surface;
  int threads = 0; ///< 0: all cores. The result does not depend on it.
  /// Called after each iteration; return false to stop. Called from the calling thread.
  std::function<bool(const IterationState&)> observer;
};

/// Why an element is still inverted.
enum class Obstacle : signed char
{
  None = 0,            ///< the element is valid
  Unknown = 1,         ///< the iterations ended before it became valid
  FixedElement = 2,    ///< all its vertices are fixed
  FixedNeighbours = 3, ///< the fixed vertices around leave no valid place for its free ones
  NonFinite = 4        ///< a coordinate of a fixed vertex is NaN or infinite
};

struct Untangling
{
  std::vector<double> points; ///< 3 x numberOfPoints, the one with the fewest inverted elements
  std::vector<signed char> obstacles; ///< an Obstacle per cell
  /**
   * @brief objective: the sum of -D over inverted simplices (corners of cells), D = det T with targets as long as the mean
   * edge, comparable between all phases; inverted: elements left. One record or none if there was nothing to do.
   */
  std::vector<IterationRecord> history;
  Index invertedBefore = 0, invertedAfter = 0;
  Index impossible = 0; ///< elements with FixedElement or FixedNeighbours
  StopReason reason = StopReason::AllValid;
  double surfaceError = 0;
};

/**
 * @brief Untangles. The result never has more inverted or degenerate elements than the input; fixed points and
 * points that need not move keep their bits.
 * @param mesh oriented consistently (see Mesh::orientation(), setMirrored()); not changed.
 * Throws Error for a surface mesh in space with inverted elements.
 */
TAUTLINE_KERNEL_EXPORT Untangling untangle(const Mesh& mesh, const UntangleOptions& options);
}
#endif
