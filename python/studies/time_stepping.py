# SPDX-License-Identifier: BSD-3-Clause
"""Heat and wave equations: orders of the schemes, and solvers over many steps; open question of section 2.8."""

from __future__ import annotations

import math
import time
from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._memory import remembered
from ._report import Report, parser
from ._solvers import initial_mesh, order, smoothed, vertices
from ._verdicts import Open, Times, Verdict, faster, quickest
from .peridynamics_local import grid

SIZE, SMALL = 100_000, 1_000  # vertices
REPEATS = 3
#: Order in time of each scheme, and how far the measured one may be off.
ORDERS = {"backward euler": 1, "bdf2": 2, "crank-nicolson": 2, "newmark": 2}
ORDER_TOLERANCE = 0.1
#: For the measured orders: 1/h of the grid, end of the time, numbers of steps.
GRID, END, STEPS = 16, 0.1, (20, 40, 80)
EXACT = 1e-12  # relative tolerance of the linear systems there
#: Solver and preconditioner; of Table 2.5 the methods for symmetric positive definite matrices.
COMBINATIONS = (("cg", "jacobi"), ("cg", "ssor"), ("cg", "icc"), ("cg", "amg"), ("minres", "jacobi"), ("gmres", "ilu"),
                ("bicgstab", "ilu"), ("direct", "none"))
CG_AMG, DIRECT = "cg + amg", "direct"
#: Equation by name: scheme, time step as a part of the domain's size (of its square for the heat equation).
EQUATIONS = {"heat": ("bdf2", 1e-5), "wave": ("newmark", 1e-2)}
FEW, MANY = 1, 100  # steps
BULGE = "exp(-20*((x-{x:g})^2+(y-{y:g})^2)/{square:g})"

#: CPU seconds by combination.
Row = dict[str, Times]


def main(arguments: list[str]) -> int:
    made = parser("time_stepping", __doc__, repeats=REPEATS)
    made.add_argument("--size", type=vertices, default=0, metavar="N", help=f"vertices (default: {SIZE // 1000}K)")
    given = made.parse_args(arguments)
    report = Report("time_stepping", "Time-dependent problems (section 2.8)", given)
    report.text(
        "Question: which combination of preconditioner and solver is the fastest for time-dependent problems, "
        "where the matrix stays and each step starts from the steps before? Heat equation by BDF2, wave equation by "
        f"Newmark's method, on the wrench smoothed by IMR, {FEW} and {MANY} steps; CPU seconds with assembly and "
        f"set-up, {given.repeats} run(s). Orders in time on a grid with 1/h = {GRID}, against the exact solution in "
        "time of an eigenmode."
    )
    errors = {scheme: [error(scheme, n, given.threads) for n in STEPS] for scheme in ORDERS}
    orders = {scheme: order([END / n for n in STEPS], row) for scheme, row in errors.items()}
    report.table("orders", "Error at the end by number of steps, and order in time",
                 ["scheme", *(f"{n} steps" for n in STEPS), "order"], [[s, *errors[s], orders[s]] for s in ORDERS])
    order_findings(report, orders)
    mesh = smoothed(initial_mesh("wrench", given.size or (SMALL if given.small else SIZE)), "imr", given.threads)
    rows, counts = {}, {}
    runs = given.repeats, given.threads
    for equation in EQUATIONS:
        for steps in (FEW, MANY):
            rows[equation, steps], counts[equation, steps] = timed(mesh, equation, steps, *runs)
    masses = {mass: timed(mesh, "heat", MANY, *runs, (("cg", "jacobi"),), mass)[0] for mass in ("consistent", "lumped")}
    stationary = timed(mesh, "stationary", 0, *runs)[0]
    names = list(stationary)
    headings = ["combination", "stationary", *(f"{e}, {n} steps" for e, n in rows)]
    report.table("seconds", f"CPU seconds, {mesh.GetNumberOfPoints():,} vertices", headings,
                 [[c, best(stationary, c), *(best(row, c) for row in rows.values())] for c in names])
    report.table("iterations", "Iterations of all steps", ["combination", *headings[2:]],
                 [[c, *(row.get(c, math.nan) for row in counts.values())] for c in names])
    findings(report, stationary, rows, masses)
    return report.finish()


def best(row: Row, name: str) -> float:
    return row[name].best if name in row else math.nan


@remembered
def error(scheme: str, steps: int, threads: int) -> float:
    """The largest error of an eigenmode of lumped elements at the end, over its start."""
    mesh = grid(GRID, 1)
    value = 8 * GRID**2 * math.sin(math.pi / (2 * GRID)) ** 2
    exact = math.cos(math.sqrt(value) * END) if scheme == "newmark" else math.exp(-value * END)
    found = tautline.solve(mesh, time_scheme=scheme, time_step=END / steps, time_steps=steps, mass="lumped", source=0.0,
                           initial="sin(3.14159265358979*x)*sin(3.14159265358979*y)", relative_tolerance=EXACT,
                           gradient=False, threads=threads)
    return abs(float(np.max(np.abs(found.solution))) - abs(exact))


@remembered
def timed(mesh: vtkDataSet, equation: str, steps: int, repeats: int, threads: int, combinations: tuple = COMBINATIONS,
          mass: str = "consistent") -> tuple[Row, dict[str, int]]:
    """CPU seconds and iterations of the combinations that converge in all runs."""
    low, high = (np.array(mesh.GetBounds())[k::2][:2] for k in (0, 1))
    size = float(np.max(high - low))
    problem: dict[str, Any] = {"source": 1.0}
    if equation in EQUATIONS:
        scheme, step = EQUATIONS[equation]
        x, y = 0.5 * (low + high)
        problem = {"source": 0.0, "time_scheme": scheme, "time_steps": steps, "mass": mass,
                   "time_step": step * (size**2 if equation == "heat" else size),
                   "initial": BULGE.format(x=x, y=y, square=size**2)}
    times, counts = {}, {}
    for solver, preconditioner in combinations:
        runs = []
        for _ in range(repeats):
            began = time.process_time()
            found = tautline.solve(mesh, solver=solver, preconditioner=preconditioner, gradient=False,
                                   fast_multigrid=False, threads=threads, **problem)
            runs.append(time.process_time() - began)
            if not found.converged:
                break
        if found.converged:
            name = solver if solver == DIRECT else f"{solver} + {preconditioner}"
            times[name], counts[name] = Times(tuple(runs)), found.iterations
    return times, counts


def order_findings(report: Report, orders: dict[str, float]) -> None:
    for scheme, expected in ORDERS.items():
        report.finding("orders", f"{scheme} has order {expected} in time",
                       abs(orders[scheme] - expected) <= ORDER_TOLERANCE, f"{orders[scheme]:.3f}",
                       criterion=f"within {ORDER_TOLERANCE:g}", own=True,
                       proof=f"the orders are measured on one grid, 1/h = {GRID}, in every size of the study, against "
                       "the exact solution in time of the discrete eigenmode, which does not depend on h")


def findings(report: Report, stationary: Row, rows: dict[tuple[str, int], Row], masses: dict[str, Row]) -> None:
    """The fastest combination: the dissertation asks for it; so these statements are our own."""

    def finding(where: str, claim: str, holds: Verdict, ours: str, rule: str = "than all other combinations") -> None:
        report.finding(f"2.8, {where}", claim, holds, ours, own=True,
                       criterion=f"less time {rule} that converge, by more than the noise")

    finding("stationary", "CG with AMG is the fastest for the stationary problem", quickest_of(stationary, CG_AMG),
            shown(stationary))
    for equation in EQUATIONS:
        few, many = rows[equation, FEW], rows[equation, MANY]
        finding(equation, "CG with AMG is also the fastest over many steps", quickest_of(many, CG_AMG), shown(many))
        finding(equation, "A factorization, done once, is the fastest over many steps", quickest_of(many, DIRECT),
                shown(many))
        finding(equation, "The fastest combination is the same for one step and for many", same(few, many),
                f"{FEW} step: {shown(few)}; {MANY} steps: {shown(many)}",
                "in both cases than all other combinations")
    one, other = (masses[mass].get("cg + jacobi") for mass in ("lumped", "consistent"))
    finding("heat", "A lumped mass matrix takes less time than a consistent one (CG with Jacobi)",
            faster(one, other) if one and other else Open("CG with Jacobi failed"),
            ", ".join(f"{m} {shown(row)}" for m, row in masses.items()), "than the other one, of two")


def quickest_of(row: Row, name: str) -> Verdict:
    """Whether a combination is the fastest of those that converge; not decided where it failed."""
    return quickest(row, name) if name in row else Open(f"{name} failed")


def same(few: Row, many: Row) -> Verdict:
    """Whether the fastest combination is the same; not decided unless it is clear in both."""
    if not few or not many:
        return Open("all combinations failed")
    first, second = (min(row, key=lambda n: row[n].best) for row in (few, many))
    for row, name in ((few, first), (many, second)):
        if isinstance(verdict := quickest(row, name), Open):
            return verdict
    return first == second


def shown(row: Row) -> str:
    ranked = sorted(row, key=lambda n: row[n].best)
    return ", ".join(f"{name} {row[name]}" for name in ranked[:4]) or "all failed"
