# SPDX-License-Identifier: BSD-3-Clause
"""test_motion_on_ranks.py PVBATCH: on 1 to 4 MPI ranks points move to the same places; skipped without mpirun."""

import numpy as np
from on_ranks import run
from wording import wording

CLOSE = 1e-10
GLOBAL = ("L-BFGS", "Newton-CG")
DIVISIONS = {"k-d Tree": ".", "PT-Scotch": " by PT-Scotch."}  # and what the summary ends with
# Operations that gather the mesh, and the reason in the summary.
GATHERED = {
    "turned": "cells list their points in opposite orders, or only parts of it are reversed.",
    "broken": " has a coordinate that is not finite: remove its cells first, by Threshold or Clean to Grid.",
}
BROKEN = 3  # coordinates of the points that are not finite


def check_gathered(ranks: int, found: dict, one: dict) -> None:
    for name, why in GATHERED.items():
        expected = one[f"{name} slabs"]
        for cut in ("slabs", "tree", "random"):
            case = found[f"{name} {cut}"]
            points, others = np.array(case["points"]), np.array(expected["points"])
            assert np.count_nonzero(np.isnan(others)) == (BROKEN if name == "broken" else 0), name
            assert np.array_equal(np.isnan(points), np.isnan(others)), (ranks, name, cut)
            far = np.nanmax(np.abs(points - others))
            assert far <= CLOSE, (ranks, name, cut, far)
            assert case["inverted"] == expected["inverted"], (ranks, name, cut, case["inverted"])
            stated = "The mesh was put together on the first process: " in case["summary"]
            assert stated == (ranks > 1), (ranks, name, cut, case["summary"])
            assert not stated or case["summary"].endswith(why), (ranks, name, cut, case["summary"])
            # Each rank has arrays of the same types: otherwise filters and files that join pieces drop them.
            assert case.get("types", []) == expected.get("types", []) * ranks, (ranks, name, cut, case.get("types"))
            print(ranks, "ranks, gathered:", name, cut, "farthest", far)


def check_copies(ranks: int, found: dict, one: dict) -> None:
    """Copies of a point that differ by rounding are one point by their ids."""
    for name in ("copies", "untangled copies"):
        expected = one[f"{name} slabs"]
        for cut in ("slabs", "tree", "random"):
            case = found[f"{name} {cut}"]
            far = np.abs(np.array(case["points"]) - np.array(expected["points"])).max()
            assert far <= CLOSE, (ranks, name, cut, far)
            assert case["inverted"] == expected["inverted"], (ranks, name, cut, case["inverted"])
            stated = "copies with the same global id that are up to " in case["summary"]
            assert stated == (ranks > 1), (ranks, name, cut, case["summary"])
            print(ranks, "ranks:", name, cut, "farthest", far)


one = run("motion_on_ranks.py", 1)
assert one["ranks"] == 1
history = one["optimize 0"]["history"]
assert len(history) > 3 and history[-1] < 0.9 * history[0], history
assert one["rescaled 0"]["inverted"][0] > one["rescaled 0"]["inverted"][1]
assert one["untangle 0"]["inverted"][0] > one["untangle 0"]["inverted"][1]
for name in GLOBAL:
    found = one[f"{name} 0"]["history"]
    assert len(found) > 3 and found[-1] < 0.9 * found[0], (name, found)
assert one["turned slabs"]["types"][0]["Validity"] == "signed char", one["turned slabs"]["types"]
for ranks in (1, 2, 3, 4):
    found = one if ranks == 1 else run("motion_on_ranks.py", ranks)
    assert found["ranks"] == ranks
    check_gathered(ranks, found, one)
    check_copies(ranks, found, one)
    for name in ("optimize", *DIVISIONS, "slide", "rescaled", "untangle", *GLOBAL):
        expected = one["optimize 0" if name in DIVISIONS else f"{name} 0"]
        for cut in (0, 1):
            case = found[f"{name} {cut}"]
            by = DIVISIONS.get(name, ".")
            divided = f"The mesh was {wording('redistributed')} among {ranks} processes{by}" in case["summary"]
            assert divided == (name in DIVISIONS and ranks > 1), (ranks, name, cut, case["summary"])
            far = np.abs(np.array(case["points"]) - np.array(expected["points"])).max()
            assert far <= CLOSE, (ranks, name, cut, far)
            assert case["inverted"] == expected["inverted"], (ranks, name, cut)
            for column in ("history", "mean") if name not in DIVISIONS else ():
                # The sums of sweeps are the same bit by bit.
                some, others = case.get(column, []), expected.get(column, [])
                same = np.allclose(some, others, rtol=CLOSE, atol=0) if name in GLOBAL else some == others
                assert len(some) == len(others) and same, (ranks, name, cut, column)
            print(ranks, "ranks:", name, "slabs" if cut == 0 else "at random", "farthest", far)
