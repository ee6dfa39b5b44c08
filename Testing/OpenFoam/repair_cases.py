#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""repair_cases.py CASES --work FOLDER [--table FILE] [NAME...]: meshes that fail checkMesh, repaired.

The meshes are of make_cases.py: those that fail by themselves and that points can repair, and others whose internal
points are moved at random by a part of the shortest edge that ends in each. `Optimize Mesh`, preset *Finite volumes*,
moves the points, first with a fixed boundary; if a check still fails, with one that slides on its flat parts. checkMesh
judges. A boundary is in place if its points are no farther from where it was than SURFACE of the diagonal. --table
writes a Markdown table. The exit code is 1 if fewer than LEAST meshes of all pass with the boundary in place.
"""

import argparse
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import tautline
from compare_cases import verdict
from solve_case import ENVIRONMENT, boundary, read_faces
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkImplicitPolyDataDistance, vtkTriangleFilter

#: Cases, and how far their internal points are moved, in lengths of the shortest edge at a point; 0: as they are.
MESHES = {
    "IO_fileHandler": 0.0,
    "incompressible_pimpleFoam_RAS_rotatingFanInRoom": 0.0,
    "incompressible_pimpleFoam_RAS_wingMotion_wingMotion2D_pimpleFoam": 0.0,
    "mesh_snappyHexMesh_opposite_walls": 0.0,
    "synthetic_dual_moved_70": 0.0,
    "synthetic_hexes_moved_60": 0.0,
    "synthetic_hexes_moved_100": 0.0,
    "synthetic_hexes_moved_300": 0.0,
    "synthetic_periodic_moved": 0.0,
    "synthetic_tetrahedra_moved_35": 0.0,
    "synthetic_tetrahedra_moved_70": 0.0,
    "synthetic_dual_of_hexes": 1.2,
    "incompressible_icoFoam_cavity_cavityGrade": 1.0,
    "incompressible_icoFoam_cavity_cavityClipped": 1.5,
    "basic_potentialFoam_pitzDaily": 0.8,
    "stressAnalysis_solidDisplacementFoam_plateHole": 1.0,
    "multiphase_interIsoFoam_damBreak": 1.0,
    "multiphase_interIsoFoam_damBreakWithObstacle": 0.8,
    "compressible_rhoPimpleFoam_RAS_TJunction": 0.9,
    "compressible_rhoPimpleFoam_RAS_mixerVessel2D": 0.7,
    "compressible_rhoPimpleFoam_RAS_annularThermalMixer": 0.6,
    "incompressible_SRFSimpleFoam_mixer": 0.7,
    "incompressible_pimpleFoam_LES_channel395": 0.8,
    "lagrangian_reactingParcelFoam_cylinder": 0.8,
    "basic_overPotentialFoam_cylinder_cylinderMesh": 0.8,
    "mesh_snappyHexMesh_flange": 0.6,
    "heatTransfer_buoyantBoussinesqSimpleFoam_iglooWithFridges": 0.7,
    "incompressible_pisoFoam_LES_motorBike_motorBike": 0.6,
    "multiphase_interFoam_RAS_motorBike": 0.5,
    "combustion_XiDyMFoam_annularCombustorTurbine": 0.0,
}
LEAST = 24
SURFACE = 1e-3  # of the diagonal
SECONDS = 300  # for one repair
DIGITS = 10  # of coordinates in which the two sides of a layer agree


@dataclass
class Repair:
    """The results for a mesh."""

    name: str
    cells: int
    failed_before: int
    failed: int
    non_orthogonality: tuple[float, float]
    skewness: tuple[float, float]
    slides: bool
    surface: float
    seconds: float


def perturb(case: Path, points: np.ndarray, amplitude: float) -> np.ndarray:
    """Internal points moved; in one layer within its plane, in the same way on both sides. The same each time."""
    mesh = case / "constant/polyMesh"
    faces = read_faces(mesh)
    held = boundary(mesh, faces, empty=False)
    sides = boundary(mesh, faces, empty=True)
    inside = np.ones(len(points), bool)
    inside[np.concatenate(held)] = False
    axis = None
    if sides:
        normals = np.array([np.abs(np.cross(points[face[1]] - points[face[0]], points[face[2]] - points[face[0]]))
                            for face in sides])  # fmt: skip
        axis = int(normals.sum(axis=0).argmax())
    shortest = np.full(len(points), np.inf)
    for face in faces:
        edges = points[np.roll(face, -1)] - points[face]
        if axis is not None:
            edges[:, axis] = 0
        lengths = np.linalg.norm(edges, axis=1)
        lengths[lengths == 0] = np.inf
        np.minimum.at(shortest, face, lengths)
        np.minimum.at(shortest, np.roll(face, -1), lengths)
    columns = [c for c in range(3) if c != axis]
    _, same = np.unique(points[:, columns].round(DIGITS), axis=0, return_inverse=True)
    same = same if axis is not None else np.arange(len(points))
    random = np.random.default_rng(1).uniform(-1, 1, (same.max() + 1, 3))[same]
    if axis is not None:
        random[:, axis] = 0
    shortest = np.minimum.reduceat(shortest[np.argsort(same, kind="stable")],
                                   np.flatnonzero(np.diff(np.sort(same), prepend=-1)))[same]  # fmt: skip
    moved = points.copy()
    free = inside & np.isfinite(shortest)
    moved[free] += amplitude * shortest[free, None] * random[free]
    return moved


def check(case: Path) -> int:
    """The number of checks that checkMesh lets fail."""
    log = case / "log.checkMesh"
    with log.open("w", encoding="utf-8") as output:
        subprocess.run(["checkMesh", "-constant"], cwd=case, env=ENVIRONMENT, stdout=output, check=True)
    failed = verdict(log)
    assert failed is not None, log
    return failed


def largest(mesh) -> tuple[float, float]:
    """The largest non-orthogonality and skewness."""
    values = tautline.quality(mesh, ["non_orthogonality", "face_skewness"]).values
    return float(values["non_orthogonality"].max()), float(values["face_skewness"].max())


def distance_from(faces: list[np.ndarray], points: np.ndarray, moved: np.ndarray) -> float:
    """How far the points of faces are from the surface that the faces had."""
    surface = vtkPolyData()
    places = vtkPoints()
    places.SetData(numpy_to_vtk(points, deep=True))
    polygons = vtkCellArray()
    for face in faces:
        polygons.InsertNextCell(len(face), face.tolist())
    surface.SetPoints(places)
    surface.SetPolys(polygons)
    triangles = vtkTriangleFilter()
    triangles.SetInputData(surface)
    triangles.Update()
    distance = vtkImplicitPolyDataDistance()
    distance.SetInput(triangles.GetOutput())
    return max(abs(distance.EvaluateFunction(moved[i])) for i in np.unique(np.concatenate(faces)))


def repair(source: Path, work: Path, amplitude: float) -> Repair:
    """Repairs a copy of a case."""
    case = work / source.name
    shutil.rmtree(case, ignore_errors=True)
    shutil.copytree(source / "constant/polyMesh", case / "constant/polyMesh")
    (case / "system").mkdir()
    for file in ("controlDict", "fvSchemes", "fvSolution"):
        shutil.copy(source / "system" / file, case / "system" / file)
    foam = case / "case.foam"
    foam.touch()
    mesh = tautline.read(str(foam))
    points = vtk_to_numpy(mesh.GetPoints().GetData()).astype(float)
    if amplitude > 0:
        points = perturb(case, points, amplitude)
        data = numpy_to_vtk(points, deep=True)
        mesh.GetPoints().SetData(data)
        tautline.write(mesh, str(foam))
    before, failed_before = largest(mesh), check(case)
    start = time.process_time()
    for motion in ("fixed", "slide on flat parts"):
        result = tautline.optimize(mesh, preset="finite volumes", boundary=motion, time_limit=SECONDS)
        tautline.write(result, str(foam))
        failed = check(case)
        if failed == 0:
            break
    seconds = time.process_time() - start
    faces = boundary(case / "constant/polyMesh", read_faces(case / "constant/polyMesh"), empty=False)
    diagonal = float(np.linalg.norm(np.ptp(points, axis=0)))
    surface = 0.0 if motion == "fixed" else distance_from(faces, points, result.points) / diagonal
    cells = int((vtk_to_numpy(mesh.GetCellData().GetArray("Face")) < 0).sum())
    after = largest(result)
    return Repair(source.name, cells, failed_before, failed, (before[0], after[0]), (before[1], after[1]),
                  motion != "fixed", surface, seconds)  # fmt: skip


def table(repairs: list[Repair]) -> str:
    """The results in Markdown."""
    names = ("mesh", "moved by", "cells", "failed checks", "after", "non-orthogonality", "after", "skewness", "after",
             "boundary", "CPU s")  # fmt: skip
    lines = ["| " + " | ".join(names) + " |", "|---" * len(names) + "|"]
    for one in repairs:
        lines.append(
            f"| {one.name} | {MESHES[one.name] or ''} | {one.cells} | {one.failed_before} | {one.failed} "
            f"| {one.non_orthogonality[0]:.1f} | {one.non_orthogonality[1]:.1f} "
            f"| {one.skewness[0]:.3g} | {one.skewness[1]:.3g} | {f'{one.surface:.1g}' if one.slides else 'fixed'} "
            f"| {one.seconds:.1f} |"
        )
    return "\n".join(lines) + "\n"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", type=Path)
    parser.add_argument("names", nargs="*", choices=[*MESHES, []], metavar="NAME")
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--table", type=Path)
    arguments = parser.parse_intermixed_args()
    repairs = []
    for name in arguments.names or MESHES:
        one = repair(arguments.cases / name, arguments.work, MESHES[name])
        repairs.append(one)
        print(f"{name}: {one.cells} cells, {one.failed_before} -> {one.failed} failed checks, "
              f"{one.non_orthogonality[0]:.1f} -> {one.non_orthogonality[1]:.1f}, "
              f"{one.skewness[0]:.3g} -> {one.skewness[1]:.3g}, surface {one.surface:.1e}, "
              f"{one.seconds:.1f} s", flush=True)  # fmt: skip
    passed = sum(one.failed == 0 and one.surface <= SURFACE for one in repairs)
    print(f"{passed} of {len(repairs)} pass with the boundary in place")
    if arguments.table:
        arguments.table.write_text(table(repairs), encoding="utf-8")
    return 0 if passed >= LEAST * len(repairs) / len(MESHES) else 1


if __name__ == "__main__":
    sys.exit(main())
