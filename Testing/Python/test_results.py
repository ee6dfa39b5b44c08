# SPDX-License-Identifier: BSD-3-Clause
"""Results: how they print, copies, pickle, comparison, help, tables."""

import base64
import copy
import json
import pickle
import pydoc
import re
from dataclasses import fields, is_dataclass

import numpy as np
import tautline as tl
from checks import DATA, OUT, rejected, run_tests, square, wording
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet

TANGLED, PLATE = DATA / "bracket-tangled.vtu", DATA / "plate.vtu"
LINES, WIDTH = 5, 110
RESULTS = [kind for name, kind in vars(tl).items() if name.endswith("Result") and is_dataclass(kind)]


def some_results():
    """Results of several kinds of meshes: a grid, an image, blocks, none."""
    blocks = vtkMultiBlockDataSet()
    for i, n in enumerate((2, 3)):
        blocks.SetBlock(i, square(n))
    yield tl.quality(PLATE, ["imr", "rr"], criteria="fem")
    yield tl.metric_field(["imr", "si"], dimensions=(7, 4))
    yield tl.perturb(PLATE, seed=2)
    yield tl.compare(PLATE, tl.perturb(PLATE, seed=2))
    yield tl.transfer(PLATE, tl.perturb(PLATE, seed=2))
    yield tl.quality(blocks)
    yield tl.optimize(blocks)
    if hasattr(tl, "adapt"):
        yield tl.adapt(tl.domain("rectangle", cells=100), lambda mesh: mesh.points[:, 0] ** 2, 1, elements=200)
    if hasattr(tl, "solve"):
        yield tl.solve(PLATE)
        yield tl.solver_study(square(5), combinations=[1, 3])


def test_print():
    result = tl.untangle(TANGLED)
    lines = repr(result).splitlines()
    assert lines[0] == "UntangleResult: vtkUnstructuredGrid, 2343 points, 8140 cells", lines
    assert lines[1] == result.summary.splitlines()[0] and lines[-1].startswith("fields: mesh, history, validity")
    for result in some_results():
        lines = repr(result).splitlines()
        assert len(lines) <= LINES and max(map(len, lines)) <= WIDTH, lines
        assert str(result) == repr(result) and lines[-1].startswith("fields: ")
    many = repr(tl.quality(PLATE, ["imr", "rr", "size", "min_angle"])).splitlines()
    assert len(many) == LINES and many[3].endswith(" ..."), many


def test_notebook():
    """A picture of the measured mesh; a text where there is nothing to draw."""
    for result, legend in ((tl.quality(PLATE, "rr"), "Radius ratio"), (tl.perturb(PLATE), "Inverse mean ratio")):
        page = result._repr_html_()
        png = base64.b64decode(re.search(r'base64,([^"]+)"', page)[1])
        assert png.startswith(b"\x89PNG") and len(png) > 5000 and legend in page, page[:500]
        assert "class=" not in page, "layout of a report that the notebook does not have"
    assert "<img" not in tl.metric_field(dimensions=(5, 4))._repr_html_()
    assert wording("untangleresult-vtkunstructuredgrid") in tl.untangle(TANGLED)._repr_html_()


def test_copies():
    for result in some_results():
        shallow, deep, packed = copy.copy(result), copy.deepcopy(result), pickle.loads(pickle.dumps(result))
        for other in (shallow, deep, packed):
            assert other == result and type(other) is type(result), (type(result), repr(other))
            assert other.summary == result.summary if hasattr(result, "summary") else True
        if hasattr(result, "mesh"):
            assert shallow.mesh is result.mesh and deep.mesh is not result.mesh is not packed.mesh
            assert packed.mesh.GetClassName() == result.mesh.GetClassName()
    result = tl.perturb(PLATE)
    deep = copy.deepcopy(result)
    deep.mesh.GetPoints().SetPoint(3, 7.0, 0.0, 0.0)
    assert result.mesh.GetPoint(3) != (7.0, 0.0, 0.0) and deep != result
    deep = copy.deepcopy(result)
    deep.displacement[5] += 1e-12
    assert deep != result


def test_equality():
    """Runs of the same work are equal, although their times differ; others are not."""
    assert tl.optimize(PLATE) == tl.optimize(PLATE)
    assert tl.quality(PLATE) == tl.quality(PLATE)
    assert tl.quality(PLATE) != tl.quality(PLATE, "rr")
    assert tl.perturb(PLATE, seed=1) != tl.perturb(PLATE, seed=2)
    assert tl.quality(PLATE) != tl.perturb(PLATE) and tl.quality(PLATE) != 3
    nan = tl.quality(([[0, 0], [1, 0], [2, 0]], [[0, 1, 2]]))  # degenerate: nothing is measured
    assert np.isnan(nan.statistics["imr"]["worst"]) and nan == copy.deepcopy(nan)
    rejected_hash = False
    try:
        hash(nan)
    except TypeError:
        rejected_hash = True
    assert rejected_hash


def test_help():
    """help() names and explains every field; no field is explained that there is not."""
    assert len(RESULTS) >= 12, RESULTS
    for kind in RESULTS:
        text = pydoc.render_doc(kind, renderer=pydoc.plaintext)
        listed = re.findall(r"^ \|  ((?:\w+, )*\w+) : \S", text, re.MULTILINE)
        explained = [name for line in listed for name in line.split(", ")]
        names = [field.name for field in fields(kind)]
        assert sorted(explained) == sorted(names), (kind, set(explained) ^ set(names))


def test_tables():
    result = tl.optimize(PLATE)
    facts = json.loads(result.to_json(OUT / "result.json"))
    assert json.loads((OUT / "result.json").read_text()) == facts
    assert facts["iterations"] == result.iterations and "mesh" not in facts and "displacement" not in facts
    assert facts["history"]["objective"] == result.history["objective"].tolist()
    result.to_csv(OUT / "result.csv")
    rows = (OUT / "result.csv").read_text().splitlines()
    assert rows[0].split(",") == list(result.history) and len(rows) == len(result.history["objective"]) + 1
    assert tl.quality(PLATE, ["imr", "rr"]).table()[1]["metric"] == "rr"
    rejected(wording("has-no-table"), tl.perturb(PLATE).to_csv, OUT / "none.csv")
    for result in some_results():
        json.loads(result.to_json())
    try:
        import pandas
    except ImportError:
        rejected(wording("pandas-is-not-installed"), result.to_pandas)
        return
    frame = tl.optimize(PLATE).to_pandas()
    assert isinstance(frame, pandas.DataFrame) and list(frame["iteration"]) == list(range(len(frame)))


run_tests(globals())
