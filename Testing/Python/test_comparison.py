# SPDX-License-Identifier: BSD-3-Clause
"""The function compare against the two meshes' qualities, and its errors."""

import numpy as np
import tautline as tl
from checks import DATA, rejected, run_tests, wording

BRACKET, PLATE = (DATA / f"{name}.vtu" for name in ("bracket", "plate"))


def test_compare():
    mesh = tl.read(BRACKET)
    first = tl.perturb(mesh)
    result = tl.compare(mesh, first, ["imr", "size"])
    facts, change = result.statistics["imr"], result.difference["imr"]
    assert facts["better"] + facts["worse"] + facts["equal"] == 8140
    assert np.isclose(change.mean(), facts["mean_after"] - facts["mean_before"])
    assert (result.displacement == first.displacement).all()
    assert set(np.unique(result.change)) == {-1, 0, 1}
    assert (tl.compare(mesh, mesh).change == 0).all()
    rejected("", tl.compare, mesh, PLATE)
    rejected(wording("there-is-no-such-file"), tl.compare, mesh, "absent.vtu")


run_tests(globals())
