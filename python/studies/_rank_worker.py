# SPDX-License-Identifier: BSD-3-Clause
"""_rank_worker.py FILE FUNCTION CELLS REPEATS: the work of a rank of the study `rank_scaling`, for pvbatch --sym.

The mesh is cut in strips, one for each rank. Each rank writes the smallest wall-clock time of several runs, and its
points or cells by their numbers with the result, to FILE.RANK.npz.
"""

from __future__ import annotations

import os
import sys
import time
import traceback
from pathlib import Path

import numpy as np
import tautline
from tautline.studies._meshes import points_of, right_triangles
from vtkmodules.vtkParallelCore import vtkMultiProcessController

METRICS = ("imr", "rr", "si", "ss")
ITERATIONS = 10
SHIFT = 0.2  # of the distance of the points of the grid
TIGHT = 1e-11  # relative residual of the linear system


def main(file: str, name: str, cells: str, repeats: str) -> None:
    controller = vtkMultiProcessController.GetGlobalController()
    rank, ranks = controller.GetLocalProcessId(), controller.GetNumberOfProcesses()
    n = max(4, round((int(cells) / 2) ** 0.5))
    points, triangles = right_triangles(np.arange(n + 1.0), np.arange(n + 1.0))
    inner = ((points > 0) & (points < n)).all(axis=1)
    points = (points + inner[:, None] * np.random.default_rng(1).uniform(-SHIFT, SHIFT, points.shape)) / n
    own = np.array_split(np.arange(len(triangles)), ranks)[rank]
    used, corners = np.unique(triangles[own], return_inverse=True)
    mesh = tautline.from_arrays(points[used], {"triangle": corners.reshape(-1, 3)})

    def run() -> tuple[np.ndarray, np.ndarray]:
        if name == "optimize":
            moved = tautline.optimize(mesh, "imr", maximum_iterations=ITERATIONS, reproducible_order=True, threads=1)
            return used, points_of(moved.mesh)
        if name == "solve":
            return used, np.asarray(tautline.solve(mesh, relative_tolerance=TIGHT, threads=1).solution)
        found = tautline.quality(mesh, list(METRICS), threads=1)
        return own, np.stack([found.values[metric] for metric in METRICS], axis=1)

    numbers, values = run()  # a first run is not timed
    seconds = []
    for _ in range(int(repeats)):
        controller.Barrier()
        began = time.perf_counter()
        numbers, values = run()
        controller.Barrier()
        seconds.append(time.perf_counter() - began)
    np.savez(Path(f"{file}.{rank}.npz"), numbers=numbers, values=values, seconds=min(seconds))


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except Exception:  # the other ranks would wait for this one
        traceback.print_exc()
        sys.stderr.flush()
        os._exit(1)
