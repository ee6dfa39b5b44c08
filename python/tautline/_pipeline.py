# SPDX-License-Identifier: BSD-3-Clause
"""The function run_steps: a file of steps (read, criteria, untangle, warp, report, ...) is checked, then run."""

from __future__ import annotations

import argparse
import os
from dataclasses import dataclass
from importlib import import_module
from inspect import signature
from os import PathLike
from pathlib import Path
from types import UnionType
from typing import Any, Callable, Literal, Mapping, NamedTuple, Union, get_args, get_origin, get_type_hints

from vtkmodules.vtkCommonDataModel import vtkDataObject

from . import _commands, _vtk
from ._errors import Error, interruptible, unknown
from ._files import check_input, check_target, file_name
from ._interrupts import Progress
from ._io import check_output, read, write
from ._metrics import choose, find_metric
from ._names import find_name, nearest_name
from ._quality_parts import criteria_presets
from ._results import Result
from ._state import STATE, run_state

#: The functions that a step can call, by the file of the capability. Each takes the mesh of the previous steps.
_FUNCTIONS = {
    "quality": "_quality",
    "perturb": "_perturbation",
    "untangle": "_untangling",
    "improve": "_reconnection",
    "optimize": "_optimization",
    "warp": "_deformation",
    "report": "_report",
}
#: Arguments of functions that are files to read.
_FILES_READ = ("before", "reference", "geometry", "target")
#: The name of the mesh that was read last, as such an argument.
_INPUT = "input"
#: Arguments that a step does not have.
_NOT_IN_STEPS = ("mesh", "progress")
_FAILED = 3  # exit code, as of the command quality


class _Step(NamedTuple):
    """A step that was checked."""

    number: int
    do: str
    options: dict[str, Any]


@dataclass(frozen=True, repr=False, eq=False)
class StepsResult(Result):
    """The result of run_steps().

    Attributes
    ----------
    mesh : vtkDataObject
        The mesh after the last step.
    results : list[Any]
        The result of each step that has one, in order.
    passed : bool
        Whether no step `criteria` failed.
    files : list[str]
        The files written.
    summary : str
        A line per step.
    """

    mesh: vtkDataObject
    results: list[Any]
    passed: bool
    files: list[str]
    summary: str

    def to_dict(self) -> dict[str, Any]:
        """Passed, files, and the facts of each result."""
        facts = [result.to_dict() for result in self.results if isinstance(result, Result)]
        return {"passed": self.passed, "results": facts, "summary": self.summary}


@interruptible
def run_steps(
    steps: str | PathLike[str] | Mapping[str, Any],
    *,
    check_only: bool = False,
    progress: Progress | bool | None = None,
) -> StepsResult | None:
    """Run the steps of a TOML file one after the other, each on the mesh of the previous one.

    Parameters
    ----------
    steps : str or path or Mapping[str, Any]
        The file, or its content as a dict. It has a table [[step]] per step with the key `do`: "read" (file),
        "criteria" (criteria, stop), "write" (file), "report" (file), "quality", "perturb", "untangle", "improve",
        "optimize" or "warp". The other keys are the arguments of the function of this name. "criteria" measures, and
        ends the run if the mesh fails, unless stop is false. The argument "before" of a report, and reference, geometry
        and target of others, may be "input", the mesh that was read last. File names are relative to the file's folder.
    check_only : bool, default False
        Check the steps, do not run them.
    progress : bool or callable, optional
        True: a bar on the terminal, if there is one. Otherwise a function, called ten times a second with the fraction
        done, 0 to 1, and a text; it cancels by returning False, which raises Aborted. Ctrl-C raises KeyboardInterrupt.

    Returns
    -------
    StepsResult | None
        The result, None with check_only.

    Raises
    ------
    Error
        With the number of the step.

    Notes
    -----
    Everything is checked before the first step runs: keys, names, numbers, files to read and to write.

    Examples
    --------
    >>> tautline.run_steps("steps.toml").mesh
    """
    content, folder = _content(steps)
    listed = _check(content, folder)
    return None if check_only else _run_all(listed)


def _content(steps: Any) -> tuple[Mapping[str, Any], Path]:
    if isinstance(steps, Mapping):
        return steps, Path(".")
    name = file_name(steps)
    check_input(name)
    try:
        import tomllib
    except ImportError:
        raise Error("files of steps need Python 3.11 or later") from None
    try:
        return tomllib.loads(Path(name).read_text(encoding="utf-8")), Path(name).parent
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise Error(f"{name}: {error}") from None


# --- checks -------------------------------------------------------------------------------------------------


def _check(content: Mapping[str, Any], folder: Path) -> list[_Step]:
    for key in content:
        if key != "step":
            raise Error(str(unknown("key of the file of steps", key, ["step"])))
    listed = content.get("step")
    if not isinstance(listed, list) or not listed or not all(isinstance(step, Mapping) for step in listed):
        raise Error("there are no steps: begin each with a line [[step]]")
    made: list[str] = []
    steps = []
    for number, step in enumerate(listed, 1):
        try:
            steps.append(_checked_step(number, dict(step), folder, made))
        except Error as error:
            raise Error(f"step {number}: {error}") from None
    if steps[0].do != "read":
        raise Error("step 1: the first step has to be read")
    return steps


def _known_steps() -> list[str]:
    built = [name for name, capability in _FUNCTIONS.items() if _vtk.available(capability)]
    return ["read", "criteria", "write", *built]


def _checked_step(number: int, step: dict[str, Any], folder: Path, made: list[str]) -> _Step:
    """A step after the checks; `made` are the files that earlier ones write."""
    name = step.pop("do", None)
    if not isinstance(name, str):
        raise Error("the key do is missing, the name of the step")
    do = find_name(name, _known_steps())
    if do is None:
        raise unknown("step", name, _known_steps())
    if do in ("read", "write"):
        _require(step, ("file",), ("file",))
    elif do == "criteria":
        _require(step, ("criteria", "stop", "metrics", "time_limit", "threads"), ("criteria",))
        if not isinstance(step.setdefault("stop", True), bool):
            raise Error(f"stop is {step['stop']!r}; true or false is expected")
    else:
        _check_arguments(do, step)
    _check_files(do, step, folder, made)
    if do in ("quality", "criteria") and "metrics" in step:
        choose(_vtk.vtkElementQuality(), step["metrics"])
    return _Step(number, do, step)


def _require(step: Mapping[str, Any], known: tuple[str, ...], needed: tuple[str, ...]) -> None:
    for key in step:
        if key not in known:
            raise unknown("key", key, known)
    for key in needed:
        if key not in step:
            raise Error(f"the key {key} is missing")


def _function(do: str) -> Callable[..., Any]:
    found: Callable[..., Any] = getattr(import_module(f".{_FUNCTIONS[do]}", __package__), do)
    return found


def _check_arguments(do: str, step: Mapping[str, Any]) -> None:
    """Check names and types of arguments against the signature of the function."""
    function = _function(do)
    parameters = {n: p for n, p in signature(function).parameters.items() if n not in _NOT_IN_STEPS}
    _require(step, tuple(parameters), ("file",) if do == "report" else ())
    hints = get_type_hints(_innermost(function), vars(import_module(f".{_FUNCTIONS[do]}", __package__)))
    for key, value in step.items():
        _check_value(key, value, hints.get(key))


def _innermost(function: Any) -> Any:
    while hasattr(function, "__wrapped__"):
        function = function.__wrapped__
    return function


def _check_value(key: str, value: Any, hint: Any) -> None:
    kinds = [kind for kind in get_args(hint) if kind is not type(None)]
    if len(kinds) == 1 and get_origin(hint) in (Union, UnionType):
        hint = kinds[0]  # of `Preset | None`
    elif isinstance(value, str) and str not in kinds and find_metric(value) is None:
        hint = next((kind for kind in kinds if get_origin(kind) is Literal), hint)  # of `Preset | list[...]`
    if get_origin(hint) is Literal and find_name(value, get_args(hint)) is None:
        listed = ", ".join(map(repr, get_args(hint)))
        raise Error(f"{key} is {value!r}{nearest_name(value, get_args(hint))}; there are {listed}")
    if hint is bool and not isinstance(value, bool):
        raise Error(f"{key} is {value!r}; true or false is expected")
    if hint in (int, float) and (isinstance(value, bool) or not isinstance(value, (int, float))):
        raise Error(f"{key} is {value!r}; a number is expected")


def _check_files(do: str, step: dict[str, Any], folder: Path, made: list[str]) -> None:
    """Make file names relative to the folder; check that they can be read or written."""
    for key in ("file", *_FILES_READ):
        if key not in step or step[key] == _INPUT:
            continue
        name = os.path.join(folder, file_name(step[key])) if folder != Path(".") else file_name(step[key])
        step[key] = name
        if key == "file" and do == "write":
            check_output(name)
            made.append(name)
        elif key == "file" and do == "report":
            check_target(name)
        elif name not in made:
            check_input(name)
    chosen = step.get("criteria")
    if isinstance(chosen, str) and find_name(chosen, criteria_presets()) is None:
        if not Path(chosen).suffix:
            raise unknown("preset of quality criteria", chosen, criteria_presets())
        step["criteria"] = os.path.join(folder, chosen)
        check_input(step["criteria"])


# --- the run ------------------------------------------------------------------------------------------------


def _run_all(steps: list[_Step]) -> StepsResult:
    mesh = source = None
    results: list[Any] = []
    files: list[str] = []
    lines: list[str] = []
    passed = True
    for step in steps:
        options: dict[str, Any] = dict(step.options)
        options.update({key: source for key in _FILES_READ if options.get(key) == _INPUT})
        try:
            if step.do == "read":
                mesh = source = read(options["file"])
                text = f"{options['file']}: {_commands.counts(mesh)}"
            elif step.do == "write":
                files += write(mesh, options["file"])
                text = options["file"]
            elif step.do == "report":
                _function("report")(mesh, **options)
                files.append(options["file"])
                text = options["file"]
            else:
                stop = options.pop("stop", False)
                result = _function("quality" if step.do == "criteria" else step.do)(mesh, **options)
                results.append(result)
                mesh = result.mesh
                text = result.summary.splitlines()[0]
                failed = step.do == "criteria" and result.verdict in ("failed", "none")
                passed = passed and not failed
                if failed and stop:
                    lines.append(f"{step.number} {step.do}: {text} The steps after it were not run.")
                    break
        except Error as error:
            raise Error(f"step {step.number}, {step.do}: {error}") from None
        lines.append(f"{step.number} {step.do}: {text}")
    assert mesh is not None  # the first step reads
    return StepsResult(mesh=mesh, results=results, passed=passed, files=files, summary="\n".join(lines))


# --- the shell ----------------------------------------------------------------------------------------------


def add_commands(commands: Any) -> None:
    """Add `run` to the subparsers of the command line."""
    parser = _commands.add_command(
        commands, "run", _run, "run the steps of a TOML file, or the filters of a ParaView state", threads=False,
        example="steps.toml",
        details="All steps are checked before the first one runs; exits with 3 if the mesh fails the criteria. A state "
                "(.pvsm) needs ParaView with the plugin, but no display.",
    )  # fmt: skip
    text = "tables [[step]], each with the key do, see tautline.run_steps; or a state of ParaView"
    parser.add_argument("steps", metavar="FILE", help=text)
    parser.add_argument("--check", action="store_true", help="check the steps only")
    parser.add_argument("--mesh", metavar="FILE", help="for a state: another mesh, instead of the one that it reads")
    parser.add_argument("--filter", metavar="NAME", help="for a state with several ends: the filter to choose")
    _commands.add_output(parser, "for a state: where to write the mesh", required=False)


def _run(arguments: argparse.Namespace) -> int:
    if Path(arguments.steps).suffix.lower() == STATE:
        if arguments.check:
            raise Error("a state is not checked; --check is for files of steps")
        state = run_state(arguments.steps, mesh=arguments.mesh, filter=arguments.filter or "")
        _commands.finish(arguments, state, state.summary, facts={"filters": state.filters})
        return 0
    for name in ("mesh", "filter", "output"):
        if getattr(arguments, name) is not None:
            raise Error(f"--{name} is for states of ParaView (.pvsm); a file of steps has read and write")
    result = run_steps(arguments.steps, check_only=arguments.check)
    if result is None:
        _commands.finish(arguments, None, "the steps are correct", facts={"correct": True})
        return 0
    _commands.finish(arguments, result, result.summary, facts={**result.to_dict(), "written": result.files})
    return 0 if result.passed else _FAILED
