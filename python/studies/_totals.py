# SPDX-License-Identifier: BSD-3-Clause
"""Claims of section 2.7.3 on the solver time, the total time (smoothing and solver) and the sensitivity to metrics."""

from __future__ import annotations

from ._report import Report
from ._solver_tables import COMBINATIONS, METRICS
from ._solvers import AMG, LABELS, SOLVERS, TITLES, Solve
from ._verdicts import Times, Verdict, all_of, below, faster

JACOBI_GMRES, ILU_CG, ILU_MINRES, CG_AMG = 2, 9, 11, 13
#: The best and the worst (metric, combination) that the text names, and how much less the solver time of the best is.
SOLVER_CLAIMS = {
    "poisson": (("imr", CG_AMG), ("imr", JACOBI_GMRES), 0.97),
    "elliptic": (("rr", CG_AMG), ("si", JACOBI_GMRES), 0.95),
    "elasticity": (("imr", ILU_CG), ("rr", JACOBI_GMRES), 0.92),
}
#: The text rounds, and compares different rows; a time that is larger by this part of the other one, and by this part
#: of itself, still agrees with it.
CLAIM_TOLERANCE, CLAIM_FACTOR = 0.05, 0.4
#: How much less the total time with IMR is than with SS: (combination, reduction). The text names SI for Jacobi with
#: GMRES, where its printed numbers give SS.
TOTAL_CLAIMS = {
    "poisson": ((CG_AMG, 0.90), (JACOBI_GMRES, 0.45)),
    "elasticity": ((ILU_MINRES, 0.71), (JACOBI_GMRES, 0.16)),
}
#: "IMR > RR > SI > SS", from the fastest to the slowest.
ORDER = METRICS
#: Variation of the iterations over the metrics: "more than 20 %" of Bi-CGSTAB, "less than 10 %" of the others.
LARGE_VARIATION, SMALL_VARIATION = 0.20, 0.10
BICGSTAB = SOLVERS.index("Bi-CGSTAB")
CG = SOLVERS.index("CG")

Rows = dict[str, dict[int, Solve]]


def less(one: Times, other: Times, reduction: float) -> Verdict:
    """Whether a time is less than another one by a part of it, within the tolerance of the claims."""
    return below(one, other, 1 - reduction + min(CLAIM_TOLERANCE, CLAIM_FACTOR * (1 - reduction)))


def totals(rows: Rows, smooth: dict[str, Times], number: int) -> dict[str, Times]:
    """Smoothing and solver time of a combination by metric, of those that converged."""
    return {m: smooth[m] + row[number].times for m, row in rows.items() if number in row and row[number].converged}


def total_table(report: Report, pde: str, domain: str, rows: Rows, smooth: dict[str, Times]) -> None:
    """The total times per metric and combination."""
    numbers = [n for n in rows["imr"] if n in COMBINATIONS]
    found = {n: totals(rows, smooth, n) for n in numbers}
    lines = [[m, smooth[m].best, *(found[n][m].best if m in found[n] else float("nan") for n in numbers)]
             for m in METRICS]
    report.table(f"total_{pde}_{domain}", f"Total time (smoothing and solver, CPU s), {TITLES[pde]}, {domain}",
                 ["metric", "smoothing", *(str(n) for n in numbers)], lines)


def total_findings(report: Report, pde: str, domain: str, rows: Rows, smooth: dict[str, Times]) -> None:
    where = f"2.7.3, {domain}, {pde}"
    *named, share = SOLVER_CLAIMS[pde]
    if all(n in rows[m] for m, n in named):
        best, worst = (rows[m][n] for m, n in named)
        report.finding(where, f"The solver time of the best combination is {share:.0%} less than that of the worst one",
                       less(best.times, worst.times, share) if best.converged and worst.converged else None,
                       "; ".join(f"{m}, {LABELS[n]} {rows[m][n].times}" for m, n in named)
                       + f": {1 - best.seconds / worst.seconds:.1%}")
    for number, share in TOTAL_CLAIMS.get(pde, ()):
        found = totals(rows, smooth, number)
        if number not in rows["imr"]:
            continue
        report.finding(where, f"The total time of {LABELS[number]} with IMR is {share:.0%} less than with SS",
                       less(found["imr"], found["ss"], share) if {"imr", "ss"} <= set(found) else None,
                       ", ".join(f"{m} {t}" for m, t in found.items()) or "none converged")
    orders = {n: ranked(totals(rows, smooth, n)) for n in rows["imr"] if n in COMBINATIONS}
    kept = [n for n, verdict in orders.items() if verdict]
    open_ = [n for n, verdict in orders.items() if verdict is None]
    enough = 2 * len(kept) > len(orders)
    report.finding(where, "The metrics rank IMR, RR, SI, SS by the total time in most combinations",
                   True if enough else None if 2 * (len(kept) + len(open_)) > len(orders) else False,
                   f"{len(kept)} of {len(orders)} combinations, {len(open_)} are not decided; smoothing alone: "
                   + ", ".join(f"{m} {t}" for m, t in smooth.items()))


def ranked(found: dict[str, Times]) -> Verdict:
    """Whether the metrics are in the stated order; not decided where one did not converge."""
    pairs = [(a, b) for a, b in zip(ORDER, ORDER[1:]) if a in found and b in found]
    return all_of([faster(found[a], found[b]) for a, b in pairs] + [None] * (len(found) < len(ORDER)))


def variation(rows: Rows) -> dict[int, float]:
    """(largest - smallest) / smallest number of iterations over the metrics, by combination without AMG."""
    found = {}
    for number in rows["imr"]:
        counts = [row[number].iterations for row in rows.values() if row[number].converged]
        if number in COMBINATIONS and number not in AMG and len(counts) > 1:
            found[number] = max(counts) / max(min(counts), 1) - 1
    return found


def sensitivity_findings(report: Report, pde: str, domain: str, rows: Rows) -> None:
    where = f"2.7.3, {domain}, {pde}"
    found = variation(rows)
    by_solver = {i: [v for n, v in found.items() if (n - 1) % len(SOLVERS) == i] for i in range(len(SOLVERS))}
    if not all(by_solver.values()):
        return
    mean = {i: sum(values) / len(values) for i, values in by_solver.items()}
    figures = "mean variation of the iterations over the metrics: " + ", ".join(
        f"{SOLVERS[i]} {v:.1%}" for i, v in mean.items())
    report.finding(where, "Bi-CGSTAB is the most sensitive to the metric", max(mean, key=mean.get) == BICGSTAB, figures)
    if pde != "elasticity":
        report.finding(where, "CG is the least affected by the metric", min(mean, key=mean.get) == CG, figures)
    largest = max(by_solver[BICGSTAB])
    others = [v for i, values in by_solver.items() if i != BICGSTAB for v in values]
    few = sum(v < SMALL_VARIATION for v in others)
    report.finding(where, f"Its iterations vary by up to {LARGE_VARIATION:.0%} and more, those of the others mostly by "
                   f"less than {SMALL_VARIATION:.0%}", largest >= LARGE_VARIATION and 2 * few > len(others),
                   f"Bi-CGSTAB up to {largest:.1%}; {few} of {len(others)} others below {SMALL_VARIATION:.0%}")
