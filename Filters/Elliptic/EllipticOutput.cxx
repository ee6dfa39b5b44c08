// SPDX-License-Identifier: BSD-3-Clause
#include "EllipticOutput.h"

#include "TableRows.h"

#include "vtkCellData.h"
#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cctype>
#include <limits>

namespace tautline
{
namespace
{
constexpr int StressSize = 6;
constexpr std::array<const char*, StressSize> TensorComponents = { "XX", "YY", "ZZ", "XY", "YZ",
  "XZ" };
}

//------------------------------------------------------------------------------
Index addArray(vtkDataSet* output, bool ofCells, const std::string& name,
  const std::vector<double>& values, int components)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name.c_str());
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()) / components);
  for (int k = 0; components == StressSize && k < StressSize; ++k)
  {
    array->SetComponentName(k, TensorComponents[k]);
  }
  Index missing = 0;
  for (std::size_t i = 0; i < values.size(); i += components)
  {
    const double* tuple = values.data() + i;
    const bool finite =
      std::all_of(tuple, tuple + components, [](double value) { return std::isfinite(value); });
    missing += !finite;
    for (int k = 0; k < components; ++k)
    {
      array->SetValue(static_cast<vtkIdType>(i) + k, finite ? tuple[k] : 0.0);
    }
  }
  vtkDataSetAttributes* data =
    ofCells ? static_cast<vtkDataSetAttributes*>(output->GetCellData()) : output->GetPointData();
  data->AddArray(array);
  data->SetActiveScalars(name.c_str());
  return missing;
}

//------------------------------------------------------------------------------
void addStress(vtkDataSet* output, const std::vector<double>& stresses)
{
  addArray(output, true, "Stress", stresses, StressSize);
  std::vector<double> mises;
  for (std::size_t i = 0; i + StressSize <= stresses.size(); i += StressSize)
  {
    const double* s = stresses.data() + i;
    const auto square = [](double x) { return x * x; };
    mises.push_back(
      std::sqrt(0.5 * (square(s[0] - s[1]) + square(s[1] - s[2]) + square(s[2] - s[0])) +
        3.0 * (square(s[3]) + square(s[4]) + square(s[5]))));
  }
  addArray(output, true, "VonMises", mises, 1);
}

//------------------------------------------------------------------------------
std::string sentence(std::string text)
{
  if (!text.empty())
  {
    text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
    text += text.back() == '.' ? "" : ".";
  }
  return text;
}

//------------------------------------------------------------------------------
void addResiduals(TableRows& rows, const std::vector<double>& residuals, const std::string& block)
{
  for (const double residual : residuals)
  {
    const double first = residuals.front() > 0 ? residuals.front() : 1.0;
    const double relative = std::isfinite(residual / first)
      ? std::max(residual / first, std::numeric_limits<double>::epsilon())
      : 1.0;
    rows.begin(block);
    rows.add("Log10 residual", std::log10(relative));
    rows.add("N residual", std::isfinite(residual) ? residual : 0.0);
  }
}
}
