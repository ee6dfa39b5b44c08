// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMovingBoundary.h"

#include "GatheredExecution.h"
#include "Processes.h"
#include "WarpSession.h"
#include "tautline/Core/Interruption.h"

#include "vtkCellArray.h"
#include "vtkGenericCell.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSelection.h"

#include <algorithm>
#include <map>

vtkStandardNewMacro(vtkMovingBoundary);

namespace
{
/// The number of input ports; the first has the mesh.
constexpr int BoundaryPort = 1, MovedSelection = 2, FixedSelection = 3;

using PointIds = std::vector<vtkIdType>;

/// An edge or face of a cell: its points in order, and the number of cells that share it.
struct Facet
{
  PointIds points;
  int cells = 0;
};

/// The facets between moving points, by the sorted ids of these.
std::map<PointIds, Facet> facetsBetween(vtkDataSet* input, const tautline::RestingMesh& rest,
  const tautline::PointFlags& moving, int dimension)
{
  const std::vector<tautline::Index>& one = rest.mesh->representative();
  const auto nodeOf = [&one](vtkIdType point) { return one.empty() ? point : one[point]; };
  std::map<PointIds, Facet> facets;
  vtkNew<vtkGenericCell> cell;
  vtkNew<vtkIdList> ids;
  for (vtkIdType c = 0; c < input->GetNumberOfCells(); ++c)
  {
    tautline::pollInterruption(c);
    input->GetCellPoints(c, ids);
    const auto moved = std::count_if(
      ids->begin(), ids->end(), [&](vtkIdType point) { return moving[nodeOf(point)] != 0; });
    if (moved < dimension)
    {
      continue;
    }
    input->GetCell(c, cell);
    const int sides = cell->GetCellDimension() != dimension ? 0
      : dimension == 3                                      ? cell->GetNumberOfFaces()
                                                            : cell->GetNumberOfEdges();
    for (int i = 0; i < sides; ++i)
    {
      vtkIdList* side = (dimension == 3 ? cell->GetFace(i) : cell->GetEdge(i))->GetPointIds();
      PointIds points(side->begin(), side->end());
      std::transform(points.begin(), points.end(), points.begin(), nodeOf);
      if (std::all_of(
            points.begin(), points.end(), [&moving](vtkIdType point) { return moving[point]; }))
      {
        PointIds key = points;
        std::sort(key.begin(), key.end());
        Facet& facet = facets[key];
        facet.points = std::move(points);
        ++facet.cells;
      }
    }
  }
  return facets;
}

/// Adds the moving part of a data set's boundary.
void addMoving(vtkDataSet* input, const tautline::RestingMesh& rest,
  const tautline::PointFlags& moving, vtkPolyData* output)
{
  const int dimension = rest.mesh->mesh().dimension() == tautline::Dimension::Volume ? 3 : 2;
  std::vector<vtkIdType> ids(moving.size(), -1);
  const auto idOf = [&](vtkIdType point)
  {
    if (ids[point] < 0)
    {
      ids[point] = output->GetPoints()->InsertNextPoint(input->GetPoint(point));
    }
    return ids[point];
  };
  vtkCellArray* cells = dimension == 3 ? output->GetPolys() : output->GetLines();
  for (const auto& [key, facet] : facetsBetween(input, rest, moving, dimension))
  {
    if (facet.cells == 1)
    {
      PointIds points(facet.points.size());
      std::transform(facet.points.begin(), facet.points.end(), points.begin(), idOf);
      cells->InsertNextCell(static_cast<vtkIdType>(points.size()), points.data());
    }
  }
  for (std::size_t point = 0; point < moving.size(); ++point)
  {
    if (moving[point] && ids[point] < 0)
    {
      const vtkIdType id = idOf(static_cast<vtkIdType>(point));
      output->GetVerts()->InsertNextCell(1, &id);
    }
  }
}
}

//------------------------------------------------------------------------------
vtkMovingBoundary::vtkMovingBoundary() = default;

//------------------------------------------------------------------------------
vtkMovingBoundary::~vtkMovingBoundary() = default;

//------------------------------------------------------------------------------
int vtkMovingBoundary::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == MeshPort ? "vtkPolyData" : "vtkTable");
  return 1;
}

//------------------------------------------------------------------------------
int vtkMovingBoundary::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector**, vtkInformationVector*)
{
  return 1; // one time step
}

//------------------------------------------------------------------------------
int vtkMovingBoundary::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  tautline::WarpSession& session = this->GetSession();
  session.settings = this->GetSettings();
  vtkDataObject* input = vtkDataObject::GetData(inputVector[MeshPort]);
  vtkDataObject* target = vtkDataObject::GetData(inputVector[BoundaryPort]);
  vtkPolyData* output = vtkPolyData::GetData(outputVector, MeshPort);
  vtkNew<vtkPolyData> found;
  const std::string failure = FailureOf("warp the mesh in parts",
    [&]
    {
      tautline::requireOneProcess(input);
      vtkNew<vtkPoints> points;
      points->SetDataTypeToDouble();
      found->SetPoints(points);
      for (const auto set :
        { &vtkPolyData::SetVerts, &vtkPolyData::SetLines, &vtkPolyData::SetPolys })
      {
        vtkNew<vtkCellArray> cells;
        (found->*set)(cells);
      }
      const auto moved =
        tautline::markSelected(input, vtkSelection::GetData(inputVector[MovedSelection]));
      const auto fixed =
        tautline::markSelected(input, vtkSelection::GetData(inputVector[FixedSelection]));
      const auto scratch = vtkSmartPointer<vtkDataObject>::Take(input->NewInstance());
      tautline::forEachBlock(input, nullptr, fixed, scratch,
        [&](const tautline::InputBlock& block)
        {
          if (block.input->GetNumberOfPoints() > 0 && block.input->GetNumberOfCells() > 0)
          {
            tautline::PointFlags moving = session.movingPoints(block, target, moved);
            const tautline::RestingMesh& rest = session.restingMesh(block.number);
            vtkDataSet* shown = block.input;
            if (rest.curved) // the straight cells of the corners
            {
              shown = rest.curved->corners();
              for (const tautline::Index point : rest.curved->nodes().points())
              {
                moving[point] = 0;
              }
            }
            addMoving(shown, rest, moving, found);
          }
        });
      session.forgetFrom(tautline::countBlocks(input));
    });
  if (tautline::minimumOverProcesses(failure.empty()) == 0)
  {
    session.clear();
    return this->Fail(outputVector, failure);
  }
  output->ShallowCopy(found);
  this->Summary = std::to_string(output->GetNumberOfPoints()) + " points of the boundary move.";
  return 1;
}

//------------------------------------------------------------------------------
tautline::GatheredRules vtkMovingBoundary::GetGatheredRules()
{
  tautline::GatheredRules rules = this->Superclass::GetGatheredRules();
  rules.result = tautline::GatheredResult::OnFirst;
  return rules;
}

//------------------------------------------------------------------------------
int vtkMovingBoundary::Fail(vtkInformationVector* outputVector, const std::string& message)
{
  for (int port = 0; port < outputVector->GetNumberOfInformationObjects(); ++port)
  {
    vtkDataObject::GetData(outputVector, port)->Initialize();
  }
  this->Summary = message;
  return 1;
}
