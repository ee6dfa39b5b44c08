// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PerturbOptions.h
 * @brief The options of a random motion of the points of a mesh, and its result.
 */
#ifndef tautline_PerturbOptions_h
#define tautline_PerturbOptions_h

#include "tautline/Core/Types.h"

#include <functional>
#include <vector>

namespace tautline
{
/// The number of vertices to move, the distances, and the number of elements to invert.
struct PerturbOptions
{
  double percentage = 50.0; ///< of the movable vertices to move, 0 to 100
  /// A vertex moves by a random fraction, uniformly distributed from 0 to this (0 to 1), of its
  /// distance to inversion.
  double fraction = 0.5;
  double tangledFraction = 0.0; ///< of the elements to be inverted in the end, 0 to 1
  std::uint64_t seed = 0;
  bool singlePrecision = false; ///< round new coordinates to float without inverting elements
  int threads = 0;              ///< 0: all cores. The result does not depend on it.
  /// One number per point, at least 0, that determines its random numbers and its turn, so that
  /// they do not depend on the order of the points; null: its index.
  const Index* ids = nullptr;
  /// Called periodically with the fraction done, 0 to 1; returns whether to continue. May be empty.
  std::function<bool(double)> progress;
};

/// The perturbed points, and a report.
struct Perturbation
{
  std::vector<double> points; ///< 3 per point of the mesh
  Index movable = 0;          ///< vertices that could move
  Index moved = 0;            ///< vertices whose coordinates changed
  Index elements = 0;         ///< elements with finite vertices, of which a fraction is tangled
  Index invertedBefore = 0;
  Index invertedAfter = 0;
  double largestDisplacement = 0;
  bool stopped = false; ///< progress() returned false; the points are intermediate
};
}
#endif
