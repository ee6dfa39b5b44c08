# SPDX-License-Identifier: BSD-3-Clause
"""Wrong arguments raise tautline.Error with a remedy, in every function: never TypeError, AttributeError or OSError."""

import os
import time
from inspect import Parameter, isfunction, signature

import tautline as tl
from checks import DATA, OUT, refused, run_tests, shell, square, wording
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet, vtkTable, vtkUnstructuredGrid

FUNCTIONS = {name: value for name, value in vars(tl).items() if isfunction(value) and not name.startswith("_")}
#: Arguments without a default, beside the mesh.
NEEDED = {"domain": ("square",), "write": (OUT / "arguments.vtu",), "compare": (square(2),), "warp": ()}
#: What these functions take first is not a mesh.
NO_MESH = ("domain", "domains", "metrics", "metric_field", "from_arrays", "read", "read_silhouettes", "retrieval",
           "silhouette", "match", "solver_combinations", "load_metrics", "register_metric",
           "unregister_metric")  # fmt: skip


def blocks():
    """Composite data with one mesh."""
    made = vtkMultiBlockDataSet()
    made.SetBlock(0, square(4))
    return made


def outcome(function, *arguments, **options) -> str:
    """The message of tautline.Error, or nothing; any other exception is an error of the test."""
    try:
        function(*arguments, **options)
    except tl.Error as error:
        return str(error)
    except BaseException as error:
        raise AssertionError(f"{function.__name__}{arguments} {options} raised {error!r}") from error
    return ""


def test_unknown_keywords() -> None:
    assert len(FUNCTIONS) > 20, FUNCTIONS
    for name, function in FUNCTIONS.items():
        positional = [p for p in signature(function).parameters.values() if p.default is Parameter.empty]
        positional = [p for p in positional if p.kind is Parameter.POSITIONAL_OR_KEYWORD]
        given = (DATA / "plate.vtu",) * len(positional)
        text = outcome(function, *given, no_such_keyword=1)
        assert "no_such_keyword" in text, f"{name}: '{text}'"
        assert not positional or f"{name}()" in outcome(function), f"{name} without arguments"
    refused(wording("did-you-mean-youngs-modulus-there-are"), tl.solve, square(2), youngs_moduls=1)
    refused(wording("there-is-no-argument-of-perturb-fracton"), tl.perturb, square(2), fracton=1)


def test_no_mesh() -> None:
    """A number, nothing, a table and a file without permission in the place of a mesh."""
    denied = OUT / "arguments-denied.vtu"
    tl.write(square(2), denied)
    for name, function in FUNCTIONS.items():
        for wrong in (7, None, vtkTable(), object(), "", b"mesh.vtu", [1, 2, 3]):
            if name not in NO_MESH:
                assert outcome(function, wrong, *NEEDED.get(name, ())), f"{name} accepted {wrong!r}"
            elif name not in ("metric_field", "metrics", "domains", "solver_combinations"):
                others = ((),) * (sum(p.default is Parameter.empty and p.kind is Parameter.POSITIONAL_OR_KEYWORD
                                      for p in signature(function).parameters.values()) - 1)  # fmt: skip
                assert outcome(function, wrong, *others), f"{name} accepted {wrong!r}"
    denied.chmod(0)
    if os.geteuid() != 0:
        refused(wording("cannot-be-read"), tl.quality, denied)


def test_composite_data() -> None:
    for name, function in FUNCTIONS.items():
        if name not in NO_MESH:
            data = blocks()
            if name == "write":
                outcome(function, data, OUT / "arguments.vtm")
            outcome(function, data, *NEEDED.get(name, ()))
            outcome(function, vtkMultiBlockDataSet(), *NEEDED.get(name, ()))
    refused(wording("no-interaction-layer"), tl.peridynamics, blocks(), delta=0.2)


def test_empty_mesh() -> None:
    for name, function in FUNCTIONS.items():
        if name not in NO_MESH:
            outcome(function, vtkUnstructuredGrid(), *NEEDED.get(name, ()))


def test_sizes_of_domains() -> None:
    """Sizes that no memory holds are refused at once, before memory is allocated."""
    start = time.monotonic()
    for options in ({"element_size": 1e-9}, {"element_size": 0}, {"element_size": -1}, {"element_size": float("nan")},
                    {"element_size": float("inf")}, {"aspect_ratio": 1e9}, {"aspect_ratio": 0.5},
                    {"aspect_ratio": float("nan")}, {"layer_width": 1e9}, {"layer_width": -1},
                    {"layer_width": float("nan")}, {"element_size": 1e-4, "layer_width": 10}):  # fmt: skip
        text = outcome(lambda: tl.domain("square", **options))
        names = ("element_size", "aspect_ratio", "layer_width", "element size", "layer", "memory")
        assert any(name in text for name in names), (options, text)
    for name in ("rectangle", "cylinder", "sphere"):
        for cells in (99999999999, 10**30, -1):
            assert "cells" in outcome(tl.domain, name, cells), (name, cells)
    for amount in (1e9, float("nan")):
        assert "amount" in outcome(lambda: tl.domain("rectangle", amount=amount)), amount
    assert outcome(tl.domain, "square", "many") and outcome(tl.domain, 7)
    file = OUT / "arguments-domain.vtu"
    assert wording("element-size-is") in shell("domain", "square", "--element-size", "1e-9", "-o", file, code=1)
    assert wording("element-size-is") in shell("domain", "square", "--element-size", "0", "-o", file, code=1)
    assert "cells" in shell("domain", "rectangle", "--cells", "99999999999", "-o", file, code=1)
    source = tl.vtkDomainSource()  # as in ParaView: refused by the source itself
    messages = []
    source.AddObserver("ErrorEvent", lambda *_: messages.append(1))
    source.GetExecutive().AddObserver("ErrorEvent", lambda *_: None)
    source.SetDomainByName("square")
    source.SetElementSize(1e-4)
    source.SetLayerWidth(10)
    source.Update()
    assert messages and source.GetOutput().GetNumberOfCells() == 0
    assert time.monotonic() - start < 10.0


run_tests(globals())
