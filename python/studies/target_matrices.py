# SPDX-License-Identifier: BSD-3-Clause
"""Target matrices of the initial mesh in the linear system of FEMWARP: the open question of section 4.11."""

from __future__ import annotations

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._deformed import EXAMPLES, Deformed, Moving, deform, parse, similarity
from ._meshes import cells_of, points_of, sizes_of, with_points
from ._report import Report
from ._verdicts import timed

AMOUNTS = (1.0, 1.5)
JUDGED = 1.0  # the dissertation's largest motion
SMALL_CELLS = (400, 1500)  # triangles, tetrahedra
#: The domain and the amount of each case.
CASES = tuple((example.domain, amount) for amount in AMOUNTS for example in EXAMPLES)
EQUAL = 1e-8  # of the size of a domain: displacements that are equal up to rounding
#: Names of the minimized sums, and their titles. T is the Jacobian of the deformed element by the initial one's
#: inverse.
SYSTEMS = {
    "femwarp": "FEMWARP: area |T - I|^2",
    "equal": "|T - I|^2",
    "jacobians": "|A_deformed - A_initial|^2",
    "shape": "(4.22) = |T - adj(T)^t|^2",
    "anisotropic": "anisotropic FEMWARP",
    "anisotropic equal": "anisotropic, each element alike",
}
PLANAR = ("shape",)  # (4.22) is quadratic in T in the plane only


def jacobians(mesh: vtkDataSet) -> np.ndarray:
    """The Jacobians of the simplices with respect to a regular simplex."""
    points, cells = points_of(mesh), cells_of(mesh)
    dimension = cells.shape[1] - 1
    edges = (points[cells[:, 1:]] - points[cells[:, :1]])[:, :, :dimension].transpose(0, 2, 1)
    # The edges of the regular simplex with length 1 are the columns of the Cholesky factor of their products.
    regular = np.linalg.cholesky(0.5 * (np.eye(dimension) + 1)).T
    return edges @ np.linalg.inv(regular)


def tensors(mesh: vtkDataSet, name: str, coefficients: tuple[float, float, float]) -> np.ndarray:
    """The coefficients of FEMWARP per element, n x 6, that minimize a sum of SYSTEMS.

    FEMWARP minimizes the sum of V |T - I|^2, since T - I is the gradient of the displacements.
    """
    sizes = np.abs(sizes_of(mesh))
    weight = sizes.mean() / sizes
    full = np.zeros((len(sizes), 3, 3))
    if name == "jacobians":
        a = jacobians(mesh)
        dimension = a.shape[1]
        full[:, :dimension, :dimension] = weight[:, None, None] * a @ a.transpose(0, 2, 1)
        full /= np.mean(np.trace(full, axis1=1, axis2=2)) / dimension
    else:
        full[:] = weight[:, None, None] * np.diag(coefficients)
    return np.stack([full[:, i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))], axis=1)


def by_shape(mesh: vtkDataSet, displacement: np.ndarray, weights: np.ndarray) -> vtkDataSet:
    """The planar mesh whose boundary has moved and that minimizes the weighted sum of (4.22)."""
    points, cells = points_of(mesh)[:, :2], cells_of(mesh)
    fixed = np.array(vtk_to_numpy(mesh.GetPointData().GetArray("Fixed"))) != 0
    edges = (points[cells[:, 1:]] - points[cells[:, :1]]).transpose(0, 2, 1)
    inverse = np.linalg.inv(edges)
    # Gradients of the three basis functions: T = sum of x_k (gradient of k)^t.
    gradients = np.concatenate([-inverse.sum(axis=1, keepdims=True), inverse], axis=1)
    # (4.22) is 2 (T11 - T22)^2 + 2 (T12 + T21)^2: two rows per element, in the unknowns x and y of its corners.
    rows = np.zeros((len(cells), 2, 3, 2))
    rows[:, 0, :, 0], rows[:, 0, :, 1] = gradients[:, :, 0], -gradients[:, :, 1]
    rows[:, 1, :, 0], rows[:, 1, :, 1] = gradients[:, :, 1], gradients[:, :, 0]
    local = 2 * np.einsum("e,erai,erbj->eaibj", weights, rows, rows).reshape(len(cells), 6, 6)
    unknowns = (2 * cells[:, :, None] + np.arange(2)).reshape(len(cells), 6)
    matrix = np.zeros((2 * len(points), 2 * len(points)))
    np.add.at(matrix, (unknowns[:, :, None], unknowns[:, None, :]), local)
    moved = (points + np.where(fixed[:, None], displacement[:, :2], 0.0)).ravel()
    free = np.flatnonzero(~np.repeat(fixed, 2))
    given = np.flatnonzero(np.repeat(fixed, 2))
    moved[free] = np.linalg.solve(matrix[np.ix_(free, free)], -matrix[np.ix_(free, given)] @ moved[given])
    return with_points(mesh, np.column_stack([moved.reshape(-1, 2), points_of(mesh)[:, 2]]))


def deformed_by(moving: Moving, amount: float, name: str) -> Deformed:
    """The mesh by one of SYSTEMS."""
    displacement = moving.at(amount)
    if name in ("femwarp", "anisotropic"):
        return deform(moving.mesh, displacement, name)
    if name == "shape":
        made, times = timed(1, lambda: by_shape(moving.mesh, displacement, np.ones(moving.mesh.GetNumberOfCells())))
        shapes = similarity(moving.mesh, points_of(made))
        return Deformed(made, int(np.count_nonzero(sizes_of(made) <= 0)), 0, times, 1.0, (1.0, 1.0, 1.0), shapes)
    known = (1.0, 1.0, 1.0)
    if name == "anisotropic equal":
        known = deform(moving.mesh, displacement, "anisotropic").coefficients
    return deform(moving.mesh, displacement, "anisotropic", coefficients=tensors(moving.mesh, name, known))


def distance(moving: Moving) -> float:
    """Between the mesh by the area-weighted sum of (4.22), assembled here, and by FEMWARP, over the domain's size."""
    displacement = moving.at(1.0)
    ours = by_shape(moving.mesh, displacement, np.abs(sizes_of(moving.mesh)))
    theirs = tautline.warp(moving.mesh, displacement, method="femwarp", threads=1).mesh
    return float(np.abs(points_of(ours) - points_of(theirs)).max() / moving.mesh.GetLength())


def findings(report: Report, of: dict[str, list[Deformed | None]], same: float) -> None:
    """The findings; a system that does not exist in space has None there."""
    report.finding("4.11", "The linear system of the shape metric (4.22), weighted by area, is FEMWARP's in the plane",
                   same <= EQUAL, f"distance {same:.2g} of the domain's size", own=True,
                   criterion=f"two assemblies differ by at most {EQUAL:g} of the domain's size",
                   proof="|T - adj(T)^t|^2 = 2 |T|^2 - 4 det T, and the sum of area times det T is the area of the "
                   "domain, which the boundary determines")
    for base, names in (("femwarp", ("equal", "jacobians", "shape")), ("anisotropic", ("anisotropic equal",))):
        for name in names:
            pairs = [(of[name][i].inverted, of[base][i].inverted) for i, (_, amount) in enumerate(CASES)
                     if amount == JUDGED and of[name][i] is not None]
            ours, theirs = (sum(counts) for counts in zip(*pairs))
            report.finding("4.11", f"{SYSTEMS[name]}: minimizing the sum inverts fewer elements than {SYSTEMS[base]}",
                           ours < theirs, f"{ours} instead of {theirs} in {len(pairs)} examples: " + ", ".join(
                               f"{a} instead of {b}" for a, b in pairs), own=True,
                           criterion="fewer in all examples together, at the dissertation's largest motion")


def main(arguments: list[str]) -> int:
    given = parse("target_matrices", __doc__, arguments, repeats=1)
    report = Report("target_matrices", "Target matrices in FEMWARP's system (section 4.11)", given)
    report.text(
        "The dissertation proposes to capture the initial mesh in the linear system by target matrices. FEMWARP does "
        "so already: with T, the Jacobian of the deformed element times the inverse of the initial one's, it minimizes "
        "the sum of area |T - I|^2. Other sums of the same matrices give other linear systems: each element alike "
        "instead of by its area; |A_deformed - A_initial|^2, with coefficients A A^t per element, so that long edges "
        "keep their direction; and in the plane the metric (4.22) itself, which is quadratic there and couples the "
        "coordinates."
    )
    for seed in report.seeds:
        run(report, given.small, seed)
    return report.finish()


def run(report: Report, small: bool, seed: int) -> None:
    """The study with one seed."""
    moving = [Moving(e.domain, SMALL_CELLS[e.domain == "sphere"] if small else 0, seed) for e in EXAMPLES]
    of: dict[str, list[Deformed | None]] = {}
    for name in SYSTEMS:
        of[name] = [None if name in PLANAR and m.domain == "sphere" else deformed_by(m, amount, name)
                    for amount in AMOUNTS for m in moving]
    columns = [f"{domain} {amount:g}" for domain, amount in CASES]
    for file, title, value in (("inverted", "Inverted elements", lambda w: float(w.inverted)),
                               ("worst", "Worst TMP shape", lambda w: w.worst),
                               ("mean", "Mean TMP shape", lambda w: float(np.mean(w.shapes)))):
        report.table(file, title, ["minimized", *columns],
                     [[SYSTEMS[name], *(np.nan if w is None else value(w) for w in runs)] for name, runs in of.items()])
    findings(report, of, max(distance(m) for m in moving if m.domain != "sphere"))
