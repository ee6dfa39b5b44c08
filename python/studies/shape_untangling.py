# SPDX-License-Identifier: BSD-3-Clause
"""Shape and untangling simultaneously: section 3.4.3, Tables 3.4 and 3.5, Figures 3.8 and 3.9."""

from __future__ import annotations

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._common import MULTI, TYPICAL_C, Run, measure
from ._meshes import cells_of, points_of, scaled, sizes_of
from ._report import Report, parser
from ._tangled import BETA, NOTE, after, counts, diverged, tangled_methods, untangle, untangled_after

# Inverted elements by iteration; the second table has Escobar's method too.
TABLE_3_4 = {
    "si": (543, 1019, 1030, 1030, 1030),
    "untangle": (543, 10, 1, 0, 0),
    "exponential-sum": (543, 2, 0, 0, 0),
    "objective-product": (543, 31, 2, 0, 0),
    "equal-sum": (543, 5, 0, 0, 0),
}
ITERATIONS_3_4 = (0, 1, 2, 3, 10)
TABLE_3_5 = {
    "si": (111, 1392, 1390, 1389, 1389, 1389),
    "untangle": (111, 5, 0, 0, 0, 0),
    "exponential-sum": (111, 2, 0, 0, 0, 0),
    "objective-product": (111, 2, 0, 0, 0, 0),
    "equal-sum": (111, 2, 0, 0, 0, 0),
    "sus": (111, 0, 0, 0, 0, 0),
}
ITERATIONS_3_5 = (0, 1, 2, 3, 4, 5)
ITERATIONS = 20
SUS = "Simultaneous untangling and smoothing"
LARGEST_UNTANGLING = 3.8103  # the largest value of the untangling metric at the start, which fixes the unit of length
QUANTITIES = ("si_mean", "si_worst", "imr_mean", "imr_worst")
INVERTED_2D, INVERTED_3D, CELLS_2D, CELLS_3D = 543, 111, 54_300, 50_000  # 1 % of the former are 543
LARGE, LARGE_FRACTION = 1_000_000, 0.01


def tangled(domain: str, cells: int, inverted: float) -> vtkDataSet:
    """A perturbed domain with this number (below 1: fraction) of inverted elements, in the unit of the dissertation."""
    mesh = tautline.domain(domain, cells)
    part = inverted if inverted < 1 else inverted / mesh.GetNumberOfCells()
    mesh = tautline.perturb(mesh, tangle=part).mesh
    sizes = sizes_of(mesh)
    largest = BETA * sizes.mean() - sizes.min()
    return scaled(mesh, (LARGEST_UNTANGLING / largest) ** (1.0 / (cells_of(mesh).shape[1] - 1)))


def table(report: Report, file: str, runs: dict[str, Run], iterations, theirs: dict, extra: dict | None = None) -> None:
    known = {r.method.label: theirs.get(name, ()) for name, r in runs.items()} | ({SUS: theirs["sus"]} if extra else {})
    report.beside(file, f"Inverted elements by iterations, {file}", iterations,
                  counts(runs, iterations) | (extra or {}), known)
    gone = diverged(runs)
    if gone:
        report.text(gone)


def quality(report: Report, file: str, runs: dict[str, Run], iteration: int, extra: list | None = None) -> None:
    rows = [["start", *(next(iter(runs.values())).first(q) for q in QUANTITIES), 0.0]]
    shown = (*QUANTITIES, "seconds")
    rows += [[r.method.label, *(r.at(q, iteration) for q in shown)] for r in runs.values()]
    report.table(file, f"Quality of the valid elements after {iteration} iterations, {file}",
                 ["method", *QUANTITIES, "CPU s"], rows + (extra or []))


def escobar(mesh: vtkDataSet, iterations: int, threads: int) -> tuple[list[float], vtkDataSet]:
    """Inverted elements by iteration, and the mesh, of simultaneous untangling and smoothing."""
    found = tautline.untangle(mesh, method="simultaneous", threads=threads)
    inverted = [float(n) for n in found.history["inverted"]]
    return [inverted[min(i, len(inverted) - 1)] for i in range(iterations + 1)], found.mesh


def around_inverted(mesh: vtkDataSet, side: float) -> list[float]:
    """A window on a typical inverted element: xmin xmax ymin ymax."""
    p, cells = points_of(mesh), cells_of(mesh)
    wrong = np.flatnonzero(sizes_of(mesh) <= 0)
    x, y = p[cells[wrong[len(wrong) // 2]]].mean(axis=0)[:2]
    return [x - side, x + side, y - side, y + side]


def main(arguments: list[str]) -> int:
    made = parser("shape_untangling", __doc__, steps=True)
    made.add_argument("--no-large", action="store_true", help=f"leave out the mesh of {LARGE:,} triangles")
    given = made.parse_args(arguments)
    report = Report("shape_untangling", "Shape and untangling (section 3.4.3)", given.out, given.small)
    common = dict(patch_iterations=given.patch_iterations, threads=given.threads)
    every = tangled_methods("si", "untangle_beta")
    flat = tangled("barrier2d", 3_000 if given.small else CELLS_2D, 0.01 if given.small else INVERTED_2D)
    solid = tangled("disk3d", 3_000 if given.small else CELLS_3D, 0.0022 if given.small else INVERTED_3D)
    report.text(
        f"{NOTE}\n"
        f"Local Polak-Ribiere conjugate gradients, {given.patch_iterations} steps per vertex and iteration; c = "
        f"{TYPICAL_C:g}; unit of length: the untangling metric is at most {LARGEST_UNTANGLING} at the start.\n"
        "The text of the dissertation has 1 % of about 1,000,000 elements, its tables have 543 and 111 inverted ones, "
        "the latter on a mesh of about 50,000: the tables are computed with these numbers (543 are 1 % of 54,300), "
        "then for a mesh of 1,000,000 triangles with 1 % inverted elements."
    )
    shown = (1, ITERATIONS_3_4[-1])
    runs2 = {m.name: untangle(flat, m, ITERATIONS_3_4[-1], QUANTITIES, keep=shown, **common) for m in every}
    alike = dict(optimizer="newton", threads=given.threads)
    newton = {m.name: untangle(flat, m, ITERATIONS_3_4[-1], QUANTITIES, **alike) for m in every}
    table(report, "table_3_4", runs2, ITERATIONS_3_4, TABLE_3_4)
    table(report, "table_3_4_newton", newton, ITERATIONS_3_4, TABLE_3_4)
    quality(report, "quality_barrier2d", runs2, ITERATIONS_3_4[-1])
    report.curves("curves_barrier2d", [*runs2.values(), *newton.values()])
    last = ITERATIONS_3_4[-1]
    report.meshes("meshes", [("start", flat), *((r.method.label, r.kept[last]) for r in runs2.values())], columns=3,
                  window=around_inverted(flat, 8 * np.sqrt(np.abs(sizes_of(flat)).mean())))

    runs3 = {m.name: untangle(solid, m, ITERATIONS, QUANTITIES, **common) for m in every}
    inverted, mesh = escobar(solid, ITERATIONS_3_5[-1], given.threads)
    sus = measure(mesh, QUANTITIES)
    table(report, "table_3_5", runs3, ITERATIONS_3_5, TABLE_3_5, {SUS: inverted})
    report.text(
        f"{SUS}: Untangle Mesh with the method of that name (Escobar et al. 2003)."
    )
    quality(report, "quality_disk3d", runs3, ITERATIONS, [[SUS, *(sus[q] for q in QUANTITIES), float("nan")]])
    report.curves("curves_disk3d", list(runs3.values()))
    report.plot("quality", [r for n, r in runs3.items() if n != "si"], [
        ("si_mean", "Average SI", False), ("si_worst", "Worst SI", True), ("inverted", "Inverted elements", False),
    ])
    large = {}
    if not given.small and not given.no_large:
        mesh = tangled("barrier2d", LARGE, LARGE_FRACTION)
        large = {m.name: untangle(mesh, m, ITERATIONS_3_4[-1], QUANTITIES, **common) for m in every}
        table(report, "large", large, ITERATIONS_3_4, {})
        quality(report, "quality_large", large, ITERATIONS_3_4[-1])
        report.curves("curves_large", list(large.values()))
    findings(report, runs2, runs3, large, inverted, sus)
    return report.finish()


def findings(report: Report, flat: dict[str, Run], solid: dict[str, Run], large: dict[str, Run], inverted, sus) -> None:
    both = {"barrier2d": flat, "disk3d": solid} | ({"barrier2d, 1,000,000": large} if large else {})
    when = "; ".join(f"{name}: {after(runs)}" for name, runs in both.items())
    most = {name: max(runs["si"].values["inverted"]) for name, runs in both.items()}

    def finding(source: str, sentence: str, holds: bool, figures: str) -> None:
        report.finding(source, sentence, holds, figures)

    finding("Tables 3.4, 3.5", "SI alone increases the number of inverted elements",
        all(most[n] > runs["si"].first("inverted") for n, runs in both.items()),
        ", ".join(f"{n}: start {r['si'].first('inverted'):g}, most {most[n]:g}, end {r['si'].last('inverted'):g}"
                  for n, r in both.items()))
    finding("3.4.3", "SI alone does not untangle", all(r["si"].last("inverted") > 0 for r in both.values()), when)
    finding("Tables 3.4, 3.5", "Untangling alone eliminates all inverted elements within three iterations",
        all(untangled_after(r["untangle"]) <= 3 for r in both.values()), when)
    for name in MULTI:
        label = flat[name].method.label
        finding("Tables 3.4, 3.5", f"{label} eliminates all within three iterations",
            all(untangled_after(r[name]) <= 3 for r in both.values()), when)
    finding("3.4.3", "All three multiobjective methods eliminate them in the end",
        all(r[n].last("inverted") == 0 for r in both.values() for n in MULTI), when)
    finding("Table 3.4", "Exponential and equal sum need fewer iterations than untangling alone",
        max(untangled_after(flat[n]) for n in ("exponential-sum", "equal-sum")) < untangled_after(flat["untangle"]),
        when)
    finding("3.4.3", "The exponential sum eliminates them sooner than the objective product (or as soon)",
        all(untangled_after(r["exponential-sum"]) <= untangled_after(r["objective-product"]) for r in both.values()),
        when)
    valid = [n for n, r in flat.items() if r.last("inverted") == 0]
    figures = ", ".join(f"{n} {r.last('si_mean'):.4f}" for n, r in flat.items())
    best = max(valid, key=lambda n: round(flat[n].last("si_mean"), 4)) if valid else ""
    top = flat[best].last("si_mean") if best else 0.0
    finding("Figure 3.8",
        "The exponential sum yields the best element shapes (average SI to 4 decimals) of the methods that untangle",
        "exponential-sum" in valid and round(flat["exponential-sum"].last("si_mean"), 4) >= round(top, 4), figures)
    seconds = {f"{name} {n}": runs[n].last_second() for name, runs in both.items() for n in MULTI}
    finding("3.4.3", "Each multiobjective method takes less than a minute", max(seconds.values()) < 60,
        ", ".join(f"{n} {s:.3g} s" for n, s in seconds.items()))
    finding("Table 3.5", f"{SUS} eliminates them in one iteration", inverted[1] == 0,
            f"inverted by iteration: {inverted}")
    for quantity, word in (("si_mean", "average"), ("si_worst", "worst")):
        finding("Figure 3.9", f"Exponential and equal sum have a better {word} SI than {SUS.lower()}",
            all(solid[n].last(quantity) > sus[quantity] for n in ("exponential-sum", "equal-sum")),
            f"{SUS} {sus[quantity]:.4g}, " + ", ".join(f"{n} {solid[n].last(quantity):.4g}" for n in MULTI))
