# SPDX-License-Identifier: BSD-3-Clause
"""improve_on_ranks.py FILE: for pvbatch --sym on any number of MPI ranks, see test_improve_on_ranks.py.

Improves a block of tetrahedra with slivers whose pieces are on the ranks, by every route and with every setting that
is improved in parts. The first rank writes numbers to FILE as JSON, every rank its parts to FILE.CASE.RANK.npz.
"""

import json
import os
import sys

import numpy as np
import tautline
from paraview import simple
from rank_meshes import CONTROLLER, CUTS, RANK, RANKS, add_array, divided, piece, simplices
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList, vtkIdTypeArray, vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_HEXAHEDRON, VTK_TRIANGLE, vtkSelection, vtkSelectionNode

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())
N, MOVED, TINY = 5, 0.45, 2e-3
AGGRESSIVE = 4
WALL = 3  # the plane x = WALL is marked by triangles, and on its two sides there are regions


def volumes(points: np.ndarray, cells: np.ndarray) -> np.ndarray:
    edges = points[cells[:, 1:]] - points[cells[:, :1]]
    return np.linalg.det(edges) / 6


def slivers() -> tuple:
    """Points, moved inside at random as far as all cells stay valid, and tetrahedra."""
    places, cells = simplices(N)
    start = places.astype(float)
    inner = ((places > 0) & (places < N)).all(axis=1) & (places[:, 0] != WALL)
    shift = inner[:, None] * np.random.default_rng(3).uniform(-MOVED, MOVED, start.shape)
    bad = np.array([0])
    while bad.size:
        bad = np.unique(cells[volumes(start + shift, cells) < TINY])
        shift[bad] *= 0.7
    return start + shift, cells


POINTS, CELLS = slivers()
CENTRES = POINTS[CELLS].mean(axis=1)
REGION = np.where(CENTRES[:, 0] < WALL, 7.0, -2.5)
STAYS = np.arange(len(POINTS)) % 11 == 0
faces = np.sort(CELLS[:, [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]]].reshape(-1, 3), axis=1)
FACETS = np.unique(faces[(POINTS[faces][:, :, 0] == WALL).all(axis=1)], axis=0)


def mesh(cut: str, ghosts: bool = False, single: bool = False, triangles: bool = False):
    """The piece of this rank; on four ranks or more the last has nothing."""
    takers = RANKS - 1 if RANKS > 3 else RANKS
    points = POINTS.astype(np.float32) if single else POINTS
    grid = piece(points, CELLS, divided(CENTRES, cut, takers) == RANK, ghosts)
    where = cells = np.zeros(0, int)
    if grid.GetNumberOfPoints():
        where = vtk_to_numpy(grid.GetPointData().GetArray("place"))
        cells = vtk_to_numpy(grid.GetCellData().GetArray("cell"))
    if triangles:
        where, cells = add_facets(grid, where, cells)
    if grid.GetNumberOfPoints():
        add_array(grid.GetPointData(), "place", where)
        add_array(grid.GetPointData(), "given", POINTS[where])
        add_array(grid.GetPointData(), "stays", STAYS[where].astype(np.uint8))
        add_array(grid.GetCellData(), "cell", cells)
        add_array(grid.GetCellData(), "region", REGION[cells])
    return grid


def add_facets(grid, where: np.ndarray, cells: np.ndarray) -> tuple:
    """Adds triangles that mark a wall: those that a rank gets at random, whoever has the tetrahedra there."""
    own = np.random.default_rng(5).integers(0, RANKS, len(FACETS)) == RANK
    if not grid.GetPoints():
        grid.SetPoints(vtkPoints())
        grid.AllocateExact(len(FACETS), 3 * len(FACETS))
    for facet in FACETS[own]:
        ids = vtkIdList()
        for place in facet:
            known = np.flatnonzero(where == place)
            if not known.size:
                known = [grid.GetPoints().InsertNextPoint(POINTS[place])]
                where = np.append(where, place)
            ids.InsertNextId(int(known[0]))
        grid.InsertNextCell(VTK_TRIANGLE, ids)
    return where, np.concatenate([cells, np.zeros(np.count_nonzero(own), int)])


def turn(grid, which: slice) -> None:
    """Lists the points of cells in the opposite order."""
    if grid.GetNumberOfCells():
        corners = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)
        corners[which, :2] = corners[which, 1::-1].copy()


def columns_of(table) -> dict:
    return {
        table.GetColumnName(i): [str(table.GetValue(row, i)) for row in range(table.GetNumberOfRows())]
        for i in range(table.GetNumberOfColumns())
    }


def filter_of(data, *, below: int = 0, **settings):
    filter_ = tautline.vtkMeshImprover()
    filter_.SetInputDataObject(0, data)
    filter_.SetGatherBelow(below)
    for name, value in settings.items():
        getattr(filter_, f"Set{name}")(value)
    return filter_


def numbers_of(filter_) -> dict:
    return {
        "summary": filter_.GetSummary(),
        "reason": filter_.GetReason(),
        "elements": [filter_.GetElementsBefore(), filter_.GetElementsAfter()],
        "angle": [filter_.GetSmallestAngleBefore(), filter_.GetSmallestAngleAfter()],
        "worst": [filter_.GetWorstBefore(), filter_.GetWorstAfter()],
        "left": filter_.GetRemaining(),
    }


def dump(case: str, data, given) -> None:
    """Writes the part of this rank."""
    found = {"points": np.zeros((0, 3)), "cells": np.zeros((0, 4), int), "given": given.GetNumberOfCells()}
    if data.GetNumberOfCells() or data.GetNumberOfPoints():
        found["points"] = vtk_to_numpy(data.GetPoints().GetData())
        found["cells"] = vtk_to_numpy(data.GetCells().GetConnectivityArray()).reshape(-1, 4)
        for kind, fields in (("point", data.GetPointData()), ("cell", data.GetCellData())):
            for k in range(fields.GetNumberOfArrays()):
                found[f"{kind} {fields.GetArrayName(k)}"] = vtk_to_numpy(fields.GetArray(k))
    np.savez(f"{sys.argv[1]}.{case}.{RANK}", **found)
    CONTROLLER.Barrier()


results: dict = {"ranks": RANKS}


def note(case: str, filter_, data) -> None:
    """All ranks have the same numbers and the same summary; the tables are on the first."""
    found = numbers_of(filter_)
    with open(f"{sys.argv[1]}.{RANK}", "w", encoding="utf-8") as out:
        json.dump(found, out)
    CONTROLLER.Barrier()
    with open(f"{sys.argv[1]}.0", encoding="utf-8") as first:
        assert json.load(first) == found, (case, found)
    found["history"] = columns_of(filter_.GetHistory())
    found["remaining"] = columns_of(filter_.GetRemainingTable())
    assert RANK == 0 or not (filter_.GetHistory().GetNumberOfRows() or filter_.GetRemainingTable().GetNumberOfRows())
    results[case] = found
    dump(case, filter_.GetOutputDataObject(0), data)


def improved(case: str, data, select=None, **settings):
    filter_ = filter_of(data, **settings)
    if select:
        select(filter_)
    filter_.Update()
    note(case, filter_, data)
    return filter_


def keep(filter_) -> None:
    filter_.SetInputArrayToProcess(0, 0, 0, 0, "stays")
    filter_.SetInputArrayToProcess(1, 0, 0, 1, "region")


def keep_selected(filter_) -> None:
    """The last cell of every rank is selected."""
    node = vtkSelectionNode()
    node.SetContentType(vtkSelectionNode.INDICES)
    node.SetFieldType(vtkSelectionNode.CELL)
    cells = filter_.GetInputDataObject(0, 0).GetNumberOfCells()
    ids = vtkIdTypeArray()
    if cells:
        ids.InsertNextValue(cells - 1)
    node.SetSelectionList(ids)
    selection = vtkSelection()
    selection.AddNode(node)
    filter_.SetInputDataObject(1, selection)


def routes() -> None:
    """The Python function and the proxy do what the class does."""
    data = mesh("tree")
    result = tautline.improve(data, "aggressive", gather_below=0, rounds=3)
    by_class = improved("aggressive tree", data, Preset=AGGRESSIVE, Rounds=3)
    assert (result.elements, result.worst) == (by_class.GetElementsAfter(), by_class.GetWorstAfter())
    assert result.mesh.GetNumberOfCells() == len(result.original_cell) == len(result.imr)
    source = simple.TrivialProducer()
    source.GetClientSideObject().SetOutput(data)
    proxy = ImproveMesh(source, Preset="Aggressive", GatherBelow=0, Rounds=3)
    proxy.UpdatePipeline()
    proxy.UpdatePropertyInformation()
    assert (proxy.ElementsAfter, proxy.WorstAfter) == (result.elements, result.worst)
    assert proxy.Summary == result.summary


def gathered() -> None:
    """Operations that need the whole mesh get it, and the summary states why."""
    data = mesh("random")
    improved("small", data, below=len(CELLS) + 1)
    improved("on surface", data, Boundary=2)
    improved("metric", data, Objective=3)
    improved("mean", data, ThenBestShape=True)
    improved("conservative", data, CellTransfer=1)
    improved("lengths", data, Size=3)
    improved("seams", data, MergeCoincidentPoints=False)


def failures() -> None:
    """An error on one rank is an error on all, and none waits."""
    last = min(RANKS, 3) - 1
    for case in ("inverted", "regions", "hexahedra", "order"):
        data = mesh("slabs")
        if RANK == last and case == "inverted":
            x = vtk_to_numpy(data.GetPoints().GetData())
            inner = np.flatnonzero(((x > 1) & (x < N - 1)).all(axis=1))
            x[inner[0]] += 3
        if RANK == last and case == "regions":
            vtk_to_numpy(data.GetCellData().GetArray("region"))[3] = np.nan
        if RANK == last and case == "hexahedra":
            data.GetPointData().Initialize()
            data.GetCellData().Initialize()
            data.InsertNextCell(VTK_HEXAHEDRON, 8, list(range(8)))
        if RANK == last and case == "order":
            turn(data, slice(1))
        filter_ = filter_of(data)
        if case == "regions":
            filter_.SetInputArrayToProcess(1, 0, 0, 1, "region")
        filter_.Update()
        cells = filter_.GetOutputDataObject(0).GetNumberOfCells()
        assert case == "order" or (cells == 0 and filter_.GetSummary() == ""), (case, cells)
        results[f"failed {case}"] = filter_.GetSummary()


for cut in CUTS:
    improved(f"plain {cut}", mesh(cut, ghosts=cut == "tree"), Preset=AGGRESSIVE)
    if cut != "tree":  # all of these rounds for two cuts do
        improved(f"kept {cut}", mesh(cut, triangles=True), keep, Preset=AGGRESSIVE)
improved("single", mesh("random", single=True), Preset=AGGRESSIVE)
improved("selected", mesh("tree"), keep_selected, Preset=AGGRESSIVE, Rounds=2)
improved("sliding", mesh("tree"), Preset=AGGRESSIVE, Boundary=1, Rounds=2)
improved("late", mesh("tree"), Preset=AGGRESSIVE, TimeLimit=1e-9)
reversed_mesh = mesh("slabs")
turn(reversed_mesh, slice(None))
improved("reversed", reversed_mesh, Preset=AGGRESSIVE, Rounds=2)
if RANKS > 1:
    improved("once", mesh("slabs"), Preset=AGGRESSIVE, Rounds=1)
routes()
gathered()
failures()
if RANK == 0:
    np.savez(f"{sys.argv[1]}.given", points=POINTS, cells=CELLS, facets=FACETS, stays=STAYS, region=REGION)
    with open(sys.argv[1], "w", encoding="utf-8") as out:
        json.dump(results, out)
