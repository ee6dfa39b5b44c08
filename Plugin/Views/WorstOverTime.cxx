// SPDX-License-Identifier: BSD-3-Clause
#include "WorstOverTime.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqObjectBuilder.h"
#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqServer.h"
#include "pqTimeKeeper.h"
#include "pqUndoStack.h"
#include "pqView.h"

#include "vtkDataObject.h"
#include "vtkNew.h"
#include "vtkSMParaViewPipelineControllerWithRendering.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMViewLayoutProxy.h"
#include "vtkSMViewProxy.h"
#include "vtkSmartPointer.h"

namespace tautline
{
namespace
{

constexpr const char* Series = "SeriesVisibility";

/// A new chart below or beside the active view.
vtkSMViewProxy* newChart(pqServer* server)
{
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  vtkSmartPointer<vtkSMProxy> made;
  made.TakeReference(server->proxyManager()->NewProxy("views", "XYChartView"));
  auto* chart = vtkSMViewProxy::SafeDownCast(made);
  if (!chart)
  {
    return nullptr;
  }
  controller->InitializeProxy(chart);
  controller->RegisterViewProxy(chart);
  pqView* active = pqActiveObjects::instance().activeView();
  vtkSMViewLayoutProxy* layout =
    active ? vtkSMViewLayoutProxy::FindLayout(active->getViewProxy()) : nullptr;
  controller->AssignViewToLayout(
    chart, layout, layout ? layout->GetViewLocation(active->getViewProxy()) : 0);
  return chart;
}

/// Shows only the series whose names start with the given text.
void showSeries(vtkSMProxy* shown, const std::string& beginning)
{
  vtkSMPropertyHelper visible(shown, Series, true);
  constexpr unsigned int perSeries = 2; // name and state
  for (unsigned int i = 0; i + 1 < visible.GetNumberOfElements(); i += perSeries)
  {
    const std::string name = visible.GetAsString(i);
    visible.Set(i + 1, name.compare(0, beginning.size(), beginning) == 0 ? "1" : "0");
  }
  shown->UpdateVTKObjects();
}

} // anonymous namespace

//------------------------------------------------------------------------------
bool hasTimeSteps(pqOutputPort* mesh)
{
  return mesh->getServer()->getTimeKeeper()->getNumberOfTimeStepValues() > 1;
}

//------------------------------------------------------------------------------
std::string plotWorstOverTime(pqOutputPort* mesh, const std::string& array, bool largest)
{
  if (!hasTimeSteps(mesh))
  {
    return "There is only one time step: open a time series, or switch Animation on.";
  }
  const pqScopedUndoSet oneStep("Plot Worst over Time");
  pqPipelineSource* plot = pqApplicationCore::instance()->getObjectBuilder()->createFilter(
    "filters", "PlotDataOverTime", mesh->getSource(), mesh->getPortNumber());
  vtkSMViewProxy* chart = plot ? newChart(mesh->getServer()) : nullptr;
  if (!chart)
  {
    return "The filter Plot Data Over Time is not available.";
  }
  plot->rename(QString("%1 over time").arg(QString::fromStdString(array)));
  vtkSMPropertyHelper(plot->getProxy(), "FieldAssociation").Set(vtkDataObject::CELL);
  plot->getProxy()->UpdateVTKObjects();
  plot->updatePipeline();
  plot->setModifiedState(pqProxy::UNMODIFIED);
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  vtkSMProxy* shown = controller->Show(plot->getSourceProxy(), 0, chart);
  if (shown)
  {
    showSeries(shown, (largest ? "max(" : "min(") + array + ")");
  }
  vtkSMPropertyHelper(chart, "LeftAxisTitle").Set(("Worst " + array).c_str());
  vtkSMPropertyHelper(chart, "BottomAxisTitle").Set("Time");
  chart->UpdateVTKObjects();
  chart->StillRender();
  return {};
}

} // namespace tautline
