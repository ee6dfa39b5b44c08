# SPDX-License-Identifier: BSD-3-Clause
"""Points, cells and arrays of meshes as numpy arrays: the attributes that the meshes of the package have."""

from __future__ import annotations

from collections.abc import MutableMapping
from typing import Any, Callable, Iterator, TypeVar

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import (
    vtkImageData,
    vtkPointSet,
    vtkPolyData,
    vtkRectilinearGrid,
    vtkStructuredGrid,
    vtkUnstructuredGrid,
)
from vtkmodules.vtkFiltersCore import vtkAppendFilter

from ._arrays import Array, cell_types, keep_source, source_of
from ._cell_names import CELLS, CELLS_BY_NUMBER, find_cell
from ._errors import Error, MissingKey, run
from ._tables import many

Value = TypeVar("Value")

#: Cells of images, by VTK's number: the equivalent cells of other meshes, and the order of their points.
_REGULAR = {8: (9, [0, 1, 3, 2]), 11: (12, [0, 1, 3, 2, 4, 5, 7, 6])}


class NamedDict(dict[str, Value]):
    """A dict whose keys are also found by their other names, such as the aliases of metrics."""

    #: Returns the key for a name, or None, given all keys.
    _find: Callable[[str, list[str]], str | None]
    #: The kind of the keys, for messages.
    _what: str

    def __init__(self, values: Any, find: Callable[[str, list[str]], str | None], what: str) -> None:
        super().__init__(values)
        self._find, self._what = find, what

    def __missing__(self, key: Any) -> Value:
        found = self._find(key, list(self)) if isinstance(key, str) else None
        if found is None:
            raise MissingKey(self._what, key, self)
        return self[found]

    def __contains__(self, key: object) -> bool:
        if super().__contains__(key):
            return True
        return isinstance(key, str) and self._find(key, list(self)) is not None

    def get(self, key: Any, default: Any = None) -> Any:
        """The value of a key or of another name of it; otherwise the default."""
        return self[key] if key in self else default

    def __reduce__(self) -> Any:
        return type(self), (dict(self), self._find, self._what)

    def like(self, values: dict[str, Any]) -> NamedDict[Any]:
        """A dict of other values with the same names."""
        return NamedDict(values, self._find, self._what)


class Arrays(MutableMapping[str, Any]):
    """The point arrays or the cell arrays of a mesh by name: numpy arrays that share memory with it.

    An assignment adds or replaces an array, which is copied, of one row per point or cell; `del` removes one. Arrays
    of texts are lists of str.
    """

    def __init__(self, fields: Any, rows: int, what: str) -> None:
        self._fields, self._rows, self._what = fields, rows, what

    def __getitem__(self, name: str) -> Any:
        found = self._fields.GetAbstractArray(name) if isinstance(name, str) else None
        if found is None:
            raise MissingKey(self._what, name, self)
        if found.IsA("vtkDataArray"):
            return vtk_to_numpy(found)
        return [str(found.GetVariantValue(i)) for i in range(found.GetNumberOfValues())]

    def __setitem__(self, name: str, values: Any) -> None:
        if not isinstance(name, str) or not name:
            raise Error(f"the name of an array is {name!r}; a text is expected")
        try:
            numbers = np.ascontiguousarray(values)
            numbers = numbers.astype(np.uint8) if numbers.dtype == bool else numbers
            numbers = numbers.reshape(len(numbers), -1) if numbers.ndim > 2 else numbers
        except (TypeError, ValueError) as error:
            raise Error(f"{self._what} {name!r}: not an array of numbers: {error}") from None
        if numbers.dtype.kind not in "iuf":
            raise Error(f"{self._what} {name!r}: not an array of numbers, but of {numbers.dtype}")
        if np.shape(values) == () or len(numbers) != self._rows:
            raise Error(f"{self._what} {name!r} has the shape {np.shape(values)}; {self._rows} rows are expected")
        array = numpy_to_vtk(numbers, deep=True)
        array.SetName(name)
        self._fields.AddArray(array)

    def __delitem__(self, name: str) -> None:
        if name not in self:
            raise MissingKey(self._what, name, self)
        self._fields.RemoveArray(name)

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and bool(self._fields.HasArray(name))

    def __iter__(self) -> Iterator[str]:
        names = (self._fields.GetArrayName(i) for i in range(self._fields.GetNumberOfArrays()))
        return iter([name for name in names if name])

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def __repr__(self) -> str:
        facts = [f"{name!r}: {getattr(self[name], 'dtype', 'text')} {np.shape(self[name])}" for name in self]
        return f"{{{', '.join(facts)}}}"


def points_of(mesh: Any) -> Array:
    """The coordinates of the points, n x 3.

    They share memory with the mesh; for images and rectilinear grids, which have none, they are a read-only copy.
    """
    if isinstance(mesh, vtkPointSet) or mesh.IsA("vtkPointSet"):
        return np.asarray(vtk_to_numpy(mesh.GetPoints().GetData())) if mesh.GetPoints() else np.zeros((0, 3))
    return np.asarray(_fixed(vtk_to_numpy(_as_grid(mesh).GetPoints().GetData())))


def cells_of(mesh: Any) -> NamedDict[Any]:
    """The numbers of the points of the cells, from 0, by the name of the cell: m x k in VTK's order.

    An array shares memory with the mesh where the cells of its type follow each other in an unstructured grid,
    otherwise it is a read-only copy. Cells without a fixed number of points (polygons, polyhedra) are a list of arrays.
    """
    if not mesh.IsA("vtkUnstructuredGrid"):
        found = _cells(_as_grid(mesh))
        return _named_cells({name: _fixed(cells) for name, cells in found.items()})
    return _named_cells(_cells(mesh))


def point_data_of(mesh: Any) -> Arrays:
    """The point arrays by name."""
    return Arrays(mesh.GetPointData(), mesh.GetNumberOfPoints(), "point array")


def cell_data_of(mesh: Any) -> Arrays:
    """The cell arrays by name."""
    return Arrays(mesh.GetCellData(), mesh.GetNumberOfCells(), "cell array")


def _named_cells(found: dict[str, Any]) -> NamedDict[Any]:
    return NamedDict(found, find_cell, "cell type")


def _fixed(array: Any) -> Any:
    """An array, or a list of arrays, that cannot be written to."""
    for part in array if isinstance(array, list) else [array]:
        part.flags.writeable = False
    return array


def _as_grid(mesh: Any) -> vtkUnstructuredGrid:
    append = vtkAppendFilter()
    append.AddInputData(mesh)
    run(append)
    return append.GetOutput()


def _cells(grid: Any) -> dict[str, Any]:
    types = cell_types(grid)
    if types is None or not types.GetNumberOfTuples():
        return {}
    kinds = vtk_to_numpy(types).ravel()
    ids = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    offsets = vtk_to_numpy(grid.GetCells().GetOffsetsArray())
    numbers, first = np.unique(kinds, return_index=True)
    found: dict[str, Any] = {}
    for kind in numbers[np.argsort(first)].tolist():
        target, order = _REGULAR.get(kind, (kind, None))
        name = CELLS_BY_NUMBER.get(target, f"type {target}")
        cells = np.flatnonzero(kinds == kind)
        if name not in CELLS:
            cell_ids = [ids[offsets[cell] : offsets[cell + 1]] for cell in cells]
            found[name] = cell_ids
            continue
        size = CELLS[name][1]
        block = _block(ids, offsets, cells, size)
        block = block if order is None else _fixed(block[:, order])
        found[name] = _fixed(np.concatenate([found[name], block])) if name in found else block
    return found


def _block(ids: Array, offsets: Array, cells: Array, size: int) -> Array:
    """The points of cells of one type: a part of the array of all cells where they follow each other in it."""
    if cells[-1] - cells[0] + 1 == len(cells):
        return ids[offsets[cells[0]] : offsets[cells[-1] + 1]].reshape(-1, size)
    return np.asarray(_fixed(ids[offsets[cells][:, None] + np.arange(size)]))


class MeshViews:
    """Attributes of the package's meshes besides the methods of VTK's classes."""

    #: Whether the points may have been modified, which would make the bounds that VTK caches stale.
    _points_taken = False

    def refresh(self) -> None:
        """Make VTK compute the bounds again if the points may have been modified."""
        if self._points_taken and isinstance(self, vtkPointSet) and self.GetPoints():
            self.GetPoints().Modified()

    @property
    def points(self) -> Array:
        """The coordinates of the points, n x 3; they share memory with the mesh.

        For images and rectilinear grids, which have none, they are a read-only copy.
        """
        self._points_taken = True
        return points_of(self)

    @points.setter
    def points(self, xyz: Any) -> None:
        mesh: Any = self
        if not isinstance(self, vtkPointSet):
            raise Error(f"the points of a {mesh.GetClassName()} follow from its grid and cannot be replaced")
        try:
            found = np.array(xyz, dtype=None if getattr(xyz, "dtype", None) == np.float32 else float, order="C")
        except (TypeError, ValueError) as error:
            raise Error(f"points are not an array of numbers: {error}") from None
        if found.shape != (mesh.GetNumberOfPoints(), 3):
            raise Error(f"points have the shape {found.shape}; {mesh.GetNumberOfPoints()} x 3 is expected")
        points = vtkPoints()
        points.SetData(numpy_to_vtk(found, deep=True))
        mesh.SetPoints(points)

    @property
    def cells(self) -> NamedDict[Any]:
        """The numbers of the points of the cells, from 0, by the name of the cell: m x k in VTK's order.

        An array shares memory with the mesh where the cells of its type follow each other in an unstructured grid,
        otherwise it is a read-only copy. Cells without a fixed number of points (polygons, polyhedra) are a list of
        arrays.
        """
        return cells_of(self)

    @property
    def point_data(self) -> Arrays:
        """The point arrays by name; they share memory with the mesh. An assignment adds one."""
        return point_data_of(self)

    @property
    def cell_data(self) -> Arrays:
        """The cell arrays by name; they share memory with the mesh. An assignment adds one."""
        return cell_data_of(self)

    def __repr__(self) -> str:
        mesh: Any = self
        kinds = ", ".join(f"{len(cells)} {many(name, len(cells))}" for name, cells in self.cells.items())
        lines = [f"{mesh.GetClassName()}: {mesh.GetNumberOfPoints()} points, {mesh.GetNumberOfCells()} cells"]
        lines[0] += f" ({kinds})" if kinds else ""
        for what, fields in (("point arrays", self.point_data), ("cell arrays", self.cell_data)):
            lines += [f"{what}: {', '.join(fields)}"] if len(fields) else []
        return "\n".join(lines)

    __str__ = __repr__  # VTK's is a hundred lines


class _UnstructuredGrid(MeshViews, vtkUnstructuredGrid):  # type: ignore[misc]
    pass


class _PolyData(MeshViews, vtkPolyData):  # type: ignore[misc]
    pass


class _StructuredGrid(MeshViews, vtkStructuredGrid):  # type: ignore[misc]
    pass


class _RectilinearGrid(MeshViews, vtkRectilinearGrid):  # type: ignore[misc]
    pass


class _ImageData(MeshViews, vtkImageData):  # type: ignore[misc]
    pass


_CLASSES: dict[str, Any] = {
    made.__name__.replace("_", "vtk"): made
    for made in (_UnstructuredGrid, _PolyData, _StructuredGrid, _RectilinearGrid, _ImageData)
}


def viewed(data: Any) -> Any:
    """A mesh as one with numpy arrays as attributes, which shares all its arrays; other data as they are."""
    kind = _CLASSES.get(data.GetClassName()) if hasattr(data, "GetClassName") else None
    if kind is None or isinstance(data, MeshViews):
        return data
    made = kind()
    made.ShallowCopy(data)
    keep_source(made, source_of(data))
    return made
