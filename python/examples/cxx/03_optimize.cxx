// SPDX-License-Identifier: BSD-3-Clause
// 03_optimize [DATA]: perturbs the plate, optimizes it, and reads the statistics, a table with a
// row per metric.
#include <vtkMeshOptimizer.h>
#include <vtkMeshPerturbation.h>
#include <vtkNew.h>
#include <vtkTable.h>
#include <vtkVariant.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <iostream>
#include <string>

int main(int argc, char* argv[])
{
  const std::string data = argc > 1 ? argv[1] : "Data";
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName((data + "/plate.vtu").c_str());

  vtkNew<vtkMeshPerturbation> perturbation;
  perturbation->SetInputConnection(reader->GetOutputPort());
  perturbation->SetFraction(0.5); // of the distance to inversion
  perturbation->SetSeed(7);

  vtkNew<vtkMeshOptimizer> optimizer; // its default is the mean shape
  optimizer->SetInputConnection(perturbation->GetOutputPort());
  optimizer->Update();

  const double before = optimizer->GetStatistics()->GetValueByName(0, "WorstBefore").ToDouble();
  const double after = optimizer->GetStatistics()->GetValueByName(0, "WorstAfter").ToDouble();
  std::cout << "worst inverse mean ratio " << before << " to " << after << " in "
            << optimizer->GetIterations() << " iterations\n";
  return before > 1 && after <= before ? 0 : 1;
}
