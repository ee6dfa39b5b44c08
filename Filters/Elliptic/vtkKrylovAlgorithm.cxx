// SPDX-License-Identifier: BSD-3-Clause
#include "vtkKrylovAlgorithm.h"

#include "tautline/Solvers/SolverOptions.h"

//------------------------------------------------------------------------------
vtkKrylovAlgorithm::vtkKrylovAlgorithm() = default;

//------------------------------------------------------------------------------
vtkKrylovAlgorithm::~vtkKrylovAlgorithm() = default;

//------------------------------------------------------------------------------
void vtkKrylovAlgorithm::SetCommonOptions(tautline::SolverOptions& options) const
{
  options.relativeTolerance = this->RelativeTolerance;
  options.absoluteTolerance = this->AbsoluteTolerance;
  options.maximumIterations = this->MaximumIterations;
  options.restart = this->Restart;
  options.omega = this->Omega;
  options.petscOptions = this->PETScOptions;
  options.threads = this->Threads;
}

//------------------------------------------------------------------------------
void vtkKrylovAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "RelativeTolerance: " << this->RelativeTolerance << "\n";
  os << indent << "AbsoluteTolerance: " << this->AbsoluteTolerance << "\n";
  os << indent << "MaximumIterations: " << this->MaximumIterations << "\n";
  os << indent << "Restart: " << this->Restart << "\n";
}
