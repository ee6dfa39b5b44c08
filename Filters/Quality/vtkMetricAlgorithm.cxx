// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMetricAlgorithm.h"

#include "MetricSelection.h"

//------------------------------------------------------------------------------
vtkMetricAlgorithm::vtkMetricAlgorithm()
  : Selection(std::make_unique<tautline::MetricSelection>())
{
}

//------------------------------------------------------------------------------
vtkMetricAlgorithm::~vtkMetricAlgorithm() = default;

//------------------------------------------------------------------------------
void vtkMetricAlgorithm::AddMetric(int metric)
{
  try
  {
    if (this->Selection->add(metric))
    {
      this->Modified();
    }
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< error.what());
  }
}

//------------------------------------------------------------------------------
void vtkMetricAlgorithm::AddMetricByName(const char* name)
{
  try
  {
    if (this->Selection->addByName(name))
    {
      this->Modified();
    }
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< error.what());
  }
}

//------------------------------------------------------------------------------
void vtkMetricAlgorithm::ClearMetrics()
{
  if (this->Selection->clear())
  {
    this->Modified();
  }
}

//------------------------------------------------------------------------------
int vtkMetricAlgorithm::GetNumberOfMetrics() const
{
  return this->Selection->count();
}

//------------------------------------------------------------------------------
std::string vtkMetricAlgorithm::GetUserMetrics()
{
  return tautline::listUserMetrics();
}

//------------------------------------------------------------------------------
std::string vtkMetricAlgorithm::FindSettingProblem() const
{
  return this->Selection->problem();
}

//------------------------------------------------------------------------------
void vtkMetricAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Metrics:";
  for (const tautline::Metric metric : this->Selection->metrics())
  {
    os << " " << tautline::metricInfo(metric).name;
  }
  os << "\n";
}
