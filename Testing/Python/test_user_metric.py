# SPDX-License-Identifier: BSD-3-Clause
"""Metrics of the user: a numpy function, and a compiled library (argument 1), in Python and in the shell."""

import json
import os
import subprocess
import sys

import numpy as np
import tautline as tl
from checks import DATA, OUT, rejected, run_tests, wording
from vtkmodules.util.numpy_support import vtk_to_numpy

LIBRARY = sys.argv[1]
PLATE, BRACKET = DATA / "plate.vtu", DATA / "bracket.vtu"


def longest(corners, cell_type):
    """The longest distance of two corners."""
    differences = corners[:, :, None, :] - corners[:, None, :, :]
    return np.sqrt((differences**2).sum(axis=3)).max(axis=(1, 2))


def corners_of(mesh, cells):
    points = np.array([mesh.GetPoint(i) for i in range(mesh.GetNumberOfPoints())])
    return [points[[mesh.GetCell(c).GetPointId(k) for k in range(mesh.GetCell(c).GetNumberOfPoints())]] for c in cells]


def test_register():
    calls = []

    def function(corners, cell_type):
        calls.append((cell_type, corners.shape))
        return longest(corners, cell_type)

    number = tl.register_metric("longest", function, label="Longest distance", formula="max |p - q|", unit="length",
                                acceptable=(0, 0.3))  # fmt: skip
    assert number == 300445941, "the number follows from the name, in every session"
    # Tried on two cells of each type as they are, and turned.
    assert [(name, shape) for name, shape in calls[::2]] == [
        ("triangle", (2, 3, 3)), ("quadrilateral", (2, 4, 3)), ("tetrahedron", (2, 4, 3)), ("hexahedron", (2, 8, 3)),
        ("wedge", (2, 6, 3)), ("pyramid", (2, 5, 3))] and calls[1::2] == calls[::2], calls  # fmt: skip
    facts = {facts["name"]: facts for facts in tl.metrics()}
    assert facts["longest"]["label"] == "Longest distance" and facts["longest"]["number"] == number
    assert facts["longest"]["cell_types"][0] == "triangle" and facts["longest"]["dimensions"] == [2, 3]
    for mesh in (PLATE, BRACKET):
        calls.clear()
        result = tl.quality(mesh, ["imr", "longest"])
        cells = sum(shape[0] for _, shape in calls)
        assert len({name for name, _ in calls}) == len(calls), "once for all cells of a type"
        assert cells == result.mesh.GetNumberOfCells(), (cells, calls)
        some = range(0, result.mesh.GetNumberOfCells(), 7)
        expected = [longest(p[None], "") for p in corners_of(result.mesh, some)]
        assert np.allclose(result.values["longest"][some], np.ravel(expected), rtol=1e-12)
        statistics = result.statistics["longest"]
        assert statistics["maximum"] == statistics["worst"] == result.values["longest"].max()
        assert np.isclose(statistics["mean"], result.values["longest"].mean(), rtol=1e-12)
        array = result.mesh.GetCellData().GetArray("longest")
        assert array.GetRange() == (statistics["minimum"], statistics["maximum"])
    same = tl.quality(PLATE, "Longest distance")  # by its label
    assert list(same.values) == ["longest"]
    comparison = tl.compare(PLATE, PLATE, "longest")
    assert "longest" in str(comparison.__dict__)
    field = tl.metric_field("longest")
    assert field is not None
    limits = {"all": {"ideal": 0, "good": 1e-6, "warn": 1e-5, "fail": 1e-4, "worst": 1}}
    text = json.dumps({"name": "long", "criteria": [{"metric": "longest", "weight": 1, "limits": limits}]})
    graded = tl.quality(PLATE, "imr", criteria=text)
    assert graded.verdict == "failed" and "longest" in graded.values


def shape(corners, cell_type):
    """The inverse mean ratio; infinite for flat and inverted elements."""
    edges = (corners[:, 1:] - corners[:, :1]).transpose(0, 2, 1)
    if cell_type == "triangle":
        ideal = np.array([[1, 0.5], [0, np.sqrt(0.75)]])
        edges = edges[:, :2]
    else:
        ideal = np.array([[1, 0.5, 0.5], [0, np.sqrt(0.75), np.sqrt(1 / 12)], [0, 0, np.sqrt(2 / 3)]])
    T = edges @ np.linalg.inv(ideal)
    n = T.shape[1]
    determinant = np.linalg.det(T)
    found = np.full(len(T), np.inf)
    valid = determinant > 0
    found[valid] = (T[valid] ** 2).sum(axis=(1, 2)) / (n * determinant[valid] ** (2 / n))
    return found


def moved(mesh, matrix):
    """The mesh with its points multiplied by a matrix from the right."""
    copy = mesh.NewInstance()
    copy.DeepCopy(mesh)
    places = vtk_to_numpy(copy.GetPoints().GetData())
    places[:] = places @ matrix
    return copy


def test_optimized():
    """A metric of Python as an objective gives the same minimum as the built-in one that it copies."""
    tl.register_metric("my_shape", shape, cell_types=["triangle", "tetrahedron"], scale_invariant=True,
                       full=(1, np.inf), ideal=1.0)
    for domain, cells in (("disk2d", 300), ("disk3d", 600)):
        mesh = tl.perturb(tl.domain(domain, cells), fraction=0.6, seed=3).mesh
        options = dict(optimizer="l-bfgs", relative_change=1e-9, maximum_iterations=300)
        built_in = tl.optimize(mesh, "custom", objectives="imr", **options)
        ours = tl.optimize(mesh, "custom", objectives="my_shape", **options)
        first, last = (np.array(ours.history["objective"])[[0, -1]], np.array(built_in.history["objective"])[[0, -1]])
        assert np.allclose(first, last, rtol=1e-6), (domain, first, last)
        assert first[1] < 0.95 * first[0] and ours.inverted == 0, (domain, first)
        # Turned out of the plane, and seen in a mirror, which lists the corners the other way round.
        turned = moved(mesh, np.array([[0.6, 0, 0.8], [0, 1, 0], [-0.8, 0, 0.6]]) * (1, 1, -1))
        again = tl.optimize(turned, "custom", objectives="my_shape", **options)
        assert np.allclose(np.array(again.history["objective"])[[0, -1]], first, rtol=1e-6), domain
        automatic = tl.optimize(mesh, "custom", objectives="my_shape", relative_change=1e-9)
        assert np.isclose(automatic.history["objective"][-1], first[1], rtol=1e-6)
        both = tl.optimize(mesh, "custom", objectives=["my_shape", "size"], scalarization="equal sum", **options)
        assert both.history["objective"][-1] < both.history["objective"][0]
    for rejection in (dict(optimizer="local newton"), dict(optimizer="newton-cg"), dict(improve_worst=0.01),
                    dict(limits=0.1)):
        rejected(wording("without-derivatives-of-its-own"), tl.optimize, mesh, "custom", objectives="my_shape",
                **rejection)
    tl.unregister_metric("my_shape")


def test_replaced_and_removed():
    tl.register_metric("constant", lambda corners, cell: np.ones(len(corners)))
    assert (tl.quality(PLATE, "constant").values["constant"] == 1).all()
    tl.register_metric("constant", lambda corners, cell: np.full(len(corners), 2.0))
    assert (tl.quality(PLATE, "constant").values["constant"] == 2).all()
    tl.register_metric("constant", lambda corners, cell: np.full(len(corners), np.nan) if len(corners) > 2 else
                       np.zeros(len(corners)))  # fmt: skip
    assert (tl.quality(PLATE, "constant").values["constant"] == 0).all(), "what is not finite becomes 0"
    tl.unregister_metric("constant")
    rejected(wording("there-is-no-metric-constant"), tl.quality, PLATE, "constant")
    rejected(wording("no-metric-constant-was-registered"), tl.unregister_metric, "constant")


def test_only_some_cells():
    tl.register_metric("flat_only", lambda p, cell: np.full(len(p), 3.0), cell_types=["triangle", "quadrilateral"])
    assert (tl.quality(PLATE, "flat_only").values["flat_only"] == 3).all()
    assert (tl.quality(BRACKET, "flat_only").values["flat_only"] == 0).all()


def test_rejected():
    def fails(corners, cell_type):
        raise KeyError("no such thing")

    ones = lambda corners, cell: np.ones(len(corners))  # noqa: E731
    rejected(wording("there-is-a-metric-imr"), tl.register_metric, "imr", ones)
    rejected(wording("cannot-be-the-name"), tl.register_metric, "My metric", ones)
    rejected(wording("a-function-is-expected"), tl.register_metric, "mine", 3)
    rejected(wording("keyerror-no-such-thing"), tl.register_metric, "mine", fails)
    rejected(wording("values-of-shape-3-2-is-expected"), tl.register_metric, "mine", lambda p, cell: np.ones(3))
    rejected(wording("could-not-convert"), tl.register_metric, "mine", lambda p, cell: ["a"] * len(p))
    rejected(wording("not-finite-on-a-valid"), tl.register_metric, "mine", lambda p, cell: np.full(len(p), np.inf))
    rejected(wording("did-you-mean-triangle"), tl.register_metric, "mine", ones, cell_types=["triangel"])
    rejected(wording("did-you-mean-larger-is-better"), tl.register_metric, "mine", ones, direction="larger is beter")
    rejected(wording("depends-on-the-scale"), tl.register_metric, "mine", longest, scale_invariant=True)
    rejected(wording("set-rotation-invariant-to-false"), tl.register_metric, "mine", lambda p, cell: p[:, 0, 0])
    assert not any(facts["name"] == "mine" for facts in tl.metrics())
    # A function that fails later: an error of the filter, and the next mesh is measured.
    wrong = {"now": False}
    tl.register_metric("sometimes", lambda p, cell: p[:, 0, 5] if wrong["now"] else np.ones(len(p)))
    wrong["now"] = True
    rejected(wording("the-metric-sometimes-failed-on"), tl.quality, PLATE, "sometimes")
    wrong["now"] = False
    assert (tl.quality(PLATE, "sometimes").values["sometimes"] == 1).all()
    # Improve Mesh takes derivatives of each metric.
    if hasattr(tl, "improve"):
        rejected(wording("has-no-derivatives"), tl.improve, BRACKET, metric="sometimes")
    rejected(wording("cannot-be"), tl.load_metrics, "/nonexistent.so")


def shell(*arguments, library=LIBRARY):
    environment = {**os.environ, "TAUTLINE_METRICS": library}
    return subprocess.run([sys.executable, "-m", "tautline", *arguments], env=environment, text=True,
                          capture_output=True)  # fmt: skip


def test_library():
    run = shell("metrics", "--json")
    names = [facts["name"] for facts in json.loads(run.stdout)]
    assert names[-2:] == ["my_distortion", "longest_edge"], names
    measured = shell("quality", str(PLATE), "--metrics", "my_distortion,imr", "--json")
    assert measured.returncode == 0, measured.stderr
    assert "my_distortion" in measured.stdout
    wrong = shell("quality", str(PLATE), "--metrics", "my_distortion", library="/nonexistent.so")
    assert wrong.returncode != 0 and "TAUTLINE_METRICS" in wrong.stderr and wording("cannot-be") in wrong.stderr, wrong
    wrong = shell("metrics", library="/nonexistent.so")
    assert wrong.returncode != 0 and wording("cannot-be") in wrong.stderr

    assert tl.load_metrics(LIBRARY) == ["my_distortion", "longest_edge"]
    result = tl.quality(BRACKET, ["my_distortion", "imr", "longest_edge"])
    # |T|^2 / det^(2/3) - 3 = 3 (IMR - 1) on tetrahedra
    assert np.allclose(result.values["my_distortion"], 3 * (result.values["imr"] - 1), rtol=1e-10, atol=1e-12)
    edges = [longest(p[None], "")[0] for p in corners_of(result.mesh, range(20))]
    assert np.allclose(result.values["longest_edge"][:20], edges, rtol=1e-12)
    if hasattr(tl, "optimize"):
        moved = tl.perturb(BRACKET, fraction=0.3, seed=1)
        better = tl.optimize(moved, objectives=["my_distortion"])
        before = tl.quality(moved, "my_distortion").values["my_distortion"]
        after = tl.quality(better, "my_distortion").values["my_distortion"]
        assert (after**2).sum() < 0.5 * (before**2).sum(), ((before**2).sum(), (after**2).sum())


def test_python_file():
    file = OUT / "some_metrics.py"
    text = (
        "import numpy, tautline\n"
        "tautline.register_metric('of_file', lambda corners, cell: numpy.full(len(corners), {}))"
    )
    file.write_text(text.format(1.0), encoding="utf-8")
    assert tl.load_metrics(file) == ["of_file"]
    assert (tl.quality(PLATE, "of_file").values["of_file"] == 1).all()
    file.write_text(text.format(2.0), encoding="utf-8")
    assert tl.load_metrics(str(file)) == ["of_file"], "it is replaced"
    assert (tl.quality(PLATE, "of_file").values["of_file"] == 2).all()
    for wrong, message in (("1 / 0", "ZeroDivisionError"), ("x = (", "SyntaxError"), (text.replace("of_file", "imr"),
                           "there already is a metric 'imr'")):  # fmt: skip
        file.write_text(wrong.format(0.0), encoding="utf-8")
        rejected(message, tl.load_metrics, file)
        rejected(str(file), tl.load_metrics, file)
    rejected("nowhere.py", tl.load_metrics, OUT / "nowhere.py")
    tl.unregister_metric("of_file")


if __name__ == "__main__":
    run_tests(globals())
