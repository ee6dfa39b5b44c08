# SPDX-License-Identifier: BSD-3-Clause
"""Arrays and tables of VTK as numpy arrays, and numpy arrays as input arrays of filters."""

from __future__ import annotations

import re
from operator import methodcaller
from typing import Any, Callable, Iterator, NamedTuple, Sequence, Union

import numpy as np
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray, vtkVersion
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkDataSet

from ._errors import Error

#: An array of numbers.
Array = NDArray[Any]

#: The name of an array of the mesh, or numbers, one row per cell or point.
Values = Union[str, Sequence[Any], Array]

#: The association of an array.
ANY, CELLS, POINTS = "any", "cells", "points"

#: Columns of histories that have other names in the results.
_HISTORY_COLUMNS = {"Time (s)": "seconds", "N moving": "moving", "N gradient": "gradient_norm"}
_GIVEN = "given "  # prefix of the names under which arrays of numbers are added to a copy of the mesh


class _Place(NamedTuple):
    """Where a data set has arrays, and how many rows they have."""

    on: str
    association: int
    fields: Callable[[vtkDataSet], Any]
    size: Callable[[vtkDataSet], int]


_PLACES = (
    _Place(
        CELLS,
        vtkDataObject.FIELD_ASSOCIATION_CELLS,
        methodcaller("GetCellData"),
        methodcaller("GetNumberOfCells"),
    ),
    _Place(
        POINTS,
        vtkDataObject.FIELD_ASSOCIATION_POINTS,
        methodcaller("GetPointData"),
        methodcaller("GetNumberOfPoints"),
    ),
)


#: The attribute of mesh objects with the file they come from.
_SOURCE = "source_file"


def source_of(data: Any) -> str:
    """The full name of the file that a mesh, or the mesh that a filter moved, was read from; "" if there is none."""
    return str(getattr(data, _SOURCE, ""))


def keep_source(data: Any, file: str) -> None:
    """Record the file of a mesh; it is not part of the mesh and is not written."""
    if file:
        setattr(data, _SOURCE, file)


def leaves(data: vtkDataObject) -> Iterator[vtkDataSet]:
    """The data set itself, or the blocks of a composite one in order."""
    if isinstance(data, vtkDataSet):
        yield data
        return
    walk = data.NewIterator()
    walk.InitTraversal()
    while not walk.IsDoneWithTraversal():
        if isinstance(walk.GetCurrentDataObject(), vtkDataSet):
            yield walk.GetCurrentDataObject()
        walk.GoToNextItem()


def cell_types(grid: Any) -> Any:
    """The vtkUnsignedCharArray of the types of an unstructured grid's cells, which VTK 9.6 may compute; None if there
    are none.
    """
    computes = (vtkVersion.GetVTKMajorVersion(), vtkVersion.GetVTKMinorVersion()) >= (9, 6)
    stored = grid.GetCellTypes() if computes else grid.GetCellTypesArray()
    if stored is None or stored.IsA("vtkUnsignedCharArray"):
        return stored
    types = vtkUnsignedCharArray()
    types.DeepCopy(stored)
    return types


def cell_array(data: vtkDataObject, name: str) -> Array:
    """A cell array by name; of composite data the blocks concatenated. Empty if there is none."""
    return _array(leaf.GetCellData().GetArray(name) for leaf in leaves(data))


def point_array(data: vtkDataObject, name: str) -> Array:
    """A point array by name; of composite data the blocks concatenated. Empty if there is none."""
    return _array(leaf.GetPointData().GetArray(name) for leaf in leaves(data))


def _array(found: Iterator[Any]) -> Array:
    parts: list[Array] = [vtk_to_numpy(array) for array in found if array]
    return parts[0] if len(parts) == 1 else np.concatenate(parts) if parts else np.zeros(0)


def is_number(value: Any) -> bool:
    """Whether a value is one number, not an array nor the name of one."""
    if value is None or isinstance(value, (str, list, tuple)):
        return False
    return np.ndim(value) == 0


def has_array(data: vtkDataObject, name: str, on: str = ANY) -> bool:
    """Whether a block of the mesh has an array of this name."""
    return any(place.fields(leaf).GetArray(name) for leaf in leaves(data) for place in _PLACES if on in (ANY, place.on))


def columns(table: Any) -> dict[str, Any]:
    """The columns of a vtkTable by name: numpy arrays; of text lists of str."""
    result: dict[str, Any] = {}
    for i in range(table.GetNumberOfColumns()):
        column = table.GetColumn(i)
        if column.IsA("vtkStringArray"):
            result[column.GetName()] = list(map(column.GetValue, range(column.GetNumberOfValues())))
        else:
            result[column.GetName()] = vtk_to_numpy(column)
    return result


def table_rows(columns_by_name: dict[str, Any]) -> list[dict[str, Any]]:
    """The rows of columns of equal length as dicts."""
    return [dict(zip(columns_by_name, row)) for row in zip(*columns_by_name.values())]


def snake(name: str) -> str:
    """A VTK column name in snake case: StandardDeviation is standard_deviation, Quantile01 quantile_01."""
    return re.sub(r"(?<=[a-z])(?=[A-Z0-9])", "_", name).lower()


class InputArrays:
    """The input arrays of a filter. Arrays given as numbers are added to a shallow copy of the mesh.

    >>> inputs = InputArrays(filter_, mesh)
    >>> inputs.use(0, [1.0, 2.0], "size")
    >>> filter_.SetInputDataObject(inputs.mesh)
    >>> inputs.remove_from(filter_.GetOutputDataObject(0))
    """

    def __init__(self, algorithm: Any, mesh: vtkDataObject) -> None:
        self.algorithm, self.mesh = algorithm, mesh
        self._added: list[str] = []
        self._source = source_of(mesh)

    def use(
        self, index: int, values: float | Values | None, name: str, on: str = ANY, *, scalar: bool = False
    ) -> None:
        """Choose array number `index` of the filter; nothing is done for None.

        values: the name of an array of the mesh, or numbers, one row per cell or per point; see with_array().
        name: what the array is, for error messages and for its name in the copy.
        on: POINTS or CELLS for arrays of points or cells only. scalar: one number per row.
        """
        if values is None:
            return
        self.mesh, association, found = with_array(self.mesh, values, name, on, scalar=scalar)
        if not isinstance(values, str):
            self._added.append(found)
        self.algorithm.SetInputArrayToProcess(index, 0, 0, association, found)

    def remove_from(self, output: vtkDataObject) -> vtkDataObject:
        """Remove the added arrays from the output of the filter, which gets the source of the mesh; returns it."""
        keep_source(output, self._source)
        for leaf in leaves(output) if self._added else ():
            for name in self._added:
                leaf.GetPointData().RemoveArray(name)
                leaf.GetCellData().RemoveArray(name)
        return output


def with_array(
    data: vtkDataObject, values: float | Values, name: str, on: str = ANY, *, scalar: bool = False
) -> tuple[vtkDataObject, int, str]:
    """The mesh with an input array, its association (vtkDataObject.FIELD_ASSOCIATION_...) and its name.

    values: the name of an array of the mesh (the cell array if cells and points both have one), or
        numbers, one row per cell or per point, which are added to a shallow copy of the mesh.
    name, on, scalar: see InputArrays.use().

    Raises Error if there is no such array, or if the number of rows does not fit.
    """
    places = [place for place in _PLACES if on in (ANY, place.on)]
    if isinstance(values, str):
        for place in places:
            if any(place.fields(leaf).GetArray(values) for leaf in leaves(data)):
                return data, place.association, values
        raise Error(f"the mesh has no {'' if on == ANY else on[:-1] + ' '}array '{values}'")
    if not isinstance(data, vtkDataSet):
        raise Error("numbers per cell or point are for a single data set: name an array of the blocks")
    try:
        numbers = np.ascontiguousarray(values, np.float64)
        numbers = numbers.reshape(len(numbers), -1)
    except (TypeError, ValueError) as error:
        raise Error(f"{name}: not an array of numbers: {error}") from None
    if scalar and numbers.shape[1] != 1:
        raise Error(f"{name} has the shape {np.shape(values)}; one value per row is expected")
    for place in places:
        if len(numbers) == place.size(data):
            copy = data.NewInstance()
            copy.ShallowCopy(data)
            array = numpy_to_vtk(numbers, deep=True)
            array.SetName(_GIVEN + name)
            place.fields(copy).AddArray(array)
            return copy, place.association, _GIVEN + name
    if on == ANY:
        cells, points = data.GetNumberOfCells(), data.GetNumberOfPoints()
        raise Error(f"{name}: {len(numbers)} rows; there are {cells} cells and {points} points")
    count = places[0].size(data)
    raise Error(f"{name} has the shape {np.shape(values)}; one row for each of the {count} {on} is expected")


def history_of(filter_: Any) -> dict[str, Any]:
    """The history of a filter that moves points: iteration, objective, inverted, moving, seconds, ..."""
    table = columns(filter_.GetHistory())
    found = {_HISTORY_COLUMNS.get(name, name.lower().replace(" ", "_")): column for name, column in table.items()}
    rows = len(found.get("objective", ()))
    blocks = found.get("block", [""] * rows)
    iteration = [row - blocks.index(blocks[row]) for row in range(rows)]
    history = {"iteration": np.array(iteration, int), **found}
    for name in ("inverted", "moving"):
        history[name] = np.asarray(history.get(name, ())).astype(int)
    return history
