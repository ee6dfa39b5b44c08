# SPDX-License-Identifier: BSD-3-Clause
"""Checks of the views that open, called in ParaView's Python shell."""

from paraview import servermanager, simple

from session_checks import check, chart_in, find


@check
def no_chart(rows):
    """The history has so many rows: 0, the input was refused; 1, there was nothing to improve."""
    history = servermanager.Fetch(find("MeshImprover"), idx=1)
    assert history.GetNumberOfRows() == rows, history.GetNumberOfRows()
    (view,), (layout,) = simple.GetViews(), simple.GetLayouts().values()
    assert view.GetXMLName() == "RenderView" and layout.SMProxy.GetViewLocation(view.SMProxy) == 0


@check
def chart_opened():
    """Beside the mesh, whose view is active."""
    improver = find("MeshImprover")
    view, chart = chart_in("XYChartView")
    rows = servermanager.Fetch(improver, idx=1).GetNumberOfRows()
    assert chart.Input.SMProxy == improver.SMProxy and rows > 0, (chart.Input, rows)
    assert (view.LeftAxisTitle, view.BottomAxisTitle) == ("Angle (degrees)", "Pass"), view.LeftAxisTitle
    active = simple.GetActiveView()
    assert len(simple.GetViews()) == 2 and active.GetXMLName() == "RenderView"
    (layout,) = simple.GetLayouts().values()
    assert sorted(layout.SMProxy.GetViewLocation(one.SMProxy) for one in simple.GetViews()) == [1, 2]
    assert simple.GetDisplayProperties(improver, active).Visibility
