# SPDX-License-Identifier: BSD-3-Clause
"""Arguments of the functions: checks, enumerations, keyword options of filters."""

from __future__ import annotations

from typing import Any, Callable, Iterable, Literal, Mapping, Sequence, TypeVar, get_args

import numpy as np

from ._arrays import snake
from ._errors import Error, unknown
from ._names import find_name, nearest_name

#: How the values at the corners of a cell are combined, in the filters' numbering.
Combination = Literal["mean", "worst", "power mean"]
COMBINATIONS: tuple[Combination, ...] = get_args(Combination)
#: What the target element is, in the filters' numbering.
Target = Literal["ideal", "reference", "size", "tensor"]
TARGETS: tuple[Target, ...] = get_args(Target)

#: Preconditioners of linear systems, in the filters' numbering.
Preconditioner = Literal["jacobi", "ssor", "ilu", "boomeramg", "icc", "gamg", "none"]
PRECONDITIONERS: tuple[Preconditioner, ...] = get_args(Preconditioner)

#: How several processes divide a mesh anew, in the filters' numbering.
Redistribution = Literal["off", "k-d tree", "pt-scotch"]
REDISTRIBUTIONS: tuple[Redistribution, ...] = get_args(Redistribution)

_MAX_THREADS = 1024

Name = TypeVar("Name", bound=str)

#: Sets an option of a filter from the value of a keyword.
Setter = Callable[[Any, Any], None]


def pick(option: str, value: Any, allowed: Sequence[str]) -> int:
    """The index of a name, in any case, in the allowed ones. Raises Error, with the nearest one, for others."""
    found = find_name(value, allowed)
    if found is None:
        listed = ", ".join(map(repr, allowed))
        raise Error(f"{option} is {value!r}{nearest_name(value, allowed)}; there are {listed}")
    return allowed.index(found)


def picked(option: str, value: Any, allowed: Sequence[Name]) -> Name:
    """The one of the allowed names that a value means; see pick()."""
    return allowed[pick(option, value, allowed)]


def set_redistribution(filter_: Any, value: Redistribution | bool) -> None:
    """Set Redistribute of a filter; True is a k-d tree."""
    name = ("off", "k-d tree")[value] if isinstance(value, bool) else value
    filter_.SetRedistribute(pick("redistribute", name, REDISTRIBUTIONS))


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


def set_threads(algorithm: Any, threads: int) -> None:
    """Set the number of threads; 0 is all cores."""
    algorithm.SetThreads(int(within("threads", threads, 0, _MAX_THREADS)))


def set_time_limit(algorithm: Any, seconds: float) -> None:
    """Set the time limit; 0 is no limit."""
    algorithm.SetTimeLimit(within("time_limit", seconds, 0, np.inf))


def number_option(setter: str, low: float, high: float, kind: type = float) -> Setter:
    """A setter of a filter for the numbers from low to high."""

    def set_number(algorithm: Any, value: Any) -> None:
        getattr(algorithm, setter)(kind(within(snake(setter[3:]), value, low, high)))

    return set_number


def flag_option(setter: str) -> Setter:
    """A setter of a filter for True and False."""

    def set_flag(algorithm: Any, value: Any) -> None:
        getattr(algorithm, setter)(bool(value))

    return set_flag


def check_options(options: Mapping[str, Any], known: Iterable[str]) -> None:
    """Raise Error for a keyword that is not known."""
    for name in options:
        if name not in known:
            raise unknown("option", name, known)


def set_options(algorithm: Any, options: Mapping[str, Any], known: Mapping[str, Setter]) -> None:
    """Set keyword options on a filter by a table of setters."""
    check_options(options, known)
    for name, value in options.items():
        known[name](algorithm, value)
