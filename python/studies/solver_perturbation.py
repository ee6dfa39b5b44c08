# SPDX-License-Identifier: BSD-3-Clause
"""Solvers and preconditioners against vertex perturbation: Tables 2.9 and 2.12, Figures 2.4, 2.7 and 2.10."""

from __future__ import annotations

from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._report import Report
from ._solver_tables import BY_PERTURBATION
from ._solvers import AMG, DOMAINS, ILU, JACOBI, LABELS, PDES, POSITIVE, SOLVERS, SSOR, TITLES, Solve
from ._solvers import bars, initial_mesh, options, setup_of, size_of, smoothed, solve, table
from ._verdicts import Open, Verdict, all_of, any_of, unless

FRACTIONS = (0.0, 0.05, 0.10, 0.25, 0.50)  # of the interior vertices, which are moved
DISTANCE = 0.5  # the largest displacement over the distance at which an element is inverted, section 2.7.2
TABLES = {"poisson": "Table 2.9", "elliptic": "Figure 2.7", "elasticity": "Table 2.12"}
CG_AND_MINRES = (0, 2)  # columns of Table 2.5
GROUPS = {"Jacobi": JACOBI, "SSOR": SSOR, "ILU(0)": ILU, "AMG": AMG}
GROUPED = tuple(n for group in GROUPS.values() for n in group)
#: The most robust combinations, and the least robust ones of elasticity.
ROBUST = {"elliptic": (SSOR[0], SSOR[2]), "elasticity": (AMG[1],)}
SENSITIVE = (SSOR[1], SSOR[3], ILU[1])
NOISE = ("by more than the ranges of PI that the faster half of the runs allows, or, where these overlap, by PI of the "
         "iterations (with AMG, whose set-up does not change, up to it)")

#: Solves by fraction and number of the combination.
Rows = dict[float, dict[int, Solve]]
#: PI, the smallest and the largest one that the times allow, and the smallest and the largest one by the iterations.
Increase = tuple[float, ...]
Grown = dict[int, Increase]


def moved(mesh: vtkDataSet, fraction: float, seed: int = 1) -> vtkDataSet:
    """The mesh with this fraction of its interior vertices moved as in section 2.7.2."""
    if not fraction:
        return mesh
    return tautline.perturb(mesh, fraction=DISTANCE, percentage=100 * fraction, seed=seed).mesh


def increases(rows: Rows) -> Grown:
    """PI of section 2.7.2, (T_max - T_min) / T_min, of the combinations that converged on every mesh."""
    found = {}
    for n in next(iter(rows.values())):
        solves = [row[n] for row in rows.values()]
        if not all(s.converged for s in solves):
            continue
        seconds = [s.seconds for s in solves]
        longest = max((s.times for s in solves), key=lambda t: t.best)
        shortest = min((s.times for s in solves), key=lambda t: t.best)
        low, high = longest.over(shortest)
        # The matrices have one sparsity pattern, so that iterations of one method take the same time.
        counts = [s.iterations for s in solves]
        work = max(counts) / max(min(counts), 1) - 1
        found[n] = (max(seconds) / min(seconds) - 1, max(low - 1, 0.0), high - 1, 0.0 if n in AMG else work, work)
    return found


def larger(one: Increase, other: Increase) -> Verdict:
    """Whether a PI is larger than another one, by the times or, where their ranges overlap, by the iterations."""
    for low, high in ((1, 2), (3, 4)):
        if one[low] > other[high] or one[high] < other[low]:
            return one[low] > other[high]
    return Open(f"the ranges of PI, {one[1]:.2f} to {one[2]:.2f} and {other[1]:.2f} to {other[2]:.2f}, overlap, and by "
                f"the iterations, {one[3]:.2f} to {one[4]:.2f} and {other[3]:.2f} to {other[4]:.2f}")


def means(grown: Grown) -> dict[str, Increase]:
    """The mean PI and its range by preconditioner, of those that converged with every solver on every mesh."""
    return {name: tuple(sum(v) / len(group) for v in zip(*(grown[n] for n in group)))
            for name, group in GROUPS.items() if all(n in grown for n in group)}


def compared(found: dict, larger_one: object, smaller_one: object) -> Verdict:
    """Whether the PI of one is larger; not decided where one failed."""
    for key in (larger_one, smaller_one):
        if key not in found:
            return Open(f"{LABELS.get(key, key)} failed on a mesh")
    return larger(found[larger_one], found[smaller_one])


def main(arguments: list[str]) -> int:
    given = options("solver_perturbation", __doc__).parse_args(arguments)
    report = Report("solver_perturbation", "Solvers and vertex perturbation (section 2.7.3, Experiment 2)", given)
    report.text(
        "Meshes smoothed by IMR to 95 % of the possible reduction; then 0, 5, 10, 25 and 50 % of the interior vertices "
        "are moved in a random direction by up to half of the distance at which an element would invert. PI = (T_max "
        f"- T_min) / T_min over these meshes, of CPU seconds with set-up, the fastest of {given.repeats} run(s); in "
        "the table its range by these. '*' is a failure, '>' the time limit."
    )
    for seed in report.seeds:
        for pde in given.pde or PDES:
            found = {}
            for domain in given.domain or DOMAINS:
                smooth = smoothed(initial_mesh(domain, size_of(given, pde=pde), seed), "imr", given.threads)
                row = {fraction: moved(smooth, fraction, seed) for fraction in FRACTIONS}
                rows = {fraction: solve(mesh, PDES[pde], setup_of(given)) for fraction, mesh in row.items()}
                found[domain] = rows, increases(rows)
                shown(report, pde, domain, *found[domain], row[0.0].GetNumberOfPoints())
                findings(report, pde, domain, *found[domain])
                ranking_findings(report, pde, domain, found[domain][1])
            if len(found) == len(DOMAINS):
                domain_findings(report, pde, found)
    return report.finish()


def shown(report: Report, pde: str, domain: str, rows: Rows, grown: Grown, points: int) -> None:
    """The tables and the chart of a problem on a domain."""
    title = f"{TABLES[pde]}, {TITLES[pde]}, {domain}, {points:,} vertices"
    table(report, f"{pde}_{domain}", title, rows, BY_PERTURBATION.get((pde, domain), {}), "perturbed")
    report.table(f"pi_{pde}_{domain}", f"PI of the solver time, {TITLES[pde]}, {domain}",
                 ["combination", "PI", "least", "largest", "least by iterations", "largest by iterations"],
                 [[f"{n} {LABELS[n]}", *grown[n]] for n in sorted(grown)])
    count = failures(rows)
    report.table(f"failures_{pde}_{domain}", f"Failures on the {len(rows)} meshes, {TITLES[pde]}, {domain}",
                 ["preconditioner", *SOLVERS], [[name, *(count.get(n, 0) for n in group)]
                                                for name, group in GROUPS.items()])
    bars(report, f"pi_{pde}_{domain}", f"{TITLES[pde]}, {domain}", {"PI": {n: g[0] for n, g in grown.items()}},
         "percentage increase / 100")


def failures(rows: Rows) -> dict[int, int]:
    """The number of meshes on which a combination failed."""
    return {n: sum(row[n].failed for row in rows.values()) for n in rows[0.0]}


def unfinished(rows: Rows) -> str:
    """The combinations that did not finish within the time limit; "": all did."""
    return next((f"{LABELS[n]} did not finish" for row in rows.values() for n, s in row.items() if s.unfinished), "")


def findings(report: Report, pde: str, domain: str, rows: Rows, grown: Grown) -> None:
    where = f"{TABLES[pde]}, {domain}"
    count = failures(rows)
    weak, strong = (sum(k for n, k in count.items() if ((n - 1) % len(SOLVERS) in CG_AND_MINRES) == inside)
                    for inside in (True, False))
    figures = f"failures: CG and MINRES {weak}, GMRES and Bi-CGSTAB {strong}"
    why = unfinished(rows)
    reason = "" if weak or strong else POSITIVE
    if pde == "poisson":
        report.finding(where, "CG and MINRES fail in many cases, GMRES and Bi-CGSTAB do not",
                       unless(why, strong < weak), figures, reason=reason,
                       criterion="more failures of the former than of the latter on the five meshes")
    if pde == "elliptic":
        most = max(grown, key=lambda n: grown[n][0], default=None)
        figures = "none converged on all" if most is None else f"largest PI: {LABELS[most]} {grown[most][0]:.2f}"
        report.finding(where, "The Jacobi preconditioner is the most sensitive to perturbation",
                       any_of(all_of(compared(grown, n, m) for m in rows[0.0] if m not in JACOBI)
                              for n in JACOBI if n in rows[0.0]), figures,
                       criterion=f"the PI of a combination with Jacobi is larger than the PI of all others, {NOISE}")
    if pde == "elasticity":
        mean = means(grown)
        report.finding(where, "AMG is less affected by perturbation than the other preconditioners",
                       all_of(compared(mean, name, "AMG") for name in GROUPS if name != "AMG"),
                       "mean PI: " + ", ".join(f"{k} {v[0]:.2f}" for k, v in mean.items()),
                       criterion=f"its mean PI over the solvers is smaller, {NOISE}")
    else:
        counts = {n: [rows[f][n].iterations for f in FRACTIONS] for n in AMG if n in grown}
        report.finding(where, "The iterations of AMG do not change with perturbation",
                       all_of(max(counts[n]) - min(counts[n]) <= 1 if n in counts else
                              Open(f"{LABELS[n]} failed on a mesh") for n in AMG if n in rows[0.0]),
                       "; ".join(f"{LABELS[n]} {c}" for n, c in counts.items()) or "failed",
                       criterion="they differ by at most 1 among the five meshes", own=True)


def ranking_findings(report: Report, pde: str, domain: str, grown: Grown) -> None:
    """The rankings of robustness of section 2.7.3, by PI; a combination that failed on some mesh has none."""
    where = f"2.7.3, {domain}, {pde}"
    if pde == "poisson":
        mean = means(grown)
        order = (("ILU(0)", "SSOR"), ("ILU(0)", "AMG"), ("SSOR", "Jacobi"), ("AMG", "Jacobi"))
        report.finding(where, "The preconditioners rank ILU(0), SSOR and AMG, Jacobi by robustness",
                       all_of(compared(mean, b, a) for a, b in order),
                       "mean PI: " + (", ".join(f"{k} {v[0]:.2f}" for k, v in mean.items()) or "failures with all"),
                       criterion=f"the mean PI over the solvers increases in this order, {NOISE}; SSOR and AMG are not "
                       "compared", stated="ILU(0) > SSOR ~ AMG > Jacobi")
        return
    smallest = min(grown, key=lambda n: grown[n][0], default=None)
    largest = sorted(grown, key=lambda n: -grown[n][0])[:len(SENSITIVE)]
    robust = ROBUST[pde]
    report.finding(where, "The most robust against perturbation: " + " and ".join(LABELS[n] for n in robust),
                   all_of(compared(grown, n, one) for one in robust for n in GROUPED if n not in robust),
                   ", ".join(f"{LABELS[n]} {grown[n][0]:.2f}" for n in robust if n in grown)
                   + ("" if smallest is None else f"; smallest PI: {LABELS[smallest]} {grown[smallest][0]:.2f}"),
                   criterion=f"their PI is smaller than the PI of all other combinations, {NOISE}")
    if pde == "elasticity":
        report.finding(where, "The most sensitive to perturbation: " + ", ".join(LABELS[n] for n in SENSITIVE),
                       all_of(compared(grown, one, n) for one in SENSITIVE for n in GROUPED if n not in SENSITIVE),
                       "largest PI: " + ", ".join(f"{LABELS[n]} {grown[n][0]:.2f}" for n in largest),
                       criterion=f"their PI is larger than the PI of all other combinations, {NOISE}")


def domain_findings(report: Report, pde: str, found: dict[str, tuple[Rows, Grown]]) -> None:
    """The hinge beside the wrench."""
    wrench, hinge = (found[domain] for domain in DOMAINS)
    count = [sum(failures(rows).values()) for rows, _ in (wrench, hinge)]
    if pde == "poisson":
        report.finding("2.7.3.2", "More combinations solve the problem on the wrench than on the hinge",
                       unless(unfinished(wrench[0]) or unfinished(hinge[0]), count[0] < count[1]),
                       f"failures on five meshes: wrench {count[0]}, hinge {count[1]}",
                       criterion="fewer failures on the wrench",
                       reason="" if any(count) else POSITIVE)
        both = [n for n in wrench[1] if n in hinge[1]]
        mean = [tuple(sum(v) / len(both) for v in zip(*(grown[n] for n in both))) for _, grown in (wrench, hinge)]
        report.finding("Figure 2.4", "PI is significantly greater on the hinge than on the wrench",
                       larger(mean[1], mean[0]) if both else Open("no combination converged on all meshes"),
                       f"mean PI of {len(both)} combinations"
                       + (f": wrench {mean[0][0]:.2f}, hinge {mean[1][0]:.2f}" if both else ""),
                       criterion=f"the mean over the combinations that converge on all meshes is larger, {NOISE}")
