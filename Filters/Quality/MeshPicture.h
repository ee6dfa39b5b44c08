// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshPicture.h
 * @brief Draws a picture of a mesh in the colors of its cells, without a display.
 *
 * Planar meshes are viewed along their normal, others from the front, right and above, in parallel
 * projection. Only the boundary of volume meshes is drawn. Highlighted cells are drawn through the
 * cells in front of them, which are then pale, so that elements inside a solid are visible. Edges
 * are drawn if there is enough space.
 */
#ifndef tautline_MeshPicture_h
#define tautline_MeshPicture_h

#include "TautlineQualityModule.h" // for export macro
#include "tautline/Mesh/Mesh.h"

#include <array>
#include <vector>

namespace tautline
{
/// Red, green and blue, 0 to 1.
using Color = std::array<double, 3>;

/// A part of a picture; the data that it refers to must outlive it.
struct PicturePart
{
  const Mesh* mesh = nullptr;
  std::vector<Color> colors;     ///< one per cell
  std::vector<char> highlighted; ///< one per cell, nonzero: visible through others; may be empty
};

/// Rows from top to bottom, with pixels from left to right.
struct Picture
{
  int width = 0, height = 0;
  std::vector<unsigned char> rgb; ///< 3 * width * height
};

/**
 * @brief Draws the parts into one picture, as large as possible.
 * @param parts cells with a coordinate that is not finite are left out; may be empty
 * @param width, height pixels, 16 to 4096
 *
 * Without cells the picture is white. The result does not depend on the number of threads. Throws
 * Error for an invalid size, and for a part without a mesh or with a wrong number of colors.
 */
TAUTLINEQUALITY_EXPORT Picture drawMeshes(
  const std::vector<PicturePart>& parts, int width, int height);
}
#endif
