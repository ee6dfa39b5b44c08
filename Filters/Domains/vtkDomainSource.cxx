// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDomainSource.h"

#include "ExecutionScope.h"
#include "MeshOutput.h"
#include "ProgressStep.h"

#include "tautline/Core/Memory.h"
#include "tautline/Domains/Domains.h"

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataObject.h"
#include "vtkDoubleArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <cmath>
#include <functional>

#if TAUTLINE_HAS_MESH_GENERATORS
#include "PlanarMesher.h"
#include "SolidMesher.h"
#endif

vtkStandardNewMacro(vtkDomainSource);

namespace
{
using tautline::DomainInfo;
using tautline::DomainKind;
using tautline::Error;
using tautline::Index;
using tautline::operator+;

/// A mesh of simplices from any source.
struct Made
{
  int dimension = 2; ///< of the points and the cells
  std::vector<double> points;
  std::vector<Index> cells, boundary;
  std::vector<int> pointMarkers, boundaryMarkers, references;
  Index count() const { return static_cast<Index>(this->cells.size()) / (this->dimension + 1); }
};

constexpr Index NumberUnknown = -1; ///< of points, for the progress

#if TAUTLINE_HAS_MESH_GENERATORS
Made makeWithSpacing(
  const DomainInfo& info, double spacing, const std::function<bool(Index)>& progress)
{
  Made made;
  if (info.kind == DomainKind::Planar)
  {
    tautline::PlanarOptions options;
    options.size = 1.3 * spacing;
    options.minimumAngle = 25.0;
    options.holesGiven = true;
    options.progress = progress;
    tautline::PlanarMesh mesh =
      tautline::meshPlane(tautline::planarBoundary(info.name, spacing), options);
    made.points = std::move(mesh.points);
    made.cells = std::move(mesh.triangles);
    made.boundary = std::move(mesh.edges);
    made.pointMarkers = std::move(mesh.pointMarkers);
    made.boundaryMarkers = std::move(mesh.edgeMarkers);
    return made;
  }
  tautline::SolidOptions options;
  options.volume = 0.2 * spacing * spacing * spacing;
  options.progress = [&progress, calls = 0.0]() mutable
  {
    // The duration is not known in advance.
    constexpr double callsForHalf = 20.0;
    calls += 1.0;
    tautline::LoopProgress::at(calls / (calls + callsForHalf));
    return progress(NumberUnknown);
  };
  tautline::SolidMesh mesh =
    tautline::meshSolid(tautline::solidBoundary(info.name, spacing), options);
  made.dimension = 3;
  made.points = std::move(mesh.points);
  made.cells = std::move(mesh.tetrahedra);
  made.boundary = std::move(mesh.faces);
  made.pointMarkers = std::move(mesh.pointMarkers);
  made.boundaryMarkers = std::move(mesh.faceMarkers);
  return made;
}

/// Meshes with few cells first, to find the number of cells for a spacing, then with the requested
/// number.
Made makeUnstructured(
  const DomainInfo& info, Index cells, const std::function<bool(Index)>& progress)
{
  tautline::checkDomainSize(static_cast<double>(cells), info.kind);
  const double power = info.kind == DomainKind::Planar ? 2.0 : 3.0;
  constexpr Index Trial = 20000;
  const double enough = info.kind == DomainKind::Planar ? 0.005 : 0.02; // tetrahedra take longer
  const auto spacingFor = [&](double perCell)
  { return std::pow(info.size / (static_cast<double>(cells) * perCell), 1.0 / power); };
  double perCell = info.kind == DomainKind::Planar ? 0.5 : 0.1; // size of a cell, spacing 1
  if (cells > 2 * Trial)
  {
    const double scale = static_cast<double>(cells) / static_cast<double>(Trial);
    const double spacing = spacingFor(perCell) * std::pow(scale, 1.0 / power);
    const Made trial = makeWithSpacing(info, spacing, progress);
    perCell = info.size / (static_cast<double>(trial.count()) * std::pow(spacing, power));
  }
  Made best;
  for (int attempt = 0; attempt < 4; ++attempt)
  {
    const double spacing = spacingFor(perCell);
    Made made = makeWithSpacing(info, spacing, progress);
    perCell = info.size / (static_cast<double>(made.count()) * std::pow(spacing, power));
    if (attempt == 0 || std::llabs(made.count() - cells) < std::llabs(best.count() - cells))
    {
      best = std::move(made);
    }
    if (std::abs(static_cast<double>(best.count() - cells)) <= enough * static_cast<double>(cells))
    {
      break;
    }
  }
  return best;
}
#else
Made makeUnstructured(const DomainInfo& info, Index, const std::function<bool(Index)>&)
{
  throw Error(std::string("the domain '") + info.name +
    "' needs a mesh generator, but this Tautline was built without mesh generators "
    "(TAUTLINE_MESHING=OFF); only the structured domains rectangle and square are available");
}
#endif

Made fromStructured(tautline::StructuredMesh mesh)
{
  Made made;
  for (std::size_t i = 0; i < mesh.points.size(); i += 3)
  {
    made.points.insert(made.points.end(), { mesh.points[i], mesh.points[i + 1] });
  }
  made.cells = std::move(mesh.triangles);
  made.pointMarkers = std::move(mesh.pointMarkers);
  made.references = std::move(mesh.cellReferences);
  return made;
}

/// Adds Displacement to the mesh and moves the points of the boundary.
void addMotion(const DomainInfo& info, double amount, const Made& made, vtkUnstructuredGrid* output,
  vtkPolyData* boundary)
{
  vtkNew<vtkPoints> moved;
  moved->DeepCopy(output->GetPoints());
  vtkNew<vtkDoubleArray> displacement;
  displacement->SetName("Displacement");
  displacement->SetNumberOfComponents(3);
  displacement->SetNumberOfTuples(output->GetNumberOfPoints());
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
  {
    tautline::Vec3 p;
    output->GetPoint(i, p.data());
    const int marker = made.pointMarkers[static_cast<std::size_t>(i)];
    const tautline::Vec3 d = tautline::domainDisplacement(info.name, p, marker, amount);
    displacement->SetTuple(i, d.data());
    const tautline::Vec3 q = p + d;
    moved->SetPoint(i, q.data());
  }
  output->GetPointData()->AddArray(displacement);
  boundary->SetPoints(moved);
}
}

//------------------------------------------------------------------------------
vtkDomainSource::vtkDomainSource()
{
  this->SetNumberOfInputPorts(0);
  this->SetNumberOfOutputPorts(2);
}

//------------------------------------------------------------------------------
int vtkDomainSource::GetNumberOfDomains()
{
  return static_cast<int>(tautline::domains().size());
}

//------------------------------------------------------------------------------
const char* vtkDomainSource::GetDomainName(int domain)
{
  const bool known = domain >= 0 && domain < vtkDomainSource::GetNumberOfDomains();
  return known ? tautline::domains()[static_cast<std::size_t>(domain)].name : nullptr;
}

//------------------------------------------------------------------------------
bool vtkDomainSource::HasMeshing()
{
  return TAUTLINE_HAS_MESH_GENERATORS != 0;
}

//------------------------------------------------------------------------------
void vtkDomainSource::SetDomain(int domain)
{
  const std::string error = tautline::rangeError(
    "Domain", domain, 0, vtkDomainSource::GetNumberOfDomains() - 1, this->Domain);
  if (!error.empty())
  {
    vtkErrorMacro(<< error);
  }
  else if (this->Domain != domain)
  {
    this->Domain = domain;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkDomainSource::SetDomainByName(const char* name)
{
  try
  {
    const std::string wanted = name ? name : "";
    const DomainInfo& info = tautline::findDomain(wanted);
    this->SetDomain(static_cast<int>(&info - tautline::domains().data()));
  }
  catch (const Error& error)
  {
    vtkErrorMacro(<< error.what());
  }
}

//------------------------------------------------------------------------------
int vtkDomainSource::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkUnstructuredGrid" : "vtkPolyData");
  return 1;
}

//------------------------------------------------------------------------------
vtkTypeBool vtkDomainSource::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  return tautline::processInScope(this, { this->TimeLimit, nullptr }, request, outputs,
    [&] { return this->Superclass::ProcessRequest(request, inputs, outputs); });
}

//------------------------------------------------------------------------------
int vtkDomainSource::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  vtkUnstructuredGrid* output = vtkUnstructuredGrid::GetData(outputVector, 0);
  vtkPolyData* boundary = vtkPolyData::GetData(outputVector, 1);
  const DomainInfo& info = tautline::domains()[static_cast<std::size_t>(this->Domain)];
  const Index cells = this->NumberOfCells > 0 ? this->NumberOfCells : info.cells;
  const auto progress = [&](Index points)
  {
    if (points != NumberUnknown)
    {
      tautline::LoopProgress::at(2.0 * static_cast<double>(points) / static_cast<double>(cells));
    }
    return this->GetAbortExecute() == 0;
  };
  Made made;
  try
  {
    const tautline::ProgressStep step(this, 0.0, 0.9);
    made = info.kind != DomainKind::Structured ? makeUnstructured(info, cells, progress)
      : std::string(info.name) == "rectangle"
      ? fromStructured(tautline::structuredRectangle(cells))
      : fromStructured(
          tautline::structuredSquare(this->ElementSize, this->AspectRatio, this->LayerWidth));
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< tautline::errorText(error, "choose fewer cells or larger elements"));
    return 0;
  }
  output->SetPoints(tautline::makePoints(made.points, made.dimension));
  output->SetCells(made.dimension == 2 ? VTK_TRIANGLE : VTK_TETRA,
    tautline::makeCells(made.cells, made.dimension + 1));
  output->GetPointData()->AddArray(tautline::makeMarkers("BoundaryMarker", made.pointMarkers));
  vtkNew<vtkUnsignedCharArray> fixed;
  fixed->SetName("Fixed");
  for (const int marker : made.pointMarkers)
  {
    fixed->InsertNextValue(marker != 0);
  }
  output->GetPointData()->AddArray(fixed);
  if (std::string(info.name) == "square")
  {
    output->GetCellData()->AddArray(tautline::makeMarkers("Reference", made.references));
  }
  boundary->SetPoints(output->GetPoints());
  if (info.moving)
  {
    addMotion(info, this->Amount, made, output, boundary);
  }
  const auto pieces = tautline::makeCells(made.boundary, made.dimension);
  made.dimension == 2 ? boundary->SetLines(pieces) : boundary->SetPolys(pieces);
  boundary->GetCellData()->AddArray(tautline::makeMarkers("BoundaryMarker", made.boundaryMarkers));
  return 1;
}

//------------------------------------------------------------------------------
void vtkDomainSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Domain: " << vtkDomainSource::GetDomainName(this->Domain) << "\n";
  os << indent << "NumberOfCells: " << this->NumberOfCells << "\n";
  os << indent << "Amount: " << this->Amount << "\n";
  os << indent << "ElementSize: " << this->ElementSize << "\n";
  os << indent << "AspectRatio: " << this->AspectRatio << "\n";
  os << indent << "LayerWidth: " << this->LayerWidth << "\n";
  os << indent << "TimeLimit: " << this->TimeLimit << "\n";
}
