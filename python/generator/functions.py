# SPDX-License-Identifier: BSD-3-Clause
"""A proxy as a function and a command of the shell."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from functools import cached_property
from textwrap import dedent, indent

from numpydoc import numpydoc, quoted_lines, type_of
from parts import Argument, Parts, Setter
from properties import Property
from texts import Failure, call, quoted, wrapped

#: The last arguments of every function that has them.
COMMON = ("time_limit", "threads", "merge_coincident_points", "reproducible_order", "redistribute")
PROGRESS = """progress: True: a bar on the terminal, if there is one. Otherwise a function, called ten times a second
    with the fraction done, 0 to 1, and a text; it cancels by returning False, which raises Aborted. Ctrl-C raises
    KeyboardInterrupt."""
MESH = "Given as {kind}, a composite data set, a file name or (points, cells). It is not changed."


class Function:
    """A function of the package, from a proxy with the hint Python."""

    def __init__(self, proxy: ElementTree.Element, hint: ElementTree.Element, parts: Parts) -> None:
        self.proxy, self.hint, self.parts = proxy, hint, parts
        self.name = hint.get("function", "")
        self.module = hint.get("module", "")
        self.command = self.name.replace("_", "-")
        elements = [child for child in proxy if child.tag.endswith("Property")]
        self.properties = [Property(element, self) for element in elements]
        self.own_input = parts.input(self.name)
        self.input = next((p for p in self.properties if p.name == "Input"), None) if self.own_input is None else None
        self.setters = parts.setters(self.name)
        self.result = parts.returned(f"{self.name}_result")

    def array_domain(self, name: str) -> ElementTree.Element:
        found = self.input.element.find(f"InputArrayDomain[@name='{name}']") if self.input else None
        if found is None:
            raise Failure(f"{self.proxy.get('name')}: the input has no InputArrayDomain {name!r}")
        return found

    @cached_property
    def words(self) -> dict[str, str]:
        """Labels of the panel, and their equivalents in Python."""
        claimed = {name for setter in self.setters for name in setter.properties}
        own = [p for p in self.properties if p.is_argument and p.argument_name and p.name not in claimed]
        words = {label: p.argument_name for p in own if " " in (label := p.element.get("label", p.name))}
        for prop in self.properties:
            domain = prop.element.find("EnumerationDomain")
            for entry in domain.iterfind("Entry") if domain is not None and prop.choices else ():
                label = entry.get("text", "")
                words[f"*{label}*"] = f'"{entry.get("python", label.lower())}"'
        return words

    def translated(self, text: str) -> str:
        """A text of the panel for users of Python: one line, with names of arguments and choices."""
        text = " ".join(["", *text.split()])
        for label in sorted(self.words, key=len, reverse=True):
            text = text.replace(label, self.words[label])
        text = re.sub(r"\*+([^*]+)\*+", r"\1", text)
        return re.sub(r"\b[Oo]ff:", "False:", re.sub(r"\b[Oo]n:", "True:", text)).strip()

    @cached_property
    def arguments(self) -> list[Argument]:
        """In the order of the signature, without the mesh and progress."""
        claimed = {name: setter for setter in self.setters for name in setter.properties}
        unknown = set(claimed) - {p.name for p in self.properties}
        if unknown:
            where = f"of sets() in {self.parts.module}.py"
            raise Failure(f"{self.proxy.get('name')} has no property {sorted(unknown)[0]}, {where}")
        found = list(self.own_input.arguments) if self.own_input else []
        required = [argument.name for argument in found if argument.default is None]
        found += [argument for setter in self.setters if not setter.properties for argument in setter.arguments]
        placed: set[str] = set()
        for prop in self.properties:
            setter = claimed.get(prop.name)
            if setter and setter.name not in placed:
                placed.add(setter.name)
                for argument in setter.arguments:
                    argument.custom = all(p.custom for p in self.properties if p.name in setter.properties)
                found += setter.arguments
            elif not setter and prop.is_argument and prop.argument_name:
                found.append(prop.argument())
        found += self.parts.result(self.name).arguments
        others = [argument.name for argument in found if argument.name not in (*self.positional, *COMMON)]
        order = list(dict.fromkeys([*required, *self.positional, *others, *COMMON]))
        return sorted(found, key=lambda argument: order.index(argument.name))

    @cached_property
    def positional(self) -> list[str]:
        return self.hint.get("positional", "").split()

    # --- the text -------------------------------------------------------------------------------------------

    def signature(self, name: str, result: str, progress: bool) -> str:
        lines = ["mesh: Mesh"] if self.input else []
        keyword = False
        for argument in self.arguments:
            if argument.name not in self.positional and argument.default is not None and not keyword:
                keyword = True
                lines.append("*")
            default = "" if argument.default is None else f" = {argument.default}"
            lines.append(f"{argument.name}: {argument.type}{default}")
        if progress:
            lines += [] if keyword else ["*"]
            lines.append("progress: Progress | bool | None = None")
        return f"def {name}(\n" + "".join(f"    {line},\n" for line in lines) + f") -> {result}:\n"

    def docstring(self) -> str:
        head = self.proxy.find("Documentation")
        blocks = re.split(r"\n\s*\n", (self.hint.text or "").strip("\n"))
        blocks = [block for block in blocks if block.strip()]
        after = next((i for i, block in enumerate(blocks) if block.lstrip().startswith(("Raises", ">>>"))), len(blocks))
        entries = [argument.entry for argument in self.arguments if argument.entry]
        if self.input is not None:
            type_ = self.input.element.find("DataTypeDomain/DataType")
            grid = type_ is None or type_.get("value") != "vtkPointSet"
            kind = MESH.format(kind="a vtkDataSet" if grid else "a vtkDataSet with explicit points")
            text = self.translated(self.input.element.findtext("Documentation", "")).removeprefix("The mesh: ")
            entries.insert(0, wrapped(f"mesh: {text} {kind}", 4, 8))
        entries.append(indent(PROGRESS, "    "))
        parts = [head.get("short_help", "") if head is not None else ""]
        parts += [*blocks[:after], dedent("\n".join(entries)), *blocks[after:]]
        types = {a.name: type_of(a.type, a.default, self.choice_types) for a in self.arguments}
        types |= {"mesh": "Mesh", "progress": "bool or callable, optional"}
        return quoted_lines(numpydoc("\n\n".join(part.rstrip() for part in parts), types, self.result))

    @cached_property
    def choice_types(self) -> set[str]:
        """The names of the types of enumerations, whose values are texts."""
        own = {name for name, origin in self.parts.origin.items() if origin == "._choices"}
        literals = set(re.findall(r"^(\w+) = Literal\[", self.parts.source, re.MULTILINE))
        literals |= set(re.findall(r"^(\w+): \w+ = Literal\[", self.parts.source, re.MULTILINE))
        return own | literals | {prop.choices.type for prop in self.properties if prop.choices}

    def body(self) -> str:
        """The code that makes the filter, sets and runs it."""
        lines = [f"    filter_ = _vtk.{self.proxy.get('class')}()", "    messages = watch(filter_)"]
        if self.input:
            lines.append("    inputs = InputArrays(filter_, as_mesh(mesh))")
        lines += [argument.code for argument in self.arguments if argument.code]
        lines += [self._setter_call(setter) for setter in self.setters]
        if self.input:
            lines.append("    filter_.SetInputDataObject(0, inputs.mesh)")
        if self.own_input:
            lines.append(call(f"{self.own_input.name}(", self.own_input.parameters, ")", 4))
        lines.append("    run(filter_, messages)")
        if self.input:
            lines.append("    inputs.remove_from(filter_.GetOutputDataObject(0))")
        return "\n".join(lines) + "\n"

    def _setter_call(self, setter: Setter) -> str:
        pairs = [f'"{a.name}": {a.name}' for a in self.arguments if a.custom]
        custom = call("custom={", pairs, "}", 8).strip()
        others = [custom if name == "custom" else f"{name}={name}" for name in setter.others]
        return call(f"{setter.name}(", [*setter.parameters, *others], ")", 4)

    def code(self) -> str:
        """The function, and the command of the shell."""
        inner = self.hint.get("filter")
        more = [f"{argument.name}={argument.name}" for argument in self.parts.result(self.name).arguments]
        values = ", ".join(["filter_", "viewed(filter_.GetOutputDataObject(0))", *more])
        made = f"    return {self.name}_result({values})\n"
        head = self.signature(self.name, self.result, True)
        if not inner:
            return f"@interruptible\n{head}{self.docstring()}{self.body()}{made}"
        given = ["mesh"] if self.input else []
        given += [a.name if a.name in self.positional else f"{a.name}={a.name}" for a in self.arguments]
        text = f'    """The filter that has run; with the arguments of {self.name}()."""\n'
        outer = call(f"filter_ = {inner}(", given, ")", 4)
        return (
            f"@interruptible\n{head}{self.docstring()}{outer}\n{made}\n\n"
            f"{self.signature(inner, 'Any', False)}{text}{self.body()}    return filter_\n"
        )

    def commands(self) -> str:
        """The code that adds the command to a parser."""
        short = self.proxy.find("Documentation")
        help_ = self.hint.get("help") or (short.get("short_help", "") if short is not None else "").rstrip(".")
        help_ = help_[0].lower() + help_[1:]
        parts = ["commands", f'"{self.command}"', f"_run_{self.name}", quoted(help_)]
        parts.append(f"example={quoted(self.hint.get('example', ''))}")
        if details := self.hint.get("details"):
            parts.append(f"details={quoted(' '.join(details.split()))}")
        if aliases := self.hint.get("aliases"):
            parts.append(f"aliases={aliases.split()!r}")
        if not any(argument.name == "threads" for argument in self.arguments):
            parts.append("threads=False")
        lines = [call("parser = _commands.add_command(", parts, ")", 4)]
        if self.input:
            lines.append("    _commands.add_mesh(parser)")
        output = self.hint.get("output", "mesh to write")
        required = "" if self.hint.get("output") is None else ", False"
        lines += [f"    _commands.add_output(parser, {quoted(output)}{required})"] if output else []
        if csv := self.hint.get("csv"):
            lines.append(f'    parser.add_argument("--csv", metavar="FILE", help={quoted(csv)})')
        lines += [argument.option for argument in self.arguments if argument.option]
        if f"add_{self.name}_options" in self.parts.functions:
            lines.append(f"    add_{self.name}_options(parser)")
        return "\n".join(lines) + "\n"

    def run(self) -> str:
        names = [a.name for a in self.arguments if a.option or a.name == "threads"]
        own = f" | {self.name}_options(arguments)" if f"{self.name}_options" in self.parts.functions else ""
        code = self.parts.returned(f"finish_{self.name}")
        give = "return " if code != "None" else ""
        needed = [argument.name for argument in self.arguments if argument.default is None]
        first = "".join(f"arguments.{name}, " for name in (["mesh"] if self.input else needed))
        lines = [
            f"def _run_{self.name}(arguments: argparse.Namespace) -> {code}:",
            call("names = (", [f'"{name}"' for name in names], ",)" if len(names) == 1 else ")", 4),
            f"    options: dict[str, Any] = _commands.given(arguments, names){own}",
            f"    {give}finish_{self.name}(arguments, {self.name}({first}**options))",
        ]
        if "finish" in self.hint.attrib:  # which needs the filter
            made = f"{self.hint.get('filter')}({first}**options)"
            lines[-1] = f"    {give}finish_{self.name}(arguments, {made}, options)"
            if self._several in self.parts.functions:
                made = f"lambda file: {self.hint.get('filter')}(file, **options)"
                lines.insert(-1, f"    if arguments.more:\n        {give}{self._several}(arguments, {made})")
        return "\n".join(lines) + "\n"

    @property
    def _several(self) -> str:
        return f"finish_{self.name}_of_several"

    def names(self) -> set[str]:
        """The imports of the code."""
        found = {"Any", "interruptible", "run", "viewed", "watch", "Progress", self.result, f"{self.name}_result"}
        found |= {f"finish_{self.name}"} | {setter.name for setter in self.setters}
        found |= {self._several} if self._several in self.parts.functions else set()
        found |= {self.own_input.name} if self.own_input else set()
        found |= {n for n in (f"add_{self.name}_options", f"{self.name}_options") if n in self.parts.functions}
        found |= {"Mesh", "as_mesh", "InputArrays"} if self.input else set()
        found |= {name for argument in self.arguments for name in argument.names}
        return found - {"int", "float", "str", "bool", "tuple", "dict", "list", "None"}
