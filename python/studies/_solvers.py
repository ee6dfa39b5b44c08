# SPDX-License-Identifier: BSD-3-Clause
"""Shared by the studies of linear solvers: meshes of chapter 2, the combinations of Table 2.5, tables and charts."""

from __future__ import annotations

import argparse
import math
import sys
import time
from dataclasses import dataclass
from typing import Any, Iterable, Sequence

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._common import Method, Run, improve
from ._memory import remembered
from ._report import Report, parser, pyplot
from ._solver_tables import CELLS, COMBINATIONS, METRICS
from ._verdicts import COUNT_TOLERANCE, Open, Times, Verdict, all_of, any_of, faster, same_count

DOMAINS = ("wrench", "hinge")
#: The three problems of Table 2.3.
PDES = {
    "poisson": {"pde": "poisson", "source": 1.0},
    "elliptic": {"pde": "elliptic", "source": 1.0, "reaction": 100.0},
    "elasticity": {"pde": "elasticity", "source": (1.0, 0.0, 0.0), "youngs_modulus": 1.0, "poisson_ratio": 0.3},
}
TITLES = {"poisson": "Poisson's equation (A)", "elliptic": "general second order (B)", "elasticity": "elasticity (C)"}
SOLVERS = ("CG", "GMRES", "MINRES", "Bi-CGSTAB")
PRECONDITIONERS = ("Jacobi", "SSOR", "ILU(0)", "AMG")
#: In addition to Table 2.5, for elasticity: multigrid with the rigid body modes.
NEAR_NULL_SPACE = (19, 24)
LABELS = {
    **{n: f"{PRECONDITIONERS[(n - 1) // 4]} + {SOLVERS[(n - 1) % 4]}" for n in COMBINATIONS},
    **{n: tautline.solver_combinations()[n] for n in NEAR_NULL_SPACE},
}
JACOBI, SSOR, ILU, AMG = (tuple(COMBINATIONS[4 * i : 4 * i + 4]) for i in range(4))
#: Reduction of the objective at which smoothing stops, section 2.4.
REDUCTION = 0.95
SWEEPS = 200
#: Relative change of the objective in an iteration at which a mesh is completely smoothed.
CONVERGED = 1e-5
INITIAL_FRACTION = 0.5  # of the interior vertices, perturbed before smoothing
FULL, SMALL = 500_000, 1_000
REPEATS = 3  # runs of each combination, for their times
#: CPU seconds from which a combination is run once: the noise is a smaller part of longer times.
LONG = 2.0
#: Shorter ones are repeated until their runs have taken this many CPU seconds, or this many times.
ENOUGH, MOST_RUNS = 1.0, 10
#: Why ours does not fail where the printed one does.
POSITIVE = ("without inverted elements the matrix, Jacobi's preconditioner and SSOR are positive definite, so that CG "
            "and MINRES with these cannot break down; all combinations converge on our meshes")
SIZES = tuple(CELLS["wrench"])

#: Columns of a table that are shown beside each other.
COLUMNS_SHOWN = 8


def options(name: str, text: str | None, pdes: bool = True, full: int = FULL) -> argparse.ArgumentParser:
    """The options of a study of solvers; --size is a number of vertices."""
    made = parser(name, text, repeats=REPEATS, seeds=True)
    made.add_argument("--size", type=vertices, default=0, metavar="N",
                      help=f"vertices of each mesh, 10K to 500K (default: {full // 1000}K)")
    made.add_argument("--domain", choices=DOMAINS, action="append", help="one of the two domains (default: both)")
    made.add_argument("--time-limit", type=float, default=0.0, metavar="SECONDS",
                      help="of a combination; unfinished ones are shown as '>' (default: none)")
    made.add_argument("--combinations", type=int, nargs="+", default=list(COMBINATIONS), metavar="N",
                      help="numbers of Table 2.5 (default: all)")
    if pdes:
        made.add_argument("--elasticity-size", type=vertices, default=0, metavar="N", help="vertices of each mesh for "
                          "elasticity, whose systems take ten times as long (default: as the others)")
        made.add_argument("--pde", choices=tuple(PDES), action="append", help="one of the problems (default: all)")
    return made


def vertices(text: str) -> int:
    """The number of a text that may end in K, for thousands."""
    factor, digits = (1000, text[:-1]) if text[-1:].upper() == "K" else (1, text)
    if not digits.isdigit() or int(digits) == 0:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of vertices such as 10000 or 500K")
    return factor * int(digits)


def size_of(given: argparse.Namespace, full: int = FULL, small: int = SMALL, pde: str = "") -> int:
    """The number of vertices, of the meshes for a problem."""
    own = given.elasticity_size if pde == "elasticity" else 0
    return own or given.size or (small if given.small else full)


def sizes_up_to(given: argparse.Namespace, pde: str = "") -> list[int]:
    """The sizes of Table 2.4 up to the largest one of a study or problem; in a small study its half and its quarter."""
    largest = size_of(given, small=2 * SMALL, pde=pde)
    lower = [n for n in SIZES if n < largest] or [largest // 4, largest // 2]
    return [*lower, largest]


# --- meshes ---------------------------------------------------------------------------------------------


def initial_mesh(domain: str, size: int, seed: int = 1) -> vtkDataSet:
    """A mesh of about `size` vertices, half of the interior ones perturbed, as the dissertation's before smoothing."""
    # A planar mesh has about two triangles per vertex; Table 2.4 has the exact numbers for its sizes.
    cells = CELLS[domain].get(size, 2 * size)
    return tautline.perturb(tautline.domain(domain, cells), fraction=INITIAL_FRACTION, seed=seed).mesh


def smoothed(mesh: vtkDataSet, metric: str, threads: int) -> vtkDataSet:
    """The mesh smoothed to 95 % of the possible reduction (section 2.4)."""
    return smoothing(mesh, metric, threads).mesh


def template(metric: str) -> str:
    """How the values of the elements are aggregated: (2.5) and (2.6); other metrics have their own aggregation."""
    if metric not in METRICS:
        return "default"
    return "sum of squared reciprocals" if metric in ("si", "ss") else "sum of squares"


def _smooth(mesh: vtkDataSet, metric: str, sweeps: int, threads: int, **more: Any) -> Run:
    return improve(mesh, Method(metric, metric, (metric,)), sweeps, ["imr_mean"], template=template(metric),
                   trace=False, threads=threads, **more)


@remembered
def best_objective(mesh: vtkDataSet, metric: str, threads: int) -> float:
    """The objective of the completely smoothed mesh: by L-BFGS after sweeps of Local Newton."""
    run = _smooth(mesh, metric, 2 * SWEEPS, threads, optimizer="automatic", relative_change=CONVERGED)
    return float(run.values["objective"].min())


@remembered
def smoothing(mesh: vtkDataSet, metric: str, threads: int, repeats: int = 1, optimizer: str = "nlcg",
              share: float = REDUCTION, best: float | None = None) -> Run:
    """Smooth to a share of the possible reduction (section 2.4); a share of 1 is until it converges.

    best: the objective of the completely smoothed mesh. repeats: runs, for the times.
    """
    if best is None:
        best = best_objective(mesh, metric, threads)
    return _smooth(mesh, metric, SWEEPS, threads, optimizer=optimizer, reduction=share, best_known=best,
                   relative_change=CONVERGED if share == 1 else 0.0, repeats=repeats)


# --- solves ---------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Setup:
    """How combinations are run."""

    combinations: tuple[int, ...]
    #: Seconds of a combination; 0: no limit.
    time_limit: float
    repeats: int
    threads: int


def setup_of(given: argparse.Namespace, combinations: Sequence[int] = ()) -> Setup:
    return Setup(tuple(combinations or given.combinations), given.time_limit, given.repeats, given.threads)


@dataclass(frozen=True)
class Solve:
    """The result of a combination of solver and preconditioner."""

    number: int
    #: CPU seconds including the set-up of the preconditioner, of each run.
    times: Times
    iterations: int
    converged: bool
    #: Stopped at the time limit: neither converged nor failed.
    unfinished: bool
    reason: str

    @property
    def seconds(self) -> float:
        """CPU seconds of the fastest run."""
        return self.times.best

    @property
    def failed(self) -> bool:
        return not self.converged and not self.unfinished

    def shown(self, value: float) -> str:
        if self.unfinished:
            return f">{value:,.4g}"
        return f"{value:,.4g}" if self.converged else "*"


@remembered
def solve(mesh: vtkDataSet, problem: dict[str, Any], setup: Setup, **more: Any) -> dict[int, Solve]:
    """Run combinations on one mesh; problem: options of solver_study(), such as the entries of PDES."""
    options = {"combinations": list(setup.combinations), "combination_time_limit": setup.time_limit, "time_limit": 0.0,
               "conditions": False, "threads": setup.threads, **problem, **more}
    began = time.perf_counter()
    runs = {row["number"]: [row] for row in tautline.solver_study(mesh, **options).rows}
    for run in range(1, MOST_RUNS if setup.repeats > 1 else 1):
        again = [n for n, rows in runs.items() if rows[0]["cpu_seconds"] < LONG and (
            run < setup.repeats or sum(row["cpu_seconds"] for row in rows) < ENOUGH)]
        if again:
            for row in tautline.solver_study(mesh, **{**options, "combinations": again}).rows:
                runs[row["number"]].append(row)
    if mesh.GetNumberOfPoints() >= SIZES[1]:
        print(f"{problem['pde']}: {time.perf_counter() - began:.0f} s", file=sys.stderr, flush=True)
    return {n: _solve(rows) for n, rows in runs.items()}


def _solve(rows: Sequence[dict[str, Any]]) -> Solve:
    """A combination of its rows in several runs of the study."""
    failing = [r for r in rows if not r["converged"]]
    row = failing[0] if failing else min(rows, key=lambda r: r["cpu_seconds"])
    return Solve(row["number"], Times(tuple(r["cpu_seconds"] for r in rows)), row["iterations"],
                 not failing, "time limit" in row["reason"], row["reason"])


def trouble(row: dict[int, Solve], numbers: Iterable[int]) -> str:
    """Why the times of combinations do not count; "": they do."""
    for n in numbers:
        if n not in row:
            return f"{LABELS[n]} was not run"
        if not row[n].converged:
            return f"{LABELS[n]} {'did not finish' if row[n].unfinished else 'failed'}: {row[n].reason}"
    return ""


def most_of(verdicts: Iterable[Verdict]) -> Verdict:
    """Whether more than half hold; not decided if those that are not decided make the difference."""
    found = list(verdicts)
    undecided = [v for v in found if isinstance(v, Open)]
    holding = sum(bool(v) for v in found if not isinstance(v, Open))
    if 2 * holding > len(found):
        return True
    if found and 2 * (holding + len(undecided)) <= len(found):
        return False
    return Open(f"{len(undecided)} of {len(found)} are not decided: {undecided[0].reason}" if undecided
                else "there is nothing to compare")


# --- reports --------------------------------------------------------------------------------------------


def table(report: Report, file: str, title: str, found: dict, theirs: dict, head: str) -> None:
    """Two tables, iterations and seconds, of rows {label: {number: Solve}}; the dissertation's numbers in brackets."""
    numbers = sorted({n for row in found.values() for n in row})
    for what, place in (("iterations", 1), ("seconds", 0)):
        rows, shown = [], []
        for label, row in found.items():
            known = theirs.get(label)
            cells, texts = [], []
            for n in numbers:
                s = row[n]
                value = s.iterations if what == "iterations" else s.seconds
                printed = known is not None and n in COMBINATIONS
                other = known[place][n - 1] if printed else None
                cells += [value, "yes" if s.converged else "no", s.reason, "" if other is None else other]
                text = s.shown(value)
                texts.append(text + (f" ({'*' if other is None else f'{other:g}'})" if printed else ""))
            rows.append([label, *cells])
            shown.append([label, *texts])
        headings = [h for n in numbers for h in (f"{n} {what}", f"{n} converged", f"{n} reason", f"{n} dissertation")]
        report.csv(f"{file}_{what}", [head, *headings], rows)
        note = f"{'; the dissertation in brackets' if theirs else ''}; '*' is a failure"
        for part in range(0, len(numbers), COLUMNS_SHOWN):
            columns = numbers[part : part + COLUMNS_SHOWN]
            report.aligned(f"{title}, {what}{note}", [head, *columns],
                           [[row[0], *row[1 + part : 1 + part + COLUMNS_SHOWN]] for row in shown],
                           f"{file}_{what}_{columns[0]}_to_{columns[-1]}")


def count_finding(report: Report, where: str, label: str, row: dict[int, Solve],
                  theirs: Sequence[float | None]) -> None:
    """Whether the iterations are the printed ones, where both converged."""
    both = [n for n in row if n in COMBINATIONS and row[n].converged and theirs[n - 1] is not None]
    off = [n for n in both if not same_count(row[n].iterations, theirs[n - 1])]
    report.finding(where, f"The numbers of iterations with {label} are the printed ones",
                   not off if both else Open("none converged both here and there"),
                   f"{len(both) - len(off)} of {len(both)}" + "".join(
                       f"; {LABELS[n]} {row[n].iterations}, printed {theirs[n - 1]:g}" for n in off),
                   criterion=f"each differs from the printed one by at most {COUNT_TOLERANCE:.0%} of it",
                   stated=", ".join(f"{n}: {theirs[n - 1]:g}" for n in both))


def times_of(row: dict[int, Solve], without: Sequence[int] = ()) -> dict[int, Times]:
    """The times of the converged combinations."""
    return {n: s.times for n, s in row.items() if s.converged and n not in without}


def group_is_faster(row: dict[int, Solve], group: tuple[int, ...], every: bool = False) -> Verdict:
    """Whether one of a group of combinations (every: each) is faster than all outside it; not if it failed."""
    times = times_of(row, NEAR_NULL_SPACE)
    inside = {n: times.get(n, Open(trouble(row, [n]))) for n in group}
    outside = [t for n, t in times.items() if n not in group]
    verdicts = [t if isinstance(t, Open) else all_of(faster(t, other) for other in outside) for t in inside.values()]
    return all_of(verdicts) if every else any_of(verdicts)


def fastest(row: dict[int, Solve]) -> list[int]:
    """The numbers of the converged combinations, the fastest first."""
    return sorted((n for n, s in row.items() if s.converged), key=lambda n: row[n].seconds)


def bars(report: Report, file: str, title: str, series: dict[str, dict[int, float]], label: str,
         logarithmic: bool = False) -> None:
    """A chart with a bar per combination and series, as Figures 2.4 to 2.12; a missing bar is a failure."""
    if pyplot is None:
        return
    figure, axis = pyplot.subplots(figsize=(9.0, 4.6))
    width = 0.8 / len(series)
    for i, (name, values) in enumerate(series.items()):
        numbers = sorted(values)
        offset = (i - 0.5 * (len(series) - 1)) * width
        axis.bar(np.array(numbers) + offset, [values[n] for n in numbers], width, label=name)
    axis.set(title=title, xlabel="combination of preconditioner and solver (Table 2.5)", ylabel=label,
             xticks=list(COMBINATIONS), yscale="log" if logarithmic else "linear")
    axis.grid(alpha=0.3, axis="y")
    axis.legend(fontsize=8)
    report.save(figure, file)


def order(sizes: Sequence[float], values: Sequence[float]) -> float:
    """s of O(N^s) by linear least squares of the logarithms."""
    return float(np.polyfit(np.log(sizes), np.log(np.maximum(values, math.ulp(0.0))), 1)[0])
