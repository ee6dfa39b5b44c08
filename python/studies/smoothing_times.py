# SPDX-License-Identifier: BSD-3-Clause
"""Times and angles of smoothing by IMR, RR, SI and SS: section 2.4, Tables 2.6 and 2.7."""

from __future__ import annotations

import argparse
import math
from typing import Sequence

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from . import _own_mesh
from ._memory import remembered
from ._meshes import cells_of, points_of
from ._report import Report, parser
from ._solver_tables import CELLS as PRINTED_CELLS
from ._solver_tables import METRICS
from ._solvers import DOMAINS, FULL, ILU, PDES, REDUCTION, Setup, best_objective, smoothing, solve
from ._solvers import LABELS as COMBINATION
from ._verdicts import Open, Times, Verdict, all_of, below, faster, quickest, slowest

LABELS = ("IMR", "RR", "SI", "SS")
CELLS, SMALL_CELLS = 995_000, 4_000
REPEATS = 3
#: "About ten times": between half of it and twice it.
TEN_TIMES = (5, 20)
BINS = ("< 20", "20 - 40", "40 - 80", "80 - 100", "> 100")
TABLE_2_6 = {"wrench": (55, 515, 501, 605), "hinge": (55, 526, 516, 633)}
TABLE_2_7 = {
    "wrench": {
        "initial": (0.768, 15.64, 67.13, 12.03, 4.43),
        "imr": (0.008, 1.60, 94.67, 3.47, 0.25),
        "rr": (0.006, 0.96, 96.47, 2.49, 0.07),
        "si": (0.005, 0.70, 96.07, 3.08, 0.09),
        "ss": (0.027, 2.08, 92.14, 5.70, 0.25),
    },
    "hinge": {
        "initial": (0.950, 54.27, 28.39, 11.85, 4.54),
        "imr": (0.021, 2.05, 93.78, 3.76, 0.39),
        "rr": (0.019, 1.44, 94.69, 2.82, 0.19),
        "si": (0.016, 1.17, 94.37, 3.38, 0.23),
        "ss": (0.084, 2.44, 90.40, 5.81, 0.43),
    },
}
#: Vertices and triangles of the meshes of Table 2.7, from Table 2.4.
TABLE_2_4 = {"wrench": (499_340, 995_496), "hinge": (498_978, 987_162)}
SMALL, LARGE = math.radians(20), math.radians(100)
#: Triangles are nearly equilateral if this part of the angles is between 40 and 80 degrees, in percent.
NEARLY = 90
#: Shares of the possible reduction at which smoothing stops; the last one is the converged mesh, 0 no smoothing.
SHARES = (0.0, 0.5, 0.75, 0.9, 0.95, 0.99, 1.0)
#: Combinations whose solver time is added: AMG and ILU(0) with CG.
SWEPT = (13, ILU[0])

#: By share of the reduction: sweeps, and the time of smoothing and of each combination of SWEPT together.
Swept = dict[float, tuple[int, dict[int, Times]]]


@remembered
def poor_at_boundary(mesh: vtkDataSet) -> tuple[int, int]:
    """Number of triangles with an angle below 20 or above 100 degrees, and how many of them have a boundary vertex."""
    cells = cells_of(mesh)
    p = points_of(mesh)[cells]
    poor = np.zeros(len(p), bool)
    for k in range(3):
        a, b = p[:, (k + 1) % 3] - p[:, k], p[:, (k + 2) % 3] - p[:, k]
        cosine = np.einsum("ij,ij->i", a, b) / np.sqrt(np.einsum("ij,ij->i", a, a) * np.einsum("ij,ij->i", b, b))
        poor |= (cosine > math.cos(SMALL)) | (cosine < math.cos(LARGE))
    edges = np.sort(np.concatenate([cells[:, [0, 1]], cells[:, [1, 2]], cells[:, [2, 0]]]), axis=1)
    edge, count = np.unique(edges, axis=0, return_counts=True)
    boundary = np.zeros(mesh.GetNumberOfPoints(), bool)
    boundary[edge[count == 1]] = True
    return int(poor.sum()), int((poor & boundary[cells].any(axis=1)).sum())


def main(arguments: list[str]) -> int:
    made = parser("smoothing_times", __doc__, CELLS, repeats=REPEATS, seeds=True)
    _own_mesh.add_mesh_options(made)
    given = made.parse_args(arguments)
    report = Report("smoothing_times", "Smoothing times and angles (section 2.4, Tables 2.6 and 2.7)", given)
    report.text(
        f"Each metric is smoothed to {100 * REDUCTION:g} % of the possible reduction of its objective, whose best "
        "value comes from a converged run (L-BFGS after Local Newton sweeps, relative change 1e-5). Sum of squares "
        "of IMR and RR, sum of squared reciprocals of SI and SS; boundary fixed. Local conjugate gradients are "
        "Polak-Ribiere's, one step per vertex and sweep (the dissertation: Fletcher-Reeves, the same with one step). "
        f"Times are CPU seconds of {given.threads or 'all'} thread(s), set-up included, the fastest of "
        f"{given.repeats} run(s)."
    )
    if _own_mesh.chosen(given):
        own(report, given)
        return report.finish()
    report.text(
        "Half of the interior vertices are perturbed by up to 0.5 of the distance to inversion. The dissertation's "
        "times are of an Intel Nehalem at 2.66 GHz, 500,000 vertices.\n"
        "For a triangle, SI = 1 / (4 sqrt(3) IMR): these two objectives differ by a factor only, and so their results "
        "are the same; that the dissertation's differ must come from the point where the smoothing stopped."
    )
    for seed in report.seeds:
        study(report, given, seed)
    return report.finish()


def mesh_of(domain: str, given: argparse.Namespace, seed: int) -> vtkDataSet:
    """The perturbed mesh of a domain, with the printed number of triangles in full size."""
    cells = given.cells or (SMALL_CELLS if given.small else PRINTED_CELLS[domain][FULL])
    return tautline.perturb(tautline.domain(domain, cells), seed=seed).mesh


def study(report: Report, given: argparse.Namespace, seed: int) -> None:
    """The tables and findings of one seed."""
    seconds, newton, shares, boundary, sizes, swept = {}, {}, {}, {}, {}, {}
    for domain in DOMAINS:
        mesh = mesh_of(domain, given, seed)
        best = {metric: best_objective(mesh, metric, given.threads) for metric in METRICS}
        shares[domain] = {"initial": angles(mesh)}
        sizes[domain] = [mesh.GetNumberOfPoints(), mesh.GetNumberOfCells(), *shares[domain]["initial"]]
        steps = []
        for metric in METRICS:
            run, other = (smoothing(mesh, metric, given.threads, given.repeats, o, best=best[metric])
                          for o in ("nlcg", "newton"))
            seconds[domain, metric], newton[domain, metric] = run.times(), other.times()
            shares[domain][metric] = angles(run.mesh)
            boundary[domain, metric] = poor_at_boundary(run.mesh)
            steps.append([metric, *(int(r.iterations[-1]) for r in (run, other)), best[metric]])
        report.table(f"iterations_{domain}", f"Sweeps to {100 * REDUCTION:g} %, {domain}",
                     ["metric", "NLCG", "Newton", "best objective"], steps)
        swept[domain] = sweep(report, domain, mesh, best, given)
    printed = {d: (*TABLE_2_4[d], *TABLE_2_7[d]["initial"]) for d in DOMAINS}
    report.beside("meshes", "Initial meshes: vertices, triangles, percent of the angles",
                  ("vertices", "triangles", *BINS), sizes, printed, head="domain")
    for file, found, what in (("table_2_6", seconds, "local NLCG"), ("table_2_6_newton", newton, "Local Newton")):
        report.beside(file, f"Table 2.6, smoothing time (CPU s), {what}", LABELS,
                      {d: [found[d, m].best for m in METRICS] for d in DOMAINS}, TABLE_2_6, head="domain")
    for domain in DOMAINS:
        title = f"Table 2.7, angles in percent, {domain}"
        report.beside(f"table_2_7_{domain}", title, BINS, shares[domain], TABLE_2_7[domain], head="metric")
    rows = [[d, m, *boundary[d, m]] for d in DOMAINS for m in METRICS]
    title = "Triangles with an angle below 20 or above 100 degrees"
    report.table("boundary", title, ["domain", "metric", "all", "at the boundary"], rows)
    report.bars("angles", BINS, "degrees", "percent of the angles", shares)
    findings(report, seconds, shares, boundary)
    for domain, found in swept.items():
        sweep_findings(report, domain, found)


def own(report: Report, given: argparse.Namespace) -> None:
    """A mesh or metrics of the user: times, sweeps and qualities, without the dissertation's numbers."""
    size = given.cells // 2 if given.cells else FULL
    for name, mesh in _own_mesh.meshes(given, SMALL_CELLS // 2 if given.small else size).items():
        metrics = _own_mesh.metrics_of(mesh, given)
        rows, series = [], {}
        for metric in metrics:
            best = best_objective(mesh, metric, given.threads)
            run, other = (smoothing(mesh, metric, given.threads, given.repeats, o, best=best)
                          for o in ("nlcg", "newton"))
            rows.append([metric, *(v for r in (run, other) for v in (r.times().best, int(r.iterations[-1]))),
                         run.first("objective"), run.last("objective")])
            series[metric] = run.mesh
        report.table(f"smoothing_{name}", f"{name}, {mesh.GetNumberOfCells():,} cells: smoothing to "
                     f"{100 * REDUCTION:g} % of the possible reduction",
                     ["metric", "NLCG, CPU s", "NLCG, sweeps", "Newton, CPU s", "Newton, sweeps", "objective before",
                      "objective after"], rows)
        quality = {label: tautline.quality(made, metrics).statistics
                   for label, made in {"before": mesh, **series}.items()}
        report.table(f"quality_{name}", f"{name}: mean and worst value of each metric, before and after smoothing by "
                     "local NLCG", ["smoothed by", *(f"{m}, {what}" for m in metrics for what in ("mean", "worst"))],
                     [[label, *(found[m][what] for m in metrics for what in ("mean", "worst"))]
                      for label, found in quality.items()])


def angles(mesh: vtkDataSet) -> list[float]:
    return [float(share) for share in tautline.quality(mesh).angles["percent"]]


def sweep(report: Report, domain: str, mesh: vtkDataSet, best: dict[str, float],
          given: argparse.Namespace) -> dict[str, Swept]:
    """The total time by the share of the possible reduction at which smoothing stops (section 2.4)."""
    setup = Setup(SWEPT, 0.0, given.repeats, given.threads)
    found: dict[str, Swept] = {}
    for metric in METRICS:
        found[metric] = {}
        for share in SHARES:
            run = None
            if share:
                run = smoothing(mesh, metric, given.threads, given.repeats, share=share, best=best[metric])
            times = run.times() if run else Times((0.0,))
            solves = solve(run.mesh if run else mesh, PDES["poisson"], setup)
            found[metric][share] = (int(run.iterations[-1]) if run else 0,
                                    {n: times + s.times for n, s in solves.items() if s.converged})
    report.table(f"shares_{domain}", f"Total time (CPU s) by the share of the reduction, Poisson's equation, {domain}",
                 ["metric", "share", "sweeps", *(COMBINATION[n] for n in SWEPT)],
                 [[m, f"{s:g}", count, *(times[n].best if n in times else math.nan for n in SWEPT)]
                  for m, row in found.items() for s, (count, times) in row.items()])
    return found


def sweep_findings(report: Report, domain: str, found: dict[str, Swept]) -> None:
    """Where the total time is the smallest; shares that end after the same sweep are one mesh."""
    for n in SWEPT:
        verdicts, none, shown = [], [], []
        for metric, row in found.items():
            sweeps = row[REDUCTION][0]
            times = {s: t[n] for s, (count, t) in row.items() if n in t and (s == REDUCTION or count != sweeps)}
            failed = REDUCTION not in times or len(times) < 2
            bare = times.get(0.0)
            verdicts.append(Open(f"{COMBINATION[n]} failed") if failed else quickest(times, REDUCTION))
            none.append(Open(f"{COMBINATION[n]} failed") if failed or bare is None else faster(times[REDUCTION], bare))
            least = min(times, key=lambda s: times[s].best, default=math.nan)
            shown.append(f"{metric}: least at {least:.0%}" if times else f"{metric}: failed")
        report.finding(f"2.4, {domain}", f"The total time with {COMBINATION[n]} is minimal at 95 % of the possible "
                       "reduction", all_of(verdicts), "; ".join(shown),
                       criterion="with each metric, less total time than without smoothing and than with the other "
                       "shares that take another number of sweeps, by more than the noise", stated="95 %")
        report.finding(f"2.4, {domain}", f"Smoothing to 95 % takes less total time with {COMBINATION[n]} than no "
                       "smoothing", all_of(none), "; ".join(
                           f"{m}: {row[REDUCTION][1][n]} and {row[0.0][1][n]}" for m, row in found.items()
                           if n in row[REDUCTION][1] and n in row[0.0][1]) or "failed",
                       criterion="with each metric, by more than the noise", own=True)


def leaves_most(shares: dict[str, Sequence[float]], order: int) -> Verdict:
    """Whether SS leaves the largest part of the angles in a range; not decided where no metric leaves any."""
    left = {m: shares[m][order] for m in METRICS}
    if not any(left.values()):
        return Open("there are no such angles")
    return left["ss"] > max(v for m, v in left.items() if m != "ss")


def findings(report: Report, seconds: dict[tuple[str, str], Times], shares: dict, boundary: dict) -> None:
    finding = report.finding
    times = "; ".join(f"{d}: " + ", ".join(f"{m} {seconds[d, m]}" for m in METRICS) for d in DOMAINS)
    of = [{m: seconds[d, m] for m in METRICS} for d in DOMAINS]
    noise = "on both domains, by more than the noise of the times"
    finding("Table 2.6", "IMR is the fastest to smooth", all_of(quickest(found, "imr") for found in of), times,
            criterion=noise)
    finding("Table 2.6", "SS is the slowest", all_of(slowest(found, "ss") for found in of), times, criterion=noise)
    ratios = [found[m].best / found["imr"].best for found in of for m in METRICS[1:]]
    least, most = TEN_TIMES
    finding("Table 2.6", "The others take about ten times as long as IMR",
        all_of(v for found in of for m in METRICS[1:]
               for v in (below(found["imr"], found[m], 1 / least), below(found[m], found["imr"], most))),
        f"{min(ratios):.2f} to {max(ratios):.2f} times", stated="9.1 to 11.5 times",
        criterion=f"between {least} and {most} times")
    middle = {(d, m): shares[d][m][2] for d in DOMAINS for m in METRICS}
    finding("Table 2.7", "All four metrics make nearly equilateral triangles", min(middle.values()) > NEARLY,
        ", ".join(f"{d} {m} {v:.1f} %" for (d, m), v in middle.items()), stated="90.4 to 96.5 %",
        criterion=f"more than {NEARLY} % of the angles are from 40 to 80 degrees")
    small = {(d, m): shares[d][m][0] + shares[d][m][4] for d in DOMAINS for m in METRICS}
    for order, word in ((0, "small angles (below 20 degrees)"), (4, "large angles (above 100 degrees)")):
        finding("Table 2.7", f"SS leaves the most {word}",
            all_of(leaves_most(shares[d], order) for d in DOMAINS),
            ", ".join(f"{d} {m} {shares[d][m][order]:.4f} %" for d in DOMAINS for m in METRICS),
            criterion="a larger part of the angles than with each other metric, on both domains")
    finding("Table 2.7", "RR leaves the fewest poorly shaped elements, fewer even than IMR",
        all(boundary[d, "rr"][0] < min(boundary[d, m][0] for m in METRICS if m != "rr") for d in DOMAINS),
        "with an angle below 20 or above 100 degrees: "
        + ", ".join(f"{d} {m} {boundary[d, m][0]} ({small[d, m]:.4f} % of the angles)" for d, m in boundary),
        criterion="fewer triangles with an angle below 20 or above 100 degrees than each other metric, on both domains")
    at = {key: part / whole if whole else math.nan for key, (whole, part) in boundary.items()}
    finding("2.7.3.2", "Poorly shaped elements occur most often at the boundary",
        all_of(Open("there are no poorly shaped elements") if math.isnan(v) else v > 0.5 for v in at.values()),
        ", ".join(f"{d} {m} {100 * v:.0f} %" for (d, m), v in at.items()),
        criterion="with each metric, more than half of the triangles with an angle below 20 or above 100 degrees have "
        "a vertex at the boundary")
