# SPDX-License-Identifier: BSD-3-Clause
"""Shared by the studies of two goals without inverted elements (sections 3.4.1 and 3.4.2)."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Callable, Sequence

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline
from tautline._errors import Error

from ._common import (
    COMPARABLE, MULTI, QUALITY_MARGIN, TYPICAL_C, Run, best_of, failures, improve, judged, measure, methods,
    patch_option, time_judged,
)
from ._memory import remembered
from ._meshes import scaled
from ._report import Report, parser
from ._verdicts import Times, Verdict, all_of, below, close, unless, word

DOMAINS = ("disk3d", "disk2d", "barrier2d", "barrier3d")  # Figure 3.3; the first is used for tables and figures
ITERATIONS = 20
TABLE_ITERATIONS = (1, 5, 10, 20)
CELLS, SMALL_CELLS = 1_000_000, 2_000
REPEATS = 3
#: Fraction of the distance to inversion: brings the 3D disk as far from optimal as inversion-free moves of half the
#: vertices do.
PERTURBATION = 0.95
#: Complete smoothing takes significantly longer than the inaccurate one if it takes this multiple of its time.
SIGNIFICANT_TIME = 2.0
#: The table of qualities has this many decimals where smoothing is inaccurate (section 3.4).
DECIMALS = 2


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
    made.add_argument("--mesh", metavar="FILE", help="optimize this mesh, without the dissertation's numbers")
    made.add_argument("--metrics", nargs=2, metavar="METRIC", default=list(goals.metrics),
                      help="of --mesh (default: %(default)s)")
    patch_option(made)
    given = made.parse_args(arguments)
    if given.mesh is None and given.metrics != list(goals.metrics):
        raise Error("--metrics needs --mesh: the dissertation's numbers belong to its metrics")
    given.cells = given.cells or (SMALL_CELLS if given.small else CELLS)
    return given


def of_user(given: argparse.Namespace, report: Report) -> int:
    """Two metrics on the mesh of a file: tables and curves of their qualities."""
    mesh = tautline.read(given.mesh)
    every = methods(*given.metrics, names=given.metrics)
    quantities = [f"{metric}_{part}" for metric in given.metrics for part in ("mean", "min", "max")]
    report.text(f"{given.mesh}: {mesh.GetNumberOfCells():,} cells, {mesh.GetNumberOfPoints():,} points. Local "
                f"Polak-Ribiere conjugate gradients, {given.patch_iterations} steps per vertex and sweep; boundary "
                "fixed. c of the exponential sum is chosen from the initial values.")
    runs = {m.name: improve(mesh, m, given.iterations, quantities, repeats=given.repeats, threads=given.threads,
                            patch_iterations=given.patch_iterations, patch_scalarization=given.patch_scalarization)
            for m in every}
    if failures(runs):
        report.text(failures(runs))
    one = next(iter(runs.values()))
    rows = [["start", *(one.first(q) for q in quantities), one.first("inverted"), 0.0]]
    rows += [[r.method.label, *(r.last(q) for q in quantities), r.last("inverted"), r.times().best]
             for r in runs.values()]
    report.table("quality", "Quality at the end", ["method", *quantities, "inverted", "CPU s"], rows)
    report.curves("curves", list(runs.values()))
    report.plot("average", list(runs.values()), [(f"{metric}_mean", f"Mean {metric}", False)
                                                 for metric in given.metrics])
    return report.finish()


@remembered
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
    patch = dict(patch_iterations=given.patch_iterations, patch_scalarization=given.patch_scalarization)
    report.text(
        f"{first}: {mesh.GetNumberOfCells():,} elements, {mesh.GetNumberOfPoints():,} vertices, half of the interior "
        f"ones perturbed by up to {PERTURBATION:g} of the distance to inversion, boundary fixed.\n"
        f"Unit of length: the one in which {goals.unit[0]} starts at {goals.unit[1]:g} as in the dissertation (the "
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
    for domain, runs in (*others.items(), (f"{first} newton", newton)):
        if failures(runs):
            report.text(f"{domain}: {failures(runs)}")
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
        iteration = two_digits(goals, run)
        seconds = run.at("seconds", iteration) if iteration else float("nan")
        rows.append([name, str(iteration or "not reached"), seconds])
    title = "Inaccurate smoothing: mean qualities keep two decimals"
    report.table("two_digits", title, ["method", "at iteration", "CPU s"], rows)


def two_digits(goals: Goals, run: Run) -> int:
    """The first iteration that does not change two decimals of the mean qualities of a method; 0 if there is none."""
    watched = [q for q, metric in zip(goals.means, goals.metrics) if metric in run.method.objectives]
    digits = np.round([run.values[q] for q in watched], DECIMALS)
    same = np.flatnonzero((digits[:, 1:] == digits[:, :-1]).all(axis=0))
    return int(same[0]) + 1 if same.size else 0


def everywhere(others: dict[str, dict[str, Run]], test: Callable[[dict[str, Run]], Verdict]) -> tuple[Verdict, str]:
    """Whether a test of the runs holds on all domains, and a text with its verdict on each."""
    found = {domain: test(runs) for domain, runs in others.items()}
    return all_of(found.values()), ", ".join(f"{domain}: {word(verdict)}" for domain, verdict in found.items())


def common_findings(report: Report, goals: Goals, found: Outcome) -> None:
    """The findings of sections 3.4 and 3.6 on two goals."""
    count = won = 0
    for runs in found.others.values():
        for quantity in (*goals.means, *goals.worsts):
            count += 1
            won += best_of(runs, MULTI[0], MULTI, quantity) is True
    failed = "; ".join(filter(None, (failures(runs, MULTI) for runs in found.others.values())))
    report.finding(
        "3.6", "In most cases the exponential sum is the most effective of the three methods",
        unless(failed, 2 * won > count), f"it is better than both others in {won} of {count} cases",
        criterion="in more than half of the cases (average and worst quality by each metric on each domain) it is "
        f"better at the end than both others, by more than {QUALITY_MARGIN:.0%}")
    holds, where = everywhere(found.others, lambda r: judged(r, MULTI, all_of(
        close(r["equal-sum"].last(q), r[MULTI[0]].last(q), COMPARABLE) for q in (*goals.means, *goals.worsts))))
    report.finding(
        "3.6", "The equal sum shows comparable performance to the exponential sum", holds, where,
        criterion=f"average and worst quality by each metric differ by at most {COMPARABLE:.0%} at the end, on each "
        "domain")
    shares, verdicts = [], []
    for name, run in found.nlcg.items():
        first = two_digits(goals, run)
        if not first or run.failure:
            shares.append(f"{name} not reached")
            continue
        watched = [q for q, metric in zip(goals.means, goals.metrics) if metric in run.method.objectives]
        gains = [1.0 - run.last(q) / run.at(q, first) for q in watched]
        early, end = Times((run.at("seconds", first),)), Times((run.last_second(),))
        shares.append(f"{name} iteration {first}, {early} of {end}, then {max(gains):.2%} better")
        verdicts += [max(gains) < QUALITY_MARGIN, below(early, end, 1.0 / SIGNIFICANT_TIME)]
    report.finding(
        "3.4", "Accurate smoothing significantly increases the time, but slightly increases the quality",
        time_judged(found.nlcg, found.nlcg, all_of(verdicts)), "; ".join(shares),
        criterion=f"by each method that keeps two decimals of its averages before the last sweep: all sweeps take more "
        f"than {SIGNIFICANT_TIME:g} times as long, and improve the averages by less than {QUALITY_MARGIN:.0%}; all "
        "sweeps stand for accurate smoothing")
