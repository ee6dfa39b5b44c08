# SPDX-License-Identifier: BSD-3-Clause
"""Shared by the studies of two goals without inverted elements (sections 3.4.1 and 3.4.2)."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Sequence

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._common import TYPICAL_C, Run, improve, measure, methods
from ._meshes import scaled
from ._report import Report, parser

DOMAINS = ("disk3d", "disk2d", "barrier2d", "barrier3d")  # Figure 3.3; the first is that of tables and figures
ITERATIONS = 20
TABLE_ITERATIONS = (1, 5, 10, 20)
CELLS, SMALL_CELLS = 1_000_000, 2_000
REPEATS = 3
#: Of the distance to inversion: brings the 3D disk as far from optimal as inversion-free moves of half the vertices do.
PERTURBATION = 0.95


@dataclass(frozen=True)
class Goals:
    """Two metrics, and the quantities shown in the figures."""

    name: str
    title: str
    metrics: tuple[str, str]
    labels: tuple[str, str]
    means: tuple[str, str]
    worsts: tuple[str, str]
    #: The quantity, and its initial value in the dissertation, that fix the unit of length, and its power of a length.
    unit: tuple[str, float, int]
    axes: tuple[str, str]
    times: dict[str, tuple[float, ...]]


def options(goals: Goals, text: str | None, arguments: Sequence[str]) -> argparse.Namespace:
    made = parser(goals.name, text, CELLS, repeats=REPEATS, steps=True)
    made.add_argument("--iterations", type=int, default=ITERATIONS, help="sweeps (default: %(default)s)")
    made.add_argument("--domains", nargs="+", choices=DOMAINS, default=list(DOMAINS), help="default: all four")
    given = made.parse_args(arguments)
    given.cells = given.cells or (SMALL_CELLS if given.small else CELLS)
    return given


def start_mesh(goals: Goals, domain: str, cells: int) -> vtkDataSet:
    """The perturbed mesh, in the unit of length that the dissertation's initial value implies."""
    mesh = tautline.perturb(tautline.domain(domain, cells), fraction=PERTURBATION).mesh
    quantity, theirs, power = goals.unit
    dimension = 3 if domain.endswith("3d") else 2
    power = power if power != 3 else dimension  # a size is an area in the plane
    return scaled(mesh, (theirs / measure(mesh, [quantity])[quantity]) ** (1.0 / power))


@dataclass
class Outcome:
    """The runs by the names of the methods: on the first domain by both optimizers, start and end on all domains."""

    nlcg: dict[str, Run]
    newton: dict[str, Run]
    others: dict[str, dict[str, Run]]


def experiment(goals: Goals, given: argparse.Namespace, report: Report) -> Outcome:
    """Run every method, write tables and pictures."""
    quantities = [*goals.means, *goals.worsts]
    every = methods(*goals.metrics, names=goals.labels)
    first, *rest = given.domains
    mesh = start_mesh(goals, first, given.cells)
    common = dict(c=TYPICAL_C, threads=given.threads)
    patch = dict(patch_iterations=given.patch_iterations)
    report.text(
        f"{first}: {mesh.GetNumberOfCells():,} elements, {mesh.GetNumberOfPoints():,} vertices, half of the interior "
        f"ones perturbed by up to {PERTURBATION:g} of the distance to inversion, boundary fixed.\n"
        f"Unit of length: that in which {goals.unit[0]} starts at {goals.unit[1]:g} as in the dissertation (the "
        f"exponential and the equal sum depend on it). c = {TYPICAL_C:g}.\n"
        f"Local Polak-Ribiere conjugate gradients, {given.patch_iterations} steps per vertex and sweep; an iteration "
        "is a sweep over all vertices. For comparison Local Newton (over-relaxed, one step). Times are CPU seconds of "
        f"{given.threads or 'all'} thread(s), set-up included; the dissertation's were measured on a Core2 Duo T7500 "
        "at 2.2 GHz."
    )
    nlcg = {m.name: improve(mesh, m, given.iterations, quantities, repeats=given.repeats, **common, **patch)
            for m in every}
    newton = {m.name: improve(mesh, m, given.iterations, quantities, optimizer="newton", **common) for m in every}
    report.curves("curves", [*nlcg.values(), *newton.values()])
    _time_tables(goals, report, nlcg, newton)
    _quality_table(goals, report, {**nlcg, **{f"{k} newton": r for k, r in newton.items()}}, first)
    _digits(goals, report, nlcg, newton)
    runs = list(nlcg.values())
    averages = [(q, label, False) for q, label in zip(goals.means, goals.axes)]
    report.plot("average", runs, averages)
    labels = [a.replace("Average", "Worst").replace(" (rms)", "") for a in goals.axes]
    report.plot("worst", runs, [(q, label, True) for q, label in zip(goals.worsts, labels)])
    report.plot("average_newton", list(newton.values()), averages)
    others = {first: nlcg}
    for domain in rest:
        mesh = start_mesh(goals, domain, given.cells)
        others[domain] = {
            m.name: improve(mesh, m, given.iterations, quantities, trace=False, **common, **patch) for m in every
        }
        _quality_table(goals, report, others[domain], domain)
    return Outcome(nlcg, newton, others)


def _time_tables(goals: Goals, report: Report, nlcg: dict[str, Run], newton: dict[str, Run]) -> None:
    for file, runs, what in (("times", nlcg, "local NLCG"), ("times_newton", newton, "Local Newton")):
        ours = {r.method.label: [r.at("seconds", i) for i in TABLE_ITERATIONS] for r in runs.values()}
        theirs = {r.method.label: goals.times[name] for name, r in runs.items()}
        report.beside(file, f"Smoothing time (CPU s) by iterations, {what}", TABLE_ITERATIONS, ours, theirs)


def _quality_table(goals: Goals, report: Report, runs: dict[str, Run], domain: str) -> None:
    quantities = [*goals.means, *goals.worsts]
    one = next(iter(runs.values()))
    rows = [["start", *(one.first(q) for q in quantities)]]
    rows += [[name, *(r.last(q) for q in quantities)] for name, r in runs.items()]
    report.table(f"quality_{domain}", f"Quality at the end, {domain}", ["method", *quantities], rows)


def _digits(goals: Goals, report: Report, nlcg: dict[str, Run], newton: dict[str, Run]) -> None:
    """ "Inaccurate smoothing": the first iteration that does not change two decimals of the mean qualities."""
    rows = []
    for name, run in [*nlcg.items(), *((f"{k} newton", r) for k, r in newton.items())]:
        watched = [q for q, metric in zip(goals.means, goals.metrics) if metric in run.method.objectives]
        digits = np.round([run.values[q] for q in watched], 2)
        same = np.flatnonzero((digits[:, 1:] == digits[:, :-1]).all(axis=0))
        iteration = int(same[0]) + 1 if same.size else -1
        seconds = run.at("seconds", iteration) if same.size else float("nan")
        rows.append([name, "not reached" if iteration < 0 else str(iteration), seconds])
    title = "Inaccurate smoothing: mean qualities keep two decimals"
    report.table("two_digits", title, ["method", "at iteration", "CPU s"], rows)


def everywhere(others: dict[str, dict[str, Run]], test) -> tuple[bool, str]:
    """Whether a test of the runs holds on all domains, and a text with the domains where it does and does not."""
    failed = [domain for domain, runs in others.items() if not test(runs)]
    held = [domain for domain in others if domain not in failed]
    return not failed, f"holds on {', '.join(held) or 'none'}" + (f", not on {', '.join(failed)}" if failed else "")


