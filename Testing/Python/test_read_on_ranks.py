# SPDX-License-Identifier: BSD-3-Clause
"""test_read_on_ranks.py PVBATCH: MPI ranks share a file and compute what one rank does; skipped without mpirun."""

from pathlib import Path

import numpy as np
from on_ranks import run

DATA = Path(__file__).parents[2] / "Data"
CLOSE = 1e-10

one = run("read_on_ranks.py", 1, str(DATA))
for ranks in (1, 2, 3):
    found = one if ranks == 1 else run("read_on_ranks.py", ranks, str(DATA))
    assert found["ranks"] == ranks
    for name in ("cube.1.ele", "part.msh", "cylinder.msh", "house.off"):
        assert found[name]["parts"] == ranks, (name, found[name])
        assert found[name]["cells"] == one[name]["cells"], (name, ranks)
        assert abs(found[name]["mean"] - one[name]["mean"]) < CLOSE * one[name]["mean"], (name, ranks)
    far = np.abs(np.array(found["optimized"]) - np.array(one["optimized"])).max()
    print(ranks, "ranks: farthest point", far)
    assert far < CLOSE
