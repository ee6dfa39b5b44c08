# SPDX-License-Identifier: BSD-3-Clause
"""Drawings of constructions, for the study `figures`: Figures 1.1, 1.2, 4.1, 4.3, 4.8, 4.21 and 4.23."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._horizon import square
from ._meshes import cells_of, points_of
from ._report import Report, pyplot

_LINE, _MARK, _FILL = "#1f4e79", "#c04000", "#80b0e060"
#: Figures 1.1 and 1.2: cells of the domain, by how much of the distance to inversion vertices move, inverted elements.
_CELLS, _ROUGH, _TANGLED = 500, 0.9, 0.1
#: The mesh of Figure 4.3: 1/h and the horizon.
_SIZE, _HORIZON = 10, 0.2
#: The six neighbors of a vertex of the structured mesh; the first four are along the axes.
_NEIGHBORS = ((1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, -1))


def draw(report: Report, threads: int) -> tuple[vtkDataSet, vtkDataSet, vtkDataSet]:
    """Draw all of them; the meshes before and after the improvement of Figure 1.1, and the tangled one."""
    domain = tautline.domain("disk2d", _CELLS)
    rough = tautline.perturb(domain, _ROUGH, 100.0, seed=1, threads=threads).mesh
    smooth = tautline.optimize(rough, "imr", threads=threads).mesh
    tangled = tautline.perturb(domain, seed=1, tangle=_TANGLED, threads=threads).mesh
    report.meshes("figure_1_1", [("(a) before the improvement", rough), ("(b) after it", smooth)], columns=2)
    report.meshes("figure_1_2", [("tangled mesh", tangled)])
    if pyplot is not None:
        _horizon(report)
        _boundaries(report)
        _ratio(report)
        _element(report)
        _directions(report)
    return rough, smooth, tangled


def _plain(width: float, height: float, columns: int = 1) -> tuple[Any, Any]:
    """A figure and its panels without axes."""
    figure, axes = pyplot.subplots(1, columns, figsize=(width, height), squeeze=False)
    for axis in axes[0]:
        axis.set_axis_off()
        axis.set_aspect("equal")
    return figure, axes[0]


def _arrow(axis: Any, start: Any, end: Any, color: str = _MARK) -> None:
    axis.annotate("", xy=end, xytext=start, arrowprops={"arrowstyle": "->", "color": color})


def _horizon(report: Report) -> None:
    """Figure 4.1: a point, its horizon and the force of a bond."""
    figure, (axis,) = _plain(5.0, 4.0)
    t = np.linspace(0, 2 * np.pi, 200)
    axis.plot(2.2 * np.cos(t), 1.6 * np.sin(t) + 0.15 * np.sin(2 * t), color=_LINE)
    axis.text(-1.8, 0.9, r"$\Omega$", fontsize=14)
    v, other, radius = np.array([0.3, 0.0]), np.array([0.8, 0.45]), 0.9
    axis.fill(v[0] + radius * np.cos(t), v[1] + radius * np.sin(t), facecolor=_FILL, edgecolor=_LINE, linestyle="--")
    axis.plot(*np.array([v, other]).T, "o", color=_LINE)
    _arrow(axis, v, other)
    _arrow(axis, v, v + radius * np.array([math.cos(3.6), math.sin(3.6)]), _LINE)
    for place, text in (((0.25, -0.2), "v"), ((0.85, 0.45), "v'"), ((0.45, 0.3), "f"), ((-0.15, -0.1), r"$\delta$"),
                        ((0.9, -0.6), "H")):  # fmt: skip
        axis.text(*place, text, fontsize=12)
    report.save(figure, "figure_4_1")


def _boundaries(report: Report) -> None:
    """Figure 4.3: where the solution is given, for the local and the nonlocal model."""
    figure, axes = _plain(9.0, 4.6, 2)
    mesh, region, given = square(_SIZE, 1, _HORIZON)
    p, cells = points_of(mesh)[:, :2], cells_of(mesh)
    inside = cells[region == 1]
    axes[0].triplot(*p.T, inside, color=_LINE, linewidth=0.6)
    axes[0].plot(*p[np.intersect1d(np.unique(inside), np.flatnonzero(given))].T, "o", color=_MARK, markersize=4)
    axes[0].set_title("(a) classical: given at boundary points")
    axes[1].triplot(*p.T, inside, color=_LINE, linewidth=0.6)
    axes[1].tripcolor(*p.T, cells[region == 2], facecolors=np.ones(np.sum(region == 2)), cmap="Oranges", vmin=0, vmax=3,
                      edgecolors=_MARK, linewidth=0.4)
    axes[1].set_title(rf"(b) nonlocal: given in a layer of width $\delta$ = {_HORIZON}")
    report.save(figure, "figure_4_3")


def _ratio(report: Report) -> None:
    """Figure 4.8: the aspect ratio of a right triangle."""
    figure, (axis,) = _plain(5.6, 2.4)
    axis.plot([0, 4, 0, 0], [0, 0, 1, 0], color=_LINE)
    axis.text(2, -0.25, "W", ha="center")
    axis.text(-0.2, 0.5, "w", va="center")
    axis.set(xlim=(-0.5, 4.3), ylim=(-0.4, 1.2), title="aspect ratio W / w")
    report.save(figure, "figure_4_8")


def _element(report: Report) -> None:
    """Figure 4.21: a triangle of the structured mesh."""
    figure, (axis,) = _plain(4.2, 3.4)
    axis.plot([0, 1.4, 0, 0], [0, 0, 1, 0], color=_LINE)
    for place, text in (((0, -0.12), r"$A = (ih, jk)$"), ((1.4, -0.12), r"$B = ((i+1)h, jk)$"),
                        ((0, 1.06), r"$(ih, (j+1)k)$"), ((0.7, 0.04), "h"), ((0.06, 0.5), "k"),
                        ((0.4, 0.3), r"$T_{ij}$")):  # fmt: skip
        axis.text(*place, text, ha="center")
    axis.set(xlim=(-0.5, 2.1), ylim=(-0.3, 1.3))
    report.save(figure, "figure_4_21")


def _directions(report: Report) -> None:
    """Figure 4.23: the neighbors that count, by the direction of the motion."""
    figure, axes = _plain(10.5, 3.8, 3)
    angle = math.radians(30)
    for axis, title, motion, used in zip(
            axes, (r"(a) $\alpha = 1, \beta = 0$", r"(b) $\alpha = 0, \beta = 1$", r"(c) $\alpha = a, \beta = b$"),
            ((1, 0), (0, 1), (math.cos(angle), math.sin(angle))), ((0, 1), (2, 3), (0, 1, 2, 3))):  # fmt: skip
        for k, (x, y) in enumerate(_NEIGHBORS):
            axis.plot([0, x], [0, y], color=_LINE, linewidth=0.8)
            axis.plot(x, y, "o", color=_LINE)
            if k < 4 and k not in used:
                axis.plot(0.5 * x, 0.5 * y, "x", color=_MARK, markersize=12)
        if len(used) == 4:
            axis.text(0.5, -0.15, "a")
            axis.text(-0.18, 0.5, "b")
        axis.plot(0, 0, "o", color=_MARK)
        _arrow(axis, (0, 0), tuple(0.8 * c for c in motion))
        axis.set(xlim=(-1.3, 1.3), ylim=(-1.3, 1.3), title=title)
    report.save(figure, "figure_4_23")
