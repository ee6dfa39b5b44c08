# SPDX-License-Identifier: BSD-3-Clause
"""The result of improve(), and its arguments that are not one property each."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, get_args

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataObject

from . import _commands
from ._arguments import number, pick, picked, sets, within
from ._arrays import POINTS, Array, InputArrays, Values, cell_array, columns, is_number, table_rows
from ._choices import IMPROVE_PRESETS, ImprovePreset
from ._errors import Error
from ._metrics import metric_name
from ._results import Result

#: In the filter's numbering, except the last one.
Objective = Literal["angles and shape", "angles", "shape", "sum"]
OBJECTIVES: tuple[Objective, ...] = get_args(Objective)
_SIZES = 2  # input array of vtkMeshImprover


@dataclass(frozen=True, repr=False, eq=False)
class ImproveResult(Result):
    """The result of improve(). For composite data, numbers cover all blocks.

    Attributes
    ----------
    mesh : vtkDataObject
        The new mesh with the data of the input, `OriginalCellId`, `min_angle` and `imr`.
    history : dict[str, Any]
        Per pass (0 is the input): smallest_angle, largest_angle, worst_imr, elements, below_target, edge_removals (for
        triangles: flips), face_removals, boundary_swaps, contractions, insertions, moves, seconds; with "adapt" also
        edges_in_range and worst_quality_in_metric; for composite data also block.
    remaining : dict[str, Any]
        The elements that are still below the target, the worst first: cell, smallest_angle, imr, x, y, z, quality (of
        the objective; for triangles the sine of the smallest angle), quality_bound (what facets or angles on the
        boundary and between regions allow), reason; for composite data also block. Empty if there are none.
    original_cell : Array
        Per cell the cell of the input that it has its data from, m.
    min_angle, imr : Array
        Per cell, m: smallest angle in degrees (for tetrahedra dihedral), inverse mean ratio.
    elements_before, elements : int
        Number of elements before and after.
    smallest_angle_before, smallest_angle : float
        Smallest angle in degrees before and after.
    worst_before, worst : float
        Worst inverse mean ratio before and after.
    worst_metric_before, worst_metric : float
        Worst value of the metric before and after; 0 without one.
    boundary_distance : float
        Largest distance between the boundaries of the result and the input; 0 unless it is "on surface".
    edges_in_range_before, edges_in_range : float
        With "adapt", the fraction of the edges, 0 to 1, that are 0.71 to 1.41 times as long as the target, before and
        after; otherwise 0.
    worst_in_metric : float
        With "adapt", the largest inverse mean ratio in the metric; otherwise 0.
    reason : str
        The stopping criterion that ended the run.
    summary : str
        The result in words.
    """

    _per_element: ClassVar[tuple[str, ...]] = ("original_cell", "min_angle", "imr")
    mesh: vtkDataObject
    history: dict[str, Any]
    remaining: dict[str, Any]
    original_cell: Array
    min_angle: Array
    imr: Array
    elements_before: int
    elements: int
    smallest_angle_before: float
    smallest_angle: float
    worst_before: float
    worst: float
    worst_metric_before: float
    worst_metric: float
    boundary_distance: float
    edges_in_range_before: float
    edges_in_range: float
    worst_in_metric: float
    reason: str
    summary: str


@sets("improve", "Preset")
def choose_preset(filter_: Any, preset: ImprovePreset = "remove slivers", *, custom: dict[str, bool | None]) -> None:
    """Set the preset.

    preset: "remove slivers" (changes only neighborhoods of elements with dihedral angles below 15 or above 165 degrees,
        for triangles with angles below 15), "swap only" (no point moves), "swap and smooth" (no point is
        inserted or removed), "aggressive" (every operation everywhere), "adapt" (edges get the lengths of edge_length,
        with as many elements as needed, and the worst elements are improved in this metric) or "custom" (the
        operations given: swap, smooth, contract, insert, compound; all by default).
    """
    preset = picked("preset", preset, IMPROVE_PRESETS)
    operations = [name for name, value in custom.items() if value is not None]
    if operations and preset != "custom":
        raise Error(f"{', '.join(operations)}: operations are chosen with preset='custom' only")
    filter_.SetPreset(IMPROVE_PRESETS.index(preset))


@sets("improve", "Objective", "Metric")
def set_objective(filter_: Any, objective: Objective = "angles and shape", metric: str | None = None) -> None:
    """Set the objective for the worst tetrahedra.

    objective: for tetrahedra, the objective for the worst ones: "angles and shape" (the smaller of the sines of the
        dihedral angles and (mean ratio)^(3/2)), "angles" (the sines alone: larger smallest angles, longer tetrahedra)
        or "shape" ((mean ratio)^(3/2) alone). "sum": all are improved, by the sum of (inverse mean ratio - 1), and the
        worst do not become worse.
    metric: for tetrahedra, instead of an objective: the name of a metric, whose worst values are improved first and
        never become worse. Tetrahedra are worked on while the quality x / I (I / x where smaller is better, 1 / (1 + x)
        where I is 0), of the value x and the ideal value I, is below the sine of the target angle.
    """
    chosen = pick("objective", objective, OBJECTIVES)
    filter_.SetObjective(filter_.SUM if OBJECTIVES[chosen] == "sum" else chosen)
    if metric is not None:
        if chosen != 0:
            raise Error("give either an objective or a metric")
        filter_.SetObjective(filter_.METRIC)
        filter_.SetMetricByName(metric_name(metric, "metric"))


@sets("improve", "EdgeLengths", "EdgeLength", "SizeArray")
def set_edge_length(filter_: Any, inputs: InputArrays, edge_length: float | Values | None = None) -> None:
    """Set where the target length of edges comes from.

    edge_length: target length of edges, which bounds contraction and insertion; None: any length. A number; "input"
        (the mean length of the edges at each point); or per point a length, n, or a metric tensor in which edges of the
        target length have length 1, n x 6 in the order of VTK or n x 9; or the name of such a point array.
    """
    if edge_length is None:
        return
    if isinstance(edge_length, str) and edge_length == "input":
        filter_.SetSize(filter_.LENGTH_OF_INPUT)
    elif is_number(edge_length):
        filter_.SetSize(filter_.EDGE_LENGTH)
        filter_.SetEdgeLength(within("edge_length", number("edge_length", edge_length), 0, np.inf))
    else:
        filter_.SetSize(filter_.SIZE_ARRAY)
        inputs.use(_SIZES, edge_length, "edge_length", POINTS)


def improve_result(filter_: Any, output: vtkDataObject) -> ImproveResult:
    """The result of a filter that has run."""
    return ImproveResult(
        mesh=output,
        history=_named(filter_.GetHistory()),
        remaining=_named(filter_.GetRemainingTable()),
        original_cell=cell_array(output, "OriginalCellId"),
        min_angle=cell_array(output, "min_angle"),
        imr=cell_array(output, "imr"),
        elements_before=filter_.GetElementsBefore(),
        elements=filter_.GetElementsAfter(),
        smallest_angle_before=filter_.GetSmallestAngleBefore(),
        smallest_angle=filter_.GetSmallestAngleAfter(),
        worst_before=filter_.GetWorstBefore(),
        worst=filter_.GetWorstAfter(),
        worst_metric_before=filter_.GetWorstMetricBefore(),
        worst_metric=filter_.GetWorstMetricAfter(),
        boundary_distance=filter_.GetBoundaryDistance(),
        edges_in_range_before=filter_.GetEdgesInRangeBefore(),
        edges_in_range=filter_.GetEdgesInRangeAfter(),
        worst_in_metric=filter_.GetWorstInMetric(),
        reason=filter_.GetReason(),
        summary=filter_.GetSummary(),
    )


def _named(table: Any) -> dict[str, Any]:
    """The columns of a table by names of Python; ids and counts are integers."""
    renamed = {"Time (s)": "seconds"}
    real = ("seconds", "smallest_angle", "largest_angle", "worst_imr", "imr", "x", "y", "z", "quality", "quality_bound",
            "edges_in_range", "worst_quality_in_metric")  # fmt: skip
    found = columns(table)  # once: texts of many rows take a while
    names = {name: name.removeprefix("N ").lower().replace(" ", "_") for name in found} | renamed
    result = {names[name]: column for name, column in found.items()}
    return {
        name: column if isinstance(column, list) or name in real else column.astype(int)
        for name, column in result.items()
    }


# --- the shell ----------------------------------------------------------------------------------------------


def add_improve_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of these arguments."""
    parser.add_argument("--preset", choices=IMPROVE_PRESETS, default="remove slivers")
    parser.add_argument("--objective", choices=OBJECTIVES, default=OBJECTIVES[0],
                        help="the objective for the worst tetrahedra")  # fmt: skip
    parser.add_argument("--metric", metavar="NAME", help="a metric instead of an objective, its worst values first")
    parser.add_argument("--edge-length", type=_commands.number_or_name, metavar="LENGTH|ARRAY|input",
                        help="target length of edges: number, point array, or input")  # fmt: skip


def improve_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """The values of these options."""
    return _commands.given(arguments, ("preset", "objective", "metric", "edge_length"))


def finish_improve(arguments: argparse.Namespace, result: ImproveResult) -> None:
    """Print the result of the command."""
    _commands.finish(arguments, result, result.summary, table_rows(result.history))
