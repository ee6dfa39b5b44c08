// SPDX-License-Identifier: BSD-3-Clause
#include "SizeField.h"

#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStaticPointLocator.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
//------------------------------------------------------------------------------
std::function<double(double, double)> makeSizeField(
  const std::vector<double>& points, const std::vector<double>& sizes, double gradation)
{
  // The locator computes squares, so it searches at a scale where they neither overflow nor vanish.
  double largest = 0.0;
  for (const double x : points)
  {
    largest = std::max(largest, std::abs(x));
  }
  int exponent = 0;
  std::frexp(largest, &exponent);
  auto scaled = vtkSmartPointer<vtkPoints>::New();
  scaled->SetDataType(VTK_DOUBLE);
  for (std::size_t i = 0; i + 1 < points.size(); i += 2)
  {
    scaled->InsertNextPoint(
      std::ldexp(points[i], -exponent), std::ldexp(points[i + 1], -exponent), 0.0);
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(scaled);
  auto locator = vtkSmartPointer<vtkStaticPointLocator>::New();
  locator->SetDataSet(data);
  locator->BuildLocator();
  return [=](double x, double y)
  {
    const double place[] = { std::ldexp(x, -exponent), std::ldexp(y, -exponent), 0.0 };
    const auto nearest =
      static_cast<std::size_t>(std::max<vtkIdType>(0, locator->FindClosestPoint(place)));
    const double dx = points[2 * nearest] - x, dy = points[2 * nearest + 1] - y;
    return sizes[nearest] + gradation * std::hypot(dx, dy);
  };
}
}
