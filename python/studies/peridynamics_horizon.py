# SPDX-License-Identifier: BSD-3-Clause
"""Figures 4.9 to 4.18: condition numbers over the horizon, the element size and the aspect ratio, with fits.

Both discretizations; findings are judged by the exact one. Fits: c in cond = c delta^-2 (p = 1); the exponent of h and
that of the aspect ratio (p = 2.5), to h = 1/160 and aspect ratio 64 in the full size.
"""

from __future__ import annotations

import math
from typing import Sequence

from ._horizon import Report, condition, exponent, parse

_DELTAS = (0.2, 0.25, 0.3, 0.35, 0.4)
_RATIOS = (1, 4, 16, 64)
#: cond is proportional to delta^-2 where the fitted exponent is -2 within this; cond ~ h^-1 alike.
_EXPONENT_TOLERANCE = 0.1
#: Relative change of cond that is small.
_SMALL_CHANGE = 0.05


def main(arguments: Sequence[str]) -> int:
    options = parse("peridynamics_horizon", __doc__, arguments)
    small = options.small
    report = Report("peridynamics_horizon", "Horizon, element size and aspect ratio (Figures 4.9 to 4.18)", options.out,
                    small)  # fmt: skip
    known: dict[tuple, float] = {}

    def cond(n: int, ar: int, delta: float, basis: str, p: float, discretization: str = "exact") -> float:
        key = (n, ar, delta, basis, p, discretization)
        if key not in known:
            known[key] = condition(n, ar, delta, basis, p, discretization, options.threads)
        return known[key]

    sizes = (5, 10) if small else (10, 20, 40)
    finest = sizes[-1]
    for basis, p, figures in (("constant", 1.0, (9, 10, 11, 12)), ("linear", 1.0, (13, 14, 15, 16)),
                              ("linear", 2.5, (17, 17, 18, 18))):  # fmt: skip
        _over_delta(report, cond, basis, p, figures, sizes)
    _constants(report, cond, finest)
    _over_size(report, cond, small)
    _over_ratio(report, cond, small)
    rows = [[*key, value] for key, value in known.items() if not math.isnan(value)]
    headings = ["n", "aspect_ratio", "delta", "basis", "p", "discretization", "condition"]
    report.csv("peridynamics_horizon", headings, rows)
    return report.finish()


def _over_delta(report, cond, basis, p, figures, sizes) -> None:
    """Four panels: fixed h with the aspect ratio varied, fixed aspect ratio with h varied."""
    def line(n, ar, discretization="exact", square=False):
        y = [cond(n, ar, d, basis, p, discretization) for d in _DELTAS]
        return ([d**-2 for d in _DELTAS] if square else _DELTAS), y, "o-" if discretization == "exact" else "x:"

    def fits(n, ar):
        return not math.isnan(cond(n, ar, 0.2, basis, p))

    for square in (False, True) if p < 2 else (False,):
        panels = []
        for n in sizes[1:]:
            lines = {}
            for ar in (a for a in _RATIOS if fits(n, a)):
                lines[f"AR {ar}"] = line(n, ar, square=square)
                lines[f"AR {ar}, dissertation's rules"] = line(n, ar, "dissertation", square)
            panels.append({"title": f"Figure 4.{figures[square]}: h = {1 / n:g}", "lines": lines})
        for ar in (1, 4):
            lines = {f"h = {1 / n:g}": line(n, ar, square=square) for n in sizes}
            lines |= {f"h = {1 / n:g}, dissertation's rules": line(n, ar, "dissertation", square) for n in sizes}
            panels.append({"title": f"Figure 4.{figures[2 + square]}: aspect ratio {ar}", "lines": lines})
        for panel in panels:
            panel["x"] = "delta^-2" if square else "delta"
        report.chart(f"peridynamics_horizon_{basis}_p{p:g}{'_inverse' if square else ''}", panels)


def _constants(report, cond, n) -> None:
    rows, rates = [], {}
    for basis in ("constant", "linear"):
        for ar in (a for a in _RATIOS if not math.isnan(cond(n, a, 0.2, basis, 1.0))):
            c = [cond(n, ar, d, basis, 1.0) * d * d for d in _DELTAS]
            rates[basis, ar] = exponent(_DELTAS, [v / d**2 for v, d in zip(c, _DELTAS)])
            rows.append([basis, ar, *(f"{v:.3f}" for v in c), f"{rates[basis, ar]:.2f}"])
    report.texts(f"c = cond delta^2 at h = 1/{n}, p = 1 (exact discretization)", rows,
                 ["basis", "AR", *(f"delta {d:g}" for d in _DELTAS), "fitted exponent"])  # fmt: skip
    limit = 2 * 3 / math.pi**2
    report.text(f"For delta to 0, c tends to 2 (4-p) / ((2-p) pi^2) = {limit:.2f}.")
    horizon_findings(report, rates, {basis: [cond(n, ar, d, basis, 1.0) for ar in (1, 4) for d in _DELTAS]
                                     for basis in ("constant", "linear")})  # fmt: skip


def horizon_findings(report: Report, rates: dict[tuple[str, int], float], conditions: dict[str, list[float]]) -> None:
    """The findings for p = 1. rates: exponents of delta by basis and aspect ratio; conditions: by basis, those of the
    aspect ratios 1 and 4 at each delta."""
    report.finding("4.5.1, 4.5.2", "p = 1: cond is proportional to delta^-2 (exponents within "
                   f"{_EXPONENT_TOLERANCE:g})",
                   all(abs(rate + 2) <= _EXPONENT_TOLERANCE for rate in rates.values()),
                   ", ".join(f"{basis}, AR {ar}: {rate:.2f}" for (basis, ar), rate in rates.items()))  # fmt: skip
    for basis, values in conditions.items():
        half = len(values) // 2
        spread = max(abs(b / a - 1) for a, b in zip(values[:half], values[half:]))
        report.finding("4.5.1, 4.5.2", f"p = 1: the aspect ratio affects cond very little (4 against 1, within "
                       f"{_SMALL_CHANGE:.0%}; {basis} basis)", spread <= _SMALL_CHANGE, f"{spread:.1%}")  # fmt: skip


def _over_size(report, cond, small) -> None:
    sizes = (5, 10, 20) if small else (10, 20, 40, 80, 160)
    deltas = (0.2,) if small else (0.2, 0.4)
    rows, lines, exact = [], {}, {}
    for p in (1.0, 2.5):
        for delta in deltas:
            for discretization in ("exact", "dissertation"):
                use = [n for n in sizes if n <= (160 if delta == 0.2 else 80)]
                y = [cond(n, 1, delta, "linear", p, discretization) for n in use]
                rates = [math.log2(b / a) for a, b in zip(y, y[1:])]
                if discretization == "exact":
                    exact[p, delta] = rates
                rows.append([p, delta, discretization, *(f"{v:.3f}" for v in y), *[""] * (len(sizes) - len(y)),
                             " ".join(f"{r:.2f}" for r in rates)])  # fmt: skip
                style, rules = ("o-", "") if discretization == "exact" else ("x:", ", dissertation's rules")
                lines[f"p = {p:g}, delta = {delta}{rules}"] = [1 / n for n in use], y, style
    report.texts("Growth with 1/h, linear basis, aspect ratio 1", rows,
                 ["p", "delta", "discretization", *(f"1/h = {n}" for n in sizes), "exponents of 1/h"])  # fmt: skip
    chart = {"title": "growth with 1/h", "x": "h", "xscale": "log", "yscale": "log", "lines": lines}
    report.chart("peridynamics_horizon_h", [chart])
    size_findings(report, exact)


def size_findings(report: Report, rates: dict[tuple[float, float], list[float]]) -> None:
    """The findings on the element size. rates: exponents of 1/h from one h to the next, by p and delta."""
    def told(p: float) -> str:
        return "; ".join(f"delta = {d}: " + ", ".join(f"{r:.2f}" for r in found)
                         for (q, d), found in rates.items() if q == p)  # fmt: skip

    converging = {key: found for key, found in rates.items() if key[0] == 1.0}
    report.finding("4.5.2", "p = 1: cond converges as h goes to 0 (exponents decrease below "
                   f"{_EXPONENT_TOLERANCE:g})", all(abs(found[-1]) <= _EXPONENT_TOLERANCE and
                                                   abs(found[-1]) < abs(found[0]) for found in converging.values()),
                   told(1.0))  # fmt: skip
    report.finding("4.5.3", f"p = 2.5: cond is proportional to h^-1 (exponents within {_EXPONENT_TOLERANCE:g})",
                   all(abs(r - 1) <= _EXPONENT_TOLERANCE for (p, _), found in rates.items() if p == 2.5 for r in found),
                   told(2.5) + "; towards p - 2 = 0.5")  # fmt: skip


def _over_ratio(report, cond, small) -> None:
    sizes = (10,) if small else (40, 80, 160)
    rows, lines, exact = [], {}, {}
    for p in (1.0, 2.5):
        for n in sizes:
            for discretization in ("exact", "dissertation"):
                use = [a for a in _RATIOS if not math.isnan(cond(n, a, 0.2, "linear", p))]
                y = [cond(n, a, 0.2, "linear", p, discretization) for a in use]
                if (p, discretization) == (2.5, "exact"):
                    exact[n] = y
                ratios = " ".join(f"{b / a:.2f}" for a, b in zip(y, y[1:]))
                rows.append([p, n, discretization, *("indefinite" if math.isnan(v) else f"{v:.3f}" for v in y),
                             *[""] * (len(_RATIOS) - len(y)), ratios])  # fmt: skip
                lines[f"p = {p:g}, h = 1/{n}" + ("" if discretization == "exact" else ", dissertation's rules")] = (
                    use, y, "o-" if discretization == "exact" else "x:")  # fmt: skip
    report.texts("Growth with the aspect ratio, linear basis, delta = 0.2, dx dy fixed", rows,
                 ["p", "1/h", "discretization", *(f"AR {a}" for a in _RATIOS), "per factor 4"])  # fmt: skip
    chart = {"title": "growth with the aspect ratio", "x": "aspect ratio", "xscale": "log", "yscale": "log",
             "lines": lines}  # fmt: skip
    report.chart("peridynamics_horizon_ratio", [chart])
    report.text("AR^((p-2)/2), the shortest edge to the power -(p-2), grows by 1.41 per factor 4 for p = 2.5. With the "
                "dissertation's rules cond grows faster, by their error.")  # fmt: skip
    ratio_findings(report, exact)


def ratio_findings(report: Report, curves: dict[int, list[float]]) -> None:
    """The findings on the aspect ratio for p = 2.5. curves: cond at growing aspect ratios, from 1, by 1/h."""
    grown = {n: [b / a for a, b in zip(y, y[1:])] for n, y in curves.items()}
    told = "; ".join(f"h = 1/{n}: " + ", ".join(f"{g:.2f}" for g in found) for n, found in grown.items())
    report.finding("4.5.3", "p = 2.5: anisotropy increases cond", all(found[0] > 1 for found in grown.values() if found)
                   if any(grown.values()) else None, f"per factor 4 of the aspect ratio: {told}")  # fmt: skip
    further = [g for found in grown.values() for g in found[1:]]
    report.finding("4.5.3", f"p = 2.5: further anisotropy does not increase it (by at most {_SMALL_CHANGE:.0%})",
                   all(g <= 1 + _SMALL_CHANGE for g in further) if further else None,
                   f"per factor 4 of the aspect ratio: {told}")  # fmt: skip
