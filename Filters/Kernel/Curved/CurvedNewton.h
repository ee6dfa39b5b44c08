// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvedNewton.h
 * @brief One step of Newton's method on an energy of curved elements.
 * Internal: not installed.
 */
#ifndef tautline_CurvedNewton_h
#define tautline_CurvedNewton_h

#include "CurvedSlides.h"
#include "CurvedSum.h"

namespace tautline
{
struct NewtonLimits
{
  double relativeResidual = 0.3; ///< of the linear system
  int iterations = 40;
};

/**
 * @class CurvedNewton
 * @brief Newton's directions by conjugate gradients, preconditioned by the blocks of the points,
 * and ended where the curvature is not positive (T. Steihaug, "The conjugate gradient method and
 * trust regions in large scale optimization", 1983).
 */
template <int Dim>
class CurvedNewton
{
public:
  /// All must outlive this. The points of x are on what they slide on.
  CurvedNewton(CurvedSum<Dim>& energy, CurvedSlides& slides, int threads)
    : Energy(energy)
    , Slides(slides)
    , Threads(threads)
  {
  }

  /// Finds energy, gradient and direction at x.
  void linearize(const std::vector<double>& x, const NewtonLimits& limits);
  double energy() const { return this->Value; }
  double gradientNorm() const { return this->GradientNorm; }
  /// The slope of the energy along the direction; negative, or 0 where there is none.
  double slope() const { return this->Slope; }

  /**
   * @brief Goes along the direction until the energy has fallen as the slope promises (Armijo).
   * @param step the first step length; gets the one of the result
   * @param x gets the new points
   * @return the energy there, or infinity if no step does; then, after some points were held (see
   * CurvedSlides::hold()), linearize() finds another direction
   */
  double search(const std::vector<double>& from, double& step, std::vector<double>& x);

private:
  bool holdRidges(const std::vector<double>& from, const std::vector<double>& x);
  void precondition(const std::vector<double>& r, std::vector<double>& z) const;

  CurvedSum<Dim>& Energy;
  CurvedSlides& Slides;
  int Threads;
  double Value = 0, GradientNorm = 0, Slope = 0;
  std::vector<double> Full; ///< the gradient, also across what points slide on
  std::vector<double> Gradient, Direction;
  std::vector<PointBlock> Inverse;
};
}
#endif
