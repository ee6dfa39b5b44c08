# SPDX-License-Identifier: BSD-3-Clause
"""Figure 4.19: condition number over the exponent p of the kernel, linear basis, with fits of its growth."""

from __future__ import annotations

import math
from typing import Sequence

import numpy as np

from ._horizon import Report, condition, increasing, parse
from ._verdicts import Open, Verdict, all_of

_EXPONENTS = (0, 0.5, 1, 1.5, 1.75, 2, 2.25, 2.5, 2.75, 2.9, 3, 3.25, 3.5, 3.75, 3.99)
#: Ranges of p with a slope of their own: below the singularity of the kernel's integral, and above it in two parts.
_PARTS = ((0, 2), (2, 3), (3, 4))
#: Growth is exponential in p where its rates in the parts above 2 differ by at most this part.
_RATE_TOLERANCE = 0.25


def slopes(exponents: Sequence[float], values: Sequence[float]) -> list[float]:
    """Growth of ln cond per unit of p in each part, by least squares; NaN: fewer than two values."""
    with np.errstate(invalid="ignore"):
        p, logs = np.array(exponents, float), np.log(values)
    inside = [(p >= low) & (p <= high) for low, high in _PARTS]
    return [float(np.polyfit(p[k], logs[k], 1)[0]) if k.sum() > 1 and np.isfinite(logs[k]).all() else math.nan
            for k in inside]


def exponential(rates: Sequence[float]) -> Verdict:
    """Whether ln cond is linear in p above 2, and grows there faster than below."""
    below, *above = rates
    if any(math.isnan(rate) for rate in rates):
        return Open("a part of the range has fewer than two exponents")
    return min(above) > max(below, 0.0) and max(above) <= (1 + _RATE_TOLERANCE) * min(above)


Curves = dict[tuple[int, float], Sequence[float]]


def findings(report: Report, exponents: Sequence[float], curves: Curves, rules: Curves) -> None:
    """The findings on Figure 4.19 of condition numbers over the exponents, by 1/h and delta.

    curves: with the exact integrals. rules: with the dissertation's rules.
    """
    rates = {key: slopes(exponents, values) for key, values in curves.items()}
    theirs = {key: slopes(exponents, values) for key, values in rules.items()}
    growth = {key: values[-1] / values[0] for key, values in curves.items()}
    report.finding("4.5.3, 4.6", "The condition number increases with p", all_of(map(increasing, curves.values())),
                   "; ".join(f"h = 1/{n}, delta = {d}: {g:.3g} times from p = {exponents[0]:g} to {exponents[-1]:g}"
                             for (n, d), g in growth.items()),
                   criterion="it is larger at each exponent than at the one before, on each mesh")  # fmt: skip
    report.finding("Figure 4.19", "It grows exponentially for p >= 2", all_of(exponential(r) for r in rates.values()),
                   _told(rates), criterion="ln cond has one slope from 2 to 3 and from 3 to 4 (within "
                   f"{_RATE_TOLERANCE:.0%}), larger than below 2", reason="ln cond grows about linearly with the "
                   "dissertation's rules, but faster with the exact integrals, near whose singularity low-order rules "
                   f"underestimate the largest eigenvalue. Slopes with the rules: {_told(theirs)}")  # fmt: skip


def _told(rates: dict[tuple[int, float], list[float]]) -> str:
    return "; ".join(f"h = 1/{n}, delta = {d}: " + ", ".join(f"{s:.2f}" for s in r)
                     for (n, d), r in rates.items()) + " for p below 2, 2 to 3, above 3"  # fmt: skip


def main(arguments: Sequence[str]) -> int:
    given = parse("peridynamics_kernel", __doc__, arguments)
    report = Report("peridynamics_kernel", "The exponent of the kernel (Figure 4.19)", given)
    sizes = (10,) if given.small else (10, 20, 40)
    deltas = (0.2, 0.4)
    exponents = _EXPONENTS[::2] if given.small else _EXPONENTS
    rows, panels, growth = [], [], []
    exact: Curves = {}
    rules: Curves = {}
    for n in sizes:
        lines = {}
        for delta in deltas:
            for discretization in ("exact", "dissertation"):
                y = [condition(n, 1, delta, "linear", p, discretization, given.threads) for p in exponents]
                rows += [[n, delta, discretization, p, v] for p, v in zip(exponents, y)]
                lines[f"delta = {delta}" + ("" if discretization == "exact" else ", dissertation's rules")] = (
                    exponents, y, "o-" if discretization == "exact" else "x:")  # fmt: skip
                growth.append([n, delta, discretization, *(f"{s:.2f}" for s in slopes(exponents, y))])
                (exact if discretization == "exact" else rules)[n, delta] = y
        panels.append({"title": f"Figure 4.19: h = {1 / n:g}", "x": "p", "yscale": "log", "lines": lines})
    report.csv("peridynamics_kernel", ["n", "delta", "discretization", "p", "condition"], rows)
    shown = [[p, *(f"{exact[n, d][i]:.3f}" for n in sizes for d in deltas)] for i, p in enumerate(exponents)]
    report.texts("Condition number, exact discretization, linear basis, aspect ratio 1", shown,
                 ["p", *(f"1/h {n}, delta {d}" for n in sizes for d in deltas)], "kernel_condition")  # fmt: skip
    parts = [f"{low} <= p <= {high}" for low, high in _PARTS]
    report.texts("Slope of ln cond per unit of p", growth, ["1/h", "delta", "discretization", *parts], "kernel_slopes")
    report.chart("peridynamics_kernel", panels)
    local = ", ".join(f"{1 / math.tan(math.pi / (2 * n)) ** 2:.1f} at h = 1/{n}" for n in sizes)
    report.text("As p goes to 4 the operator becomes local, and cond tends to the Laplacian's, cot^2(pi h / 2): "
                f"{local}; so the growth ends.")  # fmt: skip
    findings(report, exponents, exact, rules)
    return report.finish()
