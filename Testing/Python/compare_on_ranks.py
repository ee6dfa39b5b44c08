# SPDX-License-Identifier: BSD-3-Clause
"""compare_on_ranks.py FILE: for pvbatch on any number of MPI ranks, see test_compare_on_ranks.py.

Compare Meshes on two meshes in pieces, cut alike and differently; the results go to FILE as JSON.
"""

import json
import os
import sys

import numpy as np
from paraview import servermanager, simple
from parallel_tools import RANKS, columns, parts, update
from wording import wording

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())
METRICS = ["Mean ratio", "Size (area or volume)", "Untangling beta", "Edge length ratio"]
results = {}

# Runs on every rank: its part of a mesh with its points in one of two states.
PIECES = """
import numpy as np
from rank_meshes import RANK, RANKS, add_global_ids, appended, divided, piece, simplices
from vtkmodules.util.numpy_support import vtk_to_numpy

D, N, KIND, AFTER, TAKERS = {dimension}, {n}, "{kind}", {after}, {takers}
takers = TAKERS if 0 < TAKERS < RANKS else RANKS
places, cells = simplices(N, D)
random = np.random.default_rng(1)
inner = np.logical_and(places > 0, places < N).all(axis=1)
x = np.zeros((len(places), 3))
x[:, :D] = places / N
amplitude = (1.6 if KIND in ("tangled", "mixed") else 0.3) / N
for state in range(1 + AFTER):
    x[:, :D] += amplitude / (1 + state) * inner[:, None] * (random.random(places.shape) - 0.5)
if KIND == "surface":
    x[:, 2] = np.abs(x[:, 0] - 0.5) + (0.2 * x[:, 1] ** 2 if AFTER else 0)
if KIND == "flattened":
    x[:, 2] = 0 if AFTER else np.abs(x[:, 0] - 0.5)
if KIND == "inclined":
    x = x @ np.array([[0.8, 0.6, 0.2], [-0.6, 0.8, 0.1], [0, 0, 1]])
if KIND == "reversed":
    cells[:, [1, 2]] = cells[:, [2, 1]]
if KIND in ("mixed", "flattened"):
    cells[::5, 1:3] = cells[::5, 2:0:-1]
own = divided(places[cells].mean(axis=1), "{cut}", takers, axis={axis}) == (takers - 1 - RANK if {swap} else RANK)
grid = piece(x, cells, own, {ghosts} and RANKS > 1)
if {several} and RANKS > 1:  # as readers put pieces together: each has points of its own
    halves = divided(places[cells].mean(axis=1), "tree", 3)
    grid = appended([piece(x, cells, np.logical_and(own, halves == half)) for half in range(3)])
if grid.GetNumberOfPoints():
    if {ids}:
        add_global_ids(grid)
        vtk_to_numpy(grid.GetPointData().GetGlobalIds())[:] += {shift}
    output.VTKObject.ShallowCopy(grid)
"""


PLAIN = {"kind": "plain", "cut": "slabs", "after": 0, "ids": 1, "ghosts": 0, "dimension": 3, "n": 4, "takers": 0,
         "axis": 0, "several": 0, "swap": 0, "shift": 0}  # fmt: skip


def mesh(**given):
    script = PIECES.format(**{**PLAIN, **given})
    return simple.ProgrammableSource(OutputDataSetType="vtkUnstructuredGrid", Script=script)


def values(filter_, names, key):
    """Arrays in the order of the whole mesh; ranks that share a point or cell must agree."""
    found = {}
    for arrays in parts(filter_, sys.argv[1]):
        rows = np.concatenate([np.reshape(arrays[name], (len(arrays[key]), -1)) for name in names], axis=1)
        for number, row in zip(arrays[key].tolist(), rows.tolist()):
            assert np.allclose(found.setdefault(number, row), row, rtol=1e-12, atol=1e-14), (names, number, row)
    return [row for _, row in sorted(found.items())]


def table(filter_):
    return {name: column for name, column in columns(servermanager.Fetch(filter_, idx=1)).items() if name != "Metric"}


def compare(name, first, second):
    filter_ = update(CompareMeshes(Input=first, Other=second, Metrics=METRICS))
    arrays = ["Validity_before", "Validity_after", "Change"]
    arrays += [f"{m}_{w}" for m in ("mean_ratio", "size", "untangle_beta", "edge_ratio")
               for w in ("before", "after", "difference")]  # fmt: skip
    results[name] = [values(filter_, arrays, "cell"), values(filter_, ["Displacement", "points"], "place"),
                     table(filter_), filter_.Summary]  # fmt: skip
    # Each rank has its part of the second mesh.
    results[f"cells {name}"] = [len(found["cell"]) for found in parts(filter_, sys.argv[1])]
    results[f"cells of {name}"] = [len(found["cell"]) for found in parts(second, sys.argv[1])]


# As the pieces of both meshes are the same, ids are not needed.
for cut in ("slabs", "tree", "random"):
    for ghosts in (0, 1):
        given = {"cut": cut, "ghosts": ghosts, "ids": ghosts}
        compare(f"alike {cut} {ghosts}", mesh(**given), mesh(after=1, **given))
for kind, dimension in (("tangled", 3), ("reversed", 3), ("tangled", 2), ("inclined", 2), ("reversed", 2),
                        ("surface", 2), ("mixed", 3), ("flattened", 2)):  # fmt: skip
    given = {"kind": kind, "dimension": dimension, "n": 4 if dimension == 3 else 9, "ids": 0}
    for cut in ("slabs", "random"):
        compare(f"{kind} {dimension} {cut}", mesh(cut=cut, **given), mesh(cut=cut, after=1, **given))
# Other pieces: by ids. Two ranks have all of the first mesh, and one has all of the second.
compare("slabs, tree", mesh(cut="slabs"), mesh(cut="tree", after=1, axis=1))
compare("tree, random with ghosts", mesh(cut="tree", ghosts=1), mesh(cut="random", after=1, ghosts=1))
compare("two ranks, random", mesh(takers=2, kind="tangled"), mesh(cut="random", after=1, kind="tangled"))
compare("random, one rank", mesh(cut="random", dimension=2, n=8), mesh(takers=1, after=1, dimension=2, n=8))
compare("surfaces", mesh(cut="random", kind="surface", dimension=2, n=8),
        mesh(after=1, kind="surface", dimension=2, n=8))  # fmt: skip
compare("several pieces", mesh(several=1, kind="tangled"), mesh(cut="random", after=1, several=1, kind="tangled"))
# The pieces look alike, and the ids show that they are not; or the ids belong to another mesh.
compare("swapped slabs", mesh(), mesh(after=1, swap=1))
compare("other ids", mesh(cut="tree"), mesh(cut="tree", after=1, shift=1000))
# By their places where nothing has moved.
compare("unmoved", mesh(cut="random", ids=0), mesh(cut="tree", ids=0))
# With ids that ParaView makes, and ghost cells in one of the meshes only.
given = simple.GenerateGlobalIds(mesh(ids=0))
moved = PerturbMesh(given, Percentage=100, Fraction=0.4)
ghosted = getattr(simple, "GhostCellsGenerator", None) or simple.GhostCells
found = [update(CompareMeshes(Input=given, Other=other, Metrics=METRICS)) for other in (moved, ghosted(moved))]
results["generated ids"] = [[table(filter_), filter_.Summary] for filter_ in found]
# Blocks.
tangled = {"cut": "tree", "dimension": 2, "kind": "tangled", "ids": 0}
first = simple.GroupDatasets(Input=[mesh(ids=0), mesh(**tangled)])
second = simple.GroupDatasets(Input=[mesh(ids=0, after=1), mesh(after=1, **tangled)])
blocks = update(CompareMeshes(Input=first, Other=second, Metrics=METRICS))
results["blocks"] = [table(blocks), blocks.Summary]
# A block that only the first rank has.
BLOCKS = PIECES.replace("    output.VTKObject.ShallowCopy(grid)\n", "    pass\n") + """
blocks = output.VTKObject
blocks.SetBlock(0, grid)
if RANK == 0:
    blocks.SetBlock(1, piece(x, cells, np.ones(len(cells), bool)))
"""
scripts = [BLOCKS.format(**{**PLAIN, "ids": 0, "after": after}) for after in (0, 1)]
first, second = (simple.ProgrammableSource(OutputDataSetType="vtkMultiblockDataSet", Script=text) for text in scripts)
blocks = update(CompareMeshes(Input=first, Other=second, Metrics=METRICS))
results["more blocks"] = [table(blocks), blocks.Summary]


def rejected(name, first, second):
    """An error on all ranks, and none waits."""
    filter_ = update(CompareMeshes(Input=first, Other=second))
    results[f"rejected {name}"] = [filter_.GetDataInformation().GetNumberOfCells(), filter_.Summary]


# The last rank with cells has another cell.
BREAK = """
from vtkmodules.vtkParallelCore import vtkMultiProcessController
from vtkmodules.util.numpy_support import vtk_to_numpy
grid = output.VTKObject
grid.DeepCopy(inputs[0].VTKObject)
controller = vtkMultiProcessController.GetGlobalController()
if controller.GetLocalProcessId() == controller.GetNumberOfProcesses() - 1:
    connectivity = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    connectivity[[0, 1]] = connectivity[[1, 0]]
"""
rejected("order", mesh(), simple.ProgrammableFilter(mesh(after=1), Script=BREAK))
rejected("cells", mesh(n=3), mesh(after=1))
if RANKS > 1:
    # Copies of cells that are no longer marked are not counted as cells.
    drop = "output.VTKObject.ShallowCopy(inputs[0].VTKObject); output.CellData.VTKObject.RemoveArray('vtkGhostType')"
    unmarked = [simple.ProgrammableFilter(mesh(ghosts=1, after=after), Script=drop) for after in (0, 1)]
    rejected("copies", *unmarked)
    rejected(wording("no-ids"), mesh(ids=0), mesh(cut="random", ids=0, after=1))

results["ranks"] = RANKS
with open(sys.argv[1], "w", encoding="utf-8") as out:
    json.dump(results, out)
