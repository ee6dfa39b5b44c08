# SPDX-License-Identifier: BSD-3-Clause
"""Arguments of the functions: checks and choices."""

from __future__ import annotations

from typing import Any, Callable, Sequence, TypeVar

import numpy as np

from ._errors import Error, wrong_name
from ._names import find_name, nearest_name

Name = TypeVar("Name", bound=str)
Function = TypeVar("Function", bound=Callable[..., Any])


def pick(option: str, value: Any, allowed: Sequence[str]) -> int:
    """The index of a name, in any case, in the allowed ones. Raises Error, with the nearest one, for others."""
    found = find_name(value, allowed)
    if found is None:
        listed = ", ".join(map(repr, allowed))
        raise wrong_name(f"{option} is {value!r}{nearest_name(value, allowed)}; there are {listed}")
    return allowed.index(found)


def picked(option: str, value: Any, allowed: Sequence[Name]) -> Name:
    """The one of the allowed names that a value means; see pick()."""
    return allowed[pick(option, value, allowed)]


def flagged(value: str | bool, off: str, on: str) -> str:
    """The name that True or False means; other values as they are."""
    return (off, on)[value] if isinstance(value, bool) else value


def sets(_functions: str, *_properties: str) -> Callable[[Function], Function]:
    """For python/generator: the arguments of this setter are those of the functions, and set these properties."""
    return lambda setter: setter


def within(option: str, value: float, low: float, high: float) -> float:
    """The value. Raises Error if it is not a number from low to high; the filter would keep the older one."""
    try:
        if low <= value <= high:
            return value
    except TypeError:
        pass
    positive = low == np.nextafter(0, 1)
    least = "above 0" if positive else f"from {low:g}"
    most = "" if high == np.inf else f" and at most {high:g}" if positive else f" to {high:g}"
    raise Error(f"{option} is {value!r}; it must be a number {least}{most}")


def number(option: str, value: Any) -> float:
    """The value as a float. Raises Error if it is not a finite number."""
    try:
        result = float(value)
    except (TypeError, ValueError):
        raise Error(f"{option} is {value!r}; a number is expected") from None
    if not np.isfinite(result):
        raise Error(f"{option} is {result}; it must be finite")
    return result
