# SPDX-License-Identifier: BSD-3-Clause
"""Meshes from numpy arrays."""

from __future__ import annotations

from typing import Any, Mapping

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import (
    VTK_HEXAHEDRON,
    VTK_PYRAMID,
    VTK_QUAD,
    VTK_TETRA,
    VTK_TRIANGLE,
    VTK_WEDGE,
    vtkCellArray,
    vtkUnstructuredGrid,
)

from ._arrays import Array
from ._errors import Error, checked
from ._grid_checks import check_block

_CELLS = {  # name: VTK's cell type, number of points
    "triangle": (VTK_TRIANGLE, 3),
    "quadrilateral": (VTK_QUAD, 4),
    "tetrahedron": (VTK_TETRA, 4),
    "hexahedron": (VTK_HEXAHEDRON, 8),
    "wedge": (VTK_WEDGE, 6),
    "pyramid": (VTK_PYRAMID, 5),
}
_ALIASES = {"tri": "triangle", "quad": "quadrilateral", "tet": "tetrahedron", "hex": "hexahedron"}
# The cell of an array without a name, by its number of points, for points with 2 and with 3 coordinates.
_FLAT = {3: "triangle", 4: "quadrilateral"}
_SOLID = {3: "triangle", 4: "tetrahedron", 5: "pyramid", 6: "wedge", 8: "hexahedron"}


@checked
def from_arrays(points: Any, cells: Any) -> vtkUnstructuredGrid:
    """Make a mesh from numpy arrays.

    points: coordinates, n x 2 or n x 3. Single precision is kept; other types are converted to double.
    cells: point numbers from 0, m x k, in VTK's order. k = 3 are triangles, 4 tetrahedra (with n x 2 points:
        quadrilaterals), 5 pyramids, 6 wedges, 8 hexahedra. For mixed cells a dict of such arrays by the name of the
        cell: "triangle", "quadrilateral", "tetrahedron", "hexahedron", "wedge", "pyramid".

    Raises Error if a shape, a type or a point number is wrong.

    >>> mesh = tautline.from_arrays([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]])
    """
    xyz, flat = _coordinates(points)
    blocks = []
    for name, array in cells.items() if isinstance(cells, Mapping) else [(None, cells)]:
        blocks.append(_block(name, array, flat, len(xyz)))
    grid = vtkUnstructuredGrid()
    vtk_points = vtkPoints()
    vtk_points.SetData(numpy_to_vtk(xyz, deep=True))
    grid.SetPoints(vtk_points)
    types: list[Array] = []
    sizes: list[Any] = [0]
    ids: list[Array] = []
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


def _block(name: str | None, array: Any, flat: bool, points: int) -> tuple[int, Array]:
    """VTK's cell type and the point numbers, m x k, after checks of shape, type and range."""
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
    full = _ALIASES.get(name, name)
    if full not in _CELLS:
        raise Error(f"there are no cells '{name}'; there are {', '.join(_CELLS)}")
    kind, size = _CELLS[full]
    return kind, check_block(full, cells, size, points)
