// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshBoundaryAlgorithm.h"

#include "BoundarySetup.h"

//------------------------------------------------------------------------------
vtkMeshBoundaryAlgorithm::vtkMeshBoundaryAlgorithm(int fixedArray, int kindArray, int regionArray)
  : FixedIndex(fixedArray)
  , KindIndex(kindArray)
  , RegionIndex(regionArray)
{
}

//------------------------------------------------------------------------------
vtkMeshBoundaryAlgorithm::~vtkMeshBoundaryAlgorithm() = default;

//------------------------------------------------------------------------------
tautline::BoundaryProperties vtkMeshBoundaryAlgorithm::GetBoundaryProperties(
  vtkDataObject* geometry)
{
  tautline::BoundaryProperties properties;
  properties.motion = static_cast<tautline::BoundaryMotion>(this->Boundary);
  properties.flatAngle = this->FlatAngle;
  properties.featureAngle = this->FeatureAngle;
  properties.keepFeatures = this->KeepFeatures;
  properties.smoothSurface = this->SmoothSurface;
  properties.surfaceTolerance = this->SurfaceTolerance;
  properties.showFeatures = this->ShowFeatures;
  properties.freeInvalid = this->FreeInvalid;
  properties.geometry = geometry;
  properties.arrays = this;
  properties.fixedArray = this->FixedIndex;
  properties.kindArray = this->KindIndex;
  properties.regionArray = this->RegionIndex;
  properties.threads = this->Threads;
  return properties;
}

//------------------------------------------------------------------------------
void vtkMeshBoundaryAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Boundary: " << this->Boundary << "\n";
  os << indent << "FlatAngle: " << this->FlatAngle << "\n";
  os << indent << "FeatureAngle: " << this->FeatureAngle << "\n";
  os << indent << "KeepFeatures: " << this->KeepFeatures << "\n";
  os << indent << "SmoothSurface: " << this->SmoothSurface << "\n";
  os << indent << "SurfaceTolerance: " << this->SurfaceTolerance << "\n";
  os << indent << "ShowFeatures: " << this->ShowFeatures << "\n";
  os << indent << "FreeInvalid: " << this->FreeInvalid << "\n";
}
