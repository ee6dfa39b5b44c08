# SPDX-License-Identifier: BSD-3-Clause
"""The common parts of the shell commands: options, types of their values, input and output."""

from __future__ import annotations

import argparse
import os
import shutil
import sys
import warnings
from contextlib import contextmanager
from difflib import get_close_matches
from tempfile import TemporaryDirectory
from textwrap import fill
from typing import Any, Callable, Iterable, Iterator, Mapping, NoReturn

from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkDataSet, vtkUnstructuredGrid
from vtkmodules.vtkFiltersCore import vtkAppendFilter

from ._errors import WRONG_USAGE, Error, run as update
from ._files import check_stream_or_target, replace_bytes, replace_text
from ._groups import Groups
from ._io import as_mesh, can_be_template, check_output, losses, write
from ._names import find_name, nearest_name
from ._results import Result
from ._tables import csv_text, json_text

#: A command: runs with the parsed arguments; the exit code is 0 for None.
Run = Callable[[argparse.Namespace], "int | None"]

#: The file name that stands for the standard input or output.
STREAM = "-"
_HELP_WIDTH = 100
#: Arguments that are meshes to read.
_INPUTS = ("mesh", "input", "before", "after", "reference", "target", "geometry", "outline", "surface")
_STANDARD_INPUT = "standard-input.vtu"
_CHANGING = ("improve", "adapt")  # the commands that change cells
#: Commands that move points, which can also write formats that are only copied with new coordinates.
_MOVING = ("optimize", "untangle", "warp", "perturb")

EXIT_CODES = """exit codes:
  0    done
  1    an error, whose cause is on stderr; or the aim was missed: elements remain inverted, a solver did not converge
  2    wrong usage, or the name of a command, metric, preset or method that does not exist
  3    the mesh fails the criteria (quality --criteria)
  130  interrupted by Ctrl-C"""


#: The options that --help shows, by command, besides the ones in ALWAYS; --help-all shows all. Other commands show all.
BASIC = {
    "quality": ("output", "csv", "metrics", "worst", "criteria", "groups", "report"),
    "optimize": ("output", "csv", "preset", "objectives", "boundary", "fixed", "limits", "maximum_iterations"),
    "untangle": ("output", "csv", "preset", "boundary", "fixed"),
    "improve": ("output", "csv", "preset", "target_angle", "edge_length", "boundary", "fixed"),
    "adapt": ("output", "csv", "iterations", "elements", "growth", "anisotropic", "boundary", "regions", "pde",
              "source", "fixed", "given"),
    "warp": ("output", "csv", "displacement", "target", "rotate", "translate", "scale", "bend", "axis", "center",
             "moved", "method", "amount", "fixed"),
    "solve": ("output", "csv", "pde", "source", "fixed", "given", "solver", "preconditioner", "relative_tolerance"),
    "condition": ("output", "csv", "pde", "preconditioner"),
    "solver-study": ("csv", "pde", "combinations"),
    "peridynamics": ("output", "delta", "p", "basis", "model", "kernel", "add_layer"),
    "match": ("output", "csv", "method", "locations"),
    "retrieval": ("output", "csv", "sheet", "labels", "method"),
    "domain": ("output", "cells", "element_size"),
}  # fmt: skip
_ALWAYS = ("help", "help_all", "time_limit", "threads", "json", "quiet")
#: The destinations of the file that a command writes.
_OUTPUTS = ("output", "report")
_IN_PLACE = "in_place"


class Parser(argparse.ArgumentParser):
    """A parser with case-insensitive choices, whose messages name the nearest one.

    Errors come with one line of usage. The file to write may be the last argument, in the place of -o; `more` are
    further files to read. Both may be between options.
    """

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self.takes_more = False
        self._shows_all = False
        self._needs_output = False  # while arguments are parsed

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        output = self.output_action()
        self._needs_output = output is not None and output.required
        try:
            if output is not None:
                output.required = False  # it may be the last argument
            found, extra = super().parse_known_args(args, namespace)
        finally:
            if output is not None:
                output.required = self._needs_output
        self._check_options(extra)
        files = list(extra)
        if self.takes_more:
            found.more, extra = files, []
        elif output is not None and len(files) == 1 and getattr(found, output.dest) is None:
            setattr(found, output.dest, files[0])
            extra = []
        if extra:
            self.error(f"unrecognized arguments: {' '.join(extra)}")
        if any(action.dest == _IN_PLACE for action in self._actions) and found.in_place:
            if found.output is not None or found.mesh == STREAM:
                self.error("--in-place writes into the file that was read: leave out --output, and name a file")
            found.output = found.mesh
        if output is not None and self._needs_output and getattr(found, output.dest) is None:
            self.error(f"the following arguments are required: {'/'.join(output.option_strings)}")
        return found, extra

    def _check_options(self, extra: list[str]) -> None:
        """End with an error, with the nearest option, if an option is unknown."""
        known = [name for action in self._actions for name in action.option_strings if name.startswith("--")]
        for text in extra:
            if text.startswith("-") and text != STREAM:
                near = get_close_matches(text.partition("=")[0], known, 1)
                self.error(f"unrecognized arguments: {text}" + (f" (did you mean {near[0]!r}?)" if near else ""))

    def output_action(self) -> argparse.Action | None:
        """The option of the file to write."""
        return next((a for a in self._actions if a.dest in _OUTPUTS and "-o" in a.option_strings), None)

    def short_usage(self) -> str:
        """The usage in one line."""
        words, output = [self.prog], self.output_action()
        for action in self._actions:
            if not action.option_strings:
                name = str(action.metavar or action.dest)
                words.append(f"{name}..." if self.takes_more and action.dest == "mesh" else name)
            elif action.required and action is not output:
                words.append(f"{action.option_strings[0]} {action.metavar or action.dest.upper()}")
        if output is not None and not self.takes_more:
            words.append("OUTPUT" if output.required or self._needs_output else "[OUTPUT]")
        return " ".join([*words, "[OPTION...]"])

    def format_usage(self) -> str:
        return f"usage: {self.short_usage()}\n"

    def error(self, message: str) -> NoReturn:
        """Print the usage and the message, and end with exit code 2."""
        self.exit(WRONG_USAGE, f"{self.format_usage()}{self.prog}: error: {message} (see {self.prog} --help)\n")

    def format_help(self) -> str:
        shown = BASIC.get(self.prog.split()[-1])
        hidden = []
        if shown is not None and not self._shows_all:
            hidden = [a for a in self._actions if a.option_strings and a.dest not in (*shown, *_ALWAYS)]
            hidden = [action for action in hidden if action.help != argparse.SUPPRESS]
        texts = [action.help for action in hidden]
        try:
            for action in hidden:
                action.help = argparse.SUPPRESS
            text = self._help_text()
        finally:
            for action, words in zip(hidden, texts):
                action.help = words
        more = f"\n{len(hidden)} more options: {self.prog} --help-all\n" if hidden else ""
        return text.rstrip("\n") + "\n" + more

    def _help_text(self) -> str:
        """The help, with the usage in one line."""
        kept, self.usage = self.usage, self.short_usage()
        try:
            return super().format_help()
        finally:
            self.usage = kept

    def show_all(self) -> None:
        """Print the help with all options."""
        self._shows_all = True
        self.print_help()
        self.exit()

    def _get_value(self, action: argparse.Action, arg_string: str) -> Any:
        value = super()._get_value(action, arg_string)
        names = _choices(action)
        return find_name(value, names) or value if names else value

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        names = list(action.choices or ())
        if action.choices is not None and value not in action.choices:
            near = nearest_name(value, [name for name in names if isinstance(name, str)])
            is_command = near and action.option_strings == []
            choose = "" if is_command else f" (choose from {', '.join(map(repr, names))})"
            raise argparse.ArgumentError(action, f"invalid choice: {value!r}{near}{choose}")


class _HelpAll(argparse.Action):
    """--help-all."""

    def __call__(self, parser: Any, *_: Any) -> None:
        parser.show_all()


def _choices(action: argparse.Action) -> list[str]:
    """The allowed values of an option; none for the commands."""
    if action.choices is None or isinstance(action, argparse._SubParsersAction):
        return []
    return [name for name in action.choices if isinstance(name, str)]


def add_command(
    commands: Any,
    name: str,
    run: Run,
    text: str,
    *,
    example: str,
    details: str = "",
    threads: bool = True,
    aliases: Iterable[str] = (),
) -> argparse.ArgumentParser:
    """Add a command to the subparsers `commands`.

    text: its help. details: further sentences of its description. example: the arguments of an example.
    aliases: older names.
    """
    parser: argparse.ArgumentParser = commands.add_parser(
        name,
        help=text,
        description=f"{text[0].upper()}{text[1:]}. {details}".strip(),
        formatter_class=argparse.RawDescriptionHelpFormatter,
        aliases=list(aliases),
    )
    parser.description = fill(parser.description or "", _HELP_WIDTH)
    parser.epilog = f"example:\n  {parser.prog} {example}".rstrip() + "\n\nexit codes: see --help without a command"
    parser.set_defaults(run=run)
    if threads:
        parser.add_argument("--threads", type=int, default=0, help="number of threads; 0, the default, is all cores")
    parser.add_argument("--help-all", action=_HelpAll, nargs=0, default=argparse.SUPPRESS, help="show all options")
    parser.add_argument("--json", action="store_true", help="print the result as JSON, and nothing else")
    parser.add_argument("-q", "--quiet", action="store_true", help="print errors only")
    return parser


def add_mesh(parser: argparse.ArgumentParser) -> None:
    """Add the mesh to read."""
    parser.add_argument("mesh", metavar="FILE", help="mesh to read; - is a .vtu from the standard input")


def take_more(parser: argparse.ArgumentParser) -> None:
    """Let the command take further meshes, the argument `more`, a list."""
    assert isinstance(parser, Parser)
    parser.takes_more = True
    parser.set_defaults(more=[])


def add_output(parser: argparse.ArgumentParser, text: str = "mesh to write", required: bool = True) -> None:
    """Add the option of the mesh to write, which may also be the last argument; see Parser."""
    parser.add_argument("-o", "--output", metavar="FILE", required=required,
                        help=f"{text}; its ending decides on the format, - is the standard output")  # fmt: skip
    if required and any(action.dest == "mesh" for action in parser._actions):
        parser.add_argument("--in-place", action="store_true", dest=_IN_PLACE, help="write into the file that was read")
        parser.add_argument("--keep-original", action="store_true",
                            help="with OpenFOAM: keep the points that are replaced as points.orig")  # fmt: skip


def add_metrics(parser: argparse.ArgumentParser) -> None:
    """Add the option of the metrics."""
    parser.add_argument("--metrics", type=names, default=["imr"], metavar="NAME,...",
                        help="names of metrics, see the command metrics (default: imr)")  # fmt: skip


def add_time_limit(parser: argparse.ArgumentParser, default: float = 0.0) -> None:
    """Add the option of the time limit."""
    parser.add_argument("--time-limit", type=float, default=default, metavar="SECONDS",
                        help=f"0 is no limit (default: {default:g})")  # fmt: skip


def add_merge_points(parser: argparse.ArgumentParser) -> None:
    """Add the option of the coincident points."""
    add_flag(parser, "merge_coincident_points", "whether coincident points on matching facets are one point")


def add_flag(
    parser: argparse.ArgumentParser, name: str, text: str, off: str | None = None, default: bool | None = True
) -> None:
    """Add --name and --no-name for an argument that is True by default; `off` is an older name of the latter."""
    flag = "--" + name.replace("_", "-")
    parser.add_argument(flag, action=argparse.BooleanOptionalAction, default=default, help=text)
    if off:
        parser.add_argument(off, action="store_false", dest=name, help=argparse.SUPPRESS)


def names(text: str) -> list[str]:
    """Names with commas between them, for argparse."""
    return [name.strip() for name in text.split(",") if name.strip()]


def numbers(text: str) -> list[float]:
    """Numbers with commas between them, for argparse."""
    try:
        return [float(part) for part in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a list of numbers with commas between them") from None


def number_or_name(text: str) -> float | str:
    """A number, or the text if it is not a number."""
    try:
        return float(text)
    except ValueError:
        return text


def numbers_or_text(text: str, kind: type = float) -> Any:
    """A list of numbers if the text has numbers with commas between them, otherwise the text."""
    try:
        return [kind(part) for part in text.split(",")]
    except ValueError:
        return text


def given(arguments: argparse.Namespace, names: Iterable[str]) -> dict[str, Any]:
    """The values of options by name."""
    return {name: getattr(arguments, name) for name in names}


def counts(mesh: Any) -> str:
    """The size of a mesh in words."""
    return f"{mesh.GetNumberOfPoints()} points, {mesh.GetNumberOfCells()} cells"


def check_outputs(arguments: argparse.Namespace) -> None:
    """Raise Error if a file that the command is to write cannot be written, before it does anything else."""
    output = getattr(arguments, "output", None)
    texts = ("csv", "report", "certificate")
    streams = [f"--{name} -" for name in ("output", *texts) if getattr(arguments, name, None) == STREAM]
    streams += ["--json"] if arguments.json else []
    if len(streams) > 1:
        raise Error(f"{' and '.join(streams)} would all write to the standard output: choose one")
    if output and output != STREAM:
        source = getattr(arguments, "mesh", None)
        check_output(output, source if isinstance(source, str) and arguments.command in _MOVING else "")
    for name in texts:
        if getattr(arguments, name, None):
            check_stream_or_target(_stream(getattr(arguments, name)))


def _stream(file: str) -> str:
    return "/dev/stdout" if file == STREAM else file


@contextmanager
def standard_input(arguments: argparse.Namespace) -> Iterator[None]:
    """A block in which the mesh argument that is "-", if any, is a file with the .vtu from the standard input."""
    names = [name for name in _INPUTS if getattr(arguments, name, None) == STREAM]
    if not names:
        yield
        return
    if len(names) > 1:
        raise Error(f"{' and '.join(names)} cannot both be the standard input")
    with TemporaryDirectory() as folder:
        file = os.path.join(folder, _STANDARD_INPUT)
        replace_bytes(file, sys.stdin.buffer.read())
        setattr(arguments, names[0], file)
        yield


def finish(
    arguments: argparse.Namespace,
    result: Result | vtkDataObject | None,
    text: str,
    rows: list[dict[str, Any]] | None = None,
    texts: Mapping[str, str] | None = None,
    facts: Mapping[str, Any] | None = None,
    **options: Any,
) -> None:
    """Print a result and write its files.

    text: the result in words. rows: for the file --csv. texts: more files with their contents. facts: what --json
    prints if there is no result with to_dict(). options: of write(). The files are listed after the text, in the JSON
    as `files`. With --output -, everything else is printed to stderr.
    """
    out = sys.stderr if getattr(arguments, "output", None) == STREAM else sys.stdout
    silent = arguments.quiet or arguments.json
    if not silent:
        print(text, file=out)
    files = []
    if getattr(arguments, "output", None) == STREAM:
        _write_stream(result, options.get("groups"))
    elif getattr(arguments, "output", None):
        files += _write(arguments, result, options)
    texts = dict(texts or {})
    if getattr(arguments, "csv", None):
        texts[arguments.csv] = csv_text(rows or [])
    for file, content in texts.items():
        replace_text(_stream(file), content, stream=True)
        files.append(file)
    if arguments.json:
        found = facts if facts is not None else _facts(result)
        print(json_text({**found, "files": files}))
    elif files and not silent:
        print("\n".join(files), file=out)


def _write(arguments: argparse.Namespace, result: Any, options: dict[str, Any]) -> list[str]:
    """Write a mesh; after a motion of points, to the format that was read: the file itself with new coordinates."""
    source, output = getattr(arguments, "mesh", None), arguments.output
    if isinstance(source, str) and arguments.command in _CHANGING and can_be_template(source, output):
        lost = losses(source)
        if lost:
            warnings.warn(f"{output}: points and cells changed, so it lacks {lost} of {source}", stacklevel=2)
    if getattr(arguments, "keep_original", False):
        options = {**options, "keep_original": True}
    return write(result, output, **options)


def _facts(result: Any) -> dict[str, Any]:
    if isinstance(result, Result):
        return result.to_dict()
    return {"points": result.GetNumberOfPoints(), "cells": result.GetNumberOfCells()}


def _write_stream(result: Any, groups: Groups | None) -> None:
    """Write a mesh as .vtu to the standard output."""
    data = as_mesh(result)
    if isinstance(data, vtkDataSet) and not isinstance(data, vtkUnstructuredGrid):
        append = vtkAppendFilter()
        append.AddInputData(data)
        update(append)
        data = append.GetOutput()
    with TemporaryDirectory() as folder:
        file = os.path.join(folder, "standard-output.vtu")
        write(data, file, groups=groups)
        with open(file, "rb") as content:
            shutil.copyfileobj(content, sys.stdout.buffer)
    sys.stdout.flush()
