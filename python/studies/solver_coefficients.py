# SPDX-License-Identifier: BSD-3-Clause
"""Efficiency of the combinations when C, f, a and the boundary conditions are varied: sections 2.2, 2.7.1, 2.7.3.3."""

from __future__ import annotations

import argparse
from typing import Any

from vtkmodules.vtkCommonDataModel import vtkDataSet

from ._report import Report
from ._solvers import LABELS, PDES, Solve, initial_mesh, options, setup_of, size_of, smoothed, solve, times_of
from ._verdicts import Open, Verdict, all_of, faster, is_not

SIZE = 100_000
DOMAIN = "wrench"
#: gamma of C = gamma I.
FACTORS = (0.01, 1.0, 100.0)
#: f of (2.3).
SOURCES: dict[str, Any] = {"1": 1.0, "1000": 1000.0, "sin(3 x) y": "sin(3*x)*y"}
#: a of (2.3) in the range of the dissertation, and beyond it.
REACTIONS, BEYOND = (1.0, 10.0, 100.0), (1e4, 1e6)
#: Iterations that do not depend on a coefficient differ by at most this number, by rounding errors.
SAME_ITERATIONS = 2
#: A ranking is decided if at least this part of the pairs of combinations is.
DECIDED = 0.5
RULE = (f"no pair of combinations is faster with one value and slower with another one by more than the noise, and at "
        f"least {DECIDED:.0%} of the pairs are decided with all values")

#: The solves of the combinations by the value of a coefficient.
Varied = dict[str, dict[int, Solve]]


def main(arguments: list[str]) -> int:
    given = options("solver_coefficients", __doc__, pdes=False, full=SIZE).parse_args(arguments)
    report = Report("solver_coefficients", "Coefficients and boundary conditions (sections 2.2, 2.7.1 and 2.7.3.3)",
                    given)
    report.text(
        "The general second-order equation -div(C grad u) + a u = f with C = gamma I, and elasticity with Young's "
        "modulus gamma, on meshes smoothed by IMR. Boundary conditions: u = 0 (the dissertation's), u = x, and u = 0 "
        "on the left half of the boundary with a free right half. One coefficient is varied at a time; CPU seconds of "
        f"{given.repeats} run(s). Two combinations are reversed where one is faster with one value and slower with "
        "another one, by more than the noise."
    )
    for seed in report.seeds:
        for domain in given.domain or (DOMAIN,):
            mesh = smoothed(initial_mesh(domain, size_of(given, SIZE), seed), "imr", given.threads)
            studied = runs(mesh, given)
            for number, (name, varied) in enumerate(studied.items()):
                rows = [[f"{n} {LABELS[n]}", *(row[n].iterations for row in varied.values()),
                         *(row[n].seconds for row in varied.values())] for n in given.combinations]
                report.table(f"{domain}_{number}", f"{domain}, {name} varied: iterations, then CPU s",
                             ["combination", *varied, *(f"{key}, s" for key in varied)], rows)
            findings(report, domain, studied)
    return report.finish()


def runs(mesh: vtkDataSet, given: argparse.Namespace) -> dict[str, Varied]:
    """The solves by what is varied."""
    setup = setup_of(given)
    done: dict[str, dict[int, Solve]] = {}

    def varied(pde: str, values: dict[str, dict[str, Any]]) -> Varied:
        """A problem with several values; each problem is solved once."""
        problems = {key: {**PDES[pde], **more} for key, more in values.items()}
        for p in problems.values():
            if repr(p) not in done:
                done[repr(p)] = solve(mesh, p, setup)
        return {key: done[repr(p)] for key, p in problems.items()}

    coefficients = {f"gamma = {g:g}": dict.fromkeys(("alpha", "beta", "gamma"), g) for g in FACTORS}
    free = {key: {**more, "reaction": 0.0} for key, more in coefficients.items()}
    x = mesh.GetBounds()[:2]
    half = f"x < {0.5 * (x[0] + x[1]):.6g}"
    conditions: dict[str, dict[str, Any]] = {"u = 0": {}, "u = x": {"given": "x"}, "left half": {"fixed": half}}
    return {
        "C, a = 0": varied("elliptic", free),
        "C, a = 100": varied("elliptic", coefficients),
        "Young's modulus": varied("elasticity", {f"E = {g:g}": {"youngs_modulus": g} for g in FACTORS}),
        "f": varied("elliptic", {f"f = {name}": {"source": f} for name, f in SOURCES.items()}),
        "a": varied("elliptic", {f"a = {a:g}": {"reaction": a} for a in REACTIONS}),
        "a > 100": varied("elliptic", {f"a = {a:g}": {"reaction": a} for a in (REACTIONS[0], *BEYOND)}),
        "boundary, poisson": varied("poisson", conditions),
        "boundary, elliptic": varied("elliptic", conditions),
        "boundary, elasticity": varied("elasticity", {**conditions, "u = x": {"given": "x*iHat"}}),
    }


def pairs(varied: Varied) -> dict[tuple[int, int], set[bool | None]]:
    """For each pair of combinations that converged with all values, whether the first is faster; None: not decided."""
    times = [times_of(row) for row in varied.values()]
    numbers = sorted(set.intersection(*(set(t) for t in times)))
    return {(a, b): {None if isinstance(v := faster(t[a], t[b]), Open) else bool(v) for t in times}
            for a in numbers for b in numbers if a < b}


def reversed_pairs(varied: Varied) -> list[tuple[int, int]]:
    """The pairs of combinations of which one is faster with one value and slower with another one."""
    return [pair for pair, orders in pairs(varied).items() if {True, False} <= orders]


def same_ranking(varied: Varied) -> Verdict:
    """Whether no pair is reversed; not decided where too few pairs are decided with all values."""
    found = pairs(varied)
    if reversed_pairs(varied):
        return False
    clear = sum(None not in orders for orders in found.values())
    if not found or clear < DECIDED * len(found):
        return Open(f"the times of {len(found) - clear} of {len(found)} pairs differ by less than their noise")
    return True


def described(varied: Varied) -> str:
    found, reverse = pairs(varied), reversed_pairs(varied)
    clear = sum(None not in orders for orders in found.values())
    return (f"{len(reverse)} of {len(found)} pairs reversed, {clear} decided with all values"
            + "".join(f"; {LABELS[a]}, {LABELS[b]}" for a, b in reverse[:4]))


def findings(report: Report, domain: str, studied: dict[str, Varied]) -> None:
    where = f"2.7.3.3, {domain}"
    for name, source, sentence in (
        ("C, a = 0", where, "C = gamma I does not affect the ranking (a = 0)"),
        ("C, a = 100", where, "C = gamma I does not affect the ranking (a = 100)"),
        ("Young's modulus", f"2.7.3.4, {domain}", "C = gamma I does not affect the ranking (elasticity)"),
        ("f", where, "f does not affect the ranking"),
        ("a", where, "a does not affect the ranking if it is below 100"),
        *((f"boundary, {pde}", f"2.2, 2.7.1, {domain}", f"Boundary conditions do not affect the ranking ({pde})")
          for pde in PDES),
    ):
        report.finding(source, sentence, same_ranking(studied[name]), described(studied[name]), criterion=RULE)
    varied = studied["C, a = 0"]
    counts = {n: [row[n].iterations for row in varied.values()] for n in next(iter(varied.values()))
              if all(row[n].converged for row in varied.values())}
    spread = {n: max(c) - min(c) for n, c in counts.items()}
    most = max(spread, key=lambda n: spread[n], default=0)
    report.finding(where, "C = gamma I does not affect kappa(A) (a = 0)",
                   all_of(spread[n] <= SAME_ITERATIONS if n in spread else Open(f"{LABELS[n]} failed")
                          for n in next(iter(varied.values()))),
                   f"iterations differ by up to {spread[most]} with {LABELS[most]}" if spread else "all failed",
                   criterion=f"the numbers of iterations differ by at most {SAME_ITERATIONS}, as by rounding")
    report.finding(where, "A large a affects the ranking", is_not(same_ranking(studied["a > 100"])),
                   described(studied["a > 100"]), criterion="a pair of combinations is faster with one value and "
                   "slower with another one by more than the noise")
    report.finding(where, "All combinations converge with all coefficients and boundary conditions",
                   all_of(s.converged for varied in studied.values() for row in varied.values() for s in row.values()),
                   f"{sum(not s.converged for v in studied.values() for r in v.values() for s in r.values())} failures",
                   own=True)
