// SPDX-License-Identifier: BSD-3-Clause
#include "vtkShapeAlgorithm.h"

#include "tautline/Shapes/ShapeMatch.h"

//------------------------------------------------------------------------------
vtkShapeAlgorithm::vtkShapeAlgorithm() = default;

//------------------------------------------------------------------------------
void vtkShapeAlgorithm::GetOptions(
  tautline::LocationOptions& locations, tautline::MatchOptions& match)
{
  locations.kind = static_cast<tautline::Locations>(this->Locations);
  locations.columns = this->GridSize[0];
  locations.rows = this->GridSize[1];
  locations.contour = this->ContourPoints;
  locations.threads = this->Threads;
  tautline::ShapeEnergy& energy = match.energy;
  energy.lambda = this->Lambda;
  energy.deformation = this->DeformationWeight;
  energy.distortion = this->DistortionWeight;
  energy.signedDistortion = this->SignedDistortion;
  energy.smoothing = this->Smoothing;
  energy.directedEdges = this->DirectedEdges;
  energy.rotation = this->RotationWeight;
  energy.descriptor = this->DescriptorWeight;
  energy.ordering = this->OrderingWeight;
  energy.reflection = static_cast<tautline::Reflection>(this->Reflection);
  match.centreTolerance = this->CentreTolerance;
  match.maxSolutions = this->MaximumSolutions;
  match.coarseToFine = this->CoarseToFine;
  match.rotations = this->Rotations;
  match.scales = this->Scales;
  match.timeLimit = this->GetRemainingSeconds();
  match.threads = this->Threads;
  match.progress = [this](double fraction) { return this->Proceed(fraction); };
}

//------------------------------------------------------------------------------
void vtkShapeAlgorithm::ClearResult()
{
  this->Superclass::ClearResult();
  this->Matching = false;
}

//------------------------------------------------------------------------------
void vtkShapeAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Lambda: " << this->Lambda << "\n";
  os << indent << "DeformationWeight: " << this->DeformationWeight << "\n";
  os << indent << "DistortionWeight: " << this->DistortionWeight << "\n";
  os << indent << "SignedDistortion: " << this->SignedDistortion << "\n";
  os << indent << "Smoothing: " << this->Smoothing << "\n";
  os << indent << "DirectedEdges: " << this->DirectedEdges << "\n";
  os << indent << "RotationWeight: " << this->RotationWeight << "\n";
  os << indent << "DescriptorWeight: " << this->DescriptorWeight << "\n";
  os << indent << "OrderingWeight: " << this->OrderingWeight << "\n";
  os << indent << "Reflection: " << this->Reflection << "\n";
  os << indent << "Locations: " << this->Locations << "\n";
  os << indent << "GridSize: " << this->GridSize[0] << " " << this->GridSize[1] << "\n";
  os << indent << "ContourPoints: " << this->ContourPoints << "\n";
  os << indent << "CentreTolerance: " << this->CentreTolerance << "\n";
  os << indent << "MaximumSolutions: " << this->MaximumSolutions << "\n";
  os << indent << "CoarseToFine: " << this->CoarseToFine << "\n";
  os << indent << "Rotations: " << this->Rotations << "\n";
  os << indent << "Scales: " << this->Scales << "\n";
  os << indent << "Foreground: " << this->Foreground << "\n";
}
