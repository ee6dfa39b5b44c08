// SPDX-License-Identifier: BSD-3-Clause
#include "ImproverReport.h"

#include "TableRows.h"
#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <utility>

namespace tautline
{
namespace
{
constexpr int ListedElements = 10;

/// In the order of ReconnectionObstacle.
using Reasons = std::array<const char*, 6>;
constexpr Reasons obstacles = { "it is not below the target",
  "no operation improves it, or a limit ended the run",
  "one of its facets on the boundary or between regions allows no better element",
  "it has a fixed point", "it has a point between regions", "it has a point on the boundary" };

/// The remedies, in the same order.
constexpr Reasons remedies = { "", "try the preset Aggressive, a larger time limit or other counts",
  "allow the boundary to slide on flat parts or on the surface, or repair the surface mesh",
  "fix fewer points", "choose fewer regions",
  "allow the boundary to slide on flat parts or on the surface" };
/// The same if the boundary slides on flat parts, and if it slides on the surface.
constexpr Reasons remediesOfSliding = { "", remedies[1],
  "allow the boundary to slide on the surface, or repair the surface mesh", remedies[3],
  remedies[4], "allow the boundary to slide on the surface" };
constexpr Reasons remediesOnSurface = { "", remedies[1], "repair the surface mesh", remedies[3],
  remedies[4], "choose a larger Feature Angle, or repair the surface mesh" };

/// The same for triangles.
constexpr Reasons edgeObstacles = { "it is not below the target",
  "no operation improves it, or a limit ended the run",
  "the angle between two kept edges allows no better element", "it has a fixed point",
  "it has a point between regions or on a sharp edge", "it has a point on the border" };
constexpr Reasons edgeRemedies = { "",
  "try the preset Aggressive, a larger time limit, other counts or, on a surface, a larger surface "
  "distance",
  "change the geometry", "fix fewer points",
  "allow the boundary to slide on flat parts, choose fewer regions or a larger feature angle",
  "allow the boundary to slide on flat parts" };
constexpr Reasons edgeRemediesOfSliding = { "", edgeRemedies[1], edgeRemedies[2], edgeRemedies[3],
  "choose fewer regions or a larger feature angle", "change the geometry" };

/// The names of the elements and of their angles.
struct Words
{
  const char *one, *many, *title, *angle;
  const Reasons& obstacles;
};
constexpr Words tetrahedra = { "tetrahedron", "tetrahedra", "Tetrahedra", "dihedral angle",
  obstacles };
constexpr Words triangles = { "triangle", "triangles", "Triangles", "angle", edgeObstacles };

const Words& wordsOf(bool isTriangles)
{
  return isTriangles ? triangles : tetrahedra;
}

/// The remedies for the given freedom of the boundary.
const Reasons& remediesFor(bool isTriangles, BoundaryMotion boundary)
{
  const bool fixed = boundary == BoundaryMotion::Fixed;
  if (isTriangles)
  {
    return fixed ? edgeRemedies : edgeRemediesOfSliding;
  }
  return fixed                              ? remedies
    : boundary == BoundaryMotion::FlatParts ? remediesOfSliding
                                            : remediesOnSurface;
}

/// "12 edge removals, 3 motions of points"
std::string describeOperations(const ReconnectionRecord& record)
{
  const std::array<std::pair<Index, const char*>, 6> operations = { {
    { record.edgeRemovals, "edge removals" },
    { record.faceRemovals, "face removals" },
    { record.boundarySwaps, "boundary swaps" },
    { record.contractions, "contractions" },
    { record.insertions, "insertions" },
    { record.moves, "motions of points" },
  } };
  std::string text;
  for (const auto& [count, name] : operations)
  {
    if (count > 0)
    {
      text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + name;
    }
  }
  return text.empty() ? "none" : text;
}
}

//------------------------------------------------------------------------------
const char* reasonText(StopReason reason)
{
  switch (reason)
  {
    case StopReason::Reduction:
      return "Every element has reached the target.";
    case StopReason::NoProgress:
      return "No operation improves the worst elements further.";
    default:
      return describe(reason);
  }
}

//------------------------------------------------------------------------------
double inverseMeanRatioOf(const ReconnectionRecord& record, bool isTriangles)
{
  // The quality is (mean ratio)^(3/2) for tetrahedra, and the mean ratio for triangles.
  constexpr double largest = 1e30; // for a flat element
  const double q = record.worstQuality;
  return q > 0.0 ? std::min(isTriangles ? 1.0 / q : 1.0 / std::cbrt(q * q), largest) : largest;
}

//------------------------------------------------------------------------------
std::vector<RemainingElement> remainingOf(const std::vector<signed char>& obstacles,
  const std::vector<double>& qualities, const std::vector<double>& bounds,
  const ImprovedCells& improved, Index first)
{
  constexpr auto none = static_cast<signed char>(ReconnectionObstacle::None);
  std::vector<RemainingElement> remaining;
  remaining.reserve(obstacles.size() - std::count(obstacles.begin(), obstacles.end(), none));
  for (std::size_t i = 0; i < obstacles.size(); ++i)
  {
    pollInterruption(static_cast<Index>(i));
    if (obstacles[i] != none)
    {
      remaining.push_back(
        { first + static_cast<Index>(i), improved.smallestAngles[i], improved.inverseMeanRatios[i],
          improved.centers[i], qualities[i], bounds[i], obstacles[i] });
    }
  }
  return remaining;
}

//------------------------------------------------------------------------------
void sortWorstFirst(std::vector<RemainingElement>& remaining)
{
  std::sort(remaining.begin(), remaining.end(),
    [](const RemainingElement& a, const RemainingElement& b)
    {
      return a.smallestAngle != b.smallestAngle ? a.smallestAngle < b.smallestAngle
                                                : a.cell < b.cell;
    });
}

//------------------------------------------------------------------------------
void addHistory(TableRows& rows, const std::vector<ReconnectionRecord>& history,
  const std::string& block, bool adapted)
{
  for (const ReconnectionRecord& record : history)
  {
    const auto add = [&rows](const char* column, auto value)
    { rows.add(column, static_cast<double>(value)); };
    rows.begin(block);
    add("Smallest angle", record.smallestAngle);
    add("Largest angle", record.largestAngle);
    add("Worst imr", record.worstInverseMeanRatio);
    add("N elements", record.tetrahedra);
    add("N below target", record.belowTarget);
    add("N edge removals", record.edgeRemovals);
    add("N face removals", record.faceRemovals);
    add("N boundary swaps", record.boundarySwaps);
    add("N contractions", record.contractions);
    add("N insertions", record.insertions);
    add("N moves", record.moves);
    if (adapted)
    {
      add("Edges in range", record.edgesInRange);
      add("Worst quality in metric", record.worstQuality);
    }
    add("Time (s)", record.seconds);
  }
}

//------------------------------------------------------------------------------
void addRemaining(TableRows& rows, const std::vector<RemainingElement>& remaining, bool isTriangles,
  const std::string& block)
{
  const std::size_t n = remaining.size();
  if (n == 0)
  {
    return;
  }
  // Column by column: collecting rows of cells in arbitrary order is slow, and there may be many.
  rows.begin();
  if (!block.empty())
  {
    rows.addManyTexts("Block", n, [&](std::size_t) { return block; });
  }
  const auto add = [&](const char* column, auto member)
  {
    rows.addMany(
      column, n, [&](std::size_t i) { return static_cast<double>(remaining[i].*member); });
  };
  add("Cell", &RemainingElement::cell);
  add("Smallest angle", &RemainingElement::smallestAngle);
  add("imr", &RemainingElement::inverseMeanRatio);
  constexpr std::array<const char*, 3> axes = { "X", "Y", "Z" };
  for (std::size_t c = 0; c < axes.size(); ++c)
  {
    rows.addMany(axes[c], n, [&](std::size_t i) { return remaining[i].center[c]; });
  }
  add("Quality", &RemainingElement::quality);
  add("Quality bound", &RemainingElement::bound);
  const Words& words = wordsOf(isTriangles);
  rows.addManyTexts(
    "Reason", n, [&](std::size_t i) { return words.obstacles[remaining[i].obstacle]; });
}

//------------------------------------------------------------------------------
std::string describeResult(const ReconnectionResult& result, bool isTriangles)
{
  const Words& words = wordsOf(isTriangles);
  const ReconnectionRecord &first = result.history.front(), &last = result.history.back();
  std::ostringstream text;
  text << (result.adapted && result.reason == StopReason::NoProgress
              ? "The lengths of the edges no longer improve."
              : reasonText(result.reason))
       << "\n"
       << words.title << ": " << first.tetrahedra << " to " << last.tetrahedra << ". Smallest "
       << words.angle << ": " << first.smallestAngle << " to " << last.smallestAngle
       << " degrees; largest: " << first.largestAngle << " to " << last.largestAngle
       << ". Worst inverse mean ratio: " << first.worstInverseMeanRatio << " to "
       << last.worstInverseMeanRatio << ".";
  if (result.meanAfter > 0.0)
  {
    text << " Mean: " << result.meanBefore << " to " << result.meanAfter << ".";
  }
  if (result.adapted)
  {
    constexpr double percent = 100.0;
    text << "\nEdges with lengths from 0.71 to 1.41 times the target: "
         << percent * first.edgesInRange << " to " << percent * last.edgesInRange
         << " %. Worst inverse mean ratio in the metric: " << inverseMeanRatioOf(first, isTriangles)
         << " to " << inverseMeanRatioOf(last, isTriangles) << ".";
  }
  text << "\nOperations: " << describeOperations(last) << ".";
  if (result.markedFacets > 0)
  {
    text << "\nFacets inside the mesh that triangles mark, and that are kept: "
         << result.markedFacets << ".";
  }
  if (result.ignoredMarks > 0)
  {
    text << "\n"
         << result.ignoredMarks << (isTriangles ? " lines" : " triangles")
         << " beside the mesh are left out: they are not among its "
         << (isTriangles ? "edges" : "facets") << ", or are duplicates.";
  }
  if (result.volumeBefore != 0.0)
  {
    text << "\n";
    if (!isTriangles)
    {
      text << "Largest distance between the boundaries of the output and the input: "
           << result.boundaryDistance << ". ";
    }
    text << "Volume: " << result.volumeBefore << " to " << result.volumeAfter << ".";
  }
  return text.str();
}

//------------------------------------------------------------------------------
std::string describeRemaining(const std::vector<RemainingElement>& remaining, bool isTriangles,
  BoundaryMotion boundary, double targetAngle)
{
  const Reasons& helps = remediesFor(isTriangles, boundary);
  const Words& words = wordsOf(isTriangles);
  std::ostringstream text, target;
  if (targetAngle > 0.0)
  {
    target << " of " << targetAngle << " degrees";
  }
  else
  {
    target << " in the metric";
  }
  if (remaining.empty())
  {
    text << "No " << words.one << " remains below the target" << target.str() << ".";
    return text.str();
  }
  text << remaining.size() << " " << (remaining.size() == 1 ? words.one : words.many)
       << (remaining.size() == 1 ? " remains" : " remain") << " below the target" << target.str();
  const auto byShape = std::count_if(remaining.begin(), remaining.end(),
    [targetAngle](const RemainingElement& one) { return one.smallestAngle >= targetAngle; });
  // The quality of an element also depends on its largest angle and, by objective, on its shape.
  text << (byShape == 0 || targetAngle == 0.0
              ? ""
              : ", " + std::to_string(byShape) + " of them because of a large angle or their shape")
       << ":";
  std::array<Index, obstacles.size()> counts = {};
  for (const RemainingElement& element : remaining)
  {
    ++counts[element.obstacle];
  }
  for (std::size_t k = 0; k < obstacles.size(); ++k)
  {
    if (counts[k] > 0)
    {
      text << "\n- " << counts[k] << ": " << words.obstacles[k] << " (" << helps[k] << ")";
    }
  }
  const auto listed = std::min<std::size_t>(remaining.size(), ListedElements);
  for (std::size_t i = 0; i < listed; ++i)
  {
    const RemainingElement& element = remaining[i];
    const Vec3& at = element.center;
    text << "\nElement " << element.cell << " at (" << at[0] << ", " << at[1] << ", " << at[2]
         << "): smallest " << words.angle << " " << element.smallestAngle << ", inverse mean ratio "
         << element.inverseMeanRatio << "; " << words.obstacles[element.obstacle] << ".";
  }
  if (remaining.size() > listed)
  {
    text << "\n... and " << remaining.size() - listed << " more: see the output Remaining.";
  }
  return text.str();
}

//------------------------------------------------------------------------------
std::string describeForced(
  const std::vector<RemainingElement>& remaining, bool isTriangles, double forcedInverseMeanRatio)
{
  if (remaining.empty())
  {
    return "";
  }
  std::ostringstream text;
  text << "With the " << (isTriangles ? "edges" : "facets")
       << " of its boundary and between regions, no mesh has a worst inverse mean ratio below "
       << forcedInverseMeanRatio << ".";
  return text.str();
}
}
