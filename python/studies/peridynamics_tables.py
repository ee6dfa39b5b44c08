# SPDX-License-Identifier: BSD-3-Clause
"""Tables 4.1, 4.2 and 4.3: condition numbers of nonlocal stiffness matrices, printed and ours by both discretizations.

Discretization (a) is the dissertation's rules: three outer points, and one inner point (linear basis) or three
(constant); cut triangles by their chords. "literal" is the rule of its text, one outer and three inner points.
Discretization (b) is the exact integrals, to a tolerance.
"""

from __future__ import annotations

import math
from typing import NamedTuple, Sequence

from ._horizon import (CLOSE_TO_ONE, ERROR, EXPONENT_TOLERANCE, LITTLE, MODELS, TABLES, Report, Spectrum, condition,
                       increasing, parse, spectrum)  # fmt: skip
from ._verdicts import Open, Verdict, all_of, any_of, less

_DELTAS = (0.2, 0.3, 0.4)
_SIZES = (10, 20, 40)
_RATIOS = (1, 4)
#: Relative tolerance for agreement with a printed number; the printed ones have three or four digits.
_SAME = 0.02
#: Tolerance of the integrals with which the error of (b) is estimated, a hundredth of the default.
_FINE = 1e-7
#: The refinement ratios that the tables print, by aspect ratio, 1/h of the finer mesh and delta.
_RATIO_KEYS = [(ar, n, delta) for ar in _RATIOS for n in _SIZES[1:] for delta in _DELTAS]
PRINTED_RATIOS = {table: dict(zip(_RATIO_KEYS, values)) for table, values in {
    "4.1": [1.07, 1.04, 1.02, 1.03, 1.00, 1.01, 1.09, 1.11, 1.03, 1.02, 0.92, 1.02],
    "4.2": [1.26, 1.18, 1.03, 1.14, 1.09, 1.06, 1.23, 1.01, 1.13, 1.09, 1.09, 1.06],
    "4.3": [1.86, 1.78, 1.70, 1.71, 1.63, 1.59, 1.86, 1.47, 1.99, 1.69, 1.60, 1.46],
}.items()}  # fmt: skip
#: The comparisons of two numbers of a table.
REFINED, STRETCHED, SHORTENED = "h halved", "aspect ratio 4 over 1", "delta = 0.2 over 0.4"
#: Why the entries of Table 4.3 do not grow like 1/h.
_POWER = ("The largest eigenvalue grows like h^-(p-2), as the symbol of the operator does for waves much shorter than "
          "the horizon, and the smallest one does not depend on h; exponents fall towards p - 2 = 0.5, see the study "
          "peridynamics_horizon")


class Entry(NamedTuple):
    """The condition numbers of an entry of a table."""

    a: float
    literal: float
    b: float


#: By aspect ratio, 1/h and delta.
Cells = dict[tuple[int, int, float], Entry]


def main(arguments: Sequence[str]) -> int:
    given = parse("peridynamics_tables", __doc__, arguments)
    report = Report("peridynamics_tables", "Condition numbers of nonlocal models (Tables 4.1 to 4.3)", given)
    finest = _SIZES[0] if given.small else _SIZES[-1]
    rows: list[list] = []
    values: dict[str, Cells] = {}
    asymmetries: list[float] = []
    fine: dict[str, tuple[float, float]] = {}
    for table, printed in TABLES.items():
        basis, p = MODELS[table]
        cells: Cells = {}
        for (ar, n, delta), number in printed.items():
            if n > finest:
                continue
            rules: Spectrum = spectrum(n, ar, delta, basis, p, "dissertation", given.threads, False)
            literal = condition(n, ar, delta, basis, p, "dissertation", given.threads, False, rules="literal")
            cells[ar, n, delta] = Entry(rules.condition, literal,
                                        condition(n, ar, delta, basis, p, "exact", given.threads, False))
            asymmetries.append(rules.asymmetry)
            rows.append([table, ar, n, delta, basis, p, number, *cells[ar, n, delta]])
        case = (_SIZES[0], 1, _DELTAS[0])
        better = condition(*case, basis, p, "exact", given.threads, False, tolerance=_FINE)
        fine[table] = cells[1, _SIZES[0], _DELTAS[0]].b, better
        values[table] = cells
        _show(report, table, cells)
    report.csv("peridynamics_tables", ["table", "aspect_ratio", "n", "delta", "basis", "p", "printed", "a", "literal",
                                       "b"], rows)  # fmt: skip
    for table, cells in values.items():
        number_findings(report, table, cells)
        ratio_findings(report, table, cells, PRINTED_RATIOS[table])
    matrix_findings(report, values, max(asymmetries), fine)
    integrable_findings(report, values["4.1"], values["4.2"])
    singular_findings(report, values["4.3"])
    _charts(report, values, finest)
    return report.finish()


def _show(report: Report, table: str, cells: Cells) -> None:
    """The numbers and the ratios of a table."""
    basis, p = MODELS[table]
    lines = []
    for key, (a, literal, b) in cells.items():
        number = TABLES[table][key]
        shown = "indefinite" if math.isnan(literal) else f"{literal:.2f}"
        lines.append([*key[:1], f"1/{key[1]}", key[2], number, f"{a:.2f}", _differ(a, number), shown, f"{b:.4f}",
                      _differ(a, b), _differ(number, b)])
    headings = ["AR", "h", "delta", "printed", "(a)", "(a)/printed", "literal", "(b)", "(a)/(b)", "printed/(b)"]
    file = f"table_{table}".replace(".", "_")
    report.texts(f"Table {table}: piecewise {basis} basis, p = {p:g}", lines, headings, file)
    ratios = [[what, *_place(key), *("-" if math.isnan(v) else f"{v:.2f}" for v in (
        PRINTED_RATIOS[table].get(key, math.nan) if what == REFINED else math.nan, _ratio(TABLES[table], what, key),
        _ratio(_numbers(cells, "a"), what, key), _ratio(_numbers(cells, "b"), what, key)))]
        for what in (REFINED, STRETCHED, SHORTENED) for key in _keys(cells, what)]  # fmt: skip
    report.texts(f"Table {table}: ratios", ratios, ["ratio", "AR", "h", "delta", "printed", "of printed numbers", "(a)",
                                                    "(b)"], f"{file}_ratios")  # fmt: skip
    worst = max(abs(a / b - 1) for a, _, b in cells.values())
    report.text(f"Table {table}: (a) is within {100 * worst:.1f} % of (b).")


def _differ(value: float, other: float) -> str:
    return f"{100 * (value / other - 1):+.2f} %"


def _place(key: tuple[int, int, float]) -> list[str]:
    return [str(key[0]), f"1/{key[1]}", f"{key[2]:g}"]


def _numbers(cells: Cells, which: str) -> dict[tuple[int, int, float], float]:
    return {key: getattr(entry, which) for key, entry in cells.items()}


def _other(what: str, key: tuple[int, int, float]) -> tuple[int, int, float]:
    """The entry that another one is compared with."""
    ar, n, delta = key
    return {REFINED: (ar, n // 2, delta), STRETCHED: (_RATIOS[0], n, delta), SHORTENED: (ar, n, _DELTAS[-1])}[what]


def _keys(cells: dict, what: str) -> list[tuple[int, int, float]]:
    """The entries that are compared with another one."""
    last = {REFINED: lambda k: True, STRETCHED: lambda k: k[0] == _RATIOS[1], SHORTENED: lambda k: k[2] == _DELTAS[0]}
    return [key for key in cells if last[what](key) and _other(what, key) in cells]


def _ratio(numbers: dict, what: str, key: tuple[int, int, float]) -> float:
    return numbers[key] / numbers[_other(what, key)]


def _charts(report: Report, values: dict[str, Cells], finest: int) -> None:
    sizes = [n for n in _SIZES if n <= finest]
    panels = []
    for table, cells in values.items():
        lines = {}
        for ar, mark in zip(_RATIOS, "os"):
            for delta, color in zip(_DELTAS, ("C0", "C1", "C2")):
                label = f"AR {ar}, delta {delta}"
                lines[f"{label}: (b)"] = (sizes, [cells[ar, n, delta].b for n in sizes], f"{color}{mark}-")
                printed = [TABLES[table][ar, n, delta] for n in sizes]
                lines[f"_{label}"] = (sizes, printed, f"{color}{mark}:")
        basis, p = MODELS[table]
        panels.append({"title": f"Table {table}: {basis}, p = {p:g} (dotted: printed)", "x": "1/h", "lines": lines})
    report.chart("peridynamics_tables", panels)


def _far(found: dict[tuple[int, int, float], float], stated: dict, tolerance: float) -> dict:
    """The numbers that are not the stated ones."""
    return {key: v for key, v in found.items() if not abs(v / stated[key] - 1) <= tolerance}


def _listed(found: dict, stated: dict, far: dict, what: str) -> str:
    """How many numbers are the stated ones, and the others."""
    others = "".join(f"; AR {ar}, h = 1/{n}, delta = {d:g}: {v:.2f} {what} {stated[ar, n, d]:.2f}"
                     for (ar, n, d), v in far.items())
    return f"{len(found) - len(far)} of {len(found)}{others}"


def number_findings(report: Report, table: str, cells: Cells) -> None:
    """The printed numbers of a table by the rules that reproduce most of them, and by the rules of the text."""
    printed = TABLES[table]
    ours = _numbers(cells, "a")
    far = _far(ours, printed, _SAME)
    errors = [abs(printed[key] / cells[key].b - 1) for key in far]
    good = [abs(cells[key].a / cells[key].b - 1) for key in cells if key not in far]
    reason = "" if not far or not good else (
        f"The numbers that differ are also {min(errors):.1%} to {max(errors):.1%} away from the exact integrals; the "
        f"others of (a) are within {max(good):.1%} of them")
    report.finding(f"Table {table}", "The printed condition numbers", all_of(key not in far for key in ours),
                   _listed(ours, printed, far, "for printed"), reason=reason,
                   criterion=f"all within {_SAME:.0%} of (a), three outer points and one inner (constant basis: three)")
    ours = _numbers(cells, "literal")
    far = _far(ours, printed, _SAME)
    indefinite = sum(math.isnan(v) for v in ours.values())
    report.finding("4.3.1", f"One outer and three inner points give the numbers of Table {table}",
                   all_of(key not in far for key in ours),
                   f"{len(ours) - len(far)} of {len(ours)}; {indefinite} matrices are not positive definite",
                   criterion=f"all within {_SAME:.0%} of the rules as the text has them",
                   reason="Other rules give more of the numbers, see (a)" if MODELS[table][0] == "constant" else
                   "With the centroid as the only outer point, the rows of a vertex depend on the means of its "
                   "triangles alone; on this grid a vector can be 1, -1 and 0 at the vertices of each triangle, with "
                   "mean 0 everywhere: such a vector is in the left null space up to the boundary")  # fmt: skip


def ratio_findings(report: Report, table: str, cells: Cells, printed: dict[tuple[int, int, float], float]) -> None:
    """The ratios of the numbers of a table. printed: those that the table has, of halving h."""
    numbers = {key: _ratio(TABLES[table], REFINED, key) for key in printed}
    far = _far(numbers, printed, _SAME)
    report.finding(f"Table {table}", "The printed ratios are the ratios of the printed numbers",
                   all_of(key not in far for key in numbers), _listed(numbers, printed, far, "for printed"), own=True,
                   criterion=f"all within {_SAME:.0%}", proof="printed numbers alone, no mesh is used",
                   reason="An error of the arithmetic or of the print")
    for what in (REFINED, STRETCHED, SHORTENED):
        keys = _keys(cells, what)
        ours = {key: _ratio(_numbers(cells, "b"), what, key) for key in keys}
        theirs = {key: _ratio(TABLES[table], what, key) for key in keys}
        far = _far(ours, theirs, LITTLE)
        rules = {key: _ratio(_numbers(cells, "a"), what, key) for key in far}
        same = not _far(rules, theirs, _SAME)
        reason = ("The dissertation's quadrature rules cause it: with them the ratios are the printed ones" if same else
                  "Numbers that no rule of quadrature reproduces are among these ratios, see the printed condition "
                  "numbers")
        report.finding(f"Table {table}", f"The ratios of the condition numbers, {what}", all_of(
            key not in far for key in keys), _listed(ours, theirs, far, "for printed"), reason=reason,
            criterion=f"with the exact integrals, all within {LITTLE:.0%} of the ratio of the printed numbers")


def matrix_findings(report: Report, values: dict[str, Cells], asymmetry: float,
                    fine: dict[str, tuple[float, float]]) -> None:
    """Definiteness, symmetry and the error of our numbers. fine: (b) with two tolerances of the integrals, by table."""
    found = [v for cells in values.values() for entry in cells.values() for v in (entry.a, entry.b)]
    definite = sum(v > 0 for v in found)
    report.finding("4.2", "A is symmetric and positive definite", definite == len(found) and asymmetry <= ERROR,
                   f"{definite} of {len(found)} matrices positive definite, asymmetry at most {asymmetry:.2g}",
                   criterion="the smallest eigenvalue is positive beyond its bound with (a) and (b), and the "
                   f"skew-symmetric part is at most {ERROR:g} of the matrix with (a); (b) is symmetric by construction")
    report.finding("Tables 4.1 to 4.3", f"Our condition numbers (b) have a relative error of at most {ERROR:g}",
                   all_of(abs(v / better - 1) <= ERROR for v, better in fine.values()), "; ".join(
                       f"Table {table}: {v:.6g} and {better:.6g}" for table, (v, better) in fine.items()), own=True,
                   criterion=f"as much as on the coarsest mesh with a tolerance of the integrals of {_FINE:g}")


def integrable_findings(report: Report, constant: Cells, linear: Cells) -> None:
    """p = 1: c of the bound, the basis, refinement, and ratios by delta; by (b) on the finest mesh."""
    low, high = CLOSE_TO_ONE
    finest = max(n for _, n, _ in constant)
    for table, name, cells in (("4.1", "constant", constant), ("4.2", "linear", linear)):
        c = {(ar, d): cells[ar, finest, d].b * d * d for ar in _RATIOS for d in _DELTAS}
        report.finding(f"Table {table}", f"cond <= c delta^-2 with c close to 1 ({name} basis, p = 1)",
                       all_of(low <= v <= high for v in c.values()), f"cond delta^2 at h = 1/{finest}: " + ", ".join(
                           f"{v:.3f} (AR {ar}, delta = {d})" for (ar, d), v in c.items()), stated="close to 1",
                       criterion=f"cond delta^2 from {low:g} to {high:g} on the finest mesh")  # fmt: skip
    apart = {key: linear[key].b / constant[key].b - 1 for key in constant}
    worst = {n: max(abs(v) for key, v in apart.items() if key[1] == n) for n in sorted({n for _, n, _ in constant})}
    told = ", ".join(f"{v:.1%} at h = 1/{n}" for n, v in worst.items())
    report.finding("4.1, 4.6", "p = 1: the condition number is almost not affected by the basis",
                   worst[finest] <= LITTLE, f"linear and constant differ by up to {told}",
                   criterion=f"at most {LITTLE:.0%} on the finest mesh",
                   reason="The largest eigenvalue is below its limit by a part proportional to (h / delta)^(2/3) with "
                   "the linear basis, whose mass matrix damps short waves, and h / delta with the constant one; both "
                   "tend to the same operator, and the printed numbers differ by as much")  # fmt: skip
    for source, name, cells in (("4.5.1, 4.6", "constant", constant), ("4.5.2, 4.6", "linear", linear)):
        found = {key: _ratio(_numbers(cells, "b"), REFINED, key) for key in _keys(cells, REFINED)}
        last = {key: v for key, v in found.items() if key[1] == finest}
        report.finding(source, f"p = 1: refinement affects the condition number very little ({name} basis)",
                       all_of(abs(v - 1) <= LITTLE for v in last.values()), "ratios of the last refinement: "
                       + ", ".join(f"{v:.3f} (AR {ar}, delta = {d:g})" for (ar, _, d), v in last.items()),
                       criterion=f"the last refinement changes it by at most {LITTLE:.0%}",
                       reason="The numbers still rise towards their limit, by a part proportional to (h / delta)^(2/3)")
        falls = [less(found[ar, n, b], found[ar, n, a], ERROR) for ar, n, a in found for b in _DELTAS
                 if a == _DELTAS[_DELTAS.index(b) - 1] and a < b]
        report.finding(source.split(",")[0], f"The refinement ratio decreases as delta increases ({name} basis)",
                       _most(falls), _counted(falls), criterion="in more than half of the pairs of neighboring delta")
        report.finding(source.split(",")[0], "It does because cut triangles decrease the numerical stability "
                       f"({name} basis)", _opposite(_most(falls)), _counted(falls) + " with exact integrals",
                       criterion="with the exact integrals, which have no error from cut triangles, it decreases in no "
                       "more than half of the pairs",
                       reason="The ratios decrease with the exact integrals as well: the condition number approaches "
                       "its limit like a power of h / delta")  # fmt: skip


def _most(verdicts: Sequence[Verdict]) -> Verdict:
    """Whether more than half hold; not decided where the ones that are not decided could change it."""
    holding = sum(1 for v in verdicts if not isinstance(v, Open) and v)
    undecided = sum(isinstance(v, Open) for v in verdicts)
    if 2 * holding > len(verdicts):
        return True
    if not verdicts or 2 * (holding + undecided) > len(verdicts):
        return Open("too many ratios are equal within their error" if verdicts else "there is one mesh size only")
    return False


def _opposite(verdict: Verdict) -> Verdict:
    return verdict if isinstance(verdict, Open) else not verdict


def _counted(verdicts: Sequence[Verdict]) -> str:
    holding = sum(1 for v in verdicts if not isinstance(v, Open) and v)
    undecided = sum(isinstance(v, Open) for v in verdicts)
    return f"decreases in {holding} of {len(verdicts)} pairs, equal within the error in {undecided}"


def singular_findings(report: Report, cells: Cells) -> None:
    """p = 2.5: growth with h, the aspect ratio and delta, by (b)."""
    numbers = _numbers(cells, "b")
    finest = max(n for _, n, _ in cells)
    refined = {key: _ratio(numbers, REFINED, key) for key in _keys(cells, REFINED)}
    rates = {key: math.log2(v) if v > 0 else math.nan for key, v in refined.items()}
    told = ", ".join(f"{v:.2f} (AR {ar}, h = 1/{n}, delta = {d:g})" for (ar, n, d), v in rates.items())
    report.finding("Table 4.3", "p = 2.5: cond grows like h^-1",
                   all_of(abs(rate - 1) <= EXPONENT_TOLERANCE for rate in rates.values()), told or "one mesh size only",
                   criterion=f"exponents of 1/h within {EXPONENT_TOLERANCE:g} of 1 at each refinement", reason=_POWER)
    least = min(refined.values(), default=math.nan)
    report.finding("4.5.3", "p = 2.5: the refinement ratio is not close to 1, even with delta = 0.4",
                   all_of(v > 1 + LITTLE for v in refined.values()), f"ratios of {least:.2f} and more",
                   criterion=f"all ratios above {1 + LITTLE:g}")  # fmt: skip
    stretched = {key: _ratio(numbers, STRETCHED, key) for key in _keys(cells, STRETCHED)}
    report.finding("Table 4.3", "p = 2.5: anisotropy increases cond",
                   all_of(less(1.0, v, 2 * ERROR) for v in stretched.values()), "aspect ratio 4 over 1: " + ", ".join(
                       f"{v:.2f} (h = 1/{n}, delta = {d:g})" for (_, n, d), v in stretched.items()),
                   criterion="it is larger with aspect ratio 4 than with 1 on each mesh")  # fmt: skip
    falling = [[numbers[ar, n, d] for d in reversed(_DELTAS)] for ar in _RATIOS for n in _SIZES if n <= finest]
    report.finding("4.5.3", "p = 2.5: cond increases as delta decreases", all_of(map(increasing, falling)),
                   f"delta = 0.2 over 0.4: {min(r[-1] / r[0] for r in falling):.2f} times and more",
                   criterion="on each mesh, from each delta to the next smaller one")  # fmt: skip
    scaled = {key: v * key[2] ** 2 for key, v in numbers.items() if key[1] == finest}
    grows = all_of(v > 1 + LITTLE for v in refined.values())
    beyond = any_of(v > CLOSE_TO_ONE[1] for v in scaled.values())
    report.finding("4.5.3", "p = 2.5: cond is not bounded by the horizon", all_of([beyond, grows]),
                   f"cond delta^2 up to {max(scaled.values()):.2f} at h = 1/{finest}; halving h: {least:.2f} times and "
                   "more", criterion=f"cond delta^2 exceeds {CLOSE_TO_ONE[1]:g} on the finest mesh, and each halving "
                   f"of h increases it by more than {LITTLE:.0%}")  # fmt: skip
