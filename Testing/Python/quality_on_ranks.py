# SPDX-License-Identifier: BSD-3-Clause
"""quality_on_ranks.py FILE: for pvbatch on any number of MPI ranks, see test_quality_on_ranks.py.

Element Quality and Perturb Mesh on cubes whose cells list their points in both orders, in pieces; the cells that are
ghosts of another part on their rank; and the order of arrays. The results go to FILE as JSON.
"""

import json
import os
import sys

from paraview import simple
from parallel_tools import RANKS, parts, update

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())
results = {"ranks": RANKS}

# Runs on every rank: its part of a cube of tetrahedra, or of a square of triangles, with inner points that are moved.
PIECES = """
import numpy as np
from rank_meshes import RANK, RANKS, add_global_ids, appended, divided, piece, simplices

N, D, KIND = {n}, {dimension}, "{kind}"
places, cells = simplices(N, D)
inner = np.logical_and(places > 0, places < N).all(axis=1)
x = np.zeros((len(places), 3))
amplitude = 0.9 if "tangled" in KIND else 0.3
x[:, :D] = places + amplitude * inner[:, None] * (np.random.default_rng(1).random(places.shape) - 0.5)
if "mixed" in KIND:  # neighbors in most places
    turned = np.logical_or(places[cells].mean(axis=1)[:, 0] < N / 2, np.arange(len(cells)) % 5 == 0)
    cells[turned, 1:3] = cells[turned, 2:0:-1]
own = divided(places[cells].mean(axis=1), "{cut}", RANKS) == RANK
if {several}:  # as readers put pieces together: each has points of its own
    halves = divided(places[cells].mean(axis=1), "tree", 3)
    grid = appended([piece(x, cells, np.logical_and(own, halves == half), {ghosts}) for half in range(3)])
else:
    grid = piece(x, cells, own, {ghosts} and RANKS > 1)
if {ids} and grid.GetNumberOfPoints():
    add_global_ids(grid)
output.VTKObject.ShallowCopy(grid)
"""


def mesh(kind: str, cut: str, n: int = 4, dimension: int = 3, **given):
    options = {"several": 0, "ghosts": 0, "ids": 0, **given}
    script = PIECES.format(kind=kind, cut=cut, n=n, dimension=dimension, **options)
    return simple.ProgrammableSource(OutputDataSetType="vtkUnstructuredGrid", Script=script)


def values(filter_, names: tuple) -> list:
    """Arrays of all cells, also of ghosts, in the order of the whole mesh; all copies of a cell must agree."""
    found: dict = {}
    for arrays in parts(filter_, sys.argv[1]):
        for number, *row in zip(arrays["cell"].tolist(), *(arrays[name].tolist() for name in names)):
            assert found.setdefault(number, row) == row, (names, number, row, found[number])
    return [row for _, row in sorted(found.items())]


def orders(filter_) -> list:
    """The names of the arrays of each part, in their order."""
    return [arrays.files for arrays in parts(update(filter_), sys.argv[1])]


for cut in ("slabs", "random"):
    for kind in ("plain", "mixed", "tangled mixed"):
        for case, given in {
            "": {}, " ids": {"ids": 1}, " ghosts": {"ghosts": 1}, " several": {"several": 1},
        }.items():  # fmt: skip
            measured = ElementQuality(mesh(kind, cut, **given), Metrics=["Inverse mean ratio"])
            results[f"quality {kind} {cut}{case}"] = values(update(measured), ("imr", "Validity"))
    for case, given in {"": {}, " several": {"several": 1}}.items():
        moved = update(PerturbMesh(mesh("mixed", cut, **given), Percentage=70))
        results[f"perturb {cut}{case}"] = [int(moved.MovablePoints), int(moved.MovedPoints), moved.Summary]
    if RANKS > 1:
        worst = OptimizeMesh(mesh("plain", cut, several=1, ghosts=1), Preset="Worst element", MaximumIterations=5)
        results[f"copies {cut}"] = values(update(worst), ("imr", "imr_before", "Validity"))
results["arrays improved"] = orders(ImproveMesh(mesh("plain", "random")))
results["arrays of a layer"] = orders(InteractionLayer(mesh("mixed", "random", n=8, dimension=2), Width=0.5))
with open(sys.argv[1], "w", encoding="utf-8") as file:
    json.dump(results, file)
