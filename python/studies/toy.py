# SPDX-License-Identifier: BSD-3-Clause
"""Untangling a structured mesh with one vertex out of place: section 3.3.3, Figure 3.2."""

from __future__ import annotations

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid

import tautline

from ._common import MULTI, Run
from ._meshes import points_of
from ._report import MESQUITE_PATCH_ITERATIONS, Report, parser
from ._tangled import NOTE, tangled_methods, untangle

SQUARES = 6  # along each side of the mesh
SHIFT = 1.3  # of the vertex in the middle along its row, in edges: past the next vertex
EDGE = 1.0  # not known from the figure, which has no axes
CONVERGED = 100  # iterations
UNITS = (0.1, 1.0, 10.0, 20.0, 100.0)
QUANTITIES = ("si_mean", "si_worst", "imr_mean", "imr_worst", "size_rms")


def structured(edge: float, shift: float) -> vtkUnstructuredGrid:
    """The square in triangles, its middle vertex moved along the row."""
    row = SQUARES + 1
    y, x = np.divmod(np.arange(row * row), row)
    points = edge * np.column_stack([x, y, np.zeros(row * row)]).astype(float)
    points[(SQUARES // 2) * (row + 1), 0] += shift * edge
    lower = np.array([i + row * j for j in range(SQUARES) for i in range(SQUARES)])
    below = np.column_stack([lower, lower + 1, lower + row + 1])
    above = np.column_stack([lower, lower + row + 1, lower + row])
    return tautline.from_arrays(points, {"triangle": np.vstack([below, above])})


def runs_of(edge: float, iterations: int, patch_iterations: int, c: float, threads: int) -> dict[str, Run]:
    every = tangled_methods("si", "untangle_beta")
    return {
        m.name: untangle(structured(edge, SHIFT), m, iterations, QUANTITIES, keep=(1,), c=c,
                         patch_iterations=patch_iterations, threads=threads)
        for m in every
    }


def main(arguments: list[str]) -> int:
    given = parser("toy", __doc__, 0).parse_args(arguments)
    report = Report("toy", "Toy example (section 3.3.3, Figure 3.2)", given.out, given.small)
    initial, tangled = structured(EDGE, 0.0), structured(EDGE, SHIFT)
    runs = runs_of(EDGE, 20 if given.small else CONVERGED, MESQUITE_PATCH_ITERATIONS, 0.0, given.threads)
    report.text(
        f"{tangled.GetNumberOfCells()} triangles; the vertex in the middle is moved {SHIFT:g} edges along its row, "
        f"which inverts two. {NOTE}\n"
        f"Local Polak-Ribiere conjugate gradients, {MESQUITE_PATCH_ITERATIONS} steps per vertex and iteration; edges "
        f"of length {EDGE:g}; c of the exponential sum is chosen from the initial values (the typical 1e4 to 1e6 are "
        "far above these objectives, which makes the exponential sum the equal sum)."
    )
    rows = [
        [r.method.label, *(r.at(q, k) for q in ("inverted", "si_mean", "si_worst") for k in (0, 1, CONVERGED))]
        for r in runs.values()
    ]
    headings = [f"{q} {k}" for q in ("inverted", "mean SI", "worst SI") for k in ("start", "after 1", "end")]
    report.table("toy", "Inverted elements and SI (0.1443 is best) of the valid ones", ["method", *headings], rows)
    report.curves("curves", list(runs.values()))
    report.meshes("meshes", [
        ("one vertex perturbed", tangled),
        *((f"{runs[n].method.label}\nafter one iteration", runs[n].kept[1]) for n in ("untangle", *MULTI)),
        ("structured mesh", initial),
        *((f"{runs[n].method.label}\nconverged", runs[n].mesh) for n in ("untangle", *MULTI)),
    ], columns=5)

    table = []
    for edge in (UNITS[0], UNITS[-1]) if given.small else UNITS:
        for steps in (1, MESQUITE_PATCH_ITERATIONS):
            for c, name in ((0.0, "chosen"), (1e6, "1e6")):
                found = runs_of(edge, 1, steps, c, given.threads)
                table.append([edge, steps, name, *(int(found[n].last("inverted")) for n in ("si", "untangle", *MULTI))])
    report.table("sensitivity", "Inverted elements after one iteration, by unit of length, steps per vertex and c",
                 ["edge", "steps", "c", "si", "untangle", *MULTI], table)

    apart = np.linalg.norm(points_of(runs["exponential-sum"].mesh) - points_of(runs["equal-sum"].mesh), axis=1).max()
    findings(report, runs, [row[3:] for row in table], float(apart) / EDGE)
    return report.finish()


def findings(report: Report, runs: dict[str, Run], left: list[list[int]], apart: float) -> None:
    """The findings on Figure 3.2.

    left: by setting, the inverted elements after one iteration of each method; apart: the largest distance of a vertex
    in the converged meshes of exponential and equal sum, in edges.
    """
    one = {n: int(runs[n].at("inverted", 1)) for n in MULTI}
    source = "Figure 3.2 (c) to (e)"
    for name, sentence, expected in (
        ("exponential-sum", "One iteration of the exponential sum removes the inverted elements", True),
        ("objective-product", "One iteration of the objective product does not remove them", False),
        ("equal-sum", "One iteration of the equal sum does not remove them", False),
    ):
        removed = sum(row[2 + MULTI.index(name)] == 0 for row in left)
        report.finding(source, sentence, (one[name] == 0) == expected,
                       f"{one[name]} left; it removes them in {removed} of the {len(left)} settings of "
                       "sensitivity.csv", any_size=True)
    end = {n: int(runs[n].last("inverted")) for n in MULTI}
    source = "Figure 3.2 (f) to (h)"
    report.finding(source, "At convergence, all three have removed them", not any(end.values()),
                   ", ".join(f"{n} {k}" for n, k in end.items()))
    worst = {n: runs[n].last("si_worst") for n in MULTI}
    report.finding(source, "Converged, exponential and equal sum have better elements than the objective product",
                   min(worst["exponential-sum"], worst["equal-sum"]) > worst["objective-product"],
                   "worst SI: " + ", ".join(f"{n} {q:.4g}" for n, q in worst.items()))
    report.finding(source,
                   "The converged meshes of exponential and equal sum are nearly the same (within 5 % of an edge)",
                   apart < 0.05, f"largest distance of a vertex: {apart:.4f} edges")
