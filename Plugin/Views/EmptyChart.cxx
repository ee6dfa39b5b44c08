// SPDX-License-Identifier: BSD-3-Clause
#include "EmptyChart.h"

#include "ProxyKind.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqDataRepresentation.h"
#include "pqObjectBuilder.h"
#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqView.h"

#include "vtkNew.h"
#include "vtkPVDataInformation.h"
#include "vtkSMParaViewPipelineControllerWithRendering.h"
#include "vtkSMProxy.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMViewLayoutProxy.h"
#include "vtkSMViewProxy.h"

#include <QVariant>

namespace
{
/// Property of a source: the number of the output whose chart was closed.
constexpr const char* Closed = "TautlineClosedChart";

/// Whether there is nothing to draw; a line needs two rows.
bool isEmpty(pqOutputPort* table)
{
  constexpr int fewest = 2;
  const char* study = "Study"; // of Solver Study, drawn as bars
  const vtkTypeInt64 rows = table->getDataInformation()->GetNumberOfRows();
  return rows < (table->getPortName() == study ? 1 : fewest);
}
}

//------------------------------------------------------------------------------
void tautline::closeNeedlessChart(pqDataRepresentation* chart)
{
  pqView* view = chart->getView();
  pqOutputPort* table = chart->getOutputPortFromInput();
  const bool inDock = tautline::isDrawnInDock(table->getSource()->getProxy());
  if (!view || !view->getProxy()->GetProperty("LeftAxisLogScale") || (!inDock && !isEmpty(table)) ||
    view->getNumberOfRepresentations() > 1)
  {
    return;
  }
  if (!inDock)
  {
    table->getSource()->setProperty(Closed, table->getPortNumber());
  }
  pqObjectBuilder* builder = pqApplicationCore::instance()->getObjectBuilder();
  vtkSMViewLayoutProxy* layout = vtkSMViewLayoutProxy::FindLayout(view->getViewProxy());
  const int place = layout ? layout->GetViewLocation(view->getViewProxy()) : -1;
  builder->destroy(chart);
  builder->destroy(view);
  if (place > 0) // not the only view
  {
    layout->Collapse(place);
  }
}

//------------------------------------------------------------------------------
void tautline::openClosedChart(pqPipelineSource* source)
{
  const QVariant port = source->property(Closed);
  pqView* view = pqActiveObjects::instance().activeView();
  if (!port.isValid() || !view || isEmpty(source->getOutputPort(port.toInt())))
  {
    return;
  }
  source->setProperty(Closed, QVariant());
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  vtkSMViewProxy* mesh = view->getViewProxy();
  vtkSMViewProxy* chart =
    controller->ShowInPreferredView(source->getSourceProxy(), port.toInt(), mesh);
  if (chart && !vtkSMViewLayoutProxy::FindLayout(chart))
  {
    vtkSMViewLayoutProxy* layout = vtkSMViewLayoutProxy::FindLayout(mesh);
    controller->AssignViewToLayout(chart, layout, layout ? layout->GetViewLocation(mesh) : 0);
  }
}
