# SPDX-License-Identifier: BSD-3-Clause
"""The HTML of a report on the quality of a mesh, from the filters that have measured it."""

from __future__ import annotations

from datetime import datetime, timezone
from os import PathLike
from typing import Any

from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet, vtkDataSet

from . import _vtk
from ._errors import Error, Messages, run

_TABLES = (1, "Statistics"), (2, "Distribution"), (3, "Angles"), (6, "Criteria")  # output ports
_COMPARED = (
    ("worst", "Worst"), ("mean", "Mean"), ("minimum", "Minimum"), ("maximum", "Maximum"),
    ("unacceptable", "OutsideAcceptable"), ("inverted", "Inverted"), ("degenerate", "Degenerate"),
)  # fmt: skip


def html_report(
    measured: Any, name: Any, settings: dict[str, Any], before: Any = None, title: str | None = None
) -> str:
    """The report of a filter of vtkElementQuality that was executed.

    name: what was measured: a file name, else the class of the data is the name.
    settings: what was chosen, by name; None and "" are left out.
    before: the filter of the mesh before, with the same metrics.
    title: the default is the name.
    """
    report = _vtk.vtkHtmlReport()
    messages = Messages(report)
    label = str(name) if isinstance(name, (str, PathLike)) else measured.GetOutputDataObject(0).GetClassName()
    now = datetime.now(timezone.utc).isoformat(" ", "seconds")
    report.Begin(title or label, f"Element Quality, Tautline. {now}")
    report.AddHeading("Mesh")
    _add_mesh(report, measured.GetOutputDataObject(0))
    report.AddHeading("Result")
    report.AddText(measured.GetSummary())
    metrics = _metrics(measured)
    shown = metrics[0]
    if before is None:
        report.AddMeshPicture(measured.GetOutputDataObject(0), shown)
    else:
        _add_comparison(report, before, measured, metrics)
        report.AddMeshPictures(before.GetOutputDataObject(0), measured.GetOutputDataObject(0), shown)
        report.AddHeading("Histogram before")
        report.AddHistograms(before.GetStatistics(), before.GetHistogram())
    report.AddHeading("Histogram" if before is None else "Histogram after")
    report.AddHistograms(measured.GetStatistics(), measured.GetHistogram())
    for port, heading in _TABLES:
        table = measured.GetOutputDataObject(port)
        if table.GetNumberOfRows():
            report.AddHeading(heading)
            report.AddTable(table)
    report.AddHeading("Settings")
    for key, value in settings.items():
        if value is not None and value != "":
            report.AddRow(key.replace("_", " "), _text(value))
    messages.raise_errors()
    return str(report.GetHtml())


def _metrics(measured: Any) -> list[str]:
    names = measured.GetStatistics().GetColumnByName("Metric")
    return [names.GetValue(row) for row in range(names.GetNumberOfValues())]


def _add_mesh(report: Any, mesh: Any) -> None:
    """Type, size and extent, as in ParaView's report."""
    bounds = [0.0] * 6
    mesh.GetBounds(bounds)
    report.AddRow("Type", mesh.GetClassName())
    report.AddRow("Points", str(mesh.GetNumberOfPoints()))
    report.AddRow("Cells", str(mesh.GetNumberOfCells()))
    for axis, letter in enumerate("xyz"):
        low, high = bounds[2 * axis : 2 * axis + 2]
        report.AddRow(letter, f"{low:g} to {high:g}" if low <= high else "empty")


def _add_comparison(report: Any, before: Any, after: Any, metrics: list[str]) -> None:
    """The statistics before and after and, of meshes with the same cells, the elements that changed."""
    report.AddHeading("Before and after")
    for row, metric in enumerate(metrics):
        for label, column in _COMPARED:
            values = [filter_.GetStatistics().GetValueByName(row, column).ToDouble() for filter_ in (before, after)]
            report.AddRow(f"{metric}, {label}", " to ".join(f"{value:.6g}" for value in values))
    inputs = before.GetInputDataObject(0, 0), after.GetInputDataObject(0, 0)
    compare = _vtk.vtkMeshComparison()
    for metric in metrics:
        compare.AddMetricByName(metric)
    for port, mesh in enumerate(inputs):
        compare.SetInputDataObject(port, mesh)
    try:
        run(compare)
    except Error:  # of other cells: its connectivity was changed, which a report can be of, too
        report.AddText("The meshes have different cells: there is no comparison element by element.")
        return
    report.AddTable(compare.GetOutputDataObject(1))


def _text(value: Any) -> str:
    if isinstance(value, (list, tuple)):
        return ", ".join(map(str, value))
    if isinstance(value, (vtkDataSet, vtkCompositeDataSet)):
        return str(value.GetClassName())
    return str(value)
