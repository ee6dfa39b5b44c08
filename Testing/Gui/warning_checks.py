# SPDX-License-Identifier: BSD-3-Clause
"""Checks of what a run reports: that it ran, of all blocks, and what it left invalid. See session_checks.py."""

import re

import numpy
from paraview import servermanager, simple
from session_checks import check, find
from vtkmodules.util.numpy_support import vtk_to_numpy

STRETCH = 1.5  # of the first block


def summary_of(name):
    source = find(name)
    source.SMProxy.UpdatePropertyInformation()
    return source.Summary


@check
def not_run():
    assert summary_of("ElementQuality") == "", summary_of("ElementQuality")
    assert find("ElementQuality").SMProxy.GetDataInformation(0).GetNumberOfCells() == 0


@check
def run():
    assert "8140" in summary_of("ElementQuality"), summary_of("ElementQuality")


@check
def left_invalid():
    left = int((vtk_to_numpy(servermanager.Fetch(find("MeshOptimizer")).GetCellData().GetArray("Validity")) < 1).sum())
    summary = summary_of("MeshOptimizer")
    found = re.match(r"Warning: (\d+) elements? (is|are) inverted or degenerate \(\d+ before\)", summary)
    assert found and int(found[1]) == left > 0, (left, summary)


@check
def none_left():
    optimizer = find("MeshOptimizer")
    assert optimizer.FreeInvalidElements == 1
    assert (vtk_to_numpy(servermanager.Fetch(optimizer).GetCellData().GetArray("Validity")) == 1).all()
    assert "Warning" not in summary_of("MeshOptimizer"), summary_of("MeshOptimizer")


@check
def open_blocks():
    """Two structured blocks of eight cubes; the first is stretched."""
    blocks = []
    for scale, place in ((STRETCH, 0), (1, 10)):
        moved = simple.Transform(Input=simple.Wavelet(WholeExtent=[-1, 1] * 3))
        moved.Transform.Scale = [scale, 1, 1]
        moved.Transform.Translate = [place, 0, 0]
        blocks.append(moved)
    group = simple.GroupDatasets(Input=blocks)
    simple.Show(group)
    simple.SetActiveSource(group)


@check
def surface_shown():
    optimizer = find("MeshOptimizer")
    blocks = servermanager.Fetch(optimizer)
    assert blocks.GetBlock(0).IsA("vtkStructuredGrid"), blocks.GetBlock(0).GetClassName()
    shown = simple.GetDisplayProperties(optimizer, next(v for v in simple.GetViews() if v.GetXMLName() == "RenderView"))
    assert shown.Visibility and shown.Representation == "Surface", shown.Representation
    values = [vtk_to_numpy(blocks.GetBlock(i).GetCellData().GetArray("imr")).max() for i in range(2)]
    stretched = (STRETCH**2 + 2) / (3 * STRETCH ** (2 / 3))
    assert numpy.allclose(values, (stretched, 1)), values
