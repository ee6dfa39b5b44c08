# SPDX-License-Identifier: BSD-3-Clause
"""The function metric_field: metrics of one cell over the position of its free vertex."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, Sequence, get_args

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkImageData

from . import _commands, _vtk
from ._arguments import pick, set_threads, set_time_limit, within
from ._arrays import Array, point_array
from ._errors import Error, interruptible, run
from ._interrupts import Progress
from ._metrics import Metrics, choose
from ._results import Result

Cell = Literal["triangle", "tetrahedron"]
CELLS: tuple[Cell, ...] = get_args(Cell)


@dataclass(frozen=True, repr=False, eq=False)
class MetricFieldResult(Result):
    """The result of metric_field(). The arrays have the axes [z, y, x]; of a triangle [y, x].

    mesh: an image with a point array per metric and `Validity`.
    values: per metric its value with the free vertex at each grid point.
    validity: with the free vertex at each grid point: 1 valid, 0 degenerate, -1 inverted.
    """

    _per_element: ClassVar[tuple[str, ...]] = ("values", "validity")
    mesh: vtkImageData
    values: dict[str, Array]
    validity: Array


@interruptible
def metric_field(
    metrics: Metrics = ("imr",),
    cell: Cell = "triangle",
    vertices: Sequence[Any] | None = None,
    bounds: Sequence[float] = (-1, 2, 0, 2, 0, 2),
    dimensions: Sequence[int] = (301, 201, 101),
    beta: float = 0.25,
    time_limit: float = 0.0,
    threads: int = 0,
    *,
    progress: Progress | bool | None = None,
) -> MetricFieldResult:
    """Evaluate metrics of one cell over the position of its last vertex, on a grid (Figures 2.1 and 3.1).

    metrics: see quality().
    cell: "triangle" (in the plane z = 0) or "tetrahedron".
    vertices: the fixed vertices: of a triangle 2 x 2 or 2 x 3 coordinates, of a tetrahedron 3 x 3. The default is the
        base of the regular cell with edges of length 1, from the origin along x.
    bounds: range of the free vertex: xmin, xmax, ymin, ymax, and of a tetrahedron zmin, zmax.
    dimensions: number of grid points along x, y, and of a tetrahedron z, each at least 1.
    beta: parameter of the untangling metric, the least area or volume of a valid element, in the unit of the vertices;
        the default is that of Figure 3.1 (e).
    time_limit: seconds; 0 is no limit.
    threads: number of threads; 0 is all cores. The result does not depend on it.

    Raises Error for wrong arguments.

    >>> field = tautline.metric_field("imr", dimensions=(31, 21))
    >>> field.values["imr"][field.validity == 1].min()
    """
    solid = pick("cell", cell, CELLS)
    axes = 2 + solid
    source = _vtk.vtkMetricField()
    messages = choose(source, metrics)
    source.SetCell(solid)
    if vertices is not None:
        for number, vertex in enumerate(_numbers("vertices", vertices, [(axes, 3), (axes, axes)]), 1):
            getattr(source, f"SetVertex{number}")(*vertex, *[0.0] * (3 - len(vertex)))
    box = _numbers("bounds", bounds, [(6,), (2 * axes,)])
    counts = _numbers("dimensions", dimensions, [(3,), (axes,)])
    if (counts < 1).any() or (counts != np.floor(counts)).any():
        raise Error(f"dimensions are {tuple(dimensions)}; whole numbers from 1 are expected")
    source.SetBounds(*box, *[0.0] * (6 - len(box)))
    source.SetDimensions(*(int(n) for n in counts), *[1] * (3 - len(counts)))
    source.SetBeta(within("beta", beta, -np.inf, np.inf))
    set_time_limit(source, time_limit)
    set_threads(source, threads)
    run(source, messages)
    image = source.GetOutputDataObject(0)
    shape = image.GetDimensions()[axes - 1 :: -1]
    arrays = image.GetPointData()
    names = [arrays.GetArrayName(i) for i in range(arrays.GetNumberOfArrays())]
    grids = {name: point_array(image, name).reshape(shape) for name in names}
    validity = grids.pop("Validity")
    return MetricFieldResult(mesh=image, values=grids, validity=validity)


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


def add_commands(commands: Any) -> None:
    """Add `field` to the subparsers of the command line."""
    parser = _commands.add_command(
        commands, "metric-field", _run, "metrics of one cell over the position of its last vertex",
        example="--metrics imr --dimensions 31 21 1 -o field.vti",
        details="Writes an image with an array per metric (dissertation, Figures 2.1 and 3.1).",
        aliases=["field"],
    )
    parser.add_argument("-o", "--output", metavar="FILE.vti", required=True)
    _commands.add_metrics(parser)
    _commands.add_time_limit(parser)
    parser.add_argument("--cell", choices=CELLS, default="triangle")
    parser.add_argument("--vertices", type=_commands.numbers, nargs="+", metavar="X,Y[,Z]",
                        help="the fixed vertices, 2 of a triangle, 3 of a tetrahedron")  # fmt: skip
    parser.add_argument("--bounds", type=float, nargs=6, metavar="X",
                        help="range of the vertex: xmin xmax ymin ymax zmin zmax (default: -1 2 0 2 0 2)")  # fmt: skip
    parser.add_argument("--dimensions", type=int, nargs=3, metavar="N", help="grid points (default: 301 201 101)")
    parser.add_argument("--beta", type=float, default=0.25, help="of the untangling metric (default: %(default)s)")


def _run(arguments: argparse.Namespace) -> None:
    options = {name: value for name in ("vertices", "bounds", "dimensions") if (value := getattr(arguments, name))}
    options |= _commands.given(arguments, ("beta", "time_limit", "threads"))
    result = metric_field(arguments.metrics, arguments.cell, **options)
    lines = []
    for name, values in result.values.items():
        valid = values[result.validity == 1]
        extremes = f"{valid.min():.6g} to {valid.max():.6g}" if valid.size else "no valid position"
        lines.append(f"{name}: {' x '.join(map(str, values.shape[::-1]))} points, {extremes}")
    _commands.finish(arguments, result, "\n".join(lines))
