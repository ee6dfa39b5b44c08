# SPDX-License-Identifier: BSD-3-Clause
"""Shared by the studies of mesh optimization: methods, and runs measured iteration by iteration."""

from __future__ import annotations

import argparse
import math
import sys
import time
from dataclasses import dataclass, field
from typing import Any, Callable, Iterable, Sequence

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline
from tautline._arguments import pick
from tautline._choices import OPTIMIZE_OPTIMIZERS, OPTIMIZE_SCALARIZATIONS, TEMPLATES
from tautline._errors import Messages, run, watch

from ._memory import remembered
from ._meshes import copied
from ._verdicts import GAIN_BAND, Times, Verdict, all_of, below, less, unless

#: c of (3.8), the upper end of the dissertation's typical values.
TYPICAL_C = 1e6
#: From this number of cells on, progress is printed.
LARGE = 200_000
#: The names of the methods of several objectives.
MULTI = ("exponential-sum", "objective-product", "equal-sum")
OPTIMIZERS = {"nlcg": "local conjugate gradient", "newton": "local newton"}
#: Qualities that differ by a smaller part are alike: another perturbation of the mesh changes them by as much.
QUALITY_MARGIN = 0.01
#: Qualities of methods with a comparable performance differ by at most this part.
COMPARABLE = 0.1
#: The first words of the optimizer's message after convergence, and after a failure to proceed.
_CONVERGED, _STUCK = "Converged", ("No step", "No vertex")


@dataclass(frozen=True)
class Method:
    """A column or row of the dissertation's tables: objectives and their scalarization."""

    name: str
    label: str
    objectives: tuple[str, ...]
    scalarization: str = "equal sum"


def methods(*objectives: str, names: Sequence[str]) -> list[Method]:
    """Each objective alone, then the three scalarizations of all of them (section 3.3.1)."""
    single = [Method(o.split("_")[0], f"{n} single objective", (o,)) for o, n in zip(objectives, names)]
    every = ", ".join(names[:-1]) + " and " + names[-1]
    several = [
        Method(scalarization.replace(" ", "-"), f"{scalarization.capitalize()} ({every})", objectives, scalarization)
        for scalarization in ("exponential sum", "objective product", "equal sum")
    ]
    return single + several


@dataclass
class Run:
    """An optimization, measured before it (row 0) and after each iteration."""

    method: Method
    optimizer: str
    iterations: np.ndarray
    #: CPU seconds of all threads from the filter's start to the end of each iteration, set-up included.
    seconds: np.ndarray
    #: Per quantity its value in each row.
    values: dict[str, np.ndarray]
    #: The mesh after the last iteration, and why it was the last.
    mesh: vtkDataSet
    reason: str
    #: Meshes after the iterations asked for.
    kept: dict[int, vtkDataSet] = field(default_factory=dict)
    #: CPU seconds of whole runs of the same optimization; empty: of this run alone.
    repeated: tuple[float, ...] = ()
    #: Why it failed: an error, no step that reduces the objective, vertices that left the domain; "": it did not.
    failure: str = ""

    def converged(self) -> bool:
        """Whether further iterations would not change the mesh, by what the optimizer said."""
        return not self.failure and self.reason.startswith(_CONVERGED)

    def at(self, quantity: str, iteration: int) -> float:
        """The value after an iteration; after the last one only if the run converged, otherwise NaN."""
        series = self.seconds if quantity == "seconds" else self.values[quantity]
        if iteration > self.iterations[-1]:
            return float(series[-1]) if self.converged() else math.nan
        found = np.flatnonzero(self.iterations == iteration)
        return float(series[found[0]]) if found.size else math.nan

    def last(self, quantity: str) -> float:
        """The value at the end; NaN if the run failed."""
        return math.nan if self.failure else float(self.values[quantity][-1])

    def first(self, quantity: str) -> float:
        return float(self.values[quantity][0])

    def last_second(self) -> float:
        return math.nan if self.failure else float(self.seconds[-1])

    def times(self) -> Times:
        """The CPU seconds of all runs."""
        return Times(self.repeated or (self.last_second(),))


#: The measured quantities: name: (metric, aggregation of its values over the valid elements).
QUANTITIES: dict[str, tuple[str, Callable[[np.ndarray], float]]] = {
    "imr_mean": ("imr", np.mean),
    "imr_worst": ("imr", np.max),
    "size_rms": ("size", lambda v: math.sqrt(np.mean(v * v))),
    "size_worst": ("size", np.max),
    "ss_mean": ("ss", lambda q: np.mean(1 / q)),
    "ss_worst": ("ss", lambda q: np.max(1 / q)),
    "si_mean": ("si", np.mean),
    "si_worst": ("si", np.min),
}


#: Aggregations of any other metric: METRIC_mean, METRIC_min, METRIC_max.
AGGREGATIONS: dict[str, Callable[[np.ndarray], float]] = {"mean": np.mean, "min": np.min, "max": np.max}


def measure(mesh: vtkDataSet, quantities: Iterable[str]) -> dict[str, float]:
    """The quantities of a mesh over its valid elements, and `inverted`, the number of all others."""
    parts = {q: QUANTITIES.get(q) or (q.rsplit("_", 1)[0], AGGREGATIONS[q.rsplit("_", 1)[1]]) for q in quantities}
    names = list(dict.fromkeys(metric for metric, _ in parts.values()))
    threads = 0 if mesh.GetNumberOfCells() >= LARGE else 1
    found = tautline.quality(mesh, names, reversed_mesh="measure as given", threads=threads)
    valid = found.validity == 1
    result = {}
    for quantity, (metric, aggregate) in parts.items():
        result[quantity] = float(aggregate(found.values[metric][valid])) if valid.any() else math.nan
    return {**result, "inverted": float(np.count_nonzero(~valid))}


def patch_option(made: argparse.ArgumentParser) -> None:
    """Add the option that chooses where objectives are combined."""
    made.add_argument("--patch-scalarization", action="store_true",
                      help="combine the objectives on the patch of a vertex, Mesquite's default, not on the whole mesh")


def failures(runs: dict[str, Run], names: Iterable[str] = ()) -> str:
    """Why runs failed (of the methods `names`, by default all), a line each, or ""."""
    return "\n".join(f"{n} failed: {runs[n].failure}" for n in (names or runs) if runs[n].failure)


def judged(runs: dict[str, Run], names: Iterable[str], verdict: Any) -> Verdict:
    """A verdict that rests on the runs of these methods: not decided if one of them failed."""
    return unless(failures(runs, names).split("\n")[0], verdict)


def time_judged(runs: dict[str, Run], names: Iterable[str], verdict: Any) -> Verdict:
    """A verdict on times: not decided if a run failed or made fewer iterations than the others."""
    names = list(names)
    made = {n: len(runs[n].iterations) - 1 for n in names}
    uneven = "the runs made different numbers of iterations: " + ", ".join(f"{n} {k}" for n, k in made.items())
    return judged(runs, names, unless(uneven if len(set(made.values())) > 1 else "", verdict))


def about(one: Times, other: Times, printed: float) -> Verdict:
    """Whether one takes the printed multiple of the other's time, within the band of gains."""
    low, high = (factor * printed for factor in GAIN_BAND)
    return all_of((below(other, one, 1.0 / low), below(one, other, high)))


def best_of(runs: dict[str, Run], name: str, others: Iterable[str], quantity: str) -> Verdict:
    """Whether a method has the smallest value of a quantity at the end, by more than the margin of qualities."""
    others = [n for n in others if n != name]
    value = runs[name].last(quantity)
    return judged(runs, [name, *others], all_of(less(value, runs[n].last(quantity), QUALITY_MARGIN) for n in others))


def worst_of(runs: dict[str, Run], name: str, quantity: str) -> Verdict:
    """Whether a method has the largest value of a quantity at the end, by more than the margin of qualities."""
    others = [n for n in runs if n != name]
    value = runs[name].last(quantity)
    return judged(runs, runs, all_of(less(runs[n].last(quantity), value, QUALITY_MARGIN) for n in others))


def reduces(run: Run, quantity: str) -> Verdict:
    """Whether a run reduces a quantity, by more than the margin of qualities."""
    failed = f"{run.method.name} failed: {run.failure}" if run.failure else ""
    return unless(failed, less(run.last(quantity), run.first(quantity), QUALITY_MARGIN))


@remembered
def improve(
    mesh: vtkDataSet,
    method: Method,
    iterations: int,
    quantities: Iterable[str],
    *,
    optimizer: str = "nlcg",
    keep: Sequence[int] = (),
    trace: bool = True,
    repeats: int = 1,
    **options: Any,
) -> Run:
    """Run vtkMeshOptimizer, and measure the mesh after each iteration, or without trace at the start and the end.

    keep: iterations after which the mesh is kept. repeats: number of runs, for the times; the fastest one is returned.
    options: see _configured().
    """
    filter_, messages = _configured(mesh, method, iterations, optimizer, **options)
    filter_.SetAnimation(trace)
    timed = []
    for _ in range(repeats):
        filter_.Modified()
        timed.append(_timed(filter_, messages))
    seconds = min(timed, key=lambda stamps: stamps[-1])
    count = len(seconds)
    rows, kept = [], {}
    for step in range(count) if trace else (0, count - 1):
        if trace:
            filter_.UpdateTimeStep(step)
            messages.raise_errors()
            shown = filter_.GetOutputDataObject(0)
        else:
            shown = mesh if step == 0 else filter_.GetOutputDataObject(0)
        rows.append(measure(shown, quantities))
        if step in keep:
            kept[step] = copied(shown)
    values = {key: np.array([row[key] for row in rows]) for key in rows[0]}
    steps = np.arange(count) if trace else np.array([0, count - 1])
    history = filter_.GetHistory()
    values["objective"] = np.array([history.GetValueByName(int(i), "Objective").ToDouble() for i in steps])
    final = copied(filter_.GetOutputDataObject(0))
    if mesh.GetNumberOfCells() >= LARGE:
        text = f"{method.name}, {optimizer}: {count - 1} iterations, {seconds[-1]:.1f} CPU s"
        print(text, file=sys.stderr, flush=True)
    repeated = tuple(float(stamps[-1]) for stamps in timed)
    reason = filter_.GetReason()
    if not trace:
        seconds = seconds[[0, -1]]
    failure = reason if reason.startswith(_STUCK) else ""
    return Run(method, optimizer, steps, seconds, values, final, reason, kept, repeated, failure)


def _configured(
    mesh: vtkDataSet,
    method: Method,
    iterations: int,
    optimizer: str,
    *,
    patch_iterations: int = 1,
    beta: float = 0.0,
    c: float = 0.0,
    allow_inversion: bool = False,
    two_digits: bool = False,
    relative_change: float = 0.0,
    reduction: float = 1.0,
    best_known: float | None = None,
    weights: Sequence[tuple[str, float]] = (),
    template: str = "default",
    patch_scalarization: bool = False,
    threads: int = 0,
) -> tuple[Any, Messages]:
    """A vtkMeshOptimizer of a method, with fixed boundary and without culling, and its messages.

    weights: further objectives and their weights; the scalarization is then the weighted sum, with 1 for the others.
    template: aggregation of the objectives of the method. patch_scalarization: combine the objectives' values on the
    patch of a vertex instead of the values on the whole mesh.
    """
    filter_ = tautline.vtkMeshOptimizer()
    messages = watch(filter_)
    for name in method.objectives:
        filter_.AddObjectiveByName(name, pick("template", template, TEMPLATES) - 1)
    for name, weight in weights:
        filter_.AddObjectiveByName(name, filter_.DEFAULT_TEMPLATE, weight)
    scalarization = "weighted sum" if weights else method.scalarization
    filter_.SetScalarization(pick("scalarization", scalarization, OPTIMIZE_SCALARIZATIONS))
    if patch_scalarization and len(method.objectives) + len(weights) > 1:
        filter_.SetPatchScalarization(True)
    filter_.SetOptimizer(pick("optimizer", OPTIMIZERS.get(optimizer, optimizer), OPTIMIZE_OPTIMIZERS))
    filter_.SetHoldWorst(False)  # the methods of the dissertation guarantee nothing about single elements
    filter_.SetMaximumIterations(iterations)
    filter_.SetPatchIterations(patch_iterations)
    filter_.SetBeta(beta)
    filter_.SetC(c)
    filter_.SetAllowInversion(allow_inversion)
    filter_.SetUntangleFirst(False)
    filter_.SetTwoDigits(two_digits)
    filter_.SetRelativeChange(relative_change)
    filter_.SetGradientNorm(0.0)
    filter_.SetReduction(reduction)
    if best_known is not None:
        filter_.SetBestKnown(best_known)
        filter_.UseBestKnownOn()
    filter_.SetCulling(0.0)
    filter_.SetTimeLimit(0.0)
    filter_.SetThreads(threads)
    filter_.SetInputDataObject(0, mesh)
    return filter_, messages


def _timed(filter_: Any, messages: Messages) -> np.ndarray:
    """Run a vtkMeshOptimizer; the CPU seconds from its start to the end of each iteration, 0 is the set-up."""
    stamps: list[float] = []
    tag = filter_.AddObserver("ProgressEvent", lambda *_: stamps.append(time.process_time()))
    began = time.process_time()
    run(filter_, messages)
    filter_.RemoveObserver(tag)
    count = filter_.GetHistory().GetNumberOfRows()
    seconds = np.array(stamps) - began
    # The pipeline itself also reports progress: 0 before and 1 after the filter's own.
    return seconds[len(seconds) - 1 - count : -1] if len(seconds) > count else np.resize(seconds, count)


def compare(runs: dict[str, Run], quantity: str) -> str:
    """The final values of a quantity, for the figures of a finding."""
    start = next(iter(runs.values())).first(quantity)
    return f"{quantity}: start {start:.4g}; " + ", ".join(f"{n} {r.last(quantity):.4g}" for n, r in runs.items())
