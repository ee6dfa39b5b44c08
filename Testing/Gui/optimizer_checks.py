# SPDX-License-Identifier: BSD-3-Clause
"""Checks of Optimize Mesh in a session: its features, regions and Geometry. See session_checks.py."""

import os

import numpy
from paraview import servermanager, simple
from session_checks import chart_in, check, find
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

CORNER = 2  # of the array FeatureKind
SMALLER, LARGER = 0.5, 0.52  # radii of spheres
LINE_COLOR, NEAR = (31, 120, 181), 40  # of the objective in the chart


def tetrahedron_volumes(mesh):
    points = vtk_to_numpy(mesh.GetPoints().GetData()).astype(float)
    cells = vtk_to_numpy(mesh.GetCells().GetConnectivityArray()).reshape(-1, 4)
    edges = points[cells[:, 1:]] - points[cells[:, :1]]
    return numpy.einsum("ij,ij->i", edges[:, 0], numpy.cross(edges[:, 1], edges[:, 2])) / 6


@check
def features_kept():
    """The features belong to a box that an interface cuts in two; they and the volumes of both parts are kept."""
    optimizer = find("MeshOptimizer")
    before, after = servermanager.Fetch(optimizer.Input), servermanager.Fetch(optimizer)
    kinds, patches = (vtk_to_numpy(after.GetPointData().GetArray(name)) for name in ("FeatureKind", "PatchId"))
    region = vtk_to_numpy(after.GetCellData().GetArray("Reference"))
    cells = vtk_to_numpy(after.GetCells().GetConnectivityArray()).reshape(-1, 4)
    then, now = (vtk_to_numpy(mesh.GetPoints().GetData()).astype(float) for mesh in (before, after))
    shared = numpy.intersect1d(*(cells[region == number] for number in numpy.unique(region)))
    cut = then[shared, 0].mean()
    planes = numpy.zeros(len(then), int)  # on how many sides of the box, or on the interface, a point is
    for axis, places in enumerate(((0, cut, 2), (0, 1), (0, 0.5))):
        planes += numpy.isclose(then[:, axis, None], places, rtol=0, atol=1e-6).any(axis=1)
        for place in places:
            flush = numpy.isclose(then[:, axis], place, rtol=0, atol=1e-6)
            assert flush.sum() > 4 and numpy.allclose(now[flush, axis], place, rtol=0, atol=1e-5), (axis, place)
    on = planes > 0
    assert numpy.array_equal(kinds[on], planes[on] - 1), numpy.unique(kinds[on] - planes[on])
    assert (kinds == CORNER).sum() == 12 and numpy.array_equal(now[kinds == CORNER], then[kinds == CORNER])
    assert len(numpy.unique(patches[kinds == 0])) <= 11 and "11 patches" in optimizer.Summary, optimizer.Summary
    moved = numpy.linalg.norm(now - then, axis=1)
    assert moved[planes == 1].max() > 1e-3 and moved[shared].max() > 1e-3, moved[shared]
    volumes = [[tetrahedron_volumes(mesh)[region == number].sum() for number in numpy.unique(region)]
               for mesh in (before, after)]  # fmt: skip
    assert numpy.allclose(*volumes, rtol=1e-5) and tetrahedron_volumes(after).min() > 0, volumes


@check
def objective_drawn():
    """The line of an objective that falls by little, which VTK does not draw on a logarithmic axis."""
    table = servermanager.Fetch(find("MeshOptimizer"), idx=1)
    objective = vtk_to_numpy(table.GetColumnByName("Objective"))
    assert 1 < objective.max() / objective.min() < 1.1, objective
    view, _ = chart_in("XYChartView")
    file = os.path.join(os.environ["TAUTLINE_TEST_DIR"], "history.png")
    simple.SaveScreenshot(file, view)
    reader = vtkPNGReader()
    reader.SetFileName(file)
    reader.Update()
    image = reader.GetOutput()
    width, height, _ = image.GetDimensions()
    pixels = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)[:, :, :3].astype(int)
    # Its color without the legend, which is at the top on the right.
    drawn = (numpy.abs(pixels - LINE_COLOR) < NEAR).all(axis=2)
    drawn[height // 2 :, width // 2 :] = False
    assert drawn.sum() > width // 4, drawn.sum()


@check
def color_by_features():
    optimizer = find("MeshOptimizer")
    simple.ColorBy(simple.GetDisplayProperties(optimizer), ("POINTS", "FeatureKind"))
    simple.GetDisplayProperties(optimizer).Representation = "Surface With Edges"
    simple.HideUnusedScalarBars()
    simple.GetDisplayProperties(optimizer).SetScalarBarVisibility(simple.GetActiveView(), True)
    simple.ResetCamera()
    simple.Render()


@check
def open_spheres():
    """A coarse sphere in the view, active; and a file of STL with a larger, finer one."""
    file = os.path.join(os.environ["TAUTLINE_TEST_DIR"], "finer.stl")
    fine = simple.Sphere(ThetaResolution=80, PhiResolution=80, Radius=LARGER)
    simple.SaveData(file, proxy=fine)
    simple.Delete(fine)
    finer = simple.STLReader(registrationName="finer.stl", FileNames=[file])
    finer.UpdatePipeline()
    coarse = simple.Sphere(registrationName="coarse", ThetaResolution=12, PhiResolution=9, Radius=SMALLER)
    simple.Show(coarse)
    simple.ResetCamera()
    simple.SetActiveSource(coarse)


@check
def on_geometry():
    """All points are on the larger sphere, with better triangles than the coarse one."""
    optimizer = find("MeshOptimizer")
    assert optimizer.Geometry is not None and optimizer.Geometry.GetXMLName() == "stlreader", optimizer.Geometry
    before, after = servermanager.Fetch(optimizer.Input), servermanager.Fetch(optimizer)
    radii = [numpy.linalg.norm(vtk_to_numpy(mesh.GetPoints().GetData()), axis=1) for mesh in (before, after)]
    assert numpy.allclose(radii[0], SMALLER, rtol=1e-5) and after.GetNumberOfPoints() == before.GetNumberOfPoints()
    # Its facets are up to 0.001 inside it.
    assert LARGER - 1e-3 < radii[1].min() <= radii[1].max() < LARGER * (1 + 1e-5), (radii[1].min(), radii[1].max())
    quality = [vtk_to_numpy(after.GetCellData().GetArray(name)).mean() for name in ("imr_before", "imr")]
    assert quality[1] < 0.99 * quality[0], quality
