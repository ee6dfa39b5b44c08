// SPDX-License-Identifier: BSD-3-Clause
// Time steps of Solve PDE that are shown one after the other: one assembly for all of them.
#include "Registry.h"
#include "VtkMeshes.h"
#include "vtkEllipticSolver.h"

using namespace tautline;

namespace
{
/// Another time step is shown without an assembly; a change of a property or the input is not.
TAUTLINE_PART(testTimeSteps)
{
  vtkNew<vtkMultiBlockDataSet> blocks; // a system each
  blocks->SetBlock(0, toGrid(blockMesh(CellType::Triangle, 6, 6, 0)));
  MeshData far = blockMesh(CellType::Triangle, 4, 4, 0);
  for (double& x : far.points)
  {
    x += 5.0;
  }
  blocks->SetBlock(1, toGrid(far));
  const auto at = [](vtkEllipticSolver* filter, double time)
  {
    filter->UpdateTimeStep(time);
    auto* data = outputOf<vtkMultiBlockDataSet>(filter);
    std::vector<double> both;
    for (unsigned int i = 0; i < 2; ++i)
    {
      vtkDataArray* array =
        vtkDataSet::SafeDownCast(data->GetBlock(i))->GetPointData()->GetArray("Solution");
      for (vtkIdType k = 0; TAUTLINE_CHECK(array) && k < array->GetNumberOfTuples(); ++k)
      {
        both.push_back(array->GetComponent(k, 0));
      }
    }
    return both;
  };
  TAUTLINE_NEW(vtkEllipticSolver, filter, SetInputData(blocks),
    SetTimeScheme(vtkEllipticSolver::BDF2), SetTimeStep(0.01), SetNumberOfTimeSteps(4));
  const std::vector<double> last = at(filter, 0.04), first = at(filter, 0.01);
  TAUTLINE_CHECK_EQUAL(filter->GetAssemblies(), 2);
  TAUTLINE_CHECK(last != first && at(filter, 0.04) == last);
  TAUTLINE_CHECK_EQUAL(filter->GetAssemblies(), 2);
  filter->SetSourceValue(2.0);
  const std::vector<double> doubled = at(filter, 0.01);
  TAUTLINE_CHECK_EQUAL(filter->GetAssemblies(), 4);
  TAUTLINE_CHECK_NEAR(doubled[24] / first[24], 2.0, 1e-5);
  // ParaView copies the input at each time step; the arrays are the same ones.
  const auto copy = [](vtkDataObject* leaf)
  {
    TAUTLINE_NEW(vtkUnstructuredGrid, result, ShallowCopy(leaf));
    return vtkSmartPointer<vtkUnstructuredGrid>(result);
  };
  blocks->SetBlock(0, copy(blocks->GetBlock(0)));
  blocks->SetBlock(1, copy(blocks->GetBlock(1)));
  TAUTLINE_CHECK(at(filter, 0.01) == doubled);
  TAUTLINE_CHECK_EQUAL(filter->GetAssemblies(), 4);
  vtkPoints* points = vtkUnstructuredGrid::SafeDownCast(blocks->GetBlock(1))->GetPoints();
  TAUTLINE_SET(points, SetPoint(0, 5.0, -0.25, 0.0), Modified());
  blocks->Modified();
  TAUTLINE_CHECK(at(filter, 0.01) != doubled);
  TAUTLINE_CHECK_EQUAL(filter->GetAssemblies(), 6);
}
}
