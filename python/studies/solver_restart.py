# SPDX-License-Identifier: BSD-3-Clause
"""The restart of GMRES: section 2.7.3.1, Figure 2.3."""

from __future__ import annotations

import numpy as np

from ._report import Report, pyplot
from ._solvers import FULL, LABELS, SIZES, Solve, initial_mesh, options, size_of, smoothed, solve
from ._verdicts import quickest

RESTARTS = (10, 30, 50, 100, 200)
SSOR_GMRES = 6
SMALL_SIZES = (500, 1_000, 2_000)
DEFAULT_RESTART = 30


def main(arguments: list[str]) -> int:
    given = options("solver_restart", __doc__, pdes=False).parse_args(arguments)
    given.combinations = [SSOR_GMRES]
    largest = size_of(given, FULL)
    sizes = [n for n in (SMALL_SIZES if given.small else SIZES) if n <= largest] or [largest]
    report = Report("solver_restart", "The restart value of GMRES (section 2.7.3.1, Figure 2.3)",
                    given.out, given.small)
    report.text(f"Poisson's equation on the wrench smoothed by IMR, {LABELS[SSOR_GMRES]}.")
    found = {m: [] for m in RESTARTS}
    for size in sizes:
        mesh = smoothed(initial_mesh("wrench", size), "imr", given.threads)
        for restart in RESTARTS:
            found[restart].append(solve(mesh, "poisson", given, restart=restart)[SSOR_GMRES])
    for what in ("iterations", "seconds"):
        rows = [[f"GMRES({m})", *(getattr(s, what) for s in solves)] for m, solves in found.items()]
        report.table(what, f"Figure 2.3, {what}", ["restart", *(f"{n:,} vertices" for n in sizes)], rows)
    chart(report, sizes, found)
    findings(report, {m: solves[-1] for m, solves in found.items()})
    return report.finish()


def findings(report: Report, last: dict[int, Solve]) -> None:
    """The findings on the solves of the finest mesh, by restart value."""
    counts = [last[m].iterations for m in RESTARTS]
    report.finding("Figure 2.3 (a)", "The larger the restart value, the fewer iterations",
                   counts == sorted(counts, reverse=True),
                   ", ".join(f"{m}: {s.iterations}" for m, s in last.items()))
    times = {m: s.times for m, s in last.items()}
    report.finding("Figure 2.3 (b)", "A restart value of 30 takes the least time", quickest(times, DEFAULT_RESTART),
                   ", ".join(f"{m}: {t}" for m, t in times.items()))


def chart(report: Report, sizes: list[int], found: dict) -> None:
    if pyplot is None:
        return
    figure, axes = pyplot.subplots(1, 2, figsize=(12.8, 4.6))
    for axis, what in zip(axes, ("iterations", "seconds")):
        for m, solves in found.items():
            axis.plot(np.array(sizes) / 1000, [getattr(s, what) for s in solves], "o-", label=f"m = {m}")
        axis.set(xlabel="thousand vertices", ylabel=what)
        axis.grid(alpha=0.3)
    axes[0].legend(fontsize=8)
    report.save(figure, "figure_2_3")
