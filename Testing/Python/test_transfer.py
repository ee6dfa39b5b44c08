# SPDX-License-Identifier: BSD-3-Clause
"""The function transfer and its command: totals, bounds, arrays, meshes that differ, errors."""

import csv

import numpy as np
import tautline as tl
from checks import DATA, OUT, points, rejected, run_tests, shell, square, wording
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet

BRACKET = DATA / "bracket.vtu"


def with_fields(mesh):
    """A mesh with point arrays u and mark, and cell arrays c and region."""
    x, y = points(mesh)[:, :2].T
    cells = np.arange(mesh.GetNumberOfCells(), dtype=float)
    for data, name, values in (
        (mesh.GetPointData(), "u", np.sin(3 * x) + y),
        (mesh.GetPointData(), "mark", (x > 0.5).astype(np.int32)),
        (mesh.GetCellData(), "c", np.column_stack([np.sin(cells), cells])),
        (mesh.GetCellData(), "region", (cells > cells.mean()).astype(np.int32) + 5),
    ):
        array = numpy_to_vtk(values, deep=True)
        array.SetName(name)
        data.AddArray(array)
    return mesh


def test_totals():
    source = with_fields(square(9))
    result = tl.transfer(square(7), source)
    assert result.total_error < 1e-12 and result.largest_excess == 0
    assert np.isclose(result.source_covered, 1) and np.isclose(result.target_covered, 1)
    assert [(row["array"], row["data"], row["component"]) for row in result.totals] == [
        ("u", "point", 0), ("c", "cell", 0), ("c", "cell", 1)]  # fmt: skip
    for row in result.totals:
        assert np.isclose(row["total_after"], row["total_before"], rtol=1e-12, atol=1e-12)
        assert row["minimum_before"] <= row["minimum_after"] <= row["maximum_after"] <= row["maximum_before"]
        assert row["beyond_bounds"] == 0
    x, y = points(result.mesh)[:, :2].T
    assert abs(result.point_data["u"] - np.sin(3 * x) - y).max() < 0.02
    assert set(result.point_data["mark"]) == {0, 1} and result.point_data["mark"].dtype == np.int32
    assert set(result.cell_data["region"]) == {5, 6} and result.cell_data["c"].shape == (98, 2)
    assert result.table() == result.totals and "total" in result.summary
    # The total is the integral over the elements: of squares, the mean.
    assert np.isclose(result.totals[2]["total_after"], np.arange(162).mean())
    assert np.isclose(result.cell_data["c"][:, 1].mean(), np.arange(162).mean())


def test_options():
    source = with_fields(square(9))
    chosen = tl.transfer(square(7), source, point_arrays=["u"])
    assert list(chosen.point_data) == ["u"] and not list(chosen.cell_data)
    assert list(tl.transfer(square(7), source, cell_arrays=("c", "region")).cell_data) == ["c", "region"]
    linear = tl.transfer(square(7), source, cell_order="linear")
    assert linear.total_error < 1e-12 and (linear.cell_data["c"] != tl.transfer(square(7), source).cell_data["c"]).any()
    near = tl.transfer(square(7), source, "interpolate")
    assert set(near.cell_data["c"][:, 1]) <= set(range(162)) and near.source_covered == 0
    corner = [0, 7, 56, 63]
    assert np.allclose(near.point_data["u"][corner], source.GetPointData().GetArray("u").GetTuple1(0) + np.array(
        [0, np.sin(3), 1, 1 + np.sin(3)]))  # fmt: skip
    # Arrays that the target has are replaced, or not.
    again = tl.transfer(chosen, source, replace_arrays=False)
    assert (again.point_data["u"] == chosen.point_data["u"]).all() and "c" in again.cell_data
    one, many = (tl.transfer(square(7), source, threads=threads) for threads in (1, 4))
    assert (one.point_data["u"] == many.point_data["u"]).all() and one.summary == many.summary


def test_meshes():
    """Meshes of a part in space, blocks, and boundaries that differ."""
    result = tl.transfer(tl.perturb(BRACKET), with_fields(tl.read(BRACKET)))
    assert result.total_error < 1e-12, result.summary
    blocks = vtkMultiBlockDataSet()
    for i in range(2):
        block = square(4 + i)
        half = points(block) * (0.5, 1, 1) + (0.5 * i, 0, 0)
        points(block)[:] = half
        blocks.SetBlock(i, block)
    both = tl.transfer(blocks, with_fields(square(9)))
    assert both.total_error < 1e-12
    for i, n in enumerate((25, 36)):
        assert both.mesh.GetBlock(i).GetPointData().GetArray("u").GetNumberOfTuples() == n
    smaller = square(7)
    points(smaller)[:] *= (0.9, 1, 1)
    kept = tl.transfer(smaller, with_fields(square(9)), point_arrays=["u"])
    assert kept.total_error < 1e-12 and kept.largest_excess >= 0 and np.isclose(kept.source_covered, 0.9)
    free = tl.transfer(smaller, with_fields(square(9)), point_arrays=["u"], keep_total=False)
    assert free.total_error > 1e-3 and free.largest_excess == 0


def test_rejected():
    source = with_fields(square(5))
    rejected("nothing", tl.transfer, square(4), source, point_arrays=["nothing"])
    rejected("point_arrays", tl.transfer, square(4), source, point_arrays=[])
    rejected("cell_order", tl.transfer, square(4), source, cell_order="cubic")
    rejected("method", tl.transfer, square(4), source, "guess")
    far = square(4)
    points(far)[:] += 3
    rejected(wording("the-meshes-do-not-overlap"), tl.transfer, far, source)
    rejected(wording("the-source-is-a-volume"), tl.transfer, square(4), BRACKET)
    rejected("order 1", tl.transfer, square(4), tl.curve(square(2), 2))
    odd = with_fields(square(5))
    odd.GetPointData().GetArray("u").SetTuple1(2, np.inf)
    rejected(wording("1-values-of-the-point-array-u"), tl.transfer, square(4), odd, point_arrays=["u"])


def test_shell():
    source, target, out, totals = (OUT / f"transfer-{name}" for name in ("s.vtu", "t.vtu", "o.vtu", "totals.csv"))
    tl.write(with_fields(square(6)), source)
    tl.write(square(5), target)
    printed = shell("transfer", target, source, "--cell-order", "linear", "-o", out, "--csv", totals)
    assert "total" in printed and str(out) in printed
    assert list(tl.read(out).GetPointData().GetArray("u").GetRange())
    with open(totals, encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [row["array"] for row in rows] == ["u", "c", "c"] and rows[0]["total_before"]
    shell("transfer", target, source, "--point-arrays", "u,mark", "--no-keep-total", "-o", out)
    assert not tl.read(out).GetCellData().GetNumberOfArrays()
    assert "nothing" in shell("transfer", target, source, "--cell-arrays", "nothing", "-o", out, code=1)


run_tests(globals())
