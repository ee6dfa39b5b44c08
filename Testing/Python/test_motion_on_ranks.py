# SPDX-License-Identifier: BSD-3-Clause
"""test_motion_on_ranks.py PVBATCH: on 1 to 4 MPI ranks points move to the same places; skipped without mpirun."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np

MPIRUN = shutil.which("mpirun")
if not MPIRUN:
    print("there is no mpirun")
    sys.exit(77)
HERE, OUT = Path(__file__).parent, Path(os.environ["TAUTLINE_TEST_DIR"])
# As root, too, and wherever processes may not read each other's memory.
ENVIRONMENT = dict(os.environ, OMPI_MCA_btl_vader_single_copy_mechanism="none", OMP_NUM_THREADS="1")
CLOSE = 1e-10
SECONDS = 150


def run(ranks: int) -> dict:
    file = OUT / f"motion_on_ranks_{ranks}.json"
    file.unlink(missing_ok=True)
    command = [MPIRUN, "--oversubscribe", "--bind-to", "none", "-np", str(ranks), sys.argv[1]]
    done = subprocess.run([*command, str(HERE / "motion_on_ranks.py"), str(file)], env=ENVIRONMENT, timeout=SECONDS,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)  # fmt: skip
    assert file.exists(), done.stdout
    assert "ERR|" not in done.stdout, done.stdout
    return json.loads(file.read_text())


one = run(1)
assert one["ranks"] == 1
history = one["optimize 0"]["history"]
assert len(history) > 3 and history[-1] < 0.9 * history[0], history
assert one["untangle 0"]["inverted"][0] > one["untangle 0"]["inverted"][1]
for ranks in (1, 2, 3, 4):
    found = one if ranks == 1 else run(ranks)
    assert found["ranks"] == ranks
    for name in ("optimize", "slide", "untangle"):
        expected = one[f"{name} 0"]
        for cut in (0, 1):
            case = found[f"{name} {cut}"]
            far = np.abs(np.array(case["points"]) - np.array(expected["points"])).max()
            assert far <= CLOSE, (ranks, name, cut, far)
            assert case["inverted"] == expected["inverted"], (ranks, name, cut)
            for column in ("history", "mean"):
                assert case.get(column) == expected.get(column), (ranks, name, cut, column)
            print(ranks, "ranks:", name, "slabs" if cut == 0 else "at random", "farthest", far)
