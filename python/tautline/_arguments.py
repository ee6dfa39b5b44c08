# SPDX-License-Identifier: BSD-3-Clause
"""Arguments of the functions: checks and choices."""

from __future__ import annotations

from numbers import Real
from typing import Any, Callable, Iterable, Mapping, Sequence, TypeVar

import numpy as np

from ._errors import Error, wrong_usage
from ._names import find_name, nearest_name

Name = TypeVar("Name", bound=str)
Function = TypeVar("Function", bound=Callable[..., Any])


def pick(option: str, value: Any, allowed: Sequence[str]) -> int:
    """The index of a name, in any case, in the allowed ones. Raises Error, with the nearest one, for others."""
    found = find_name(value, allowed)
    if found is None:
        listed = ", ".join(map(repr, allowed))
        raise wrong_usage(f"{option} is {value!r}{nearest_name(value, allowed)}; there are {listed}")
    return allowed.index(found)


def picked(option: str, value: Any, allowed: Sequence[Name]) -> Name:
    """The allowed name that matches a value; see pick()."""
    return allowed[pick(option, value, allowed)]


def flagged(value: str | bool, off: str, on: str) -> str:
    """The name that True or False stands for; other values are returned unchanged."""
    return (off, on)[value] if isinstance(value, bool) else value


def sets(_functions: str, *_properties: str) -> Callable[[Function], Function]:
    """For python/generator: the arguments of this setter are arguments of the functions, and set these properties."""
    return lambda setter: setter


def within(option: str, value: float, low: float, high: float) -> float:
    """The value. Raises Error if it is not a number from low to high; the filter would keep the older one."""
    if isinstance(value, (np.ndarray, np.generic)) and value.ndim == 0:
        value = value.item()
    if isinstance(value, Real) and low <= float(value) <= high:
        return value
    positive = low == np.nextafter(0, 1)
    least = "above 0" if positive else f"from {low:g}"
    most = "" if high == np.inf else f" and at most {high:g}" if positive else f" to {high:g}"
    raise Error(f"{option} is {value!r}; it must be a number {least}{most}")


def whole(option: str, value: float, low: float, high: float) -> int:
    """The value. Raises Error if it is not a whole number from low to high."""
    found = within(option, value, low, high)
    if found != int(found):
        raise Error(f"{option} is {value!r}; a whole number is expected")
    return int(found)


def flag(option: str, value: Any) -> bool:
    """The value. Raises Error if it is neither True nor False, nor 1 or 0."""
    if isinstance(value, (bool, np.bool_)) or (isinstance(value, (int, np.integer)) and value in (0, 1)):
        return bool(value)
    raise Error(f"{option} is {value!r}; True or False is expected")


def text(option: str, value: Any) -> str:
    """The value. Raises Error if it is not a text."""
    if not isinstance(value, str):
        raise Error(f"{option} is {value!r}; a text is expected")
    return value


def sequence(option: str, values: Any) -> list[Any]:
    """The values as a list. Raises Error for a text, a number and anything else that is not a sequence."""
    if isinstance(values, np.ndarray) and values.ndim == 0:
        values = values.item()
    if not isinstance(values, Iterable) or isinstance(values, (str, bytes, Mapping)):
        raise Error(f"{option} is {values!r}; a list is expected")
    return list(values)


def number(option: str, value: Any) -> float:
    """The value as a float. Raises Error if it is not a finite number."""
    try:
        result = float(value)
    except (TypeError, ValueError, OverflowError):
        raise Error(f"{option} is {value!r}; a number is expected") from None
    if not np.isfinite(result):
        raise Error(f"{option} is {result}; it must be finite")
    return result
