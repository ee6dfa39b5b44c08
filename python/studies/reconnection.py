# SPDX-License-Identifier: BSD-3-Clause
"""The cost of slivers for a solver, the gain by Improve Mesh, and its results on the domains."""

from __future__ import annotations

from typing import Callable

import numpy as np
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkDataSet, vtkPolyData
from vtkmodules.vtkFiltersSources import vtkSphereSource

import tautline

from ._memory import remembered
from ._report import Report, parser
from ._verdicts import Verdict, all_of, less

CELLS, SMALL_CELLS = 40_000, 3_000
PERTURBED = 0.97  # of the distance to inversion: nearly flat elements
EXPECTED_ERROR = 1e-3  # relative, of the eigenvalues
CONDITION_ERROR = 2 * EXPECTED_ERROR  # of their ratio
COLUMNS = ("elements", "smallest angle", "worst imr", "condition", "preconditioned", "iterations")
ANGLE, CONDITION, PRECONDITIONED, ITERATIONS = 1, 3, 4, 5
#: Label and the operation on the mesh with slivers.
STEPS: dict[str, Callable[[vtkDataSet, int], vtkDataSet]] = {
    "with slivers": lambda mesh, threads: mesh,
    "best shape (points move)": lambda mesh, threads: tautline.optimize(mesh, threads=threads).mesh,
    "remove slivers": lambda mesh, threads: tautline.improve(mesh, "remove slivers", threads=threads).mesh,
    "aggressive": lambda mesh, threads: tautline.improve(mesh, "aggressive", threads=threads).mesh,
}
#: The domains of the condition numbers, and of the comparison with Delaunay refinement.
DOMAINS = ("disk3d", "wrench")
PLANAR = ("plate", "wrench", "hinge")
#: Domains of tetrahedra, the targets in degrees with the boundary fixed and sliding, and the angle that a sliding one
#: reaches.
SOLIDS = ("disk3d", "barrier3d", "bore", "sphere", "box-in-box")
TARGETS = {"fixed": 33.4, "sliding": 38.8}
REACHED = 36.0
#: A sphere meshed without the quality option of TetGen.
BALL_POINTS, BALL_VOLUME = 24, 1e-3
#: A square plate with a round hole, meshed with a larger smallest angle than the domains.
SIDE, RADIUS, AROUND, PLATE_ANGLE = 2.0, 0.4, 64, 33.0
Rows = dict[str, list[float]]


@remembered
def figures(mesh: vtkDataSet, threads: int) -> list[float]:
    """The numbers of COLUMNS: of Poisson's matrix, and with Jacobi's preconditioner; iterations of CG; nan: failed."""
    measured = tautline.improve(mesh, "custom", swap=False, smooth=False, contract=False, insert=False, compound=False,
                                threads=threads)
    found = tautline.condition(mesh, pde="poisson", preconditioner="jacobi", tolerance=EXPECTED_ERROR, shares=False,
                               threads=threads)
    solved = tautline.solve(mesh, pde="poisson", source=1.0, solver="cg", preconditioner="jacobi", threads=threads)
    condition, preconditioned = (row["condition"] if row["converged"] else np.nan for row in found.spectrum)
    return [float(measured.elements), measured.smallest_angle, measured.worst, condition, preconditioned,
            float(solved.iterations) if solved.converged else np.nan]


@remembered
def stepped(mesh: vtkDataSet, label: str, threads: int) -> vtkDataSet:
    """The numbers of the mesh with slivers after a step."""
    return STEPS[label](mesh, threads)


def domain_findings(report: Report, domain: str, rows: Rows) -> None:
    """The findings on a domain; rows: see `figures`."""

    def text(column: int) -> str:
        return ", ".join(f"{name} {row[column]:.5g}" for name, row in rows.items())

    def finding(sentence: str, holds: Verdict, column: int) -> None:
        report.finding(domain, sentence, holds, text(column), own=True,
                       criterion=f"by more than the error of both condition numbers, {CONDITION_ERROR:g} each"
                       if column in (CONDITION, PRECONDITIONED) else "")

    start, repaired, best = rows["with slivers"], rows["remove slivers"], rows["aggressive"]
    finding("Removing slivers makes the condition number of the matrix smaller",
            less(repaired[CONDITION], start[CONDITION], 2 * CONDITION_ERROR), CONDITION)
    finding("Removing slivers makes the condition number with Jacobi's preconditioner smaller",
            less(repaired[PRECONDITIONED], start[PRECONDITIONED], 2 * CONDITION_ERROR), PRECONDITIONED)
    finding("CG needs fewer iterations without slivers", less(repaired[ITERATIONS], start[ITERATIONS], 0), ITERATIONS)
    finding("The preset aggressive needs no more iterations than removing slivers",
            less(best[ITERATIONS], repaired[ITERATIONS] + 1, 0), ITERATIONS)
    finding("Moving points alone leaves a smaller smallest angle than the preset aggressive",
            less(rows["best shape (points move)"][ANGLE], best[ANGLE], 0), ANGLE)


def refinement_findings(report: Report, rows: Rows) -> None:
    """Whether the improved meshes have at least the smallest angle of Delaunay refinement; rows: its angle, the number
    of its points, our angle and points."""
    holds = all_of(ours >= theirs and points <= count for theirs, count, ours, points in rows.values())
    shown = ", ".join(f"{name} {ours:.4g} with {points:.0f} points (refinement {theirs:.4g} with {count:.0f})"
                      for name, (theirs, count, ours, points) in rows.items())
    claim = "The smallest angle is at least as large as after Delaunay refinement with as many points"
    report.finding("plane", claim, holds,
                   shown, own=True, criterion="at least its angle, with at most its number of points, on every domain")


def plate(cells: int) -> vtkDataSet:
    """Delaunay refinement of the plate."""
    turns = 2 * np.pi * np.arange(AROUND) / AROUND
    corners = 0.5 * SIDE * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]], float)
    points = np.vstack([corners, RADIUS * np.column_stack([np.cos(turns), np.sin(turns)])])
    square = np.column_stack([np.arange(4), (np.arange(4) + 1) % 4])
    hole = 4 + np.column_stack([np.arange(AROUND), (np.arange(AROUND) + 1) % AROUND])
    outline = vtkPolyData()
    xyz = vtkPoints()
    for x, y in points:
        xyz.InsertNextPoint(x, y, 0.0)
    lines = vtkCellArray()
    for edge in np.vstack([square, hole]):
        lines.InsertNextCell(2, [int(i) for i in edge])
    outline.SetPoints(xyz)
    outline.SetLines(lines)
    mesher = tautline.vtkTriangleMesher()
    mesher.SetInputData(outline)
    mesher.SetMinimumAngle(PLATE_ANGLE)
    mesher.SetSize(float(np.sqrt(4.0 * (SIDE**2 - np.pi * RADIUS**2) / cells)))
    mesher.Update()
    return mesher.GetOutput()


@remembered
def against_refinement(cells: int, threads: int) -> Rows:
    """Delaunay refinements, then the same meshes perturbed and improved with no more points."""
    rows = {}
    for name in PLANAR:
        refined = plate(cells) if name == "plate" else tautline.domain(name, cells)
        angle = tautline.improve(refined, "custom", swap=False, smooth=False, contract=False, insert=False,
                                 compound=False, threads=threads).smallest_angle
        poor = tautline.perturb(refined, PERTURBED, 100.0).mesh
        ours = tautline.improve(poor, "aggressive", boundary="sliding", largest_count=1.0, threads=threads)
        rows[name] = [angle, float(refined.GetNumberOfPoints()), ours.smallest_angle,
                      float(ours.mesh.GetNumberOfPoints())]
    return rows


def delaunay_ball() -> vtkDataSet:
    """A constrained Delaunay mesh of a sphere of facets, with slivers: only the volume of its elements is bounded."""
    sphere = vtkSphereSource()
    sphere.SetThetaResolution(BALL_POINTS)
    sphere.SetPhiResolution(BALL_POINTS)
    sphere.Update()
    mesher = tautline.vtkTetGenMesher()
    mesher.SetInputData(sphere.GetOutput())
    mesher.SetRadiusEdgeRatio(0.0)
    mesher.SetMinimumDihedralAngle(0.0)
    mesher.SetVolume(BALL_VOLUME)
    mesher.Update()
    return mesher.GetOutput()


@remembered
def reach(cells: int, threads: int) -> Rows:
    """Per mesh and boundary: elements before and after, angle and worst imr before and after, degrees of the smallest
    bound of what remains (90: nothing remains)."""
    meshes = {name: tautline.perturb(tautline.domain(name, cells), PERTURBED, 100.0).mesh for name in SOLIDS}
    meshes["ball, Delaunay"] = delaunay_ball()
    rows = {}
    for name, mesh in meshes.items():
        for boundary, target in TARGETS.items():
            found = tautline.improve(mesh, "aggressive", boundary=boundary, target_angle=target, threads=threads)
            bound = min(found.remaining["quality_bound"]) if found.remaining else 1.0
            rows[f"{name}, {boundary}"] = [float(found.elements_before), float(found.elements),
                                           found.smallest_angle_before, found.worst_before, found.smallest_angle,
                                           found.worst, float(np.degrees(np.arcsin(bound)))]
    return rows


def reach_findings(report: Report, rows: Rows) -> None:
    """Whether all are improved, and the domains reach the angle where the boundary slides; rows: see `reach`."""
    shown = ", ".join(f"{name} {row[4]:.4g} degrees, {row[5]:.4g}" for name, row in rows.items())
    sliding = [row[4] for name, row in rows.items() if name.split(", ")[0] in SOLIDS and name.endswith("sliding")]
    report.finding("solids", "Smallest angle and worst inverse mean ratio improve on all meshes",
                   all_of(row[4] > row[2] and row[5] < row[3] for row in rows.values()), shown, own=True)
    report.finding("solids", "With a sliding boundary, the smallest angle of the domains is at least "
                   f"{REACHED:g} degrees", all_of(angle >= REACHED for angle in sliding),
                   ", ".join(f"{angle:.4g}" for angle in sliding), own=True)


def main(arguments: list[str]) -> int:
    given = parser("reconnection", __doc__, CELLS).parse_args(arguments)
    report = Report("reconnection", "The cost of slivers for a solver", given)
    cells = given.cells or (SMALL_CELLS if given.small else CELLS)
    report.text(
        f"Meshes of the domains, all inner points moved at random by up to {PERTURBED:g} of their distance to "
        "inversion. Poisson's equation with f = 1 and u = 0 on the boundary; condition numbers of the matrix and with "
        f"Jacobi's preconditioner, eigenvalues to a relative error of {EXPECTED_ERROR:g}; iterations of CG with it, to "
        "a relative residual of 1e-5."
    )
    for domain in DOMAINS:
        poor = tautline.perturb(tautline.domain(domain, cells), PERTURBED, 100.0).mesh
        rows = {label: figures(stepped(poor, label, given.threads), given.threads) for label in STEPS}
        report.table(domain, domain, ["mesh", *COLUMNS], [[label, *row] for label, row in rows.items()])
        domain_findings(report, domain, rows)
    rows = against_refinement(cells, given.threads)
    report.table("refinement", "Triangles: smallest angle of Delaunay refinement and after Improve Mesh",
                 ["domain", "refinement", "points", "improved", "points improved"],
                 [[name, *row] for name, row in rows.items()])
    refinement_findings(report, rows)
    rows = reach(cells, given.threads)
    report.table("reach", "Tetrahedra: smallest angle and worst inverse mean ratio before and after",
                 ["mesh", "elements", "elements after", "angle", "imr", "angle after", "imr after", "bound"],
                 [[name, *row] for name, row in rows.items()])
    reach_findings(report, rows)
    return report.finish()
