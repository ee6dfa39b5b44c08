# SPDX-License-Identifier: BSD-3-Clause
"""Nonlocal beside local condition numbers, h^-2 and 1 / sin 2 theta, and times: sections 4.1, 4.4.2 and 4.5."""

from __future__ import annotations

import math
from typing import Sequence

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._horizon import ERROR, EXPONENT_TOLERANCE, LITTLE, Report, condition, exponent, resolved, solve
from ._memory import remembered
from ._meshes import right_triangles
from ._report import parser
from ._verdicts import Times, all_of, below, close, less, timed

_SIZES = (10, 20, 40)
_DELTA = 0.2
#: Aspect ratios of the grids of all models: the steps divide the square, and the longer leg is shorter than delta.
_RATIOS, _RATIO_SIZE, _SMALL_RATIO_SIZE = (1, 4, 16, 25), 40, 20
#: Aspect ratios of the grids of the local model alone: the smallest angle is from 45 to 0.22 degrees.
_ANGLES, _ANGLE_SIZE = (1, 4, 16, 64, 256), 80
#: The models by name: basis and exponent of the kernel; None is the local one, Poisson's equation.
_MODELS = {"local": None, "constant, p = 1": ("constant", 1.0), "linear, p = 1": ("linear", 1.0),
           "linear, p = 2.5": ("linear", 2.5), "linear, p = 3.9": ("linear", 3.9)}
_SINGULAR, _NEARLY_LOCAL = "linear, p = 2.5", "linear, p = 3.9"
#: Horizons over h while the horizon tends to 0, and 1/h.
_HORIZONS, _HORIZON_SIZE = (2, 1, 0.5, 0.25, 0.125), 20
#: Seconds by basis and 1/h for delta = 0.2, section 4.5; on 48 cores.
PRINTED = {"constant": {10: 1, 20: 11, 40: 341}, "linear": {10: 1, 20: 11, 40: 100_825}}
#: How many times longer a much longer time is, and how much longer halving h takes at least, as 11 s over 1 s.
_MUCH, _GROWTH = 2.0, 10.0
_REPEATS = 3


def grid(n: int, aspect_ratio: float) -> vtkDataSet:
    """The unit square of right triangles with legs sqrt(AR) / n and 1 / (n sqrt(AR)), as the nonlocal ones."""
    counts = [round(n / math.sqrt(aspect_ratio)), round(n * math.sqrt(aspect_ratio))]
    points, cells = right_triangles(*(np.linspace(0.0, 1.0, c + 1) for c in counts))
    return tautline.from_arrays(points, {"triangle": cells})


def sine(aspect_ratio: float) -> float:
    """sin 2 theta of the smallest angle theta of a right triangle, of which the legs have this ratio."""
    return 2 * aspect_ratio / (1 + aspect_ratio**2)


def degrees(aspect_ratio: float) -> float:
    """theta."""
    return math.degrees(math.atan(1 / aspect_ratio))


@remembered
def local(n: int, aspect_ratio: float, threads: int) -> float:
    """The condition number of Poisson's equation with linear elements."""
    return tautline.condition(grid(n, aspect_ratio), preconditioner="none", method="accurate", shares=False,
                              threads=threads).condition


def value(model: str, n: int, aspect_ratio: float, threads: int) -> float:
    """The condition number of a model."""
    chosen = _MODELS[model]
    if chosen is None:
        return local(n, aspect_ratio, threads)
    return condition(n, aspect_ratio, _DELTA, *chosen, "exact", threads)


@remembered
def times_of(n: int, basis: str, discretization: str, repeats: int, threads: int) -> Times:
    """CPU seconds of all threads for a condition number with p = 1."""
    return timed(repeats, lambda: solve(n, 1, _DELTA, basis, 1.0, discretization, threads))[1]


def main(arguments: Sequence[str]) -> int:
    given = parser("peridynamics_local", __doc__, repeats=_REPEATS).parse_args(arguments)
    report = Report("peridynamics_local", "Local and nonlocal condition numbers, times (4.1, 4.4.2, 4.5)", given)
    report.text(
        "The local model is Poisson's equation with linear elements on the unit square, u = 0 on its boundary; theta "
        f"is the smallest angle of the right triangles. Nonlocal models have delta = {_DELTA} and the exact "
        "discretization. Meshes of one h have the same number of triangles at all aspect ratios."
    )
    sizes = _SIZES[:2] if given.small else _SIZES
    count = _SMALL_RATIO_SIZE if given.small else _RATIO_SIZE
    ratios = [r for r in _RATIOS if count % math.isqrt(r) == 0 and resolved(count, r, _DELTA)]
    by_size = {m: {n: value(m, n, 1, given.threads) for n in sizes} for m in _MODELS}
    by_ratio = {m: {r: value(m, count, r, given.threads) for r in ratios} for m in _MODELS}
    fine = _SMALL_RATIO_SIZE if given.small else _ANGLE_SIZE
    by_angle = {r: local(fine, r, given.threads) for r in (_ANGLES[:3] if given.small else _ANGLES)}
    report.table("by_size", "Condition number by 1/h, aspect ratio 1", ["model", *map(str, sizes), "exponent of 1/h"],
                 [[m, *row.values(), exponent(list(row), list(row.values()))] for m, row in by_size.items()])
    report.table("by_aspect_ratio", f"Condition number by aspect ratio, 1/h = {count}", ["model", *map(str, ratios)],
                 [[m, *row.values()] for m, row in by_ratio.items()])
    report.table("by_angle", f"Local condition number by the smallest angle, 1/h = {fine}",
                 ["aspect ratio", "theta in degrees", "condition", "condition sin 2 theta"],
                 [[r, degrees(r), v, v * sine(r)] for r, v in by_angle.items()])
    size = sizes[0] if given.small else _HORIZON_SIZE
    by_horizon = {k: condition(size, 1, k / size, "linear", 1.0, "exact", given.threads) for k in _HORIZONS}
    report.table("by_horizon", f"Condition number by the horizon, 1/h = {size}, linear basis, p = 1",
                 ["delta / h", "condition", "over the local one"],
                 [[k, v, v / local(size, 1, given.threads)] for k, v in by_horizon.items()])
    report.chart("peridynamics_local", [
        {"title": "aspect ratio 1", "x": "1/h", "xscale": "log", "yscale": "log",
         "lines": {m: (list(row), list(row.values())) for m, row in by_size.items()}},
        {"title": f"1/h = {count}", "x": "aspect ratio", "xscale": "log", "yscale": "log",
         "lines": {m: (list(row), list(row.values())) for m, row in by_ratio.items()}},
    ])  # fmt: skip
    times = {(b, d): {n: times_of(n, b, d, given.repeats, given.threads) for n in sizes} for b in PRINTED
             for d in ("dissertation", "exact")}
    report.table("times", f"CPU seconds for cond(A), delta = {_DELTA}, p = 1",
                 ["basis", "discretization", *(f"{what} 1/h = {n}" for n in sizes for what in ("ours,", "printed,"))],
                 [[b, d, *(v for n in sizes for v in (row[n].best, PRINTED[b][n]))] for (b, d), row in times.items()])
    local_findings(report, by_size["local"], by_angle)
    findings(report, by_size, by_ratio)
    horizon_findings(report, by_horizon, local(size, 1, given.threads))
    time_findings(report, times)
    return report.finish()


def local_findings(report: Report, by_size: dict[int, float], by_angle: dict[int, float]) -> None:
    """The local model by 1/h, and by the aspect ratio."""
    order = exponent(list(by_size), list(by_size.values()))
    report.finding("4.4.2", "Local: cond is proportional to h^-2", abs(order - 2) <= EXPONENT_TOLERANCE,
                   f"h^-{order:.2f}", stated="h^-2", criterion=f"exponent within {EXPONENT_TOLERANCE:g} of 2")
    products = {r: v * sine(r) for r, v in by_angle.items()}
    mean = sum(products.values()) / len(products)
    report.finding("4.1, 4.4.2", "Local: cond is proportional to 1 / sin 2 theta and approaches infinity as theta "
                   "approaches 0", all_of(close(v, mean, LITTLE) for v in products.values()), "cond sin 2 theta: "
                   + ", ".join(f"{v:.4g} at {degrees(r):.2g} degrees" for r, v in products.items()),
                   criterion=f"cond sin 2 theta is within {LITTLE:.0%} of its mean")  # fmt: skip


def findings(report: Report, by_size: dict[str, dict[int, float]], by_ratio: dict[str, dict[int, float]]) -> None:
    """All models by 1/h, and by the aspect ratio."""
    orders = {m: exponent(list(row), list(row.values())) for m, row in by_size.items()}
    shown = "exponents of 1/h: " + ", ".join(f"{m} {v:.2f}" for m, v in orders.items())
    report.finding("4.5.3", "Nonlocal, p = 2.5: refinement increases cond less than locally",
                   less(orders[_SINGULAR], orders["local"], ERROR), shown, criterion="the exponent of 1/h is smaller")
    report.finding("4.1, 4.4.1, 6", "Nonlocal, p = 2.5: refinement increases cond similarly to the local model",
                   abs(orders[_SINGULAR] - orders["local"]) <= EXPONENT_TOLERANCE, shown,
                   criterion=f"exponents of 1/h within {EXPONENT_TOLERANCE:g}",
                   reason="cond grows like h^-(p-2): like the local one, h^-2, for p near 4 only, as p = 3.9 shows")
    growth = {m: max(row.values()) / row[1] for m, row in by_ratio.items()}
    last = max(by_ratio["local"])
    shown = f"aspect ratio {last} over 1: " + ", ".join(f"{m} {v:.3g} times" for m, v in growth.items())
    report.finding("4.5.3", "Nonlocal, p = 2.5: anisotropy increases cond, but less than locally",
                   all_of([growth[_SINGULAR] > 1 + LITTLE, less(growth[_SINGULAR], growth["local"], ERROR)]), shown,
                   criterion=f"by more than {LITTLE:.0%}, and by less than the local one")
    report.finding("4.1, 4.4.1, 6", "Nonlocal, p = 2.5: anisotropy increases cond similarly to the local model",
                   close(growth[_SINGULAR], growth["local"], LITTLE), shown,
                   criterion=f"the increases are within {LITTLE:.0%}",
                   reason="cond grows like AR^((p-2)/2), the shortest edge to the power -(p-2); locally like AR")
    changes = {m: max(abs(v / row[1] - 1) for v in row.values()) for m, row in by_ratio.items() if m.endswith("p = 1")}
    report.finding("4.5.1, 4.5.2", "Nonlocal, p = 1: anisotropy hardly changes cond",
                   all_of(v <= LITTLE for v in changes.values()), f"up to aspect ratio {last}: " + ", ".join(
                       f"{m} by {v:.1%}" for m, v in changes.items()), criterion=f"by at most {LITTLE:.0%}")


def horizon_findings(report: Report, by_horizon: dict[float, float], limit: float) -> None:
    """Condition numbers by delta / h, and the local one."""
    gaps = [abs(v / limit - 1) for v in by_horizon.values()]
    report.finding("4.1", "The nonlocal model is close to the local one when the horizon goes to 0",
                   all_of([gaps[-1] <= LITTLE, all_of(b < a for a, b in zip(gaps, gaps[1:]))]),
                   ", ".join(f"{v:.4g} with delta = {k:g} h" for k, v in by_horizon.items()) + f"; local {limit:.4g}",
                   criterion=f"cond comes closer to the local one with each smaller horizon, at last to {LITTLE:.0%}")


def time_findings(report: Report, times: dict[tuple[str, str], dict[int, Times]]) -> None:
    """Times by basis and discretization, and 1/h."""
    finest = max(times["linear", "dissertation"])
    for discretization in ("dissertation", "exact"):
        one, other = (times[basis, discretization][finest] for basis in PRINTED)
        report.finding("4.5, times", f"The linear basis takes much longer than the constant one ({discretization} "
                       "discretization)", below(one, other, 1 / _MUCH), f"constant {one}, linear {other}",
                       stated="341 s and 100,825 s", criterion=f"more than {_MUCH:g} times as long on the finest mesh",
                       reason="Both bases need the same pairs of triangles, each once, and the linear one has half as "
                       "many unknowns; section 4.5 visits the triangles again for each vertex")  # fmt: skip
    pairs = {key: [(a, b) for a, b in zip(row.values(), [*row.values()][1:])] for key, row in times.items()}
    report.finding("4.5, times", "Halving h multiplies the time", all_of(
        below(a, b, 1 / _GROWTH) for of_key in pairs.values() for a, b in of_key),
        "; ".join(f"{b}, {d}: " + ", ".join(f"{two.best / max(one.best, math.ulp(0.0)):.1f} times"
                                            for one, two in pairs[b, d]) for b, d in pairs),
        stated="by 11 and 31 (constant basis), 11 and 9,166 (linear)",
        criterion=f"by more than {_GROWTH:g} at each refinement with both bases and discretizations",
        reason="The pairs of triangles within a horizon grow like h^-4, up to 16 times; times on the coarsest meshes "
        "are milliseconds, with fixed costs, and a factor of 9,166 has no cause in the model")  # fmt: skip
