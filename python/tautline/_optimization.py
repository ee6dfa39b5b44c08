"""The verbs optimize and untangle."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any, Iterable, Sequence, Union

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkDataSet

import tautline

from ._errors import Error, run, watch
from ._mesh import Mesh, as_mesh, cell_array, columns, leaves, point_array, with_array
from ._metrics import pick, within
from ._quality import COMBINATIONS, TARGETS, snake

PRESETS = (
    "custom",
    "fast clean-up",
    "best shape",
    "uniform size",
    "low interpolation error",
    "untangle then improve",
    "preserve shape",
    "worst element",
)
TEMPLATES = (
    "default",
    "sum of squares",
    "sum of squared reciprocals",
    "sum of reciprocals",
    "sum",
    "power mean",
    "maximum",
)
SCALARIZATIONS = (
    "exponential sum",
    "objective product",
    "equal sum",
    "weighted sum",
    "weighted min-max",
    "exponential weighted",
    "lexicographic",
    "rao",
)
OPTIMIZERS = (
    "automatic",
    "local newton",
    "local conjugate gradient",
    "fletcher-reeves",
    "polak-ribiere",
    "l-bfgs",
    "newton-cg",
)
BOUNDARIES = ("fixed", "sliding", "free", "on surface")
EFFORTS = ("local", "normal", "thorough")

_MOST_THREADS = 1024
_MOST_ITERATIONS = 1000000
_OWN = "given "  # arrays given in numbers go to the filter by names that begin so
_SIZE, _TENSOR, _FIXED, _LIMITS, _WEIGHTS = range(5)  # arrays to process of vtkMeshOptimizer
_COLUMNS = {"Time (s)": "seconds", "N moving": "moving", "N gradient": "gradient_norm"}

#: An objective: the name of a metric, or (name, {"template": ..., "weight": ..., "target": ...}).
Objective = Union[str, "tuple[str, dict[str, Any]]"]


@dataclass(frozen=True)
class Optimized:
    """What optimize() made. Of composite data, numbers are of all blocks; the reason is that of the last."""

    #: The mesh with other points, `Displacement`, `Validity`, and per metric its value after (`imr`)
    #: and before (`imr_before`).
    mesh: vtkDataObject
    #: Per iteration (0 is the input): iteration, objective, <metric>_mean, <metric>_worst, of several
    #: objectives also <metric>_objective; inverted, gradient_norm, moving, seconds; of composite data block.
    history: dict[str, Any]
    #: Per metric: label, and with the endings _before and _after: minimum, mean, maximum, rms,
    #: standard_deviation, worst, outside_acceptable, inverted, degenerate. Of composite data by "block n metric".
    statistics: dict[str, dict[str, Any]]
    #: Why it stopped.
    reason: str
    #: Inverted or degenerate elements before and after.
    inverted_before: int
    inverted: int
    iterations: int
    #: Points that were free to move.
    free: int
    #: New minus old position, n x 3.
    displacement: np.ndarray
    #: Per cell 1 valid, 0 degenerate, -1 inverted, -2 not measured, -3 not finite.
    validity: np.ndarray
    #: Largest distance of the elements of a surface in space from the input surface.
    surface_error: float
    #: The result in words.
    summary: str


def optimize(
    mesh: Mesh,
    objectives: str | Iterable[Objective] | None = None,
    *,
    preset: str | None = None,
    scalarization: str | None = None,
    optimizer: str | None = None,
    reference: Mesh | None = None,
    size: str | float | Sequence | None = None,
    tensor: str | Sequence | None = None,
    fixed: str | Sequence | None = None,
    boundary: str = "fixed",
    flat_angle: float = 1.0,
    feature_angle: float = 30.0,
    limits: str | float | Sequence | None = None,
    element_weights: str | Sequence | None = None,
    project_to_surface: bool = True,
    untangle_first: bool = True,
    allow_inversion: bool = False,
    time_limit: float = 0.0,
    threads: int = 0,
    **options: Any,
) -> Optimized:
    """Move the points of a mesh so that its elements become better; the result is never worse.

    mesh: a vtkDataSet with explicit points, a file name or (points, cells). It is not changed.
    objectives: what is to become better: names of metrics, or pairs of a name and a dict of
        "template" (how the elements' values become one number: "default", "sum of squares", "sum of
        squared reciprocals", "sum of reciprocals", "sum", "power mean", "maximum"), "weight" (above 0)
        and "target" ("ideal", "reference", "size", "tensor"; the default is what is given of the last
        three, if it is one).
    preset: "fast clean-up", "best shape", "uniform size", "low interpolation error", "untangle then
        improve", "preserve shape" (of the reference) or "worst element". It decides on
        objectives, scalarization, optimizer and options, which cannot be given beside it. Without any of
        them it is "best shape".
    scalarization: how several objectives become one: "exponential sum" (the default), "objective product",
        "equal sum", "weighted sum", "weighted min-max", "exponential weighted", "lexicographic", "rao".
    optimizer: "automatic" (the default), "local newton", "local conjugate gradient", "fletcher-reeves",
        "polak-ribiere", "l-bfgs", "newton-cg".
    reference, size, tensor: what the wanted element is, see quality().
    fixed: points that stay: truth values, one per point, or the name of a point array.
    boundary: "fixed"; "sliding" (points in flat or straight parts move along them, see flat_angle, degrees);
        "on surface" (in curved but smooth parts too, see feature_angle, degrees); or "free".
    limits: how far points may go: a number, one per point (negative: any distance), or a point array.
    element_weights: at least 0, one per cell, or the name of a cell array.
    project_to_surface: keep the points of a surface in space on it.
    untangle_first: untangle a mesh with inverted elements first where the objectives cannot repair it.
    allow_inversion: let steps invert valid elements.
    time_limit: seconds; 0 is no limit.
    threads: 0 is all cores. The result does not depend on it.
    options: maximum_iterations (100), gradient_norm (1e-6), relative_change (1e-5), two_digits (False),
        reduction (1: off), best_known, stop_when_valid (False); c (0: chosen), exponent (1), tolerance
        (0.01), utopia (one per objective); power (8), combination ("mean", "worst", "power mean"), beta (0);
        culling (1e-3), patch_iterations (1), relaxation (1.4), improve_worst (0), rescale_untangling (True).
        They are those of vtkMeshOptimizer.

    Raises Error for wrong arguments and whatever the filter refuses.

    >>> result = tautline.optimize("part.vtu", ["imr", ("si", {"weight": 2})], scalarization="weighted sum")
    >>> result.statistics["imr"]["worst_after"], result.reason
    """
    filter_ = tautline.vtkMeshOptimizer()
    messages = watch(filter_)
    data = as_mesh(mesh)
    given = {"reference": reference, "size": size, "tensor": tensor}
    custom = {"objectives": objectives, "scalarization": scalarization, "optimizer": optimizer, **options}
    _set_method(filter_, preset, custom, [name for name, value in given.items() if value is not None])
    messages.raise_errors()
    filter_.SetBoundary(pick("boundary", boundary, BOUNDARIES))
    filter_.SetFlatAngle(within("flat_angle", flat_angle, 0, 90))
    filter_.SetFeatureAngle(within("feature_angle", feature_angle, 0, 180))
    filter_.SetProjectToSurface(bool(project_to_surface))
    filter_.SetUntangleFirst(bool(untangle_first))
    filter_.SetAllowInversion(bool(allow_inversion))
    filter_.SetTimeLimit(within("time_limit", time_limit, 0, np.inf))
    filter_.SetThreads(int(within("threads", threads, 0, _MOST_THREADS)))
    if np.ndim(size) == 0 and size is not None and not isinstance(size, str):
        size = np.full(data.GetNumberOfCells(), size)
    if np.ndim(limits) == 0 and limits is not None and not isinstance(limits, str):
        filter_.SetMaximumDisplacement(within("limits", limits, 0, np.inf))
        limits = None
    for index, values, name in (
        (_SIZE, size, "size"),
        (_TENSOR, tensor, "tensor"),
        (_FIXED, fixed, "fixed"),
        (_LIMITS, limits, "limits"),
        (_WEIGHTS, element_weights, "element weights"),
    ):
        data = _set_array(filter_, data, index, values, name)
    filter_.SetInputDataObject(0, data)
    if reference is not None:
        filter_.SetInputDataObject(1, as_mesh(reference))
    run(filter_, messages)
    output = _without_own(filter_.GetOutputDataObject(0))
    return Optimized(
        mesh=output,
        history=_history(filter_),
        statistics=_statistics(columns(filter_.GetStatistics())),
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


def _set_method(filter_: Any, preset: str | None, custom: dict[str, Any], targets: list[str]) -> None:
    """Set the preset, or objectives and the options that go with them."""
    chosen = {name: value for name, value in custom.items() if value is not None}
    unknown = [name for name in chosen if name not in (*_OPTIONS, "objectives", "scalarization", "optimizer")]
    if unknown:
        raise Error(f"there is no option {unknown[0]!r}; there are {', '.join(_OPTIONS)}")
    if preset is None:
        preset = "custom" if chosen or targets else "best shape"
    filter_.SetPreset(pick("preset", preset, PRESETS))
    if preset != "custom":
        if chosen:
            raise Error(f"the preset {preset!r} decides on {', '.join(chosen)}: leave out one or the other")
        if preset == "preserve shape" and "reference" not in targets:
            raise Error("the preset 'preserve shape' needs a reference mesh")
        return
    objectives = chosen.pop("objectives", ["imr"])
    objectives = [objectives] if isinstance(objectives, str) else list(objectives)
    if not objectives:
        raise Error("no objective is given")
    for objective in objectives:
        _add_objective(filter_, objective, targets)
    filter_.SetScalarization(pick("scalarization", chosen.pop("scalarization", "exponential sum"), SCALARIZATIONS))
    filter_.SetOptimizer(pick("optimizer", chosen.pop("optimizer", "automatic"), OPTIMIZERS))
    for name, value in chosen.items():
        _OPTIONS[name](filter_, value)


def _add_objective(filter_: Any, objective: Any, targets: list[str]) -> None:
    pair = (objective, {}) if isinstance(objective, str) else objective
    name, facts = pair if isinstance(pair, (tuple, list)) and len(pair) == 2 else (None, None)
    if not isinstance(name, str) or not isinstance(facts, dict):
        raise Error(f"an objective is the name of a metric or (name, dict), not {objective!r}")
    unknown = set(facts) - {"template", "weight", "target"}
    if unknown:
        raise Error(f"objective {name!r}: there is no {sorted(unknown)[0]!r}; there are template, weight and target")
    target = facts.get("target", targets[0] if len(targets) == 1 else "ideal")
    if target in TARGETS[1:] and target not in targets:
        raise Error(f"objective {name!r}: the target is {target!r} but {target!r} is not given")
    form = pick("template", facts.get("template", "default"), TEMPLATES) - 1
    weight = within("weight", facts.get("weight", 1.0), np.nextafter(0, 1), np.inf)
    filter_.AddObjectiveByName(name, form, weight, pick("target", target, TARGETS))


def _number(setter: str, low: float, high: float, kind: type = float):
    def set_(filter_: Any, value: Any) -> None:
        getattr(filter_, setter)(kind(within(snake(setter[3:]), value, low, high)))

    return set_


def _flag(setter: str):
    return lambda filter_, value: getattr(filter_, setter)(bool(value))


def _utopia(filter_: Any, values: Any) -> None:
    for value in np.atleast_1d(values):
        filter_.AddUtopia(within("utopia", float(value), -np.inf, np.inf))


_OPTIONS = {
    "maximum_iterations": _number("SetMaximumIterations", 0, _MOST_ITERATIONS, int),
    "gradient_norm": _number("SetGradientNorm", 0, 1),
    "relative_change": _number("SetRelativeChange", 0, 1),
    "two_digits": _flag("SetTwoDigits"),
    "reduction": _number("SetReduction", 0, 1),
    "best_known": _number("SetBestKnown", -np.inf, np.inf),
    "stop_when_valid": _flag("SetStopWhenValid"),
    "c": _number("SetC", 0, np.inf),
    "exponent": _number("SetExponent", np.nextafter(0, 1), np.inf),
    "tolerance": _number("SetTolerance", 0, np.inf),
    "utopia": _utopia,
    "power": _number("SetPower", np.nextafter(0, 1), np.inf),
    "combination": lambda filter_, value: filter_.SetCombination(pick("combination", value, COMBINATIONS)),
    "beta": _number("SetBeta", -np.inf, np.inf),
    "culling": _number("SetCulling", 0, 1),
    "patch_iterations": _number("SetPatchIterations", 1, 1000, int),
    "relaxation": _number("SetRelaxation", 1, 1.99),
    "improve_worst": _number("SetImproveWorst", 0, 1),
    "rescale_untangling": _flag("SetRescaleUntangling"),
}


@dataclass(frozen=True)
class Untangled:
    """What untangle() made. Of composite data, numbers are of all blocks."""

    #: The mesh with other points, `Displacement`, `Validity` and `Obstacle`.
    mesh: vtkDataObject
    #: Per iteration (0 is the input): iteration, objective (the energy), inverted, gradient_norm, moving, seconds;
    #: of composite data block.
    history: dict[str, Any]
    #: Per cell, as in Optimized.
    validity: np.ndarray
    #: Per cell why it is not valid: 0 it is, 1 the iterations ended, 2 all its points are fixed, 3 the
    #: fixed points around leave no place, 4 a fixed point is not finite.
    obstacle: np.ndarray
    #: Inverted or degenerate elements before and after, and those that fixed points make impossible.
    inverted_before: int
    inverted: int
    impossible: int
    #: Why it stopped.
    reason: str
    #: New minus old position, n x 3.
    displacement: np.ndarray
    #: The result in words: which elements remain, where and why.
    summary: str


def untangle(
    mesh: Mesh,
    effort: str = "normal",
    *,
    fixed: str | Sequence | None = None,
    fix_boundary: bool = True,
    time_limit: float = 0.0,
    threads: int = 0,
) -> Untangled:
    """Make the elements of a mesh valid by moving its points; never more are inverted than before.

    mesh: a vtkDataSet with explicit points, a file name or (points, cells). It is not changed.
    effort: "local" (only around inverted elements), "normal" (then all points) or "thorough".
    fixed: points that stay: truth values, one per point, or the name of a point array.
    fix_boundary: whether the points of the boundary stay.
    time_limit: seconds; 0 is no limit.
    threads: 0 is all cores. The result does not depend on it.

    Raises Error for wrong arguments and whatever the filter refuses; elements that remain inverted are
    no error: see inverted, obstacle and summary of the result.
    """
    filter_ = tautline.vtkMeshUntangler()
    filter_.SetEffort(pick("effort", effort, EFFORTS))
    filter_.SetFixBoundary(bool(fix_boundary))
    filter_.SetTimeLimit(within("time_limit", time_limit, 0, np.inf))
    filter_.SetThreads(int(within("threads", threads, 0, _MOST_THREADS)))
    filter_.SetInputDataObject(0, _set_array(filter_, as_mesh(mesh), 0, fixed, "fixed"))
    run(filter_)
    output = _without_own(filter_.GetOutputDataObject(0))
    return Untangled(
        mesh=output,
        history=_history(filter_),
        validity=cell_array(output, "Validity"),
        obstacle=cell_array(output, "Obstacle"),
        inverted_before=filter_.GetInvertedBefore(),
        inverted=filter_.GetInvertedAfter(),
        impossible=filter_.GetImpossible(),
        reason=filter_.GetReason(),
        displacement=point_array(output, "Displacement"),
        summary=filter_.GetSummary(),
    )


def _set_array(filter_: Any, data: vtkDataObject, index: int, values: Any, name: str) -> vtkDataObject:
    """Choose an array by name, or add one of numbers to a copy of the mesh; returns the mesh."""
    if values is None:
        return data
    on_points = name in ("fixed", "limits")
    if not isinstance(values, str):
        points, cells = data.GetNumberOfPoints(), data.GetNumberOfCells()
        if on_points and len(np.atleast_1d(values)) != points:
            raise Error(f"{name} has the shape {np.shape(values)}; a value for each of the {points} points is expected")
        if name == "element weights" and len(np.atleast_1d(values)) != cells:
            raise Error(f"{name} have the shape {np.shape(values)}; a value for each of the {cells} cells is expected")
    data, where, found = with_array(data, values, _OWN + name, points_only=on_points)
    if name == "element weights" and where != vtkDataObject.FIELD_ASSOCIATION_CELLS:
        raise Error(f"element weights are per cell; '{found}' is a point array")
    filter_.SetInputArrayToProcess(index, 0, 0, where, found)
    return data


def _without_own(output: vtkDataObject) -> vtkDataObject:
    for leaf in leaves(output) if isinstance(output, vtkDataSet) else ():
        for fields in (leaf.GetPointData(), leaf.GetCellData()):
            names = [fields.GetArrayName(i) for i in range(fields.GetNumberOfArrays())]
            for name in names:
                if name and name.startswith(_OWN):
                    fields.RemoveArray(name)
    return output


def _history(filter_: Any) -> dict[str, Any]:
    table = columns(filter_.GetHistory())
    found = {_COLUMNS.get(name, name.lower().replace(" ", "_")): column for name, column in table.items()}
    rows = len(found.get("objective", ()))
    blocks = found.get("block", [""] * rows)
    iteration = [row - blocks.index(blocks[row]) for row in range(rows)]
    history = {"iteration": np.array(iteration, int), **found}
    for name in ("inverted", "moving"):
        history[name] = np.asarray(history.get(name, ())).astype(int)
    return history


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


# --- the shell -------------------------------------------------------------------------------------


def add_commands(commands: Any) -> None:
    """Add `optimize` and `untangle` to the subparsers of the command line; each sets `run`."""
    for name, text in (("optimize", "make the elements of a mesh better"), ("untangle", "make them valid")):
        parser = commands.add_parser(name, help=text, description=f"Move points to {text}.")
        parser.add_argument("mesh", metavar="FILE")
        parser.add_argument("-o", "--output", metavar="FILE", required=True)
        parser.add_argument("--csv", metavar="FILE", help="write the history, a row per iteration")
        parser.add_argument("--fixed", metavar="ARRAY", help="point array, not 0 where points stay")
        parser.add_argument("--time-limit", type=float, default=0.0, help="seconds; 0, the default, is no limit")
        parser.add_argument("--threads", type=int, default=0, help="0, the default, is all cores")
        if name == "untangle":
            parser.add_argument("--effort", choices=EFFORTS, default="normal")
            parser.set_defaults(run=_run_untangle)
    parser = commands.choices["optimize"]
    parser.add_argument("--preset", choices=PRESETS[1:], help="the default, without --objective, is best shape")
    parser.add_argument("--objective", action="append", type=_objective, metavar="NAME[,KEY=VALUE...]",
                        help="a metric, with template=, weight= and target= if wanted; several are several objectives")  # fmt: skip
    parser.add_argument("--scalarization", choices=SCALARIZATIONS, help="(default: exponential sum)")
    parser.add_argument("--optimizer", choices=OPTIMIZERS, help="(default: automatic)")
    parser.add_argument("--iterations", type=int, dest="maximum_iterations", help="at most so many (default: 100)")
    parser.add_argument("--reference", metavar="FILE", help="target: the same cells of this mesh")
    parser.add_argument("--size", metavar="ARRAY", help="target: the size in this array")
    parser.add_argument("--tensor", metavar="ARRAY", help="target: the metric tensor in this array")
    parser.add_argument("--boundary", choices=BOUNDARIES, default="fixed")
    parser.set_defaults(run=_run_optimize)


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


def _run_optimize(arguments: argparse.Namespace) -> None:
    passed = ("preset", "scalarization", "optimizer", "maximum_iterations", "reference", "size", "tensor", "fixed",
              "boundary", "time_limit", "threads")  # fmt: skip
    options = {name: getattr(arguments, name) for name in passed}
    _finish(optimize(arguments.mesh, arguments.objective, **options), arguments)


def _run_untangle(arguments: argparse.Namespace) -> int:
    passed = ("effort", "fixed", "time_limit", "threads")
    result = untangle(arguments.mesh, **{name: getattr(arguments, name) for name in passed})
    _finish(result, arguments)
    return 1 if result.inverted else 0


def _finish(result: Any, arguments: argparse.Namespace) -> None:
    from ._tables import csv_text

    print(result.summary)
    print("\n".join(tautline.write(result, arguments.output)))
    if arguments.csv:
        names = list(result.history)
        rows = [dict(zip(names, values)) for values in zip(*result.history.values())]
        try:
            with open(arguments.csv, "w", encoding="utf-8", newline="") as out:
                out.write(csv_text(rows))
        except OSError as error:
            raise Error(f"{arguments.csv}: cannot be written: {error.strerror}") from None
        print(arguments.csv)
