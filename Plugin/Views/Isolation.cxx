// SPDX-License-Identifier: BSD-3-Clause
#include "Isolation.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqDataRepresentation.h"
#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqRenderView.h"
#include "pqServer.h"
#include "pqServerManagerModel.h"
#include "pqTimeKeeper.h"
#include "pqUndoStack.h"

#include "vtkDataObject.h"
#include "vtkNew.h"
#include "vtkPVDataInformation.h"
#include "vtkSMParaViewPipelineControllerWithRendering.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMRepresentationProxy.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"

#include <utility>

namespace tautline
{
namespace
{

constexpr const char* Opacity = "Opacity";
constexpr const char* Style = "Representation";
constexpr const char* WithEdges = "Surface With Edges";
constexpr const char* SelectionStyle = "SelectionRepresentation";
constexpr const char* Labels = "SelectionCellLabelVisibility";
constexpr const char* LabelArray = "SelectionCellFieldDataArrayName";
constexpr const char* Additional = "HiddenRepresentations";
constexpr int FilledSelection = 2; // VTK_SURFACE

/// Opacity of the mesh and of the neighbors; in a plane, they hide nothing.
constexpr double SolidOpacity = 0.1, PlaneOpacity = 0.4;
constexpr double SolidNeighbors = 0.35, PlaneNeighbors = 1.0;
/// The outline makes slivers visible.
constexpr double OutlineWidth = 4.0; // pixels
constexpr double OutlineColor[3] = { 1.0, 0.0, 1.0 };
constexpr double EdgeColor[3] = { 0.1, 0.1, 0.1 };

/// A 3D view: the active one, otherwise one that shows the mesh, otherwise any.
pqRenderView* viewFor(pqOutputPort* mesh)
{
  auto* view = qobject_cast<pqRenderView*>(pqActiveObjects::instance().activeView());
  const QList<pqView*> others = mesh->getViews();
  for (auto other = others.begin(); !view && other != others.end(); ++other)
  {
    view = qobject_cast<pqRenderView*>(*other);
  }
  if (!view)
  {
    const auto all =
      pqApplicationCore::instance()->getServerManagerModel()->findItems<pqRenderView*>(
        mesh->getServer());
    view = all.isEmpty() ? nullptr : all.front();
  }
  return view;
}

void copyProperty(vtkSMProxy* from, vtkSMProxy* to, const char* name)
{
  if (from->GetProperty(name) && to->GetProperty(name))
  {
    to->GetProperty(name)->Copy(from->GetProperty(name));
  }
}

} // anonymous namespace

//------------------------------------------------------------------------------
std::string Isolation::begin(pqOutputPort* mesh, const std::string& array)
{
  this->end();
  pqRenderView* view = viewFor(mesh);
  if (!view)
  {
    return "Isolate needs a 3D view: open a Render View.";
  }
  pqDataRepresentation* shown = mesh->getRepresentation(view);
  const bool shownBefore = shown && shown->isVisible();
  if (!shownBefore)
  {
    vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
    controller->Show(mesh->getSourceProxy(), mesh->getPortNumber(), view->getViewProxy());
    shown = mesh->getRepresentation(view);
  }
  vtkSMProxy* proxy = shown ? shown->getProxy() : nullptr;
  if (!proxy || !proxy->GetProperty(Opacity) || !proxy->GetProperty(SelectionStyle))
  {
    return "Isolate cannot show this mesh in the view: choose a Render View.";
  }
  this->Mesh = mesh;
  this->View = view;
  this->fade(shown, array, shownBefore);
  return {};
}

//------------------------------------------------------------------------------
bool Isolation::planar() const
{
  const double* bounds = this->Mesh->getDataInformation()->GetBounds();
  return !(bounds[0] < bounds[1] && bounds[2] < bounds[3] && bounds[4] < bounds[5]);
}

//------------------------------------------------------------------------------
void Isolation::fade(pqDataRepresentation* mesh, const std::string& array, bool shownBefore)
{
  const pqScopedUndoExclude notUndone;
  // Other meshes, and the elements drawn by Element Quality, would hide these elements.
  std::vector<QPointer<pqDataRepresentation>> others;
  for (pqRepresentation* other : this->View->getRepresentations())
  {
    auto* data = qobject_cast<pqDataRepresentation*>(other);
    if (data && data != mesh && data->isVisible() && data->getProxy()->GetProperty(Opacity))
    {
      data->setVisible(false);
      others.emplace_back(data);
    }
  }
  vtkSMProxy* proxy = mesh->getProxy();
  const double opacity = vtkSMPropertyHelper(proxy, Opacity).GetAsDouble();
  const std::string style = vtkSMPropertyHelper(proxy, Style).GetAsString();
  const int filled = vtkSMPropertyHelper(proxy, SelectionStyle).GetAsInt();
  const int labels = vtkSMPropertyHelper(proxy, Labels).GetAsInt();
  const auto set =
    [](vtkSMProxy* of, double newOpacity, const std::string& newStyle, int newFilled, int newLabels)
  {
    vtkSMPropertyHelper(of, Opacity).Set(newOpacity);
    vtkSMPropertyHelper(of, Style).Set(newStyle.c_str());
    vtkSMPropertyHelper(of, SelectionStyle).Set(newFilled);
    vtkSMPropertyHelper(of, Labels).Set(newLabels);
    of->UpdateVTKObjects();
  };
  const QPointer<pqDataRepresentation> faded = mesh;
  this->Faded = mesh;
  this->Restore = [=]
  {
    if (faded)
    {
      set(faded->getProxy(), opacity, style, filled, labels);
      faded->setVisible(shownBefore);
      faded->renderViewEventually();
    }
    for (const QPointer<pqDataRepresentation>& other : others)
    {
      if (other)
      {
        other->setVisible(true);
        other->renderViewEventually();
      }
    }
  };
  vtkSMPropertyHelper(proxy, LabelArray).Set(array.c_str());
  set(proxy, this->planar() ? PlaneOpacity : SolidOpacity, WithEdges, FilledSelection, 1);
  mesh->renderViewEventually();
}

//------------------------------------------------------------------------------
void Isolation::show(const std::vector<ElementName>& names, int layers)
{
  const pqScopedUndoExclude notUndone;
  this->remove();
  if (!this->active() || !this->Mesh || !this->View || !this->Faded)
  {
    return;
  }
  this->draw(names, 0, true);
  if (layers > 0)
  {
    this->draw(names, layers, false);
  }
  this->View->render();
}

//------------------------------------------------------------------------------
void Isolation::draw(const std::vector<ElementName>& names, int layers, bool outline)
{
  std::string problem;
  Drawn drawn;
  drawn.selection = selectionOf(this->Mesh, names, problem);
  if (!drawn.selection)
  {
    return;
  }
  vtkSMPropertyHelper(drawn.selection, "NumberOfLayers").Set(layers);
  vtkSMPropertyHelper(drawn.selection, "RemoveSeed").Set(outline ? 0 : 1);
  drawn.selection->UpdateVTKObjects();
  vtkSMSessionProxyManager* manager = this->Mesh->getSourceProxy()->GetSessionProxyManager();
  drawn.cells.TakeReference(
    vtkSMSourceProxy::SafeDownCast(manager->NewProxy("filters", "ExtractSelection")));
  vtkSMPropertyHelper(drawn.cells, "Input")
    .Set(this->Mesh->getSourceProxy(), static_cast<unsigned int>(this->Mesh->getPortNumber()));
  vtkSMPropertyHelper(drawn.cells, "Selection").Set(drawn.selection.GetPointer());
  drawn.cells->UpdateVTKObjects();
  drawn.cells->UpdatePipeline(this->Mesh->getServer()->getTimeKeeper()->getTime());

  vtkSMViewProxy* view = this->View->getViewProxy();
  drawn.shown.TakeReference(view->CreateDefaultRepresentation(drawn.cells, 0));
  if (!drawn.shown)
  {
    return;
  }
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  controller->PreInitializeProxy(drawn.shown);
  vtkSMPropertyHelper(drawn.shown, "Input").Set(drawn.cells.GetPointer());
  controller->PostInitializeProxy(drawn.shown);
  vtkSMPropertyHelper(drawn.shown, "Pickable", true).Set(0);
  vtkSMPropertyHelper(drawn.shown, Style).Set(outline ? "Wireframe" : WithEdges);
  if (outline)
  {
    // Not colored by the active array.
    vtkSMPropertyHelper(drawn.shown, "ColorArrayName")
      .SetInputArrayToProcess(vtkDataObject::CELL, "");
    vtkSMPropertyHelper(drawn.shown, "LineWidth").Set(OutlineWidth);
    vtkSMPropertyHelper(drawn.shown, "AmbientColor").Set(OutlineColor, 3);
    vtkSMPropertyHelper(drawn.shown, "DiffuseColor").Set(OutlineColor, 3);
  }
  else
  {
    copyProperty(this->Faded->getProxy(), drawn.shown, "ColorArrayName");
    copyProperty(this->Faded->getProxy(), drawn.shown, "LookupTable");
    vtkSMPropertyHelper(drawn.shown, "EdgeColor").Set(EdgeColor, 3);
    vtkSMPropertyHelper(drawn.shown, Opacity).Set(this->planar() ? PlaneNeighbors : SolidNeighbors);
  }
  drawn.shown->UpdateVTKObjects();
  vtkSMPropertyHelper(view, Additional).Add(drawn.shown);
  view->UpdateVTKObjects();
  this->Additions.push_back(drawn);
}

//------------------------------------------------------------------------------
void Isolation::zoom() const
{
  if (this->View && !this->Additions.empty())
  {
    double bounds[6];
    this->Additions.back().cells->GetDataInformation(0)->GetBounds(bounds);
    zoomTo(this->View, bounds, this->Additions.size() > 1 ? 0.0 : 1.0);
  }
}

//------------------------------------------------------------------------------
void Isolation::remove()
{
  const pqScopedUndoExclude notUndone;
  for (const Drawn& drawn : std::exchange(this->Additions, {}))
  {
    if (this->View)
    {
      vtkSMViewProxy* view = this->View->getViewProxy();
      vtkSMPropertyHelper(view, Additional).Remove(drawn.shown);
      view->UpdateVTKObjects();
    }
  }
}

//------------------------------------------------------------------------------
void Isolation::end()
{
  const pqScopedUndoExclude notUndone;
  this->remove();
  if (const auto restore = std::exchange(this->Restore, nullptr))
  {
    restore();
  }
}

} // namespace tautline
