# SPDX-License-Identifier: BSD-3-Clause
"""Verdicts of the studies: a finding holds, does not hold, or is not decided by the numbers at hand."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from typing import Callable, Iterable, Optional, Sequence, TypeVar

T = TypeVar("T")
#: True: the finding holds; False: it does not; None: the numbers do not decide it.
Verdict = Optional[bool]

HOLDS, DOES_NOT_HOLD, NOT_DECIDED, TOO_SMALL = "holds", "does not hold", "not decided", "too small to decide"

#: Times that differ by a smaller part are taken for equal: what runs of one program on an idle machine differ by.
TIME_MARGIN = 0.05


def word(verdict: Verdict) -> str:
    """The words of a verdict."""
    return {True: HOLDS, False: DOES_NOT_HOLD, None: NOT_DECIDED}[verdict]


def all_of(verdicts: Iterable[Verdict]) -> Verdict:
    """Whether all hold: False if one does not, else None if one is not decided, or if there is none."""
    found = list(verdicts)
    if any(v is not None and not v for v in found):
        return False
    return True if found and all(v is not None for v in found) else None


def any_of(verdicts: Iterable[Verdict]) -> Verdict:
    """Whether one holds: True if one does, else None if one is not decided, or if there is none."""
    found = list(verdicts)
    if any(v is not None and v for v in found):
        return True
    return False if found and all(v is not None for v in found) else None


@dataclass(frozen=True)
class Times:
    """CPU seconds of several runs of the same work, at least one."""

    runs: tuple[float, ...]

    @property
    def best(self) -> float:
        """The fastest run, the one least disturbed."""
        return min(self.runs)

    @property
    def worst(self) -> float:
        return max(self.runs)

    def over(self, other: Times) -> tuple[float, float]:
        """The smallest and the largest ratio to the times of other work that the runs and the margin allow."""
        low = self.best / max(other.worst, math.ulp(0.0)) / (1 + TIME_MARGIN)
        high = self.worst / max(other.best, math.ulp(0.0)) * (1 + TIME_MARGIN)
        return low, high

    def __add__(self, other: Times) -> Times:
        """The times of both works: the fastest and the slowest runs together."""
        return Times((self.best + other.best, self.worst + other.worst))

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
    """Whether one takes less time: not decided unless all its runs are faster than all of the other by the margin."""
    return below(one, other, 1.0)


def below(one: Times, other: Times, factor: float) -> Verdict:
    """Whether one takes less than `factor` times the time of the other."""
    low, high = one.over(other)
    return True if high < factor else False if low > factor else None


def quickest(times: dict, name: object) -> Verdict:
    """Whether `name` is the fastest of all; not decided where another one is as fast within the noise."""
    return all_of(faster(times[name], other) for key, other in times.items() if key != name)


def slowest(times: dict, name: object) -> Verdict:
    """Whether `name` is the slowest of all; not decided where another one is as slow within the noise."""
    return all_of(faster(other, times[name]) for key, other in times.items() if key != name)


def same_count(ours: float, printed: float, tolerance: float) -> bool:
    """Whether a count is the printed one within a relative tolerance, rounded up to a whole number."""
    return abs(ours - printed) <= math.ceil(tolerance * printed)


def constant(values: Sequence[float], tolerance: float) -> bool:
    """Whether all values are within a relative tolerance of their geometric mean."""
    mean = math.exp(sum(math.log(v) for v in values) / len(values))
    return all(1 / (1 + tolerance) <= v / mean <= 1 + tolerance for v in values)
