# SPDX-License-Identifier: BSD-3-Clause
"""The handwritten parts of the generated functions: <module>_parts.py, which is read, not imported."""

from __future__ import annotations

import ast
from dataclasses import dataclass, field
from pathlib import Path
from textwrap import indent

from texts import Failure


@dataclass
class Argument:
    """An argument of a function: its position in the signature, its documentation, its setter and its option."""

    name: str
    type: str
    default: str | None
    entry: str = ""
    code: str = ""
    option: str = ""
    custom: bool = False
    names: set[str] = field(default_factory=set)  # that its code needs


@dataclass
class Setter:
    """A function of <module>_parts.py that sets properties from arguments of its own."""

    name: str
    properties: list[str]
    parameters: list[str]
    others: list[str]  # keywords, which are not its own arguments
    arguments: list[Argument]


class Parts:
    """The handwritten parts: <module>_parts.py."""

    def __init__(self, path: Path) -> None:
        self.module = path.stem
        self.source = path.read_text(encoding="utf-8")
        tree = ast.parse(self.source)
        self.functions = {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}
        #: The origin of the names in this module.
        self.origin: dict[str, str] = {}
        for node in tree.body:
            if isinstance(node, ast.ImportFrom):
                module = "." * node.level + (node.module or "")
                self.origin |= {alias.asname or alias.name: module for alias in node.names}
            elif isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                self.origin[node.name] = f".{self.module}"
            elif isinstance(node, (ast.Assign, ast.AnnAssign)):
                targets = node.targets if isinstance(node, ast.Assign) else [node.target]
                self.origin |= {t.id: f".{self.module}" for t in targets if isinstance(t, ast.Name)}

    def returned(self, name: str) -> str:
        """The type that a function returns."""
        node = self.functions.get(name)
        if node is None or node.returns is None:
            raise Failure(f"{self.module}.py has no {name}() with the type of its result")
        return ast.unparse(node.returns)

    def setters(self, function: str) -> list[Setter]:
        found = []
        for node in self.functions.values():
            marks = [d for d in node.decorator_list if isinstance(d, ast.Call) and ast.unparse(d.func) == "sets"]
            words = [[str(ast.literal_eval(word)) for word in mark.args] for mark in marks]
            own = [properties for names, *properties in words if function in names.split()]
            if own:
                found.append(self._setter(node, own[0]))
        return found

    def input(self, function: str) -> Setter | None:
        """NAME_input(), whose parameters are the first arguments."""
        node = self.functions.get(f"{function}_input")
        return self._setter(node, [], required=True) if node else None

    def result(self, function: str) -> Setter:
        """NAME_result(), whose parameters after the filter and its output are also arguments."""
        return self._setter(self.functions[f"{function}_result"], [])

    def _setter(self, node: ast.FunctionDef, properties: list[str], required: bool = False) -> Setter:
        parameters = node.args.args
        defaults = [None] * (len(parameters) - len(node.args.defaults)) + node.args.defaults
        arguments = []
        for parameter, default in list(zip(parameters, defaults))[1:] if required else zip(parameters, defaults):
            if (default is not None or required) and parameter.annotation is not None:
                text = ast.get_source_segment(self.source, default) if default else None
                type_ = ast.get_source_segment(self.source, parameter.annotation) or ""
                names = names_in(parameter.annotation, default)
                arguments.append(Argument(parameter.arg, type_, text, names=names))
        _, _, entries = (ast.get_docstring(node) or "").partition("\n\n")
        if arguments:
            arguments[0].entry = indent(entries, "    ").rstrip()
        others = [parameter.arg for parameter in node.args.kwonlyargs]
        return Setter(node.name, properties, [parameter.arg for parameter in parameters], others, arguments)


def names_in(*nodes: ast.AST | None) -> set[str]:
    return {name.id for node in nodes if node for name in ast.walk(node) if isinstance(name, ast.Name)}
