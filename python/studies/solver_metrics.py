# SPDX-License-Identifier: BSD-3-Clause
"""Solvers and preconditioners on meshes smoothed by four metrics, total times: Tables 2.8, 2.10 and 2.11."""

from __future__ import annotations

from ._common import Run
from ._report import Report
from ._solver_tables import BY_METRIC, METRICS
from ._solvers import AMG, DOMAINS, FULL, ILU, LABELS, NEAR_NULL_SPACE, PDES, TITLES
from ._solvers import Solve, bars, fastest, initial_mesh, options, size_of, smoothing, solve, table, times_of, within
from ._totals import sensitivity_findings, total_findings, total_table
from ._verdicts import Verdict, all_of, any_of, faster, slowest

TABLES = {"poisson": "2.8", "elliptic": "2.10", "elasticity": "2.11"}
FACTOR = 1.5  # within which iteration counts agree
JACOBI_GMRES = 2
CG_AMG = 13


def main(arguments: list[str]) -> int:
    given = options("solver_metrics", __doc__).parse_args(arguments)
    size = size_of(given)
    report = Report("solver_metrics", "Solvers, preconditioners and quality metrics (section 2.7.3)",
                    given.out, given.small)
    report.text(
        "Half of the interior vertices are perturbed, then the mesh is smoothed by each metric to 95 % of the possible "
        "reduction (section 2.4). PETSc's defaults: relative tolerance 1e-5 of the preconditioned residual, at most "
        "10,000 iterations, GMRES(30), SSOR with omega 1, BoomerAMG with its defaults. Seconds are CPU seconds with "
        f"the set-up of the preconditioner, the fastest of {given.repeats} run(s). '*' is a failure, '>' the time "
        "limit. The dissertation's numbers are of 500,000 vertices, PETSc 3.0 and an Intel Nehalem at 2.66 GHz. In "
        "addition to Table 2.5, elasticity is solved by multigrid with the rigid body modes: "
        + ", ".join(f"{n} {LABELS[n]}" for n in NEAR_NULL_SPACE) + "."
    )
    runs: dict[str, dict[str, Run]] = {}
    for pde in given.pde or PDES:
        for domain in given.domain or DOMAINS:
            mesh = initial_mesh(domain, size)
            if domain not in runs:  # the same for all problems
                runs[domain] = {m: smoothing(mesh, m, given.threads, given.repeats) for m in METRICS}
            smooth = {m: run.times() for m, run in runs[domain].items()}
            numbers = [*given.combinations, *(NEAR_NULL_SPACE if pde == "elasticity" else ())]
            rows = {m: solve(run.mesh, pde, given, combinations=numbers) for m, run in runs[domain].items()}
            theirs = BY_METRIC[pde, domain]
            title = f"Table {TABLES[pde]}, {TITLES[pde]}, {domain}, {mesh.GetNumberOfPoints():,} vertices"
            table(report, f"{pde}_{domain}", title, rows, theirs, "metric")
            bars(report, f"{pde}_{domain}", title,
                 {m: {n: s.seconds for n, s in row.items() if s.converged} for m, row in rows.items()},
                 "seconds", logarithmic=True)
            total_table(report, pde, domain, rows, smooth)
            findings(report, pde, domain, rows, theirs, same_size=size == FULL)
            total_findings(report, pde, domain, rows, smooth)
            sensitivity_findings(report, pde, domain, rows)
    return report.finish()


def findings(report: Report, pde: str, domain: str, rows: dict, theirs: dict, same_size: bool) -> None:
    where = f"Table {TABLES[pde]}, {domain}"
    first = {m: [n for n in fastest(row) if n not in NEAR_NULL_SPACE] for m, row in rows.items()}
    best = "; ".join(f"{m}: {LABELS[f[0]]} {rows[m][f[0]].seconds:.3g} s" for m, f in first.items() if f)
    if same_size:
        for metric in METRICS:
            good, both, off = within(rows[metric], theirs[metric][1], FACTOR)
            report.finding(where, f"Iterations with {metric.upper()} within a factor {FACTOR:g} of the dissertation's",
                           good == both, f"{good} of {both}" + (f"; {off}" if off else ""))
    if set(AMG) <= set(rows["imr"]):
        if pde == "elasticity":
            report.finding(where, "ILU(0) with CG or MINRES is the best for elasticity",
                           all_of(group_is_faster(row, (ILU[0], ILU[2])) for row in rows.values()), best)
            modes = {m: min((row[n] for n in NEAR_NULL_SPACE), key=lambda s: s.seconds) for m, row in rows.items()}
            report.finding("in addition to " + where,
                           "Multigrid with the rigid body modes is faster than all of Table 2.5",
                           all_of(s.converged and all_of(faster(s.times, other) for other in
                                                         times_of(rows[m], NEAR_NULL_SPACE).values())
                                  for m, s in modes.items()),
                           "; ".join(f"{m}: {LABELS[s.number]} {s.seconds:.3g} s, {s.iterations} iterations"
                                     for m, s in modes.items()))
        else:
            report.finding(where, "AMG with any solver is faster than everything else",
                           all_of(group_is_faster(row, AMG, every=True) for row in rows.values()), best)
    worst = {m: max(first[m], key=lambda n: row[n].seconds) for m, row in rows.items() if first[m]}
    if JACOBI_GMRES in rows["imr"] and len(worst) == len(rows):
        report.finding(where, "Jacobi with GMRES is the slowest",
                       all_of(row[JACOBI_GMRES].converged
                              and slowest(times_of(row, NEAR_NULL_SPACE), JACOBI_GMRES) for row in rows.values()),
                       "; ".join(f"{m}: {LABELS[n]} {rows[m][n].seconds:.3g} s" for m, n in worst.items()))
    failed = {m: [n for n, s in row.items() if not s.converged and not s.unfinished and n not in NEAR_NULL_SPACE]
              for m, row in rows.items()}
    there = {m: [n for n, v in enumerate(theirs[m][1], 1) if v is None] for m in METRICS}
    report.finding(where, "The same combinations fail as in the dissertation", failed == there,
                   "; ".join(f"{m}: ours {failed[m] or 'none'}, there {there[m] or 'none'}" for m in METRICS))
    if CG_AMG in rows["imr"]:
        times = {m: rows[m][CG_AMG].times for m in METRICS}
        report.finding(where, "SS is the least efficient metric for the solver (by CG with AMG)",
                       slowest(times, "ss"), ", ".join(f"{m} {t}" for m, t in times.items()))


def group_is_faster(row: dict[int, Solve], group: tuple[int, ...], every: bool = False) -> Verdict:
    """Whether one of a group of combinations (every: each that converged) is faster than all outside it."""
    times = times_of(row, NEAR_NULL_SPACE)
    inside = [t for n, t in times.items() if n in group]
    outside = [t for n, t in times.items() if n not in group]
    if not inside or not outside or (every and len(inside) < len(group)):
        return False
    verdicts = [all_of(faster(t, other) for other in outside) for t in inside]
    return all_of(verdicts) if every else any_of(verdicts)
