# SPDX-License-Identifier: BSD-3-Clause
"""The function metric and its command: sources, targets, limits, what takes the tensors, errors."""

import numpy as np
import tautline as tl
from checks import DATA, OUT, points, rejected, run_tests, shell, square, wording
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet, vtkUnstructuredGrid

BRACKET = DATA / "bracket.vtu"


def front(mesh) -> np.ndarray:
    x, y = points(mesh)[:, :2].T
    return np.tanh(10 * (x - 0.4 * y - 0.3))


def sizes(tensors: np.ndarray) -> np.ndarray:
    """The sizes along the principal axes, n x 3, the largest one first."""
    xx, yy, zz, xy, yz, xz = np.asarray(tensors).T
    matrices = np.moveaxis(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]), -1, 0)
    return 1 / np.sqrt(np.linalg.eigvalsh(matrices))


def test_hessian():
    mesh = square(20)
    result = tl.metric(mesh, field=front(mesh), target_value=4000)
    assert abs(result.elements / 4000 - 1) < 0.011 and result.tensors.shape == (21 * 21, 6)
    assert np.isclose(result.elements, 4 / np.sqrt(3) * result.complexity)
    found = sizes(result.tensors)
    assert np.isclose(found.min(), result.smallest_size) and np.isclose(found.max(), result.largest_size)
    assert np.isclose((found[:, 0] / found[:, 2]).max(), result.anisotropy) and result.anisotropy > 3
    assert result.point_data["Metric"].shape == result.tensors.shape
    assert list(result.point_data) == ["Metric"]
    assert wording("complexity-of-the-metric") in result.summary
    # A finer target halves the sizes.
    finer = tl.metric(mesh, field=front(mesh), target_value=16000, gradation=0)
    coarser = tl.metric(mesh, field=front(mesh), target_value=4000, gradation=0)
    assert 1.5 < coarser.smallest_size / finer.smallest_size < 2.5
    # The larger norm has larger sizes away from the front, and smaller ones at it.
    plain, worst = (sizes(tl.metric(mesh, field=front(mesh), norm=norm, gradation=0).tensors) for norm in (1, np.inf))
    away, close = abs(front(mesh)) > 0.999, abs(front(mesh)) < 0.8
    assert worst[away, 2].mean() > 2 * plain[away, 2].mean() and worst[close, 2].mean() < plain[close, 2].mean()
    projected = tl.metric(mesh, field=front(mesh), recovery="double projection")
    assert abs(projected.elements / 10000 - 1) < 0.011
    # For an error, sizes go with its root.
    x = points(mesh)
    for norm, error in ((np.inf, 1e-3), (0, 1e-5)):
        each = tl.metric(mesh, field=(x**2).sum(axis=1), norm=norm, target="error", target_value=error, gradation=0)
        assert np.isclose(each.smallest_size, np.sqrt(3 * error), rtol=1e-4), each.smallest_size


def test_taken():
    """Functions that take metric tensors take the array: targets, and lengths of edges."""
    mesh = square(12)
    metric = tl.metric(mesh, field=front(mesh), target_value=600)
    before = tl.quality(metric, "mu_shape_size", target="tensor", tensor="Metric")
    assert np.isfinite(before.values["mu_shape_size"]).all() and before.inverted == 0
    moved = tl.optimize(metric, objectives=["mu_shape_size"], tensor="Metric", boundary="sliding")
    after = tl.quality(moved, "mu_shape_size", target="tensor", tensor="Metric")
    assert after.values["mu_shape_size"].mean() < before.values["mu_shape_size"].mean()
    assert tl.optimize(metric, tensor="Metric").summary
    assert tl.improve(metric, "aggressive", edge_length="Metric").elements > 0
    solid = tl.metric(BRACKET)
    assert tl.improve(solid, edge_length="Metric").elements > 0
    assert tl.quality(solid, "mu_size", tensor="Metric").values["mu_size"].max() > 0


def test_sources():
    mesh = square(10)
    uniform = tl.metric(mesh, sizes=np.full(121, 0.05))
    assert np.allclose(sizes(uniform.tensors), 0.05) and np.isclose(uniform.complexity, 400)
    same = tl.metric(mesh, sizes=uniform.tensors, array_name="Again")
    assert np.allclose(same.tensors, uniform.tensors) and "Again" in same.point_data
    nine = uniform.tensors[:, [0, 3, 5, 3, 1, 4, 5, 4, 2]]
    assert np.allclose(tl.metric(mesh, sizes=nine).tensors, uniform.tensors)
    layers = tl.metric(mesh, "distance", wall_size=0.01, tangential_ratio=5, gradation=0)
    found = sizes(layers.tensors)
    assert np.isclose(found.min(), 0.01) and np.isclose(layers.anisotropy, 5, rtol=0.01)
    distance = points(mesh)[:, 0]
    given = tl.metric(mesh, distance=distance, wall_size=0.01, wall_growth=1.5, gradation=0)
    assert np.allclose(sizes(given.tensors)[:, 2], np.minimum(0.01 + 0.5 * distance, given.largest_size))
    marked = tl.metric(mesh, "distance", wall=(distance == 0).astype(int), wall_size=0.01, wall_growth=1.5, gradation=0)
    assert np.allclose(marked.tensors, given.tensors)
    # Curvature: of flat parts none; a smaller chord error, smaller sizes.
    assert np.allclose(sizes(tl.metric(mesh).tensors), tl.metric(mesh).largest_size)
    rough, close = (tl.metric(BRACKET, chord_error=error) for error in (0.05, 0.0125))
    assert close.smallest_size < rough.smallest_size
    # Two sources: no size is larger than in either.
    both = tl.metric(layers, field=front(mesh), target_value=2000, intersect_with="Metric", gradation=0)
    assert (sizes(both.tensors)[:, 2] <= found[:, 2] * (1 + 1e-6)).all()


def test_limits():
    mesh = square(15)
    limited = tl.metric(mesh, field=front(mesh), smallest_size=0.04, largest_size=0.1, largest_anisotropy=2)
    assert limited.smallest_size >= 0.04 * (1 - 1e-9) and limited.largest_size <= 0.1 * (1 + 1e-9)
    assert limited.anisotropy <= 2 * (1 + 1e-9)
    assert wording("is-not-reached-it-is") in limited.summary
    # Sizes of neighbors, without directions, differ by the logarithm of the factor times the distance.
    given = np.full(256, 0.5)
    given[0] = 0.01
    graded = sizes(tl.metric(mesh, sizes=given, gradation=1.3, largest_size=1).tensors)[:, 2]
    distance = np.linalg.norm(points(mesh), axis=1)
    assert (graded >= 0.01 + np.log(1.3) * distance - 1e-6).all() and np.isclose(graded[0], 0.01)
    assert np.isclose(graded[15], 0.01 + np.log(1.3), rtol=1e-4)


def test_kinds_of_data():
    mesh = square(6)
    blocks = vtkMultiBlockDataSet()
    blocks.SetBlock(0, mesh)
    blocks.SetBlock(2, square(8))
    both = tl.metric(blocks, "distance")
    parts = [tl.metric(each, "distance") for each in (mesh, square(8))]
    assert np.isclose(both.elements, sum(part.elements for part in parts))
    assert (both.tensors == np.concatenate([part.tensors for part in parts])).all()
    for file in ("zoo.mesh", "plate.vtu", "cube.1.node"):
        result = tl.metric(DATA / file, "distance")
        assert (result.tensors[:, :3] > 0).all() and np.isfinite(result.tensors).all(), file
        glyphs = result.ellipsoids.GetPointData()
        assert 0 < len(set(vtk_to_numpy(glyphs.GetArray("PointId")))) <= 500, file
    one, many = (tl.metric(BRACKET, "distance", threads=threads) for threads in (1, 4))
    assert (one.tensors == many.tensors).all() and one.summary == many.summary


def test_rejected():
    mesh = square(4)
    x = np.ones(25)
    rejected("field", tl.metric, mesh, "hessian")
    rejected("sizes", tl.metric, mesh, "sizes")
    rejected(wording("an-array-for-the-source"), tl.metric, mesh, "curvature", field=x)
    rejected(wording("an-array-for-the-source"), tl.metric, mesh, field=x, sizes=x)
    rejected("nothing", tl.metric, mesh, field="nothing")
    odd = np.where(np.arange(25) == 3, np.nan, x)
    rejected(wording("values-of-the-field-are-not-finite"), tl.metric, mesh, field=odd)
    rejected(wording("sizes-are-not-positive-numbers"), tl.metric, mesh, sizes=odd)
    rejected(wording("sizes-are-not-positive-numbers"), tl.metric, mesh, sizes=-x)
    rejected(wording("sizes-are-not-positive-numbers"), tl.metric, mesh, sizes=0 * x)
    rejected(wording("metric-tensors-are-not-positive-definite"), tl.metric, mesh, sizes=np.ones((25, 6)))
    rejected(wording("the-array-of-sizes-has-3"), tl.metric, mesh, sizes=np.ones((25, 3)))
    rejected("target_value", tl.metric, mesh, field=x, target_value=0)
    rejected("target_value", tl.metric, mesh, field=x, target_value=-1)
    rejected("smallest_size", tl.metric, mesh, smallest_size=-0.1)
    rejected(wording("gradation-is-at-most-1"), tl.metric, mesh, gradation=1)
    rejected(wording("norm-is-below-1"), tl.metric, mesh, field=x, norm=0.5)
    rejected(wording("the-double-projection-takes"), tl.metric, DATA / "zoo.mesh",
            field=np.zeros(tl.read(DATA / "zoo.mesh").GetNumberOfPoints()), recovery="double projection")  # fmt: skip
    rejected(wording("cells-are-of-higher-order-run-curve"), tl.metric, tl.curve(mesh, 2))
    point = tl.from_arrays(np.zeros((3, 3)), {"triangle": [[0, 1, 2]]})
    rejected(wording("all-points-are-at-one-place"), tl.metric, point)
    broken = square(2)
    points(broken)[0, 0] = np.nan
    rejected(wording("not-a-finite-number"), tl.metric, broken)
    empty = tl.metric(vtkUnstructuredGrid())
    assert empty.elements == 0 and wording("has-no") in empty.summary


def test_command():
    source, out = OUT / "metric-field.vtu", OUT / "metric.vtu"
    mesh = square(8)
    tl.write(tl.metric(mesh, sizes=np.full(81, 0.1), array_name="size").mesh, source)
    printed = shell("metric", source, "--sizes", "size", "--largest-size", 0.05, "--gradation", 0, "-o", out)
    assert wording("complexity-of-the-metric") in printed
    tensors = vtk_to_numpy(tl.read(out).GetPointData().GetArray("Metric"))
    assert np.allclose(sizes(tensors), 0.05)
    assert "target_value" in shell("metric", source, "--target-value", 0, "-o", out, code=1)


run_tests(globals())
