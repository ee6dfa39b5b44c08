# SPDX-License-Identifier: BSD-3-Clause
"""metrics_on_ranks.py FILE: for pvbatch on any number of MPI ranks, see test_metrics_on_ranks.py.

Metrics of a user, of a library (TAUTLINE_METRICS) and of a Python file, on a mesh whose parts are on all ranks: Element
Quality with criteria, and Optimize Mesh by the compiled one. The results go to FILE as JSON. Then the metrics that some
ranks do not have.
"""

import json
import os
import sys
from pathlib import Path

import numpy as np
import tautline
from paraview import servermanager, simple
from parallel_tools import RANKS, columns, parts, update
from rank_meshes import CUTS

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())
CUSTOM = 0  # of the enumeration Preset
METRICS = ["My distortion", "Longest edge", "Height of the center", "Slenderness"]
ARRAYS = ["my_distortion", "longest_edge", "height", "slenderness", "Validity", "Grade"]
LIMITS = ("ideal", "good", "warn", "fail", "worst")
CRITERIA = json.dumps({"name": "own", "criteria": [
    {"metric": metric, "weight": weight, "limits": {"all": dict(zip(LIMITS, limits))}}
    for metric, weight, limits in (("my_distortion", 2, (0, 0.7, 1.2, 2.5, 9)), ("slenderness", 1, (1, 1.8, 2.2, 3, 9)))
]})  # fmt: skip

# Runs on every rank: a cube of 5^3 cubes of six tetrahedra each, whose inner points are moved at random.
CUBE = """
import numpy as np
from rank_meshes import RANK, RANKS, add_global_ids, divided, piece, simplices

places, cells = simplices(5)
inner = np.logical_and(places > 0, places < 5)
points = places + inner * np.random.default_rng(4).uniform(-0.3, 0.3, places.shape)
own = divided(places[cells].mean(axis=1), "{cut}", RANKS) == RANK
grid = piece(points, cells, own, {ghosts})
add_global_ids(grid)  # the lists of the worst elements have these
output.VTKObject.ShallowCopy(grid)
"""
results = {"ranks": RANKS, "loaded": tautline.load_metrics(Path(__file__).with_name("metrics_to_load.py"))}


def cube(cut: str, ghosts: bool = False):
    script = CUBE.format(cut=cut, ghosts=ghosts)
    return simple.ProgrammableSource(OutputDataSetType="vtkUnstructuredGrid", Script=script)


def values(proxy, key: str, names: list) -> list:
    """Arrays in the order of the whole mesh; ranks that share a point agree."""
    found = {}
    for arrays in parts(proxy, sys.argv[1]):
        rows = np.concatenate([np.reshape(arrays[name], (len(arrays[key]), -1)) for name in names], axis=1)
        for number, row in zip(arrays[key].tolist(), rows.tolist()):
            assert np.allclose(found.setdefault(number, row), row, rtol=1e-12), (number, row)
    return [row for _, row in sorted(found.items())]


def tables(proxy, *ports: int) -> list:
    return [columns(servermanager.Fetch(proxy, idx=port)) for port in ports]


for cut in CUTS:
    quality = update(ElementQuality(Input=cube(cut), Metrics=METRICS, Criteria=CRITERIA))
    optimized = OptimizeMesh(Input=cube(cut), Preset=CUSTOM, ReproducibleOrder=1)
    optimized.Metric1 = optimized.WorstElementBy = "My distortion"
    update(optimized)
    results[cut] = {
        "cells": values(quality, "cell", ARRAYS),
        "cells of ranks": [len(arrays["cell"]) for arrays in parts(quality, sys.argv[1])],
        "tables": tables(quality, 1, 2, 6),
        "summary": quality.Summary,
        "points": values(optimized, "place", ["points"]),
        "history": tables(optimized, 1, 2),
    }

# Ghost cells have the grades of their originals, and do not count.
quality = update(ElementQuality(Input=cube("tree", True), Metrics=METRICS, Criteria=CRITERIA))
results["ghosts"] = {
    "cells": values(quality, "cell", [*ARRAYS, "QualityIndex"]),
    "cells of ranks": [len(arrays["cell"]) for arrays in parts(quality, sys.argv[1])],
    "tables": tables(quality, 1, 2, 6),
    "summary": quality.Summary,
}

# An objective without derivatives is rejected by sweeps.
tried = OptimizeMesh(Input=cube("slabs"), Preset=CUSTOM, Optimizer="Local Newton")
tried.Metric1 = "Slenderness"
update(tried)

# A metric that is registered on this process only: an error on all, and none waits.
tautline.register_metric("only_here", lambda corners, cell: np.ones(len(corners)), label="Only here")
rejected = {
    "quality": ElementQuality(Input=cube("random"), Metrics=["Inverse mean ratio", "Only here"]),
    "compare": CompareMeshes(Input=cube("random"), Other=cube("random"), Metrics=["Only here"]),
    "optimize": OptimizeMesh(Input=cube("random"), ReproducibleOrder=1, WorstElementBy="Only here"),
    "improve": ImproveMesh(Input=cube("random"), Metric="Only here"),
}
if RANKS > 1:
    for name, filter_ in rejected.items():
        update(filter_)
        results[f"rejected {name}"] = [filter_.GetDataInformation().GetNumberOfCells(), filter_.Summary]
    # Wrong on the last process only.
    wrong = Path(sys.argv[1]).with_suffix(".py")
    wrong.write_text(f"from rank_meshes import RANK\nassert RANK != {RANKS - 1}, 'not here'\n", encoding="utf-8")
    try:
        tautline.load_metrics(wrong)
    except tautline.Error as error:
        results["wrong"] = str(error)

with open(sys.argv[1], "w", encoding="utf-8") as file:
    json.dump(results, file)
