# SPDX-License-Identifier: BSD-3-Clause
"""Shared by the studies of linear solvers: meshes of chapter 2, the combinations of Table 2.5, tables and charts."""

from __future__ import annotations

import argparse
import sys
import time
from dataclasses import dataclass
from typing import Any, Sequence

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._common import Method, Run, improve
from ._report import Report, parser, pyplot
from ._solver_tables import CELLS, COMBINATIONS
from ._verdicts import Times

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
INITIAL_FRACTION = 0.5  # of the interior vertices, perturbed before smoothing
FULL, SMALL = 500_000, 1_000
REPEATS = 3  # runs of each combination, for their times
SIZES = tuple(CELLS["wrench"])


def options(name: str, text: str | None, pdes: bool = True, full: int = FULL) -> argparse.ArgumentParser:
    """The options of a study of solvers; --size is a number of vertices."""
    made = parser(name, text, repeats=REPEATS)
    made.add_argument("--size", type=vertices, default=0, metavar="N",
                      help=f"vertices of each mesh, 10K to 500K (default: {full // 1000}K)")
    made.add_argument("--domain", choices=DOMAINS, action="append", help="one of the two domains (default: both)")
    made.add_argument("--time-limit", type=float, default=0.0, metavar="SECONDS",
                      help="of a combination; unfinished ones are shown as '>' (default: none)")
    made.add_argument("--combinations", type=int, nargs="+", default=list(COMBINATIONS), metavar="N",
                      help="numbers of Table 2.5 (default: all)")
    if pdes:
        made.add_argument("--pde", choices=tuple(PDES), action="append", help="one of the problems (default: all)")
    return made


def vertices(text: str) -> int:
    """The number of a text that may end in K, for thousands."""
    factor, digits = (1000, text[:-1]) if text[-1:].upper() == "K" else (1, text)
    if not digits.isdigit() or int(digits) == 0:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of vertices such as 10000 or 500K")
    return factor * int(digits)


def size_of(given: argparse.Namespace, full: int = FULL) -> int:
    return given.size or (SMALL if given.small else full)


# --- meshes ---------------------------------------------------------------------------------------------


def initial_mesh(domain: str, size: int) -> vtkDataSet:
    """A mesh of about `size` vertices, half of the interior ones perturbed, as the dissertation's before smoothing."""
    # A planar mesh has about two triangles per vertex; Table 2.4 has the exact numbers for its sizes.
    cells = CELLS[domain].get(size, 2 * size)
    return tautline.perturb(tautline.domain(domain, cells), fraction=INITIAL_FRACTION).mesh


def smoothed(mesh: vtkDataSet, metric: str, threads: int) -> vtkDataSet:
    """The mesh smoothed to 95 % of the possible reduction (section 2.4)."""
    return smoothing(mesh, metric, threads).mesh


def smoothing(mesh: vtkDataSet, metric: str, threads: int, repeats: int = 1) -> Run:
    """Smooth to 95 % of the possible reduction (section 2.4); the best value is that of a converged run.

    repeats: runs, for the times; those of the converged run do not count.
    """
    method = Method(metric, metric, (metric,))
    template = "sum of squared reciprocals" if metric in ("si", "ss") else "sum of squares"
    common = dict(template=template, trace=False, threads=threads)
    best = improve(mesh, method, 2 * SWEEPS, ["imr_mean"], optimizer="automatic", relative_change=1e-5, **common)
    known = float(best.values["objective"].min())
    return improve(mesh, method, SWEEPS, ["imr_mean"], reduction=REDUCTION, best_known=known, repeats=repeats, **common)


# --- solves ---------------------------------------------------------------------------------------------


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

    def shown(self, value: float) -> str:
        if self.unfinished:
            return f">{value:,.4g}"
        return f"{value:,.4g}" if self.converged else "*"


def solve(mesh: vtkDataSet, pde: str, given: argparse.Namespace, **more) -> dict[int, Solve]:
    """Run the chosen combinations on one mesh."""
    options = {"combinations": list(given.combinations), "combination_time_limit": given.time_limit, "time_limit": 0.0,
               "conditions": False, "threads": given.threads, **PDES[pde], **more}
    began = time.perf_counter()
    runs = [tautline.solver_study(mesh, **options).rows for _ in range(given.repeats)]
    if mesh.GetNumberOfPoints() >= SIZES[1]:
        print(f"{pde}: {time.perf_counter() - began:.0f} s", file=sys.stderr, flush=True)
    return {rows[0]["number"]: _solve(rows) for rows in zip(*runs)}


def _solve(rows: Sequence[dict[str, Any]]) -> Solve:
    """A combination of its rows in several runs of the study."""
    row = min(rows, key=lambda r: r["cpu_seconds"])
    return Solve(row["number"], Times(tuple(r["cpu_seconds"] for r in rows)), row["iterations"], row["converged"],
                 "time limit" in row["reason"], row["reason"])


# --- reports --------------------------------------------------------------------------------------------


def table(report: Report, file: str, title: str, found: dict, theirs: dict, head: str) -> None:
    """Two tables, iterations and seconds, of rows {label: {number: Solve}}; in brackets those of the dissertation."""
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
        note = "; in brackets those of the dissertation, '*' is a failure"
        for part in range(0, len(numbers), 8):
            report.aligned(f"{title}, {what}{note}  [{file}_{what}.csv]", [head, *numbers[part : part + 8]],
                           [[row[0], *row[1 + part : 9 + part]] for row in shown])


def within(found: dict[int, Solve], theirs: Sequence[float | None], factor: float) -> tuple[int, int, str]:
    """The number of iteration counts that agree within a factor, the number of all in both, and those that disagree."""
    both = [n for n in found if n in COMBINATIONS and found[n].converged and theirs[n - 1] is not None]
    ratios = {n: found[n].iterations / theirs[n - 1] for n in both}
    off = {n: r for n, r in ratios.items() if not 1 / factor <= r <= factor}
    return len(both) - len(off), len(both), ", ".join(f"{n} {LABELS[n]}: {r:.2f} times" for n, r in off.items())


def times_of(row: dict[int, Solve], without: Sequence[int] = ()) -> dict[int, Times]:
    """The times of the converged combinations."""
    return {n: s.times for n, s in row.items() if s.converged and n not in without}


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
    return float(np.polyfit(np.log(sizes), np.log(values), 1)[0])
