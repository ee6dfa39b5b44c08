# SPDX-License-Identifier: BSD-3-Clause
"""The restart of GMRES: section 2.7.3.1, Figure 2.3."""

from __future__ import annotations

import numpy as np

from ._report import Report, pyplot
from ._solvers import LABELS, PDES, TITLES, Solve
from ._solvers import initial_mesh, options, setup_of, sizes_up_to, smoothed, solve, trouble
from ._verdicts import all_of, faster, quickest, unless

RESTARTS = (10, 30, 50, 100, 200)
SSOR_GMRES = 6
DEFAULT_RESTART = 30
DOMAIN = "wrench"
#: The problem of Figure 2.3; the text states the same of the others.
SHOWN = "poisson"


def main(arguments: list[str]) -> int:
    given = options("solver_restart", __doc__).parse_args(arguments)
    report = Report("solver_restart", "The restart value of GMRES (section 2.7.3.1, Figure 2.3)", given)
    report.text(f"The problems of Table 2.3 on meshes smoothed by IMR, {LABELS[SSOR_GMRES]}.")
    for seed in report.seeds:
        for domain in given.domain or (DOMAIN,):
            for pde in given.pde or PDES:
                sizes = sizes_up_to(given, pde)
                meshes = {n: smoothed(initial_mesh(domain, n, seed), "imr", given.threads) for n in sizes}
                setup = setup_of(given, [SSOR_GMRES])
                found = {m: [solve(mesh, PDES[pde], setup, restart=m)[SSOR_GMRES] for mesh in meshes.values()]
                         for m in RESTARTS}
                for what in ("iterations", "seconds"):
                    rows = [[f"GMRES({m})", *(getattr(s, what) if s.converged else float("nan") for s in solves)]
                            for m, solves in found.items()]
                    report.table(f"{what}_{pde}_{domain}", f"Figure 2.3, {what}, {TITLES[pde]}, {domain}",
                                 ["restart", *(f"{n:,} vertices" for n in sizes)], rows)
                if (pde, domain) == (SHOWN, DOMAIN):
                    chart(report, sizes, found)
                findings(report, pde, domain, {m: solves[-1] for m, solves in found.items()})
    return report.finish()


def findings(report: Report, pde: str, domain: str, last: dict[int, Solve]) -> None:
    """The findings on the solves of the finest mesh, by restart value."""
    why = next((why for s in last.values() if (why := trouble({s.number: s}, [s.number]))), "")
    counts = [last[m].iterations for m in RESTARTS]
    part = {what: f"Figure 2.3 ({what})" if pde == SHOWN else "2.7.3.1" for what in "ab"}
    where = {what: f"{part[what]}, {domain}, {pde}" for what in "ab"}
    report.finding(where["a"], "The larger the restart value, the fewer iterations",
                   unless(why, all(a > b for a, b in zip(counts, counts[1:]))),
                   ", ".join(f"{m}: {s.iterations}" for m, s in last.items()),
                   criterion="fewer iterations with each larger restart value, on the finest mesh")
    times = {m: s.times for m, s in last.items()}
    shown = ", ".join(f"{m}: {t}" for m, t in times.items())
    noise = "by more than the noise of the times, on the finest mesh"
    report.finding(where["b"], f"A restart value of {DEFAULT_RESTART} takes the least time",
                   unless(why, quickest(times, DEFAULT_RESTART)), shown,
                   criterion=f"less time than with each other restart value, {noise}")
    steps = [(a, b) if a >= DEFAULT_RESTART else (b, a) for a, b in zip(RESTARTS, RESTARTS[1:])]
    report.finding(where["b"], f"The time increases as the restart value departs from {DEFAULT_RESTART}",
                   unless(why, all_of(faster(times[near], times[far]) for near, far in steps)), shown,
                   criterion=f"less time than with the next value farther from {DEFAULT_RESTART}, {noise}")


def chart(report: Report, sizes: list[int], found: dict[int, list[Solve]]) -> None:
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
