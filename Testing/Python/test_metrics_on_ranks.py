# SPDX-License-Identifier: BSD-3-Clause
"""test_metrics_on_ranks.py PVBATCH LIBRARY: a user's metrics, compiled and of Python, give the same on 1 to 3 ranks.

Skipped without mpirun.
"""

import sys

import numpy as np
from on_ranks import ENVIRONMENT, run_with_output
from vtkmodules.vtkParallelCore import vtkDummyController, vtkMultiProcessController
from wording import wording

controller = vtkDummyController()
vtkMultiProcessController.SetGlobalController(controller)
from rank_meshes import CUTS, simplices  # noqa: E402, asks for the controller

ENVIRONMENT["TAUTLINE_METRICS"] = sys.argv[2]
CLOSE = 1e-10


def close(found, expected, where) -> None:
    a, b = np.asarray(found, dtype=float), np.asarray(expected, dtype=float)
    assert a.shape == b.shape and np.allclose(a, b, rtol=CLOSE, atol=1e-12, equal_nan=True), (where, a, b)


def check_table(found: dict, expected: dict, where) -> None:
    assert found.keys() == expected.keys() and found, (where, found.keys())
    for name, column in expected.items():
        if "ime (s)" in name or "econds" in name:
            continue
        if column and isinstance(column[0], str):
            assert found[name] == column, (where, name, found[name], column)
        else:
            close(found[name], column, (where, name))


one, text = run_with_output("metrics_on_ranks.py", 1)
assert text.count("ERR|") == 1 and wording("without-derivatives-of-its-own") in text, text
assert one["loaded"] == ["height", "slenderness"], one["loaded"]

# The values of one process equal numpy's.
places, cells = simplices(5)
inner = np.logical_and(places > 0, places < 5)
corners = (places + inner * np.random.default_rng(4).uniform(-0.3, 0.3, places.shape))[cells]
edges = np.linalg.norm(corners[:, :, None] - corners[:, None], axis=-1)
longest, shortest = edges.max(axis=(1, 2)), (edges + 1e9 * np.eye(4)).min(axis=(1, 2))
ideal = np.array([[1, 0.5, 0.5], [0, np.sqrt(3) / 2, np.sqrt(3) / 6], [0, 0, np.sqrt(2 / 3)]])
T = np.swapaxes(corners[:, 1:] - corners[:, :1], 1, 2) @ np.linalg.inv(ideal)
distortion = (T**2).sum(axis=(1, 2)) / np.linalg.det(T) ** (2 / 3) - 3
grades = set()
for cut in CUTS:
    found = np.array(one[cut]["cells"])
    valid = found[:, 4] == 1
    assert valid.sum() > 700, valid.sum()
    close(found[valid, 0], distortion[valid], cut)
    close(found[:, 1:4], np.stack([longest, corners[:, :, 2].mean(axis=1), longest / shortest], -1), cut)
    grades |= set(found[:, 5])
    history = one[cut]["history"][0]["Objective"]
    assert len(history) > 3 and history[-1] < 0.9 * history[0], history
    assert one[cut]["summary"].startswith('Failed by the criteria "own"'), one[cut]["summary"]
assert len(grades) >= 3, grades

for ranks in (2, 3):
    found, text = run_with_output("metrics_on_ranks.py", ranks)
    assert found["loaded"] == ["height", "slenderness"], found["loaded"]
    for cut in CUTS:
        case, expected, where = found[cut], one[cut], f"{ranks} ranks, {cut}"
        here = case["cells of ranks"]
        assert len(here) == ranks and sum(here) == len(cells), here
        for key in ("cells", "points"):
            close(case[key], expected[key], where)
        for key in ("tables", "history"):
            for table, other in zip(case[key], expected[key]):
                check_table(table, other, f"{where}, {key}")
        assert case["summary"] == expected["summary"], (where, case["summary"])
    ghosts, alone = found["ghosts"], one["ghosts"]
    assert sum(ghosts["cells of ranks"]) > len(cells) == sum(alone["cells of ranks"]), ghosts["cells of ranks"]
    close(ghosts["cells"], alone["cells"], f"{ranks} ranks, ghosts")
    for table, other in zip(ghosts["tables"], alone["tables"]):
        check_table(table, other, f"{ranks} ranks, ghosts")
    assert ghosts["summary"] == alone["summary"], ghosts["summary"]
    assert text.count(wording("without-derivatives-of-its-own")) == ranks, text
    # A metric that only the first process has registered: each reports it.
    for name in ("quality", "compare", "optimize", "improve"):
        assert found[f"rejected {name}"] == [0, ""], (name, found[f"rejected {name}"])
    message = "is not registered in this process. Register it in all processes of the server"
    assert text.count(message) == 4 * ranks and text.count("ERR|") == 5 * ranks, text
    assert f"process {ranks - 1} of the server cannot load the metrics: " in found["wrong"], found["wrong"]
    assert wording("not-here") in found["wrong"], found["wrong"]
    print(ranks, "ranks:", found["tree"]["summary"].splitlines()[0])
