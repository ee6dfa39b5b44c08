# SPDX-License-Identifier: BSD-3-Clause
"""Options and reports of the studies: tables, pictures and findings, and the files that they are written to."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import Any, Sequence

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

from tautline._errors import Error
from tautline._files import make_folder, replace_text, save_figure
from tautline._tables import align, csv_rows

from ._meshes import cells_of, points_of, sizes_of
from ._verdicts import DOES_NOT_HOLD, HOLDS, TOO_SMALL, Verdict, word

try:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot
    from matplotlib.collections import PolyCollection
except ImportError:  # the report then has no pictures, and a note
    pyplot = None

#: Default inner steps per patch of Mesquite's nonlinear conjugate gradients.
MESQUITE_PATCH_ITERATIONS = 5
#: A curve that exceeds this multiple of its start would flatten the others; the axis ends below.
BEYOND = 3.0


def parser(name: str, text: str | None, cells: int = 0, threads: int | None = 1, repeats: int = 0,
           steps: bool = False) -> Options:
    """The options every study has.

    threads: the default, None for studies that always use one. cells, repeats, steps: further options, see below.
    """
    made = Options(prog=f"python3 -m tautline study {name}", description=(text or "").split("\n")[0])
    made.add_argument("--small", action="store_true", help="a small mesh, for a test: seconds; without verdicts")
    made.add_argument(
        "--out", type=Path, default=Path(f"study-{name}"), metavar="DIR", help="directory of the output (%(default)s)",
    )
    if threads is not None:
        made.add_argument("--threads", type=int, default=threads,
                          help="0 is all cores (%(default)s" + (", for comparable times)" if threads == 1 else ")"))
    if repeats:
        made.add_argument("--repeats", type=int, default=repeats, metavar="N",
                          help="runs of what is timed; a verdict on times needs several (default: %(default)s)")
    if cells:
        made.add_argument("--cells", type=int, default=0, help=f"approximate number (default: {cells:,})")
    if steps:
        made.add_argument("--patch-iterations", type=int, default=MESQUITE_PATCH_ITERATIONS,
                          help="conjugate gradient steps per vertex and sweep (default: %(default)s, Mesquite's)")
    return made


class Options(argparse.ArgumentParser):
    """The options of a study."""

    def parse_args(self, *arguments: Any, **more: Any) -> argparse.Namespace:  # type: ignore[override]
        given = super().parse_args(*arguments, **more)
        if getattr(given, "repeats", 1) < 1:
            raise Error(f"--repeats is {given.repeats}; at least one run is needed")
        if given.small and hasattr(given, "repeats"):
            given.repeats = 1
        return given


class Report:
    """Collects tables, pictures and findings of a study and writes them to a directory.

    small: whether the meshes are too small for verdicts; the findings then have figures only.
    """

    def __init__(self, name: str, title: str, out: Path, small: bool = False) -> None:
        self.name, self.out, self.small = name, Path(out), small
        self.parts = [f"{title}\n{'=' * len(title)}"]
        self.findings: list[tuple[str, str, str, str]] = []  # source, sentence, verdict, figures
        make_folder(self.out)

    def text(self, paragraph: str) -> None:
        self.parts.append(paragraph)

    def table(self, file: str, title: str, headings: Sequence[str], rows: Sequence[Sequence[Any]]) -> None:
        """A table in the text and a CSV file."""
        self.csv(file, headings, rows)
        shown = [[_short(value) for value in row] for row in rows]
        self.parts.append(f"{title}  [{file}.csv]\n{align(shown, headings)}")

    def beside(self, file: str, title: str, columns: Sequence[Any], ours: dict[str, Sequence[float]],
               theirs: dict[str, Sequence[float]], head: str = "method") -> None:
        """Our numbers, with those of the dissertation in brackets; the CSV file has separate columns for them."""
        rows, shown = [], []
        for label, values in ours.items():
            known = list(theirs.get(label, [])) or [math.nan] * len(values)
            rows.append([label, *values, *known])
            pairs = zip(values, known)
            shown.append([label, *(_short(v) + ("" if math.isnan(k) else f" ({_short(k)})") for v, k in pairs)])
        names = [str(column) for column in columns]
        self.csv(file, [head, *names, *(f"{name} dissertation" for name in names)], rows)
        title = f"{title}; in brackets those of the dissertation  [{file}.csv]"
        self.parts.append(f"{title}\n{align(shown, [head, *names])}")

    def csv(self, file: str, headings: Sequence[str], rows: Sequence[Sequence[Any]]) -> None:
        shown = [["" if _missing(value) else value for value in row] for row in rows]
        replace_text(self.out / f"{file}.csv", csv_rows([headings, *shown], "\r\n"))

    def curves(self, file: str, runs: Sequence[Any]) -> None:
        """A CSV file of every quantity of every run after every iteration."""
        names = list(runs[0].values)
        rows = [
            [r.method.name, r.optimizer, int(r.iterations[i]), r.seconds[i], *(r.values[name][i] for name in names)]
            for r in runs
            for i in range(len(r.iterations))
        ]
        self.csv(file, ["method", "optimizer", "iteration", "cpu_seconds", *names], rows)

    def finding(self, source: str, sentence: str, holds: Verdict, figures: str, any_size: bool = False) -> None:
        """Add a statement of the dissertation, whether our numbers agree with it (None: not decided), and the numbers.

        any_size: whether a small mesh decides it, too.
        """
        verdict = TOO_SMALL if self.small and not any_size else word(None if holds is None else bool(holds))
        self.findings.append((source, sentence, verdict, figures))

    def plot(self, file: str, runs: Sequence[Any], panels: Sequence[tuple[str, str, bool]]) -> None:
        """A picture of quantities against iterations; a panel is (quantity, label of the axis, logarithmic)."""
        if not self._pictures():
            return
        figure, axes = pyplot.subplots(1, len(panels), figsize=(6.4 * len(panels), 4.6), squeeze=False)
        for axis, (quantity, label, logarithmic) in zip(axes[0], panels):
            for number, (run_, marker) in enumerate(zip(runs, "osv^D<>*xp+")):
                # The last one is dashed, so that the one it hides can be seen.
                line = "--" if number == len(runs) - 1 else "-"
                axis.plot(run_.iterations, run_.values[quantity], line, marker=marker, markersize=4,
                          linewidth=1.2, label=run_.method.label)
            axis.xaxis.get_major_locator().set_params(integer=True)
            axis.set(xlabel="iterations", ylabel=label, yscale="log" if logarithmic else "linear")
            axis.grid(alpha=0.3)
            start = runs[0].first(quantity)
            beyond = [r.method.label for r in runs if r.values[quantity].max() > BEYOND * start > 0]
            if beyond and not logarithmic:
                axis.set_ylim(top=1.05 * start)
                axis.set_title("beyond the axis: " + ", ".join(beyond), fontsize=8)
        axes[0][0].legend(fontsize=8)
        self.save(figure, file)

    def meshes(self, file: str, shown: Sequence[tuple[str, vtkDataSet]], columns: int = 4,
               window: Sequence[float] | None = None) -> None:
        """A picture of meshes of triangles, inverted ones filled; window: xmin xmax ymin ymax."""
        if not self._pictures():
            return
        figure, axes = _panels(len(shown), columns, (4.2, 4.7))
        for axis, (title, mesh) in zip(axes, shown):
            axis.set_axis_off()
            p, cells, wrong = points_of(mesh)[:, :2], cells_of(mesh), sizes_of(mesh) <= 0
            if window is not None:
                near = p[cells]
                inside = ((near >= [window[0], window[2]]) & (near <= [window[1], window[3]])).all(axis=2).any(axis=1)
                cells, wrong = cells[inside], wrong[inside]
            axis.add_collection(PolyCollection(p[cells], facecolors="none", edgecolors="#1f4e79", linewidths=0.5))
            if wrong.any():
                axis.add_collection(PolyCollection(p[cells[wrong]], facecolors="#d000d055", edgecolors="#d000d0"))
            axis.autoscale_view()
            if window is not None:
                axis.set(xlim=window[:2], ylim=window[2:])
            axis.set_aspect("equal")
            axis.set_title(f"{title}\n{np.count_nonzero(wrong)} inverted", fontsize=9)
        self.save(figure, file)

    def lines(self, file: str, panels: Sequence[tuple[str, str, str, dict[str, tuple]]], columns: int = 2) -> None:
        """A picture of curves; a panel is (title, label of x, label of y, {label of a curve: (x, y)})."""
        if not self._pictures():
            return
        figure, axes = _panels(len(panels), columns, (5.6, 4.2))
        for axis, (title, x_label, y_label, curves) in zip(axes, panels):
            for number, (label, (x, y)) in enumerate(curves.items()):
                # There are ten colors; further curves are dashed.
                axis.plot(x, y, "-" if number < 10 else "--", marker="osv^D<>*xp"[number % 10], markersize=4,
                          linewidth=1.2, label=label)
            axis.set(title=title, xlabel=x_label, ylabel=y_label)
            places = np.concatenate([np.asarray(x, float) for x, _ in curves.values()])
            margin = 0.05 * np.ptp(places)
            axis.set_xlim(places.min() - margin, places.max() + margin)  # also of missing values
            axis.set_ylim(bottom=0)
            axis.grid(alpha=0.3)
            axis.legend(fontsize=7)
        self.save(figure, file)

    def grid(self, file: str, title: str, rows: Sequence[str], columns: Sequence[str],
             values: Sequence[Sequence[float]]) -> None:
        """A picture of a table of counts, darker for larger counts; 0 is white."""
        if not self._pictures():
            return
        figure, axis = pyplot.subplots(figsize=(1.6 + 0.95 * len(columns), 1.2 + 0.32 * len(rows)))
        shade = np.log1p(np.array(values, float))
        axis.imshow(np.ma.masked_equal(shade, 0), cmap="Reds", aspect="auto", vmin=0, vmax=max(1.0, 1.3 * shade.max()))
        for i, row in enumerate(values):
            for j, value in enumerate(row):
                axis.text(j, i, _short(value), ha="center", va="center", fontsize=8)
        axis.set_title(title, fontsize=10)
        axis.set_xticks(range(len(columns)), columns, fontsize=8)
        axis.set_yticks(range(len(rows)), rows, fontsize=8)
        self.save(figure, file)

    def polygons(self, file: str, titles: Sequence[str], drawings: Sequence[tuple[Sequence[np.ndarray], np.ndarray]],
                 windows: Sequence[Sequence[float] | None], columns: int, colors: tuple[str, str]) -> None:
        """A picture of panels of polygons, marked ones filled; a window is xmin xmax ymin ymax."""
        if not self._pictures():
            return
        rows = -(-len(drawings) // columns)
        # The heights of the rows follow from their contents.
        frames = [window or _frame(pieces) for (pieces, _), window in zip(drawings, windows)]
        ratios = [(top - bottom) / (right - left) for left, right, bottom, top in frames]
        heights = [4.2 * max(ratios[r * columns : (r + 1) * columns]) + 0.5 for r in range(rows)]
        figure, axes = pyplot.subplots(rows, columns, figsize=(4.2 * columns, sum(heights)), squeeze=False,
                                       gridspec_kw={"height_ratios": heights})
        plain, filled = colors
        for axis in axes.flat[len(drawings):]:
            axis.set_axis_off()
        for axis, title, (pieces, marked), frame in zip(axes.flat, titles, drawings, frames):
            axis.set_axis_off()
            axis.add_collection(PolyCollection(pieces, facecolors="none", edgecolors=plain, linewidths=0.3))
            if marked.any():
                wrong = [piece for piece, mark in zip(pieces, marked) if mark]
                axis.add_collection(PolyCollection(wrong, facecolors=filled + "80", edgecolors=filled, linewidths=0.8))
            axis.set(xlim=frame[:2], ylim=frame[2:])
            axis.set_aspect("equal")
            axis.set_title(title, fontsize=9)
        self.save(figure, file)

    def bars(self, file: str, bins: Sequence[str], axis_label: str, label: str,
             panels: dict[str, dict[str, Sequence[float]]], columns: int = 3) -> None:
        """A picture of distributions on a logarithmic axis: a panel has a row of bars for each of its series."""
        if not self._pictures():
            return
        figure, axes = _panels(len(panels), columns, (6.4, 4.6))
        for axis, (title, series) in zip(axes, panels.items()):
            width = 0.8 / len(series)
            for number, (name, values) in enumerate(series.items()):
                axis.bar(np.arange(len(bins)) + (number - 0.5 * (len(series) - 1)) * width, values, width, label=name)
            axis.set(
                title=title, xlabel=axis_label, ylabel=label, yscale="log", xticks=range(len(bins)), xticklabels=bins,
            )
            axis.grid(alpha=0.3, axis="y")
        axes[0].legend(fontsize=8)
        self.save(figure, file)

    def aligned(self, title: str, headings: Sequence[Any], rows: Sequence[Sequence[str]]) -> None:
        """A table of texts in the report, without a CSV file."""
        self.parts.append(f"{title}\n{align(rows, [str(heading) for heading in headings])}")

    def finish(self, heading: str = "Findings of the dissertation") -> int:
        """Write and print the report; `heading` is that of the findings."""
        verdicts = [verdict for _, _, verdict, _ in self.findings]
        undecided = len(verdicts) - verdicts.count(HOLDS) - verdicts.count(DOES_NOT_HOLD)
        lines = [f"{heading}: {verdicts.count(HOLDS)} of {len(verdicts)} hold"
                 + (f", {undecided} are not decided" if undecided else "")]
        for source, sentence, verdict, figures in self.findings:
            lines.append(f"- {verdict.upper()} ({source}): {sentence}\n    ours: {figures}")
        self.parts.append("\n".join(lines))
        self.csv("findings", ["source", "finding", "verdict", "figures"], self.findings)
        text = "\n\n".join(self.parts) + "\n"
        replace_text(self.out / f"{self.name}.txt", text)
        print(text)
        print(f"Files: {self.out}")
        return 0

    def _pictures(self) -> bool:
        missing = "No pictures: matplotlib is not installed."
        if pyplot is None and missing not in self.parts:
            self.parts.append(missing)
        return pyplot is not None

    def save(self, figure: Any, file: str) -> None:
        """Save a figure of pyplot."""
        figure.tight_layout()
        save_figure(figure, self.out / f"{file}.png", dpi=110, bbox_inches="tight")
        pyplot.close(figure)


def _panels(count: int, columns: int, size: tuple[float, float]) -> tuple[Any, Sequence[Any]]:
    """A figure of panels in at most `columns` columns, and their axes; unused panels are hidden."""
    columns = min(columns, count)
    rows = -(-count // columns)
    figure, axes = pyplot.subplots(rows, columns, figsize=(size[0] * columns, size[1] * rows), squeeze=False)
    for axis in axes.flat[count:]:
        axis.set_axis_off()
    return figure, axes.flat


def _frame(pieces: Sequence[np.ndarray]) -> tuple[float, float, float, float]:
    """xmin xmax ymin ymax of polygons, and a margin."""
    points = np.concatenate(pieces)
    (left, bottom), (right, top) = points.min(axis=0), points.max(axis=0)
    margin = 0.02 * max(right - left, top - bottom)
    return left - margin, right + margin, bottom - margin, top + margin


def _missing(value: Any) -> bool:
    return isinstance(value, float) and not math.isfinite(value)


def _short(value: Any) -> str:
    if isinstance(value, str):
        return value
    if _missing(value):
        return "-"
    return f"{value:,.0f}" if float(value).is_integer() and abs(value) < 1e9 else f"{value:.4g}"


def percent(part: float) -> str:
    return f"{100 * part:.1f} %"
