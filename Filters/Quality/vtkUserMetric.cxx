// SPDX-License-Identifier: BSD-3-Clause
#include "vtkUserMetric.h"

#include "vtkCommand.h"
#include "vtkDoubleArray.h"
#include "vtkObjectFactory.h"
#include "vtkSmartPointer.h"

#include "tautline/Quality/UserMetric.h"

#include <algorithm>

vtkStandardNewMacro(vtkUserMetric);

struct vtkUserMetric::Facts : tautline::MetricDescription
{
};

//------------------------------------------------------------------------------
vtkUserMetric::vtkUserMetric()
  : TheFacts(std::make_unique<Facts>())
{
  this->Corners->SetNumberOfComponents(3);
}

//------------------------------------------------------------------------------
vtkUserMetric::~vtkUserMetric() = default;

//------------------------------------------------------------------------------
void vtkUserMetric::SetName(const char* text)
{
  this->TheFacts->name = text ? text : "";
}

void vtkUserMetric::SetLabel(const char* text)
{
  this->TheFacts->label = text ? text : "";
}

void vtkUserMetric::SetSymbol(const char* text)
{
  this->TheFacts->symbol = text ? text : "";
}

void vtkUserMetric::SetAliases(const char* text)
{
  this->TheFacts->aliases = text ? text : "";
}

void vtkUserMetric::SetFormula(const char* text)
{
  this->TheFacts->formula = text ? text : "";
}

void vtkUserMetric::SetSource(const char* text)
{
  this->TheFacts->source = text ? text : "";
}

void vtkUserMetric::SetUnit(const char* text)
{
  this->TheFacts->unit = text ? text : "";
}

void vtkUserMetric::SetFullRange(double low, double high)
{
  this->TheFacts->full = { low, high };
}

void vtkUserMetric::SetAcceptableRange(double low, double high)
{
  this->TheFacts->acceptable = { low, high };
}

void vtkUserMetric::SetIdeal(double value)
{
  this->TheFacts->ideal = value;
}

void vtkUserMetric::SetDirection(int direction)
{
  if (direction < 0 || direction > 2)
  {
    vtkErrorMacro(<< "The direction " << direction << " is not 0, 1 or 2.");
    return;
  }
  this->TheFacts->direction = static_cast<tautline::Direction>(direction);
}

void vtkUserMetric::SetInvariances(bool scale, bool rotation)
{
  this->TheFacts->scaleInvariant = scale;
  this->TheFacts->rotationInvariant = rotation;
}

void vtkUserMetric::ClearCellTypes()
{
  this->TheFacts->cellTypes = 0;
}

void vtkUserMetric::AddCellType(int type)
{
  const int index = tautline::topologyIndex(static_cast<tautline::CellType>(type));
  if (type < 0 || type > 255 || index < 0)
  {
    vtkErrorMacro(<< "Cells of type " << type
                  << " are not measured: a metric is defined on triangles (5), quadrilaterals (9), "
                     "tetrahedra (10), hexahedra (12), wedges (13) and pyramids (14).");
    return;
  }
  this->TheFacts->cellTypes |= 1u << index;
}

//------------------------------------------------------------------------------
bool vtkUserMetric::AddToRegistry()
{
  // The registry keeps the metric and its observer.
  const vtkSmartPointer<vtkUserMetric> self = this;
  const auto evaluate =
    [self](tautline::CellType type, tautline::Index count, const double* points, double* values)
  {
    const tautline::Index corners = tautline::topology(type).nodes * count;
    self->CellType = static_cast<int>(type);
    self->Failure.clear();
    self->Corners->SetNumberOfTuples(corners);
    std::copy(points, points + 3 * corners, self->Corners->GetPointer(0));
    self->Values->SetNumberOfTuples(count);
    self->Values->Fill(0.0);
    if (!self->HasObserver(vtkCommand::UserEvent))
    {
      self->Failure = "it has no observer of UserEvent";
    }
    self->InvokeEvent(vtkCommand::UserEvent);
    if (self->Failure.empty() &&
      (self->Values->GetNumberOfTuples() != count || self->Values->GetNumberOfComponents() != 1))
    {
      self->Failure = "it gave " + std::to_string(self->Values->GetNumberOfTuples()) +
        " values for " + std::to_string(count) + " cells";
    }
    if (!self->Failure.empty())
    {
      throw tautline::Error("The metric " + self->TheFacts->name + " failed on " +
        std::to_string(count) + " " + tautline::topology(type).plural + ": " + self->Failure + ".");
    }
    std::copy_n(self->Values->GetPointer(0), count, values);
  };
  try
  {
    tautline::registerElementsMetric(*this->TheFacts, evaluate);
    return true;
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< error.what());
    return false;
  }
}

//------------------------------------------------------------------------------
bool vtkUserMetric::RemoveFromRegistry(const char* name)
{
  try
  {
    tautline::unregisterMetric(name ? name : "");
    return true;
  }
  catch (const std::exception& error)
  {
    vtkGenericWarningMacro(<< error.what());
    return false;
  }
}

//------------------------------------------------------------------------------
std::string vtkUserMetric::LoadLibrary(const char* file)
{
  try
  {
    tautline::loadMetrics(file ? file : "");
    return {};
  }
  catch (const std::exception& error)
  {
    return error.what();
  }
}

//------------------------------------------------------------------------------
std::string vtkUserMetric::GetLoadErrors()
{
  tautline::metricRegistry(); // loads the libraries
  return tautline::metricLoadErrors();
}

//------------------------------------------------------------------------------
vtkDoubleArray* vtkUserMetric::GetCorners()
{
  return this->Corners;
}

vtkDoubleArray* vtkUserMetric::GetValues()
{
  return this->Values;
}

void vtkUserMetric::SetFailure(const char* message)
{
  this->Failure = message && *message ? message : "unknown reason";
}

//------------------------------------------------------------------------------
void vtkUserMetric::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Name: " << this->TheFacts->name << "\n"
     << indent << "CellType: " << this->CellType << "\n"
     << indent << "Failure: " << this->Failure << "\n";
}
