# SPDX-License-Identifier: BSD-3-Clause
"""Errors in L2 and H1 against known solutions by metric, preconditioner and solver: open question of 2.7.1, 2.8."""

from __future__ import annotations

import argparse
import math
from typing import Any, NamedTuple, Sequence

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._memory import remembered
from ._meshes import right_triangles
from ._report import Report, parser
from ._solver_tables import METRICS
from ._solvers import order, smoothing
from ._verdicts import Open, Times, Verdict, all_of, any_of, faster, timed

REPEATS = 3
#: Numbers of cells along the sides of the meshes; of the finest one all metrics and combinations.
SIZES, SMALL_SIZES = (32, 64, 128, 256), (8, 16)
WIDTH = 0.05  # of the boundary layer
COMBINATIONS = (("cg", "jacobi"), ("gmres", "jacobi"), ("minres", "ssor"), ("cg", "ilu"), ("bicgstab", "ilu"),
                ("cg", "amg"), ("bicgstab", "amg"))
TOLERANCES = (1e-5, 1e-8)  # relative, of the linear systems; the first one is PETSc's default
FINE = 1e-10
#: Relative difference of errors that counts as none.
SAME = 0.01
ORDER_TOLERANCE = 0.2
PERTURBED = 0.5  # of the interior vertices, by up to half of the distance to inversion

class Problem(NamedTuple):
    """A known solution, as an expression of x and y, the source, and further options of solve()."""

    exact: str
    source: float | str
    options: dict[str, Any]
    #: The mesh is the square from 0 to 1, or the L-shaped domain from -1 to 1.
    corner: bool
    #: Orders in h of the errors in L2 and H1.
    orders: tuple[float, float]


_WAVE = f"sin({math.pi!r}*x)*sin({math.pi!r}*y)"
_ANGLE = f"({0.75 * math.pi!r} + atan2(-x - y, y - x))"  # from the x-axis, continuous outside the missing quadrant
PROBLEMS = {
    "smooth": Problem(_WAVE, f"{2 * math.pi**2!r}*{_WAVE}", {}, False, (2.0, 1.0)),
    "boundary layer": Problem(f"exp(-x/{WIDTH!r})", 0.0, {"pde": "elliptic", "reaction": WIDTH**-2}, False, (2.0, 1.0)),
    "corner": Problem(f"(x^2 + y^2)^(1/3)*sin(2/3*{_ANGLE})", 0.0, {}, True, (4 / 3, 2 / 3)),
}


class Result(NamedTuple):
    """The errors of a solution, nan where the solver failed, and the CPU seconds."""

    l2: float
    h1: float
    times: Times
    iterations: int
    converged: bool


def main(arguments: list[str]) -> int:
    given = parser("solution_error", __doc__, repeats=REPEATS, seeds=True).parse_args(arguments)
    sizes = SMALL_SIZES if given.small else SIZES
    report = Report("solution_error", "Errors of the solution (sections 2.7.1 and 2.8)", given)
    report.text(
        "Question: which combination of metric, preconditioner and solver gives the smallest error of the solution? "
        "Three solutions are known: a smooth one and a boundary layer on the unit square, and a singularity "
        "r^(2/3) on an L-shaped domain. Half of the interior vertices are perturbed, then the mesh is smoothed by each "
        "metric to 95 % of the possible reduction. Errors in L2 and in the H1 seminorm by Solve PDE; CPU "
        f"seconds of {given.repeats} run(s)."
    )
    for seed in report.seeds:
        for name, problem in PROBLEMS.items():
            study(report, given, name, problem, sizes, seed)
    return report.finish()


def study(report: Report, given: argparse.Namespace, name: str, problem: Problem, sizes: Sequence[int],
          seed: int) -> None:
    """The tables and findings of a problem."""
    runs = name, given.repeats, given.threads
    found = {n: solved(smoothing(initial(problem, n, seed), "imr", given.threads).mesh, *runs) for n in sizes}
    file = name.replace(" ", "_")
    report.table(f"orders_{file}", f"{name}: errors by cells along a side, IMR", ["cells", "L2", "H1"],
                 [[n, r.l2, r.h1] for n, r in found.items()])
    order_findings(report, name, {n: (r.l2, r.h1) for n, r in found.items()})
    start = initial(problem, sizes[-1], seed)
    meshes = {"perturbed": start, **{m: smoothing(start, m, given.threads).mesh for m in METRICS}}
    by_metric = {m: solved(mesh, *runs) for m, mesh in meshes.items()}
    report.table(f"metrics_{file}", f"{name}: errors by metric", ["mesh", "L2", "H1"],
                 [[m, r.l2, r.h1] for m, r in by_metric.items()])
    metric_findings(report, name, {m: (r.l2, r.h1) for m, r in by_metric.items()})
    by_solver = {(*c, t): solved(meshes["rr"], *runs, *c, t) for c in COMBINATIONS for t in TOLERANCES}
    report.table(f"solvers_{file}", f"{name}: errors by solver, preconditioner, tolerance; RR",
                 ["solver", "preconditioner", "tolerance", "L2", "H1", "iterations", "CPU s"],
                 [[*key[:2], f"{key[2]:g}", r.l2, r.h1, r.iterations, r.times.best] for key, r in by_solver.items()])
    solver_findings(report, name, by_metric["rr"].l2, by_solver)


def initial(problem: Problem, n: int, seed: int = 1) -> vtkDataSet:
    """A perturbed mesh of right triangles with n cells along a side."""
    x = np.linspace(-1.0 if problem.corner else 0.0, 1.0, n + 1)
    points, cells = right_triangles(x, x)
    if problem.corner:
        centres = points[cells].mean(axis=1)
        cells = cells[~((centres[:, 0] > 0) & (centres[:, 1] < 0))]
        used = np.unique(cells)
        cells, points = np.searchsorted(used, cells), points[used]
    return tautline.perturb(tautline.from_arrays(points, {"triangle": cells}), fraction=0.5,
                            percentage=100 * PERTURBED, seed=seed).mesh


@remembered
def solved(mesh: vtkDataSet, name: str, repeats: int, threads: int, solver: str = "cg", preconditioner: str = "amg",
           tolerance: float = FINE) -> Result:
    """Solve a problem, and measure the errors."""
    problem = PROBLEMS[name]

    def run(**more: Any) -> tautline.SolveResult:
        return tautline.solve(mesh, solver=solver, preconditioner=preconditioner, relative_tolerance=tolerance,
                              source=problem.source, given=problem.exact, gradient=False, threads=threads,
                              **problem.options, **more)

    _, times = timed(repeats, run)
    found = run(exact=problem.exact)  # which takes longer
    norms = (found.solution_error, found.gradient_error) if found.converged else (math.nan, math.nan)
    return Result(*norms, times, found.iterations, found.converged)


def order_findings(report: Report, name: str, found: dict[int, tuple[float, float]]) -> None:
    sizes = [1 / n for n in found]
    for k, norm in enumerate(("L2", "H1")):
        values = [e[k] for e in found.values()]
        failed = any(math.isnan(v) for v in values)
        rate, expected = math.nan if failed else order(sizes, values), PROBLEMS[name].orders[k]
        report.finding(f"2.7.1, {name}", f"The error in {norm} has order {expected:.3g} in h",
                       Open("a solver failed") if failed else abs(rate - expected) <= ORDER_TOLERANCE, f"{rate:.3f}",
                       criterion=f"within {ORDER_TOLERANCE:g}", own=True)


def by_more(larger: float, other: float) -> Verdict:
    """Whether an error is larger by more than counts as none; errors of solutions have no noise."""
    return Open("a solver failed") if math.isnan(larger + other) else larger > (1 + SAME) * other


def metric_findings(report: Report, name: str, found: dict[str, tuple[float, float]]) -> None:
    margin = f"by more than {SAME:.0%}, which counts as no difference"
    for k, norm in enumerate(("L2", "H1")):
        values = {m: e[k] for m, e in found.items()}
        figures = ", ".join(f"{m} {v:.4g}" for m, v in values.items())
        four = [values[m] for m in METRICS]
        report.finding(f"2.8, {name}", f"Smoothing reduces the error in {norm}, by each metric",
                       all_of(by_more(values["perturbed"], v) for v in four), figures,
                       criterion=f"smaller with each metric, {margin}", own=True)
        report.finding(f"2.8, {name}", f"The metric makes no difference to the error in {norm}",
                       Open("a solver failed") if any(map(math.isnan, four)) else max(four) <= (1 + SAME) * min(four),
                       figures, criterion=f"the largest is at most {SAME:.0%} above the smallest", own=True)
        report.finding(f"2.8, {name}", f"SS, the least efficient metric, has the largest error in {norm}",
                       all_of(by_more(values["ss"], values[m]) for m in METRICS if m != "ss"), figures,
                       criterion=f"larger than with each other metric, {margin}", own=True)


def solver_findings(report: Report, name: str, exact: float, found: dict[tuple[str, str, float], Result]) -> None:
    for tolerance in TOLERANCES:
        rows = {f"{s} + {p}": r for (s, p, t), r in found.items() if t == tolerance}
        worst = max(rows, key=lambda c: abs(rows[c].l2 / exact - 1) if rows[c].converged else 0.0)
        report.finding(f"2.7.1, {name}", "Solver and preconditioner do not affect the error in L2 with the tolerance "
                       f"{tolerance:g}", all_of(abs(r.l2 / exact - 1) <= SAME if r.converged else Open(f"{c} failed")
                                                for c, r in rows.items()),
                       f"largest difference {abs(rows[worst].l2 / exact - 1):.2%} with {worst}", own=True,
                       criterion=f"at most {SAME:.0%} from the error with the tolerance {FINE:g}")
    good = {f"{s} + {p}, {t:g}": r for (s, p, t), r in found.items() if r.converged and r.l2 <= (1 + SAME) * exact}
    ranked = sorted(good, key=lambda c: good[c].times.best)
    report.finding(f"2.8, {name}", "CG with AMG reaches the error of the discretization in the least time",
                   quickest_group(good, "cg + amg"),
                   ", ".join(f"{c} {good[c].times}" for c in ranked[:4]) or "none reaches it", own=True,
                   criterion=f"with one of the tolerances, less time than all others whose error is within {SAME:.0%}, "
                   "by more than the noise")


def quickest_group(found: dict[str, Result], start: str) -> Verdict:
    """Whether one of the combinations whose names begin so is faster than all others."""
    ours = [r.times for c, r in found.items() if c.startswith(start)]
    others = [r.times for c, r in found.items() if not c.startswith(start)]
    if not ours:
        return Open(f"{start} does not reach the error")
    return any_of(all_of(faster(one, other) for other in others) for one in ours)
