# SPDX-License-Identifier: BSD-3-Clause
"""Solvers and metrics on tetrahedra, hexahedra, mixed meshes, and anisotropic coefficients: open in section 2.8."""

from __future__ import annotations

import argparse
import itertools
from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._memory import remembered
from ._meshes import right_triangles
from ._report import Report, parser
from ._solver_claims import Rows, better, extreme
from ._solver_tables import COMBINATIONS, METRICS
from ._solvers import AMG, ILU, LABELS, PDES, REDUCTION, REPEATS, SWEEPS, TITLES, bars, group_is_faster, most_of
from ._solvers import Setup, smoothing, solve, table, times_of, trouble, vertices
from ._totals import JACOBI_GMRES
from ._verdicts import Open, Verdict, all_of, any_of, is_not, slowest, word

SIZE, SMALL_SIZE = 15_000, 600
#: The first one is what the dissertation's results are compared on.
PLANAR = "triangles"
SOLIDS = ("tetrahedra", "hexahedra", "mixed")
#: Metrics with derivatives on all cells, and the dissertation's for triangles and tetrahedra.
SOLID_METRICS = ("imr", "condition_number", "mu_shape")
LEAST_CELLS = 3  # along x
#: The coefficient of -u_xx; the others are 1.
ANISOTROPY = 100.0
ANISOTROPIC = {"pde": "elliptic", "source": 1.0, "reaction": 0.0, "alpha": ANISOTROPY}
MATCHED = "imr, matching target"
#: The tetrahedra of a cube: paths from one corner to the opposite one along the axes.
PATHS = [np.cumsum(np.vstack([np.zeros(3, int), np.eye(3, dtype=int)[list(axes)]]), axis=0)
         for axes in itertools.permutations(range(3))]

#: Whether results of chapter 2 hold, by a short name.
Results = dict[str, Verdict]


def main(arguments: list[str]) -> int:
    made = parser("solver_meshes", __doc__, repeats=REPEATS, seeds=True)
    made.add_argument("--size", type=vertices, default=0, metavar="N", help=f"points of each mesh (default: {SIZE:,})")
    made.add_argument("--combinations", type=int, nargs="+", default=list(COMBINATIONS), metavar="N",
                      help="numbers of Table 2.5 (default: all)")
    made.add_argument("--time-limit", type=float, default=0.0, metavar="SECONDS", help="of a combination")
    given = made.parse_args(arguments)
    report = Report("solver_meshes", "Meshes of volumes and anisotropic coefficients (sections 2.7.1 and 2.8)", given)
    report.text(
        "The dissertation states that its results do not carry over to meshes in space and to anisotropic "
        "coefficients. Meshes of a square and of a cube with about as many points: right triangles, tetrahedra, "
        "hexahedra, and hexahedra in one half and wedges in the other. Half of the interior points are perturbed, then "
        "the mesh is smoothed by each metric to 95 % of the possible reduction; RR, SI and SS are defined on triangles "
        f"and tetrahedra. Anisotropic: -{ANISOTROPY:g} u_xx - u_yy - u_zz = 1; there also a mesh with as many points "
        f"whose elements are {ANISOTROPY**0.5:g} times longer along x, smoothed by IMR with the matching target, an "
        "element that is equilateral in the metric of the inverse coefficients. A result that holds on triangles "
        f"and not on another mesh does not carry over. CPU seconds of {given.repeats} run(s)."
    )
    for seed in report.seeds:
        study(report, given, seed)
    return report.finish()


def study(report: Report, given: argparse.Namespace, seed: int) -> None:
    """The tables and findings of one seed."""
    setup = Setup(tuple(given.combinations), given.time_limit, given.repeats, given.threads)
    found: dict[str, dict[str, Rows]] = {}
    sizes = []
    for name in (PLANAR, *SOLIDS):
        points = given.size or (SMALL_SIZE if given.small else SIZE)
        mesh = initial(name, points, seed)
        sizes.append([name, mesh.GetNumberOfPoints(), mesh.GetNumberOfCells()])
        metrics = METRICS if name in (PLANAR, SOLIDS[0]) else SOLID_METRICS
        meshes = {m: smoothing(mesh, m, given.threads).mesh for m in metrics}
        found[name] = {pde: {m: solve(made, problem, setup) for m, made in meshes.items()}
                       for pde, problem in PDES.items()}
        for pde, rows in found[name].items():
            shown(report, f"{name}_{pde}", f"{name}, {TITLES[pde]}", rows)
        if name in (PLANAR, SOLIDS[1]):
            meshes[MATCHED] = matched(initial(name, points, seed, ANISOTROPY**0.5), given.threads)
            rows = {m: solve(made, ANISOTROPIC, setup) for m, made in meshes.items()}
            shown(report, f"{name}_anisotropic", f"{name}, anisotropic coefficients", rows)
            shape_findings(report, name, rows)
            isotropic = {m: solve(meshes[m], {**ANISOTROPIC, "alpha": 1.0}, setup) for m in metrics}
            anisotropic_findings(report, name, isotropic, {m: rows[m] for m in metrics})
    report.table("meshes", "Meshes", ["mesh", "points", "cells"], sizes)
    every = {name: all_results(row) for name, row in found.items()}
    report.aligned("Results of chapter 2 by mesh", ["result", *every],
                   [[claim, *(word(row[claim]) if claim in row else "-" for row in every.values())]
                    for claim in every[PLANAR]], "results")
    findings(report, found)


def shown(report: Report, file: str, title: str, rows: Rows) -> None:
    table(report, file, title, rows, {}, "metric")
    bars(report, file, title, {m: {n: s.seconds for n, s in row.items() if s.converged} for m, row in rows.items()},
         "seconds", logarithmic=True)


# --- meshes -------------------------------------------------------------------------------------------------------


def initial(name: str, points: int, seed: int, stretch: float = 1.0) -> vtkDataSet:
    """A perturbed mesh of a square or cube with about this number of points.

    stretch: the length of an element along x over its others.
    """
    dimension = 2 if name == PLANAR else 3
    other = points ** (1 / dimension) * stretch ** (1 / dimension)
    counts = [max(round(other / stretch) - 1, LEAST_CELLS), *[round(other) - 1] * (dimension - 1)]
    if name == PLANAR:
        coordinates, cells = right_triangles(*(np.linspace(0, 1, n + 1) for n in counts))
        blocks = {"triangle": cells}
    else:
        coordinates, blocks = cube(name, counts)
    return tautline.perturb(tautline.from_arrays(coordinates, blocks), fraction=0.5, seed=seed).mesh


def cube(name: str, counts: list[int]) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """The points of a grid with these numbers of cells, which are hexahedra, tetrahedra, or hexahedra and wedges."""
    grid = np.stack(np.meshgrid(*(np.arange(n + 1) for n in counts), indexing="ij"), axis=-1).reshape(-1, 3)
    steps = np.array([(counts[1] + 1) * (counts[2] + 1), counts[2] + 1, 1])
    first = (grid[(grid < counts).all(axis=1)] @ steps)[:, None]
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    corners = np.vstack([square, square + [0, 0, 1]]) @ steps
    hexahedra = first + corners
    points = grid / counts
    if name == "hexahedra":
        return points, {"hexahedron": hexahedra}
    if name == "tetrahedra":
        # Every second path is reversed in orientation.
        cells = [path @ steps if np.linalg.det(path[1:] - path[0]) > 0 else (path @ steps)[[0, 2, 1, 3]]
                 for path in PATHS]
        return points, {"tetrahedron": np.vstack([first + cell for cell in cells])}
    halves = points[hexahedra].mean(axis=1)[:, 0] < 0.5
    wedges = [hexahedra[~halves][:, part] for part in ((0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7))]
    return points, {"hexahedron": hexahedra[halves], "wedge": np.vstack(wedges)}


@remembered
def matched(mesh: vtkDataSet, threads: int) -> vtkDataSet:
    """The mesh smoothed by IMR to 95 % of the possible reduction, with the target that matches the coefficients."""
    tensor = np.tile([1 / ANISOTROPY, 1.0, 1.0, 0.0, 0.0, 0.0], (mesh.GetNumberOfCells(), 1))
    common: dict[str, Any] = dict(objectives=[("imr", {"template": "sum of squares", "target": "tensor"})],
                                  tensor=tensor, hold_worst=False, untangle_first=False, culling=0.0, threads=threads)
    best = tautline.optimize(mesh, maximum_iterations=2 * SWEEPS, **common).history["objective"].min()
    return tautline.optimize(mesh, optimizer="local conjugate gradient", maximum_iterations=SWEEPS, relative_change=0.0,
                             reduction=REDUCTION, best_known=float(best), **common).mesh


# --- findings -----------------------------------------------------------------------------------------------------


def results(pde: str, rows: Rows) -> Results:
    """Whether the results of chapter 2 hold for a problem on the meshes smoothed by several metrics."""
    found: Results = {}
    if pde == "elasticity":
        found["ILU(0) with CG or MINRES is the fastest for elasticity"] = all_of(
            group_is_faster(row, (ILU[0], ILU[2])) for row in rows.values())
    else:
        found[f"AMG with any solver is faster than everything else ({pde})"] = all_of(
            group_is_faster(row, AMG, every=True) for row in rows.values())
    found[f"Jacobi with GMRES is the slowest ({pde})"] = all_of(
        Open(why) if (why := trouble(row, [JACOBI_GMRES])) else slowest(times_of(row), JACOBI_GMRES)
        for row in rows.values())
    if set(METRICS) <= set(rows):
        four = {m: rows[m] for m in METRICS}
        found[f"RR is the most efficient metric ({pde})"] = most_of(extreme(four, "rr", better).values())
        found[f"SS is the least efficient metric ({pde})"] = most_of(
            extreme(four, "ss", lambda one, other: better(other, one)).values())
    return found


def differs(control: Results, other: Results) -> Verdict:
    """Whether a result that holds in the control does not hold elsewhere."""
    common = [name for name in control if name in other]
    return any_of(_lost(control[name], other[name]) for name in common)


def _lost(control: Verdict, other: Verdict) -> Verdict:
    return all_of([control, is_not(other)])


def lost(control: Results, here: Results) -> str:
    """The results that hold in the control, with their verdicts here."""
    kept = [f"{claim}: {word(here[claim])}" for claim, v in control.items() if claim in here and v is True]
    return "of the results that hold in comparison: " + ("; ".join(kept) or "none holds")


RULE = ("a result that holds on triangles with as many points (time differences beyond the noise; metrics in more than "
        "half of the combinations) does not hold there")


def all_results(found: dict[str, Rows]) -> Results:
    """The results of all problems on a mesh."""
    return {claim: verdict for pde, rows in found.items() for claim, verdict in results(pde, rows).items()}


def findings(report: Report, found: dict[str, dict[str, Rows]]) -> None:
    """Whether the results for triangles carry over to meshes in space."""
    control = all_results(found[PLANAR])
    for name in SOLIDS:
        here = all_results(found[name])
        report.finding(f"2.7.1, 2.8, {name}", "The results cannot be generalized to meshes in space",
                       differs(control, here), lost(control, here), criterion=RULE)


def anisotropic_findings(report: Report, name: str, isotropic: Rows, anisotropic: Rows) -> None:
    """Whether the results carry over to anisotropic coefficients."""
    control, here = (results("anisotropic", rows) for rows in (isotropic, anisotropic))
    report.finding(f"2.7.1, 2.8, {name}", "The results cannot be generalized to anisotropic coefficients",
                   differs(control, here), lost(control, here),
                   criterion="a result that holds with isotropic coefficients on the same meshes does not hold with "
                   "anisotropic ones")


def shape_findings(report: Report, name: str, rows: Rows) -> None:
    """Whether other element shapes are better for anisotropic coefficients."""
    pairs = {n: (rows[MATCHED][n], rows["imr"][n]) for n in rows["imr"] if n not in AMG}
    report.finding(f"2.7.1, 2.8, {name}", "The ideal element shapes for anisotropic coefficients are other ones",
                   most_of(one.iterations < other.iterations if one.converged and other.converged
                           else Open(f"{LABELS[n]} failed") for n, (one, other) in pairs.items()),
                   "iterations with the matching target and with equilateral elements: " + ", ".join(
                       f"{LABELS[n]} {one.iterations}, {other.iterations}" for n, (one, other) in pairs.items()),
                   criterion="in more than half of the combinations but those with AMG fewer iterations on a mesh with "
                   "as many points whose elements are equilateral in the metric of the inverse of the coefficients",
                   stated="different from the optimal shapes for isotropic coefficients")
