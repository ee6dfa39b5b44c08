# SPDX-License-Identifier: BSD-3-Clause
"""Pareto optimality of the scalarizations, by a front of weighted sums: sections 3.3.1 and 3.4."""

from __future__ import annotations

from typing import Sequence

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._common import MULTI, TYPICAL_C, Method, Run, failures, improve, methods
from ._meshes import points_of, scaled
from ._pairs import ITERATIONS, start_mesh
from ._report import MESQUITE_PATCH_ITERATIONS, Report, parser
from ._verdicts import Open, Verdict
from .shape_size import GOALS

CELLS, SMALL_CELLS = 20_000, 1_000
#: Weights of the size, over that with which both objectives are equal at the start.
WEIGHTS, SMALL_WEIGHTS = tuple(10.0 ** np.linspace(-3, 3, 25)), tuple(10.0 ** np.linspace(-2, 2, 5))
#: Iterations of the optimizer of the front and of the converged results, and its relative change.
LIMIT, SMALL_LIMIT, CHANGE = 3_000, 300, 1e-10
#: A point dominates another one if both of its objectives are smaller by this part of their start values: the
#: difference between two converged optimizations of one objective.
TOLERANCE = 1e-4
UNIT = 10.0  # the edges of the mesh in another unit of length
SAME = 1e-6  # over the extent of the mesh: distances of vertices that are at the same place
OPTIMIZER = "l-bfgs"


def objectives(mesh: vtkDataSet) -> tuple[float, float]:
    """The sums of squares (3.4) of IMR and size."""
    found = tautline.quality(mesh, ["imr", "size"], reversed_mesh="measure as given", threads=1)
    return tuple(float((found.values[name] ** 2).sum()) for name in ("imr", "size"))


def implied_weight(name: str, mesh: vtkDataSet) -> float:
    """The weight of the size in the weighted sum that is stationary where a scalarization is."""
    shape, size = objectives(mesh)
    implied = {"objective-product": shape / size, "exponential-sum": float(np.exp((size - shape) / TYPICAL_C))}
    return implied.get(name, 1.0)


def front(mesh: vtkDataSet, weights: Sequence[float], limit: int) -> list[Run]:
    """The minima of weighted sums of both objectives, and of each alone; weights: of the size."""
    common = dict(optimizer=OPTIMIZER, trace=False, threads=1, relative_change=CHANGE)
    runs = [improve(mesh, Method(name, name, (name,)), limit, ("imr_mean",), **common) for name in ("imr", "size")]
    for weight in weights:
        method = Method(f"weight {weight:.3g}", f"weight {weight:.3g}", ("imr",))
        runs.append(improve(mesh, method, limit, ("imr_mean",), weights=[("size", weight)], **common))
    return runs


def dominated(one: tuple[float, float], points: list[tuple[float, float]]) -> float:
    """By how much a point of the front is better than a result in both objectives, at least; below 0: none is."""
    return max(min(one[0] - other[0], one[1] - other[1]) for other in points)


def main(arguments: list[str]) -> int:
    given = parser("pareto", __doc__, CELLS).parse_args(arguments)
    report = Report("pareto", "Pareto optimality of the scalarizations (sections 3.3.1, 3.4)", given)
    cells = given.cells or (SMALL_CELLS if given.small else CELLS)
    limit = SMALL_LIMIT if given.small else LIMIT
    mesh = start_mesh(GOALS, "disk2d", cells)
    start = objectives(mesh)
    every = [m for m in methods("imr", "size", names=("IMR", "size")) if m.name in MULTI]
    exact = {m.name: improve(mesh, m, limit, ("imr_mean",), optimizer=OPTIMIZER, trace=False, threads=1, c=TYPICAL_C,
                             relative_change=CHANGE) for m in every}
    sweeps = {m.name: improve(mesh, m, ITERATIONS, ("imr_mean",), trace=False, threads=1, c=TYPICAL_C,
                              patch_iterations=MESQUITE_PATCH_ITERATIONS) for m in every}
    weights = [w * start[0] / start[1] for w in (SMALL_WEIGHTS if given.small else WEIGHTS)]
    sampled = front(mesh, sorted([*weights, *(implied_weight(n, r.mesh) for n, r in exact.items())]), limit)
    report.text(
        f"disk2d: {mesh.GetNumberOfCells():,} triangles, the mesh of the study shape_size. Objectives: sums of squares "
        "of IMR and size, relative to the start. The front is sampled by minima of weighted sums, each from the "
        f"start by {OPTIMIZER.upper()} to a relative change of {CHANGE:g}; among the weights are those that the "
        "converged results imply, where a scalarization and the weighted sum have the same gradient; converged results "
        f"the same way, results of section 3.4 by {ITERATIONS} sweeps of local conjugate gradients. A weighted sum "
        "finds convex parts of a front only, and a sample is not a proof: it can show that a result is not optimal."
    )
    relative = {r.method.name: tuple(a / b for a, b in zip(objectives(r.mesh), start))
                for r in sampled if not r.failure}
    ends = {kind: {n: tuple(a / b for a, b in zip(objectives(r.mesh), start)) for n, r in runs.items() if not r.failure}
            for kind, runs in (("converged", exact), (f"{ITERATIONS} sweeps", sweeps))}
    for runs in ({r.method.name: r for r in sampled}, exact, sweeps):
        if failures(runs):
            report.text(failures(runs))
    rows = [[name, "front", *point, float("nan")] for name, point in relative.items()]
    rows += [[name, kind, *point, dominated(point, list(relative.values()))]
             for kind, found in ends.items() for name, point in found.items()]
    report.table("front", "Objectives relative to the start, and by how much a point of the front is better in both",
                 ["method", "kind", "IMR", "size", "dominated by"], rows)
    ordered = sorted(relative.values())
    curves = {"front": tuple(zip(*ordered))}
    curves |= {f"{name}, {kind}": tuple(zip(point)) for kind, found in ends.items() for name, point in found.items()}
    report.lines("pareto", [("Objectives relative to the start", "sum of IMR^2", "sum of size^2", curves)], columns=1)
    findings(report, {kind: {n: dominated(point, list(relative.values())) for n, point in found.items()}
                      for kind, found in ends.items()}, unit_shift(mesh))
    return report.finish()


def unit_shift(mesh: vtkDataSet) -> dict[str, float]:
    """The largest distance of a vertex in the results in two units of length, over the extent, by scalarization."""
    found = {}
    for method in methods("imr", "size", names=("IMR", "size")):
        if method.name in MULTI:
            one, other = (points_of(improve(m, method, ITERATIONS, ("imr_mean",), trace=False, threads=1, c=TYPICAL_C,
                                            patch_iterations=1).mesh) for m in (mesh, scaled(mesh, UNIT)))
            found[method.name] = float(np.linalg.norm(one - other / UNIT, axis=1).max() / mesh.GetLength())
    return found


def findings(report: Report, better: dict[str, dict[str, float]], shift: dict[str, float]) -> None:
    """The findings of sections 3.3.1 and 3.4.

    better: for converged results and results after some sweeps, by how much a point of the front is better in both
    objectives; shift: the distance between results in two units of length.
    """
    for kind, found in better.items():
        source = "3.3.1" if kind == "converged" else "3.4"
        for name in MULTI:
            label = name.replace("-", " ")
            text = "is weakly Pareto optimal" + ("" if kind == "converged" else f" after {kind}")
            report.finding(source, f"The result of the {label} {text}", optimal(found, name),
                           f"a point of the front is better in both objectives by {max(found.get(name, 0.0), 0.0):.2g} "
                           "of their values at the start",
                           criterion=f"no sampled point of the front is better in both objectives by more than "
                           f"{TOLERANCE:g} of their values at the start",
                           reason="" if kind == "converged" else "the sweeps stop before they have converged")
    ours = ", ".join(f"{n} {distance:.2g}" for n, distance in shift.items())
    report.finding("3.3.1", "The objective product does not require normalization", shift["objective-product"] < SAME,
                   f"largest distance of a vertex, over the extent: {ours}",
                   criterion=f"with the mesh in another unit, in which the size is {UNIT:g}^4 times as large, vertices "
                   f"are at the same places within {SAME:g} of the extent",
                   proof="an objective multiplied by a constant multiplies the product")
    report.finding("3.3.1", "The equal sum depends on the unit of length", shift["equal-sum"] > SAME,
                   f"largest distance of a vertex, over the extent: {ours}", own=True,
                   criterion=f"in another unit, a vertex is elsewhere by more than {SAME:g} of the extent",
                   proof="the sizes, and with them the weight of their objective, are other ones")


def optimal(found: dict[str, float], name: str) -> Verdict:
    """Whether no point of the front is better in both objectives."""
    return found[name] <= TOLERANCE if name in found else Open(f"{name} failed")
