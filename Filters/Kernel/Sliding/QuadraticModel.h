// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file QuadraticModel.h
 * @brief A convex quadratic model of an energy of points, minimized matrix-free.
 * Internal: not installed.
 */
#ifndef tautline_QuadraticModel_h
#define tautline_QuadraticModel_h

#include "tautline/Core/Types.h"

#include <vector>

namespace tautline
{
/// A symmetric 3 x 3 matrix: xx xy xz yy yz zz.
struct SymmetricBlock
{
  std::array<double, 6> entries = {};

  void addOuter(const Vec3& v, double factor);
  void addIdentity(double factor);
  Vec3 operator*(const Vec3& v) const;
};

/// The directions in which a point can move.
enum class Freedom : unsigned char
{
  None,  ///< it is fixed
  Line,  ///< along a direction
  Plane, ///< perpendicular to a normal
  Space
};

/// The component of a displacement allowed by a freedom with its direction or normal.
TAUTLINE_KERNEL_EXPORT Vec3 allowed(Freedom freedom, const Vec3& direction, const Vec3& d);

/// A 3 x 3 matrix by its columns.
using Columns = std::array<Vec3, 3>;

/// The corner of a cell for an energy of its Jacobian J: column j of the change of J is the sum
/// over edges k of weights[k][j] times the change of edge k.
struct CornerBlock
{
  std::array<std::int32_t, 4> points; ///< the corner, then its neighbors; -1: does not move
  std::array<Vec3, 3> weights;        ///< of each edge, for the columns of J
  Columns jacobian, cofactor;
  /// The form ofNorm |dJ|^2 + 2 ofMixed (J : dJ)(C : dJ) + ofDeterminant (C : dJ)^2, where C is
  /// the cofactor.
  double ofNorm, ofMixed, ofDeterminant;
};

/// The stopping limits of a solution.
struct SolutionLimits
{
  double relativeResidual = 0.1; ///< in the norm of the preconditioner
  int iterations = 60;
};

/**
 * @class tautline::QuadraticModel
 * @brief Gradient and positive semidefinite Hessian of an energy, as a list of terms. The model is
 * minimized by conjugate gradients, preconditioned by the blocks of the points.
 *
 * Points are numbered from 0; number -1 stands for fixed points and is ignored.
 */
class TAUTLINE_KERNEL_EXPORT QuadraticModel
{
public:
  /// Discards all terms.
  void start(std::size_t points);
  std::size_t points() const { return this->Gradient.size(); }
  void setFreedom(std::int32_t i, Freedom freedom, const Vec3& direction);

  void addGradient(std::int32_t i, const Vec3& g);
  /// Adds factor g g^T, where g has `count` vectors at these points.
  void addRankOne(int count, const std::int32_t* points, const Vec3* vectors, double factor);
  /// Adds stiffness |d_a - d_b|^2 / 2.
  void addEdge(std::int32_t a, std::int32_t b, double stiffness);
  void addBlock(std::int32_t i, const SymmetricBlock& block);
  void addCorner(const CornerBlock& corner);

  /// The Hessian times d, without damping and constraints.
  void apply(const std::vector<Vec3>& d, std::vector<Vec3>& result) const;
  /// The mean of the diagonal entries of a point.
  double sizeOf(std::size_t i) const
  {
    const auto& e = this->Sums[i].entries;
    return (e[0] + e[3] + e[5]) / 3.0;
  }
  const std::vector<Vec3>& gradient() const { return this->Gradient; }

  /**
   * @brief Minimizes the model with damping[i] |d_i|^2 / 2 added.
   * @param step receives the minimum
   * @return the predicted change of the model without damping at `step`, at most 0
   */
  double solve(const std::vector<double>& damping, const SolutionLimits& limits,
    std::vector<Vec3>& step) const;

private:
  struct RankOne
  {
    std::int32_t begin, count;
    double factor;
  };
  struct Edge
  {
    std::int32_t a, b;
    double stiffness;
  };

  std::vector<SymmetricBlock> preconditioner(const std::vector<double>& damping) const;
  Vec3 allow(std::size_t i, const Vec3& d) const
  {
    return allowed(this->Freedoms[i], this->Directions[i], d);
  }

  std::vector<Vec3> Gradient, Directions;
  std::vector<Freedom> Freedoms;
  std::vector<SymmetricBlock> Own;  ///< terms of one point
  std::vector<SymmetricBlock> Sums; ///< the diagonal blocks of all terms
  std::vector<RankOne> RankOnes;
  std::vector<std::int32_t> Ends; ///< of the rank ones
  std::vector<Vec3> Vectors;
  std::vector<Edge> Edges;
  std::vector<CornerBlock> Corners;
};
}
#endif
