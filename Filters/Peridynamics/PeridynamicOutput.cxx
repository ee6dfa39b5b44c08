// SPDX-License-Identifier: BSD-3-Clause
#include "PeridynamicOutput.h"

#include "tautline/Peridynamics/Dilatation.h"

#include "vtkCellData.h"
#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkTable.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{
/// The destination of a function's values: a tuple of a point or cell array, and the first
/// component.
struct Place
{
  vtkIdType tuple;
  int corner;
};

bool onPoints(PeridynamicBasis basis)
{
  return basis == PeridynamicBasis::Linear;
}

int functionsPerTuple(PeridynamicBasis basis)
{
  return basis == PeridynamicBasis::DiscontinuousLinear ? 3 : 1;
}

Place placeOf(const HorizonInput& input, PeridynamicBasis basis, Index function)
{
  switch (basis)
  {
    case PeridynamicBasis::Linear:
      return { static_cast<vtkIdType>(function), 0 };
    case PeridynamicBasis::Constant:
      return { input.cell(function), 0 };
    default:
      return { input.cell(function / 3), static_cast<int>(function % 3) };
  }
}

template <class Array>
vtkSmartPointer<Array> makeArray(
  const char* name, PeridynamicBasis basis, int components, vtkDataSet* output)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfComponents(functionsPerTuple(basis) * components);
  array->SetNumberOfTuples(
    onPoints(basis) ? output->GetNumberOfPoints() : output->GetNumberOfCells());
  array->Fill(0);
  if (onPoints(basis))
  {
    output->GetPointData()->AddArray(array);
  }
  else
  {
    output->GetCellData()->AddArray(array);
  }
  return array;
}

std::vector<double> tupleOf(
  const HorizonInput& input, Index components, vtkDataArray* array, vtkIdType i)
{
  if (components == 1)
  {
    return { array->GetComponent(i, 0) };
  }
  const bool space = array->GetNumberOfComponents() > 2;
  const Vec3 v = { array->GetComponent(i, 0), array->GetComponent(i, 1),
    space ? array->GetComponent(i, 2) : 0.0 };
  if (!space)
  {
    return { v[0], v[1] };
  }
  const auto p = input.project(v);
  return { p[0], p[1] };
}

/// A column with one row.
template <class Array, class Value>
void addColumn(const char* name, Value value, vtkTable* table)
{
  vtkNew<Array> column;
  column->SetName(name);
  column->InsertNextValue(value);
  table->AddColumn(column);
}

void checkComponents(Index components, vtkDataArray* array)
{
  const int has = array->GetNumberOfComponents();
  if (components == 1 ? has != 1 : has != 2 && has != 3)
  {
    throw Error("the array '" + std::string(array->GetName()) + "' has " + std::to_string(has) +
      " components; " + (components == 1 ? "one is" : "two or three are") + " expected");
  }
}
}

//------------------------------------------------------------------------------
void addRowData(const PeridynamicResult& result, vtkDataSet* output)
{
  const PeridynamicSystem& system = result.system;
  const auto c = static_cast<int>(system.components);
  const auto unknown = makeArray<vtkUnsignedCharArray>("Unknown", result.basis, 1, output);
  const auto neighbors = makeArray<vtkIntArray>("Neighbors", result.basis, 1, output);
  const auto sum = makeArray<vtkDoubleArray>("RowSum", result.basis, c, output);
  const auto diagonal = makeArray<vtkDoubleArray>("Diagonal", result.basis, c, output);
  const SparseMatrix& a = system.matrix;
  for (std::size_t u = 0; u < system.functionOf.size(); ++u)
  {
    const Place place = placeOf(result.input, result.basis, system.functionOf[u]);
    unknown->SetComponent(place.tuple, place.corner, 1);
    for (int i = 0; i < c; ++i)
    {
      const Index row = static_cast<Index>(u) * c + i;
      double total = 0.0;
      Index functions = 0, last = -1;
      for (Index k = a.offsets[row]; k < a.offsets[row + 1]; ++k)
      {
        total += a.values[k];
        functions += a.columns[k] / c != last;
        last = a.columns[k] / c;
      }
      neighbors->SetComponent(place.tuple, place.corner, static_cast<double>(functions - 1));
      sum->SetComponent(place.tuple, place.corner * c + i, total);
      diagonal->SetComponent(place.tuple, place.corner * c + i, a.at(row, row));
    }
  }
  for (vtkDataArray* array :
    std::initializer_list<vtkDataArray*>{ unknown, neighbors, sum, diagonal })
  {
    if (onPoints(result.basis))
    {
      result.input.spread(array);
    }
  }
}

//------------------------------------------------------------------------------
void addRowVector(const PeridynamicResult& result, const std::vector<double>& values,
  const char* name, const std::vector<double>* given, vtkDataSet* output)
{
  const Index c = result.system.components;
  const int width = c == 1 ? 1 : 3;
  const auto array = makeArray<vtkDoubleArray>(name, result.basis, width, output);
  for (std::size_t f = 0; f < result.system.unknownOf.size(); ++f)
  {
    const Index u = result.system.unknownOf[f];
    if (u < -1 || (u < 0 && !given))
    {
      continue;
    }
    const double* from = u >= 0 ? values.data() + c * u : given->data() + c * static_cast<Index>(f);
    const Place place = placeOf(result.input, result.basis, static_cast<Index>(f));
    const Vec3 v = c == 1 ? Vec3{ from[0], 0, 0 } : result.input.liftVector(from[0], from[1]);
    for (int i = 0; i < width; ++i)
    {
      array->SetComponent(place.tuple, place.corner * width + i, v[i]);
    }
  }
  if (onPoints(result.basis))
  {
    result.input.spread(array);
  }
}

//------------------------------------------------------------------------------
void addStrain(const PeridynamicResult& result, const PeridynamicOptions& options,
  const std::vector<double>& solution, const std::vector<double>* given, vtkDataSet* output)
{
  constexpr std::size_t components = 2;
  std::vector<double> values(components * result.system.unknownOf.size(), 0.0);
  if (given)
  {
    values = *given;
  }
  for (std::size_t u = 0; u < result.system.functionOf.size(); ++u)
  {
    const auto f = static_cast<std::size_t>(result.system.functionOf[u]);
    std::copy_n(&solution[components * u], components, &values[components * f]);
  }
  const PeridynamicStrain strain = peridynamicStrain(result.input.mesh(), options, values);
  const auto dilatation =
    makeArray<vtkDoubleArray>("Dilatation", PeridynamicBasis::Constant, 1, output);
  const auto energy =
    makeArray<vtkDoubleArray>("EnergyDensity", PeridynamicBasis::Constant, 1, output);
  for (std::size_t t = 0; t < strain.dilatation.size(); ++t)
  {
    const vtkIdType cell = result.input.cell(static_cast<Index>(t));
    dilatation->SetValue(cell, strain.dilatation[t]);
    energy->SetValue(cell, strain.energyDensity[t]);
  }
}

//------------------------------------------------------------------------------
std::vector<double> onFunctions(const HorizonInput& input, PeridynamicBasis basis, Index components,
  vtkDataArray* array, bool arrayOnPoints)
{
  checkComponents(components, array);
  const HorizonMesh& mesh = input.mesh();
  std::vector<double> values;
  const auto append = [&](const std::vector<double>& v)
  { values.insert(values.end(), v.begin(), v.end()); };
  const auto at = [&](Index i)
  { return tupleOf(input, components, array, static_cast<vtkIdType>(i)); };
  if (basis == PeridynamicBasis::Linear)
  {
    if (!arrayOnPoints)
    {
      throw Error("the array '" + std::string(array->GetName()) +
        "' is a cell array; the continuous linear basis needs a point array: run Cell Data to "
        "Point Data");
    }
    for (Index i = 0; i < mesh.numberOfPoints(); ++i)
    {
      append(at(i));
    }
    return values;
  }
  for (Index t = 0; t < mesh.numberOfTriangles(); ++t)
  {
    std::vector<double> mean(static_cast<std::size_t>(components), 0.0);
    for (int k = 0; k < 3; ++k)
    {
      const auto v = at(arrayOnPoints ? mesh.triangles[3 * t + k] : input.cell(t));
      for (std::size_t i = 0; i < mean.size(); ++i)
      {
        mean[i] += v[i] / 3.0;
      }
      if (basis == PeridynamicBasis::DiscontinuousLinear)
      {
        append(v);
      }
    }
    if (basis == PeridynamicBasis::Constant)
    {
      append(mean);
    }
  }
  return values;
}

//------------------------------------------------------------------------------
std::vector<double> onMesh(
  const HorizonInput& input, Index components, vtkDataArray* array, bool arrayOnPoints)
{
  return onFunctions(input, arrayOnPoints ? PeridynamicBasis::Linear : PeridynamicBasis::Constant,
    components, array, arrayOnPoints);
}

//------------------------------------------------------------------------------
void fillSpectrum(const PeridynamicSystem& system, const Spectrum* spectrum, vtkTable* table)
{
  const auto real = [table](const char* name, double value)
  { addColumn<vtkDoubleArray>(name, value, table); };
  const auto whole = [table](const char* name, Index value)
  { addColumn<vtkTypeInt64Array>(name, value, table); };
  const Spectrum none;
  const Spectrum& s = spectrum ? *spectrum : none;
  real("Condition", s.condition);
  real("Smallest", s.smallest);
  real("Largest", s.largest);
  real("SmallestBound", s.smallestBound);
  real("LargestBound", s.largestBound);
  whole("Definite", s.definite);
  whole("Converged", s.converged);
  whole("Iterations", s.iterations);
  whole("Rows", system.matrix.size);
  whole("Nonzeros", system.matrix.nonzeros());
  real("Asymmetry", system.asymmetry);
  real("LayerDeficit", system.layerDeficit);
  whole("IntegratedPairs", system.integratedPairs);
  real("Memory", system.memory);
}

//------------------------------------------------------------------------------
void addSolveReport(const SolveReport& report, vtkTable* table)
{
  addColumn<vtkTypeInt64Array>("SolverIterations", report.iterations, table);
  addColumn<vtkDoubleArray>("SolverResidual", report.residual, table);
  addColumn<vtkTypeInt64Array>("SolverConverged", report.converged, table);
  const bool known = report.ritzSmallest > 0.0;
  addColumn<vtkDoubleArray>(
    "PreconditionedCondition", known ? report.ritzLargest / report.ritzSmallest : 0.0, table);
}

//------------------------------------------------------------------------------
void drawSparsity(const SparseMatrix& matrix, int pixels, vtkImageData* image)
{
  const Index n = std::min<Index>(matrix.size, pixels);
  image->SetDimensions(static_cast<int>(n), static_cast<int>(n), 1);
  vtkNew<vtkFloatArray> counts;
  counts->SetName("Entries");
  counts->SetNumberOfTuples(static_cast<vtkIdType>(n * n));
  counts->Fill(0.0);
  for (Index row = 0; row < matrix.size; ++row)
  {
    const Index y = n - 1 - row * n / matrix.size; // the first row on top
    for (Index k = matrix.offsets[row]; k < matrix.offsets[row + 1]; ++k)
    {
      const Index x = matrix.columns[k] * n / matrix.size;
      const auto at = static_cast<vtkIdType>(y * n + x);
      counts->SetValue(at, counts->GetValue(at) + 1.0f);
    }
  }
  image->GetPointData()->SetScalars(counts);
}
}
