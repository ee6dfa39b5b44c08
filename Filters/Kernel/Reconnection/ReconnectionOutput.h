// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReconnectionOutput.h
 * @brief The result of reconnection as arrays, and its relation to the input.
 * Internal: not installed.
 */
#ifndef tautline_ReconnectionOutput_h
#define tautline_ReconnectionOutput_h

#include "ReconnectionInput.h"
#include "ReconnectionResult.h"
#include "tautline/ReconnectionKernelExport.h"

namespace tautline
{
/// The input cells that a cell overlaps, with the common volumes.
using OverlapRow = std::vector<std::pair<std::int32_t, double>>;

/// Finds the tetrahedron of the input that contains a point, by walking from a nearby one.
class TAUTLINE_RECONNECTIONKERNEL_EXPORT InputLocator
{
public:
  /// @param mesh the input, before any change
  InputLocator(const TetrahedronMesh& mesh, const ReconnectionInput& input);

  /// The cell of the same region as `start` that contains x; if none does (because of rounding, or
  /// outside the mesh), the nearest of the visited cells.
  TetId locate(const Vec3& x, TetId start) const;
  /// The cell that contains x, of any region; if the path to it leaves the mesh, the nearest of the
  /// visited cells.
  TetId nearest(const Vec3& x, TetId start) const;
  /**
   * @brief The cells that a tetrahedron overlaps, and their common volumes, times 6. Empty if there
   * are none.
   * @param start a cell of its region, near it
   */
  OverlapRow overlaps(const std::array<Vec3, 4>& corners, TetId start) const;
  /// Barycentric coordinates of x.
  std::array<double, 4> weights(const Vec3& x, TetId cell) const;

private:
  TetId walk(const Vec3& x, TetId start, bool crosses, bool& found) const;
  TetId search(const Vec3& x, TetId start, bool crosses, std::size_t most) const;
  bool isWall(std::int32_t neighbor, TetId t) const;

  const ReconnectionInput& Input;
  std::vector<std::array<std::int32_t, 4>> Neighbors;
};

/// Whether a tetrahedron is an input tetrahedron with unmoved points.
bool isUnchanged(const ReconnectionInput& input, const TetrahedronMesh& changed, TetId t);

/// Sets ReconnectionResult::overlaps, and the original cells to those with the largest overlap,
/// from one row per output cell; an empty row stands for its original cell.
void takeOverlaps(std::vector<OverlapRow>& rows, ReconnectionResult& result);

/// Sets ReconnectionResult::overlaps, and the original cells to those with the largest overlap.
void computeOverlaps(const ReconnectionInput& input, const TetrahedronMesh& changed,
  const InputLocator& locator, int threads, ReconnectionResult& result);

/// Sets ReconnectionResult::facets and originalFacets: after convertOutput().
void convertFacets(const ReconnectionInput& input, const ReconnectionOptions& options,
  bool mirrored, const TetrahedronMesh& changed, ReconnectionResult& result);

/// Writes points, tetrahedra and their origins.
void convertOutput(const Mesh& mesh, const ReconnectionInput& input, const TetrahedronMesh& changed,
  const InputLocator& locator, int threads, ReconnectionResult& result);
}
#endif
