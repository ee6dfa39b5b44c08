# SPDX-License-Identifier: BSD-3-Clause
"""Options and reports of the studies: tables, pictures and findings, and the files that they are written to."""

from __future__ import annotations

import argparse
import datetime
import math
import platform
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Iterator, Sequence

import numpy as np
from vtkmodules.vtkCommonCore import vtkVersion
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline
from tautline._errors import Error
from tautline._files import make_folder, replace_text, save_figure
from tautline._tables import align, csv_rows, json_text

from . import _memory
from ._findings import COLUMNS, Finding, columns, merged, spread
from ._meshes import cells_of, points_of, sizes_of
from ._verdicts import HOLDS, TOO_SMALL, WORDS, Open, Verdict, word

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


#: Options that name files and folders: only their last part belongs to the results.
FILES = ("mesh", "data")
#: Formats of tables and pictures.
TABLE_FORMATS, PICTURE_FORMATS = ("csv", "json", "tex"), ("png", "svg", "pdf")


def parser(name: str, text: str | None, cells: int = 0, threads: int | None = 1, repeats: int = 0,
           steps: bool = False, seeds: bool = False) -> Options:
    """The options every study has.

    threads: the default, None for studies that always use one. cells, repeats, steps, seeds: further options, see
    below.
    """
    made = Options(prog=f"python3 -m tautline study {name}", description=(text or "").split("\n")[0])
    made.add_argument("--small", action="store_true", help="a small mesh, for a test: seconds; without verdicts")
    made.add_argument(
        "--out", type=Path, default=Path(f"study-{name}"), metavar="DIR", help="directory of the output (%(default)s)",
    )
    made.add_argument("--format", nargs="+", choices=(*TABLE_FORMATS, *PICTURE_FORMATS), default=["csv", "png"],
                      help="of tables and pictures (%(default)s; CSV, JSON and PNG are always written)")
    made.add_argument("--resume", action="store_true",
                      help="keep the results of long calculations in DIR/parts, and use those that are there")
    if threads is not None:
        made.add_argument("--threads", type=int, default=threads,
                          help="0 is all cores (%(default)s" + (", for comparable times)" if threads == 1 else ")"))
    if repeats:
        made.add_argument("--repeats", type=int, default=repeats, metavar="N",
                          help="runs of timed work; a verdict on times needs several (default: %(default)s)")
    if cells:
        made.add_argument("--cells", type=int, default=0, help=f"approximate number (default: {cells:,})")
    if steps:
        made.add_argument("--patch-iterations", type=int, default=MESQUITE_PATCH_ITERATIONS,
                          help="conjugate gradient steps per vertex and sweep (default: %(default)s, Mesquite's)")
    if seeds:
        made.add_argument("--seeds", type=int, default=1, metavar="N",
                          help="repeat the study with N seeds of its random numbers: medians, ranges, and verdicts "
                          "by the share of the seeds (default: %(default)s)")
    return made


class Options(argparse.ArgumentParser):
    """The options of a study."""

    def parse_args(self, *arguments: Any, **more: Any) -> argparse.Namespace:  # type: ignore[override]
        given = super().parse_args(*arguments, **more)
        for name in ("repeats", "seeds"):
            if getattr(given, name, 1) < 1:
                raise Error(f"--{name} is {getattr(given, name)}; at least one is needed")
        if given.small and hasattr(given, "repeats"):
            given.repeats = 1
        return given


@dataclass
class Table:
    """A table, of each seed."""

    title: str
    headings: list[str]
    #: Per seed the rows, as texts.
    rows: dict[int, list[list[str]]]

    def texts(self) -> list[list[str]]:
        """The rows; numbers that depend on the seed are given by their median and range.

        Where tables of seeds have other rows, they follow one another, with the seed before each row.
        """
        first, *others = self.rows.values()
        if any([len(row) for row in rows] != [len(row) for row in first] for rows in others):
            return [[f"seed {seed}: {row[0]}", *row[1:]] for seed, rows in self.rows.items() for row in rows]
        return [[spread({seed: rows[i][k] for seed, rows in self.rows.items()}) for k in range(len(row))]
                for i, row in enumerate(first)]


class Report:
    """Collects tables, pictures and findings of a study and writes them to a directory.

    In the small size meshes are too small for verdicts; the findings then have figures only.
    """

    def __init__(self, name: str, title: str, given: argparse.Namespace) -> None:
        self.name, self.title, self.given = name, title, given
        self.out, self.small = Path(given.out), bool(given.small)
        self.parts: list[str | Table] = []
        self.recorded: list[Finding] = []
        self._seed = 0
        self._tables: dict[str, Table] = {}
        self._rows: dict[str, list[list[Any]]] = {}
        self._began = time.process_time()
        make_folder(self.out)
        _memory.keep(self.out / "parts" if getattr(given, "resume", False) else None)

    @property
    def seeds(self) -> Iterator[int]:
        """The seeds to run with, one after the other; reports belong to the current one."""
        for seed in range(1, getattr(self.given, "seeds", 1) + 1):
            self._seed = seed
            yield seed

    @property
    def findings(self) -> list[Finding]:
        """One finding for the findings of all seeds."""
        return merged(self.recorded, getattr(self.given, "seeds", 1))

    def text(self, paragraph: str) -> None:
        """A paragraph; paragraphs of later seeds are dropped."""
        if self._seed <= 1:
            self.parts.append(paragraph)

    def table(self, file: str, title: str, headings: Sequence[str], rows: Sequence[Sequence[Any]]) -> None:
        """A table in the text and in files."""
        self.csv(file, headings, rows)
        self._shown(file, title, headings, rows)

    def beside(self, file: str, title: str, columns: Sequence[Any], ours: dict[str, Sequence[float]],
               theirs: dict[str, Sequence[float]], head: str = "method") -> None:
        """Our numbers, with the dissertation's in brackets; the CSV file has separate columns for them."""
        rows, shown = [], []
        for label, values in ours.items():
            known = list(theirs.get(label, [])) or [math.nan] * len(values)
            rows.append([label, *values, *known])
            pairs = zip(values, known)
            shown.append([label, *(_short(v) + ("" if math.isnan(k) else f" ({_short(k)})") for v, k in pairs)])
        names = [str(column) for column in columns]
        self.csv(file, [head, *names, *(f"{name} dissertation" for name in names)], rows)
        self._shown(file, f"{title}; the dissertation's in brackets", [head, *names], shown)

    def aligned(self, title: str, headings: Sequence[Any], rows: Sequence[Sequence[str]], file: str = "") -> None:
        """A table of texts in the report, without a CSV file; file: what the table belongs to."""
        self._shown(file or title, title, headings, rows)

    def csv(self, file: str, headings: Sequence[str], rows: Sequence[Sequence[Any]]) -> None:
        """A CSV file; with several seeds its first column is the seed."""
        shown = [["" if _missing(value) else value for value in row] for row in rows]
        if getattr(self.given, "seeds", 1) > 1:
            headings = ["seed", *headings]
            shown = self._rows.setdefault(file, []) + [[self._seed, *row] for row in shown]
            self._rows[file] = shown
        replace_text(self.out / f"{file}.csv", csv_rows([headings, *shown], "\r\n"))

    def _shown(self, file: str, title: str, headings: Sequence[Any], rows: Sequence[Sequence[Any]]) -> None:
        """Show a table; the tables of several seeds become one."""
        texts = [[_short(value) for value in row] for row in rows]
        known = self._tables.get(file)
        if known is None:
            known = Table(f"{title}  [{file}]", [str(heading) for heading in headings], {})
            self._tables[file] = known
            self.parts.append(known)
        if self._seed in known.rows:
            raise Error(f"there are two tables {file}")
        known.rows[self._seed] = texts

    def curves(self, file: str, runs: Sequence[Any]) -> None:
        """A CSV file of every quantity of every run after every iteration."""
        names = list(runs[0].values)
        rows = [
            [r.method.name, r.optimizer, int(r.iterations[i]), r.seconds[i], *(r.values[name][i] for name in names)]
            for r in runs
            for i in range(len(r.iterations))
        ]
        self.csv(file, ["method", "optimizer", "iteration", "cpu_seconds", *names], rows)

    def finding(self, source: str, claim: str, holds: Verdict, ours: str, *, criterion: str = "", stated: str = "",
                reason: str = "", own: bool = False, proof: str = "") -> None:
        """Add a statement, and whether our numbers agree with it.

        source: the table, figure or section that states it. ours: our numbers. criterion: the condition on them for the
        statement to hold; "": the claim says it. stated: the dissertation's number. reason: why it does not hold.
        own: it is not a statement of the dissertation. proof: why a small mesh also decides it.
        """
        if self.small and not proof:
            verdict, why = TOO_SMALL, ""
        else:
            verdict = word(holds)
            why = holds.reason if isinstance(holds, Open) else "" if verdict == HOLDS else reason
        seeds = (self._seed,) if self._seed else ()
        rule = criterion + (f" ({proof})" if criterion and proof else proof)
        self.recorded.append(Finding(source, claim, rule, stated, ours, verdict, why, own, seeds))

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

    def finish(self) -> int:
        """Write and print the report."""
        found = self.findings
        text = "\n\n".join([f"{self.title}\n{'=' * len(self.title)}", *map(_paragraph, self.parts), summary(found)])
        rows = [COLUMNS, *(columns(finding) for finding in found)]
        replace_text(self.out / "findings.csv", csv_rows(rows, "\r\n"))
        replace_text(self.out / f"{self.name}.txt", text + "\n")
        replace_text(self.out / f"{self.name}.json", json_text(self.record()) + "\n")
        if "tex" in self.given.format:
            for file, table in self._tables.items():
                replace_text(self.out / f"{file}.tex", latex(table))
        _memory.keep(None)
        print(text)
        print(f"Files: {self.out}")
        return 0

    def record(self) -> dict[str, Any]:
        """Everything except the pictures, as JSON."""
        options = {key: value for key, value in vars(self.given).items()
                   if key not in ("out", "format", "resume") and value is not None}
        tables = {id(table): file for file, table in self._tables.items()}
        return {
            "study": self.name,
            "title": self.title,
            "options": {key: Path(value).name if key in FILES else value for key, value in options.items()},
            "date": datetime.date.today().isoformat(),
            "versions": versions(),
            "seconds": round(time.process_time() - self._began + _memory.saved(), 1),
            "findings": [finding.row() for finding in self.findings],
            "parts": [{"text": part} if isinstance(part, str) else
                      {"file": tables[id(part)], "title": part.title, "headings": part.headings, "rows": part.texts()}
                      for part in self.parts],
        }

    def _pictures(self) -> bool:
        missing = "No pictures: matplotlib is not installed."
        if pyplot is None and missing not in self.parts:
            self.parts.append(missing)
        return pyplot is not None

    def save(self, figure: Any, file: str) -> None:
        """Save a figure of pyplot; figures of later seeds are dropped."""
        if self._seed <= 1:
            figure.tight_layout()
            for kind in {"png", *self.given.format} & set(PICTURE_FORMATS):
                save_figure(figure, self.out / f"{file}.{kind}", dpi=110, bbox_inches="tight")
        pyplot.close(figure)


def summary(found: Sequence[Finding]) -> str:
    """The findings as a text: how many hold, then each."""
    verdicts = [finding.verdict for finding in found]
    counts = ", ".join(f"{verdicts.count(word)} {word}" for word in WORDS if word in verdicts)
    lines = [f"Findings: {len(found)}" + (f" ({counts})" if counts else "")]
    for finding in found:
        whose = ", ours" if finding.own else ""
        lines.append(f"- {finding.verdict.upper()} ({finding.source}{whose}): {finding.claim}")
        lines.append(f"    ours: {finding.ours}")
        for name in ("stated", "criterion", "reason"):
            if getattr(finding, name):
                lines.append(f"    {name}: {getattr(finding, name)}")
    return "\n".join(lines)


def versions() -> dict[str, str]:
    """The versions and the processor that the numbers depend on."""
    return {"tautline": tautline.__version__, "vtk": vtkVersion.GetVTKVersion(), "numpy": np.__version__,
            "python": platform.python_version(), "processor": processor()}


def processor() -> str:
    """The name of the processor if the system provides it, otherwise its architecture."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.machine()
    return next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), platform.machine())


#: Characters with a meaning in LaTeX.
_LATEX = str.maketrans({"\\": r"\textbackslash{}", "|": r"\textbar{}", "^": r"\textasciicircum{}",
                        "~": r"\textasciitilde{}", "<": r"\textless{}", ">": r"\textgreater{}",
                        **{c: "\\" + c for c in "&%$#_{}"}})


def latex(table: Table) -> str:
    """A table as LaTeX; it needs no package."""
    rows = [table.headings, *table.texts()]
    lines = [" & ".join(cell.translate(_LATEX) for cell in row) + r" \\" for row in rows]
    columns_ = "l" + "r" * (len(table.headings) - 1)
    return "\n".join([f"% {table.title}", rf"\begin{{tabular}}{{{columns_}}}", r"\hline", lines[0], r"\hline",
                      *lines[1:], r"\hline", r"\end{tabular}", ""])


def _paragraph(part: str | Table) -> str:
    return part if isinstance(part, str) else f"{part.title}\n{align(part.texts(), part.headings)}"


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
