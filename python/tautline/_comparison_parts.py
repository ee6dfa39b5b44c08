# SPDX-License-Identifier: BSD-3-Clause
"""The result of compare(), and its arguments that are not one property each."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any, ClassVar

from vtkmodules.vtkCommonDataModel import vtkDataObject

from . import _commands
from ._arguments import sets
from ._arrays import CELLS, Array, cell_array, columns, has_array, point_array, snake
from ._io import Mesh, as_mesh
from ._metrics import Metrics, by_metric, choose, metrics as known_metrics
from ._results import Result
from ._tables import comparison_rows, comparison_text


@dataclass(frozen=True, repr=False, eq=False)
class CompareResult(Result):
    """The result of compare(). On several MPI ranks each has the arrays of its piece, the first one the statistics.

    Attributes
    ----------
    mesh : vtkDataObject
        The second mesh with the cell arrays `<metric>_before`, `_after`, `_difference`, `Validity_before`,
        `Validity_after`, `Change`, and the point array `Displacement`.
    statistics : dict[str, dict[str, Any]]
        Per metric: better, worse, equal (numbers of elements), inverted_before, inverted_after, minimum_before,
        minimum_after, mean_before, mean_after, maximum_before, maximum_after, largest_displacement.
    difference : dict[str, Array]
        Per metric the value after minus the value before on each cell, m.
    change : Array
        Per cell, m: 1 better by some metric and worse by none, -1 the opposite, otherwise 0.
    displacement : Array
        Second minus first position, n x 3.
    summary : str
        The result in words.
    """

    _per_element: ClassVar[tuple[str, ...]] = ("difference", "change", "displacement")
    mesh: vtkDataObject
    statistics: dict[str, dict[str, Any]]
    difference: dict[str, Array]
    change: Array
    displacement: Array
    summary: str

    def table(self) -> list[dict[str, Any]]:
        """A row per metric, as --csv writes it."""
        return comparison_rows(self)


def compare_input(filter_: Any, before: Mesh, after: Mesh) -> None:
    """Set the meshes.

    before, after: each a vtkDataSet, a composite data set, a file name or (points, cells). Neither is changed.
    """
    filter_.SetInputDataObject(0, as_mesh(before))
    filter_.SetInputDataObject(1, as_mesh(after))


@sets("compare", "Metrics")
def choose_metrics(filter_: Any, metrics: Metrics = ("imr",)) -> None:
    """Choose the metrics.

    metrics: see quality().
    """
    choose(filter_, metrics).raise_errors()


def compare_result(filter_: Any, mesh: vtkDataObject) -> CompareResult:
    """The result of a filter that has run."""
    table = columns(filter_.GetOutputDataObject(1))
    rows = {name: row for row, name in enumerate(table.pop("Metric", ()))}
    # The table is on the first rank of MPI; the others find the measured metrics by its arrays.
    names = list(rows) or [m["name"] for m in known_metrics() if has_array(mesh, f"{m['name']}_difference", CELLS)]
    return CompareResult(
        mesh=mesh,
        statistics=by_metric({n: {snake(key): table[key][row].item() for key in table} for n, row in rows.items()}),
        difference=by_metric({name: cell_array(mesh, f"{name}_difference") for name in names}),
        change=cell_array(mesh, "Change"),
        displacement=point_array(mesh, "Displacement"),
        summary=filter_.GetSummary(),
    )


# --- the shell ----------------------------------------------------------------------------------------------


def add_compare_options(parser: argparse.ArgumentParser) -> None:
    """Add the meshes, and the option of the metrics."""
    parser.add_argument("before", metavar="BEFORE")
    parser.add_argument("after", metavar="AFTER")
    _commands.add_metrics(parser)


def compare_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """The values of these options."""
    return _commands.given(arguments, ("metrics",))


def finish_compare(arguments: argparse.Namespace, result: CompareResult) -> None:
    """Print the result of the command."""
    _commands.finish(arguments, result, comparison_text(result), comparison_rows(result))
