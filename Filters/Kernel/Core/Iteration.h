// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Iteration.h
 * @brief Types shared by the iterative methods: stop reasons, iteration records, and the data
 * passed to observers.
 */
#ifndef tautline_Iteration_h
#define tautline_Iteration_h

#include "Types.h"

#include <functional>
#include <vector>

namespace tautline
{
/// Why an optimization ended.
enum class StopReason : int
{
  GradientNorm = 0,   ///< the gradient is small enough
  RelativeChange = 1, ///< the objective hardly changes anymore
  TwoDigits = 2,      ///< mean qualities agree with the previous iteration's to two decimals
  Reduction = 3,      ///< the requested fraction of the possible reduction is reached
  AllValid = 4,       ///< no element is inverted or degenerate
  IterationLimit = 5,
  TimeLimit = 6,
  Aborted = 7,
  NoProgress = 8,    ///< no step reduces the objective
  NoFreeVertices = 9 ///< every vertex is fixed or outside all cells
};

/// A sentence for the user.
TAUTLINE_KERNEL_EXPORT const char* describe(StopReason reason);

/// One line of the history; iteration 0 is the input.
struct IterationRecord
{
  int iteration = 0;
  double seconds = 0;              ///< wall time since the start
  double objective = 0;            ///< the scalarized objective
  std::vector<double> objectives;  ///< each F_i
  std::vector<double> mean, worst; ///< of each objective's metric over the valid elements
  Index inverted = 0;              ///< inverted or degenerate elements
  double gradientNorm = 0; ///< of the scalarized objective over free vertices; 0 if not known
  Index moving = 0;        ///< vertices that still move (local algorithms with culling)
};

/// The data that observers receive after each iteration.
struct IterationState
{
  const IterationRecord& record;
  double progress; ///< 0 to 1, of the iteration or time limit, whichever is closer
  /// Writes 3 x numberOfPoints coordinates in the order of the mesh.
  std::function<void(double*)> points;
};

/// A surface on which the vertices of a surface mesh stay.
struct SurfaceConstraint
{
  bool project = true; ///< project moved vertices back to the input surface
};
}
#endif
