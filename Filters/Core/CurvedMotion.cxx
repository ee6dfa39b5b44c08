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
    throw Error("Curved cells have coincident points on seams, where the cells would come apart: "
                "run Clean to Grid first.");
  }
  this->Corners.certifyBy(this->Cells);
  this->Full = std::make_unique<Mesh>(this->Cells.mesh().at(this->Corners.mesh().view().points));
  this->fixWhatStays();
}

//------------------------------------------------------------------------------
/// The corners that always stay are known; the nodes of cells with only such corners (ghosts,
/// facets inside a volume) stay with them.
void CurvedMotion::fixWhatStays()
{
  const MeshView& view = this->Full->view();
  const std::vector<unsigned char>& corners = this->Corners.fixed();
  this->Fixed = corners;
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const CellType type = cornerType(view.cellTypes[cell]);
    const Index* nodes = view.connectivity + view.offsets[cell];
    const Index* end = view.connectivity + view.offsets[cell + 1];
    if (type != CellType::Unsupported &&
      std::all_of(nodes, nodes + topology(type).nodes, [&](Index p) { return corners[p] != 0; }))
    {
      std::for_each(nodes, end, [this](Index p) { this->Fixed[p] = 1; });
    }
  }
  this->Stays = this->Fixed;
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
      this->Fixed[view.connectivity[n]] = this->Stays[view.connectivity[n]];
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
