# SPDX-License-Identifier: BSD-3-Clause
"""The functions metrics, register_metric, unregister_metric and load_metrics: all quality metrics, with data."""

from __future__ import annotations

import argparse
import os
import re
import sys
import warnings
from difflib import get_close_matches
from pathlib import Path
from typing import Any, Callable, Iterable, Union

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy

from . import _vtk
from ._arguments import flag, number, sequence
from ._arrays import Array
from ._commands import add_command
from ._errors import Error, Messages, checked, unknown, watch, wrong_usage
from ._names import folded
from ._tables import json_text, metrics_markdown, metrics_text
from ._views import NamedDict

#: Metrics of a function: a name, label, symbol or alias, or several of them.
Metrics = Union[str, Iterable[str]]

_RANGES = ("full", "acceptable")
_LISTS = ("aliases", "dimensions", "cell_types")
_FLAGS = {"yes": True, "no": False}


@checked
def metrics() -> list[dict[str, Any]]:
    """List all metrics.

    Returns
    -------
    list[dict[str, Any]]
        A dict of properties for each, None where one does not apply: number (int); name (str, also the name of the cell
        array); label, symbol, formula, source, unit (str); aliases (list of str); dimensions (list of 2 and 3);
        cell_types (list of str); full_2d, full_3d (range on valid elements, a tuple of two floats); acceptable_2d,
        acceptable_3d (range that most solvers accept); ideal_2d, ideal_3d (float); direction ("smaller is better",
        "larger is better", "neutral"); inverted (value on an inverted element: "negative", "larger", "unsigned");
        barrier, differentiable, scale_invariant, rotation_invariant (bool); family ("target", "simplex" and "cell":
        functions of one element; "faces": of finite volumes, of the faces of a cell and the cells across).

    Examples
    --------
    >>> [facts["name"] for facts in tautline.metrics() if facts["barrier"]]
    """
    known = _vtk.vtkElementQuality
    fields = [field.lower().replace(" ", "_") for field in known.GetKnownMetricFields().split("\t")]
    lines = (known.GetKnownMetric(i).split("\t") for i in range(known.GetNumberOfKnownMetrics()))
    return [{field: _fact(field, text) for field, text in zip(fields, line)} for line in lines]


def _fact(field: str, text: str) -> Any:
    if field in _LISTS:
        words = [word.strip() for word in text.split(",") if word.strip()]
        return [int(word) for word in words] if field == "dimensions" else words
    if text == "-":
        return None
    if field == "number":
        return int(text)
    if field.startswith("ideal"):
        return float(text)
    if field.startswith(_RANGES):
        low, high = text.split(" to ")
        return float(low), float(high)
    return _FLAGS.get(text, text)


#: The cell types of a metric: names, types of VTK, numbers of corners.
_CELLS = {
    "triangle": (5, 3),
    "quadrilateral": (9, 4),
    "tetrahedron": (10, 4),
    "hexahedron": (12, 8),
    "wedge": (13, 6),
    "pyramid": (14, 5),
}
_DIRECTIONS = ("smaller is better", "larger is better", "neutral")
_TEXTS = ("label", "symbol", "aliases", "formula", "source", "unit")

#: A metric of the user: takes x y z of the corners, shape (cells, corners, 3), and the type of the cells, and returns
#: a value per cell, shape (cells,).
MetricFunction = Callable[["Array", str], "Array"]


@checked
def register_metric(
    name: str,
    function: MetricFunction,
    *,
    label: str = "",
    symbol: str = "",
    aliases: str = "",
    formula: str = "",
    source: str = "",
    unit: str = "",
    cell_types: Iterable[str] = tuple(_CELLS),
    direction: str = "smaller is better",
    full: tuple[float, float] = (0.0, float("inf")),
    acceptable: tuple[float, float] = (0.0, float("inf")),
    ideal: float | None = None,
    scale_invariant: bool = False,
    rotation_invariant: bool = True,
) -> int:
    """Register a user-defined metric for measuring, coloring, statistics, criteria and optimization.

    The metric is then known by its name to quality, compare, metric_field, criteria and, in pvpython and in ParaView's
    Python shell, to the menus of filters that are made afterwards. As an objective of optimize it takes derivatives by
    central differences, 6 evaluations for each corner of an element, and moves all points together (L-BFGS or a
    conjugate gradient): tens of times slower than a metric that is registered in C++ (tautline/Quality/UserMetric.h),
    and only with a boundary that is fixed or slides on flat parts. A metric that was registered in Python under the
    same name is replaced. With a server of ParaView, or several processes of pvbatch, it is registered in this process
    only: put the registration into a file for load_metrics instead.

    Parameters
    ----------
    name : str
        Lower case letters, digits and underscores; the name of the cell array.
    function : MetricFunction
        Takes x y z of the corners, shape (cells, corners, 3), read-only, and the type of the cells, a name of
        cell_types; returns a value per cell, shape (cells,). It is called once per cell type. A planar mesh is given in
        its plane (z is 0, valid cells counter-clockwise); values that are not finite become 0.
    label, symbol : str, default ""
        For menus; the default is the name.
    aliases : str, default ""
        Other names, with commas between them.
    formula, source, unit : str, default ""
        Texts.
    cell_types : Iterable[str], default tuple(_CELLS)
        Names of the cells it is defined on; the default is all six.
    direction : str, default "smaller is better"
        "smaller is better", "larger is better" or "neutral".
    full, acceptable : tuple[float, float], default (0.0, float("inf"))
        The ranges for valid cells, and for cells that most solvers accept.
    ideal : float, optional
        The value of the ideal cell.
    scale_invariant, rotation_invariant : bool, default False, bool, default True
        Whether size and orientation of a cell do not matter; both are checked.

    Returns
    -------
    int
        The number of the metric.

    Raises
    ------
    Error
        If the name is taken, or the function fails on cells near the ideal ones.

    Examples
    --------
    >>> def elongation(corners, cell_type):
    ...     extent = np.ptp(corners, axis=1)
    ...     return extent.max(axis=1) / extent[:, :2].min(axis=1)
    >>> tautline.register_metric("elongation", elongation, rotation_invariant=False, scale_invariant=True)
    >>> tautline.quality("part.vtu", "elongation").statistics["elongation"]["worst"]
    """
    if not callable(function):
        raise Error(f"the function of the metric {name} is {function!r}; a function is expected")
    if direction not in _DIRECTIONS:
        raise unknown("direction", str(direction), _DIRECTIONS)
    metric = _vtk.vtkUserMetric()
    messages = Messages(metric)
    for setter, text in zip(
        ("Name", *map(str.capitalize, _TEXTS)), (name, label, symbol, aliases, formula, source, unit)
    ):
        if not isinstance(text, str):
            raise Error(f"{setter.lower()} is {text!r}; a text is expected")
        getattr(metric, f"Set{setter}")(text)
    metric.SetDirection(_DIRECTIONS.index(direction))
    metric.SetFullRange(*_range("full", full))
    metric.SetAcceptableRange(*_range("acceptable", acceptable))
    metric.SetIdeal(float("nan") if ideal is None else number("ideal", ideal))
    metric.SetInvariances(
        flag("scale_invariant", scale_invariant), flag("rotation_invariant", rotation_invariant)
    )
    metric.ClearCellTypes()
    for cell in [cell_types] if isinstance(cell_types, str) else sequence("cell_types", cell_types):
        if not isinstance(cell, str) or cell not in _CELLS:
            raise unknown("cell type", str(cell), _CELLS)
        metric.AddCellType(_CELLS[cell][0])
    metric.AddObserver("UserEvent", _evaluator(function))
    replaced = _REGISTERED.pop(name, None)
    if replaced is not None:
        replaced.RemoveFromRegistry(name)
    if not metric.AddToRegistry():
        if replaced is not None:  # the existing metric stays
            replaced.AddToRegistry()
            _REGISTERED[name] = replaced
        try:
            messages.raise_errors()
        except Error as error:
            raise Error(_NAMES_OF_FACTS.sub(lambda found: found[1] + "_invariant to False", str(error))) from None
    _REGISTERED[name] = metric
    server = None if _loading else _server()
    if server and server.IsRemote():
        warnings.warn(
            f"the metric {name} is registered in this process only, but the filters of ParaView are executed by the "
            f"server {server.GetURI()}, whose menus do not have it: put the registration into a file, and load it by "
            "tautline.load_metrics(FILE), which also registers it in all processes of the server",
            stacklevel=3,
        )
    return next(int(facts["number"]) for facts in metrics() if facts["name"] == name)


def _range(option: str, ends: Any) -> tuple[float, float]:
    """The lower and the upper end of a range, which may be infinite."""
    found = sequence(option, ends)
    if len(found) != 2 or not all(isinstance(end, (int, float, np.number)) for end in found):
        raise Error(f"{option} is {ends!r}; two numbers, the lower and the upper end, are expected")
    return float(found[0]), float(found[1])


#: The names of arguments in C++, in messages.
_NAMES_OF_FACTS = re.compile(r"\b(scale|rotation)Invariant to false")

#: The metrics that Python has registered.
_REGISTERED: dict[str, Any] = {}


def _evaluator(function: MetricFunction) -> Callable[[Any, str], None]:
    names = {number: (name, corners) for name, (number, corners) in _CELLS.items()}

    def evaluate(metric: Any, event: str) -> None:
        try:
            cell, corners = names[metric.GetCellType()]
            points = vtk_to_numpy(metric.GetCorners()).reshape(-1, corners, 3)
            points.flags.writeable = False
            found = np.asarray(function(points, cell))
            if np.iscomplexobj(found):
                raise TypeError("it gave complex values; real ones are expected")
            found = found.astype(float)
            if found.shape != (len(points),):
                raise ValueError(f"it gave values of shape {found.shape}; ({len(points)},) is expected")
            vtk_to_numpy(metric.GetValues())[:] = found
        except Exception as error:  # VTK prints exceptions of observers and goes on
            metric.SetFailure(f"{type(error).__name__}: {error}")

    return evaluate


@checked
def unregister_metric(name: str) -> None:
    """Remove a metric that was registered in Python.

    Parameters
    ----------
    name : str
        Its name.

    Raises
    ------
    Error
        If no metric was registered under this name.
    """
    if not isinstance(name, str) or name not in _REGISTERED:
        raise Error(f"no metric {name!r} was registered in Python")
    _REGISTERED.pop(name).RemoveFromRegistry(name)


@checked
def load_metrics(library: str | os.PathLike[str]) -> list[str]:
    """Load a file that registers metrics.

    Parameters
    ----------
    library : str or path
        A shared library (tautline/Quality/UserMetric.h), or a Python file (.py) that calls register_metric. The shell
        and ParaView load the shared libraries named in the environment variable TAUTLINE_METRICS, separated by colons,
        when they start.

    Returns
    -------
    list[str]
        The names of the metrics that were registered.

    Raises
    ------
    Error
        If the file cannot be loaded or a registration in it fails, on any process.

    Notes
    -----
    In pvpython, pvbatch and ParaView's Python shell, all processes of the server also load it: a Python file is sent
    to them, a library is loaded from its path on the server's computer. Filters that are made
    afterwards have the metrics in their menus. The server needs the package tautline.
    """
    if not isinstance(library, (str, os.PathLike)):
        raise Error(f"the library is {library!r}; a file name is expected")
    path = Path(library).absolute()
    script = None
    if path.suffix == ".py":
        try:
            script = path.read_text(encoding="utf-8")
        except (OSError, ValueError) as error:
            raise Error(f"{path}: {error}") from None
    server = _server()
    before = _known()
    problem = "" if server and server.IsRemote() and not path.exists() else load_here(str(path), script)
    if not problem and server:
        problem = _load_on_server(server, str(path), script)
    if problem:
        raise Error(problem)
    return [name for name, metric in _known().items() if name not in before or before[name] is not metric]


def _known() -> dict[str, Any]:
    """The names of all metrics, and the metrics that Python has registered."""
    return {facts["name"]: _REGISTERED.get(facts["name"]) for facts in metrics()}


#: Whether load_here() is running: its metrics are registered on all processes.
_loading = False


def load_here(path: str, script: str | None) -> str:
    """Load a library, or run the text of a Python file, in this process. Returns the problem, or ""."""
    global _loading
    if script is None:
        return str(_vtk.vtkUserMetric.LoadLibrary(path))
    _loading = True
    try:
        exec(compile(script, path, "exec"), {"__name__": "tautline_user_metrics", "__file__": path})
        return ""
    except Exception as error:
        return f"{path}: {error if isinstance(error, Error) else f'{type(error).__name__}: {error}'}"
    finally:
        _loading = False


def _server() -> Any:
    """The connection of ParaView, if its server has other processes than this one; otherwise None."""
    connection = getattr(sys.modules.get("paraview.servermanager"), "ActiveConnection", None)
    if connection is None:
        return None
    from paraview.modules.vtkRemotingCore import vtkProcessModule

    if vtkProcessModule.GetProcessModule().GetSymmetricMPIMode():  # each process runs the same script
        return None
    return connection if connection.IsRemote() or connection.GetNumberOfDataPartitions() > 1 else None


#: Runs on each process of the server: a row with its number and the problem.
_ON_SERVER = """
from vtkmodules.vtkCommonCore import vtkIntArray, vtkStringArray
from vtkmodules.vtkParallelCore import vtkMultiProcessController
try:
    from tautline import _metrics
    problem = _metrics.load_here({path!r}, {script!r})
except Exception as error:
    problem = type(error).__name__ + ": " + str(error)
controller = vtkMultiProcessController.GetGlobalController()
for array, value in ((vtkIntArray(), controller.GetLocalProcessId() if controller else 0), (vtkStringArray(), problem)):
    array.SetName("Problem" if array.IsA("vtkStringArray") else "Process")
    array.InsertNextValue(value)
    output.VTKObject.AddColumn(array)
"""


def _load_on_server(server: Any, path: str, script: str | None) -> str:
    """Load a file in all processes of the server. Returns the problem, or ""."""
    from paraview import servermanager

    source = servermanager.sources.ProgrammableSource()
    source.OutputDataSetType = "vtkTable"
    source.Script = _ON_SERVER.format(path=path, script=script)
    source.UpdatePipeline()
    for process in range(int(server.GetNumberOfDataPartitions())):
        table = servermanager.Fetch(source, process)
        if not table or table.GetNumberOfRows() != 1 or table.GetValueByName(0, "Process").ToInt() != process:
            problem = "it did not run the script, see what it prints"
        else:
            problem = table.GetValueByName(0, "Problem").ToString()
        if problem:
            return f"process {process} of the server cannot load the metrics: {problem}"
    return ""


def find_metric(name: str, known: Iterable[str] | None = None) -> str | None:
    """The known metric with a name, label, symbol or alias, case-insensitive; None if there is none.

    The default are all metrics.
    """
    wanted, among = folded(name), None if known is None else set(known)
    for facts in metrics():
        if (among is None or facts["name"] in among) and wanted in map(folded, _names_of(facts)):
            return str(facts["name"])
    return None


def by_metric(values: dict[str, Any]) -> NamedDict[Any]:
    """A dict by metrics, whose other names are found as well."""
    return NamedDict(values, find_metric, "metric")


def _names_of(facts: dict[str, Any]) -> list[str]:
    return [name for name in (facts["name"], facts["label"], facts["symbol"], *facts["aliases"]) if name]


def metric_name(name: Any, option: str = "a metric") -> str:
    """The name of the metric with a name, label, symbol or alias. Raises Error, with the nearest one, for others.

    option: the argument, for the message.
    """
    if not isinstance(name, str):
        raise Error(f"{option} is given by its name, not {name!r}")
    known = [facts["name"] for facts in metrics()]
    found = find_metric(name)
    if found is None:
        near = nearest_metric(name)
        hint = f"did you mean {near}?" if near else f"there are {', '.join(known)}"
        problems = str(_vtk.vtkUserMetric.GetLoadErrors()).strip()  # of libraries that may have it
        raise wrong_usage(f"There is no metric {name!r}; {hint}" + (f"\n{problems}" if problems else ""))
    return found


def nearest_metric(name: str) -> str:
    """The metric with the nearest name, label, symbol or alias, for a message; "" if there is none."""
    names = {folded(other): (facts["name"], other) for facts in reversed(metrics()) for other in _names_of(facts)}
    near = get_close_matches(folded(name), names, 1)
    if not near:
        return ""
    found, other = names[near[0]]
    return f"{found!r}" + ("" if folded(found) == folded(other) else f" ({other})")


def choose(algorithm: Any, chosen: Metrics) -> Messages:
    """Add metrics to a filter by name; returns the filter's messages. Raises Error for none or unknown ones."""
    names = [chosen] if isinstance(chosen, str) else sequence("metrics", chosen)
    if not names:
        raise Error("no metric is chosen")
    messages = watch(algorithm)
    for name in names:
        algorithm.AddMetricByName(metric_name(name))
    messages.raise_errors()
    return messages


# --- the shell ----------------------------------------------------------------------------------------------


def add_commands(commands: Any) -> None:
    """Add `metrics` to the subparsers of the command line."""
    parser = add_command(
        commands, "metrics", _run, "list the metrics", threads=False,
        example="--markdown",
        details="Prints name, label, ranges and direction of each.",
    )
    parser.add_argument("--markdown", action="store_true", help="as a Markdown table")


def _run(arguments: argparse.Namespace) -> None:
    facts = metrics()
    errors = _vtk.vtkUserMetric.GetLoadErrors()
    if errors:
        raise Error(errors.strip())
    if arguments.json:
        print(json_text(facts))
    elif not arguments.quiet:
        print(metrics_markdown(facts) if arguments.markdown else metrics_text(facts))
