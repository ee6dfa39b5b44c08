# SPDX-License-Identifier: BSD-3-Clause
"""The function warp and its command: motions, targets, coefficients, results, errors."""

import csv

import numpy as np
import tautline as tl
from checks import DATA, OUT, points, quadratic_square, rejected, run_tests, shell, wording
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet
from vtkmodules.vtkCommonTransforms import vtkTransform
from vtkmodules.vtkFiltersSources import vtkSphereSource

PLATE, BRACKET = DATA / "plate.vtu", DATA / "bracket.vtu"


def box_in_box(n=7):
    """Tetrahedra between two boxes: a block without its middle."""
    grid = np.stack(np.meshgrid(*[np.arange(n + 1)] * 3, indexing="ij"), -1).reshape(-1, 3).astype(float)
    number = np.arange((n + 1) ** 3).reshape([n + 1] * 3)
    cells = []
    low, high = n // 3, n - n // 3
    for i, j, k in np.ndindex(n, n, n):
        if all(low <= x < high for x in (i, j, k)):
            continue
        corner = number[i : i + 2, j : j + 2, k : k + 2]
        for a in range(3):
            for b in range(3):
                if a != b:
                    unit = np.eye(3, dtype=int)
                    cell = [corner[tuple(step)] for step in (0 * unit[a], unit[a], unit[a] + unit[b], np.ones(3, int))]
                    edges = grid[cell[1:]] - grid[cell[0]]
                    cells.append(cell if np.linalg.det(edges) > 0 else [cell[1], cell[0], *cell[2:]])
    used, compact = np.unique(np.array(cells), return_inverse=True)
    return grid[used], compact.reshape(-1, 4)


def test_transforms():
    mesh = tl.read(PLATE)
    x = points(mesh)
    turned = tl.warp(mesh, transform={"rotate": 40})
    d = turned.displacement
    assert turned.inverted == 0 and (turned.validity == 1).all() and "Hybrid" in turned.summary
    assert (d == points(turned.mesh) - x).all()
    facts = turned.statistics
    assert facts["elements"] == mesh.GetNumberOfCells() and facts["inverted"] == 0
    assert facts["moved_points"] > 20 and facts["worst_shape"] == turned.shape.max()
    assert np.isclose(facts["mean_shape"], turned.shape.mean()) and facts["total_seconds"] > 0
    assert np.isclose(facts["worst_imr"], tl.quality(turned).values["imr"].max())
    assert np.isclose(facts["worst_imr_before"], tl.quality(mesh).values["imr"].max())
    history = turned.history
    assert history["stage"][0] == "warp" and len(history["inverted"]) == len(history["stage"])
    assert history["inverted"][-1] == 0 and history["iterations"].dtype == int
    # a transform of VTK, a matrix and words give the same; amount goes along the arc
    vtk = vtkTransform()
    vtk.RotateZ(40)
    for other in (vtk, [vtk.GetMatrix().GetElement(i, j) for i in range(4) for j in range(4)]):
        again = tl.warp(mesh, transform=other, method="femwarp")
        same = tl.warp(mesh, transform={"rotate": 40, "center": (0, 0)}, method="femwarp")
        assert np.abs(again.displacement - same.displacement).max() < 1e-12
    half, whole = (tl.warp(mesh, transform={"rotate": a}, method="femwarp", amount=t) for a, t in ((20, 1), (40, 0.5)))
    assert np.abs(half.displacement - whole.displacement).max() < 1e-12
    assert not tl.warp(mesh, transform=vtk, amount=0).displacement.any()
    # what moves: parts by number, arrays by name or by value
    big = tl.warp(mesh, transform={"scale": 2}, moved=[1])
    marks = np.zeros(len(x))
    marks[np.linalg.norm(big.displacement, axis=1) > 0] = 3
    assert big.statistics["moved_points"] > 50
    whole = tl.warp(mesh, transform={"translate": (1, 2)}, moved="whole boundary")
    assert np.allclose(whole.displacement, [1, 2, 0], atol=1e-9)
    some = tl.warp(mesh, transform={"translate": (0, 0.01)}, moved=marks, values=[3])
    assert 0 < some.statistics["moved_points"] < whole.statistics["moved_points"]
    assert some.mesh.GetPointData().GetArray("given moved") is None
    bent = tl.warp(mesh, transform={"bend": 90, "direction": (1, 0)}, moved="whole boundary")
    assert bent.inverted == 0 and np.ptp(points(bent.mesh)[:, 1]) > 1.2 * np.ptp(x[:, 1])


def test_arrays_and_targets():
    mesh = tl.read(PLATE)
    x = points(mesh)
    affine = x @ np.array([[1.2, 0.3, 0], [-0.1, 0.7, 0], [0, 0, 1]])
    cells = mesh.GetNumberOfCells()
    for coefficients in ("displacement sums", "principal directions", (1, 4, 1), np.arange(1.0, cells + 1)):
        result = tl.warp(mesh, affine - x, "anisotropic femwarp", coefficients=coefficients)
        assert np.abs(points(result.mesh) - affine).max() < 1e-10, coefficients
    region = np.arange(cells) % 3
    result = tl.warp(mesh, affine - x, "anisotropic femwarp", coefficients=(2, 1, 1), regions=(region, {1: (1, 3, 1)}))
    assert np.abs(points(result.mesh) - affine).max() < 1e-10
    turned = tl.warp(mesh, transform={"rotate": 30}, method="femwarp", coefficients=(1, 1, 1))
    uneven = tl.warp(mesh, transform={"rotate": 30}, method="anisotropic femwarp", coefficients=(1, 9, 1))
    assert np.abs(turned.displacement - uneven.displacement).max() > 1e-3 and np.isclose(uneven.statistics["cyy"], 9)
    back = tl.warp(turned, target=mesh, method="femwarp")
    assert wording("as-the-same-mesh") in back.summary and 0 < np.abs(points(back.mesh) - x).max() < 0.3
    edge = np.flatnonzero(x[:, 0] == x[:, 0].max())
    assert len(edge) > 5 and np.abs(points(back.mesh) - x)[edge].max() < 1e-12
    assert not tl.warp(turned, "Displacement", amount=0).displacement.any()

    source = tl.vtkDomainSource()
    source.SetDomainByName("rectangle")
    source.SetNumberOfCells(800)
    source.Update()
    moving, boundary = source.GetOutput(0), source.GetOutputDataObject(1)
    by_array, by_target = tl.warp(moving, "Displacement"), tl.warp(moving, target=boundary)
    assert by_array.inverted == 0 and np.abs(by_array.displacement).max() > 0.1
    assert np.abs(by_array.displacement - by_target.displacement).max() < 1e-5

    mesh = box_in_box()
    sphere = vtkSphereSource()
    sphere.SetCenter(3.5, 3.5, 3.5)
    sphere.SetRadius(1.5)
    sphere.SetThetaResolution(40)
    sphere.SetPhiResolution(40)
    sphere.Update()
    round_ = tl.warp(mesh, target=sphere.GetOutput())
    moved = np.linalg.norm(round_.displacement, axis=1) > 0
    radius = np.linalg.norm(points(round_.mesh) - 3.5, axis=1)
    assert wording("by-projection") in round_.summary and round_.inverted == 0 and moved.any()
    assert radius.min() > 1.48 and np.abs(radius[np.argsort(radius)[:20]] - 1.5).max() < 0.02
    x = points(round_.mesh)
    numbers = np.array([0, 1, 2])
    target = (x[numbers] + [0, 0, -0.5], {"triangle": []})
    by_id = tl.warp(mesh, target=target, target_ids=numbers, method="inverse distance")
    assert wording("by-point-ids-3-of") in by_id.summary
    assert np.allclose(by_id.displacement[numbers], [0, 0, -0.5])


def test_methods():
    mesh = box_in_box()
    for method in ("hybrid", "femwarp and untangling", "automatic"):
        result = tl.warp(mesh, transform={"rotate": 90, "axis": (1, 1, 0)}, method=method)
        assert result.inverted == 0, (method, result.summary)
    turned = tl.warp(mesh, transform={"rotate": 15}, method="inverse distance with rotations")
    assert turned.inverted == 0 and turned.history["stage"] == ["warp"], turned.summary
    chosen = tl.warp(mesh, transform={"rotate": 15}, method="automatic")
    assert chosen.inverted == 0 and chosen.history["stage"][0] == "radial basis", chosen.summary
    plain = tl.warp(mesh, transform={"rotate": 90, "axis": (1, 1, 0)}, method="femwarp")
    assert plain.inverted == plain.inverted_after_warp > 0 and plain.history["inverted"][-1] == plain.inverted
    assert (plain.validity != 1).sum() == plain.inverted
    for options in ({"solver": "conjugate gradients", "preconditioner": "icc"}, {"solver": "direct"}):
        other = tl.warp(mesh, transform={"rotate": 90, "axis": (1, 1, 0)}, method="femwarp", **options)
        assert np.abs(other.displacement - plain.displacement).max() < 1e-7
    one, two = (tl.warp(mesh, transform={"rotate": 50}, threads=threads) for threads in (1, 2))
    assert (one.displacement == two.displacement).all()
    crossing = tl.warp(mesh, transform={"translate": (4, 0, 0)}, time_limit=20)
    assert crossing.inverted > 0 and f"{crossing.inverted} of" in crossing.summary
    blocks = vtkMultiBlockDataSet()
    for i in range(2):
        blocks.SetBlock(i, tl.from_arrays(*mesh))
    both = tl.warp(blocks, transform={"rotate": 50})
    assert list(both.statistics) == ["block 1", "block 2"]
    assert (both.displacement == np.concatenate([one.displacement] * 2)).all()


def test_rejected():
    rejected(wording("nothing-is-given"), tl.warp, PLATE)
    rejected(wording("displacement-and-transform-are-given"), tl.warp, PLATE, "d", transform={"rotate": 1})
    rejected(wording("method-is-magic"), tl.warp, PLATE, method="magic")
    rejected(wording("no-point-array-d"), tl.warp, PLATE, "d")
    rejected(wording("has-the-shape-3-3"), tl.warp, PLATE, np.zeros((3, 3)))
    rejected(wording("amount-is-1"), tl.warp, PLATE, amount=-1)
    rejected(wording("argument-of-warp-speed"), tl.warp, PLATE, speed=3)
    rejected(wording("transform-has-to-have-one-of"), tl.warp, PLATE, transform={"turn": 30})
    rejected(wording("no-center"), tl.warp, PLATE, transform={"translate": (1, 0, 0), "center": (0, 0, 0)})
    rejected(wording("rotate-is-far"), tl.warp, PLATE, transform={"rotate": "far"})
    rejected(wording("16-finite-numbers"), tl.warp, PLATE, transform=[1, 2, 3])
    rejected(wording("no-boundary-part-7"), tl.warp, PLATE, transform={"rotate": 30}, moved=7)
    rejected(wording("run-untangle-mesh-first"), tl.warp, DATA / "bracket-tangled.vtu", transform={"rotate": 30})
    nowhere = np.full((tl.read(PLATE).GetNumberOfPoints(), 3), np.nan)
    rejected(wording("nan-or-infinite-at-179"), tl.warp, PLATE, nowhere)
    rejected(wording("regions-are"), tl.warp, PLATE, transform={"rotate": 1}, regions="region")
    rejected("mirrors", tl.warp, PLATE, transform=np.diag([-1.0, 1, 1, 1]))


def test_curved():
    """Nodes of curved cells follow: affine motions are exact, and validity holds for the whole cell."""
    mesh = quadratic_square(6, 0.08)
    x = points(mesh)
    d = np.column_stack([0.3 * x[:, 0] + 0.2 * x[:, 1], -0.5 * x[:, 0], 0 * x[:, 0]])
    for method in ("femwarp", "inverse distance", "radial basis", "weighted laplacian", "automatic"):
        moved = tl.warp(mesh, displacement=d, method=method)
        assert moved.inverted == 0 and np.abs(moved.displacement - d).max() < 1e-10, method
    # A node in the middle of an edge of the boundary goes beyond a quarter of it.
    push = np.zeros_like(x)
    push[1, 0] = 0.05
    folded = tl.warp(mesh, displacement=push, method="femwarp")
    assert folded.inverted == 1 == (folded.validity == -1).sum() == tl.quality(folded).inverted
    rejected(wording("inverted-or-degenerate-before-anything-moves"), tl.warp, folded, transform={"rotate": 10})


def test_command():
    output, table = OUT / "warped.vtu", OUT / "warped.csv"
    text = shell("warp", PLATE, "--rotate", 30, "-o", output, "--csv", table)
    assert wording("all-1913-elements-are-valid") in text, text
    moved = tl.read(output)
    assert (points(moved) == points(tl.warp(PLATE, transform={"rotate": 30}).mesh)).all()
    with open(table, encoding="utf-8") as lines:
        rows = list(csv.DictReader(lines))
    assert rows[0]["stage"] == "warp" and rows[-1]["inverted"] == "0"
    options = ("-o", OUT / "back.vtu", "--method", "femwarp", "--coefficients", "1,2,1")
    assert wording("as-the-same-mesh") in shell("warp", output, "--target", PLATE, *options)
    shell("warp", PLATE, "--bend", 60, "--moved", "1,2", "--direction", "0,1,0", "-o", OUT / "bent.vtu")
    shell("warp", PLATE, "-o", output, code=2)
    assert "translate" in shell("warp", PLATE, "--translate", "1", "-o", output, code=1)


run_tests(globals())
