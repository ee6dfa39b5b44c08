// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSilhouetteMesher.h"

#include "GatheredExecution.h"
#include "Processes.h"
#include "ProgressStep.h"
#include "ShapeAdapter.h"
#include "ValidateInput.h"
#include "tautline/Core/Memory.h"

#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <optional>
#include <sstream>

vtkStandardNewMacro(vtkSilhouetteMesher);

namespace
{
/// Adds the data of the shape as field arrays, in the unit of space.
void addFacts(
  vtkDataSet* output, const tautline::Silhouette& shape, const tautline::GreyImage& image)
{
  const auto add = [output](const char* name, std::initializer_list<double> values)
  {
    vtkNew<vtkDoubleArray> array;
    array->SetName(name);
    array->SetNumberOfComponents(static_cast<int>(values.size()));
    array->InsertNextTuple(values.begin());
    output->GetFieldData()->AddArray(array);
  };
  double centre[3];
  image.toSpace(shape.centre, centre);
  const double pixel = image.pixelSize();
  add("CentreOfMass", { centre[0], centre[1] });
  add("MaximumDistance", { shape.maxDistance * pixel });
  add("Area", { shape.area * pixel * pixel });
  add("Components", { static_cast<double>(shape.components) });
  add("Holes", { static_cast<double>(shape.holes) });
  add("TouchesBorder", { shape.touchesBorder ? 1.0 : 0.0 });
}

/// The traced outline as one closed line.
void fillOutline(
  vtkPolyData* output, const tautline::Silhouette& shape, const tautline::GreyImage& image)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell(static_cast<int>(shape.outline.size()) + 1);
  for (const tautline::Vec2& p : shape.outline)
  {
    double x[3];
    image.toSpace(p, x);
    lines->InsertCellPoint(points->InsertNextPoint(x));
  }
  lines->InsertCellPoint(0);
  output->SetPoints(points);
  output->SetLines(lines);
}

std::string summaryOf(const tautline::PolygonMesh& mesh, const tautline::Silhouette& shape)
{
  std::ostringstream text;
  text << mesh.points.size() << " vertices, " << mesh.triangles.size() << " triangles";
  if (shape.components > 1)
  {
    text << "; the largest of " << shape.components << " components";
  }
  if (shape.holes > 0)
  {
    text << "; " << shape.holes << (shape.holes == 1 ? " hole" : " holes") << " ignored";
  }
  if (shape.touchesBorder)
  {
    text << "; touches the border of the image";
  }
  return text.str() + ".";
}
}

//------------------------------------------------------------------------------
vtkSilhouetteMesher::vtkSilhouetteMesher()
{
  this->SetNumberOfOutputPorts(2);
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
}

//------------------------------------------------------------------------------
int vtkSilhouetteMesher::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

//------------------------------------------------------------------------------
int vtkSilhouetteMesher::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkUnstructuredGrid" : "vtkPolyData");
  return 1;
}

//------------------------------------------------------------------------------
vtkTypeBool vtkSilhouetteMesher::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  return tautline::processGathered(this, { this->TimeLimit, nullptr },
    tautline::GatheredResult::OnFirst, {}, request, inputs, outputs,
    [&] { return this->Superclass::ProcessRequest(request, inputs, outputs); });
}

//------------------------------------------------------------------------------
int vtkSilhouetteMesher::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkImageData* input = vtkImageData::GetData(inputVector[0]);
  vtkUnstructuredGrid* output = vtkUnstructuredGrid::GetData(outputVector, 0);
  vtkPolyData* outline = vtkPolyData::GetData(outputVector, 1);
  this->Summary.clear();
  this->NumberOfComponents = this->NumberOfHoles = 0;
  if (!input)
  {
    vtkWarningMacro(<< tautline::leftOut(vtkDataObject::GetData(inputVector[0]), "image"));
    return 1;
  }
  try
  {
    tautline::requireFirstProcess(this, 0, input, "Silhouette to Mesh");
    tautline::validateInput(input);
    if (input->GetNumberOfPoints() == 0)
    {
      tautline::warnOfEmptyInput(this, input, "points");
      return 1;
    }
    const tautline::GreyImage image(input, this->GetInputArrayToProcess(0, input));
    tautline::SilhouetteOptions options;
    options.foreground = static_cast<tautline::Foreground>(this->Foreground);
    if (this->UseThreshold)
    {
      if (!std::isfinite(this->Threshold))
      {
        throw tautline::Error("The threshold is not finite.");
      }
      options.threshold = this->Threshold;
    }
    std::optional<tautline::ProgressStep> progress(std::in_place, this, 0.0, 0.5);
    const tautline::Silhouette shape = tautline::traceSilhouette(image.view(), options);
    progress.emplace(this, 0.5, 1.0);
    const tautline::PolygonMesh mesh =
      tautline::triangulatePolygon(tautline::approximateOutline(shape.outline, this->Spacing));
    tautline::fillGrid(output, mesh, mesh.points, image);
    tautline::addOrders(output, mesh);

    addFacts(output, shape, image);
    fillOutline(outline, shape, image);
    this->NumberOfComponents = static_cast<int>(shape.components);
    this->NumberOfHoles = static_cast<int>(shape.holes);
    this->Summary = summaryOf(mesh, shape);
  }
  catch (const std::exception& error)
  {
    output->Initialize();
    outline->Initialize();
    vtkErrorMacro(<< tautline::errorText(error, "choose a larger spacing or a smaller image"));
    return 0;
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkSilhouetteMesher::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Spacing: " << this->Spacing << "\n";
  os << indent << "UseThreshold: " << this->UseThreshold << "\n";
  os << indent << "Threshold: " << this->Threshold << "\n";
  os << indent << "Foreground: " << this->Foreground << "\n";
  os << indent << "Summary: " << this->Summary << "\n";
  os << indent << "TimeLimit: " << this->TimeLimit << "\n";
}
