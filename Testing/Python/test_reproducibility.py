# SPDX-License-Identifier: BSD-3-Clause
"""Every filter gives bitwise the same with one thread and with two.

    test_reproducibility.py                  each operation with one and with two threads: the digests are equal
    test_reproducibility.py --write FILE     the digests of all operations with one thread, as JSON
    test_reproducibility.py --compare FILE   the same, and each difference from FILE; exit code 1 if there is any
    ... --only TEXT                          those operations only whose names have the text

The digest of an operation is a list: name, kind and SHA-256 of each array, number and text of its result, in order.
Times in seconds are left out. Values, names and texts are compared separately, so that a renamed array or a reworded
message is distinguished from a changed number.

--write and --compare prove that a change of the sources changes no result: write before it, compare after it. The
digests depend on the compiler, the vector units of the processor and the versions of the libraries. They hold for one
machine only, so none are part of the sources.
"""

import argparse
import functools
import hashlib
import json
import os
import re
import sys
import tempfile
import time
from dataclasses import fields, is_dataclass
from pathlib import Path

import numpy as np
import tautline as tl
from tautline._arrays import cell_types
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkAbstractArray, vtkDataArray
from vtkmodules.vtkCommonDataModel import (
    vtkCellArray,
    vtkCompositeDataSet,
    vtkDataSet,
    vtkImageData,
    vtkMultiBlockDataSet,
    vtkPointSet,
    vtkPolyData,
    vtkTable,
    vtkUnstructuredGrid,
)
from vtkmodules.vtkFiltersSources import vtkSphereSource
from wording import wording

DATA = Path(os.environ.get("TAUTLINE_DATA_DIR", Path(__file__).parents[2] / "Data"))
BRACKET, TANGLED, PLATE = (DATA / f"{name}.vtu" for name in ("bracket", "bracket-tangled", "plate"))
FISH, BENT, CLOVER, TURNED = (DATA / f"{name}.png" for name in ("fish", "fish-bent", "clover", "clover-turned"))
CELLS = 50000  # of the generated meshes, about

# --- digests ------------------------------------------------------------------------------------------------

BY_THREAD = "/memory"  # the estimate of peridynamics: each thread needs some
SECONDS_NAME = re.compile(r"seconds|\btime\b", re.IGNORECASE)  # of an array, a column, a field
SECONDS_TEXT = re.compile(r"\b[\d.]+(e[+-]?\d+)? m?s\b|^Seconds: .*$", re.MULTILINE)  # in a text


class Digest:
    """A list of [name, kind, SHA-256] of all there is in a result, in order."""

    def __init__(self, result):
        self.entries = []
        self.add("result", result)

    def add(self, name, value):
        if SECONDS_NAME.search(name.rsplit("/", 1)[-1]):
            return
        if isinstance(value, str):
            self.entry(name, "text", SECONDS_TEXT.sub("(time)", value).encode())
        elif isinstance(value, vtkCompositeDataSet):
            self.add_blocks(name, value)
        elif isinstance(value, vtkDataSet):
            self.add_data_set(name, value)
        elif isinstance(value, vtkTable):
            self.add_fields(name, value.GetRowData())
        elif isinstance(value, vtkDataArray):
            parts = [value.GetComponentName(i) or "" for i in range(value.GetNumberOfComponents())]
            self.array(f"{name} {' '.join(parts)}".strip(), vtk_to_numpy(value))
        elif isinstance(value, vtkAbstractArray):
            self.add(name, [str(value.GetVariantValue(i)) for i in range(value.GetNumberOfValues())])
        elif is_dataclass(value):
            for field in fields(value):
                self.add(f"{name}/{field.name}", getattr(value, field.name))
        elif isinstance(value, dict):
            for key, inner in value.items():
                self.add(f"{name}/{key}", inner)
        elif isinstance(value, (list, tuple)):
            for i, inner in enumerate(value):
                self.add(f"{name}/{i}", inner)
        elif value is None:
            self.entry(name, "value", b"")
        elif isinstance(value, (bytes, bool, int, float, np.ndarray, np.generic)):
            self.array(name, np.frombuffer(value, np.uint8) if isinstance(value, bytes) else np.asarray(value))
        else:
            raise TypeError(f"{name}: there is no digest of a {type(value).__name__}")

    def entry(self, name, kind, content):
        self.entries.append([name, kind, hashlib.sha256(content).hexdigest()])

    def array(self, name, values):
        self.entry(name, "value", f"{values.dtype} {values.shape} ".encode() + values.tobytes())

    def add_blocks(self, name, blocks):
        walk = blocks.NewIterator()
        walk.SkipEmptyNodesOff()
        walk.InitTraversal()
        while not walk.IsDoneWithTraversal():
            block = walk.GetCurrentMetaData().Get(vtkCompositeDataSet.NAME()) if walk.HasCurrentMetaData() else None
            self.add(f"{name}/{walk.GetCurrentFlatIndex()} {block or ''}", walk.GetCurrentDataObject())
            walk.GoToNextItem()

    def add_data_set(self, name, data):
        self.add(f"{name}/class", data.GetClassName())
        if isinstance(data, vtkPointSet) and data.GetPoints():
            self.add(f"{name}/points", data.GetPoints().GetData())
        if isinstance(data, vtkImageData):
            grid = (*data.GetExtent(), *data.GetOrigin(), *data.GetSpacing(), *data.GetDirectionMatrix().GetData())
            self.array(f"{name}/grid", np.array(grid))
        if isinstance(data, vtkUnstructuredGrid) and data.GetNumberOfCells():
            self.add(f"{name}/cell types", cell_types(data))
            self.add_cells(f"{name}/cells", data.GetCells())
        if isinstance(data, vtkPolyData):
            for kind in ("Verts", "Lines", "Polys", "Strips"):
                self.add_cells(f"{name}/{kind}", getattr(data, f"Get{kind}")())
        for kind in ("Point", "Cell", "Field"):
            self.add_fields(f"{name}/{kind.lower()} data", getattr(data, f"Get{kind}Data")())

    def add_cells(self, name, cells: vtkCellArray):
        self.add(f"{name}/offsets", cells.GetOffsetsArray())
        self.add(f"{name}/connectivity", cells.GetConnectivityArray())

    def add_fields(self, name, data):
        for i in range(data.GetNumberOfArrays()):
            array = data.GetAbstractArray(i)
            self.add(f"{name}/{array.GetName() or i}", array)


def differences(first, second):
    """The differences between the entries of two digests: a list of sentences."""
    found = []
    for kind in ("value", "text"):
        ours, theirs = ([entry for entry in entries if entry[1] == kind] for entries in (first, second))
        changed = [b[0] for a, b in zip(ours, theirs) if a[2] != b[2]]
        if len(ours) != len(theirs):
            found.append(f"{len(ours)} {kind}s became {len(theirs)}")
        if changed:
            found.append(f"{kind}s differ: {', '.join(changed)}")
    renamed = [f"{a[0]} is now {b[0]}" for a, b in zip(first, second) if a[0] != b[0]]
    if renamed:
        found.append(f"names differ: {', '.join(renamed)}")
    return found


# --- the meshes ---------------------------------------------------------------------------------------------


@functools.cache
def wrench():
    return tl.perturb(tl.domain("wrench", CELLS), seed=3, threads=1).mesh


@functools.cache
def barrier():
    return tl.perturb(tl.domain("barrier3d", CELLS), seed=4, threads=1).mesh


@functools.cache
def tangled_barrier():
    return tl.perturb(barrier(), seed=5, tangle=0.005, threads=1).mesh


@functools.cache
def moving(name):
    return tl.domain(name, CELLS)


@functools.cache
def hexahedra(n=36):
    """A cube of n^3 hexahedra with its interior points out of place."""
    z, y, x = (axis.ravel() for axis in np.meshgrid(*[np.arange(n + 1) / n] * 3, indexing="ij"))
    number = np.arange((n + 1) ** 3).reshape([n + 1] * 3)
    steps = ((0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0), (1, 0, 0), (1, 0, 1), (1, 1, 1), (1, 1, 0))
    cells = np.stack([number[k : k + n, j : j + n, i : i + n].ravel() for k, j, i in steps], axis=1)
    mesh = tl.from_arrays(np.stack([x, y, z], axis=1), {"hexahedron": cells})
    return tl.perturb(mesh, fraction=0.4, seed=6, threads=1).mesh


@functools.cache
def sphere(resolution=160):
    """A surface in space, with triangles of unequal size and shape."""
    source = vtkSphereSource()
    source.SetThetaResolution(resolution)
    source.SetPhiResolution(resolution)
    source.SetOutputPointsPrecision(vtkSphereSource.DOUBLE_PRECISION)
    source.Update()
    return source.GetOutput()


@functools.cache
def layered_square(size=0.02):
    """The unit square with an interaction layer, in right triangles with legs of this size."""
    return tl.domain("square", element_size=size, layer_width=0.1)


@functools.cache
def layered_rectangle():
    return tl.interaction_layer(tl.domain("rectangle", 1600), 0.06, threads=1)


def coordinates(mesh):
    return vtk_to_numpy(mesh.GetPoints().GetData())


def blocks(*meshes):
    made = vtkMultiBlockDataSet()
    for i, mesh in enumerate(meshes):
        made.SetBlock(i, tl.read(mesh) if isinstance(mesh, Path) else mesh)
    return made


def with_sizes(mesh, sizes):
    """A copy with the point array for a mesher."""
    copy = mesh.NewInstance()
    copy.ShallowCopy(mesh)
    array = numpy_to_vtk(sizes, deep=True)
    array.SetName("Sizes")
    copy.GetPointData().AddArray(array)
    return copy


# --- the operations -----------------------------------------------------------------------------------------


def outputs(name, mesh=None, array=None, **properties):
    """All outputs of the filter of this class, which has no function in the package."""
    algorithm = getattr(tl, name)()
    for key, value in properties.items():
        getattr(algorithm, f"Set{key}")(value)
    if mesh is not None:
        algorithm.SetInputData(mesh)
    if array:
        algorithm.SetInputArrayToProcess(0, 0, 0, mesh.FIELD_ASSOCIATION_POINTS, array)
    algorithm.Update()
    made = [algorithm.GetOutputDataObject(i) for i in range(algorithm.GetNumberOfOutputPorts())]
    assert made[0].GetNumberOfPoints() > 0, f"{name}: there is no output"
    return made


def all_files(**options):
    """The results of the readers for the files of Data/."""
    endings = (".1.node", ".1.ele", ".smesh", ".poly", ".msh", ".mesh", ".sol", ".off")
    files = sorted(file for file in DATA.iterdir() if file.name.endswith(endings))
    assert len(files) >= 14, files
    return {file.name: tl.read(file, **options) for file in files}


def written():
    """The bytes of files of every format, and what is read from them."""
    cube, house = tl.read(DATA / "cube.1.node", lower_cells=True), tl.read(DATA / "house.off")
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        for mesh, name, options in (
            (cube, "cube.node", {}),
            (cube, "cube.mesh", {}),
            (cube, "cube.msh", {}),
            (cube, "bytes.msh", {"binary": True}),
            (barrier(), "barrier.ele", {}),
            (barrier(), "barrier.msh", {"binary": True}),
            (wrench(), "wrench.mesh", {}),
            (house, "house.off", {}),
            (house, "house.smesh", {}),
        ):
            for file in tl.write(mesh, Path(folder) / name, **options):
                found[Path(file).name] = Path(file).read_bytes()
            found[f"{name} read"] = tl.read(Path(folder) / name, lower_cells=True)
    return found


def domains(cells):
    """Every domain, and its deformed boundary if it moves."""
    made = {name: tl.domain(name, cells) for name in tl.domains()}
    edges = [name for name, mesh in made.items() if mesh.GetPointData().GetArray("Displacement")]
    return made, {name: tl.domain(name, cells, deformed_boundary=True, amount=0.7) for name in edges}


def without_times(study):
    """A solver study without what depends on times: the recommendation, its reasons and the ranks."""
    timed = ("result", "n rank")
    return [{key: value for key, value in row.items() if key not in timed} for row in study.rows], study.unknowns


def half(mesh):
    """A mark at each point: 1 in one half of the mesh, 0 in the other."""
    x = coordinates(mesh)[:, 0]
    return (x > x.mean()).astype(float)


TARGETED = ["mu_shape_size", "mu_9", "tmp_shape", "mu_size", "mu_shape_orientation"]
TWO = ["imr", ("size", {"weight": 2})]
THREE = ["imr", "si", ("size", {"template": "sum of squares"})]


def improve(mesh, threads, objectives=None, iterations=6, **options):
    """Optimize Mesh with few iterations."""
    return tl.optimize(mesh, objectives, maximum_iterations=iterations, threads=threads, **options)


def each(name, values, operation):
    """An operation per value, which takes the value and the number of threads."""
    return {name.format(value): functools.partial(operation, value) for value in values}


# The operations, by name, with a number of threads. Filters without threads are also run twice.
OPERATIONS = {
    # readers, writers, domains, meshers
    "read": lambda _: all_files(),
    "read with boundary cells": lambda _: all_files(lower_cells=True),
    "read silhouettes": lambda _: tl.read_silhouettes(DATA / "silhouettes.csv"),
    "write": lambda _: written(),
    "domains as in the examples": lambda _: domains(0),
    "domains of 50,000 cells": lambda _: domains(CELLS),
    "square": lambda _: tl.domain("square", element_size=0.05, aspect_ratio=4, layer_width=0.3),
    "triangle mesher": lambda _: outputs(
        "vtkTriangleMesher", tl.read(DATA / "plate.poly"), Size=0.012, MinimumAngle=30.0),
    "triangle mesher, sizes": lambda _: outputs(
        "vtkTriangleMesher", with_sizes(tl.read(DATA / "plate.poly"), np.geomspace(0.01, 0.2, 8)), "Sizes",
        UseSizeArray=True, Gradation=0.2),
    "tetgen mesher": lambda _: outputs(
        "vtkTetGenMesher", tl.read(DATA / "cube.smesh"), Volume=4e-5, RadiusEdgeRatio=1.3),
    "tetgen mesher, surface kept": lambda _: outputs("vtkTetGenMesher", sphere(40), PreserveSurface=True),
    # quality
    "quality, all metrics": lambda t: tl.quality(BRACKET, [metric["name"] for metric in tl.metrics()], threads=t),
    "quality, mixed cells": lambda t: tl.quality(
        PLATE, ["imr", "scaled_jacobian", "mu_shape"], combination="power mean", power=3, threads=t),
    "quality, 50,000 triangles": lambda t: tl.quality(
        wrench(), ["imr", "rr", "min_angle", "size"], histogram_bins=50, threads=t),
    "quality, tetrahedra by size": lambda t: tl.quality(barrier(), TARGETED, size=2.5e-3, threads=t),
    "quality, tetrahedra by reference": lambda t: tl.quality(
        barrier(), TARGETED, reference=tl.domain("barrier3d", CELLS), threads=t),
    "quality, tangled hexahedra": lambda t: tl.quality(
        tl.perturb(hexahedra(), tangle=0.01, threads=t), ["imr", "si", "edge_ratio", "untangle_beta"],
        combination="worst", beta=1e-6, reversed_mesh="measure as given", threads=t),
    "quality, blocks": lambda t: tl.quality(blocks(BRACKET, TANGLED), ["imr", "ss"], threads=t),
    "perturb": lambda t: tl.perturb(tl.domain("wrench", CELLS), 0.8, 70, seed=11, threads=t),
    "perturb, tangled": lambda t: tl.perturb(barrier(), tangle=0.01, fixed=half(barrier()), threads=t),
    "compare": lambda t: tl.compare(tl.domain("barrier3d", CELLS), barrier(), ["imr", "rr", "size"], threads=t),
    "transfer": lambda t: tl.transfer(
        tl.domain("barrier3d", CELLS // 2), tl.quality(barrier(), ["imr"]), cell_order="linear", threads=t),
    "adapt": lambda t: tl.adapt(barrier(), lambda mesh: np.tanh(9 * mesh.points[:, 0]), 2, threads=t),
    "metric field": lambda t: tl.metric_field(["imr", "si", "mu_shape"], threads=t),
    "metric field of a tetrahedron": lambda t: tl.metric_field(
        ["rr", "ss"], "tetrahedron", bounds=(-1, 2, -1, 2, 0.1, 2), dimensions=(40, 40, 30), threads=t),
    # optimization
    **each("optimize, {}", (
        "fast clean-up", "best shape", "uniform size", "low interpolation error", "worst element",
    ), lambda preset, t: tl.optimize(BRACKET, preset=preset, threads=t)),
    "optimize, untangle then improve": lambda t: tl.optimize(TANGLED, preset="untangle then improve", threads=t),
    "optimize, preserve shape": lambda t: tl.optimize(
        tl.perturb(PLATE, percentage=100, fraction=0.6), preset="preserve shape", reference=PLATE, threads=t),
    **each("optimize by {}, 50,000 tetrahedra", (
        "local newton", "local conjugate gradient", "fletcher-reeves", "polak-ribiere", "l-bfgs", "newton-cg",
    ), lambda optimizer, t: improve(barrier(), t, TWO, optimizer=optimizer, scalarization="weighted sum")),
    **each("optimize to {}, 50,000 triangles", (
        "exponential sum", "objective product", "equal sum", "weighted min-max", "exponential weighted",
        "lexicographic", "rao",
    ), lambda scalarization, t: improve(wrench(), t, THREE, 3, scalarization=scalarization)),
    "optimize, 50,000 triangles": lambda t: improve(
        wrench(), t, "rr", culling=1e-2, relaxation=1.2, patch_iterations=2),
    **each("optimize {}, 46,656 hexahedra", (
        "imr", "mu_shape", "scaled_jacobian",
    ), lambda metric, t: improve(hexahedra(), t, metric, 2, combination="power mean")),
    "optimize, sliding": lambda t: improve(barrier(), t, "imr", 3, boundary="sliding", optimizer="l-bfgs"),
    "optimize, on surface": lambda t: improve(barrier(), t, "imr", 3, boundary="on surface", feature_angle=40),
    "optimize, free": lambda t: improve(wrench(), t, "mu_shape_size", 3, boundary="free", size=1e-4),
    "optimize, a surface": lambda t: improve(sphere(), t, "imr", 3, boundary="on surface"),
    "optimize, held points": lambda t: improve(
        PLATE, t, "imr", fixed=half(tl.read(PLATE)), limits=0.05, element_weights=np.arange(1.0, 1914.0)),
    "optimize, tangled": lambda t: improve(TANGLED, t, ["imr", "size"], improve_worst=0.1),
    "optimize, blocks": lambda t: improve(blocks(PLATE, BRACKET), t, TWO, 4),
    **each("untangle, {}", ("local", "normal", "thorough"), lambda effort, t: tl.untangle(TANGLED, effort, threads=t)),
    "untangle, 50,000 tetrahedra": lambda t: tl.untangle(tangled_barrier(), threads=t),
    "untangle, held points": lambda t: tl.untangle(
        TANGLED, "local", fixed=half(tl.read(TANGLED)), boundary="free", threads=t),
    **each("improve mesh, {}", ("remove slivers", "swap only", "swap and smooth", "aggressive"),
           lambda preset, t: tl.improve(BRACKET, preset, threads=t)),
    "improve mesh, sliding": lambda t: tl.improve(BRACKET, boundary="sliding", threads=t),
    # deformation
    **each("warp by {}, 50,000 triangles", (
        "hybrid", "femwarp", "anisotropic femwarp", "small-step femwarp", "femwarp and untangling",
        "jacobian stiffening", "biharmonic", "inverse distance", "radial basis", "weighted laplacian",
        "inverse distance with rotations", "automatic",
    ), lambda method, t: tl.warp(moving("cylinder"), "Displacement", method, 0.6, threads=t)),
    "warp, iterative stiffening": lambda t: tl.warp(
        PLATE, transform={"rotate": 70}, method="iterative stiffening", maximum_stiffenings=5, threads=t),
    "warp, 50,000 tetrahedra": lambda t: tl.warp(
        moving("box-in-box"), transform={"rotate": 60, "axis": (1, 1, 0)}, threads=t),
    "warp to a target": lambda t: tl.warp(
        moving("gate"), target=tl.domain("gate", CELLS, deformed_boundary=True, amount=0.5),
        method="anisotropic femwarp", coefficients="principal directions", solver="gmres", preconditioner="ilu",
        threads=t),
    "warp, steps": lambda t: tl.warp(
        BRACKET, transform={"bend": 40}, moved="whole boundary", steps=3, coefficients=(1, 2, 3), solver="direct",
        threads=t),
    # linear systems
    "solve": lambda t: tl.solve(barrier(), source="x*y + z", threads=t),
    "solve, elliptic": lambda t: tl.solve(
        wrench(), "elliptic", "gmres", "ilu", source="sin(x)*y", alpha=2, beta=3, reaction=5, restart=50, threads=t),
    "solve, elasticity": lambda t: tl.solve(
        BRACKET, "elasticity", preconditioner="gamg", source=(0, 0, -1), fixed="x < 1", threads=t),
    **each("solve by {0[0]}, {0[1]}", (
        ("minres", "ssor"), ("bicgstab", "jacobi"), ("cg", "icc"), ("direct", "none"),
    ), lambda pair, t: tl.solve(PLATE, "poisson", *pair, source="x", given="y", threads=t)),
    "condition": lambda t: tl.condition(BRACKET, "elasticity", "jacobi", threads=t),
    "condition, ritz": lambda t: tl.condition(wrench(), preconditioner="amg", method="ritz", threads=t),
    "condition, accurate": lambda t: tl.condition(PLATE, "elliptic", "ilu", method="accurate", reaction=3, threads=t),
    "solver study": lambda t: without_times(tl.solver_study(BRACKET, combinations=range(1, 26), threads=t)),
    "solver study, 50,000 triangles": lambda t: without_times(
        tl.solver_study(wrench(), "elliptic", [5, 6, 9, 13, 18, 19], reaction=10.0, threads=t)),
    # nonlocal models
    "interaction layer": lambda t: tl.interaction_layer(tl.domain("rectangle", 5000), 0.1, threads=t),
    "interaction layer, coarse": lambda t: tl.interaction_layer(
        tl.domain("wrench", 4000), 0.3, element_size=0.2, threads=t),
    "horizon neighbors": lambda _: outputs(
        "vtkHorizonNeighbors", layered_square(), Center=(0.4, 0.5, 0.0), Horizon=0.13),
    "peridynamics": lambda t: tl.peridynamics(layered_square(0.04), 0.1, 2.5, solve=True, sparsity=64, threads=t),
    "peridynamics, 45,000 triangles": lambda t: tl.peridynamics(
        layered_square(0.008), 0.03, 1, kernel="constant", discretization="dissertation", spectrum=False, solve=True,
        threads=t),
    "peridynamics, elastic": lambda t: tl.peridynamics(
        layered_rectangle(), 0.06, 3, model="elastic", solve=True, tolerance=1e-3, threads=t),
    "peridynamics, discontinuous": lambda t: tl.peridynamics(
        layered_square(0.1), 0.1, 1, "discontinuous linear", kernel="gaussian", threads=t),
    "peridynamics, constant": lambda t: tl.peridynamics(
        layered_square(0.05), 0.1, 1, "constant", kernel="conical", discretization="dissertation", rules="3/3",
        threads=t),
    # shapes
    "silhouette": lambda _: [tl.silhouette(image, spacing=9) for image in (FISH, BENT, CLOVER)],
    "match": lambda t: tl.match(FISH, BENT, spacing=12, grid=(14, 14), threads=t),
    "match on the contour": lambda t: tl.match(
        CLOVER, TURNED, spacing=10, locations="contour", reflection="whole", b=5, grey_gradient=True, threads=t),
    "retrieval": lambda t: tl.retrieval(DATA / "silhouettes.csv", best=1, threads=t),
    "retrieval, custom": lambda t: tl.retrieval(
        DATA / "silhouettes.csv", setting="custom", locations="near grid", grid=(10, 10), symmetric=True, best=1,
        threads=t),
}  # fmt: skip


# --- the runs -----------------------------------------------------------------------------------------------


def run(name, threads):
    """The digest of an operation."""
    return Digest(OPERATIONS[name](threads)).entries


def test_digests():
    """A digest detects a changed bit, name, text or option; it ignores times."""
    entries = Digest({"a": np.arange(3.0), "b": "x"}).entries
    assert differences(entries, Digest({"a": np.arange(3.0), "b": "x"}).entries) == []
    bit = np.arange(3.0)
    bit[2] = np.nextafter(bit[2], 3)
    assert differences(entries, Digest({"a": bit, "b": "x"}).entries) == ["values differ: result/a"]
    assert differences(entries, Digest({"c": np.arange(3.0), "b": "x"}).entries) == [
        "names differ: result/a is now result/c"
    ]
    assert differences(entries, Digest({"a": np.arange(3.0), "b": "y"}).entries) == ["texts differ: result/b"]
    assert differences(entries, Digest({"a": np.arange(3.0), "b": "x", "c": 1}).entries) == ["1 values became 2"]
    assert Digest({"seconds": 1.0, "Total time (s)": 2.0, "a": "0.1 s"}).entries == Digest({"a": "3e-05 s"}).entries

    first, other = (Digest(tl.perturb(PLATE, seed=seed)).entries for seed in (1, 2))
    found = " ".join(differences(first, other))
    assert "result/mesh/points" in found and wording("result-mesh-point-data") in found and "names" not in found
    assert "cells/connectivity" not in found
    mesh = tl.read(PLATE)
    before = Digest(mesh).entries
    mesh.GetPoints().SetPoint(7, np.nextafter(mesh.GetPoint(7), 9))
    assert differences(before, Digest(mesh).entries) == ["values differ: result/points"]
    first, other = (Digest(improve(PLATE, 1, "imr", iterations)).entries for iterations in (2, 3))
    assert "result/mesh/points" in " ".join(differences(first, other))


def test_threads(names):
    """Each operation with one thread and with two."""
    wrong = 0
    for name in names:
        start = time.process_time()
        one, two = ([e for e in run(name, threads) if not e[0].endswith(BY_THREAD)] for threads in (1, 2))
        found = differences(one, two)
        print(f"{name}: {len(one)} entries, {time.process_time() - start:.1f} s of CPU", flush=True)
        for sentence in found:
            print(f"  one and two threads: {sentence}")
        wrong += bool(found)
    assert not wrong, f"{wrong} of {len(names)} operations depend on the number of threads"


def compare(file, digests, only):
    """The number of operations whose digests differ from the file."""
    known = json.loads(Path(file).read_text())
    known = {name: entries for name, entries in known.items() if only in name}
    wrong = 0
    for name in {**known, **digests}:
        if name not in known or name not in digests:
            found = [f"only in {'this run' if name in digests else file}"]
        else:
            found = differences(known[name], digests[name])
        for sentence in found:
            print(f"{name}: {sentence}")
        wrong += bool(found)
    print(f"{len(digests)} operations, {wrong} differ from {file}")
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    modes = parser.add_mutually_exclusive_group()
    modes.add_argument("--write", metavar="FILE")
    modes.add_argument("--compare", metavar="FILE")
    parser.add_argument("--only", metavar="TEXT", default="")
    parser.add_argument("--threads", type=int, default=1, help="of --write and --compare (default: 1)")
    arguments = parser.parse_args()
    names = [name for name in OPERATIONS if arguments.only in name]
    if not arguments.write and not arguments.compare:
        test_digests()
        test_threads(names)
        return 0
    digests = {name: run(name, arguments.threads) for name in names}
    if arguments.write:
        Path(arguments.write).write_text(json.dumps(digests, indent=0))
        print(f"{len(digests)} operations: {arguments.write}")
        return 0
    return 1 if compare(arguments.compare, digests, arguments.only) else 0


if __name__ == "__main__":
    sys.exit(main())
