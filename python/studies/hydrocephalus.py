# SPDX-License-Identifier: BSD-3-Clause
"""Untangling a deformed brain with ventricles: section 3.5.1, Table 3.7, Figure 3.11."""

from __future__ import annotations

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._common import Run
from ._meshes import cells_of, points_of, scaled, sizes_of
from ._report import Report
from ._tangled import after, untangled_after
from ._warped import better_worst, experiment, harmonic, of_points, options, warp

STEPS = (0, 1, 5, 9, 12, 20, 33)
TABLE_3_7 = {
    "si": (13, 31, 33, 33, 33, 33, 33),
    "untangle": (13, 7, 4, 6, 3, 1, 0),
    "exponential-sum": (13, 9, 1, 0, 0, 0, 0),
    "objective-product": (13, 9, 8, 6, 6, 6, 6),
    "equal-sum": (13, 9, 3, 1, 0, 0, 0),
}
ITERATIONS = 40
CELLS, INVERTED = 8166, 13
LENGTH, PIXELS = 2.0, 1000.0  # of the brain, in the domain, and in an image for segmentation
CLOSE = 50.0  # pixels, half the side of the close-up
FIRST_VENTRICLE = 2  # its boundary marker; 1 is the outline
MAX_SHIFT = 0.45  # of a length; a larger shift moves a ventricle to the outline


def close_up(report: Report, initial: vtkDataSet, warped: vtkDataSet, runs: dict[str, Run]) -> None:
    """Pictures of the domains and, at an inverted element, of the results."""
    report.meshes("domain", [("initial", initial), ("deformed", warped)], columns=2)
    start = runs["si"].kept[0]
    x, y = points_of(start)[cells_of(start)[sizes_of(start) <= 0]].mean(axis=1)[0][:2]
    window = [x - CLOSE, x + CLOSE, y - CLOSE, y + CLOSE]
    shown = [(r.method.label, r.mesh) for r in runs.values()]
    report.meshes("close_up", [("deformed", start), *shown], columns=3, window=window)


def warped_brain(small: bool) -> tuple[vtkDataSet, vtkDataSet, float]:
    """The brain, the brain deformed until it has the required number of inverted elements, and the shift this needs."""
    initial = tautline.domain("brain", 1_500 if small else CELLS)
    ventricles = (of_points(initial, "BoundaryMarker") >= FIRST_VENTRICLE) & (of_points(initial, "Fixed") != 0)
    shrunk = points_of(initial) + harmonic(initial, of_points(initial, "Displacement"))
    aside = harmonic(initial, np.outer(ventricles, (1.0, 0.0, 0.0)))
    mesh, shift = warp(initial, shrunk, aside, 5 if small else INVERTED, MAX_SHIFT)
    return initial, scaled(mesh, PIXELS / LENGTH), shift


def main(arguments: list[str]) -> int:
    given = options("hydrocephalus", __doc__, arguments)
    report = Report("hydrocephalus", "Hydrocephalus in the plane (section 3.5.1)", given.out, given.small)
    report.text(
        "The dissertation's brain comes from segmented images, which are not published. This one is the project's "
        "parametric domain `brain`: an outline with two ventricles that shrink, more in width than in height, as "
        "after treatment, and that are shifted sideways until elements are inverted."
    )
    initial, mesh, shift = warped_brain(given.small)
    motion = "shrinking the ventricles as the domain does and shifting them sideways by "
    motion += f"{shift:.3f} (the brain is {LENGTH:g} long)"
    iterations = 12 if given.small else ITERATIONS
    unit = f"the pixel of an image in which the brain is {PIXELS:g} long"
    runs = experiment(report, mesh, motion, unit, iterations, STEPS, TABLE_3_7, given)
    close_up(report, initial, mesh, runs)

    findings(report, runs, iterations)
    return report.finish()


def findings(report: Report, runs: dict[str, Run], iterations: int) -> None:
    figures = after(runs)
    ends = {n: untangled_after(r) for n, r in runs.items()}
    si = runs["si"]
    report.finding("Table 3.7", "SI alone inverts more elements and untangles none",
                   si.last("inverted") > si.first("inverted"),
                   f"start {si.first('inverted'):g}, end {si.last('inverted'):g}, most {si.values['inverted'].max():g}")
    for name, sentence in (
        ("untangle", "Untangling alone eliminates all (there after 33 iterations)"),
        ("exponential-sum", "The exponential sum eliminates all (there after 9)"),
        ("equal-sum", "The equal sum eliminates all (there after 12)"),
    ):
        report.finding("Table 3.7", sentence, ends[name] <= iterations, figures)
    report.finding("Table 3.7", "The exponential sum needs fewer iterations than untangling alone",
                   ends["exponential-sum"] < ends["untangle"], figures)
    report.finding("Table 3.7", "The exponential sum needs fewer iterations than the equal sum",
                   ends["exponential-sum"] < ends["equal-sum"], figures)
    report.finding("Table 3.7", "The objective product does not eliminate all (there 6 are left)",
                   runs["objective-product"].last("inverted") > 0, figures)
    better_worst(report, runs, "Figure 3.11")
