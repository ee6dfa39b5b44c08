# SPDX-License-Identifier: BSD-3-Clause
"""Claims of section 2.7.3 on the solver time, the total time (smoothing and solver) and the sensitivity to metrics."""

from __future__ import annotations

import math

from ._report import Report
from ._solver_claims import Rows
from ._solver_tables import COMBINATIONS, METRICS
from ._solvers import AMG, LABELS, SOLVERS, TITLES, most_of, trouble
from ._verdicts import GAIN_RULE, Open, Times, Verdict, all_of, any_of, faster, gain, less, unless

JACOBI_GMRES, ILU_CG, ILU_MINRES, CG_AMG = 2, 9, 11, 13
#: The best and the worst (metric, combination) that the text names, and how much less solver time the best one takes.
SOLVER_CLAIMS = {
    "poisson": (("imr", CG_AMG), ("imr", JACOBI_GMRES), 0.97),
    "elliptic": (("rr", CG_AMG), ("si", JACOBI_GMRES), 0.95),
    "elasticity": (("imr", ILU_CG), ("rr", JACOBI_GMRES), 0.92),
}
#: How much less the total time with IMR is than with SS: (combination, reduction). The text names SI for Jacobi with
#: GMRES, where its printed numbers give SS.
TOTAL_CLAIMS = {
    "poisson": ((CG_AMG, 0.90), (JACOBI_GMRES, 0.45)),
    "elasticity": ((ILU_MINRES, 0.71), (JACOBI_GMRES, 0.16)),
}
#: The combinations with the smallest total time, with IMR.
BEST_TOTAL = {"poisson": (CG_AMG,), "elliptic": AMG, "elasticity": (ILU_CG, ILU_MINRES)}
#: "IMR > RR > SI > SS", from the fastest to the slowest.
ORDER = METRICS
#: Variation of the iterations over the metrics: "more than 20 %" of Bi-CGSTAB, "less than 10 %" of the others.
LARGE_VARIATION, SMALL_VARIATION = 0.20, 0.10
BICGSTAB = SOLVERS.index("Bi-CGSTAB")
CG = SOLVERS.index("CG")


def gained(one: Times, other: Times, stated: float) -> Verdict:
    """Whether the gain of one time over another is as large as the stated one; not decided where runs differ in it."""
    found = [gain(1 - ratio, stated) for ratio in one.over(other)]
    if found[0] != found[1]:
        return Open(f"the times {one} and {other} are at the limit of the band")
    return found[0]


def totals(rows: Rows, smooth: dict[str, Times], number: int) -> dict[str, Times]:
    """Smoothing and solver time of a combination by metric, of those that converged."""
    return {m: smooth[m] + row[number].times for m, row in rows.items() if number in row and row[number].converged}


def total_table(report: Report, pde: str, domain: str, rows: Rows, smooth: dict[str, Times]) -> None:
    """The total times per metric and combination."""
    numbers = [n for n in next(iter(rows.values())) if n in COMBINATIONS]
    found = {n: totals(rows, smooth, n) for n in numbers}
    lines = [[m, smooth[m].best, *(found[n][m].best if m in found[n] else math.nan for n in numbers)] for m in rows]
    report.table(f"total_{pde}_{domain}", f"Total time (smoothing and solver, CPU s), {TITLES.get(pde, pde)}, {domain}",
                 ["metric", "smoothing", *(str(n) for n in numbers)], lines)


def total_findings(report: Report, pde: str, domain: str, rows: Rows, smooth: dict[str, Times]) -> None:
    where = f"2.7.3, {domain}, {pde}"
    *ends, share = SOLVER_CLAIMS[pde]
    if all(n in rows[m] for m, n in ends):
        best, worst = (rows[m][n] for m, n in ends)
        why = trouble(rows[ends[0][0]], [ends[0][1]]) or trouble(rows[ends[1][0]], [ends[1][1]])
        report.finding(where, f"The solver time with the best combination is {share:.0%} less than with the worst one",
                       unless(why, gained(best.times, worst.times, share)),
                       "; ".join(f"{m}, {LABELS[n]} {rows[m][n].times}" for m, n in ends)
                       + f": {1 - best.seconds / worst.seconds:.1%}",
                       criterion=GAIN_RULE + ", with the faster half of the runs", stated=f"{share:.0%}")
    for number, share in TOTAL_CLAIMS.get(pde, ()):
        if number not in rows["imr"]:
            continue
        found = totals(rows, smooth, number)
        why = trouble(rows["imr"], [number]) or trouble(rows["ss"], [number])
        named = ", named SI; the printed numbers give it for SS" if number == JACOBI_GMRES else ""
        report.finding(where, f"The total time of {LABELS[number]} with IMR is {share:.0%} less than with SS",
                       Open(why) if why else gained(found["imr"], found["ss"], share),
                       ", ".join(f"{m} {t}" for m, t in found.items()) or "none converged",
                       criterion=GAIN_RULE + ", with the faster half of the runs", stated=f"{share:.0%}{named}")
    orders = {n: ranked(totals(rows, smooth, n)) for n in rows["imr"] if n in COMBINATIONS}
    report.finding(where, "The metrics rank IMR, RR, SI, SS by the total time in most cases", most_of(orders.values()),
                   f"{sum(v is True for v in orders.values())} of {len(orders)} combinations, "
                   f"{sum(isinstance(v, Open) for v in orders.values())} are not decided; smoothing alone: "
                   + ", ".join(f"{m} {t}" for m, t in smooth.items()),
                   criterion="each metric takes less time than the next one by more than the noise, in more than half "
                   "of the combinations", stated="IMR > RR > SI > SS")
    best_findings(report, where, pde, {(m, n): t for n in orders for m, t in totals(rows, smooth, n).items()})


def best_findings(report: Report, where: str, pde: str, found: dict[tuple[str, int], Times]) -> None:
    """The metric and combination with the shortest total time."""
    group = [("imr", n) for n in BEST_TOTAL[pde] if ("imr", n) in found]
    missing = [Open(f"{LABELS[n]} failed") for n in BEST_TOTAL[pde] if ("imr", n) not in found]
    others = [t for key, t in found.items() if key not in group]
    names = " or ".join(LABELS[n] for n in BEST_TOTAL[pde])
    first = min(found, key=lambda key: found[key].best, default=None)
    report.finding(where, f"IMR with {names} has the least total time",
                   any_of([*(all_of(faster(found[key], t) for t in others) for key in group), *missing]),
                   "none converged" if first is None else f"least: {first[0]}, {LABELS[first[1]]} {found[first]}; "
                   + ", ".join(f"{LABELS[n]} {found[m, n]}" for m, n in group),
                   criterion="one of these takes less time than every other metric and combination by more than the "
                   "noise")


def ranked(found: dict[str, Times]) -> Verdict:
    """Whether the metrics are in the stated order; not decided where one did not converge."""
    pairs = [(a, b) for a, b in zip(ORDER, ORDER[1:]) if a in found and b in found]
    missing = [Open(f"{m} failed") for m in ORDER if m not in found]
    return all_of([*(faster(found[a], found[b]) for a, b in pairs), *missing])


def variation(rows: Rows) -> dict[int, float]:
    """(largest - smallest) / smallest number of iterations over the metrics, by combination without AMG."""
    found = {}
    for number in rows["imr"]:
        counts = [row[number].iterations for row in rows.values() if row[number].converged]
        if number in COMBINATIONS and number not in AMG and len(counts) == len(rows):
            found[number] = max(counts) / max(min(counts), 1) - 1
    return found


def sensitivity_findings(report: Report, pde: str, domain: str, rows: Rows) -> None:
    where = f"2.7.3, {domain}, {pde}"
    found = variation(rows)
    by_solver = {i: [v for n, v in found.items() if (n - 1) % len(SOLVERS) == i] for i in range(len(SOLVERS))}
    why = ", ".join(SOLVERS[i] for i, values in by_solver.items() if not values)
    why = f"no combination of {why} converged with all metrics" if why else ""
    mean = {i: sum(values) / len(values) for i, values in by_solver.items() if values}
    figures = "mean variation of the iterations over the metrics: " + ", ".join(
        f"{SOLVERS[i]} {v:.1%}" for i, v in mean.items())
    rule = "the mean over the preconditioners but AMG of (largest - smallest) / smallest number of iterations is {}"
    report.finding(where, "Bi-CGSTAB is the most sensitive to the metric",
                   unless(why, all_of(less(v, mean[BICGSTAB], 0) for i, v in mean.items() if i != BICGSTAB))
                   if BICGSTAB in mean else Open(why), figures, criterion=rule.format("the largest"))
    if pde != "elasticity":
        report.finding(where, "CG is the least affected by the metric",
                       unless(why, all_of(less(mean[CG], v, 0) for i, v in mean.items() if i != CG))
                       if CG in mean else Open(why), figures, criterion=rule.format("the smallest"))
    largest = max(by_solver[BICGSTAB], default=math.nan)
    others = [v for i, values in by_solver.items() if i != BICGSTAB for v in values]
    few = sum(v < SMALL_VARIATION for v in others)
    report.finding(where, "The iterations vary by more than 20 % with Bi-CGSTAB, with the others mostly by less than "
                   "10 %", unless(why, largest > LARGE_VARIATION and 2 * few > len(others)),
                   f"Bi-CGSTAB up to {largest:.1%}; {few} of {len(others)} others below {SMALL_VARIATION:.0%}",
                   criterion=f"a combination of Bi-CGSTAB above {LARGE_VARIATION:.0%}, more than half of the others "
                   f"below {SMALL_VARIATION:.0%}")
