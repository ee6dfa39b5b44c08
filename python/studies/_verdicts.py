# SPDX-License-Identifier: BSD-3-Clause
"""Verdicts of the studies: a finding holds, does not hold, or is not decided by the numbers at hand."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from typing import Any, Callable, Iterable, Sequence, TypeVar, Union

T = TypeVar("T")


@dataclass(frozen=True)
class Open:
    """The verdict of numbers that decide nothing, and why they do not."""

    reason: str

    def __bool__(self) -> bool:
        raise TypeError("a verdict that is not decided is neither true nor false")


class Mixed(Open):
    """The verdict of numbers that agree with a statement in some cases only, and what the cases depend on."""


#: True: the finding holds; False: it does not; Open: the numbers do not decide it; Mixed: it holds in some cases.
Verdict = Union[bool, Open]

HOLDS, DOES_NOT_HOLD, VARIES = "holds", "does not hold", "varies"
NOT_DECIDED, TOO_SMALL = "not decided", "too small to decide"
#: All of them, in the order of reports.
WORDS = (HOLDS, DOES_NOT_HOLD, VARIES, NOT_DECIDED, TOO_SMALL)

#: Times that differ by a smaller part are regarded as equal: the variation of one program on an idle machine.
TIME_MARGIN = 0.05
#: A number is about as large as the printed one between these multiples of it: meshes and machines are other ones.
GAIN_BAND = (0.5, 2.0)
#: The criterion of gain().
GAIN_RULE = (f"the gain is between {GAIN_BAND[0]:g} and {GAIN_BAND[1]:g} times the printed one, and what remains of "
             f"the whole is at most {GAIN_BAND[1]:g} times as much as there")
#: Counts of elements and of iterations on other meshes are the printed ones within this relative tolerance.
COUNT_TOLERANCE = 0.5


def word(verdict: Verdict) -> str:
    """The words of a verdict."""
    if isinstance(verdict, Mixed):
        return VARIES
    return NOT_DECIDED if isinstance(verdict, Open) else HOLDS if verdict else DOES_NOT_HOLD


def all_of(verdicts: Iterable[Any]) -> Verdict:
    """Whether all hold: False if one does not, otherwise not decided if one is not, or if there is none."""
    return _joined(verdicts, False)


def any_of(verdicts: Iterable[Any]) -> Verdict:
    """Whether one holds: True if one does, otherwise not decided if one is not, or if there is none."""
    return _joined(verdicts, True)


def _joined(verdicts: Iterable[Any], decisive: bool) -> Verdict:
    """The decisive verdict if it is among them, otherwise the first that is not decided, otherwise the other one."""
    found = list(verdicts)
    undecided = [v for v in found if isinstance(v, Open)]
    if any(bool(v) is decisive for v in found if not isinstance(v, Open)):
        return decisive
    if undecided or not found:
        return undecided[0] if undecided else Open("there is nothing to compare")
    return not decisive


def is_not(verdict: Verdict) -> Verdict:
    """The opposite verdict."""
    return verdict if isinstance(verdict, Open) else not verdict


def unless(reason: str, verdict: Any) -> Verdict:
    """Not decided for a reason; the verdict where the reason is empty."""
    return Open(reason) if reason else verdict


def less(one: float, other: float, error: float) -> Verdict:
    """Whether a number is smaller than another one; not decided where they differ by less than their relative error."""
    if not (math.isfinite(one) and math.isfinite(other)):
        return Open("a number is missing")
    if abs(one - other) <= error * max(abs(one), abs(other)):
        return Open(f"the numbers {one:.6g} and {other:.6g} differ by less than their error of {error:g}")
    return one < other


def close(one: float, other: float, tolerance: float) -> Verdict:
    """Whether a number is another one within a relative tolerance; not decided where one is missing."""
    if not (math.isfinite(one) and math.isfinite(other)):
        return Open("a number is missing")
    return abs(one - other) <= tolerance * abs(other)


def as_large(ours: float, printed: float) -> Verdict:
    """Whether a number is about as large as the printed one: between half of it and twice it."""
    if not math.isfinite(ours):
        return Open("a number is missing")
    low, high = sorted(factor * printed for factor in GAIN_BAND)
    return low <= ours <= high


def gain(ours: float, printed: float) -> Verdict:
    """Whether a gain, a part of the whole below 1, is about as large as the printed one.

    Half of 97 % less time would be 2 times faster instead of 33 times: where a gain is large, what remains decides. It
    may be less than there: the text rounds, and its own times give 99 % where it says 97 %.
    """
    if not math.isfinite(ours):
        return Open("the gain has no number")
    return all_of((as_large(ours, printed), 1.0 - ours <= GAIN_BAND[1] * (1.0 - printed)))


@dataclass(frozen=True)
class Times:
    """CPU seconds of several runs of the same work, at least one."""

    runs: tuple[float, ...]

    @property
    def best(self) -> float:
        """The fastest run, the one least disturbed."""
        return min(self.runs)

    @property
    def middle(self) -> float:
        """The median; for an even number of runs the slower one in the middle, because slower runs were disturbed."""
        return sorted(self.runs)[len(self.runs) // 2]

    @property
    def worst(self) -> float:
        return max(self.runs)

    def over(self, other: Times) -> tuple[float, float]:
        """The smallest and the largest ratio to other times that the faster half of the runs and the margin allow."""
        low = self.best / max(other.middle, math.ulp(0.0)) / (1 + TIME_MARGIN)
        high = self.middle / max(other.best, math.ulp(0.0)) * (1 + TIME_MARGIN)
        return low, high

    def __add__(self, other: Times) -> Times:
        """The times of both works: the fastest runs together, the medians and the slowest."""
        return Times((self.best + other.best, self.middle + other.middle, self.worst + other.worst))

    def __str__(self) -> str:
        spread = f" to {self.worst:.3g}" if self.worst > self.best else ""
        return f"{self.best:.3g}{spread} s"


def timed(repeats: int, work: Callable[[], T]) -> tuple[T, Times]:
    """The last result of work that is repeated, and the CPU seconds of all threads of each run."""
    runs = []
    for _ in range(repeats):
        began = time.process_time()
        result = work()
        runs.append(time.process_time() - began)
    return result, Times(tuple(runs))


def faster(one: Times, other: Times) -> Verdict:
    """Whether one takes less time: not decided unless its faster runs are faster than the other's by the margin."""
    return below(one, other, 1.0)


def below(one: Times, other: Times, factor: float) -> Verdict:
    """Whether one takes less than `factor` times the time of the other."""
    low, high = one.over(other)
    if low <= factor <= high:
        return Open(f"the times {one} and {other} differ by less than their noise")
    return high < factor


def quickest(times: dict, name: object) -> Verdict:
    """Whether `name` is the fastest of all; not decided where another one is as fast within the noise."""
    return all_of(faster(times[name], other) for key, other in times.items() if key != name)


def slowest(times: dict, name: object) -> Verdict:
    """Whether `name` is the slowest of all; not decided where another one is as slow within the noise."""
    return all_of(faster(other, times[name]) for key, other in times.items() if key != name)


def same_count(ours: float, printed: float, tolerance: float = COUNT_TOLERANCE) -> Verdict:
    """Whether a count is the printed one within a relative tolerance; not decided where there is none."""
    if not math.isfinite(ours):
        return Open("a count is missing")
    return abs(ours - printed) <= tolerance * printed


def constant(values: Sequence[float], tolerance: float) -> bool:
    """Whether all values are within a relative tolerance of their geometric mean."""
    mean = math.exp(sum(math.log(v) for v in values) / len(values))
    return all(1 / (1 + tolerance) <= v / mean <= 1 + tolerance for v in values)
