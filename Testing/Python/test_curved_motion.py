# SPDX-License-Identifier: BSD-3-Clause
"""Untangle, optimize and curve on curved cells: valid by another proof, with the boundary where it is to stay."""

import numpy as np
import tautline as tl
from checks import DATA, OUT, points, rejected, run_tests, shell, wording
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter

CYLINDER = DATA / "cylinder.msh"  # triangles
BRACKET = DATA / "bracket.vtu"  # tetrahedra


def curved(order: int = 2):
    return tl.curve(CYLINDER, order).mesh


def tangled(order: int = 2):
    """Some of the cells are folded; the boundary stays."""
    return tl.perturb(curved(order), 1.0, 100.0, seed=3, tangle=0.2).mesh


def boundary(mesh) -> np.ndarray:
    """Flags of the points of faces of one cell."""
    flags = tl.perturb(mesh, 0.01, 100.0).displacement
    return ~flags.any(axis=1)


def test_untangle():
    for order in (2, 3):
        mesh = tangled(order)
        before = tl.quality(mesh)
        assert before.inverted > 0
        result = tl.untangle(mesh)
        assert (result.inverted_before, result.inverted) == (before.inverted + before.degenerate, 0)
        assert not result.obstacle.any() and (result.validity == 1).all()
        assert (vtk_to_numpy(result.mesh.GetCellTypesArray()) == vtk_to_numpy(mesh.GetCellTypesArray())).all()
        path = OUT / "untangled.vtu"
        tl.write(result, path)
        # By the shape functions of VTK.
        made = tl.certificate(path)
        assert made["valid"] == made["cells"] and tl.verify_certificate(path, made)
        assert tl.quality(path).inverted == 0


def test_boundary():
    mesh = tangled()
    stays = tl.untangle(mesh, boundary="fixed")
    assert stays.inverted == 0
    assert not stays.displacement[boundary(mesh)].any()
    corners = tl.untangle(mesh, mid_nodes_only=True, boundary="free")
    linear = tl.curve(mesh, 1).mesh.GetNumberOfPoints()
    assert not corners.displacement[:linear].any()


def test_optimize():
    mesh = tangled()
    before = tl.quality(tl.untangle(mesh).mesh, "imr")
    for options in ({}, {"boundary": "on surface"}, {"preset": "worst element"}):
        result = tl.optimize(mesh, **options)
        after = tl.quality(result.mesh, "imr")
        assert (result.inverted, after.inverted) == (0, 0)
        assert after.values["imr"].mean() < before.values["imr"].mean()
    rejected(wording("set-maximum-displacement-to-0"), tl.optimize, mesh, limits=0.1)


def test_geometry():
    # The boundary of tetrahedra stays on a surface of triangles.
    made = tl.curve(BRACKET, 2)
    mesh = tl.perturb(made.mesh, 1.0, 100.0, seed=3, tangle=0.02).mesh
    assert tl.quality(mesh).inverted > 0
    facets = vtkGeometryFilter()
    facets.SetInputData(tl.read(BRACKET))
    facets.Update()
    surface = facets.GetOutput()
    for result in (tl.untangle(mesh, geometry=surface), tl.untangle(mesh)):
        assert result.inverted == 0
        assert tl.quality(result.mesh).inverted == 0
    rejected(wording("the-geometry-has-volume-cells"), tl.untangle, mesh, geometry=BRACKET)


def test_threads():
    mesh = tangled()
    one, several = (tl.untangle(mesh, threads=n) for n in (1, 3))
    assert (points(one.mesh) == points(several.mesh)).all()


def test_command():
    source, target = OUT / "tangled.msh", OUT / "untangled.msh"
    tl.write(tangled(), source)
    shell("untangle", source, "-o", target)
    assert tl.quality(target).inverted == 0
    assert (points(tl.read(target)) != points(tl.read(source))).any()


run_tests(globals())
