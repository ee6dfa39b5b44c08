# SPDX-License-Identifier: BSD-3-Clause
"""Errors against the number of elements: uniform refinement, isotropic and anisotropic adaptation."""

from __future__ import annotations

import math
from typing import Any, NamedTuple, Sequence

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._memory import remembered
from ._meshes import right_triangles
from ._report import Report, parser
from ._solvers import order
from ._verdicts import Open, Verdict, all_of
from .solution_error import PROBLEMS as KNOWN
from .solver_meshes import cube

#: Cells along a side of the uniform meshes, whose numbers of elements are the targets of the adapted ones.
SIZES, SMALL_SIZES = (8, 16, 32, 64), (4, 8)
CUBE_SIZES, SMALL_CUBE_SIZES = (4, 8, 12), (2, 4)
#: Adaptations to each target, from the mesh of the target before.
ITERATIONS = 3
LARGEST_SIZE = 0.5  # which leaves the coarsest meshes free
TOLERANCE = 1e-10  # relative, of the linear systems
#: The number of finest meshes that an exponent is fitted to.
FITTED = 3
#: Difference from an exponent that counts as none.
RATE_TOLERANCE = 0.1
#: Relative difference of a number of elements from its target.
COUNT_TOLERANCE = 0.25
#: Part of another error that an error is to be below for the difference to be a gain.
GAIN = 0.5
METHODS = {"uniform": "uniform refinement", "isotropic": "isotropic adaptation",
           "anisotropic": "anisotropic adaptation"}
NORMS = ("L2", "H1")
WIDTH = 0.1  # of the layer in the cube


class Problem(NamedTuple):
    """A known solution and its domain."""

    #: Arguments of solve().
    options: dict[str, Any]
    dimension: int
    #: The mesh is the square or cube from 0 to 1, or the L-shaped domain from -1 to 1.
    corner: bool
    #: Exponents of the number of elements in the errors in L2 and H1: on uniform and on adapted meshes.
    uniform: tuple[float, float]
    adapted: tuple[float, float]


def _options(exact: str, source: Any, more: dict[str, Any]) -> dict[str, Any]:
    return {"source": source, "given": exact, "exact": exact, "relative_tolerance": TOLERANCE, "gradient": False,
            **more}


PROBLEMS = {
    "corner": Problem(_options(*KNOWN["corner"][:3]), 2, True, (-2 / 3, -1 / 3), (-1.0, -0.5)),
    "boundary layer": Problem(_options(*KNOWN["boundary layer"][:3]), 2, False, (-1.0, -0.5), (-1.0, -0.5)),
    "boundary layer in a cube": Problem(
        _options(f"exp(-x/{WIDTH!r})", 0.0, {"pde": "elliptic", "reaction": WIDTH**-2}), 3, False,
        (-2 / 3, -1 / 3), (-2 / 3, -1 / 3)),
}  # fmt: skip


class Solved(NamedTuple):
    """A mesh by its size and its errors."""

    target: float
    elements: int
    l2: float
    h1: float
    in_range: float


def main(arguments: list[str]) -> int:
    given = parser("adaptation", __doc__, threads=0).parse_args(arguments)
    report = Report("adaptation", "Errors of the solution on adapted meshes", given)
    report.text(
        "How does the error of the solution fall with the number of elements N where the solution has a singularity "
        "r^(2/3) at a corner or a boundary layer? Meshes are refined uniformly, or adapted by Metric Tensor (Hessian, "
        f"norm L2) and Improve Mesh (preset Adapt), {ITERATIONS} times for each target. Errors in L2 and in the H1 "
        "seminorm by Solve PDE, with linear elements."
    )
    for name, problem in PROBLEMS.items():
        plane = problem.dimension == 2
        sizes = (SMALL_SIZES if plane else SMALL_CUBE_SIZES) if given.small else SIZES if plane else CUBE_SIZES
        found = {method: solved(name, method, sizes, given.threads) for method in METHODS}
        show(report, name, found)
        rate_findings(report, name, found)
        gain_findings(report, name, found)
        count_findings(report, name, found)
    return report.finish()


def initial(problem: Problem, n: int) -> vtkDataSet:
    """A mesh with n cells along a side."""
    if problem.dimension == 3:
        points, blocks = cube("tetrahedra", [n, n, n])
        return tautline.from_arrays(points, blocks)
    x = np.linspace(-1.0 if problem.corner else 0.0, 1.0, n + 1)
    points, cells = right_triangles(x, x)
    if problem.corner:
        centres = points[cells].mean(axis=1)
        cells = cells[~((centres[:, 0] > 0) & (centres[:, 1] < 0))]
        used = np.unique(cells)
        cells, points = np.searchsorted(used, cells), points[used]
    return tautline.from_arrays(points, {"triangle": cells})


@remembered
def solved(name: str, method: str, sizes: Sequence[int], threads: int) -> list[Solved]:
    """The errors on the meshes of a method."""
    problem = PROBLEMS[name]
    meshes = [initial(problem, n) for n in sizes]
    found = []
    mesh: Any = meshes[0]
    for uniform in meshes:
        target = uniform.GetNumberOfCells()
        if method == "uniform":
            result = tautline.solve(uniform, threads=threads, **problem.options)
            row = (target, result.solution_error, result.gradient_error, math.nan)
        else:
            adapted = tautline.adapt(mesh, problem.options, ITERATIONS, elements=target, threads=threads,
                                     anisotropic=method == "anisotropic", largest_size=LARGEST_SIZE)
            mesh, last = adapted.mesh, adapted.table()[-1]
            row = (adapted.elements, last["solution_error"], last["gradient_error"], last["edges_in_range"])
        found.append(Solved(target, int(row[0]), *(float(value) for value in row[1:])))
    return found


def show(report: Report, name: str, found: dict[str, list[Solved]]) -> None:
    """The table and the picture of a problem."""
    file = name.replace(" ", "_")
    rows = [[METHODS[m], each.target, each.elements, each.l2, each.h1, each.in_range]
            for m, series in found.items() for each in series]
    report.table(f"errors_{file}", f"{name}: errors by number of elements",
                 ["mesh", "target", "elements", "L2", "H1", "edges in range"], rows)
    report.lines(f"errors_{file}", [
        (f"{name}, {norm}", "log10 of the number of elements", f"-log10 of the error in {norm}",
         {METHODS[m]: (np.log10([each.elements for each in series]), digits(series, norm))
          for m, series in found.items()})
        for norm in NORMS])


def digits(series: Sequence[Solved], norm: str) -> np.ndarray:
    """The negative logarithms of the errors."""
    return -np.log10([getattr(each, norm.lower()) for each in series])


def rate(series: Sequence[Solved], norm: str) -> float:
    """The fitted exponent of the number of elements; nan where a number is missing."""
    values = [getattr(each, norm.lower()) for each in series[-FITTED:]]
    sizes = [each.elements for each in series[-FITTED:]]
    known = min(sizes) > 0 and len(set(sizes)) > 1 and all(math.isfinite(value) and value > 0 for value in values)
    return order(sizes, values) if known else math.nan


def as_fast(found: float, expected: float) -> Verdict:
    """Whether errors fall at least as fast as expected."""
    return Open("a solver failed") if math.isnan(found) else found <= expected + RATE_TOLERANCE


def rate_findings(report: Report, name: str, found: dict[str, list[Solved]]) -> None:
    problem = PROBLEMS[name]
    for k, norm in enumerate(NORMS):
        for method, series in found.items():
            ours = rate(series, norm)
            expected = (problem.uniform if method == "uniform" else problem.adapted)[k]
            if method == "uniform":
                holds = Open("a solver failed") if math.isnan(ours) else abs(ours - expected) <= RATE_TOLERANCE
                claim = f"The error in {norm} falls as N^{expected:.3g} with {METHODS[method]}"
                rule = f"within {RATE_TOLERANCE:g}, fitted to the {FITTED} finest meshes"
            else:
                holds = as_fast(ours, expected)
                claim = f"The error in {norm} falls at least as N^{expected:.3g} with {METHODS[method]}"
                rule = f"the exponent is at most {RATE_TOLERANCE:g} larger, fitted to the {FITTED} finest meshes"
            report.finding(name, claim, holds, f"{ours:.3f}", criterion=rule, own=True)


def smaller(one: Solved, other: Solved, norm: str, expected: float) -> Verdict:
    """Whether one error is at most GAIN times the other, at the same number of elements by the expected exponent."""
    a, b = getattr(one, norm.lower()), getattr(other, norm.lower())
    if not (math.isfinite(a) and math.isfinite(b) and min(one.elements, other.elements) > 0):
        return Open("a solver failed")
    return a <= GAIN * b * (one.elements / other.elements) ** expected


def gain_findings(report: Report, name: str, found: dict[str, list[Solved]]) -> None:
    layer = "layer" in name
    for k, norm in enumerate(NORMS):
        expected = PROBLEMS[name].adapted[k]
        last = {method: series[-1] for method, series in found.items()}
        figures = ", ".join(f"{m} {getattr(each, norm.lower()):.3g} with {each.elements}" for m, each in last.items())
        rule = f"at most {GAIN:g} times as large on the finest meshes, scaled to the same number of elements"
        for method in ("isotropic", "anisotropic"):
            claim = f"The error in {norm} is smaller after {METHODS[method]} than after uniform refinement"
            report.finding(name, claim, smaller(last[method], last["uniform"], norm, expected), figures, criterion=rule,
                           own=True)
        if layer:
            report.finding(name, f"The error in {norm} is smaller with anisotropy than without",
                           smaller(last["anisotropic"], last["isotropic"], norm, expected), figures, criterion=rule,
                           own=True)


def count_findings(report: Report, name: str, found: dict[str, list[Solved]]) -> None:
    adapted = [each for method, series in found.items() if method != "uniform" for each in series]
    off = [abs(each.elements / each.target - 1) if each.target else math.nan for each in adapted]
    report.finding(name, "The number of elements is about the target",
                   all_of(Open("a number is missing") if math.isnan(part) else part <= COUNT_TOLERANCE for part in off),
                   f"largest difference {max(off):.1%}", criterion=f"within {COUNT_TOLERANCE:.0%}", own=True)
