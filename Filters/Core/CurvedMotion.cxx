// SPDX-License-Identifier: BSD-3-Clause
#include "CurvedMotion.h"

#include "Blocks.h"
#include "GeometrySurface.h"
#include "tautline/Mesh/Features.h"

#include "vtkDataSet.h"

#include <algorithm>

namespace tautline
{
//------------------------------------------------------------------------------
CurvedMotion::CurvedMotion(const InputBlock& block, int threads, bool mergePoints)
  : Cells(block.input, threads)
  , Corners(this->Cells.corners(), threads, mergePoints, true)
  , Threads(threads)
{
  if (!this->Corners.representative().empty())
  {
    throw Error("Curved cells have several points at the same place on seams, where all nodes of "
                "the cells would come apart: run Clean to Grid first.");
  }
  this->Corners.certifyBy(this->Cells);
  this->Full = std::make_unique<Mesh>(this->Cells.mesh().at(this->Corners.mesh().view().points));
  this->Fixed.assign(this->Full->view().numberOfPoints, 0);
}

//------------------------------------------------------------------------------
CurvedOptions CurvedMotion::options() const
{
  CurvedOptions options;
  options.facts = this->Cells.facts();
  options.fixed = this->Fixed.data();
  options.threads = this->Threads;
  return options;
}

//------------------------------------------------------------------------------
void CurvedMotion::fix(vtkDataArray* array)
{
  markPoints(this->Full->view(), array, false, this->Fixed);
  this->Corners.fix(array, false);
}

//------------------------------------------------------------------------------
void CurvedMotion::fixSelected(vtkDataSet* selected)
{
  markPoints(this->Full->view(), selected, this->Fixed);
  this->Corners.fixSelected(selected);
  // With what the corners always hold: points of ghosts, lines and other cells that are not moved.
  std::transform(this->Fixed.begin(), this->Fixed.end(), this->Corners.fixed().begin(),
    this->Fixed.begin(),
    [](unsigned char own, unsigned char corner) -> unsigned char { return own || corner; });
}

//------------------------------------------------------------------------------
void CurvedMotion::freeInvalid()
{
  const MeshView& view = this->Full->view();
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    for (Index n = view.offsets[cell];
         isInvalid(this->Corners.validity()[cell]) && n < view.offsets[cell + 1]; ++n)
    {
      this->Fixed[view.connectivity[n]] = 0;
    }
  }
}

//------------------------------------------------------------------------------
SurfaceModel CurvedMotion::geometry(vtkDataObject* surface, double featureAngle, bool smooth) const
{
  const GeometrySurface facets(
    vtkDataSet::SafeDownCast(surface), this->Corners.frame(), false, this->Threads);
  FeatureOptions options;
  options.angle = featureAngle;
  options.asSurface = true;
  return makeSurfaceModel(facets.mesh(), findFeatures(facets.mesh(), options), smooth);
}
}
