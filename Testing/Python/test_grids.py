# SPDX-License-Identifier: BSD-3-Clause
"""Every grid that leaves read() is valid, whoever read it; every writer takes, or rejects, every kind of empty mesh."""

from pathlib import Path

import numpy as np
import tautline as tl
from checks import OUT, rejected, run_tests, shell, square
from tautline._grid_checks import POINTS_OF_TYPE, check_grid
from tautline._meshio import installed
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkPoints
from vtkmodules.vtkCommonDataModel import (
    vtkCellArray,
    vtkGenericCell,
    vtkImageData,
    vtkMultiBlockDataSet,
    vtkPlane,
    vtkPolyData,
    vtkRectilinearGrid,
    vtkStructuredGrid,
    vtkUnstructuredGrid,
)
from vtkmodules.vtkFiltersCore import vtkAppendFilter, vtkThreshold
from vtkmodules.vtkFiltersExtraction import vtkExtractGeometry
from vtkmodules.vtkFiltersGeneral import vtkClipDataSet

try:
    from vtkmodules.vtkFiltersCore import vtkExtractCells
except ImportError:  # before VTK 9.2
    from vtkmodules.vtkFiltersExtraction import vtkExtractCells

FOLDER = OUT / "grids"
FOLDER.mkdir(parents=True, exist_ok=True)
#: Formats of VTK hold a mesh without cells; others may reject it.
HOLD_NOTHING = {".vtk", ".vtu", ".vtp", ".vti", ".vtr", ".vts", ".vtm"}
FAR = 100.0  # outside of the unit square


def grid(types, sizes, ids, xyz=((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))):
    """An unstructured grid as a faulty reader or script makes it."""
    made = vtkUnstructuredGrid()
    coordinates = vtkPoints()
    coordinates.SetData(numpy_to_vtk(np.asarray(xyz, float), deep=True))
    made.SetPoints(coordinates)
    cells = vtkCellArray()
    offsets = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
    cells.SetData(numpy_to_vtkIdTypeArray(offsets, deep=True), numpy_to_vtkIdTypeArray(np.int64(ids), deep=True))
    made.SetCells(numpy_to_vtk(np.uint8(types), deep=True), cells)
    return made


def with_short_array():
    made = square(2)
    values = vtkDoubleArray()
    values.SetName("short")
    values.SetNumberOfTuples(3)
    made.GetCellData().AddArray(values)
    return made


INVALID = {
    "too few points": lambda: grid([12], [4], [0, 1, 2, 3]),
    "too many points": lambda: grid([5], [4], [0, 1, 2, 3]),
    "one cell of many": lambda: grid([10, 5, 10], [4, 3, 3], [0, 1, 2, 3, 0, 1, 2, 0, 1, 2]),
    "a line of one point": lambda: grid([4], [1], [0]),
    "a point that does not exist": lambda: grid([5], [3], [0, 1, 4]),
    "a negative point": lambda: grid([5], [3], [0, 1, -1]),
    "an unknown type": lambda: grid([200], [3], [0, 1, 2]),
    "a short array": with_short_array,
}


def test_types():
    """The table of points by type equals VTK's."""
    cell = vtkGenericCell()
    for kind, count in POINTS_OF_TYPE.items():
        cell.SetCellType(kind)
        assert cell.GetCellType() == kind and cell.GetNumberOfPoints() == count, (kind, count, cell.GetNumberOfPoints())
    check_grid(grid([10, 5, 1, 4, 7], [4, 3, 1, 2, 3], [0, 1, 2, 3, 0, 1, 2, 0, 1, 2, 0, 1, 2]))


def test_invalid_grids():
    for name, make in INVALID.items():
        rejected("", check_grid, make())
        for ending in (".vtu", ".vtk", ".msh", ".stl", ".mesh", ".off"):
            target = FOLDER / f"invalid{ending}"
            rejected("", tl.write, make(), target)
            assert not target.exists(), (name, ending)


def test_meshio():
    """Cells of meshio that do not have the points of their type; Nastran that meshio reads so."""
    if not installed():
        print("without meshio")
        return
    import meshio

    for kind, cells in (("hexahedron", [[0, 1, 2, 3]]), ("triangle", [[0, 1, 9]]), ("tetra", [[0.5, 1, 2, 3]])):
        mesh = meshio.Mesh(np.zeros((4, 3)), [])
        mesh.cells = [type("Block", (), {"type": kind, "data": np.array(cells)})()]
        rejected(kind, tl.quality, mesh)
    ragged = type("Block", (), {"type": "triangle", "data": [[0, 1, 2], [0, 1]]})()
    mesh = meshio.Mesh(np.zeros((4, 3)), [])
    mesh.cells = [ragged]
    rejected("triangle", tl.quality, mesh)
    # The first triangle of meshio's wedge faces inward, of VTK's outward.
    prism = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1)]
    ids = tl.quality(meshio.Mesh(np.array(prism, float), [("wedge", np.arange(6)[None])])).mesh.GetCell(0).GetPointIds()
    assert [ids.GetId(i) for i in range(6)] == [0, 2, 1, 3, 5, 4]
    corners = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    card = "".join
    file = FOLDER / "continued.bdf"
    rows = [card(f"{v:>8}" for v in (i + 1, "", *map(float, p))) for i, p in enumerate(corners)]
    element = card(f"{v:>8}" for v in (1, 1, 1, 2, 4, 3, 5, 6)) + "\n        " + card(f"{v:>8}" for v in (8, 7))
    file.write_text("BEGIN BULK\n" + "".join(f"GRID    {row}\n" for row in rows) + f"CHEXA   {element}\nENDDATA\n")
    for ending in (".vtu", ".vtk"):
        target = FOLDER / f"continued{ending}"
        try:
            mesh = tl.read(file)
            check_grid(mesh)  # of a meshio that reads it
        except tl.Error as error:
            assert str(file) in str(error)
            assert str(file) in shell("convert", file, target, code=1) and not target.exists()


def after(algorithm, mesh):
    algorithm.SetInputData(mesh)
    algorithm.Update()
    return algorithm.GetOutput()


def initialized(kind):
    made = kind()
    made.Initialize()
    return made


def beyond():
    plane = vtkPlane()
    plane.SetOrigin(FAR, 0, 0)
    plane.SetNormal(1, 0, 0)
    return plane


def clipped():
    clip = vtkClipDataSet()
    clip.SetClipFunction(beyond())
    return after(clip, square(2))


def outside():
    extract = vtkExtractGeometry()
    extract.SetImplicitFunction(beyond())
    extract.ExtractInsideOff()
    return after(extract, square(2))


def below():
    threshold = vtkThreshold()
    mesh = tl.quality(square(2), "imr").mesh
    threshold.SetInputArrayToProcess(0, 0, 0, 1, "imr")
    threshold.SetLowerThreshold(FAR)
    threshold.SetUpperThreshold(2 * FAR)
    return after(threshold, mesh)


def only_points(kind):
    made = kind()
    made.SetPoints(square(2).GetPoints())
    return made


def blocks(*parts):
    made = vtkMultiBlockDataSet()
    for i, part in enumerate(parts):
        made.SetBlock(i, part)
    return made


EMPTY = {
    "grid": vtkUnstructuredGrid,
    "grid, Initialize()": lambda: initialized(vtkUnstructuredGrid),
    "grid, append": lambda: after(vtkAppendFilter(), vtkUnstructuredGrid()),
    "grid, clip": clipped,
    "grid, extract cells": lambda: after(vtkExtractCells(), square(2)),
    "grid, extract geometry": outside,
    "grid, threshold": below,
    "grid, points": lambda: only_points(vtkUnstructuredGrid),
    "surface": vtkPolyData,
    "surface, Initialize()": lambda: initialized(vtkPolyData),
    "surface, points": lambda: only_points(vtkPolyData),
    "image": vtkImageData,
    "image, Initialize()": lambda: initialized(vtkImageData),
    "rectilinear": vtkRectilinearGrid,
    "structured": vtkStructuredGrid,
    "structured, Initialize()": lambda: initialized(vtkStructuredGrid),
    "blocks": vtkMultiBlockDataSet,
    "blocks, one missing": lambda: blocks(None, square(2)),
    "blocks of nothing": lambda: blocks(initialized(vtkUnstructuredGrid), initialized(vtkPolyData), vtkImageData()),
}


def test_empty():
    """One process for all: a crash of a writer ends it."""
    endings = [form["ending"] for form in tl.formats() if form["write"]]
    written = 0
    for name, make in EMPTY.items():
        for ending in endings:
            print(name, ending, flush=True)
            mesh, target = make(), FOLDER / f"empty{ending}"
            assert name == "blocks, one missing" or mesh.GetNumberOfCells() == 0, name
            target.unlink(missing_ok=True)
            try:
                files = tl.write(mesh, target)
            except tl.Error:
                assert not target.exists(), (name, ending)
                # Meshes that the format is made for are not rejected.
                same = mesh.IsA("vtkMultiBlockDataSet") if ending == ".vtm" else is_for(ending, mesh)
                assert not (ending in HOLD_NOTHING and same), (name, ending)
                continue
            written += 1
            assert Path(files[0]) == target or Path(files[0]).exists()
            if ending in HOLD_NOTHING:
                back = tl.read(target)
                assert back.GetNumberOfPoints() == mesh.GetNumberOfPoints(), (name, ending)
                assert back.GetNumberOfCells() == mesh.GetNumberOfCells(), (name, ending)
    assert written > len(EMPTY)


def is_for(ending, mesh) -> bool:
    kinds = {".vtk": "vtkDataObject", ".vtu": "vtkUnstructuredGrid", ".vtp": "vtkPolyData", ".vti": "vtkImageData",
             ".vtr": "vtkRectilinearGrid", ".vts": "vtkStructuredGrid"}  # fmt: skip
    return ending in kinds and bool(mesh.IsA(kinds[ending]))


run_tests(globals())
