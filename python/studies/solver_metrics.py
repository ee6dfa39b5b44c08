# SPDX-License-Identifier: BSD-3-Clause
"""Solvers and preconditioners on meshes smoothed by four metrics, total times: Tables 2.8, 2.10 and 2.11."""

from __future__ import annotations

import argparse

from . import _own_mesh
from ._common import Run
from ._report import Report
from ._solver_claims import FINE_ERROR, Rows, eigenvalue_findings, extreme_eigenvalues, factor_findings, metric_findings
from ._solver_tables import BY_METRIC, METRICS
from ._solvers import AMG, DOMAINS, FULL, ILU, LABELS, LONG, NEAR_NULL_SPACE, PDES, POSITIVE, TITLES
from ._solvers import Solve, bars, count_finding, fastest, initial_mesh, options, setup_of, size_of, smoothing, solve
from ._solvers import group_is_faster, table, times_of, trouble
from ._totals import sensitivity_findings, total_findings, total_table
from ._verdicts import Open, all_of, faster, slowest, unless
from .smoothing_times import TABLE_2_6

TABLES = {"poisson": "2.8", "elliptic": "2.10", "elasticity": "2.11"}
JACOBI_GMRES = 2


def main(arguments: list[str]) -> int:
    made = options("solver_metrics", __doc__)
    _own_mesh.add_options(made)
    given = made.parse_args(arguments)
    report = Report("solver_metrics", "Solvers, preconditioners and quality metrics (section 2.7.3)", given)
    report.text(
        "PETSc's defaults: relative tolerance 1e-5 of the preconditioned residual, at most 10,000 iterations, "
        "GMRES(30), SSOR with omega 1, BoomerAMG with its defaults. Seconds are CPU seconds with the set-up of the "
        f"preconditioner, the fastest of {given.repeats} run(s) of what takes less than {LONG:g} s. '*' is a failure, "
        "'>' the time limit."
    )
    if _own_mesh.chosen(given):
        own(report, given)
        return report.finish()
    report.text(
        "Half of the interior vertices are perturbed, then the mesh is smoothed by each metric to 95 % of the possible "
        "reduction (section 2.4). The dissertation's numbers are of 500,000 vertices, PETSc 3.0 and an Intel Nehalem "
        "at 2.66 GHz. In addition to Table 2.5, elasticity is solved by multigrid with the rigid body modes: "
        + ", ".join(f"{n} {LABELS[n]}" for n in NEAR_NULL_SPACE) + "."
    )
    for seed in report.seeds:
        for domain in given.domain or DOMAINS:
            runs: dict[int, dict[str, Run]] = {}
            for pde in given.pde or PDES:
                size = size_of(given, pde=pde)
                if size not in runs:
                    mesh = initial_mesh(domain, size, seed)
                    runs[size] = {m: smoothing(mesh, m, given.threads, given.repeats) for m in METRICS}
                solved(report, given, pde, domain, runs[size])
    return report.finish()


def solved(report: Report, given: argparse.Namespace, pde: str, domain: str, runs: dict[str, Run]) -> None:
    """Solve a problem on the meshes of a domain."""
    smooth = {m: run.times() for m, run in runs.items()}
    setup = setup_of(given, [*given.combinations, *(NEAR_NULL_SPACE if pde == "elasticity" else ())])
    rows = {m: solve(run.mesh, PDES[pde], setup) for m, run in runs.items()}
    theirs = BY_METRIC[pde, domain]
    points = runs["imr"].mesh.GetNumberOfPoints()
    title = f"Table {TABLES[pde]}, {TITLES[pde]}, {domain}, {points:,} vertices"
    shown(report, pde, domain, title, rows, smooth, theirs)
    findings(report, pde, domain, rows, theirs)
    if size_of(given, pde=pde) == FULL:
        for metric in METRICS:
            count_finding(report, f"Table {TABLES[pde]}, {domain}", metric.upper(), rows[metric], theirs[metric][1])
    metric_findings(report, pde, domain, rows)
    total_findings(report, pde, domain, rows, smooth)
    factor_findings(report, pde, domain, rows, smooth, dict(zip(METRICS, map(float, TABLE_2_6[domain]))))
    sensitivity_findings(report, pde, domain, rows)
    if pde == "poisson":
        eigenvalue_findings(report, domain, {m: extreme_eigenvalues(r.mesh, given.threads, error=FINE_ERROR)
                                             for m, r in runs.items()})


def shown(report: Report, pde: str, domain: str, title: str, rows: Rows, smooth: dict, theirs: dict) -> None:
    """The tables and the chart of a problem on a mesh."""
    table(report, f"{pde}_{domain}", title, rows, theirs, "metric")
    bars(report, f"{pde}_{domain}", title, {m: {n: s.seconds for n, s in row.items() if s.converged}
                                            for m, row in rows.items()}, "seconds", logarithmic=True)
    total_table(report, pde, domain, rows, smooth)


def own(report: Report, given: argparse.Namespace) -> None:
    """A mesh, metrics, coefficients or boundary conditions of the user: without the dissertation's numbers."""
    for name, mesh in _own_mesh.meshes(given, size_of(given)).items():
        runs = _own_mesh.smoothed_by(mesh, given)
        for pde in given.pde or PDES:
            rows = {label: solve(made, _own_mesh.problem(pde, given), setup_of(given))
                    for label, (made, _) in runs.items()}
            title = f"{TITLES[pde]}, {name}, {mesh.GetNumberOfCells():,} cells, {mesh.GetNumberOfPoints():,} points"
            shown(report, pde, name, title, rows, {label: times for label, (_, times) in runs.items()}, {})


def findings(report: Report, pde: str, domain: str, rows: Rows, theirs: dict) -> None:
    where = f"Table {TABLES[pde]}, {domain}"
    first = {m: [n for n in fastest(row) if n not in NEAR_NULL_SPACE] for m, row in rows.items()}
    best = "; ".join(f"{m}: {LABELS[f[0]]} {rows[m][f[0]].seconds:.3g} s" for m, f in first.items() if f)
    rule = "with each metric, by more than the noise of the times"
    if pde == "elasticity":
        report.finding(where, "ILU(0) with CG or MINRES is the best for elasticity",
                       all_of(group_is_faster(row, (ILU[0], ILU[2])) for row in rows.values()), best,
                       criterion=f"one of the two takes less time than all other combinations, {rule}")
        report.finding(where, "ILU(0) is more efficient than AMG for elasticity",
                       all_of(unless(trouble(row, (a, b)), faster(row[a].times, row[b].times))
                              for row in rows.values() for a, b in zip(ILU, AMG) if {a, b} <= set(row)), best,
                       criterion=f"with each solver, and {rule}")
        rigid_findings(report, where, rows)
    else:
        report.finding(where, "AMG with any solver is faster than everything else",
                       all_of(group_is_faster(row, AMG, every=True) for row in rows.values()), best,
                       criterion=f"each solver with AMG takes less time than all other combinations, {rule}")
    worst = {m: max(f, key=lambda n: rows[m][n].seconds) for m, f in first.items() if f}
    report.finding(where, "Jacobi with GMRES is the slowest",
                   all_of(Open(why) if (why := trouble(row, [JACOBI_GMRES]) or waiting(row)) else
                          slowest(times_of(row, NEAR_NULL_SPACE), JACOBI_GMRES) for row in rows.values()),
                   "; ".join(f"{m}: {LABELS[n]} {rows[m][n].seconds:.3g} s" for m, n in worst.items()) or "all failed",
                   criterion=f"slower than all combinations that converge, {rule}")
    failed = {m: [n for n, s in row.items() if s.failed and n not in NEAR_NULL_SPACE] for m, row in rows.items()}
    there = {m: [n for n, v in enumerate(theirs[m][1], 1) if v is None and n in rows[m]] for m in METRICS}
    why = next((why for row in rows.values() if (why := waiting(row))), "")
    report.finding(where, "The same combinations fail as in the dissertation", unless(why, failed == there),
                   "; ".join(f"{m}: {failed[m] or 'none'}" for m in METRICS),
                   stated="; ".join(f"{m}: {there[m] or 'none'}" for m in METRICS),
                   criterion="the same list of combinations with each metric",
                   reason="" if any(failed.values()) else POSITIVE)


def rigid_findings(report: Report, where: str, rows: Rows) -> None:
    """Multigrid with the rigid body modes beside Table 2.5."""
    modes = {m: min((row[n] for n in NEAR_NULL_SPACE if n in row), key=lambda s: s.seconds) for m, row in rows.items()}
    report.finding(where, "Multigrid with the rigid body modes is faster than all of Table 2.5",
                   all_of(unless(trouble(rows[m], [s.number]), all_of(
                       faster(s.times, t) for t in times_of(rows[m], NEAR_NULL_SPACE).values()))
                          for m, s in modes.items()),
                   "; ".join(f"{m}: {LABELS[s.number]} {s.seconds:.3g} s, {s.iterations} iterations"
                             for m, s in modes.items()),
                   criterion="with each metric, by more than the noise of the times", own=True)


def waiting(row: dict[int, Solve]) -> str:
    """The combinations that did not finish within the time limit; "": all did."""
    return trouble(row, [n for n, s in row.items() if s.unfinished])
