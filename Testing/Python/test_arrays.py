# SPDX-License-Identifier: BSD-3-Clause
"""Results and meshes as numpy arrays: points, cells, point_data, cell_data; meshes from what meshio has."""

import copy
import pickle
import subprocess
import sys

import numpy as np
import tautline as tl
from checks import DATA, OUT, rejected, run_tests, square, wording
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkMultiBlockDataSet, vtkRectilinearGrid, vtkUnstructuredGrid

PLATE = DATA / "plate.vtu"
CORNERS = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1)], float)
TET = [[0, 1, 2, 3]]


def test_views() -> None:
    """Values written to an array are in the mesh, and VTK's values are in the array."""
    mesh = tl.read(PLATE)
    assert mesh.points.shape == (1190, 3) and np.shares_memory(mesh.points, vtk_to_numpy(mesh.GetPoints().GetData()))
    mesh.points[7] += (0.25, 0, 0)
    assert mesh.GetPoint(7) == tuple(mesh.points[7]) and mesh.GetPoint(7)[0] != tl.read(PLATE).GetPoint(7)[0]
    assert list(mesh.cells) == ["quadrilateral", "triangle"]
    triangles = mesh.cells["triangle"]
    assert triangles.shape == (1625, 3)
    ids = vtk_to_numpy(mesh.GetCells().GetConnectivityArray())
    assert all(np.shares_memory(cells, ids) for cells in mesh.cells.values())
    assert isinstance(mesh, vtkUnstructuredGrid) and mesh.GetClassName() == "vtkUnstructuredGrid"
    mesh.point_data["Height"] = mesh.points[:, 2]
    mesh.cell_data["Part"] = np.arange(1913)
    mesh.cell_data["Part"][:3] = 5
    assert [mesh.GetCellData().GetArray("Part").GetValue(i) for i in range(4)] == [5, 5, 5, 3]
    assert list(mesh.point_data) == ["Height"] and "Part" in mesh.cell_data and len(mesh.cell_data) == 1
    assert tl.quality(mesh).mesh.GetCellData().HasArray("Part")
    del mesh.cell_data["Part"]
    assert not mesh.GetCellData().HasArray("Part")
    assert wording("1190-points-1913-cells-288") in repr(mesh) and len(str(mesh)) < 200
    before = mesh.GetBounds()[1]
    mesh.points[:] *= 2
    assert tl.quality(mesh).mesh.GetBounds()[1] == 2 * before  # not the bounds that VTK has kept
    result = tl.quality(mesh)
    assert result.mesh.GetBounds()[1] == 2 * before
    result.points[:] *= 2
    assert tl.quality(result).mesh.GetBounds()[1] == 4 * before


def test_results() -> None:
    """The same arrays of results, also in copies; fields of the same names are not hidden."""
    result = tl.quality(PLATE, "imr")
    for one in (result, copy.copy(result), copy.deepcopy(result), pickle.loads(pickle.dumps(result))):
        assert (one.points == result.mesh.points).all() and one.cells["tri"].shape == (1625, 3)
        assert (one.cell_data["imr"] == one.values["imr"]).all() and "points" in dir(one)
        assert (one.mesh.cell_data["imr"] == one.values["imr"]).all()
    assert np.shares_memory(result.cell_data["imr"], result.values["imr"])
    warped = tl.warp(PLATE, transform={"rotate": 3})
    assert (warped.points - tl.read(PLATE).points == warped.displacement).all()
    assert (tl.optimize(PLATE).points == vtk_to_numpy(tl.optimize(PLATE).mesh.GetPoints().GetData())).all()
    found = tl.horizon_neighbors(tl.interaction_layer(square(6), 0.2))
    assert found.cells.ndim == 1 and found.points.shape[1] == 3 and "triangle" in found.mesh.cells
    assert not hasattr(tl.solver_study(PLATE, combinations=[1]), "points")
    blocks = vtkMultiBlockDataSet()
    blocks.SetBlock(0, square(2))
    rejected(wording("take-one-of-its-blocks"), lambda: tl.quality(blocks).points)
    assert not hasattr(result, "no_such_field")
    for made in (tl.domain("square"), tl.interaction_layer(square(3), 0.3), square(3), tl.triangle_mesh(
            DATA / "plate.poly").mesh, tl.metric_field(dimensions=(5, 4)).mesh):  # fmt: skip
        assert made.points.shape == (made.GetNumberOfPoints(), 3) and len(made.cells), made


def test_round_trip() -> None:
    """Points and cells of a mesh are a mesh."""
    for name in ("plate.vtu", "bracket.vtu", "zoo.mesh", "quadratic.1.ele", "house.off", "wedges.msh"):
        mesh = tl.read(DATA / name)
        made = tl.from_arrays(mesh.points, mesh.cells)
        assert made.GetNumberOfCells() == mesh.GetNumberOfCells()
        for kind, cells in mesh.cells.items():
            assert all(map(np.array_equal, made.cells[kind], cells)), (name, kind)
        assert tl.quality(made).inverted == tl.quality((mesh.points, mesh.cells)).inverted == tl.quality(mesh).inverted
    mixed = tl.from_arrays(CORNERS, [("tetra", TET), ("triangle", [[0, 1, 2]]), ("tetra", TET)])
    assert mixed.cells["tetra"].tolist() == TET * 2 and not mixed.cells["tetra"].flags.writeable


def test_other_grids() -> None:
    """Images and rectilinear grids have no arrays of points and cells: these are copies that cannot be written to."""
    image = vtkImageData()
    image.SetDimensions(3, 3, 3)
    tl.write(image, OUT / "arrays.vti")
    grid = vtkRectilinearGrid()
    grid.SetDimensions(2, 1, 1)
    read = tl.read(OUT / "arrays.vti")
    assert read.points.shape == (27, 3) and read.cells["hex"].shape == (8, 8) and not read.points.flags.writeable
    measured = tl.quality((read.points, read.cells))
    assert measured.inverted == 0 and (measured.validity == 1).all()  # in the order of hexahedra, not of voxels
    try:
        read.points = read.points
        raise AssertionError("the points of an image were set")
    except tl.Error as error:
        assert wording("cannot-be-replaced") in str(error)
    polygons = tl.read(DATA / "house.off")
    tl.write(polygons, OUT / "arrays.vtp")
    assert {kind: len(cells) for kind, cells in tl.read(OUT / "arrays.vtp").cells.items()} == {
        kind: len(cells) for kind, cells in polygons.cells.items()
    }


def test_wrong_arrays() -> None:
    mesh = tl.read(PLATE)
    for values in (3, [1, 2], "text", None, [[1], [2, 3]], ["a"] * 1190, object()):
        rejected("'x'", mesh.point_data.__setitem__, "x", values)
    for name in (None, "", 3):
        rejected(wording("the-name-of-an-array-is"), mesh.cell_data.__setitem__, name, np.zeros(1913))
    for points in (3, None, np.zeros((3, 3)), [["a"]], mesh.points[:, :2]):
        rejected("points", setattr, mesh, "points", points)
    mesh.points = mesh.points + 1
    assert mesh.GetPoint(0)[2] == 1
    for wrong in ("nope", None, 3):
        rejected(wording("there-is-no-array-of-points"), lambda: mesh.point_data[wrong])
        rejected(wording("there-is-no-cell-type"), lambda: mesh.cells[wrong])
    rejected(wording("did-you-mean-triangle"), lambda: mesh.cells["triangel"])
    assert mesh.point_data.get("nope") is None and mesh.cells.get("nope", 3) == 3
    for cells in ([("tetra", [[0, 1, 2]])], [("tetrahedrn", TET)], [("wedge", TET)], [("wedge", 3)], [(3, TET)],
                  [("tetra", TET), 3], [("tetra",)], [], {3: TET}, None, "tetra", [("tetra", None)]):  # fmt: skip
        rejected("cells", tl.from_arrays, CORNERS, cells)
    rejected(wording("did-you-mean-tetrahedron"), tl.from_arrays, CORNERS, [("tetrahedrn", TET)])


def test_metric_names() -> None:
    """Every name of a metric is a key, in the dicts of every function; a wrong one names the nearest."""
    result = tl.quality(PLATE, "mu_2", criteria="fem")
    for facts in tl.metrics():
        if facts["name"] in result.statistics:
            for name in (facts["label"], facts["symbol"], *facts["aliases"], facts["name"].upper()):
                assert result.statistics[name] is result.statistics[facts["name"]], name
    assert "mu_2" in result.values and result.values.get("mu_2") is result.values["mu_shape"]
    assert result.criteria["Inverse Mean Ratio"] == result.criteria["imr"]
    assert "nope" not in result.values and result.values.get("nope") is None
    worse = tl.perturb(PLATE, fraction=0.2)
    assert tl.compare(PLATE, worse, "mu_2").statistics["mu_2"] and tl.optimize(PLATE, "mu_2").statistics["mu_2"]
    assert tl.metric_field("mu_2", dimensions=(3, 3)).values["mu_2"].shape == (3, 3)
    try:
        result.statistics["mu_3"]
    except KeyError as error:
        assert isinstance(error, tl.Error) and "mu_shape" in str(error) and pickle.loads(pickle.dumps(error))
    rejected(wording("did-you-mean-imr"), tl.quality, PLATE, "imrr")
    rejected(wording("did-you-mean-rr-radius-ratio"), tl.quality, PLATE, "radius ratoi")
    rejected(wording("did-you-mean-scaled-jacobian"), tl.optimize, PLATE, ["scaled_jacobain"])
    rejected(wording("did-you-mean-scaled-jacobian"), tl.optimize, PLATE, worst_metric="scaled_jacobain")
    rejected(wording("did-you-mean-scaled-jacobian"), tl.improve, DATA / "bracket.vtu", metric="scaled_jacobain")
    rejected(wording("did-you-mean-fem"), tl.quality, PLATE, criteria="fen")


def test_error_names() -> None:
    """A traceback names tautline.Error, as it is written in `except`."""
    for text, name in (("tl.read('absent.vtu')", "tautline.Error"), ("tl.Aborted('x')", "tautline.Aborted")):
        script = f"import tautline as tl\nfound = {text}\nraise found"
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
        assert f"\n{name}: " in done.stderr, done.stderr
    error = pickle.loads(pickle.dumps(tl.Error("text")))
    assert isinstance(error, tl.Error) and str(error) == "text"


def test_meshio() -> None:
    """meshio's blocks, its pairs of name and array, and its order of wedges."""
    try:
        import meshio
    except ImportError:
        return
    wedge = [[0, 2, 1, 3, 5, 4]]
    made = meshio.Mesh(CORNERS, [("wedge", wedge)])
    for cells in (made.cells, [("wedge", wedge)], [("prism", np.array(wedge))]):
        assert tl.from_arrays(CORNERS, cells).cells["wedge"].tolist() == tl.quality(made).cells["wedge"].tolist()
    assert tl.quality((CORNERS, made.cells)) == tl.quality(made)
    assert tl.from_arrays(CORNERS, {"wedge": wedge}).cells["wedge"].tolist() == wedge  # VTK's order
    tetra = meshio.Mesh(CORNERS[:4], [("tetra", np.array(TET))])
    assert tl.quality((tetra.points, tetra.cells)) == tl.quality((tetra.points, tetra.cells_dict)) == tl.quality(tetra)


run_tests(globals())
