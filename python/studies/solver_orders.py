# SPDX-License-Identifier: BSD-3-Clause
"""Order of the iterations and of the time in the number of vertices: Figures 2.5, 2.6, 2.8, 2.9, 2.11 and 2.12."""

from __future__ import annotations

import math

from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._report import Report
from ._solvers import AMG, DOMAINS, LABELS, PDES, PRECONDITIONERS, SIZES, TITLES
from ._solvers import bars, initial_mesh, options, order, size_of, smoothed, solve
from ._verdicts import constant

FIGURES = {"poisson": ("2.5", "2.6"), "elliptic": ("2.8", "2.9"), "elasticity": ("2.11", "2.12")}
SMALL_SIZES = (500, 1_000, 2_000)
ONE_LEVEL_ORDER, MULTIGRID_ORDER = 0.5, 0.1
NEAR = 0.15
JACOBI_GMRES = 2
EIGENVALUES_OF = "poisson"
ONE_LEVEL = ("Jacobi", "SSOR", "ILU(0)")
EIGENVALUE_ERROR = 1e-4  # relative, of the eigenvalues
#: Largest eigenvalues are constant within this part; a smallest one decreases rapidly from this order in N on.
CONSTANT, RAPID = 0.1, -0.5
LEAST = 1e-300  # a smallest eigenvalue that is not positive counts as this
JACOBI_GMRES_ORDER = {"poisson": 0.8, "elliptic": 0.63, "elasticity": 0.8}


def main(arguments: list[str]) -> int:
    given = options("solver_orders", __doc__).parse_args(arguments)
    largest = size_of(given)
    sizes = [n for n in (SMALL_SIZES if given.small else SIZES) if n <= largest]
    report = Report("solver_orders", "Orders of iterations and time (section 2.7.3, Experiment 3)", given.out,
                    given.small)
    report.text(
        "Meshes smoothed by IMR to 95 % of the possible reduction with " + ", ".join(f"{n:,}" for n in sizes) +
        " vertices; s of O(N^s) by linear least squares in logarithms, of the combinations that converged on all."
    )
    for pde in given.pde or PDES:
        orders = {}
        for domain in given.domain or DOMAINS:
            found, extremes = {}, {}
            for size in sizes:
                mesh = smoothed(initial_mesh(domain, size), "imr", given.threads)
                found[mesh.GetNumberOfPoints()] = solve(mesh, pde, given)
                if pde == EIGENVALUES_OF:
                    extremes[mesh.GetNumberOfPoints()] = eigenvalues(mesh, given.threads)
            if extremes:
                eigenvalue_findings(report, domain, extremes)
            solved = [n for n in given.combinations if all(row[n].converged for row in found.values())]
            rows = [[f"{n} {LABELS[n]}", *(row[n].iterations for row in found.values()),
                     *(row[n].seconds for row in found.values())] for n in solved]
            headings = [f"{what}, {n:,}" for what in ("iterations", "seconds") for n in found]
            report.table(f"{pde}_{domain}", f"{TITLES[pde]}, {domain}", ["combination", *headings], rows)
            for what in ("iterations", "seconds"):
                orders[domain, what] = {
                    n: order(list(found), [getattr(row[n], what) for row in found.values()]) for n in solved
                }
        for what, figure in zip(("iterations", "seconds"), FIGURES[pde]):
            series = {d: orders[d, what] for d in given.domain or DOMAINS}
            report.table(f"{pde}_orders_{what}", f"Figure {figure}: s of the {what}", ["combination", *series],
                         [[f"{n} {LABELS[n]}", *(s.get(n, float("nan")) for s in series.values())]
                          for n in given.combinations])
            bars(report, f"figure_{figure.replace('.', '_')}", f"{TITLES[pde]}, {what}", series, "s")
        findings(report, pde, {d: orders[d, "iterations"] for d in given.domain or DOMAINS})
    return report.finish()


def eigenvalues(mesh: vtkDataSet, threads: int) -> dict[str, tuple[float, float]]:
    """The largest and the smallest eigenvalue of P^-1 A of Poisson's equation by preconditioner."""
    found = {}
    for name, option in zip(PRECONDITIONERS, ("jacobi", "ssor", "ilu", "amg")):
        row = tautline.condition(mesh, preconditioner=option, tolerance=EIGENVALUE_ERROR, shares=False,
                                 threads=threads).spectrum[-1]
        found[name] = row["largest"], row["smallest"]
    return found


def eigenvalue_findings(report: Report, domain: str, extremes: dict[int, dict[str, tuple[float, float]]]) -> None:
    """The eigenvalues of P^-1 A as the number of vertices N grows: section 2.7.3.2, Experiment 3."""
    sizes = list(extremes)
    rows = [[name, *(extremes[n][name][k] for k in (0, 1) for n in sizes)] for name in PRECONDITIONERS]
    headings = [f"{what}, {n:,}" for what in ("largest", "smallest") for n in sizes]
    report.table(f"eigenvalues_{domain}", f"Eigenvalues of P^-1 A, Poisson's equation, {domain}",
                 ["preconditioner", *headings], rows)
    where = f"2.7.3.2, {domain}"
    largest = {name: [extremes[n][name][0] for n in sizes] for name in ONE_LEVEL}
    report.finding(where, f"The largest eigenvalue of P^-1 A stays constant as N increases (within {CONSTANT:.0%})",
                   all(min(v) > 0 and constant(v, CONSTANT) for v in largest.values()),
                   "; ".join(f"{name} {min(v):.3g} to {max(v):.3g}" for name, v in largest.items()))
    orders = {name: order(sizes, [max(extremes[n][name][1], LEAST) for n in sizes]) for name in ONE_LEVEL}
    report.finding(where, "The smallest eigenvalue of P^-1 A decreases rapidly as N increases (order below "
                   f"{RAPID:g})", all(math.isfinite(s) and s < RAPID for s in orders.values()),
                   "order in N: " + ", ".join(f"{name} {s:.2f}" for name, s in orders.items()))


def findings(report: Report, pde: str, orders: dict[str, dict[int, float]]) -> None:
    where = f"Figure {FIGURES[pde][0]}"
    multigrid = {(d, n): s for d, row in orders.items() for n, s in row.items() if n in AMG}
    if pde != "elasticity":
        report.finding(where, f"s is below {MULTIGRID_ORDER} with AMG",
                       all(s < MULTIGRID_ORDER for s in multigrid.values()),
                       "; ".join(f"{d}, {LABELS[n]}: {s:.3f}" for (d, n), s in multigrid.items()))
    others = {(d, n): s for d, row in orders.items() for n, s in row.items() if n not in (*AMG, JACOBI_GMRES)}
    report.finding(where, f"s is near {ONE_LEVEL_ORDER} with the other combinations (within {NEAR})",
                   all(abs(s - ONE_LEVEL_ORDER) <= NEAR for s in others.values()),
                   "; ".join(f"{d}, {LABELS[n]}: {s:.3f}" for (d, n), s in others.items()))
    largest = {d: max(row, key=row.get) for d, row in orders.items() if row}
    report.finding(where, f"Jacobi with GMRES has the largest s (about {JACOBI_GMRES_ORDER[pde]})",
                   all(n == JACOBI_GMRES for n in largest.values()),
                   "; ".join(f"{d}: {LABELS[n]} {orders[d][n]:.3f}" for d, n in largest.items()))
