"""What the verbs take as a mesh, and VTK's arrays as numpy's."""

from __future__ import annotations

from os import PathLike
from typing import Any, Iterator, Mapping, Sequence, Union

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import (
    VTK_HEXAHEDRON,
    VTK_PYRAMID,
    VTK_QUAD,
    VTK_TETRA,
    VTK_TRIANGLE,
    VTK_WEDGE,
    vtkCellArray,
    vtkCompositeDataSet,
    vtkDataObject,
    vtkDataSet,
    vtkUnstructuredGrid,
)

from ._errors import Error

#: What every verb takes as a mesh: a vtkDataSet (or composite data set), a file name, a result of
#: another verb, or (points, cells).
Mesh = Union[vtkDataObject, str, PathLike, "tuple[Any, Any]", Any]

_CELLS = {  # name: VTK's number, points
    "triangle": (VTK_TRIANGLE, 3),
    "quadrilateral": (VTK_QUAD, 4),
    "tetrahedron": (VTK_TETRA, 4),
    "hexahedron": (VTK_HEXAHEDRON, 8),
    "wedge": (VTK_WEDGE, 6),
    "pyramid": (VTK_PYRAMID, 5),
}
_ALIASES = {"tri": "triangle", "quad": "quadrilateral", "tet": "tetrahedron", "hex": "hexahedron"}
# What an array of so many points per cell is of, with points in the plane or in space.
_FLAT = {3: "triangle", 4: "quadrilateral"}
_SOLID = {3: "triangle", 4: "tetrahedron", 5: "pyramid", 6: "wedge", 8: "hexahedron"}


def as_mesh(mesh: Mesh) -> vtkDataObject:
    """The VTK data object of a mesh given in any way; the verbs do not change it.

    Raises Error for anything that is not a mesh.
    """
    if isinstance(mesh, (vtkDataSet, vtkCompositeDataSet)):
        return mesh
    if isinstance(mesh, (str, PathLike)):
        from ._io import read  # which needs this module

        return read(mesh)
    if isinstance(mesh, (tuple, list)) and len(mesh) == 2:
        return from_arrays(*mesh)
    inner = getattr(mesh, "mesh", None)  # a result
    if isinstance(inner, (vtkDataSet, vtkCompositeDataSet)):
        return inner
    raise Error(f"a mesh is a vtkDataSet, a file name or (points, cells), not {type(mesh).__name__}")


def from_arrays(points: Any, cells: Any) -> vtkUnstructuredGrid:
    """A mesh of numpy arrays.

    points: n x 2 or n x 3 coordinates; single precision stays so, all else becomes double.
    cells: m x k point numbers from 0. k = 3 is triangles, 4 tetrahedra (of points in the plane:
    quadrilaterals), 5 pyramids, 6 wedges, 8 hexahedra. Or a dict of such arrays by the name of
    the cell, in VTK's order of points: {"triangle": ..., "quadrilateral": ..., "tetrahedron": ...}.

    Raises Error if a shape, a type or a point number is wrong.
    """
    xyz, flat = _coordinates(points)
    blocks = []
    for name, array in cells.items() if isinstance(cells, Mapping) else [(None, cells)]:
        blocks.append(_block(name, array, flat, len(xyz)))
    grid = vtkUnstructuredGrid()
    vtk_points = vtkPoints()
    vtk_points.SetData(numpy_to_vtk(xyz, deep=True))
    grid.SetPoints(vtk_points)
    types, sizes, ids = [], [0], []
    for kind, block in blocks:
        types.append(np.full(len(block), kind, np.uint8))
        sizes.append(np.full(len(block), block.shape[1], np.int64))
        ids.append(block.ravel())
    if any(len(block) for _, block in blocks):
        connectivity = vtkCellArray()
        connectivity.SetData(
            numpy_to_vtkIdTypeArray(np.cumsum(np.hstack(sizes)), deep=True),
            numpy_to_vtkIdTypeArray(np.hstack(ids), deep=True),
        )
        grid.SetCells(numpy_to_vtk(np.hstack(types), deep=True), connectivity)
    return grid


def _coordinates(points: Any) -> tuple[np.ndarray, bool]:
    try:
        xyz = np.asarray(points)
        xyz = np.ascontiguousarray(xyz, xyz.dtype if xyz.dtype == np.float32 else np.float64)
    except (TypeError, ValueError) as error:
        raise Error(f"points are not an array of numbers: {error}") from None
    if xyz.ndim != 2 or xyz.shape[1] not in (2, 3):
        raise Error(f"points have the shape {xyz.shape}; n x 2 or n x 3 is expected")
    flat = xyz.shape[1] == 2
    return (np.hstack([xyz, np.zeros((len(xyz), 1), xyz.dtype)]) if flat else xyz), flat


def _block(name: str | None, array: Any, flat: bool, points: int) -> tuple[int, np.ndarray]:
    """VTK's cell type and the checked point numbers."""
    try:
        cells = np.asarray(array)
    except ValueError as error:
        raise Error(f"cells are not an array of whole numbers: {error}") from None
    if name is None:
        known = _FLAT if flat else _SOLID
        if cells.ndim != 2 or cells.shape[1] not in known:
            sizes = " or ".join(str(size) for size in known)
            raise Error(f"cells have the shape {cells.shape}; m x {sizes} is expected, or a dict by the cells' names")
        name = known[cells.shape[1]]
    full = _ALIASES.get(name, name)
    if full not in _CELLS:
        raise Error(f"there are no cells '{name}'; there are {', '.join(_CELLS)}")
    kind, size = _CELLS[full]
    if cells.size == 0:
        return kind, np.zeros((0, size), np.int64)
    if cells.ndim != 2 or cells.shape[1] != size:
        raise Error(f"cells '{full}' have the shape {cells.shape}; m x {size} is expected")
    if not np.issubdtype(cells.dtype, np.integer):
        raise Error(f"cells '{full}' are of type {cells.dtype}; whole numbers are expected")
    if cells.min() < 0 or cells.max() >= points:
        raise Error(f"cells '{full}' use the points {cells.min()} to {cells.max()}; there are 0 to {points - 1}")
    return kind, cells.astype(np.int64)


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


def cell_array(data: vtkDataObject, name: str) -> np.ndarray:
    """A cell array by name, of composite data one block after the other."""
    return _array(data, name, "GetCellData")


def point_array(data: vtkDataObject, name: str) -> np.ndarray:
    """A point array by name, of composite data one block after the other."""
    return _array(data, name, "GetPointData")


def _array(data: vtkDataObject, name: str, fields: str) -> np.ndarray:
    found = (getattr(leaf, fields)().GetArray(name) for leaf in leaves(data))
    parts = [vtk_to_numpy(array) for array in found if array]
    return parts[0] if len(parts) == 1 else np.concatenate(parts) if parts else np.zeros(0)


def columns(table: Any) -> dict[str, Any]:
    """The columns of a vtkTable: numpy arrays, of text a list of str."""
    result: dict[str, Any] = {}
    for i in range(table.GetNumberOfColumns()):
        column = table.GetColumn(i)
        if column.IsA("vtkStringArray"):
            result[column.GetName()] = [column.GetValue(k) for k in range(column.GetNumberOfValues())]
        else:
            result[column.GetName()] = vtk_to_numpy(column)
    return result


def with_array(
    data: vtkDataObject, values: str | Sequence, name: str, points_only: bool = False
) -> tuple[vtkDataObject, int, str]:
    """The mesh with an array to process, where it is (vtkDataObject.FIELD_ASSOCIATION_...) and its name.

    values: the name of an array of the mesh (if cells and points both have it, that of the cells), or
    numbers, a row per cell or per point: these go to a shallow copy of the mesh. Raises Error if
    there is no such array or if the number of rows fits neither.
    """
    places = [] if points_only else [(data.FIELD_ASSOCIATION_CELLS, "GetCellData", "GetNumberOfCells")]
    places.append((data.FIELD_ASSOCIATION_POINTS, "GetPointData", "GetNumberOfPoints"))
    if isinstance(values, str):
        for where, fields, _ in places:
            if any(getattr(leaf, fields)().GetArray(values) for leaf in leaves(data)):
                return data, where, values
        raise Error(f"the mesh has no {'point ' if points_only else ''}array '{values}'")
    if not isinstance(data, vtkDataSet):
        raise Error("numbers per cell or point are for a single data set: name an array of the blocks")
    try:
        numbers = np.ascontiguousarray(values, np.float64)
        numbers = numbers.reshape(len(numbers), -1)
    except (TypeError, ValueError) as error:
        raise Error(f"{name}: not an array of numbers: {error}") from None
    copy = data.NewInstance()
    copy.ShallowCopy(data)
    for where, fields, count in places:
        if len(numbers) == getattr(data, count)():
            array = numpy_to_vtk(numbers, deep=True)
            array.SetName(name)
            getattr(copy, fields)().AddArray(array)
            return copy, where, name
    cells, points = data.GetNumberOfCells(), data.GetNumberOfPoints()
    raise Error(f"{name}: {len(numbers)} rows; there are {cells} cells and {points} points")
