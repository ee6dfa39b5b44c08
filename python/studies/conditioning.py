# SPDX-License-Identifier: BSD-3-Clause
"""Condition numbers after multiobjective optimization: sections 3.5.1 to 3.5.3, Tables 3.8, 3.9 and 3.10."""

from __future__ import annotations

import argparse
import math
from typing import Sequence

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._common import TYPICAL_C, Run, failures, improve, measure, methods
from ._memory import remembered
from ._meshes import cells_of, points_of, sizes_of, with_points
from ._pairs import start_mesh
from ._report import MESQUITE_PATCH_ITERATIONS, Report, parser, percent
from ._solver_tables import TABLE_3_8, TABLE_3_9, TABLE_3_10
from ._tangled import DIVERGED, tangled_methods, untangle
from ._verdicts import COUNT_TOLERANCE, GAIN_RULE, Open, Verdict, all_of, close, gain, less
from ._warped import of_points
from .bore import CELLS as BORE_CELLS
from .bore import warped_bore
from .hydrocephalus import CELLS as BRAIN_CELLS
from .hydrocephalus import warped_brain
from .shape_size import GOALS

DISK_CELLS, SMALL_DISK_CELLS = 500_000, 4_000
DISK_SWEEPS = 20
UNTANGLING_ITERATIONS = 40
SMALL_ITERATIONS = 8
COLUMNS = ("largest", "smallest", "condition", "iterations")
EXPECTED_ERROR = 1e-3  # relative, of the eigenvalues shown
#: The relative error of each column: both eigenvalues' of the condition number; a count of iterations has one of 1.
ERRORS = (EXPECTED_ERROR, EXPECTED_ERROR, 2 * EXPECTED_ERROR)
WORDS = ("largest eigenvalue", "smallest eigenvalue", "condition number", "number of iterations")
LARGEST, SMALLEST, CONDITION, COUNT = range(4)
SMALLER = 0.19  # the condition number of the exponential sum in the brain, as the text has it
BOTH, MULTI = ("exponential-sum", "equal-sum"), ("exponential-sum", "objective-product", "equal-sum")
#: Volumes of the flattened element over its volume before, and its number of vertices that are not on the boundary.
FLAT_VOLUMES, FLAT_FREE = (1.0, 1e-2, 1e-3, 1e-4, 1e-5), 3
FLAT_CELLS = 3_000
FLAT_CLOSE = 0.01  # tolerances of the limit of the eigenvalue and of the growth of the condition number
FLAT_PROOF = (
    "where an element degenerates, its term s g g' with s to infinity is all that is left of the rows of its free "
    "vertices, and g g' scaled by its diagonal has as its largest eigenvalue the number of these vertices"
)
#: The first zero of the Bessel function J0, squared: the smallest eigenvalue of -laplace u on the unit disk.
DISK_EIGENVALUE = 5.783186
#: The diagonal of the stiffness matrix of equilateral triangles, six times the cotangent of 60 degrees.
EQUILATERAL_DIAGONAL = 2 * np.sqrt(3.0)
PRINTED_SMALLEST = 3.97e-5  # the smallest eigenvalue in Table 3.10, with shape alone
DISK_TOLERANCE = 0.1  # of the formula for the smallest eigenvalue
FLAT_ELEMENT = (
    "A largest eigenvalue of 2.999 with every method, and one of P^-1 A near 1e-5, are what one nearly flat element "
    "with three free vertices gives (table flat_element), which no method repaired there; our mesh without such an "
    "element has condition numbers near 100"
)


@remembered
def spectrum(mesh: vtkDataSet, threads: int) -> list[float]:
    """Extreme eigenvalues, condition number and iterations of MINRES of the Poisson matrix with Jacobi."""
    if np.any(sizes_of(mesh) <= 0):
        return [np.nan] * len(COLUMNS)
    found = tautline.condition(mesh, pde="poisson", preconditioner="jacobi", tolerance=EXPECTED_ERROR, shares=False,
                               threads=threads)
    solved = tautline.solve(mesh, pde="poisson", source=1.0, solver="minres", preconditioner="jacobi",
                            threads=threads)
    row = found.spectrum[-1]
    return [row["largest"], row["smallest"], found.preconditioned_condition, float(solved.iterations)]


def compare(report: Report, file: str, title: str, meshes: dict[str, tuple[str, vtkDataSet]], theirs: dict,
            threads: int) -> dict[str, list[float]]:
    """Write the table of a section; returns its rows by method."""
    found = {name: spectrum(mesh, threads) for name, (_, mesh) in meshes.items()}
    label = {name: text for name, (text, _) in meshes.items()}
    known = {label[n]: [np.nan if v is None else v for v in theirs[n]] for n in meshes if n in theirs}
    report.beside(file, f"{title}; '-': no valid solution because of inverted elements", COLUMNS,
                  {label[n]: row for n, row in found.items()}, known)
    return found


def below(found: dict[str, list[float]], one: str, other: str, column: int) -> Verdict:
    """Whether a method has a smaller number in a column than another one, outside the error of the numbers."""
    a, b = found[one][column], found[other][column]
    if not (np.isfinite(a) and np.isfinite(b)):
        return Open(f"no valid solution with {one if not np.isfinite(a) else other}")
    return less(a, b, 1.0 / max(a, b, 1.0) if column == COUNT else ERRORS[column])


def least(report: Report, source: str, sentence: str, found: dict[str, list[float]], names: Sequence[str],
          others: Sequence[str], column: int = CONDITION, theirs: dict | None = None) -> None:
    """A finding: each of the methods `names` has a smaller number in a column than each of the others."""
    verdicts = [below(found, n, other, column) for n in names for other in others if n != other]
    error = "by more than 1" if column == COUNT else f"by more than the error of {ERRORS[column]:g}"
    printed = ", ".join(f"{n} {theirs[n][column]:,}" for n in dict.fromkeys((*names, *others))) if theirs else ""
    report.finding(source, sentence, all_of(verdicts), ", ".join(f"{n} {row[column]:.6g}" for n, row in found.items()),
                   criterion=f"a smaller {WORDS[column]}, {error}", stated=printed)


def invalid(report: Report, source: str, name: str, label: str, inverted: dict[str, float]) -> None:
    """A finding: a method leaves inverted elements; their number is NaN where its run failed but did not diverge."""
    count = inverted[name]
    report.finding(source, f"{label} leaves inverted elements: no valid solution",
                   Open(f"{name} failed") if np.isnan(count) else count > 0, f"{count:g} inverted elements",
                   criterion="at least one inverted element after the last iteration")


def as_printed(report: Report, source: str, found: dict[str, list[float]], theirs: dict, reason: str = "") -> None:
    """A finding: condition numbers are the printed ones."""
    names = [n for n, row in theirs.items() if row[CONDITION] is not None]
    report.finding(source, "The condition numbers are about the printed ones",
                   all_of(close(found[n][CONDITION], theirs[n][CONDITION], COUNT_TOLERANCE) for n in names),
                   ", ".join(f"{n} {found[n][CONDITION]:.6g}" for n in names),
                   criterion=f"each within {COUNT_TOLERANCE:.0%} of the printed one",
                   stated=", ".join(f"{n} {theirs[n][CONDITION]:,}" for n in names), reason=reason)


def untangled(report: Report, mesh: vtkDataSet, given: argparse.Namespace) -> tuple[
        dict[str, tuple[str, vtkDataSet]], dict[str, float]]:
    """Labels and meshes by method, and the inverted elements of each."""
    iterations = SMALL_ITERATIONS if given.small else UNTANGLING_ITERATIONS
    runs = {m.name: untangle(mesh, m, iterations, ("si_worst",), patch_iterations=MESQUITE_PATCH_ITERATIONS,
                             threads=given.threads) for m in tangled_methods("si", "untangle_beta")}
    if failures(runs):
        report.text(failures(runs))
    return {n: (r.method.label, r.mesh) for n, r in runs.items()}, {n: left(r) for n, r in runs.items()}


def left(run: Run) -> float:
    """The inverted elements at the end; NaN where the optimizer failed."""
    return float(run.values["inverted"][-1]) if not run.failure or run.failure.startswith(DIVERGED) else np.nan


def described(name: str, mesh: vtkDataSet, stated: str, kappa: float, printed: float) -> list:
    """The row of a mesh in the table "our mesh, theirs"."""
    quality = measure(mesh, ("si_mean", "si_worst", "imr_mean", "imr_worst"))
    return [name, mesh.GetNumberOfCells(), stated, mesh.GetNumberOfPoints(), *list(quality.values())[:-1], kappa,
            printed, kappa / printed]


def warped(report: Report, given: argparse.Namespace) -> list[list]:
    """Tables 3.8 and 3.9; returns the rows of both meshes in the table "our mesh, theirs"."""
    _, mesh, _ = warped_brain(given.small)
    meshes, inverted = untangled(report, mesh, given)
    found = compare(report, "table_3_8", "Table 3.8, hydrocephalus", meshes, TABLE_3_8, given.threads)
    brain_findings(report, found, inverted)
    rows = [described("brain", meshes[BOTH[0]][1], f"{BRAIN_CELLS:,}", found[BOTH[0]][CONDITION],
                      TABLE_3_8[BOTH[0]][CONDITION])]
    mesh, _ = warped_bore(given.small)
    meshes, inverted = untangled(report, mesh, given)
    sus = tautline.untangle(mesh, method="simultaneous", threads=given.threads)
    meshes["sus"] = ("Simultaneous untangling and smoothing", sus.mesh)
    found = compare(report, "table_3_9", "Table 3.9, bore", meshes, TABLE_3_9, given.threads)
    bore_findings(report, found, inverted)
    flat_findings(report, flat_element(report, given.threads))
    return [*rows, described("bore", meshes[BOTH[0]][1], f"{BORE_CELLS:,}", found[BOTH[0]][CONDITION],
                             TABLE_3_9[BOTH[0]][CONDITION])]


def brain_findings(report: Report, found: dict[str, list[float]], inverted: dict[str, float]) -> None:
    """The findings on Table 3.8, by method."""
    least(report, "Table 3.8", "Exponential and equal sum have a smaller condition number than untangling alone", found,
          BOTH, ["untangle"], CONDITION, TABLE_3_8)
    least(report, "3.5.1", "Exponential and equal sum have a smaller largest eigenvalue than untangling alone", found,
          BOTH, ["untangle"], LARGEST, TABLE_3_8)
    least(report, "Table 3.8", "Exponential and equal sum need fewer iterations than untangling alone", found, BOTH,
          ["untangle"], COUNT, TABLE_3_8)
    part = 1 - found["exponential-sum"][CONDITION] / (found["untangle"][CONDITION] or math.nan)
    report.finding("3.5.1", "The exponential sum has a 19 % smaller condition number than untangling alone",
                   gain(part, SMALLER), percent(part), stated=f"{percent(SMALLER)}; 905 against 1,079 are 16.1 %",
                   criterion=GAIN_RULE)
    invalid(report, "Table 3.8", "si", "SI alone", inverted)
    invalid(report, "Table 3.8", "objective-product", "The objective product", inverted)
    as_printed(report, "Table 3.8", found, TABLE_3_8)


def bore_findings(report: Report, found: dict[str, list[float]], inverted: dict[str, float]) -> None:
    """The findings on Table 3.9, by method."""
    invalid(report, "Table 3.9", "si", "SI alone", inverted)
    least(report, "Table 3.9", "The multiobjective methods need fewer iterations than untangling alone", found,
          MULTI, ["untangle"], COUNT, TABLE_3_9)
    least(report, "3.5.2", "The multiobjective methods need fewer iterations than simultaneous untangling and "
          "smoothing", found, MULTI, ["sus"], COUNT, TABLE_3_9)
    least(report, "3.5.2", "Exponential and equal sum outperform the other methods", found, BOTH,
          ["untangle", "objective-product", "sus"], COUNT, TABLE_3_9)
    least(report, "Table 3.9", "Exponential sum, product, equal sum and untangling have smaller condition numbers than "
          "simultaneous untangling and smoothing", found, (*MULTI, "untangle"), ["sus"], CONDITION, TABLE_3_9)
    as_printed(report, "Table 3.9", found, TABLE_3_9, FLAT_ELEMENT)


@remembered
def flattened(volumes: Sequence[float]) -> list[vtkDataSet]:
    """The bore of 3,000 elements, one of them flattened by one of its vertices, to parts of its volume.

    It has three vertices that are not on the boundary, and is the one whose flattening shrinks others least.
    """
    mesh = tautline.domain("bore", FLAT_CELLS)
    points, cells, sizes = points_of(mesh), cells_of(mesh), sizes_of(mesh)
    fixed = of_points(mesh, "Fixed") != 0
    best, chosen = -np.inf, (0, 0)
    for element in np.flatnonzero((~fixed[cells]).sum(axis=1) == FLAT_FREE):
        for vertex in cells[element][~fixed[cells[element]]]:
            near = (cells == vertex).any(axis=1)
            near[element] = False
            moved = with_points(mesh, _lowered(points, cells[element], vertex, volumes[-1]))
            shrunk = float((sizes_of(moved)[near] / sizes[near]).min())
            best, chosen = max((best, chosen), (shrunk, (int(element), int(vertex))))
    element, vertex = chosen
    return [with_points(mesh, _lowered(points, cells[element], vertex, volume)) for volume in volumes]


def _lowered(points: np.ndarray, corners: np.ndarray, vertex: int, part: float) -> np.ndarray:
    """Points with the height of a vertex above the opposite face of a tetrahedron reduced to a part."""
    a, b, c = points[corners[corners != vertex]]
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal)
    moved = points.copy()
    moved[vertex] -= (1.0 - part) * ((points[vertex] - a) @ normal) * normal
    return moved


def flat_element(report: Report, threads: int) -> dict[float, list[float]]:
    """The effect of one flat element on the spectrum: by its volume over its volume before."""
    found = {volume: spectrum(mesh, threads) for volume, mesh in zip(FLAT_VOLUMES, flattened(FLAT_VOLUMES))}
    report.table("flat_element", f"The bore of about {FLAT_CELLS:,} elements, one with three free vertices flattened",
                 ["volume", *COLUMNS], [[volume, *row] for volume, row in found.items()])
    return found


def flat_findings(report: Report, found: dict[float, list[float]]) -> None:
    """The apparent cause of Table 3.9: one flat element."""
    *_, before, last = (found[volume] for volume in FLAT_VOLUMES)
    growth = FLAT_VOLUMES[-2] / FLAT_VOLUMES[-1]
    report.finding("Table 3.9", "One nearly flat element with three free vertices gives a largest eigenvalue of 3, and "
                   "a condition number that grows as its volume shrinks",
                   all_of((close(last[LARGEST], FLAT_FREE, FLAT_CLOSE),
                           close(last[CONDITION] / before[CONDITION], growth, 10 * FLAT_CLOSE))),
                   ", ".join(f"volume {v:g}: {row[LARGEST]:.4g}, {row[CONDITION]:.6g}" for v, row in found.items()),
                   criterion=f"the largest eigenvalue within {FLAT_CLOSE:.0%} of 3, and ten times the condition number "
                   f"(within {10 * FLAT_CLOSE:.0%}) with a tenth of the volume, at the smallest volumes",
                   stated="2.999 with all methods", own=True, proof=FLAT_PROOF)


def sized(report: Report, given: argparse.Namespace) -> list[list]:
    """Table 3.10; returns the row of its mesh in the table "our mesh, theirs"."""
    cells = given.cells or (SMALL_DISK_CELLS if given.small else DISK_CELLS)
    mesh = start_mesh(GOALS, "disk2d", cells)
    runs = [improve(mesh, m, DISK_SWEEPS, ("imr_mean",), c=TYPICAL_C, patch_iterations=MESQUITE_PATCH_ITERATIONS,
                    trace=False, threads=given.threads) for m in methods("imr", "size", names=("Shape", "Size"))]
    meshes = {"start": ("start", mesh), **{r.method.name: (r.method.label, r.mesh) for r in runs if not r.failure}}
    title = f"Table 3.10, disk, {mesh.GetNumberOfCells():,} triangles"
    found = compare(report, "table_3_10", title, meshes, TABLE_3_10, given.threads)
    disk_findings(report, found)
    vertex_findings(report, mesh.GetNumberOfPoints(), found["imr"][SMALLEST])
    return [described("disk", meshes[BOTH[0]][1], "500,000", found[BOTH[0]][CONDITION], TABLE_3_10[BOTH[0]][CONDITION])]


def disk_findings(report: Report, found: dict[str, list[float]]) -> None:
    """The findings on Table 3.10, by method."""
    others = [n for n in TABLE_3_10 if n != "exponential-sum"]
    least(report, "Table 3.10", "The exponential sum has the smallest condition number", found, ["exponential-sum"],
          others, CONDITION, TABLE_3_10)
    least(report, "3.5.3", "The exponential sum has the smallest largest eigenvalue", found, ["exponential-sum"],
          others, LARGEST, TABLE_3_10)
    rest = [n for n in TABLE_3_10 if n != "size"]
    least(report, "Table 3.10", "Size alone has the largest condition number", found, rest, ["size"], CONDITION,
          TABLE_3_10)
    least(report, "3.5.3", "Size alone shows the slowest convergence", found, rest, ["size"], COUNT, TABLE_3_10)
    as_printed(report, "Table 3.10", found, TABLE_3_10,
               "the printed smallest eigenvalues match a disk with about "
               f"{disk_vertices(PRINTED_SMALLEST):,.0f} vertices, "
               f"{2 * disk_vertices(PRINTED_SMALLEST):,.0f} triangles, "
               "not 500,000; the condition number grows with the number of vertices")


def disk_vertices(smallest: float) -> float:
    """The vertices of a disk of nearly equilateral triangles whose preconditioned matrix has a smallest eigenvalue.

    x'Ax / x'Dx, with D = 2 sqrt(3) and the same area per vertex, has the disk's eigenvalue as its minimum.
    """
    return float(DISK_EIGENVALUE * np.pi / EQUILATERAL_DIAGONAL / smallest)


def vertex_findings(report: Report, vertices: int, smallest: float) -> None:
    """The size of the mesh of Table 3.10, by its smallest eigenvalue."""
    expected = disk_vertices(smallest)
    report.finding("Table 3.10", "The smallest eigenvalue determines the number of vertices of the disk",
                   close(expected, vertices, DISK_TOLERANCE),
                   f"{expected:,.0f} vertices by the eigenvalue, {vertices:,} in the mesh",
                   criterion=f"the formula is right within {DISK_TOLERANCE:.0%}",
                   stated=f"3.970e-05, which is {disk_vertices(PRINTED_SMALLEST):,.0f} vertices", own=True,
                   proof="the smallest eigenvalue of P^-1 A times the number of vertices tends to a constant of the "
                   "domain")


def main(arguments: list[str]) -> int:
    given = parser("conditioning", __doc__, DISK_CELLS).parse_args(arguments)
    report = Report("conditioning", "Condition numbers after multiobjective optimization (section 3.5)", given)
    report.text(
        "Poisson's equation with f = 1 and u = 0 on the boundary, solved by MINRES with Jacobi's preconditioner as in "
        "sections 1 and 3.5: P is the diagonal of A; eigenvalues of P^-1 A to a relative error of "
        f"{EXPECTED_ERROR:g}; iterations to a relative preconditioned residual of 1e-5. The meshes come from the "
        "studies hydrocephalus, bore and shape_size after the last iteration of local conjugate gradients."
    )
    rows = [*warped(report, given), *sized(report, given)]
    report.table("meshes", "Our meshes, theirs: after the exponential sum",
                 ["mesh", "elements", "elements dissertation", "vertices", "mean SI", "worst SI", "mean IMR",
                  "worst IMR", "condition", "condition dissertation", "ratio"], rows)
    return report.finish()
