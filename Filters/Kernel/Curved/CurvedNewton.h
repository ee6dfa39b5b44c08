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
 * @brief Newton's directions by conjugate gradients, preconditioned with the diagonal blocks of the
 * points and stopped at nonpositive curvature (T. Steihaug, "The conjugate gradient method and
 * trust regions in large scale optimization", 1983).
 */
template <int Dim>
class CurvedNewton
{
public:
  /// All arguments must outlive this object. The points of x lie on the surfaces or curves on which
  /// they slide.
  CurvedNewton(CurvedSum<Dim>& energy, CurvedSlides& slides, int threads)
    : Energy(energy)
    , Slides(slides)
    , Threads(threads)
  {
  }

  /// Computes the energy, the gradient, and the direction at x.
  void linearize(const std::vector<double>& x, const NewtonLimits& limits);
  double energy() const { return this->Value; }
  double gradientNorm() const { return this->GradientNorm; }
  /// The slope of the energy along the direction; negative, or 0 if there is no descent direction.
  double slope() const { return this->Slope; }

  /**
   * @brief Searches along the direction for a sufficient decrease of the energy (Armijo).
   * @param step the first step length; receives the final one
   * @param x receives the new points
   * @return the energy there, or infinity if no step is sufficient; then, after some points were
   * held (see CurvedSlides::hold()), linearize() finds another direction
   */
  double search(const std::vector<double>& from, double& step, std::vector<double>& x);

private:
  bool holdRidges(const std::vector<double>& from, const std::vector<double>& x);
  void precondition(const std::vector<double>& r, std::vector<double>& z) const;

  CurvedSum<Dim>& Energy;
  CurvedSlides& Slides;
  int Threads;
  double Value = 0, GradientNorm = 0, Slope = 0;
  std::vector<double> Full; ///< the gradient, including components normal to sliding surfaces
  std::vector<double> Gradient, Direction;
  std::vector<PointBlock> Inverse;
};
}
#endif
