# SPDX-License-Identifier: BSD-3-Clause
"""generate.py SOURCES PACKAGE XML...: writes Python functions and shell commands from the XML of the proxies.

A proxy with the hint <Python function="..."/> becomes a function and a command. Each of its properties becomes an
argument, with type, default, range, choices and documentation as in the XML, and an option of the command. Data that
ParaView's XML has no place for is in further attributes, which ParaView ignores. Attributes of <Python>:

    module       the file with the function, as in CAPABILITIES
    positional   the arguments that are not keyword-only, in order
    custom       the property whose value 0 shows others, whose arguments are None by default
    filter       the name of a function that returns the filter; with finish="filter", the command uses it
    help, details, example, aliases, csv, output
                 of the command; csv: what --csv writes; output: the help of --output if that option is optional, ""
                 if there is none
    text         the docstring around the arguments, after the line short_help

Attributes of a property:

    python          the name of the argument if it is not the property's name in snake case; "" is none. For an
                    <Entry>: the name of the choice if it is not the label.
    python_default  the default in Python if it differs from the panel's default; None leaves the property as it is
    python_type     the name of the type of an enumeration that several functions share
    python_true     the choice that True means; False is the first one
    python_above    the limit that a number has to exceed
    python_min, python_max
                    the limits if they differ from the panel's limits; "inf" if there is none
    shell           the help of the option if it is not the first sentence of the documentation; "" is no option
    shell_old       an older name of the option, or of --no-NAME

Arguments and results that are not one property each are written by hand, in SOURCES/<module>_parts.py, which is read,
not imported, so nothing has to be compiled first.

    NAME_result(filter, output)     the result of a filter that has run; further parameters are arguments of NAME()
    finish_NAME(arguments, result)  prints it for the shell
    finish_NAME_of_several(arguments, measured)
                                    the same for several meshes, if finish="filter"; measured(file) is the filter
    NAME_input(filter, ...)         sets an input that is not a mesh; its parameters are the first arguments
    @sets("NAME", "Property", ...)  a setter: its parameters with a default, and their docstring, become arguments of
                                    NAME(). Keyword-only ones are arguments that others declare; `custom` is a dict of
                                    the arguments that belong to the property custom.
    add_NAME_options(parser), NAME_options(arguments)
                                    the options of these arguments, and their values
    add_own_commands(commands)      further commands

Prints the names of the files that it wrote.
"""

from __future__ import annotations

import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from functions import Function
from parts import Parts
from properties import Choices
from texts import WIDTH, Failure, call, folded

PACKAGE = {
    "Any": "typing",
    "Literal": "typing",
    "get_args": "typing",
    "within": "._arguments",
    "pick": "._arguments",
    "flag": "._arguments",
    "flagged": "._arguments",
    "text": "._arguments",
    "whole": "._arguments",
    "InputArrays": "._arrays",
    "Values": "._arrays",
    "POINTS": "._arrays",
    "CELLS": "._arrays",
    "ANY": "._arrays",
    "interruptible": "._errors",
    "run": "._errors",
    "watch": "._errors",
    "Progress": "._interrupts",
    "Mesh": "._io",
    "as_mesh": "._io",
    "metric_name": "._metrics",
    "viewed": "._views",
}
HEAD = '''# SPDX-License-Identifier: BSD-3-Clause
# Written by python/generator from {sources}.
"""{title}"""

from __future__ import annotations

'''


def imports(names: set[str], parts: Parts, choices: dict[str, Choices]) -> str:
    """The import lines of a module."""
    chosen = {name: "._choices" for c in choices.values() for name in (c.type, c.tuple)}
    modules: dict[str, list[str]] = {}
    for name in sorted(names - {"np"}):
        origin = PACKAGE.get(name) or chosen.get(name) or parts.origin.get(name)
        if origin is None:
            raise Failure(f"{parts.module}.py has no {name}, which the function needs")
        modules.setdefault(origin, []).append(name)
    lines = ["import argparse"]
    standard = sorted(module for module in modules if not module.startswith("."))
    lines += [call(f"from {m} import ", modules[m], "", 0) for m in standard if m in sys.stdlib_module_names]
    lines += ["", "import numpy as np"] if "np" in names else []
    others = [call(f"from {m} import ", modules[m], "", 0) for m in standard if m not in sys.stdlib_module_names]
    lines += ["", *others] if others else []
    lines += ["", "from . import _commands, _vtk"]
    for module in sorted(module for module in modules if module.startswith(".")):
        line = f"from {module} import {', '.join(modules[module])}"
        if len(line) > WIDTH:
            line = call(f"from {module} import (", modules[module], ")", 0)
        lines.append(line)
    return "\n".join(lines) + "\n"


def module_text(functions: list[Function], choices: dict[str, Choices], source: str) -> str:
    """A module with functions and their commands."""
    parts = functions[0].parts
    names = {name for function in functions for name in function.names()}
    plural = "s" if len(functions) > 1 else ""
    title = f"The function{plural} {', '.join(function.name for function in functions)}."
    commands = "".join(function.commands() for function in functions)
    own = "    add_own_commands(commands)\n" if "add_own_commands" in parts.functions else ""
    names |= {"add_own_commands"} if own else set()
    exported = ", ".join(f'"{f.name}"' for f in functions)
    texts = [
        HEAD.format(sources=source, title=title) + imports(names, parts, choices).rstrip("\n") + "\n",
        *(function.code() for function in functions),
        'def add_commands(commands: Any) -> None:\n'
        f'    """Add {exported.replace(chr(34), "`").replace("_", "-")} to the subparsers of the command line."""\n'
        f"{commands}{own}",
        *(function.run() for function in functions),
    ]
    return "\n\n".join(texts)


def choices_text(choices: dict[str, Choices], labels: dict[str, set[str]], source: str) -> str:
    """The module with all enumerations, and the meanings of the panel labels."""
    title = "The choices of the arguments, in the order of the filters' numbers, and the labels of the panels."
    lines = [HEAD.format(sources=source, title=title) + "from typing import Literal, get_args\n"]
    lines += [choices[name].code() for name in sorted(choices)]
    rows = (f"    {label!r}: {tuple(sorted(names))!r},\n" for label, names in sorted(labels.items()))
    table = "".join(rows).replace("'", '"')
    lines.append("#: Labels without blanks, hyphens and underscores, and the choices that they mean.\n"
                 f"LABELS: dict[str, tuple[str, ...]] = {{\n{table}}}\n")  # fmt: skip
    return "\n".join(lines)


def read(sources: Path, files: list[Path]) -> list[tuple[Function, Path]]:
    """The functions of the proxies in the XML files."""
    found = []
    parts: dict[str, Parts] = {}
    for file in files:
        for proxy in ElementTree.parse(file).iterfind("ProxyGroup/*"):
            for hint in proxy.iterfind("Hints/Python"):
                module = hint.get("module", "")
                parts.setdefault(module, Parts(sources / f"{module}_parts.py"))
                found.append((Function(proxy, hint, parts[module]), file))
    return found


def all_choices(functions: list[Function]) -> tuple[dict[str, Choices], dict[str, set[str]]]:
    choices: dict[str, Choices] = {}
    labels: dict[str, set[str]] = {}
    for prop in (prop for function in functions for prop in function.properties if prop.choices):
        found = prop.choices
        assert found is not None
        if choices.setdefault(found.type, found) != found:
            raise Failure(f"{prop}: its entries differ from another property of the type {found.type}")
        for entry in prop.element.iterfind("EnumerationDomain/Entry"):
            label, name = entry.get("text", ""), entry.get("python")
            if name and folded(label) != folded(name):
                labels.setdefault(folded(label), set()).add(name)
    return choices, labels


def write(path: Path, text: str) -> None:
    """Write a file, unless it has this text; a link to a source of an earlier version is replaced."""
    if path.is_symlink():
        path.unlink()
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")
    print(path)


def main(sources: Path, package: Path, files: list[Path]) -> int:
    try:
        found = read(sources, files)
        choices, labels = all_choices([function for function, _ in found])
        texts = {"_choices": choices_text(choices, labels, "ServerManager")}
        for module in dict.fromkeys(function.module for function, _ in found):
            own = [(function, file) for function, file in found if function.module == module]
            source = f"ServerManager/{own[0][1].name}.in and python/tautline/{module}_parts.py"
            texts[module] = module_text([function for function, _ in own], choices, source)
    except (Failure, OSError, SyntaxError, ElementTree.ParseError) as error:
        print(f"generate.py: {error}", file=sys.stderr)
        return 1
    for name, text in texts.items():
        write(package / f"{name}.py", text)
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), Path(sys.argv[2]), [Path(argument) for argument in sys.argv[3:]]))
