# SPDX-License-Identifier: BSD-3-Clause
"""A mesh in pieces (.pvtu, appended parts) gives what the whole mesh gives, in the functions and on the shell."""

from pathlib import Path

import numpy as np
import tautline as tl
from checks import OUT, points, rejected, run_tests, shell, square, wording
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataSetAttributes, vtkMultiBlockDataSet
from vtkmodules.vtkFiltersCore import vtkAppendFilter
from vtkmodules.vtkCommonCore import vtkIdList

try:
    from vtkmodules.vtkFiltersCore import vtkExtractCells
except ImportError:  # VTK 9.1
    from vtkmodules.vtkFiltersExtraction import vtkExtractCells

N = 12
TIGHT = 1e-12


def rough():
    """A square whose inner points are moved."""
    return tl.perturb(square(N), fraction=0.4, percentage=100, seed=4).mesh


def parts(mesh) -> list:
    """Its quarters, a data set each."""
    connectivity = vtk_to_numpy(mesh.GetCells().GetConnectivityArray()).reshape(-1, 3)
    centers = points(mesh)[connectivity].mean(axis=1)
    quarter = (centers[:, 0] > 0.5) + 2 * (centers[:, 1] > 0.5)
    made = []
    for number in range(4):
        ids = vtkIdList()
        for cell in np.flatnonzero(quarter == number):
            ids.InsertNextId(int(cell))
        extract = vtkExtractCells()
        extract.SetInputData(mesh)
        extract.SetCellList(ids)
        extract.Update()
        made.append(extract.GetOutput())
    return made


def in_pieces(mesh):
    """Its quarters in one data set, with the points of each."""
    append = vtkAppendFilter()
    for part in parts(mesh):
        append.AddInputData(part)
    append.Update()
    return append.GetOutput()


def pvtu_file(pieces_of_mesh: list) -> Path:
    """A .pvtu file of these pieces."""
    pieces = []
    for number, part in enumerate(pieces_of_mesh):
        tl.write(part, OUT / f"seams_{number}.vtu")
        pieces.append(f'<Piece Source="seams_{number}.vtu"/>')
    file = OUT / "seams.pvtu"
    file.write_text('<VTKFile type="PUnstructuredGrid" version="1.0" byte_order="LittleEndian"><PUnstructuredGrid>'
                    '<PPoints><PDataArray type="Float64" Name="Points" NumberOfComponents="3"/></PPoints>'
                    + "".join(pieces) + "</PUnstructuredGrid></VTKFile>")  # fmt: skip
    return file


def from_pvtu(mesh):
    """Its quarters, read from a .pvtu file."""
    return tl.read(pvtu_file(parts(mesh)))


def by_place(mesh, values) -> dict:
    """The value at each place; all points of a place have the same."""
    found = {}
    for place, value in zip(map(tuple, points(mesh)), values):
        assert np.array_equal(found.setdefault(place, value), value), place
    return found


def test_solve() -> None:
    mesh = rough()
    whole = tl.solve(mesh, source=50, relative_tolerance=TIGHT)
    for given in (in_pieces(mesh), from_pvtu(mesh)):
        result = tl.solve(given, source=50, relative_tolerance=TIGHT)
        assert result.unknowns == whole.unknowns == (N - 1) ** 2
        assert abs(result.solution.max() / whole.solution.max() - 1) < 1e-12
        assert len(result.solution) == (N + 1) ** 2 + 2 * (N + 1) + 1
        expected = by_place(mesh, whole.solution)
        for place, value in by_place(result.mesh, result.solution).items():
            assert abs(value - expected[place]) < 1e-10 * whole.solution.max()
        assert wording("27-coincident-points-on-1-seam-were") in result.summary, result.summary
        apart = tl.solve(given, source=50, relative_tolerance=TIGHT, merge_coincident_points=False)
        assert apart.solution.max() < 0.5 * whole.solution.max() and "coincident" not in apart.summary
        condition = tl.condition(given, preconditioner="jacobi")
        assert abs(condition.condition / tl.condition(mesh, preconditioner="jacobi").condition - 1) < 1e-6
    file = OUT / "seams_solved.vtu"
    tl.write(in_pieces(mesh), file)
    assert wording("27-coincident-points") in shell("solve", file)
    assert "coincident" not in shell("solve", file, "--no-merge-coincident-points")


def test_pvtu() -> None:
    mesh = rough()
    quarters = parts(mesh)
    # A piece with the cells of another one as its ghost cells.
    append = vtkAppendFilter()
    for part in quarters[:2]:
        append.AddInputData(part)
    append.Update()
    overlapping = append.GetOutput()
    flags = np.zeros(overlapping.GetNumberOfCells(), np.uint8)
    flags[quarters[0].GetNumberOfCells() :] = vtkDataSetAttributes.DUPLICATECELL
    ghosts = numpy_to_vtk(flags, deep=True)
    ghosts.SetName("vtkGhostType")
    overlapping.GetCellData().AddArray(ghosts)
    for number in (1, 2, 3):
        ghosts = numpy_to_vtk(np.zeros(quarters[number].GetNumberOfCells(), np.uint8), deep=True)
        ghosts.SetName("vtkGhostType")
        quarters[number].GetCellData().AddArray(ghosts)
    file = pvtu_file([overlapping, *quarters[1:]])
    text = file.read_text()
    array = '<PCellData><PDataArray type="UInt8" Name="vtkGhostType"/></PCellData>'
    file.write_text(text.replace("<PPoints>", f"{array}<PPoints>"))
    read = tl.read(file)
    assert read.GetNumberOfCells() == mesh.GetNumberOfCells()
    whole = tl.solve(mesh, source=50, relative_tolerance=TIGHT)
    result = tl.solve(file, source=50, relative_tolerance=TIGHT)
    assert result.unknowns == whole.unknowns
    assert abs(result.solution.max() / whole.solution.max() - 1) < 1e-12
    assert wording("27-coincident-points") in shell("solve", pvtu_file(parts(mesh)))
    piece = OUT / "seams_2.vtu"
    piece.write_bytes(piece.read_bytes()[:2000])
    rejected("seams", tl.read, file)
    piece.unlink()
    rejected("seams_2.vtu", tl.read, file)
    rejected(wording("no-writer-for-pvtu"), tl.write, mesh, file)


def test_blocks() -> None:
    mesh = rough()
    blocks = vtkMultiBlockDataSet()
    for number, part in enumerate(parts(mesh)):
        blocks.SetBlock(number, part)
    whole = tl.solve(mesh, source=50, relative_tolerance=TIGHT)
    result = tl.solve(blocks, source=50, relative_tolerance=TIGHT)
    assert result.unknowns == whole.unknowns and wording("one-mesh") in result.summary
    assert abs(result.solution.max() / whole.solution.max() - 1) < 1e-10
    rejected(wording("merge-blocks"), tl.optimize, blocks, boundary="free")


def test_motion() -> None:
    mesh = rough()
    given = in_pieces(mesh)
    for function, options in (
        (tl.optimize, {}), (tl.untangle, {}), (tl.warp, {"transform": {"rotate": 10}, "moved": "whole boundary"}),
    ):  # fmt: skip
        whole, result = function(mesh, **options), function(given, **options)
        assert wording("27-coincident-points-on-1-seam") in result.summary, result.summary
        moved = dict(zip(map(tuple, points(mesh)), whole.displacement))
        for place, displacement in zip(map(tuple, points(given)), result.displacement):
            assert np.abs(displacement - moved[place]).max() < 1e-10, (function, place)
        assert result.mesh.GetNumberOfPoints() == given.GetNumberOfPoints()
        assert "coincident" not in function(given, merge_coincident_points=False, **options).summary
    perturbed = tl.perturb(given, percentage=100)
    by_place(given, perturbed.displacement)
    assert perturbed.movable == (N - 1) ** 2 and perturbed.inverted == 0
    output = OUT / "seams_optimized.vtu"
    tl.write(given, OUT / "seams_given.vtu")
    assert wording("27-coincident-points") in shell("optimize", OUT / "seams_given.vtu", "-o", output)
    assert tl.read(output).GetNumberOfPoints() == given.GetNumberOfPoints()


def test_peridynamics() -> None:
    mesh = tl.interaction_layer(square(8), 0.25)
    reference = vtk_to_numpy(mesh.GetCellData().GetArray("Reference"))
    assert (reference == 2).any()
    # The integrals are accurate to their tolerance only, whatever the order of the cells.
    whole = tl.peridynamics(mesh, delta=0.25, tolerance=1e-9)
    result = tl.peridynamics(in_pieces(mesh), delta=0.25, tolerance=1e-9)
    assert result.rows == whole.rows and abs(result.condition / whole.condition - 1) < 1e-8
    layered = tl.interaction_layer(in_pieces(square(8)), 0.25)
    assert layered.GetNumberOfCells() == mesh.GetNumberOfCells()
    blocks = vtkMultiBlockDataSet()
    for number, part in enumerate(parts(square(8))):
        blocks.SetBlock(number, part)
    assert tl.interaction_layer(blocks, 0.25).GetNumberOfCells() == mesh.GetNumberOfCells()
    for number, part in enumerate(parts(mesh)):
        blocks.SetBlock(number, part)
    result = tl.peridynamics(blocks, delta=0.25, tolerance=1e-9)
    assert result.rows == whole.rows and abs(result.condition / whole.condition - 1) < 1e-8


def test_element_quality() -> None:
    result = tl.quality(in_pieces(rough()), ["imr"])
    assert wording("27-points-on-1-seam-are-at") in result.notice, result.notice
    assert tl.quality(rough(), ["imr"]).notice == ""


run_tests(globals())
