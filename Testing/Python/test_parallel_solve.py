# SPDX-License-Identifier: BSD-3-Clause
"""test_parallel_solve.py PVBATCH: pvbatch on 1, 2 and 4 MPI ranks finds the same numbers; skipped without mpirun."""

import numpy as np
from on_ranks import run_with_output
from wording import wording

CLOSE = 1e-8
ROUNDING = 1e-12


def run(ranks: int) -> dict:
    found, text = run_with_output("parallel_solve.py", ranks)
    # Each rank reports the error of the three rejected problems.
    for message in ("is not finite at point", "-nonsense", "without a fixed point"):
        assert text.count(message) >= ranks, text
    return found


def close(a, b, tolerance=CLOSE) -> bool:
    a, b = np.asarray(a), np.asarray(b)
    return a.shape == b.shape and np.abs(a - b).max() <= tolerance * np.abs(b).max()


def check_tables(found: dict, expected: dict) -> None:
    """Compare the tables of Element Quality: sums may be taken in another order."""
    assert found.keys() == expected.keys()
    for name, values in expected.items():
        numbers = not isinstance(values, str) and not isinstance(values[0], str)
        same = np.allclose(found[name], values, rtol=ROUNDING, atol=0, equal_nan=True) if numbers else None
        assert same if numbers else found[name] == values, (name, found[name], values)


one = run(1)
assert one["unknowns 0 0"] == 343 and one["ranks"] == 1
assert max(one["poisson 0 0"]) > 0.01 and one["flattest 0 0"] > 0
assert len(one["poisson 0 0"]) == 729 and len(one["elastic"]) == 729
# Not the same value everywhere, and elements of each grade.
assert len(one["metric field mean_ratio"]) == 21 * 17 and np.ptp(one["metric field mean_ratio"]) > 0.5
assert len(one["domain points"]) == 1 and one["domain cells"] > 100
counts = [one["quality 0"][f"6 {name}"] for name in ("Passed", "Warning", "Failed")]
assert min(map(min, counts)) > 0 and np.sum(counts, axis=0).tolist() == [3072, 3072], counts
for ranks in (1, 2, 4):
    found = one if ranks == 1 else run(ranks)
    assert found["ranks"] == ranks
    for key in ("0 0", "1 0", "0 1", "1 1"):
        assert found[f"unknowns {key}"] == 343, key
        assert close(found[f"poisson {key}"], one["poisson 0 0"]), (ranks, key)
        assert close(found[f"flattest {key}"], one["flattest 0 0"], 1e-6), (ranks, key)
    for key in ("elastic", "held", "image"):
        assert close(found[key], one[key]), (ranks, key)
    assert close(found["divided"], one["poisson 0 0"]), ranks
    sentence = f"The mesh was {wording('redistributed')} among {ranks} processes by PT-Scotch."
    assert (found["division"] == sentence) == (ranks > 1), (ranks, found["division"])
    assert close(found["condition"], one["condition"], 1e-4), found["condition"]
    assert abs(found["shares"] - 1) < 1e-6, found["shares"]
    assert found["study"] == [1, 1, 1] and found["history"] and found["late"]
    assert all(value == 0 for key, value in found.items() if key.startswith("rejected"))
    # Metric Field and Mesh Domain: value by value. A domain is whole on the first rank.
    for key in ("mean_ratio", "condition_number", "Validity"):
        assert found[f"metric field {key}"] == one[f"metric field {key}"], (ranks, key)
    assert found["domain points"] == one["domain points"] and found["domain cells"] == one["domain cells"]
    for ghosts in (0, 1):
        check_tables(found[f"quality {ghosts}"], one["quality 0"])
    print(ranks, "ranks:", found["condition"], found["image"])
