#include "vtkHorizonNeighbors.h"

#include "HorizonInput.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <cmath>
#include <map>

vtkStandardNewMacro(vtkHorizonNeighbors);

namespace
{
constexpr int CirclePieces = 256;

/// 1, 2, 3 for three, two, one corner inside; 0 for none.
int caseOf(int corners)
{
  return corners > 0 ? 4 - corners : 0;
}
}

//------------------------------------------------------------------------------
vtkHorizonNeighbors::vtkHorizonNeighbors()
{
  this->SetNumberOfOutputPorts(3);
}

//------------------------------------------------------------------------------
int vtkHorizonNeighbors::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataSet");
  return 1;
}

//------------------------------------------------------------------------------
int vtkHorizonNeighbors::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataSet* input = vtkDataSet::GetData(inputVector[0]);
  vtkPolyData* triangles = vtkPolyData::GetData(outputVector, 0);
  vtkPolyData* circle = vtkPolyData::GetData(outputVector, 1);
  vtkPolyData* pieces = vtkPolyData::GetData(outputVector, 2);
  if (input->GetNumberOfCells() == 0)
  {
    return 1;
  }
  try
  {
    if (!(this->Horizon > 0.0) || !std::isfinite(this->Horizon))
    {
      throw tautline::Error("the horizon has to be above 0");
    }
    const tautline::HorizonInput taken(input, nullptr, 0.0, 0);
    const tautline::HorizonMesh& mesh = taken.mesh();
    const auto centre = taken.project({ this->Center[0], this->Center[1], this->Center[2] });
    const auto place = [&](vtkPoints* points, double x, double y)
    { return points->InsertNextPoint(taken.lift(x, y).data()); };

    vtkNew<vtkPoints> round;
    vtkNew<vtkCellArray> line;
    line->InsertNextCell(CirclePieces + 1);
    for (int i = 0; i < CirclePieces; ++i)
    {
      const double angle = 2.0 * M_PI * i / CirclePieces;
      line->InsertCellPoint(place(round, centre[0] + this->Horizon * std::cos(angle),
        centre[1] + this->Horizon * std::sin(angle)));
    }
    line->InsertCellPoint(0);
    circle->SetPoints(round);
    circle->SetLines(line);

    vtkNew<vtkPoints> corners, ends;
    corners->SetDataType(VTK_DOUBLE);
    ends->SetDataType(VTK_DOUBLE);
    vtkNew<vtkCellArray> cells, parts;
    vtkNew<vtkIntArray> cases, partCases;
    vtkNew<vtkIdTypeArray> ids, partIds;
    vtkNew<vtkDoubleArray> area, chord, missed;
    std::map<tautline::Index, vtkIdType> newId;
    for (tautline::Index t = 0; t < mesh.numberOfTriangles(); ++t)
    {
      double xy[6];
      for (int k = 0; k < 3; ++k)
      {
        xy[2 * k] = mesh.points[2 * mesh.triangles[3 * t + k]];
        xy[2 * k + 1] = mesh.points[2 * mesh.triangles[3 * t + k] + 1];
      }
      const tautline::DiscIntersection met =
        tautline::intersectDisc(xy, centre[0], centre[1], this->Horizon);
      if (met.exactArea <= 1e-14 * this->Horizon * this->Horizon)
      {
        continue;
      }
      vtkIdType points[3];
      for (int k = 0; k < 3; ++k)
      {
        const auto [known, fresh] = newId.emplace(mesh.triangles[3 * t + k], 0);
        if (fresh)
        {
          known->second = place(corners, xy[2 * k], xy[2 * k + 1]);
        }
        points[k] = known->second;
      }
      cells->InsertNextCell(3, points);
      cases->InsertNextValue(caseOf(met.corners));
      ids->InsertNextValue(taken.cell(t));
      area->InsertNextValue(met.exactArea);
      chord->InsertNextValue(met.chordArea);
      missed->InsertNextValue(met.exactArea - met.chordArea);
      for (std::size_t i = 0; i < met.chords.size(); i += 6)
      {
        vtkIdType part[3];
        for (std::size_t k = 0; k < 3; ++k)
        {
          part[k] = place(ends, met.chords[i + 2 * k], met.chords[i + 2 * k + 1]);
        }
        parts->InsertNextCell(3, part);
        partCases->InsertNextValue(caseOf(met.corners));
        partIds->InsertNextValue(taken.cell(t));
      }
    }
    const auto add = [](vtkPolyData* to, vtkDataArray* array, const char* name)
    {
      array->SetName(name);
      to->GetCellData()->AddArray(array);
    };
    triangles->SetPoints(corners);
    triangles->SetPolys(cells);
    add(triangles, cases, "Case");
    add(triangles, ids, "CellId");
    add(triangles, area, "Area");
    add(triangles, chord, "ChordArea");
    add(triangles, missed, "Missed");
    triangles->GetCellData()->SetActiveScalars("Case");
    pieces->SetPoints(ends);
    pieces->SetPolys(parts);
    add(pieces, partCases, "Case");
    add(pieces, partIds, "CellId");
    pieces->GetCellData()->SetActiveScalars("Case");
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< error.what());
    for (vtkPolyData* output : { triangles, circle, pieces })
    {
      output->Initialize();
    }
    return 0;
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkHorizonNeighbors::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Center: " << this->Center[0] << " " << this->Center[1] << " " << this->Center[2]
     << "\n";
  os << indent << "Horizon: " << this->Horizon << "\n";
}
