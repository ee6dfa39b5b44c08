# SPDX-License-Identifier: BSD-3-Clause
"""warp_on_ranks.py FILE: for pvbatch on any number of MPI ranks, see test_warp_on_ranks.py.

Warp Mesh over time steps, and to targets that are cut in another way than the mesh; points, in the order of the whole
mesh, and summaries go to FILE as JSON.
"""

import json
import os
import sys

import numpy as np
from paraview import simple
from parallel_tools import RANKS, parts, update
from rank_meshes import CUTS

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())
TIMES = (2.0, 0.0, 3.0, 1.0)
results = {"ranks": RANKS}

STEPS = """
executive = self.GetExecutive()
info = executive.GetOutputInformation(0)
info.Remove(executive.TIME_STEPS())
for time in range(4):
    info.Append(executive.TIME_STEPS(), time)
info.Remove(executive.TIME_RANGE())
info.Append(executive.TIME_RANGE(), 0)
info.Append(executive.TIME_RANGE(), 3)
"""
# Runs on every rank: its part of a jittered cube of tetrahedra that is sheared with time, or whose array `push` is.
PIECES = """
import numpy as np
from rank_meshes import RANK, RANKS, add_array, add_global_ids, divided, piece, simplices

N, CUT, TIME, WRONG = 4, "{cut}", {time}, {wrong}
if TIME is None:
    executive = self.GetExecutive()
    info = executive.GetOutputInformation(0)
    TIME = info.Get(executive.UPDATE_TIME_STEP()) if info.Has(executive.UPDATE_TIME_STEP()) else 0.0
takers = RANKS - 1 if RANKS > 3 else RANKS  # of more than three, the last has nothing
places, cells = simplices(N)
inner = np.logical_and(places > 0, places < N).all(axis=1)
x = places / N + 0.3 / N * inner[:, None] * (np.random.default_rng(1).random(places.shape) - 0.5)
own = np.full(len(cells), RANK == 0)
if CUT != "first":
    own = divided(x[cells].mean(axis=1), CUT, takers) == RANK
push = TIME * np.stack([0.08 * x[:, 1] ** 2, 0.02 * x[:, 2] * x[:, 0], 0.04 * x[:, 1] * x[:, 0]], -1)
now = x + {moves} * push
grid = piece(now, cells, own, {ghosts} and RANKS > 1)
if grid.GetNumberOfPoints():
    if WRONG and TIME == 2 and RANK == takers - 1:
        grid.GetPoints().SetPoint(0, np.nan, 0, 0)
    add_array(grid.GetPointData(), "push", push[np.array(grid.GetPointData().GetArray("place"))])
    add_global_ids(grid)
output.VTKObject.ShallowCopy(grid)
"""


def mesh(cut: str, moves: int = 1, time: object = None, ghosts: int = 0, wrong: int = 0):
    script = PIECES.format(cut=cut, moves=moves, time=time, ghosts=ghosts, wrong=wrong)
    source = simple.ProgrammableSource(OutputDataSetType="vtkUnstructuredGrid", Script=script)
    if time is None:
        source.ScriptRequestInformation = STEPS
    return source


def points_of(filter_) -> list:
    """The points in the order of the whole mesh; ranks that share a point agree."""
    found = {}
    for arrays in parts(filter_, sys.argv[1]):
        for number, point in zip(arrays["place"].tolist(), arrays["points"].tolist()):
            assert found.setdefault(number, point) == point, (number, point, found[number])
    return [point for _, point in sorted(found.items())]


def note(name: str, warped, time=None) -> None:
    warped.UpdatePipeline(time) if time is not None else warped.UpdatePipeline()
    warped.UpdatePropertyInformation()
    results[name] = {"points": points_of(warped), "summary": warped.Summary, "inverted": int(warped.Inverted)}


for cut in CUTS:  # (scripts of sources import into this module: "number" would be one of numpy)
    other = CUTS[CUTS.index(cut) - 1]
    for start in ("First time step", "Previous time step"):
        options = {"StartFrom": start, "Method": "FEMWARP"}
        steps = WarpMesh(mesh(cut, ghosts=int(cut == "tree")), Motion="Time steps of the input", **options)
        pushed = WarpMesh(mesh(cut, 0), Motion="Displacement array", Displacement=["POINTS", "push"], **options)
        followed = WarpMesh(mesh(cut, 0, 0.0), Motion="Target data set", Target=mesh(other), **options)
        for time in TIMES:
            note(f"steps, {start}, {time:g}, {cut}", steps, time)
            note(f"array, {start}, {time:g}, {cut}", pushed, time)
            note(f"target, {start}, {time:g}, {cut}", followed, time)
    still, moved = mesh(cut, 0, 0.0), mesh(other, 1, 3.0, ghosts=1)
    to = {"Motion": "Target data set", "Method": "FEMWARP"}
    note(f"same mesh, {cut}", WarpMesh(still, Target=moved, Correspondence="Same mesh", **to))
    note(f"numbers, {cut}", WarpMesh(still, Target=moved, TargetIds="place", **to))
    surface = simple.ExtractSurface(moved)
    note(f"boundary, {cut}", WarpMesh(still, Target=surface, **to))

# Coordinates that are not finite on one rank at a time on the way.
wrong = WarpMesh(mesh("slabs", wrong=1), Motion="Time steps of the input", StartFrom="Previous time step")
wrong.UpdatePipeline(3.0)
results["rejected"] = update(wrong).GetDataInformation().GetNumberOfCells()
note("after", WarpMesh(mesh("slabs"), Motion="Time steps of the input", Method="FEMWARP"), 3.0)

with open(sys.argv[1], "w", encoding="utf-8") as out:
    json.dump(results, out)
