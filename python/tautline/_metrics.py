"""The function metrics: all quality metrics and their facts."""

from __future__ import annotations

import argparse
import json
from typing import Any, Iterable, Union

from . import _vtk
from ._commands import add_command
from ._errors import Error, Messages, checked, watch
from ._tables import finite, metrics_markdown, metrics_text

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
    parser = add_command(commands, "metrics", _run, "list the metrics", threads=False)
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--markdown", action="store_true", help="as a Markdown table")
    form.add_argument("--json", action="store_true", help="all facts as JSON")


def _run(arguments: argparse.Namespace) -> None:
    facts = metrics()
    if arguments.json:
        print(json.dumps(finite(facts), indent=2))
    else:
        print(metrics_markdown(facts) if arguments.markdown else metrics_text(facts))
