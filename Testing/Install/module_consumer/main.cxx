// SPDX-License-Identifier: BSD-3-Clause
#include <vtkCellType.h>
#include <vtkCellTypeSource.h>
#include <vtkDataSet.h>
#include <vtkElementQuality.h>
#include <vtkEllipticSolver.h>
#include <vtkMeshOptimizer.h>
#include <vtkMeshWarp.h>
#include <vtkNew.h>

#include <cstdlib>
#include <iostream>
#include <string>

int main()
{
  vtkNew<vtkCellTypeSource> source;
  source->SetCellType(VTK_TETRA);
  source->SetBlocksDimensions(2, 2, 2);
  vtkNew<vtkElementQuality> quality;
  quality->SetInputConnection(source->GetOutputPort());
  quality->Update();
  auto* mesh = vtkDataSet::SafeDownCast(quality->GetOutputDataObject(0));
  const vtkIdType cells = mesh ? mesh->GetNumberOfCells() : 0;
  std::cout << "measured " << cells << " tetrahedra\n";

  vtkNew<vtkMeshOptimizer> optimizer;
  optimizer->SetInputConnection(quality->GetOutputPort());
  optimizer->Update();
  std::cout << optimizer->GetSummary() << "\n";

  vtkNew<vtkMeshWarp> warp;
  warp->SetInputConnection(optimizer->GetOutputPort());
  warp->SetTransformKind(vtkMeshWarp::ROTATION);
  warp->SetAngle(30);
  warp->Update();
  std::cout << warp->GetSummary() << "\n";
  if (warp->GetInverted() != 0 || std::string(warp->GetSummary()).empty())
  {
    return EXIT_FAILURE;
  }

  vtkNew<vtkEllipticSolver> solver;
  solver->SetInputConnection(quality->GetOutputPort());
  solver->Update();
  std::cout << solver->GetSummary() << "\n";
  return cells > 0 && solver->GetConverged() && optimizer->GetStopReason() >= 0 ? EXIT_SUCCESS
                                                                                : EXIT_FAILURE;
}
