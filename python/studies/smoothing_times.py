# SPDX-License-Identifier: BSD-3-Clause
"""Times and angles of smoothing by IMR, RR, SI and SS: section 2.4, Tables 2.6 and 2.7."""

from __future__ import annotations

import math

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._common import Method, Run, improve
from ._meshes import cells_of, points_of
from ._report import Report, parser
from ._solver_tables import METRICS
from ._verdicts import Times, all_of, below, quickest, slowest

LABELS = ("IMR", "RR", "SI", "SS")
DOMAINS = ("wrench", "hinge")
CELLS, SMALL_CELLS = 995_000, 4_000
REDUCTION = 0.95
ITERATIONS = 200
REPEATS = 3
FACTORS = (5, 20)  # about ten times
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
SMALL, LARGE = math.radians(20), math.radians(100)


def method(metric: str) -> Method:
    """Sum of squares of IMR and RR (2.5), of squared reciprocals of SI and SS (2.6)."""
    return Method(metric, LABELS[METRICS.index(metric)], (metric,))


def poor_at_boundary(mesh: vtkDataSet) -> tuple[int, int]:
    """Number of triangles with an angle below 20 or above 100 degrees, and of those of them with a boundary vertex."""
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


def smooth(mesh: vtkDataSet, metric: str, optimizer: str, best: float, given) -> Run:
    return improve(mesh, method(metric), ITERATIONS, ["imr_mean"], optimizer=optimizer, template=template(metric),
                   reduction=REDUCTION, best_known=best, trace=False, repeats=given.repeats, threads=given.threads)


def template(metric: str) -> str:
    return "sum of squared reciprocals" if metric in ("si", "ss") else "sum of squares"


def main(arguments: list[str]) -> int:
    given = parser("smoothing_times", __doc__, CELLS, repeats=REPEATS).parse_args(arguments)
    cells = given.cells or (SMALL_CELLS if given.small else CELLS)
    report = Report("smoothing_times", "Smoothing times and angles (section 2.4, Tables 2.6 and 2.7)",
                    given.out, given.small)
    report.text(
        f"Each metric is smoothed to {100 * REDUCTION:g} % of the possible reduction of its objective, whose best "
        "value is that of a converged run (L-BFGS after Local Newton sweeps, relative change 1e-5). Sum of squares "
        "of IMR and RR, sum of squared reciprocals of SI and SS; boundary fixed; half of the interior vertices "
        "perturbed by up to 0.5 of the distance to inversion. Local conjugate gradients are Polak-Ribiere's, one "
        "step per vertex and sweep (the dissertation: Fletcher-Reeves, the same with one step). Times are "
        f"CPU seconds of {given.threads or 'all'} thread(s), set-up included, the fastest of {given.repeats} run(s); "
        "the dissertation's are of an Intel Nehalem at 2.66 GHz, 500,000 vertices.\n"
        "Of a triangle, SI = 1 / (4 sqrt(3) IMR): these two objectives differ by a factor only, and so their results "
        "are the same; that the dissertation's differ must come from the point where the smoothing stopped."
    )
    seconds, newton, shares, boundary = {}, {}, {}, {}
    for domain in DOMAINS:
        mesh = tautline.perturb(tautline.domain(domain, cells)).mesh
        rows = {"initial": angles(mesh)}
        report.text(f"{domain}: {mesh.GetNumberOfCells():,} triangles, {mesh.GetNumberOfPoints():,} vertices.")
        steps = []
        for metric in METRICS:
            converged = improve(mesh, method(metric), 2 * ITERATIONS, ["imr_mean"], optimizer="automatic", trace=False,
                                template=template(metric), relative_change=1e-5, threads=given.threads)
            best = float(converged.values["objective"].min())
            run = smooth(mesh, metric, "nlcg", best, given)
            other = smooth(mesh, metric, "newton", best, given)
            seconds[domain, metric], newton[domain, metric] = run.times(), other.times()
            rows[metric] = angles(run.mesh)
            boundary[domain, metric] = poor_at_boundary(run.mesh)
            steps.append([metric, *(len(r.seconds) - 1 for r in (run, other)), best])
        shares[domain] = rows
        headings = ["metric", "NLCG", "Newton", "best objective"]
        report.table(f"iterations_{domain}", f"Sweeps to {100 * REDUCTION:g} %, {domain}", headings, steps)
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
    return report.finish()


def angles(mesh: vtkDataSet) -> list[float]:
    return [float(share) for share in tautline.quality(mesh).angles["percent"]]


def findings(report: Report, seconds: dict[tuple[str, str], Times], shares: dict, boundary: dict) -> None:
    finding = report.finding
    times = "; ".join(f"{d}: " + ", ".join(f"{m} {seconds[d, m]}" for m in METRICS) for d in DOMAINS)
    of = [{m: seconds[d, m] for m in METRICS} for d in DOMAINS]
    finding("Table 2.6", "IMR is the fastest to smooth", all_of(quickest(found, "imr") for found in of), times)
    finding("Table 2.6", "SS is the slowest", all_of(slowest(found, "ss") for found in of), times)
    ratios = [found[m].best / found["imr"].best for found in of for m in METRICS[1:]]
    least, most = FACTORS
    finding("Table 2.6", f"The others take about ten times as long as IMR (within {least} to {most})",
        all_of(v for found in of for m in METRICS[1:]
               for v in (below(found["imr"], found[m], 1 / least), below(found[m], found["imr"], most))),
        f"{min(ratios):.2f} to {max(ratios):.2f} times, the dissertation's 9.1 to 11.5")
    middle = {(d, m): shares[d][m][2] for d in DOMAINS for m in METRICS}
    finding("Table 2.7", "All four metrics make nearly equilateral triangles (90 % of the angles in 40 to 80 degrees)",
        min(middle.values()) > 90, ", ".join(f"{d} {m} {v:.1f} %" for (d, m), v in middle.items()))
    small = {(d, m): shares[d][m][0] + shares[d][m][4] for d in DOMAINS for m in METRICS}
    figures = "below 20 or above 100 degrees: " + ", ".join(f"{d} {m} {v:.4f} %" for (d, m), v in small.items())
    for order, word in ((0, "small angles (below 20 degrees)"), (4, "large angles (above 100)")):
        finding("Table 2.7", f"SS leaves the most {word}",
            all(shares[d]["ss"][order] > max(shares[d][m][order] for m in METRICS[:3]) for d in DOMAINS),
            ", ".join(f"{d} {m} {shares[d][m][order]:.4f} %" for d in DOMAINS for m in METRICS))
    finding("Table 2.7", "RR leaves the fewest poorly shaped elements, fewer even than IMR",
        all(small[d, "rr"] < min(small[d, m] for m in METRICS if m != "rr") for d in DOMAINS), figures)
    at = {key: (part / whole if whole else 1.0) for key, (whole, part) in boundary.items()}
    finding("2.7.3", "Poorly shaped elements occur most often at the boundary", min(at.values()) > 0.5,
        ", ".join(f"{d} {m} {100 * v:.0f} %" for (d, m), v in at.items()))
