# SPDX-License-Identifier: BSD-3-Clause
"""pvpython make_pictures.py PLUGIN [NAME...]: draws the pictures of the help pages, NAME.png, or those named.

Each function below draws the picture of its name, mostly the picture of the page of this name; what it returns is
saved. The colors: pale is good, dark red is bad, blue is inverted and nothing else; a change is green or orange, other
fields go from pale to dark green, regions have colors of REGIONS.
"""

import math
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

from paraview import servermanager, simple  # noqa: E402
from small_png import read, write, write_smooth  # noqa: E402
from vtkmodules.vtkCommonCore import vtkPoints  # noqa: E402
from vtkmodules.vtkCommonDataModel import (  # noqa: E402
    VTK_QUADRATIC_TETRA,
    VTK_QUADRATIC_TRIANGLE,
    vtkUnstructuredGrid,
)
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter  # noqa: E402

DATA = HERE.parents[1] / "Data"
WIDE, HEIGHT = 660, 280  # pixels: ParaView's help window shows 680 at first
FINE_WIDE, FINE_HEIGHT = 600, 190  # of meshes with many edges
WIDEST_PLAIN = 860  # of three meshes
HERO_WIDE = 1200  # of README.md
GAP = 4  # between two views
SMOOTH = ("before_after", "warp_mesh")  # pictures with as many shades as there is room for
CELLS, POINTS = 1, 0
FLAT, LIT, BRIGHT = (1, 0), (0.6, 0.5), (0.75, 0.35)  # ambient and diffuse light
DARK = [0.25, 0.25, 0.25]
PLAIN = [0.80, 0.80, 0.77]  # a mesh without colors
RED = [0.8, 0.2, 0.15]
DARK_RED = [0.72, 0.06, 0.11]  # bad, as in Filters/Quality/ColorMaps.cxx
BLUE = [0.05, 0.35, 1.0]  # inverted, as in Filters/Quality/ColorMaps.h
SHADOW = [0.4, 0.4, 0.4]  # a translucent mesh around what lies inside
INSIDE = 0.12  # its opacity
FIELD = ((0.90, 0.93, 0.76), (0.52, 0.73, 0.42), (0.05, 0.30, 0.15))  # from low to high
REGIONS = ((0.90, 0.86, 0.72), (0.55, 0.72, 0.55), (0.62, 0.45, 0.62), (0.80, 0.60, 0.35))
OBLIQUE = ([0.9, -2, 1.0], [0, 0, 1])  # direction to the camera, and up


def sample(name: str):
    return simple.OpenDataFile(str(DATA / name))


def output(source, port: int):
    return simple.OutputPort(source, port)


def new_view(camera=None):
    view = simple.CreateView("RenderView")
    view.OrientationAxesVisibility = view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    view.CameraParallelProjection = 1
    view.CenterAxesVisibility = 0
    if camera:
        view.CameraPosition, view.CameraViewUp = camera
        view.CameraFocalPoint = [0, 0, 0]
    return view


def draw(source, view, array=None, where=CELLS, light=FLAT, edges=True, color=None, opacity=1.0):
    """Shows the source; with an array in its colors, else in one color."""
    display = simple.Show(source, view)
    display.Representation = "Surface With Edges" if edges else "Surface"
    display.EdgeColor = DARK
    display.Ambient, display.Diffuse = light
    display.Opacity = opacity
    if array:
        display.SetScalarColoring(array, where)
    else:
        display.ColorArrayName = [None, ""]
        display.AmbientColor = display.DiffuseColor = color or PLAIN
    return display


def fit(view, zoom=1.0):
    simple.ResetCamera(view)
    view.CameraParallelScale /= zoom
    return view


def fit_plane(view, source, ratio):
    """The camera sees the planar source in a view of this ratio of width and height."""
    simple.ResetCamera(view)
    left, right, low, high, *_ = source.GetDataInformation().GetBounds()
    view.CameraParallelScale = 0.53 * max(high - low, (right - left) / ratio)
    return view


def side_by_side(*views, size=(WIDE, HEIGHT)):
    """The views from left to right in one layout."""
    layout = simple.CreateLayout("Pictures")
    place = 0
    for number, view in enumerate(views):
        simple.AssignViewToLayout(view=view, layout=layout, hint=place)
        left = len(views) - number
        if left > 1:
            place = layout.SplitHorizontal(place, 1 / left) + 1
    return layout, size


def field(array, low, high, colors=FIELD):
    """Colors of an array between two values."""
    table = simple.GetColorTransferFunction(array)
    places = [low + i * (high - low) / (len(colors) - 1) for i in range(len(colors))]
    table.RGBPoints = [number for place, rgb in zip(places, colors) for number in (place, *rgb)]
    table.ColorSpace, table.AutomaticRescaleRangeMode = "Lab", "Never"


def field_of(source, array, where=POINTS):
    """The same for the values that the source has."""
    source.UpdatePipeline()
    data = source.GetDataInformation().DataInformation
    information = data.GetPointDataInformation() if where == POINTS else data.GetCellDataInformation()
    field(array, *information.GetArrayInformation(array).GetComponentRange(0))


def regions(array, numbers):
    """A color for each number."""
    table = simple.GetColorTransferFunction(array)
    table.InterpretValuesAsCategories = 1
    table.Annotations = [text for number in numbers for text in (str(number), str(number))]
    table.IndexedColors = [channel for i in range(len(numbers)) for channel in REGIONS[i % len(REGIONS)]]


def numbers_in(mesh, array) -> list:
    """The different values of a cell array of integers."""
    mesh.UpdatePipeline()
    low, high = mesh.CellData[array].GetRange()
    return list(range(int(low), int(high) + 1))


def draw_around(mesh, view):
    """The surface of a mesh, translucent."""
    return draw(simple.ExtractSurface(Input=mesh), view, edges=False, opacity=INSIDE, light=LIT, color=SHADOW)


def cut(mesh, front=0):
    """The half of the elements behind the middle, whole ones, or the one in front of it."""
    mesh.UpdatePipeline()
    bounds = mesh.GetDataInformation().GetBounds()
    half = simple.Clip(Input=mesh, ClipType="Plane", Crinkleclip=1, Invert=front)
    half.ClipType.Origin = [(bounds[i] + bounds[i + 1]) / 2 for i in (0, 2, 4)]
    half.ClipType.Normal = [0, 1, 0]
    return half


def draw_cut(mesh, view, array=None, light=LIT):
    """One half of the mesh; the other one is translucent."""
    draw(cut(mesh), view, array, light=light)
    draw_around(cut(mesh, 1), view)


def chosen(mesh, array, method, low=0.0, high=0.0):
    """The elements whose value of a cell array is in a range."""
    part = simple.Threshold(Input=mesh, Scalars=["CELLS", array], ThresholdMethod=method)
    part.LowerThreshold, part.UpperThreshold = low, high
    part.UpdatePipeline()
    return part


def invalid_elements(quality):
    return chosen(output(quality, 0), "Validity", "Below Lower Threshold", 0)


def numbers_of(mesh) -> list:
    """The numbers of the elements, from the array Number that numbered() added."""
    data = servermanager.Fetch(mesh).GetCellData().GetArray("Number")
    return [int(data.GetValue(i)) for i in range(data.GetNumberOfTuples())]


def numbered(mesh):
    """The mesh with the cell array Number."""
    return simple.GenerateIds(Input=mesh, CellIdsArrayName="Number")


def same_elements(mesh, numbers):
    """The elements with these numbers."""
    ids = [value for number in numbers for value in (-1, number)]  # -1: of any process
    selected = simple.IDSelectionSource(FieldType="CELL", IDs=ids)
    return simple.ExtractSelection(Input=mesh, Selection=selected)


def text_in(view, text, place, size=18):
    note = simple.Show(simple.Text(Text=text), view)
    note.Color, note.FontSize, note.FontFamily = [0, 0, 0], size, "Arial"
    note.WindowLocation, note.Position = "Any Location", list(place)


def swatch(view, left, right, color=None):
    """A rectangle of the legend; without a color the colors of the inverse mean ratio from 1 to 3."""
    plane = simple.Plane(Origin=[left, 0.3, 0], Point1=[right, 0.3, 0], Point2=[left, 0.75, 0], XResolution=200)
    if color:
        return draw(plane, view, edges=False, color=color)
    formula = f"1+2*(coordsX-{left})/{right - left}"
    rising = simple.Calculator(Input=plane, Function=formula, ResultArrayName="imr")
    return draw(rising, view, "imr", POINTS, edges=False)


def quality_legend(size):
    """One row with the colors of the inverse mean ratio and words; `size` in pixels."""
    view = new_view()
    wide = size[0] / size[1]  # heights of the row
    worse = list(simple.GetColorTransferFunction("imr").AboveRangeColor)
    swatch(view, 0.27 * wide, 0.49 * wide)
    for place, color, text in ((0.59, worse, "worse than 3"), (0.78, BLUE, "inverted")):
        swatch(view, place * wide, (place + 0.025) * wide, color)
        text_in(view, text, (place + 0.035, 0.3))
    for place, text in ((0.08, "Inverse mean ratio"), (0.25, "1"), (0.5, "3")):
        text_in(view, text, (place, 0.3))
    view.CameraFocalPoint, view.CameraPosition = [wide / 2, 0.5, 0], [wide / 2, 0.5, 10]
    view.CameraParallelScale = 0.5
    return side_by_side(view, size=size)


def before_after():
    """The mesh of `./run demo` before and after, cut open, for README.md."""
    from tautline import demo

    folder = Path(tempfile.mkdtemp())
    start = demo.start(folder)
    demo.measure(start, folder)
    demo.improve(start, folder)
    views = []
    for name, words in (("quality", "before: {} inverted elements"), ("better", "after: {} inverted elements")):
        mesh = simple.OpenDataFile(str(folder / f"{name}.vtu"))
        inverted = chosen(mesh, "Validity", "Below Lower Threshold", -1)
        count = inverted.GetDataInformation().GetNumberOfCells()
        view = new_view(([0.75, -1.0, 0.55], [0, 0, 1]))
        draw_cut(mesh, view, "imr", BRIGHT)
        if count:
            draw(inverted, view, "imr", light=BRIGHT)
        text_in(view, words.format(count or "no"), (0.25, 0.02), 24)
        views.append(fit(view, 1.25))
    return side_by_side(*views, size=(HERO_WIDE, 440)), quality_legend((HERO_WIDE, 44))


def element_quality():
    quality = simple.ElementQuality(Input=sample("bracket-tangled.vtu"))
    outside, inside = new_view(OBLIQUE), new_view(OBLIQUE)
    draw(output(quality, 0), outside, "imr", light=LIT)
    draw_around(output(quality, 0), inside)
    draw(output(quality, 7), inside, "imr", light=LIT)
    return side_by_side(fit(outside, 1.2), fit(inside, 1.2))


def curved_mesh(name, points, cell_type, cells):
    """Cells of one curved type; edges are drawn as curves."""
    grid = vtkUnstructuredGrid()
    places = vtkPoints()
    places.SetDataTypeToDouble()
    for point in points:
        places.InsertNextPoint(point)
    grid.SetPoints(places)
    for cell in cells:
        grid.InsertNextCell(cell_type, len(cell), cell)
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(str(Path(tempfile.mkdtemp()) / f"{name}.vtu"))
    writer.SetInputData(grid)
    writer.Write()
    return simple.OpenDataFile(writer.GetFileName())


def draw_curved(source, view, array=None, **options):
    display = draw(source, view, array, **options)
    display.NonlinearSubdivisionLevel = 4
    return display


def nonpositive_jacobian_1():
    """A valid triangle, one with a node beyond a quarter of its edge, one with a curved side near its corner."""
    views = []
    for middle, side in (((0.5, 0.5), (0.5, -0.08)), ((0.5, 0.5), (0.12, 0)), ((0.2, 0.2), (0.5, 0))):
        corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
        mesh = curved_mesh("triangle", [*corners, (*side, 0), (*middle, 0), (0, 0.5, 0)], VTK_QUADRATIC_TRIANGLE,
                           [range(6)])  # fmt: skip
        quality = simple.ElementQuality(Input=mesh)
        quality.UpdatePipeline()
        valid = output(quality, 0).CellData["Validity"].GetRange()[0] == 1
        view = new_view()
        draw_curved(output(quality, 0), view, color=PLAIN if valid else BLUE)
        views.append(fit(view, 1.3))
    return side_by_side(*views, size=(WIDE, 220))


def coarse_tube():
    """A tube of few quadratic tetrahedra with its nodes on a cone and a cylinder: folded where it is thin."""
    around, along, bottom, top = 8, 3, 0.55, 0.8
    lattice, numbers = [], {}

    def number(across, turn, up):  # in half steps
        key = (across, turn % (2 * around), up)
        if key not in numbers:
            numbers[key] = len(lattice)
            inner = bottom + (top - bottom) * up / (2 * along)
            radius = inner + (1 - inner) * across / 2
            angle = math.pi * key[1] / around
            lattice.append((radius * math.cos(angle), radius * math.sin(angle), 0.5 * up))
        return numbers[key]

    corners = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
    simplices = [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]
    edges = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
    cells = []
    for turn in range(0, 2 * around, 2):
        for up in range(0, 2 * along, 2):
            for simplex in simplices:
                places = [(corners[k][0], corners[k][1] + turn, corners[k][2] + up) for k in simplex]
                middles = [tuple((a + b) // 2 for a, b in zip(places[i], places[j])) for i, j in edges]
                cells.append([number(*place) for place in places + middles])
    # Nodes inside are where a mesh generator leaves them: in the middle of straight edges.
    inside = {node for (across, _, _), node in numbers.items() if across == 1}
    for cell in cells:
        for (i, j), node in zip(edges, cell[4:]):
            if node in inside:
                lattice[node] = tuple((x + y) / 2 for x, y in zip(lattice[cell[i]], lattice[cell[j]]))
    return curved_mesh("tube", lattice, VTK_QUADRATIC_TETRA, cells)


def drawn_inside(mesh, elements, color):
    view = new_view(OBLIQUE)
    draw_curved(mesh, view, edges=False, opacity=INSIDE, light=LIT, color=SHADOW)
    draw_curved(elements, view, color=color, light=LIT)
    return fit(view, 0.95)


def nonpositive_jacobian_2():
    """The tube, and its folded elements."""
    quality = simple.ElementQuality(Input=coarse_tube())
    whole = new_view(OBLIQUE)
    draw_curved(output(quality, 0), whole, light=LIT)
    return side_by_side(fit(whole, 0.95), drawn_inside(output(quality, 0), invalid_elements(quality), BLUE))


def nonpositive_jacobian_3():
    """The tube after Untangle Mesh, and the same elements, which are valid."""
    tube = coarse_tube()
    folded = numbers_of(invalid_elements(simple.ElementQuality(Input=numbered(tube))))
    quality = simple.ElementQuality(Input=output(simple.UntangleMesh(Input=tube), 0))
    assert not invalid_elements(quality).GetDataInformation().GetNumberOfCells()
    whole = new_view(OBLIQUE)
    draw_curved(output(quality, 0), whole, light=LIT)
    elements = same_elements(output(quality, 0), folded)
    return side_by_side(fit(whole, 0.95), drawn_inside(output(quality, 0), elements, PLAIN))


def before_and_after(before, after, array="imr", zoom=1.7):
    views = [new_view(), new_view()]
    for mesh, view in zip((before, after), views):
        draw(mesh, view, array)
        fit(view, zoom)
    return side_by_side(*views, size=(FINE_WIDE, FINE_HEIGHT))


def optimize_mesh():
    plate = sample("plate.vtu")
    better = simple.OptimizeMesh(Input=plate)
    return before_and_after(simple.ElementQuality(Input=plate), output(better, 0))


def improve_mesh():
    """The bracket cut open, and all tetrahedra with a dihedral angle below 25 degrees, dark red."""
    bracket = sample("bracket.vtu")
    quality = simple.ElementQuality(Input=bracket, Metrics=["Minimum angle"])
    better = simple.ImproveMesh(Input=bracket, Preset="Aggressive")
    views = []
    for mesh in (quality, better):
        bad = chosen(output(mesh, 0), "min_angle", "Below Lower Threshold", 25)
        view = new_view(OBLIQUE)
        draw_cut(output(mesh, 0), view)
        if bad.GetDataInformation().GetNumberOfCells():
            draw(bad, view, color=DARK_RED, light=LIT)
        views.append(fit(view, 1.2))
    return side_by_side(*views)


def improve_mesh_plane():
    """Triangles, colored by their smallest angles; the points of the first were moved at random."""
    worse = simple.PerturbMesh(Input=sample("wrench.msh"), Percentage=100, Fraction=0.95)
    quality = simple.ElementQuality(Input=worse, Metrics=["Minimum angle"])
    better = simple.ImproveMesh(Input=worse, Preset="Aggressive")
    views = [new_view(), new_view()]
    for mesh, view in zip((quality, better), views):
        draw(output(mesh, 0), view, "min_angle")
        fit(view, 3.4)
    return side_by_side(*views, size=(FINE_WIDE, FINE_HEIGHT))


def adapted_to(solved, field, elements, rounds=2, **options):
    """The mesh after Metric Tensor of a field and Improve Mesh, preset Adapt; `solved` adds the field to a mesh."""
    mesh = None
    for _ in range(rounds):
        metric = simple.MetricTensor(
            Input=solved(mesh), Source="Hessian", Field=["POINTS", field], TargetValue=elements, **options)
        adapted = simple.ImproveMesh(
            Input=output(metric, 0), Preset="Adapt", EdgeLengths="Point array", SizeArray=["POINTS", "Metric"],
            Boundary="Slide on flat parts")  # fmt: skip
        mesh = output(adapted, 0)
    return solved(mesh)


def improve_mesh_adapt():
    """A front across a rectangle, and the mesh that was adapted to it."""
    start = simple.MeshDomain(Domain="Rectangle, Structured", NumberOfCells=800)

    def front(mesh):
        return simple.Calculator(
            Input=mesh or start, Function="tanh(6*(coordsX-0.5*coordsY-0.7))", ResultArrayName="front")

    left, right = new_view(), new_view()
    draw(front(None), left, "front", POINTS)
    field_of(front(None), "front")
    draw(adapted_to(front, "front", 300, 4, LargestSize=0.4, LargestAnisotropy=8), right)
    return side_by_side(fit(left, 1.95), fit(right, 1.95), size=(WIDE, 180))


def corner_mesh():
    return output(simple.TriangleMesher(Input=sample("corner.poly"), Size=0.2), 0)


def solved_on(mesh):
    return output(simple.SolvePDE(Input=mesh or corner_mesh()), 0)


def refine_solution_1():
    """The solution on the first mesh, and the ellipsoids of its metric."""
    solved = solved_on(None)
    metric = simple.MetricTensor(Input=solved, Source="Hessian", Field=["POINTS", "Solution"], TargetValue=700,
                                 LargestSize=0.5, MaximumEllipsoids=300, EllipsoidScale=0.4)  # fmt: skip
    left, right = new_view(), new_view()
    draw(solved, left, "Solution", POINTS)
    field_of(solved, "Solution")
    draw(output(metric, 1), right, "Size", POINTS, edges=False)
    field_of(output(metric, 1), "Size")
    return side_by_side(fit(left, 1.3), fit(right, 1.3))


def refine_solution_2():
    """The adapted mesh, all of it and at the inner corner."""
    adapted = adapted_to(solved_on, "Solution", 700, 4, LargestSize=0.5)
    whole, near = new_view(), new_view()
    for view in (whole, near):
        draw(adapted, view, "Solution", POINTS)
    field_of(adapted, "Solution")
    fit(whole, 1.3)
    fit(near, 3.5).CameraFocalPoint = [0, 0, 0]
    near.CameraPosition = [0, 0, 5]
    return side_by_side(whole, near)


def untangle_mesh():
    """The inverted elements, and the same elements after."""
    bracket = numbered(sample("bracket-tangled.vtu"))
    before = simple.ElementQuality(Input=bracket)
    after = simple.ElementQuality(Input=output(simple.UntangleMesh(Input=bracket), 0))
    inverted = invalid_elements(before)
    views = []
    for mesh, elements in ((before, inverted), (after, same_elements(output(after, 0), numbers_of(inverted)))):
        view = new_view(OBLIQUE)
        draw_around(output(mesh, 0), view)
        draw(elements, view, "imr", light=LIT)
        views.append(fit(view, 1.2))
    return side_by_side(*views)


def hole_of(mesh):
    """The boundary of the plate's hole."""
    edges = simple.FeatureEdges(Input=simple.ExtractSurface(Input=mesh), FeatureEdges=0, NonManifoldEdges=0)
    return simple.Clip(Input=edges, ClipType="Sphere", Invert=1)


def mark_turn(view, mesh, angle):
    """The hole's boundary, and an arrow along it from the first place of a point to where it moved."""
    mesh.UpdatePipeline()
    left, right, low, high, *_ = mesh.GetDataInformation().GetBounds()
    center = [(left + right) / 2, (low + high) / 2]
    hole = hole_of(mesh)
    hole.ClipType.Center, hole.ClipType.Radius = [*center, 0], 0.3 * (high - low)
    hole.UpdatePipeline()
    bounds = hole.GetDataInformation().GetBounds()
    radius = (bounds[1] - bounds[0]) / 2
    rim = draw(hole, view, edges=False, color=[0, 0, 0])
    rim.LineWidth, rim.Position = 3, [0, 0, 0.05]

    def at(degrees, distance):
        turn = math.radians(degrees)
        return [center[0] + distance * math.cos(turn), center[1] + distance * math.sin(turn), 0.1]

    begin, end, inner, head = 60, 60 + angle, 0.68 * radius, 22
    lines = [[at(begin, 0.86 * inner), at(begin, 1.14 * inner)]]
    lines.append([at(degrees, inner) for degrees in range(begin, end + 1, 4)])
    lines.append([at(end - head, 0.78 * inner), at(end, inner), at(end - head, 1.22 * inner)])
    for line in lines:
        arrow = draw(simple.PolyLineSource(Points=[number for point in line for number in point]), view, edges=False,
                     color=[0, 0, 0])  # fmt: skip
        arrow.LineWidth = 3


def warp_mesh():
    """The hole is turned by 120 degrees: the plate, FEMWARP, which inverts elements, and the hybrid method."""
    plate = sample("plate.vtu")
    angle = 120
    views = [new_view() for _ in range(3)]
    draw(plate, views[0], color=[1, 1, 1])
    counts = []
    for method, view in zip(("FEMWARP", "Hybrid"), views[1:]):
        turned = simple.WarpMesh(Input=plate, Method=method, TransformKind="Rotation", Angle=angle)
        quality = simple.ElementQuality(Input=output(turned, 0))
        inverted = invalid_elements(quality)
        counts.append(inverted.GetDataInformation().GetNumberOfCells())
        draw(output(quality, 0), view, "imr")
        if counts[-1]:
            draw(inverted, view, "imr").Position = [0, 0, 0.1]  # they lie below others
    assert counts == [111, 0], counts  # as README.md has them
    for view in views:
        mark_turn(view, plate, angle)
        fit(view, 2.6)
    return side_by_side(*views, size=(WIDEST_PLAIN, 220))


def perturb_mesh():
    plate = sample("plate.vtu")
    worse = simple.PerturbMesh(Input=plate, TangledFraction=0.01)
    quality = simple.ElementQuality(Input=worse)
    layout = before_and_after(simple.ElementQuality(Input=plate), output(quality, 0))
    inverted = chosen(output(quality, 0), "Validity", "Below Lower Threshold", -1)
    draw(inverted, simple.GetActiveView(), "imr").Position = [0, 0, 0.1]  # they lie below others
    return layout


def curve_mesh():
    """A cylinder of twelve facets around; edges are drawn as lines between their nodes."""
    cylinder = simple.Cylinder(Resolution=12, Height=0.8)
    views = []
    for surface in ("Straight", "Smooth"):
        curved = simple.CurveMesh(Input=simple.Triangulate(Input=cylinder), Order=4, Surface=surface)
        skin = simple.ExtractSurface(Input=curved)
        skin.NonlinearSubdivisionLevel = 4
        view = new_view(OBLIQUE)
        draw(skin, view, light=LIT, edges=False)
        lines = simple.Show(simple.ExtractEdges(Input=curved), view)
        lines.AmbientColor = lines.DiffuseColor = DARK
        lines.ColorArrayName = [None, ""]
        lines.RenderLinesAsTubes, lines.LineWidth = 1, 2
        views.append(fit(view, 1.15))
    return side_by_side(*views)


def metric_tensor():
    """A front across a rectangle, and the sizes that it needs."""
    mesh = simple.MeshDomain(Domain="Rectangle, Structured", NumberOfCells=3200)
    front = simple.Calculator(Input=mesh, Function="tanh(8*(coordsX-0.5*coordsY-0.3))", ResultArrayName="front")
    metric = simple.MetricTensor(
        Input=front, Source="Hessian", Field=["POINTS", "front"], TargetValue=1500, LargestSize=0.12,
        MaximumEllipsoids=250, EllipsoidScale=0.4,
    )  # fmt: skip
    left, right = new_view(), new_view()
    draw(front, left, "front", POINTS, edges=False)
    field_of(front, "front")
    draw(output(metric, 1), right, "Size", POINTS, edges=False)
    field_of(output(metric, 1), "Size")
    return side_by_side(fit(left, 1.3), fit(right, 1.3))


def transfer():
    """A field with a jump on a fine mesh, and on a coarse one of quadrilaterals."""
    mesh = simple.MeshDomain(Domain="Rectangle, Structured", NumberOfCells=3200)
    jump = simple.Calculator(
        Input=mesh, ResultArrayName="density",
        Function="if((coordsX-0.7)^2+(coordsY-0.5)^2<0.1,1,0.2)+0.2*sin(6*coordsX)",
    )  # fmt: skip
    coarse = simple.Plane(Origin=[0, 0, 0], Point1=[2, 0, 0], Point2=[0, 1, 0], XResolution=30, YResolution=15)
    moved = simple.Transfer(Input=coarse, Source=jump, PointArrays=["density"])
    left, right = new_view(), new_view()
    draw(jump, left, "density", POINTS)
    draw(output(moved, 0), right, "density", POINTS)
    field_of(jump, "density")
    return side_by_side(fit(left, 1.3), fit(right, 1.3))


def compare_meshes():
    plate = sample("plate.vtu")
    changes = simple.CompareMeshes(Input=plate, Other=simple.OptimizeMesh(Input=plate))
    view = new_view()
    draw(output(changes, 0), view, "Change")
    return side_by_side(fit(view, 1.3), size=(WIDE // 2, HEIGHT))


def field_of_metric():
    field = simple.MetricField(Metrics=["Inverse mean ratio"], Bounds=[-1, 2, 0.02, 2, 0, 0], Dimensions=[301, 199, 1])
    lines = simple.Contour(Input=field, ContourBy=["POINTS", "imr"], Isosurfaces=[1.05, 1.2, 1.5, 2, 3, 5, 8])
    base = simple.Line(Point1=[0, 0, 0], Point2=[1, 0, 0])
    view = new_view()
    draw(field, view, "imr", POINTS, edges=False)
    for source, width in ((lines, 1), (base, 4)):
        display = draw(source, view, edges=False, color=[0, 0, 0])
        display.LineWidth, display.Position = width, [0, 0, 0.01]
    return side_by_side(fit(view, 1.3), size=(420, HEIGHT))


def mesh_domain():
    names = ("Wrench", "Hinge", "Barrier (2D)", "Cylinder in a Channel", "Moving Gate", "Bore (3D)")
    views = []
    for name in names:
        solid = "3D" in name
        view = new_view(OBLIQUE if solid else None)
        domain = simple.MeshDomain(Domain=name, NumberOfCells=3000 if solid else 700)
        draw(output(domain, 0), view, light=LIT if solid else FLAT)
        views.append(fit(view, 1) if solid else fit_plane(view, domain, 4 / 3))
    size = (600, 150)
    return side_by_side(*views[:3], size=size), side_by_side(*views[3:], size=size)


def small_edge(outline) -> float:
    """A tenth of the outline's width."""
    outline.UpdatePipeline()
    low, high = outline.GetDataInformation().GetBounds()[:2]
    return (high - low) / 10


def triangle_mesher():
    outline = sample("plate.poly")
    mesh = simple.TriangleMesher(Input=outline, MinimumAngle=25, Size=small_edge(outline))
    left, right = new_view(), new_view()
    draw(outline, left, edges=False, color=[0, 0, 0]).LineWidth = 2
    draw(output(mesh, 0), right)
    return side_by_side(fit(left, 1.3), fit(right, 1.3))


def tetgen_mesher():
    mesh = simple.TetGenMesher(Input=sample("cube.smesh"), Volume=0.002)
    cut = simple.Clip(Input=output(mesh, 0), ClipType="Plane", Crinkleclip=1)
    cut.ClipType.Origin, cut.ClipType.Normal = [0.5, 0.5, 0.5], [-0.4, -1, 0.3]
    cut.Invert = 0
    view = new_view(([0.9, -2, 1.0], [0, 0, 1]))
    cut.ClipType.Normal = [0, 1, 0]
    draw(cut, view, light=LIT)
    return side_by_side(fit(view, 1.3), size=(360, HEIGHT))


def solve_pde():
    solved = simple.SolvePDE(Input=sample("plate.vtu"))
    view = new_view()
    draw(output(solved, 0), view, "Solution", POINTS, edges=False)
    field_of(output(solved, 0), "Solution")
    return side_by_side(fit(view, 1.3), size=(360, HEIGHT))


def condition_estimator():
    condition = simple.ConditionEstimator(Input=sample("bracket.vtu"))
    bad = chosen(output(condition, 0), "Excess", "Above Upper Threshold", high=1)
    view = new_view(OBLIQUE)
    draw_around(output(condition, 0), view)
    draw(bad, view, "Excess", light=LIT)
    return side_by_side(fit(view, 1.2), size=(420, HEIGHT))


def solver_study():
    study = simple.SolverStudy(Input=sample("bracket.vtu"))
    study.UpdatePipeline()
    view = simple.CreateView("XYBarChartView")
    display = simple.Show(output(study, 1), view)
    display.SeriesVisibility = ["Total time (s)"]
    display.SeriesColor = ["Total time (s)", "0.35", "0.55", "0.35"]
    display.UseIndexForXAxis, display.XArrayName = 0, "N combination"
    view.LeftAxisTitle, view.BottomAxisTitle, view.ShowLegend = "Total time (s)", "Combination", 0
    return side_by_side(view, size=(WIDE // 2, HEIGHT))


def peridynamic_condition():
    square = simple.MeshDomain(Domain="Square with Interaction Layer, Structured", ElementSize=0.05)
    condition = simple.PeridynamicCondition(Input=output(square, 0), Solve=1)
    left, right = new_view(), new_view()
    draw(output(square, 0), left, "Reference")
    field("Reference", 0.5, 3, ((1, 1, 1), (0, 0, 0)))
    condition.UpdatePipeline()
    draw(output(condition, 0), right, "Solution", POINTS, edges=False)
    field_of(output(condition, 0), "Solution")
    return side_by_side(fit(left, 1.3), fit(right, 1.3))


def interaction_layer():
    outline = sample("plate.poly")
    edge = small_edge(outline)
    mesh = simple.TriangleMesher(Input=outline, MinimumAngle=25, Size=edge)
    layer = simple.InteractionLayer(Input=output(mesh, 0), Width=1.5 * edge)
    view = new_view()
    draw(layer, view, "Reference")
    field("Reference", 0.5, 3, ((1, 1, 1), (0, 0, 0)))
    return side_by_side(fit(view, 1.3), size=(420, HEIGHT))


def horizon_neighbors():
    square = simple.MeshDomain(Domain="Rectangle, Structured", NumberOfCells=400)
    near = simple.HorizonNeighbors(Input=output(square, 0), Center=[1.03, 0.52, 0], Horizon=0.2)
    view = new_view()
    draw(output(square, 0), view, color=[1, 1, 1])
    draw(output(near, 0), view, "Case").Position = [0, 0, 0.01]
    circle = draw(output(near, 1), view, edges=False, color=[0, 0, 0])
    circle.LineWidth, circle.Position = 3, [0, 0, 0.02]
    return side_by_side(fit(view, 2.2), size=(420, HEIGHT))


def show_image(reader, view):
    display = simple.Show(reader, view)
    display.Representation = "Slice"
    display.MapScalars = 0
    return display


def silhouette_to_mesh():
    fish = sample("fish.png")
    mesh = simple.SilhouettetoMesh(Input=fish, Spacing=12)
    left, right = new_view(), new_view()
    show_image(fish, left)
    draw(output(mesh, 0), right)
    return side_by_side(fit(left, 1.3), fit(right, 1.3))


def match_shape():
    fish, bent = sample("fish.png"), sample("fish-bent.png")
    mesh = simple.SilhouettetoMesh(Input=fish, Spacing=12)
    found = simple.MatchShape(Input=output(mesh, 0), Target=bent, Locations="Points on the outline")
    left, right = new_view(), new_view()
    for image, triangles, array, view in ((fish, mesh, None, left), (bent, found, "Deformation", right)):
        show_image(image, view).Position = [0, 0, -1]
        draw(output(triangles, 0), view, array, opacity=0.8)
        fit(view, 1.3)
    return side_by_side(left, right)


def shape_retrieval():
    """Above each silhouette, below its best match."""
    images = simple.SilhouetteSetReader(FileName=str(DATA / "silhouettes.csv"))
    ranking = simple.ShapeRetrieval(Input=images, BestMatches=1)
    table = servermanager.Fetch(ranking, idx=1)
    names = [[table.GetColumnByName(key).GetValue(row) for row in range(table.GetNumberOfRows())]
             for key in ("Query", "Match")]
    return tuple(side_by_side(*map(picture_of, row), size=(WIDE, HEIGHT // 2)) for row in names)


def picture_of(name):
    view = new_view()
    show_image(sample(f"{name}.png"), view)
    return fit(view, 1.3)


def silhouette_list():
    lines = (DATA / "silhouettes.csv").read_text().splitlines()[1:]
    return side_by_side(*(picture_of(line.split(",")[0].removesuffix(".png")) for line in lines), size=(WIDE, 180))


def gmsh_files():
    view = new_view(OBLIQUE)
    part = sample("part.msh")
    part.UpdatePipeline()
    draw(part, view, "Reference", light=LIT)
    regions("Reference", numbers_in(part, "Reference"))
    return side_by_side(fit(view, 1.3), size=(360, HEIGHT))


def abaqus_files():
    view = new_view(OBLIQUE)
    draw(sample("beam.inp"), view, "LOADED", light=LIT)
    regions("LOADED", (0, 1))
    return side_by_side(fit(view, 1.3), size=(360, HEIGHT))


def nastran_files():
    view = new_view()
    ring = sample("ring.bdf")
    ring.UpdatePipeline()
    draw(ring, view, "Reference")
    regions("Reference", numbers_in(ring, "Reference"))
    return side_by_side(fit(view, 1.1), size=(360, HEIGHT))


def medit_files():
    view = new_view(OBLIQUE)
    draw(simple.Shrink(Input=sample("zoo.mesh"), ShrinkFactor=0.9), view, light=LIT)
    return side_by_side(fit(view, 1.3), size=(420, HEIGHT))


def mfem_files():
    view = new_view(OBLIQUE)
    pipe = sample("pipe.mesh")
    pipe.UpdatePipeline()
    display = draw(pipe, view, "Reference", light=LIT)
    display.NonlinearSubdivisionLevel = 3
    regions("Reference", numbers_in(pipe, "Reference"))
    return side_by_side(fit(view, 1.3), size=(360, HEIGHT))


def off_files():
    view = new_view(OBLIQUE)
    display = draw(sample("house.off"), view, "Color")
    display.MapScalars = 0
    return side_by_side(fit(view, 1.3), size=(360, HEIGHT))


def bend(file: Path) -> None:
    """Writes a quarter of a ring as a mesh of Fluent, with an inlet, an outlet and walls."""
    along, across = 24, 8
    nodes = [(i, j) for j in range(across + 1) for i in range(along + 1)]
    number = {node: k + 1 for k, node in enumerate(nodes)}
    cell = {(i, j): 1 + i + along * j for i in range(along) for j in range(across)}
    zones = {"interior": [], "velocity-inlet": [], "pressure-outlet": [], "wall": []}
    for i, j in nodes:
        for end, left, right, name in (
            ((i, j + 1), (i - 1, j), (i, j), "pressure-outlet" if i else "velocity-inlet"),
            ((i + 1, j), (i, j), (i, j - 1), "wall"),
        ):
            if end in number:
                sides = cell.get(left, 0), cell.get(right, 0)
                row = " ".join(f"{value:x}" for value in (number[i, j], number[end], *sides))
                zones["interior" if all(sides) else name].append(row)
    radius = [(1 + j / across, math.pi / 2 * (1 - i / along)) for i, j in nodes]
    points = "\n".join(f"{r * math.cos(angle):.9f} {r * math.sin(angle):.9f}" for r, angle in radius)
    count = f"{len(nodes):x}"
    text = f"(2 2)\n(10 (0 1 {count} 0 2))\n(12 (0 1 {len(cell):x} 0))\n(10 (1 1 {count} 1 2)(\n{points}))\n"
    first = 1
    for zone, (name, rows) in enumerate(zones.items(), 3):
        head = f"{zone:x} {first:x} {first + len(rows) - 1:x} {2 if name == 'interior' else 3} 2"
        text += f"(13 ({head})(\n" + "\n".join(rows) + f"))\n(45 ({zone} {name} {name})())\n"
        first += len(rows)
    file.write_text(text)


def fluent_files():
    view = new_view()
    with tempfile.TemporaryDirectory() as folder:
        bend(Path(folder) / "bend.msh")
        mesh = simple.OpenDataFile(str(Path(folder) / "bend.msh"))
        mesh.UpdatePipeline()
    draw(mesh, view, "Patch").LineWidth = 2
    regions("Patch", (-1, 0, 1, 2))
    return side_by_side(fit(view, 1.1), size=(360, HEIGHT))


def openfoam_files():
    view = new_view(OBLIQUE)
    case = simple.OpenFOAMMeshReader(FileName=str(DATA / "elbow" / "elbow.foam"))
    patches = simple.Threshold(Input=case, Scalars=["CELLS", "Patch"], LowerThreshold=0, UpperThreshold=2)
    patches.UpdatePipeline()
    draw(patches, view, "Patch", light=LIT).SetRepresentationType("Surface With Edges")
    regions("Patch", numbers_in(patches, "Patch"))
    return side_by_side(fit(view, 1.3), size=(360, HEIGHT))


def tetgen_files():
    view = new_view(OBLIQUE)
    draw(simple.Shrink(Input=sample("cube.1.node"), ShrinkFactor=0.8), view, light=LIT)
    return side_by_side(fit(view, 1.3), size=(360, HEIGHT))


PICTURES = (
    before_after, element_quality, optimize_mesh, improve_mesh, improve_mesh_plane, improve_mesh_adapt,
    refine_solution_1, refine_solution_2, untangle_mesh, warp_mesh, perturb_mesh,
    curve_mesh, metric_tensor, transfer, compare_meshes, field_of_metric, mesh_domain, triangle_mesher, tetgen_mesher,
    solve_pde, condition_estimator, solver_study, peridynamic_condition, interaction_layer, horizon_neighbors,
    silhouette_to_mesh, match_shape, shape_retrieval, silhouette_list, abaqus_files, nastran_files, fluent_files,
    gmsh_files, medit_files, mfem_files, off_files, openfoam_files, tetgen_files, nonpositive_jacobian_1,
    nonpositive_jacobian_2, nonpositive_jacobian_3,
)  # fmt: skip


def save(pictures, path: Path) -> None:
    """Saves one layout, or several one below the other."""
    import numpy

    rows = pictures if isinstance(pictures[0], tuple) else (pictures,)
    with tempfile.TemporaryDirectory() as folder:
        images = []
        for layout, size in rows:
            name = Path(folder) / "picture.png"
            simple.SaveScreenshot(str(name), layout, ImageResolution=list(size), SeparatorWidth=GAP,
                                  SeparatorColor=[1, 1, 1], FontScaling="Do not scale fonts")  # fmt: skip
            images.append(read(name))
    (write_smooth if path.stem in SMOOTH else write)(numpy.concatenate(images), path)
    print(path.name, path.stat().st_size)


def main(plugin: str, names: list) -> None:
    simple.LoadPlugin(plugin, ns=vars(simple))
    for picture in PICTURES:
        if not names or picture.__name__ in names:
            save(picture(), HERE / f"{picture.__name__}.png")
            simple.ResetSession()


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
