# SPDX-License-Identifier: BSD-3-Clause
"""A property of a proxy as an argument of a function."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from functools import cached_property
from textwrap import indent
from typing import TYPE_CHECKING

from parts import Argument
from texts import Failure, call, first_sentence, listed, quoted, snake, uncapitalized, wrapped

if TYPE_CHECKING:
    from functions import Function

LIMITS = {"Int": ("-(2**31)", "2**31 - 1"), "IdType": ("-(2**63)", "2**63 - 1"), "Double": ("-np.inf", "np.inf")}


@dataclass
class Choices:
    """An enumeration."""

    type: str
    names: list[str]
    values: list[int]

    @property
    def tuple(self) -> str:
        name = snake(self.type).upper()
        return name[:-1] + "IES" if name.endswith("Y") else name + "S"

    def code(self) -> str:
        lines = call(f"{self.type} = Literal[", [f'"{name}"' for name in self.names], "]", 0)
        return f"{lines}\n{self.tuple}: tuple[{self.type}, ...] = get_args({self.type})\n"


class Property:
    """A property of a proxy."""

    def __init__(self, element: ElementTree.Element, function: Function) -> None:
        self.element, self.function = element, function
        self.name = element.get("name", "")
        self.kind = element.tag.removesuffix("Property").removesuffix("Vector")
        self.argument_name = element.get("python", snake(self.name))

    def __str__(self) -> str:
        return f"{self.function.proxy.get('name')}.{self.name}"

    @cached_property
    def is_argument(self) -> bool:
        """Whether it is an input: neither a result nor the selection that a panel copies from the view."""
        selection = self.element.find("DataTypeDomain/DataType[@value='vtkSelection']") is not None
        return not (selection or self.element.get("information_only") == "1" or self.name == "Input")

    @cached_property
    def choices(self) -> Choices | None:
        """The choices of an enumeration; none for metrics, whose names are found at run time."""
        domain = self.element.find("EnumerationDomain")
        if domain is None or domain.find("RequiredProperties") is not None or not self.is_argument:
            return None
        entries = sorted(domain.iterfind("Entry"), key=lambda entry: int(entry.get("value", "")))
        names = [entry.get("python", entry.get("text", "").lower()) for entry in entries]
        own = self.function.name.title().replace("_", "") + self.name
        return Choices(self.element.get("python_type", own), names, [int(e.get("value", "")) for e in entries])

    @cached_property
    def text(self) -> str:
        """The documentation, in Python's terms."""
        text = self.function.translated(self.element.findtext("Documentation", ""))
        for entry in self.element.iterfind("EnumerationDomain/Entry"):
            label = entry.get("text", "")
            start = rf"(?i:(^|(?<=\. )){re.escape(label)}:)"
            text = re.sub(start, f'"{entry.get("python", label.lower())}":', text)
        return text

    @cached_property
    def default(self) -> str:
        """The default as the shell shows it."""
        value = self.element.get("python_default", self.element.get("default_values", "None"))
        if self.element.find("EnumerationDomain/RequiredProperties") is not None:
            return "None"
        if self.choices is not None and value.lstrip("-").isdigit():
            return self.choices.names[self.choices.values.index(int(value))]
        return "None" if "|" in value else value

    @cached_property
    def custom(self) -> bool:
        """Whether the panel shows it with the value 0 of the property that `custom` names only."""
        by = self.function.hint.get("custom", "")
        mark = f".//PropertyWidgetDecorator[@property='{by}'][@value='0']"
        data = self.kind == "Input" or self.element.get("command") == "SetInputArrayToProcess"
        return bool(by) and not data and self.element.find(f"Hints{mark[1:]}") is not None

    def argument(self) -> Argument:
        """The argument that sets this property."""
        made = self._made()
        made.custom = self.custom
        if (self.custom or self.element.get("python_default") == "None") and not made.type.endswith("None"):
            shown = quoted(self.default) if self.choices else made.default.removesuffix(".0")
            by = f'with {snake(self.function.hint.get("custom", ""))} "custom", the' if self.custom else "the"
            made.entry += f" {by.capitalize()} default is {shown}." if made.default != "None" else ""
            made.type, made.default = f"{made.type} | None", "None"
            made.code = f"    if {made.name} is not None:\n{indent(made.code, '    ')}"
        made.entry = wrapped(f"{made.name}: {uncapitalized(made.entry)}", 4, 8)
        made.option = self._option(made) if made.name != "threads" else ""
        return made

    def _made(self) -> Argument:
        count = self.element.get("number_of_elements", "1")
        if self.kind == "Input":
            return self._mesh()
        if self.element.get("command") == "SetInputArrayToProcess":
            return self._array()
        if count != "1" or self.element.get("repeat_command") == "1":
            remedy = f"give it a setter in {self.function.module}_parts.py, or python=''"
            raise Failure(f"{self} is not one value: {remedy}")
        if self.element.find("BooleanDomain") is not None:
            return self._flag()
        if self.choices is not None:
            return self._choice(self.choices)
        if self.element.find("EnumerationDomain") is not None:
            name, setter = self.argument_name, self.element.get("command")
            code = f'    if {name} is not None:\n        filter_.{setter}ByName(metric_name({name}, "{name}"))'
            text = re.sub(r'"automatic":', "None:", self.text)
            return Argument(name, "str | None", "None", f"the name of a metric. {text}", code, names={"metric_name"})
        if self.kind == "String":
            default = f'"{self.element.get("default_values", "")}"'
            name = self.argument_name
            return Argument(name, "str", default, self.text, self._set(f'text("{name}", {name})'), names={"text"})
        return self._number()

    def _set(self, value: str) -> str:
        return call(f"filter_.{self.element.get('command')}(", [value], ")", 4)

    def _mesh(self) -> Argument:
        name, port = self.argument_name, self.element.get("port_index", "0")
        code = f"    if {name} is not None:\n        filter_.SetInputDataObject({port}, as_mesh({name}))"
        return Argument(name, "Mesh | None", "None", self.text, code, names={"Mesh", "as_mesh"})

    def _array(self) -> Argument:
        name, index = self.argument_name, self.element.get("default_values", "0").split("|")[0]
        domain = self.element.find("ArrayListDomain")
        source = self.function.array_domain(domain.get("input_domain_name", "") if domain is not None else "")
        on = {"point": "POINTS", "cell": "CELLS"}.get(source.get("attribute_type", ""), "ANY")
        parts = [index, name, f'"{name}"', on]
        parts += ["scalar=True"] if source.get("number_of_components") == "1" else []
        row = {"POINTS": "point", "CELLS": "cell", "ANY": "cell or point"}[on]
        entry = re.sub(rf"^A {row} array", rf"A {row} array (its name, or one row per {row})", self.text)
        entry += "" if entry != self.text else f" The name of an array of the mesh, or one row per {row}."
        code = call("inputs.use(", parts, ")", 4)
        return Argument(name, "Values | None", "None", entry, code, names={"Values", on})

    def _flag(self) -> Argument:
        name, default = self.argument_name, self.element.get("default_values") == "1"
        default = bool(int(self.element.get("python_default", default)))
        code = self._set(f'flag("{name}", {name})')
        return Argument(name, "bool", str(default), self.text, code, names={"flag"})

    def _choice(self, choices: Choices) -> Argument:
        name, default = self.argument_name, self.default
        entry = f"{listed(choices.names)}. {self.text}"
        type_, picked, used = choices.type, name, {choices.type, choices.tuple, "pick"}
        if meant := self.element.get("python_true"):
            type_, picked = f"{type_} | bool", f'flagged({name}, "{choices.names[0]}", "{meant}")'
            entry = f'{listed(choices.names)}; True is "{meant}". {self.text}'
            used.add("flagged")
        index = f'pick("{name}", {picked}, {choices.tuple})'
        if choices.values != list(range(len(choices.values))):
            index = f"{tuple(choices.values)}[{index}]"
        return Argument(name, type_, f'"{default}"', entry, self._set(index), names=used)

    def _number(self) -> Argument:
        name = self.argument_name
        low, high = LIMITS[self.kind]
        domain = self.element.find(f"{'Int' if self.kind == 'IdType' else self.kind}RangeDomain")
        if domain is not None:
            low, high = domain.get("min", low), domain.get("max", high)
        low, high = self.element.get("python_min", low), self.element.get("python_max", high)
        high = "np.inf" if high == "inf" else high
        text = self.text
        if not any("np." in end or "**" in end for end in (low, high)) and name != "threads":
            text += f" From {low} to {high}."
        if above := self.element.get("python_above"):
            low = f"np.nextafter({above}, np.inf)"
        default = self.element.get("python_default", self.element.get("default_values", "0"))
        whole = self.kind != "Double"
        check = "whole" if whole else "within"
        default = default if whole or re.search(r"[.en]", default) else f"{default}.0"
        used = {check} | ({"np"} if "np." in low + high else set())
        code = self._set(f'{check}("{name}", {name}, {low}, {high})')
        return Argument(name, "int" if whole else "float", default, text, code, names=used)

    def _option(self, made: Argument) -> str:
        """The option of the shell: the call that adds it to the parser."""
        if self.element.get("shell") == "":
            return ""
        help_ = uncapitalized(self.element.get("shell") or first_sentence(self.text))
        if help_.startswith('"'):  # one of the choices, which are listed
            help_ = uncapitalized(self.element.get("label", self.name))
        flag = "--" + made.name.rstrip("_").replace("_", "-")
        old = [quoted(name)] if (name := self.element.get("shell_old")) else []
        old += [quoted(flag[1:])] if len(made.name) == 1 else []
        old += [f'dest="{made.name}"'] if made.name.endswith("_") else []
        if self.element.find("BooleanDomain") is not None:
            if made.default == "False":
                parts = [f'"{flag}"', 'action="store_true"', f"help={quoted(help_)}"]
                return call("parser.add_argument(", parts, ")", 4)
            parts = ["parser", f'"{made.name}"', quoted(help_), *old, *(["default=None"] if made.custom else [])]
            return call("_commands.add_flag(", parts, ")", 4)
        help_ += f" (default: {self.default})" if self.default != "None" else ""
        parts = [f'"{flag}"', *old, f"default={made.default}", *self._option_type(made)]
        parts.append(f"help={quoted(help_.replace('%', '%%'))}")
        return call("parser.add_argument(", parts, ")", 4)

    def _option_type(self, made: Argument) -> list[str]:
        if self.choices is not None:
            made.names.add(self.choices.tuple)
            return [f"choices={self.choices.tuple}"]
        if made.type == "str | None":
            return ['metavar="NAME"']
        if self.kind in ("Int", "IdType"):
            return ["type=int", 'metavar="N"']
        if self.kind == "Double":
            words = {"time_limit": "SECONDS", "angle": "DEGREES"}
            word = words.get(made.name) or words.get(made.name.rpartition("_")[2]) or "X"
            return ["type=float", f'metavar="{word}"']
        word = "FILE" if self.kind == "Input" else "ARRAY" if self.default == "None" else "NAME"
        return [f'metavar="{word}"']
