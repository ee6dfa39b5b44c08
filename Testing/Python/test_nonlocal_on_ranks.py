# SPDX-License-Identifier: BSD-3-Clause
"""test_nonlocal_on_ranks.py PVBATCH: on MPI ranks Horizon Neighbors and Interaction Layer find what they find on one.

Skipped without mpirun.
"""

import numpy as np
from on_ranks import run_with_output

CLOSE = 1e-9
REJECTIONS = {
    "cells that are not triangles (quadrilateral)": 2, "lists point 100000": 2, "the horizon must be above 0": 1,
    "the width of the interaction layer is": 1, "The time limit of 0.2 s is reached": 1, "no area": 1,
}  # fmt: skip


def close(found, expected, where: str) -> None:
    a, b = np.asarray(found, dtype=float), np.asarray(expected, dtype=float)
    assert a.shape == b.shape, (where, a.shape, b.shape)
    assert np.allclose(a, b, rtol=CLOSE, atol=CLOSE), (where, np.abs(a - b).max())


def triangles_of(case: list) -> list:
    """Numbers, cases and areas of the triangles with the places of their corners."""
    points = np.asarray(case["points"])
    names = [name for name in ("Case", "CellId", "Area", "ChordArea", "Missed") if name in case]
    corners = points[np.asarray(case["cells"]).reshape(-1, 3)].reshape(-1, 9)
    return np.column_stack([*(case[name] for name in names), corners])


one, text = run_with_output("nonlocal_on_ranks.py", 1)
for problem, times in REJECTIONS.items():
    assert text.count(problem) == times, (problem, text)
for case, value in one.items():
    if case.startswith("horizon"):
        triangles, circle, pieces = value
        assert len(triangles["Case"]) > 20 and len(circle["points"]) == 256, case
        assert case == "horizon all" or set(triangles["Case"]) >= {1, 2, 3}, case
        assert case == "horizon all" or len(pieces["Case"]) > len(triangles["Case"]) - 10, case
    if case.startswith("layer"):
        kinds = np.asarray(value[0])[:, 0]
        assert (kinds == 1).sum() > 200 and (kinds == 2).sum() > 100, case
for ranks in (2, 3, 4):
    found, text = run_with_output("nonlocal_on_ranks.py", ranks)
    for case, expected in one.items():
        where = f"{ranks} ranks, {case}"
        if case == "horizon several":
            # Without ids the points of several pieces of a rank stay apart, and the cells have another order.
            close(sorted(found[case][0]["Area"]), sorted(expected[0]["Area"]), where)
        elif case.startswith("horizon"):
            for port in (0, 2):
                assert found[case][port].keys() == expected[port].keys(), where
                for name in ("Case", "CellId"):
                    assert found[case][port][name] == expected[port][name], (where, name)
                assert len(found[case][port]["points"]) == len(expected[port]["points"]), where
                close(triangles_of(found[case][port]), triangles_of(expected[port]), where)
            close(found[case][1]["points"], expected[1]["points"], where)
        elif case.startswith("layer"):
            close(found[case][0], expected[0], where)
            assert found[case][1] == expected[1] or case == "layer inclined", (where, "points")
        elif case.startswith("counts"):
            total = np.asarray(found[case]).sum(axis=0)
            assert total.tolist() == expected[0], (where, found[case], expected)
            assert case == "counts two ranks" or len(found[case]) == ranks, (where, found[case])
            assert (np.asarray(found[case])[:, 1] > 0).all(), (where, found[case])
        elif case.startswith("rejected"):
            assert found[case] == expected == 0, where
    for problem, times in {**REJECTIONS, "Several cells have the global id 0": 2}.items():
        assert text.count(problem) == times * ranks, (ranks, problem, text)
