# SPDX-License-Identifier: BSD-3-Clause
"""The function curve and its command: types of cells, data, geometry, curved input, errors."""

import numpy as np
import tautline as tl
from checks import DATA, OUT, points, rejected, run_tests, shell, square, wording
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet, vtkPolyData, vtkUnstructuredGrid

BRACKET = DATA / "bracket.vtu"
TYPES = {2: {"tetra": 24, "triangle": 22}, 3: {"tetra": 71, "triangle": 69}, 4: {"tetra": 71, "triangle": 69}}


def ring(around: int, radius: float = 1.0):
    """A disk without its middle, of quadrilaterals, with linear data."""
    angles = 2 * np.pi * np.arange(around) / around
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    i = np.arange(around)
    j = (i + 1) % around
    mesh = tl.from_arrays(np.vstack([0.5 * circle, radius * circle]),
                          {"quad": np.column_stack([i, i + around, j + around, j])})  # fmt: skip
    return mesh


def types(mesh) -> set:
    return set(vtk_to_numpy(mesh.GetCellTypesArray()).tolist())


def add(data, name: str, values) -> None:
    array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    array.SetName(name)
    data.AddArray(array)


def test_data():
    mesh = tl.read(BRACKET)
    x = points(mesh)
    add(mesh.GetPointData(), "linear", x @ [1.0, 2.0, 3.0])
    add(mesh.GetCellData(), "number", np.arange(mesh.GetNumberOfCells()))
    add(mesh.GetFieldData(), "note", [7.0])
    for order in (2, 3, 4):
        curved = tl.curve(mesh, order, surface="straight")
        assert types(curved.mesh) == {TYPES[order]["tetra"]}
        assert curved.added == curved.mesh.GetNumberOfPoints() - mesh.GetNumberOfPoints() > 0
        assert curved.invalid == curved.invalid_before == 0 and (curved.validity == 1).all()
        data = curved.mesh.GetPointData().GetArray("linear")
        assert np.allclose(vtk_to_numpy(data), points(curved.mesh) @ [1.0, 2.0, 3.0], atol=1e-9)
        assert (vtk_to_numpy(curved.mesh.GetCellData().GetArray("number")) == np.arange(len(curved.validity))).all()
        assert curved.mesh.GetFieldData().GetArray("note").GetValue(0) == 7
        assert (points(curved.mesh)[: len(x)] == x).all()
        back = tl.curve(curved.mesh, 1)
        assert types(back.mesh) == {10} and (points(back.mesh) == x).all()
        assert wording("nodes-of-curved-cells-dropped") in back.summary
    assert tl.quality(curved.mesh).inverted == 0


def test_smooth():
    mesh = ring(12)
    straight, smooth = tl.curve(mesh, 2, surface="straight"), tl.curve(mesh)
    assert types(smooth.mesh) == {28} and types(tl.curve(mesh, serendipity=True).mesh) == {23}
    radii = [np.linalg.norm(points(each.mesh)[24:, :2], axis=1) for each in (straight, smooth)]
    outer = [r[r > 0.9] for r in radii]
    assert abs(outer[0].min() - np.cos(np.pi / 12)) < 1e-12
    assert abs(outer[1] - 1).max() < 1e-4, outer
    assert 0.033 < smooth.largest_offset < 0.035 and straight.largest_offset == 0
    # Sharp corners stay: below the angle of the polygon, all points are corners.
    assert tl.curve(mesh, feature_angle=10).largest_offset < 1e-12
    # Curved cells keep their shape at a higher order.
    again = tl.curve(smooth, 4)
    assert types(again.mesh) == {70} and again.largest_offset < 1e-12
    assert wording("its-shape-is-kept") in again.summary
    x = points(again.mesh)
    rim = np.linalg.norm(x[:, :2], axis=1)
    assert abs(rim[rim > 0.99] - 1).max() < 3e-4


def test_geometry():
    fine = ring(240)
    curved = tl.curve(ring(12), 3, geometry=fine)
    assert curved.distance < 1e-3 < 0.03 < curved.distance_before, curved
    rejected(wording("straight-cells-on-a-geometry"), tl.curve, ring(12), surface="straight", geometry=fine)
    rejected(wording("geometry-is-empty"), tl.curve, ring(12), geometry=vtkUnstructuredGrid())


def test_kinds_of_data():
    surface = vtkPolyData()
    surface.SetPoints(square(3).GetPoints())
    surface.SetPolys(square(3).GetCells())
    curved = tl.curve(surface, 2)
    assert isinstance(curved.mesh, vtkUnstructuredGrid) and types(curved.mesh) == {22}
    blocks = vtkMultiBlockDataSet()
    blocks.SetBlock(0, surface)
    blocks.SetBlock(2, ring(12))
    both = tl.curve(blocks, 2)
    assert both.added == curved.added + tl.curve(ring(12), 2).added
    assert [both.mesh.GetBlock(b) and types(both.mesh.GetBlock(b)) for b in range(3)] == [{22}, None, {28}]
    regions = np.arange(18) // 9
    assert tl.curve(square(3), 2, regions=regions).invalid == 0
    zoo = tl.read(DATA / "zoo.mesh")
    assert tl.curve(zoo, 2).invalid == tl.quality(zoo).inverted


def test_threads():
    one, many = (tl.curve(BRACKET, 3, threads=threads) for threads in (1, 4))
    assert (points(one.mesh) == points(many.mesh)).all() and one.summary == many.summary


def test_rejected():
    rejected("order", tl.curve, ring(12), 5)
    corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 1]]
    pyramid = tl.from_arrays(corners, {"pyramid": [[0, 1, 2, 3, 4]]})
    assert types(tl.curve(pyramid, 2).mesh) == {37} and types(tl.curve(pyramid, 2, serendipity=True).mesh) == {27}
    rejected(wording("no-pyramids-of-order"), tl.curve, pyramid, 3)
    broken = square(2)
    points(broken)[0, 0] = np.nan
    rejected(wording("not-a-finite-number"), tl.curve, broken)


def test_command():
    out = OUT / "curved.vtu"
    printed = shell("curve", DATA / "cylinder.msh", "--order", 2, "--serendipity", "-o", out)
    assert wording("invalid-elements-certified") in printed
    assert types(tl.read(out)) == {22}


run_tests(globals())
