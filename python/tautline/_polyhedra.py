# SPDX-License-Identifier: BSD-3-Clause
"""The sense of the faces of polyhedra, which VTK's readers do not look at: they point out of the cell here.

vtkCGNSReader lists the faces of NFACE_n as they are seen from inside, so that all cells have negative volumes. Files
whose face numbers have no signs, and those of EnSight, have no sense at all.
"""

from __future__ import annotations

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import VTK_POLYHEDRON, vtkUnstructuredGrid

from ._arrays import Array, cell_types

#: Of a check sum of edges: odd numbers that mix the bits.
_LOW, _HIGH, _MIX = (np.uint64(number) for number in (0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0xBF58476D1CE4E5B9))
_HALF = np.uint64(32)


class Faces:
    """The faces of the polyhedra of a grid: cell, first place in the list of points, number of points."""

    def __init__(self, grid: vtkUnstructuredGrid) -> None:
        if hasattr(grid, "GetPolyhedronFaces"):  # VTK 9.4
            faces, of_cells = grid.GetPolyhedronFaces(), grid.GetPolyhedronFaceLocations()
            offsets = vtk_to_numpy(faces.GetOffsetsArray())
            numbers = vtk_to_numpy(of_cells.GetConnectivityArray())
            counts = np.diff(vtk_to_numpy(of_cells.GetOffsetsArray()))
            self.cell = np.repeat(np.arange(len(counts)), counts)
            self.first, self.size = offsets[numbers], np.diff(offsets)[numbers]
            self.stream = vtk_to_numpy(faces.GetConnectivityArray())
        else:
            self.stream = vtk_to_numpy(grid.GetFaces())
            places = vtk_to_numpy(grid.GetFaceLocations())
            cells = np.flatnonzero(places >= 0)
            at, left = places[cells] + 1, self.stream[places[cells]]
            found = []
            while len(cells):  # one face of each cell that has more
                size = self.stream[at]
                found.append((cells, at + 1, size))
                left = left - 1
                more = left > 0
                cells, at, left = cells[more], (at + size + 1)[more], left[more]
            self.cell, self.first, self.size = (np.concatenate(column) for column in zip(*found))
        self.face = np.repeat(np.arange(len(self.size)), self.size)
        #: Of each corner of each face: its place in the list of points, and that of the next corner.
        inside = np.arange(len(self.face)) - np.repeat(np.cumsum(self.size) - self.size, self.size)
        self.at = self.first[self.face] + inside
        self.next = np.where(inside + 1 < self.size[self.face], self.at + 1, self.first[self.face])

    def volumes(self, points: Array, cells: int) -> Array:
        """The volume of each cell, positive where its faces point outwards."""
        low = np.full(cells, len(self.stream))
        np.minimum.at(low, self.cell, self.first)
        apex = points[self.stream[low[self.cell[self.face]]]]
        base, a, b = (points[self.stream[at]] - apex for at in (self.first[self.face], self.at, self.next))
        parts = np.einsum("ij,ij->i", base, np.cross(a, b)) / 6
        return np.bincount(self.cell[self.face], parts, cells)

    def agreeing(self, cells: int) -> Array:
        """Of each cell, whether each of its edges is run in both senses."""
        a, b = self.stream[self.at].astype(np.uint64), self.stream[self.next].astype(np.uint64)
        keys = (np.minimum(a, b) * _LOW) ^ (np.maximum(a, b) * _HIGH)
        keys = (keys ^ (keys >> _HALF)) * _MIX
        sums = np.zeros(cells, np.uint64)  # in which the two senses of an edge cancel
        np.add.at(sums, self.cell[self.face], np.where(b > a, keys, -keys))
        result: Array = sums == 0
        return result

    def reverse(self, cells: Array) -> None:
        """List the faces of cells in the opposite sense."""
        chosen = cells[self.cell[self.face]]
        source = self.first[self.face] + self.size[self.face] - 1 - (self.at - self.first[self.face])
        self.stream[self.at[chosen]] = self.stream[source[chosen]]


def turn_outwards(grid: vtkUnstructuredGrid) -> None:
    """List the faces of polyhedra as they are seen from outside, in place.

    Where the faces of most cells agree with each other, the file has their sense: all cells are reversed if their
    volumes together are negative, so that a cell that is inverted stays one. Else it has none: each cell whose faces
    agree is reversed where its volume is negative; the others are left to Element Quality, which turns them.
    """
    types = cell_types(grid) if grid.GetNumberOfCells() else None
    if types is None or not (polyhedra := vtk_to_numpy(types).ravel() == VTK_POLYHEDRON).any():
        return
    faces, cells = Faces(grid), grid.GetNumberOfCells()
    points = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
    volumes, agreeing = faces.volumes(points, cells), faces.agreeing(cells) & polyhedra
    if 2 * agreeing.sum() > polyhedra.sum():
        turned = polyhedra & (volumes[agreeing].sum() < 0)
    else:
        turned = agreeing & (volumes < 0)
    if turned.any():
        faces.reverse(turned)
        grid.Modified()
