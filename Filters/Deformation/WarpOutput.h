// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpOutput.h
 * @brief The results of Warp Mesh as arrays, rows of tables and sentences.
 */
#ifndef tautline_WarpOutput_h
#define tautline_WarpOutput_h

#include "Blocks.h"
#include "MovedBoundary.h"
#include "TableRows.h"
#include "tautline/Deformation/Warp.h"

namespace tautline
{
/// What is known of a data set beside the result of the kernel.
struct WarpFacts
{
  std::string method;        ///< its name
  std::string motion;        ///< how the target corresponds, or ""
  bool coefficients = false; ///< whether the method has any
  double amount = 1.0;
  Index boundaryPoints = 0, movedPoints = 0;
  double largestDisplacement = 0.0; ///< of what is given, at the amount
  bool reused = false;
  double seconds = 0.0; ///< all of it
  int threads = 0;
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
  bool incomplete = false; ///< some did not come to the end of their motion
  double worstShape = 0.0;
  int reused = 0;
  std::string summary;
};

/**
 * @brief Gives the output the new points and the arrays `Displacement`, `TMP shape` (the active
 * scalars) and `Validity`, adds rows to the tables and to the totals.
 */
void addWarpOutput(const MovableMesh& rest, const WarpResult& result, const WarpFacts& facts,
  const InputBlock& block, TableRows& history, TableRows& statistics, WarpTotals& totals);

/// The part of it that adds the arrays; values of the shape are rounded to 0 in place.
void addWarpArrays(
  vtkDataSet* output, std::vector<double>& shape, const std::vector<signed char>& validity);

/**
 * @brief The part of it that adds rows and sentences.
 * @param notes further sentences; empty ones are left out
 */
void addWarpReport(const WarpResult& result, const WarpFacts& facts, const WarpQualities& qualities,
  const std::string& block, const std::vector<std::string>& notes, TableRows& history,
  TableRows& statistics, WarpTotals& totals);

/**
 * @brief The shape (4.22) of each cell against that before, with targets. Volumes are measured
 * range by range, as the targets of a cell need nine times the memory of its value.
 * @param values one per cell, filled
 */
void measureSimilarity(
  const Mesh& after, const Mesh& before, int threads, std::vector<double>& values);
}
#endif
