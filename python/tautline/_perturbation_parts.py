# SPDX-License-Identifier: BSD-3-Clause
"""The result of perturb()."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any, ClassVar

from vtkmodules.vtkCommonDataModel import vtkDataObject

from . import _commands
from ._arrays import Array, point_array
from ._results import Result


@dataclass(frozen=True, repr=False, eq=False)
class PerturbResult(Result):
    """The result of perturb(). For composite data, numbers cover all blocks.

    Attributes
    ----------
    mesh : vtkDataObject
        The mesh with the new points and the point array `Displacement`; shares the rest with the input.
    displacement : Array
        New minus old position, n x 3.
    movable, moved : int
        Number of interior points that were free to move, and of points that moved.
    inverted_before, inverted, tangled : int, float
        Number of inverted elements before and after, and the latter as a fraction of all elements.
    largest_displacement : float
        The largest displacement, in the mesh's unit.
    summary : str
        The result in words.
    """

    _per_element: ClassVar[tuple[str, ...]] = ("displacement",)
    mesh: vtkDataObject
    displacement: Array
    movable: int
    moved: int
    inverted_before: int
    inverted: int
    tangled: float
    largest_displacement: float
    summary: str


def perturb_result(filter_: Any, output: vtkDataObject) -> PerturbResult:
    """The result of a filter that has run."""
    return PerturbResult(
        mesh=output,
        displacement=point_array(output, "Displacement"),
        movable=filter_.GetNumberOfMovablePoints(),
        moved=filter_.GetNumberOfMovedPoints(),
        inverted_before=filter_.GetInvertedBefore(),
        inverted=filter_.GetInvertedAfter(),
        tangled=filter_.GetTangledFractionReached(),
        largest_displacement=filter_.GetLargestDisplacement(),
        summary=filter_.GetSummary(),
    )


def finish_perturb(arguments: argparse.Namespace, result: PerturbResult) -> None:
    """Print the result of the command."""
    _commands.finish(arguments, result, result.summary)
