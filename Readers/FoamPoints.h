// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FoamPoints.h
 * @brief Writes the points of an OpenFOAM mesh back into its files.
 */
#ifndef tautline_FoamPoints_h
#define tautline_FoamPoints_h

#include "MeshFile.h"

namespace tautline
{
/// The new content of a file `points`, plain or compressed like the file.
struct FoamPointsContent
{
  std::string name; ///< with .gz if it is compressed
  std::string bytes;
  double rounding = 0.0; ///< the largest, with 4-byte numbers
};

/**
 * @brief The content of the file `points` of a directory polyMesh with other coordinates, in the
 * same format: text or binary, same width, compressed or not.
 *
 * Unchanged coordinates keep their bytes, and so does the rest of the file. In text files, new
 * coordinates are the shortest numbers that read back the same.
 *
 * Throws FileError if the number of points differs, or if a coordinate is not finite or too large
 * for numbers of 4 bytes.
 */
TAUTLINEREADERS_EXPORT FoamPointsContent withFoamPoints(
  const std::string& folder, const std::vector<double>& points);

/**
 * @brief Writes the points of a mesh to the files of its directories, either all of them or none.
 *
 * @param numbers for each processor directory, the number in the mesh of each of its points; empty
 * if the only directory has the points of the mesh
 * @param keepOriginal whether to keep a replaced file as points.orig, unless that exists
 * @param rounding set to the largest rounding error
 * @return the names of the files
 */
TAUTLINEREADERS_EXPORT std::vector<std::string> writeFoamPoints(
  const std::vector<std::string>& folders, const std::vector<std::vector<Index>>& numbers,
  const std::vector<double>& points, bool keepOriginal, double* rounding = nullptr);
}
#endif
