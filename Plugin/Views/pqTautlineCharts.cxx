// SPDX-License-Identifier: BSD-3-Clause
#include "pqTautlineCharts.h"

#include "EmptyChart.h"
#include "FetchOutput.h"
#include "LoadingState.h"
#include "ProxyKind.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqDataRepresentation.h"
#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqPropertiesPanel.h"
#include "pqRenderView.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"

#include "vtkAbstractArray.h"
#include "vtkAxis.h"
#include "vtkChartXY.h"
#include "vtkDataObject.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVDataSetAttributesInformation.h"
#include "vtkSMContextViewProxy.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkTable.h"
#include "vtkTextProperty.h"
#include "vtkVariant.h"

#include <QPointer>
#include <QTimer>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

namespace
{
constexpr const char *LeftAxis = "0", *RightAxis = "1"; // vtkChart: BOTTOM_LEFT, BOTTOM_RIGHT
/// As in the run dock.
constexpr std::array<const char*, 3> LeftColor = { "0.12", "0.47", "0.71" };
constexpr std::array<const char*, 3> RightColor = { "0.84", "0.38", "0.06" };
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

/// The columns of a table with their smallest and largest values.
struct Column
{
  std::string name;
  double smallest, largest;
};

/// Whether a logarithmic axis can show a column. It cannot show 0, the final objective of
/// untangling, and VTK draws no line if the logarithms differ by less than one percent.
bool suitsLogarithms(const Column& column)
{
  constexpr double leastDifference = 0.02;
  if (!(column.smallest > 0))
  {
    return false;
  }
  const double low = std::log10(column.smallest), high = std::log10(column.largest);
  return high - low > leastDifference * std::max(std::abs(low), std::abs(high));
}

std::vector<Column> columnsOf(pqOutputPort* port)
{
  std::vector<Column> columns;
  vtkPVDataSetAttributesInformation* rows =
    port->getDataInformation()->GetAttributeInformation(vtkDataObject::ROW);
  for (int i = 0; i < rows->GetNumberOfArrays(); ++i)
  {
    vtkPVArrayInformation* array = rows->GetArrayInformation(i);
    const double* range = array->GetComponentRange(0);
    columns.push_back({ array->GetName(), range[0], range[1] });
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

/// The color of a series: red, green and blue from 0 to 1, as in the property.
void setColor(vtkSMProxy* chart, const std::string& name, const std::array<const char*, 3>& rgb)
{
  constexpr unsigned int perSeries = 4; // the name and the three values
  vtkSMPropertyHelper colors(chart, "SeriesColor", true);
  for (unsigned int i = 0; i + perSeries <= colors.GetNumberOfElements(); i += perSeries)
  {
    if (colors.GetAsString(i) == name)
    {
      for (unsigned int c = 0; c < rgb.size(); ++c)
      {
        colors.Set(i + 1 + c, rgb[c]);
      }
    }
  }
}

void setTitle(vtkSMProxy* view, const char* axis, const char* title)
{
  vtkSMPropertyHelper(view, axis).Set(title);
}

/// The objective on the left axis; the worst element of each metric, or the inverted ones, on the
/// right axis.
void arrangeObjective(
  vtkSMProxy* chart, vtkSMProxy* view, const std::vector<Column>& columns, const Column& objective)
{
  const std::string worst = " worst";
  std::vector<std::string> onTheRight;
  for (const Column& column : columns)
  {
    if (endsWith(column.name, worst))
    {
      onTheRight.push_back(column.name);
    }
  }
  if (onTheRight.empty())
  {
    onTheRight = { "Inverted" };
  }
  std::string title;
  for (const Column& column : columns)
  {
    const bool right =
      std::find(onTheRight.begin(), onTheRight.end(), column.name) != onTheRight.end();
    const bool left = column.name == objective.name;
    setSeries(chart, Corner, column.name, left ? LeftAxis : RightAxis);
    setSeries(chart, Visibility, column.name, left || right ? "1" : "0");
    if (left || (right && onTheRight.size() == 1))
    {
      setColor(chart, column.name, left ? LeftColor : RightColor);
    }
    title += right ? (title.empty() ? "" : ", ") + column.name : "";
  }
  vtkSMPropertyHelper(view, "LeftAxisLogScale").Set(suitsLogarithms(objective) ? 1 : 0);
  setTitle(view, "LeftAxisTitle", objective.name.c_str());
  setTitle(view, "RightAxisTitle", title.c_str());
  const bool blocks = std::any_of(
    columns.begin(), columns.end(), [](const Column& column) { return column.name == "Block"; });
  setTitle(view, "BottomAxisTitle", blocks ? "Iterations, block after block" : "Iteration");
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
      arrangeObjective(chart, view, columns, column);
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

/// The chart drawn by a view on this computer.
vtkChartXY* drawnChart(vtkSMProxy* view)
{
  auto* context = vtkSMContextViewProxy::SafeDownCast(view);
  return context ? vtkChartXY::SafeDownCast(context->GetContextItem()) : nullptr;
}

/**
 * The names below the bars are vertical, because they are longer than the bars are wide. The bars
 * have gaps: vtkChartXY sets their width to a fraction of the distance between the first two rows,
 * which can be any whole number for ranks.
 */
void drawStudy(vtkSMProxy* view, vtkAbstractArray* ranks)
{
  constexpr double upwards = 90.0; // degrees
  constexpr double barWidth = 0.8; // of the distance between two bars
  vtkChartXY* drawn = drawnChart(view);
  if (!drawn)
  {
    return;
  }
  vtkTextProperty* labels = drawn->GetAxis(vtkAxis::BOTTOM)->GetLabelProperties();
  labels->SetOrientation(upwards);
  labels->SetJustificationToRight();
  labels->SetVerticalJustificationToCentered();
  if (ranks->GetNumberOfTuples() > 1)
  {
    const int distance =
      std::abs(ranks->GetVariantValue(1).ToInt() - ranks->GetVariantValue(0).ToInt());
    // Each block has its own ranks: the first two, from different blocks, may be equal.
    drawn->SetBarWidthFraction(static_cast<float>(barWidth / std::max(distance, 1)));
  }
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
    const auto place = static_cast<unsigned int>(2 * row);
    labels.Set(place, ranks->GetVariantValue(row).ToString().c_str());
    labels.Set(place + 1, names->GetVariantValue(row).ToString().c_str());
  }
  constexpr int fontSize = 10;
  vtkSMPropertyHelper(view, "BottomAxisUseCustomLabels").Set(1);
  vtkSMPropertyHelper(view, "BottomAxisLabelFontSize").Set(fontSize);
  vtkSMPropertyHelper(view, "ShowLegend").Set(0); // one series, whose name is the axis title
  setTitle(view, "LeftAxisTitle", "Total time (s)");
  drawStudy(view, ranks);
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
  const QPointer<pqDataRepresentation> chart = qobject_cast<pqDataRepresentation*>(shown);
  if (tautline::isLoadingState() || !chart)
  {
    return;
  }
  // The representation gets its input later; the proxy already has it.
  auto* source = model()->findItem<pqPipelineSource*>(
    vtkSMPropertyHelper(chart->getProxy(), "Input", true).GetAsProxy());
  if (!source || !tautline::isTautline(source->getProxy()))
  {
    return;
  }
  if (source->modifiedState() == pqProxy::UNINITIALIZED)
  {
    this->OpenedByApply.append(chart);
    for (auto* panel : pqCoreUtilities::mainWidget()->findChildren<pqPropertiesPanel*>())
    {
      QObject::connect(panel, QOverload<>::of(&pqPropertiesPanel::applied), this,
        &pqTautlineCharts::applied, Qt::UniqueConnection);
    }
  }
  // After ParaView has set the defaults and added the representation to a view.
  QTimer::singleShot(0, this,
    [this, chart]
    {
      if (chart && chart->getInput())
      {
        this->arrange(chart);
      }
    });
}

//------------------------------------------------------------------------------
void pqTautlineCharts::applied()
{
  // During Apply, even while it processes events, ParaView keeps lists of the views.
  QTimer::singleShot(0, this,
    [this]
    {
      const pqScopedUndoExclude notUndone;
      for (const QPointer<pqDataRepresentation>& chart : std::exchange(this->OpenedByApply, {}))
      {
        if (chart && chart->getInput())
        {
          tautline::closeNeedlessChart(chart);
        }
      }
      for (pqPipelineSource* source : model()->findItems<pqPipelineSource*>())
      {
        tautline::openClosedChart(source);
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
  // Another run has other ranks. Fetching updates a pipeline, so it follows the update.
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
  const pqScopedUndoExclude notUndone;
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
