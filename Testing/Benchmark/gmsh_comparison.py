# SPDX-License-Identifier: BSD-3-Clause
"""gmsh_comparison.py [--preset NAME]: improve() against the optimizer of Gmsh, on ten meshes.

Both get the same mesh and keep its surface. Smallest dihedral angle in degrees and worst inverse mean ratio of each,
and CPU seconds. Gmsh's optimizer swaps edges and faces and moves points. Prints the table; the exit status is 1 if Gmsh
is better in a figure of a mesh. Gmsh runs in a process of its own, through its Python module (Debian: python3-gmsh);
without this, nothing is done. The meshes of tire and disk are those in the folder `meshes` of the directory
TAUTLINE_TEST_DATA, left out without it.
"""

import argparse
import importlib.util
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import tautline as tl
from tautline._arrays import cell_types
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid
from vtkmodules.vtkFiltersCore import vtkCleanPolyData, vtkTriangleFilter
from vtkmodules.vtkFiltersSources import vtkSphereSource

TETRAHEDRON = 10
#: Optimizes a mesh; tetrahedra that were read are "discrete", hence force. Prints the CPU seconds of the optimization.
OPTIMIZE = """
import gmsh, sys, time
gmsh.initialize()
gmsh.option.setNumber("General.Verbosity", 1)
gmsh.option.setNumber("Mesh.MshFileVersion", 2.2)
gmsh.option.setNumber("Mesh.SaveAll", 1)
gmsh.merge(sys.argv[1])
start = time.process_time()
gmsh.model.mesh.optimize("", True)
print(time.process_time() - start)
gmsh.write(sys.argv[2])
"""
#: Meshes a box with a cylindrical bore, without the optimizer.
MESH = """
import gmsh, sys
gmsh.initialize()
gmsh.option.setNumber("General.Verbosity", 1)
box = gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
bore = gmsh.model.occ.addCylinder(0.5, 0.5, -1, 0, 0, 3, 0.25)
gmsh.model.occ.cut([(3, box)], [(3, bore)])
gmsh.model.occ.synchronize()
for name, value in (("MeshSizeMax", float(sys.argv[2])), ("Optimize", 0), ("MshFileVersion", 2.2), ("SaveAll", 1)):
    gmsh.option.setNumber("Mesh." + name, value)
gmsh.model.mesh.generate(3)
gmsh.write(sys.argv[1])
"""
#: The smallest angle and the worst ratio differ by more than this where one is better.
ROUNDING = 1e-6


def perturbed(mesh: object, fraction: float, seed: int) -> vtkUnstructuredGrid:
    return tl.perturb(mesh, fraction=fraction, seed=seed).mesh


def tetgen(surface: object) -> vtkUnstructuredGrid:
    """The Delaunay tetrahedra of a closed surface, without the quality option."""
    triangles, clean = vtkTriangleFilter(), vtkCleanPolyData()
    triangles.SetInputData(surface)
    clean.SetInputConnection(triangles.GetOutputPort())
    mesher = tl.vtkTetGenMesher()
    mesher.SetInputConnection(clean.GetOutputPort())
    mesher.SetRadiusEdgeRatio(0)
    mesher.SetMinimumDihedralAngle(0)
    mesher.Update()
    return mesher.GetOutput()


def sphere(resolution: int) -> object:
    source = vtkSphereSource()
    source.SetThetaResolution(resolution)
    source.SetPhiResolution(resolution)
    source.Update()
    return source.GetOutput()


def run_gmsh(script: str, *arguments: object) -> str:
    """Runs a script that uses Gmsh; what it prints."""
    command = [sys.executable, "-c", script, *map(str, arguments)]
    return subprocess.run(command, check=True, capture_output=True, text=True, cwd=tempfile.gettempdir()).stdout


def gmsh_box(size: float) -> vtkUnstructuredGrid:
    with tempfile.TemporaryDirectory() as folder:
        mesh = Path(folder, "box.msh")
        run_gmsh(MESH, mesh, size)
        return tetrahedra(tl.read(mesh))


def tetrahedra(mesh: object) -> vtkUnstructuredGrid:
    """The linear tetrahedra of a mesh with the points that they use."""
    types = vtk_to_numpy(cell_types(mesh))
    cells = vtk_to_numpy(mesh.GetCells().GetConnectivityArray())
    offsets = vtk_to_numpy(mesh.GetCells().GetOffsetsArray())
    kept = cells[np.repeat(types == TETRAHEDRON, np.diff(offsets))].reshape(-1, 4)
    used, numbers = np.unique(kept, return_inverse=True)
    return tl.from_arrays(vtk_to_numpy(mesh.GetPoints().GetData())[used].astype(float), numbers.reshape(-1, 4))


def meshes() -> Iterator[tuple[str, Callable[[], object]]]:
    """Names, and functions that make the meshes."""
    yield "ball", lambda: tl.domain("sphere", cells=20000)
    yield "ball, perturbed", lambda: perturbed(tl.domain("sphere", cells=20000), 0.5, 1)
    yield "bore", lambda: tl.domain("bore", cells=20000)
    yield "bore, perturbed", lambda: perturbed(tl.domain("bore", cells=20000), 0.5, 2)
    yield "barrier", lambda: tl.domain("barrier3d", cells=20000)
    yield "barrier, perturbed", lambda: perturbed(tl.domain("barrier3d", cells=20000), 0.5, 3)
    yield "TetGen, no quality", lambda: tetgen(sphere(24))
    yield "Gmsh, not optimized", lambda: gmsh_box(0.08)
    data = os.environ.get("TAUTLINE_TEST_DATA")
    for name in ("tire", "disk3d_50k_p50") if data else ():
        yield name, lambda name=name: tetrahedra(tl.read(Path(data, "meshes", name + ".vtk")))


def figures(mesh: object) -> tuple[float, float]:
    """Smallest dihedral angle in degrees, worst inverse mean ratio."""
    statistics = tl.quality(mesh, ["min_angle", "imr"]).statistics
    return statistics["min_angle"]["worst"], statistics["imr"]["worst"]


def optimize_by_gmsh(mesh: object) -> tuple[vtkUnstructuredGrid, float]:
    """The mesh that Gmsh's optimizer returns, and CPU seconds."""
    with tempfile.TemporaryDirectory() as folder:
        before, after = Path(folder, "in.msh"), Path(folder, "out.msh")
        tl.write(mesh, before)
        seconds = float(run_gmsh(OPTIMIZE, before, after).split()[-1])
        return tetrahedra(tl.read(after)), seconds


def compare(preset: str) -> int:
    """Prints the table; the number of meshes where Gmsh is better in a figure."""
    print(f"{'mesh':22}{'tetrahedra':>11}{'before':>16}{'Gmsh':>16}{'s':>7}{'Tautline':>16}{'s':>7}  better in both")
    worse = 0
    for name, make in meshes():
        mesh = make()
        other, seconds = optimize_by_gmsh(mesh)
        start = time.process_time()
        own = tl.improve(mesh, preset, threads=1).mesh
        own_seconds = time.process_time() - start
        before, theirs, ours = figures(mesh), figures(other), figures(own)
        better = ours[0] > theirs[0] - ROUNDING and ours[1] < theirs[1] + ROUNDING
        worse += not better
        texts = [f"{angle:.3g} / {ratio:.4g}" for angle, ratio in (before, theirs, ours)]
        print(f"{name:22}{mesh.GetNumberOfCells():11}{texts[0]:>16}{texts[1]:>16}{seconds:7.2f}{texts[2]:>16}"
              f"{own_seconds:7.2f}  {'yes' if better else 'NO'}", flush=True)  # fmt: skip
    return worse


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--preset", default="aggressive")
    options = parser.parse_args()
    if importlib.util.find_spec("gmsh") is None:
        print("Gmsh's Python module is not installed (Debian: python3-gmsh): no comparison with it")
        return 0
    return 1 if compare(options.preset) else 0


if __name__ == "__main__":
    sys.exit(main())
