# SPDX-License-Identifier: BSD-3-Clause
"""The HTML of a report on the quality of a mesh, from the filters that have measured it."""

from __future__ import annotations

import inspect
import os
from datetime import datetime, timezone
from importlib import import_module
from os import PathLike
from typing import Any

from . import _vtk
from ._errors import Messages

#: The labels in ParaView's panel of settings that are not their names.
_LABELS = {
    "target": "Target Type", "size": "Size Array", "tensor": "Tensor Array", "checks": "Solver Checks",
    "face_output": "Faces to Show", "face_convention": "Face Centers",
}  # fmt: skip
_LONGEST = 200  # of a value, such as criteria in JSON


def html_report(
    measured: Any, name: Any, settings: dict[str, Any], before: Any = None, title: str | None = None
) -> str:
    """The report of a filter of vtkElementQuality that was executed: that of Save Report in ParaView.

    name: what was measured: a file name, else the class of the data is the name.
    settings: what was chosen, by name; defaults are left out. "before" is the name of the file before.
    before: the filter of the mesh before, with the same metrics.
    title: the default is the name.
    """
    report = _vtk.vtkHtmlReport()
    messages = Messages(report)
    file = os.path.basename(os.fspath(name)) if isinstance(name, (str, PathLike)) else ""
    now = datetime.now(timezone.utc).isoformat(" ", "seconds")
    report.Begin(title or file or measured.GetOutputDataObject(0).GetClassName(), f"Element Quality, Tautline. {now}")
    report.SetFile(report.AFTER, file)
    file_before = settings.get("before")
    if isinstance(file_before, (str, PathLike)):
        report.SetFile(report.BEFORE, os.path.basename(os.fspath(file_before)))
    report.AddStep("Element Quality", "\n".join(_changed(settings, measured)))
    if before is not None:
        report.SetQuality(report.BEFORE, before)
    report.SetQuality(report.AFTER, measured)
    report.AddSections()
    messages.raise_errors()
    return str(report.GetHtml())


def _changed(settings: dict[str, Any], measured: Any) -> list[str]:
    """The settings that are not the default, "Label: value" as in ParaView's panel."""
    table = measured.GetStatistics()
    columns = table.GetColumnByName("Metric"), table.GetColumnByName("Label")
    labels = {columns[0].GetValue(row): columns[1].GetValue(row) for row in range(table.GetNumberOfRows())}
    defaults = inspect.signature(import_module("tautline._quality").quality).parameters
    lines = []
    for key, value in settings.items():
        names = _texts(value)
        if key == "before" or names == [""] or (key in defaults and names == _texts(defaults[key].default)):
            continue
        shown = ", ".join(labels.get(name, name) for name in names) if key == "metrics" else ", ".join(names)
        shown = shown if len(shown) <= _LONGEST else shown[:_LONGEST] + "..."
        lines.append(f"{_LABELS.get(key, key.replace('_', ' ').title())}: {shown}")
    return lines


def _texts(value: Any) -> list[str]:
    return list(map(_text, value)) if isinstance(value, (list, tuple)) else [_text(value)]


def _text(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, float):
        return f"{value:g}"
    return str(value.GetClassName()) if hasattr(value, "GetClassName") else str(value)
