# SPDX-License-Identifier: BSD-3-Clause
"""Shape, size and untangling simultaneously: section 3.4.4, Table 3.6, Figure 3.10."""

from __future__ import annotations

from ._common import MULTI, TYPICAL_C, Run, compare, measure
from ._meshes import scaled
from ._report import Report, parser
from ._tangled import NOTE, UNITS, after, by_unit, counts, diverged, tangled_methods, untangle, untangled_after
from .shape_untangling import CELLS_3D, INVERTED_3D, tangled

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
    given = parser("shape_size_untangling", __doc__, CELLS_3D, steps=True).parse_args(arguments)
    report = Report("shape_size_untangling", "Shape, size and untangling (section 3.4.4)", given.out, given.small)
    cells = given.cells or (3_000 if given.small else CELLS_3D)
    mesh = tangled("disk3d", cells, INVERTED_3D if cells == CELLS_3D else INVERTED_3D / CELLS_3D)
    mesh = scaled(mesh, (SIZE_RMS / measure(mesh, ["size_rms"])["size_rms"]) ** (1.0 / 3.0))
    report.text(
        f"disk3d: {mesh.GetNumberOfCells():,} elements. {NOTE}\n"
        f"Local Polak-Ribiere conjugate gradients, {given.patch_iterations} steps per vertex and iteration; c = "
        f"{TYPICAL_C:g}; unit of length: the size (rms) is {SIZE_RMS:g} at the start, about as in Figure 3.10 (b); "
        "the untangling metric is then rescaled as in section 3.3.3. Averages are over the valid elements."
    )
    every = tangled_methods(*OBJECTIVES)
    options = dict(patch_iterations=given.patch_iterations, threads=given.threads)
    runs = {m.name: untangle(mesh, m, ITERATIONS[-1], QUANTITIES, **options) for m in every}
    alike = dict(optimizer="newton", threads=given.threads)
    newton = {m.name: untangle(mesh, m, ITERATIONS[-1], QUANTITIES, **alike) for m in every}
    for file, found in (("table_3_6", runs), ("table_3_6_newton", newton)):
        theirs = {r.method.label: TABLE_3_6[name] for name, r in found.items()}
        report.beside(
            file, f"Inverted elements by iterations, {file}", ITERATIONS, counts(found, ITERATIONS), theirs,
        )
    by_unit(report, mesh, OBJECTIVES, ITERATIONS[-1], UNITS[::2] if given.small else UNITS, **options)
    if diverged(runs):
        report.text(diverged(runs))
    rows = [["start", *(runs["si"].first(q) for q in QUANTITIES), 0.0]]
    rows += [[r.method.label, *(r.last(q) for q in QUANTITIES), r.last_second()] for r in runs.values()]
    report.table("quality", f"Quality after {ITERATIONS[-1]} iterations", ["method", *QUANTITIES, "CPU s"], rows)
    report.curves("curves", [*runs.values(), *newton.values()])
    report.plot("average", list(runs.values()), [
        ("si_mean", "Average element quality, shape (SI)", False),
        ("size_rms", "Average element quality, size (rms)", False),
    ])

    findings(report, runs)
    return report.finish()


def findings(report: Report, runs: dict[str, Run]) -> None:
    when = after(runs)
    untangling = ("untangle", *MULTI)
    report.finding("Table 3.6", "The multiobjective methods and untangling alone eliminate all inverted elements",
                   all(runs[n].last("inverted") == 0 for n in untangling), when)
    report.finding("Table 3.6", "SI alone and size alone do not",
                   all(runs[n].last("inverted") > 0 for n in ("si", "size")), when)
    first = untangled_after(runs["exponential-sum"])
    report.finding("Table 3.6", "The exponential sum eliminates them in the fewest iterations (or as few as any)",
                   first <= min(untangled_after(r) for r in runs.values()), when)

    def improves(name: str) -> bool:
        run = runs[name]
        return run.last("si_mean") > run.first("si_mean") and run.last("size_rms") < run.first("size_rms")

    both = [n for n in runs if improves(n) and runs[n].last("inverted") == 0]
    figures = f"improved and untangled by {', '.join(both) or 'none'}; "
    figures += f"{compare(runs, 'si_mean')}; {compare(runs, 'size_rms')}"
    report.finding("Figure 3.10", "Exponential and equal sum improve shape and size while they untangle",
                   {"exponential-sum", "equal-sum"} <= set(both), figures)
    report.finding("Figure 3.10", "No other method does", set(both) <= {"exponential-sum", "equal-sum"},
                   f"by {', '.join(both) or 'none'}")
    report.finding("3.4.4", "Size alone improves shape and size but leaves inverted elements",
                   improves("size") and runs["size"].last("inverted") > 0,
                   f"size alone: inverted {runs['size'].last('inverted'):g}, average SI "
                   f"{runs['size'].first('si_mean'):.4g} to {runs['size'].last('si_mean'):.4g}, size "
                   f"{runs['size'].first('size_rms'):.4g} to {runs['size'].last('size_rms'):.4g}")
