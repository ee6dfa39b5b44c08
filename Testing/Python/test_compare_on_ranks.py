# SPDX-License-Identifier: BSD-3-Clause
"""test_compare_on_ranks.py PVBATCH: on 2, 3 and 4 MPI ranks Compare Meshes finds what it finds on one.

Skipped without mpirun. The two meshes are cut alike or otherwise.
"""

import numpy as np
from on_ranks import run_with_output
from wording import wording

COUNTS = ("Better", "Worse", "Equal", "InvertedBefore", "InvertedAfter")


def close(found, expected, where: str) -> None:
    a, b = np.asarray(found, dtype=float), np.asarray(expected, dtype=float)
    assert a.shape == b.shape and np.allclose(a, b, rtol=1e-11, atol=1e-13), (where, np.abs(a - b).max())


def check_table(found: dict, expected: dict, where: str) -> None:
    assert found.keys() == expected.keys(), (where, found.keys())
    for name, column in expected.items():
        if name in COUNTS:
            assert found[name] == column, (where, name, found[name], column)
        else:
            close(found[name], column, f"{where}, {name}")


one, text = run_with_output("compare_on_ranks.py", 1)
assert text.count("ERR|") == 2, text
cases = [case for case, value in one.items() if isinstance(value, list) and len(value) == 4]
assert len(cases) == 31, cases
# Something has happened.
for case in cases:
    cells, points, table, summary = one[case]
    changed = np.asarray(cells)[:, 2]
    assert (changed > 0).any() and (changed < 0).any() or case == "unmoved", case
    assert (np.asarray(points)[:, :3] != 0).any() or case == "unmoved", case
    tangled = any(word in case for word in ("tangled", "mixed", "two", "several"))
    assert (table["InvertedBefore"][0] > 0) == tangled, (case, summary)
    assert wording("put-together") not in summary, summary
for ranks in (2, 3, 4):
    found, text = run_with_output("compare_on_ranks.py", ranks)
    for case in cases:
        where = f"{ranks} ranks, {case}"
        cells, points, table, summary = found[case]
        expected = one[case]
        close(cells, expected[0], where)
        close(points, expected[1], where)
        check_table(table, expected[2], where)
        assert summary == expected[3], (where, summary)
        assert found[f"cells {case}"] == found[f"cells of {case}"], where
        # With ghost cells random pieces of so few cells have nearly all.
        if case not in ("alike random 1", "tree, random with ghosts", "random, one rank"):
            assert max(found[f"cells {case}"]) < len(cells), (where, found[f"cells {case}"])
    alike, ghosts = found["generated ids"]
    check_table(ghosts[0], alike[0], f"{ranks} ranks, generated ids")
    assert ghosts[1] == alike[1] and alike[0]["Worse"][0] > 100, (alike, ghosts)
    check_table(found["blocks"][0], one["blocks"][0], f"{ranks} ranks, blocks")
    assert found["blocks"][1] == one["blocks"][1], found["blocks"][1]
    check_table(found["more blocks"][0], one["more blocks"][0], f"{ranks} ranks, more blocks")
    # An error on all ranks, and none waits.
    for case in ("order", "cells", "no ids", "copies"):
        assert found[f"rejected {case}"] == [0, ""], found[f"rejected {case}"]
    print(ranks, "ranks:", found["slabs, tree"][3].splitlines()[0])
