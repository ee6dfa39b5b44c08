# SPDX-License-Identifier: BSD-3-Clause
"""motion_on_ranks.py FILE: for pvbatch on any number of MPI ranks, see test_motion_on_ranks.py.

Optimizes and untangles a cube whose parts are on all ranks, cut in slabs or at random, and writes points, summaries and
tables to FILE as JSON.
"""

import json
import os
import sys

import numpy as np
from paraview import servermanager, simple
from vtkmodules.vtkParallelCore import vtkMultiProcessController

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())

# Runs on every rank: a cube of N^3 cubes of six tetrahedra each, whose inner points are moved at random.
CUBE = """
import itertools
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_TETRA, vtkCellArray
from vtkmodules.vtkParallelCore import vtkMultiProcessController

N, AMPLITUDE, RANDOM = {n}, {amplitude}, {random}
controller = vtkMultiProcessController.GetGlobalController()
rank, ranks = controller.GetLocalProcessId(), controller.GetNumberOfProcesses()
generator = np.random.default_rng(4)
k, j, i = np.meshgrid(np.arange(N + 1), np.arange(N + 1), np.arange(N + 1), indexing="ij")
x = np.stack([i, j, k], -1).reshape(-1, 3).astype(float)
inner = np.logical_and(x > 0, x < N)
x += inner * generator.uniform(-AMPLITUDE, AMPLITUDE, x.shape)
steps = (1, N + 1, (N + 1) ** 2)
ck, cj, ci = (a.ravel() for a in np.meshgrid(np.arange(N), np.arange(N), np.arange(N), indexing="ij"))
tetrahedra = []
for order in itertools.permutations(range(3)):
    corners = list(itertools.accumulate((steps[a] for a in order), initial=ci + cj * steps[1] + ck * steps[2]))
    if np.linalg.det(np.eye(3)[list(order)]) < 0:
        corners[1], corners[2] = corners[2], corners[1]
    tetrahedra.append(np.stack(corners, -1))
nodes = np.concatenate(tetrahedra).astype(np.int64)
part = generator.integers(0, ranks, len(nodes)) if RANDOM else np.tile(ck, 6) * ranks // N
nodes = nodes[part == rank]
used, local = np.unique(nodes, return_inverse=True)
points = vtkPoints()
points.SetData(numpy_to_vtk(x[used], deep=True))
grid = output.VTKObject
grid.SetPoints(points)
cells = vtkCellArray()
offsets = np.arange(0, nodes.size + 1, 4, dtype=np.int64)
local = local.reshape(-1).astype(np.int64)
cells.SetData(numpy_to_vtkIdTypeArray(offsets, deep=True), numpy_to_vtkIdTypeArray(local, deep=True))
grid.SetCells(VTK_TETRA, cells)
place = numpy_to_vtk(used.astype(np.int64), deep=True)
place.SetName("place")
grid.GetPointData().AddArray(place)
"""
RANKS = vtkMultiProcessController.GetGlobalController().GetNumberOfProcesses()
SLIDING = 1  # of the enumeration Boundary
results = {"ranks": RANKS}


def cube(n: int, amplitude: float, random: bool):
    return simple.ProgrammableSource(OutputDataSetType="vtkUnstructuredGrid",
                                     Script=CUBE.format(n=n, amplitude=amplitude, random=random))  # fmt: skip


# Runs on every rank: writes the points of its part to a file.
DUMP = """
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkParallelCore import vtkMultiProcessController

data = self.GetInputDataObject(0, 0)
arrays = {{"points": np.zeros((0, 3)), "place": np.zeros(0, dtype=np.int64)}}
if data.GetNumberOfPoints() > 0:
    arrays["points"] = vtk_to_numpy(data.GetPoints().GetData())
    arrays["place"] = vtk_to_numpy(data.GetPointData().GetArray("place"))
np.savez("{file}." + str(vtkMultiProcessController.GetGlobalController().GetLocalProcessId()), **arrays)
"""


def points_of(proxy) -> list:
    """The points in the order of the whole mesh; those of several ranks agree."""
    simple.ProgrammableFilter(proxy, Script=DUMP.format(file=sys.argv[1])).UpdatePipeline()
    parts = [np.load(f"{sys.argv[1]}.{number}.npz") for number in range(RANKS)]
    where = np.concatenate([one["place"] for one in parts])
    found = np.concatenate([one["points"] for one in parts])
    whole = np.full((where.max() + 1, 3), np.nan)
    whole[where] = found
    assert np.isfinite(whole).all() and np.array_equal(whole[where], found)
    return whole.tolist()


def table(proxy, port: int, column: str) -> list:
    rows = servermanager.Fetch(proxy, idx=port)
    return [rows.GetValueByName(row, column).ToDouble() for row in range(rows.GetNumberOfRows())]


def note(name: str, proxy) -> None:
    proxy.UpdatePipeline()
    proxy.UpdatePropertyInformation()
    results[name] = {
        "points": points_of(proxy),
        "inverted": [int(proxy.GetPropertyValue(name)) for name in ("InvertedBefore", "InvertedAfter")],
    }


for scattered in (0, 1):  # (scripts of sources import into this module: not "random")
    optimized = OptimizeMesh(Input=cube(6, 0.3, scattered), ReproducibleOrder=1)
    note(f"optimize {scattered}", optimized)
    results[f"optimize {scattered}"]["history"] = table(optimized, 1, "Objective")
    results[f"optimize {scattered}"]["mean"] = table(optimized, 2, "MeanAfter")
    slide = OptimizeMesh(Input=cube(4, 0.3, scattered), ReproducibleOrder=1)
    slide.Boundary = SLIDING
    note(f"slide {scattered}", slide)
    note(f"untangle {scattered}", UntangleMesh(Input=cube(5, 0.45, scattered), ReproducibleOrder=1))

with open(sys.argv[1], "w") as file:
    json.dump(results, file)
