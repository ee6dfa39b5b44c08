# SPDX-License-Identifier: BSD-3-Clause
"""Order of the iterations and of the time in the number of vertices: Figures 2.5, 2.6, 2.8, 2.9, 2.11 and 2.12."""

from __future__ import annotations

import argparse
import math

from vtkmodules.vtkCommonDataModel import vtkDataSet

from ._report import Report
from ._solver_claims import EIGENVALUE_ERROR, extreme_eigenvalues
from ._solver_tables import BY_METRIC
from ._solvers import AMG, DOMAINS, FULL, ILU, LABELS, PDES, PRECONDITIONERS, TITLES, Solve, bars, count_finding
from ._solvers import group_is_faster, initial_mesh, most_of, options, order, setup_of, sizes_up_to, smoothed, solve
from ._solvers import times_of, trouble
from ._totals import CG_AMG, GAIN_RULE, gained
from ._verdicts import Open, Times, Verdict, all_of, faster, less

FIGURES = {"poisson": ("2.5", "2.6"), "elliptic": ("2.8", "2.9"), "elasticity": ("2.11", "2.12")}
SECTIONS = {"poisson": "2.7.3.2", "elliptic": "2.7.3.3", "elasticity": "2.7.3.4"}
TABLES = {"poisson": "Table 2.8", "elliptic": "Table 2.10", "elasticity": "Table 2.11"}
ONE_LEVEL_ORDER, MULTIGRID_ORDER = 0.5, 0.1
#: Tolerances of an order for "around" and "approximately".
NEAR = 0.15
JACOBI_GMRES = 2
CG = (1, 5, 9)  # with a preconditioner of one level
EIGENVALUES_OF = "poisson"
EIGENVALUE_POINTS = 300_000  # eigenvalues of meshes with more points take too long
ONE_LEVEL = ("Jacobi", "SSOR", "ILU(0)")
#: Largest eigenvalues are constant if they vary by at most this part; a smallest one decreases rapidly from this order
#: in N on.
CONSTANT, RAPID = 0.1, -0.5
JACOBI_GMRES_ORDER = {"poisson": 0.8, "elliptic": 0.63, "elasticity": 0.8}
#: "AMG exhibits up to 94 % faster convergence than the other combinations as the problem size is increased."
AMG_GAIN = 0.94

#: The orders by combination.
Orders = dict[int, float]


def main(arguments: list[str]) -> int:
    given = options("solver_orders", __doc__).parse_args(arguments)
    report = Report("solver_orders", "Orders of iterations and time (section 2.7.3, Experiment 3)", given)
    report.text(
        "Meshes smoothed by IMR to 95 % of the possible reduction with " + ", ".join(
            f"{n:,}" for n in sizes_up_to(given)) + " vertices; s of O(N^s) by linear least squares in logarithms, of "
        "the combinations that converged on all."
    )
    for seed in report.seeds:
        meshes: dict[tuple[str, int], vtkDataSet] = {}
        for pde in given.pde or PDES:
            sizes = sizes_up_to(given, pde)
            for domain in given.domain or DOMAINS:
                for n in sizes:
                    if (domain, n) not in meshes:
                        meshes[domain, n] = smoothed(initial_mesh(domain, n, seed), "imr", given.threads)
            rows = {domain: [meshes[domain, n] for n in sizes] for domain in given.domain or DOMAINS}
            if pde == EIGENVALUES_OF:
                for domain, row in rows.items():
                    eigenvalue_findings(report, domain, {m.GetNumberOfPoints(): eigenvalues(m, given.threads)
                                                         for m in row if m.GetNumberOfPoints() < EIGENVALUE_POINTS})
            found = {domain: {m.GetNumberOfPoints(): solve(m, PDES[pde], setup_of(given)) for m in row}
                     for domain, row in rows.items()}
            study(report, given, pde, found)
            if sizes[-1] == FULL:
                for domain, solves in found.items():
                    count_finding(report, f"{TABLES[pde]}, {domain}", "IMR", solves[max(solves)],
                                  BY_METRIC[pde, domain]["imr"][1])
    return report.finish()


def study(report: Report, given: argparse.Namespace, pde: str, found: dict[str, dict[int, dict[int, Solve]]]) -> None:
    """The tables, charts and findings of a problem: solves by domain and number of vertices."""
    orders: dict[tuple[str, str], Orders] = {}
    for domain, by_size in found.items():
        solved = [n for n in given.combinations if all(row[n].converged for row in by_size.values())]
        rows = [[f"{n} {LABELS[n]}", *(row[n].iterations for row in by_size.values()),
                 *(row[n].seconds for row in by_size.values())] for n in solved]
        headings = [f"{what}, {n:,}" for what in ("iterations", "seconds") for n in by_size]
        report.table(f"{pde}_{domain}", f"{TITLES[pde]}, {domain}", ["combination", *headings], rows)
        for what in ("iterations", "seconds"):
            orders[domain, what] = {
                n: order(list(by_size), [getattr(row[n], what) for row in by_size.values()]) for n in solved
            }
    for what, figure in zip(("iterations", "seconds"), FIGURES[pde]):
        series = {d: orders[d, what] for d in found}
        report.table(f"{pde}_orders_{what}", f"Figure {figure}: s of the {what}", ["combination", *series],
                     [[f"{n} {LABELS[n]}", *(s.get(n, math.nan) for s in series.values())] for n in given.combinations])
        bars(report, f"figure_{figure.replace('.', '_')}", f"{TITLES[pde]}, {what}", series, "s")
    findings(report, pde, {d: orders[d, "iterations"] for d in found})
    for domain, by_size in found.items():
        size_findings(report, pde, domain, by_size)


def eigenvalues(mesh: vtkDataSet, threads: int) -> dict[str, tuple[float, float]]:
    """The largest and the smallest eigenvalue of P^-1 A of Poisson's equation by preconditioner."""
    return {name: extreme_eigenvalues(mesh, threads, option)
            for name, option in zip(PRECONDITIONERS, ("jacobi", "ssor", "ilu", "boomeramg"))}


def eigenvalue_findings(report: Report, domain: str, extremes: dict[int, dict[str, tuple[float, float]]]) -> None:
    """The eigenvalues of P^-1 A as the number of vertices N grows: section 2.7.3.2, Experiment 3."""
    sizes = list(extremes)
    rows = [[name, *(extremes[n][name][k] for k in (0, 1) for n in sizes)] for name in PRECONDITIONERS]
    headings = [f"{what}, {n:,}" for what in ("largest", "smallest") for n in sizes]
    report.table(f"eigenvalues_{domain}", f"Eigenvalues of P^-1 A, Poisson's equation, {domain}",
                 ["preconditioner", *headings], rows)
    where = f"2.7.3.2, {domain}"
    largest = {name: [extremes[n][name][0] for n in sizes] for name in ONE_LEVEL}
    report.finding(where, "The largest eigenvalue of P^-1 A stays constant as N increases",
                   all_of(less(max(v), (1 + CONSTANT) * min(v), 2 * EIGENVALUE_ERROR) if min(v) > 0 else
                          Open("an eigenvalue was not found") for v in largest.values()),
                   "; ".join(f"{name} {min(v):.3g} to {max(v):.3g}" for name, v in largest.items()),
                   criterion=f"the largest is at most {CONSTANT:.0%} above the smallest of them, with Jacobi, SSOR and "
                   f"ILU(0); eigenvalues to {EIGENVALUE_ERROR:g}")
    smallest = {name: [extremes[n][name][1] for n in sizes] for name in ONE_LEVEL}
    orders = {name: order(sizes, v) if min(v) > 0 else math.nan for name, v in smallest.items()}
    report.finding(where, "The smallest eigenvalue of P^-1 A decreases rapidly as N increases",
                   all_of(Open("an eigenvalue was not found") if math.isnan(s) else s < RAPID for s in orders.values()),
                   "order in N: " + ", ".join(f"{name} {s:.2f}" for name, s in orders.items()),
                   criterion=f"an order in N below {RAPID:g}, with Jacobi, SSOR and ILU(0)")


def near(orders: dict[str, Orders], numbers: tuple[int, ...], stated: float) -> Verdict:
    """Whether the orders of these combinations are around a number on all domains."""
    return all_of(abs(row[n] - stated) <= NEAR if n in row else Open(f"{LABELS[n]} failed on a mesh")
                  for row in orders.values() for n in numbers)


def shown(orders: dict[str, Orders], numbers: tuple[int, ...]) -> str:
    return "; ".join(f"{d}, {LABELS[n]}: {row[n]:.3f}" for d, row in orders.items() for n in numbers
                     if n in row) or "failed on a mesh"


def findings(report: Report, pde: str, orders: dict[str, Orders]) -> None:
    """The statements on s of the iterations, by domain."""
    where = f"Figure {FIGURES[pde][0]}"
    around = f"within {NEAR:g}"
    if pde == "elasticity":
        for domain, row in orders.items():
            others = [n for n in LABELS if n in row and n not in AMG]
            if domain == "wrench":
                report.finding(f"{where}, wrench", "s is less with AMG than with the other preconditioners",
                               all_of(Open(f"{LABELS[n]} failed on a mesh") if n not in row else row[n] < row[m]
                                      for n in AMG for m in others), shown({domain: row}, (*AMG, *others)),
                               criterion="the s of each combination with AMG is less than with every other one")
            else:
                report.finding(f"{where}, hinge", "s is close to 0.5 with all combinations",
                               near({domain: row}, tuple(n for n in (*AMG, *others) if n != JACOBI_GMRES),
                                    ONE_LEVEL_ORDER), shown({domain: row}, (*AMG, *others)),
                               criterion=f"{around}; Jacobi with GMRES, of which 0.8 is stated, aside", stated="0.5")
    else:
        report.finding(where, f"s is below {MULTIGRID_ORDER} with AMG",
                       all_of(row[n] < MULTIGRID_ORDER if n in row else Open(f"{LABELS[n]} failed on a mesh")
                              for row in orders.values() for n in AMG), shown(orders, AMG), stated="below 0.1")
        numbers = CG if pde == "elliptic" else tuple(n for n in LABELS if n <= ILU[-1] and n != JACOBI_GMRES)
        name = "CG and each preconditioner" if pde == "elliptic" else "the other combinations"
        report.finding(where, f"s is around {ONE_LEVEL_ORDER} with {name}", near(orders, numbers, ONE_LEVEL_ORDER),
                       shown(orders, numbers), stated="0.5", criterion=around + (
                           "; AMG, of which less than 0.1 is stated, aside" if pde == "elliptic" else ""))
        report.finding(where, "Jacobi with GMRES has the largest s",
                       all_of(all_of(row[JACOBI_GMRES] > s for n, s in row.items() if n != JACOBI_GMRES)
                              if JACOBI_GMRES in row else Open(f"{LABELS[JACOBI_GMRES]} failed on a mesh")
                              for row in orders.values()),
                       "; ".join(f"{d}: {LABELS[n]} {row[n]:.3f}" for d, row in orders.items()
                                 for n in [max(row, key=row.get)] if row) or "none converged on all meshes")
    stated = JACOBI_GMRES_ORDER[pde]
    report.finding(where, f"s is approximately {stated} with Jacobi and GMRES", near(orders, (JACOBI_GMRES,), stated),
                   shown(orders, (JACOBI_GMRES,)), criterion=around, stated=str(stated))


def best_group(row: dict[int, Solve]) -> int | Open:
    """The number of the preconditioner of the fastest combination; not decided where another one is as fast."""
    best: dict[int, Times] = {}
    for n, t in times_of(row).items():
        group = (n - 1) // 4
        if group not in best or t.best < best[group].best:
            best[group] = t
    if len(best) < 2:
        return Open("fewer than two preconditioners converge")
    first = min(best, key=lambda group: best[group].best)
    verdict = all_of(faster(best[first], t) for group, t in best.items() if group != first)
    return verdict if isinstance(verdict, Open) else first


def size_findings(report: Report, pde: str, domain: str, by_size: dict[int, dict[int, Solve]]) -> None:
    """Whether the best combination depends on the number of vertices, and the gain of AMG on the finest mesh."""
    where = f"{SECTIONS[pde]}, {domain}"
    best = {n: best_group(row) for n, row in by_size.items()}
    figures = ", ".join(f"{n:,}: {'not decided' if isinstance(b, Open) else PRECONDITIONERS[b]}"
                        for n, b in best.items())
    if pde == "elasticity":
        report.finding(where, "ILU(0) with MINRES or CG is the best combination in most cases",
                       most_of(group_is_faster(row, (ILU[0], ILU[2])) for row in by_size.values()), figures,
                       criterion="one of the two takes less time than all others by more than the noise, with more "
                       "than half of the numbers of vertices")
    else:
        known = {b for b in best.values() if not isinstance(b, Open)}
        report.finding(where, "The best combination does not depend on the number of vertices",
                       False if len(known) > 1 else all_of(b if isinstance(b, Open) else True for b in best.values()),
                       figures,
                       criterion="the fastest combination has the same preconditioner on all meshes, by more than the "
                       "noise of the times")
    last = by_size[max(by_size)]
    others = {n: t for n, t in times_of(last).items() if n not in AMG}
    slow = max(others, key=lambda n: others[n].best, default=0)
    why = trouble(last, [CG_AMG]) or ("" if others else "no other combination converged")
    report.finding(f"2.8, {domain}, {pde}", "AMG converges up to 94 % faster than the other combinations",
                   Open(why) if why else gained(last[CG_AMG].times, others[slow], AMG_GAIN),
                   "failed" if why else f"{LABELS[CG_AMG]} {last[CG_AMG].times}, {LABELS[slow]} {others[slow]}: "
                   f"{1 - last[CG_AMG].seconds / others[slow].best:.1%}",
                   criterion=f"CG with AMG against the slowest other combination on the finest mesh: {GAIN_RULE}",
                   stated=f"{AMG_GAIN:.0%}")
