"""The function improve and its command."""

import csv

import numpy as np
import tautline as tl
from checks import OUT, points, refused, run_tests, shell as run, square
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet


def slivers():
    """A box of tetrahedra whose inner points moved at random, with a point and a cell array."""
    mesh = tl.perturb(tl.domain("disk3d", 2000), fraction=0.9, seed=3).mesh
    field = numpy_to_vtk(points(mesh) @ [2.0, -1.0, 0.5] + 3, deep=True)
    field.SetName("field")
    mesh.GetPointData().AddArray(field)
    region = numpy_to_vtk((points_of_cells(mesh)[:, 0] > points(mesh)[:, 0].mean()).astype(int), deep=True)
    region.SetName("region")
    mesh.GetCellData().AddArray(region)
    return mesh


def points_of_cells(mesh):
    """The centroid of each tetrahedron."""
    cells = vtk_to_numpy(mesh.GetCells().GetConnectivityArray()).reshape(-1, 4)
    return points(mesh)[cells].mean(axis=1)


def volumes(mesh):
    cells = vtk_to_numpy(mesh.GetCells().GetConnectivityArray()).reshape(-1, 4)
    corner = points(mesh)[cells]
    return np.einsum("ij,ij->i", np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]),
                     corner[:, 3] - corner[:, 0]) / 6  # fmt: skip


def test_improve():
    mesh = slivers()
    before = tl.quality(mesh, ["min_angle", "imr"])
    for preset in ("remove slivers", "swap only", "swap and smooth", "aggressive"):
        result = tl.improve(mesh, preset)
        after = tl.quality(result, ["min_angle", "imr"])
        assert after.inverted == 0, preset
        assert np.allclose(result.min_angle, after.values["min_angle"]) and np.allclose(result.imr, after.values["imr"])
        assert np.isclose(result.smallest_angle_before, before.values["min_angle"].min())
        assert np.isclose(result.smallest_angle, result.min_angle.min()) and np.isclose(result.worst, result.imr.max())
        assert result.smallest_angle > result.smallest_angle_before and result.worst < result.worst_before, preset
        assert result.elements == result.mesh.GetNumberOfCells() == len(result.original_cell)
        assert 0.9 * result.elements_before <= result.elements <= 1.1 * result.elements_before
        history = result.history
        assert history["elements"][0] == result.elements_before and history["elements"][-1] == result.elements
        assert (np.diff(history["worst_imr"]) <= 1e-9).all() and (np.diff(history["seconds"]) >= 0).all()
        assert history["moves"].dtype == int and (preset != "swap only" or history["moves"][-1] == 0)
        assert len(result.remaining.get("cell", ())) == history["below_target"][-1]
        assert "Smallest dihedral angle: " in result.summary and result.reason in result.summary
    easy = tl.improve(mesh, target_angle=1)
    assert easy.reason == "Every element has reached the target." and not easy.remaining, easy.summary


def test_data():
    """Regions keep their cells' volumes; cells have the data of the original one; points keep theirs."""
    mesh = slivers()
    region = vtk_to_numpy(mesh.GetCellData().GetArray("region"))
    result = tl.improve(mesh, "aggressive", target_angle=40, regions="region")
    after = vtk_to_numpy(result.mesh.GetCellData().GetArray("region"))
    assert (after == region[result.original_cell]).all()
    for number in (0, 1):
        volume = volumes(mesh)[region == number].sum()
        assert np.isclose(volumes(result.mesh)[after == number].sum(), volume, rtol=1e-12)
    same = tl.improve(mesh, "aggressive", target_angle=40, regions=region)
    assert (points(same.mesh) == points(result.mesh)).all()
    assert result.mesh.GetPointData().HasArray("field")
    still = tl.improve(mesh, "swap and smooth", fixed=np.ones(mesh.GetNumberOfPoints()))
    assert (points(still.mesh) == points(mesh)).all()
    assert "it has a fixed point" in still.remaining["reason"]


def test_inputs():
    mesh = slivers()
    cells = vtk_to_numpy(mesh.GetCells().GetConnectivityArray()).reshape(-1, 4)
    region = vtk_to_numpy(mesh.GetCellData().GetArray("region"))
    blocks = vtkMultiBlockDataSet()
    for i in range(2):
        blocks.SetBlock(i, tl.from_arrays(points(mesh), cells[region == i]))
    refused("blocks would come apart", tl.improve, blocks, boundary="flat")
    both = tl.improve(blocks)
    assert both.elements_before == len(cells) and set(both.history["block"]) == {"block 1", "block 2"}
    assert np.isclose(both.smallest_angle, both.min_angle.min()) and "In block 2: " in both.summary
    cells = [[0, 1, 2, 3]]
    assert tl.improve(([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], cells)).elements == 1
    custom = tl.improve(slivers(), "custom", smooth=False, insert=False, contract=False, compound=False)
    assert custom.history["moves"][-1] == 0 and custom.history["edge_removals"][-1] > 0
    flat = tl.improve(slivers(), boundary="flat", time_limit=60)
    assert flat.smallest_angle >= flat.smallest_angle_before


def test_refused():
    for text, options in (
        ("preset is 'best'", {"preset": "best"}),
        ("boundary is 'x'", {"boundary": "x"}),
        ("target_angle is 61", {"target_angle": 61}),
        ("smallest_count is 2", {"smallest_count": 2}),
        ("largest_count is 0.5", {"largest_count": 0.5}),
        ("flat_tolerance is 2", {"flat_tolerance": 2}),
        ("no option 'speed'", {"speed": 1}),
        ("with preset='custom' only", {"swap": False}),
        ("no cell array 'x'", {"regions": "x"}),
        ("no point array 'x'", {"fixed": "x"}),
    ):
        refused(text, tl.improve, slivers(), **options)
    refused("run Untangle Mesh first", tl.improve, tl.perturb(slivers(), tangle=0.05))
    refused("no tetrahedron", tl.improve, square(4))
    refused("there is no such file", tl.improve, "absent.vtu")


def test_unused_far_point():
    """A point that no cell uses does not determine the unit of the computation."""
    mesh = slivers()
    near = tl.improve(mesh)
    mesh.GetPointData().Initialize()
    mesh.GetPoints().InsertNextPoint(1e30, 0, 0)
    far = tl.improve(mesh)
    assert near.smallest_angle > near.smallest_angle_before
    assert (far.smallest_angle, far.elements) == (near.smallest_angle, near.elements), far.summary


def test_command():
    source, mesh, table = OUT / "slivers.vtu", OUT / "improved.vtu", OUT / "improved.csv"
    tl.write(slivers(), source)
    text = run("improve", source, "-o", mesh, "--csv", table, "--preset", "aggressive", "--regions", "region")
    assert "Smallest dihedral angle: " in text, text
    expected = tl.improve(source, "aggressive", regions="region")
    assert (points(tl.read(mesh)) == points(expected.mesh)).all()
    rows = list(csv.DictReader(open(table, encoding="utf-8")))
    assert len(rows) == len(expected.history["elements"])
    assert int(rows[-1]["elements"]) == expected.elements, rows[-1]
    run("improve", source, "-o", mesh, "--preset", "custom", "--no-insert", "--no-contract", "--no-compound")
    few = tl.improve(source, "custom", insert=False, contract=False, compound=False)
    assert (points(tl.read(mesh)) == points(few.mesh)).all()
    assert few.mesh.GetNumberOfPoints() == slivers().GetNumberOfPoints()
    assert "invalid choice: 'x'" in run("improve", source, "-o", mesh, "--preset", "x", code=2)


run_tests(globals())
