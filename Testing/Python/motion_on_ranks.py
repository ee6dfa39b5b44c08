# SPDX-License-Identifier: BSD-3-Clause
"""motion_on_ranks.py FILE: for pvbatch on any number of MPI ranks, see test_motion_on_ranks.py.

Optimizes (by sweeps, and all points at once) and untangles a cube whose parts are on all ranks, cut in slabs or at
random, and writes points, summaries and tables to FILE as JSON. So it does with cubes that are gathered on one rank,
by their settings or their pieces, and with copies of points that differ by rounding, cut also by a k-d tree.
"""

import json
import os
import sys
from pathlib import Path

import numpy as np
from paraview import servermanager, simple
from parallel_tools import RANKS, parts
from rank_meshes import CUTS

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())

# Runs on every rank: a cube of N^3 cubes of six tetrahedra each, whose inner points are moved at random.
CUBE = """
import numpy as np
from rank_meshes import RANK, RANKS, add_global_ids, divided, piece, simplices

places, cells = simplices({n})
inner = np.logical_and(places > 0, places < {n})
points = places + inner * np.random.default_rng(4).uniform(-{amplitude}, {amplitude}, places.shape)
own = divided(places[cells].mean(axis=1), "{cut}", RANKS) == RANK
{change}
grid = piece(points, cells, own)
if {ids} and grid.GetNumberOfPoints():
    add_global_ids(grid)
output.VTKObject.ShallowCopy(grid)
"""
TURN = """  # half of the cells list their points in the opposite order: with slabs, the cells of some ranks
half = points[cells].mean(axis=1)[:, 2] < {n} / 2
cells[half, :2] = cells[half, 1::-1]
"""
# The lowest rank with a point has it where it is; the copies of others differ by rounding, to larger coordinates.
SHIFT = """
lowest = np.full(len(points), RANKS)
np.minimum.at(lowest, cells, divided(places[cells].mean(axis=1), "{cut}", RANKS)[:, None])
points = points + 1e-12 * np.maximum(0, RANK - lowest)[:, None]
"""
BREAK = "points[np.flatnonzero(inner.all(axis=1))[3]] = np.nan"
# Only one rank's copy of a point: of the last rank that has the point, or of the first.
BREAK_COPY = """
point = np.flatnonzero(inner.all(axis=1))[3]
holders = divided(places[cells].mean(axis=1), "{cut}", RANKS)[(cells == point).any(axis=1)]
if RANK == holders.{which}():
    points[point] = np.nan
"""
# Runs on every rank: writes the types of the arrays of its cells to a file.
TYPES = """
import json
from rank_meshes import CONTROLLER, RANK

data = self.GetInputDataObject(0, 0).GetCellData()
arrays = [data.GetArray(i) for i in range(data.GetNumberOfArrays())]
with open("{file}." + str(RANK), "w") as out:
    json.dump({{array.GetName(): array.GetDataTypeAsString() for array in arrays}}, out)
CONTROLLER.Barrier()  # the first rank reads the files
"""
SLIDING = 1  # of the enumeration Boundary
CUSTOM = 0  # of the enumeration Preset
GLOBAL = {"L-BFGS": 5, "Newton-CG": 6}  # of the enumeration Optimizer
results = {"ranks": RANKS}


def cube(n: int, amplitude: float, scattered: bool):
    return cut_cube(n, amplitude, "random" if scattered else "slabs")


def cut_cube(n: int, amplitude: float, cut: str, change: str = "", ids: bool = False):
    script = CUBE.format(n=n, amplitude=amplitude, cut=cut, change=change.format(n=n, cut=cut), ids=ids)
    return simple.ProgrammableSource(OutputDataSetType="vtkUnstructuredGrid", Script=script)


def points_of(proxy) -> list:
    """The points in the order of the whole mesh; points of several ranks agree."""
    found = parts(proxy, sys.argv[1])
    where = np.concatenate([one["place"] for one in found])
    points = np.concatenate([one["points"] for one in found])
    assert np.array_equal(np.unique(where), np.arange(where.max() + 1)), "a point is missing"
    whole = np.empty((where.max() + 1, 3))
    whole[where] = points
    assert np.array_equal(whole[where], points, equal_nan=True)
    return whole.tolist()


def types_of(proxy) -> list:
    """The types of the arrays of the cells, by name, on each rank."""
    file = sys.argv[1] + ".types"
    simple.ProgrammableFilter(proxy, Script=TYPES.format(file=file)).UpdatePipeline()
    return [json.loads(Path(f"{file}.{rank}").read_text(encoding="utf-8")) for rank in range(RANKS)]


def table(proxy, port: int, column: str) -> list:
    rows = servermanager.Fetch(proxy, idx=port)
    return [rows.GetValueByName(row, column).ToDouble() for row in range(rows.GetNumberOfRows())]


def note(name: str, proxy) -> None:
    proxy.UpdatePipeline()
    proxy.UpdatePropertyInformation()
    results[name] = {
        "points": points_of(proxy),
        "inverted": [int(proxy.GetPropertyValue(name)) for name in ("InvertedBefore", "InvertedAfter")],
        "summary": proxy.GetPropertyValue("Summary"),
    }


for scattered in (0, 1):  # (scripts of sources import into this module: not "random")
    optimized = OptimizeMesh(Input=cube(6, 0.3, scattered), ReproducibleOrder=1)
    note(f"optimize {scattered}", optimized)
    results[f"optimize {scattered}"]["history"] = table(optimized, 1, "Objective")
    results[f"optimize {scattered}"]["mean"] = table(optimized, 2, "MeanAfter")
    for division in ("k-d Tree", "PT-Scotch"):
        divided = OptimizeMesh(Input=cube(6, 0.3, scattered), ReproducibleOrder=1, Redistribute=division)
        note(f"{division} {scattered}", divided)
    slide = OptimizeMesh(Input=cube(4, 0.3, scattered), ReproducibleOrder=1)
    slide.Boundary = SLIDING
    note(f"slide {scattered}", slide)
    for name, optimizer in GLOBAL.items():
        together = OptimizeMesh(Input=cube(4, 0.3, scattered), ReproducibleOrder=1, Preset=CUSTOM, Optimizer=optimizer)
        note(f"{name} {scattered}", together)
        results[f"{name} {scattered}"]["history"] = table(together, 1, "Objective")
    both = OptimizeMesh(Input=cube(4, 0.42, scattered), ReproducibleOrder=1, Preset=CUSTOM, Beta=0.01)
    both.NumberOfObjectives = 2
    both.Metric1, both.Metric2 = "Untangling beta", "Inverse mean ratio"
    note(f"rescaled {scattered}", both)
    note(f"untangle {scattered}", UntangleMesh(Input=cube(5, 0.45, scattered), ReproducibleOrder=1))

for cut in CUTS:
    turned = OptimizeMesh(Input=cut_cube(4, 0.3, cut, TURN, ids=True))
    note(f"turned {cut}", turned)
    results[f"turned {cut}"]["types"] = types_of(turned)
    note(f"broken {cut}", OptimizeMesh(Input=cut_cube(4, 0.3, cut, BREAK, ids=True)))
    for name, which in {"last": "max", "first": "min"}.items():
        broken = cut_cube(4, 0.3, cut, BREAK_COPY.replace("{which}", which), ids=True)
        note(f"broken {name} {cut}", OptimizeMesh(Input=broken))
    note(f"copies {cut}", OptimizeMesh(Input=cut_cube(4, 0.3, cut, SHIFT, ids=True), ReproducibleOrder=1))
    tangled = cut_cube(5, 0.45, cut, SHIFT, ids=True)
    note(f"untangled copies {cut}", UntangleMesh(Input=tangled, ReproducibleOrder=1))

with open(sys.argv[1], "w") as file:
    json.dump(results, file)
