# SPDX-License-Identifier: BSD-3-Clause
"""test_warp_on_ranks.py PVBATCH: on 1 to 4 MPI ranks Warp Mesh moves points to the same places; skipped without mpirun.

Over time steps, and to targets in other pieces; no rank gets the whole mesh.
"""

import numpy as np
from on_ranks import run_with_output
from wording import wording

CLOSE = 1e-10
MATCHED = {
    "same mesh": "as the same mesh, point by point: ", "numbers": "by point ids: ",
    "boundary": ": 98 of 98 points of the boundary",  # in the order of the mesh, also on one rank
}  # fmt: skip
POINTS = 125


def run(ranks: int) -> dict:
    found, text = run_with_output("warp_on_ranks.py", ranks)
    assert text.count("prescribed points are NaN or infinite") >= ranks, text
    assert found.pop("ranks") == ranks and found.pop("rejected") == 0
    return found


one = run(1)
start = np.asarray(one["steps, First time step, 0, slabs"]["points"])
for name, case in one.items():
    points = np.asarray(case["points"])
    assert points.shape == (POINTS, 3), (name, points.shape)
    assert np.abs(points - start).max() > 0.05 or ", 0, " in name, name
    assert MATCHED.get(name.split(",")[0], "") in case["summary"], (name, case["summary"])
for ranks in (1, 2, 3, 4):
    found = run(ranks) if ranks > 1 else one
    farthest = 0.0
    assert found.keys() == one.keys()
    for name, case in found.items():
        expected = one[name if name == "after" else ", ".join([*name.split(", ")[:-1], "slabs"])]
        far = np.abs(np.asarray(case["points"]) - np.asarray(expected["points"])).max()
        assert far <= CLOSE, (ranks, name, far)
        assert case["inverted"] == 0 and (
            name.split(",")[0] in (*MATCHED, "target") or wording("put-together") not in case["summary"]
        ), (ranks, name, case["summary"])
        how = MATCHED.get(name.split(",")[0], "")
        assert how in case["summary"], (ranks, name, case["summary"])
        farthest = max(farthest, far)
    print(ranks, "ranks: farthest", farthest, "in", len(found), "cases")
