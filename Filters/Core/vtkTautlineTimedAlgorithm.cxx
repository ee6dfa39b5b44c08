// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTautlineTimedAlgorithm.h"

//------------------------------------------------------------------------------
vtkTautlineTimedAlgorithm::vtkTautlineTimedAlgorithm() = default;

//------------------------------------------------------------------------------
vtkTautlineTimedAlgorithm::~vtkTautlineTimedAlgorithm() = default;

//------------------------------------------------------------------------------
void vtkTautlineTimedAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "TimeLimit: " << this->TimeLimit << "\n";
}
