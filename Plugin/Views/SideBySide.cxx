// SPDX-License-Identifier: BSD-3-Clause
#include "SideBySide.h"

#include "FetchOutput.h"
#include "ParaViewCompatibility.h"
#include "ReportPipeline.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqObjectBuilder.h"
#include "pqOutputPort.h"
#include "pqProxy.h"
#include "pqRenderView.h"
#include "pqServer.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"

#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPVDataInformation.h"
#include "vtkPVXMLElement.h"
#include "vtkSMCameraLink.h"
#include "vtkSMParaViewPipelineControllerWithRendering.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxyManager.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTrace.h"
#include "vtkSMViewLayoutProxy.h"
#include "vtkSMViewProxy.h"
#include "vtkSmartPointer.h"
#include "vtkTable.h"
#include "vtkType.h"
#include "vtkVariant.h"
#include "vtkWeakPointer.h"

#include <QList>
#include <QPointer>
#include <QTimer>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

namespace tautline
{
namespace
{

constexpr int MeshPort = 0;
constexpr double Half = 0.5;
constexpr int FontSize = 14;
constexpr std::size_t Sides = 2;
constexpr const char* Caption = "Text";

/// An unregistered link of two views: ParaView's link model clears the undo stack when a link is
/// added or removed.
class ViewLink : public vtkSMCameraLink
{
public:
  static ViewLink* New();
  vtkTypeMacro(ViewLink, vtkSMCameraLink);

  void link(vtkSMProxy* first, vtkSMProxy* second)
  {
    for (vtkSMProxy* view : { first, second })
    {
      this->AddLinkedProxy(view, INPUT);
      this->AddLinkedProxy(view, OUTPUT);
    }
  }
  void save(const QString& name, vtkPVXMLElement* links)
  {
    this->SaveXMLState(name.toUtf8().data(), links);
  }

protected:
  ViewLink() = default;
  ~ViewLink() override = default;
};
vtkStandardNewMacro(ViewLink);

/// The objects created by one click. Objects that the user or Undo deletes become null.
struct Comparison
{
  QPointer<pqPipelineSource> filter;
  bool match = false;
  /// For Match Shape, they may be sources of the user.
  std::array<QPointer<pqPipelineSource>, Sides> meshes, texts;
  std::array<QPointer<pqView>, Sides> views;
  vtkWeakPointer<ViewLink> link;

  bool isComplete() const
  {
    const auto alive = [](const auto& one) { return !one.isNull(); };
    return std::all_of(meshes.begin(), meshes.end(), alive) &&
      std::all_of(texts.begin(), texts.end(), alive) &&
      std::all_of(views.begin(), views.end(), alive);
  }
};

std::vector<Comparison>& comparisons()
{
  static std::vector<Comparison> all;
  return all;
}

/// An executed Element Quality of an output.
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
  // The inverse mean ratio of inverted elements is negative: the largest value is from a valid one.
  const bool valid = value("Inverted") != "0" && value("Metric") == "imr";
  const double worst = statistics->GetValueByName(0, valid ? "Maximum" : "Worst").ToDouble();
  return QString("%1: worst%2 %3 %4, %5 inverted")
    .arg(quality->getSMName().toLower(), valid ? " valid" : "", value("Metric"),
      QString::number(worst, 'g', 3), value("Inverted"));
}

/// Hides the legend, also of the bad elements, which are shown later.
void hideLegendLater(vtkSMProxy* shown, pqView* view)
{
  const vtkSmartPointer<vtkSMProxy> representation = shown;
  QTimer::singleShot(0, view,
    [representation, view]
    {
      const pqScopedUndoExclude notUndone;
      tautline::ColorMaps::SetScalarBarVisibility(representation, view->getViewProxy(), false);
      view->render();
    });
}

/// Shows a text at the top of a view.
pqPipelineSource* addText(const QString& shown, pqPipelineSource* of, pqView* view)
{
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  pqObjectBuilder* builder = pqApplicationCore::instance()->getObjectBuilder();
  pqPipelineSource* text = builder->createSource("sources", "TextSource", of->getServer());
  text->rename(of->getSMName() + ", text");
  {
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", text->getProxy());
    vtkSMPropertyHelper(text->getProxy(), Caption).Set(shown.toUtf8().data());
    text->getProxy()->UpdateVTKObjects();
  }
  text->setModifiedState(pqProxy::UNMODIFIED);
  if (vtkSMProxy* drawn = controller->Show(text->getSourceProxy(), 0, view->getViewProxy()))
  {
    constexpr int upperCenter = 6; // of the property WindowLocation
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", drawn);
    vtkSMPropertyHelper(drawn, "WindowLocation", true).Set(upperCenter);
    vtkSMPropertyHelper(drawn, "FontSize", true).Set(FontSize);
    drawn->UpdateVTKObjects();
  }
  return text;
}

/// Writes the caption again, unless the user has written another one.
void refreshCaption(pqPipelineSource* quality, pqPipelineSource* text, QString& last)
{
  static bool fetching = false; // fetching also reports an update
  if (fetching || quality->modifiedState() != pqProxy::UNMODIFIED)
  {
    return;
  }
  const pqScopedUndoExclude notUndone;
  fetching = true;
  const QString now = describe(quality);
  fetching = false;
  vtkSMPropertyHelper shown(text->getProxy(), Caption);
  if (now != last && QString::fromUtf8(shown.GetAsString()) == last)
  {
    shown.Set(now.toUtf8().data());
    text->getProxy()->UpdateVTKObjects();
    text->renderAllViews();
  }
  last = now;
}

/// Keeps the caption up to date, as the filter may be applied again.
void followUpdates(pqPipelineSource* quality, pqPipelineSource* text)
{
  const auto last = std::make_shared<QString>(
    QString::fromUtf8(vtkSMPropertyHelper(text->getProxy(), Caption).GetAsString()));
  const QPointer<pqPipelineSource> measured = quality;
  // Fetching updates a pipeline, which is not possible within an update.
  QObject::connect(pqApplicationCore::instance()->getServerManagerModel(),
    &pqServerManagerModel::dataUpdated, text,
    [measured, text, last](pqPipelineSource* updated)
    {
      if (updated != measured)
      {
        return;
      }
      QTimer::singleShot(0, text,
        [measured, text, last]
        {
          if (measured)
          {
            refreshCaption(measured, text, *last);
          }
        });
    });
}

/// Shows the mesh, and a text at the top.
pqPipelineSource* fill(pqPipelineSource* quality, pqView* view, bool legend)
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
  pqPipelineSource* text = addText(describe(quality), quality, view);
  followUpdates(quality, text);
  return text;
}

/// Copies the view direction of another view, if that shows meshes.
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

/// Whether the filter matches a shape from one image in another.
bool isMatch(pqPipelineSource* filter)
{
  return filter->getProxy()->GetXMLName() == std::string("MatchShape");
}

/// The source of Match Shape: the source mesh or, for an image, the mesh created from it.
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

QString linkName(pqPipelineSource* filter)
{
  return filter->getSMName() + ", before and after";
}

/// Moving the camera of one view moves the other, as long as both exist.
ViewLink* linkCameras(pqPipelineSource* filter, const std::array<pqView*, Sides>& views)
{
  const pqScopedUndoExclude notUndone;
  const auto link = vtkSmartPointer<ViewLink>::New();
  link->link(views[0]->getProxy(), views[1]->getProxy());
  for (pqView* view : views)
  {
    // A reference would keep the other view alive.
    QObject::connect(view, &QObject::destroyed, [link] { link->RemoveAllLinks(); });
  }
  const std::string name = linkName(filter).toStdString();
  SM_SCOPED_TRACE(CallFunction)
    .arg("AddCameraLink")
    .arg(views[0]->getProxy())
    .arg(views[1]->getProxy())
    .arg(name.c_str())
    .arg("comment", "link cameras in two views");
  return link;
}

/// Two views side by side in a new layout; null if they cannot be created.
std::array<pqView*, Sides> splitLayout(pqServer* server)
{
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  vtkSmartPointer<vtkSMProxy> made;
  made.TakeReference(server->proxyManager()->NewProxy("misc", "ViewLayout"));
  auto* layout = vtkSMViewLayoutProxy::SafeDownCast(made);
  std::array<pqView*, Sides> views{};
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

/// Removes the layout that a view was in, unless it has other views or is the only one.
void removeLayout(vtkSMViewLayoutProxy* layout)
{
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  auto* item = layout ? model->findItem<pqProxy*>(layout) : nullptr;
  if (item && layout->GetViews().empty() &&
    layout->GetSessionProxyManager()->GetNumberOfProxies("layouts") > 1)
  {
    pqApplicationCore::instance()->getObjectBuilder()->destroy(item);
  }
}

/// Removes the rest of a comparison; meshes that the user works with are kept.
void close(const Comparison& comparison)
{
  pqObjectBuilder* builder = pqApplicationCore::instance()->getObjectBuilder();
  for (std::size_t i = 0; i < Sides; ++i)
  {
    if (comparison.texts[i])
    {
      builder->destroy(comparison.texts[i]);
    }
    pqPipelineSource* mesh = comparison.match ? nullptr : comparison.meshes[i].data();
    if (mesh && mesh->getNumberOfConsumers() == 0)
    {
      builder->destroy(mesh);
    }
    if (comparison.views[i])
    {
      const vtkSmartPointer<vtkSMViewLayoutProxy> layout =
        vtkSMViewLayoutProxy::FindLayout(comparison.views[i]->getViewProxy());
      builder->destroy(comparison.views[i]);
      removeLayout(layout);
    }
  }
}

/// A caption is removed with its mesh, and the whole comparison with the filter.
void sourceRemoved(pqPipelineSource* source)
{
  for (Comparison& comparison : comparisons())
  {
    Comparison gone = comparison;
    if (comparison.filter == source)
    {
      comparison = {};
    }
    else
    {
      gone.meshes = {};
      gone.views = {};
      for (std::size_t i = 0; i < Sides; ++i)
      {
        gone.texts[i] = comparison.meshes[i] == source ? comparison.texts[i] : nullptr;
      }
    }
    // No other source can be removed during a removal.
    QTimer::singleShot(0, pqApplicationCore::instance(),
      [gone]
      {
        const pqScopedUndoExclude notUndone;
        close(gone);
      });
  }
}

/// Adds the links to a state that is saved.
void saveLinks(vtkPVXMLElement* root)
{
  vtkPVXMLElement* state = root->FindNestedElementByName("ServerManagerState");
  vtkPVXMLElement* links = state ? state->FindNestedElementByName("Links") : nullptr;
  for (const Comparison& comparison : comparisons())
  {
    if (links && comparison.link && comparison.isComplete())
    {
      comparison.link->save(linkName(comparison.filter), links);
    }
  }
}

void watchSession()
{
  static bool watching = false;
  if (!watching)
  {
    watching = true;
    auto* core = pqApplicationCore::instance();
    QObject::connect(
      core->getServerManagerModel(), &pqServerManagerModel::preSourceRemoved, core, sourceRemoved);
    QObject::connect(core, &pqApplicationCore::stateSaved, core, saveLinks);
  }
}

/// The comparison of a filter if it is complete; otherwise its rest is removed.
const Comparison* findComparison(pqPipelineSource* filter)
{
  std::vector<Comparison>& all = comparisons();
  for (auto comparison = all.begin(); comparison != all.end(); ++comparison)
  {
    if (comparison->filter == filter && comparison->isComplete())
    {
      return &*comparison;
    }
    if (comparison->filter == filter)
    {
      const Comparison incomplete = *comparison;
      all.erase(comparison);
      close(incomplete);
      return nullptr;
    }
  }
  return nullptr;
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
    return "Apply the filter first: there is no result to compare yet.";
  }
  watchSession();
  const pqScopedUndoSet oneStep("Side by Side");
  if (const Comparison* known = findComparison(filter))
  {
    pqActiveObjects::instance().setActiveView(known->views[1]);
    pqActiveObjects::instance().setActiveSource(filter);
    return {};
  }
  const bool match = isMatch(filter);
  const QPointer<pqView> seen = pqActiveObjects::instance().activeView();
  const std::array<pqPipelineSource*, Sides> shown = match
    ? std::array<pqPipelineSource*, Sides>{ meshOfSource(filter), filter }
    : std::array<pqPipelineSource*, Sides>{ measure(inputOf(filter), "Before"),
        measure(filter->getOutputPort(MeshPort), "After") };
  if (!shown[0] || !shown[1])
  {
    return "The meshes cannot be measured.";
  }
  const std::array<pqView*, Sides> views = splitLayout(filter->getServer());
  if (!views[0] || !views[1])
  {
    return "The layout could not be created.";
  }
  Comparison comparison{ filter, match, {}, {}, {}, {} };
  for (std::size_t i = 0; i < views.size(); ++i)
  {
    if (match)
    {
      // pqTautlinePictures adds the image behind the mesh.
      vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
      controller->Show(shown[i]->getSourceProxy(), MeshPort, views[i]->getViewProxy());
      comparison.texts[i] = addText(i == 0 ? "source" : "target", shown[i], views[i]);
    }
    else
    {
      comparison.texts[i] = fill(shown[i], views[i], i == 1);
    }
    comparison.meshes[i] = shown[i];
    comparison.views[i] = views[i];
  }
  if (!match) // the images may differ in size
  {
    comparison.link = linkCameras(filter, views);
  }
  comparisons().push_back(comparison);
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
