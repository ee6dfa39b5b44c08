# SPDX-License-Identifier: BSD-3-Clause
"""test_quality_on_ranks.py PVBATCH: on 1, 2 and 3 MPI ranks a mesh whose cells list their points in both orders is
measured as in one piece, with one warning for the whole; skipped without mpirun.
"""

import re

import numpy as np
from on_ranks import run_with_output

CLOSE = 1e-12
CASES = ("", " ids", " ghosts", " several")
CUTS = ("slabs", "random")
FIGURE = re.compile(r"\d+ faces have neighbors that list .*? (\d+ of the \d+) cells are treated as if listed")


def warnings(text: str) -> list[str]:
    return [line for line in text.splitlines() if "vtkElementQuality" in line and "WARN|" in line]


one, text = run_with_output("quality_on_ranks.py", 1)
assert "ERR|" not in text, text
figures = set(FIGURE.findall(text))
assert len(figures) == 1, figures
reversed_cells, cells = map(int, re.findall(r"\d+", figures.pop()))
assert 0 < reversed_cells < cells == len(one["quality plain slabs"]), (reversed_cells, cells)
inverted = {kind: np.array(one[f"quality {kind} slabs"])[:, 1] == -1 for kind in ("plain", "mixed", "tangled mixed")}
assert not inverted["plain"].any() and not inverted["mixed"].any() and inverted["tangled mixed"].any()
for ranks in (1, 2, 3):
    found, text = (one, text) if ranks == 1 else run_with_output("quality_on_ranks.py", ranks)
    assert "ERR|" not in text, text
    for cut in CUTS:
        for kind in inverted:
            for case in CASES:
                where = f"quality {kind} {cut}{case}"
                a, b = np.array(found[where]), np.array(one[f"quality {kind} slabs"])
                assert a.shape == b.shape and np.allclose(a, b, rtol=CLOSE, atol=CLOSE), (ranks, where)
        for case in ("", " several"):
            movable, moved, summary = found[f"perturb {cut}{case}"]
            assert [movable, moved] == one["perturb slabs"][:2], (ranks, cut, case, summary)
            assert "overlap" not in summary, (ranks, cut, case, summary)
        if ranks > 1:
            assert len(found[f"copies {cut}"]) == cells, (ranks, cut)
            assert min(map(min, found[f"copies {cut}"])) > 0, (ranks, cut)
    # One warning for a mesh, on one rank, with the figures of the whole.
    told = [line for line in warnings(text) if "orientation" in line]
    assert len(told) == 2 * len(CUTS) * len(CASES), (ranks, len(told))
    for line in told:
        assert f"{reversed_cells} of the {cells} cells are treated" in line, (ranks, line)
    seams = [line for line in warnings(text) if " seam" in line]
    assert len(seams) == (3 * len(CUTS) if ranks == 1 else 0), (ranks, seams)
    for name in ("arrays improved", "arrays of a layer"):
        assert len(found[name]) == ranks and all(names == found[name][0] for names in found[name]), (name, found[name])
    print(ranks, "ranks:", reversed_cells, "of", cells, "cells are listed in the opposite order")
