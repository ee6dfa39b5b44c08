/**
 * @file ValidityGuard.h
 * @brief Keeps hexahedra and wedges valid between their corners. Internal: not installed.
 *
 * The steps of the optimizers keep the determinants at the corners positive. Elements that fold
 * inside are found after a sweep, all at once, and their vertices go back.
 */
#ifndef tautline_ValidityGuard_h
#define tautline_ValidityGuard_h

#include "OptimizationProblem.h"

namespace tautline
{
/// How much of an element is valid; must not fall.
enum ValidityLevel : signed char
{
  InvalidCorners = 0, ///< or not measured
  ValidCorners = 1,   ///< but invalid in between
  ValidThroughout = 2
};

/// Writes a ValidityLevel per cell.
void findValidityLevels(const Mesh& mesh, int threads, std::vector<signed char>& levels);

class TAUTLINE_KERNEL_EXPORT ValidityGuard
{
public:
  /// The present validity is the least from now on. The problem has to live as long as this.
  explicit ValidityGuard(OptimizationProblem& problem);

  /**
   * @brief Lets vertices of elements that became less valid go back to where they were, until there
   * is no such element; stores the points. Does nothing in meshes of elements without an inside
   * (hasInside()) and where inversion is allowed.
   * @param before VertexStride coordinates per free vertex
   * @return how many vertices went back
   */
  Index restore(const std::vector<double>& before);

private:
  std::vector<std::int32_t> worsened(const std::vector<signed char>& levels) const;

  OptimizationProblem& Problem;
  bool Active = false;
  std::vector<std::int32_t> VertexOf; ///< per point; -1: not free
  std::vector<signed char> Levels;
};
}
#endif
