// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImproverReport.h
 * @brief The report of Improve Mesh: the tables and the sentences of the summary.
 */
#ifndef tautline_ImproverReport_h
#define tautline_ImproverReport_h

#include "ImprovedCells.h"
#include "tautline/Reconnection/Reconnection.h"

#include <string>
#include <vector>

namespace tautline
{
/// The input arrays of Improve Mesh.
namespace ImproverArrays
{
constexpr int Fixed = 0, Region = 1, Size = 2, Changing = 3;
}

class TableRows;

/// An element below the target. Sent between processes as bytes.
struct RemainingElement
{
  Index cell; ///< in the output
  double smallestAngle, inverseMeanRatio;
  Vec3 center;
  double quality, bound;
  Index obstacle; ///< a ReconnectionObstacle
};

/**
 * @brief The elements below the target.
 * @param obstacles,qualities,bounds one per cell, as in ReconnectionResult
 * @param first the number of the first cell
 */
std::vector<RemainingElement> remainingOf(const std::vector<signed char>& obstacles,
  const std::vector<double>& qualities, const std::vector<double>& bounds,
  const ImprovedCells& improved, Index first = 0);
/// Sorts the elements, with the smallest angle first.
void sortWorstFirst(std::vector<RemainingElement>& remaining);

/// The remarks on a run in the summary.
struct ImproverRemarks
{
  std::string block;                      ///< or ""
  std::string rounds;                     ///< a sentence on the work of several processes, or ""
  std::string precision, leftOut, notice; ///< sentences, or ""
  bool triangles;
  double targetAngle;
};

/// The largest inverse mean ratio in the metric, after an adaptation: from the smallest quality.
double inverseMeanRatioOf(const ReconnectionRecord& record, bool isTriangles);

/// The reason why a run ended.
const char* reasonText(StopReason reason);

/// Adds the rows of output History. @param adapted whether they are of an adaptation
void addHistory(TableRows& rows, const std::vector<ReconnectionRecord>& history,
  const std::string& block, bool adapted);
/// Adds the rows of output Remaining. @param isTriangles whether the elements are triangles,
/// otherwise tetrahedra
void addRemaining(TableRows& rows, const std::vector<RemainingElement>& remaining, bool isTriangles,
  const std::string& block);

/// Sentences on the qualities before and after.
std::string describeResult(const ReconnectionResult& result, bool isTriangles);
/// Sentences on the elements below the target, the reasons, and the worst of them.
/// @param targetAngle in degrees; 0 after an adaptation, whose target is a quality in the metric
std::string describeRemaining(const std::vector<RemainingElement>& remaining, bool isTriangles,
  BoundaryMotion boundary, double targetAngle);
/// A sentence on the bound that the boundary imposes on any mesh, if elements remain below the
/// target.
std::string describeForced(
  const std::vector<RemainingElement>& remaining, bool isTriangles, double forcedInverseMeanRatio);
}
#endif
