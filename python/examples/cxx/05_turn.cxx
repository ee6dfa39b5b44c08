// SPDX-License-Identifier: BSD-3-Clause
// 05_turn [DATA]: turns the hole of the plate by 120 degrees with two methods.
#include <vtkMeshWarp.h>
#include <vtkNew.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <iostream>
#include <string>

int main(int argc, char* argv[])
{
  const std::string data = argc > 1 ? argv[1] : "Data";
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName((data + "/plate.vtu").c_str());
  vtkNew<vtkMeshWarp> warp;
  warp->SetInputConnection(reader->GetOutputPort());
  warp->SetMotion(vtkMeshWarp::TRANSFORM);
  warp->SetTransformKind(vtkMeshWarp::ROTATION);
  warp->SetAngle(120); // the inner boundaries, about their middle

  warp->SetMethod(vtkMeshWarp::FEMWARP);
  warp->Update();
  const vtkIdType plain = warp->GetInverted();
  warp->SetMethod(vtkMeshWarp::HYBRID);
  warp->Update();
  std::cout << "inverted: " << plain << " by FEMWARP, " << warp->GetInverted()
            << " by the hybrid method\n";
  return plain > 0 && warp->GetInverted() == 0 ? 0 : 1;
}
