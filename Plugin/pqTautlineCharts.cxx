#include "pqTautlineCharts.h"

#include "FetchOutput.h"
#include "ProxyKind.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqDataRepresentation.h"
#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqRenderView.h"
#include "pqServerManagerModel.h"

#include "vtkAbstractArray.h"
#include "vtkDataObject.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVDataSetAttributesInformation.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkTable.h"
#include "vtkVariant.h"

#include <QPointer>
#include <QString>
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

constexpr const char* StudyPort = "Study";
constexpr const char* Rank = "N rank"; // a column of Solver Study
constexpr const char* XAxis = "XArrayName";
constexpr const char* ByIndex = "UseIndexForXAxis";

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

void setTitle(vtkSMProxy* view, const char* axis, const char* title)
{
  vtkSMPropertyHelper(view, axis).Set(title);
}

void arrangeHistory(vtkSMProxy* chart, vtkSMProxy* view, const std::vector<Column>& columns)
{
  for (const Column& column : columns)
  {
    if (column.name == "Log10 residual") // of Solve PDE
    {
      setTitle(view, "LeftAxisTitle", column.name.c_str());
      setTitle(view, "BottomAxisTitle", "Iteration");
      return;
    }
    if (column.name == "Worst imr") // of Improve Mesh, beside two angles
    {
      setSeries(chart, Corner, column.name, RightAxis);
      setTitle(view, "LeftAxisTitle", "Angle (degrees)");
      setTitle(view, "RightAxisTitle", column.name.c_str());
      setTitle(view, "BottomAxisTitle", "Pass");
      return;
    }
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
      setTitle(view, "LeftAxisTitle", column.name.c_str());
      setTitle(view, "RightAxisTitle", "Other series");
      setTitle(view, "BottomAxisTitle", "Iteration");
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
      vtkSMPropertyHelper(chart, ByIndex).Set(0);
      vtkSMPropertyHelper(chart, XAxis).Set(column.name.c_str());
      for (const Column& other : columns)
      {
        setSeries(chart, Visibility, other.name, other.name == metric + count ? "1" : "0");
      }
      setTitle(view, "BottomAxisTitle", metric.c_str());
      setTitle(view, "LeftAxisTitle", "Elements");
      return;
    }
  }
}

/// The name of a combination on lines of its own: solver, preconditioner. Neighbours are shifted
/// by two lines, since the bars are narrower than the names.
QString barLabel(const std::string& name, int rank)
{
  constexpr int levels = 4, linesOfName = 2;
  const QString shift(linesOfName * ((rank - 1) % levels), '\n');
  return shift + QString::fromStdString(name).replace(" + ", "\n").replace(", ", "\n");
}

/// Bars in the order of the ranks, with the names of the combinations.
void arrangeStudy(vtkSMProxy* chart, vtkSMProxy* view, pqOutputPort* port)
{
  const auto data = tautline::fetchOutput(port->getSource(), StudyPort);
  vtkTable* table = vtkTable::SafeDownCast(data);
  vtkAbstractArray* names = table ? table->GetColumnByName("Combination") : nullptr;
  vtkAbstractArray* ranks = table ? table->GetColumnByName(Rank) : nullptr;
  if (!names || !ranks)
  {
    return;
  }
  vtkSMPropertyHelper(chart, ByIndex).Set(0);
  vtkSMPropertyHelper(chart, XAxis).Set(Rank);
  vtkSMPropertyHelper labels(view, "BottomAxisLabels");
  labels.SetNumberOfElements(0);
  for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
  {
    const int rank = ranks->GetVariantValue(row).ToInt();
    const std::string name = names->GetVariantValue(row).ToString();
    const auto place = static_cast<unsigned int>(2 * row);
    labels.Set(place, std::to_string(rank).c_str());
    labels.Set(place + 1, barLabel(name, rank).toUtf8().constData());
  }
  constexpr int fontSize = 8;
  vtkSMPropertyHelper(view, "BottomAxisUseCustomLabels").Set(1);
  vtkSMPropertyHelper(view, "BottomAxisLabelFontSize").Set(fontSize);
  setTitle(view, "LeftAxisTitle", "Total time (s)");
}
}

//------------------------------------------------------------------------------
void pqTautlineCharts::startup()
{
  QObject::connect(
    model(), &pqServerManagerModel::representationAdded, this, &pqTautlineCharts::added);
  QObject::connect(model(), &pqServerManagerModel::dataUpdated, this, &pqTautlineCharts::updated);
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
void pqTautlineCharts::updated(pqPipelineSource* source)
{
  if (!tautline::isTautline(source->getProxy()) || !source->getOutputPort(StudyPort))
  {
    return;
  }
  // Another run has other ranks. Fetching updates a pipeline: after the update.
  const QPointer<pqPipelineSource> study = source;
  QTimer::singleShot(0, this,
    [this, study]
    {
      for (pqView* view : study ? study->getViews() : QList<pqView*>())
      {
        if (pqDataRepresentation* chart = study->getOutputPort(StudyPort)->getRepresentation(view))
        {
          this->arrange(chart);
        }
      }
    });
}

//------------------------------------------------------------------------------
void pqTautlineCharts::stateChanged(pqServerManagerModelItem* item)
{
  auto* source = qobject_cast<pqPipelineSource*>(item);
  if (source && source->modifiedState() == pqProxy::UNMODIFIED)
  {
    this->updated(source);
  }
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
  else if (port->getPortName() == StudyPort)
  {
    // During Apply the data cannot be fetched yet.
    QObject::connect(port->getSource(), &pqPipelineSource::modifiedStateChanged, this,
      &pqTautlineCharts::stateChanged, Qt::UniqueConnection);
    arrangeStudy(chart->getProxy(), view->getProxy(), port);
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
