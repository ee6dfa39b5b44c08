# SPDX-License-Identifier: BSD-3-Clause
"""Figures 4.9 to 4.18: condition numbers over the horizon, the element size and the aspect ratio, with fits.

Both discretizations; findings are judged by the exact one, on meshes whose longer legs are shorter than the horizon.
Fits: c in cond = c delta^-2 (p = 1); the exponents of h and of the aspect ratio (p = 2.5), to aspect ratio 64.
"""

from __future__ import annotations

import math
from typing import Sequence

from ._horizon import (CLOSE_TO_ONE, ERROR, EXPONENT_TOLERANCE, LITTLE, Report, condition, exponent, increasing,
                       resolved)  # fmt: skip
from ._report import parser
from ._verdicts import Open, all_of, close, less

_DELTAS = (0.2, 0.25, 0.3, 0.35, 0.4)
_RATIOS = (1, 4, 16, 64)
_P = 2.5  # of the kernel that is not integrable
#: 1/h of the growth with h (p = 1 with the constant basis to the one before the last) and with the aspect ratio.
_FINEST, _COARSEST, _RATIO_COARSEST = 80, 10, 40
#: Horizons over h, for the bound by delta^-2 and h^-2; the first is below the mesh size.
_HORIZONS = (0.5, 1, 2, 4)
#: cond converges where each difference under refinement is at most this part of the one before: an order of 0.4 in h.
_SHRINKS = 0.75
#: The orders in h with which cond converges for p = 1, by basis. Linear: the product of the symbol, 1 - 1 / (k delta)
#: for short waves, and the mass matrix, 1 - O(k h)^2, is largest at k ~ (delta h^2)^(-1/3).
_ORDERS = {"constant": 1.0, "linear": 2 / 3}
#: Elements in the horizon while it tends to 0, and the horizons.
_ELEMENTS, _SHORT = 4, (0.4, 0.2, 0.1, 0.05)


def main(arguments: Sequence[str]) -> int:
    made = parser("peridynamics_horizon", __doc__, threads=0)
    made.add_argument("--finest", type=int, default=_FINEST, metavar="N",
                      help="largest 1/h; twice as large takes 16 times as long (default: %(default)s)")
    options = made.parse_args(arguments)
    small = options.small
    report = Report("peridynamics_horizon", "Horizon, element size and aspect ratio (Figures 4.9 to 4.18)", options)
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
    _bounds(report, cond, sizes)
    _limit(report, cond, small)
    _over_size(report, cond, (5, 10, 20) if small else _doubled(_COARSEST, options.finest))
    _over_ratio(report, cond, (10,) if small else _doubled(_RATIO_COARSEST, options.finest))
    rows = [[*key, value] for key, value in known.items() if not math.isnan(value)]
    headings = ["n", "aspect_ratio", "delta", "basis", "p", "discretization", "condition"]
    report.csv("peridynamics_horizon", headings, rows)
    return report.finish()


def _doubled(first: int, last: int) -> tuple[int, ...]:
    """first, 2 first, 4 first, ... to `last`."""
    found = [first]
    while 2 * found[-1] <= last:
        found.append(2 * found[-1])
    return tuple(found)


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
    rows, rates, conditions = [], {}, {}
    for basis in ("constant", "linear"):
        for ar in (a for a in _RATIOS if not math.isnan(cond(n, a, 0.2, basis, 1.0))):
            found = [cond(n, ar, d, basis, 1.0) for d in _DELTAS]
            rate = exponent(_DELTAS, found)
            if resolved(n, ar, min(_DELTAS)):
                rates[basis, ar], conditions[basis, ar] = rate, found
            rows.append([basis, ar, *(f"{v * d * d:.3f}" for v, d in zip(found, _DELTAS)), f"{rate:.2f}"])
    report.texts(f"c = cond delta^2 at h = 1/{n}, p = 1 (exact discretization)", rows,
                 ["basis", "AR", *(f"delta {d:g}" for d in _DELTAS), "fitted exponent"], "constants_p1")  # fmt: skip
    horizon_findings(report, rates, conditions)


def horizon_findings(report: Report, rates: dict[tuple[str, int], float],
                     conditions: dict[tuple[str, int], list[float]]) -> None:
    """The findings for p = 1 by basis and aspect ratio. rates: exponents of delta; conditions: cond at each delta."""
    for source, basis in (("4.5.1", "constant"), ("4.5.2", "linear")):
        found = {ar: rate for (name, ar), rate in rates.items() if name == basis}
        report.finding(source, f"p = 1, {basis} basis: cond is proportional to delta^-2",
                       all_of(abs(rate + 2) <= EXPONENT_TOLERANCE for rate in found.values()), "exponents of delta: "
                       + ", ".join(f"{rate:.2f} (AR {ar})" for ar, rate in found.items()), stated="-2",
                       criterion=f"exponents within {EXPONENT_TOLERANCE:g} of -2 from delta = {min(_DELTAS)} to "
                       f"{max(_DELTAS)}",
                       reason="The factor c = cond delta^2 grows with delta: u is 0 outside the square, so that the "
                       "slowest wave is as long as the square and a part of the horizon on each side; the exponent is "
                       "-2 for delta to 0 only")  # fmt: skip
        changes = {ar: max(abs(b / a - 1) for a, b in zip(conditions[basis, 1], values))
                   for (name, ar), values in conditions.items() if name == basis and ar > 1}
        report.finding(f"{source}, 6", f"p = 1, {basis} basis: anisotropy does not affect the condition number",
                       all_of(v <= LITTLE for v in changes.values()), "largest change against aspect ratio 1: "
                       + ", ".join(f"{v:.1%} (AR {ar})" for ar, v in changes.items()),
                       criterion=f"at each delta it changes by at most {LITTLE:.0%} against aspect ratio 1, while the "
                       "longer leg of the triangles is shorter than the horizon",
                       reason="The longer leg comes close to the horizon: the mesh no longer resolves it")  # fmt: skip


def _bounds(report, cond, sizes) -> None:
    """cond max(delta, h)^2 with horizons below, at and above the mesh size."""
    found = {(basis, n, k): cond(n, 1, k / n, basis, 1.0) * max(k, 1.0) ** 2 / n**2
             for basis in ("constant", "linear") for n in sizes for k in _HORIZONS}
    report.table("bounds_p1", "c in cond = c min(delta^-2, h^-2), p = 1", ["basis", "1/h", *(
        f"delta = {k:g} h" for k in _HORIZONS)], [[basis, n, *(found[basis, n, k] for k in _HORIZONS)] for basis, n in
                                                  dict.fromkeys(key[:2] for key in found)])  # fmt: skip
    bound_findings(report, found)


def bound_findings(report: Report, found: dict[tuple[str, int, float], float]) -> None:
    """The bound by delta^-2 and h^-2. found: cond max(delta, h)^2 by basis, 1/h and delta / h."""
    report.finding("4.4.1", "p = 1: cond <= c min(delta^-2, h^-2)",
                   all_of(v <= CLOSE_TO_ONE[1] for v in found.values()),
                   f"c up to {max(found.values()):.3f} with delta from {_HORIZONS[0]:g} h to {_HORIZONS[-1]:g} h",
                   criterion=f"cond max(delta, h)^2 at most {CLOSE_TO_ONE[1]:g}, with horizons below the mesh size, "
                   "too")  # fmt: skip


def _limit(report, cond, small) -> None:
    """c for delta to 0 with a fixed number of elements in the horizon, beside its limit."""
    c = {d: cond(round(_ELEMENTS / d), 1, d, "constant", 1.0) * d * d for d in (_SHORT[:2] if small else _SHORT)}
    report.table("short_horizons", f"c = cond delta^2, constant basis, p = 1, h = delta / {_ELEMENTS}",
                 ["delta", "c"], [[d, v] for d, v in c.items()])
    limit_findings(report, c)


def limit_findings(report: Report, c: dict[float, float]) -> None:
    """The limit of c = cond delta^2 by delta, the last two of which are extrapolated linearly."""
    (d, one), (e, other) = list(c.items())[-2:]
    extrapolated = other + (other - one) * e / (d - e)
    limit = 2 * (4 - 1.0) / ((2 - 1.0) * math.pi**2)
    report.finding("4.4.1", "p = 1: cond delta^2 tends to 2 (4 - p) / ((2 - p) pi^2) for delta to 0",
                   all_of([abs(extrapolated / limit - 1) <= LITTLE, *(less(b, a, ERROR) for a, b in
                                                                    zip(c.values(), [*c.values()][1:]))]),
                   ", ".join(f"{v:.3f} with delta = {d:g}" for d, v in c.items())
                   + f", extrapolated {extrapolated:.3f}; the limit is {limit:.3f}", own=True,
                   criterion=f"it decreases with delta and is extrapolated to within {LITTLE:.0%} of the limit")


def _over_size(report, cond, sizes) -> None:
    """Growth with 1/h. The finest mesh is left out where delta is twice as large or the basis is constant."""
    rows, lines, exact = [], {}, {}
    for basis, p, delta, left in (("constant", 1.0, 0.2, 1), ("linear", 1.0, 0.2, 0), ("linear", 1.0, 0.4, 1),
                                  ("linear", _P, 0.2, 0), ("linear", _P, 0.4, 1)):  # fmt: skip
        use = sizes[: len(sizes) - left]
        for discretization in ("exact", "dissertation"):
            y = [cond(n, 1, delta, basis, p, discretization) for n in use]
            rates = [math.log2(b / a) for a, b in zip(y, y[1:])]
            if discretization == "exact":
                exact[basis, p, delta] = y
            rows.append([basis, p, delta, discretization, *(f"{v:.3f}" for v in y), *[""] * left,
                         " ".join(f"{r:.2f}" for r in rates)])  # fmt: skip
            style, rules = ("o-", "") if discretization == "exact" else ("x:", ", dissertation's rules")
            lines[f"{basis}, p = {p:g}, delta = {delta}{rules}"] = [1 / n for n in use], y, style
    report.texts("Growth with 1/h, aspect ratio 1", rows,
                 ["basis", "p", "delta", "discretization", *(f"1/h = {n}" for n in sizes), "exponents of 1/h"],
                 "growth_h")  # fmt: skip
    chart = {"title": "growth with 1/h", "x": "h", "xscale": "log", "yscale": "log", "lines": lines}
    report.chart("peridynamics_horizon_h", [chart])
    size_findings(report, exact)


def size_findings(report: Report, curves: dict[tuple[str, float, float], list[float]]) -> None:
    """The findings on the element size. curves: cond at halved h, by basis, p and delta."""
    rates = {key: [math.log2(b / a) if a * b > 0 else math.nan for a, b in zip(y, y[1:])] for key, y in curves.items()}
    told = {key: f"delta = {key[2]:g}: " + ", ".join(f"{r:.2f}" for r in found) for key, found in rates.items()}
    limits = {}
    for source, basis in (("4.5.1", "constant"), ("4.5.2", "linear")):
        found = {key: y for key, y in curves.items() if key[:2] == (basis, 1.0)}
        shrunk = {key: [abs((c - b) / (b - a)) if b != a else math.inf for a, b, c in zip(y, y[1:], y[2:])]
                  for key, y in found.items()}
        report.finding(source, f"p = 1, {basis} basis: cond converges to a stable level under refinement",
                       all_of(v <= _SHRINKS for ratios in shrunk.values() for v in ratios), "; ".join(
                           f"delta = {key[2]:g}: " + ", ".join(f"{v:.4g}" for v in y) + ", differences shrink by "
                           + ", ".join(f"{v:.2f}" for v in shrunk[key]) for key, y in found.items()),
                       criterion=f"each difference is at most {_SHRINKS:g} times the one before")  # fmt: skip
        *_, before, last = next(iter(found.values()))
        limits[basis] = last + (last - before) / (2 ** _ORDERS[basis] - 1)
    report.finding("4.5.1, 4.5.2", "p = 1: both bases tend to the same condition number under refinement",
                   close(limits["linear"], limits["constant"], LITTLE), "extrapolated with delta = 0.2: " + ", ".join(
                       f"{basis} {v:.4g}" for basis, v in limits.items()), own=True,
                   criterion=f"within {LITTLE:.0%}, the constant basis with order 1 in h, the linear one with 2/3")
    found = {key: r for key, r in rates.items() if key[1] == _P}
    shown = "exponents of 1/h, " + "; ".join(told[key] for key in found)
    report.finding("4.5.3, 4.6", f"p = {_P:g}: cond is proportional to h^-1",
                   all_of(abs(r - 1) <= EXPONENT_TOLERANCE for of_delta in found.values() for r in of_delta), shown,
                   criterion=f"exponents within {EXPONENT_TOLERANCE:g} of 1 at each refinement", stated="h^-1",
                   reason="The largest eigenvalue grows like h^-(p-2), as the symbol of the operator does for waves "
                   "much shorter than the horizon, and the smallest one tends to a constant; what is measured falls "
                   f"towards p - 2 = {_P - 2:g}")  # fmt: skip
    powers = {key: _power(curves[key]) for key in found}
    report.finding("4.5.3", f"p = {_P:g}: cond grows like h^-(p-2) in addition to a constant",
                   all_of(Open("there are too few sizes") if math.isnan(v) else abs(v - (_P - 2)) <= EXPONENT_TOLERANCE
                          for v in powers.values()),
                   ", ".join(f"{v:.2f} with delta = {key[2]:g}" for key, v in powers.items()), own=True,
                   criterion=f"the exponent of the last two differences of cond is within {EXPONENT_TOLERANCE:g} of "
                   f"{_P - 2:g}")  # fmt: skip


def _power(values: Sequence[float]) -> float:
    """q of cond = a + b h^-q by the last three of halved h; nan: there are fewer, or they do not grow."""
    if len(values) < 3 or not (values[-1] > values[-2] > values[-3]):
        return math.nan
    return math.log2((values[-1] - values[-2]) / (values[-2] - values[-3]))


def _over_ratio(report, cond, sizes) -> None:
    rows, lines, exact = [], {}, {}
    for p in (1.0, _P):
        for n in sizes:
            for discretization in ("exact", "dissertation"):
                use = [a for a in _RATIOS if not math.isnan(cond(n, a, 0.2, "linear", p))]
                y = [cond(n, a, 0.2, "linear", p, discretization) for a in use]
                if (p, discretization) == (_P, "exact"):
                    exact[n] = {a: v for a, v in zip(use, y) if resolved(n, a, 0.2)}
                ratios = " ".join(f"{b / a:.2f}" for a, b in zip(y, y[1:]))
                rows.append([p, n, discretization, *("indefinite" if math.isnan(v) else f"{v:.3f}" for v in y),
                             *[""] * (len(_RATIOS) - len(y)), ratios])  # fmt: skip
                lines[f"p = {p:g}, h = 1/{n}" + ("" if discretization == "exact" else ", dissertation's rules")] = (
                    use, y, "o-" if discretization == "exact" else "x:")  # fmt: skip
    report.texts("Growth with the aspect ratio, linear basis, delta = 0.2, dx dy fixed", rows,
                 ["p", "1/h", "discretization", *(f"AR {a}" for a in _RATIOS), "per factor 4"], "growth_ratio")
    chart = {"title": "growth with the aspect ratio", "x": "aspect ratio", "xscale": "log", "yscale": "log",
             "lines": lines}  # fmt: skip
    report.chart("peridynamics_horizon_ratio", [chart])
    report.text("AR^((p-2)/2), the shortest edge to the power -(p-2), grows by 1.41 per factor 4 for p = 2.5. With the "
                "dissertation's rules cond grows faster, by their error.")  # fmt: skip
    ratio_findings(report, exact)


def ratio_findings(report: Report, curves: dict[int, dict[int, float]]) -> None:
    """The findings on the aspect ratio for p = 2.5. curves: by 1/h cond at growing aspect ratios, from 1."""
    told = "; ".join(f"h = 1/{n}: " + ", ".join(f"{v:.4g} (AR {a})" for a, v in found.items())
                     for n, found in curves.items())
    firsts = [list(found.values())[:2] for found in curves.values() if len(found) > 1]
    report.finding("4.5.3, 4.6", f"p = {_P:g}: anisotropy increases cond", all_of(map(increasing, firsts)), told,
                   criterion="it is larger with aspect ratio 4 than with 1 on each mesh")
    further = [list(found.values())[1:] for found in curves.values() if len(found) > 2]
    report.finding("4.5.3, 4.6", f"p = {_P:g}: further anisotropy does not increase cond",
                   all_of(max(values) <= (1 + LITTLE) * values[0] for values in further), told,
                   criterion=f"with aspect ratios above 4 it is at most {LITTLE:.0%} larger than with 4, while the "
                   "longer leg is shorter than the horizon",
                   reason="The largest eigenvalue belongs to the shortest waves, across the shortest edges, and grows "
                   "like their length to the power -(p-2): with h fixed like AR^((p-2)/2), "
                   f"{4 ** ((_P - 2) / 2):.2f} times per factor 4")  # fmt: skip
    slopes = {n: exponent([*found][1:], [*found.values()][1:]) for n, found in curves.items() if len(found) > 2}
    report.finding("4.5.3", f"p = {_P:g}: further anisotropy increases cond like AR^((p-2)/2)",
                   all_of(abs(v - (_P - 2) / 2) <= EXPONENT_TOLERANCE for v in slopes.values()),
                   ", ".join(f"{v:.2f} with h = 1/{n}" for n, v in slopes.items()) or "one aspect ratio only", own=True,
                   criterion=f"exponents above aspect ratio 4 within {EXPONENT_TOLERANCE:g} of {(_P - 2) / 2:g}")
