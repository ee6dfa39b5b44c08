/**
 * @file Untangle.h
 * @brief Makes the elements of a mesh valid by moving its free vertices.
 *
 * First vertex by vertex around the inverted elements with a regularised determinant (J. M. Escobar et
 * al., "Simultaneous untangling and smoothing of tetrahedral meshes", CMAME 192, 2003), then, for what
 * is left, all vertices at once by a foldover-free map energy (V. Garanzha et al., "Foldover-free maps in 50 lines
 * of code", ACM TOG 40, 2021) whose regularisation is driven to zero. The connectivity never changes.
 */
#ifndef tautline_Untangle_h
#define tautline_Untangle_h

#include "Optimize.h"

namespace tautline
{
/// How hard to try before giving up. The numbers are stable: ParaView state files hold them.
enum class Effort : int
{
  Local = 0,   ///< only the neighbourhood of inverted elements moves
  Normal = 1,  ///< then all vertices, a few hundred iterations
  Thorough = 2 ///< thousands of iterations, restarts from other positions
};

struct UntangleOptions
{
  Effort effort = Effort::Normal;
  /// Seconds of wall time; 0: no limit.
  double maximumSeconds = 0.0;
  const unsigned char* fixed = nullptr; ///< as in OptimizeOptions
  SurfaceConstraint surface;
  int threads = 0;
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
  std::vector<signed char> obstacles;   ///< an Obstacle per cell
  std::vector<IterationRecord> history; ///< objective: the energy; inverted: elements left
  Index invertedBefore = 0, invertedAfter = 0;
  Index impossible = 0; ///< elements with FixedElement or FixedNeighbours
  StopReason reason = StopReason::AllValid;
  double surfaceError = 0;
};

/// Untangles. The result never has more inverted elements than the input.
TAUTLINE_KERNEL_EXPORT Untangling untangle(const Mesh& mesh, const UntangleOptions& options);
}
#endif
