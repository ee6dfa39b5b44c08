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
  Forbidden = 0, ///< they are treated as flat
  Whole = 1,     ///< the better of the shape and its mirror image; triangles as in Forbidden
  Free = 2       ///< they have no additional cost, as in the formula of the dissertation
};

/// The terms of the energy and their weights.
struct ShapeEnergy
{
  double lambda = 0.1;     ///< of the edge cost, above 0; |grad I| is 1 on an ideal edge
  double deformation = 12; ///< a, at least 0
  double distortion = 3;   ///< b, at least 0; 0 gives Felzenszwalb's energy
  /// E_dis = |log(l_t / l_s) - log(d_t / d_s)|: a triangle must shrink where the shape shrinks. The
  /// default, the form of the dissertation, only compares the magnitude of length changes, not
  /// their sign.
  bool signedDistortion = false;
  /// The standard deviation of the Gaussian that smooths the target, in pixels, above 0.
  double smoothing = 1.5;
  /// Whether the edge cost only uses the gradient along the inner normal of the polygon: the dark
  /// side of an edge must be outside. Not in the dissertation.
  bool directedEdges = false;
  /// The weight of 1 - cos(rotation angle of a triangle); 0, the default: rotation is free.
  double rotation = 0.0;
  /// Weight per vertex of the squared difference between the descriptors of source and target: the
  /// fraction of the shape in disks of four radii, and the distance from the center of mass.
  double descriptor = 0.0;
  /// Weight per boundary edge of |log(length along the outline of the target / expected)|, with the
  /// outline traversed in the direction of the polygon. Contour locations only.
  double ordering = 0.0;
  Reflection reflection = Reflection::Forbidden;

  /// The energy of the dissertation: a = 4 b, lambda = 0.1, b = 3.
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
    arc; ///< position of each vertex along the outline, 0 to 1; empty if not computed
  std::vector<std::array<float, 5>> descriptors; ///< per vertex; empty if not computed
};

/// The triangulated polygon of a silhouette. Throws Error for a spacing that is not above 0.
TAUTLINE_SHAPESKERNEL_EXPORT ShapeSource makeShapeSource(const Silhouette& shape, double spacing);

/// A polygon as the shape to match; center and d_max are computed from its area and vertices.
TAUTLINE_SHAPESKERNEL_EXPORT ShapeSource makeShapeSource(std::vector<Vec2> polygon);

/**
 * @brief A source rotated counterclockwise, or mirrored at the y axis and then rotated. A mirrored
 * polygon has its vertices in reverse order, so that it stays counterclockwise.
 * @param angle in radians
 */
TAUTLINE_SHAPESKERNEL_EXPORT ShapeSource transformSource(
  const ShapeSource& source, double angle, bool mirrored);

/// The allowed locations of vertices.
enum class Locations
{
  Grid = 0,     ///< the centers of columns x rows equal rectangles of the image
  NearGrid = 1, ///< those within a grid step of the outline of the target
  Contour = 2   ///< equidistant points along the outline of the target
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

/// The target: an image, its outline, and the locations. Precomputed once and shared by any number
/// of matches.
class TAUTLINE_SHAPESKERNEL_EXPORT ShapeTarget
{
public:
  /**
   * Prepares a target. Edge costs are tables over pairs of locations, which only depend on lambda,
   * smoothing and directedEdges of the energy; descriptors are computed if they have a weight.
   * @param grey the image, to use the gradient of its gray values instead of the silhouette; may be
   * null
   *
   * Throws Error if there are fewer than 3 locations, their table would need more than 4 GiB, or an
   * option is out of range.
   */
  ShapeTarget(const Silhouette& shape, const LocationOptions& locations,
    const ShapeEnergy& energy = {}, const ImageView* grey = nullptr);
  ~ShapeTarget();
  ShapeTarget(ShapeTarget&&) noexcept;
  ShapeTarget& operator=(ShapeTarget&&) noexcept;

  const std::vector<Vec2>& locations() const;
  Vec2 centre() const;
  double maxDistance() const;
  /// The mean of 1 / (lambda + |grad I|) from p to q, sampled about once per pixel.
  double edgeCost(const Vec2& p, const Vec2& q) const;

  struct Data;
  const Data& data() const { return *this->Private; }

private:
  std::unique_ptr<Data> Private;
};

/// The search options.
struct MatchOptions
{
  ShapeEnergy energy;
  /// Solutions whose center is farther from the center of mass of the target than this times d_max
  /// are skipped in favor of the next best (dissertation equation 5.2). 0: the rule is off. The
  /// dissertation uses 1/3.
  double centreTolerance = 1.0 / 3.0;
  /// The maximum number of solutions to try for the rule; then the one with the minimum distance is
  /// used.
  Index maxSolutions = 1000;
  /// Whether to solve on a third of the locations first, then only around that solution; fast, not
  /// exact.
  bool coarseToFine = false;
  /// Whether to use bounds that skip placements that cannot be the best. The result is the same
  /// without them.
  bool bounds = true;
  /// The number of rotations of the source, by multiples of 360 / rotations degrees, that are
  /// tried; useful with energy.rotation.
  Index rotations = 1;
  /// The number of target sizes tried, odd: delta times 2^(k/2), k = -(n-1)/2 ... (n-1)/2; for
  /// images that show more than the shape, where d_max does not measure its size.
  Index scales = 1;
  int threads = 0; ///< 0: all cores. The result does not depend on it.
  /// seconds; 0: none. When it is reached, the best match so far is returned.
  double timeLimit = 0;
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

/// The anisotropy (alpha / beta + beta / alpha) / 2 of a triangle that is flat, or inverted where
/// that is forbidden. Its energy is finite, and larger than for any useful triangle.
constexpr float FlatAnisotropy = 1e6f;
/// The minimum area of a triangle that is not flat, as a fraction of the square of its perimeter.
constexpr float FlatArea = 1e-7f;
/// The minimum sum of edge lengths, in units of the target size.
constexpr float MinLength = 1e-6f;

/**
 * @brief Deformation, distortion and rotation of a map of a triangle, in double precision, from its
 * singular values.
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
  std::vector<Vec2> points; ///< positions of the source vertices in the target
  double energy = 0;        ///< E, all weighted terms
  double edge = 0;          ///< sum of E_edge
  double deformation = 0;   ///< sum of E_def
  double distortion = 0;    ///< sum of E_dis
  double rotation = 0;      ///< sum of 1 - cos(angle)
  double descriptor = 0;    ///< sum of squared differences
  double ordering = 0;      ///< sum of |log|
  std::vector<TriangleEnergy> triangles;
  Index rank = 1;            ///< of the chosen solution: 1 is the minimum energy
  double centreDistance = 0; ///< D, from the mean of the points to the center of mass of the target
  bool centreAccepted = true;
  bool mirrored = false; ///< whether the mirror image of the source was matched
  double angle = 0;      ///< rotation angle of the source, in degrees
  double scale = 1;      ///< factor on the expected size
  bool exact = true;     ///< no placement on the locations has a lower energy (rank 1)
  MatchStop stop = MatchStop::Complete;
};
}
#endif
