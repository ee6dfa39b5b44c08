# SPDX-License-Identifier: BSD-3-Clause
"""The functions quality and metrics, meshes given as arguments, errors."""

import json

import numpy as np
import tautline as tl
from checks import DATA, OUT, rejected, run_tests, wording
from tautline._tables import quality_text
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet
BRACKET, TANGLED, PLATE = (DATA / f"{name}.vtu" for name in ("bracket", "bracket-tangled", "plate"))
ROOT3 = 3**0.5
TET = np.array([[0, 0, 0], [1, 0, 0], [0.5, ROOT3 / 2, 0], [0.5, ROOT3 / 6, (2 / 3) ** 0.5]])
ONE = (TET, [[0, 1, 2, 3]])
SQUARE = [[0, 0], [1, 0], [1, 1], [0, 1]]


def snapshot(mesh):
    fields = [mesh.GetPointData(), mesh.GetCellData()]
    names = [[f.GetArrayName(i) for i in range(f.GetNumberOfArrays())] for f in fields]
    cells = vtk_to_numpy(mesh.GetCells().GetConnectivityArray()).tobytes()
    return vtk_to_numpy(mesh.GetPoints().GetData()).tobytes(), cells, names, mesh.GetMTime()


def test_quality():
    result = tl.quality(ONE, ["imr", "mean_ratio", "scaled_jacobian"])
    assert abs(result.values["imr"][0] - 1) < 1e-14 and abs(result.values["mean_ratio"][0] - 1) < 1e-14
    assert list(result.values) == list(result.statistics) == ["imr", "mean_ratio", "scaled_jacobian"]
    assert result.validity.tolist() == [1] and result.inverted == 0 and result.notice == ""
    assert result.angles["count"].tolist() == [0, 0, 6, 0, 0], "all dihedral angles are 70.5 degrees"
    facts = result.statistics["imr"]
    assert facts["worst_cells"].tolist() == [0] and np.allclose(facts["worst_positions"], [TET.mean(axis=0)])
    assert result.mesh.GetCellData().GetArray("imr") is not None

    result = tl.quality(TANGLED, ["imr", "rr"], histogram_bins=7)
    validity, values = result.validity, result.values["imr"]
    assert result.inverted == np.count_nonzero(validity == -1) == np.count_nonzero(values < 0) == 41
    facts = result.statistics["imr"]
    measured = values[abs(validity) == 1]  # the valid and the inverted elements
    assert facts["measured"] == len(measured) == result.distribution["imr"]["count"].sum()
    assert len(result.distribution["rr"]["value"]) == 7
    assert np.isclose(facts["mean"], measured.mean(), rtol=1e-13)
    assert np.isclose(facts["standard_deviation"], measured.std(), rtol=1e-12)
    assert facts["maximum"] == measured.max() and facts["minimum"] == measured.min() < 0
    assert facts["worst"] == facts["worst_values"][0] == values[facts["worst_cells"][0]] < 0
    assert len(facts["worst_cells"]) == 10 and facts["worst_positions"].shape == (10, 3)
    assert result.worst.GetNumberOfPoints() == 20
    sine = tl.quality(TANGLED, "scaled_jacobian").statistics["scaled_jacobian"]
    assert sine["worst"] == sine["minimum"] < 0, "larger is better: the minimum is the worst"
    one = tl.quality(TANGLED, ["imr", "rr"], threads=1)
    assert all((one.values[name] == result.values[name]).all() for name in one.values)


def test_histogram():
    result = tl.quality(TANGLED, ["imr", "mean_ratio"], histogram_bins=8)
    values = result.values["imr"][result.validity == 1]
    bins = result.histogram["imr"]
    assert bins["from"][1] == 1 and bins["to"][8] == 3, "the acceptable range"
    assert bins["count"].sum() == len(values) and bins["count"][-1] == np.count_nonzero(values > 3 + 3e-12) > 0
    for row in range(1, 8):
        inside = (values >= bins["from"][row]) & (values < bins["to"][row])
        assert bins["count"][row] == np.count_nonzero(inside), row
    outside = result.statistics["mean_ratio"]["outside_acceptable"]
    assert result.histogram["mean_ratio"]["count"][0] == outside - result.inverted > 0


def test_criteria():
    limits = {"ideal": 1, "good": 1.5, "warn": 3, "fail": 10, "worst": 100}
    mine = {"criteria": [{"metric": "imr", "limits": {"all": limits}}]}
    result = tl.quality(TANGLED, "rr", criteria=mine)
    values = result.values["imr"]
    bad = (result.validity != 1) | (values > 10)
    warned = ~bad & (values > 3)
    assert (result.grades == np.where(bad, 2, np.where(warned, 1, 0))).all()
    assert result.verdict == "failed" and warned.any()
    places = np.interp(values, list(limits.values()), [0, 0.25, 0.5, 0.75, 1])
    assert np.allclose(result.indices, np.where(result.validity == 1, places, 1), rtol=0, atol=1e-14)
    assert abs(result.index - result.indices.mean()) < 1e-14
    facts = result.criteria["imr"]
    valid = result.validity == 1
    assert facts["graded"] == valid.sum() and facts["failed"] == (bad & valid).sum()
    assert facts["warning"] == warned.sum() and facts["passed"] == facts["graded"] - facts["failed"] - facts["warning"]
    one = tl.quality(TANGLED, "rr", criteria=mine, threads=1)
    assert (one.indices == result.indices).all() and one.index == result.index
    # Without criteria nothing is graded.
    plain = tl.quality(TANGLED)
    assert plain.verdict is plain.index is plain.grades is plain.indices is None and plain.criteria == {}
    assert not plain.mesh.GetCellData().HasArray("Grade")
    # A preset as it is, changed, and from a file.
    preset = tl.criteria("fem")
    assert tl.quality(BRACKET, criteria="fem").index == tl.quality(BRACKET, criteria=preset).index
    for criterion in preset["criteria"]:
        criterion["limits"] = {"triangle": next(iter(criterion["limits"].values()))}
    none = tl.quality(BRACKET, criteria=preset)
    assert none.verdict == "none" and (none.grades == -1).all(), "limits for triangles only"
    file = OUT / "criteria.json"
    file.write_text(json.dumps(mine))
    assert tl.quality(TANGLED, criteria=file).index == result.index
    rejected(wording("did-you-mean-fem"), tl.criteria, "fam")
    rejected(wording("neither-a-file-that-can-be-read"), tl.quality, ONE, criteria="absent.json")
    rejected(wording("not-valid-json"), tl.quality, ONE, criteria="{")
    rejected(wording("cannot-be-written-as-json"), tl.quality, ONE, criteria={"name": float("nan")})
    rejected(wording("no-key-limit"), tl.quality, ONE, criteria={"limit": 1})


def folded_tetrahedron(c: float):
    """A quadratic tetrahedron with the middle node of edge 1 2 at (c, c, 0): the smallest determinant is 4 c - 1."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
    middles = [(corners[a] + corners[b]) / 2 for a, b in ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))]
    middles[1] = np.array([c, c, 0])
    return np.array([*corners, *middles]), {"tetra10": [list(range(10))]}


def test_curved():
    """The whole curved cell is measured, and what the integration points miss is counted."""
    result = tl.quality(folded_tetrahedron(0.24), ["mean_ratio", "min_jacobian"], checks="all")
    facts = result.statistics["mean_ratio"]
    assert result.validity.tolist() == [-1] and abs(result.values["min_jacobian"][0] + 0.04) < 1e-7, result.values
    assert result.values["mean_ratio"][0] < 0, result.values
    missed = (facts["curved"], facts["missed_at_corners"], facts["missed_at_integration_points"])
    assert missed == (1, 0, 1), missed
    assert len(result.checks) == 13 and result.checks["calculix_jacobian"][0] > 0, result.checks
    assert result.checks["jacobian_ratio"][0] < 0 and result.checks["midnode_angle"][0] > 0, result.checks
    # The worst element is shown where the determinant is smallest: on the edge, whose places have z = 0.
    x, y, z = facts["worst_positions"][0]
    assert z == 0 and 0 <= x <= 1 and 0 <= y <= 1, facts["worst_positions"]
    worst = tl.quality(folded_tetrahedron(0.4), "mean_ratio", combination="worst").values["mean_ratio"][0]
    mean = tl.quality(folded_tetrahedron(0.4), "mean_ratio").values["mean_ratio"][0]
    assert 0 < worst < mean < 1, (worst, mean)
    text = quality_text(tl.quality(folded_tetrahedron(0.24), checks="distortion"))
    assert "distortion" in text and "at all integration points: 1" in text, text
    # Presets have criteria of checks.
    graded = tl.quality(folded_tetrahedron(0.3), criteria="nastran_solids")
    assert graded.criteria["midnode_angle"]["warning"] == 1 and graded.verdict == "warning", graded.criteria
    assert list(graded.checks) == ["midnode_angle"] and tl.quality(ONE).checks == {}
    rejected(wording("there-is-no-check-jacobi"), tl.quality, ONE, checks="jacobi")


def test_targets():
    assert abs(tl.quality(ONE, "mu_size", size=2**0.5 / 12).values["mu_size"][0]) < 1e-12, "its own volume"
    twice = tl.quality(ONE, "mu_size", size=[2**0.5 / 6])
    assert twice.values["mu_size"][0] > 0.1
    assert twice.mesh.GetCellData().GetNumberOfArrays() == 2, "the target is not left behind"
    flat = (TET * [1, 1, 0.25], ONE[1])
    assert tl.quality(flat, "mu_shape").values["mu_shape"][0] > 0.5
    assert abs(tl.quality(flat, "mu_shape", reference=flat).values["mu_shape"][0]) < 1e-12
    assert abs(tl.quality(flat, "mu_shape", tensor=[[1, 1, 16, 0, 0, 0]]).values["mu_shape"][0]) < 1e-12
    rejected(wording("only-one-target"), tl.quality, ONE, size=1, reference=ONE)
    rejected(wording("size-is-not-given"), tl.quality, ONE, target="size")
    rejected(wording("target-is-tensor-but-size"), tl.quality, ONE, target="tensor", size=1)
    rejected(wording("no-array-h"), tl.quality, ONE, "mu_size", size="h")
    rejected(wording("3-rows-there-are-1-cells-and"), tl.quality, ONE, "mu_size", size=[1, 2, 3])


def test_inputs():
    mesh = tl.read(BRACKET)
    points = vtk_to_numpy(mesh.GetPoints().GetData())
    cells = vtk_to_numpy(mesh.GetCells().GetConnectivityArray()).reshape(-1, 4)
    expected = tl.quality(str(BRACKET)).values["imr"]
    for given in (mesh, BRACKET, (points, cells), (points, {"tet": cells}), tl.perturb(mesh, 0)):
        assert (tl.quality(given).values["imr"] == expected).all()
    half = len(cells) // 2
    blocks = vtkMultiBlockDataSet()
    for i, part in enumerate((cells[:half], cells[half:])):
        blocks.SetBlock(i, tl.from_arrays(points, part))
    assert (tl.quality(blocks).values["imr"] == expected).all()

    quad = tl.from_arrays(SQUARE, [[0, 1, 2, 3]])
    assert quad.GetCellType(0) == 9 and tl.quality(quad, "size").values["size"][0] == 1
    mixed = {"quad": [[0, 1, 2, 3]], "triangle": [[1, 4, 2]]}
    assert tl.quality(([*SQUARE, [2, 0.5]], mixed), "size").values["size"].tolist() == [1, 0.5]
    cube = [[x, y, z] for z in (0, 1) for x, y in SQUARE]
    assert abs(tl.quality((cube, [list(range(8))])).values["imr"][0] - 1) < 1e-14
    assert tl.from_arrays(np.float32(TET), ONE[1]).GetPoints().GetDataType() == 10  # VTK_FLOAT
    assert tl.quality((np.zeros((0, 3)), {})).values["imr"].size == 0
    assert len(tl.quality(PLATE).validity) == tl.read(PLATE).GetNumberOfCells() == 1913


def test_input_untouched():
    mesh = tl.read(BRACKET)
    before = snapshot(mesh)
    tl.quality(mesh, ["imr", "mu_size"], size=1.0)
    tl.quality(mesh, reversed_mesh="flip output")
    moved = tl.perturb(mesh, fixed=np.zeros(mesh.GetNumberOfPoints()), tangle=0.01)
    tl.compare(mesh, moved)
    assert snapshot(mesh) == before
    mirrored = tl.from_arrays(TET * [-1, 1, 1], ONE[1])
    before = snapshot(mirrored)
    assert "reversed" in tl.quality(mirrored, reversed_mesh="flip output").notice
    assert snapshot(mirrored) == before
    assert tl.quality(mirrored).inverted == 0 and tl.quality(mirrored, reversed_mesh="measure as given").inverted == 1


def test_metrics():
    facts = tl.metrics()
    assert [f["number"] for f in facts] == list(range(len(facts))) and len(facts) >= 38
    imr = facts[0]
    assert imr["name"] == "imr" and imr["dimensions"] == [2, 3] and imr["acceptable_3d"] == (1, 3)
    assert imr["ideal_2d"] == 1 and imr["barrier"] is True and imr["unit"] == "" and len(imr["cell_types"]) == 6
    for f in facts:  # every name and alias can be used
        for name in (f["name"], f["label"], *f["aliases"]):
            assert list(tl.quality(ONE, name).values) == [f["name"]], name


def test_errors():
    rejected(wording("no-metric-nope"), tl.quality, ONE, "nope")
    rejected(wording("no-metric-is-chosen"), tl.quality, ONE, [])
    rejected(wording("by-its-name-not-3"), tl.quality, ONE, [3])
    rejected(wording("combination-is-sum-there-are-mean-worst"), tl.quality, ONE, combination="sum")
    rejected(wording("power-is-0"), tl.quality, ONE, power=0)
    rejected(wording("not-int"), tl.quality, 3)
    rejected("m x 3 or 4", tl.quality, (SQUARE, [[0, 1, 2, 3, 0]]))
    rejected(wording("use-the-points-0-to-9-there"), tl.quality, (TET, [[0, 1, 2, 9]]))
    rejected(wording("whole-numbers-are-expected"), tl.quality, (TET, [[0.0, 1, 2, 3]]))
    rejected(wording("there-are-no-cells-line"), tl.quality, (TET, {"lime": [[0, 1]]}))
    rejected("n x 2 or n x 3", tl.quality, (np.zeros((4, 4)), [[0, 1, 2]]))
    rejected(wording("points-are-not-an-array-of-numbers"), tl.quality, (["a", "b"], [[0, 1, 2]]))


def dihedral_angles(corners):
    """The six angles of tetrahedra, in degrees, n x 6, of corners n x 4 x 3, from the normals of the faces."""
    outward = []
    for i in range(4):
        a, b, c = (corners[:, j] for j in range(4) if j != i)
        normal = np.cross(b - a, c - a)
        normal *= -np.sign(np.sum(normal * (corners[:, i] - a), axis=1))[:, None]
        outward.append(normal / np.linalg.norm(normal, axis=1)[:, None])
    pairs = [(i, j) for i in range(4) for j in range(i)]
    return np.degrees([np.arccos(-np.sum(outward[i] * outward[j], axis=1)) for i, j in pairs]).T


def verdict(mesh, kind: str, metric: str):
    """The values of ParaView's and VTK's Mesh Quality, of the elements of one type."""
    from vtkmodules.vtkFiltersVerdict import vtkMeshQuality

    quality = vtkMeshQuality()
    getattr(quality, f"Set{kind}QualityMeasureTo{metric}")()
    quality.SetInputData(mesh)
    quality.Update()
    return vtk_to_numpy(quality.GetOutput().GetCellData().GetArray("Quality"))


def test_verdict():
    """The rows "verdict" of Plugin/Site/coming-from.md."""
    from vtkmodules.vtkCommonCore import vtkVersion

    mesh = tl.read(BRACKET)
    points = vtk_to_numpy(mesh.GetPoints().GetData())
    corners = points[vtk_to_numpy(mesh.GetCells().GetConnectivityArray()).reshape(-1, 4)]
    smallest = dihedral_angles(corners).min(axis=1)
    ours = tl.quality(mesh, "min_angle").values["min_angle"]
    assert np.abs(ours - smallest).max() < 1e-9
    if vtkVersion.GetVTKVersion().startswith("9.2."):
        theirs = verdict(mesh, "Tet", "MinAngle")
        differs = np.abs(theirs - ours)
        assert (np.count_nonzero(differs > 1e-3), len(ours)) == (2375, 8140)
        assert 55.5 < differs.max() < 56 and theirs.max() > 81 > 70.53 > ours.max()
    same = {
        "Tet": ["ScaledJacobian", "Condition", "MeanRatio", "RadiusRatio"],
        "Triangle": ["ScaledJacobian", "Condition", "RadiusRatio", "MinAngle"],
        "Quad": ["ScaledJacobian", "MinAngle", "Condition"],
    }
    names = {"ScaledJacobian": "scaled_jacobian", "Condition": "condition_number", "MeanRatio": "mean_ratio",
             "RadiusRatio": "rr_normalized", "MinAngle": "min_angle"}  # fmt: skip
    for kind, metrics in same.items():
        mesh = tl.read(BRACKET if kind == "Tet" else PLATE)
        chosen = vtk_to_numpy(mesh.GetCellTypesArray()) == {"Tet": 10, "Triangle": 5, "Quad": 9}[kind]
        for metric in metrics:
            worst = (kind, metric) == ("Quad", "Condition")
            result = tl.quality(mesh, names[metric], combination="worst" if worst else "mean")
            expected = verdict(mesh, kind, metric)[chosen]
            assert np.allclose(result.values[names[metric]][chosen], expected, rtol=1e-9), (kind, metric)


def square_sum(matrix):
    return np.sum(matrix * matrix)


def test_mfem():
    """The metrics of the rows "MFEM" of Plugin/Site/coming-from.md, by the formulas of MFEM's tmop.hpp."""
    jacobian = np.array([[1.1, 0.2, -0.1], [0.1, 0.9, 0.15], [-0.2, 0.1, 1.2]])
    for dimension in (2, 3):
        t = jacobian[:dimension, :dimension]
        det, inverse, norm, gram = np.linalg.det(t), np.linalg.inv(t), square_sum(t), square_sum(t.T @ t)
        shape_size, size = square_sum(t - inverse.T), 0.5 * (det**2 + det**-2) - 1
        if dimension == 2:
            expected = {"mu_2": 0.5 * norm / det - 1, "mu_7": shape_size, "mu_9": det * shape_size,
                        "mu_50": 0.5 * gram / det**2 - 1, "mu_58": gram / det**2 - 2 * norm / det + 2,
                        "mu_77": size}  # fmt: skip
        else:
            both = norm * square_sum(inverse)
            expected = {"mu_301": both**0.5 / 3 - 1, "mu_302": both / 9 - 1, "mu_303": norm / 3 / det ** (2 / 3) - 1,
                        "mu_304": norm**1.5 / 27**0.5 / det - 1, "mu_318": size, "mu_321": shape_size,
                        "mu_322": square_sum(t - det * inverse.T) / 6 / det,
                        "mu_323": norm**1.5 - 27**0.5 * (np.log(det) + 1)}  # fmt: skip
        corners = TET[: dimension + 1, :dimension] @ t.T
        for name, value in expected.items():
            found = list(tl.quality((corners, [list(range(dimension + 1))]), name).values.values())[0][0]
            assert abs(found - value) < 1e-12, (name, found, value)


run_tests(globals())
