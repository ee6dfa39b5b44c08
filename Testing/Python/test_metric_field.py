# SPDX-License-Identifier: BSD-3-Clause
"""The function metric_field on a triangle and a tetrahedron, and its errors."""

import numpy as np
import tautline as tl
from checks import rejected, run_tests, wording

ROOT3 = 3**0.5


def test_metric_field():
    field = tl.metric_field(["imr", "size"], bounds=(0, 1, 0, ROOT3), dimensions=(3, 3))
    assert field.values["imr"].shape == (3, 3) and field.mesh.GetDimensions() == (3, 3, 1)
    assert abs(field.values["imr"][1, 1] - 1) < 1e-12, "the apex of the equilateral triangle"
    assert np.allclose(field.values["size"][2], ROOT3 / 2) and (field.validity[0] == 0).all()
    solid = tl.metric_field("size", "tetrahedron", vertices=np.eye(3), bounds=(0, 1, 0, 1, 0, 1), dimensions=(2, 3, 4))
    assert solid.values["size"].shape == (4, 3, 2)
    assert abs(solid.values["size"][-1, -1, -1] - 1 / 3) < 1e-14, "(1, 1, 1) above the face of the unit simplex"
    flat = tl.metric_field("untangle_beta", bounds=(0, 1, 0, 2), dimensions=(2, 5))
    assert np.allclose(flat.values["untangle_beta"][:, 0], [0.25, 0, 0, 0, 0]), "(3.3) at y = 0, 0.5, ..."
    assert tl.metric_field("untangle_beta", beta=0.0).values["untangle_beta"].max() == 0
    rejected("beta", tl.metric_field, beta=float("nan"))
    rejected(wording("there-are-triangle-tetrahedron"), tl.metric_field, cell="prism")
    rejected(wording("vertices-have-the-shape-1-3"), tl.metric_field, vertices=[[0, 0, 0]])
    rejected(wording("whole-numbers-from-1"), tl.metric_field, dimensions=(0, 1, 1))
    rejected(wording("no-metric-nope"), tl.metric_field, "nope")


run_tests(globals())
