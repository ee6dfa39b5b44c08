# SPDX-License-Identifier: BSD-3-Clause
"""The result of optimize(), and its arguments that are not one property each."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any, ClassVar, Iterable, Union

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataObject

from . import _commands
from ._arguments import number, pick, picked, sequence, sets, within
from ._arrays import (
    ANY,
    POINTS,
    Array,
    InputArrays,
    Values,
    cell_array,
    columns,
    history_of,
    is_number,
    point_array,
    snake,
    table_rows,
)
from ._choices import OPTIMIZE_PRESETS, TARGETS, TEMPLATES, OptimizePreset
from ._errors import Error, wrong_usage
from ._metrics import by_metric, find_metric, metric_name, nearest_metric
from ._names import find_name, nearest_name
from ._results import Result

_SIZE, _LIMITS = 0, 3  # input arrays of vtkMeshOptimizer

#: An objective: the name of a metric, or (name, {"template": ..., "weight": ..., "target": ...}).
Objective = Union[str, "tuple[str, dict[str, Any]]"]


@dataclass(frozen=True, repr=False, eq=False)
class OptimizeResult(Result):
    """The result of optimize(). For composite data, numbers cover all blocks; the reason is for the last block.

    Attributes
    ----------
    mesh : vtkDataObject
        The mesh with the new points, `Displacement`, `Validity`, and per metric its value after (`imr`) and before
        (`imr_before`).
    history : dict[str, Any]
        Per iteration (0 is the input): iteration, objective, <metric>_mean, <metric>_worst, for several objectives also
        <metric>_objective; inverted, gradient_norm, moving, seconds; for composite data also block.
    statistics : dict[str, dict[str, Any]]
        Per metric: label, and with the suffixes _before and _after: minimum, mean, maximum, rms, standard_deviation,
        worst, outside_acceptable, inverted, degenerate. For composite data the keys are "block n metric". With the
        preset "finite volumes", per check of checkMesh: label, and before and after: offending, minimum and maximum.
    reason : str
        The stopping criterion that ended the run.
    inverted_before, inverted, iterations : int
        Number of inverted or degenerate elements before and after.
    free : int
        Number of points that were free to move.
    displacement : Array
        New minus old position, n x 3.
    validity : Array
        Per cell, m: 1 valid, 0 degenerate, -1 inverted, -2 not measured, -3 not finite.
    surface_error : float
        Largest distance between the facets of a surface in space (of the boundary, where its points slide) and the
        facets of the input, measured in both directions, or from them to the geometry; in the mesh's unit.
    summary : str
        The result in words.
    """

    _per_element: ClassVar[tuple[str, ...]] = ("displacement", "validity")
    mesh: vtkDataObject
    history: dict[str, Any]
    statistics: dict[str, dict[str, Any]]
    reason: str
    inverted_before: int
    inverted: int
    iterations: int
    free: int
    displacement: Array
    validity: Array
    surface_error: float
    summary: str


@sets(
    "optimize", "Preset", "NumberOfObjectives",
    "Metric1", "Template1", "Target1", "Weight1",
    "Metric2", "Template2", "Target2", "Weight2",
    "Metric3", "Template3", "Target3", "Weight3",
    "Metric4", "Template4", "Target4", "Weight4",
)  # fmt: skip
def choose_preset(
    filter_: Any,
    preset: OptimizePreset | list[Objective] | list[str] | tuple[Objective, ...] | None = None,
    objectives: str | Iterable[Objective] | None = None,
    *,
    custom: dict[str, Any],
    reference: Any,
    size: Any,
    tensor: Any,
) -> None:
    """Set the preset, or the objectives.

    preset: "fast clean-up", "best shape", "uniform size", "low interpolation error", "untangle then improve", "preserve
        shape" (of the reference), "worst element", "finite volumes" (also polyhedra) or "custom". "best shape" is the
        default if no objectives, no target and no argument that a preset replaces are given. The name of a metric, or a
        list, gives the objectives.
    objectives: what to optimize: names of metrics, or pairs of a name and a dict with any of "template" (how the values
        of the elements are aggregated: "default", "sum of squares", "sum of squared reciprocals", "sum of
        reciprocals", "sum", "power mean", "maximum"), "weight" (above 0; 1) and "target" ("ideal", "reference", "size",
        "tensor"; the default is the target argument given below, if exactly one is given, otherwise
        "ideal"). The default is ["imr"]. The name of a preset gives the preset.
    """
    given = {"reference": reference, "size": size, "tensor": tensor}
    targets = [name for name, value in given.items() if value is not None]
    preset, objectives = _preset_and_objectives(preset, objectives)
    chosen = {name: value for name, value in {"objectives": objectives, **custom}.items() if value is not None}
    if preset is None:
        preset = "custom" if chosen or targets else "best shape"
    preset = picked("preset", preset, OPTIMIZE_PRESETS)
    filter_.SetPreset(OPTIMIZE_PRESETS.index(preset))
    if preset != "custom":
        if chosen:
            raise Error(f"the preset {preset!r} decides on {', '.join(chosen)}: give one or the other")
        if preset == "preserve shape" and "reference" not in targets:
            raise Error("the preset 'preserve shape' needs a reference mesh")
        return
    listed: Any = ["imr"] if objectives is None else objectives
    listed = [listed] if isinstance(listed, str) else sequence("objectives", listed)
    if not listed:
        raise Error("no objective is given")
    for objective in listed:
        _add_objective(filter_, objective, targets)


def _preset_and_objectives(preset: Any, objectives: Any) -> tuple[Any, Any]:
    """The preset and the objectives; each may have been given as the other: the type and the name decide."""
    if isinstance(objectives, str) and find_name(objectives, OPTIMIZE_PRESETS) is not None:
        if preset is not None:
            raise Error(f"two presets are given, {objectives!r} and {preset!r}")
        return objectives, None
    is_metric = isinstance(preset, str) and not find_name(preset, OPTIMIZE_PRESETS) and find_metric(preset) is not None
    if is_metric or isinstance(preset, (list, tuple)):
        if objectives is not None:
            raise Error(f"objectives are given twice, {preset!r} and {objectives!r}")
        return None, preset
    if isinstance(preset, str) and find_name(preset, OPTIMIZE_PRESETS) is None and (near := nearest_metric(preset)):
        if not nearest_name(preset, OPTIMIZE_PRESETS):
            raise wrong_usage(f"there is no preset and no metric {preset!r}; did you mean {near}?")
    return preset, objectives


def _add_objective(filter_: Any, objective: Any, targets: list[str]) -> None:
    pair = (objective, {}) if isinstance(objective, str) else objective
    name, facts = pair if isinstance(pair, (tuple, list)) and len(pair) == 2 else (None, None)
    if not isinstance(name, str) or not isinstance(facts, dict):
        raise Error(f"an objective is the name of a metric or (name, dict), not {objective!r}")
    unknown = set(facts) - {"template", "weight", "target"}
    if unknown:
        raise Error(f"objective {name!r}: there is no {sorted(unknown)[0]!r}; there are template, weight and target")
    target = picked("target", facts.get("target", targets[0] if len(targets) == 1 else "ideal"), TARGETS)
    if target in TARGETS[1:] and target not in targets:
        raise Error(f"objective {name!r}: the target is {target!r} but {target!r} is not given")
    template = pick("template", facts.get("template", "default"), TEMPLATES) - 1
    weight = within("weight", facts.get("weight", 1.0), np.nextafter(0, 1), np.inf)
    filter_.AddObjectiveByName(metric_name(name), template, weight, TARGETS.index(target))


@sets("optimize", "Utopia")
def set_utopia(filter_: Any, utopia: float | Iterable[float] | None = None) -> None:
    """Set the best values.

    utopia: the best value of each objective, one number per objective. The default is 0.
    """
    values: Any = [] if utopia is None else [utopia] if is_number(utopia) else sequence("utopia", utopia)
    for value in values:
        filter_.AddUtopia(within("utopia", value, -np.inf, np.inf))


@sets("optimize", "UseBestKnown", "BestKnown")
def set_best_known(filter_: Any, best_known: float | None = None) -> None:
    """Set the objective that the reduction refers to.

    best_known: the objective of the completely smoothed mesh, for reduction; it is estimated by default.
    """
    filter_.SetUseBestKnown(best_known is not None)
    if best_known is not None:
        filter_.SetBestKnown(within("best_known", best_known, -np.inf, np.inf))


@sets("optimize", "SizeArray")
def set_size(inputs: InputArrays, size: float | Values | None = None) -> None:
    """Set the target size.

    size: the target area or volume: a number, one per cell or point, or the name of an array.
    """
    if is_number(size):
        size = np.full(inputs.mesh.GetNumberOfCells(), size)
    inputs.use(_SIZE, size, "size", ANY)


@sets("optimize", "MaximumDisplacement", "LimitArray")
def set_limits(filter_: Any, inputs: InputArrays, limits: float | Values | None = None) -> None:
    """Set the largest displacements.

    limits: largest displacement of points, in the mesh's unit: a number (0: no limit), one per point (negative: no
        limit), or the name of a point array.
    """
    if is_number(limits):
        filter_.SetMaximumDisplacement(within("limits", number("limits", limits), 0, np.inf))
    else:
        inputs.use(_LIMITS, limits, "limits", POINTS)


def optimize_result(filter_: Any, output: vtkDataObject) -> OptimizeResult:
    """The result of a filter that has run."""
    return OptimizeResult(
        mesh=output,
        history=history_of(filter_),
        statistics=by_metric(_statistics(columns(filter_.GetStatistics()))),
        reason=filter_.GetReason(),
        inverted_before=filter_.GetInvertedBefore(),
        inverted=filter_.GetInvertedAfter(),
        iterations=filter_.GetIterations(),
        free=filter_.GetFreePoints(),
        displacement=point_array(output, "Displacement"),
        validity=cell_array(output, "Validity"),
        surface_error=filter_.GetSurfaceError(),
        summary=filter_.GetSummary(),
    )


def _statistics(table: dict[str, Any]) -> dict[str, dict[str, Any]]:
    counts = ("outside_acceptable", "inverted", "degenerate")
    result = {}
    for row, metric in enumerate(table.get("Metric", ())):
        key = f"{table['Block'][row]} {metric}" if "Block" in table else metric
        facts = {"label": table["Label"][row]}
        for name, column in table.items():
            if name not in ("Block", "Metric", "Label"):
                ending = "Before" if name.endswith("Before") else "After"
                fact = f"{snake(name[: -len(ending)])}_{ending.lower()}"
                facts[fact] = int(column[row]) if fact.startswith(counts) else float(column[row])
        result[key] = facts
    return result


# --- the shell ----------------------------------------------------------------------------------------------


def add_optimize_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of these arguments."""
    parser.add_argument("--preset", choices=OPTIMIZE_PRESETS[1:], help="without --objective, the default is best shape")
    parser.add_argument("--objectives", "--objective", action="append", type=_objective, metavar="NAME[,KEY=VALUE...]",
                        help="a metric, optionally with template=, weight= and target=; may be repeated")  # fmt: skip
    parser.add_argument("--size", metavar="VALUE|ARRAY", type=_commands.number_or_name,
                        help="target: this area or volume, or an array of them")  # fmt: skip
    parser.add_argument("--limits", metavar="LENGTH|ARRAY", type=_commands.number_or_name,
                        help="largest displacement: a length or a point array (default: 0, no limit)")  # fmt: skip
    parser.add_argument("--utopia", type=_commands.numbers, metavar="X,...", help="best values of the objectives")
    parser.add_argument("--best-known", type=float, metavar="X",
                        help="the smallest known objective, for --reduction (default: estimated)")  # fmt: skip


def optimize_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """The values of these options."""
    return _commands.given(arguments, ("preset", "objectives", "size", "limits", "utopia", "best_known"))


def _objective(text: str) -> Objective:
    name, *pairs = text.split(",")
    facts: dict[str, Any] = {}
    for pair in pairs:
        key, separator, value = pair.partition("=")
        if not separator:
            raise argparse.ArgumentTypeError(f"{pair!r} is not KEY=VALUE")
        try:
            facts[key] = float(value) if key == "weight" else value
        except ValueError:
            raise argparse.ArgumentTypeError(f"the weight is {value!r}, not a number") from None
    return name, facts


def finish_optimize(arguments: argparse.Namespace, result: OptimizeResult) -> int:
    """Print the result of the command."""
    _commands.finish(arguments, result, result.summary, table_rows(result.history))
    return 1 if result.inverted else 0
