// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshPicture.h
 * @brief A picture of a mesh in the colours of its cells, drawn without a display.
 *
 * Planar meshes are seen along their normal, others from the front, the right and above, in
 * parallel projection. Of volume meshes the boundary is drawn. Cells that are highlighted are drawn
 * through what is in front of them, which is pale then: elements inside a solid are visible. Edges
 * are drawn where there is room for them.
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

/// A part of a picture; what it refers to must outlive it.
struct PicturePart
{
  const Mesh* mesh = nullptr;
  std::vector<Color> colors;     ///< one per cell
  std::vector<char> highlighted; ///< one per cell, nonzero: visible through others; may be empty
};

/// Rows from the top to the bottom, of pixels from the left to the right.
struct Picture
{
  int width = 0, height = 0;
  std::vector<unsigned char> rgb; ///< 3 * width * height
};

/**
 * @brief Draws the parts into one picture, as large as fits into it.
 * @param parts cells with a coordinate that is not finite are left out; may be empty
 * @param width, height pixels, 16 to 4096
 *
 * Without a cell the picture is white. The result does not depend on the number of threads. Throws
 * Error for another size, and for a part without a mesh or with another number of colours.
 */
TAUTLINEQUALITY_EXPORT Picture drawMeshes(
  const std::vector<PicturePart>& parts, int width, int height);
}
#endif
