# SPDX-License-Identifier: BSD-3-Clause
"""Shape, size and untangling simultaneously: section 3.4.4, Table 3.6, Figure 3.10."""

from __future__ import annotations

import argparse

from vtkmodules.vtkCommonDataModel import vtkDataSet

from ._common import MULTI, QUALITY_MARGIN, TYPICAL_C, Run, compare, judged, measure, patch_option
from ._meshes import scaled
from ._report import Report, parser
from ._tangled import (
    BETAS, NOTE, after, fails, in_settings, inverted_table, settings, sooner, tangled_methods, until_all, untangle,
    untangles,
)
from ._verdicts import Verdict, all_of, any_of, is_not, less
from .shape_untangling import CELLS_3D, INVERTED_3D, SMALL_CELLS, tangled

ITERATIONS = (0, 1, 2, 5, 10)
TABLE_3_6 = {
    "si": (111, 1392, 1390, 1389, 1326),
    "size": (111, 12, 6, 5, 8),
    "untangle": (111, 5, 0, 0, 0),
    "exponential-sum": (111, 0, 0, 0, 0),
    "objective-product": (111, 1, 1, 0, 0),
    "equal-sum": (111, 1, 0, 0, 0),
}
OBJECTIVES = ("si", "size", "untangle_beta")
SIZE_RMS = 2.7e-3  # the start of Figure 3.10 (b)
QUANTITIES = ("si_mean", "size_rms", "si_worst", "imr_mean")


def main(arguments: list[str]) -> int:
    made = parser("shape_size_untangling", __doc__, CELLS_3D, steps=True, seeds=True)
    patch_option(made)
    given = made.parse_args(arguments)
    report = Report("shape_size_untangling", "Shape, size and untangling (section 3.4.4)", given)
    cells = given.cells or (SMALL_CELLS if given.small else CELLS_3D)
    for seed in report.seeds:
        mesh = tangled("disk3d", cells, INVERTED_3D if cells == CELLS_3D else INVERTED_3D / CELLS_3D, seed)
        mesh = scaled(mesh, (SIZE_RMS / measure(mesh, ["size_rms"])["size_rms"]) ** (1.0 / 3.0))
        report.text(
            f"disk3d: {mesh.GetNumberOfCells():,} elements. {NOTE}\n"
            f"Local Polak-Ribiere conjugate gradients, {given.patch_iterations} steps per vertex and iteration; c = "
            f"{TYPICAL_C:g}; unit of length: the size (rms) is {SIZE_RMS:g} at the start, about as in Figure 3.10 (b); "
            "the untangling metric is then rescaled as in section 3.3.3. Averages are over the valid elements."
        )
        runs = experiment(report, mesh, given)
        varied = settings(report, mesh, OBJECTIVES, ITERATIONS[-1], (), BETAS, patch_iterations=given.patch_iterations,
                          threads=given.threads)
        findings(report, runs, varied)
    return report.finish()


def experiment(report: Report, mesh: vtkDataSet, given: argparse.Namespace) -> dict[str, Run]:
    """Run every method, write tables and pictures."""
    every = tangled_methods(*OBJECTIVES)
    options = dict(patch_iterations=given.patch_iterations, patch_scalarization=given.patch_scalarization,
                   threads=given.threads)
    runs = {m.name: untangle(mesh, m, ITERATIONS[-1], QUANTITIES, **options) for m in every}
    alike = {**options, "optimizer": "newton", "patch_iterations": 1}
    newton = {m.name: untangle(mesh, m, ITERATIONS[-1], QUANTITIES, **alike) for m in every}
    for file, found in (("table_3_6", runs), ("table_3_6_newton", newton)):
        inverted_table(report, file, f"Inverted elements by iterations, {file}", found, ITERATIONS, TABLE_3_6)
    rows = [["start", *(runs["si"].first(q) for q in QUANTITIES), 0.0]]
    rows += [[r.method.label, *(r.last(q) for q in QUANTITIES), r.last_second()] for r in runs.values()]
    report.table("quality", f"Quality after {ITERATIONS[-1]} iterations", ["method", *QUANTITIES, "CPU s"], rows)
    report.curves("curves", [*runs.values(), *newton.values()])
    report.plot("average", list(runs.values()), [
        ("si_mean", "Average element quality, shape (SI)", False),
        ("size_rms", "Average element quality, size (rms)", False),
    ])
    return runs


def improves(runs: dict[str, Run], name: str) -> Verdict:
    """Whether a method improves average shape and size, by more than the margin of qualities."""
    run = runs[name]
    return judged(runs, [name], all_of((
        less(run.first("si_mean"), run.last("si_mean"), QUALITY_MARGIN),
        less(run.last("size_rms"), run.first("size_rms"), QUALITY_MARGIN))))


def improves_all(runs: dict[str, Run], name: str) -> Verdict:
    """Whether a method improves average shape and size, and leaves no inverted element."""
    if fails(runs, [name]) is True:
        return False
    return all_of((untangles(runs, [name]), improves(runs, name)))


def findings(report: Report, runs: dict[str, Run], varied: dict[str, dict[str, Run]]) -> None:
    """The findings of section 3.4.4; varied: the runs in settings that the dissertation does not state."""
    when = after(runs)

    def finding(source: str, sentence: str, holds: Verdict, ours: str, criterion: str, stated: str = "") -> None:
        report.finding(source, sentence, holds, ours, criterion=criterion, stated=stated)

    for name in ("untangle", *MULTI):
        label = "Untangling alone" if name == "untangle" else f"The {name.replace('-', ' ')}"
        finding("Table 3.6", f"{label} eliminates all inverted elements",
                in_settings(varied, lambda r, n=name: untangles(r, [n])), until_all(varied, [name]),
                "no inverted element after the last iteration, in all settings of settings.csv",
                f"after {ITERATIONS[TABLE_3_6[name].index(0)]} iterations")
    for name, left in (("si", "1,326"), ("size", "8")):
        label = "SI" if name == "si" else name
        finding("Table 3.6", f"{label} alone does not eliminate all inverted elements", fails(runs, [name]), when,
                "inverted elements are left after the last iteration, or it diverges", f"{left} are left")
    others = [n for n in ("untangle", *MULTI) if n != "exponential-sum"]
    finding("Table 3.6", "The exponential sum eliminates all inverted elements with fewer iterations",
            in_settings(varied, lambda r: all_of(sooner(r, "exponential-sum", n) for n in others)),
            until_all(varied, ("exponential-sum", *others)),
            "fewer iterations until no element is inverted than untangling alone and each other multiobjective method, "
            "in all settings of settings.csv; equal numbers are not fewer", "1 against 2, 5 and 2")
    compared = f"{compare(runs, 'si_mean')}; {compare(runs, 'size_rms')}; {when}"
    better = f"average SI larger, rms of the size smaller by more than {QUALITY_MARGIN:.0%}"
    finding("Figure 3.10", "Exponential and equal sum improve shape and size while they untangle",
            all_of(improves_all(runs, n) for n in ("exponential-sum", "equal-sum")), compared,
            f"{better}, and no inverted element, at the end")
    rest = [n for n in runs if n not in ("exponential-sum", "equal-sum")]
    finding("Figure 3.10", "No other method improves shape and size while it untangles",
            is_not(any_of(improves_all(runs, n) for n in rest)), compared,
            f"of none of the others: {better}, and no inverted element, at the end")
    finding("3.4.4", "Size alone improves shape and size but leaves inverted elements",
            all_of((improves(runs, "size"), fails(runs, ["size"]))),
            f"size alone: inverted {runs['size'].last('inverted'):g}, average SI "
            f"{runs['size'].first('si_mean'):.4g} to {runs['size'].last('si_mean'):.4g}, size "
            f"{runs['size'].first('size_rms'):.4g} to {runs['size'].last('size_rms'):.4g}",
            f"{better}, and inverted elements are left at the end")
