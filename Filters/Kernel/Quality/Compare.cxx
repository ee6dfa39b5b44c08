// SPDX-License-Identifier: BSD-3-Clause
#include "Compare.h"

#include <algorithm>

namespace tautline
{
namespace
{
std::string typeName(unsigned char vtkType)
{
  const CellType type = cornerType(vtkType);
  return type == CellType::Unsupported || isHigherOrder(vtkType)
    ? "cell of VTK type " + std::to_string(static_cast<int>(vtkType))
    : topology(type).name;
}

std::string idsOf(const MeshView& view, Index cell)
{
  std::string text;
  for (Index n = view.offsets[cell]; n < view.offsets[cell + 1]; ++n)
  {
    text += (text.empty() ? "" : " ") + std::to_string(view.connectivity[n]);
  }
  return text;
}

void add(ValueSummary& summary, const std::vector<double>& values)
{
  for (double value : values)
  {
    ++summary.count;
    summary.minimum = std::min(summary.minimum, value);
    summary.maximum = std::max(summary.maximum, value);
    summary.sum += value;
  }
}
}

//------------------------------------------------------------------------------
std::string connectivityDifference(const Mesh& before, const Mesh& after)
{
  const MeshView &a = before.view(), &b = after.view();
  if (a.numberOfPoints != b.numberOfPoints)
  {
    return "the first mesh has " + std::to_string(a.numberOfPoints) + " points, the second " +
      std::to_string(b.numberOfPoints);
  }
  if (a.numberOfCells != b.numberOfCells)
  {
    return "the first mesh has " + std::to_string(a.numberOfCells) + " cells, the second " +
      std::to_string(b.numberOfCells);
  }
  for (Index i = 0; i < a.numberOfCells; ++i)
  {
    if (a.cellTypes[i] != b.cellTypes[i])
    {
      return "cell " + std::to_string(i) + " is a " + typeName(a.cellTypes[i]) +
        " in the first mesh and a " + typeName(b.cellTypes[i]) + " in the second";
    }
    if (!std::equal(a.connectivity + a.offsets[i], a.connectivity + a.offsets[i + 1],
          b.connectivity + b.offsets[i], b.connectivity + b.offsets[i + 1]))
    {
      return "cell " + std::to_string(i) + " has the points " + idsOf(a, i) +
        " in the first mesh and " + idsOf(b, i) + " in the second";
    }
  }
  return "";
}

//------------------------------------------------------------------------------
void compareMetric(const MetricInfo& info, int dimension, const CellValues& before,
  const CellValues& after, double tolerance, signed char* change, MetricChange& total)
{
  const double ideal = info.ideal(dimension);
  // Changes are relative to the value or, near a unitless ideal value of 0, to 1.
  const double smallest = ideal == 0 && info.unit[0] == '\0' ? 1.0 : 0.0;
  const int sense = info.direction == Direction::LargerIsBetter ? 1
    : info.direction == Direction::SmallerIsBetter              ? -1
                                                                : 0;
  auto changeOf = [&](Index i)
  {
    const signed char was = before.validity[i], is = after.validity[i];
    // A change of validity takes precedence; values are only compared between elements of equal
    // validity.
    if (was != is)
    {
      return is > was ? 1 : -1;
    }
    const double low = before.values[i], high = after.values[i];
    // Inverted elements can only be compared by metrics that increase with the degree of inversion.
    const bool ordered = is == Valid || (is == Inverted && info.inverted == InvertedValue::Larger);
    const double magnitude = std::max({ std::abs(low), std::abs(high), smallest });
    return !ordered || std::abs(high - low) <= tolerance * magnitude ? 0
      : high > low                                                   ? sense
                                                                     : -sense;
  };
  for (Index i = 0; i < before.cells; ++i)
  {
    const CellType type = cornerType(before.cellTypes[i]);
    const bool counts =
      type != CellType::Unsupported && info.definedOn(type) && !(before.skip && before.skip[i]);
    change[i] = static_cast<signed char>(counts ? changeOf(i) : 0);
    total.better += change[i] > 0;
    total.worse += change[i] < 0;
    total.equal += counts && change[i] == 0;
  }
  add(total.before, measuredValues(info, before));
  add(total.after, measuredValues(info, after));
}
}
