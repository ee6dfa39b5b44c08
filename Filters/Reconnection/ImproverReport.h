// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImproverReport.h
 * @brief What Improve Mesh reports: the tables and the sentences of the summary.
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

/// An element that is still below the target. Sent between processes as bytes.
struct RemainingElement
{
  Index cell; ///< of the output
  double smallestAngle, inverseMeanRatio;
  Vec3 center;
  double quality, bound;
  Index obstacle; ///< a ReconnectionObstacle
};

/**
 * @brief The elements below the target.
 * @param obstacles,qualities,bounds one per cell, as those of ReconnectionResult
 * @param first the number of the first cell
 */
std::vector<RemainingElement> remainingOf(const std::vector<signed char>& obstacles,
  const std::vector<double>& qualities, const std::vector<double>& bounds,
  const ImprovedCells& improved, Index first = 0);
/// Sorts them: the smallest angle first.
void sortWorstFirst(std::vector<RemainingElement>& remaining);

/// What the summary says of a run.
struct ImproverRemarks
{
  std::string block;                      ///< or ""
  std::string rounds;                     ///< a sentence on the work of several processes, or ""
  std::string precision, leftOut, notice; ///< sentences, or ""
  bool triangles;
  double targetAngle;
};

/// The largest inverse mean ratio in the metric, after an adaptation: of the smallest quality.
double inverseMeanRatioOf(const ReconnectionRecord& record, bool isTriangles);

/// Why a run ended.
const char* reasonText(StopReason reason);

/// Adds the rows of output History. @param adapted whether they are of an adaptation
void addHistory(TableRows& rows, const std::vector<ReconnectionRecord>& history,
  const std::string& block, bool adapted);
/// Adds the rows of output Remaining. @param isTriangles whether the elements are; else tetrahedra
void addRemaining(TableRows& rows, const std::vector<RemainingElement>& remaining, bool isTriangles,
  const std::string& block);

/// Before and after, in words.
std::string describeResult(const ReconnectionResult& result, bool isTriangles);
/// What remains below the target, why, and which are the worst.
/// @param targetAngle in degrees; 0 after an adaptation, whose target is a quality in the metric
std::string describeRemaining(const std::vector<RemainingElement>& remaining, bool isTriangles,
  BoundaryMotion boundary, double targetAngle);
/// What the boundary forces on any mesh, if something remains.
std::string describeForced(
  const std::vector<RemainingElement>& remaining, bool isTriangles, double forcedInverseMeanRatio);
}
#endif
