// SPDX-License-Identifier: BSD-3-Clause
// Condition Estimator: eigenvalues that are known, which element hurts, tables and messages.
#include "Registry.h"
#include "VtkMeshes.h"
#include "vtkConditionEstimator.h"

using namespace tautline;

namespace
{
vtkDataSet* meshOf(vtkConditionEstimator* filter)
{
  return outputOf(filter);
}

double sumOfCells(vtkDataSet* mesh, const char* name)
{
  return sumOf<double>(0, mesh->GetNumberOfCells(),
    [&](vtkIdType i) { return component(mesh->GetCellData(), name, i); });
}

/// The five-point matrix has eigenvalues 4 sin^2(i pi / 2n) + 4 sin^2(j pi / 2n), diagonal 4.
TAUTLINE_PART(testKnown)
{
  constexpr Index n = 12;
  const double condition = 1 / std::pow(std::tan(Pi / (2 * n)), 2);
  for (double scale : { 1.0, 1e-8, 1e8 })
  {
    const Context context(std::to_string(scale));
    MeshData data = blockMesh(CellType::Triangle, n, n, 0);
    for (double& x : data.points)
    {
      x *= scale;
    }
    vtkNew<vtkConditionEstimator> filter;
    Messages messages(filter);
    filter->SetInputData(toGrid(data));
    filter->SetPreconditioner(0); // Jacobi: the same ratio
    filter->Update();
    TAUTLINE_CHECK_RELATIVE(filter->GetCondition(), condition, 1e-6);
    TAUTLINE_CHECK_RELATIVE(filter->GetPreconditionedCondition(), condition, 1e-6);
    vtkTable* table = filter->GetSpectrum();
    TAUTLINE_CHECK_EQUAL(table->GetNumberOfRows(), 2);
    const double largest = 8 * std::pow(std::cos(Pi / (2 * n)), 2);
    TAUTLINE_CHECK_RELATIVE(table->GetValueByName(0, "Largest").ToDouble(), largest, 1e-6);
    TAUTLINE_CHECK_RELATIVE(table->GetValueByName(1, "Largest").ToDouble(), largest / 4, 1e-6);
    TAUTLINE_CHECK_EQUAL(table->GetValueByName(0, "Matrix").ToString(), "A");
    TAUTLINE_CHECK_EQUAL(table->GetValueByName(1, "Matrix").ToString(), "P^-1 A (Jacobi)");
    const double error = table->GetValueByName(0, "LargestError").ToDouble();
    TAUTLINE_CHECK(error >= 0 && error < 1e-5);
    TAUTLINE_CHECK_NEAR(sumOfCells(meshOf(filter), "Share"), 1, 1e-9);
    // A right triangle: half of (1 0 -1; 0 1 -1; -1 -1 2), largest eigenvalue 3/2.
    TAUTLINE_EACH(vtkIdType, i, meshOf(filter)->GetNumberOfCells(),
      TAUTLINE_CHECK_NEAR(
        component(meshOf(filter)->GetCellData(), "LargestEigenvalue", i), 1.5, 0.51));
    TAUTLINE_CHECK(messages.empty());

    TAUTLINE_SET(
      filter, SetMethod(vtkConditionEstimator::RITZ_VALUES), SetPreconditioner(6), Update());
    TAUTLINE_CHECK_EQUAL(filter->GetSpectrum()->GetNumberOfRows(), 1);
    TAUTLINE_CHECK_EQUAL(filter->GetSpectrum()->GetValueByName(0, "LargestError").ToDouble(), -1);
    TAUTLINE_CHECK(filter->GetCondition() <= condition * (1 + 1e-9));
    TAUTLINE_CHECK(filter->GetCondition() > 0.9 * condition);
    TAUTLINE_CHECK_EQUAL(filter->GetPreconditionedCondition(), 0);
    TAUTLINE_CHECK(messages.empty());
  }
}

/// One flat element has nearly all of the largest eigenvalue, and the summary names it.
TAUTLINE_PART(testCulprit)
{
  MeshData data = blockMesh(CellType::Triangle, 8, 8, 0);
  const Index point = 4 + 9 * 4; // the center moves next to an edge opposite to it
  data.setPoint(point, { 4.999, 4.4, 0 });
  const Mesh mesh(data.view());
  TAUTLINE_NEW(
    vtkConditionEstimator, filter, SetInputData(toGrid(data)), SetPreconditioner(6), Update());
  vtkIdType worst = 0;
  for (vtkIdType i = 0; i < data.numberOfCells(); ++i)
  {
    if (component(meshOf(filter)->GetCellData(), "Share", i) >
      component(meshOf(filter)->GetCellData(), "Share", worst))
    {
      worst = i;
    }
  }
  TAUTLINE_CHECK(filter->GetCondition() > 1000);
  TAUTLINE_CHECK(component(meshOf(filter)->GetCellData(), "Share", worst) > 0.3);
  bool touches = false;
  for (Index k = data.offsets[worst]; k < data.offsets[worst + 1]; ++k)
  {
    touches = touches || data.connectivity[k] == point;
  }
  TAUTLINE_CHECK(touches);
  const std::string summary = filter->GetSummary();
  TAUTLINE_CHECK(contains(summary, "\nElement " + std::to_string(worst) + " at ("));
  TAUTLINE_CHECK(contains(summary, wording("of-128-elements-have-90")));
  TAUTLINE_CHECK_EQUAL(
    std::string(meshOf(filter)->GetCellData()->GetScalars()->GetName()), "Excess");
  TAUTLINE_CHECK_NEAR(sumOfCells(meshOf(filter), "Excess"), 0, 1e-9);
  TAUTLINE_CHECK(component(meshOf(filter)->GetCellData(), "Excess", worst) > 1);

  TAUTLINE_SET(filter, SetComputeShares(false), Update());
  TAUTLINE_CHECK(!meshOf(filter)->GetCellData()->GetArray("Share"));
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("largest-eigenvalue")));
}

TAUTLINE_PART(testOthers)
{
  // Elasticity, blocks, and what is rejected.
  TAUTLINE_NEW(vtkMultiBlockDataSet, blocks,
    SetBlock(0, toGrid(blockMesh(CellType::Tetrahedron, 3, 3, 3))),
    SetBlock(1, toGrid(blockMesh(CellType::Hexahedron, 3, 3, 3))));
  vtkNew<vtkConditionEstimator> filter;
  Messages messages(filter);
  TAUTLINE_SET(filter, SetInputDataObject(blocks), SetEquation(vtkEllipticAlgorithm::ELASTICITY),
    SetPreconditioner(2), Update());
  TAUTLINE_CHECK(filter->GetPreconditionedCondition() >= 1);
  TAUTLINE_CHECK(filter->GetCondition() >= filter->GetPreconditionedCondition());
  TAUTLINE_CHECK_EQUAL(filter->GetSpectrum()->GetNumberOfRows(), 4);
  TAUTLINE_CHECK_EQUAL(filter->GetSpectrum()->GetValueByName(2, "Block").ToString(), "block 2");
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_SET(filter, SetTolerance(2), Update());
  TAUTLINE_CHECK(!messages.empty());
  messages.clear();
  TAUTLINE_SET(filter, SetTolerance(1e-6), SetPETScOptions("-nonsense"), Update());
  TAUTLINE_CHECK(messages.has("-nonsense"));
}
}
