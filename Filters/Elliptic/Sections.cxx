// SPDX-License-Identifier: BSD-3-Clause
#include "Sections.h"

#include "ProcessGroup.h"

#include "tautline/Core/Interruption.h"

#include "vtkAppendPolyData.h"
#include "vtkBoundingBox.h"
#include "vtkCell.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkCutter.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPlane.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkTetra.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace tautline
{
namespace
{
constexpr int Axes = 3;
constexpr int Slabs = 64;          // into which the extent along an axis is divided
constexpr double LargeShare = 0.9; // sections with this fraction of the largest area are also large

bool isVolume(int cellType)
{
  switch (cellType)
  {
    case VTK_TETRA:
    case VTK_HEXAHEDRON:
    case VTK_VOXEL:
    case VTK_WEDGE:
    case VTK_PYRAMID:
      return true;
    default:
      return false;
  }
}

bool hasVolumes(vtkDataSet* data)
{
  for (vtkIdType cell = 0; cell < data->GetNumberOfCells(); ++cell)
  {
    pollInterruption(cell);
    if (isVolume(data->GetCellType(cell)))
    {
      return true;
    }
  }
  return false;
}

std::vector<vtkDataSet*> volumesOf(vtkDataObject* mesh)
{
  std::vector<vtkDataSet*> volumes;
  const auto add = [&volumes](vtkDataObject* object)
  {
    vtkDataSet* data = vtkDataSet::SafeDownCast(object);
    if (data && hasVolumes(data))
    {
      volumes.push_back(data);
    }
  };
  add(mesh);
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(mesh))
  {
    vtkSmartPointer<vtkCompositeDataIterator> blocks;
    blocks.TakeReference(composite->NewIterator());
    for (blocks->InitTraversal(); !blocks->IsDoneWithTraversal(); blocks->GoToNextItem())
    {
      add(blocks->GetCurrentDataObject());
    }
  }
  return volumes;
}

/// The bounds on all processes; valid if any has points.
vtkBoundingBox boundsOf(const std::vector<vtkDataSet*>& volumes, RankGroup& processes)
{
  vtkBoundingBox own;
  for (vtkDataSet* data : volumes)
  {
    own.AddBounds(data->GetBounds());
  }
  std::vector<double> corners;
  if (own.IsValid())
  {
    corners.insert(corners.end(), own.GetMinPoint(), own.GetMinPoint() + Axes);
    corners.insert(corners.end(), own.GetMaxPoint(), own.GetMaxPoint() + Axes);
  }
  corners = processes.gatherJoined(corners);
  vtkBoundingBox all;
  for (std::size_t i = 0; i + Axes <= corners.size(); i += Axes)
  {
    all.AddPoint(corners.data() + i);
  }
  return all;
}

/**
 * The section areas of slabs of the bounds, for each axis. The volume of a tetrahedron is spread
 * evenly over its extent.
 */
class SectionAreas
{
public:
  explicit SectionAreas(const vtkBoundingBox& bounds)
    : Areas(std::size_t{ Axes } * Slabs, 0.0)
  {
    bounds.GetMinPoint(this->Low[0], this->Low[1], this->Low[2]);
    bounds.GetLengths(this->Width.data());
    for (double& width : this->Width)
    {
      width /= Slabs;
    }
  }

  void add(vtkDataSet* data)
  {
    vtkUnsignedCharArray* ghosts = data->GetCellGhostArray();
    vtkNew<vtkIdList> ids;
    vtkNew<vtkPoints> corners;
    for (vtkIdType cell = 0; cell < data->GetNumberOfCells(); ++cell)
    {
      pollInterruption(cell);
      if (!isVolume(data->GetCellType(cell)) || (ghosts && ghosts->GetValue(cell) != 0))
      {
        continue;
      }
      data->GetCell(cell)->Triangulate(0, ids, corners);
      constexpr vtkIdType cornersOfTetrahedron = 4;
      for (vtkIdType i = 0; i + cornersOfTetrahedron <= corners->GetNumberOfPoints();
           i += cornersOfTetrahedron)
      {
        this->addTetrahedron(corners, i);
      }
    }
  }

  /// The areas on all processes. Collective.
  void sum(RankGroup& processes)
  {
    const std::vector<double> all = processes.gatherJoined(this->Areas);
    std::fill(this->Areas.begin(), this->Areas.end(), 0.0);
    for (std::size_t i = 0; i < all.size(); ++i)
    {
      this->Areas[i % this->Areas.size()] += all[i];
    }
  }

  /// The middle of the slabs with large sections that are nearest to the middle of the bounds.
  double place(int axis) const
  {
    const auto first = this->Areas.begin() + std::ptrdiff_t{ axis } * Slabs;
    const double large = LargeShare * *std::max_element(first, first + Slabs);
    double best = 0.5 * Slabs, nearest = Slabs;
    for (int begin = 0; begin < Slabs; ++begin)
    {
      int end = begin;
      while (end < Slabs && first[end] >= large)
      {
        ++end;
      }
      const double gap = std::max({ begin - 0.5 * Slabs, 0.5 * Slabs - end, 0.0 });
      if (end > begin && gap < nearest)
      {
        nearest = gap;
        best = 0.5 * (begin + end);
      }
      begin = end;
    }
    const auto k = static_cast<std::size_t>(axis);
    return this->Low[k] + best * this->Width[k];
  }

private:
  void addTetrahedron(vtkPoints* points, vtkIdType begin)
  {
    std::array<std::array<double, Axes>, 4> p{};
    for (std::size_t i = 0; i < p.size(); ++i)
    {
      points->GetPoint(begin + static_cast<vtkIdType>(i), p[i].data());
    }
    const double volume =
      std::abs(vtkTetra::ComputeVolume(p[0].data(), p[1].data(), p[2].data(), p[3].data()));
    for (std::size_t axis = 0; axis < Axes; ++axis)
    {
      const auto [low, high] = std::minmax({ p[0][axis], p[1][axis], p[2][axis], p[3][axis] });
      if (!(high > low) || !(this->Width[axis] > 0))
      {
        continue;
      }
      const double begins = (low - this->Low[axis]) / this->Width[axis],
                   ends = (high - this->Low[axis]) / this->Width[axis];
      const int last = std::min(static_cast<int>(ends), Slabs - 1);
      for (int slab = std::max(static_cast<int>(begins), 0); slab <= last; ++slab)
      {
        const double overlap = std::min(ends, slab + 1.0) - std::max<double>(begins, slab);
        this->Areas[axis * Slabs + static_cast<std::size_t>(slab)] +=
          volume / (high - low) * std::max(overlap, 0.0);
      }
    }
  }

  std::vector<double> Areas; ///< times the width of the slab
  std::array<double, Axes> Low{}, Width{};
};
}

//------------------------------------------------------------------------------
void cutVolumes(vtkDataObject* mesh, RankGroup& processes, vtkPolyData* sections)
{
  std::vector<vtkDataSet*> volumes;
  volumes = volumesOf(mesh);
  const vtkBoundingBox bounds = boundsOf(volumes, processes);
  if (!bounds.IsValid())
  {
    return;
  }
  SectionAreas areas(bounds);
  for (vtkDataSet* data : volumes)
  {
    areas.add(data);
  }
  areas.sum(processes);
  const std::array<double, Axes> center = { areas.place(0), areas.place(1), areas.place(2) };
  vtkNew<vtkAppendPolyData> all;
  std::string shown;
  for (vtkDataSet* data : volumes)
  {
    vtkDataArray* scalars = data->GetPointData()->GetScalars();
    shown = scalars && scalars->GetName() ? scalars->GetName() : shown;
    for (int axis = 0; axis < Axes; ++axis)
    {
      vtkNew<vtkPlane> plane;
      plane->SetOrigin(center.data());
      plane->SetNormal(axis == 0, axis == 1, axis == 2);
      vtkNew<vtkCutter> cutter;
      cutter->SetInputData(data);
      cutter->SetCutFunction(plane);
      cutter->GenerateTrianglesOff();
      cutter->Update();
      if (cutter->GetOutput()->GetNumberOfCells() > 0)
      {
        all->AddInputData(cutter->GetOutput());
      }
    }
  }
  if (all->GetNumberOfInputConnections(0) > 0)
  {
    all->Update();
    sections->ShallowCopy(all->GetOutput());
    sections->GetPointData()->SetActiveScalars(shown.c_str());
    sections->GetCellData()->SetActiveScalars(nullptr);
  }
}
}
