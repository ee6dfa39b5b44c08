# SPDX-License-Identifier: BSD-3-Clause
"""The functions metrics, register_metric, unregister_metric and load_metrics: all quality metrics and their facts."""

from __future__ import annotations

import argparse
import os
from pathlib import Path
from typing import Any, Callable, Iterable, Union

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy

from . import _vtk
from ._arrays import Array
from ._commands import add_command
from ._errors import Error, Messages, checked, unknown, watch
from ._tables import json_text, metrics_markdown, metrics_text

#: Metrics of a function: a name, label, symbol or alias, or several of them.
Metrics = Union[str, Iterable[str]]

_RANGES = ("full", "acceptable")
_LISTS = ("aliases", "dimensions", "cell_types")
_FLAGS = {"yes": True, "no": False}


@checked
def metrics() -> list[dict[str, Any]]:
    """List all metrics, each a dict of facts; None where a fact does not apply.

    number (int); name (str, also the name of the cell array); label, symbol, formula, source, unit (str); aliases
    (list of str); dimensions (list of 2 and 3); cell_types (list of str); full_2d, full_3d (range on valid elements,
    a tuple of two floats); acceptable_2d, acceptable_3d (range that most solvers accept); ideal_2d, ideal_3d (float);
    direction ("smaller is better", "larger is better", "neutral"); inverted (value on an inverted element: "negative",
    "larger", "unsigned"); barrier, differentiable, scale_invariant, rotation_invariant (bool).

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
    """Register a metric of one's own, for measuring, colouring, statistics and criteria; returns its number.

    The metric is then known by its name to quality, compare, metric_field, criteria and, in pvpython and in ParaView's
    Python shell, to the menus of filters that are made afterwards. It has no derivatives and cannot be optimized: for
    that, register one in C++ (tautline/Quality/UserMetric.h). A metric that was registered in Python under the same
    name is replaced.

    name: lower case letters, digits and underscores; the name of the cell array.
    function: takes x y z of the corners, shape (cells, corners, 3), read-only, and the type of the cells, a name of
        cell_types; returns a value per cell, shape (cells,). It is called once per cell type. A planar mesh is seen in
        its plane (z is 0, valid cells counter-clockwise); what is not finite becomes 0.
    label, symbol: for menus (default: the name); aliases: other names, comma separated; formula, source, unit: text.
    cell_types: names of the cells it is defined on (default: all six).
    direction: "smaller is better", "larger is better" or "neutral".
    full, acceptable: the ranges of valid cells, and of those that most solvers accept. ideal: of the ideal cell.
    scale_invariant, rotation_invariant: whether size and orientation of a cell do not matter; both are checked.

    Raises Error if the name is taken, or the function fails on cells near the ideal ones.

    >>> def elongation(corners, cell_type):
    ...     extent = np.ptp(corners, axis=1)
    ...     return extent.max(axis=1) / extent[:, :2].min(axis=1)
    >>> tautline.register_metric("elongation", elongation, rotation_invariant=False, scale_invariant=True)
    >>> tautline.quality("part.vtu", "elongation").statistics["elongation"]["worst"]
    """
    if not callable(function):
        raise Error(f"the function of the metric {name} is {function!r}; a function is expected")
    if direction not in _DIRECTIONS:
        raise unknown("direction", direction, _DIRECTIONS)
    metric = _vtk.vtkUserMetric()
    messages = Messages(metric)
    for setter, text in zip(
        ("Name", *map(str.capitalize, _TEXTS)), (name, label, symbol, aliases, formula, source, unit)
    ):
        if not isinstance(text, str):
            raise Error(f"{setter.lower()} is {text!r}; a text is expected")
        getattr(metric, f"Set{setter}")(text)
    metric.SetDirection(_DIRECTIONS.index(direction))
    metric.SetFullRange(*full)
    metric.SetAcceptableRange(*acceptable)
    metric.SetIdeal(float("nan") if ideal is None else ideal)
    metric.SetInvariances(scale_invariant, rotation_invariant)
    metric.ClearCellTypes()
    for cell in [cell_types] if isinstance(cell_types, str) else cell_types:
        if cell not in _CELLS:
            raise unknown("cell type", cell, _CELLS)
        metric.AddCellType(_CELLS[cell][0])
    metric.AddObserver("UserEvent", _evaluator(function))
    replaced = _REGISTERED.pop(name, None)
    if replaced is not None:
        replaced.RemoveFromRegistry(name)
    if not metric.AddToRegistry():
        if replaced is not None:  # the metric that was there stays
            replaced.AddToRegistry()
            _REGISTERED[name] = replaced
        messages.raise_errors()
    _REGISTERED[name] = metric
    return next(int(facts["number"]) for facts in metrics() if facts["name"] == name)


#: The metrics that Python has registered.
_REGISTERED: dict[str, Any] = {}


def _evaluator(function: MetricFunction) -> Callable[[Any, str], None]:
    names = {number: (name, corners) for name, (number, corners) in _CELLS.items()}

    def evaluate(metric: Any, event: str) -> None:
        try:
            cell, corners = names[metric.GetCellType()]
            points = vtk_to_numpy(metric.GetCorners()).reshape(-1, corners, 3)
            points.flags.writeable = False
            found = np.asarray(function(points, cell), dtype=float)
            if found.shape != (len(points),):
                raise ValueError(f"it gave values of shape {found.shape}; ({len(points)},) is expected")
            vtk_to_numpy(metric.GetValues())[:] = found
        except Exception as error:  # VTK prints exceptions of observers and goes on
            metric.SetFailure(f"{type(error).__name__}: {error}")

    return evaluate


@checked
def unregister_metric(name: str) -> None:
    """Remove a metric that was registered in Python. Raises Error if there is none of the name."""
    if not isinstance(name, str) or name not in _REGISTERED:
        raise Error(f"no metric {name!r} was registered in Python")
    _REGISTERED.pop(name).RemoveFromRegistry(name)


@checked
def load_metrics(library: str | os.PathLike[str]) -> list[str]:
    """Load a shared library that registers metrics (tautline/Quality/UserMetric.h); returns their names.

    The shell loads the libraries named in the environment variable TAUTLINE_METRICS, separated by colons; so does
    ParaView. Raises Error if the library cannot be loaded or a registration in it fails.
    """
    if not isinstance(library, (str, os.PathLike)):
        raise Error(f"the library is {library!r}; a file name is expected")
    before = {facts["name"] for facts in metrics()}
    problem = _vtk.vtkUserMetric.LoadLibrary(str(Path(library).absolute()))
    if problem:
        raise Error(problem)
    return [facts["name"] for facts in metrics() if facts["name"] not in before]


def choose(algorithm: Any, chosen: Metrics) -> Messages:
    """Add metrics to a filter by name; returns the filter's messages. Raises Error for none or unknown ones."""
    names = [chosen] if isinstance(chosen, str) else list(chosen)
    if not names:
        raise Error("no metric is chosen")
    messages = watch(algorithm)
    for name in names:
        if not isinstance(name, str):
            raise Error(f"a metric is given by its name, not {name!r}")
        algorithm.AddMetricByName(name)
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
