# SPDX-License-Identifier: BSD-3-Clause
"""The result of quality(), its arguments that are not one property each, and the function criteria."""

from __future__ import annotations

import argparse
import json
import os
import sys
from dataclasses import dataclass
from os import PathLike
from typing import Any, Callable, ClassVar

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkPolyData

from . import _commands, _vtk
from ._arguments import picked, sets
from ._arrays import CELLS, Array, InputArrays, Values, cell_array, columns, has_array, is_number, point_array, snake
from ._certificate import REFUTED, certificate, certificate_text, verify_certificate
from ._choices import TARGETS, Target
from ._errors import Aborted, Error, checked, unknown, wrong_usage
from ._files import file_name, replace_text
from ._html import html_report
from ._metrics import Metrics, by_metric, choose, find_metric, metrics as known_metrics
from ._names import find_name, nearest_name
from ._results import Result
from ._tables import align, quality_json, quality_rows, quality_text

#: Exit code of the command for a mesh that fails its criteria.
FAILED = 3

_SIZE = 0  # input array of vtkElementQuality
_NOT_NUMBERS = ("Metric", "WorstCells", "WorstPositions")  # columns of the statistics
_INVERTED = -1  # of `validity`
_WARNING_GRADE, _FAILED_GRADE = 1, 2
_MAX_WORST = 10  # elements listed per metric


@dataclass(frozen=True, repr=False, eq=False)
class QualityResult(Result):
    """The result of quality(). Dicts are by the names of the metrics, in the order in which they were given; labels,
    symbols and aliases of metrics are also found. On several MPI ranks each has the arrays of its piece; the numbers of
    the whole mesh are on the first rank, and empty or None on the others.

    Attributes
    ----------
    mesh : vtkDataObject
        The mesh with a cell array per metric and `Validity`; shares the other arrays with the input.
    values : dict[str, Array]
        Per metric its value on each cell, m; for composite data the blocks concatenated. 0 where it is not defined.
    validity : Array
        Per cell, m: 1 valid, 0 degenerate, -1 inverted, -2 not measured, -3 not finite.
    statistics : dict[str, dict[str, Any]]
        Per metric: label, measured, minimum, maximum, mean, rms, standard_deviation, quantile_01 to quantile_99, worst
        (nan if nothing was measured), outside_acceptable, acceptable_low, acceptable_high, inverted, degenerate,
        not_measured, non_finite, curved (cells of higher order that are certified), missed_at_corners and
        missed_at_integration_points (invalid curved cells with a positive determinant at all corners, or at all
        integration points of solvers). All are over the measured elements: the valid and the
        inverted ones on which the metric is defined. The worst value is taken from the inverted elements if there are
        any, otherwise it is the maximum or minimum, by the direction of the metric. For the k elements to repair first,
        at most ten: worst_cells (k), worst_values (k), worst_positions (k x 3); inverted elements come first, then
        degenerate ones, then the worst of the others.
    distribution : dict[str, dict[str, Array]]
        Per metric the histogram of the measured elements: value (centers of the bins) and count.
    histogram : dict[str, dict[str, Array]]
        Per metric the histogram over its acceptable range: from, to and count; the first row counts the elements below
        the range, the last row the elements above it.
    angles : dict[str, Array]
        angles (for volumes: dihedral angles) in the five bins of Table 2.7: from, to (degrees), count, percent.
    worst : vtkPolyData
        A point at the center of each of the worst elements (in curved ones, where the determinant is smallest), with
        the arrays Metric, Rank, CellId, Value, Validity.
    inverted, degenerate : int | None
        Number of inverted elements, and of elements without area or volume.
    verdict : str | None
        By the criteria, if any were given: "passed", "warning", "failed", or "none" if no element could be graded.
    index, indices : float | None, Array | None
        Quality index of the mesh, 0 (ideal) to 1 (worst), and of each cell, m; None without criteria.
    grades : Array | None
        Grade of each cell, m: 0 passed, 1 warning, 2 failed, -1 none; None without criteria.
    bounds : Array | None
        With jacobian_bounds, a certified lower bound of the smallest Jacobian determinant in each cell, m; otherwise
        None.
    criteria : dict[str, dict[str, Any]]
        Per metric of the criteria: label, weight, graded, passed, warning, failed (elements), mean_penalty.
    checks : dict[str, Array]
        Per check of solvers, if any were chosen, its value on each cell, m.
    faces : vtkPolyData | None
        The faces that fail a check of OpenFOAM's checkMesh (or all, see face_output), with the cell arrays Face, Owner,
        `Neighbour`, Patch, Failed, OwnerWeight and one per metric; None without metrics of finite volumes.
    mesh_checks : dict[str, dict[str, Any]]
        Per check of checkMesh: label, minimum, maximum, mean, limit, offending, severe, on_request (only with
        -allTopology and -allGeometry), failed, bit (in Failed of the faces). Empty without metrics of finite volumes.
    failed_checks, failed_checks_of_all : int | None
        How many checks fail, as checkMesh counts them without options and with both; None without such metrics.
    notice : str
        A note on the mesh (reversed orientation, cells left out), or "".
    summary : str
        The result in a few lines.
    """

    _per_element: ClassVar[tuple[str, ...]] = ("values", "validity", "indices", "grades", "bounds", "checks")
    mesh: vtkDataObject
    values: dict[str, Array]
    validity: Array
    statistics: dict[str, dict[str, Any]]
    distribution: dict[str, dict[str, Array]]
    histogram: dict[str, dict[str, Array]]
    angles: dict[str, Array]
    worst: vtkPolyData
    inverted: int | None
    degenerate: int | None
    verdict: str | None
    index: float | None
    indices: Array | None
    grades: Array | None
    bounds: Array | None
    criteria: dict[str, dict[str, Any]]
    checks: dict[str, Array]
    faces: vtkPolyData | None
    mesh_checks: dict[str, dict[str, Any]]
    failed_checks: int | None
    failed_checks_of_all: int | None
    notice: str
    summary: str

    def table(self) -> list[dict[str, Any]]:
        """A row per metric, as --csv writes it."""
        return quality_rows(self)

    def groups(self) -> dict[str, Array]:
        """Sets of elements by name, as numbers from 0: the argument `groups` of write().

        Inverted and Degenerate; with criteria also Failed and Warning. A set may be empty.

        >>> tautline.write(result, "part.inp", groups=result.groups())
        """
        found = {"Inverted": self.validity == _INVERTED, "Degenerate": self.validity == 0}
        if self.grades is not None:
            found |= {"Failed": self.grades == _FAILED_GRADE, "Warning": self.grades == _WARNING_GRADE}
        return {name: np.flatnonzero(mask) for name, mask in found.items()}

    def to_json(self, file: str | PathLike[str] | None = None) -> str:
        """Counts, statistics, histogram and, by the criteria, verdict, index and counts, as JSON; see Result."""
        text = quality_json(self)
        if file is not None:
            replace_text(file, text + "\n")
        return text


@sets("quality", "Metrics")
def choose_metrics(filter_: Any, metrics: Metrics = ("imr",)) -> None:
    """Choose the metrics.

    metrics: names, labels, symbols or aliases, see metrics(). The default is the inverse mean ratio.
    """
    if isinstance(metrics, str) and find_name(metrics, criteria_presets()) and find_metric(metrics) is None:
        raise wrong_usage(f"there is no metric {metrics!r}, which is a preset of criteria: give criteria={metrics!r}")
    choose(filter_, metrics).raise_errors()


@sets("quality", "Criteria")
def set_criteria(
    filter_: Any, criteria: str | PathLike[str] | dict[str, Any] | None = None
) -> None:
    """Set the criteria.

    criteria: limits that the elements are graded by: the name of a preset, a JSON file, or a dict as criteria() returns
        it. Their metrics are also measured.
    """
    filter_.SetCriteria(_criteria_text(criteria))


@sets("quality", "TargetType", "SizeArray")
def set_target(
    filter_: Any,
    inputs: InputArrays,
    target: Target = "ideal",
    size: float | Values | None = None,
    *,
    reference: Any,
    tensor: Any,
) -> None:
    """Set the type of the target.

    target: the target element of target metrics: "ideal", "reference", "size" or "tensor". It follows from the
        arguments of these names; at most one of them may be given.
    size: target area or volume: a number, one per cell or point, or the name of an array.
    """
    target = picked("target", target, TARGETS)
    given = {"reference": reference, "size": size, "tensor": tensor}
    chosen = [name for name, value in given.items() if value is not None]
    if len(chosen) > 1:
        raise Error(f"only one target is possible, not {' and '.join(chosen)}")
    if chosen and target not in ("ideal", chosen[0]):
        raise Error(f"the target is {target!r} but {chosen[0]!r} is given")
    if not chosen and target != "ideal":
        raise Error(f"the target is {target!r} but {target!r} is not given")
    filter_.SetTargetType(TARGETS.index(picked("target", chosen[0] if chosen else target, TARGETS)))
    if is_number(size):
        size = np.full(inputs.mesh.GetNumberOfCells(), size)
    inputs.use(_SIZE, size, "target")


@checked
def criteria(name: str) -> dict[str, Any]:
    """The preset quality criteria of a name, for use in quality(), unchanged or modified.

    Parameters
    ----------
    name : str
        For shells and solids: "fem", "skewness". For shells: "optistruct", "hypermesh", "nastran", "ansys". For solids:
        "optistruct_solids", "hypermesh_solids", "nastran_solids", "ansys_solids". For finite volumes: "openfoam",
        "openfoam.org", "snappy", "fluent".

    Returns
    -------
    dict[str, Any]
        A dict with name, source, and criteria, a list: metric, weight, and limits by cell type or "all", each a dict of
        ideal, good, warn, fail and worst. An element beyond warn gets a warning, one beyond fail fails.

    Examples
    --------
    >>> mine = tautline.criteria("fem")
    >>> mine["criteria"][0]["limits"]["all"]["fail"] = 5
    >>> tautline.quality("part.vtu", criteria=mine).verdict
    """
    known = criteria_presets()
    found = find_name(name, known)
    if found is None:
        raise unknown("preset of quality criteria", str(name), known)
    preset: dict[str, Any] = json.loads(_vtk.vtkElementQuality.GetCriteriaPreset(found))
    return preset


def criteria_presets() -> list[str]:
    return str(_vtk.vtkElementQuality.GetCriteriaPresets()).split("\t")


def _criteria_text(chosen: str | PathLike[str] | dict[str, Any] | None) -> str:
    if isinstance(chosen, dict):
        try:
            return json.dumps(chosen, allow_nan=False)
        except (TypeError, ValueError) as error:
            raise Error(f"the criteria cannot be written as JSON: {error}") from None
    if chosen is None:
        return ""
    if not isinstance(chosen, (str, PathLike)):
        raise Error(f"criteria is {chosen!r}; the name of a preset, a JSON file or a dict is expected")
    preset = find_name(chosen, criteria_presets())
    if preset is not None:
        return preset
    found = file_name(chosen)
    if isinstance(chosen, str) and not chosen.lstrip().startswith("{") and not os.path.exists(chosen):
        listed = f"{nearest_name(chosen, criteria_presets())}; there are {', '.join(criteria_presets())}"
        is_name = not os.path.splitext(chosen)[1] and not os.path.dirname(chosen)
        text = f"the criteria {chosen!r} are neither a file that can be read nor a preset{listed}"
        raise wrong_usage(text) if is_name else Error(text)
    return found


def quality_result(filter_: Any, mesh: vtkDataObject) -> QualityResult:
    """The result of a filter that has run."""
    worst = filter_.GetWorst()
    statistics = _statistics(columns(filter_.GetStatistics()), worst)
    bins = columns(filter_.GetDistribution())
    ranges = columns(filter_.GetHistogram())
    # The tables are on the first rank of MPI; the others find the measured metrics by its arrays.
    measured = list(statistics) or [m["name"] for m in known_metrics() if has_array(mesh, m["name"], CELLS)]
    totals = next(iter(statistics.values()), {"inverted": None, "degenerate": None})
    graded = bool(filter_.GetVerdict())
    return QualityResult(
        mesh=mesh,
        values=by_metric({name: cell_array(mesh, name) for name in measured}),
        validity=cell_array(mesh, "Validity"),
        statistics=by_metric(statistics),
        distribution=by_metric({n: {"value": bins[f"{n} value"], "count": bins[f"{n} count"]} for n in statistics}),
        histogram=by_metric({n: {key: ranges[f"{n} {key}"] for key in ("from", "to", "count")} for n in statistics}),
        angles={name.lower(): column for name, column in columns(filter_.GetAngles()).items()},
        worst=worst,
        inverted=totals["inverted"],
        degenerate=totals["degenerate"],
        verdict=filter_.GetVerdict() or None,
        index=filter_.GetQualityIndex() if graded else None,
        indices=cell_array(mesh, "QualityIndex") if graded else None,
        grades=cell_array(mesh, "Grade") if graded else None,
        bounds=cell_array(mesh, "JacobianBound") if filter_.GetJacobianBounds() else None,
        criteria=by_metric(_by_metric(columns(filter_.GetCriteriaTable())) if graded else {}),
        checks={name: cell_array(mesh, name) for name in _chosen_checks(filter_)},
        faces=filter_.GetFaces() if filter_.GetFailedChecks() >= 0 else None,
        mesh_checks=_mesh_checks(columns(filter_.GetMeshChecks())),
        failed_checks=_count(filter_.GetFailedChecks()),
        failed_checks_of_all=_count(filter_.GetFailedChecksOfAll()),
        notice=filter_.GetNotice(),
        summary=filter_.GetSummary(),
    )


def _chosen_checks(filter_: Any) -> list[str]:
    wanted = {name.strip() for name in filter_.GetChecks().split(",")}
    if filter_.GetVerdict():
        wanted |= set(columns(filter_.GetCriteriaTable()).get("Metric", ()))
    known = [filter_.GetKnownCheck(i).split("\t")[0] for i in range(filter_.GetNumberOfKnownChecks())]
    return [name for name in known if name in wanted or "all" in wanted]


def _statistics(table: dict[str, Any], worst: vtkPolyData) -> dict[str, dict[str, Any]]:
    numbers = {metric["name"]: metric["number"] for metric in known_metrics()}
    of, ids, values = (point_array(worst, name) for name in ("Metric", "CellId", "Value"))
    result = {}
    for row, name in enumerate(table.get("Metric", ())):
        facts = {snake(key): _plain(table[key][row]) for key in table if key not in _NOT_NUMBERS}
        mine = np.flatnonzero(of == numbers[name])
        positions = np.asarray(table["WorstPositions"][row]).reshape(-1, 3)
        facts["worst"] = facts["worst"] if facts["measured"] else float("nan")
        facts["worst_cells"] = ids[mine]
        facts["worst_values"] = values[mine]
        facts["worst_positions"] = positions[: len(mine)].copy()
        result[name] = facts
    return result


def _by_metric(table: dict[str, Any]) -> dict[str, dict[str, Any]]:
    counts = ("Graded", "Passed", "Warning", "Failed")
    keys = [key for key in table if key != "Metric"]
    return {
        str(name): {snake(key): int(table[key][row]) if key in counts else _plain(table[key][row]) for key in keys}
        for row, name in enumerate(table.get("Metric", ()))
    }


def _mesh_checks(table: dict[str, Any]) -> dict[str, dict[str, Any]]:
    numbers = ("Minimum", "Maximum", "Mean", "Limit")
    rows: dict[str, dict[str, Any]] = {}
    for row, name in enumerate(table.get("Check", ())):
        rows[str(name)] = {"label": str(table["Label"][row])}
        rows[str(name)] |= {snake(key): float(table[key][row]) for key in numbers}
        rows[str(name)] |= {snake(key): int(table[key][row]) for key in ("Offending", "Severe", "Bit")}
        rows[str(name)] |= {snake(key): bool(table[key][row]) for key in ("OnRequest", "Failed")}
    return rows


def _count(number: int) -> int | None:
    return number if number >= 0 else None


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value


# --- the shell ----------------------------------------------------------------------------------------------


def add_quality_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of these arguments, and the options of the output."""
    _commands.take_more(parser)
    _commands.add_metrics(parser)
    parser.add_argument("--worst", type=int, choices=range(_MAX_WORST + 1), default=0, metavar=f"0..{_MAX_WORST}",
                        help="list this many of the worst elements (default: 0)")  # fmt: skip
    parser.add_argument("--target", choices=TARGETS, default="ideal", help="follows from the options of these names")
    parser.add_argument("--size", metavar="VALUE|ARRAY", type=_commands.number_or_name,
                        help="target: this area or volume, or an array of them")  # fmt: skip
    parser.add_argument("--criteria", metavar="NAME|FILE",
                        help="grade the elements by a preset or JSON file; exits with 3 if the mesh fails")  # fmt: skip
    parser.add_argument("--groups", action="store_true",
                        help="write the bad elements as groups (.inp, .med) or cell arrays")  # fmt: skip
    parser.add_argument("--report", metavar="FILE", help="write an HTML report, see the command report")
    parser.add_argument("--certificate", metavar="FILE",
                        help="write a proof for each element that it is valid, as JSON")  # fmt: skip
    parser.add_argument("--verify", metavar="FILE",
                        help="check such a proof independently; exits with 3 if it does not hold")  # fmt: skip


def quality_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """The values of these options."""
    return _commands.given(arguments, ("metrics", "target", "size", "criteria"))


def finish_quality(arguments: argparse.Namespace, filter_: Any, options: dict[str, Any]) -> int:
    """Print the result of the command."""
    result = quality_result(filter_, filter_.GetOutputDataObject(0))
    texts = {}
    if arguments.report:
        texts[arguments.report] = html_report(filter_, arguments.mesh, options)
    rows, facts = quality_rows(result), json.loads(quality_json(result))
    text, mesh = quality_text(result, arguments.worst), filter_.GetInputDataObject(0, 0)
    if arguments.certificate:
        made = certificate(mesh)
        texts[arguments.certificate] = certificate_text(made)
        text += f"\n\ncertificate: {made['valid']} of {made['cells']} elements are proved to be valid"
    refuted = False
    if arguments.verify:
        checked_ = verify_certificate(mesh, arguments.verify)
        refuted = not checked_
        facts["certificate"] = {"holds": checked_.holds, "valid": checked_.valid, "problems": checked_.problems}
        found = " ".join(checked_.problems) or f"holds: {checked_.valid} of {checked_.cells} elements are valid"
        text += f"\n\n{arguments.verify}: {found}"
    sets_ = {"groups": result.groups()} if arguments.groups else {}
    _commands.finish(arguments, result, text, rows, texts, facts, **sets_)
    if refuted:
        return REFUTED
    return FAILED if result.verdict in ("failed", "none") else 0


def finish_quality_of_several(arguments: argparse.Namespace, measured: Callable[[str], Any]) -> int:
    """Print a table of several meshes, a row for each; measured() returns the filter that has run for a file.

    Returns 1 if a file could not be measured, otherwise 3 if a mesh fails its criteria.
    """
    for name in ("output", "report", "certificate", "verify"):
        if getattr(arguments, name):
            raise wrong_usage(f"--{name} is for one mesh, {1 + len(arguments.more)} are given")
    rows: list[dict[str, Any]] = []
    facts: list[dict[str, Any]] = []
    code = 0
    for file in (arguments.mesh, *arguments.more):
        try:
            filter_ = measured(file)
            result = quality_result(filter_, filter_.GetOutputDataObject(0))
        except Aborted:
            raise
        except Error as error:
            if error.exit_code != 1:  # wrong usage, the same for every file
                raise
            print(f"tautline: {error}", file=sys.stderr)
            code = 1
            continue
        rows.append(_row_of(file, result))
        facts.append({"file": file, **json.loads(quality_json(result))})
        if result.verdict in ("failed", "none"):
            code = code or FAILED
    text = align([list(row.values()) for row in rows], list(rows[0])) if rows else ""
    _commands.finish(arguments, None, text, rows, facts={"meshes": facts})
    return code


def _row_of(file: str, result: QualityResult) -> dict[str, Any]:
    row: dict[str, Any] = {"file": file}
    if result.verdict is not None:
        row |= {"verdict": result.verdict, "index": result.index}
    row |= {"cells": len(result.validity), "inverted": result.inverted, "degenerate": result.degenerate}
    for name, facts in result.statistics.items():
        row |= {f"{name} {key}": facts[key] for key in ("worst", "mean")}
        row[f"{name} unacceptable"] = facts["outside_acceptable"]
    return row


def add_own_commands(commands: Any) -> None:
    """Add `criteria` to the subparsers of the command line."""
    preset = _commands.add_command(
        commands, "criteria", _run_criteria, "print preset quality criteria as JSON", threads=False,
        example="fem",
        details="The file can be changed and given to quality --criteria.",
    )  # fmt: skip
    names = ("fem, skewness; for shells optistruct, hypermesh, nastran, ansys; for solids the same with _solids; for "
             "finite volumes openfoam, openfoam.org, snappy, fluent")  # fmt: skip
    preset.add_argument("name", metavar="NAME", help=names)


def _run_criteria(arguments: argparse.Namespace) -> None:
    print(json.dumps(criteria(arguments.name), indent=2))
