# SPDX-License-Identifier: BSD-3-Clause
"""test_parallel_filters.py PVBATCH: on 2, 3 and 4 MPI ranks filters find what they find on one; skipped without mpirun.

A mesh is cut into slabs, by a k-d tree and at random, with and without ghost cells and global ids.
"""

import itertools

import numpy as np
from on_ranks import run_with_output
from wording import wording

CLOSE = 1e-9
INTEGRALS = 2e-6
SIMILAR = 0.1  # of a third of the edge of the cube: no point goes elsewhere
CASES = ("slabs", "tree", "random")
ORDERED = ("hybrid", "untangled", "literal")


def run(ranks: int) -> dict:
    found, text = run_with_output("parallel_filters.py", ranks)
    # Each rank reports the defect of one of them, by each of four filters, and the failure of the filter before.
    assert text.count("In process") >= 4 * ranks or ranks == 1, text
    assert text.count("An input could not be computed") >= ranks or ranks == 1, text
    return found


def compare(found, expected, where: str, tolerance: float = CLOSE) -> None:
    """Numbers and what contains them within a tolerance, texts exactly."""
    if isinstance(expected, dict):
        assert found.keys() == expected.keys(), (where, found.keys(), expected.keys())
        for key, value in expected.items():
            compare(found[key], value, f"{where}, {key}", tolerance)
    elif isinstance(expected, str):
        assert found == expected, (where, found, expected)
    elif isinstance(expected, list) and any(isinstance(value, (str, dict, list)) for value in expected):
        assert len(found) == len(expected), (where, len(found), len(expected))
        for k, (a, b) in enumerate(zip(found, expected)):
            compare(a, b, f"{where} {k}", tolerance)
    else:
        a, b = np.asarray(found, dtype=float), np.asarray(expected, dtype=float)
        assert a.shape == b.shape and np.allclose(a, b, rtol=tolerance, atol=tolerance), (where, found, expected)


def check_untangled(found: dict, several: dict, ranks: int) -> None:
    """Untangling and optimization use another order on several ranks, always the same one."""
    for case, key in itertools.product(CASES, ORDERED):
        where = f"{key} {case}"
        (points, *counts, summary), (expected, *numbers, first) = found.pop(where), one[where]
        assert counts == numbers == [0, 0], (where, counts, numbers)
        assert wording("put-together") not in summary, (where, summary)
        assert wording("elements-are-valid") in first, first
        assert summary.splitlines()[0].split(".")[0] == first.splitlines()[0].split(".")[0], (summary, first)
        far = np.abs(np.asarray(points) - np.asarray(expected)).max()
        assert far < SIMILAR, (where, far)
        compare(points, several.setdefault(where, points), f"{ranks} ranks, {where}")


one = run(1)
several: dict = {}
for case in CASES:
    # Something has happened: points move, elements become inverted, cells change.
    assert np.abs(np.asarray(one[f"warp {case}"])[:, 3:]).max() > 0.1 and len(one[f"warp {case}"]) == 64
    for way in ("anisotropic", "principal", "small steps", "stiffening", "jacobian", "cells", "regions", "gradients",
                "biharmonic", "laplacian", "distances", "radial", "rotations", "automatic", "part",
                "values"):  # fmt: skip
        if case == "tree":
            continue
        points, shapes, _, statistics = one[f"{way} {case}"]
        assert len(points) == 64 and len(shapes) == 162 and statistics["Moved points"][0] > 8, (way, statistics)
        assert statistics["Inverted"] == [0] and statistics["Largest displacement"][0] > 0.05, (way, statistics)
        assert np.ptp(np.asarray(shapes)) > 1e-4, way
    for way, inverted in (("tangle", "Inverted elements: 0 before, 3 after"), ("perturb", ": 0 before, 0 after")):
        points, summary = one[f"{way} {case}"]
        assert np.ptp(np.asarray(points)[:, 3:]) > 0.01 and inverted in summary, summary
    grades = np.asarray(one[f"criteria {case}"])
    assert len(grades) == 162 and len(set(grades[:, 0])) > 1 and np.ptp(grades[:, 1]) > 0.1, grades
    assert len(one[f"compare {case}"][0]) == 162 and np.ptp(np.asarray(one[f"compare {case}"][0])[:, 2]) > 0
    assert len(one[f"transfer {case}"][0]) == 64 and np.ptp(np.asarray(one[f"transfer {case}"][0])) > 0
    assert len(one[f"improve {case}"][0]) != 162 or one[f"improve {case}"][2] > 1
    assert one[f"condition {case}"][0] > 1 and len(one[f"rows {case}"][0]) == 81
    assert len(one[f"horizon {case}"][0]) > 20
for ranks in (2, 3, 4):
    found = run(ranks)
    assert found.pop("ranks") == ranks
    assert all(found[key] == 0 for key in found if key.startswith("rejected"))
    assert found["image"] == "", (ranks, found["image"])
    assert found.pop("upstream") == [0, ""], found
    check_untangled(found, several, ranks)
    assert found.keys() == {key for key in one if key.split()[0] not in ("ranks", "upstream", *ORDERED)}
    for key, value in found.items():
        if key.startswith("laplacian"):  # by another linear solver
            value[2]["N iterations"] = one[key][2]["N iterations"]
        # The cells of the layer are in another order, and integrals are found to a tolerance.
        compare(value, one[key], f"{ranks} ranks, {key}", INTEGRALS if key.startswith("condition") else CLOSE)
    print(ranks, "ranks:", found["condition tree"], found["improve random"][3].splitlines()[0])
