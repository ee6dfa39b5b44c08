// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CoordinateFrame.h
 * @brief Coordinates of extreme size or far from the origin, and the frame used for computing with
 * them.
 *
 * Double precision holds lengths from 1e-308 to 1e308, but the square of a volume only for lengths
 * from 1e-51 to 1e51. Measuring functions scale each cell individually (Metrics.h). Functions that
 * move points or assemble matrices support cells of SmallestExtent to LargestExtent;
 * requireOrdinaryScale() rejects others. A CoordinateFrame converts a mesh to this range and back.
 *
 *     const tautline::CoordinateFrame frame(tautline::coordinateRange(view));
 *     std::vector<double> points(view.points, view.points + 3 * view.numberOfPoints);
 *     frame.enter(points);
 *     view.points = points.data();                     // ... move the points ...
 *     frame.leave(points);
 */
#ifndef tautline_CoordinateFrame_h
#define tautline_CoordinateFrame_h

#include "CellExtent.h"
#include "tautline/Core/Types.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace tautline
{
struct MeshView;

/// The location and size of the cells of a mesh, from at most 1000 cells evenly spread over the
/// mesh.
struct TAUTLINE_KERNEL_EXPORT CoordinateRange
{
  double extent = 0; ///< median of the longest extents along an axis; 0: none
  Vec3 low = { 0, 0, 0 }, high = { 0, 0, 0 }; ///< the box around the cells
  /// The largest absolute coordinate.
  double farthest() const;
  /**
   * @brief The spacing of consecutive floating-point numbers at the largest coordinate.
   * @param singlePrecision 24 bits, as in float; otherwise 53
   */
  double spacing(bool singlePrecision) const;
};

/// Cells with a coordinate that is not finite and cells without extent are ignored.
TAUTLINE_KERNEL_EXPORT CoordinateRange coordinateRange(const MeshView& view);

/**
 * @class tautline::CoordinateFrame
 * @brief An origin and a unit of length such that cells have ordinary size and are near the origin.
 *
 * It is the identity unless needed. The unit is a power of two: 1 for cells of SmallestExtent to
 * LargestExtent. The origin is 0 along each axis along which the mesh is not far away: farther than
 * 2^20 cells and 2^10 times its own extent. Entering a frame is then exact; leaving it rounds to
 * the precision of coordinates that far from the origin.
 */
class TAUTLINE_KERNEL_EXPORT CoordinateFrame
{
public:
  CoordinateFrame() = default;
  /// @param shifted off: the origin is not shifted
  explicit CoordinateFrame(const CoordinateRange& range, bool shifted = true);

  const Vec3& origin() const { return this->Origin; }
  double unit() const { return this->Unit; }
  bool isIdentity() const { return this->Unit == 1 && this->Origin == Vec3{ 0, 0, 0 }; }

  /// Converts coordinates of a mesh to this frame, and back; in place, 3 per point.
  void enter(std::vector<double>& points) const;
  void leave(std::vector<double>& points) const;

private:
  Vec3 Origin = { 0, 0, 0 };
  double Unit = 1;
};

/**
 * @brief Throws Error if the typical cell is not between SmallestExtent and LargestExtent long.
 * @param work the operation, used as the subject of the message: "Untangling"
 */
TAUTLINE_KERNEL_EXPORT void requireOrdinaryScale(const MeshView& view, const std::string& work);
}
#endif
