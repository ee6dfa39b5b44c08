// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHorizonNeighbors.h"

#include "GatheredExecution.h"
#include "HorizonInput.h"
#include "ProgressStep.h"
#include "ValidateInput.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Core/Memory.h"
#include "tautline/Mesh/CoordinateFrame.h"

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

#include <algorithm>
#include <cmath>
#include <map>

vtkStandardNewMacro(vtkHorizonNeighbors);

namespace
{
constexpr int CirclePieces = 256;
constexpr double NegligibleArea = 1e-14; // relative to the square of the horizon

/// The horizon, in the plane of the mesh.
struct Disc
{
  std::array<double, 2> center;
  double radius;
};

/// 1, 2, 3 for three, two, one corner inside; 0 for none.
int caseOf(int corners)
{
  return corners > 0 ? 4 - corners : 0;
}

void fillCircle(const tautline::HorizonInput& taken, const Disc& disc, vtkPolyData* circle)
{
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> line;
  line->InsertNextCell(CirclePieces + 1);
  for (int i = 0; i < CirclePieces; ++i)
  {
    const double angle = 2.0 * tautline::Pi * i / CirclePieces;
    line->InsertCellPoint(
      points->InsertNextPoint(taken
                                .lift(disc.center[0] + disc.radius * std::cos(angle),
                                  disc.center[1] + disc.radius * std::sin(angle))
                                .data()));
  }
  line->InsertCellPoint(0);
  circle->SetPoints(points);
  circle->SetLines(line);
}

/// Triangles with cell arrays for an output.
class TriangleCollector
{
public:
  explicit TriangleCollector(bool withAreas)
    : WithAreas(withAreas)
  {
    this->Points->SetDataType(VTK_DOUBLE);
  }

  vtkIdType addPoint(const tautline::Vec3& p) { return this->Points->InsertNextPoint(p.data()); }

  void addTriangle(const vtkIdType* points, int number, vtkIdType cell)
  {
    this->Cells->InsertNextCell(3, points);
    this->Cases->InsertNextValue(number);
    this->Ids->InsertNextValue(cell);
  }

  /// Areas of a triangle within the disc: exact and approximated by chords.
  void addAreas(double exact, double chord)
  {
    this->Area->InsertNextValue(exact);
    this->Chord->InsertNextValue(chord);
    this->Missed->InsertNextValue(exact - chord);
  }

  void fill(vtkPolyData* output)
  {
    output->SetPoints(this->Points);
    output->SetPolys(this->Cells);
    add(output, this->Cases, "Case");
    add(output, this->Ids, "CellId");
    if (this->WithAreas)
    {
      add(output, this->Area, "Area");
      add(output, this->Chord, "ChordArea");
      add(output, this->Missed, "Missed");
    }
    output->GetCellData()->SetActiveScalars("Case");
  }

private:
  static void add(vtkPolyData* output, vtkDataArray* array, const char* name)
  {
    array->SetName(name);
    output->GetCellData()->AddArray(array);
  }

  bool WithAreas;
  vtkNew<vtkPoints> Points;
  vtkNew<vtkCellArray> Cells;
  vtkNew<vtkIntArray> Cases;
  vtkNew<vtkIdTypeArray> Ids;
  vtkNew<vtkDoubleArray> Area, Chord, Missed;
};

bool isNegligible(const tautline::DiscIntersection& met, const Disc& disc)
{
  return met.exactArea <= NegligibleArea * disc.radius * disc.radius;
}

/// The triangles that intersect the disc, and the triangles that replace their parts in it.
void collectTriangles(const tautline::HorizonInput& taken, const Disc& disc,
  TriangleCollector& triangles, TriangleCollector& pieces)
{
  const tautline::HorizonMesh& mesh = taken.mesh();
  std::map<tautline::Index, vtkIdType> newId;
  for (tautline::Index t = 0; t < mesh.numberOfTriangles(); ++t)
  {
    tautline::pollInterruption(t);
    tautline::LoopProgress::atPass(t, mesh.numberOfTriangles());
    const tautline::Index* corners = &mesh.triangles[3 * t];
    double xy[6];
    for (int k = 0; k < 3; ++k)
    {
      xy[2 * k] = mesh.points[2 * corners[k]];
      xy[2 * k + 1] = mesh.points[2 * corners[k] + 1];
    }
    const tautline::DiscIntersection met =
      tautline::intersectDisc(xy, disc.center[0], disc.center[1], disc.radius);
    if (isNegligible(met, disc))
    {
      continue;
    }
    vtkIdType points[3];
    for (int k = 0; k < 3; ++k)
    {
      const auto [known, fresh] = newId.emplace(corners[k], 0);
      if (fresh)
      {
        known->second = triangles.addPoint(taken.lift(xy[2 * k], xy[2 * k + 1]));
      }
      points[k] = known->second;
    }
    triangles.addTriangle(points, caseOf(met.corners), taken.cell(t));
    triangles.addAreas(met.exactArea, met.chordArea);
    for (std::size_t i = 0; i < met.chords.size(); i += 6)
    {
      for (std::size_t k = 0; k < 3; ++k)
      {
        points[k] = pieces.addPoint(taken.lift(met.chords[i + 2 * k], met.chords[i + 2 * k + 1]));
      }
      pieces.addTriangle(points, caseOf(met.corners), taken.cell(t));
    }
  }
}
}

//------------------------------------------------------------------------------
vtkHorizonNeighbors::vtkHorizonNeighbors()
{
  this->SetNumberOfOutputPorts(3);
}

//------------------------------------------------------------------------------
vtkHorizonNeighbors::~vtkHorizonNeighbors() = default;

//------------------------------------------------------------------------------
int vtkHorizonNeighbors::FillInputPortInformation(int, vtkInformation* info)
{
  // The composite type comes first: its data sets form one mesh.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataSet");
  return 1;
}

//------------------------------------------------------------------------------
vtkTypeBool vtkHorizonNeighbors::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  return tautline::processGathered(this, {}, tautline::GatheredResult::OnFirst, { true, 0 },
    request, inputs, outputs,
    [&] { return this->Superclass::ProcessRequest(request, inputs, outputs); });
}

//------------------------------------------------------------------------------
int vtkHorizonNeighbors::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkPolyData* triangles = vtkPolyData::GetData(outputVector, 0);
  vtkPolyData* circle = vtkPolyData::GetData(outputVector, 1);
  vtkPolyData* pieces = vtkPolyData::GetData(outputVector, 2);
  try
  {
    tautline::validateInput(vtkDataObject::GetData(inputVector[0]), { true });
    const vtkSmartPointer<vtkDataSet> input =
      tautline::wholeMesh(vtkDataObject::GetData(inputVector[0]));
    if (input->GetNumberOfCells() == 0)
    {
      tautline::warnOfEmptyInput(this, vtkDataObject::GetData(inputVector[0]), "cells");
      return 1;
    }
    this->CheckHorizon();
    const tautline::ProgressStep progress(this, 0.0, 1.0);
    Disc disc = { {}, this->Horizon };
    const tautline::Vec3 center = { this->Center[0], this->Center[1], this->Center[2] };
    const tautline::HorizonInput taken(input, nullptr, 0.0, false, 0); // for the geometry only
    disc.center = taken.project(center);
    fillCircle(taken, disc, circle);
    TriangleCollector met(true), chords(false);
    collectTriangles(taken, disc, met, chords);
    met.fill(triangles);
    chords.fill(pieces);
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< tautline::errorText(error, "choose a smaller horizon or a coarser mesh"));
    for (vtkPolyData* output : { triangles, circle, pieces })
    {
      output->Initialize();
    }
    return 0;
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkHorizonNeighbors::CheckHorizon()
{
  if (!(this->Horizon > 0.0) || !std::isfinite(this->Horizon))
  {
    throw tautline::Error("the horizon must be above 0");
  }
  using tautline::LargestExtent;
  using tautline::SmallestExtent;
  const bool near = std::all_of(
    this->Center, this->Center + 3, [](double x) { return std::abs(x) <= LargestExtent; });
  if (!near || this->Horizon < SmallestExtent || this->Horizon > LargestExtent)
  {
    throw tautline::Error("the horizon must be between 5e-20 and 2e19, and the center within 2e19 "
                          "of the origin: scale the mesh first (filter Transform)");
  }
}

//------------------------------------------------------------------------------
void vtkHorizonNeighbors::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Center: " << this->Center[0] << " " << this->Center[1] << " " << this->Center[2]
     << "\n";
  os << indent << "Horizon: " << this->Horizon << "\n";
}
