# SPDX-License-Identifier: BSD-3-Clause
"""Wall-clock times of optimize(), warp(), solve() and quality() by the number of threads (chapter 6)."""

from __future__ import annotations

import os
import time
from typing import Callable, Sequence

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._memory import remembered
from ._meshes import points_of
from ._report import Report, parser
from ._verdicts import Open, Verdict, all_of

_CELLS, _SMALL_CELLS = 200_000, 5_000
_ITERATIONS = 10  # of optimize()
_METRICS = ("imr", "rr", "si", "ss")
_REPEATS = 3


def _optimize(mesh: vtkDataSet, threads: int) -> np.ndarray:
    found = tautline.optimize(mesh, "imr", maximum_iterations=_ITERATIONS, threads=threads)
    return points_of(found.mesh)


def _warp(mesh: vtkDataSet, threads: int) -> np.ndarray:
    p = points_of(mesh)
    # The domain is sheared, which moves all of its boundary.
    motion = np.column_stack([0.1 * p[:, 1], np.zeros(len(p)), np.zeros(len(p))])
    return points_of(tautline.warp(mesh, motion, threads=threads).mesh)


def _solve(mesh: vtkDataSet, threads: int) -> np.ndarray:
    return np.asarray(tautline.solve(mesh, threads=threads).solution)


def _quality(mesh: vtkDataSet, threads: int) -> np.ndarray:
    found = tautline.quality(mesh, list(_METRICS), threads=threads)
    return np.concatenate([found.values[name] for name in _METRICS])


#: The timed work, by the name of the function.
WORKS: dict[str, Callable[[vtkDataSet, int], np.ndarray]] = {
    "optimize": _optimize, "warp": _warp, "solve": _solve, "quality": _quality}


@remembered
def measured(work: str, mesh: vtkDataSet, threads: int, repeats: int) -> tuple[float, np.ndarray]:
    """The least wall-clock seconds of several runs, and the result of the last one; a first run is not timed."""
    seconds = []
    WORKS[work](mesh, threads)
    for _ in range(repeats):
        began = time.perf_counter()
        result = WORKS[work](mesh, threads)
        seconds.append(time.perf_counter() - began)
    return min(seconds), result


def main(arguments: Sequence[str]) -> int:
    made = parser("thread_scaling", __doc__, cells=_CELLS, threads=0, repeats=_REPEATS)
    given = made.parse_args(arguments)
    report = Report("thread_scaling", "Times by the number of threads (chapter 6)", given)
    report.text("Subject: the speed-up of mesh optimization by threads. Wall-clock seconds, the least of "
                f"{given.repeats} runs; the number of cores is {os.cpu_count()}. Speed-ups are of this machine; the "
                "criterion is that the results do not depend on the number of threads.")
    domain = tautline.domain("disk2d", given.cells or (_SMALL_CELLS if given.small else _CELLS))
    mesh = tautline.perturb(domain, seed=1, threads=given.threads).mesh
    most = given.threads or os.cpu_count() or 1
    counts = sorted({1, *(2**k for k in range(1, most.bit_length()) if 2**k <= most), most})
    if most == 1:
        counts.append(2)  # threads of one core: no speed-up, but results to compare
    found = {work: {n: measured(work, mesh, n, given.repeats) for n in counts} for work in WORKS}
    cells = mesh.GetNumberOfCells()
    report.table("seconds", f"Wall-clock seconds by the number of threads, {cells:,} triangles",
                 ["function", *map(str, counts), *(f"speed-up {n}" for n in counts[1:])],
                 [[work, *(s for s, _ in row.values()), *(row[1][0] / max(row[n][0], np.finfo(float).tiny)
                                                         for n in counts[1:])] for work, row in found.items()])
    report.lines("thread_scaling", [("speed-up", "threads", "times", {work: (counts, [row[1][0] / max(
        row[n][0], np.finfo(float).tiny) for n in counts]) for work, row in found.items()})], columns=1)
    same_findings(report, {work: {n: result for n, (_, result) in row.items()} for work, row in found.items()})
    return report.finish()


def same(results: dict[int, np.ndarray]) -> Verdict:
    """Whether results are the same to the last bit with each number of threads."""
    first, *others = results.values()
    if not others:
        return Open("there is one number of threads only")
    return all_of(bool(np.array_equal(first, other)) for other in others)


def same_findings(report: Report, found: dict[str, dict[int, np.ndarray]]) -> None:
    """The results by the number of threads."""
    for work, results in found.items():
        first = next(iter(results.values()))
        apart = max((float(np.max(np.abs(first - other))) for other in results.values()), default=0.0)
        report.finding("6", f"{work}(): the result does not depend on the number of threads", same(results),
                       f"largest difference {apart:.3g} with {', '.join(map(str, results))} threads", own=True,
                       criterion="the same to the last bit")
