# SPDX-License-Identifier: BSD-3-Clause
"""The progress of every filter, source and reader moves while it computes, and carries its name in the menu."""

import os
import sys
from pathlib import Path

import numpy as np
from paraview import servermanager, simple
from vtkmodules.vtkImagingSources import vtkImageEllipsoidSource
from vtkmodules.vtkIOImage import vtkPNGWriter

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "Plugin"))
import list_proxies  # noqa: E402

DATA = Path(os.environ["TAUTLINE_DATA_DIR"])
OUT = Path(os.environ["TAUTLINE_TEST_DIR"])
#: How many different values are between 0 and 1, at least, and how far they are apart, at most.
MOVES, JUMP = 3, 0.75
#: Part of the panel of Warp Mesh, not in a menu.
HIDDEN = {("filters", "MovingBoundary")}

before = list_proxies.proxies()
simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns={})
PROXIES = sorted(list_proxies.proxies() - before)


def read(name):
    return simple.OpenDataFile(str(DATA / name))


def grid(half):
    """A cube of 5 (2 half)^3 tetrahedra."""
    return simple.Tetrahedralize(Input=simple.Wavelet(WholeExtent=[-half, half] * 3))


def make(group, name, inputs, settings):
    """The proxy, whatever its label is."""
    proxy = servermanager.ProxyManager().NewProxy(group, name)
    made = servermanager._getPyProxy(proxy)
    for key, value in {**inputs, **settings}.items():
        made.SetPropertyWithName(key, value)
    return made


def square(**settings):
    domain = make("sources", "MeshDomain", {}, {"Domain": "Square with Interaction Layer, Structured"})
    for key, value in settings.items():
        domain.SetPropertyWithName(key, value)
    return domain


def rotation():
    transform = servermanager._getPyProxy(servermanager.ProxyManager().NewProxy("extended_sources", "Transform3"))
    transform.Rotate = [0, 0, 20]
    return transform


def disc():
    """A picture of 1500 x 1500 pixels."""
    size = 1500
    image = vtkImageEllipsoidSource()
    image.SetWholeExtent(0, size - 1, 0, size - 1, 0, 0)
    image.SetCenter(size / 2, size / 2, 0)
    image.SetRadius(size / 3, size / 3, 1)
    writer = vtkPNGWriter()
    writer.SetInputConnection(image.GetOutputPort())
    writer.SetFileName(str(OUT / "progress.png"))
    writer.Write()
    return simple.OpenDataFile(str(OUT / "progress.png"))


def written(extension, mesh):
    file = OUT / f"progress{extension}"
    simple.SaveData(str(file), mesh)
    return str(file)


def deck(extension, mesh, lines):
    """A file of cards: `lines` has a format of points and one of tetrahedra, and what stands before each."""
    data = servermanager.Fetch(mesh)
    points = [data.GetPoint(p) for p in range(data.GetNumberOfPoints())]
    cells = [[data.GetCell(c).GetPointId(i) + 1 for i in range(4)] for c in range(data.GetNumberOfCells())]
    before_points, point, before_cells, cell = lines
    text = [before_points, *(point.format(i, *x) for i, x in enumerate(points, 1))]
    text += [before_cells, *(cell.format(i, *nodes) for i, nodes in enumerate(cells, 1))]
    file = OUT / f"progress{extension}"
    file.write_text("\n".join(text) + "\n")
    return str(file)


ABAQUS = ("*NODE", "{}, {}, {}, {}", "*ELEMENT, TYPE=C3D4", "{}, {}, {}, {}, {}")
NASTRAN = ("BEGIN BULK", "GRID,{},,{},{},{}", "$", "CTETRA,{},1,{},{},{},{}")


def straight_mesh(mesh):
    """A file of MFEM."""
    data = servermanager.Fetch(mesh)
    cells = [data.GetCell(c) for c in range(data.GetNumberOfCells())]
    elements = ["1 4 " + " ".join(str(cell.GetPointId(i)) for i in range(4)) for cell in cells]
    points = [" ".join(map(str, data.GetPoint(p))) for p in range(data.GetNumberOfPoints())]
    text = ["MFEM mesh v1.0", "dimension", "3", "elements", str(len(elements)), *elements, "boundary", "0"]
    text += ["vertices", str(len(points)), "3", *points]
    file = OUT / "progress-mfem.mesh"
    file.write_text("\n".join(text) + "\n")
    return str(file)


def cubes(n):
    """The points of n^3 cubes, and their faces between two cells and on the boundary: the cells, then the points."""
    side = n + 1
    cell, point = np.indices((n, n, n)).reshape(3, -1).T, np.indices((side,) * 3).reshape(3, -1).T
    steps, cell_steps = np.array([side * side, side, 1]), np.array([n * n, n, 1])
    first, number = cell @ steps, cell @ cell_steps
    inner, outer = [], []
    for axis in range(3):
        a, b = steps[(axis + 1) % 3], steps[(axis + 2) % 3]
        low = np.stack([first, first + b, first + a + b, first + a], 1)
        high = np.stack([first, first + a, first + a + b, first + b], 1) + steps[axis]
        between = cell[:, axis] < n - 1
        inner += zip(number[between], number[between] + cell_steps[axis], high[between].tolist())
        outer += zip(number[cell[:, axis] == 0], low[cell[:, axis] == 0].tolist())
        outer += zip(number[~between], high[~between].tolist())
    return point, inner, outer


def fluent_file(n):
    """A mesh of Fluent of n^3 cubes."""
    point, inner, outer = cubes(n)
    text = ["(2 3)", f"(10 (0 1 {len(point):x} 0 3))", f"(12 (0 1 {n**3:x} 0))", f"(10 (1 1 {len(point):x} 1 3)("]
    text += [f"{x} {y} {z}" for x, y, z in point.tolist()] + ["))"]
    rows = [(*face[-1][::-1], *face[:-1]) for face in inner] + [(*face[-1][::-1], *face[:-1], -1) for face in outer]
    for zone, code, first, last in ((2, 2, 1, len(inner)), (3, 3, len(inner) + 1, len(rows))):
        text.append(f"(13 ({zone} {first:x} {last:x} {code} 4)(")
        text += [" ".join(f"{number + 1:x}" for number in row) for row in rows[first - 1 : last]] + ["))"]
    file = OUT / "progress-fluent.msh"
    file.write_text("\n".join(text) + "\n")
    return str(file)


def foam_case(n):
    """A case of OpenFOAM of n^3 cubes on one patch."""
    point, inner, outer = cubes(n)
    inner.sort(key=lambda face: face[:2])
    faces = [f"4({' '.join(map(str, face[-1]))})" for face in (*inner, *outer)]
    patch = f"all {{ type patch; nFaces {len(outer)}; startFace {len(inner)}; }}"
    lists = {
        "points": [f"({x} {y} {z})" for x, y, z in point.tolist()], "faces": faces,
        "owner": [str(face[0]) for face in (*inner, *outer)], "neighbour": [str(face[1]) for face in inner],
        "boundary": [patch],
    }  # fmt: skip
    folder = OUT / "progress" / "constant" / "polyMesh"
    folder.mkdir(parents=True, exist_ok=True)
    for name, rows in lists.items():
        kind = "faceList" if name == "faces" else name
        head = f"FoamFile {{ version 2.0; format ascii; class {kind}; }}\n"
        (folder / name).write_text(head + "\n".join([str(len(rows)), "(", *rows, ")"]) + "\n")
    (OUT / "progress" / "case.foam").touch()
    return str(OUT / "progress" / "case.foam")


def cases():
    """Inputs that take long enough: group, name, inputs, settings."""
    cube = grid(15)
    surface = simple.ExtractSurface(Input=simple.Wavelet(WholeExtent=[-150, 150, -150, 150, 0, 0]))
    triangles = simple.Triangulate(Input=surface)
    perturbed = make("filters", "MeshPerturbation", {"Input": grid(6)}, {})
    tangled = make("filters", "MeshPerturbation", {"Input": grid(8)}, {"TangledFraction": 0.1})
    yield "sources", "MetricField", {}, {}
    yield "sources", "MeshDomain", {}, {"NumberOfCells": 30000}
    yield "sources", "MeshDomain", {}, {"Domain": "Rectangle, Structured", "NumberOfCells": 200000}
    yield "sources", "MeshDomain", {}, {"Domain": "Disk (2D)", "NumberOfCells": 30000}
    readers = {".mesh": "TautlineMeditReader", ".msh": "AnyGmshReader", ".ele": "TautlineTetGenReader"}
    for extension, name in {**readers, ".off": "TautlineOffReader"}.items():
        file = written(extension, triangles if extension == ".off" else cube)
        yield "sources", name, {}, {"FileNames": [file]}
    yield "sources", "ABAQUSReader", {}, {"FileNames": [deck(".inp", cube, ABAQUS)]}
    yield "sources", "AnyNastranReader", {}, {"FileNames": [deck(".bdf", cube, NASTRAN)]}
    yield "sources", "TautlineMfemReader", {}, {"FileNames": [straight_mesh(cube)]}
    yield "sources", "TautlineFoamReader", {}, {"FileName": foam_case(30)}
    yield "sources", "AnyFluentReader", {}, {"FileName": fluent_file(30)}
    yield "sources", "SilhouetteSetReader", {}, {"FileName": str(DATA / "silhouettes.csv")}
    yield "filters", "ElementQuality", {"Input": cube}, {}
    yield "filters", "MeshComparison", {"Input": cube, "Other": cube}, {}
    yield "filters", "MeshPerturbation", {"Input": cube}, {}
    yield "filters", "MeshOptimizer", {"Input": perturbed}, {}
    yield "filters", "MeshUntangler", {"Input": tangled}, {}
    yield "filters", "MeshCurving", {"Input": cube}, {"Order": 3}
    yield "filters", "MeshMetric", {"Input": cube}, {"Source": "Distance"}
    yield "filters", "FieldTransfer", {"Input": cube, "Source": cube}, {}
    yield "filters", "MeshImprover", {"Input": perturbed}, {"TargetAngle": 40}
    yield "filters", "MeshWarp", {"Input": read("plate.vtu")}, {"Transform": rotation()}
    yield "filters", "EllipticSolver", {"Input": cube}, {}
    yield "filters", "ConditionEstimator", {"Input": read("plate.vtu")}, {}
    yield "filters", "SolverStudy", {"Input": read("plate.vtu")}, {}
    yield "filters", "TriangleMesher", {"Input": read("plate.poly")}, {"Size": 0.02}
    yield "filters", "TetGenMesher", {"Input": read("cube.smesh")}, {"Volume": 4e-6}
    fine = square(ElementSize=0.01)
    yield "filters", "InteractionLayer", {"Input": fine}, {}
    yield "filters", "HorizonNeighbors", {"Input": fine}, {}
    yield "filters", "PeridynamicCondition", {"Input": square()}, {}
    yield "filters", "SilhouetteToMesh", {"Input": disc()}, {}
    yield "filters", "MatchShape", {"Input": read("clover.png"), "Target": read("clover-turned.png")}, {}
    silhouettes = make("sources", "SilhouetteSetReader", {}, {"FileName": str(DATA / "silhouettes.csv")})
    yield "filters", "ShapeRetrieval", {"Input": silhouettes}, {}


def algorithm_of(made):
    """The algorithm that computes: for a series of files the reader of one file."""
    algorithm = made.SMProxy.GetClientSideObject()
    return algorithm.GetReader() if algorithm.IsA("vtkFileSeriesReader") else algorithm


def watch(made):
    """Executes; the fractions and texts of its reports."""
    reports = []
    algorithm = algorithm_of(made)
    algorithm.AddObserver(
        "ProgressEvent", lambda *_: reports.append((algorithm.GetProgress(), algorithm.GetProgressText()))
    )
    made.UpdatePipeline()
    return reports


def check(name, made, reports):
    label = made.SMProxy.GetXMLLabel()
    fractions = [fraction for fraction, _ in reports]
    texts = {text for _, text in reports}
    assert all(text and (text == label or text.startswith(f"{label}: ")) for text in texts), (name, label, texts)
    if made.SMProxy.GetClientSideObject() != algorithm_of(made):
        fractions = [0, *fractions, 1]  # the series reports begin and end
    else:
        assert fractions[0] == 0 and fractions[-1] == 1, (name, fractions[0], fractions[-1])
    jumps = [after - before for before, after in zip(fractions, fractions[1:])]
    assert min(jumps) >= 0, (name, [f"{fraction:.3f}" for fraction in fractions])
    assert max(jumps) <= JUMP, (name, [f"{fraction:.3f}" for fraction in fractions])
    between = {fraction for fraction in fractions if 0 < fraction < 1}
    assert len(between) >= MOVES, (name, between)
    print(f"{name}: {len(between)} values, at most {max(jumps):.2f} apart", flush=True)


def main():
    seen = set()
    for group, name, inputs, settings in cases():
        for source in inputs.values():
            source.UpdatePipeline()
        made = make(group, name, inputs, settings)
        seen.add((group, name))
        check(name, made, watch(made))
    left = {proxy for proxy in PROXIES if proxy[0] != "writers"} - seen - HIDDEN
    assert not left, f"no input for {left}"


main()
