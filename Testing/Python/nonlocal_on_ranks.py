# SPDX-License-Identifier: BSD-3-Clause
"""nonlocal_on_ranks.py FILE: for pvbatch on any number of MPI ranks, see test_nonlocal_on_ranks.py.

Horizon Neighbors and Interaction Layer on a mesh in pieces, cut in several ways; the results go to FILE as JSON.
"""

import json
import os
import sys

import numpy as np
from paraview import servermanager, simple
from parallel_tools import RANKS, parts, update
from vtkmodules.util.numpy_support import vtk_to_numpy
from wording import wording

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())
results = {}

# Runs on every rank: its part of a square of triangles with a hole. `ids`: global ones; without them the points
# are in the order of their coordinates and the cells in the order of their points, as meshes are put together.
PIECES = """
import numpy as np
from rank_meshes import RANK, RANKS, add_array, add_global_ids, appended, divided, piece, simplices
from vtkmodules.vtkCommonDataModel import VTK_LINE

N, KIND = {n}, "{kind}"
takers = {takers} if 0 < {takers} < RANKS else RANKS
places, cells = simplices(N, 2)
random = np.random.default_rng(1)
inner = np.logical_and(places > 0, places < N).all(axis=1)
x = np.zeros((len(places), 3))
x[:, :2] = places / N + 0.3 / N * inner[:, None] * (random.random(places.shape) - 0.5)
middle = places[cells].mean(axis=1) / N
cells = cells[np.logical_or(np.abs(middle[:, 0] - 0.5) > 0.2, np.abs(middle[:, 1] - 0.6) > 0.15)]
if KIND == "reversed":
    cells[:, [1, 2]] = cells[:, [2, 1]]
if KIND == "mixed":
    cells[::5, 1:3] = cells[::5, 2:0:-1]
if KIND == "upright":
    x = np.stack([np.full(len(x), 0.25), x[:, 0], x[:, 1]], -1)
if KIND == "inclined":
    x = x @ np.array([[0.8, 0.6, 0.2], [-0.6, 0.8, 0.1], [0, 0, 1]])
if not {ids}:
    order = np.lexsort(x.T[::-1])
    rank_of = np.empty(len(order), dtype=np.int64)
    rank_of[order] = np.arange(len(order))
    x, cells = x[order], rank_of[cells]
    cells = cells[np.lexsort(np.sort(cells, axis=1).T[::-1])]
ranks = divided(x[cells].mean(axis=1), "{cut}", takers, axis={axis})
if {uneven} and RANKS > 1:
    ranks = np.where(np.arange(len(cells)) < 100, 0, RANKS - 1)
grid = piece(x, cells, ranks == RANK, {ghosts} and RANKS > 1)
if {several} and RANKS > 1:  # as readers put pieces together: each has points of its own
    halves = divided(x[cells].mean(axis=1), "tree", 3)
    grid = appended([piece(x, cells, np.logical_and(ranks == RANK, halves == half)) for half in range(3)])
if grid.GetNumberOfPoints():
    number = np.array(grid.GetPointData().GetArray("place"))
    add_array(grid.GetPointData(), "value", np.stack([x[number, 0] + 1, number + 0.5], -1))
    add_array(grid.GetPointData(), "large", 2**60 + number)
    if KIND == "lines":  # an edge of every seventh triangle, behind all triangles
        numbers = np.array(grid.GetCellData().GetArray("cell"))
        for edge in np.flatnonzero(numbers % 7 == 0):
            corners = grid.GetCell(int(edge)).GetPointIds()
            grid.InsertNextCell(VTK_LINE, 2, [corners.GetId(0), corners.GetId(1)])
            grid.GetCellData().GetArray("cell").InsertNextTuple1(len(cells) + numbers[edge])
    add_array(grid.GetCellData(), "half", (np.array(grid.GetCellData().GetArray("cell")) + 0.5).astype(np.float32))
    if {ids}:
        add_global_ids(grid)
    output.VTKObject.ShallowCopy(grid)
"""


def mesh(kind="plain", cut="slabs", ids=1, ghosts=0, n=12, takers=0, axis=0, uneven=0, several=0):
    script = PIECES.format(**locals())
    return simple.ProgrammableSource(OutputDataSetType="vtkUnstructuredGrid", Script=script)


def fetched(filter_, port):
    """Points, connectivity and cell arrays of what the first rank has."""
    data = servermanager.Fetch(filter_, idx=port)
    arrays = data.GetCellData()
    found = {arrays.GetArrayName(i): vtk_to_numpy(arrays.GetArray(i)) for i in range(arrays.GetNumberOfArrays())}
    found["cells"] = vtk_to_numpy(data.GetPolys().GetConnectivityArray())
    found["points"] = vtk_to_numpy(data.GetPoints().GetData()) if data.GetNumberOfPoints() else np.zeros((0, 3))
    return {name: array.tolist() for name, array in found.items()}


def horizon(name, source, **options):
    given = {"Center": [0.45, 0.4, 0], "Horizon": 0.3, **options}
    filter_ = update(HorizonNeighbors(source, **given))
    results[f"horizon {name}"] = [fetched(filter_, port) for port in range(3)]


# Runs on every rank: adds the corners of each cell as a cell array.
CORNERS = """
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
grid = output.VTKObject
grid.ShallowCopy(inputs[0].VTKObject)
if grid.GetNumberOfCells():
    corners = vtk_to_numpy(grid.GetPoints().GetData())[vtk_to_numpy(grid.GetCells().GetConnectivityArray())]
    array = numpy_to_vtk(np.ascontiguousarray(corners.reshape(-1, 9)), deep=True)
    array.SetName("corners")
    grid.GetCellData().AddArray(array)
"""


# Runs on every rank: a grid of triangles and lines as poly data, which has the lines first.
POLY_DATA = """
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import VTK_LINE, vtkCellArray
grid, poly = inputs[0].VTKObject, output.VTKObject
if grid.GetNumberOfCells():
    kinds = np.array([grid.GetCellType(cell) == VTK_LINE for cell in range(grid.GetNumberOfCells())])
    lists = [vtkCellArray(), vtkCellArray()]  # triangles and lines
    for cell, line in enumerate(kinds):
        lists[int(line)].InsertNextCell(grid.GetCell(cell).GetPointIds())
    poly.SetPoints(grid.GetPoints())
    poly.SetPolys(lists[0])
    poly.SetLines(lists[1])
    poly.GetPointData().ShallowCopy(grid.GetPointData())
    order = np.concatenate([np.flatnonzero(kinds), np.flatnonzero(~kinds)])
    ids = numpy_to_vtkIdTypeArray(vtk_to_numpy(grid.GetCellData().GetGlobalIds())[order], deep=True)
    ids.SetName("ids")
    poly.GetCellData().SetGlobalIds(ids)
"""


def layer(name, source, **options):
    filter_ = update(InteractionLayer(source, **{"Width": 0.3, **options}))
    found = parts(simple.ProgrammableFilter(filter_, Script=CORNERS), sys.argv[1])
    triangles, points = [], {}
    for arrays in found:
        rows = np.column_stack([arrays["Reference"], arrays["cell"], arrays["half"], arrays["corners"]])
        triangles += rows.tolist()
        for place, *row in zip(arrays["points"].tolist(), arrays["place"].tolist(), arrays["value"].tolist(),
                               arrays["large"].tolist()):  # fmt: skip
            key = " ".join(f"{x + 0.0:.9f}" for x in place)
            # Pieces that share a point have the same values of it.
            assert points.setdefault(key, row) == row, (name, place, row, points[key])
    results[f"layer {name}"] = [sorted(triangles), points]
    results[f"counts {name}"] = [[int((arrays["Reference"] == kind).sum()) for kind in (1, 2)] for arrays in found]
    for arrays in found:
        assert "vtkGhostType" not in arrays, name


for case, given in {
    "slabs": {"cut": "slabs", "ghosts": 1},
    "tree": {"cut": "tree", "ids": 0},
    "random": {"cut": "random", "ghosts": 1, "ids": 0},
    "random ids": {"cut": "random"},
    "two ranks": {"takers": 2, "cut": "tree"},
    "reversed": {"kind": "reversed", "cut": "random", "ids": 0},
    "upright": {"kind": "upright", "cut": "tree"},
    "several": {"several": 1, "cut": "random", "ids": 0},
    "several ids": {"several": 1, "cut": "tree"},
    "mixed": {"kind": "mixed", "cut": "random"},
    "inclined": {"kind": "inclined", "cut": "tree"},
}.items():
    whole = mesh(**given)
    places = {"upright": {"Center": [0.3, 0.45, 0.4]}, "inclined": {"Center": [0.1, 0.6, 0.2]}}
    horizon(case, whole, **places.get(case, {}))
    layer(case, whole)
# Lines have the highest global ids: in a grid they come last, in poly data before the triangles.
horizon("lines", mesh(kind="lines", cut="tree"))
horizon("lines of poly data", simple.ProgrammableFilter(mesh(kind="lines", cut="tree"), Script=POLY_DATA,
                                                        OutputDataSetType="vtkPolyData"))  # fmt: skip
horizon("all", mesh(cut="random"), Horizon=5.0)
layer("small", mesh(cut="tree", ids=0), ElementSize=0.04, Width=0.1)
layer("by ids", mesh(cut="random"), MergeCoincidentPoints=0)


def rejected(name, filter_):
    """An error on all ranks, and none waits."""
    results[f"rejected {name}"] = update(filter_).GetDataInformation().GetNumberOfCells()


# The last rank has a quadrilateral, a flat triangle, or a point that does not exist.
BREAK = """
from vtkmodules.vtkParallelCore import vtkMultiProcessController
from vtkmodules.util.numpy_support import vtk_to_numpy
grid = output.VTKObject
grid.DeepCopy(inputs[0].VTKObject)
controller = vtkMultiProcessController.GetGlobalController()
if controller.GetLocalProcessId() == controller.GetNumberOfProcesses() - 1:
    connectivity = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    {change}
"""
for case, change in {
    "quadrilateral": "grid.GetCellData().Initialize(); grid.InsertNextCell(9, 4, [0, 1, 2, 3])",
    "point": "connectivity[0] = 100000",
}.items():
    broken = simple.ProgrammableFilter(mesh(), Script=BREAK.format(change=change))
    rejected(f"horizon {case}", HorizonNeighbors(broken))
    rejected(f"layer {case}", InteractionLayer(broken))
# A cell of the last rank has the id of one of the first rank; a mesh of one rank keeps its order whatever the ids are.
if RANKS > 1:
    same = BREAK.format(change="vtk_to_numpy(grid.GetCellData().GetGlobalIds())[0] = 0")
    rejected(wording("horizon-ids"), HorizonNeighbors(simple.ProgrammableFilter(mesh(), Script=same)))
    rejected(wording("layer-ids"), InteractionLayer(simple.ProgrammableFilter(mesh(), Script=same)))
flat = simple.ProgrammableFilter(mesh(), Script=BREAK.format(change="connectivity[0] = connectivity[1]"))
rejected(wording("layer-flat"), InteractionLayer(flat))
rejected(wording("horizon-zero"), HorizonNeighbors(mesh(), Horizon=0))
rejected(wording("layer-width"), InteractionLayer(mesh(), Width=0))
rejected(wording("layer-time"), InteractionLayer(mesh(), ElementSize=0.002, Width=0.5, TimeLimit=0.2))

results["ranks"] = RANKS
with open(sys.argv[1], "w", encoding="utf-8") as out:
    json.dump(results, out)
