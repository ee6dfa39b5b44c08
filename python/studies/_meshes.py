# SPDX-License-Identifier: BSD-3-Clause
"""Shared by the studies: coordinates, cells and sizes of meshes as arrays."""

from __future__ import annotations

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkDataSet


def copied(mesh: vtkDataSet) -> vtkDataSet:
    copy = mesh.NewInstance()
    copy.ShallowCopy(mesh)
    return copy


def points_of(mesh: vtkDataSet) -> np.ndarray:
    """The coordinates, n x 3, a copy in double precision."""
    return np.array(vtk_to_numpy(mesh.GetPoints().GetData()), float)


def cells_of(mesh: vtkDataSet) -> np.ndarray:
    """The corners of a mesh of one cell type, one row per cell."""
    corners = mesh.GetCell(0).GetNumberOfPoints()
    return vtk_to_numpy(mesh.GetCells().GetConnectivityArray()).reshape(-1, corners)


def with_points(mesh: vtkDataSet, points: np.ndarray) -> vtkDataSet:
    """The mesh with other coordinates."""
    copy = copied(mesh)
    moved = vtkPoints()
    moved.SetData(numpy_to_vtk(np.ascontiguousarray(points, float), deep=True))
    copy.SetPoints(moved)
    return copy


def sizes_of(mesh: vtkDataSet) -> np.ndarray:
    """Signed areas (of a mesh in the plane z = 0) or volumes."""
    p, cells = points_of(mesh), cells_of(mesh)
    a, b = p[cells[:, 1]] - p[cells[:, 0]], p[cells[:, 2]] - p[cells[:, 0]]
    if cells.shape[1] == 3:
        return 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    return np.einsum("ij,ij->i", np.cross(a, b), p[cells[:, 3]] - p[cells[:, 0]]) / 6


def right_triangles(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The points, n x 2, and the triangles of a grid with these coordinates; each of its cells is two triangles."""
    columns = len(x)
    corner = (np.arange(len(y) - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    right, above = corner + 1, corner + columns
    cells = np.stack([corner, right, above + 1, corner, above + 1, above], axis=1).reshape(-1, 3)
    return np.column_stack([c.ravel() for c in np.meshgrid(x, y)]), cells


def scaled(mesh: vtkDataSet, factor: float) -> vtkDataSet:
    """The mesh in another unit of length."""
    return with_points(mesh, factor * points_of(mesh))
