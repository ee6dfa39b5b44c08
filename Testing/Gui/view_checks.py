# SPDX-License-Identifier: BSD-3-Clause
"""Checks of the views that open, and of what a loaded state shows, called in ParaView's Python shell."""

import os

import numpy
from paraview import servermanager, simple, smstate
from vtkmodules.util.numpy_support import vtk_to_numpy

import fresh_session
from session_checks import check, chart_in, find

COLORS = [1, 0, 0, 0, 1, 0]  # of the regions; the plugin has others
TITLE = "Triangles of the square"
STATE = os.path.join(os.environ["TAUTLINE_TEST_DIR"], "own-display")


@check
def no_chart(rows, name="MeshImprover"):
    """The history has this many rows: 0, the input was rejected; 1, there was nothing to improve."""
    history = servermanager.Fetch(find(name), idx=1)
    assert history.GetNumberOfRows() == rows, history.GetNumberOfRows()
    (view,), (layout,) = simple.GetViews(), simple.GetLayouts().values()
    assert view.GetXMLName() == "RenderView" and layout.SMProxy.GetViewLocation(view.SMProxy) == 0


@check
def no_chart_of_run():
    rows = servermanager.Fetch(find("MeshImprover"), idx=1).GetNumberOfRows()
    assert rows > 1 and len(simple.GetViews()) == 1, (rows, simple.GetViews())


@check
def source_term(expression):
    solver = find("EllipticSolver")
    solver.SourceType, solver.SourceExpression = "Expression", expression


@check
def chart_opened(name, left, bottom):
    """Beside the mesh, whose view is active."""
    source = find(name)
    view, chart = chart_in("XYChartView")
    rows = servermanager.Fetch(source, idx=1).GetNumberOfRows()
    assert chart.Input.SMProxy == source.SMProxy and rows > 0, (chart.Input, rows)
    assert (view.LeftAxisTitle, view.BottomAxisTitle) == (left, bottom), view.LeftAxisTitle
    active = simple.GetActiveView()
    assert len(simple.GetViews()) == 2 and active.GetXMLName() == "RenderView"
    (layout,) = simple.GetLayouts().values()
    assert sorted(layout.SMProxy.GetViewLocation(one.SMProxy) for one in simple.GetViews()) == [1, 2]
    assert simple.GetDisplayProperties(source, active).Visibility


def render_view():
    return next(view for view in simple.GetViews() if view.GetXMLName() == "RenderView")


@check
def own_display():
    """Other colors of the regions and another title than the plugin's; saved as both kinds of state."""
    view = render_view()
    shown = simple.Show(find("MeshDomain"), view)
    shown.LookupTable.IndexedColors = COLORS
    chart_in("XYBarChartView")[0].LeftAxisTitle = TITLE
    simple.SaveState(STATE + ".pvsm")
    with open(STATE + ".py", "w", encoding="utf-8") as script:
        script.write(smstate.get_state())


@check
def load_state():
    fresh_session.remove_all()
    simple.LoadState(STATE + ".pvsm")


@check
def own_display_kept():
    shown = simple.GetDisplayProperties(find("MeshDomain"), render_view())
    assert list(shown.LookupTable.IndexedColors)[:6] == COLORS, list(shown.LookupTable.IndexedColors)
    assert chart_in("XYBarChartView")[0].LeftAxisTitle == TITLE, chart_in("XYBarChartView")[0].LeftAxisTitle


@check
def hide_mesh():
    simple.Hide(find("ElementQuality"), render_view())


def added_cells():
    """The numbers of cells of what is drawn besides the pipeline."""
    added = render_view().SMProxy.GetProperty("HiddenRepresentations")
    inputs = [added.GetProxy(i).GetProperty("Input").GetProxy(0) for i in range(added.GetNumberOfProxies())]
    return [one.GetDataInformation(0).GetNumberOfCells() for one in inputs]


@check
def isolated(*cells):
    """The mesh is faded with its edges; these numbers of cells are drawn besides: the element, then its neighbors."""
    shown = simple.GetDisplayProperties(find("ElementQuality"), render_view())
    state = shown.Visibility, shown.Representation, shown.Opacity < 1
    assert state == (1, "Surface With Edges", True), state
    assert added_cells() == list(cells), added_cells()


@check
def mesh_hidden():
    """As before Isolate; and no other mesh is drawn."""
    shown = simple.GetDisplayProperties(find("ElementQuality"), render_view())
    state = shown.Visibility, shown.Representation, shown.Opacity, added_cells()
    assert state == (0, "Surface", 1, []), state


@check
def no_time(filter_name):
    """The filter is to leave the mesh as it is."""
    find(filter_name).TimeLimit = 1e-9


@check
def selected_cell(cell):
    """This cell, and no other, is selected on the improved mesh."""
    combined = find("MeshImprover").SMProxy.GetSelectionInput(0)
    ids = combined.GetProperty("Input").GetProxy(0).GetProperty("IDs")
    selected = [int(ids.GetElement(i)) for i in range(ids.GetNumberOfElements())]
    assert selected == [-1, cell], selected


@check
def worst_over_time():
    """One series, the worst element of each iteration, as in the history of the optimizer."""
    view, chart = chart_in("XYChartView")
    states = list(chart.SMProxy.GetProperty("SeriesVisibility").GetElement(i) for i in range(
        chart.SMProxy.GetProperty("SeriesVisibility").GetNumberOfElements()))
    visible = [name for name, state in zip(states[::2], states[1::2]) if state == "1"]
    assert len(visible) == 1 and visible[0].startswith("max(imr)"), states
    assert (view.LeftAxisTitle, view.BottomAxisTitle) == ("Worst imr", "Time"), view.LeftAxisTitle
    table = servermanager.Fetch(chart.Input).GetBlock(0)
    worst = vtk_to_numpy(table.GetColumnByName("max(imr)"))
    history = vtk_to_numpy(servermanager.Fetch(find("MeshOptimizer"), idx=1).GetColumnByName("imr worst"))
    # The times after the last iteration show its mesh.
    history = numpy.append(history, numpy.full(len(worst) - len(history), history[-1]))
    assert len(history) > 2 and numpy.allclose(worst, history, rtol=1e-6), (worst, history)
