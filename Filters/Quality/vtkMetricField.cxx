// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMetricField.h"

#include "MetricSelection.h"
#include "ProgressStep.h"
#include "tautline/Core/Memory.h"
#include "tautline/Quality/MetricField.h"

#include "vtkDataObject.h"
#include "vtkDoubleArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkSignedCharArray.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <cmath>

vtkStandardNewMacro(vtkMetricField);

//------------------------------------------------------------------------------
vtkMetricField::vtkMetricField()
{
  this->SetNumberOfInputPorts(0);
}

//------------------------------------------------------------------------------
vtkMetricField::~vtkMetricField() = default;

//------------------------------------------------------------------------------
void vtkMetricField::GetGrid(int wholeExtent[6], double origin[3], double spacing[3]) const
{
  for (int c = 0; c < 3; ++c)
  {
    const bool flat = c == 2 && this->Cell == TRIANGLE;
    const int last = flat ? 0 : std::max(0, this->Dimensions[c] - 1);
    const double length = this->Bounds[2 * c + 1] - this->Bounds[2 * c];
    wholeExtent[2 * c] = 0;
    wholeExtent[2 * c + 1] = last;
    origin[c] = flat ? 0.0 : this->Bounds[2 * c];
    spacing[c] = last > 0 && length > 0 ? length / last : 1.0;
  }
}

//------------------------------------------------------------------------------
int vtkMetricField::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  vtkInformation* info = outputVector->GetInformationObject(0);
  int extent[6];
  double origin[3], spacing[3];
  this->GetGrid(extent, origin, spacing);
  info->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
  info->Set(vtkDataObject::ORIGIN(), origin, 3);
  info->Set(vtkDataObject::SPACING(), spacing, 3);
  info->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
  const tautline::Metric first = this->GetSelection().metrics().front();
  vtkDataObject::SetActiveAttribute(info, vtkDataObject::FIELD_ASSOCIATION_POINTS,
    tautline::metricInfo(first).name, vtkDataSetAttributes::SCALARS);
  vtkDataObject::SetPointDataActiveScalarInfo(info, VTK_DOUBLE, 1);
  return 1;
}

//------------------------------------------------------------------------------
vtkImageData* vtkMetricField::GetOutput()
{
  return vtkImageData::SafeDownCast(this->GetOutputDataObject(0));
}

//------------------------------------------------------------------------------
int vtkMetricField::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkImageData");
  return 1;
}

//------------------------------------------------------------------------------
int vtkMetricField::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  vtkInformation* info = outputVector->GetInformationObject(0);
  vtkImageData* output = vtkImageData::GetData(info);
  int whole[6], extent[6];
  tautline::FieldGrid grid;
  this->GetGrid(whole, grid.origin.data(), grid.spacing.data());
  info->Get(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(), extent);
  output->SetExtent(extent);
  output->SetOrigin(grid.origin.data());
  output->SetSpacing(grid.spacing.data());
  for (int c = 0; c < 3; ++c)
  {
    grid.first[c] = extent[2 * c];
    grid.size[c] = std::max(0, extent[2 * c + 1] - extent[2 * c] + 1);
  }
  return this->Attempt(outputVector, "choose smaller Dimensions or fewer metrics",
    [&]
    {
      const std::string problem = this->FindSettingProblem();
      if (!problem.empty())
      {
        throw tautline::Error(problem);
      }
      for (int c = 0; c < (this->Cell == TRIANGLE ? 2 : 3); ++c)
      {
        const double length = this->Bounds[2 * c + 1] - this->Bounds[2 * c];
        const bool increases = length > 0 || (length == 0 && this->Dimensions[c] == 1);
        if (this->Dimensions[c] < 1 || !increases || !std::isfinite(length))
        {
          throw tautline::Error(std::string("Along ") + "xyz"[c] +
            ", Bounds must increase and be finite, and Dimensions must be at least 1; equal bounds "
            "need dimension 1.");
        }
      }
      const tautline::MetricField field(
        this->Cell == TRIANGLE ? tautline::CellType::Triangle : tautline::CellType::Tetrahedron,
        { tautline::Vec3{ this->Vertex1[0], this->Vertex1[1], this->Vertex1[2] },
          tautline::Vec3{ this->Vertex2[0], this->Vertex2[1], this->Vertex2[2] },
          tautline::Vec3{ this->Vertex3[0], this->Vertex3[1], this->Vertex3[2] } });
      tautline::EvaluationOptions options;
      options.threads = this->Threads;
      options.parameters.beta = this->Beta;
      if (!std::isfinite(this->Beta))
      {
        throw tautline::Error("Beta must be a finite number.");
      }
      const std::vector<tautline::Metric> metrics = this->GetSelection().metrics();
      tautline::requireMemory(static_cast<double>(grid.count()) *
          static_cast<double>(1 + metrics.size() * sizeof(double)),
        "the field", "choose smaller Dimensions or fewer metrics");
      const auto stepAt = [&](std::size_t step) // one per metric, then one for the signs
      { return static_cast<double>(step) / static_cast<double>(metrics.size() + 1); };
      for (std::size_t i = 0; i < metrics.size() && !this->GetAbortExecute(); ++i)
      {
        const tautline::ProgressStep progress(this, stepAt(i), stepAt(i + 1));
        vtkNew<vtkDoubleArray> values;
        values->SetName(tautline::metricInfo(metrics[i]).name);
        values->SetNumberOfTuples(grid.count());
        field.evaluate(grid, metrics[i], options, values->GetPointer(0));
        output->GetPointData()->AddArray(values);
      }
      output->GetPointData()->SetActiveScalars(tautline::metricInfo(metrics.front()).name);
      vtkNew<vtkSignedCharArray> validity;
      validity->SetName("Validity");
      validity->SetNumberOfTuples(grid.count());
      const tautline::ProgressStep progress(this, stepAt(metrics.size()), 1.0);
      field.classify(grid, validity->GetPointer(0), this->Threads);
      output->GetPointData()->AddArray(validity);
    });
}

//------------------------------------------------------------------------------
void vtkMetricField::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  auto print = [&](const char* name, const auto& numbers)
  {
    os << indent << name << ":";
    for (auto number : numbers)
    {
      os << " " << number;
    }
    os << "\n";
  };
  os << indent << "Cell: " << (this->Cell == TRIANGLE ? "triangle" : "tetrahedron") << "\n";
  print("Vertex1", this->Vertex1);
  print("Vertex2", this->Vertex2);
  print("Vertex3", this->Vertex3);
  print("Bounds", this->Bounds);
  print("Dimensions", this->Dimensions);
  os << indent << "Beta: " << this->Beta << "\n";
}
