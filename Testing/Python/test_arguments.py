# SPDX-License-Identifier: BSD-3-Clause
"""Wrong arguments raise tautline.Error with a remedy, in every function: never TypeError, AttributeError or OSError."""

import os
import time
import warnings
from inspect import Parameter, isfunction, signature

import numpy as np
import tautline as tl
from checks import DATA, OUT, rejected, run_tests, shell, slow, square, wording
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet, vtkTable, vtkUnstructuredGrid

FUNCTIONS = {name: value for name, value in vars(tl).items() if isfunction(value) and not name.startswith("_")}
#: Arguments without a default, beside the mesh.
NEEDED = {"domain": ("square",), "write": (OUT / "arguments.vtu",), "compare": (square(2),),
          "transfer": (square(2),), "warp": (), "adapt": ({}, 1)}
#: The first argument of these functions is not a mesh.
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
    rejected(wording("did-you-mean-youngs-modulus-there-are"), tl.solve, square(2), youngs_moduls=1)
    rejected(wording("there-is-no-argument-of-perturb-fracton"), tl.perturb, square(2), fracton=1)


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
        rejected(wording("cannot-be-read"), tl.quality, denied)


def test_composite_data() -> None:
    for name, function in FUNCTIONS.items():
        if name not in NO_MESH:
            data = blocks()
            if name == "write":
                outcome(function, data, OUT / "arguments.vtm")
            outcome(function, data, *NEEDED.get(name, ()))
            outcome(function, vtkMultiBlockDataSet(), *NEEDED.get(name, ()))
    rejected(wording("no-interaction-layer"), tl.peridynamics, blocks(), delta=0.2)


def test_empty_mesh() -> None:
    for name, function in FUNCTIONS.items():
        if name not in NO_MESH:
            outcome(function, vtkUnstructuredGrid(), *NEEDED.get(name, ()))


def test_sizes_of_domains() -> None:
    """Sizes that no memory holds are rejected at once, before memory is allocated."""
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
    source = tl.vtkDomainSource()  # as in ParaView: rejected by the source itself
    messages = []
    source.AddObserver("ErrorEvent", lambda *_: messages.append(1))
    source.GetExecutive().AddObserver("ErrorEvent", lambda *_: None)
    source.SetDomainByName("square")
    source.SetElementSize(1e-4)
    source.SetLayerWidth(10)
    source.Update()
    assert messages and source.GetOutput().GetNumberOfCells() == 0
    assert time.monotonic() - start < 10.0


#: Values of types that an argument may not have.
WRONG = (None, object(), "text", 1.5, -3, [], {}, b"x", float("nan"), [1, "a"], True, np.zeros((2, 2)), [None], 10**30,
         1 + 2j, np.array("x"), "", [[1], [2, 3]])  # fmt: skip
#: First arguments of functions, where they are not meshes.
FIRST = {"domain": ("square",), "silhouette": (DATA / "fish.png",), "match": (DATA / "fish.png",) * 2,
         "retrieval": ([DATA / "fish.png", DATA / "fish-bent.png"],), "read": (DATA / "plate.vtu",),
         "times": (DATA / "plate.vtu",), "write": (square(2), "wrong.vtu"), "compare": (square(2),) * 2,
         "transfer": (square(2),) * 2, "adapt": (square(2), {}, 1),
         "triangle_mesh": (DATA / "plate.poly",), "tet_mesh": (DATA / "cube.smesh",), "criteria": ("fem",),
         "from_arrays": ([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]]), "load_metrics": ("absent.py",),
         "register_metric": ("wrong_value", lambda corners, kind: corners[:, 0, 0]), "run_state": ("absent.pvsm",),
         "unregister_metric": ("absent",), "run_steps": ({},), "read_silhouettes": ("absent",)}  # fmt: skip
OPTIONS = {"warp": {"transform": {"rotate": 3}}, "metric_field": {"dimensions": (3, 3, 3)}, "match": {"grid": (5, 5)},
           "retrieval": {"grid": (5, 5)}}  # fmt: skip


@slow
def test_wrong_values() -> None:
    """Every argument of every function with values of wrong types: tautline.Error, or the value is taken."""
    folder = OUT / "wrong-values"
    folder.mkdir(exist_ok=True)
    calls = 0
    here = os.getcwd()
    os.chdir(folder)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            for name, function in FUNCTIONS.items():
                parameters = signature(function).parameters
                layered = name in ("peridynamics", "horizon_neighbors")
                mesh = tl.interaction_layer(square(2), 0.3) if layered else square(2)
                first = FIRST.get(name, (mesh,) if "mesh" in parameters else ())
                for place, parameter in enumerate(parameters.values()):
                    if parameter.kind is Parameter.VAR_KEYWORD:
                        continue
                    for wrong in WRONG:
                        given = list(first)
                        options = {key: value for key, value in OPTIONS.get(name, {}).items() if key != parameter.name}
                        if place < len(given):
                            given[place] = wrong
                        else:
                            options[parameter.name] = wrong
                        outcome(function, *given, **options)
                        calls += 1
    finally:
        os.chdir(here)
    assert calls > 6000, calls


def test_types() -> None:
    """Wrong types are errors that state the expected type; they are not interpreted in another way."""
    for options, text in (
        ({"boundary": None}, "boundary is None"),
        ({"hold_worst": "no"}, wording("true-or-false-is-expected")),
        ({"hold_worst": None}, wording("true-or-false-is-expected")),
        ({"threads": 1.5}, wording("a-whole-number-is-expected")),
        ({"time_limit": "soon"}, wording("it-must-be-a-number")),
        ({"time_limit": None}, wording("it-must-be-a-number")),
        ({"limits": [[1], [2, 3]]}, "limits: not an array"),
        ({"utopia": "text"}, "utopia"),
        ({"objectives": 3}, "objectives is 3"),
    ):
        rejected(text, tl.optimize, square(2), **options)
    rejected(wording("rows-of-different-lengths"), tl.warp, square(2), transform={"rotate": 3}, moved=[[1], [2, 3]])
    for wrong in (None, 3, b"imr", {"imr": 1}):
        rejected(wording("a-list-is-expected"), tl.quality, square(2), wrong)
        rejected("criteria", tl.quality, square(2), criteria=wrong or 3)
    rejected(wording("a-text-is-expected"), tl.solve, square(2), solution_name=None)
    assert tl.optimize(square(2), threads=np.int64(1), hold_worst=np.True_, time_limit=np.float32(9)).inverted == 0
    assert tl.optimize(square(2), hold_worst=1, maximum_iterations=3.0).inverted == 0


run_tests(globals())
