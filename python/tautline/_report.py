# SPDX-License-Identifier: BSD-3-Clause
"""The function report: the quality of a mesh, and of the mesh before, as one HTML file."""

from __future__ import annotations

import argparse
import os
from html import escape
from os import PathLike
from typing import Any

from . import _commands
from ._arguments import text
from ._errors import interruptible
from ._files import check_stream_or_target, file_name, replace_text
from ._html import html_report
from ._interrupts import Progress
from ._io import Mesh
from ._metrics import Metrics
from ._quality import measure
from ._quality_parts import QualityResult, quality_result
from ._views import viewed

_KILOBYTE = 1000


class ReportResult(str):
    """What report() returns: the HTML as a text, which prints in a few lines.

    Attributes
    ----------
    html : str
        The HTML.
    file : str | None
        The name of the file written; None if there is none.
    title : str
        The title.
    quality : QualityResult
        The result of quality() for the mesh.
    before : QualityResult | None
        The same for the mesh before it was changed, or None.
    """

    html: str
    file: str | None
    title: str  # type: ignore[assignment]
    quality: QualityResult
    before: QualityResult | None

    @classmethod
    def make(cls, html: str, **facts: Any) -> ReportResult:
        """A result with these attributes."""
        made = cls(html)
        made.__dict__.update(facts, html=html)
        return made

    def __repr__(self) -> str:
        place = f", {self.file}" if self.file else "; save(FILE) writes it"
        return f"ReportResult: {self.title}, {len(self) / _KILOBYTE:.0f} kB of HTML{place}\n{self.quality.summary}"

    __str__ = __repr__

    def _repr_html_(self) -> str:
        """For notebooks."""
        return f"<pre>{escape(repr(self))}</pre>"

    def save(self, file: str | PathLike[str]) -> None:
        """Replace a file by the HTML."""
        replace_text(file, self.html)


@interruptible
def report(
    mesh: Mesh,
    file: str | PathLike[str] | None = None,
    *,
    before: Mesh | None = None,
    metrics: Metrics = ("imr",),
    criteria: str | PathLike[str] | dict[str, Any] | None = None,
    title: str | None = None,
    histogram_bins: int = 32,
    time_limit: float = 0.0,
    threads: int = 0,
    progress: Progress | bool | None = None,
) -> ReportResult:
    """Report the quality of a mesh as one HTML file that needs no other file.

    It is the report of Save Report in ParaView: source, settings that are not the default, mesh, result, picture,
    histogram and tables. The picture is colored by the first metric, and inverted elements inside are visible; it needs
    no display.

    Parameters
    ----------
    mesh : Mesh
        A vtkDataSet, a composite data set, a file name or (points, cells). It is not changed.
    file : str or path, optional
        The HTML file to write; the default writes none.
    before : Mesh, optional
        The mesh before it was changed: the report has pictures, histograms and tables of both meshes and, if the cells
        are the same, the numbers of elements that became better and worse.
    metrics : Metrics, default ("imr",)
        See quality().
    criteria : str or path or dict[str, Any], optional
        See quality().
    title : str, optional
        The default is the name of the file of the mesh.
    histogram_bins : int, default 32
        Number of bins, 1 to 100000.
    time_limit : float, default 0.0
        Seconds for each mesh; 0 is no limit.
    threads : int, default 0
        Number of threads; 0 is all cores. The result does not depend on it.
    progress : bool or callable, optional
        True: a bar on the terminal, if there is one. Else a function, called ten times a second with the fraction done,
        0 to 1, and a text; it cancels by returning False, which raises Aborted. Ctrl-C raises KeyboardInterrupt.

    Returns
    -------
    ReportResult
        The HTML, a str with further attributes that prints in a few lines.

    Raises
    ------
    Error
        For wrong arguments, for meshes that quality() rejects and if the file cannot be written.

    Examples
    --------
    >>> better = tautline.optimize("part.vtu")
    >>> tautline.report(better, "report.html", before="part.vtu", criteria="fem")
    """
    if file is not None:
        check_stream_or_target(file)
    if title is not None:
        text("title", title)
    options: dict[str, Any] = {
        "criteria": criteria, "histogram_bins": histogram_bins, "time_limit": time_limit, "threads": threads,
    }  # fmt: skip
    first = None if before is None else measure(before, metrics, **options)
    measured = measure(mesh, metrics, **options)
    settings: dict[str, Any] = {"metrics": metrics, **options}
    settings["before"] = before if isinstance(before, (str, PathLike)) else None
    html = html_report(measured, mesh, settings, first, title)
    if file is not None:
        replace_text(file, html)
    label = measured.GetOutputDataObject(0).GetClassName()
    if isinstance(mesh, (str, PathLike)):
        label = os.path.basename(file_name(mesh))
    return ReportResult.make(
        html,
        file=None if file is None else file_name(file),
        title=title or label,
        quality=_result(measured),
        before=None if first is None else _result(first),
    )


def _result(filter_: Any) -> QualityResult:
    return quality_result(filter_, viewed(filter_.GetOutputDataObject(0)))


# --- the shell ----------------------------------------------------------------------------------------------


def add_commands(commands: Any) -> None:
    """Add `report` to the subparsers of the command line."""
    parser = _commands.add_command(
        commands, "report", _run, "write the quality of a mesh as one HTML file",
        example="part.vtu -o report.html --criteria fem",
        details="It is the report of Save Report in ParaView: pictures, histograms, tables and changed settings.",
    )
    _commands.add_mesh(parser)
    parser.add_argument("-o", "--out", "--output", dest="report", metavar="FILE", required=True, help="the HTML file")
    parser.add_argument("--before", metavar="FILE", help="the mesh before it was changed, to compare with")
    _commands.add_metrics(parser)
    parser.add_argument("--criteria", metavar="NAME|FILE", help="grade the elements by a preset or JSON file")
    parser.add_argument("--title", metavar="TEXT", help="default: the name of the file")
    parser.add_argument("--histogram-bins", type=int, default=32, metavar="N", help="number of bins (default: 32)")
    _commands.add_time_limit(parser)


def _run(arguments: argparse.Namespace) -> None:
    options = _commands.given(arguments, (
        "before", "metrics", "criteria", "title", "histogram_bins", "time_limit", "threads",
    ))  # fmt: skip
    html = report(arguments.mesh, **options)
    facts: dict[str, Any] = {"title": options["title"] or str(arguments.mesh)}
    _commands.finish(arguments, None, "", texts={arguments.report: html.html}, facts=facts)
