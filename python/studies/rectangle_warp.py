# SPDX-License-Identifier: BSD-3-Clause
"""The rectangle whose top sinks: Figures 4.20 and 4.22, Propositions 1 to 4 in numbers."""

from __future__ import annotations

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

from ._meshes import points_of, with_points
from ._report import Report
from ._deformed import Deformed, Moving, deform, parse, strip
from ._verdicts import same_count

CELLS = 800
AMOUNTS = (0.2, 0.4, 0.6, 0.8, 1.0, 1.1)
THEIRS = 20  # inverted elements of FEMWARP in Figure 4.20
#: Within which our count is that of the figure, from which the mesh is taken.
COUNT_TOLERANCE = 0.1
EXACT = 1e-8  # tolerance of the propositions
GRADING = 1.5  # a grid line at height y moves to y^1.5
COEFFICIENTS = ((1, 1, 1), (0, 1, 1), (1, 0, 1), (6, 1, 1), (1, 4, 1))  # the last does not matter in the plane


def columns_of(points: np.ndarray) -> list[np.ndarray]:
    """The points of each vertical grid line, from the bottom to the top."""
    _, line = np.unique(np.round(points[:, 0], 9), return_inverse=True)
    order = np.lexsort((points[:, 1], line))
    return np.split(order, np.flatnonzero(np.diff(line[order])) + 1)


def vertically(mesh: vtkDataSet, displacement: np.ndarray) -> np.ndarray:
    """The points after anisotropic FEMWARP with alpha = 0, beta = 1."""
    return points_of(deform(mesh, displacement, "anisotropic", coefficients=(0, 1, 1)).mesh)


def one_column(mesh: vtkDataSet) -> tuple[float, float]:
    """Largest displacements of the other columns and of its own column where one vertex of the top sinks."""
    p = points_of(mesh)
    columns = columns_of(p)
    mine = columns[len(columns) // 3]
    displacement = np.zeros_like(p)
    displacement[mine[-1], 1] = -0.5
    moved = np.linalg.norm(vertically(mesh, displacement) - p, axis=1)
    others = np.setdiff1d(np.arange(len(p)), mine)
    return float(moved[others].max()), float(moved[mine[:-1]].max())


def spacing(mesh: vtkDataSet, displacement: np.ndarray) -> float:
    """Largest relative change of the ratios of neighboring vertical distances."""
    p = points_of(mesh)
    q = vertically(mesh, displacement)
    worst = 0.0
    for column in columns_of(p):
        before, after = np.diff(p[column, 1]), np.diff(q[column, 1])
        relative = (after / after.sum()) / (before / before.sum())
        worst = max(worst, float(np.abs(relative - 1).max()))
    return worst


def graded(mesh: vtkDataSet) -> vtkDataSet:
    p = points_of(mesh)
    p[:, 1] **= GRADING
    return with_points(mesh, p)


def affine(mesh: vtkDataSet) -> float:
    """Largest deviation of interior vertices from an affine motion of the boundary, over all coefficients."""
    p = points_of(mesh)
    slope = np.array([[0.4, -0.3, 0.0], [0.7, 0.2, 0.0], [0.0, 0.0, 0.0]])
    motion = p @ slope + [3.0, -2.0, 0.0]
    worst = 0.0
    for coefficients in COEFFICIENTS:
        found = deform(mesh, motion, "anisotropic", coefficients=coefficients).mesh
        worst = max(worst, float(np.abs(points_of(found) - p - motion).max()))
    return worst


def main(arguments: list[str]) -> int:
    given = parse("rectangle_warp", __doc__, arguments, repeats=1)
    report = Report("rectangle_warp", "A rectangle whose top sinks (Figures 4.20 and 4.22)", given.out, given.small)
    rectangle = Moving("rectangle", 200 if given.small else CELLS)
    mesh, displacement = rectangle.mesh, rectangle.at(1.0)
    report.text(
        f"A structured mesh of {mesh.GetNumberOfCells()} triangles; the top sinks by 0.85 of the height in the middle, "
        "times the amount. The dissertation's mesh and motion are taken from its figure."
    )
    rows, curves = [], {"FEMWARP": [], "anisotropic FEMWARP": []}
    for amount in AMOUNTS:
        isotropic, anisotropic = (deform(mesh, amount * displacement, m) for m in ("femwarp", "anisotropic"))
        rows.append([amount, isotropic.inverted, anisotropic.inverted, isotropic.worst, anisotropic.worst])
        curves["FEMWARP"].append(isotropic.inverted)
        curves["anisotropic FEMWARP"].append(anisotropic.inverted)
        if amount == 1.0:
            whole = isotropic, anisotropic
    report.table("inverted", "Inverted elements and worst TMP shape (4.22)",
                 ["amount", "FEMWARP", "anisotropic", "worst FEMWARP", "worst anisotropic"], rows)
    report.lines("inverted", [("Inverted elements", "amount of the motion", "inverted",
                               {label: (AMOUNTS, values) for label, values in curves.items()})])
    hybrid = deform(mesh, displacement, "hybrid")
    strip(report, "strip", [[("before", mesh), ("FEMWARP", whole[0])],
                            [("anisotropic FEMWARP", whole[1]), ("hybrid", hybrid)]], [None, None])

    apart, along = one_column(mesh)
    uniform, relative = (spacing(m, displacement) for m in (mesh, graded(mesh)))
    exact = affine(mesh)
    report.table(
        "propositions", "Propositions 1 to 4, alpha = 0 and beta = 1 (4: several coefficients)",
        ["proposition", "what is measured", "largest", "to be at most"],
        [
            ["1", "motion outside the column whose top vertex moved (there 0.5)", apart, EXACT],
            ["2", "change of the relative spacing, uniform columns", uniform, EXACT],
            ["3", "change of the relative spacing, graded columns", relative, EXACT],
            ["4", "distance from an affine motion of the whole", exact, 1e-10],
        ],
    )
    findings(report, *whole, mesh.GetNumberOfCells(), (apart, along, uniform, relative, exact))
    return report.finish()


def findings(report: Report, isotropic: Deformed, anisotropic: Deformed, cells: int,
             measured: tuple[float, float, float, float, float]) -> None:
    """The findings. measured: motion of the other columns and of their own, changes of spacing, distance to affine."""
    apart, along, uniform, relative, exact = measured
    report.finding("Figure 4.20", f"FEMWARP inverts {THEIRS} elements (within {COUNT_TOLERANCE:.0%})",
                   same_count(isotropic.inverted, THEIRS, COUNT_TOLERANCE),
                   f"{isotropic.inverted} of {cells}")
    report.finding("Figure 4.22", "Anisotropic FEMWARP inverts none (there 0)", anisotropic.inverted == 0,
                   f"{anisotropic.inverted}; coefficients {anisotropic.coefficients[0]:g}, "
                   f"{anisotropic.coefficients[1]:g} by (4.19)")
    report.finding("Proposition 1", "Interior vertices follow the boundary vertices of their own column only",
                   apart <= EXACT < along,
                   f"others move by at most {apart:.2g}, the column by up to {along:.2g}", any_size=True)
    report.finding("Proposition 2", "Uniform spacing stays uniform", uniform <= EXACT,
                   f"{uniform:.2g} of a distance", any_size=True)
    report.finding("Proposition 3", "Relative spacing of a graded mesh stays", relative <= EXACT,
                   f"{relative:.2g} of a distance", any_size=True)
    report.finding("Proposition 4", "Affine motions are exact for all coefficients", exact <= 1e-10,
                   f"{exact:.2g} at lengths of 2; alpha, beta = " + ", ".join(f"{a}:{b}" for a, b, _ in COEFFICIENTS),
                   any_size=True)
