# SPDX-License-Identifier: BSD-3-Clause
"""test_solve_on_ranks.py PVBATCH: any number of pieces on 1 to 4 MPI ranks gives the same numbers; needs mpirun.

Solve PDE, Condition Estimator and Solver Study, on pieces with and without ghost cells, cut in three ways, and with the
mesh redistributed among the ranks.
"""

import numpy as np
from on_ranks import run

CLOSE, CONDITION_CLOSE = 1e-8, 1e-4
EXACT = 1e-10  # of numbers that each element has by itself
INNER = 4**3


def far(a, b) -> float:
    """The largest difference, of the largest value."""
    a, b = np.asarray(a), np.asarray(b)
    assert a.shape == b.shape, (a.shape, b.shape)
    return float(np.abs(a - b).max() / np.abs(b).max())


one = run("solve_on_ranks.py", 1, symmetric=True)
expected = one["slabs, 1 pieces, ghosts 0"]
assert expected["unknowns"] == [INNER] * 3 and max(expected["solution"]) > 1
assert min(expected["condition"]) > 1.5 and abs(sum(expected["shares"]) - 1) < 1e-6
assert expected["study"]["N converged"] == [1, 1, 1] and min(expected["study"]["N iterations"][:2]) > 2
for ranks in (1, 2, 3, 4):
    found = one if ranks == 1 else run("solve_on_ranks.py", ranks, symmetric=True)
    assert found["ranks"] == ranks and found["points"] == one["points"]
    cases = {name: case for name, case in found.items() if "pieces" in name}
    divided = 6 * len({1, ranks, 2 * ranks + 1})
    assert len(cases) == 6 * len({1, max(1, ranks - 1), ranks, 2 * ranks + 1}) + 12 + divided, list(cases)
    limits = {"solution": CLOSE, "gradient": CLOSE, "condition": CONDITION_CLOSE, "shares": CONDITION_CLOSE,
              "eigenvalues": EXACT, "excess": EXACT}  # fmt: skip
    worst = dict.fromkeys(limits, 0.0)
    for name, case in cases.items():
        for key, limit in limits.items():
            worst[key] = max(worst[key], far(case[key], expected[key]))
            assert far(case[key], expected[key]) <= limit, (ranks, name, key, far(case[key], expected[key]))
        assert case["unknowns"] == expected["unknowns"], (ranks, name, case["unknowns"])
        assert case["divided"] == [int(ranks > 1 and "redistribution" in name)] * 3, (ranks, name, case["divided"])
        study = case["study"]
        assert study["N converged"] == [1, 1, 1], (ranks, name, study)
        # Jacobi's preconditioner is the same on any ranks; multigrid is not.
        assert study["N iterations"][0] == expected["study"]["N iterations"][0], (ranks, name, study)
        assert far(study["N condition"][:1], expected["study"]["N condition"][:1]) <= CONDITION_CLOSE, (ranks, name)
    curved = {name: case for name, case in found.items() if name.startswith("quadratic")}
    assert len(curved) == 18, list(curved)
    known = one["quadratic, slabs, False, 0"]
    assert known["unknowns"] == 5**3 and len(known["solution"]) == 7**3
    for name, case in curved.items():
        assert case["unknowns"] == known["unknowns"], (ranks, name, case["unknowns"])
        apart = far(case["solution"], known["solution"])
        assert apart <= CLOSE, (ranks, name, apart)
    functions = [name for name in found if name.startswith("function")]
    assert len(functions) == 6, functions
    for name in functions:
        assert far(found[name], expected["solution"]) <= CLOSE, (ranks, name, far(found[name], expected["solution"]))
    print(ranks, "ranks:", len(cases), "divisions, largest differences", worst)
