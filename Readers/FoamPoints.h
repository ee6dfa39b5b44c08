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
/// The new content of a file `points`, plain or compressed as the file is.
struct FoamPointsContent
{
  std::string name; ///< with .gz if it is compressed
  std::string bytes;
  double rounding = 0.0; ///< the largest, by numbers of 4 bytes
};

/**
 * @brief The content of the file `points` of a directory polyMesh with other coordinates, in its
 * format: text or binary, of the same width, compressed or not.
 *
 * Coordinates that are equal to those in the file stay as they are, with all other bytes. New ones
 * are in text the shortest numbers that read back the same.
 *
 * Throws FileError if the number of points differs, or if a coordinate is not finite or too large
 * for numbers of 4 bytes.
 */
TAUTLINEREADERS_EXPORT FoamPointsContent withFoamPoints(
  const std::string& folder, const std::vector<double>& points);

/**
 * @brief Writes the points of a mesh into the files of its directories, all of them or none.
 *
 * @param numbers of each directory of processors, the number in the mesh of each of its points;
 * empty where the only directory has the points of the mesh
 * @param keepOriginal whether a file that is replaced is kept as points.orig, unless there is one
 * @param rounding the largest
 * @return the names of the files
 */
TAUTLINEREADERS_EXPORT std::vector<std::string> writeFoamPoints(
  const std::vector<std::string>& folders, const std::vector<std::vector<Index>>& numbers,
  const std::vector<double>& points, bool keepOriginal, double* rounding = nullptr);
}
#endif
