# SPDX-License-Identifier: BSD-3-Clause
"""test_partitions_on_ranks.py PVBATCH: what three MPI ranks have saved in pieces is the same mesh on 1, 2 and 3 ranks;
skipped without mpirun.

Blocks in pieces (.vtm), a collection of partitions (.vtpc), surfaces (.pvtp), a time series and the iterations of an
animation, in numbers; what ranks do not have, and the names of elements, blocks and processes in messages.
"""

import re
import shutil

import numpy as np
from on_ranks import OUT, run, run_with_output
from wording import wording

FOLDER = OUT / "partitions-on-ranks"
CLOSE = 1e-9
EXPECTED = 200  # values of all cases together, at least
CELLS = 6 * 4**3

shutil.rmtree(FOLDER, ignore_errors=True)
FOLDER.mkdir(parents=True)
run("partitions_on_ranks.py", 3, str(FOLDER), "write")


def figures(summary: str) -> str:
    """The first lines of a summary without times, and without what depends on where the mesh is."""
    lines = [line for line in summary.splitlines() if "put together" not in line and "coincident" not in line]
    return re.sub(r"[0-9.e-]+ s\b|element [^()]*\(| of \d+ points|Seconds:.*", "", "\n".join(lines))


def check_messages(found: dict, text: str, ranks: int) -> None:
    assert len(found["size"]) == CELLS and np.ptp(found["size"]) > 0.1, (ranks, found["size"][:9])
    worst, names = found["worst"], re.findall(r"element (\d+) of block (\d+)(?: of process (\d+))? \(", found["names"])
    assert len(names) == 3, (ranks, found["names"])
    for i, (cell, block, process) in enumerate(names):
        there = [int(worst[key][i]) for key in ("Cell", "Block", "Process", "Partition")]
        assert there == [int(cell), int(block), int(process or 0), 0], (ranks, names, there)
    assert {int(block) for _, block, _ in names} <= {1, 2} and (ranks == 1) == (names[0][2] == ""), (ranks, names)
    assert wording("worst-element-with-global-id") in found["global names"], (ranks, found["global names"])
    # The rank that has no such array is named, and the block.
    for name in ("MeshOptimizer", "MeshPerturbation", "MeshImprover"):
        for kind in ("blocks", "collection", "grid"):
            assert found[f"lacking {kind} {name}"] == 0, (ranks, kind, name)
    missing = [line for line in text.splitlines() if "There is no point array 'stay' of fixed points" in line]
    assert len(missing) == 9 * ranks, (ranks, len(missing), text)
    blocks = [line for line in missing if "In block 2: " in line]
    assert len(blocks) == 6 * ranks, (ranks, missing)
    if ranks > 1:
        last = ranks - 1
        for line in missing:
            assert f"in process {last}: choose" in line or f"In process {last}: There" in line, (ranks, line)


one: dict = {}
for ranks in (1, 2, 3):
    found, text = run_with_output("partitions_on_ranks.py", ranks, str(FOLDER))
    errors = [line for line in text.splitlines() if "ERR|" in line and wording("there-is-no-point-array") not in line]
    assert not errors, (ranks, errors)
    assert wording("seam-between-blocks-is-a-boundary") not in text, (ranks, text)
    check_messages(found, text, ranks)
    one = one or found
    assert found.keys() == one.keys(), (ranks, set(found) ^ set(one))
    count = 0
    for key, value in found.items():
        if key.endswith(" summary"):
            a, b = figures(value), figures(one[key])
            assert a.split("\n")[0].split(".")[0] == b.split("\n")[0].split(".")[0], (ranks, key, value, one[key])
        elif isinstance(value, list):
            a, b = np.asarray(value, float), np.asarray(one[key], float)
            assert a.shape == b.shape and len(a) > 1, (ranks, key, a.shape, b.shape)
            assert np.abs(a - b).max() < CLOSE, (ranks, key, np.abs(a - b).max())
            count += a.size
    assert count > EXPECTED, (ranks, count)
    # Something has happened.
    moved = np.asarray(found["blocks.vtm perturbed"]) - np.asarray(found["blocks.vtm optimized"])
    assert np.abs(moved).max() > 0.01 and len(moved) == 2 * 5**3, ranks
    assert np.abs(np.asarray(found["iteration 0"]) - np.asarray(found["iteration 1000"])).max() > 0.01, ranks
    assert np.abs(np.asarray(found["iteration 1"]) - np.asarray(found["iteration 3"])).max() > 1e-4, ranks
    assert np.abs(np.asarray(found["series warped 0"]) - np.asarray(found["series warped 2"])).max() > 0.1, ranks
    print(ranks, "ranks:", count, "values;", found["names"].splitlines()[-1])
