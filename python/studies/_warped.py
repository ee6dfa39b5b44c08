# SPDX-License-Identifier: BSD-3-Clause
"""Shared by the studies of section 3.5: meshes deformed by the motion of their boundary, and their untangling."""

from __future__ import annotations

import argparse
from typing import Sequence

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline
from tautline._errors import Error

from ._common import QUALITY_MARGIN, TYPICAL_C, Run, judged, patch_option
from ._meshes import points_of, sizes_of, with_points
from ._report import Report, parser
from ._tangled import NOTE, inverted_table, tangled_methods, untangle
from ._verdicts import all_of, less

QUANTITIES = ("si_mean", "si_worst", "imr_mean", "imr_worst")
ABOUT = (
    "Only the motion of the boundary is given; interior vertices follow by one step of FEMWARP."
)
_BISECTIONS = 60
#: The relative difference of the numbers of cells of meshes with successive seeds; their generators have no seed.
_SEED_STEP = 0.02


def of_points(mesh: vtkDataSet, name: str) -> np.ndarray:
    """A point array of the mesh."""
    return np.array(vtk_to_numpy(mesh.GetPointData().GetArray(name)))


def harmonic(mesh: vtkDataSet, given: np.ndarray) -> np.ndarray:
    """A motion of the boundary points (n x 3), extended to the interior points by FEMWARP."""
    return points_of(tautline.warp(mesh, given, method="femwarp").mesh) - points_of(mesh)


def warp(
    mesh: vtkDataSet, points: np.ndarray, motion: np.ndarray, inverted: int, limit: float
) -> tuple[vtkDataSet, float]:
    """The mesh at points + t motion with the smallest t up to `limit` that inverts this number of elements, and t."""

    def moved(amount: float) -> tuple[vtkDataSet, int]:
        result = with_points(mesh, points + amount * motion)
        return result, int(np.count_nonzero(sizes_of(result) <= 0))

    low, high = 0.0, limit
    if moved(high)[1] < inverted:
        raise Error(f"{limit:g} times the motion inverts {moved(high)[1]} elements only, not {inverted}")
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if moved(middle)[1] >= inverted else (middle, high)
    return moved(high)[0], high


def seeded(cells: int, seed: int) -> int:
    """The number of cells of the mesh with a seed: as given with seed 1, then some more and some fewer in turn."""
    return round(cells * (1.0 + _SEED_STEP * (seed // 2) * (-1) ** seed))


def options(name: str, text: str | None, arguments: Sequence[str]) -> argparse.Namespace:
    made = parser(name, text, steps=True, seeds=True)
    patch_option(made)
    return made.parse_args(arguments)


def experiment(report: Report, mesh: vtkDataSet, motion: str, unit: str, iterations: int, steps: Sequence[int],
               theirs: dict, given: argparse.Namespace) -> dict[str, Run]:
    """Run every method, write tables and curves; `motion` and `unit` (of length) are texts for the report."""
    wrong = np.count_nonzero(sizes_of(mesh) <= 0)
    report.text(
        f"{mesh.GetNumberOfCells():,} elements, {wrong} inverted by {motion}. {ABOUT}\n"
        f"{NOTE}\n"
        f"Local Polak-Ribiere conjugate gradients, {given.patch_iterations} steps per vertex and iteration; c = "
        f"{TYPICAL_C:g}. Unit of length: {unit} (the dissertation has none; exponential and equal sum depend on it)."
    )
    common = dict(threads=given.threads, patch_scalarization=given.patch_scalarization)
    every = tangled_methods("si", "untangle_beta")
    runs = {
        m.name: untangle(mesh, m, iterations, QUANTITIES, patch_iterations=given.patch_iterations, **common)
        for m in every
    }
    newton = {m.name: untangle(mesh, m, iterations, QUANTITIES, optimizer="newton", **common) for m in every}
    inverted_table(report, "inverted", "Inverted elements by iterations, local NLCG", runs, steps, theirs)
    inverted_table(report, "inverted_newton", "Inverted elements by iterations, Local Newton", newton, steps, theirs)
    sus = tautline.untangle(mesh, threads=given.threads)
    report.text(f"Untangle Mesh on the same mesh: {sus.inverted_before} inverted before, {sus.inverted} after.")
    rows = [["start", *(runs["si"].first(q) for q in QUANTITIES)]]
    rows += [[r.method.label, *(r.last(q) for q in QUANTITIES)] for r in runs.values()]
    report.table(
        "quality", f"Quality of the valid elements after {iterations} iterations", ["method", *QUANTITIES], rows,
    )
    report.curves("curves", [*runs.values(), *newton.values()])
    report.plot(
        "inverted", list(runs.values()), [("inverted", "Inverted elements", False), ("si_worst", "Worst SI", True)],
    )
    return runs


def better_worst(report: Report, runs: dict[str, Run], source: str) -> None:
    """Add the finding of both studies."""
    names = ("exponential-sum", "equal-sum", "untangle")
    *both, alone = (runs[n].last("si_worst") for n in names)
    report.finding(source, "Exponential and equal sum have a better worst element than untangling alone",
                   judged(runs, names, all_of(less(alone, worst, QUALITY_MARGIN) for worst in both)),
                   "worst SI: " + ", ".join(f"{n} {r.last('si_worst'):.4g}" for n, r in runs.items()),
                   criterion="the worst SI of the valid elements at the end is larger by more than "
                   f"{QUALITY_MARGIN:.0%}")
