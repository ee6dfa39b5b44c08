# SPDX-License-Identifier: BSD-3-Clause
"""Efficiency of the combinations when the coefficients C, f and a are varied: section 2.7.3.3."""

from __future__ import annotations

from typing import Any

from ._report import Report
from ._solvers import LABELS, Solve, initial_mesh, options, size_of, smoothed, solve, times_of
from ._verdicts import Verdict, all_of, faster

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

#: The solves of the combinations by the value of a coefficient.
Varied = dict[str, dict[int, Solve]]


def main(arguments: list[str]) -> int:
    given = options("solver_coefficients", __doc__, pdes=False, full=SIZE).parse_args(arguments)
    report = Report("solver_coefficients", "Coefficients of the equation (section 2.7.3.3)", given.out, given.small)
    report.text(
        "The general second-order equation -div(C grad u) + a u = f with C = gamma I, and elasticity with Young's "
        "modulus gamma, on meshes smoothed by IMR. One coefficient is varied at a time; CPU seconds of "
        f"{given.repeats} run(s). Two combinations are reversed where one is faster with one value and slower with "
        "another one, by more than the noise."
    )
    for domain in given.domain or (DOMAIN,):
        mesh = smoothed(initial_mesh(domain, size_of(given, SIZE)), "imr", given.threads)

        def runs(pde: str, values: dict[str, dict[str, Any]]) -> Varied:
            return {key: solve(mesh, pde, given, **more) for key, more in values.items()}  # noqa: B023

        coefficients = {f"gamma = {g:g}": dict.fromkeys(("alpha", "beta", "gamma"), g) for g in FACTORS}
        free = {key: {**more, "reaction": 0.0} for key, more in coefficients.items()}
        studied = {
            "C, a = 0": runs("elliptic", free),
            "C, a = 100": runs("elliptic", coefficients),
            "Young's modulus": runs("elasticity", {f"E = {g:g}": {"youngs_modulus": g} for g in FACTORS}),
            "f": runs("elliptic", {f"f = {name}": {"source": f} for name, f in SOURCES.items()}),
            "a": runs("elliptic", {f"a = {a:g}": {"reaction": a} for a in REACTIONS}),
            "a > 100": runs("elliptic", {f"a = {a:g}": {"reaction": a} for a in (REACTIONS[0], *BEYOND)}),
        }
        for number, (name, varied) in enumerate(studied.items()):
            rows = [[f"{n} {LABELS[n]}", *(row[n].iterations for row in varied.values()),
                     *(row[n].seconds for row in varied.values())] for n in given.combinations]
            report.table(f"{domain}_{number}", f"{domain}, {name} varied: iterations, then CPU s",
                         ["combination", *varied, *(f"{key}, s" for key in varied)], rows)
        findings(report, domain, studied)
    return report.finish()


def reversed_pairs(varied: Varied) -> list[tuple[int, int]]:
    """The pairs of combinations of which one is faster with one value and slower with another one."""
    times = [times_of(row) for row in varied.values()]
    numbers = sorted(set.intersection(*(set(t) for t in times)))
    return [(a, b) for a in numbers for b in numbers
            if a < b and {True, False} <= {order(t, a, b) for t in times}]


def order(times: dict, a: int, b: int) -> Verdict:
    """True: a is faster than b; False: b is faster than a; None: not decided."""
    return True if faster(times[a], times[b]) else False if faster(times[b], times[a]) else None


def same_ranking(varied: Varied) -> Verdict:
    """Whether no pair is reversed; not decided if fewer than two combinations converged with all values."""
    common = set.intersection(*(set(times_of(row)) for row in varied.values()))
    return not reversed_pairs(varied) if len(common) > 1 else None


def described(varied: Varied) -> str:
    pairs = reversed_pairs(varied)
    return f"{len(pairs)} reversed pairs" + "".join(f"; {LABELS[a]}, {LABELS[b]}" for a, b in pairs[:4])


def findings(report: Report, domain: str, studied: dict[str, Varied]) -> None:
    where = f"2.7.3.3, {domain}"
    for name, sentence in (("C, a = 0", "C = gamma I does not affect the ranking (a = 0)"),
                           ("C, a = 100", "C = gamma I does not affect the ranking (a = 100)"),
                           ("Young's modulus", "C = gamma I does not affect the ranking (elasticity)"),
                           ("f", "f does not affect the ranking"),
                           ("a", "a does not affect the ranking if it is below 100")):
        report.finding(where, sentence, same_ranking(studied[name]), described(studied[name]))
    spread = {n: max(c) - min(c) for n in next(iter(studied["C, a = 0"].values()))
              for c in [[row[n].iterations for row in studied["C, a = 0"].values()]]}
    most = max(spread, key=spread.get)
    report.finding(where, f"C = gamma I does not affect kappa(A): the same iterations (to {SAME_ITERATIONS}, a = 0)",
                   all(d <= SAME_ITERATIONS for d in spread.values()), f"up to {spread[most]} with {LABELS[most]}")
    beyond = same_ranking(studied["a > 100"])
    report.finding(where, "A large a affects the ranking", None if beyond is None else not beyond,
                   described(studied["a > 100"]))
    converged = all_of(s.converged for varied in studied.values() for row in varied.values() for s in row.values())
    report.finding(where, "All combinations converge with all coefficients", converged,
                   f"{sum(not s.converged for v in studied.values() for r in v.values() for s in r.values())} failures")
