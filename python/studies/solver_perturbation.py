# SPDX-License-Identifier: BSD-3-Clause
"""Solvers and preconditioners against vertex perturbation: Tables 2.9 and 2.12, Figures 2.4, 2.7 and 2.10."""

from __future__ import annotations

from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._report import Report
from ._solver_tables import BY_PERTURBATION
from ._solvers import AMG, DOMAINS, ILU, JACOBI, LABELS, PDES, SSOR, TITLES
from ._solvers import bars, initial_mesh, options, size_of, smoothed, solve, table
from ._verdicts import Verdict, all_of, any_of

FRACTIONS = (0.0, 0.05, 0.10, 0.25, 0.50)  # of the interior vertices, which are moved
DISTANCE = 0.5  # the largest displacement over the distance at which an element is inverted, section 2.7.2
TABLES = {"poisson": "Table 2.9", "elliptic": "Figure 2.7", "elasticity": "Table 2.12"}
CG_AND_MINRES = (0, 2)  # columns of Table 2.5
GROUPS = {"Jacobi": JACOBI, "SSOR": SSOR, "ILU(0)": ILU, "AMG": AMG}


def moved(mesh: vtkDataSet, fraction: float) -> vtkDataSet:
    """The mesh with this fraction of its interior vertices moved as in section 2.7.2."""
    return tautline.perturb(mesh, fraction=DISTANCE, percentage=100 * fraction).mesh if fraction else mesh


def increases(rows: dict) -> dict[int, tuple[float, float, float]]:
    """PI of section 2.7.2, (T_max - T_min) / T_min, of the combinations that converged on every mesh.

    The value, and the least and the largest one that the times of all runs allow.
    """
    found = {}
    for n in next(iter(rows.values())):
        solves = [row[n] for row in rows.values()]
        if not all(s.converged for s in solves):
            continue
        seconds = [s.seconds for s in solves]
        longest = max((s.times for s in solves), key=lambda t: t.best)
        shortest = min((s.times for s in solves), key=lambda t: t.best)
        low, high = longest.over(shortest)
        found[n] = max(seconds) / min(seconds) - 1, max(low - 1, 0.0), high - 1
    return found


def larger(one: tuple[float, float, float], other: tuple[float, float, float]) -> Verdict:
    """Whether a PI is larger than another one; not decided where their ranges overlap."""
    return True if one[1] > other[2] else False if one[2] < other[1] else None


def means(grown: dict[int, tuple[float, float, float]]) -> dict[str, tuple[float, ...]]:
    """The mean PI and its range by preconditioner, of the combinations that converged on every mesh."""
    solved = {name: [grown[n] for n in group if n in grown] for name, group in GROUPS.items()}
    return {name: tuple(sum(v) / len(values) for v in zip(*values)) for name, values in solved.items() if values}


def main(arguments: list[str]) -> int:
    given = options("solver_perturbation", __doc__).parse_args(arguments)
    size = size_of(given)
    report = Report("solver_perturbation", "Solvers and vertex perturbation (section 2.7.3, Experiment 2)",
                    given.out, given.small)
    report.text(
        "Meshes smoothed by IMR to 95 % of the possible reduction; then 0, 5, 10, 25 and 50 % of the interior vertices "
        "are moved in a random direction by up to half of the distance at which an element would invert. PI = (T_max "
        f"- T_min) / T_min over these meshes, of CPU seconds with set-up, the fastest of {given.repeats} run(s); in "
        "the table its range by all runs. '*' is a failure, '>' the time limit."
    )
    for pde in given.pde or PDES:
        for domain in given.domain or DOMAINS:
            mesh = smoothed(initial_mesh(domain, size), "imr", given.threads)
            rows = {}
            for fraction in FRACTIONS:
                rows[fraction] = solve(moved(mesh, fraction), pde, given)
            title = f"{TABLES[pde]}, {TITLES[pde]}, {domain}, {mesh.GetNumberOfPoints():,} vertices"
            table(report, f"{pde}_{domain}", title, rows, BY_PERTURBATION.get((pde, domain), {}), "perturbed")
            grown = increases(rows)
            report.table(f"pi_{pde}_{domain}", f"PI of the solver time, {TITLES[pde]}, {domain}",
                         ["combination", "PI", "least", "largest"],
                         [[f"{n} {LABELS[n]}", *grown[n]] for n in sorted(grown)])
            bars(report, f"pi_{pde}_{domain}", f"{TITLES[pde]}, {domain}", {"PI": {n: g[0] for n, g in grown.items()}},
                 "percentage increase / 100")
            findings(report, pde, domain, rows, grown)
            ranking_findings(report, pde, domain, grown)
    return report.finish()


def findings(report: Report, pde: str, domain: str, rows: dict, grown: dict[int, tuple[float, float, float]]) -> None:
    where = f"{TABLES[pde]}, {domain}"
    failed = sorted({n for row in rows.values() for n, s in row.items() if not s.converged and not s.unfinished})
    column = {n: (n - 1) % 4 for n in rows[0.0]}
    if pde == "poisson":
        report.finding(where, "CG and MINRES fail on perturbed meshes where GMRES and Bi-CGSTAB do not",
                       bool(failed) and all(column[n] in CG_AND_MINRES for n in failed),
                       "failed: " + (", ".join(LABELS[n] for n in failed) or "none"))
    if pde == "elliptic" and grown:
        most = max(grown, key=lambda n: grown[n][0])
        jacobi, others = ([g for n, g in grown.items() if (n in JACOBI) == inside] for inside in (True, False))
        report.finding(where, "The Jacobi preconditioner is the most sensitive to perturbation",
                       any_of(all_of(larger(g, other) for other in others) for g in jacobi),
                       f"largest PI: {LABELS[most]} {grown[most][0]:.2f}")
    if pde == "elasticity" and grown:
        mean = means(grown)
        report.finding(where, "AMG is less affected by perturbation than the other preconditioners",
                       all_of(larger(other, mean["AMG"]) for name, other in mean.items() if name != "AMG")
                       if "AMG" in mean else False,
                       "mean PI of those that converged: " + ", ".join(f"{k} {v[0]:.2f}" for k, v in mean.items()))
    counts = {n: [rows[f][n].iterations for f in FRACTIONS] for n in AMG if n in rows[0.0] and n in grown}
    if pde != "elasticity" and counts:
        report.finding(where, "The iterations of AMG do not change with perturbation (by at most 1)",
                       all(max(c) - min(c) <= 1 for c in counts.values()),
                       "; ".join(f"{LABELS[n]} {c}" for n, c in counts.items()))


def ranking_findings(report: Report, pde: str, domain: str, grown: dict[int, tuple[float, float, float]]) -> None:
    """The rankings of robustness of section 2.7.3, by PI; a combination that failed on some mesh has none."""
    where = f"2.7.3, {domain}, {pde}"
    if pde == "poisson":
        mean = means(grown)
        order = (("ILU(0)", "SSOR"), ("ILU(0)", "AMG"), ("SSOR", "Jacobi"), ("AMG", "Jacobi"))
        known = all(a in mean and b in mean for a, b in order)
        report.finding(where, "Robustness ranks ILU(0) > SSOR, AMG > Jacobi",
                       all_of(larger(mean[b], mean[a]) for a, b in order) if known else None,
                       "mean PI: " + (", ".join(f"{k} {v[0]:.2f}" for k, v in mean.items()) or "none converged on all"))
        return
    robust = (SSOR[0], SSOR[2]) if pde == "elliptic" else (AMG[1],)
    least = [grown[n] for n in robust if n in grown]
    others = {n: g for n, g in grown.items() if n not in robust}
    if len(least) < len(robust) or not others:
        return
    names = " and ".join(LABELS[n] for n in robust)
    best = min(grown, key=lambda n: grown[n][0])
    report.finding(where, f"The most robust against perturbation: {names}",
                   all_of(larger(g, one) for g in others.values() for one in least),
                   ", ".join(f"{LABELS[n]} {grown[n][0]:.2f}" for n in robust)
                   + f"; smallest PI: {LABELS[best]} {grown[best][0]:.2f}")
