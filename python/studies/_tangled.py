# SPDX-License-Identifier: BSD-3-Clause
"""Shared by the studies of tangled meshes (sections 3.3.3, 3.4.3, 3.4.4 and 3.5)."""

from __future__ import annotations

import math
from typing import Any, Callable, Iterable, Sequence

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

from tautline._errors import Error

from ._common import TYPICAL_C, Method, Run, failures, improve, judged, measure, methods
from ._memory import remembered
from ._meshes import cells_of, scaled, sizes_of
from ._report import Report
from ._verdicts import Mixed, Open, Verdict, all_of, less

#: Over the mean size: the size below which the untangling metric (3.3) counts an element. The dissertation has no
#: value.
BETA = 0.01
#: Mean sizes of the elements, and beta over them, in which the methods are compared; where objectives are combined; c.
UNITS, SMALL_UNITS = (0.1, 1.0, 10.0, 100.0), (1.0, 100.0)
BETAS = (BETA, 0.3, 1.0)
SMALLEST_C = 1e4
LABELS = {"si": "SI", "size": "size", "untangle_beta": "untangling"}
NOTE = (
    "Objectives: sum of 1 / SI over the elements valid at the start of an iteration, sum of the squared untangling "
    f"metric (3.3) with beta = {BETA:g} of the mean size. (The dissertation's sum of 1 / SI includes inverted "
    "elements, whose terms are negative.) Steps may invert elements, as with the metrics without a barrier there.\n"
    "The scalarizations combine the objectives' values on the whole mesh, as (3.11) to (3.13) are written. "
    "Mesquite's default for patches evaluates an objective on the patch alone, where values are far below c, so that "
    "the exponential sum is nearly the equal sum; the dissertation does not state which of them its figures are from. "
    "--patch-scalarization evaluates them there."
)
#: A weight that makes the untangling metric ineffective; without this metric tangled meshes are rejected.
_NEGLIGIBLE = 1e-30
#: Growth of a mesh beyond which it counts as diverged; the sum of 1 / SI has no lower bound.
_DIVERGED = 100.0
#: The first words of the reason of a run that diverged: its method fails, not its optimizer.
DIVERGED = "Diverged"


def tangled_methods(*objectives: str) -> list[Method]:
    return methods(*objectives, names=[LABELS[o] for o in objectives])


@remembered
def untangle(mesh: vtkDataSet, method: Method, iterations: int, quantities: Iterable[str], *,
             keep: Sequence[int] = (), c: float = TYPICAL_C, beta: float = BETA, **options: Any) -> Run:
    """Run a method on a tangled mesh, one iteration at a time while it has inverted elements.

    beta: of the untangling metric, over the mean size.

    The optimizer excludes the shape terms of elements that are inverted at its start; a restart includes them as soon
    as they are valid. A product of objectives of which one is 0 cannot be reduced: the optimizer then has converged.
    """
    quantities = list(quantities)
    beta *= float(np.mean(np.abs(sizes_of(mesh))))
    rows, seconds, kept, reason, failure = [measure(mesh, quantities)], [0.0], {0: mesh}, "", ""
    now, done, repaired = mesh, 0, False
    extent = _DIVERGED * mesh.GetLength()
    while done < iterations:
        tangled = rows[-1]["inverted"] > 0
        chunk = 1 if tangled or not repaired else iterations - done
        repaired = not tangled
        try:
            run = improve(now, method, chunk, quantities, beta=beta, c=c, allow_inversion=True,
                          keep=[k - done for k in keep], weights=_weights(method), **options)
        except Error as error:
            reason = failure = str(error)
            break
        reason, failure, now = run.reason, run.failure, run.mesh
        steps = len(run.iterations) - 1
        for step in range(1, steps + 1):
            rows.append({q: run.values[q][step] for q in rows[0]})
            seconds.append(seconds[-1] + run.seconds[step] - (run.seconds[step - 1] if step > 1 else 0.0))
        kept.update({done + k: m for k, m in run.kept.items() if k > 0})
        done += steps
        now.ComputeBounds()
        if now.GetLength() > extent:
            reason = failure = f"{DIVERGED}: vertices left the domain in iteration {done}."
            break
        if failure or steps < chunk:
            break
    kept.update({k: now for k in keep if k not in kept and k >= done})
    values = {key: np.array([row[key] for row in rows]) for key in rows[0]}
    return Run(method, options.get("optimizer", "nlcg"), np.arange(len(rows)), np.array(seconds), values, now, reason,
               kept, failure=failure)


def _weights(method: Method) -> list[tuple[str, float]]:
    """Further objectives with negligible weights, without which tangled meshes are rejected."""
    return [] if "untangle_beta" in method.objectives else [("untangle_beta", _NEGLIGIBLE)]


def counts(runs: dict[str, Run], iterations: Sequence[int]) -> dict[str, list[float]]:
    """Inverted elements by label and iteration, for a table."""
    return {run.method.label: [run.at("inverted", i) for i in iterations] for run in runs.values()}


def untangled_after(run: Run) -> float:
    """The first iteration after which no element is inverted; infinity if there is none, NaN if the run failed."""
    if run.failure:
        return math.nan
    wrong = np.flatnonzero(run.values["inverted"] > 0)
    first = int(wrong[-1]) + 1 if wrong.size else 0
    return first if first < len(run.values["inverted"]) else math.inf


def after(runs: dict[str, Run]) -> str:
    """The iterations after which no element is inverted, by method, for the numbers of a finding."""
    return "iterations until all are valid: " + ", ".join(f"{n} {_until(r)}" for n, r in runs.items())


def _until(run: Run) -> str:
    done = untangled_after(run)
    return "failed" if math.isnan(done) else "never" if math.isinf(done) else f"{done:g}"


def _diverged(run: Run) -> bool:
    """Whether a run diverged and left inverted elements."""
    return run.failure.startswith(DIVERGED) and bool(run.values["inverted"][-1] > 0)


def untangles(runs: dict[str, Run], names: Iterable[str], within: float = math.inf) -> Verdict:
    """Whether each method leaves no inverted element, within a number of iterations; one that diverges does not."""
    def one(name: str) -> Verdict:
        if _diverged(runs[name]):
            return False
        done = untangled_after(runs[name])
        return judged(runs, [name], math.isfinite(done) and done <= within)

    return all_of(map(one, names))


def fails(runs: dict[str, Run], names: Iterable[str]) -> Verdict:
    """Whether each method leaves inverted elements, or diverges; not decided where the optimizer failed."""
    def one(name: str) -> Verdict:
        run = runs[name]
        if _diverged(run):
            return True
        return judged(runs, [name], run.last("inverted") > 0)

    return all_of(map(one, names))


def sooner(runs: dict[str, Run], one: str, other: str) -> Verdict:
    """Whether a method needs fewer iterations than another one, which also untangles the mesh; a tie is not fewer.

    A method that untangles the mesh is sooner than one that never does, or diverges; not decided if both do not.
    """
    first, second = (math.inf if _diverged(runs[n]) else untangled_after(runs[n]) for n in (one, other))
    left = [n for n in (one, other) if not _diverged(runs[n])]
    if math.isinf(first) and math.isinf(second):
        return Open("neither method untangles the mesh")
    return judged(runs, left, bool(first < second))


def better(runs: dict[str, Run], one: str, others: Iterable[str], quantity: str, margin: float) -> Verdict:
    """Whether a method has a larger value at the end than each of the others, of those that leave no inverted element.

    Not decided if it is the only one that is left.
    """
    others = [n for n in others if n != one]
    left = [n for n in others if runs[n].last("inverted") == 0]
    if failures(runs, (one, *others)) or not left:
        return judged(runs, (one, *others), Open(f"no method but {one} leaves no inverted element"))
    if runs[one].last("inverted") != 0:
        return False
    return all_of(less(runs[n].last(quantity), runs[one].last(quantity), margin) for n in left)


def settings(report: Report, mesh: vtkDataSet, objectives: Sequence[str], iterations: int, units: Sequence[float],
             betas: Sequence[float] = BETAS, **options: Any) -> dict[str, dict[str, Run]]:
    """The runs of several objectives and of untangling alone in settings that the dissertation does not state.

    units: mean sizes of the elements; none: the mean size of the mesh, which the dissertation states. A table says when
    all elements are valid.
    """
    dimension = cells_of(mesh).shape[1] - 1
    mean = float(np.mean(np.abs(sizes_of(mesh))))
    every = [m for m in tangled_methods(*objectives) if m.name == "untangle" or len(m.objectives) > 1]
    varied = [(size, beta, where, TYPICAL_C)
              for size in (units or (mean,)) for beta in betas for where in (False, True)]
    varied += [(size, betas[0], False, SMALLEST_C) for size in (units or (mean,))]
    found, rows = {}, []
    for size, beta, where, c in varied:
        start = scaled(mesh, (size / mean) ** (1.0 / dimension))
        chosen = {**options, "patch_scalarization": where, "c": c, "beta": beta}
        runs = {m.name: untangle(start, m, iterations, ("si_mean",), **chosen)
                for m in every}
        place = "patch" if where else "mesh"
        found[f"{size:g}, {beta:g}, {place}, {c:g}"] = runs
        rows.append([size, beta, place, c, *map(_until, runs.values())])
    report.table("settings", f"Other settings, {iterations} iterations: after which iteration all elements are valid",
                 ["mean size", "beta / mean", "combined on", "c", *(m.name for m in every)], rows)
    report.text(
        "Rows repeat where the largest value of the untangling metric is below the values of the other metrics: the "
        "optimizer then rescales it as in section 3.3.3, which eliminates the unit."
    )
    return found


def in_settings(found: dict[str, dict[str, Run]], test: Callable[[dict[str, Run]], Verdict]) -> Verdict:
    """Whether a test of the runs holds in all settings, in none, or in some; not decided if it is open in one."""
    verdicts = [test(runs) for runs in found.values()]
    decided = [bool(v) for v in verdicts if not isinstance(v, Open)]
    if any(decided) and not all(decided):
        return Mixed("it depends on what the dissertation does not state (unit of length, beta, c, where objectives "
                     f"are combined): true in {sum(decided)} of {len(verdicts)} settings")
    return all_of(verdicts)


def until_all(found: dict[str, dict[str, Run]], names: Iterable[str]) -> str:
    """The iterations after which no element is inverted, the smallest and the largest over the settings."""
    def text(name: str) -> str:
        done = [untangled_after(runs[name]) for runs in found.values()]
        known = [d for d in done if math.isfinite(d)]
        least = f"{min(known):g} to {max(known):g}" if known else "never"
        return f"{name} {least}" + (f" (not in {len(done) - len(known)} of {len(done)} settings)" if known and
                                    len(known) < len(done) else "")

    return "iterations until all are valid: " + ", ".join(map(text, names))


def inverted_table(report: Report, file: str, title: str, runs: dict[str, Run], iterations: Sequence[int],
                   theirs: dict[str, Sequence[float]], extra: dict[str, list[float]] | None = None) -> None:
    """A table of inverted elements by iterations, with the dissertation's by method, and why runs failed."""
    labels = {n: r.method.label for n, r in runs.items()}
    known = {labels.get(name, name): row for name, row in theirs.items()}
    report.beside(file, title, iterations, counts(runs, iterations) | (extra or {}), known)
    if failures(runs):
        report.text(failures(runs))
