# SPDX-License-Identifier: BSD-3-Clause
"""Condition numbers after multiobjective optimization: sections 3.5.1 to 3.5.3, Tables 3.8, 3.9 and 3.10."""

from __future__ import annotations

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._common import TYPICAL_C, improve, methods
from ._meshes import sizes_of
from ._report import MESQUITE_PATCH_ITERATIONS, Report, parser
from ._pairs import start_mesh
from ._solver_tables import TABLE_3_8, TABLE_3_9, TABLE_3_10
from ._tangled import tangled_methods, untangle
from .bore import warped_bore
from .hydrocephalus import warped_brain
from .shape_size import GOALS

DISK_CELLS, SMALL_DISK_CELLS = 500_000, 4_000
DISK_SWEEPS = 20
UNTANGLING_ITERATIONS = 40
SMALL_ITERATIONS = 8
COLUMNS = ("largest", "smallest", "condition", "iterations")
EXPECTED_ERROR = 1e-3  # relative, of the eigenvalues shown


def spectrum(mesh: vtkDataSet, threads: int) -> list[float]:
    """Extreme eigenvalues, condition number and iterations of MINRES of the Poisson matrix with Jacobi."""
    if np.any(sizes_of(mesh) <= 0):
        return [np.nan] * len(COLUMNS)
    found = tautline.condition(mesh, pde="poisson", preconditioner="jacobi", tolerance=EXPECTED_ERROR, shares=False,
                               threads=threads)
    solved = tautline.solve(mesh, pde="poisson", source=1.0, solver="minres", preconditioner="jacobi",
                            threads=threads)
    row = found.spectrum[-1]
    return [row["largest"], row["smallest"], found.preconditioned_condition, float(solved.iterations)]


def compare(report: Report, file: str, title: str, meshes: dict[str, tuple[str, vtkDataSet]], theirs: dict,
            threads: int) -> dict[str, list[float]]:
    """Write the table of a section; returns its rows by method."""
    found = {name: spectrum(mesh, threads) for name, (_, mesh) in meshes.items()}
    label = {name: text for name, (text, _) in meshes.items()}
    known = {label[n]: [np.nan if v is None else v for v in theirs[n]] for n in meshes if n in theirs}
    report.beside(file, f"{title}; '-': no valid solution because of inverted elements", COLUMNS,
                  {label[n]: row for n, row in found.items()}, known)
    return found


def least(report: Report, source: str, sentence: str, found: dict[str, list[float]], names: tuple[str, ...],
          over: str, column: int = 2) -> None:
    """A finding: the methods `names` have a smaller number in a column than the method `over`."""
    rows = {n: row[column] for n, row in found.items()}
    holds = bool(np.isfinite(rows[over])) and all(rows[n] < rows[over] for n in names)
    report.finding(source, sentence, holds, ", ".join(f"{n} {v:.6g}" for n, v in rows.items()))


def untangled(mesh: vtkDataSet, given) -> dict[str, tuple[str, vtkDataSet]]:
    iterations = SMALL_ITERATIONS if given.small else UNTANGLING_ITERATIONS
    every = tangled_methods("si", "untangle_beta")
    runs = [untangle(mesh, m, iterations, ("si_worst",), patch_iterations=MESQUITE_PATCH_ITERATIONS,
                     threads=given.threads) for m in every]
    return {r.method.name: (r.method.label, r.mesh) for r in runs}


def warped(report: Report, given) -> None:
    _, mesh, _ = warped_brain(given.small)
    meshes = untangled(mesh, given)
    found = compare(report, "table_3_8", "Table 3.8, hydrocephalus", meshes, TABLE_3_8, given.threads)
    brain_findings(report, found)
    mesh, _ = warped_bore(given.small)
    meshes = untangled(mesh, given)
    sus = tautline.untangle(mesh, method="simultaneous", threads=given.threads)
    meshes["sus"] = ("Simultaneous untangling and smoothing", sus.mesh)
    found = compare(report, "table_3_9", "Table 3.9, bore", meshes, TABLE_3_9, given.threads)
    bore_findings(report, found)


def brain_findings(report: Report, found: dict[str, list[float]]) -> None:
    """The findings on Table 3.8, by method."""
    both = ("exponential-sum", "equal-sum")
    least(report, "Table 3.8", "Exponential and equal sum have a smaller condition number than untangling alone", found,
          both, "untangle")
    least(report, "Table 3.8", "... and need fewer iterations", found, both, "untangle", column=3)
    report.finding("Table 3.8", "SI alone and the objective product leave inverted elements: no valid solution",
                   all(np.isnan(found[n][0]) for n in ("si", "objective-product")),
                   ", ".join(f"{n}: {'none' if np.isnan(row[0]) else 'valid'}" for n, row in found.items()))


def bore_findings(report: Report, found: dict[str, list[float]]) -> None:
    """The findings on Table 3.9, by method."""
    report.finding("Table 3.9", "SI alone leaves inverted elements: no valid solution", bool(np.isnan(found["si"][0])),
                   f"largest eigenvalue {found['si'][0]:.4g}")
    least(report, "Table 3.9", "The multiobjective methods need fewer iterations than untangling alone", found,
          ("exponential-sum", "objective-product", "equal-sum"), "untangle", column=3)
    least(report, "Table 3.9", "Exponential sum, product, equal sum and untangling have smaller condition numbers than "
          "simultaneous untangling and smoothing", found,
          ("exponential-sum", "objective-product", "equal-sum", "untangle"), "sus")


def sized(report: Report, given) -> None:
    cells = given.cells or (SMALL_DISK_CELLS if given.small else DISK_CELLS)
    mesh = start_mesh(GOALS, "disk2d", cells)
    every = methods("imr", "size", names=("Shape", "Size"))
    runs = [improve(mesh, m, DISK_SWEEPS, ("imr_mean",), c=TYPICAL_C, patch_iterations=MESQUITE_PATCH_ITERATIONS,
                    trace=False, threads=given.threads) for m in every]
    meshes = {"start": ("start", mesh), **{r.method.name: (r.method.label, r.mesh) for r in runs}}
    title = f"Table 3.10, disk, {mesh.GetNumberOfCells():,} triangles"
    found = compare(report, "table_3_10", title, meshes, TABLE_3_10, given.threads)
    disk_findings(report, found)


def disk_findings(report: Report, found: dict[str, list[float]]) -> None:
    """The findings on Table 3.10, by method."""
    smallest = min((n for n in found if n != "start"), key=lambda n: found[n][2])
    report.finding("Table 3.10", "The exponential sum has the smallest condition number", smallest == "exponential-sum",
                   ", ".join(f"{n} {row[2]:.6g}" for n, row in found.items()))
    least(report, "Table 3.10", "Size alone has the largest condition number", found,
          ("imr", "exponential-sum", "objective-product", "equal-sum"), "size")
    least(report, "Table 3.10", "... and needs the most iterations", found,
          ("imr", "exponential-sum", "objective-product", "equal-sum"), "size", column=3)


def main(arguments: list[str]) -> int:
    given = parser("conditioning", __doc__, DISK_CELLS).parse_args(arguments)
    report = Report("conditioning", "Condition numbers after multiobjective optimization (section 3.5)", given.out,
                    given.small)
    report.text(
        "Poisson's equation with f = 1 and u = 0 on the boundary, solved by MINRES with Jacobi's preconditioner as in "
        "sections 1 and 3.5: P is the diagonal of A; eigenvalues of P^-1 A to a relative error of "
        f"{EXPECTED_ERROR:g}; iterations to a relative preconditioned residual of 1e-5. The meshes are those of the "
        "studies hydrocephalus, bore and shape_size after the last iteration of local conjugate gradients."
    )
    warped(report, given)
    sized(report, given)
    return report.finish()
