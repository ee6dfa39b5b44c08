"""Tables 4.1, 4.2 and 4.3: condition numbers of nonlocal stiffness matrices, printed and ours by both discretizations.

Discretization (a) is the dissertation's rules: three outer points, and one inner point (linear basis) or three
(constant); cut triangles by their chords. "literal" is the rule of its text, one outer and three inner points.
Discretization (b) is the exact integrals, to a tolerance.
"""

from __future__ import annotations

import math
from typing import Sequence

from ._horizon import MODELS, TABLES, Report, condition, parse


def _differ(value: float, other: float) -> str:
    return f"{100 * (value / other - 1):+.2f} %"


def main(arguments: Sequence[str]) -> int:
    options = parse("peridynamics_tables", __doc__.splitlines()[0], arguments)
    report = Report("peridynamics_tables", options.out)
    finest = 10 if options.size == "small" else 40
    rows, values = [], {}
    for table, printed in TABLES.items():
        basis, p = MODELS[table]
        report.text(f"Table {table}: piecewise {basis} basis, p = {p:g}")
        lines = []
        for (ar, n, delta), number in printed.items():
            if n > finest:
                continue
            case = (n, ar, delta, basis, p)
            a = condition(*case, "dissertation", options.threads, False)
            literal = condition(*case, "dissertation", options.threads, False, rules="literal")
            b = condition(*case, "exact", options.threads, False)
            values[table, ar, n, delta] = a, b
            shown = "indefinite" if math.isnan(literal) else f"{literal:.2f}"
            line = [ar, n, delta, number, f"{a:.2f}", _differ(a, number), shown, f"{b:.4f}", _differ(a, b),
                    _differ(number, b)]  # fmt: skip
            lines.append(line)
            rows.append([table, ar, n, delta, basis, p, number, a, literal, b])
        report.table(lines, ["AR", "1/h", "delta", "printed", "(a)", "(a)/printed", "literal", "(b)", "(a)/(b)",
                             "printed/(b)"])  # fmt: skip
    report.write_csv("peridynamics_tables.csv", rows, ["table", "aspect_ratio", "n", "delta", "basis", "p", "printed",
                                                       "a", "literal", "b"])  # fmt: skip
    _judge(report, values, finest)
    panels = []
    for table in TABLES:
        lines = {}
        for ar, mark in ((1, "o"), (4, "s")):
            sizes = [n for n in (10, 20, 40) if n <= finest]
            for delta, color in ((0.2, "C0"), (0.3, "C1"), (0.4, "C2")):
                label = f"AR {ar}, delta {delta}"
                lines[f"{label}: (b)"] = (sizes, [values[table, ar, n, delta][1] for n in sizes], f"{color}{mark}-")
                printed = [TABLES[table][ar, n, delta] for n in sizes]
                lines[f"_{label}"] = (sizes, printed, f"{color}{mark}:")
        basis, p = MODELS[table]
        panels.append({"title": f"Table {table}: {basis}, p = {p:g} (dotted: printed)", "x": "1/h", "lines": lines})
    report.chart("peridynamics_tables.png", panels)
    return report.close()


def _judge(report: Report, values: dict, finest: int) -> None:
    linear = [(k, a, TABLES[k[0]][k[1:]]) for k, (a, _) in values.items() if k[0] != "4.1"]
    close = sum(abs(a / printed - 1) < 0.005 for _, a, printed in linear)
    report.text(f"Discretization (a), linear basis: {close} of {len(linear)} printed values within 0.5 %; the others:")
    for key, a, printed in linear:
        if abs(a / printed - 1) >= 0.005:
            report.text(f"  Table {key[0]}, AR {key[1]}, h = 1/{key[2]}, delta = {key[3]}: printed {printed}, "
                       f"(a) {a:.2f}, (b) {values[key][1]:.2f}")  # fmt: skip
    constant = [(k, a, TABLES[k[0]][k[1:]]) for k, (a, _) in values.items() if k[0] == "4.1"]
    close = sum(abs(a / printed - 1) < 0.02 for _, a, printed in constant)
    report.text(f"Discretization (a), constant basis: {close} of {len(constant)} printed values within 2 %.")
    for table in TABLES:
        worst = max(abs(a / b - 1) for k, (a, b) in values.items() if k[0] == table)
        report.text(f"Table {table}: (a) is within {100 * worst:.1f} % of (b).")
    report.text("\nFindings")
    for table, name in (("4.1", "constant"), ("4.2", "linear")):
        c = [f"{values[table, 1, finest, d][1] * d * d:.3f}" for d in (0.2, 0.3, 0.4)]
        report.text(f"cond <= c delta^-2 with c close to 1 ({name}, p = 1): holds as a bound; cond delta^2 at "
                   f"h = 1/{finest} is {', '.join(c)} at delta = 0.2, 0.3, 0.4 (b).")  # fmt: skip
    for d in (0.2, 0.4):
        b = [values["4.3", 1, n, d][1] for n in (10, 20, 40) if n <= finest]
        rates = [f"{math.log2(y / x):.2f}" for x, y in zip(b, b[1:])]
        if rates:
            report.text(f"p = 2.5, delta = {d}: cond grows like h^-{', h^-'.join(rates)} from one h to the next (b); "
                        "the dissertation has h^-1, and the rate decreases.")  # fmt: skip
    ratios = [f"{values['4.3', 4, finest, d][1] / values['4.3', 1, finest, d][1]:.2f}" for d in (0.2, 0.3, 0.4)]
    report.text(f"p = 2.5: anisotropy increases cond: holds; AR 4 over AR 1 is {', '.join(ratios)} (b). The "
               "study peridynamics_horizon has larger aspect ratios.")  # fmt: skip
