// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ShapeModel.h
 * @brief The source, the target, the energy and the options of shape matching.
 */
#ifndef tautline_ShapeModel_h
#define tautline_ShapeModel_h

#include "Silhouette.h"
#include "tautline/ShapesKernelExport.h"

#include <functional>
#include <memory>

namespace tautline
{
/// The treatment of triangles that a placement mirrors.
enum class Reflection
{
  Forbidden = 0, ///< they count as flat
  Whole = 1,     ///< the better one of the shape and its mirror image; triangles as Forbidden
  Free = 2       ///< they cost nothing by themselves, as in the dissertation's formula
};

/// The terms of the energy and their weights.
struct ShapeEnergy
{
  double lambda = 0.1;     ///< of the edge cost, above 0; |grad I| is 1 on an ideal edge
  double deformation = 12; ///< a, at least 0
  double distortion = 3;   ///< b, at least 0; 0 gives Felzenszwalb's energy
  /// E_dis = |log(l_t / l_s) - log(d_t / d_s)|: a triangle must shrink where the shape shrinks. The
  /// dissertation's form, the default, compares how much lengths change, not whether they grow.
  bool signedDistortion = false;
  /// Standard deviation of the Gaussian the target is smoothed with, in pixels, above 0.
  double smoothing = 1.5;
  /// The edge cost uses the gradient along the polygon's inner normal only: the dark side of an
  /// edge must be outside. Not in the dissertation.
  bool directedEdges = false;
  /// Weight of 1 - cos(angle a triangle turns by); 0, the default: turning is free.
  double rotation = 0.0;
  /// Weight per vertex of the squared difference between the descriptors of source and target: the
  /// fraction of the shape in discs of four radii, and the distance from the centre of mass.
  double descriptor = 0.0;
  /// Weight per boundary edge of |log(length along the target's outline / expected)|, with the
  /// outline run through in the polygon's direction. Contour locations only.
  double ordering = 0.0;
  Reflection reflection = Reflection::Forbidden;

  /// The dissertation's: a = 4 b, lambda = 0.1, b = 3.
  static ShapeEnergy dissertation() { return {}; }
  /// The special case b = 0.
  static ShapeEnergy felzenszwalb()
  {
    ShapeEnergy energy;
    energy.distortion = 0.0;
    return energy;
  }
};

/// A shape to match.
struct ShapeSource
{
  PolygonMesh mesh;
  Vec2 centre = {};
  double maxDistance = 0; ///< d_max of the source
  double perimeter = 0;   ///< of the outline
  std::vector<double>
    arc; ///< where each vertex lies along the outline, 0 to 1; empty if not computed
  std::vector<std::array<float, 5>> descriptors; ///< per vertex; empty if not computed
};

/// The triangulated polygon of a silhouette. Throws Error on a spacing that is not above 0.
TAUTLINE_SHAPESKERNEL_EXPORT ShapeSource makeShapeSource(const Silhouette& shape, double spacing);

/// A polygon as the shape to match; centre and d_max are those of its area and vertices.
TAUTLINE_SHAPESKERNEL_EXPORT ShapeSource makeShapeSource(std::vector<Vec2> polygon);

/**
 * @brief A source turned counter-clockwise, or mirrored at the y axis and then turned. A mirrored
 * polygon runs through its vertices backwards, so that it stays counter-clockwise.
 * @param angle in radians
 */
TAUTLINE_SHAPESKERNEL_EXPORT ShapeSource transformSource(
  const ShapeSource& source, double angle, bool mirrored);

/// Where vertices may go.
enum class Locations
{
  Grid = 0,     ///< the centres of columns x rows equal rectangles of the image
  NearGrid = 1, ///< those of them within a grid step of the target's outline
  Contour = 2   ///< points at equal distances along the target's outline
};

/// The set of locations for the vertices of the source.
struct LocationOptions
{
  Locations kind = Locations::Grid;
  Index columns = 30; ///< of the grid; columns and rows are at least 2
  Index rows = 30;
  Index contour = 60; ///< points on the outline, at least 3
  int threads = 0;    ///< 0: all cores. The result does not depend on it.
};

/// The target: an image, its outline, and the locations. Precomputed once, shared by any number of
/// matches.
class TAUTLINE_SHAPESKERNEL_EXPORT ShapeTarget
{
public:
  /**
   * Prepares a target. Edge costs are tables over pairs of locations, which depend on lambda,
   * smoothing and directedEdges of the energy only; descriptors are made if it weights them.
   * @param grey the image, if its grey values rather than the silhouette shall give the gradient;
   * may be null
   *
   * Throws Error if there are less than 3 locations, their table would take more than 4
   * GiB, or an option is out of range.
   */
  ShapeTarget(const Silhouette& shape, const LocationOptions& locations,
    const ShapeEnergy& energy = {}, const ImageView* grey = nullptr);
  ~ShapeTarget();
  ShapeTarget(ShapeTarget&&) noexcept;
  ShapeTarget& operator=(ShapeTarget&&) noexcept;

  const std::vector<Vec2>& locations() const;
  Vec2 centre() const;
  double maxDistance() const;
  /// Mean of 1 / (lambda + |grad I|) from p to q, sampled about once a pixel.
  double edgeCost(const Vec2& p, const Vec2& q) const;

  struct Data;
  const Data& data() const { return *this->Private; }

private:
  std::unique_ptr<Data> Private;
};

/// How to search.
struct MatchOptions
{
  ShapeEnergy energy;
  /// Solutions whose centre is farther from the target's centre of mass than this times d_max are
  /// passed over for the next best (dissertation equation 5.2). 0: the rule is off. The
  /// dissertation's is 1/3.
  double centreTolerance = 1.0 / 3.0;
  /// Maximum number of solutions to try for the rule; then the one with the minimum distance is
  /// taken.
  Index maxSolutions = 1000;
  /// Solves on a third of the locations first, then around that solution only; fast, not exact.
  bool coarseToFine = false;
  /// Bounds that skip placements which cannot be the best. The result is the same without.
  bool bounds = true;
  /// Sources turned by multiples of 360 / rotations degrees are tried; makes sense with
  /// energy.rotation.
  Index rotations = 1;
  /// Target sizes tried, an odd number: delta times 2^(k/2), k = -(n-1)/2 ... (n-1)/2; for images
  /// that show more than the shape, where d_max is no measure of its size.
  Index scales = 1;
  int threads = 0;      ///< 0: all cores. The result does not depend on it.
  double timeLimit = 0; ///< seconds; 0: none. When it is over, the best so far is returned.
  /// Called with the fraction done, 0 to 1; returns whether to continue. May be empty.
  std::function<bool(double)> progress;
};

/// The three terms of a triangle and the optional ones, unweighted.
struct TriangleEnergy
{
  double edge = 0;
  double deformation = 0;
  double distortion = 0;
  double rotation = 0;
};

/// Anisotropy (alpha / beta + beta / alpha) / 2 of a triangle that is flat, or inverted where that
/// is forbidden. Its energy is finite, and larger than that of any useful triangle.
constexpr float FlatAnisotropy = 1e6f;
/// The minimum area of a triangle that is not flat, as a fraction of the square of its perimeter.
constexpr float FlatArea = 1e-7f;
/// The minimum sum of edge lengths, in units of the target's size.
constexpr float MinLength = 1e-6f;

/**
 * @brief Deformation, distortion and rotation of a map of a triangle, in double, from its singular
 * values.
 * @param delta d_max of the source over d_max of the target
 */
TAUTLINE_SHAPESKERNEL_EXPORT TriangleEnergy triangleEnergy(const std::array<Vec2, 3>& source,
  const std::array<Vec2, 3>& target, double delta, const ShapeEnergy& energy);

/// Why a search ended.
enum class MatchStop
{
  Complete = 0,
  TimeLimit = 1,
  Stopped = 2 ///< progress() returned false
};

/// A placement of the source in the target, with its energy.
struct ShapeMatch
{
  std::vector<Vec2> points; ///< of the source's vertices in the target
  double energy = 0;        ///< E, all weighted terms
  double edge = 0;          ///< sum of E_edge
  double deformation = 0;   ///< sum of E_def
  double distortion = 0;    ///< sum of E_dis
  double rotation = 0;      ///< sum of 1 - cos(angle)
  double descriptor = 0;    ///< sum of squared differences
  double ordering = 0;      ///< sum of |log|
  std::vector<TriangleEnergy> triangles;
  Index rank = 1;            ///< of the solution taken: 1 is the minimum energy
  double centreDistance = 0; ///< D, from the mean of the points to the target's centre of mass
  bool centreAccepted = true;
  bool mirrored = false; ///< the source's mirror image was matched
  double angle = 0;      ///< by which the source was turned, in degrees
  double scale = 1;      ///< factor on the expected size
  bool exact = true;     ///< no placement on the locations has a lower energy (rank 1)
  MatchStop stop = MatchStop::Complete;
};
}
#endif
