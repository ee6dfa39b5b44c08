// SPDX-License-Identifier: BSD-3-Clause
// The filters of nonlocal models: arrays, tables, pictures, input of every kind, errors.
#include "HorizonMeshes.h"
#include "QuadraticMeshes.h"
#include "Registry.h"
#include "VtkMeshes.h"
#include "vtkDomainSource.h"
#include "vtkHorizonNeighbors.h"
#include "vtkInteractionLayer.h"
#include "vtkPeridynamicStiffness.h"

using namespace tautline;

namespace
{
vtkSmartPointer<vtkUnstructuredGrid> squareWithLayer(double h = 0.1, double layer = 0.2)
{
  TAUTLINE_NEW(vtkDomainSource, source, SetDomainByName("square"), SetElementSize(h),
    SetLayerWidth(layer), Update());
  return outputOf<vtkUnstructuredGrid>(source);
}

vtkSmartPointer<vtkUnstructuredGrid> bareSquare(int n, bool slanted, int precision = VTK_DOUBLE)
{
  MeshData data = blockMesh(CellType::Triangle, n, n, 0);
  data.transform(
    [&](const Vec3& p)
    {
      const Vec3 q = (1.0 / n) * p;
      return slanted ? Vec3{ 1.0 + 0.6 * q[0], q[1], 2.0 + 0.8 * q[0] } : q;
    });
  return toGrid(data, precision);
}

double column(vtkAlgorithm* filter, const char* name)
{
  auto* table = vtkTable::SafeDownCast(filter->GetOutputDataObject(1));
  return table->GetValueByName(0, name).ToDouble();
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testStiffness)
{
  const auto mesh = squareWithLayer();
  TAUTLINE_NEW(vtkPeridynamicStiffness, filter, SetInputData(mesh), SetSparsityPixels(40),
    SetSolve(true), Update());
  TAUTLINE_CHECK_RELATIVE(filter->GetCondition(), 9.2827, 1e-3);
  TAUTLINE_CHECK_EQUAL(column(filter, "Condition"), filter->GetCondition());
  TAUTLINE_CHECK_EQUAL(column(filter, "Rows"), 81.0);
  TAUTLINE_CHECK_EQUAL(column(filter, "Definite"), 1.0);
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("condition-number-9-28")));

  vtkPointData* points = filter->GetOutput()->GetPointData();
  auto* unknown = vtkUnsignedCharArray::SafeDownCast(points->GetArray("Unknown"));
  auto* neighbors = vtkIntArray::SafeDownCast(points->GetArray("Neighbors"));
  auto* diagonal = vtkDoubleArray::SafeDownCast(points->GetArray("Diagonal"));
  auto* sum = vtkDoubleArray::SafeDownCast(points->GetArray("RowSum"));
  auto* solution = vtkDoubleArray::SafeDownCast(points->GetArray("Solution"));
  auto* mode = vtkDoubleArray::SafeDownCast(points->GetArray("SmallestMode"));
  TAUTLINE_CHECK(points->GetArray("LargestMode") != nullptr);
  double entries = 0.0, square = 0.0, highest = 0.0;
  for (vtkIdType i = 0; i < unknown->GetNumberOfTuples(); ++i)
  {
    double p[3];
    mesh->GetPoint(i, p);
    const bool inside = p[0] > 1e-6 && p[0] < 1 - 1e-6 && p[1] > 1e-6 && p[1] < 1 - 1e-6;
    TAUTLINE_CHECK_EQUAL(unknown->GetValue(i) != 0, inside);
    TAUTLINE_CHECK_EQUAL(diagonal->GetValue(i) > 0.0, inside);
    TAUTLINE_CHECK_EQUAL(solution->GetValue(i) > 0.0, inside);
    TAUTLINE_CHECK(sum->GetValue(i) > -1e-9);
    entries += inside ? neighbors->GetValue(i) + 1 : 0;
    square += mode->GetValue(i) * mode->GetValue(i);
    highest = std::max(highest, solution->GetValue(i));
  }
  TAUTLINE_CHECK_EQUAL(entries, column(filter, "Nonzeros"));
  TAUTLINE_CHECK_NEAR(square, 1.0, 1e-9);
  // About the Laplacian's with factor pi / 6: 0.0737 / (pi / 6) = 0.141, or more.
  TAUTLINE_CHECK(highest > 0.13 && highest < 0.25);
  auto* picture = vtkImageData::SafeDownCast(filter->GetOutputDataObject(2));
  TAUTLINE_CHECK_EQUAL(picture->GetNumberOfPoints(), 1600);
  double pixels = sumOf<double>(0.0, picture->GetNumberOfPoints(),
    [&](vtkIdType i) { return picture->GetPointData()->GetScalars()->GetTuple1(i); });
  TAUTLINE_CHECK_EQUAL(pixels, entries);

  // Constants and discontinuous functions are on cells; the elastic model has vectors in space.
  TAUTLINE_SET(filter, SetBasis(vtkPeridynamicStiffness::PIECEWISE_CONSTANT), Update());
  TAUTLINE_CHECK_RELATIVE(filter->GetCondition(), 16.0772, 1e-3);
  TAUTLINE_CHECK(filter->GetOutput()->GetCellData()->GetArray("Solution") != nullptr);
  TAUTLINE_CHECK(filter->GetOutput()->GetPointData()->GetArray("Solution") == nullptr);
  TAUTLINE_SET(filter, SetBasis(vtkPeridynamicStiffness::DISCONTINUOUS_LINEAR), Update());
  TAUTLINE_CHECK_EQUAL(
    filter->GetOutput()->GetCellData()->GetArray("Solution")->GetNumberOfComponents(), 3);
  TAUTLINE_SET(filter, SetBasis(vtkPeridynamicStiffness::PIECEWISE_LINEAR), ElasticOn(), Update());
  TAUTLINE_CHECK_EQUAL(
    filter->GetOutput()->GetPointData()->GetArray("Solution")->GetNumberOfComponents(), 3);
  TAUTLINE_CHECK_EQUAL(column(filter, "Rows"), 162.0);
}

//------------------------------------------------------------------------------
/// u = 1 + x in the interaction layer and no source: u = 1 + x everywhere.
TAUTLINE_PART(testGiven)
{
  const auto mesh = squareWithLayer();
  vtkNew<vtkDoubleArray> given, onCells;
  given->SetName("g");
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    given->InsertNextValue(1.0 + mesh->GetPoint(i)[0]);
  }
  mesh->GetPointData()->AddArray(given);
  TAUTLINE_SET(onCells, SetName("cells"), SetNumberOfTuples(mesh->GetNumberOfCells()), Fill(0.0));
  mesh->GetCellData()->AddArray(onCells);
  TAUTLINE_NEW(vtkPeridynamicStiffness, filter, SetInputData(mesh), SetSolve(true),
    SetUniformSource(0.0), SetComputeSpectrum(false),
    SetInputArrayToProcess(2, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "g"), Update());
  vtkDataArray* solution = filter->GetOutput()->GetPointData()->GetArray("Solution");
  TAUTLINE_EACH(vtkIdType, i, mesh->GetNumberOfPoints(),
    TAUTLINE_CHECK_NEAR(solution->GetTuple1(i), given->GetValue(i), 2e-4));
  TAUTLINE_CHECK(filter->GetOutput()->GetPointData()->GetArray("SmallestMode") == nullptr);
  TAUTLINE_SET(filter,
    SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "cells"),
    SetUniformSource(7.0), Update());
  TAUTLINE_CHECK_NEAR(filter->GetOutput()->GetPointData()->GetArray("Solution")->GetTuple1(112),
    given->GetValue(112), 2e-4);
  filter->SetInputArrayToProcess(2, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "cells");
  TAUTLINE_CHECK(contains(errorOf(filter), wording("needs-one-on-points")));
}

//------------------------------------------------------------------------------
/// A mesh in any plane, of any precision, of any class; and its interaction layer.
TAUTLINE_PART(testInteractionLayer)
{
  double first = 0.0;
  for (const bool slanted : { false, true })
  {
    for (const int precision : { VTK_DOUBLE, VTK_FLOAT })
    {
      const auto bare = bareSquare(8, slanted, precision);
      TAUTLINE_NEW(vtkInteractionLayer, layer, SetInputData(bare), SetWidth(0.25));
      TAUTLINE_NEW(vtkPeridynamicStiffness, filter, SetInputConnection(layer->GetOutputPort()),
        SetHorizon(0.25), Update());
      first = first > 0.0 ? first : filter->GetCondition();
      TAUTLINE_CHECK_RELATIVE(filter->GetCondition(), first, 2e-4);
      vtkUnstructuredGrid* made = layer->GetOutput();
      vtkDataArray* reference = made->GetCellData()->GetArray("Reference");
      TAUTLINE_EACH(vtkIdType, cell, made->GetNumberOfCells(),
        TAUTLINE_CHECK_EQUAL(reference->GetTuple1(cell), cell < bare->GetNumberOfCells() ? 1 : 2));
      for (vtkIdType i = 0; i < made->GetNumberOfPoints(); ++i)
      {
        double p[3];
        made->GetPoint(i, p);
        // In the plane of the input.
        TAUTLINE_CHECK_NEAR(slanted ? 0.8 * (p[0] - 1.0) - 0.6 * (p[2] - 2.0) : p[2], 0.0, 1e-6);
      }
    }
  }
  vtkNew<vtkPeridynamicStiffness> filter;
  MeshData data = blockMesh(CellType::Triangle, 4, 4, 0);
  TAUTLINE_SET(filter, SetInputData(toPolyData(data)), SetHorizon(1.5), ConstrainedOff(), Update());
  TAUTLINE_CHECK(vtkPolyData::SafeDownCast(filter->GetOutput()) != nullptr);
  TAUTLINE_CHECK_EQUAL(filter->GetCondition(), 0.0);
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("null-space")));
  vtkNew<vtkUnstructuredGrid> empty;
  TAUTLINE_SET(filter, SetInputData(empty), Update());
  TAUTLINE_CHECK_EQUAL(filter->GetOutput()->GetNumberOfCells(), 0);
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testNeighbors)
{
  TAUTLINE_NEW(vtkHorizonNeighbors, filter, SetInputData(squareWithLayer()),
    SetCenter(0.43, 0.51, 0.0), Update());
  vtkCellData* cells = filter->GetOutput()->GetCellData();
  double area = 0.0, chord = 0.0;
  int seen[4] = {};
  for (vtkIdType i = 0; i < filter->GetOutput()->GetNumberOfCells(); ++i)
  {
    area += cells->GetArray("Area")->GetTuple1(i);
    chord += cells->GetArray("ChordArea")->GetTuple1(i);
    ++seen[static_cast<int>(cells->GetArray("Case")->GetTuple1(i))];
  }
  TAUTLINE_CHECK_RELATIVE(area, M_PI * 0.04, 1e-12);
  TAUTLINE_CHECK(chord < area && chord > 0.9 * area);
  TAUTLINE_CHECK(seen[1] > 5 && seen[2] > 5 && seen[3] > 5);
  auto* circle = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(1));
  auto* pieces = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(2));
  TAUTLINE_CHECK_EQUAL(circle->GetNumberOfLines(), 1);
  TAUTLINE_CHECK_EQUAL(pieces->GetNumberOfCells(), seen[1] + 2 * seen[2] + seen[3]);
  filter->SetHorizon(-1.0);
  TAUTLINE_CHECK(contains(errorOf(filter), wording("horizon-has-to-be-above-0")));
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testErrors)
{
  const auto check = [](vtkAlgorithm* filter, const char* text)
  {
    const std::string error = errorOf(filter);
    if (!TAUTLINE_CHECK(contains(error, text)))
    {
      std::cerr << "  the error is: " << error << ", expected: " << text << "\n";
    }
    TAUTLINE_CHECK_EQUAL(outputOf(filter)->GetNumberOfCells(), 0);
  };
  TAUTLINE_NEW(vtkPeridynamicStiffness, filter, SetInputData(bareSquare(4, false)));
  check(filter, "add it with Interaction Layer");
  TAUTLINE_SET(filter, SetInputData(squareWithLayer()), SetHorizon(0.3));
  check(filter, "an interaction layer of width 0.3 is needed");
  TAUTLINE_SET(filter, AllowThinLayerOn(), Update());
  TAUTLINE_CHECK_RELATIVE(column(filter, "LayerDeficit"), 0.1, 1e-9);
  TAUTLINE_SET(filter, AllowThinLayerOff(), SetHorizon(0.2), SetExponent(4.0));
  check(filter, "to below 4");
  filter->SetExponent(1.0);
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "absent");
  check(filter, "no array 'absent'");
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "Reference");
  filter->SetMemoryLimit(0.01);
  check(filter, "MiB are allowed");
  TAUTLINE_SET(filter, SetMemoryLimit(0.0), SetTimeLimit(1e-9));
  check(filter, "time limit");
  filter->SetTimeLimit(0.0);
  filter->SetInputData(toGrid(blockMesh(CellType::Quadrilateral, 3, 3, 0)));
  check(filter, "9 cells that are not triangles (quadrilateral): run Tetrahedralize first");
  filter->SetInputData(toGrid(blockMesh(CellType::Tetrahedron, 2, 2, 2)));
  check(filter, "that are not triangles (tetrahedron)");
  filter->SetInputData(toGrid(quadraticOf(blockMesh(CellType::Triangle, 2, 2, 0))));
  check(filter, "8 curved cells");
  MeshData curved = blockMesh(CellType::Triangle, 4, 4, 0);
  curved.transform(TAUTLINE_PLACE(p[0], p[1], p[0] * p[1]));
  filter->SetInputData(toGrid(curved));
  check(filter, "do not lie in a plane");
  TAUTLINE_NEW(vtkInteractionLayer, layer, SetInputData(toGrid(curved)));
  check(layer, "do not lie in a plane");
  TAUTLINE_SET(layer, SetInputData(bareSquare(4, false)), SetWidth(0.0));
  check(layer, "above 0");
}
}
