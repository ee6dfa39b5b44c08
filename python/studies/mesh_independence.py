# SPDX-License-Identifier: BSD-3-Clause
"""Independence of the solution from mesh size, metric and solver: section 2.7.1, accuracy of the solution."""

from __future__ import annotations

import argparse
import math
from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._memory import remembered
from ._meshes import cells_of, sizes_of
from ._report import Report
from ._solver_tables import CELLS, METRICS
from ._solvers import DOMAINS, PDES, TITLES, initial_mesh, options, sizes_up_to, smoothed
from ._verdicts import Open, Verdict, all_of, close
from .smoothing_times import BINS, angles

#: Combinations of which the solutions are compared: one of each method and of each preconditioner.
SOLVES = (("cg", "jacobi"), ("gmres", "ssor"), ("minres", "ilu"), ("bicgstab", "amg"))
#: Relative residuals of the linear systems: of PETSc's default, and one that leaves an error far below the tolerance of
#: the means, with condition numbers up to 1e6.
DEFAULT, RESIDUAL = 1e-5, 1e-10
#: Means of the solution are the same within this relative difference.
SAME_SOLUTION = 0.01
#: Largest difference in the share of the angles in a range, in percentage points.
SAME_ANGLES = 5.0
#: Table 2.4: the numbers of vertices.
VERTICES = {
    "wrench": {10_000: 10_142, 50_000: 50_161, 100_000: 100_267, 200_000: 199_981, 500_000: 499_340},
    "hinge": {10_000: 9_989, 50_000: 49_986, 100_000: 99_949, 200_000: 200_894, 500_000: 498_978},
}
#: The varied choices: the sentence, and the reference of "the same".
CLAIMS = {
    "size": ("The solution is independent of the mesh size", "the finest mesh"),
    "metric": ("The solution is not affected by the metric", "the last metric"),
    "solver": ("The solution is not affected by solver and preconditioner", "the last combination"),
}


@remembered
def mean(mesh: vtkDataSet, pde: str, threads: int, solver: tuple[str, str] = SOLVES[-1],
         residual: float = RESIDUAL) -> float:
    """The mean of the solution over the domain, of elasticity of its first component; nan: not converged."""
    result = tautline.solve(mesh, solver=solver[0], preconditioner=solver[1], relative_tolerance=residual,
                            gradient=False, threads=threads, **PDES[pde])
    if not result.converged:
        return math.nan
    values = result.solution if result.solution.ndim == 1 else result.solution[:, 0]
    areas = np.abs(sizes_of(mesh))
    return float((values[cells_of(mesh)].mean(axis=1) * areas).sum() / areas.sum())


def main(arguments: list[str]) -> int:
    given = options("mesh_independence", __doc__).parse_args(arguments)
    if given.elasticity_size:
        raise tautline.Error("--elasticity-size: this study compares the problems on the same meshes")
    sizes = sizes_up_to(given)
    report = Report("mesh_independence", "Mesh independence (section 2.7.1)", given)
    report.text(
        "Meshes smoothed by IMR to 95 % of the possible reduction with " + ", ".join(f"{n:,}" for n in sizes) +
        f" vertices; the mean of the solution over the domain, systems solved to {RESIDUAL:g}. On the coarsest mesh "
        f"all four metrics and four pairs of solver and preconditioner, these also with PETSc's default, {DEFAULT:g}."
    )
    for seed in report.seeds:
        counts: dict[str, list[int]] = {}
        for domain in given.domain or DOMAINS:
            counts |= study(report, given, domain, sizes, seed)
        printed = {f"{d} ({n // 1000}K)": (VERTICES[d][n], CELLS[d][n]) for d in DOMAINS for n in CELLS[d]}
        report.beside("table_2_4", "Table 2.4, numbers of vertices and triangles", ("vertices", "triangles"), counts,
                      printed, head="mesh")
    return report.finish()


def study(report: Report, given: argparse.Namespace, domain: str, sizes: list[int], seed: int) -> dict[str, list[int]]:
    """The tables and findings of a domain; the numbers of vertices and triangles of its meshes."""
    meshes = {n: smoothed(initial_mesh(domain, n, seed), "imr", given.threads) for n in sizes}
    shares = {n: angles(mesh) for n, mesh in meshes.items()}
    report.table(f"angles_{domain}", f"Angles in percent, {domain}", ["vertices", *BINS],
                 [[f"{n:,}", *row] for n, row in shares.items()])
    by_metric = {m: smoothed(initial_mesh(domain, sizes[0], seed), m, given.threads) for m in METRICS}
    found: dict[str, Any] = {}
    for pde in given.pde or PDES:
        solves = {residual: {" + ".join(s): mean(meshes[sizes[0]], pde, given.threads, s, residual) for s in SOLVES}
                  for residual in (RESIDUAL, DEFAULT)}
        found[pde] = {
            "size": {n: mean(mesh, pde, given.threads) for n, mesh in meshes.items()},
            "metric": {m: mean(mesh, pde, given.threads) for m, mesh in by_metric.items()},
            "solver": solves[RESIDUAL],
            "default": {"exact": solves[RESIDUAL][" + ".join(SOLVES[-1])], **solves[DEFAULT]},
        }
        for what, values in found[pde].items():
            report.table(f"{pde}_{domain}_{what}", f"Mean of the solution by {what}, {TITLES[pde]}, {domain}",
                         list(map(str, values)), [list(values.values())])
    findings(report, domain, found, shares)
    return {f"{domain} ({n // 1000}K)": [m.GetNumberOfPoints(), m.GetNumberOfCells()] for n, m in meshes.items()}


def same(values: dict, reference: object) -> Verdict:
    """Whether all values are the reference within the tolerance of the means."""
    return all_of(close(v, values[reference], SAME_SOLUTION) for key, v in values.items() if key != reference)


def difference(values: dict, reference: object) -> float:
    """The largest relative difference from the reference."""
    return max((abs(v / values[reference] - 1) for key, v in values.items() if key != reference), default=math.nan)


def findings(report: Report, domain: str, found: dict[str, dict[str, dict]], shares: dict[int, list[float]]) -> None:
    where = f"2.7.1, {domain}"
    for what, (sentence, reference) in CLAIMS.items():
        last = {pde: list(values[what])[-1] for pde, values in found.items()}
        report.finding(where, sentence, all_of(same(values[what], last[pde]) for pde, values in found.items()),
                       ", ".join(f"{pde} {difference(v[what], last[pde]):.2g}" for pde, v in found.items()),
                       criterion=f"the mean of the solution differs by at most {SAME_SOLUTION:.0%} from the mean of "
                       f"{reference}; systems solved to {RESIDUAL:g}")
    report.finding(where, "PETSc's default tolerance is enough for a solution that does not depend on the solver",
                   all_of(same(values["default"], "exact") for values in found.values()),
                   ", ".join(f"{pde} {difference(v['default'], 'exact'):.2g}" for pde, v in found.items()),
                   criterion=f"with {DEFAULT:g} the mean differs by at most {SAME_SOLUTION:.0%} from the mean of "
                   f"systems solved to {RESIDUAL:g}", own=True)
    rows = np.array(list(shares.values()))
    largest = float(np.ptp(rows, axis=0).max())
    report.finding(where, "The angle distribution is independent of the mesh size",
                   largest <= SAME_ANGLES if len(rows) > 1 else Open("there is one size only"), f"up to {largest:.2f}",
                   criterion=f"the share of the angles in each range differs by at most {SAME_ANGLES:g} percentage "
                   "points")
