# SPDX-License-Identifier: BSD-3-Clause
"""Checks of the sessions with metrics of a user and with a mesh in pieces, called in ParaView's Python shell.

The metrics come from Testing/Python/metrics_to_load.py, and of the library of the environment variable
TAUTLINE_METRICS, which a server has, and not its client.
"""

import os
import re
import warnings
from pathlib import Path

import numpy
import tautline
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter

from session_checks import BAD_PORT, check, find

HERE = Path(__file__).resolve().parent
LOADED = ["height", "slenderness"]
MENU = ["My distortion", "Longest edge", "Height of the center", "Slenderness"]
LIMIT = 2.2  # of the acceptable slenderness
HISTORY = 1  # output of Optimize Mesh
PIECES = 2
CRITERIA = 6  # output of Element Quality


@check
def load():
    """In this process and in the server's; a metric that is registered here only is reported as such."""
    assert sorted(tautline.load_metrics(HERE.parent / "Python" / "metrics_to_load.py")) == LOADED
    remote = servermanager.ActiveConnection.IsRemote()
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        tautline.register_metric("one_side", lambda corners, cell: numpy.ones(len(corners)), label="One side")
    texts = [str(warning.message) for warning in caught]
    assert len(texts) == remote, texts
    assert not remote or "one_side is registered in this process only" in texts[0] and "load_metrics" in texts[0], texts
    tautline.unregister_metric("one_side")
    # The library is known to the process that executes filters.
    assert remote == ("TAUTLINE_METRICS" not in os.environ)
    assert remote or "my_distortion" in {facts["name"] for facts in tautline.metrics()}


def edges_of(mesh):
    """The lengths of the six edges of each tetrahedron."""
    points = vtk_to_numpy(mesh.GetPoints().GetData()).astype(float)
    corners = points[vtk_to_numpy(mesh.GetCells().GetConnectivityArray()).reshape(-1, 4)]
    pairs = [(i, k) for i in range(4) for k in range(i)]
    return numpy.stack([numpy.linalg.norm(corners[:, i] - corners[:, k], axis=1) for i, k in pairs], axis=-1)


@check
def measured():
    """The values of numpy; the menu has all metrics; the client has the facts of the server's metrics."""
    quality = find("ElementQuality")
    menu = quality.GetProperty("Metrics").GetAvailable()
    assert menu[-len(MENU) :] == MENU, menu[38:]
    chosen = list(quality.Metrics)
    assert chosen == ["Longest edge", "Slenderness"], chosen
    mesh = servermanager.Fetch(quality)
    edges = edges_of(mesh)
    slenderness = edges.max(axis=1) / edges.min(axis=1)
    for name, expected in (("longest_edge", edges.max(axis=1)), ("slenderness", slenderness)):
        assert numpy.allclose(vtk_to_numpy(mesh.GetCellData().GetArray(name)), expected, rtol=1e-6), name
    outside = int((slenderness > LIMIT).sum())
    values = f"Slenderness: {slenderness.min():.6g} to {slenderness.max():.6g}, mean {slenderness.mean():.6g}"
    expected = f"{values}; {outside} of {len(edges)} outside the acceptable range."
    assert expected in quality.Summary and outside > 100, (expected, quality.Summary)
    bad = simple.OutputPort(quality, BAD_PORT).GetDataInformation().GetNumberOfCells()
    assert bad == outside, (bad, outside)
    known = {facts["name"]: facts for facts in tautline.metrics()}
    assert known["my_distortion"]["formula"] == "|T|^2 / det T^(2/n) - n", known["my_distortion"]


@check
def colored():
    """By the metric that was chosen in the tool bar, in colors for its acceptable range."""
    shown = simple.GetDisplayProperties(find("ElementQuality"))
    assert list(shown.ColorArrayName) == ["CELLS", "slenderness"], shown.ColorArrayName[:]
    points = shown.LookupTable.RGBPoints
    assert points[0] == 1 and LIMIT in list(points[::4]), list(points[::4])


@check
def graded():
    """By the first row of the table, with the limits 3 and 10 of the preset."""
    quality = find("ElementQuality")
    edges = edges_of(servermanager.Fetch(quality))
    slenderness = edges.max(axis=1) / edges.min(axis=1)
    assert quality.Summary.startswith('Failed by the criteria "mine": of 8140 elements'), quality.Summary
    table = servermanager.Fetch(quality, idx=CRITERIA)
    found = [table.GetValueByName(0, name).ToString() for name in ("Metric", "Warning", "Failed")]
    warned = int(((slenderness >= 3) & (slenderness < 10)).sum())
    assert warned > 10 and found == ["slenderness", str(warned), "0"], (found, warned)


@check
def select_mesh():
    simple.SetActiveSource(find("ElementQuality").Input)


@check
def optimized():
    """By the compiled metric: its sum was lowered."""
    optimizer = find("MeshOptimizer")
    assert optimizer.Metric1 == "My distortion", optimizer.Metric1
    history = servermanager.Fetch(optimizer, idx=HISTORY)
    objective = vtk_to_numpy(history.GetColumnByName("Objective"))
    assert len(objective) > 1 and objective[-1] < 0.99 * objective[0], objective
    assert history.GetColumnByName("my_distortion worst"), "no column of the metric"


@check
def write_pieces():
    """The tangled bracket as a file of two pieces, cut in the middle."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(HERE.parents[1] / "Data" / "bracket-tangled.vtu"))
    reader.Update()
    mesh = reader.GetOutput()
    cells = vtk_to_numpy(mesh.GetCells().GetConnectivityArray()).reshape(-1, 4)
    points = vtk_to_numpy(mesh.GetPoints().GetData())
    axis = int(numpy.argmax(numpy.ptp(points, axis=0)))
    centres = points[cells].mean(axis=1)[:, axis]
    own = (centres > numpy.median(centres)).astype(int)
    folder = Path(os.environ["TAUTLINE_TEST_DIR"])
    for piece in range(PIECES):
        write_cells(mesh, cells[own == piece], folder / f"pieces_{piece}.vtu")
    kind = points.dtype.name.capitalize()
    parts = "".join(f'<Piece Source="pieces_{piece}.vtu"/>' for piece in range(PIECES))
    (folder / "pieces.pvtu").write_text(
        '<?xml version="1.0"?>\n<VTKFile type="PUnstructuredGrid" version="0.1"><PUnstructuredGrid GhostLevel="0">'
        f'<PPoints><PDataArray type="{kind}" NumberOfComponents="3"/></PPoints>{parts}</PUnstructuredGrid></VTKFile>\n',
        encoding="utf-8",
    )  # fmt: skip


def write_cells(mesh, cells, file):
    """Tetrahedra of a mesh, with the points that they use."""
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import VTK_TETRA, vtkCellArray, vtkUnstructuredGrid

    used, local = numpy.unique(cells, return_inverse=True)
    grid, places, array = vtkUnstructuredGrid(), vtkPoints(), vtkCellArray()
    places.SetData(numpy_to_vtk(vtk_to_numpy(mesh.GetPoints().GetData())[used], deep=True))
    grid.SetPoints(places)
    for cell in local.reshape(-1, 4):
        array.InsertNextCell(4, [int(point) for point in cell])
    grid.SetCells(VTK_TETRA, array)
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(str(file))
    writer.SetInputData(grid)
    writer.SetDataModeToBinary()
    assert writer.Write() == 1


@check
def in_pieces():
    """Each process of the server has half of the cells; the client has numbers of the whole mesh."""
    quality = find("ElementQuality")
    assert servermanager.ActiveConnection.GetNumberOfDataPartitions() == PIECES
    meshes = [servermanager.Fetch(quality, piece) for piece in range(PIECES)]
    here = [mesh.GetNumberOfCells() for mesh in meshes]
    assert here == [4070, 4070], here
    arrays = [[vtk_to_numpy(mesh.GetCellData().GetArray(name)) for mesh in meshes] for name in ("imr", "Validity")]
    values, validity = (numpy.concatenate(parts) for parts in arrays)
    inverted = int((validity < 0).sum())
    outside = int(((values < 1) | (values > 3)).sum())
    assert len(values) == sum(here) and inverted == 41, (len(values), inverted)
    expected = (
        f"{len(values) - inverted} valid elements, {inverted} inverted, 0 degenerate.\n"
        f"Inverse mean ratio: {values.min():.6g} to {values.max():.6g}, mean {values.mean():.6g}; "
        f"{outside} of {len(values)} outside the acceptable range."
    )
    assert quality.Summary.startswith(expected), (expected, quality.Summary)
    # The elements are numbered in the piece of each process.
    found = re.search(r"Worst: element ([0-9]+) of process ([01]) \(([-0-9.]+)\)", quality.Summary)
    cell, process, value = found.groups()
    element = int(cell) + sum(here[: int(process)])
    assert numpy.isclose(values[element], float(value), rtol=1e-5), (element, value, values[element])
    statistics = servermanager.Fetch(quality, idx=1)
    assert statistics.GetNumberOfRows() == 1
    assert numpy.isclose(statistics.GetValueByName(0, "Mean").ToDouble(), values.mean(), rtol=1e-12)
