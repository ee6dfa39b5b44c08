# SPDX-License-Identifier: BSD-3-Clause
"""Names of methods and presets: in any case, with the nearest one if they are wrong. See also test_properties.py."""

import argparse
import inspect

import tautline as tl
from checks import DATA, OUT, rejected, run_tests, shell, wording
from tautline.__main__ import _parser
from vtkmodules.util.numpy_support import vtk_to_numpy

TANGLED, PLATE = DATA / "bracket-tangled.vtu", DATA / "plate.vtu"


def test_functions():
    """Any case, hyphens and underscores; results are the same."""
    assert tl.optimize(PLATE, preset="Best Shape") == tl.optimize(PLATE, preset="best shape")
    assert tl.optimize(PLATE, optimizer="L BFGS") == tl.optimize(PLATE, optimizer="l-bfgs")
    assert tl.untangle(TANGLED, "THOROUGH") == tl.untangle(TANGLED, "thorough")
    assert tl.improve(TANGLED_VALID, "Swap_Only") == tl.improve(TANGLED_VALID, "swap only")
    assert tl.improve(TANGLED_VALID, "Custom", swap=False) == tl.improve(TANGLED_VALID, "custom", swap=False)
    elastic = tl.solve(PLATE, "Elasticity", "CG", "BoomerAMG", source=(0, -1))
    assert elastic.solution.shape[1] == 3 and elastic == tl.solve(PLATE, "elasticity", source=(0, -1))
    assert tl.solve(PLATE, preconditioner="amg") == tl.solve(PLATE, preconditioner="boomeramg")
    turned = tl.warp(PLATE, transform={"rotate": 20}, solver="Conjugate gradients", moved="Whole Boundary")
    assert turned == tl.warp(PLATE, transform={"rotate": 20}, solver="cg", moved="whole boundary")
    assert tl.criteria("FEM") == tl.criteria("fem")
    assert tl.quality(PLATE, criteria="FEM") == tl.quality(PLATE, criteria="fem")
    assert tl.quality(PLATE, target="Ideal") == tl.quality(PLATE)
    assert tl.domain("Rectangle", 100).GetNumberOfCells() == tl.domain("rectangle", 100).GetNumberOfCells()


def test_second_argument():
    """The second argument of functions that have presets is the preset; the older meanings are found by their type."""
    assert tl.optimize(PLATE, "worst element") == tl.optimize(PLATE, preset="worst element")
    assert tl.optimize(PLATE, objectives="Worst Element") == tl.optimize(PLATE, preset="worst element")
    for objectives in ("mu_2", ["mu_2"], [("mu_2", {"weight": 1})]):
        assert tl.optimize(PLATE, objectives) == tl.optimize(PLATE, objectives=objectives)
        assert list(tl.optimize(PLATE, objectives).statistics) == ["mu_shape"]
    thorough = tl.untangle(TANGLED, "thorough")
    assert thorough == tl.untangle(TANGLED, preset="thorough") == tl.untangle(TANGLED, effort="thorough")
    rejected(wording("two-presets-are-given"), tl.optimize, PLATE, "best shape", objectives="worst element")
    rejected(wording("objectives-are-given-twice"), tl.optimize, PLATE, ["imr"], objectives=["imr"])
    rejected(wording("no-preset-and-no-metric"), tl.optimize, PLATE, "imrr")
    rejected(wording("preset-is-best-shpae-did-you-mean"), tl.optimize, PLATE, "best shpae")
    rejected(wording("mean-the-same"), tl.untangle, TANGLED, "local", effort="local")
    rejected(wording("is-a-preset-of-criteria"), tl.quality, PLATE, "fem")
    for name in ("optimize", "untangle", "improve"):
        assert list(inspect.signature(getattr(tl, name)).parameters)[1] == "preset", name


def test_wrong_names():
    rejected(wording("preset-is-best-shpae-did-you-mean"), tl.optimize, PLATE,
            preset="best shpae")  # fmt: skip
    rejected(wording("effort-is-thorugh-did-you-mean-thorough"), tl.untangle, PLATE, "Thorugh")
    rejected(wording("preconditioner-is-boomramg-did-you-mean-boomeramg"), tl.solve, PLATE, preconditioner="boomramg")
    rejected(wording("pde-is-xyz-there-are-poisson"), tl.solve, PLATE, "xyz")
    rejected(wording("effort-is-none-there-are"), tl.untangle, PLATE, None)
    rejected(wording("did-you-mean-fem-2"), tl.criteria, "fen")


def test_shell():
    out = OUT / "names.vtu"
    shell("optimize", PLATE, "--preset", "Best_Shape", "-o", out)
    assert tl.compare(out, tl.optimize(PLATE, preset="best shape")).displacement.max() == 0
    text = shell("optimize", PLATE, "--preset", "best shpae", "-o", out, code=2)
    assert wording("invalid-choice-best-shpae-did-you-mean") in text, text
    assert wording("did-you-mean-untangle") in shell("untangel", PLATE, code=2)
    shell("solve", PLATE, "--preconditioner", "AMG", "--solver", "Bi-CGSTAB")


#: Arguments without an option on the shell: it shows progress on a terminal, is one process, prints text, and has mesh,
#: file and motion under other names.
NOT_IN_SHELL = {"progress", "redistribute", "gather_below", "rounds", "file", "outline", "surface", "transform",
                "series", "sparsity", "target"}  # fmt: skip


def test_shell_has_all():
    """Each argument of a function is an option of its command, with the same name."""
    commands = next(a for a in _parser()._actions if isinstance(a, argparse._SubParsersAction)).choices
    checked = 0
    for name, function in ((name, getattr(tl, name.replace("-", "_"), None)) for name in commands):
        if function is None or name == "formats":
            continue
        parameters = inspect.signature(function).parameters.values()
        names = {p.name for p in parameters if p.kind not in (p.VAR_KEYWORD, p.VAR_POSITIONAL)}
        missing = names - {action.dest for action in commands[name]._actions}
        # By region is a table of numbers for each value of an array, which a shell has no option for.
        missing -= NOT_IN_SHELL | ({"regions"} if name == "warp" else set())
        assert not missing, (name, missing)
        checked += len(names)
    assert checked > 200, checked


def test_shell_options():
    """The arguments of the shell arrive: the result equals the function's."""
    out = OUT / "names.vtu"
    shell("optimize", PLATE, "--objective", "imr,template=power mean", "--power", 4, "--relative-change", 1e-3,
          "--no-untangle-first", "--limits", 0.02, "--two-digits", "-o", out)  # fmt: skip
    expected = tl.optimize(PLATE, [("imr", {"template": "power mean"})], power=4, relative_change=1e-3,
                           untangle_first=False, limits=0.02, two_digits=True)  # fmt: skip
    assert 0 < abs(expected.displacement).max() <= 0.02
    assert tl.compare(out, expected).displacement.max() == 0
    assert tl.compare(out, tl.optimize(PLATE, limits=0.02)).displacement.max() > 0
    assert wording("decides-on") in shell("optimize", PLATE, "--preset", "best shape", "--power", 4, "-o", out, code=1)
    shell("warp", PLATE, "--rotate", 10, "--method", "inverse distance", "--distance-power", 2, "-o", out)
    turned = tl.warp(PLATE, transform={"rotate": 10}, method="inverse distance", distance_power=2)
    assert tl.compare(out, turned).displacement.max() == 0
    shell("solve", PLATE, "--no-gradient", "--solution-name", "u", "-o", out)
    arrays = tl.read(out).GetCellData()
    assert arrays.GetArray("Gradient") is None and tl.read(out).GetPointData().GetArray("u")
    field = OUT / "names.vti"
    triangle = [(0, 0), (2, 0)]
    shell("metric-field", "--metrics", "size", "--vertices", "0,0", "2,0", "--dimensions", 3, 3, 1, "-o", field)
    found = tl.metric_field("size", vertices=triangle, dimensions=(3, 3)).values["size"]
    read = vtk_to_numpy(tl.read(field).GetPointData().GetArray("size"))
    assert (read == found.ravel()).all() and found.max() == 2, found


TANGLED_VALID = tl.untangle(TANGLED)
run_tests(globals())
