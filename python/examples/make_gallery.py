# SPDX-License-Identifier: BSD-3-Clause
"""make_gallery.py DATA [NAME...]: runs the examples and makes their pictures, and the table of their time and memory.

Each example writes before.vtu and after.vtu (or .vti), which the picture pictures/NAME.png shows side by side, colored
by the array that the line "Picture:" of its docstring names; "edges" has no colors, "clip" shows the half behind the
middle, "inside" the elements that fail (invalid, or beyond the range of the colors) inside a translucent surface, both
before and after, "near" a close-up of the element with the largest value, "table" the iterations of study.csv beside
the mesh, and "alone" does not show the mesh before. The colors are the plugin's: pale is good, dark red is
bad, blue is inverted and nothing else; other fields go from pale to dark green.
measured.json has the CPU seconds and the memory, MiB, of the process. Needs a display; Testing/headless.sh gives one.
"""

import csv
import json
import re
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

import tautline as tl
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable, vtkVariant
from vtkmodules.vtkCommonDataModel import vtkPlane
from vtkmodules.vtkFiltersCore import vtkExtractCells
from vtkmodules.vtkFiltersExtraction import vtkExtractGeometry
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import vtkActor, vtkColorTransferFunction, vtkPolyDataMapper, vtkRenderer
from vtkmodules.vtkRenderingCore import vtkRenderWindow, vtkTextActor, vtkWindowToImageFilter
import vtkmodules.vtkRenderingFreeType  # noqa: F401, which makes the texts work
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401, which makes the classes above work

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "Plugin" / "Documentation"))

from small_png import read, write_smooth  # noqa: E402

SIZE = (560, 280)  # of a picture, pixels
LEGEND = 40 / 280  # the part of the height below the meshes
COLORS = (64, 32, 16)  # of its palette, for small files
MOST_BYTES = 40_000
CLOSE_UP = 3  # the zoom on one element
THICK = 5  # edges of this element, pixels
TABLE = "study.csv"
#: Runs a script and prints the peak memory of the process.
MEASURE = """
import os, runpy, sys
sys.argv = sys.argv[1:]
sys.path.insert(0, os.path.dirname(sys.argv[0]))
runpy.run_path(sys.argv[0])
print(next(line for line in open("/proc/self/status") if line.startswith("VmHWM")))
"""
VALID, NOT_MEASURED = 1, -2  # of the array Validity
TRANSLUCENT = 0.12  # opacity of the surface around the elements inside
DARK = 1.3  # the sum of red, green and blue, below which text on a color is white
MESH = (0.84, 0.84, 0.82)  # without colors
#: For fields that are no measure of quality, from low to high.
FIELD = ((0.0, 0.90, 0.93, 0.76), (0.5, 0.52, 0.73, 0.42), (1.0, 0.05, 0.30, 0.15))
REGIONS = ((0.90, 0.86, 0.72), (0.55, 0.72, 0.55), (0.62, 0.45, 0.62), (0.80, 0.60, 0.35))
OWN_METRICS = {"edge_span": "QualityIndex"}  # of examples: with the map of an array of the plugin


def measured(mesh, array: str):
    """The mesh with the array, which is a metric if the mesh lacks it; other arrays are of one mesh only."""
    names = [data.GetArrayName(i) for data in (mesh.GetPointData(), mesh.GetCellData())
             for i in range(data.GetNumberOfArrays())]  # fmt: skip
    if array in names or array == "edges":
        return mesh
    metrics = [metric["name"] for metric in tl.metrics()]
    return tl.quality(mesh, array if array in metrics else "imr").mesh


def array_of(mesh, name: str):
    return mesh.GetPointData().GetArray(name) or mesh.GetCellData().GetArray(name)


def surface(mesh, clip: bool):
    if clip:
        low, high = mesh.GetBounds()[2:4]
        plane = vtkPlane()
        plane.SetOrigin(0, (low + high) / 2, 0)
        plane.SetNormal(0, 1, 0)
        half = vtkExtractGeometry()
        half.SetInputData(mesh)
        half.SetImplicitFunction(plane)
        half.ExtractInsideOff()
        half.ExtractBoundaryCellsOn()
        half.Update()
        mesh = half.GetOutput()
    outside = vtkGeometryFilter()
    outside.SetInputData(mesh)
    outside.Update()
    return outside.GetOutput()


def failing(mesh, array: str, most: float) -> list:
    """The elements that are not valid or whose value is beyond `most`."""
    validity = vtk_to_numpy(tl.quality(mesh, "imr").mesh.GetCellData().GetArray("Validity"))
    bad = (validity < VALID) & (validity != NOT_MEASURED)
    if array != "Validity":
        bad |= vtk_to_numpy(array_of(mesh, array)) > most
    return bad.nonzero()[0].tolist()


def extracted(mesh, chosen: list):
    cells = vtkExtractCells()
    cells.SetInputData(mesh)
    for cell in chosen:
        cells.AddCellRange(cell, cell)
    cells.Update()
    return cells.GetOutput()


def settings() -> dict:
    """The color maps of the plugin, by the names of arrays without blanks."""
    return json.loads(tl.vtkElementQuality.GetColorMapSettings())["array_lookup_tables"]


def transfer(points: list, low: float, high: float, table: dict) -> vtkColorTransferFunction:
    """A map through points (value from 0 to 1, red, green, blue) between two values, with the colors beyond them."""
    colors = vtkColorTransferFunction()
    colors.SetColorSpaceToLab()
    for place, *rgb in points:
        colors.AddRGBPoint(low + place * (high - low), *rgb)
    for side in ("Below", "Above"):
        if table.get(f"Use{side}RangeColor"):
            getattr(colors, f"Set{side}RangeColor")(table[f"{side}RangeColor"])
            getattr(colors, f"Use{side}RangeColorOn")()
    return colors


def categories(values: list, names: list, colors: list) -> vtkLookupTable:
    """A color for each value, with its name."""
    table = vtkLookupTable()
    table.IndexedLookupOn()
    table.SetNumberOfTableValues(len(values))
    for i, (value, name, color) in enumerate(zip(values, names, colors)):
        table.SetAnnotation(vtkVariant(value), name)
        table.SetTableValue(i, *color, 1)
    return table


def colors_of(array: str, span: tuple, meshes: list):
    """The map of an array with this range, and its title."""
    known = OWN_METRICS.get(array, array)
    entry = settings().get("".join(c for c in known if c.isalnum() or c == "_"), {})
    labels = {metric["name"]: metric["label"] for metric in tl.metrics()}
    table = entry.get("PVLookupTable", {})
    title = labels.get(array, entry.get("Title", array) if known == array else array)
    if table.get("IndexedLookup"):
        found = {value for mesh in meshes for value in vtk_to_numpy(array_of(mesh, array)).tolist()}
        values, names, flat = table["Annotations"][::2], table["Annotations"][1::2], table["IndexedColors"]
        colors = [flat[3 * i : 3 * i + 3] for i in range(len(values))]
        kept = [row for row in zip(values, names, colors) if int(row[0]) in found]
        return categories([int(value) for value, _, _ in kept], *map(list, zip(*((b, c) for _, b, c in kept)))), title
    if array == "Reference":
        found = sorted({value for mesh in meshes for value in vtk_to_numpy(array_of(mesh, array)).tolist()})
        colors = [REGIONS[i % len(REGIONS)] for i in range(len(found))]
        return categories(found, [str(value) for value in found], colors), title
    if table:
        flat = table["RGBPoints"]
        points = [flat[i : i + 4] for i in range(0, len(flat), 4)]
        if table.get("AutomaticRescaleRangeMode") == "Never":
            return transfer(points, 0, 1, table), title
        return transfer(points, *span, table), title
    return transfer(FIELD, *span, {}), title


def worst(mesh, array: str) -> int:
    """The element with the largest value."""
    return int(vtk_to_numpy(array_of(mesh, array)).argmax())


def center_of(mesh, cell: int) -> tuple:
    box = mesh.GetCell(cell).GetBounds()
    return tuple((box[2 * k] + box[2 * k + 1]) / 2 for k in range(3))


def outline(mesh, cell: int, array: str, colors) -> vtkActor:
    """An element with thick edges in its color: a flat one has no visible area."""
    part = extracted(mesh, [cell])
    actor = actor_of(part, surface(part, False), array, colors)
    actor.GetProperty().EdgeVisibilityOff()
    actor.GetProperty().SetRepresentationToWireframe()
    actor.GetProperty().SetLineWidth(THICK)
    return actor


def draw(window, mesh, array: str, how: list[str], colors, inside, place, focus=None) -> None:
    """One mesh; `inside` has the elements to show in a translucent surface, or is None; `focus` is the center of a
    close-up."""
    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.SetViewport(*place)
    if inside is not None:
        part = extracted(mesh, inside)
        renderer.AddActor(actor_of(part, surface(part, False), array, colors))
        whole = actor_of(mesh, surface(mesh, False), array, None)
        whole.GetProperty().SetOpacity(TRANSLUCENT)
        whole.GetProperty().SetColor(0.4, 0.4, 0.4)
        whole.GetProperty().EdgeVisibilityOff()
        renderer.AddActor(whole)
    else:
        renderer.AddActor(actor_of(mesh, surface(mesh, "clip" in how), array, colors))
        if focus:
            renderer.AddActor(outline(mesh, worst(mesh, array), array, colors))
    bounds = mesh.GetBounds()
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    if bounds[5] > bounds[4]:
        camera.SetPosition(0.7, -1, 0.7)
        camera.SetViewUp(0, 0, 1)
    renderer.ResetCamera()
    camera.Zoom(1.15)
    if focus:
        shift = [to - now for to, now in zip(focus, camera.GetFocalPoint())]
        camera.SetPosition(*(at + by for at, by in zip(camera.GetPosition(), shift)))
        camera.SetFocalPoint(*focus)
        camera.Zoom(CLOSE_UP)
    window.AddRenderer(renderer)


def actor_of(mesh, shown, array: str, colors) -> vtkActor:
    """The surface of (a part of) a mesh, with its colors and edges."""
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(shown)
    if colors and array_of(mesh, array):
        values = array_of(mesh, array)
        if values.GetNumberOfComponents() > 1:
            colors.SetVectorModeToMagnitude()
        mapper.SetLookupTable(colors)
        mapper.UseLookupTableScalarRangeOn()
        if shown.GetPointData().GetArray(array):
            mapper.SetScalarModeToUsePointFieldData()
        else:
            mapper.SetScalarModeToUseCellFieldData()
        mapper.SelectColorArray(array)
    else:
        mapper.ScalarVisibilityOff()
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(*MESH)
    if not mesh.IsA("vtkImageData"):
        actor.GetProperty().EdgeVisibilityOn()
    actor.GetProperty().SetEdgeColor(0.25, 0.25, 0.25)
    actor.GetProperty().SetLineWidth(0.6)
    actor.GetProperty().SetAmbient(0.3)
    return actor


def text_at(renderer, text: str, x: float, y: float, centred: bool, background=None) -> None:
    actor = vtkTextActor()
    if background:
        actor.GetTextProperty().SetBackgroundColor(background)
        actor.GetTextProperty().SetBackgroundOpacity(1)
    actor.SetInput(text)
    actor.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    actor.SetPosition(x, y)
    actor.GetTextProperty().SetColor([float(bool(background) and sum(background) < DARK)] * 3)
    actor.GetTextProperty().SetFontSize(14)
    actor.GetTextProperty().SetVerticalJustificationToCentered()
    if centred:
        actor.GetTextProperty().SetJustificationToCentered()
    renderer.AddActor(actor)


def add_legend(window, colors, title: str, names: list[str]) -> None:
    """Below the meshes: before, after, and a bar with the colors."""
    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.SetViewport(0, 0, 1, LEGEND)
    window.AddRenderer(renderer)
    for i, name in enumerate(names):
        text_at(renderer, name, (i + 0.5) / len(names), 0.85, True)
    if not colors:
        return
    text_at(renderer, title, 0.02, 0.3, False)
    if colors.GetIndexedLookup():
        count = colors.GetNumberOfTableValues()
        for i in range(count):
            place = 0.45 + 0.5 * (i + 0.5) / count
            text_at(renderer, f"  {colors.GetAnnotation(i)}  ", place, 0.3, True, colors.GetTableValue(i)[:3])
        return
    bar = vtkScalarBarActor()
    bar.SetLookupTable(colors)
    bar.SetOrientationToHorizontal()
    bar.SetNumberOfLabels(3)
    bar.SetLabelFormat("%.3g")
    bar.UnconstrainedFontSizeOn()
    for style in (bar.GetLabelTextProperty(), bar.GetAnnotationTextProperty()):
        style.SetColor(0, 0, 0)
        style.SetFontSize(12)
        style.SetBold(False)
        style.SetItalic(False)
        style.SetShadow(False)
    bar.SetPosition(0.5, 0.0)
    bar.SetPosition2(0.46, 0.62)
    renderer.AddActor(bar)


def add_table(window, file: Path) -> None:
    """The iterations of a solver study, in the right half."""
    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.SetViewport(0.5, LEGEND, 1, 1)
    window.AddRenderer(renderer)
    with file.open(encoding="utf-8", newline="") as lines:
        rows = list(csv.DictReader(lines))
    for i, (name, number) in enumerate([("", "iterations"), *((row["name"], row["iterations"]) for row in rows)]):
        height = 0.8 - 0.6 * i / len(rows)
        text_at(renderer, name, 0.05, height, False)
        text_at(renderer, number, 0.72, height, False)


def make_picture(folder: Path, what: str, file: Path) -> None:
    array, _, how = what.partition(" ")
    how = how.split()
    names = ("after.vtu", "after.vti") if "alone" in how else ("before.vtu", "after.vtu", "after.vti")
    files = [folder / name for name in names]
    meshes = [measured(tl.read(name), array) for name in files if name.exists()]
    arrays = [array_of(mesh, array) for mesh in meshes]
    ranges = [values.GetRange(-1 if values.GetNumberOfComponents() > 1 else 0) for values in arrays if values]
    span = (min(r[0] for r in ranges), max(r[1] for r in ranges)) if ranges else None
    colors, title = colors_of(array, span, [m for m in meshes if array_of(m, array)]) if span else (None, "")
    shown = [None] * len(meshes)
    if "inside" in how:  # after, the same elements: a mesh whose defects are gone is not an empty surface
        shown = [failing(meshes[0], array, colors.GetRange()[1])] * len(meshes)
        assert len({mesh.GetNumberOfCells() for mesh in meshes}) == 1, what
    focus = center_of(meshes[0], worst(meshes[0], array)) if "near" in how else None
    panels = len(meshes) + ("table" in how)
    window = vtkRenderWindow()
    window.OffScreenRenderingOn()
    window.SetMultiSamples(0)
    window.SetSize(*SIZE)
    for i, mesh in enumerate(meshes):
        place = (i / panels, LEGEND, (i + 1) / panels, 1)
        draw(window, mesh, array, how, colors, shown[i], place, focus)
    if "table" in how:
        add_table(window, folder / TABLE)
    add_legend(window, colors, title, ["before", "after"] if len(meshes) > 1 else [])
    window.Render()
    image = vtkWindowToImageFilter()
    image.SetInput(window)
    writer = vtkPNGWriter()
    writer.SetInputConnection(image.GetOutputPort())
    writer.SetFileName(str(file))
    writer.Write()
    write_smooth(read(file), file, COLORS, MOST_BYTES)


def main(data: Path, chosen: list[str]) -> None:
    table = HERE / "measured.json"
    facts = json.loads(table.read_text()) if table.exists() else {}
    (HERE / "pictures").mkdir(exist_ok=True)
    for script in sorted(HERE.glob("[0-9]*.py")):
        if chosen and script.stem not in chosen:
            continue
        with tempfile.TemporaryDirectory() as folder:
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            command = [sys.executable, "-c", MEASURE, str(script), str(data.resolve())]
            done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
            if done.returncode:
                raise SystemExit(f"{script.name}: {done.stderr}")
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
            memory = int(done.stdout.rsplit("VmHWM:", 1)[1].split()[0]) // 1024
            facts[script.stem] = {"seconds": round(seconds, 1), "memory": memory}
            what = re.search(r"^Picture: (.*)$", script.read_text(), re.MULTILINE)
            if what:
                make_picture(Path(folder), what[1], HERE / "pictures" / f"{script.stem}.png")
        print(script.stem, facts[script.stem], flush=True)
        table.write_text(json.dumps(dict(sorted(facts.items())), indent=1) + "\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:])
