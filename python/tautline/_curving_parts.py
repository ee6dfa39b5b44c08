# SPDX-License-Identifier: BSD-3-Clause
"""The result of curve()."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any, ClassVar

from vtkmodules.vtkCommonDataModel import vtkDataObject

from . import _commands
from ._arrays import Array, cell_array
from ._results import Result


@dataclass(frozen=True, repr=False, eq=False)
class CurveResult(Result):
    """The result of curve(). For composite data, counts are sums over all blocks, and distances are the largest.

    Attributes
    ----------
    mesh : vtkDataObject
        The mesh with its new nodes and cells, the data of the input, and the cell array `Validity`.
    validity : Array
        Per cell, m, certified: 1 valid, 0 degenerate, -1 invalid, -2 not measured.
    added : int
        Number of nodes that were added.
    invalid_before, invalid : int
        Number of invalid elements before and after, certified.
    largest_offset, mean_offset : float
        Distances of the boundary nodes from their positions in the cells of the input.
    distance_before, distance : float
        Largest distance of the boundary from the geometry, before and after; 0 without one.
    summary : str
        The result in words.
    """

    _per_element: ClassVar[tuple[str, ...]] = ("validity",)
    mesh: vtkDataObject
    validity: Array
    added: int
    invalid_before: int
    invalid: int
    largest_offset: float
    mean_offset: float
    distance_before: float
    distance: float
    summary: str


def curve_result(filter_: Any, output: vtkDataObject) -> CurveResult:
    """The result of a filter that has run."""
    return CurveResult(
        mesh=output,
        validity=cell_array(output, "Validity"),
        added=filter_.GetAddedNodes(),
        invalid_before=filter_.GetInvalidBefore(),
        invalid=filter_.GetInvalidAfter(),
        largest_offset=filter_.GetLargestOffset(),
        mean_offset=filter_.GetMeanOffset(),
        distance_before=filter_.GetDistanceBefore(),
        distance=filter_.GetDistanceAfter(),
        summary=filter_.GetSummary(),
    )


def finish_curve(arguments: argparse.Namespace, result: CurveResult) -> int:
    """Print the result of the command."""
    _commands.finish(arguments, result, result.summary)
    return 1 if result.invalid else 0
