# SPDX-License-Identifier: BSD-3-Clause
"""Tables 4.1, 4.2 and 4.3: condition numbers of nonlocal stiffness matrices, printed and ours by both discretizations.

Discretization (a) is the dissertation's rules: three outer points, and one inner point (linear basis) or three
(constant); cut triangles by their chords. "literal" is the rule of its text, one outer and three inner points.
Discretization (b) is the exact integrals, to a tolerance.
"""

from __future__ import annotations

import math
from typing import Sequence

from ._horizon import MODELS, TABLES, Report, condition, parse

_DELTAS = (0.2, 0.3, 0.4)
_SIZES = (10, 20, 40)
#: Within which (a) is to be the printed number.
_TOLERANCES = {"4.1": 0.02, "4.2": 0.005, "4.3": 0.005}
#: c of cond <= c delta^-2 is close to 1 where it is in this range.
_CLOSE_TO_ONE = (0.5, 1.0)
#: Within which the exponents of h are to be 1, as in cond ~ h^-1.
_EXPONENT_TOLERANCE = 0.1

#: By table, aspect ratio, 1/h and delta: the condition numbers (a) and (b).
Values = dict[tuple[str, int, int, float], tuple[float, float]]


def _differ(value: float, other: float) -> str:
    return f"{100 * (value / other - 1):+.2f} %"


def main(arguments: Sequence[str]) -> int:
    given = parse("peridynamics_tables", __doc__, arguments)
    report = Report("peridynamics_tables", "Condition numbers of nonlocal models (Tables 4.1 to 4.3)", given.out,
                    given.small)  # fmt: skip
    finest = _SIZES[0] if given.small else _SIZES[-1]
    rows: list[list] = []
    values: Values = {}
    for table, printed in TABLES.items():
        basis, p = MODELS[table]
        lines = []
        for (ar, n, delta), number in printed.items():
            if n > finest:
                continue
            case = (n, ar, delta, basis, p)
            a = condition(*case, "dissertation", given.threads, False)
            literal = condition(*case, "dissertation", given.threads, False, rules="literal")
            b = condition(*case, "exact", given.threads, False)
            values[table, ar, n, delta] = a, b
            shown = "indefinite" if math.isnan(literal) else f"{literal:.2f}"
            line = [ar, n, delta, number, f"{a:.2f}", _differ(a, number), shown, f"{b:.4f}", _differ(a, b),
                    _differ(number, b)]  # fmt: skip
            lines.append(line)
            rows.append([table, ar, n, delta, basis, p, number, a, literal, b])
        headings = ["AR", "1/h", "delta", "printed", "(a)", "(a)/printed", "literal", "(b)", "(a)/(b)", "printed/(b)"]
        report.texts(f"Table {table}: piecewise {basis} basis, p = {p:g}", lines, headings)
        worst = max(abs(a / b - 1) for k, (a, b) in values.items() if k[0] == table)
        report.text(f"Table {table}: (a) is within {100 * worst:.1f} % of (b).")
    report.csv("peridynamics_tables", ["table", "aspect_ratio", "n", "delta", "basis", "p", "printed", "a", "literal",
                                       "b"], rows)  # fmt: skip
    findings(report, values)
    _charts(report, values, finest)
    return report.finish()


def _charts(report: Report, values: Values, finest: int) -> None:
    sizes = [n for n in _SIZES if n <= finest]
    panels = []
    for table in TABLES:
        lines = {}
        for ar, mark in ((1, "o"), (4, "s")):
            for delta, color in zip(_DELTAS, ("C0", "C1", "C2")):
                label = f"AR {ar}, delta {delta}"
                lines[f"{label}: (b)"] = (sizes, [values[table, ar, n, delta][1] for n in sizes], f"{color}{mark}-")
                printed = [TABLES[table][ar, n, delta] for n in sizes]
                lines[f"_{label}"] = (sizes, printed, f"{color}{mark}:")
        basis, p = MODELS[table]
        panels.append({"title": f"Table {table}: {basis}, p = {p:g} (dotted: printed)", "x": "1/h", "lines": lines})
    report.chart("peridynamics_tables", panels)


def findings(report: Report, values: Values) -> None:
    """The findings on the tables of our condition numbers; those of trends by (b)."""
    for table, tolerance in _TOLERANCES.items():
        off = {k[1:]: a / TABLES[table][k[1:]] - 1 for k, (a, _) in values.items() if k[0] == table}
        far = {key: part for key, part in off.items() if not abs(part) <= tolerance}
        report.finding(f"Table {table}", f"The printed numbers are those of (a) within {tolerance:.1%}", not far,
                       f"{len(off) - len(far)} of {len(off)}" + "".join(
                           f"; AR {ar}, h = 1/{n}, delta = {d}: (a) {100 * part:+.1f} %"
                           for (ar, n, d), part in far.items()), any_size=True)  # fmt: skip
    finest = max(n for _, _, n, _ in values)
    low, high = _CLOSE_TO_ONE
    for table, name in (("4.1", "constant"), ("4.2", "linear")):
        c = [values[table, 1, finest, d][1] * d * d for d in _DELTAS]
        report.finding(f"Table {table}", f"cond <= c delta^-2 with c close to 1 ({low:g} to {high:g}; {name} basis, "
                       "p = 1)", all(low <= v <= high for v in c),
                       f"cond delta^2 at h = 1/{finest}: " + ", ".join(
                           f"{v:.3f} at delta = {d}" for v, d in zip(c, _DELTAS)))  # fmt: skip
    sizes = [n for n in _SIZES if n <= finest]
    rates = {d: [math.log(values["4.3", 1, m, d][1] / values["4.3", 1, n, d][1]) / math.log(m / n)
                 for n, m in zip(sizes, sizes[1:])] for d in _DELTAS}  # fmt: skip
    found = [rate for of_delta in rates.values() for rate in of_delta]
    report.finding("Table 4.3", f"p = 2.5: cond grows like h^-1 (exponents within {_EXPONENT_TOLERANCE:g})",
                   all(abs(rate - 1) <= _EXPONENT_TOLERANCE for rate in found) if found else None,
                   "; ".join(f"delta = {d}: " + ", ".join(f"{r:.2f}" for r in of_delta) for d, of_delta in rates.items()
                             if of_delta) or "one mesh size only")  # fmt: skip
    ratios = [values["4.3", 4, finest, d][1] / values["4.3", 1, finest, d][1] for d in _DELTAS]
    report.finding("Table 4.3", "p = 2.5: anisotropy increases cond", all(r > 1 for r in ratios),
                   f"aspect ratio 4 over 1 at h = 1/{finest}: " + ", ".join(f"{r:.2f}" for r in ratios))  # fmt: skip
