# SPDX-License-Identifier: BSD-3-Clause
"""State-based beside bond-based elasticity: condition numbers by h, delta and Poisson's ratio; a plate with a hole."""

from __future__ import annotations

import math
from typing import Any, NamedTuple, Sequence

import numpy as np
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkDataSet, vtkPolyData

import tautline

from . import _horizon
from ._meshes import cells_of, points_of
from ._horizon import Report, exponent, increasing
from ._memory import remembered
from ._verdicts import all_of, less

#: Poisson's ratios in plane strain; the bond-based model has BONDS.
BONDS = 0.25
RATIOS = (-0.5, 0.0, BONDS, 0.4, 0.45, 0.49)
#: The square: 1/h, the horizon, the exponent of the kernel; the first of each is the one the others vary around.
_SIZE, _DELTA, _P, _TOLERANCE = 20, 0.2, 1.0, 1e-4
_SIZES, _DELTAS = (10, 20, 40), (0.4, 0.2, 0.1)
#: Elements in the horizon while it is varied; the mesh follows.
_ELEMENTS = 3
#: The plate: half its width, radius of the hole, edges of the circle, horizons, Poisson's ratio of the material.
_HALF, _RADIUS, _EDGES, _HORIZONS, _MATERIAL = 2.0, 1.0, 40, (0.3, 0.2, 0.1), 0.4
#: The free plate: half its width, the hole, the horizon, the longest edges, tolerance.
_SLOT, _FREE_DELTA, _FREE_EDGES, _FREE_TOLERANCE = 0.15, 0.4, (0.15, 0.1), 1e-3
#: Equal condition numbers agree to this; a number counts as independent of h if it changes by no more than FLAT.
SAME, FLAT = 1e-4, 0.25
#: Order of the condition number in delta, and of the error of the plate, and what is accepted of them.
ORDER, ORDER_TOLERANCE = -2.0, 0.4
#: Poisson's ratios up to this one are moderate.
_MODERATE = 0.4
#: By how much iterations may vary with Poisson's ratio and count as bounded.
BOUNDED = 0.5
NEW = ("local amg", "two-level")


class Found(NamedTuple):
    """Condition number, nonzero entries of a row, and iterations with each preconditioner."""

    condition: float
    entries: float
    iterations: dict[str, int]


@remembered
def solved(
    n: int, delta: float, ratio: float | None, threads: int, preconditioners: Sequence[str] = ("jacobi",)
) -> Found:
    """The square with 1/h = n; bond-based where `ratio` is None."""
    made = _horizon.square(n, 1, 2 * delta)
    assert made is not None, "squares fit"
    mesh, region, given = made
    model: dict[str, Any] = {"model": "elastic"} if ratio is None else {"model": "state-based", "poisson_ratio": ratio}
    results = {
        name: tautline.peridynamics(mesh, delta, _P, region=region, given_points=given, tolerance=_TOLERANCE,
                                    solve=True, preconditioner=name, spectrum=name == "jacobi", threads=threads,
                                    **model)
        for name in preconditioners
    }  # fmt: skip
    first = results["jacobi"]
    return Found(first.condition, first.nonzeros / first.rows, {name: r.iterations for name, r in results.items()})


def outline(half: float, hole: np.ndarray) -> vtkPolyData:
    """A square and the polygon of a hole, as closed lines."""
    corners = half * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    points, lines = vtkPoints(), vtkCellArray()
    points.SetDataTypeToDouble()
    for loop in (corners, hole):
        ids = [points.InsertNextPoint(x, y, 0.0) for x, y in loop]
        lines.InsertNextCell(len(ids) + 1)
        for i in [*ids, ids[0]]:
            lines.InsertCellPoint(i)
    result = vtkPolyData()
    result.SetPoints(points)
    result.SetLines(lines)
    return result


@remembered
def plate(delta: float, elements: float) -> vtkDataSet:
    """Unstructured triangles around a round hole, with an interaction layer of 2 delta outside and in the hole."""
    angle = 2 * np.pi * np.arange(_EDGES) / _EDGES
    hole = _RADIUS * np.column_stack([np.cos(angle), np.sin(angle)])
    mesh = tautline.triangle_mesh(outline(_HALF, hole), size=1.5 * delta / elements, minimum_angle=25).mesh
    return tautline.interaction_layer(mesh, 2 * delta)


def kirsch(points: np.ndarray, ratio: float) -> np.ndarray:
    """The displacement of a plate with a round hole that is pulled along x (plane strain, S = 8 mu), for r above 0.

    Source: G. Kirsch, Z. Ver. Dtsch. Ing. 42 (1898) 797-807.
    """
    r = np.maximum(np.hypot(points[:, 0], points[:, 1]), 1e-300)
    t = np.arctan2(points[:, 1], points[:, 0])
    kappa, a = 3 - 4 * ratio, _RADIUS
    x = r / a * (kappa + 1) * np.cos(t) + 2 * a / r * ((1 + kappa) * np.cos(t) + np.cos(3 * t)) \
        - 2 * (a / r) ** 3 * np.cos(3 * t)  # fmt: skip
    y = r / a * (kappa - 3) * np.sin(t) + 2 * a / r * ((1 - kappa) * np.sin(t) + np.sin(3 * t)) \
        - 2 * (a / r) ** 3 * np.sin(3 * t)  # fmt: skip
    return a * np.column_stack([x, y, np.zeros_like(x)])


@remembered
def plate_error(mesh: vtkDataSet, delta: float, model: str, threads: int) -> float:
    """Root mean square error of the displacement at the unknown points, over its root mean square."""
    points = points_of(mesh)
    exact = kirsch(points, _MATERIAL)
    result = tautline.peridynamics(mesh, delta, _P, model=model, poisson_ratio=_MATERIAL, tolerance=1e-3, source=0.0,
                                   given=exact, solve=True, spectrum=False, preconditioner="local amg", threads=threads)
    unknown = np.asarray(result.mesh.GetPointData().GetArray("Unknown")) > 0
    return float(np.sqrt(np.sum((result.solution - exact)[unknown] ** 2) / np.sum(exact[unknown] ** 2)))


@remembered
def free_hole(size: float, cut: bool, threads: int) -> tuple[float, int]:
    """The smallest eigenvalue with a slot narrower than the horizon and no layer in it, and the nonzero entries."""
    hole = np.array([[-0.5, -_SLOT / 2], [0.5, -_SLOT / 2], [0.5, _SLOT / 2], [-0.5, _SLOT / 2]])
    mesh = tautline.triangle_mesh(outline(1.0, hole), size=size, minimum_angle=25).mesh
    # Given on a frame as wide as the reach of forces; the slot stays free.
    centers = points_of(mesh)[cells_of(mesh)].mean(axis=1)
    region = np.where(np.abs(centers[:, :2]).max(axis=1) > 1 - _FREE_DELTA / 2, 2, 1)
    result = tautline.peridynamics(mesh, _FREE_DELTA, _P, model="state-based", poisson_ratio=_MATERIAL, region=region,
                                   allow_thin_layer=True, cut_bonds=cut, tolerance=_FREE_TOLERANCE, threads=threads)
    return result.smallest, result.nonzeros


def main(arguments: Sequence[str]) -> int:
    given = _horizon.parse("state_based", __doc__ or "", arguments)
    report = Report("state_based", "State-based peridynamics, domains with holes (section 4.6)", given)
    report.text(
        "Subject: other peridynamic models, on unstructured domains. The linear ordinary state-based model "
        "(Silling et al. 2007, in plane strain) is the bond-based one and the square of the dilatation times "
        "lambda - mu: it has any Poisson's ratio, where the bond-based one has 1/4. Forces reach twice the horizon, "
        f"and so does the interaction layer. Linear basis, kernel 1/r^{_P:g} times the tensor of (4.4)."
    )
    size = 10 if given.small else _SIZE
    ratios = {nu: solved(size, _DELTA, nu, given.threads, ("jacobi", *NEW)) for nu in RATIOS}
    bonds = solved(size, _DELTA, None, given.threads, ("jacobi", *NEW))
    names = ("jacobi", *NEW)
    report.table("ratios", f"1/h = {size}, delta = {_DELTA}: condition number, entries of a row, iterations",
                 ["model", "condition", "entries", *names],
                 [["bond-based", bonds.condition, bonds.entries, *(bonds.iterations[n] for n in names)]]
                 + [[f"nu = {nu:g}", f.condition, f.entries, *(f.iterations[n] for n in names)]
                    for nu, f in ratios.items()])  # fmt: skip
    ratio_findings(report, ratios, bonds)
    sizes = _SIZES[:2] if given.small else _SIZES
    models = {"bond-based": None, "nu = 0": 0.0, "nu = 0.45": 0.45}
    by_size = {name: {n: solved(n, _DELTA, nu, given.threads).condition for n in sizes} for name, nu in models.items()}
    report.table("sizes", f"Condition number by 1/h, delta = {_DELTA}", ["model", *(str(n) for n in sizes)],
                 [[name, *row.values()] for name, row in by_size.items()])
    deltas = _DELTAS[:2] if given.small else _DELTAS
    by_delta = {name: {d: solved(round(_ELEMENTS / d), d, nu, given.threads).condition for d in deltas}
                for name, nu in models.items()}
    report.table("deltas", f"Condition number by delta, h = delta / {_ELEMENTS} (rounded)",
                 ["model", *(str(d) for d in deltas)], [[name, *row.values()] for name, row in by_delta.items()])
    scale_findings(report, by_size, by_delta)
    horizons = _HORIZONS[:2] if given.small else _HORIZONS
    errors: dict[str, dict[float, float]] = {"elastic": {}, "state-based": {}}
    for delta in horizons:
        mesh = plate(delta, 2 if given.small else _ELEMENTS)
        for model, row in errors.items():
            row[delta] = plate_error(mesh, delta, model, given.threads)
    report.table("plate", f"Plate with a round hole, nu = {_MATERIAL}: error of the displacement (Kirsch) by delta",
                 ["model", *(str(d) for d in horizons)], [[name, *row.values()] for name, row in errors.items()])
    plate_findings(report, errors)
    edges = _FREE_EDGES[:1] if given.small else _FREE_EDGES
    free = {edge: (*free_hole(edge, True, given.threads), *free_hole(edge, False, given.threads)) for edge in edges}
    report.table("slot", f"A free slot of width {_SLOT}, delta = {_FREE_DELTA}: smallest eigenvalue and entries",
                 ["longest edge", "cut", "cut entries", "not cut", "not cut entries"],
                 [[edge, *row] for edge, row in free.items()])  # fmt: skip
    slot_findings(report, free)
    report.chart("state_based", [
        {"title": f"1/h = {size}, delta = {_DELTA}", "x": "Poisson's ratio", "yscale": "log",
         "lines": {"state-based": (list(ratios), [f.condition for f in ratios.values()]),
                   "bond-based": ([BONDS], [bonds.condition], "C1s")}},
        {"title": f"Plate with a hole, nu = {_MATERIAL}", "x": "delta", "y": "error", "xscale": "log", "yscale": "log",
         "lines": {name: (list(row), list(row.values())) for name, row in errors.items()}},
    ])  # fmt: skip
    return report.finish()


def ratio_findings(report: Report, ratios: dict[float, Found], bonds: Found) -> None:
    """Condition numbers and iterations by Poisson's ratio, and of the bond-based model."""
    conditions = {nu: f.condition for nu, f in ratios.items()}
    listed = ", ".join(f"{v:.4g} with nu = {nu:g}" for nu, v in conditions.items())
    report.finding("4.6", f"With nu = {BONDS} the condition number equals the bond-based model's",
                   abs(conditions[BONDS] / bonds.condition - 1) <= SAME,
                   f"{conditions[BONDS]:.7g} and {bonds.condition:.7g}", own=True, criterion=f"within {SAME:g}",
                   proof="the factor lambda - mu of the square of the dilatation is 0: both matrices are the same")
    above = [v for nu, v in conditions.items() if nu >= BONDS]
    report.finding("4.6", f"The condition number grows with Poisson's ratio above {BONDS}", increasing(above), listed,
                   own=True, criterion="it is larger with each larger ratio")
    most = max(v for nu, v in conditions.items() if nu <= _MODERATE)
    report.finding("4.6", f"Up to nu = {_MODERATE} it is at most twice the bond-based model's",
                   less(most, 2 * bonds.condition, _TOLERANCE), f"{listed}; bond-based {bonds.condition:.4g}", own=True)
    entries = min(f.entries for nu, f in ratios.items() if nu != BONDS) / bonds.entries
    report.finding("4.6", "A row has more than twice the entries of the bond-based model's", entries > 2,
                   f"{entries:.3g} times", own=True)
    for name in NEW:
        counts = {nu: f.iterations[name] for nu, f in ratios.items()}
        report.finding("4.6", f"{name}: iterations are bounded in Poisson's ratio",
                       max(counts.values()) <= (1 + BOUNDED) * max(min(counts.values()), 1),
                       ", ".join(f"{v} with nu = {nu:g}" for nu, v in counts.items()), own=True,
                       criterion=f"they vary by at most {BOUNDED:.0%}")


def scale_findings(
    report: Report, by_size: dict[str, dict[int, float]], by_delta: dict[str, dict[float, float]]
) -> None:
    """Condition numbers by 1/h and by delta of each model."""
    for name, row in by_size.items():
        change = max(row.values()) / max(min(row.values()), math.ulp(0.0)) - 1
        report.finding("4.6", f"{name}: the condition number hardly depends on h", change <= FLAT,
                       ", ".join(f"{v:.4g} with 1/h = {n}" for n, v in row.items()), own=True,
                       criterion=f"it varies by at most {FLAT:.0%}")
    for name, deltas in by_delta.items():
        order = exponent(list(deltas), list(deltas.values()))
        report.finding("4.6", f"{name}: the condition number grows like delta^{ORDER:g}",
                       abs(order - ORDER) <= ORDER_TOLERANCE, f"delta^{order:.2f}", own=True,
                       criterion=f"exponent within {ORDER_TOLERANCE:g}")


def plate_findings(report: Report, errors: dict[str, dict[float, float]]) -> None:
    """Errors of the plate by model and delta."""
    listed = {name: ", ".join(f"{v:.3g} with delta = {d:g}" for d, v in row.items()) for name, row in errors.items()}
    state, bonds = list(errors["state-based"].values()), list(errors["elastic"].values())
    report.finding("4.6", "State-based: the solution tends to the solution of Hooke's law as delta tends to 0",
                   exponent(list(errors["state-based"]), state) > 1, listed["state-based"], own=True,
                   criterion="order above 1 in delta")
    report.finding("4.6", "Bond-based: it does not, as its Poisson's ratio is another one",
                   exponent(list(errors["elastic"]), bonds) < 0.5, listed["elastic"], own=True,
                   criterion="order below 1/2 in delta")
    report.finding("4.6", "The error of the state-based solution is below a fifth of the bond-based one's",
                   state[-1] < bonds[-1] / 5, f"{state[-1]:.3g} and {bonds[-1]:.3g}", own=True)


def slot_findings(report: Report, free: dict[float, tuple[float, int, float, int]]) -> None:
    """Smallest eigenvalues and entries with a free slot, with bonds across it cut and not, by edge length."""
    listed = "; ".join(f"{c:.4g} ({n}) and {u:.4g} ({m}) with edges of {edge:g}" for edge, (c, n, u, m) in free.items())
    report.finding("4.6", "Where bonds are cut at a free slot, the body is softer and the matrix sparser",
                   all_of(v for c, n, u, m in free.values() for v in (less(c, u, _FREE_TOLERANCE), n < m)), listed,
                   own=True, criterion="the smallest eigenvalue and the number of entries are smaller")
