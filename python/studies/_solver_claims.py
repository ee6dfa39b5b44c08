# SPDX-License-Identifier: BSD-3-Clause
"""Claims of sections 2.7.3 and 2.8 on metrics and on the factor that matters the most, by our and printed times."""

from __future__ import annotations

import math
from typing import Callable, Iterable

from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._memory import remembered
from ._report import Report
from ._solver_tables import BY_METRIC, COMBINATIONS, METRICS
from ._solvers import SOLVERS, Solve, most_of, trouble
from ._verdicts import Open, Times, Verdict, TIME_MARGIN, all_of, faster, less

#: Solves by metric and number of the combination.
Rows = dict[str, dict[int, Solve]]
#: Relative error to which eigenvalues are computed.
EIGENVALUE_ERROR = 1e-4
#: The same of A, where metrics are compared, whose smallest eigenvalues have five digits in common.
FINE_ERROR = 1e-7
#: The factors of a time.
FACTORS = ("metric", "preconditioner", "solver")


def printed_rows(pde: str, domain: str) -> Rows:
    """The solves of Tables 2.8, 2.10 and 2.11, as if each had run once."""
    return {metric: {n: _printed(n, seconds[n - 1], counts[n - 1]) for n in COMBINATIONS}
            for metric, (seconds, counts) in BY_METRIC[pde, domain].items()}


def _printed(number: int, seconds: float | None, iterations: float | None) -> Solve:
    known = seconds is not None and iterations is not None
    return Solve(number, Times((seconds or 0.0,)), int(iterations or 0), known, False, "" if known else "failed")


# --- the best and the worst metric ------------------------------------------------------------------------------


def better(one: Solve, other: Solve) -> Verdict:
    """Whether one solve is faster; where the times are within their noise, whether it has fewer iterations.

    The matrices of meshes that differ in their points only have one sparsity pattern, so that iterations are work.
    """
    verdict = faster(one.times, other.times)
    return one.iterations < other.iterations if isinstance(verdict, Open) else verdict


def extreme(rows: Rows, metric: str, ahead: Callable[[Solve, Solve], Verdict]) -> dict[int, Verdict]:
    """By combination, whether the metric is ahead of all others; not decided where it failed with one of them."""
    numbers = [n for n in COMBINATIONS if all(n in row for row in rows.values())]
    failed = {n: next((why for row in rows.values() if (why := trouble(row, [n]))), "") for n in numbers}
    return {n: Open(failed[n]) if failed[n] else
            all_of(ahead(rows[metric][n], row[n]) for m, row in rows.items() if m != metric) for n in numbers}


def counted(found: dict[int, Verdict]) -> str:
    """How many hold, of how many that are decided."""
    decided = [v for v in found.values() if not isinstance(v, Open)]
    return f"in {sum(map(bool, decided))} of {len(decided)} combinations that converge with all metrics"


def metric_findings(report: Report, pde: str, domain: str, rows: Rows) -> None:
    """RR and SS, the best and the worst metric for the solver time."""
    where = f"2.8, {domain}, {pde}"
    rule = ("in more than half of the combinations, where those that fail with a metric are not decided, its time is "
            "{} than with each other metric by more than the noise, or, where times are within the noise, its "
            "iterations are {}")
    for metric, word, other, ahead in (("rr", "less", "fewer", better),
                                       ("ss", "more", "more", lambda one, two: better(two, one))):
        ours, printed = (extreme(solves, metric, ahead) for solves in (rows, printed_rows(pde, domain)))
        superlative = "most" if metric == "rr" else "least"
        report.finding(where, f"{metric.upper()} is the {superlative} efficient metric for the solver time",
                       most_of(ours.values()), counted(ours),
                       criterion=rule.format(word, other),
                       stated="by the printed times and iterations " + counted(printed))


# --- the factor that matters the most ---------------------------------------------------------------------------


def effects(times: dict[tuple[str, int], float]) -> dict[str, float]:
    """Per factor, the geometric mean of the largest over the smallest time where only this factor changes.

    times: seconds by metric and number of the combination. Lines in which a time is missing do not count.
    """
    lines: dict[str, dict[tuple, list[float]]] = {factor: {} for factor in FACTORS}
    for metric in METRICS:
        for n in COMBINATIONS:
            preconditioner, solver = divmod(n - 1, len(SOLVERS))
            for factor, line in zip(FACTORS, ((preconditioner, solver), (metric, solver), (metric, preconditioner))):
                lines[factor].setdefault(line, []).append(times.get((metric, n), math.nan))
    return {factor: _mean_ratio(found.values()) for factor, found in lines.items()}


def _mean_ratio(lines: Iterable[list[float]]) -> float:
    logs = [math.log(max(line) / min(line)) for line in lines if all(v > 0 for v in line)]
    return math.exp(sum(logs) / len(logs)) if logs else math.nan


def seconds_of(rows: Rows, smooth: dict[str, float] | None = None) -> dict[tuple[str, int], float]:
    """The times of the combinations that converged; with the times of smoothing, if they are given."""
    return {(m, n): s.seconds + (smooth[m] if smooth else 0.0)
            for m, row in rows.items() for n, s in row.items() if n in COMBINATIONS and s.converged}


def matters_most(found: dict[str, float], factor: str) -> Verdict:
    return all_of(less(found[other], found[factor], TIME_MARGIN) for other in FACTORS if other != factor)


def described(found: dict[str, float]) -> str:
    return ", ".join(f"{name} {ratio:.2f}" for name, ratio in found.items())


def factor_findings(report: Report, pde: str, domain: str, rows: Rows, smooth: dict[str, Times],
                    printed_smooth: dict[str, float]) -> None:
    """Which of metric, preconditioner and solver matters the most; printed_smooth: seconds of Table 2.6."""
    rule = ("the mean ratio of the largest to the smallest time where only this factor changes is larger than with the "
            f"other factors by more than {TIME_MARGIN:.0%}; lines of the table with a failure do not count")
    printed = printed_rows(pde, domain)
    best = {m: t.best for m, t in smooth.items()}
    for factor, of, added, there in (("preconditioner", "solver time", None, None),
                                     ("metric", "total time", best, printed_smooth)):
        ours = effects(seconds_of(rows, added))
        report.finding(f"2.8, {domain}, {pde}", f"The {factor} matters the most for the {of}",
                       matters_most(ours, factor), "largest over smallest time: " + described(ours), criterion=rule,
                       stated="by the printed times " + described(effects(seconds_of(printed, there))))


# --- eigenvalues ------------------------------------------------------------------------------------------------


@remembered
def extreme_eigenvalues(mesh: vtkDataSet, threads: int, preconditioner: str = "none",
                        error: float = EIGENVALUE_ERROR) -> tuple[float, float]:
    """The largest and the smallest eigenvalue of P^-1 A of Poisson's equation; nan: not found to the error."""
    row = tautline.condition(mesh, preconditioner=preconditioner, tolerance=error, shares=False,
                             threads=threads).spectrum[-1]
    return (row["largest"], row["smallest"]) if row["converged"] else (math.nan, math.nan)


def eigenvalue_findings(report: Report, domain: str, found: dict[str, tuple[float, float]]) -> None:
    """The extreme eigenvalues of A by metric, where SS is said to have the widest spectrum."""
    report.table(f"poisson_eigenvalues_{domain}", f"Extreme eigenvalues of A, Poisson's equation, {domain}",
                 ["metric", "largest", "smallest"], [[m, *pair] for m, pair in found.items()])
    others = [m for m in found if m != "ss"]
    for k, name, word in ((0, "largest", "larger"), (1, "smallest", "smaller")):
        values = {m: pair[k] * (1 if k else -1) for m, pair in found.items()}
        report.finding(f"2.7.3.2, {domain}", f"With SS the {name} eigenvalue of A is {word} than with the others",
                       all_of(less(values["ss"], values[m], 2 * FINE_ERROR) for m in others),
                       ", ".join(f"{m} {pair[k]:.6g}" for m, pair in found.items()),
                       criterion=f"{word} by more than the relative error of both, {FINE_ERROR:g} each")
