# SPDX-License-Identifier: BSD-3-Clause
"""The result of untangle()."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any, ClassVar

from vtkmodules.vtkCommonDataModel import vtkDataObject

from . import _commands
from ._arrays import Array, cell_array, history_of, point_array, table_rows
from ._results import Result


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


def untangle_result(filter_: Any, output: vtkDataObject) -> UntangleResult:
    """The result of a filter that has run."""
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


def finish_untangle(arguments: argparse.Namespace, result: UntangleResult) -> int:
    """Print the result of the command."""
    _commands.finish(arguments, result, result.summary, table_rows(result.history))
    return 1 if result.inverted else 0
