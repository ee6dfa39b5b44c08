# SPDX-License-Identifier: BSD-3-Clause
"""Meshes from numpy arrays."""

from __future__ import annotations

from typing import Any, Mapping

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_POLYGON, vtkCellArray, vtkUnstructuredGrid

from ._arrays import Array
from ._cell_names import CELLS, find_cell
from ._errors import Error, checked, nearest
from ._grid_checks import check_block
from ._meshio import in_vtk_order
from ._views import viewed

_POLYGON = "polygon"
# The cell of an array without a name, by its number of points, for points with 2 and with 3 coordinates.
_FLAT = {3: "triangle", 4: "quadrilateral"}
_SOLID = {3: "triangle", 4: "tetrahedron", 5: "pyramid", 6: "wedge", 8: "hexahedron"}


@checked
def from_arrays(points: Any, cells: Any) -> vtkUnstructuredGrid:
    """Make a mesh from numpy arrays.

    Parameters
    ----------
    points : Any
        Coordinates, n x 2 or n x 3. Single precision is kept; other types are converted to double.
    cells : Any
        Point numbers from 0, m x k, in VTK's order. k = 3 are triangles, 4 tetrahedra (with n x 2 points:
        quadrilaterals), 5 pyramids, 6 wedges, 8 hexahedra. For mixed cells a dict of such arrays by the name of the
        cell: "triangle", "quadrilateral", "tetrahedron", "hexahedron", "wedge", "pyramid" or a name of meshio ("tetra",
        "tetra10"), "polygon" with a list of lists; or, as meshio has them, a list of pairs (name, array), whose wedges
        are in meshio's order.

    Returns
    -------
    vtkUnstructuredGrid
        A vtkUnstructuredGrid with the attributes points, cells, point_data and cell_data.

    Raises
    ------
    Error
        If a shape, a type or a point number is wrong.

    Examples
    --------
    >>> mesh = tautline.from_arrays([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]])
    """
    xyz, flat = _coordinates(points)
    blocks = [_block(name, array, flat, len(xyz)) for name, array in _named(cells)]
    grid = vtkUnstructuredGrid()
    vtk_points = vtkPoints()
    vtk_points.SetData(numpy_to_vtk(xyz, deep=True))
    grid.SetPoints(vtk_points)
    types: list[Array] = []
    sizes: list[Any] = [0]
    ids: list[Array] = []
    for kind, block in blocks:
        rows = block if isinstance(block, list) else [block]
        types += [np.full(len(part), kind, np.uint8) for part in rows]
        sizes += [np.full(len(part), part.shape[1], np.int64) for part in rows]
        ids += [part.ravel() for part in rows]
    if any(len(part) for part in types):
        connectivity = vtkCellArray()
        connectivity.SetData(
            numpy_to_vtkIdTypeArray(np.cumsum(np.hstack(sizes)), deep=True),
            numpy_to_vtkIdTypeArray(np.hstack(ids), deep=True),
        )
        grid.SetCells(numpy_to_vtk(np.hstack(types), deep=True), connectivity)
    made: vtkUnstructuredGrid = viewed(grid)
    return made


def _named(cells: Any) -> list[tuple[str | None, Any]]:
    """Pairs of the name of a cell, None if it has none, and an array."""
    if isinstance(cells, Mapping):
        return [(_cell(name), array) for name, array in cells.items()]
    if not isinstance(cells, (list, tuple)) or not cells or not all(map(_is_block, cells)):
        return [(None, cells)]
    pairs = [(block.type, block.data) if hasattr(block, "data") else tuple(block) for block in cells]
    found = [(_cell(name), array) for name, array in pairs]
    return [(name, in_vtk_order(name, array)) for name, array in found]


def _is_block(block: Any) -> bool:
    """Whether this is a pair (name, array), or a block of cells of meshio."""
    pair = isinstance(block, (list, tuple)) and len(block) == 2 and isinstance(block[0], str)
    return pair or (hasattr(block, "type") and hasattr(block, "data"))


def _cell(name: Any) -> str:
    """The name of the package of a cell."""
    found = find_cell(name, [*CELLS, _POLYGON]) if isinstance(name, str) else None
    if found is None:
        raise Error(f"there are no cells {name!r}{nearest(str(name), CELLS)}; there are {', '.join(CELLS)}, {_POLYGON}")
    return found


def _coordinates(points: Any) -> tuple[Array, bool]:
    try:
        xyz = np.asarray(points)
        xyz = np.ascontiguousarray(xyz, xyz.dtype if xyz.dtype == np.float32 else np.float64)
    except (TypeError, ValueError) as error:
        raise Error(f"points are not an array of numbers: {error}") from None
    if xyz.ndim != 2 or xyz.shape[1] not in (2, 3):
        raise Error(f"points have the shape {xyz.shape}; n x 2 or n x 3 is expected")
    flat = xyz.shape[1] == 2
    return (np.hstack([xyz, np.zeros((len(xyz), 1), xyz.dtype)]) if flat else xyz), flat


def _block(name: str | None, array: Any, flat: bool, points: int) -> tuple[int, Any]:
    """VTK's cell type and the point numbers, m x k, after checks of shape, type and range; of polygons a list."""
    if name == _POLYGON:
        if not isinstance(array, (list, tuple, np.ndarray)) or not all(np.ndim(cell) == 1 for cell in array):
            raise Error("polygons are a list of lists of point numbers")
        rows = [np.atleast_2d(np.asarray(cell)) for cell in array]
        if any(row.shape[1] < 3 for row in rows):
            raise Error("a polygon has fewer than three points")
        return VTK_POLYGON, [check_block(name, row, row.shape[1], points) for row in rows]
    try:
        cells = np.asarray(array)
    except ValueError as error:
        raise Error(f"cells are not an array of whole numbers: {error}") from None
    if name is None:
        known = _FLAT if flat else _SOLID
        if cells.ndim != 2 or cells.shape[1] not in known:
            sizes = " or ".join(str(size) for size in known)
            raise Error(f"cells have the shape {cells.shape}; m x {sizes} is expected, or a dict by names of cells")
        name = known[cells.shape[1]]
    kind, size = CELLS[name]
    return kind, check_block(name, cells, size, points)
