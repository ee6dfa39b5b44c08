// SPDX-License-Identifier: BSD-3-Clause
// 02_untangle [DATA]: untangles the bracket and writes after.vtu.
#include <vtkMeshUntangler.h>
#include <vtkNew.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <iostream>
#include <string>

int main(int argc, char* argv[])
{
  const std::string data = argc > 1 ? argv[1] : "Data";
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName((data + "/bracket-tangled.vtu").c_str());

  vtkNew<vtkMeshUntangler> untangler;
  untangler->SetInputConnection(reader->GetOutputPort());
  untangler->Update();
  std::cout << untangler->GetInvertedBefore() << " inverted before, "
            << untangler->GetInvertedAfter() << " after\n";

  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputConnection(untangler->GetOutputPort());
  writer->SetFileName("after.vtu");
  const bool written = writer->Write() == 1;
  return written && untangler->GetInvertedBefore() == 41 && untangler->GetInvertedAfter() == 0 ? 0
                                                                                               : 1;
}
