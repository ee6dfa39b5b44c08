// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpOutput.h
 * @brief Writes the results of Warp Mesh as arrays, rows of tables and sentences.
 */
#ifndef tautline_WarpOutput_h
#define tautline_WarpOutput_h

#include "Blocks.h"
#include "MovedBoundary.h"
#include "TableRows.h"
#include "tautline/Deformation/Warp.h"

namespace tautline
{
/// Facts on a data set in addition to the result of the kernel.
struct WarpFacts
{
  std::string method;        ///< its name
  std::string motion;        ///< the correspondence of the target, or ""
  bool coefficients = false; ///< whether the method has coefficients
  double amount = 1.0;
  Index boundaryPoints = 0, movedPoints = 0;
  double largestDisplacement = 0.0; ///< of the given displacements, scaled by the amount
  bool reused = false;
  double seconds = 0.0; ///< total
  int threads = 0;
  Index following = 0; ///< nodes between the corners of curved cells
};

/// A metric over a mesh.
struct WarpMeasurement
{
  double worst = 0, mean = 0;
};

/// The elements before and after.
struct WarpQualities
{
  WarpMeasurement shape, before, after;
  Index elements = 0, inverted = 0;
};

/// Totals over the data sets.
struct WarpTotals
{
  Index invertedAfterWarp = 0, inverted = 0, impossible = 0;
  bool incomplete = false; ///< some did not complete their motion
  double worstShape = 0.0;
  int reused = 0;
  std::string summary;
};

/**
 * @brief Gives the output the new points and the arrays `Displacement`, `TMP shape` (the active
 * scalars) and `Validity`, and adds rows to the tables and to the totals. For a mesh in pieces, the
 * numbers cover the whole mesh, the rows are added on the first process, and the memory of the mesh
 * and of the points is freed; collective.
 */
void addWarpOutput(MovableMesh& rest, WarpResult& result, const WarpFacts& facts,
  const InputBlock& block, TableRows& history, TableRows& statistics, WarpTotals& totals);
}
#endif
