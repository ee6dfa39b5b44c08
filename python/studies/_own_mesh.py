# SPDX-License-Identifier: BSD-3-Clause
"""Studies of chapter 2 with a mesh, metrics, coefficients and boundary conditions of the user's."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline
from tautline._cell_names import CELLS_BY_NUMBER
from tautline._commands import numbers_or_text

from ._solver_tables import METRICS
from ._solvers import DOMAINS, PDES, initial_mesh, smoothing
from ._verdicts import Times

#: Options of solver_study() that a study passes on: name and help.
COEFFICIENTS = {
    "alpha": "coefficient of -u_xx",
    "beta": "coefficient of -u_yy",
    "gamma": "coefficient of -u_zz",
    "reaction": "a of the general second-order equation",
    "youngs_modulus": "of elasticity",
    "poisson_ratio": "of elasticity",
}
FUNCTIONS = {
    "source": "numbers, a point array or an expression of x, y, z",
    "fixed": "where the solution is given: an expression on the boundary, or an array",
    "given": "the solution there, in the same form as the source",
    "tensor": "a cell array of tensors C of the general second-order equation",
}
#: Options by equation; other equations ignore or reject them.
OF = {"alpha": ("elliptic",), "beta": ("elliptic",), "gamma": ("elliptic",), "reaction": ("elliptic",),
      "tensor": ("elliptic",), "youngs_modulus": ("elasticity",), "poisson_ratio": ("elasticity",)}
AS_GIVEN = "as given"


def add_mesh_options(made: argparse.ArgumentParser) -> None:
    """--mesh and --metrics."""
    made.add_argument("--mesh", metavar="FILE", help="a mesh of your own, of supported cells; it is used "
                      "as it is, and nothing is compared with the dissertation")
    made.add_argument("--metrics", nargs="+", metavar="NAME", help="metrics to smooth by (default: "
                      + ", ".join(METRICS) + "); with others nothing is compared with the dissertation")


def add_options(made: argparse.ArgumentParser) -> None:
    """A mesh, metrics, coefficients and boundary conditions."""
    add_mesh_options(made)
    for name, text in COEFFICIENTS.items():
        made.add_argument("--" + name.replace("_", "-"), type=float, metavar="X", help=text)
    for name, text in FUNCTIONS.items():
        made.add_argument(f"--{name}", type=str if name == "fixed" else _function, metavar="F", help=text)


def _function(text: str) -> Any:
    values = numbers_or_text(text)
    return values[0] if isinstance(values, list) and len(values) == 1 else values


def chosen(given: argparse.Namespace) -> bool:
    """Whether anything differs from the dissertation's setting."""
    return any(getattr(given, name, None) is not None for name in ("mesh", "metrics", *COEFFICIENTS, *FUNCTIONS))


def meshes(given: argparse.Namespace, size: int) -> dict[str, vtkDataSet]:
    """The user's mesh by the name of its file, or the meshes of the dissertation's domains."""
    if given.mesh:
        return {Path(given.mesh).stem: tautline.read(given.mesh)}
    return {domain: initial_mesh(domain, size) for domain in getattr(given, "domain", None) or DOMAINS}


def metrics_of(mesh: vtkDataSet, given: argparse.Namespace) -> list[str]:
    """The chosen metrics; by default the dissertation's metrics that are defined on the cells of the mesh."""
    known = {facts["name"]: facts for facts in tautline.metrics()}
    if given.metrics:
        return list(given.metrics)
    kinds = cell_types(mesh)
    return [name for name in METRICS if kinds <= set(known[name]["cell_types"])]


def cell_types(mesh: vtkDataSet) -> set[str]:
    """The names of the types of the cells."""
    return {CELLS_BY_NUMBER[number] for number in {mesh.GetCellType(cell) for cell in range(mesh.GetNumberOfCells())}}


def smoothed_by(mesh: vtkDataSet, given: argparse.Namespace) -> dict[str, tuple[vtkDataSet, Times]]:
    """The mesh as it is and smoothed by each metric, with the times of smoothing."""
    made = {AS_GIVEN: (mesh, Times((0.0,)))}
    for metric in metrics_of(mesh, given):
        run = smoothing(mesh, metric, given.threads, given.repeats)
        made[metric] = run.mesh, run.times()
    return made


def problem(pde: str, given: argparse.Namespace) -> dict[str, Any]:
    """The problem with the user's coefficients and boundary conditions."""
    more = {name: getattr(given, name) for name in (*COEFFICIENTS, *FUNCTIONS)
            if getattr(given, name) is not None and pde in OF.get(name, (pde,))}
    return {**PDES[pde], **more}
