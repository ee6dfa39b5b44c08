# SPDX-License-Identifier: BSD-3-Clause
"""Checks of the data and charts of a session, called in ParaView's Python shell: a failed one ends ParaView with 1.

The numbers are computed here, from the points and cells, or come from numpy.
"""

import functools
import os
import re
import subprocess
import sys
import traceback

import numpy
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter

PUSHED, BEYOND = 3, 0.3  # corners of the bracket, and how far behind the opposite face, of their height
WORST_PORT, BAD_PORT = 4, 7  # of Element Quality
SECTIONS_PORT = 2  # of Solve PDE
QUADRILATERAL, QUADRATIC_TETRAHEDRON = 9, 24  # of VTK
TURN = 20  # degrees
QUERY, RIGHT, WRONG = (120, 120, 120), (0, 150, 60), (215, 25, 30)  # frames on the sheet of Shape Retrieval
WORST = (99.9, 2.87)  # of the valid elements of the bracket, tangled and optimized: inverse mean ratio
ALL_FIXED = 2  # of the array Obstacle: all points of the element are fixed


def check(function):
    @functools.wraps(function)
    def checked(*arguments):
        try:
            function(*arguments)
        except BaseException:  # the shell would print it in its window, and the session go on
            traceback.print_exc(file=sys.__stderr__)
            os._exit(1)

    return checked


def find(name):
    """The last source of this proxy."""
    return [source for source in simple.GetSources().values() if source.GetXMLName() == name][-1]


def chart_of(source, port, kind):
    """A view with the port's chart; the plugin's settings apply when the event loop runs next."""
    view = simple.CreateView(kind)
    simple.AssignViewToLayout(view)
    return simple.Show(simple.OutputPort(source, port), view)


@check
def result_number(name, number, value):
    """A number that the last run of the last filter of this kind found."""
    found = find(name).GetPropertyValue(number)
    assert found == value, found


@check
def open_history(name):
    """The chart of a run, which Apply does not open."""
    chart_of(find(name), 1, "XYChartView")


def chart_in(kind):
    """View and representation of the chart of this kind."""
    view = next(view for view in simple.GetViews() if view.GetXMLName() == kind)
    return view, view.Representations[0]


def triangles(mesh):
    """Corners of the triangles."""
    points = vtk_to_numpy(mesh.GetPoints().GetData()).astype(float)
    corners = [[mesh.GetCell(cell).GetPointId(i) for i in range(3)] for cell in range(mesh.GetNumberOfCells())]
    return points[numpy.array(corners)]


def areas(corners):
    edges = corners[:, 1:, :2] - corners[:, :1, :2]
    return (edges[:, 0, 0] * edges[:, 1, 1] - edges[:, 0, 1] * edges[:, 1, 0]) / 2


@check
def open_distribution():
    chart_of(find("ElementQuality"), 2, "XYBarChartView")


@check
def distribution():
    """Bars over the values of the metric, and as many elements as the mesh has."""
    view, chart = chart_in("XYBarChartView")
    assert (chart.XArrayName, chart.UseIndexForXAxis) == ("imr value", 0), chart.XArrayName
    assert list(chart.SeriesVisibility) == ["imr count"] or "imr count" in chart.SeriesVisibility
    assert (view.BottomAxisTitle, view.LeftAxisTitle) == ("imr", "Elements")
    table = servermanager.Fetch(find("ElementQuality"), idx=2)
    assert vtk_to_numpy(table.GetColumnByName("imr count")).sum() == 1913


@check
def animation():
    """Time 0 is the input, and there is one time for each iteration of the run made."""
    optimizer = find("MeshOptimizer")
    history = servermanager.Fetch(optimizer, idx=1)
    iterations = history.GetNumberOfRows() - 1
    assert 0 < iterations < optimizer.MaximumIterations, iterations
    expected = list(range(iterations + 1))
    assert list(optimizer.TimestepValues) == expected, optimizer.TimestepValues
    assert list(simple.GetTimeKeeper().TimestepValues) == expected
    assert simple.GetAnimationScene().EndTime == iterations
    view, chart = chart_in("XYChartView")
    titles = (view.LeftAxisTitle, view.RightAxisTitle, view.BottomAxisTitle)
    assert view.LeftAxisLogScale == 1 and titles == ("Objective", "imr worst", "Iteration"), titles
    corners = list(chart.SeriesPlotCorner)
    corners = dict(zip(corners[::2], corners[1::2]))
    assert corners.get("Objective", "0") == "0" and corners["imr worst"] == "1", corners
    assert sorted(chart.SeriesVisibility) == ["Objective", "imr worst"], list(chart.SeriesVisibility)
    before, after = re.search(r"worst ([\d.e+-]+) to ([\d.e+-]+)\.", optimizer.Summary + "\n").groups()
    assert float(after) < float(before), optimizer.Summary


@check
def interaction_layer():
    """The mesh stays; the layer is valid, and it is as wide as the horizon."""
    layer = find("InteractionLayer")
    mesh, domain = servermanager.Fetch(layer), servermanager.Fetch(layer.Input)
    corners, kind = triangles(mesh), vtk_to_numpy(mesh.GetCellData().GetArray("Reference"))
    assert (kind == 1).sum() == domain.GetNumberOfCells() > 0
    assert numpy.array_equal(corners[kind == 1], triangles(domain))
    assert set(kind) == {1, 2} and areas(corners).min() > 0
    inside = corners[kind == 1].reshape(-1, 3)
    outside = corners.reshape(-1, 3)
    width = layer.Width
    for axis in range(2):
        assert outside[:, axis].max() >= inside[:, axis].max() + width * (1 - 1e-9)
        assert outside[:, axis].min() <= inside[:, axis].min() - width * (1 - 1e-9)


    shown = simple.GetDisplayProperties(layer)
    assert list(shown.ColorArrayName) == ["CELLS", "Reference"], shown.ColorArrayName[:]
    colors = shown.LookupTable
    bars = legends(simple.GetActiveView())
    assert colors.InterpretValuesAsCategories and bars == 1, (colors.InterpretValuesAsCategories, bars)
    names = list(colors.Annotations)
    assert names == ["1", "1: domain", "2", "2: interaction layer"], names


@check
def solver_study():
    """The bars are in the order of their times, and the axis has the names in this order."""
    study = find("SolverStudy")
    view, chart = chart_in("XYBarChartView")
    table = servermanager.Fetch(study, idx=1)
    seconds = vtk_to_numpy(table.GetColumnByName("Total time (s)"))
    ranks = vtk_to_numpy(table.GetColumnByName("N rank"))
    assert (seconds > 0).all() and numpy.array_equal(numpy.sort(ranks), numpy.arange(1, len(ranks) + 1))
    assert (numpy.diff(seconds[numpy.argsort(ranks)]) >= 0).all()
    assert (chart.XArrayName, chart.UseIndexForXAxis) == ("N rank", 0), chart.XArrayName
    labels = list(view.BottomAxisLabels)
    shown = {int(rank): name for rank, name in zip(labels[::2], labels[1::2])}
    names = table.GetColumnByName("Combination")
    expected = {int(rank): names.GetValue(i) for i, rank in enumerate(ranks)}
    assert view.BottomAxisUseCustomLabels and shown == expected, shown
    # VTK draws bars as wide as this fraction of the distance of the first two rows: there are gaps.
    drawn = view.SMProxy.GetContextItem()
    width = drawn.GetBarWidthFraction() * abs(ranks[1] - ranks[0])
    assert abs(width - 0.8) < 1e-6, (width, ranks)
    assert drawn.GetAxis(1).GetLabelProperties().GetOrientation() == 90  # of the bottom


@check
def picture_behind():
    """The target is visible behind the mesh, the other image is not; the data are where they were."""
    view = simple.GetActiveView()
    matcher = find("MatchShape")
    assert simple.GetDisplayProperties(matcher.Target, view).Visibility
    assert not simple.GetDisplayProperties(matcher.Input, view).Visibility
    display = simple.GetDisplayProperties(matcher.Target, view)
    moved = display.GetProperty("Translation") or display.GetProperty("Position")  # its name before ParaView 5.13
    assert moved[2] < 0
    assert servermanager.Fetch(matcher.Target).GetBounds()[4:] == (0, 0)
    assert servermanager.Fetch(matcher).GetBounds()[4:] == (0, 0)


@check
def peridynamic_condition():
    """The horizon is larger than the square, the kernel constant: the matrix by element areas, dense in numpy."""
    condition = find("PeridynamicCondition")
    mesh = servermanager.Fetch(condition)
    area = areas(triangles(mesh))
    inside = area[vtk_to_numpy(mesh.GetCellData().GetArray("Reference")) == 1]
    eigenvalues = numpy.linalg.eigvalsh(numpy.diag(inside * area.sum()) - numpy.outer(inside, inside))
    assert eigenvalues[0] > 0
    assert abs(condition.Condition / (eigenvalues[-1] / eigenvalues[0]) - 1) < 1e-6, condition.Condition


@check
def constant_kernel():
    condition = find("PeridynamicCondition")
    condition.Horizon, condition.AllowThinLayer = 10, 1
    condition.Kernel, condition.Basis = "Constant", "Piecewise Constant"


@check
def switch_animation_on():
    find("MeshOptimizer").Animation = 1


@check
def choose_heat():
    """From 1 inside, 0 on the boundary."""
    heat = find("EllipticSolver")
    heat.SourceValue, heat.InitialValue = 0, 1
    heat.TimeScheme, heat.TimeStep, heat.NumberOfTimeSteps = "Heat: Backward Euler", 1, 4


HEAT: list[tuple[str, float]] = []  # the history of the residuals and the maximum of the steps that were shown


@check
def heat_at(step):
    """The time controls show this step; it is cooler than those before, the solution is the same run."""
    heat = find("EllipticSolver")
    assert list(heat.TimestepValues) == [0, 1, 2, 3, 4], heat.TimestepValues
    assert simple.GetAnimationScene().AnimationTime == step, simple.GetAnimationScene().AnimationTime
    warmest = servermanager.Fetch(heat).GetPointData().GetArray("Solution").GetRange()[1]
    run = heat.Summary[heat.Summary.index("Seconds:") :]
    assert f"time {step} is shown" in heat.Summary, heat.Summary
    assert all(run == seconds and warmest < before for seconds, before in HEAT), (HEAT, run, warmest)
    assert warmest == 1 if step == 0 else 0 < warmest < 1, warmest
    HEAT.append((run, warmest))


@check
def open_clovers():
    """Both pictures, the source active."""
    data = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Data")
    for name in ("clover-turned", "clover"):
        reader = simple.PNGSeriesReader(registrationName=name, FileNames=[os.path.join(data, name + ".png")])
        simple.Show(reader)
    simple.ResetCamera()
    simple.SetActiveSource(reader)


@check
def silhouettes_shown():
    """The four pictures are drawn in their own colors, beside each other, without a legend."""
    reader = find("SilhouetteSetReader")
    shown = simple.GetDisplayProperties(reader)
    assert (shown.Visibility, shown.Representation, shown.MapScalars) == (1, "Surface", 0), shown.Representation
    assert shown.ColorArrayName[0] == "POINTS" and legends(simple.GetActiveView()) == 0, shown.ColorArrayName[:]
    images = servermanager.Fetch(reader)
    bounds = [images.GetBlock(i).GetBounds() for i in range(images.GetNumberOfBlocks())]
    assert len(bounds) == 4 and len({(box[0], box[2]) for box in bounds}) == 4, bounds
    for i, one in enumerate(bounds):
        for other in bounds[:i]:
            apart = any(one[low] > other[low + 1] or other[low] > one[low + 1] for low in (0, 2))
            assert apart, (one, other)


@check
def side_by_side():
    """Two linked views of the mesh before and after, with the same colors, one legend, and the worst values."""
    views = [view for view in simple.GetViews() if view.GetXMLName() == "RenderView"][-2:]
    before, after = (find_named(name) for name in ("Before", "After"))
    assert before.Input == find("MeshOptimizer").Input and after.Input == find("MeshOptimizer")
    tables = []
    for view, quality in zip(views, (before, after)):
        shown = simple.GetDisplayProperties(quality, view)
        assert shown.Visibility and shown.ColorArrayName[1] == "imr", shown.ColorArrayName[:]
        tables.append(shown.LookupTable)
        values = vtk_to_numpy(servermanager.Fetch(quality).GetCellData().GetArray("imr"))
        text = find_named(f"{quality_name(quality)}, text").Text
        inverted = (values < 0).sum()
        kind = "worst valid imr" if inverted else "worst imr"
        assert text == f"{quality_name(quality).lower()}: {kind} {values.max():.3g}, {inverted} inverted", text
    assert tables[0].SMProxy == tables[1].SMProxy
    assert [legends(view) for view in views] == [0, 1], [legends(view) for view in views]
    # Links follow interactions and Reset Camera.
    views[1].CameraPosition = [1, 2, 300]
    simple.ResetCamera(views[0])
    assert numpy.allclose(views[1].CameraPosition, views[0].CameraPosition), views[1].CameraPosition[:]
    worst = [vtk_to_numpy(servermanager.Fetch(one).GetCellData().GetArray("imr")).max() for one in (before, after)]
    assert numpy.allclose(worst, WORST, rtol=0.01), worst


@check
def match_side_by_side():
    """On the left the source mesh over the source, on the right the found mesh over the target."""
    matcher = find("MatchShape")
    left, right = [view for view in simple.GetViews() if view.GetXMLName() == "RenderView"][-2:]
    mesh = find_named("Source")
    assert mesh.Input == matcher.Input
    for view, shown, hidden in ((left, (mesh, matcher.Input), matcher), (right, (matcher, matcher.Target), mesh)):
        sources = [one.Input for one in view.Representations if hasattr(one, "Input") and one.Visibility]
        assert all(one in sources for one in shown) and hidden not in sources, sources
    triangles_of = [servermanager.Fetch(one).GetNumberOfCells() for one in (mesh, matcher)]
    assert triangles_of[0] == triangles_of[1] > 0, triangles_of


@check
def sheet_shown():
    """The sheet of pictures is drawn in its own colors: 4 queries, each with 3 matches, of which one can be right."""
    retrieval = find("ShapeRetrieval")
    port = simple.OutputPort(retrieval, 4)
    shown = simple.GetDisplayProperties(port)
    assert (shown.Visibility, shown.Representation, shown.MapScalars) == (1, "Slice", 0), shown.Representation
    pixels = vtk_to_numpy(servermanager.Fetch(retrieval, idx=4).GetPointData().GetArray("Sheet"))
    frames = [int((pixels == color).all(axis=1).sum()) for color in (QUERY, RIGHT, WRONG)]
    table = servermanager.Fetch(retrieval, idx=1)
    right = vtk_to_numpy(table.GetColumnByName("Correct")).sum()
    frame = frames[0] / 4
    assert frames == [4 * frame, right * frame, (12 - right) * frame] and 0 < right < 12, (frames, right)


def legends(view):
    """The number of visible legends; GetScalarBar() would make one."""
    return sum(one.GetXMLName() == "ScalarBarWidgetRepresentation" and one.Visibility for one in view.Representations)


def quality_name(source):
    return next(name for (name, _), one in simple.GetSources().items() if one == source)


def find_named(name):
    return next(one for (known, _), one in simple.GetSources().items() if known == name)


@check
def push_corners():
    """The bracket with three corners pushed through the opposite faces of their elements."""
    data = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Data")
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(os.path.join(data, "bracket.vtu"))
    reader.Update()
    mesh = reader.GetOutput()
    cells = vtk_to_numpy(mesh.GetCells().GetConnectivityArray()).reshape(-1, 4)
    points = vtk_to_numpy(mesh.GetPoints().GetData())
    corners = numpy.flatnonzero(numpy.bincount(cells.ravel()) == 1)[:PUSHED]
    assert len(corners) == PUSHED, corners
    for corner in corners:
        others = [i for i in cells[(cells == corner).any(axis=1)][0] if i != corner]
        center = points[others].mean(axis=0)
        points[corner] = center + BEYOND * (center - points[corner])
    # A file, not a programmable filter: where Python's package pygments is installed, the panel of a Python script ends
    # Debian's ParaView 5.13 (pqPythonSyntaxHighlighter asks for a formatter that is not there, and then for one while
    # that exception is set, and uses the null pointer it gets).
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(os.path.join(os.environ["TAUTLINE_TEST_DIR"], "pushed.vtu"))
    writer.SetInputData(mesh)
    writer.SetDataModeToBinary()  # not appended data, see python/tautline/_io.py
    assert writer.Write() == 1
    pushed = simple.XMLUnstructuredGridReader(registrationName="pushed", FileName=[writer.GetFileName()])
    simple.Show(pushed)
    simple.ResetCamera()
    simple.SetActiveSource(pushed)


@check
def obstacles():
    """Three elements stay inverted, with their reason; the summary has the remedy."""
    untangler = find("MeshUntangler")
    reasons = vtk_to_numpy(servermanager.Fetch(untangler).GetCellData().GetArray("Obstacle"))
    assert (reasons == ALL_FIXED).sum() == (reasons > 0).sum() == PUSHED, numpy.unique(reasons, return_counts=True)
    assert "3 elements" in untangler.Summary, untangler.Summary


def planar_points(source):
    """The points as complex numbers."""
    return vtk_to_numpy(servermanager.Fetch(source).GetPoints().GetData())[:, :2].astype(float) @ [1, 1j]


def hole_of(warp):
    """Numbers of the points of the hole, and of those on the outside, of the input of a planar mesh."""
    before = planar_points(warp.Input)
    # The boundary is the edges of one element; the outside is the bounding rectangle.
    mesh = servermanager.Fetch(warp.Input)
    edges = {}
    for cell in map(mesh.GetCell, range(mesh.GetNumberOfCells())):
        for i in range(cell.GetNumberOfEdges()):
            key = tuple(sorted(cell.GetEdge(i).GetPointId(end) for end in range(2)))
            edges[key] = edges.get(key, 0) + 1
    boundary = numpy.unique([key for key, count in edges.items() if count == 1])
    ends = [f(part(before)) for part in (numpy.real, numpy.imag) for f in (numpy.min, numpy.max)]
    outside = numpy.isin(before.real, ends[:2]) | numpy.isin(before.imag, ends[2:])
    hole = boundary[~outside[boundary]]
    assert len(hole) > 10
    return hole, outside


def hidden_representations(kind):
    """The displays in the view that are not in the pipeline browser."""
    shown = simple.GetActiveView().GetProperty("HiddenRepresentations")
    return [shown[i] for i in range(len(shown)) if shown[i].GetXMLName() == kind]


@check
def hole_highlighted():
    """The edges of the hole are drawn, and the box is around them."""
    warp = find("MeshWarp")
    hole, _ = hole_of(warp)
    (shown,) = hidden_representations("GeometryRepresentation")
    drawn = servermanager.Fetch(shown.Input)
    points = vtk_to_numpy(drawn.GetPoints().GetData())[:, :2].astype(float) @ [1, 1j]
    assert drawn.GetNumberOfLines() == len(hole) == len(points), (drawn.GetNumberOfLines(), len(hole))
    assert numpy.allclose(numpy.sort_complex(points), numpy.sort_complex(planar_points(warp.Input)[hole]), atol=1e-9)
    (box,) = hidden_representations("BoxWidgetRepresentation")
    assert numpy.allclose(list(box.PlaceWidget)[:4], drawn.GetBounds()[:4], atol=1e-9), box.PlaceWidget
    assert box.PlaceWidget[4] < 0 < box.PlaceWidget[5], box.PlaceWidget


@check
def nothing_highlighted():
    assert not hidden_representations("GeometryRepresentation")


MOVED = []  # the translation of the hole by the mouse
SEEN = []  # time and points of the hole, of each frame that was played


@check
def watch_frames():
    """Keeps what each frame of the animation shows."""
    warp, scene = find("MeshWarp"), simple.GetAnimationScene()
    hole, _ = hole_of(warp)

    def frame(*_):
        warp.UpdatePipeline(scene.AnimationTime)  # ParaView 6.1 does so after this event
        mesh = servermanager.Fetch(warp)
        points = vtk_to_numpy(mesh.GetPoints().GetData())[:, :2].astype(float) @ [1, 1j]
        SEEN.append((scene.AnimationTime, points[hole]))

    scene.SMProxy.GetClientSideObject().AddObserver("AnimationCueTickEvent", frame)


@check
def played():
    """The hole turned from frame to frame, by 20 degrees in all."""
    times = [time for time, _ in SEEN]
    assert sorted(set(times)) == list(find("MeshWarp").TimestepValues) and len(set(times)) == 21, times
    before = planar_points(find("MeshWarp").Input)[hole_of(find("MeshWarp"))[0]]
    for time, points in SEEN:
        turn = numpy.exp(1j * numpy.radians(TURN * time))
        assert numpy.allclose(points - points.mean(), turn * (before - before.mean()), atol=1e-6), time


@check
def turned_in_plane():
    """The hole, which was moved, is turned about its center by the angle of the box, which the mouse has turned."""
    warp = find("MeshWarp")
    hole, _ = hole_of(warp)
    before, after = planar_points(warp.Input)[hole], planar_points(warp)[hole]
    angle, scale = list(warp.Transform.Rotate), list(warp.Transform.Scale)
    assert abs(angle[2]) > 5 and angle[:2] == [0, 0] and scale == [1, 1, 1], (angle, scale)
    turn = numpy.exp(1j * numpy.radians(angle[2]))
    assert numpy.allclose(after - after.mean(), turn * (before - before.mean()), atol=1e-6)
    shift = after.mean() - before.mean()
    assert numpy.allclose([shift.real, shift.imag], MOVED[-1], atol=1e-6), (shift, MOVED)


@check
def turned_hole():
    """The points of the hole are turned by 20 degrees about its center; no triangle is inverted."""
    warp = find("MeshWarp")
    hole, outside = hole_of(warp)
    before, after = planar_points(warp.Input), planar_points(warp)
    assert numpy.array_equal(before[outside], after[outside])
    turn = numpy.exp(1j * numpy.radians(TURN))
    assert numpy.allclose(after[hole] - after[hole].mean(), turn * (before[hole] - before[hole].mean()), atol=1e-6)
    assert "all 1913 elements are valid" in warp.Summary, warp.Summary


def legend_labels():
    """The labels of the legend, or None for ParaView's labels."""
    view = simple.GetActiveView()
    legend = next(one for one in view.Representations if one.GetXMLName() == "ScalarBarWidgetRepresentation")
    return list(legend.CustomLabels) if legend.UseCustomLabels else None


def set_criteria(criteria):
    quality = find("ElementQuality")
    quality.Criteria = criteria
    quality.UpdatePipeline()


@check
def preset_labels():
    """The preset fem: a warning beyond 3; failures beyond 10 are no color of the map. Next: own limits."""
    assert legend_labels() == [3], legend_labels()
    limits = '{ "ideal": 1, "good": 1.2, "warn": 1.5, "fail": 2.5, "worst": 9 }'
    set_criteria('{ "criteria": [ { "metric": "imr", "limits": { "all": %s } } ] }' % limits)


@check
def own_labels():
    assert legend_labels() == [1.5, 2.5], legend_labels()
    set_criteria("")


@check
def no_labels():
    assert legend_labels() is None, legend_labels()


@check
def no_grade():
    summary = find("ElementQuality").Summary
    assert "which are for shells; for solids there are fem, skewness, optistruct_solids, " in summary, summary


@check
def colored_by_grade():
    quality = find("ElementQuality")
    assert re.match(r"Failed by .*solids.*Valid elements that fail: mean_ratio \d+", quality.Summary), quality.Summary
    shown = simple.GetDisplayProperties(quality)
    assert list(shown.ColorArrayName) == ["CELLS", "Grade"], list(shown.ColorArrayName)


@check
def show_worst():
    quality = find("ElementQuality")
    assert simple.GetDisplayProperties(quality).Opacity == 1
    simple.Show(simple.OutputPort(quality, WORST_PORT))


@check
def worst_inside():
    """The mesh is translucent, the points are spheres."""
    quality = find("ElementQuality")
    assert simple.GetDisplayProperties(quality).Opacity < 0.5
    port = simple.OutputPort(quality, WORST_PORT)
    shown = simple.GetDisplayProperties(port)
    assert shown.RenderPointsAsSpheres == 1 and shown.PointSize > 5
    simple.Render()


@check
def worst_hidden():
    simple.Hide(simple.OutputPort(find("ElementQuality"), WORST_PORT))


@check
def mesh_opaque():
    assert simple.GetDisplayProperties(find("ElementQuality")).Opacity == 1


@check
def objectives_table():
    """The first of three objectives was removed: the others moved up, with all they have; the run has two."""
    optimizer = find("MeshOptimizer")
    columns = ("Metric", "Template", "Target", "Weight")
    rows = [tuple(optimizer.GetPropertyValue(f"{column}{row}") for column in columns) for row in (1, 2)]
    assert optimizer.NumberOfObjectives == 2
    assert rows == [
        ("Minimum angle", "Sum of reciprocals", "Ideal element", 0.25),
        ("Edge length ratio", "As usual for the metric", "Ideal element", 1),
    ], rows
    history = servermanager.Fetch(optimizer, idx=1)
    assert history.GetColumnByName("min_angle worst") and history.GetColumnByName("edge_ratio worst")
    assert not history.GetColumnByName("imr worst")


@check
def open_cube():
    """A mesh whose optimization can take long: 40000 tetrahedra, perturbed."""
    cube = simple.Tetrahedralize(Input=simple.Wavelet(WholeExtent=[-10, 10] * 3))
    mesh = simple.PerturbMesh(Input=cube)
    simple.Show(mesh)
    simple.SetActiveSource(mesh)


@check
def prepare_long_run():
    """A run of about half a minute, and a process that will press Stop in it."""
    optimizer = find("MeshOptimizer")
    optimizer.Preset, optimizer.Optimizer, optimizer.Scalarization = "Custom", "L-BFGS", "Lexicographic"
    optimizer.NumberOfObjectives, optimizer.Metric2 = 2, "Edge length ratio"
    optimizer.MaximumIterations, optimizer.TimeLimit = 1000000, 40
    optimizer.GradientNorm = optimizer.RelativeChange = 0
    here = os.path.dirname(os.path.abspath(__file__))
    subprocess.Popen(["/usr/bin/python3", os.path.join(here, "press_stop.py"), "2"])


@check
def stopped_run():
    """The run ended by Stop, with the best mesh so far: not the input, and no worse one."""
    optimizer = find("MeshOptimizer")
    assert optimizer.Reason == "Stopped on request.", optimizer.Reason
    mesh, history = servermanager.Fetch(optimizer), servermanager.Fetch(optimizer, idx=1)
    objective = vtk_to_numpy(history.GetColumnByName("Objective"))
    # On a busy machine there is one iteration before Stop. Later ones are of the second objective.
    assert len(objective) > 1 and (numpy.diff(objective[:3]) < 0).all(), objective[:4]
    moved = vtk_to_numpy(mesh.GetPointData().GetArray("Displacement"))
    assert mesh.GetNumberOfCells() == 40000 and abs(moved).max() > 0.01
    quality = [vtk_to_numpy(mesh.GetCellData().GetArray(name)).mean() for name in ("imr_before", "imr")]
    assert quality[1] < quality[0], quality


@check
def short_run():
    """A run of the same filter on a small mesh, in fewer steps than ParaView passes on texts of the progress."""
    data = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Data")
    plate = simple.XMLUnstructuredGridReader(FileName=[os.path.join(data, "plate.vtu")])
    optimizer = simple.OptimizeMesh(Input=simple.PerturbMesh(Input=plate), Preset="Custom", MaximumIterations=2)
    simple.Show(optimizer)
    simple.SetActiveSource(optimizer)


@check
def chained_run():
    """Untangle Mesh and, in the same update, Optimize Mesh, long enough for texts of the progress."""
    data = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Data")
    tangled = simple.XMLUnstructuredGridReader(FileName=[os.path.join(data, "bracket-tangled.vtu")])
    optimizer = simple.OptimizeMesh(Input=simple.UntangleMesh(Input=tangled))
    optimizer.Preset, optimizer.Boundary = "Worst element", "Slide on smooth parts"
    simple.Show(optimizer)


@check
def moved_in_plane():
    """The hole was translated in the plane, up and to the right as the mouse, and no more."""
    warp = find("MeshWarp")
    transform = warp.Transform
    assert list(transform.Scale) == [1, 1, 1] and list(transform.Rotate) == [0, 0, 0], list(transform.Scale)
    x, y, z = transform.Translate
    assert x > 0 and y > 0 and z == 0, (x, y, z)
    mesh = servermanager.Fetch(warp)
    assert mesh.GetBounds()[4] == mesh.GetBounds()[5]
    moved = vtk_to_numpy(mesh.GetPointData().GetArray("Displacement"))
    assert numpy.allclose(moved[numpy.argmax(numpy.linalg.norm(moved, axis=1))], (x, y, 0), rtol=1e-6)
    MOVED.append((x, y))


@check
def bad_inside():
    """The elements outside of the acceptable range are drawn, in the mesh, which is translucent."""
    quality = find("ElementQuality")
    assert simple.GetDisplayProperties(quality).Opacity < 0.5
    bad = simple.OutputPort(quality, BAD_PORT)
    shown = simple.GetDisplayProperties(bad)
    style = shown.Representation
    assert shown.Visibility and shown.Opacity == 1 and style == "Surface With Edges", (shown.Opacity, style)
    values = vtk_to_numpy(servermanager.Fetch(quality).GetCellData().GetArray("imr"))
    outside = int(((values < 1) | (values > 3)).sum())
    assert bad.GetDataInformation().GetNumberOfCells() == outside > 200, outside


def open_grid(grid, name: str) -> None:
    """Write a grid, read it in ParaView and show it."""
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(os.path.join(os.environ["TAUTLINE_TEST_DIR"], name))
    writer.SetInputData(grid)
    assert writer.Write()
    reader = simple.XMLUnstructuredGridReader(FileName=[writer.GetFileName()])
    simple.Show(reader)
    simple.SetActiveSource(reader)


@check
def open_curved():
    """A row of quadratic tetrahedra, one of them folded along an edge."""
    corners = numpy.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
    middles = numpy.array([(corners[a] + corners[b]) / 2 for a, b in ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))])
    grid, points = vtkUnstructuredGrid(), vtkPoints()
    points.SetDataTypeToDouble()
    for number in range(3):
        nodes = numpy.concatenate([corners, middles])
        nodes[5] = (0.2, 0.2, 0) if number == 1 else nodes[5]  # of the edge 1 2
        ids = [points.InsertNextPoint(node + [2 * number, 0, 0]) for node in nodes]
        grid.InsertNextCell(QUADRATIC_TETRAHEDRON, len(ids), ids)
    grid.SetPoints(points)
    open_grid(grid, "curved.vtu")


@check
def open_ring():
    """A disk without its middle, of quadrilaterals."""
    around = 12
    points, grid = vtkPoints(), vtkUnstructuredGrid()
    points.SetDataTypeToDouble()
    for radius in (1, 2):
        for angle in 2 * numpy.pi * numpy.arange(around) / around:
            points.InsertNextPoint(radius * numpy.cos(angle), radius * numpy.sin(angle), 0)
    for i in range(around):
        j = (i + 1) % around
        grid.InsertNextCell(QUADRILATERAL, 4, [i, i + around, j + around, j])
    grid.SetPoints(points)
    open_grid(grid, "ring.vtu")


@check
def open_two_blocks():
    """A block with values, and one of the same size with fewer cells, which is active."""
    for name, step in (("fine", 1), ("coarse", 2)):
        block = simple.Wavelet(registrationName=name, WholeExtent=[-4, 4] * 3, SubsampleRate=step)
        simple.Show(block)
    simple.SetActiveSource(block)


@check
def values_transferred():
    """The coarse block has the values, with the total of the fine one."""
    transfer = find("FieldTransfer")
    fine, coarse = servermanager.Fetch(find_named("fine")), servermanager.Fetch(transfer)
    assert coarse.GetNumberOfPoints() == 5**3, transfer.Summary
    totals = servermanager.Fetch(transfer, idx=1)
    before, after = (totals.GetColumnByName(name).GetValue(0) for name in ("TotalBefore", "TotalAfter"))
    assert before > 0 and numpy.isclose(before, after, rtol=1e-12, atol=0), transfer.Summary
    values = vtk_to_numpy(coarse.GetPointData().GetArray("RTData"))
    low, high = fine.GetPointData().GetArray("RTData").GetRange()
    assert values.min() >= low - 1e-9 and values.max() <= high + 1e-9


@check
def ring_curved():
    """The middle nodes are near the circles, and the cells are valid."""
    curved = find("MeshCurving")
    mesh = servermanager.Fetch(curved)
    radii = numpy.linalg.norm(vtk_to_numpy(mesh.GetPoints().GetData()), axis=1)
    middle = numpy.isclose(radii, 1.5, atol=0.01)
    assert (numpy.isclose(radii, 1, atol=0.01) | numpy.isclose(radii, 2, atol=0.01) | middle).all(), radii
    assert (vtk_to_numpy(mesh.GetCellData().GetArray("Validity")) == 1).all()
    # For the next filter, nodes inside are taken across the cells.
    points = vtk_to_numpy(mesh.GetPoints().GetData())
    points[middle & (points[:, 0] > 0)] *= 1.4
    open_grid(mesh, "folded.vtu")


@check
def metric_shown():
    """An ellipsoid per point, and the mesh as lines; the size on the inner circle follows from its radius."""
    metric = find("MeshMetric")
    metric.UpdatePropertyInformation()
    assert simple.GetDisplayProperties(metric).Representation == "Wireframe"
    ellipsoids = simple.OutputPort(metric, 1)
    assert simple.GetDisplayProperties(ellipsoids).Visibility
    glyphs = servermanager.Fetch(metric, idx=1)
    points = servermanager.Fetch(metric).GetNumberOfPoints()
    assert len(set(vtk_to_numpy(glyphs.GetPointData().GetArray("PointId")))) == points, metric.Summary
    chord = numpy.linalg.norm((4, 4)) / 1000
    assert numpy.isclose(metric.SmallestFound, (8 * chord) ** 0.5), metric.SmallestFound


@check
def ring_untangled():
    """All nodes move, and each cell is valid everywhere in it."""
    untangled = find("MeshUntangler")
    untangled.UpdatePropertyInformation()
    assert untangled.InvertedBefore > 0 and untangled.InvertedAfter == 0, untangled.Summary
    mesh = servermanager.Fetch(untangled)
    assert (vtk_to_numpy(mesh.GetCellData().GetArray("Validity")) == 1).all()


@check
def curved_shown():
    """Curved edges are subdivided, and the worst elements are drawn where their determinant is smallest."""
    quality = find("ElementQuality")
    bad, worst = simple.OutputPort(quality, BAD_PORT), simple.OutputPort(quality, WORST_PORT)
    for port in (quality, bad):
        assert simple.GetDisplayProperties(port).NonlinearSubdivisionLevel == 3, port
    shown = simple.GetDisplayProperties(worst)
    assert shown.Visibility and shown.RenderPointsAsSpheres, shown.Visibility
    first = servermanager.Fetch(quality, idx=WORST_PORT).GetPoint(0)
    assert 2 <= first[0] <= 3 and first[2] == 0, first  # on the folded edge of the second tetrahedron


@check
def sections_inside():
    """On the surface the solution is 0; the sections have values of the inside, in three planes."""
    solver = find("EllipticSolver")
    mesh = servermanager.Fetch(solver)
    low, high = mesh.GetPointData().GetArray("Solution").GetRange()
    shown = simple.GetDisplayProperties(solver)
    assert shown.Visibility and shown.Opacity < 0.5, shown.Opacity
    port = simple.OutputPort(solver, SECTIONS_PORT)
    drawn = simple.GetDisplayProperties(port)
    assert drawn.Visibility and drawn.Opacity == 1, drawn.Opacity
    assert list(drawn.ColorArrayName) == list(shown.ColorArrayName) == ["POINTS", "Solution"], drawn.ColorArrayName[:]
    sections = servermanager.Fetch(solver, idx=SECTIONS_PORT)
    values = vtk_to_numpy(sections.GetPointData().GetArray("Solution"))
    assert low == 0 and 0.5 * high < values.max() <= high * (1 + 1e-12), (values.max(), high)
    # Most points have one of three coordinates: x, y or z of a plane.
    points = vtk_to_numpy(sections.GetPoints().GetData()).round(6)
    planes = [max(zip(*numpy.unique(points[:, axis], return_counts=True)[::-1]))[1] for axis in range(3)]
    assert (points == planes).any(axis=1).all() and (points == planes).any(axis=0).all(), planes


@check
def no_sections():
    solver = find("EllipticSolver")
    assert simple.GetDisplayProperties(solver).Opacity == 1
    assert servermanager.Fetch(solver, idx=SECTIONS_PORT).GetNumberOfCells() == 0


@check
def cases():
    """The legend has names for the cases; the edges are drawn, and what replaces cut triangles is not."""
    neighbors = find("HorizonNeighbors")
    shown = simple.GetDisplayProperties(neighbors)
    assert shown.Representation == "Surface With Edges" and shown.ColorArrayName[1] == "Case", shown.Representation
    colors = simple.GetColorTransferFunction("Case")
    names = dict(zip(colors.Annotations[::2], colors.Annotations[1::2]))
    values = numpy.unique(vtk_to_numpy(servermanager.Fetch(neighbors).GetCellData().GetArray("Case")))
    assert colors.InterpretValuesAsCategories and {str(value) for value in values} <= set(names), (names, values)
    assert [names[str(case)] for case in (1, 2, 3)] == ["1: all three", "2: two", "3: one"], names
    drawn = [one for one in simple.GetActiveView().Representations if hasattr(one, "Input") and one.Visibility]
    assert len(drawn) == 2, drawn  # and the circle
