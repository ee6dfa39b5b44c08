# SPDX-License-Identifier: BSD-3-Clause
"""Shared by the studies of tangled meshes (sections 3.3.3, 3.4.3, 3.4.4 and 3.5)."""

from __future__ import annotations

from typing import Any, Iterable, Sequence

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

from tautline._errors import Error

from ._common import TYPICAL_C, Method, Run, improve, measure, methods
from ._meshes import cells_of, scaled, sizes_of
from ._report import Report

#: Over the mean size: the size below which the untangling metric (3.3) counts an element. The dissertation has no
#: value.
BETA = 0.01
#: Mean sizes of the elements in which the methods are compared.
UNITS = (0.001, 0.1, 1.0, 10.0, 100.0)
LABELS = {"si": "SI", "size": "size", "untangle_beta": "untangling"}
NOTE = (
    "Objectives: sum of 1 / SI over the elements valid at the start of an iteration, sum of the squared untangling "
    f"metric (3.3) with beta = {BETA:g} of the mean size. (The dissertation's sum of 1 / SI includes inverted "
    "elements, whose terms are negative.) Steps may invert elements, as with the metrics without a barrier there.\n"
    "The scalarizations combine the objectives' values on the whole mesh, as (3.11) to (3.13) are written. "
    "Mesquite's default for patches evaluates an objective on the patch alone, where values are far below c, so that "
    "the exponential sum is nearly the equal sum; the dissertation does not state which of them its figures are from."
)
#: A weight that makes the untangling metric ineffective; without this metric tangled meshes are refused.
_NEGLIGIBLE = 1e-30
#: Growth of a mesh beyond which it counts as diverged; the sum of 1 / SI has no lower bound.
_DIVERGED = 100.0


def tangled_methods(*objectives: str) -> list[Method]:
    return methods(*objectives, names=[LABELS[o] for o in objectives])


def untangle(mesh: vtkDataSet, method: Method, iterations: int, quantities: Iterable[str], *,
             keep: Sequence[int] = (), c: float = TYPICAL_C, **options: Any) -> Run:
    """Run a method on a tangled mesh, one iteration at a time while it has inverted elements.

    The optimizer excludes the shape terms of elements that are inverted at its start; a restart includes them as soon
    as they are valid. A product of objectives of which one is 0 cannot be reduced: further iterations do not change the
    mesh.
    """
    quantities = list(quantities)
    beta = BETA * float(np.mean(np.abs(sizes_of(mesh))))
    rows, seconds, kept, reason = [measure(mesh, quantities)], [0.0], {0: mesh}, ""
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
            reason = str(error)
            break
        reason, now = run.reason, run.mesh
        steps = len(run.iterations) - 1
        for step in range(1, steps + 1):
            rows.append({q: run.values[q][step] for q in rows[0]})
            seconds.append(seconds[-1] + run.seconds[step] - (run.seconds[step - 1] if step > 1 else 0.0))
        kept.update({done + k: m for k, m in run.kept.items() if k > 0})
        done += steps
        now.ComputeBounds()
        if now.GetLength() > extent:
            reason = f"Diverged: vertices left the domain in iteration {done}."
            break
        if steps < chunk:
            break
    # After an early end the mesh no longer changes.
    while len(rows) <= iterations:
        rows.append(rows[-1])
        seconds.append(seconds[-1])
    kept.update({k: now for k in keep if k not in kept and k >= done})
    values = {key: np.array([row[key] for row in rows]) for key in rows[0]}
    return Run(
        method, options.get("optimizer", "nlcg"), np.arange(len(rows)), np.array(seconds), values, now, reason, kept,
    )


def _weights(method: Method) -> list[tuple[str, float]]:
    """Further objectives with negligible weights, without which tangled meshes are refused."""
    return [] if "untangle_beta" in method.objectives else [("untangle_beta", _NEGLIGIBLE)]


def counts(runs: dict[str, Run], iterations: Sequence[int]) -> dict[str, list[float]]:
    """Inverted elements by label and iteration, for a table."""
    return {run.method.label: [run.at("inverted", i) for i in iterations] for run in runs.values()}


def untangled_after(run: Run) -> float:
    """The first iteration after which no element is inverted; infinity if there is none."""
    wrong = np.flatnonzero(run.values["inverted"] > 0)
    first = int(wrong[-1]) + 1 if wrong.size else 0
    return first if first < len(run.iterations) else float("inf")


def after(runs: dict[str, Run]) -> str:
    """The iterations after which no element is inverted, by method, for the figures of a finding."""
    return "iterations until all are valid: " + ", ".join(f"{n} {untangled_after(r):g}" for n, r in runs.items())


def by_unit(report: Report, mesh: vtkDataSet, objectives: Sequence[str], iterations: int, mean_sizes: Sequence[float],
            **options: Any) -> None:
    """A table of the scalarizations in other units of length, given by the mean size of the elements."""
    dimension = cells_of(mesh).shape[1] - 1
    mean = float(np.mean(np.abs(sizes_of(mesh))))
    every = tangled_methods(*objectives)[len(objectives) :]
    variants = [("exponential-sum, c chosen", every[0], 0.0), *((m.name, m, TYPICAL_C) for m in every)]
    rows = []
    for size in mean_sizes:
        start = scaled(mesh, (size / mean) ** (1.0 / dimension))
        for name, method, c in variants:
            run = untangle(start, method, iterations, ("si_mean", "si_worst"), c=c, **options)
            done = untangled_after(run)
            valid_after = "never" if np.isinf(done) else f"{done:g}"
            rows.append([size, name, valid_after, int(run.last("inverted")), run.last("si_worst")])
    title = f"Other units of length, {iterations} iterations: when all elements are valid, inverted ones at the end"
    report.table("units", title, ["mean size", "method", "valid after", "inverted", "worst SI"], rows)
    report.text(
        "Rows repeat where the largest value of the untangling metric is below that of the other metrics: the "
        "optimizer then rescales it as in section 3.3.3, which eliminates the unit."
    )


def diverged(runs: dict[str, Run]) -> str:
    """A sentence on the runs whose vertices left the domain, or ""."""
    return "\n".join(f"{r.method.label}: {r.reason}" for r in runs.values() if r.reason.startswith("Diverged"))
