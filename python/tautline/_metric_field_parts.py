# SPDX-License-Identifier: BSD-3-Clause
"""The result of metric_field(), and its arguments that are not one property each."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any, ClassVar, Sequence

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkImageData

from . import _commands
from ._arguments import pick, sets
from ._arrays import Array, point_array
from ._choices import METRIC_FIELD_CELLS
from ._errors import Error
from ._metrics import Metrics, by_metric, choose
from ._results import Result


@dataclass(frozen=True, repr=False, eq=False)
class MetricFieldResult(Result):
    """The result of metric_field(). The arrays have the axes [z, y, x]; for a triangle [y, x].

    Attributes
    ----------
    mesh : vtkImageData
        An image with a point array per metric and `Validity`.
    values : dict[str, Array]
        Per metric its value with the free vertex at each grid point.
    validity : Array
        With the free vertex at each grid point: 1 valid, 0 degenerate, -1 inverted.
    """

    _per_element: ClassVar[tuple[str, ...]] = ("values", "validity")
    mesh: vtkImageData
    values: dict[str, Array]
    validity: Array


@sets("metric_field", "Metrics")
def choose_metrics(filter_: Any, metrics: Metrics = ("imr",)) -> None:
    """Choose the metrics.

    metrics: see quality().
    """
    choose(filter_, metrics).raise_errors()


@sets("metric_field", "Vertex1", "Vertex2", "Vertex3")
def set_vertices(filter_: Any, vertices: Sequence[Any] | None = None, *, cell: str) -> None:
    """Set the fixed vertices.

    vertices: the fixed vertices: for a triangle 2 x 2 or 2 x 3 coordinates, for a tetrahedron 3 x 3. The default is the
        base of the regular cell with edges of length 1, from the origin along x.
    """
    axes = _axes(cell)
    if vertices is not None:
        for number, vertex in enumerate(_numbers("vertices", vertices, [(axes, 3), (axes, axes)]), 1):
            getattr(filter_, f"SetVertex{number}")(*vertex, *[0.0] * (3 - len(vertex)))


@sets("metric_field", "Bounds", "Dimensions")
def set_grid(
    filter_: Any,
    bounds: Sequence[float] = (-1, 2, 0, 2, 0, 2),
    dimensions: Sequence[int] = (301, 201, 101),
    *,
    cell: str,
) -> None:
    """Set the grid.

    bounds: range of the free vertex: xmin, xmax, ymin, ymax, and for a tetrahedron zmin, zmax.
    dimensions: number of grid points along x, y, and for a tetrahedron z, each at least 1.
    """
    axes = _axes(cell)
    box = _numbers("bounds", bounds, [(6,), (2 * axes,)])
    counts = _numbers("dimensions", dimensions, [(3,), (axes,)])
    if (counts < 1).any() or (counts != np.floor(counts)).any():
        raise Error(f"dimensions are {tuple(dimensions)}; whole numbers from 1 are expected")
    filter_.SetBounds(*box, *[0.0] * (6 - len(box)))
    filter_.SetDimensions(*(int(n) for n in counts), *[1] * (3 - len(counts)))


def _axes(cell: str) -> int:
    return 2 + pick("cell", cell, METRIC_FIELD_CELLS)


def metric_field_result(filter_: Any, image: vtkImageData) -> MetricFieldResult:
    """The result of a source that has run."""
    shape = image.GetDimensions()[1 + filter_.GetCell() :: -1]
    arrays = image.GetPointData()
    names = [arrays.GetArrayName(i) for i in range(arrays.GetNumberOfArrays())]
    grids = {name: point_array(image, name).reshape(shape) for name in names}
    validity = grids.pop("Validity")
    return MetricFieldResult(mesh=image, values=by_metric(grids), validity=validity)


def _numbers(option: str, values: Any, shapes: list[tuple[int, ...]]) -> Array:
    """The values as an array of one of the shapes."""
    try:
        numbers = np.asarray(values, float)
    except (TypeError, ValueError):
        raise Error(f"{option} are not numbers: {values!r}") from None
    if numbers.shape not in shapes:
        expected = " or ".join(" x ".join(map(str, shape)) for shape in dict.fromkeys(shapes))
        raise Error(f"{option} have the shape {numbers.shape}; {expected} is expected")
    if not np.isfinite(numbers).all():
        raise Error(f"{option} are not finite: {values!r}")
    return numbers


# --- the shell ----------------------------------------------------------------------------------------------


def add_metric_field_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of these arguments."""
    _commands.add_metrics(parser)
    parser.add_argument("--vertices", type=_commands.numbers, nargs="+", metavar="X,Y[,Z]",
                        help="the fixed vertices, 2 for a triangle, 3 for a tetrahedron")  # fmt: skip
    parser.add_argument("--bounds", type=float, nargs=6, metavar="X",
                        help="range of the vertex: xmin xmax ymin ymax zmin zmax (default: -1 2 0 2 0 2)")  # fmt: skip
    parser.add_argument("--dimensions", type=int, nargs=3, metavar="N", help="grid points (default: 301 201 101)")


def metric_field_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """The values of these options."""
    options = _commands.given(arguments, ("metrics", "vertices", "bounds", "dimensions"))
    return {name: value for name, value in options.items() if value}


def finish_metric_field(arguments: argparse.Namespace, result: MetricFieldResult) -> None:
    """Print the result of the command."""
    lines = []
    for name, values in result.values.items():
        valid = values[result.validity == 1]
        extremes = f"{valid.min():.6g} to {valid.max():.6g}" if valid.size else "no valid position"
        lines.append(f"{name}: {' x '.join(map(str, values.shape[::-1]))} points, {extremes}")
    _commands.finish(arguments, result, "\n".join(lines))
