# SPDX-License-Identifier: BSD-3-Clause
"""The function perturb: displacements, seeds, tangled and fixed points, errors."""

import numpy as np
import tautline as tl
from checks import DATA, quadratic_square, rejected, run_tests, wording
from vtkmodules.vtkCommonDataModel import vtkImageData

BRACKET = DATA / "bracket.vtu"


def test_perturb():
    mesh = tl.read(BRACKET)
    first, again, other = (tl.perturb(mesh, seed=seed) for seed in (1, 1, 2))
    assert first.inverted == 0 and first.moved > 0.4 * first.movable > 0
    assert (first.displacement == again.displacement).all() and (first.displacement != other.displacement).any()
    assert np.isclose(np.linalg.norm(first.displacement, axis=1).max(), first.largest_displacement)
    tangled = tl.perturb(mesh, tangle=0.02)
    assert tangled.inverted == tl.quality(tangled).inverted == round(0.02 * 8140) and abs(tangled.tangled - 0.02) < 1e-4
    still = tl.perturb(mesh, fixed=np.ones(mesh.GetNumberOfPoints(), bool))
    assert still.moved == 0 and still.mesh.GetPointData().GetNumberOfArrays() == 1
    rejected(wording("each-of-the-2343-points"), tl.perturb, mesh, fixed=[1, 2])
    rejected(wording("no-point-array-x"), tl.perturb, mesh, fixed="x")
    rejected("implicit", tl.perturb, vtkImageData())
    rejected(wording("fraction-is-1-5"), tl.perturb, mesh, 1.5)
    rejected(wording("tangle-is-nan"), tl.perturb, mesh, tangle=float("nan"))


def test_curved():
    mesh = quadratic_square(10, 0.08)
    moved = tl.perturb(mesh, fraction=1.0, percentage=100)
    assert moved.inverted == 0 == tl.quality(moved).inverted and moved.moved > 60
    tangled = tl.perturb(mesh, tangle=0.1)
    assert tangled.inverted == tl.quality(tangled).inverted >= 18


run_tests(globals())
