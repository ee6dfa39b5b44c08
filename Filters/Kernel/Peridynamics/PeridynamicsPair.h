// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PeridynamicsPair.h
 * @brief The bilinear form over one pair of triangles, to a tolerance.
 * Internal: not installed.
 */
#ifndef tautline_PeridynamicsPair_h
#define tautline_PeridynamicsPair_h

#include "PeridynamicsKernel.h"
#include "TriangleAssembler.h"

namespace tautline
{
/// Two counterclockwise triangles and their common corners.
struct TrianglePair
{
  Vec2 first[3] = {}, second[3] = {};
  /// For each corner of the second: the corner of the first whose function it shares, or -1.
  int shared[3] = { -1, -1, -1 };
  /// The same for coincident corners, whether or not they share a function.
  int touching[3] = { -1, -1, -1 };
  bool identical = false;

  int contacts() const
  {
    return (this->touching[0] >= 0) + (this->touching[1] >= 0) + (this->touching[2] >= 0);
  }
};

/**
 * @brief Integrates products of differences of basis functions over pairs of triangles.
 *
 * For x in the first triangle, the integral over the part of the second that lies in the disk
 * around x is a sum over its edges: in polar coordinates around x, which remove the singularity,
 * the radial integral is known (RadialKernel), and the angular one becomes an integral along the
 * edge, or along the circle where the edge is outside. It is exact up to the Gauss rule along the
 * edge, whose nodes are spaced by s = d sinh t if the edge passes x at a small distance d. The
 * result is smooth in x except at common corners and edges, toward which points are graded; a
 * triangle is quartered until two rules agree. A triangle paired with itself needs one integral
 * along the hexagon of its differences, because the area of its intersection with its translate by
 * z is quadratic in z.
 */
class PairIntegrator
{
public:
  /// components: 1, or 3 (xx, xy, yy) for the tensor kernel; functions: 1 or 3 per triangle
  PairIntegrator(const PeridynamicOptions& options, int functions);

  int functions() const { return this->Functions; }
  /// Numbers in a block: (2 functions)^2 x components.
  int blockSize() const { return 4 * this->Functions * this->Functions * this->Components; }

  /**
   * @brief int int (phi_i(x) - phi_i(y)) (phi_j(x) - phi_j(y)) k over first x second, symmetric in
   * i and j.
   *
   * Functions of the first triangle come first; the entries of a shared function are in the rows
   * and columns of the first triangle, and zero in the second. Halved for an `identical` pair,
   * which occurs once, while others occur twice.
   */
  void integrate(const TrianglePair& pair, double* block);

  /// x^(d-b) y^b of degree d is at d (d + 1) / 2 + b.
  static constexpr int Moments = 15;
  /**
   * @brief Moments of y - x, times k, over the part of a triangle in the disk around x, for the
   * degrees that the model needs (elastic, three functions: 2 to 4); false if there is no such
   * part.
   * @param inside whether x is in the triangle: then only existing moments are correct
   */
  bool momentsAround(const Vec2* corners, Vec2 x, bool inside, double* m);

private:
  struct Corner
  {
    Vec2 at = {};
    bool touches = false;
  };
  using Triangle = std::array<Corner, 3>;

  void identicalPair(const TrianglePair& pair, double* block);
  void refine(const Triangle& part, int depth);
  bool applyRules(const Triangle& part, bool cut);
  void sample(Vec2 x, double weight, double coarseWeight);
  bool moments(const Vec2* corners, Vec2 x, double* m);
  bool isCut(const Triangle& part, bool& apart) const;
  void alongEdge(Vec2 a, Vec2 b, double* m) const;
  void alongCircle(Vec2 a, Vec2 b, double* m) const;
  template <class Work>
  void forEachNodes(Vec2 a, Vec2 b, const Work& work) const;
  bool clip(Vec2 a, Vec2 b, double& t0, double& t1) const;

  RadialKernel Kernel;
  double Horizon, Tolerance;
  int Functions, Components, FirstDegree, LastDegree;
  double
    /// sufficient sum of distances of a pole to the ends of a segment over its half length
    EllipseSum;
  double EdgeGrading;

  // The current pair.
  const TrianglePair* Pair = nullptr;
  int Used[6], NumberUsed = 0; ///< functions with entries
  Vec2 Gradients[6] = {};      ///< of the second triangle's part of each function
  double Scale = 0.0;
  bool FromOrigin = false; ///< for radial integrals, see RadialKernel
  int Parts = 0, CutSamples = 0;
  int
    /// depth to which a part is quartered if the circle cuts the second triangle between samples
    BlindDepth;
  std::array<double, 108> Fine, Coarse, Sum; ///< blocks: of two rules on a part; of all parts
};
}
#endif
