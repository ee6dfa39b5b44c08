# SPDX-License-Identifier: BSD-3-Clause
"""test_solve_on_ranks.py PVBATCH: any number of pieces on 1 to 4 MPI ranks gives the same numbers; needs mpirun.

Solve PDE, Condition Estimator and Solver Study, on pieces with and without ghost cells, cut in three ways.
"""

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
ENVIRONMENT = dict(os.environ, OMPI_MCA_btl_vader_single_copy_mechanism="none", OMP_NUM_THREADS="1",
                   OMPI_MCA_mpi_yield_when_idle="1")
CLOSE, CONDITION_CLOSE = 1e-8, 1e-4
SECONDS = 250
INNER = 4**3


def run(ranks: int) -> dict:
    file = OUT / f"solve_on_ranks_{ranks}.json"
    file.unlink(missing_ok=True)
    command = [MPIRUN, "--oversubscribe", "--bind-to", "none", "-np", str(ranks), sys.argv[1], "--sym"]
    done = subprocess.run([*command, str(HERE / "solve_on_ranks.py"), str(file)], env=ENVIRONMENT, timeout=SECONDS,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)  # fmt: skip
    assert file.exists(), done.stdout
    assert "ERR|" not in done.stdout, done.stdout
    return json.loads(file.read_text())


def far(a, b) -> float:
    """The largest difference, of the largest value."""
    a, b = np.asarray(a), np.asarray(b)
    assert a.shape == b.shape, (a.shape, b.shape)
    return float(np.abs(a - b).max() / np.abs(b).max())


one = run(1)
expected = one["slabs, 1 pieces, ghosts 0"]
assert expected["unknowns"] == [INNER] * 3 and max(expected["solution"]) > 1
assert min(expected["condition"]) > 1.5 and abs(sum(expected["shares"]) - 1) < 1e-6
assert expected["study"]["N converged"] == [1, 1, 1] and min(expected["study"]["N iterations"][:2]) > 2
for ranks in (1, 2, 3, 4):
    found = one if ranks == 1 else run(ranks)
    assert found["ranks"] == ranks and found["points"] == one["points"]
    cases = {name: case for name, case in found.items() if "pieces" in name}
    assert len(cases) == 6 * len({1, max(1, ranks - 1), ranks, 2 * ranks + 1}), list(cases)
    worst = dict.fromkeys(("solution", "gradient", "condition", "shares"), 0.0)
    for name, case in cases.items():
        for key in worst:
            worst[key] = max(worst[key], far(case[key], expected[key]))
            limit = CLOSE if key in ("solution", "gradient") else CONDITION_CLOSE
            assert far(case[key], expected[key]) <= limit, (ranks, name, key, far(case[key], expected[key]))
        assert case["unknowns"] == expected["unknowns"], (ranks, name, case["unknowns"])
        study = case["study"]
        assert study["N converged"] == [1, 1, 1], (ranks, name, study)
        # Jacobi's preconditioner is the same on any ranks; multigrid is not.
        assert study["N iterations"][0] == expected["study"]["N iterations"][0], (ranks, name, study)
        assert far(study["N condition"][:1], expected["study"]["N condition"][:1]) <= CONDITION_CLOSE, (ranks, name)
    print(ranks, "ranks:", len(cases), "divisions, largest differences", worst)
