# SPDX-License-Identifier: BSD-3-Clause
"""The results of metric() and transfer(), and arguments that are not one property each."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any, ClassVar, Sequence

from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkPolyData

from . import _commands
from ._arguments import picked, sequence, sets, text
from ._arrays import POINTS, Array, InputArrays, Values, columns, point_array, snake, table_rows
from ._choices import METRIC_SOURCES, MetricSource
from ._errors import Error
from ._io import Mesh, as_mesh
from ._results import Result

_SIZES, _FIELD, _DISTANCE = 0, 1, 2  # input arrays of vtkMeshMetric


@dataclass(frozen=True, repr=False, eq=False)
class MetricResult(Result):
    """The result of metric(). For composite data, complexity and elements are sums, sizes extremes.

    Attributes
    ----------
    mesh : vtkDataObject
        The mesh with the point array `Metric`; shares the rest with the input.
    tensors : Array
        The metric tensors, n x 6: xx, yy, zz, xy, yz, xz.
    ellipsoids : vtkPolyData
        Ellipsoids at up to 500 points, with the sizes as diameters; point arrays `Size`, `Anisotropy`, `PointId`.
    complexity : float
        The area or volume as the metric measures it.
    elements : float
        The number of elements with edges of length 1: the complexity times 2.31 for triangles, 8.49 for tetrahedra, 1
        for quadrilaterals and hexahedra.
    smallest_size, largest_size : float
        Extremes of the sizes, in the mesh's unit.
    anisotropy : float
        The largest ratio of two sizes at a point.
    summary : str
        The result in words.
    """

    _per_element: ClassVar[tuple[str, ...]] = ("tensors",)
    mesh: vtkDataObject
    tensors: Array
    ellipsoids: vtkPolyData
    complexity: float
    elements: float
    smallest_size: float
    largest_size: float
    anisotropy: float
    summary: str


@sets("metric", "Source", "SizeArray", "Field", "DistanceArray")
def set_metric_source(
    filter_: Any,
    inputs: InputArrays,
    source: MetricSource | None = None,
    sizes: Values | None = None,
    field: Values | None = None,
    distance: Values | None = None,
) -> None:
    """Set where the tensors come from.

    source: "sizes" (an array of sizes or metric tensors), "hessian" (the smallest interpolation error of a field),
        "curvature" (of the boundary of a volume, of a surface, or of the border of a planar mesh) or "distance" (layers
        at a wall). None: it follows from the array given; without one it is "curvature".
    sizes: for "sizes", a point array (its name, or one row per point): the size at each point, or a metric tensor of
        six or nine components.
    field: for "hessian", a point array (its name, or one row per point): the field whose interpolation error is
        minimized; all components count.
    distance: for "distance", a point array (its name, or one row per point): the distance from the wall. None: it is
        computed.
    """
    given = {"sizes": sizes, "hessian": field, "distance": distance}
    implied = [name for name, values in given.items() if values is not None]
    chosen = picked("source", source, METRIC_SOURCES) if source is not None else (*implied, "curvature")[0]
    wrong = [name for name in implied if name != chosen]
    if wrong:
        raise Error(f"the source is {chosen!r}, and an array for the source {wrong[0]!r} is given: give one of them")
    if chosen in ("sizes", "hessian") and not implied:
        argument = "sizes" if chosen == "sizes" else "field"
        raise Error(f"the source is {chosen!r}: give {argument}, a point array")
    filter_.SetSource(METRIC_SOURCES.index(picked("source", chosen, METRIC_SOURCES)))
    inputs.use(_SIZES, sizes, "sizes", POINTS)
    inputs.use(_FIELD, field, "field", POINTS)
    inputs.use(_DISTANCE, distance, "distance", POINTS, scalar=True)


def metric_result(filter_: Any, output: vtkDataObject) -> MetricResult:
    """The result of a filter that has run."""
    return MetricResult(
        mesh=output,
        tensors=point_array(output, filter_.GetArrayName()),
        ellipsoids=filter_.GetEllipsoids(),
        complexity=filter_.GetComplexity(),
        elements=filter_.GetElements(),
        smallest_size=filter_.GetSmallestFound(),
        largest_size=filter_.GetLargestFound(),
        anisotropy=filter_.GetAnisotropyFound(),
        summary=filter_.GetSummary(),
    )


@dataclass(frozen=True, repr=False, eq=False)
class TransferResult(Result):
    """The result of transfer(). On several MPI ranks each has the arrays of its piece, the first one the totals.

    Attributes
    ----------
    mesh : vtkDataObject
        The target with the arrays of the source; shares the rest with the input.
    totals : list[dict[str, Any]]
        Per component that is averaged: array, data ("point" or "cell"), component, total_before, total_after (integrals
        over the elements), minimum_before, maximum_before, minimum_after, maximum_after, beyond_bounds (how far a value
        is outside the range of the values that it comes from).
    total_error : float
        The largest difference of a total, relative to the integral of the absolute value.
    largest_excess : float
        The largest distance of a value from its bounds, relative to the largest absolute value of the field.
    source_covered, target_covered : float
        The fraction of each mesh that the other one covers, 0 to 1; 0 with "interpolate".
    summary : str
        The result in words.
    """

    mesh: vtkDataObject
    totals: list[dict[str, Any]]
    total_error: float
    largest_excess: float
    source_covered: float
    target_covered: float
    summary: str

    def table(self) -> list[dict[str, Any]]:
        """A row per component, as --csv writes it."""
        return self.totals


def transfer_input(filter_: Any, target: Mesh, source: Mesh) -> None:
    """Set the meshes.

    target: the mesh that gets the arrays. A vtkDataSet, a composite data set, a file name or (points, cells). It is not
        changed.
    source: the mesh with the arrays, given in the same way. Both are planar, surfaces or volumes; all blocks of each
        are one mesh.
    """
    filter_.SetInputDataObject(0, as_mesh(target))
    filter_.SetInputDataObject(1, as_mesh(source))


@sets("transfer", "PointArrays", "CellArrays")
def choose_arrays(
    filter_: Any, point_arrays: Sequence[str] | None = None, cell_arrays: Sequence[str] | None = None
) -> None:
    """Choose the arrays.

    point_arrays, cell_arrays: the names of the arrays of the source to transfer. None for both: all arrays.
    """
    if point_arrays is None and cell_arrays is None:
        return
    names = [sequence("point_arrays", point_arrays or ()), sequence("cell_arrays", cell_arrays or ())]
    if not any(names):
        raise Error("point_arrays and cell_arrays have no name: give one, or leave both out for all arrays")
    for add, chosen in zip((filter_.AddPointArray, filter_.AddCellArray), names):
        for name in chosen:
            add(text("the name of an array", name))


def transfer_result(filter_: Any, output: vtkDataObject) -> TransferResult:
    """The result of a filter that has run."""
    found = {snake(name): column for name, column in columns(filter_.GetTotals()).items()}
    found = {name: column if isinstance(column, list) else column.tolist() for name, column in found.items()}
    found |= {"component": [int(number) for number in found.get("component", ())]}
    return TransferResult(
        mesh=output,
        totals=table_rows(found),
        total_error=filter_.GetTotalError(),
        largest_excess=filter_.GetLargestExcess(),
        source_covered=filter_.GetSourceCovered(),
        target_covered=filter_.GetTargetCovered(),
        summary=filter_.GetSummary(),
    )


# --- the shell ----------------------------------------------------------------------------------------------


def add_metric_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of these arguments."""
    parser.add_argument("--source", choices=METRIC_SOURCES,
                        help="where tensors come from (default: by the array given, or curvature)")  # fmt: skip
    parser.add_argument("--sizes", metavar="ARRAY", help="point array with sizes or metric tensors")
    parser.add_argument("--field", metavar="ARRAY", help="point array whose interpolation error is minimized")
    parser.add_argument("--distance", metavar="ARRAY", help="point array with the distance from the wall")


def metric_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """The values of these options."""
    return _commands.given(arguments, ("source", "sizes", "field", "distance"))


def finish_metric(arguments: argparse.Namespace, result: MetricResult) -> None:
    """Print the result of the command."""
    _commands.finish(arguments, result, result.summary)


def add_transfer_options(parser: argparse.ArgumentParser) -> None:
    """Add the meshes, and the options of the arrays."""
    parser.add_argument("target", metavar="TARGET")
    parser.add_argument("source", metavar="SOURCE")
    for name in ("point", "cell"):
        parser.add_argument(f"--{name}-arrays", type=_commands.names, metavar="NAME,...",
                            help=f"{name} arrays to transfer (default: all arrays)")  # fmt: skip


def transfer_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """The values of these options."""
    return _commands.given(arguments, ("point_arrays", "cell_arrays"))


def finish_transfer(arguments: argparse.Namespace, result: TransferResult) -> None:
    """Print the result of the command."""
    _commands.finish(arguments, result, result.summary, result.totals)
