#include "pqTautlineCharts.h"

#include "ProxyKind.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqDataRepresentation.h"
#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqRenderView.h"
#include "pqServerManagerModel.h"

#include "vtkDataObject.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVDataSetAttributesInformation.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"

#include <QPointer>
#include <QTimer>

#include <string>
#include <vector>

namespace
{
constexpr const char* RightAxis = "1"; // vtkChart: BOTTOM_RIGHT
constexpr const char* Visibility = "SeriesVisibility";
constexpr const char* Corner = "SeriesPlotCorner";

pqServerManagerModel* model()
{
  pqApplicationCore* core = pqApplicationCore::instance();
  return core ? core->getServerManagerModel() : nullptr;
}

/// The columns of a table with their smallest values.
struct Column
{
  std::string name;
  double smallest;
};
std::vector<Column> columnsOf(pqOutputPort* port)
{
  std::vector<Column> columns;
  vtkPVDataSetAttributesInformation* rows =
    port->getDataInformation()->GetAttributeInformation(vtkDataObject::ROW);
  for (int i = 0; i < rows->GetNumberOfArrays(); ++i)
  {
    vtkPVArrayInformation* array = rows->GetArrayInformation(i);
    columns.push_back({ array->GetName(), array->GetComponentRange(0)[0] });
  }
  return columns;
}

bool endsWith(const std::string& text, const std::string& ending)
{
  return text.size() >= ending.size() &&
    text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

void setSeries(vtkSMProxy* chart, const char* property, const std::string& name, const char* value)
{
  if (chart->GetProperty(property))
  {
    vtkSMPropertyHelper(chart, property).SetStatus(name.c_str(), value);
  }
}

void arrangeHistory(vtkSMProxy* chart, vtkSMProxy* view, const std::vector<Column>& columns)
{
  for (const Column& column : columns)
  {
    if (column.name == "Objective")
    {
      for (const Column& other : columns)
      {
        if (other.name != column.name)
        {
          setSeries(chart, Corner, other.name, RightAxis);
        }
      }
      // An objective of untangling ends at 0.
      vtkSMPropertyHelper(view, "LeftAxisLogScale").Set(column.smallest > 0 ? 1 : 0);
      vtkSMPropertyHelper(view, "LeftAxisTitle").Set(column.name.c_str());
      vtkSMPropertyHelper(view, "RightAxisTitle").Set("Other series");
      vtkSMPropertyHelper(view, "BottomAxisTitle").Set("Iteration");
      return;
    }
  }
}

void arrangeDistribution(vtkSMProxy* chart, vtkSMProxy* view, const std::vector<Column>& columns)
{
  const std::string value = " value", count = " count";
  for (const Column& column : columns)
  {
    if (endsWith(column.name, value))
    {
      const std::string metric = column.name.substr(0, column.name.size() - value.size());
      vtkSMPropertyHelper(chart, "UseIndexForXAxis").Set(0);
      vtkSMPropertyHelper(chart, "XArrayName").Set(column.name.c_str());
      for (const Column& other : columns)
      {
        setSeries(chart, Visibility, other.name, other.name == metric + count ? "1" : "0");
      }
      vtkSMPropertyHelper(view, "BottomAxisTitle").Set(metric.c_str());
      vtkSMPropertyHelper(view, "LeftAxisTitle").Set("Elements");
      return;
    }
  }
}
}

//------------------------------------------------------------------------------
void pqTautlineCharts::startup()
{
  QObject::connect(
    model(), &pqServerManagerModel::representationAdded, this, &pqTautlineCharts::added);
}

//------------------------------------------------------------------------------
void pqTautlineCharts::shutdown()
{
  if (model())
  {
    QObject::disconnect(model(), nullptr, this, nullptr);
  }
}

//------------------------------------------------------------------------------
void pqTautlineCharts::added(pqRepresentation* shown)
{
  // After ParaView has set the defaults, and added the representation to a view.
  const QPointer<pqDataRepresentation> chart = qobject_cast<pqDataRepresentation*>(shown);
  QTimer::singleShot(0, this,
    [this, chart]
    {
      if (chart && chart->getInput() && tautline::isTautline(chart->getInput()->getProxy()))
      {
        this->arrange(chart);
      }
    });
}

//------------------------------------------------------------------------------
void pqTautlineCharts::arrange(pqDataRepresentation* chart)
{
  pqView* view = chart->getView();
  if (!view || !view->getProxy()->GetProperty("LeftAxisLogScale"))
  {
    return;
  }
  pqOutputPort* port = chart->getOutputPortFromInput();
  const std::vector<Column> columns = columnsOf(port);
  if (port->getPortName() == "History")
  {
    arrangeHistory(chart->getProxy(), view->getProxy(), columns);
  }
  else if (port->getPortName() == "Distribution")
  {
    arrangeDistribution(chart->getProxy(), view->getProxy(), columns);
  }
  chart->getProxy()->UpdateVTKObjects();
  view->getProxy()->UpdateVTKObjects();
  chart->renderViewEventually();

  constexpr int meshPort = 0;
  if (pqActiveObjects::instance().activeView() == view)
  {
    pqOutputPort* mesh = port->getSource()->getOutputPort(meshPort);
    for (pqView* other : port->getSource()->getViews())
    {
      pqDataRepresentation* drawn = mesh->getRepresentation(other);
      if (qobject_cast<pqRenderView*>(other) && drawn && drawn->isVisible())
      {
        pqActiveObjects::instance().setActiveView(other);
        return;
      }
    }
  }
}
