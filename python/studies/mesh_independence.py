# SPDX-License-Identifier: BSD-3-Clause
"""Independence of the solution from mesh size, metric and solver: section 2.7.1, accuracy of the solution."""

from __future__ import annotations

from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._meshes import cells_of, sizes_of
from ._report import Report
from ._solver_tables import METRICS
from ._solvers import DOMAINS, PDES, SIZES, TITLES, initial_mesh, options, size_of, smoothed
from .smoothing_times import BINS, angles

SMALL_SIZES = (500, 1_000, 2_000)
#: Combinations of which the solutions are compared: one of each method and of each preconditioner.
SOLVES = (("cg", "jacobi"), ("gmres", "ssor"), ("minres", "ilu"), ("bicgstab", "amg"))
#: Relative, of the linear systems: the studies of times stop at 1e-5, which errors of the discretization exceed.
RESIDUAL = 1e-8
#: Relative differences of the mean solution to that on the finest mesh, and among metrics and solvers.
SAME_SOLUTION, SAME_SOLVER = 0.01, 1e-4
#: Largest difference in the share of the angles in a range, in percent.
SAME_ANGLES = 5.0


def mean(mesh: vtkDataSet, pde: str, threads: int, solver: tuple[str, str] = SOLVES[-1]) -> float:
    """The mean of the solution over the domain; of elasticity of its first component."""
    result = tautline.solve(mesh, solver=solver[0], preconditioner=solver[1], relative_tolerance=RESIDUAL,
                            gradient=False, threads=threads, **PDES[pde])
    values = result.solution if result.solution.ndim == 1 else result.solution[:, 0]
    areas = np.abs(sizes_of(mesh))
    return float((values[cells_of(mesh)].mean(axis=1) * areas).sum() / areas.sum())


def main(arguments: list[str]) -> int:
    given = options("mesh_independence", __doc__).parse_args(arguments)
    largest = size_of(given)
    sizes = [n for n in (SMALL_SIZES if given.small else SIZES) if n <= largest or given.small]
    report = Report("mesh_independence", "Mesh independence (section 2.7.1)", given.out, given.small)
    report.text(
        "Meshes smoothed by IMR to 95 % of the possible reduction with " + ", ".join(f"{n:,}" for n in sizes) +
        f" vertices; the mean of the solution over the domain, systems solved to {RESIDUAL:g}. On the coarsest mesh "
        "all four metrics and four pairs of solver and preconditioner."
    )
    for domain in given.domain or DOMAINS:
        meshes = {n: smoothed(initial_mesh(domain, n), "imr", given.threads) for n in sizes}
        shares = {n: angles(mesh) for n, mesh in meshes.items()}
        report.table(f"angles_{domain}", f"Angles in percent, {domain}", ["vertices", *BINS],
                     [[f"{n:,}", *row] for n, row in shares.items()])
        by_metric = {m: smoothed(initial_mesh(domain, sizes[0]), m, given.threads) for m in METRICS}
        found: dict[str, Any] = {}
        for pde in given.pde or PDES:
            found[pde] = {
                "size": {n: mean(mesh, pde, given.threads) for n, mesh in meshes.items()},
                "metric": {m: mean(mesh, pde, given.threads) for m, mesh in by_metric.items()},
                "solver": {" + ".join(s): mean(meshes[sizes[0]], pde, given.threads, s) for s in SOLVES},
            }
            for what, values in found[pde].items():
                report.table(f"{pde}_{domain}_{what}", f"Mean of the solution by {what}, {TITLES[pde]}, {domain}",
                             list(map(str, values)), [list(values.values())])
        findings(report, domain, found, shares)
    return report.finish()


def spread(values: dict) -> float:
    """The largest relative difference to the last value."""
    reference = list(values.values())[-1]
    return max(abs(v / reference - 1) for v in values.values())


def findings(report: Report, domain: str, found: dict[str, dict[str, dict]], shares: dict[int, list[float]]) -> None:
    where = f"2.7.1, {domain}"
    for what, sentence, limit in (
        ("size", "The solution is independent of the mesh size", SAME_SOLUTION),
        ("metric", "The solution is not affected by the metric", SAME_SOLUTION),
        ("solver", "The solution is not affected by solver and preconditioner", SAME_SOLVER),
    ):
        differences = {pde: spread(values[what]) for pde, values in found.items()}
        report.finding(where, f"{sentence} (mean within {limit:g})", all(d <= limit for d in differences.values()),
                       ", ".join(f"{pde} {d:.2g}" for pde, d in differences.items()))
    rows = np.array(list(shares.values()))
    difference = float(np.ptp(rows, axis=0).max())
    report.finding(where, f"The angle distribution is independent of the mesh size (within {SAME_ANGLES:g} percent "
                   "points)", difference <= SAME_ANGLES, f"up to {difference:.2f}")
