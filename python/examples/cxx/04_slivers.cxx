// SPDX-License-Identifier: BSD-3-Clause
// 04_slivers [DATA]: three filters one after the other; the last one changes which points
// are joined.
#include <vtkMeshImprover.h>
#include <vtkMeshOptimizer.h>
#include <vtkMeshUntangler.h>
#include <vtkNew.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <iostream>
#include <string>

int main(int argc, char* argv[])
{
  const std::string data = argc > 1 ? argv[1] : "Data";
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName((data + "/bracket-tangled.vtu").c_str());
  vtkNew<vtkMeshUntangler> untangler;
  untangler->SetInputConnection(reader->GetOutputPort());
  vtkNew<vtkMeshOptimizer> optimizer;
  optimizer->SetInputConnection(untangler->GetOutputPort());
  vtkNew<vtkMeshImprover> improver;
  improver->SetInputConnection(optimizer->GetOutputPort());
  improver->Update();

  std::cout << "smallest dihedral angle " << improver->GetSmallestAngleBefore() << " to "
            << improver->GetSmallestAngleAfter() << "\n";
  return improver->GetSmallestAngleBefore() < 15 && improver->GetSmallestAngleAfter() > 15 ? 0 : 1;
}
