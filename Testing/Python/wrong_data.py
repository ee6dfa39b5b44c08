# SPDX-License-Identifier: BSD-3-Clause
"""Runs the functions of a study that state its findings again, with wrong numbers, and checks that verdicts change."""

import copy
import dataclasses
from argparse import Namespace
from importlib import import_module
from pathlib import Path

import numpy as np
from tautline.studies import _deformed, _report, _verdicts

WAYS = 6  # in which an array may change
TRIALS = 1000  # sets of wrong numbers, each with a seed of its own, unless fewer change all verdicts
FAR = 1e12  # a factor by which numbers change that are near 0, or above a tolerance of rounding errors
DECIDED = {_verdicts.HOLDS, _verdicts.DOES_NOT_HOLD, _verdicts.VARIES}
ROUNDING = 1e-12  # numbers below are taken for 0
LARGE = 1e4  # a factor that makes the seconds of a small study minutes
SMALL_COUNT = 50  # above the counts of inverted elements in the dissertation's figures
IDENTITIES = ("number", "method", "optimizer", "mesh", "kept", "reason", "amount")  # fields that name what was measured


class Recorder:
    """Keeps the arguments with which the functions *findings of a study were called."""

    def __init__(self, study: str) -> None:
        self.module = import_module(f"tautline.studies.{study}")
        self.functions = {name: value for name, value in vars(self.module).items()
                          if name.endswith("findings") and callable(value)}
        assert self.functions, f"{study} has no function that states findings"
        self.calls = []

    def __enter__(self):
        for name, function in self.functions.items():
            setattr(self.module, name, self._wrapped(function))
        return self

    def __exit__(self, *_):
        for name, function in self.functions.items():
            setattr(self.module, name, function)

    def _wrapped(self, function):
        def call(report, *arguments, **named):
            self.calls.append((function, arguments, named))
            return function(report, *arguments, **named)

        return call


def wrong(value, random: np.random.Generator, count: str = "", way: int = -1):
    """A copy of data whose numbers are others: as large, larger, smaller, 0, exchanged or reversed; meshes, texts stay.

    count: the new value of all counts of a part of the data, "none" or "many"; "": each one differs.
    way: how all arrays change; -1: each one in a way of its own.
    """
    if isinstance(value, (bool, np.bool_)):
        return bool(random.integers(2))
    if isinstance(value, (int, np.integer)):
        if count:
            return 0 if count == "none" else 3 * abs(value) + 2
        return int(random.choice([0, 1, value, 3 * abs(value) + 2, random.integers(SMALL_COUNT)]))
    if isinstance(value, (float, np.floating)):
        others = (random.uniform(0.5, 2), *10.0 ** random.uniform(-2, 2, 2), FAR, 1 / FAR)
        factor = float(random.choice([1.0, -1.0, *others]))
        return factor * float(value) if abs(value) > ROUNDING else float(random.choice([0.0, factor]))
    if isinstance(value, np.ndarray) and value.dtype.kind in "fi":
        factors = 10.0 ** random.uniform(-1, 1, value.shape)
        shuffled = random.permutation(value.ravel()).reshape(value.shape)
        made = [value, shuffled * factors, value * LARGE, np.full_like(value, value.max(initial=1)), value[::-1]]
        if np.array_equal(value, np.round(value)):
            made.append(np.zeros_like(value))  # a count
        return np.asarray(made[random.integers(len(made)) if way < 0 else way % len(made)], value.dtype)
    if isinstance(value, dict):
        counts = {key: count or str(random.choice(["", "none", "many"])) for key in value}
        made = {key: part if key in IDENTITIES else wrong(part, random, counts[key], way)
                for key, part in value.items()}
        for key in made:
            if str(key).startswith("iterations ") and random.integers(2):
                made[key] = np.full_like(made[key], np.nan)  # not within the limit
        return made
    if isinstance(value, tuple) and len(value) > 2 and all(type(part) is int for part in value):
        return value  # what was varied
    if isinstance(value, (list, tuple)):
        parts = [wrong(part, random, count, way) for part in value]
        return type(value)(parts) if not hasattr(value, "_fields") else type(value)(*parts)
    if isinstance(value, _deformed.Example):
        return value  # the dissertation's numbers
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        if isinstance(value, _verdicts.Times):
            factor = float(random.choice([1 / LARGE, 0.01, 1, 100, LARGE]))
            return _verdicts.Times(tuple(factor * run for run in value.runs))
        made = copy.copy(value)
        for entry in dataclasses.fields(value):
            if entry.name not in IDENTITIES:
                object.__setattr__(made, entry.name, wrong(getattr(value, entry.name), random, count, way))
        return made
    return value


def verdicts(calls, directory: Path, random=None) -> dict:
    """The verdicts by finding, of the recorded numbers or of wrong ones, as on meshes of full size."""
    report = _report.Report("wrong_data", "wrong data", Namespace(out=directory, small=False, format=[]))
    way = -1 if random is None else max(-1, int(random.integers(-WAYS, WAYS)))
    for function, arguments, named in calls:
        if random is not None:
            arguments = [wrong(argument, random, way=way) for argument in arguments]
        function(report, *arguments, **named)
    return {finding.key: finding.verdict for finding in report.findings}


def check_verdicts(study: str, calls, directory: Path, others=()) -> None:
    """Check that each finding has a decided verdict and another one: of its numbers, random ones, or others' calls.

    The other one is also a decided one, except where random numbers hardly ever agree about many cases at once.
    """
    right = verdicts(calls, directory)
    assert right, f"{study} states no findings"
    seen = {key: {verdict} for key, verdict in right.items()}

    def add(found: dict) -> None:
        for key in set(found) & set(seen):
            seen[key].add(found[key])

    def missing() -> dict:
        return {key: words for key, words in seen.items() if len(words) < 2 or not words & DECIDED}

    add(verdicts(others, directory))
    for seed in range(TRIALS):
        if not missing():
            break
        for made in filter(None, (calls, others)):
            add(verdicts(made, directory, np.random.default_rng(seed)))
    assert not missing(), f"{study}: with other numbers the only verdicts are {missing()}"
