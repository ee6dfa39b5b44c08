# SPDX-License-Identifier: BSD-3-Clause
"""Checks whether a data set is a valid mesh; empty meshes that writers accept.

VTK's data sets hold whatever a reader or a script puts into them; filters and writers that trust them read beyond the
end of arrays.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import (
    vtkCellArray,
    vtkDataObject,
    vtkDataSet,
    vtkDataSetAttributes,
    vtkPointSet,
    vtkPolyData,
    vtkUnstructuredGrid,
)

from ._arrays import Array, cell_types
from ._errors import Error

#: The number of points of each type of cells that has a fixed one, by VTK's number.
POINTS_OF_TYPE = {
    0: 0, 1: 1, 3: 2, 5: 3, 8: 4, 9: 4, 10: 4, 11: 8, 12: 8, 13: 6, 14: 5, 15: 10, 16: 12, 21: 3, 22: 6, 23: 8, 24: 10,
    25: 20, 26: 15, 27: 13, 28: 9, 29: 27, 30: 6, 31: 12, 32: 18, 33: 24, 34: 7, 35: 4, 37: 19,
}  # fmt: skip
#: The least number of points of the other types; Lagrange and Bezier cells of order 1 have as many as the linear cell.
_LEAST_POINTS = dict.fromkeys(range(51, 68), 0) | {2: 1, 4: 2, 6: 3, 7: 3, 36: 3, 41: 1, 42: 4} | {
    first + i: least for first in (68, 75) for i, least in enumerate((2, 3, 4, 4, 8, 6, 5))
}
#: The lists of cells of a vtkPolyData.
POLY_LISTS = ("vertices", "lines", "polygons", "triangle_strips")


def check_grid(mesh: vtkDataObject, name: str = "") -> None:
    """Raise Error if a cell has points that do not exist, or another number of points than its type needs.

    name: of the file, for the message. Data sets of other kinds (images, structured grids) have no cells of their own.
    """
    prefix = f"{name}: " if name else ""
    for section, cells in cell_lists(mesh).items():
        _check_cells(prefix + section.upper(), cells, mesh.GetNumberOfPoints())
    if isinstance(mesh, vtkUnstructuredGrid) and mesh.GetCells():
        _check_types(prefix, mesh)
    if isinstance(mesh, vtkDataSet):
        _check_fields(f"{prefix}the point array", mesh.GetPointData(), mesh.GetNumberOfPoints(), "points")
        _check_fields(f"{prefix}the cell array", mesh.GetCellData(), mesh.GetNumberOfCells(), "cells")


def cell_lists(mesh: vtkDataObject) -> dict[str, vtkCellArray]:
    """The lists of cells by the name of their section in a legacy VTK file."""
    if isinstance(mesh, vtkUnstructuredGrid):
        return {"cells": mesh.GetCells()} if mesh.GetCells() else {}
    if isinstance(mesh, vtkPolyData):
        return dict(zip(POLY_LISTS, (mesh.GetVerts(), mesh.GetLines(), mesh.GetPolys(), mesh.GetStrips())))
    return {}


def _check_cells(title: str, cells: vtkCellArray, points: int) -> None:
    ids = vtk_to_numpy(cells.GetConnectivityArray())
    if ids.size and (ids.min() < 0 or ids.max() >= points):
        raise Error(f"{title} has the points {ids.min()} to {ids.max()}; there are {points} points")
    offsets = vtk_to_numpy(cells.GetOffsetsArray())
    if offsets.size and (offsets[0] != 0 or offsets[-1] != ids.size or (np.diff(offsets) < 0).any()):
        raise Error(f"the offsets of {title} are not in order, or not as many as points")


def _check_types(prefix: str, grid: vtkUnstructuredGrid) -> None:
    found = cell_types(grid)
    count = found.GetNumberOfTuples() if found else 0
    if count != grid.GetCells().GetNumberOfCells():
        raise Error(f"{prefix}there are {count} types of {grid.GetCells().GetNumberOfCells()} cells")
    if not count:
        return
    types = vtk_to_numpy(found).ravel()
    sizes = np.diff(vtk_to_numpy(grid.GetCells().GetOffsetsArray()))
    for kind in np.unique(types):
        own = sizes[types == kind]
        fixed, least = POINTS_OF_TYPE.get(int(kind)), _LEAST_POINTS.get(int(kind))
        wrong = own != fixed if fixed is not None else own < least if least is not None else np.ones(own.size, bool)
        if wrong.any():
            cell = int(np.flatnonzero(types == kind)[wrong][0])
            needs = str(fixed) if fixed is not None else f"at least {least}" if least is not None else None
            if needs is None:
                raise Error(f"{prefix}cell {cell} is of the type {kind}, which VTK does not have")
            raise Error(f"{prefix}cell {cell} has {sizes[cell]} points; its type {kind} needs {needs}")


def _check_fields(title: str, fields: Any, count: int, things: str) -> None:
    for i in range(fields.GetNumberOfArrays()):
        array = fields.GetAbstractArray(i)
        if array and array.GetNumberOfTuples() != count:
            raise Error(f"{title} '{array.GetName()}' has {array.GetNumberOfTuples()} rows; there are {count} {things}")


def same_cells(one: vtkDataSet, other: vtkDataSet) -> bool:
    """Whether two data sets have as many points, and the same cells in the same order."""
    if one.GetNumberOfPoints() != other.GetNumberOfPoints() or one.GetNumberOfCells() != other.GetNumberOfCells():
        return False
    lists, others = cell_lists(one), cell_lists(other)
    if lists.keys() != others.keys():
        return False
    for key, cells in lists.items():
        for part in ("GetOffsetsArray", "GetConnectivityArray"):
            mine, its = (vtk_to_numpy(getattr(which, part)()) for which in (cells, others[key]))
            if not np.array_equal(mine, its):
                return False
    if isinstance(one, vtkUnstructuredGrid):
        kinds = [vtk_to_numpy(found).ravel() if (found := cell_types(mesh)) else [] for mesh in (one, other)]
        return np.array_equal(*kinds)
    return True


def check_block(kind: str, cells: Array, size: int, points: int) -> Array:
    """The point numbers of cells of one type, m x size. Raises Error for another shape or range."""
    if cells.size == 0:
        return np.zeros((0, size), np.int64)
    if cells.ndim != 2 or cells.shape[1] != size:
        raise Error(f"cells {kind!r} have the shape {cells.shape}; m x {size} is expected")
    if not np.issubdtype(cells.dtype, np.integer):
        raise Error(f"cells {kind!r} are of type {cells.dtype}; whole numbers are expected")
    if cells.min() < 0 or cells.max() >= points:
        raise Error(f"cells {kind!r} use the points {cells.min()} to {cells.max()}; there are 0 to {points - 1}")
    return cells.astype(np.int64)


def writable(mesh: vtkDataSet) -> vtkDataSet:
    """The mesh, or, where it lacks the arrays of points or cells, a copy that has them, empty.

    vtkAppendFilter, vtkThreshold and others return grids without these arrays where nothing is left; VTK's writers
    crash on them, or write files that its readers reject.
    """
    bare_points = isinstance(mesh, vtkPointSet) and not mesh.GetPoints()
    bare_cells = isinstance(mesh, vtkUnstructuredGrid) and not (mesh.GetCells() and cell_types(mesh))
    if not bare_points and not bare_cells:
        return mesh
    made = mesh.NewInstance()
    made.ShallowCopy(mesh)
    if bare_points:
        made.SetPoints(vtkPoints())
    if bare_cells:
        made.SetCells(numpy_to_vtk(np.zeros(0, np.uint8), deep=True), vtkCellArray())
    return made


#: Attributes without a section in VTK's legacy files: the name of the array, whether it belongs to the points, and the
#: number of its attribute.
_ATTRIBUTES = (("HigherOrderDegrees", False, vtkDataSetAttributes.HIGHERORDERDEGREES),
               ("RationalWeights", True, vtkDataSetAttributes.RATIONALWEIGHTS))  # fmt: skip


def without_marks(mesh: vtkDataSet) -> vtkDataSet:
    """The mesh in which the orders and weights of Lagrange and Bezier cells are plain arrays of these names.

    VTK's legacy writer drops them otherwise.
    """
    made = mesh.NewInstance()
    made.ShallowCopy(mesh)
    for name, of_points, attribute in _ATTRIBUTES:
        data = made.GetPointData() if of_points else made.GetCellData()
        if (array := data.GetAbstractAttribute(attribute)) is not None:
            data.SetActiveAttribute(-1, attribute)
            if array.GetName() != name:
                array.SetName(name)
    return made


def mark_attributes(mesh: vtkDataSet) -> None:
    """Make the arrays of these names the attributes that VTK's cells take their orders and weights from."""
    for name, of_points, attribute in _ATTRIBUTES:
        data = mesh.GetPointData() if of_points else mesh.GetCellData()
        if data.GetAbstractAttribute(attribute) is None and data.HasArray(name):
            data.SetActiveAttribute(name, attribute)
