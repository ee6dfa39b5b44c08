# SPDX-License-Identifier: BSD-3-Clause
"""Preconditioners for nonlocal matrices: iterations by h, delta and p beside Jacobi; open question of section 4.6."""

from __future__ import annotations

import argparse
from typing import Any, NamedTuple, Sequence

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from . import _horizon
from ._meshes import sizes_of
from ._report import parser
from ._horizon import Report, exponent
from ._memory import remembered
from ._verdicts import Times, all_of, faster, timed

#: Names in the tables by the names of peridynamics().
PRECONDITIONERS = {"jacobi": "Jacobi", "local amg": "AMG of the local limit", "two-level": "two-level"}
NEW = ("local amg", "two-level")
_SIZES, _DELTAS, _RATIOS = (10, 20, 40), (0.2, 0.3, 0.4), (1, 4)
#: Exponents of the kernel with the linear basis; mesh and horizon.
_EXPONENTS, _EXPONENT_SIZE, _EXPONENT_DELTA = (0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5), 20, 0.2
#: Horizons of this many elements, and 1/h.
_ELEMENTS, _FINE_SIZES = 2, (10, 20, 40, 80)
#: Domains with unstructured triangles, numbers of cells, the horizon in mean element sizes, tolerance of integrals.
_DOMAINS, _CELLS, _ELEMENTS_UNSTRUCTURED, _INTEGRALS = ("disk2d", "hinge"), (500, 2000, 8000), 3, 1e-3
_SMALL_CELLS = (250, 500)
#: Horizons on the user's mesh, in mean element sizes.
_HORIZONS = (2, 3, 5)
#: By how much iterations may vary over a range in which they count as bounded: a factor of 2 in delta, 4 or 8 in h.
#: (Jacobi's iterations should grow like 1/delta and, with a horizon of fixed elements, like 1/h.)
BOUNDED = 0.5
#: The condition number of the preconditioned matrix that no case may exceed.
CONDITION = 10.0
#: This many more iterations also count as bounded, however few the easiest case takes.
MORE = 8
#: Order in 1/h of Jacobi's iterations where the horizon is a fixed number of elements.
_ORDER, _ORDER_TOLERANCE = 1.0, 0.25
_REPEATS = 3


class Found(NamedTuple):
    """Iterations to a relative residual of 1e-10, and the condition number estimated from them."""

    iterations: int
    condition: float


#: By preconditioner.
Row = dict[str, Found]


def taken(result: Any) -> Found:
    return Found(int(result.iterations), float(result.preconditioned_condition))


@remembered
def solved(n: int, aspect_ratio: float, delta: float, basis: str, p: float, threads: int) -> Row:
    """Each preconditioner on the square of the tables."""
    return {name: taken(_horizon.solve(n, aspect_ratio, delta, basis, p, "exact", threads, spectrum=False, solve=True,
                                       preconditioner=name)) for name in PRECONDITIONERS}


@remembered
def unstructured(bare: vtkDataSet, elements: float, p: float, threads: int) -> tuple[float, Row]:
    """The horizon, of some mean element sizes, and each preconditioner with an interaction layer; the linear basis."""
    delta = elements * float(np.sqrt(2 * np.mean(sizes_of(bare))))
    mesh = tautline.interaction_layer(bare, delta, threads=threads)
    return delta, {name: taken(tautline.peridynamics(mesh, delta, p, tolerance=_INTEGRALS, spectrum=False, solve=True,
                                                     preconditioner=name, threads=threads)) for name in PRECONDITIONERS}


@remembered
def times_of(n: int, delta: float, name: str, repeats: int, threads: int) -> Times:
    """CPU seconds of all threads of an assembly and a solution, p = 1, linear basis."""
    return timed(repeats, lambda: _horizon.solve(
        n, 1, delta, "linear", 1.0, "exact", threads, spectrum=False, solve=True, preconditioner=name))[1]


def main(arguments: Sequence[str]) -> int:
    made = parser("nonlocal_preconditioner", __doc__, repeats=_REPEATS)
    made.add_argument("--mesh", metavar="FILE", help="triangles in a plane: the preconditioners on this mesh alone")
    given = made.parse_args(arguments)
    report = Report("nonlocal_preconditioner", "Preconditioners for nonlocal matrices (section 4.6)", given)
    report.text(
        "Goal: a preconditioner that decreases the condition number of the nonlocal matrices. Conjugate "
        "gradients with three: the diagonal (Jacobi); one cycle of algebraic multigrid for the local limit (delta "
        "to 0), linear elements on the same triangles, added to the inverse of a mass matrix (p below 2) or of the "
        "diagonal; or a coarse grid with cells of about half the horizon, and the same inverse on what it leaves "
        "(two-level). Iterations to a relative residual of 1e-10 with a source of 1, and in brackets the condition "
        f"number estimated from them. Bounded: within the range at most {BOUNDED:.0%} or {MORE} more iterations: "
        "five and nine are both few."
    )
    if given.mesh:
        return users(report, given)
    sizes = _SIZES[:2] if given.small else _SIZES
    tables = {(basis, p, r, n, delta): solved(n, r, delta, basis, p, given.threads)
              for basis, p in _horizon.MODELS.values() for r in _RATIOS for n in sizes for delta in _DELTAS}
    shown(report, "tables", "The cases of Tables 4.1 to 4.3", ["basis", "p", "aspect ratio", "1/h", "delta"], tables)
    table_findings(report, tables)
    size = sizes[0] if given.small else _EXPONENT_SIZE
    exponents = {(p,): solved(size, 1, _EXPONENT_DELTA, "linear", p, given.threads) for p in _EXPONENTS}
    shown(report, "exponents", f"Linear basis, 1/h = {size}, delta = {_EXPONENT_DELTA}", ["p"], exponents)
    exponent_findings(report, {p: row for (p,), row in exponents.items()})
    fine = {(p, n): solved(n, 1, _ELEMENTS / n, "linear", p, given.threads)
            for p in (1.0, 2.5) for n in (_FINE_SIZES[:2] if given.small else _FINE_SIZES)}
    shown(report, "small_horizons", f"Linear basis, delta = {_ELEMENTS} h", ["p", "1/h"], fine)
    horizon_findings(report, fine)
    meshes = {}
    for domain in _DOMAINS:
        for cells in _SMALL_CELLS if given.small else _CELLS:
            for p in (1.0, 2.5):
                bare = tautline.domain(domain, cells=cells)
                delta, row = unstructured(bare, _ELEMENTS_UNSTRUCTURED, p, given.threads)
                meshes[domain, p, cells, f"{delta:.3g}"] = row
    report.text("On the coarsest hinge the horizon is nearly as wide as its arms: the matrix is almost a multiple of "
                "the mass matrix, and all three take few iterations.")
    shown(report, "unstructured", f"Unstructured triangles, delta = {_ELEMENTS_UNSTRUCTURED} elements",
          ["domain", "p", "cells", "delta"], meshes)  # fmt: skip
    mesh_findings(report, {key[:3]: row for key, row in meshes.items()})
    times = {name: times_of(sizes[-1], _DELTAS[0], name, given.repeats, given.threads) for name in PRECONDITIONERS}
    report.table("seconds", f"CPU seconds of assembly and solution, 1/h = {sizes[-1]}, delta = {_DELTAS[0]}, p = 1",
                 ["preconditioner", "CPU s"], [[PRECONDITIONERS[name], t.best] for name, t in times.items()])
    time_findings(report, times)
    report.chart("nonlocal_preconditioner", [
        {"title": f"delta = {_ELEMENTS} h, p = {p:g}", "x": "1/h", "y": "iterations", "xscale": "log", "yscale": "log",
         "lines": {label: ([n for q, n in fine if q == p], [r[name].iterations for (q, _), r in fine.items() if q == p])
                   for name, label in PRECONDITIONERS.items()}} for p in (1.0, 2.5)
    ] + [{"title": f"1/h = {size}, delta = {_EXPONENT_DELTA}", "x": "p", "y": "iterations",
          "lines": {label: (list(_EXPONENTS), [r[name].iterations for r in exponents.values()])
                    for name, label in PRECONDITIONERS.items()}}])  # fmt: skip
    return report.finish()


def users(report: Report, given: argparse.Namespace) -> int:
    """The preconditioners on the user's mesh, to which an interaction layer is added."""
    bare = tautline.read(given.mesh)
    rows = {}
    for elements in _HORIZONS:
        for p in (1.0, 2.5):
            delta, row = unstructured(bare, elements, p, given.threads)
            rows[p, elements, f"{delta:.3g}"] = row
    shown(report, "mesh", str(given.mesh), ["p", "elements in delta", "delta"], rows)
    condition_findings(report, "4.6", "on this mesh", rows)
    return report.finish()


def shown(report: Report, file: str, title: str, headings: list[str], rows: dict[tuple, Row]) -> None:
    """A table of iterations, with the condition numbers in brackets; separate columns in the CSV file."""
    names = list(PRECONDITIONERS)
    report.csv(file, [*headings, *(f"{name} {what}" for name in names for what in ("iterations", "condition"))],
               [[*key, *(value for name in names for value in row[name])] for key, row in rows.items()])
    report.texts(title, [[*key, *(f"{row[name].iterations} ({row[name].condition:.3g})" for name in names)]
                         for key, row in rows.items()], [*headings, *PRECONDITIONERS.values()], file)  # fmt: skip


def ranges(rows: dict[tuple, Row], name: str, varied: int) -> list[tuple[int, int]]:
    """The fewest and most iterations along one part of the keys, for all others; empty if it does not vary."""
    groups: dict[tuple, list[int]] = {}
    for key, row in rows.items():
        groups.setdefault((*key[:varied], *key[varied + 1 :]), []).append(row[name].iterations)
    return [(max(min(values), 1), max(values)) for values in groups.values() if len(values) > 1]


def bounded(report: Report, source: str, where: str, rows: dict[tuple, Row], varied: int) -> None:
    """States for each of the new preconditioners whether its iterations are bounded along one part of the keys."""
    found = {name: ranges(rows, name, varied) for name in PRECONDITIONERS}
    # For each, the range with the largest growth.
    largest = {name: max(pairs, key=lambda pair: pair[1] / pair[0]) for name, pairs in found.items() if pairs}
    for name in NEW:
        report.finding(source, f"{PRECONDITIONERS[name]}: iterations are bounded in {where}",
                       all_of(most <= max((1 + BOUNDED) * least, least + MORE) for least, most in found[name]),
                       ", ".join(f"{PRECONDITIONERS[n]} {least} to {most}" for n, (least, most) in largest.items()),
                       own=True, criterion=f"they vary by at most {BOUNDED:.0%} or {MORE}")  # fmt: skip


def condition_findings(report: Report, source: str, where: str, rows: dict[tuple, Row]) -> None:
    """States for each of the new preconditioners whether the condition number is small everywhere."""
    worst = {name: max(row[name].condition for row in rows.values()) for name in PRECONDITIONERS}
    for name in NEW:
        report.finding(source, f"{PRECONDITIONERS[name]}: condition number at most {CONDITION:g} {where}",
                       worst[name] <= CONDITION, ", ".join(f"{PRECONDITIONERS[n]} {v:.3g}" for n, v in worst.items()),
                       own=True)


def table_findings(report: Report, rows: dict[tuple, Row]) -> None:
    """The cases of the tables, by basis, p, aspect ratio, 1/h, delta."""
    for varied, where in ((3, "h"), (4, "delta"), (2, "the aspect ratio")):
        bounded(report, "Tables 4.1 to 4.3", where, rows, varied)
    for name in NEW:
        less = [row[name].iterations / max(row["jacobi"].iterations, 1) for row in rows.values()]
        report.finding("Tables 4.1 to 4.3", f"{PRECONDITIONERS[name]}: fewer iterations than Jacobi in all cases",
                       max(less) < 1, f"{min(less):.2f} to {max(less):.2f} times as many", own=True)
    condition_findings(report, "Tables 4.1 to 4.3", "in all cases", rows)


def exponent_findings(report: Report, rows: dict[float, Row]) -> None:
    bounded(report, "Figure 4.19", f"p, from {min(rows):g} to {max(rows):g}", {(p,): row for p, row in rows.items()}, 0)


def horizon_findings(report: Report, rows: dict[tuple, Row]) -> None:
    """Horizons of a fixed number of elements, by p and 1/h."""
    bounded(report, "4.4.1", f"h with delta = {_ELEMENTS} h", rows, 1)
    orders = {p: exponent([n for q, n in rows if q == p], [r["jacobi"].iterations for (q, _), r in rows.items()
                                                           if q == p]) for p in (1.0, 2.5)}  # fmt: skip
    report.finding("4.4.1", f"Jacobi: with delta = {_ELEMENTS} h iterations grow like 1/h",
                   all_of(abs(v - _ORDER) <= _ORDER_TOLERANCE for v in orders.values()),
                   ", ".join(f"{v:.2f} with p = {p:g}" for p, v in orders.items()), own=True,
                   criterion=f"order within {_ORDER_TOLERANCE:g} of {_ORDER:g}")


def mesh_findings(report: Report, rows: dict[tuple, Row]) -> None:
    """Unstructured meshes, by domain, p and cells."""
    bounded(report, "4.6", "h on unstructured meshes", rows, 2)
    condition_findings(report, "4.6", "on unstructured meshes", rows)


def time_findings(report: Report, times: dict[str, Times]) -> None:
    for name in NEW:
        report.finding("4.6", f"{PRECONDITIONERS[name]}: assembly and solution take less time together than Jacobi's",
                       faster(times[name], times["jacobi"]),
                       ", ".join(f"{PRECONDITIONERS[n]} {t}" for n, t in times.items()), own=True,
                       reason="The assembly takes most of the time, and Jacobi needs few iterations at this size")
