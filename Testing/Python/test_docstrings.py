# SPDX-License-Identifier: BSD-3-Clause
"""The docstrings are in the form of numpydoc: every parameter and attribute is listed once, sections are in order."""

import re
from inspect import Parameter, getdoc, isclass, isfunction, signature

import tautline as tl
from checks import run_tests

SECTIONS = ("Parameters", "Attributes", "Returns", "Raises", "Notes", "Examples")
HEADING = re.compile(r"^([A-Z]\w+)\n(-+)$", re.MULTILINE)
ENTRY = re.compile(r"^(\*{0,2}\w+(?:, \w+)*)(?: : (\S.*))?$", re.MULTILINE)
FUNCTIONS = {name: value for name, value in vars(tl).items() if isfunction(value) and not name.startswith("_")}


def sections(text: str) -> dict:
    """The text of each section by its name; the summary has the name ""."""
    parts = HEADING.split(text)
    for name, line in zip(parts[1::3], parts[2::3]):
        assert name in SECTIONS and len(line) == len(name), (name, line)
    order = [SECTIONS.index(name) for name in parts[1::3]]
    assert order == sorted(set(order)), order
    return {"": parts[0]} | dict(zip(parts[1::3], parts[3::3]))


def names(text: str) -> list:
    return [name.lstrip("*") for found in ENTRY.findall(text) for name in found[0].split(", ")]


def test_functions() -> None:
    assert len(FUNCTIONS) > 30
    for name, function in FUNCTIONS.items():
        found = sections(getdoc(function))
        assert found[""].splitlines()[0].endswith("."), name
        parameters = signature(function).parameters
        assert sorted(names(found.get("Parameters", ""))) == sorted(parameters), name
        for head, type_ in ENTRY.findall(found.get("Parameters", "")):
            parameter = parameters[head.split(", ")[0].lstrip("*")]
            assert type_ or parameter.kind is Parameter.VAR_KEYWORD, (name, head)
            assert parameter.default is Parameter.empty or "optional" in type_ or "default" in type_, (name, head)
        returned = function.__annotations__.get("return", "None")
        assert ("Returns" in found) == (returned != "None"), (name, returned)
        assert ">>>" not in found[""] and (">>>" in found.get("Examples", ">>>")), name
        assert max(map(len, getdoc(function).splitlines())) <= 116, name


def test_results() -> None:
    results = {n: v for n, v in vars(tl).items() if isclass(v) and n.endswith("Result")}
    assert len(results) > 12
    for name, made in results.items():
        found = sections(getdoc(made))
        fields = [key for key in made.__annotations__ if not key.startswith("_")]
        assert sorted(names(found["Attributes"])) == sorted(fields), (name, names(found["Attributes"]))


run_tests(globals())
