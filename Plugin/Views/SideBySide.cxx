// SPDX-License-Identifier: BSD-3-Clause
#include "SideBySide.h"

#include "FetchOutput.h"
#include "ParaViewCompatibility.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqLinksModel.h"
#include "pqObjectBuilder.h"
#include "pqOutputPort.h"
#include "pqPipelineFilter.h"
#include "pqProxy.h"
#include "pqRenderView.h"
#include "pqServer.h"
#include "pqServerManagerModel.h"

#include "vtkNew.h"
#include "vtkPVDataInformation.h"
#include "vtkSMParaViewPipelineControllerWithRendering.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxyManager.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMViewLayoutProxy.h"
#include "vtkSMViewProxy.h"
#include "vtkSmartPointer.h"
#include "vtkTable.h"
#include "vtkType.h"
#include "vtkVariant.h"

#include <QList>
#include <QPointer>
#include <QTimer>

#include <array>
#include <string>

namespace tautline
{
namespace
{

constexpr int MeshPort = 0;
constexpr double Half = 0.5;
constexpr int FontSize = 14;

pqOutputPort* inputOf(pqPipelineSource* source)
{
  auto* filter = qobject_cast<pqPipelineFilter*>(source);
  const QList<pqOutputPort*> ports = filter ? filter->getInputs("Input") : QList<pqOutputPort*>();
  return ports.size() == 1 ? ports.front() : nullptr;
}

/// Element Quality of an output, executed.
pqPipelineSource* measure(pqOutputPort* port, const QString& name)
{
  pqObjectBuilder* builder = pqApplicationCore::instance()->getObjectBuilder();
  pqPipelineSource* quality =
    builder->createFilter("filters", "ElementQuality", port->getSource(), port->getPortNumber());
  if (quality)
  {
    quality->rename(name);
    quality->getProxy()->UpdateVTKObjects();
    quality->updatePipeline();
    quality->setModifiedState(pqProxy::UNMODIFIED);
  }
  return quality;
}

/// "after: worst imr 2.87, 0 inverted"; "before: worst valid imr 99.9, 41 inverted".
QString describe(pqPipelineSource* quality)
{
  const auto data = fetchOutput(quality, "Statistics");
  vtkTable* statistics = vtkTable::SafeDownCast(data);
  if (!statistics || statistics->GetNumberOfRows() == 0)
  {
    return quality->getSMName();
  }
  const auto value = [statistics](const char* column)
  { return QString::fromStdString(statistics->GetValueByName(0, column).ToString()); };
  // The inverse mean ratio of inverted elements is negative: the largest is that of a valid one.
  const bool valid = value("Inverted") != "0" && value("Metric") == "imr";
  const double worst = statistics->GetValueByName(0, valid ? "Maximum" : "Worst").ToDouble();
  return QString("%1: worst%2 %3 %4, %5 inverted")
    .arg(quality->getSMName().toLower(), valid ? " valid" : "", value("Metric"),
      QString::number(worst, 'g', 3), value("Inverted"));
}

/// Hides the legend, also that of the bad elements, which are shown after this.
void hideLegendLater(vtkSMProxy* shown, pqView* view)
{
  const vtkSmartPointer<vtkSMProxy> representation = shown;
  QTimer::singleShot(0, view,
    [representation, view]
    {
      tautline::ColorMaps::SetScalarBarVisibility(representation, view->getViewProxy(), false);
      view->render();
    });
}

/// Shows a text at the top of a view.
void addText(const QString& shown, pqPipelineSource* of, pqView* view)
{
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  pqObjectBuilder* builder = pqApplicationCore::instance()->getObjectBuilder();
  pqPipelineSource* text = builder->createSource("sources", "TextSource", of->getServer());
  text->rename(of->getSMName() + ", text");
  vtkSMPropertyHelper(text->getProxy(), "Text").Set(shown.toUtf8().data());
  text->getProxy()->UpdateVTKObjects();
  text->setModifiedState(pqProxy::UNMODIFIED);
  if (vtkSMProxy* drawn = controller->Show(text->getSourceProxy(), 0, view->getViewProxy()))
  {
    constexpr int upperCenter = 4; // of the property WindowLocation
    vtkSMPropertyHelper(drawn, "WindowLocation", true).Set(upperCenter);
    vtkSMPropertyHelper(drawn, "FontSize", true).Set(FontSize);
    drawn->UpdateVTKObjects();
  }
}

/// Shows the mesh, and a text at the top.
void fill(pqPipelineSource* quality, pqView* view, bool legend)
{
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  vtkSMViewProxy* viewProxy = view->getViewProxy();
  vtkSMProxy* shown = controller->Show(quality->getSourceProxy(), MeshPort, viewProxy);
  const auto data = fetchOutput(quality, "Statistics");
  vtkTable* statistics = vtkTable::SafeDownCast(data);
  if (shown && statistics && statistics->GetNumberOfRows() > 0)
  {
    const std::string metric = statistics->GetValueByName(0, "Metric").ToString();
    tautline::ColorMaps::SetScalarColoring(shown, metric.c_str(), vtkDataObject::CELL);
    tautline::ColorMaps::SetScalarBarVisibility(shown, viewProxy, legend);
    shown->UpdateVTKObjects();
    if (!legend)
    {
      hideLegendLater(shown, view);
    }
  }
  addText(describe(quality), quality, view);
}

/// The direction of view of another view, if it is one of meshes.
void takeCamera(pqView* view, pqView* other)
{
  if (qobject_cast<pqRenderView*>(other))
  {
    for (const char* name : { "CameraPosition", "CameraFocalPoint", "CameraViewUp" })
    {
      double values[3] = {};
      vtkSMPropertyHelper(other->getProxy(), name).Get(values, 3);
      vtkSMPropertyHelper(view->getProxy(), name).Set(values, 3);
    }
    view->getProxy()->UpdateVTKObjects();
  }
}

/// Whether the filter finds a shape of one image in another one.
bool isMatch(pqPipelineSource* filter)
{
  return filter->getProxy()->GetXMLName() == std::string("MatchShape");
}

/// What Match Shape has found: the source mesh or, of an image, the one that it makes.
pqPipelineSource* meshOfSource(pqPipelineSource* match)
{
  pqOutputPort* source = inputOf(match);
  if (source->getDataInformation()->GetDataSetType() != VTK_IMAGE_DATA)
  {
    return source->getSource();
  }
  pqPipelineSource* mesh = pqApplicationCore::instance()->getObjectBuilder()->createFilter(
    "filters", "SilhouetteToMesh", source->getSource(), source->getPortNumber());
  if (mesh)
  {
    mesh->rename("Source");
    for (const char* name : { "Spacing", "Foreground" })
    {
      vtkSMPropertyHelper(mesh->getProxy(), name)
        .Set(vtkSMPropertyHelper(match->getProxy(), name).GetAsDouble());
    }
    mesh->getProxy()->UpdateVTKObjects();
    mesh->updatePipeline();
    mesh->setModifiedState(pqProxy::UNMODIFIED);
  }
  return mesh;
}

/// Two views beside each other in a new layout; null where they cannot be made.
std::array<pqView*, 2> splitLayout(pqServer* server)
{
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  vtkSmartPointer<vtkSMProxy> made;
  made.TakeReference(server->proxyManager()->NewProxy("misc", "ViewLayout"));
  auto* layout = vtkSMViewLayoutProxy::SafeDownCast(made);
  std::array<pqView*, 2> views{};
  if (!layout)
  {
    return views;
  }
  controller->InitializeProxy(layout);
  controller->RegisterLayoutProxy(layout);
  const int left = layout->SplitHorizontal(0, Half);
  pqObjectBuilder* builder = pqApplicationCore::instance()->getObjectBuilder();
  for (std::size_t i = 0; i < views.size(); ++i)
  {
    views[i] = builder->createView(pqRenderView::renderViewType(), server);
    layout->AssignView(left + static_cast<int>(i), views[i]->getViewProxy());
  }
  return views;
}

} // anonymous namespace

//------------------------------------------------------------------------------
bool changesMesh(pqPipelineSource* filter)
{
  pqOutputPort* before = inputOf(filter);
  return before && filter->getProxy()->GetXMLName() != std::string("ElementQuality") &&
    before->getDataInformation()->GetNumberOfCells() > 0 &&
    filter->getOutputPort(MeshPort)->getDataInformation()->GetNumberOfCells() > 0;
}

//------------------------------------------------------------------------------
QString showSideBySide(pqPipelineSource* filter)
{
  if (filter->modifiedState() != pqProxy::UNMODIFIED || !changesMesh(filter))
  {
    return "Apply the filter first: there is no mesh before and after it.";
  }
  const bool match = isMatch(filter);
  const QPointer<pqView> seen = pqActiveObjects::instance().activeView();
  const std::array<pqPipelineSource*, 2> shown = match
    ? std::array<pqPipelineSource*, 2>{ meshOfSource(filter), filter }
    : std::array<pqPipelineSource*, 2>{ measure(inputOf(filter), "Before"),
        measure(filter->getOutputPort(MeshPort), "After") };
  if (!shown[0] || !shown[1])
  {
    return "The meshes cannot be measured.";
  }
  const std::array<pqView*, 2> views = splitLayout(filter->getServer());
  if (!views[0] || !views[1])
  {
    return "A layout cannot be made.";
  }
  for (std::size_t i = 0; i < views.size(); ++i)
  {
    if (match)
    {
      // pqTautlinePictures adds the image behind the mesh.
      vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
      controller->Show(shown[i]->getSourceProxy(), MeshPort, views[i]->getViewProxy());
      addText(i == 0 ? "source" : "target", shown[i], views[i]);
    }
    else
    {
      fill(shown[i], views[i], i == 1);
    }
  }
  if (!match) // the images may differ in size
  {
    pqApplicationCore::instance()->getLinksModel()->addCameraLink(
      filter->getSMName() + ", before and after", views[0]->getProxy(), views[1]->getProxy());
  }
  for (pqView* view : views)
  {
    takeCamera(view, seen);
    view->resetDisplay();
    view->render();
  }
  pqActiveObjects::instance().setActiveView(views[1]);
  pqActiveObjects::instance().setActiveSource(filter);
  return {};
}

} // namespace tautline
