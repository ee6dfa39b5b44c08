"""The verb metrics: what there is to measure by."""

from __future__ import annotations

from typing import Any, Iterable, Union

import tautline

from ._errors import Error

Metrics = Union[str, Iterable[str]]

_RANGES = ("full", "acceptable")
_LISTS = ("aliases", "dimensions", "cell_types")
_FLAGS = {"yes": True, "no": False}


def metrics() -> list[dict[str, Any]]:
    """Every metric, a dict of facts each.

    number (int), name (str, of the cell array), label, symbol, aliases (list), formula, source, dimensions
    (list of 2 and 3), cell_types (list), full_2d, full_3d (range of valid elements, a tuple of two
    floats), acceptable_2d, acceptable_3d (what most solvers take), ideal_2d, ideal_3d (float),
    direction ("smaller is better", "larger is better", "neutral"), inverted (value of an inverted
    element: "negative", "larger", "unsigned"), barrier, differentiable, scale_invariant,
    rotation_invariant (bool), unit. None where a fact does not apply.
    """
    known = tautline.vtkElementQuality
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


def choose(algorithm: Any, chosen: Metrics) -> None:
    """Add metrics to a filter by name; it is an error to choose none."""
    names = [chosen] if isinstance(chosen, str) else list(chosen)
    if not names:
        raise Error("no metric is chosen")
    for name in names:
        if not isinstance(name, str):
            raise Error(f"a metric is given by its name, not {name!r}")
        algorithm.AddMetricByName(name)


def pick(option: str, value: str, allowed: tuple[str, ...]) -> int:
    """The number of a value among those allowed; Error names them if it is none of them."""
    if value not in allowed:
        raise Error(f"{option} is {value!r}; there are {', '.join(map(repr, allowed))}")
    return allowed.index(value)


def within(option: str, value: float, low: float, high: float) -> float:
    """The value, or Error if it is not a number in the range: VTK would clamp it silently."""
    try:
        if low <= value <= high:
            return value
    except TypeError:
        pass
    raise Error(f"{option} is {value!r}; it must be a number from {low:g} to {high:g}")
