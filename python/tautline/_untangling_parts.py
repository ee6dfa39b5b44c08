# SPDX-License-Identifier: BSD-3-Clause
"""The function untangle: move points so that elements become valid."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, get_args

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataObject

from . import _commands, _vtk
from ._arguments import Redistribution, pick, set_redistribution, set_threads, set_time_limit
from ._arrays import POINTS, Array, InputArrays, Values, cell_array, history_of, point_array, table_rows
from ._errors import interruptible, run
from ._interrupts import Progress
from ._io import Mesh, as_mesh
from ._results import Result

Method = Literal["automatic", "simultaneous"]
METHODS: tuple[Method, ...] = get_args(Method)
Effort = Literal["local", "normal", "thorough"]
EFFORTS: tuple[Effort, ...] = get_args(Effort)
_FIXED = 0  # input array of vtkMeshUntangler


@dataclass(frozen=True, repr=False, eq=False)
class UntangleResult(Result):
    """The result of untangle(). Of composite data, numbers are of all blocks.

    mesh: the mesh with the new points, `Displacement`, `Validity` and `Obstacle`.
    history: per iteration (0 is the input): iteration, objective (the energy), inverted, gradient_norm, moving,
        seconds; of composite data also block.
    validity: per cell, m: 1 valid, 0 degenerate, -1 inverted, -2 not measured, -3 not finite.
    obstacle: per cell, m, why it is not valid: 0 it is valid, 1 the iterations ended, 2 all its points are fixed, 3 no
        position between the fixed points around makes it valid, 4 a fixed point is not finite.
    inverted_before, inverted, impossible: number of inverted or degenerate elements before and after, and of those that
        fixed points make infeasible.
    reason: the stopping criterion that ended the run.
    displacement: new minus old position, n x 3.
    summary: the result in words: which elements remain invalid, where and why.
    """

    _per_element: ClassVar[tuple[str, ...]] = ("validity", "obstacle", "displacement")
    mesh: vtkDataObject
    history: dict[str, Any]
    validity: Array
    obstacle: Array
    inverted_before: int
    inverted: int
    impossible: int
    reason: str
    displacement: Array
    summary: str


@interruptible
def untangle(
    mesh: Mesh,
    effort: Effort = "normal",
    *,
    method: Method = "automatic",
    fixed: Values | None = None,
    fix_boundary: bool = True,
    time_limit: float = 0.0,
    threads: int = 0,
    merge_coincident_points: bool = True,
    reproducible_order: bool = False,
    redistribute: Redistribution | bool = "off",
    progress: Progress | bool | None = None,
) -> UntangleResult:
    """Make the elements of a mesh valid by moving its points; the number of inverted elements never grows.

    mesh: a vtkDataSet with explicit points, a composite data set, a file name or (points, cells). It is not changed.
    effort: "local" (moves points around inverted elements only), "normal" (then all points) or "thorough".
    method: "automatic", or "simultaneous", the simultaneous untangling and smoothing of Escobar et al. 2003, which
        moves every point and takes no effort, for comparison.
    fixed: points that stay in place: one number or truth value per point, n, or the name of a point array.
    fix_boundary: whether the points of the boundary stay in place.
    time_limit: seconds; 0 is no limit.
    threads: number of threads; 0 is all cores. The result does not depend on it.
    merge_coincident_points: whether points at the same place on facets that match are treated as one, as on the seams
        of a mesh in pieces; the result keeps them all. False: they stay apart, as a crack or a contact needs it.
    reproducible_order: work in the order that does not depend on how a mesh is spread over processes, as several of
        them do unless the mesh is gathered.
    redistribute: on several processes (pvbatch --sym under MPI, where each calls this function with its piece): divide
        the mesh anew among them, also where the first one has all of it; "off", "k-d tree" (or True), "pt-scotch".

    Raises Error for wrong arguments and for meshes that the filter refuses. Elements that remain inverted are not an
    error: see inverted, obstacle and summary of the result.

    >>> result = tautline.untangle("tangled.vtu")
    >>> result.inverted_before, result.inverted
    """
    filter_ = _vtk.vtkMeshUntangler()
    inputs = InputArrays(filter_, as_mesh(mesh))
    filter_.SetEffort(pick("effort", effort, EFFORTS))
    filter_.SetMethod(pick("method", method, METHODS))
    filter_.SetFixBoundary(bool(fix_boundary))
    set_time_limit(filter_, time_limit)
    set_threads(filter_, threads)
    filter_.SetMergeCoincidentPoints(bool(merge_coincident_points))
    filter_.SetReproducibleOrder(bool(reproducible_order))
    set_redistribution(filter_, redistribute)
    inputs.use(_FIXED, fixed, "fixed", POINTS)
    filter_.SetInputDataObject(0, inputs.mesh)
    run(filter_)
    output = inputs.remove_from(filter_.GetOutputDataObject(0))
    return UntangleResult(
        mesh=output,
        history=history_of(filter_),
        validity=cell_array(output, "Validity"),
        obstacle=cell_array(output, "Obstacle"),
        inverted_before=filter_.GetInvertedBefore(),
        inverted=filter_.GetInvertedAfter(),
        impossible=filter_.GetImpossible(),
        reason=filter_.GetReason(),
        displacement=point_array(output, "Displacement"),
        summary=filter_.GetSummary(),
    )


# --- the shell ----------------------------------------------------------------------------------------------


def add_commands(commands: Any) -> None:
    """Add `untangle` to the subparsers of the command line."""
    parser = _commands.add_command(
        commands, "untangle", _run_untangle, "move points so that elements become valid",
        example="tangled.vtu -o valid.vtu --csv history.csv",
        details="The number of inverted elements never grows; exits with 1 if some remain.",
    )
    _commands.add_moving_points(parser)
    parser.add_argument("--effort", choices=EFFORTS, default="normal")
    _commands.add_reproducible_order(parser)
    _commands.add_flag(parser, "fix_boundary", "whether the points of the boundary stay in place")
    parser.add_argument("--method", choices=METHODS, default="automatic", help="simultaneous: Escobar et al. 2003")


def _run_untangle(arguments: argparse.Namespace) -> int:
    names = ("effort", "method", "fixed", "fix_boundary", "time_limit", "threads", "merge_coincident_points",
             "reproducible_order")  # fmt: skip
    result = untangle(arguments.mesh, **_commands.given(arguments, names))
    _commands.finish(arguments, result, result.summary, table_rows(result.history))
    return 1 if result.inverted else 0
