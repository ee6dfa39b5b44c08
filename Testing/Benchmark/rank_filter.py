# SPDX-License-Identifier: BSD-3-Clause
"""rank_filter.py FILTER CELLS FILE: for pvbatch on any number of MPI ranks, see ranks.py.

Every rank makes a slab of a cube of tetrahedra, or the first one all of it, and the filter runs on it; what each rank
needed goes to FILE as JSON: peak memory since the mesh was there (VmHWM), CPU seconds and wall seconds of the filter.
"""

import gc
import json
import os
import sys
import time
from pathlib import Path

import numpy as np
from paraview import simple
from vtkmodules.vtkParallelCore import vtkMultiProcessController

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())
CONTROLLER = vtkMultiProcessController.GetGlobalController()
RANK, RANKS = CONTROLLER.GetLocalProcessId(), CONTROLLER.GetNumberOfProcesses()

# Runs on every rank: its slab of a cube of n^3 cubes of 6 tetrahedra each. Inner points are shifted by up to JITTER of
# an edge, by a hash of their numbers; SPIKES of them, at most, by more than an edge, which inverts tetrahedra.
SLAB = """
import itertools
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_TETRA, vtkCellArray
from vtkmodules.vtkParallelCore import vtkMultiProcessController

N, JITTER, SPIKES = {n}, 0.25, {spikes}
controller = vtkMultiProcessController.GetGlobalController()
rank, ranks = controller.GetLocalProcessId(), controller.GetNumberOfProcesses()
low, high = N * rank // ranks, N * (rank + 1) // ranks
if {first}:
    low, high = 0, 0 if rank else N
side = N + 1
number = np.arange(low * side * side, (high + 1) * side * side, dtype=np.int64)
place = np.stack([number // (side * side), number // side % side, number % side], -1)
inner = ((place > 0) & (place < N)).all(axis=1)
x = place.astype(float)
for axis in range(3):
    mixed = (number * 3 + axis + 1).astype(np.uint64) * np.uint64(0x9E3779B97F4A7C15)
    mixed = (mixed ^ (mixed >> np.uint64(29))) * np.uint64(0xBF58476D1CE4E5B9)
    shift = (mixed >> np.uint64(11)).astype(float) * 2.0**-53 - 0.5
    amount = np.where(number * 7919 % (side**3 // SPIKES) == 0, 2.4, JITTER) if SPIKES else JITTER
    x[:, axis] += inner * amount * shift
    del mixed, shift
wave = np.zeros_like(x)
wave[:, 0] = 0.1 * N * np.sin(np.pi * place[:, 1] / N) * np.sin(np.pi * place[:, 2] / N)
corner = np.arange((high - low) * N * N, dtype=np.int64)
first = corner // (N * N) * side * side + corner // N % N * side + corner % N
del corner, place, inner
steps = (side * side, side, 1)
cells = np.empty((6, len(first), 4), dtype=np.int64)
for k, order in enumerate(itertools.permutations(range(3))):
    nodes = list(itertools.accumulate((steps[a] for a in order), initial=0))
    if np.linalg.det(np.eye(3)[list(order)]) < 0:
        nodes[1], nodes[2] = nodes[2], nodes[1]
    for corner, node in enumerate(nodes):
        cells[k, :, corner] = first + node
grid = output.VTKObject
points = vtkPoints()
points.SetData(numpy_to_vtk(x, deep=True))
grid.SetPoints(points)
array = vtkCellArray()
array.SetData(numpy_to_vtkIdTypeArray(np.arange(0, cells.size + 1, 4, dtype=np.int64), deep=True),
              numpy_to_vtkIdTypeArray(cells.ravel(), deep=True))
grid.SetCells(VTK_TETRA, array)
push = numpy_to_vtk(wave, deep=True)
push.SetName("push")
grid.GetPointData().AddArray(push)
"""
# Those with a limit of iterations do as many on any number of ranks; "first": the first rank has the whole mesh.
FILTERS = {
    "quality": (0, lambda mesh: ElementQuality(mesh, Metrics=["Inverse mean ratio"])),
    "optimize": (0, lambda mesh: OptimizeMesh(mesh, ReproducibleOrder=1, MaximumIterations=3)),
    "optimize-first": (0, lambda mesh: OptimizeMesh(mesh, MaximumIterations=3)),
    "optimize-first-redistributed": (0, lambda mesh: OptimizeMesh(mesh, MaximumIterations=3, Redistribute=1)),
    "untangle": (100, lambda mesh: UntangleMesh(mesh, ReproducibleOrder=1)),
    "warp": (0, lambda mesh: WarpMesh(mesh, Motion="Displacement array", Displacement=["POINTS", "push"],
                                      Method="FEMWARP")),
    "solve": (0, lambda mesh: SolvePDE(mesh)),
    "solve-first": (0, lambda mesh: SolvePDE(mesh)),
    "solve-first-redistributed": (0, lambda mesh: SolvePDE(mesh, Redistribute=1)),
    "condition": (0, lambda mesh: ConditionEstimator(mesh, Preconditioner="None")),
    "condition-first": (0, lambda mesh: ConditionEstimator(mesh, Preconditioner="None")),
    "condition-first-redistributed": (0, lambda mesh: ConditionEstimator(mesh, Preconditioner="None", Redistribute=1)),
    "perturb": (0, lambda mesh: PerturbMesh(mesh)),
    "improve": (0, lambda mesh: ImproveMesh(mesh)),
}  # fmt: skip


def peak():
    """The most memory of this process since it was reset, in MiB."""
    lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
    return int(next(line for line in lines if line.startswith("VmHWM")).split()[1]) / 1024


def main(name, cells, file):
    spikes, make = FILTERS[name]
    n = max(2, round((int(cells) / 6) ** (1 / 3)))
    script = SLAB.format(n=n, spikes=spikes, first="first" in name)
    mesh = simple.ProgrammableSource(OutputDataSetType="vtkUnstructuredGrid", Script=script)
    mesh.UpdatePipeline()
    gc.collect()
    CONTROLLER.Barrier()
    start = peak()
    Path("/proc/self/clear_refs").write_text("5", encoding="ascii")  # VmHWM from here on
    filter_ = make(mesh)
    wall, cpu = time.perf_counter(), time.process_time()
    filter_.UpdatePipeline()
    found = {
        "rank": RANK,
        "cells": 6 * n**3,
        "before MiB": start,
        "cpu s": time.process_time() - cpu,
        "wall s": time.perf_counter() - wall,
        "peak MiB": peak(),
    }
    filter_.UpdatePropertyInformation()
    found["summary"] = filter_.GetProperty("Summary").GetData() if filter_.GetProperty("Summary") else ""
    Path(f"{file}.{RANK}").write_text(json.dumps(found), encoding="utf-8")
    CONTROLLER.Barrier()


main(*sys.argv[1:4])
