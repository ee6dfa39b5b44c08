# SPDX-License-Identifier: BSD-3-Clause
"""Nonlocal beside local condition numbers, h^-2 and 1 / sin 2 theta, and times: sections 4.1, 4.4.2 and 4.5."""

from __future__ import annotations

import math
from typing import Sequence

import numpy as np

import tautline

from ._meshes import right_triangles
from ._report import parser
from ._horizon import Report, condition, exponent
from ._verdicts import Times, faster, timed

_SIZES = (10, 20, 40)
_DELTA = 0.2
#: Aspect ratios of the grids with 1/h = 20: those of which the steps divide the square.
_RATIOS, _RATIO_SIZE = (1, 4, 16, 25), 20
#: The models by name: basis and exponent of the kernel; None is the local one, Poisson's equation.
_MODELS = {"local": None, "constant, p = 1": ("constant", 1.0), "linear, p = 1": ("linear", 1.0),
           "linear, p = 2.5": ("linear", 2.5)}
#: Seconds by basis and 1/h for delta = 0.2, section 4.5; on 48 cores.
PRINTED = {"constant": {10: 1, 20: 11, 40: 341}, "linear": {10: 1, 20: 11, 40: 100_825}}
#: Within which exponents agree with 2, and cond sin 2 theta is constant.
_EXPONENT_TOLERANCE, _CONSTANT = 0.1, 0.1
#: Growth of cond with the aspect ratio that counts as none.
_UNAFFECTED = 0.15
_REPEATS = 3


def grid(n: int, aspect_ratio: float):
    """The unit square of right triangles with legs sqrt(AR) / n and 1 / (n sqrt(AR)), as the nonlocal ones."""
    counts = [round(n / math.sqrt(aspect_ratio)), round(n * math.sqrt(aspect_ratio))]
    points, cells = right_triangles(*(np.linspace(0.0, 1.0, c + 1) for c in counts))
    return tautline.from_arrays(points, {"triangle": cells})


def sine(aspect_ratio: float) -> float:
    """sin 2 theta of the smallest angle theta of a right triangle, of which the legs have this ratio."""
    return 2 * aspect_ratio / (1 + aspect_ratio**2)


def value(model: str, n: int, aspect_ratio: float, threads: int) -> float:
    """The condition number of a model."""
    chosen = _MODELS[model]
    if chosen is None:
        return tautline.condition(grid(n, aspect_ratio), preconditioner="none", method="accurate", shares=False,
                                  threads=threads).condition
    return condition(n, aspect_ratio, _DELTA, *chosen, "exact", threads)


def times_of(n: int, basis: str, discretization: str, given) -> Times:
    """CPU seconds of all threads for a condition number with p = 1."""
    return timed(given.repeats, lambda: condition(n, 1, _DELTA, basis, 1.0, discretization, given.threads))[1]


def main(arguments: Sequence[str]) -> int:
    given = parser("peridynamics_local", __doc__, repeats=_REPEATS).parse_args(arguments)
    report = Report("peridynamics_local", "Local and nonlocal condition numbers, times (4.1, 4.4.2, 4.5)", given.out,
                    given.small)  # fmt: skip
    report.text(
        "The local model is Poisson's equation with linear elements on the unit square, u = 0 on its boundary; theta "
        f"is the smallest angle of the right triangles. Nonlocal models have delta = {_DELTA} and the exact "
        "discretization. Meshes of one h have the same number of triangles at all aspect ratios."
    )
    sizes = _SIZES[:2] if given.small else _SIZES
    count = sizes[0] if given.small else _RATIO_SIZE
    ratios = [r for r in _RATIOS if count % math.isqrt(r) == 0]
    by_size = {m: {n: value(m, n, 1, given.threads) for n in sizes} for m in _MODELS}
    by_ratio = {m: {r: value(m, count, r, given.threads) for r in ratios} for m in _MODELS}
    report.table("by_size", "Condition number by 1/h, aspect ratio 1", ["model", *map(str, sizes), "exponent of 1/h"],
                 [[m, *row.values(), exponent(list(row), list(row.values()))] for m, row in by_size.items()])
    report.table("by_aspect_ratio", f"Condition number by aspect ratio, 1/h = {count}", ["model", *map(str, ratios)],
                 [[m, *row.values()] for m, row in by_ratio.items()]
                 + [["1 / sin 2 theta", *(1 / sine(r) for r in ratios)]])
    report.chart("peridynamics_local", [
        {"title": "aspect ratio 1", "x": "1/h", "xscale": "log", "yscale": "log",
         "lines": {m: (list(row), list(row.values())) for m, row in by_size.items()}},
        {"title": f"1/h = {count}", "x": "aspect ratio", "xscale": "log", "yscale": "log",
         "lines": {m: (list(row), list(row.values())) for m, row in by_ratio.items()}},
    ])  # fmt: skip
    times = {(b, d): {n: times_of(n, b, d, given) for n in sizes} for b in PRINTED for d in ("dissertation", "exact")}
    report.table("times", f"CPU seconds for cond(A), delta = {_DELTA}, p = 1",
                 ["basis", "discretization", *(f"{what} 1/h = {n}" for n in sizes for what in ("ours,", "printed,"))],
                 [[b, d, *(v for n in sizes for v in (row[n].best, PRINTED[b][n]))] for (b, d), row in times.items()])
    findings(report, by_size, by_ratio)
    time_findings(report, times)
    return report.finish()


def findings(report: Report, by_size: dict[str, dict[int, float]], by_ratio: dict[str, dict[int, float]]) -> None:
    orders = {m: exponent(list(row), list(row.values())) for m, row in by_size.items()}
    shown = ", ".join(f"{m} {v:.2f}" for m, v in orders.items())
    report.finding("4.4.2", f"Local: cond grows like h^-2 (exponent within {_EXPONENT_TOLERANCE:g})",
                   abs(orders["local"] - 2) <= _EXPONENT_TOLERANCE, f"exponents of 1/h: {shown}")
    report.finding("4.5.3", "Nonlocal, p = 2.5: refinement increases cond less than locally",
                   orders["linear, p = 2.5"] < orders["local"], f"exponents of 1/h: {shown}")
    products = {r: v * sine(r) for r, v in by_ratio["local"].items()}
    mean = sum(products.values()) / len(products)
    report.finding("4.4.2", f"Local: cond grows like 1 / sin 2 theta (within {_CONSTANT:.0%})",
                   all(abs(v / mean - 1) <= _CONSTANT for v in products.values()),
                   "cond sin 2 theta: " + ", ".join(f"{v:.4g} at aspect ratio {r}" for r, v in products.items()))
    growth = {m: max(row.values()) / row[1] for m, row in by_ratio.items()}
    shown = ", ".join(f"{m} {v:.3g} times" for m, v in growth.items())
    report.finding("4.5.3", "Nonlocal, p = 2.5: anisotropy increases cond, but less than locally",
                   1 + _UNAFFECTED < growth["linear, p = 2.5"] < growth["local"], shown)
    report.finding("4.5.1, 4.5.2", f"Nonlocal, p = 1: anisotropy hardly changes cond (by at most {_UNAFFECTED:.0%})",
                   all(abs(v / row[1] - 1) <= _UNAFFECTED for m, row in by_ratio.items() if m.endswith("p = 1")
                       for v in row.values()), shown)  # fmt: skip


def time_findings(report: Report, times: dict[tuple[str, str], dict[int, Times]]) -> None:
    finest = max(times["linear", "dissertation"])
    for discretization in ("dissertation", "exact"):
        one, other = (times[basis, discretization][finest] for basis in PRINTED)
        report.finding("4.5, times", f"The linear basis takes longer than the constant one ({discretization} "
                       "discretization, finest mesh)", faster(one, other), f"constant {one}, linear {other}")
    grown = {key: [b.best / max(a.best, math.ulp(0.0)) for a, b in zip(row.values(), [*row.values()][1:])]
             for key, row in times.items()}  # fmt: skip
    least = {key: min(v) for key, v in grown.items()}
    report.finding("4.5, times", "Halving h multiplies the time by 10 or more", all(v >= 10 for v in least.values()),
                   "; ".join(f"{b}, {d}: " + ", ".join(f"{v:.1f} times" for v in grown[b, d]) for b, d in grown))
