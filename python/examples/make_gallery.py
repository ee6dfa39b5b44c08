# SPDX-License-Identifier: BSD-3-Clause
"""make_gallery.py DATA [NAME...]: runs the examples and makes their pictures, and the table of their time and memory.

Each example writes before.vtu and after.vtu (or .vti), which the picture pictures/NAME.png shows side by side, coloured
by the array that the line "Picture:" of its docstring names; "edges" has no colours, "clip" shows the half behind the
middle, "inside" the elements that fail (invalid, or beyond the range of the colours) inside a translucent surface, and
"alone" does not show the mesh before.
measured.json has the CPU seconds and the memory, MiB, of the process. Needs a display; Testing/headless.sh gives one.
"""

import json
import re
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

import tautline as tl
from PIL import Image
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkCommonDataModel import vtkPlane
from vtkmodules.vtkFiltersCore import vtkExtractCells
from vtkmodules.vtkFiltersExtraction import vtkExtractGeometry
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow
from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401, which makes the classes above work

HERE = Path(__file__).resolve().parent
SIZE = (560, 240)  # of a picture, pixels
COLOURS = 48  # of its palette, for small files
MOST_BYTES = 40_000
#: Runs a script and prints the most memory that the process had.
MEASURE = """
import os, runpy, sys
sys.argv = sys.argv[1:]
sys.path.insert(0, os.path.dirname(sys.argv[0]))
runpy.run_path(sys.argv[0])
print(next(line for line in open("/proc/self/status") if line.startswith("VmHWM")))
"""
VALID, NOT_MEASURED = 1, -2  # of the array Validity
TRANSLUCENT = 0.12  # opacity of the surface around the elements inside
HUES = (0.62, 0.0)  # blue is good, red is bad
UPWARD = ("Validity", "Change")  # arrays whose large values are good


def measured(mesh, array: str):
    """The mesh with the array, which is a metric's if the mesh does not have it; other arrays are of one mesh only."""
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


def failing(mesh, array: str, most: float):
    """The surfaces of the elements that are not valid or whose value is beyond `most`."""
    validity = vtk_to_numpy(tl.quality(mesh, "imr").mesh.GetCellData().GetArray("Validity"))
    bad = (validity < VALID) & (validity != NOT_MEASURED)
    if array != "Validity":
        bad |= vtk_to_numpy(array_of(mesh, array)) > most
    cells = vtkExtractCells()
    cells.SetInputData(mesh)
    for cell in bad.nonzero()[0].tolist():
        cells.AddCellRange(cell, cell)
    cells.Update()
    return cells.GetOutput()


def draw(window, mesh, array: str, how: list[str], span, place) -> None:
    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.SetViewport(*place)
    if "inside" in how:
        inside = failing(mesh, array, span[1])
        if inside.GetNumberOfCells():
            renderer.AddActor(actor_of(inside, surface(inside, False), array, span))
        whole = actor_of(mesh, surface(mesh, False), "edges", None)
        whole.GetProperty().SetOpacity(TRANSLUCENT)
        whole.GetProperty().EdgeVisibilityOff()
        renderer.AddActor(whole)
    else:
        renderer.AddActor(actor_of(mesh, surface(mesh, "clip" in how), array, span))
    bounds = mesh.GetBounds()
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    if bounds[5] > bounds[4]:
        camera.SetPosition(0.7, -1, 0.7)
        camera.SetViewUp(0, 0, 1)
    renderer.ResetCamera()
    camera.Zoom(1.15)
    window.AddRenderer(renderer)


def actor_of(mesh, shown, array: str, span) -> vtkActor:
    """The surface of (a part of) a mesh, with its colours and edges."""
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(shown)
    if span and array_of(mesh, array):
        table = vtkLookupTable()
        table.SetHueRange(*(HUES[::-1] if array in UPWARD else HUES))
        table.SetVectorModeToMagnitude()
        table.SetSaturationRange(0.55, 0.75)
        table.Build()
        mapper.SetLookupTable(table)
        mapper.SetScalarRange(*span)
        if shown.GetPointData().GetArray(array):
            mapper.SetScalarModeToUsePointFieldData()
        else:
            mapper.SetScalarModeToUseCellFieldData()
        mapper.SelectColorArray(array)
    else:
        mapper.ScalarVisibilityOff()
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(0.82, 0.86, 0.92)
    if not mesh.IsA("vtkImageData"):
        actor.GetProperty().EdgeVisibilityOn()
    actor.GetProperty().SetEdgeColor(0.2, 0.2, 0.25)
    actor.GetProperty().SetLineWidth(0.6)
    actor.GetProperty().SetAmbient(0.3)
    return actor


def make_picture(folder: Path, what: str, file: Path) -> None:
    array, _, how = what.partition(" ")
    how = how.split()
    names = ("after.vtu", "after.vti") if "alone" in how else ("before.vtu", "after.vtu", "after.vti")
    files = [folder / name for name in names]
    meshes = [measured(tl.read(name), array) for name in files if name.exists()]
    arrays = [array_of(mesh, array) for mesh in meshes]
    ranges = [values.GetRange(-1 if values.GetNumberOfComponents() > 1 else 0) for values in arrays if values]
    span = (min(r[0] for r in ranges), max(r[1] for r in ranges)) if ranges else None
    if span and array == "imr":
        span = (1, 3)  # of the inverse mean ratio, where most solvers begin to suffer
    window = vtkRenderWindow()
    window.OffScreenRenderingOn()
    window.SetMultiSamples(0)
    window.SetSize(*SIZE)
    for i, mesh in enumerate(meshes):
        draw(window, mesh, array, how, span, (i / len(meshes), 0, (i + 1) / len(meshes), 1))
    window.Render()
    image = vtkWindowToImageFilter()
    image.SetInput(window)
    writer = vtkPNGWriter()
    writer.SetInputConnection(image.GetOutputPort())
    writer.SetFileName(str(file))
    writer.Write()
    for colours in (COLOURS, COLOURS // 3):
        small = Image.open(file).convert("RGB").quantize(colours)
        small.save(file, optimize=True)
        if file.stat().st_size <= MOST_BYTES:
            return
    raise SystemExit(f"{file} has {file.stat().st_size} bytes, {MOST_BYTES} are allowed")


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
