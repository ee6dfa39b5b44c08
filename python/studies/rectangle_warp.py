# SPDX-License-Identifier: BSD-3-Clause
"""The rectangle whose top sinks: Figures 4.20 and 4.22, Propositions 1 to 4 in numbers."""

from __future__ import annotations

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._meshes import points_of, sizes_of, with_points
from ._report import Report
from ._deformed import Deformed, Moving, deform, parse, strip
from ._verdicts import COUNT_TOLERANCE, same_count

CELLS = 800
AMOUNTS = (0.2, 0.4, 0.6, 0.8, 1.0, 1.1)
THEIRS = 20  # inverted elements of FEMWARP in Figure 4.20
COARSER = 3  # times fewer elements, to see how the count depends on the mesh
EXACT = 1e-8  # tolerance of the propositions
UNEVEN = 0.1  # change of the ratios of neighboring distances from which on a spacing is not kept
POOR = 3.0  # inverse mean ratio, the end of the metric's acceptable range
SEVERAL = 3  # elements at least
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


def uneven(mesh: vtkDataSet, points: np.ndarray) -> float:
    """Largest relative change of the share that a vertical distance has in its column, by other points."""
    p = points_of(mesh)
    worst = 0.0
    for column in columns_of(p):
        before, after = np.diff(p[column, 1]), np.diff(points[column, 1])
        relative = (after / after.sum()) / (before / before.sum())
        worst = max(worst, float(np.abs(relative - 1).max()))
    return worst


def spacing(mesh: vtkDataSet, displacement: np.ndarray) -> float:
    """The change of the spacing by anisotropic FEMWARP with alpha = 0, beta = 1."""
    return uneven(mesh, vertically(mesh, displacement))


def poor_elements(mesh: vtkDataSet) -> int:
    """Valid elements with a poor inverse mean ratio."""
    found = tautline.quality(mesh, ["imr"], reversed_mesh="measure as given", threads=1)
    return int(np.count_nonzero(found.values["imr"][sizes_of(mesh) > 0] > POOR))


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
    given = parse("rectangle_warp", __doc__, arguments, repeats=1, seeds=False)
    report = Report("rectangle_warp", "A rectangle whose top sinks (Figures 4.20 and 4.22)", given)
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
            ["4", "distance from an affine motion of the whole", exact, EXACT],
        ],
    )
    kept = tuple(uneven(mesh, points_of(w.mesh)) for w in whole)
    coarse = Moving("rectangle", mesh.GetNumberOfCells() // COARSER)
    other = deform(coarse.mesh, coarse.at(1.0), "femwarp").inverted, coarse.mesh.GetNumberOfCells()
    findings(report, *whole, mesh.GetNumberOfCells(), poor_elements(whole[0].mesh), kept, other)
    proposition_findings(report, (apart, along, uniform, relative, exact))
    return report.finish()


def findings(report: Report, isotropic: Deformed, anisotropic: Deformed, cells: int, poor: int,
             kept: tuple[float, float], coarse: tuple[int, int]) -> None:
    """The findings on the figures.

    poor: valid elements after FEMWARP; kept: changes of the spacing by either; coarse: inverted elements and elements
    of a coarser mesh.
    """
    report.finding("Figure 4.20", "FEMWARP inverts elements", same_count(isotropic.inverted, THEIRS),
                   f"{isotropic.inverted} of {cells}", criterion=f"within {COUNT_TOLERANCE:.0%} of the printed count",
                   stated=str(THEIRS), reason="the count grows with the number of elements, which is not given: "
                   f"FEMWARP inverts {coarse[0]} of {coarse[1]}")
    report.finding("4.8.2", "FEMWARP leaves several valid elements with poor quality", poor >= SEVERAL, f"{poor}",
                   criterion=f"at least {SEVERAL} with an inverse mean ratio above {POOR:g}", stated="several")
    report.finding("4.8.2", "FEMWARP does not preserve the element spacing", kept[0] > UNEVEN,
                   f"the share of a distance in its column changes by up to {kept[0]:.3g}",
                   criterion=f"by more than {UNEVEN:g}")
    report.finding("Figure 4.22", "Anisotropic FEMWARP inverts no elements", anisotropic.inverted == 0,
                   f"{anisotropic.inverted}; coefficients {anisotropic.coefficients[0]:g}, "
                   f"{anisotropic.coefficients[1]:g} by (4.19)", criterion="none", stated="0")
    report.finding("Figure 4.22", "Anisotropic FEMWARP preserves the element spacing", kept[1] <= EXACT,
                   f"the share of a distance in its column changes by up to {kept[1]:.2g}",
                   criterion=f"by at most {EXACT:g}", proof="Proposition 2: each column is solved by itself")


def proposition_findings(report: Report, measured: tuple[float, float, float, float, float]) -> None:
    """measured: motion of the other columns and of their own, changes of spacing, distance to an affine motion."""
    apart, along, uniform, relative, exact = measured
    report.finding("Proposition 1", "Interior vertices follow the boundary vertices of their own column only",
                   apart <= EXACT < along, f"others move by at most {apart:.2g}, the column by up to {along:.2g}",
                   criterion=f"others by at most {EXACT:g}, the column by more",
                   proof="with alpha = 0 the matrix couples vertices with the same x only, on each structured mesh")
    report.finding("Proposition 2", "Uniform spacing stays uniform", uniform <= EXACT, f"{uniform:.2g} of a distance",
                   criterion=f"at most {EXACT:g}",
                   proof="the solution of (4.13) is linear in y for each number of rows")
    report.finding("Proposition 3", "Relative spacing of a graded mesh stays", relative <= EXACT,
                   f"{relative:.2g} of a distance", criterion=f"at most {EXACT:g}",
                   proof="the solution of (4.14) is linear in y for each number of rows")
    report.finding("Proposition 4", "Affine motions are exact for all coefficients", exact <= EXACT,
                   f"{exact:.2g} at lengths of 2; alpha, beta = " + ", ".join(f"{a}:{b}" for a, b, _ in COEFFICIENTS),
                   criterion=f"at most {EXACT:g}",
                   proof="linear functions are in the null space of the matrix of each mesh; 1:1 is FEMWARP")
