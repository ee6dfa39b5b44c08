# SPDX-License-Identifier: BSD-3-Clause
"""The function compare: the changes of quality between two meshes with the same cells."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataObject

from . import _commands, _vtk
from ._arguments import set_threads, set_time_limit, within
from ._arrays import Array, cell_array, columns, point_array, snake
from ._errors import interruptible, run
from ._interrupts import Progress
from ._io import Mesh, as_mesh
from ._metrics import Metrics, choose
from ._results import Result
from ._tables import comparison_rows, comparison_text


@dataclass(frozen=True, repr=False, eq=False)
class CompareResult(Result):
    """The result of compare().

    mesh: the second mesh with the cell arrays `<metric>_before`, `_after`, `_difference`, `Validity_before`,
        `Validity_after`, `Change`, and the point array `Displacement`.
    statistics: per metric: better, worse, equal (numbers of elements), inverted_before, inverted_after, minimum_before,
        minimum_after, mean_before, mean_after, maximum_before, maximum_after, largest_displacement.
    difference: per metric the value after minus the value before on each cell, m.
    change: per cell, m: 1 better by some metric and worse by none, -1 the opposite, else 0.
    displacement: second minus first position, n x 3.
    summary: the result in words.
    """

    _per_element: ClassVar[tuple[str, ...]] = ("difference", "change", "displacement")
    mesh: vtkDataObject
    statistics: dict[str, dict[str, Any]]
    difference: dict[str, Array]
    change: Array
    displacement: Array
    summary: str

    def table(self) -> list[dict[str, Any]]:
        """A row per metric: what --csv writes."""
        return comparison_rows(self)


@interruptible
def compare(
    before: Mesh,
    after: Mesh,
    metrics: Metrics = ("imr",),
    *,
    tolerance: float = 1e-6,
    time_limit: float = 0.0,
    threads: int = 0,
    progress: Progress | bool | None = None,
) -> CompareResult:
    """Compare the quality of two meshes with the same cells, element by element.

    before, after: each a vtkDataSet, a composite data set, a file name or (points, cells). Neither is changed.
    metrics: see quality().
    tolerance: relative difference up to which two values count as equal, 0 to 1.
    time_limit: seconds; 0 is no limit.
    threads: number of threads; 0 is all cores. The result does not depend on it.

    Raises Error for wrong arguments and for meshes of different connectivity; the message has the first difference.

    >>> result = tautline.compare("part.vtu", "better.vtu", ["imr", "size"])
    >>> result.statistics["imr"]["better"], result.statistics["imr"]["worse"]
    """
    filter_ = _vtk.vtkMeshComparison()
    messages = choose(filter_, metrics)
    filter_.SetTolerance(within("tolerance", tolerance, 0, 1))
    set_time_limit(filter_, time_limit)
    set_threads(filter_, threads)
    filter_.SetInputDataObject(0, as_mesh(before))
    filter_.SetInputDataObject(1, as_mesh(after))
    run(filter_, messages)
    mesh = filter_.GetOutputDataObject(0)
    table = columns(filter_.GetOutputDataObject(1))
    rows = {name: row for row, name in enumerate(table.pop("Metric"))}
    return CompareResult(
        mesh=mesh,
        statistics={n: {snake(key): table[key][row].item() for key in table} for n, row in rows.items()},
        difference={name: cell_array(mesh, f"{name}_difference") for name in rows},
        change=cell_array(mesh, "Change"),
        displacement=point_array(mesh, "Displacement"),
        summary=filter_.GetSummary(),
    )


# --- the shell ----------------------------------------------------------------------------------------------


def add_commands(commands: Any) -> None:
    """Add `compare` to the subparsers of the command line."""
    parser = _commands.add_command(
        commands, "compare", _run, "compare the quality of two meshes with the same cells, element by element",
        example="part.vtu better.vtu --metrics imr,rr",
        details="Prints how many elements became better and worse by each metric.",
    )
    parser.add_argument("before", metavar="BEFORE")
    parser.add_argument("after", metavar="AFTER")
    _commands.add_output(parser, "write the second mesh with the differences", False)
    parser.add_argument("--csv", metavar="FILE", help="write the comparison, a row per metric")
    _commands.add_metrics(parser)
    _commands.add_time_limit(parser)
    parser.add_argument("--tolerance", type=float, default=1e-6,
                        help="relative difference up to which values are equal (default: 1e-6)")  # fmt: skip


def _run(arguments: argparse.Namespace) -> None:
    options = _commands.given(arguments, ("tolerance", "time_limit", "threads"))
    result = compare(arguments.before, arguments.after, arguments.metrics, **options)
    _commands.finish(arguments, result, comparison_text(result), comparison_rows(result))
