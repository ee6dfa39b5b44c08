# SPDX-License-Identifier: BSD-3-Clause
"""A picture of a mesh for notebooks."""

from __future__ import annotations

import re
from typing import Any

from vtkmodules.vtkCommonDataModel import vtkDataObject

from . import _vtk
from ._arrays import leaves
from ._errors import Error, Messages, run

_BODY = re.compile(r"<body>\n?(.*)</body>", re.DOTALL)
#: The layout of picture and legend, which is in the head of the report.
_LAYOUT = (
    ("<img ", '<img style="max-width:30em" '),
    ('<div class="legend">', '<div style="display:flex;width:30em">'),
    ('<span style="background', '<span style="flex:1;height:1em;background'),
    ('<div class="ends">', '<div style="display:flex;justify-content:space-between;width:30em">'),
)
_METRIC = "imr"  # for meshes without an array of a metric


def picture_html(mesh: vtkDataObject) -> str:
    """The mesh colored by its first cell array of a metric, otherwise by the inverse mean ratio, as HTML.

    "" if there is nothing to measure, or if it is an image, whose cells are all alike.
    """
    if mesh.IsA("vtkImageData"):
        return ""
    known = _vtk.vtkElementQuality
    metrics = {known.GetKnownMetric(i).split("\t")[1] for i in range(known.GetNumberOfKnownMetrics())}
    arrays = [leaf.GetCellData() for leaf in leaves(mesh)]
    names = [data.GetArrayName(i) for data in arrays for i in range(data.GetNumberOfArrays())]
    shown = next((name for name in names if name in metrics), None)
    try:
        return _drawn(mesh if shown else _measured(mesh), shown or _METRIC)
    except Error:
        return ""


def _measured(mesh: vtkDataObject) -> vtkDataObject:
    measure = _vtk.vtkElementQuality()
    measure.AddMetricByName(_METRIC)
    measure.SetInputDataObject(mesh)
    run(measure)
    return measure.GetOutputDataObject(0)


def _drawn(mesh: vtkDataObject, metric: str) -> str:
    report = _vtk.vtkHtmlReport()
    messages = Messages(report)
    report.Begin("", "")
    before = _body(report)
    report.AddMeshPicture(mesh, metric)
    messages.raise_errors()
    html = _body(report)[len(before) :]
    for plain, styled in _LAYOUT:
        html = html.replace(plain, styled)
    return html


def _body(report: Any) -> str:
    found = _BODY.search(report.GetHtml())
    return found[1] if found else ""
