# SPDX-License-Identifier: BSD-3-Clause
"""The functions triangle_mesh and tet_mesh, and horizon_neighbors, in numbers."""

import math

import numpy as np
import tautline as tl
from checks import DATA, OUT, points, rejected, run_tests, shell, square, wording
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter

CUBE = DATA / "cube.smesh"



def cell_sizes(mesh) -> list:
    sizes = vtkCellSizeFilter()
    sizes.SetInputData(mesh)
    sizes.Update()
    data = sizes.GetOutput().GetCellData()
    name = "Volume" if data.GetArray("Volume").GetRange()[1] > 0 else "Area"
    return [data.GetArray(name).GetValue(i) for i in range(mesh.GetNumberOfCells())]


def loop(n: int, radius: float = 1.0):
    """A closed line around a regular polygon."""
    made, corners, lines = vtkPolyData(), vtkPoints(), vtkCellArray()
    corners.SetDataTypeToDouble()
    for k in range(n):
        corners.InsertNextPoint(radius * math.cos(2 * math.pi * k / n), radius * math.sin(2 * math.pi * k / n), 0)
        lines.InsertNextCell(2, (k, (k + 1) % n))
    made.SetPoints(corners)
    made.SetLines(lines)
    return made


def test_triangles():
    n = 24
    exact = n / 2 * math.sin(2 * math.pi / n)
    result = tl.triangle_mesh(loop(n), size=0.2, minimum_angle=25)
    assert math.isclose(sum(cell_sizes(result.mesh)), exact, rel_tol=1e-12)
    assert tl.quality(result, "min_angle").values["min_angle"].min() >= 25
    corners = points(result.mesh)
    triangles = np.array([[result.mesh.GetCell(i).GetPointId(k) for k in range(3)]
                          for i in range(result.mesh.GetNumberOfCells())])  # fmt: skip
    edges = np.linalg.norm(corners[triangles] - corners[np.roll(triangles, 1, axis=1)], axis=2)
    assert edges.max() <= 0.2 + 1e-12
    assert result.summary.startswith(f"{result.mesh.GetNumberOfCells()} triangles on ")
    assert result.boundary.GetNumberOfCells() >= n
    small = np.full(n, 0.5)
    small[0] = 0.01
    graded = tl.triangle_mesh(loop(n), sizes=small)
    assert graded.mesh.GetNumberOfCells() > tl.triangle_mesh(loop(n)).mesh.GetNumberOfCells() + 20
    rejected(wording("minimum-angle-is-36"), tl.triangle_mesh, loop(n), minimum_angle=36)
    rejected(wording("size-is-1"), tl.triangle_mesh, loop(n), -1)
    rejected(wording("sizes-has-the-shape"), tl.triangle_mesh, loop(n), sizes=[1.0, 2.0])
    assert "10 triangles" not in shell("triangle-mesh", DATA / "plate.poly", "--size", 0.2, "-o", OUT / "tri.vtu")
    made = tl.triangle_mesh(DATA / "plate.poly", 0.2).mesh
    assert tl.read(OUT / "tri.vtu").GetNumberOfCells() == made.GetNumberOfCells()


def test_tetrahedra():
    result = tl.tet_mesh(CUBE, volume=0.01)
    sizes = cell_sizes(result.mesh)
    assert math.isclose(sum(sizes), sum(cell_sizes(tl.tet_mesh(CUBE).mesh)), rel_tol=1e-9)
    assert max(sizes) <= 0.01 and len(sizes) > 100 and tl.quality(result).inverted == 0
    sphere = vtkSphereSource()
    sphere.SetThetaResolution(12)
    sphere.SetPhiResolution(10)
    sphere.Update()
    kept = tl.tet_mesh(sphere.GetOutput(), preserve_surface=True)
    assert kept.boundary.GetNumberOfCells() == sphere.GetOutput().GetNumberOfCells()
    assert "tetrahedra" in kept.summary and tl.untangle(kept).inverted == 0
    rejected(wording("volume-is-x"), tl.tet_mesh, CUBE, "x")
    rejected("", tl.tet_mesh, square(3))  # open
    shell("tet-mesh", CUBE, "--volume", 0.01, "-o", OUT / "tet.vtu")
    assert tl.read(OUT / "tet.vtu").GetNumberOfCells() == len(sizes)


def test_horizon():
    mesh, delta = square(20), 0.2
    found = tl.horizon_neighbors(mesh, (0.5, 0.5), delta)
    assert math.isclose(found.area.sum(), math.pi * delta**2, rel_tol=1e-12)
    assert set(found.case) <= {0, 1, 2, 3} and 0 < found.missed.sum() < 0.05 * found.area.sum()
    inside = [math.dist(mesh.GetCell(int(c)).GetPoints().GetPoint(k), (0.5, 0.5, 0)) <= delta + 1e-12
              for c in found.cells[found.case == 1] for k in range(3)]  # fmt: skip
    assert all(inside) and len(inside) > 100
    assert found.table()[0]["cell"] == found.cells[0] and found.horizon.GetNumberOfPoints() >= 256
    half = tl.horizon_neighbors(mesh, (0, 0.5), delta)
    assert math.isclose(half.area.sum(), math.pi * delta**2 / 2, rel_tol=1e-12)
    rejected(wording("center-is"), tl.horizon_neighbors, mesh, (1,))
    rejected(wording("delta-is-a"), tl.horizon_neighbors, mesh, (1, 1), "a")
    tl.write(mesh, OUT / "horizon.vtu")
    assert f"{len(found.case)} triangles" in shell("horizon-neighbors", OUT / "horizon.vtu")


run_tests(globals())
