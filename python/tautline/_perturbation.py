"""The verbs perturb, compare and metric_field."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Sequence

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkDataSet, vtkImageData

import tautline

from ._errors import Error, run, watch
from ._mesh import Mesh, as_mesh, cell_array, columns, point_array, with_array
from ._metrics import Metrics, choose, pick, within
from ._quality import snake

_MOST_THREADS = 1024
_SEEDS = 2**31


@dataclass(frozen=True)
class Perturbed:
    """What perturb() made. Of composite data, the numbers are those of the last block."""

    #: The mesh with other points and the point array `Displacement`; shares the rest with the input.
    mesh: vtkDataObject
    #: New minus old position, n x 3.
    displacement: np.ndarray
    #: Points inside the mesh that were free to move, and those that did.
    movable: int
    moved: int
    #: Inverted elements before and after, and the fraction of the elements the latter are.
    inverted_before: int
    inverted: int
    tangled: float
    #: The longest displacement.
    largest_displacement: float
    #: The result in words.
    summary: str


def perturb(
    mesh: Mesh,
    fraction: float = 0.5,
    percentage: float = 50.0,
    seed: int = 1,
    tangle: float = 0.0,
    fixed: str | Sequence | None = None,
    threads: int = 0,
) -> Perturbed:
    """Move interior points at random, short of inverting an element or past it.

    mesh: a vtkDataSet with explicit points, a file name or (points, cells). It is not changed.
    fraction: how far a point moves at most, as a part of its distance to inversion, 0 to 1.
    percentage: of the interior points to move, 0 to 100.
    seed: another number gives another mesh, the same number the same.
    tangle: fraction of the elements to invert, 0 to 1; with 0 none becomes inverted.
    fixed: points that stay beside the boundary: numbers or truth values, one per point, or the name of a point array.
    threads: 0 is all cores. The result does not depend on it.

    Raises Error for wrong arguments and whatever the filter refuses (quadratic cells, image data).
    """
    data = as_mesh(mesh)
    perturbation = tautline.vtkMeshPerturbation()
    perturbation.SetFraction(within("fraction", fraction, 0, 1))
    perturbation.SetPercentage(within("percentage", percentage, 0, 100))
    perturbation.SetTangledFraction(within("tangle", tangle, 0, 1))
    perturbation.SetSeed(int(within("seed", seed, -_SEEDS, _SEEDS - 1)))
    perturbation.SetThreads(int(within("threads", threads, 0, _MOST_THREADS)))
    own = None
    if fixed is not None:
        own = "fixed points"
        data, name = _with_fixed(data, fixed, own)
        perturbation.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_POINTS, name)
    perturbation.SetInputDataObject(data)
    run(perturbation)
    output = perturbation.GetOutputDataObject(0)
    if own and isinstance(output, vtkDataSet):
        output.GetPointData().RemoveArray(own)
    return Perturbed(
        mesh=output,
        displacement=point_array(output, "Displacement"),
        movable=perturbation.GetNumberOfMovablePoints(),
        moved=perturbation.GetNumberOfMovedPoints(),
        inverted_before=perturbation.GetInvertedBefore(),
        inverted=perturbation.GetInvertedAfter(),
        tangled=perturbation.GetTangledFractionReached(),
        largest_displacement=perturbation.GetLargestDisplacement(),
        summary=perturbation.GetSummary(),
    )


def _with_fixed(data: vtkDataObject, fixed: Any, name: str) -> tuple[vtkDataObject, str]:
    if not isinstance(fixed, str):
        points = data.GetNumberOfPoints()
        if np.shape(fixed) != (points,):
            raise Error(f"fixed has the shape {np.shape(fixed)}; a value for each of the {points} points is expected")
    return with_array(data, fixed, name, points_only=True)[::2]


@dataclass(frozen=True)
class Comparison:
    """What compare() found."""

    #: The second mesh with cell arrays `<metric>_before`, `_after`, `_difference`, `Validity_before`,
    #: `Validity_after`, `Change`, and the point array `Displacement`.
    mesh: vtkDataObject
    #: Per metric: better, worse, equal (numbers of elements), inverted_before, inverted_after,
    #: minimum_before, minimum_after, mean_before, mean_after, maximum_before, maximum_after,
    #: largest_displacement.
    statistics: dict[str, dict[str, Any]]
    #: Per metric, value after minus value before of each cell.
    difference: dict[str, np.ndarray]
    #: Per cell 1 better in some metric and worse in none, -1 the opposite, else 0.
    change: np.ndarray
    #: Second minus first position, n x 3.
    displacement: np.ndarray
    #: The result in words.
    summary: str


def compare(
    before: Mesh,
    after: Mesh,
    metrics: Metrics = ("imr",),
    *,
    tolerance: float = 1e-6,
    threads: int = 0,
) -> Comparison:
    """Tell what changed, element by element, between two meshes with the same cells.

    before, after: each a vtkDataSet, a file name or (points, cells); neither is changed.
    metrics: see quality().
    tolerance: relative difference up to which two values are equal, 0 to 1.
    threads: 0 is all cores. Results do not depend on it.

    Raises Error for wrong arguments and for meshes of different connectivity (it names the first difference).
    """
    comparison = tautline.vtkMeshComparison()
    messages = watch(comparison)
    choose(comparison, metrics)
    messages.raise_errors()
    comparison.SetTolerance(within("tolerance", tolerance, 0, 1))
    comparison.SetThreads(int(within("threads", threads, 0, _MOST_THREADS)))
    comparison.SetInputDataObject(0, as_mesh(before))
    comparison.SetInputDataObject(1, as_mesh(after))
    run(comparison, messages)
    mesh = comparison.GetOutputDataObject(0)
    table = columns(comparison.GetOutputDataObject(1))
    rows = {name: row for row, name in enumerate(table.pop("Metric"))}
    statistics = {n: {snake(key): table[key][row].item() for key in table} for n, row in rows.items()}
    return Comparison(
        mesh=mesh,
        statistics=statistics,
        difference={name: cell_array(mesh, f"{name}_difference") for name in rows},
        change=cell_array(mesh, "Change"),
        displacement=point_array(mesh, "Displacement"),
        summary=comparison.GetSummary(),
    )


@dataclass(frozen=True)
class Field:
    """What metric_field() computed; arrays have the axes [z, y, x], of a triangle [y, x]."""

    #: An image with a point array per metric and `Validity`.
    mesh: vtkImageData
    #: Per metric, its value with the free vertex at each grid point.
    values: dict[str, np.ndarray]
    #: 1 valid, 0 degenerate, -1 inverted.
    validity: np.ndarray


def metric_field(
    metrics: Metrics = ("imr",),
    cell: str = "triangle",
    vertices: Sequence | None = None,
    bounds: Sequence[float] = (-1, 2, 0, 2, 0, 2),
    dimensions: Sequence[int] = (301, 201, 101),
    threads: int = 0,
) -> Field:
    """A metric of one cell as a function of its last vertex, on a grid (Figures 2.1 and 3.1).

    metrics: see quality().
    cell: "triangle" (in the plane z = 0) or "tetrahedron".
    vertices: the fixed ones, 2 x 2 or 2 x 3 of a triangle, 3 x 3 of a tetrahedron; the default is the
        base of the regular cell with edges of length 1 from the origin along x.
    bounds: where the free vertex goes: xmin, xmax, ymin, ymax (and zmin, zmax of a tetrahedron).
    dimensions: grid points along x, y (and z), each at least 1.
    threads: 0 is all cores. The result does not depend on it.

    Raises Error for wrong arguments.
    """
    solid = pick("cell", cell, ("triangle", "tetrahedron"))
    axes = 2 + solid
    source = tautline.vtkMetricField()
    messages = watch(source)
    choose(source, metrics)
    messages.raise_errors()
    source.SetCell(solid)
    if vertices is not None:
        for number, vertex in enumerate(_numbers("vertices", vertices, [(axes, 3), (axes, axes)]), 1):
            getattr(source, f"SetVertex{number}")(*vertex, *[0.0] * (3 - len(vertex)))
    box = _numbers("bounds", bounds, [(6,), (2 * axes,)])
    steps = _numbers("dimensions", dimensions, [(3,), (axes,)])
    if (steps < 1).any() or (steps != np.floor(steps)).any():
        raise Error(f"dimensions are {tuple(dimensions)}; whole numbers from 1 are expected")
    source.SetBounds(*box, *[0.0] * (6 - len(box)))
    source.SetDimensions(*(int(n) for n in steps), *[1] * (3 - len(steps)))
    source.SetThreads(int(within("threads", threads, 0, _MOST_THREADS)))
    run(source, messages)
    image = source.GetOutputDataObject(0)
    shape = image.GetDimensions()[axes - 1 :: -1]
    arrays = image.GetPointData()
    names = [arrays.GetArrayName(i) for i in range(arrays.GetNumberOfArrays())]
    grids = {name: point_array(image, name).reshape(shape) for name in names}
    validity = grids.pop("Validity")
    return Field(mesh=image, values=grids, validity=validity)


def _numbers(option: str, values: Any, shapes: list[tuple[int, ...]]) -> np.ndarray:
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
