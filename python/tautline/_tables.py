# SPDX-License-Identifier: BSD-3-Clause
"""Results as tables: aligned text, CSV, Markdown."""

from __future__ import annotations

import csv
import io
import json
import math
from typing import TYPE_CHECKING, Any, Iterable, Sequence

import numpy as np

if TYPE_CHECKING:
    from ._arrays import Array
    from ._comparison_parts import CompareResult
    from ._quality_parts import QualityResult

_STATISTICS = ("minimum", "mean", "maximum", "standard_deviation", "outside_acceptable", "worst")
_KILO = 1000
_HEADINGS = {"standard_deviation": "std dev", "outside_acceptable": "unacceptable"}


def align(rows: Sequence[Sequence[Any]], headings: Sequence[str]) -> str:
    """Columns of equal width: text aligned left, numbers aligned right."""
    cells = [list(headings), *([_text(value) for value in row] for row in rows)]
    widths = [max(map(len, column)) for column in zip(*cells)]
    numeric = [any(isinstance(row[i], (int, float)) for row in rows) for i in range(len(headings))]
    lines = []
    for row in cells:
        padded = (text.rjust(w) if right else text.ljust(w) for text, w, right in zip(row, widths, numeric))
        lines.append("  ".join(padded).rstrip())
    return "\n".join([lines[0], "-" * (sum(widths) + 2 * len(widths) - 2), *lines[1:]])


def quality_text(result: QualityResult, worst: int = 0) -> str:
    """Counts, a row per metric, the distribution of angles and, per metric, this many of the worst elements."""
    total = next(iter(result.statistics.values()))
    counts = f"{len(result.validity)} cells: {np.count_nonzero(result.validity == 1)} valid, "
    counts += f"{result.inverted} inverted, {result.degenerate} degenerate"
    for key, text in (("not_measured", "not measured"), ("non_finite", "not finite")):
        counts += f", {total[key]} {text}" if total[key] else ""
    if total["missed_at_corners"] or total["missed_at_integration_points"]:
        counts += f"\nnot valid, but valid at all corners: {total['missed_at_corners']}, at all integration points: "
        counts += f"{total['missed_at_integration_points']}"
    rows = [[name, *(facts[key] for key in _STATISTICS)] for name, facts in result.statistics.items()]
    table = align(rows, ["metric", *(_HEADINGS.get(key, key) for key in _STATISTICS)])
    parts = [_verdict(result), _check_mesh(result), counts, result.notice, table]
    angles = result.angles
    rows = [
        [f"{low:g} to {high:g}", count.item(), f"{percent:.1f} %"]
        for low, high, count, percent in zip(angles["from"], angles["to"], angles["count"], angles["percent"])
    ]
    parts.append(align(rows, ["angle (degrees)", "count", "share"]))
    if result.checks:
        ranges = [[name, *_extremes(values[result.validity >= -1])] for name, values in result.checks.items()]
        parts.append(align(ranges, ["check", "minimum", "maximum"]))
    for name, facts in result.statistics.items() if worst else ():
        listed = zip(facts["worst_cells"][:worst], facts["worst_values"], facts["worst_positions"])
        rows = [[cell.item(), value.item(), *xyz.tolist()] for cell, value, xyz in listed]
        parts.append(align(rows, ["worst cell", name, "x", "y", "z"]))
    return "\n\n".join(part for part in parts if part)


def _extremes(values: Array) -> tuple[Any, Any]:
    return (values.min().item(), values.max().item()) if len(values) else ("", "")


def _verdict(result: QualityResult) -> str:
    if result.verdict is None:
        return ""
    keys = ("weight", "graded", "passed", "warning", "failed", "mean_penalty")
    rows = [[name, *(facts[key] for key in keys)] for name, facts in result.criteria.items()]
    table = align(rows, ["criterion", *(key.replace("_", " ") for key in keys)])
    return f"{result.summary.splitlines()[0]}\n\n{table}"


def _check_mesh(result: QualityResult) -> str:
    """The verdict of checkMesh, and the checks that offend."""
    if result.failed_checks is None:
        return ""
    found = [line for line in result.summary.splitlines() if line.startswith("checkMesh: ")]
    keys = ("offending", "minimum", "maximum", "limit", "on_request")
    rows = [[name, *(facts[key] for key in keys)] for name, facts in result.mesh_checks.items() if facts["offending"]]
    table = align(rows, ["check beyond its limit", *(key.replace("_", " ") for key in keys)]) if rows else ""
    return "\n\n".join(part for part in (*found, table) if part)


def quality_json(result: QualityResult) -> str:
    """Counts, statistics, histogram and, by the criteria, verdict, index and counts, as JSON."""
    names = ("verdict", "index", "criteria", "failed_checks", "failed_checks_of_all", "mesh_checks", "inverted",
             "degenerate", "notice", "summary", "statistics", "histogram")  # fmt: skip
    facts = {name: getattr(result, name) for name in names}
    return json.dumps(finite(_lists(facts)), indent=2)


def _lists(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _lists(inner) for key, inner in value.items()}
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value


def comparison_text(result: CompareResult) -> str:
    """A row per metric."""
    shown = ("better", "worse", "equal", "mean_before", "mean_after")
    rows = [[name, *(facts[key] for key in shown)] for name, facts in result.statistics.items()]
    first = next(iter(result.statistics.values()))
    table = align(rows, ["metric", *(key.replace("_", " ") for key in shown)])
    inverted = f"inverted: {first['inverted_before']} before, {first['inverted_after']} after"
    return f"{table}\n\n{inverted}\nlargest displacement: {first['largest_displacement']:.6g}"


def quality_rows(result: QualityResult) -> list[dict[str, Any]]:
    """A dict per metric with all statistics that are numbers or text, and the worst cell."""
    rows = []
    for name, facts in result.statistics.items():
        plain = {key: value for key, value in facts.items() if not isinstance(value, np.ndarray)}
        row: dict[str, Any] = {"metric": name, **plain}
        row["worst_cell"] = int(facts["worst_cells"][0]) if len(facts["worst_cells"]) else ""
        rows.append(row)
    return rows


def comparison_rows(result: CompareResult) -> list[dict[str, Any]]:
    """A dict per metric."""
    return [{"metric": name, **facts} for name, facts in result.statistics.items()]


def csv_text(rows: list[dict[str, Any]]) -> str:
    """A line of names and a line per row, with numbers in full precision; rows have the same keys."""
    out = io.StringIO()
    writer = csv.DictWriter(out, rows[0].keys() if rows else (), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return out.getvalue()


def csv_rows(rows: Iterable[Iterable[Any]], end: str = "\n") -> str:
    """A line per row."""
    out = io.StringIO()
    csv.writer(out, lineterminator=end).writerows(rows)
    return out.getvalue()


def metrics_text(facts: list[dict[str, Any]]) -> str:
    """A row per metric: name, label, dimensions, acceptable ranges, direction."""
    rows = []
    for f in facts:
        ranges = [_range(f[key]) for key in ("acceptable_2d", "acceptable_3d")]
        dimensions = ", ".join(map(str, f["dimensions"]))
        rows.append([f["name"], f["label"], dimensions, *ranges, f["direction"]])
    return align(rows, ["name", "label", "dim", "acceptable 2D", "acceptable 3D", "direction"])


def metrics_markdown(facts: list[dict[str, Any]]) -> str:
    """A Markdown table of every metric with its formula and source."""
    headings = ["name", "label", "also", "formula", "cells", "acceptable 2D", "acceptable 3D", "direction"]
    headings += ["inverted", "source"]
    lines = ["| " + " | ".join(headings) + " |", "|" + "---|" * len(headings)]
    for f in facts:
        row = [f"`{f['name']}`", f["label"], ", ".join(f["aliases"]), f"`{f['formula']}`", ", ".join(f["cell_types"])]
        row += [_range(f["acceptable_2d"]), _range(f["acceptable_3d"]), f["direction"], f["inverted"], f["source"]]
        lines.append("| " + " | ".join(text.replace("|", "\\|") for text in row) + " |")
    return "\n".join(lines)


def json_text(facts: Any) -> str:
    """Facts as JSON; numbers that are not finite, which it does not have, are texts."""
    return json.dumps(finite(facts), indent=2)


def finite(value: Any) -> Any:
    """The value with numbers that are not finite, which JSON does not have, as text."""
    if isinstance(value, dict):
        return {key: finite(inner) for key, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [finite(inner) for inner in value]
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value


def file_size(count: float) -> str:
    """A number of bytes in words."""
    for unit in ("bytes", "kB", "MB"):
        if count < _KILO:
            return f"{count:.3g} {unit}"
        count /= _KILO
    return f"{count:.3g} GB"


def many(noun: str, count: int) -> str:
    """A noun in the plural, unless there is one."""
    if count == 1:
        return noun
    ends = {"tetrahedron": "tetrahedra", "hexahedron": "hexahedra", "vertex": "vertices", "polyhedron": "polyhedra"}
    return ends.get(noun, noun if noun[-1].isdigit() else f"{noun}s")


def _range(pair: tuple[float, float] | None) -> str:
    return "-" if pair is None else f"{pair[0]:.4g} to {pair[1]:.4g}"


def _text(value: Any) -> str:
    return f"{value:.5g}" if isinstance(value, float) else str(value)
