# SPDX-License-Identifier: BSD-3-Clause
"""Shape and untangling simultaneously: section 3.4.3, Tables 3.4 and 3.5, Figures 3.8 and 3.9."""

from __future__ import annotations

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._common import MULTI, QUALITY_MARGIN, TYPICAL_C, Run, judged, measure, patch_option
from ._literal import literal
from ._memory import remembered
from ._meshes import cells_of, points_of, scaled, sizes_of
from ._report import Report, parser
from ._tangled import (
    BETA, NOTE, after, better, in_settings, inverted_table, settings, sooner, tangled_methods, until_all,
    untangle, untangled_after, untangles,
)
from ._verdicts import Times, Verdict, all_of, below, less
from ._warped import of_points

# Inverted elements by iteration; the second table also has Escobar's method.
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
SMALL_CELLS, SMALL_FRACTION_2D, SMALL_FRACTION_3D = 3_000, 0.01, 0.0022
WITHIN = 3  # iterations after which the text and the tables have no inverted element
LITERAL_CELLS, SMALL_LITERAL_CELLS, LITERAL_SWEEPS = 6_000, 1_000, 3  # of the objective as it is printed; slow
MINUTE = Times((60.0,))


@remembered
def tangled(domain: str, cells: int, inverted: float, seed: int = 1) -> vtkDataSet:
    """A perturbed domain with this number (below 1: fraction) of inverted elements, in the unit of the dissertation."""
    mesh = tautline.domain(domain, cells)
    part = inverted if inverted < 1 else inverted / mesh.GetNumberOfCells()
    mesh = tautline.perturb(mesh, tangle=part, seed=seed).mesh
    sizes = sizes_of(mesh)
    largest = BETA * sizes.mean() - sizes.min()
    return scaled(mesh, (LARGEST_UNTANGLING / largest) ** (1.0 / (cells_of(mesh).shape[1] - 1)))


def table(report: Report, file: str, runs: dict[str, Run], iterations, theirs: dict, extra: dict | None = None) -> None:
    known = {name: row for name, row in theirs.items() if name != "sus"} | ({SUS: theirs["sus"]} if extra else {})
    inverted_table(report, file, f"Inverted elements by iterations, {file}", runs, iterations, known, extra)


def quality(report: Report, file: str, runs: dict[str, Run], iteration: int, extra: list | None = None) -> None:
    rows = [["start", *(next(iter(runs.values())).first(q) for q in QUANTITIES), 0.0]]
    shown = (*QUANTITIES, "seconds")
    rows += [[r.method.label, *(r.at(q, iteration) for q in shown)] for r in runs.values()]
    report.table(file, f"Quality of the valid elements after {iteration} iterations, {file}",
                 ["method", *QUANTITIES, "CPU s"], rows + (extra or []))


@remembered
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
    made = parser("shape_untangling", __doc__, steps=True, seeds=True)
    made.add_argument("--no-large", action="store_true", help=f"leave out the mesh of {LARGE:,} triangles")
    patch_option(made)
    given = made.parse_args(arguments)
    report = Report("shape_untangling", "Shape and untangling (section 3.4.3)", given)
    common = dict(patch_iterations=given.patch_iterations, patch_scalarization=given.patch_scalarization,
                  threads=given.threads)
    report.text(
        f"{NOTE}\n"
        f"Local Polak-Ribiere conjugate gradients, {given.patch_iterations} steps per vertex and iteration; c = "
        f"{TYPICAL_C:g}; unit of length: the untangling metric is at most {LARGEST_UNTANGLING} at the start.\n"
        "The text of the dissertation has 1 % of about 1,000,000 elements, its tables have 543 and 111 inverted ones, "
        "the latter on a mesh of about 50,000: the tables are computed with these numbers (543 are 1 % of 54,300), "
        "then for a mesh of 1,000,000 triangles with 1 % inverted elements.\n"
        f"{SUS}: Untangle Mesh with the method of that name (Escobar et al. 2003)."
    )
    for seed in report.seeds:
        flat, printed, varied = plane(report, given.small, seed, common)
        solid, inverted, sus = space(report, given.small, seed, common)
        findings(report, flat, solid)
        table_findings(report, flat, varied, solid, printed)
        escobar_findings(report, solid, inverted, sus)
        if seed == 1 and not given.small and not given.no_large:
            large_findings(report, large(report, common))
    return report.finish()


def plane(report: Report, small: bool, seed: int, common: dict) -> tuple[
        dict[str, Run], list[int], dict[str, dict[str, Run]]]:
    """Table 3.4 and Figure 3.8, on the barrier in the plane.

    The runs, the inverted elements of SI alone as its objective is printed, and the runs in other settings.
    """
    every = tangled_methods("si", "untangle_beta")
    start = tangled("barrier2d", SMALL_CELLS if small else CELLS_2D, SMALL_FRACTION_2D if small else INVERTED_2D, seed)
    last = ITERATIONS_3_4[-1]
    runs = {m.name: untangle(start, m, last, QUANTITIES, keep=(1, last), **common) for m in every}
    alike = {**common, "optimizer": "newton", "patch_iterations": 1}
    newton = {m.name: untangle(start, m, last, QUANTITIES, **alike) for m in every}
    table(report, "table_3_4", runs, ITERATIONS_3_4, TABLE_3_4)
    table(report, "table_3_4_newton", newton, ITERATIONS_3_4, TABLE_3_4)
    quality(report, "quality_barrier2d", runs, last)
    report.curves("curves_barrier2d", [*runs.values(), *newton.values()])
    report.meshes("meshes", [("start", start), *((r.method.label, r.mesh) for r in runs.values())], columns=3,
                  window=around_inverted(start, 8 * np.sqrt(np.abs(sizes_of(start)).mean())))
    varied = settings(report, start, ("si", "untangle_beta"), last, (), **common)
    start = tangled("barrier2d", SMALL_LITERAL_CELLS if small else LITERAL_CELLS, SMALL_FRACTION_2D, seed)
    printed = literal(start, of_points(start, "Fixed") != 0, "si", LITERAL_SWEEPS, common["patch_iterations"],
                      BETA * float(np.mean(np.abs(sizes_of(start)))), TYPICAL_C)
    report.table("literal", f"Inverted elements of SI alone with the terms of inverted elements, as it is printed, on "
                 f"{start.GetNumberOfCells():,} triangles", ["iteration", "inverted"], list(enumerate(printed)))
    return runs, printed, varied


def space(report: Report, small: bool, seed: int, common: dict) -> tuple[dict[str, Run], list[float], dict[str, float]]:
    """Table 3.5 and Figure 3.9: the runs on the disk in space, and of Escobar's method."""
    every = tangled_methods("si", "untangle_beta")
    start = tangled("disk3d", SMALL_CELLS if small else CELLS_3D, SMALL_FRACTION_3D if small else INVERTED_3D, seed)
    runs = {m.name: untangle(start, m, ITERATIONS, QUANTITIES, **common) for m in every}
    inverted, mesh = escobar(start, ITERATIONS_3_5[-1], common["threads"])
    sus = measure(mesh, QUANTITIES)
    table(report, "table_3_5", runs, ITERATIONS_3_5, TABLE_3_5, {SUS: inverted})
    quality(report, "quality_disk3d", runs, ITERATIONS, [[SUS, *(sus[q] for q in QUANTITIES), float("nan")]])
    report.curves("curves_disk3d", list(runs.values()))
    report.plot("quality", [r for n, r in runs.items() if n != "si"], [
        ("si_mean", "Average SI", False), ("si_worst", "Worst SI", True), ("inverted", "Inverted elements", False),
    ])
    return runs, inverted, sus


def large(report: Report, common: dict) -> dict[str, Run]:
    """The runs on a mesh of the number of elements that the text has."""
    mesh = tangled("barrier2d", LARGE, LARGE_FRACTION)
    runs = {m.name: untangle(mesh, m, ITERATIONS_3_4[-1], QUANTITIES, **common)
            for m in tangled_methods("si", "untangle_beta")}
    table(report, "large", runs, ITERATIONS_3_4, {})
    quality(report, "quality_large", runs, ITERATIONS_3_4[-1])
    report.curves("curves_large", list(runs.values()))
    return runs


def quick(runs: dict[str, Run]) -> Verdict:
    """Whether each multiobjective method takes less than a minute."""
    return all_of(judged(runs, [n], below(Times((runs[n].seconds[-1],)), MINUTE, 1.0)) for n in MULTI)


def findings(report: Report, flat: dict[str, Run], solid: dict[str, Run]) -> None:
    """The findings of section 3.4.3 on the methods of this project."""
    both = {"barrier2d": flat, "disk3d": solid}
    when = "; ".join(f"{name}: {after(runs)}" for name, runs in both.items())

    def finding(source: str, sentence: str, holds: Verdict, ours: str, criterion: str, stated: str = "") -> None:
        report.finding(source, sentence, holds, ours, criterion=criterion, stated=stated)

    finding("3.4.3", "All three multiobjective methods eliminate all inverted elements in the end",
            all_of(untangles(runs, MULTI) for runs in both.values()), when, "no inverted element after the last "
            "iteration on both meshes")
    finding("Figure 3.8", "The exponential sum yields the best element shapes of the methods that untangle",
            better(flat, "exponential-sum", ("untangle", *MULTI), "si_mean", QUALITY_MARGIN),
            ", ".join(f"{n} {r.last('si_mean'):.4f}" for n, r in flat.items()),
            f"its average SI is larger by more than {QUALITY_MARGIN:.0%} than each of the others'")
    finding("3.4.3", "Each multiobjective method takes less than a minute",
            all_of(quick(runs) for runs in both.values()),
            ", ".join(f"{name} {n} {r[n].last_second():.3g} s" for name, r in both.items() for n in MULTI),
            "CPU time of all iterations on meshes with the numbers of the tables", "less than a minute")


def table_findings(report: Report, flat: dict[str, Run], varied: dict[str, dict[str, Run]], solid: dict[str, Run],
                   printed: list[int]) -> None:
    """The findings on Tables 3.4 and 3.5.

    varied: the runs on the barrier in settings that the dissertation does not state; printed: inverted elements by
    iterations of SI alone, as its objective is printed.
    """
    everywhere = "in all settings of settings.csv"
    rest = ", ".join(f"{r['si'].first('inverted'):g} to {r['si'].values['inverted'][-1]:g}" for r in (flat, solid))
    report.finding("Table 3.4", "SI alone does not untangle", printed[-1] > 0,
                   f"as printed {', '.join(map(str, printed))}; without the terms of inverted elements {rest}",
                   criterion="inverted elements are left after the iterations of the objective as it is printed, with "
                   "the terms of inverted elements", stated="1,030 are left")
    report.finding("Table 3.4", "SI alone increases the number of inverted elements", printed[-1] > printed[0],
                   f"as printed {', '.join(map(str, printed))}; without the terms of inverted elements {rest}",
                   criterion="more inverted elements than at the start after the iterations of the objective as it is "
                   "printed, with the terms of inverted elements", stated="543 to 1,030")
    for name in ("untangle", *MULTI):
        label = "Untangling alone" if name == "untangle" else f"The {name.replace('-', ' ')} of SI and untangling"
        report.finding("Table 3.4", f"{label} eliminates all inverted elements within three iterations",
                       in_settings(varied, lambda r, n=name: untangles(r, [n], WITHIN)), until_all(varied, [name]),
                       criterion=f"no inverted element from iteration {WITHIN} on, {everywhere}",
                       stated=f"{TABLE_3_4[name].index(0)} iterations")
        done = ITERATIONS_3_5[TABLE_3_5[name].index(0)]
        report.finding("Table 3.5", f"{label} eliminates all inverted elements within three iterations",
                       untangles(solid, [name], WITHIN), after({name: solid[name]}),
                       criterion=f"no inverted element from iteration {WITHIN} on", stated=f"{done} iterations")
    for one, other, stated in (("exponential-sum", "untangle", "2 against 3"), ("equal-sum", "untangle", "2 against 3"),
                               ("exponential-sum", "objective-product", "2 against 3")):
        report.finding("Table 3.4", f"The {one.replace('-', ' ')} needs fewer iterations than "
                       + ("untangling alone" if other == "untangle" else "the objective product"),
                       in_settings(varied, lambda r, a=one, b=other: sooner(r, a, b)), until_all(varied, (one, other)),
                       criterion="fewer iterations until no element is inverted (equal numbers are not fewer), "
                       f"{everywhere}", stated=stated)


def escobar_findings(report: Report, solid: dict[str, Run], inverted: list[float], sus: dict[str, float]) -> None:
    """The findings of section 3.4.3 on simultaneous untangling and smoothing."""
    report.finding("Table 3.5", f"{SUS} eliminates all inverted elements in one iteration", inverted[1] == 0,
                   f"inverted by iteration: {', '.join(f'{n:g}' for n in inverted)}", stated="1 iteration")
    done = next((i for i, n in enumerate(inverted) if n == 0), len(inverted))
    report.finding("Table 3.5", f"The multiobjective methods take one iteration more than {SUS.lower()}",
                   judged(solid, MULTI, all(untangled_after(solid[n]) == done + 1 for n in MULTI)),
                   f"{SUS} {done}; {after({n: solid[n] for n in MULTI})}",
                   criterion="exactly one iteration more until no element is inverted, each", stated="2 against 1")
    for quantity, word in (("si_mean", "average"), ("si_worst", "worst")):
        report.finding("Figure 3.9", f"Exponential and equal sum have a better {word} SI than {SUS.lower()}",
                       judged(solid, ("exponential-sum", "equal-sum"), all_of(
                           less(sus[quantity], solid[n].last(quantity), QUALITY_MARGIN)
                           for n in ("exponential-sum", "equal-sum"))),
                       f"{SUS} {sus[quantity]:.4g}, " + ", ".join(f"{n} {solid[n].last(quantity):.4g}" for n in MULTI),
                       criterion=f"the {word} SI after all iterations is larger by more than "
                       f"{QUALITY_MARGIN:.0%}, both")


def large_findings(report: Report, runs: dict[str, Run]) -> None:
    """The findings on a mesh of 1,000,000 elements, the number in the text."""
    report.finding("3.4.3", f"They eliminate all inverted elements of a mesh of about {LARGE:,} elements",
                   untangles(runs, MULTI), after(runs), criterion="no inverted element after the last iteration")
    seconds = ", ".join(f"{n} {runs[n].last_second():.3g} s" for n in MULTI)
    report.finding("3.4.3", f"Each takes less than a minute on a mesh of about {LARGE:,} elements", quick(runs),
                   seconds, criterion="CPU time of all iterations", stated="less than a minute")
