# SPDX-License-Identifier: BSD-3-Clause
"""test_read_on_ranks.py PVBATCH: MPI ranks share a file and compute what one rank does; skipped without mpirun."""

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
DATA = HERE.parent.parent / "Data"
# As root, too, and wherever processes may not read each other's memory.
ENVIRONMENT = dict(os.environ, OMPI_MCA_btl_vader_single_copy_mechanism="none", OMP_NUM_THREADS="1")
CLOSE = 1e-10
SECONDS = 150


def run(ranks: int) -> dict:
    file = OUT / f"read_on_ranks_{ranks}.json"
    file.unlink(missing_ok=True)
    command = [MPIRUN, "--oversubscribe", "--bind-to", "none", "-np", str(ranks), sys.argv[1]]
    done = subprocess.run([*command, str(HERE / "read_on_ranks.py"), str(file), str(DATA)], env=ENVIRONMENT,
                          timeout=SECONDS, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)  # fmt: skip
    assert file.exists(), done.stdout
    assert "ERR|" not in done.stdout, done.stdout
    return json.loads(file.read_text())


one = run(1)
for ranks in (1, 2, 3):
    found = one if ranks == 1 else run(ranks)
    assert found["ranks"] == ranks
    for name in ("cube.1.ele", "part.msh", "cylinder.msh", "house.off"):
        assert found[name]["parts"] == ranks, (name, found[name])
        assert found[name]["cells"] == one[name]["cells"], (name, ranks)
        assert abs(found[name]["mean"] - one[name]["mean"]) < CLOSE * one[name]["mean"], (name, ranks)
    far = np.abs(np.array(found["optimized"]) - np.array(one["optimized"])).max()
    print(ranks, "ranks: farthest point", far)
    assert far < CLOSE
