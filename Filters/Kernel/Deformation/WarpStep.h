// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpStep.h
 * @brief One step of a motion: computes all points of a mesh from the displacements of the
 * prescribed points.
 * Internal: not installed.
 */
#ifndef tautline_WarpStep_h
#define tautline_WarpStep_h

#include "Femwarp.h"
#include "WarpQuality.h"

namespace tautline
{
class ElasticWarp;
class PrescribedMotion;

/**
 * @class tautline::WarpStep
 * @brief Deforms a mesh by one step of a motion with the method of the options; keeps matrices for
 * the next step from the same mesh.
 */
class WarpStep
{
public:
  /**
   * @param from the mesh at the start of the step; `initial` for the first step
   * @param initial the reference of the shapes of elements
   */
  WarpStep(const Mesh& from, const Mesh& initial, const WarpParts& parts);
  ~WarpStep();

  /**
   * @brief Makes this an intermediate step of an untangling method: isotropic FEMWARP, local
   * untangling, and a few shape-smoothing sweeps relative to `initial`. improve() follows after the
   * last step.
   */
  void setFollowing(bool following) { this->Following = following; }

  /**
   * @brief Writes the new points, and a record of each stage into the result.
   * @param displacement from `from`
   * @param amount of the whole motion, for the records
   * @return the number of inverted or degenerate elements
   */
  Index run(
    const double* displacement, double amount, WarpControl& control, std::vector<double>& points);

  /// The second step of two-step methods; the prescribed points are already in place.
  void improve(
    const double* displacement, double amount, WarpControl& control, std::vector<double>& points);

private:
  void updateFemwarp(const double* displacement, WarpControl& control);
  void warp(WarpMethod method, const double* displacement, WarpControl& control,
    std::vector<double>& moved);
  WarpQuality warpBy(WarpMethod method, const char* stage, const double* displacement,
    double amount, WarpControl& control, std::vector<double>& points);
  WarpQuality warpByBest(
    const double* displacement, double amount, WarpControl& control, std::vector<double>& points);
  using PointwiseMethod = std::vector<double> (*)(const PrescribedMotion&, WarpControl&);
  std::vector<double> warpPointwise(
    PointwiseMethod method, const double* displacement, WarpControl& control) const;
  Mesh moved(const std::vector<double>& points, int threads) const;
  int untangle(const std::vector<unsigned char>& fixed, WarpControl& control,
    std::vector<double>& points) const;
  enum class Aim
  {
    Barrier,  ///< the squared inverse mean ratios of T alone
    Worst,    ///< then the worst of them, while the mean hardly grows
    Shape,    ///< the exponential sum, see WarpOptions::untangleFirst
    HeldShape ///< the same, with no inverse mean ratio above the worst at the start
  };
  int optimize(Aim aim, const std::vector<unsigned char>& fixed, WarpControl& control,
    std::vector<double>& points) const;
  double meanSize() const;
  WarpQuality record(const char* stage, double amount, int iterations, const double* points,
    WarpControl& control) const;

  const Mesh& From;
  const Mesh& Initial;
  const WarpParts& Parts;
  std::unique_ptr<Femwarp> Scalar; ///< with the coefficients Tensor
  SymmetricTensor Tensor = IdentityTensor;
  std::vector<double> Tensors; ///< for LocalGradients
  std::unique_ptr<ElasticWarp> Elastic;
  bool Following = false;
};

}
#endif
