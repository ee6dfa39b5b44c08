# SPDX-License-Identifier: BSD-3-Clause
"""Shared by the studies of nonlocal models: the dissertation's numbers, its meshes, tables and charts."""

from __future__ import annotations

import argparse
import math
from typing import Any, NamedTuple, Sequence

import numpy as np

import tautline
from . import _meshes, _report
from ._memory import remembered
from ._verdicts import Verdict, all_of, less

#: Tables 4.1 to 4.3 as printed: (aspect ratio, n = 1 / h, delta) and the condition numbers.
_KEYS = [(ar, n, delta) for ar in (1, 4) for n in (10, 20, 40) for delta in (0.2, 0.3, 0.4)]
_PRINTED = {
    "4.1": [16.33, 8.70, 5.65, 17.47, 9.06, 5.79, 18.09, 9.10, 5.83,
            15.98, 8.00, 5.53, 17.55, 8.95, 5.70, 17.88, 8.29, 5.86],
    "4.2": [10.60, 6.12, 4.00, 13.35, 7.20, 4.70, 15.31, 7.85, 4.98,
            11.69, 7.36, 4.31, 14.43, 7.46, 4.89, 15.78, 8.17, 5.18],
    "4.3": [11.27, 7.80, 6.07, 21.04, 13.92, 10.45, 36.12, 22.76, 16.61,
            16.02, 13.24, 8.54, 29.81, 19.51, 17.01, 50.38, 31.41, 24.88],
}  # fmt: skip
TABLES = {name: dict(zip(_KEYS, values)) for name, values in _PRINTED.items()}
#: Basis and exponent of each table. (The caption of 4.3 says p = 1, its text 2.5.)
MODELS = {"4.1": ("constant", 1.0), "4.2": ("linear", 1.0), "4.3": ("linear", 2.5)}
#: Relative error of condition numbers by the exact integrals, mainly by their tolerance of 1e-5; judged by the study
#: peridynamics_tables. Numbers that differ by less are not compared.
ERROR = 1e-3
#: A relative change of the condition number up to which it is not affected: the text calls printed ratios of 0.92 to
#: 1.11 (Table 4.1) a stable level.
LITTLE = 0.1
#: A power law holds where fitted exponents are within this of its exponent.
EXPONENT_TOLERANCE = 0.1
#: c of cond <= c delta^-2 is close to 1 in this range.
CLOSE_TO_ONE = (0.5, 1.0)


class Spectrum(NamedTuple):
    """Condition number (nan: not positive definite, or the mesh does not fit), and the relative asymmetry."""

    condition: float
    asymmetry: float


def square(n: int, aspect_ratio: float, delta: float, extra: int = 0, aligned: bool = True):
    """The unit square of right triangles with an interaction layer, its regions, and the points with a given solution.

    aligned: the sides of the square are grid lines and the interaction layer has whole layers of cells; otherwise the
        grid starts at -delta, which the numbers of the dissertation's tables imply.
    extra: layers of cells that are added.

    None if the aspect ratio does not fit.
    """
    steps = (math.sqrt(aspect_ratio) / n, 1 / (n * math.sqrt(aspect_ratio)))
    axes = []
    for step in steps:
        cells, inner = (1 + 2 * delta) / step, 1 / step
        if not aligned and abs(cells - round(cells)) < 1e-6:
            first, count = -delta - extra * step, round(cells) + 2 * extra
        elif aligned and abs(inner - round(inner)) < 1e-6:
            layers = math.ceil(delta / step - 1e-9) + extra
            first, count = -layers * step, round(inner) + 2 * layers
        else:
            return None
        axes.append(first + step * np.arange(count + 1))
    points, cells = _meshes.right_triangles(*axes)
    inside = lambda p: ((p > 1e-9) & (p < 1 - 1e-9)).all(axis=1)  # noqa: E731
    region = np.where(inside(points[cells].mean(axis=1)), 1, 2)
    return tautline.from_arrays(points, {"triangle": cells}), region, np.where(inside(points), 0.0, 1.0)


def solve(
    n: int, aspect_ratio: float, delta: float, basis: str, p: float, discretization: str, threads: int = 0,
    aligned: bool = True, **more: Any,
):  # fmt: skip
    """The result of peridynamics() on the square, or None if the aspect ratio does not fit."""
    # The exact discretization needs a wide enough layer, which the grid of one entry of the tables does not have.
    off = not aligned and discretization == "exact" and (aspect_ratio, n, delta) == (4, 10, 0.3)
    made = square(n, aspect_ratio, delta, 1 if off else 0, aligned)
    if made is None:
        return None
    mesh, region, given = made
    return tautline.peridynamics(
        mesh, delta, p, basis, discretization=discretization, region=region, given_points=given, allow_thin_layer=True,
        threads=threads, **more,
    )  # fmt: skip


@remembered
def spectrum(*arguments: Any, **options: Any) -> Spectrum:
    """The spectrum of the matrix of solve()."""
    result = solve(*arguments, **options)
    return Spectrum(math.nan, math.nan) if result is None else Spectrum(result.condition, result.asymmetry)


def condition(*arguments: Any, **options: Any) -> float:
    """The condition number; nan where the matrix is indefinite or the mesh does not fit."""
    return spectrum(*arguments, **options).condition


def resolved(n: int, aspect_ratio: float, delta: float) -> bool:
    """Whether the horizon is larger than the mesh size, as section 4.5 assumes: the longer leg of the triangles."""
    return math.sqrt(aspect_ratio) / n < delta


def increasing(values: Sequence[float]) -> Verdict:
    """Whether each condition number is larger than the one before it."""
    return all_of(less(a, b, ERROR) for a, b in zip(values, values[1:]))


def change(values: Sequence[float]) -> float:
    """The largest relative difference of condition numbers from the first one."""
    return max(abs(v / values[0] - 1) for v in values)


class Report(_report.Report):
    """A report with charts of several curves."""

    def texts(self, title: str, rows: Sequence[Sequence[Any]], headings: Sequence[str],
              file: str = "") -> None:
        """A table in the report alone; numbers are texts already."""
        self.aligned(title, headings, [[str(value) for value in row] for row in rows], file)

    def chart(self, file: str, panels: Sequence[dict[str, Any]]) -> None:
        """Panels side by side: dicts of title, x, y (labels), lines {label: (x, y[, style])}, scales."""
        if not self._pictures():
            return
        figure, axes_of = _report.pyplot.subplots(
            1, len(panels), figsize=(5.2 * len(panels), 4.2), squeeze=False)  # fmt: skip
        for axes, panel in zip(axes_of[0], panels):
            colors: dict[str, str] = {}  # one for both discretizations
            for label, (x, y, *style) in panel["lines"].items():
                color = colors.setdefault(label.split(", dissertation")[0], f"C{len(colors) % 10}")
                own = {} if style and style[0].startswith("C") else {"color": color}
                axes.plot(x, y, *(style or ["o-"]), label=label, markersize=4, **own)
            axes.set_title(panel["title"])
            axes.set_xlabel(panel["x"])
            axes.set_ylabel(panel.get("y", "condition number"))
            axes.set_xscale(panel.get("xscale", "linear"))
            axes.set_yscale(panel.get("yscale", "linear"))
            axes.grid(True, which="major", alpha=0.3)
            axes.legend(fontsize=8)
        self.save(figure, file)


def parse(name: str, text: str, arguments: Sequence[str]) -> argparse.Namespace:
    """The options every study has; by default all cores are used."""
    return _report.parser(name, text, threads=0).parse_args(arguments)


def exponent(x: Sequence[float], y: Sequence[float]) -> float:
    """The slope of log y over log x by least squares."""
    x, y = np.asarray(x, float), np.asarray(y, float)
    good = np.isfinite(y) & (y > 0)
    return float(np.polyfit(np.log(x[good]), np.log(y[good]), 1)[0]) if good.sum() > 1 else math.nan
