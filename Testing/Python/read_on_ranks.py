# SPDX-License-Identifier: BSD-3-Clause
"""read_on_ranks.py FILE DATA FORMATS: for pvbatch on any number of MPI ranks, see test_read_on_ranks.py.

Reads files of each format on all ranks, measures them and optimizes one, and writes counts, statistics and points to
FILE as JSON; of the files in the folder FORMATS, also check sums of all points and arrays.
"""

import hashlib
import json
import os
import sys

import numpy as np
from paraview import servermanager, simple
from parallel_tools import RANKS, parts, update

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())
FILE, DATA, FORMATS = sys.argv[1:4]
results = {"ranks": RANKS}


def opened(name: str):
    return update(simple.OpenDataFile(os.path.join(DATA, name)))


def mean_quality(mesh) -> float:
    table = servermanager.Fetch(update(ElementQuality(Input=mesh)), idx=1)
    return table.GetValueByName(0, "Mean").ToDouble()


for name in ("cube.1.ele", "part.msh", "cylinder.msh", "house.off"):
    mesh = opened(name)
    found = parts(mesh, FILE)
    if RANKS > 1:  # some cells are ghosts on other ranks
        cells = len(set(np.concatenate([part["GlobalCellIds"] for part in found]).tolist()))
    else:
        cells = mesh.GetDataInformation().GetNumberOfCells()
    results[name] = {"cells": cells, "parts": len(found), "mean": mean_quality(mesh)}


def whole(found: list, name: str, ids: str):
    """An array of the mesh, from parts that may share some of its points or cells."""
    values = np.concatenate([part[name] for part in found])
    if RANKS == 1:
        return values
    numbers = np.concatenate([part[ids] for part in found])
    result = np.zeros((numbers.max() + 1, *values.shape[1:]), values.dtype)
    result[numbers] = values
    assert np.array_equal(result[numbers], values), f"the ranks disagree about {name}"
    assert len(set(numbers.tolist())) == len(result), f"{name} has gaps"
    return result


for name in sorted(os.listdir(FORMATS)):
    if name.endswith((".node", ".sol")):
        continue
    mesh = update(simple.OpenDataFile(os.path.join(FORMATS, name)))
    found = parts(mesh, FILE)
    if not found:  # the file is damaged
        results[name] = {"parts": 0}
        continue
    sums = {"mean": mean_quality(mesh), "parts": len(found), "sizes": [len(part["Reference"]) for part in found]}
    for array in sorted(set(found[0].files) - {"GlobalPointIds", "GlobalCellIds", "vtkGhostType"}):
        of_points = len(found[0][array]) == len(found[0]["points"])
        values = whole(found, array, "GlobalPointIds" if of_points else "GlobalCellIds")
        sums[array] = hashlib.sha256(np.ascontiguousarray(values).tobytes()).hexdigest()
    results[name] = sums

mesh = opened("cube.1.ele")
optimized = OptimizeMesh(Input=mesh, ReproducibleOrder=1)
found = parts(update(optimized), FILE)
points = np.concatenate([part["points"] for part in found])
if RANKS > 1:
    ids = np.concatenate([part["GlobalPointIds"] for part in found])
    whole = np.full((ids.max() + 1, 3), np.nan)
    whole[ids] = points
    assert np.array_equal(whole[ids], points), "the ranks disagree about a point"
    points = whole
results["optimized"] = points.tolist()

with open(FILE, "w") as file:
    json.dump(results, file)
