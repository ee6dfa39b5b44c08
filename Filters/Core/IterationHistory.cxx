// SPDX-License-Identifier: BSD-3-Clause
#include "IterationHistory.h"

#include <algorithm>
#include <sstream>

namespace tautline
{
namespace
{
/// "Objective: 12 to 8", or "Objectives: 12 to 8, 3 to 2". Several are listed individually, because
/// the scalarized objective of the lexicographic method differs between its stages.
std::string objectivesPhrase(const IterationRecord& first, const IterationRecord& last)
{
  std::ostringstream text;
  const std::size_t count = std::min(first.objectives.size(), last.objectives.size());
  if (count < 2)
  {
    text << "Objective: " << first.objective << " to " << last.objective;
    return text.str();
  }
  text << "Objectives: ";
  for (std::size_t i = 0; i < count; ++i)
  {
    text << (i == 0 ? "" : ", ") << first.objectives[i] << " to " << last.objectives[i];
  }
  return text.str();
}

bool isConverged(StopReason reason)
{
  return reason == StopReason::GradientNorm || reason == StopReason::RelativeChange;
}
}

//------------------------------------------------------------------------------
void addHistory(TableRows& rows, const std::vector<IterationRecord>& history,
  const std::vector<std::string>& names, const std::string& block)
{
  const auto at = [](const std::vector<double>& values, std::size_t i)
  { return i < values.size() ? values[i] : 0.0; };
  for (const IterationRecord& record : history)
  {
    rows.begin(block);
    rows.add("Objective", record.objective);
    for (std::size_t i = 0; i < names.size(); ++i)
    {
      if (names.size() > 1)
      {
        rows.add(names[i] + " objective", at(record.objectives, i));
      }
      rows.add(names[i] + " mean", at(record.mean, i));
      rows.add(names[i] + " worst", at(record.worst, i));
    }
    rows.add("Inverted", static_cast<double>(record.inverted));
    rows.add("N gradient", record.gradientNorm);
    rows.add("N moving", static_cast<double>(record.moving));
    rows.add("Time (s)", record.seconds);
  }
}

//------------------------------------------------------------------------------
std::string summarize(
  const OptimizeResult& result, const MovableMesh& mesh, const std::string& block, double diagonal)
{
  std::ostringstream text;
  text << (block.empty() ? "" : "In " + block + ": ") << describe(result.reason) << "\n";
  text << result.iterations << " iterations";
  if (!result.history.empty())
  {
    const IterationRecord &first = result.history.front(), &last = result.history.back();
    text << ", " << last.seconds << " s. " << objectivesPhrase(first, last);
  }
  text << ".\n"
       << result.freeVertices << " of " << mesh.allPoints()
       << " points were free to move.\nInverted elements: " << result.invertedBefore << " before, "
       << result.invertedAfter << " after, of " << mesh.allCells()
       << (!result.untangled              ? "."
              : result.invertedAfter == 0 ? "; it was untangled first."
                                          : "; untangling came first and left some inverted.");
  if (result.newlyInvalid > 0)
  {
    text << "\nUntangling has inverted or collapsed " << result.newlyInvalid
         << (result.newlyInvalid == 1 ? " valid element" : " valid elements") << ".";
  }
  if (result.withoutNormal > 0)
  {
    text << "\n"
         << result.withoutNormal
         << (result.withoutNormal == 1 ? " element has no area: its points stayed"
                                       : " elements have no area: their points stayed")
         << ", because the direction in which it would open is undefined. Run Improve Mesh to "
            "remove such triangles.";
  }
  if (result.restored > 0)
  {
    text << "\n"
         << result.restored << (result.restored == 1 ? " point" : " points")
         << " were moved back: an element there would be worse than the worst one of the input.";
  }
  if (result.unchanged)
  {
    text << "\nThe result is " << (result.untangled ? "the untangled mesh" : "the input")
         << (isConverged(result.reason)
                ? ": the small remaining reduction of the objective would make the worst element "
                  "worse or more elements invalid."
                : ": no mesh with a smaller objective was found without a worse worst element or "
                  "more invalid elements.");
  }
  const bool larger =
    !result.history.empty() && result.history.back().objective > result.history.front().objective;
  text << (result.worstFirst && larger
      ? "\nThe worst element had priority: the objective is larger than in the input."
      : "");
  text << surfaceErrorSentence(result.surfaceError, diagonal);
  if (result.leftSurface > 0)
  {
    text << "\n"
         << result.leftSurface << (result.leftSurface == 1 ? " point" : " points")
         << " of the boundary near the worst elements left the surface, within Surface Tolerance. "
            "Switch Leave Surface off to keep them on it.";
  }
  if (result.heldOnSurface + result.heldOnInterfaces > 0)
  {
    const auto points = [](Index n, const char* of)
    { return std::to_string(n) + (n == 1 ? " point" : " points") + of; };
    const bool both = result.heldOnSurface > 0 && result.heldOnInterfaces > 0;
    text << "\nSurface Tolerance holds "
         << (result.heldOnSurface > 0 ? points(result.heldOnSurface, " of the boundary") : "")
         << (both ? " and " : "")
         << (result.heldOnInterfaces > 0 ? points(result.heldOnInterfaces, " of interfaces") : "")
         << ": their last steps went too far from the surface. A larger tolerance, or 0, allows "
            "them to "
            "slide farther.";
  }
  return text.str();
}

//------------------------------------------------------------------------------
std::string distanceText(double distance, double diagonal)
{
  std::ostringstream text;
  text << distance;
  if (diagonal > 0)
  {
    constexpr double percent = 100.0;
    text.precision(2);
    text << ", " << percent * distance / diagonal << " % of the diagonal of the bounding box";
  }
  return text.str();
}

//------------------------------------------------------------------------------
std::string surfaceErrorSentence(double surfaceError, double diagonal)
{
  return surfaceError > 0 ? "\nLargest distance of the elements from the surface: " +
      distanceText(surfaceError, diagonal) + "."
                          : "";
}

//------------------------------------------------------------------------------
std::string invalidSentence(Index before, Index after)
{
  return after == 0 ? ""
                    : std::to_string(after) + (after == 1 ? " element is" : " elements are") +
      " inverted or degenerate (" + std::to_string(before) + " before).";
}
}
