# SPDX-License-Identifier: BSD-3-Clause
"""Meshes in pieces, for what runs on MPI ranks."""

import itertools

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import (
    VTK_QUADRATIC_TETRA,
    VTK_TETRA,
    VTK_TRIANGLE,
    vtkCellArray,
    vtkUnstructuredGrid,
)
from vtkmodules.vtkFiltersCore import vtkAppendFilter
from vtkmodules.vtkParallelCore import vtkMultiProcessController

CONTROLLER = vtkMultiProcessController.GetGlobalController()
RANK, RANKS = CONTROLLER.GetLocalProcessId(), CONTROLLER.GetNumberOfProcesses()
CUTS = ("slabs", "tree", "random")


def simplices(n: int, dimension: int = 3) -> tuple:
    """Places in a grid of n cubes (squares) along each edge, and the corners of its tetrahedra (triangles)."""
    axes = np.meshgrid(*[np.arange(n + 1)] * dimension, indexing="ij")
    places = np.stack([axis.ravel() for axis in axes], -1)
    steps = [(n + 1) ** (dimension - 1 - axis) for axis in range(dimension)]
    first = np.array([np.dot(cube, steps) for cube in itertools.product(range(n), repeat=dimension)])
    cells = []
    for order in itertools.permutations(range(dimension)):
        corners = list(itertools.accumulate((steps[axis] for axis in order), initial=first))
        if np.linalg.det(np.eye(dimension)[list(order)]) < 0:
            corners[1], corners[2] = corners[2], corners[1]
        cells.append(np.stack(corners, -1))
    return places, np.concatenate(cells).astype(np.int64)


def quadratic(places: np.ndarray, cells: np.ndarray) -> tuple:
    """Points and nodes of quadratic tetrahedra in place of linear ones; the corners keep their numbers."""
    ends = np.concatenate([cells[:, edge] for edge in ([0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3])])
    edges, numbers = np.unique(np.sort(ends, axis=1), axis=0, return_inverse=True)
    middles = len(places) + numbers.reshape(6, -1).T
    return np.concatenate([places, places[edges].mean(axis=1)]), np.hstack([cells, middles])


def divided(centres: np.ndarray, cut: str, pieces: int, axis: int = 2) -> np.ndarray:
    """The piece of each cell: slabs across an axis, halves of halves across the longest extents, or at random."""
    if cut == "random":
        return np.random.default_rng(7).integers(0, pieces, len(centres))
    found = np.zeros(len(centres), int)
    left = [(np.arange(len(centres)), 0, pieces)]
    while left:
        cells, first, count = left.pop()
        if count == 1:
            found[cells] = first
            continue
        across = axis if cut == "slabs" else int(np.argmax(np.ptp(centres[cells], axis=0)))
        order = cells[np.argsort(centres[cells, across], kind="stable")]
        half = count // 2
        middle = len(order) * half // count
        left += [(order[:middle], first, half), (order[middle:], first + half, count - half)]
    return found


def add_array(data, name: str, values: np.ndarray) -> None:
    array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    array.SetName(name)
    data.AddArray(array)


def add_global_ids(grid: vtkUnstructuredGrid) -> None:
    """Makes the numbers in the whole mesh the global ids."""
    for data, name in ((grid.GetPointData(), "place"), (grid.GetCellData(), "cell")):
        ids = numpy_to_vtkIdTypeArray(vtk_to_numpy(data.GetArray(name)).copy(), deep=True)
        ids.SetName("ids")
        data.SetGlobalIds(ids)


def piece(points: np.ndarray, cells: np.ndarray, own: np.ndarray, ghosts: bool = False) -> vtkUnstructuredGrid:
    """The flagged cells with points of their own; with ghosts also the cells that share a point with them.

    The arrays `place` and `cell` have the numbers in the whole mesh.
    """
    grid = vtkUnstructuredGrid()
    if not own.any():
        return grid
    taken = np.isin(cells, np.unique(cells[own])).any(axis=1) if ghosts else own
    used, local = np.unique(cells[taken], return_inverse=True)
    positions = vtkPoints()
    positions.SetData(numpy_to_vtk(np.ascontiguousarray(points[used]), deep=True))
    grid.SetPoints(positions)
    array = vtkCellArray()
    corners = cells.shape[1]
    offsets = np.arange(0, local.size + 1, corners, dtype=np.int64)
    local = local.reshape(-1).astype(np.int64)
    array.SetData(numpy_to_vtkIdTypeArray(offsets, deep=True), numpy_to_vtkIdTypeArray(local, deep=True))
    # A type per cell: VTK 9.6 takes cells that are inserted later for the one type of a mesh otherwise.
    kinds = {3: VTK_TRIANGLE, 4: VTK_TETRA, 10: VTK_QUADRATIC_TETRA}
    types = np.full(array.GetNumberOfCells(), kinds[corners], np.uint8)
    grid.SetCells(numpy_to_vtk(types, deep=True), array)
    add_array(grid.GetPointData(), "place", used.astype(np.int64))
    add_array(grid.GetCellData(), "cell", np.flatnonzero(taken).astype(np.int64))
    if ghosts:
        add_array(grid.GetCellData(), "vtkGhostType", (~own[taken]).astype(np.uint8))
    return grid


def appended(pieces: list) -> vtkUnstructuredGrid:
    """One data set of several, whose points stay apart."""
    append = vtkAppendFilter()
    append.MergePointsOff()
    for part in pieces:
        append.AddInputData(part)
    append.Update()
    return append.GetOutput()
