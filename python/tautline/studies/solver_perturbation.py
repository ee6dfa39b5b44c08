"""Solvers and preconditioners against vertex perturbation: Tables 2.9 and 2.12, Figures 2.4, 2.7 and 2.10."""

from __future__ import annotations

import tautline

from ._common import Report
from ._solver_tables import BY_PERTURBATION
from ._solvers import AMG, DOMAINS, ILU, JACOBI, LABELS, PDES, SSOR, TITLES
from ._solvers import bars, initial_mesh, options, size_of, smoothed, solve, table

FRACTIONS = (0.0, 0.05, 0.10, 0.25, 0.50)
TABLES = {"poisson": "Table 2.9", "elliptic": "Figure 2.7", "elasticity": "Table 2.12"}
CG_AND_MINRES = (0, 2)  # columns of Table 2.5
GROUPS = {"Jacobi": JACOBI, "SSOR": SSOR, "ILU(0)": ILU, "AMG": AMG}


def increases(rows: dict) -> dict[int, float]:
    """PI of section 2.7.2, (T_max - T_min) / T_min, of the combinations that converged on every mesh."""
    times = {n: [row[n].seconds for row in rows.values() if row[n].converged] for n in next(iter(rows.values()))}
    return {n: max(t) / min(t) - 1 for n, t in times.items() if len(t) == len(rows)}


def main(arguments: list[str]) -> int:
    given = options("solver_perturbation", __doc__).parse_args(arguments)
    size = size_of(given)
    report = Report("solver_perturbation", "Solvers and vertex perturbation (section 2.7.3, Experiment 2)", given.out)
    report.text(
        "Meshes smoothed by IMR to 95 % of the possible reduction; then 0, 5, 10, 25 and 50 % of the interior vertices "
        "are moved in a random direction by up to half of the distance at which an element would invert. PI = (T_max "
        "- T_min) / T_min over these meshes, of wall seconds with set-up. '*' is a failure, '>' the time limit."
    )
    for pde in given.pde or PDES:
        for domain in given.domain or DOMAINS:
            mesh = smoothed(initial_mesh(domain, size), "imr", given.threads)
            rows = {}
            for fraction in FRACTIONS:
                moved = tautline.perturb(mesh, fraction=fraction).mesh if fraction else mesh
                rows[fraction] = solve(moved, pde, given)
            title = f"{TABLES[pde]}, {TITLES[pde]}, {domain}, {mesh.GetNumberOfPoints():,} vertices"
            table(report, f"{pde}_{domain}", title, rows, BY_PERTURBATION.get((pde, domain), {}), "perturbed")
            grown = increases(rows)
            report.table(f"pi_{pde}_{domain}", f"PI of the solver time, {TITLES[pde]}, {domain}", ["combination", "PI"],
                         [[f"{n} {LABELS[n]}", grown[n]] for n in sorted(grown)])
            bars(report, f"pi_{pde}_{domain}", f"{TITLES[pde]}, {domain}", {"PI": grown}, "percentage increase / 100")
            findings(report, pde, domain, rows, grown)
    return report.finish()


def findings(report: Report, pde: str, domain: str, rows: dict, grown: dict[int, float]) -> None:
    where = f"{TABLES[pde]}, {domain}"
    failed = sorted({n for row in rows.values() for n, s in row.items() if not s.converged and not s.unfinished})
    column = {n: (n - 1) % 4 for n in rows[0.0]}
    if pde == "poisson":
        report.finding(where, "CG and MINRES fail on perturbed meshes where GMRES and Bi-CGSTAB do not",
                       bool(failed) and all(column[n] in CG_AND_MINRES for n in failed),
                       "failed: " + (", ".join(LABELS[n] for n in failed) or "none"))
    if pde == "elliptic" and grown:
        most = max(grown, key=grown.get)
        report.finding(where, "The Jacobi preconditioner is the most sensitive to perturbation", most in JACOBI,
                       f"largest PI: {LABELS[most]} {grown[most]:.2f}")
    if pde == "elasticity" and grown:
        # A combination that failed on some mesh has no PI.
        solved = {name: [grown[n] for n in group if n in grown] for name, group in GROUPS.items()}
        mean = {name: sum(values) / len(values) for name, values in solved.items() if values}
        report.finding(where, "AMG is less affected by perturbation than the other preconditioners",
                       min(mean, key=mean.get) == "AMG",
                       "mean PI of those that converged: " + ", ".join(f"{k} {v:.2f}" for k, v in mean.items()))
    counts = {n: [rows[f][n].iterations for f in FRACTIONS] for n in AMG if n in rows[0.0] and n in grown}
    if pde != "elasticity" and counts:
        report.finding(where, "The iterations of AMG do not change with perturbation (by at most 1)",
                       all(max(c) - min(c) <= 1 for c in counts.values()),
                       "; ".join(f"{LABELS[n]} {c}" for n, c in counts.items()))
