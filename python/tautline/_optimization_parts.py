# SPDX-License-Identifier: BSD-3-Clause
"""The function optimize: move points so that elements become better."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any, ClassVar, Iterable, Literal, Union, get_args

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataObject

from . import _commands, _vtk
from ._arguments import (
    COMBINATIONS,
    TARGETS,
    Redistribution,
    check_options,
    flag_option,
    number,
    number_option,
    pick,
    picked,
    set_options,
    set_redistribution,
    set_threads,
    set_time_limit,
    within,
)
from ._arrays import (
    ANY,
    CELLS,
    POINTS,
    Array,
    InputArrays,
    Values,
    cell_array,
    columns,
    history_of,
    point_array,
    snake,
    table_rows,
)
from ._errors import Error, interruptible, run, watch
from ._interrupts import Progress
from ._io import Mesh, as_mesh
from ._results import Result

Preset = Literal[
    "custom",
    "fast clean-up",
    "best shape",
    "uniform size",
    "low interpolation error",
    "untangle then improve",
    "preserve shape",
    "worst element",
]
PRESETS: tuple[Preset, ...] = get_args(Preset)
Template = Literal[
    "default",
    "sum of squares",
    "sum of squared reciprocals",
    "sum of reciprocals",
    "sum",
    "power mean",
    "maximum",
]
TEMPLATES: tuple[Template, ...] = get_args(Template)
Scalarization = Literal[
    "exponential sum",
    "objective product",
    "equal sum",
    "weighted sum",
    "weighted min-max",
    "exponential weighted",
    "lexicographic",
    "rao",
]
SCALARIZATIONS: tuple[Scalarization, ...] = get_args(Scalarization)
Optimizer = Literal[
    "automatic",
    "local newton",
    "local conjugate gradient",
    "fletcher-reeves",
    "polak-ribiere",
    "l-bfgs",
    "newton-cg",
]
OPTIMIZERS: tuple[Optimizer, ...] = get_args(Optimizer)
Boundary = Literal["fixed", "sliding", "free", "on surface"]
BOUNDARIES: tuple[Boundary, ...] = get_args(Boundary)

_MAX_ITERATIONS = 1000000
_SIZE, _TENSOR, _FIXED, _LIMITS, _WEIGHTS, _KINDS, _REGIONS = range(7)  # input arrays of vtkMeshOptimizer

#: An objective: the name of a metric, or (name, {"template": ..., "weight": ..., "target": ...}).
Objective = Union[str, "tuple[str, dict[str, Any]]"]


@dataclass(frozen=True, repr=False, eq=False)
class OptimizeResult(Result):
    """The result of optimize(). Of composite data, numbers are of all blocks; the reason is that of the last one.

    mesh: the mesh with the new points, `Displacement`, `Validity`, and per metric its value after (`imr`) and before
        (`imr_before`).
    history: per iteration (0 is the input): iteration, objective, <metric>_mean, <metric>_worst, of several objectives
        also <metric>_objective; inverted, gradient_norm, moving, seconds; of composite data also block.
    statistics: per metric: label, and with the suffixes _before and _after: minimum, mean, maximum, rms,
        standard_deviation, worst, outside_acceptable, inverted, degenerate. Of composite data the keys are "block n
        metric".
    reason: the stopping criterion that ended the run.
    inverted_before, inverted, iterations: number of inverted or degenerate elements before and after.
    free: number of points that were free to move.
    displacement: new minus old position, n x 3.
    validity: per cell, m: 1 valid, 0 degenerate, -1 inverted, -2 not measured, -3 not finite.
    surface_error: largest distance between the facets of a surface in space (of the boundary, where its points slide)
        and those of the input, measured from either to the other, or from them to the geometry; in the mesh's unit.
    summary: the result in words.
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


@interruptible
def optimize(
    mesh: Mesh,
    objectives: str | Iterable[Objective] | None = None,
    *,
    preset: Preset | None = None,
    scalarization: Scalarization | None = None,
    optimizer: Optimizer | None = None,
    reference: Mesh | None = None,
    size: float | Values | None = None,
    tensor: Values | None = None,
    fixed: Values | None = None,
    boundary: Boundary = "fixed",
    flat_angle: float = 1.0,
    feature_angle: float = 40.0,
    keep_features: bool = True,
    smooth_surface: bool = True,
    surface_tolerance: float = 0.001,
    leave_surface: bool = True,
    show_features: bool = False,
    feature_kinds: Values | None = None,
    regions: Values | None = None,
    geometry: Mesh | None = None,
    limits: float | Values | None = None,
    element_weights: Values | None = None,
    project_to_surface: bool = True,
    untangle_first: bool = True,
    allow_inversion: bool = False,
    worst_metric: str | None = None,
    hold_worst: bool = True,
    time_limit: float = 0.0,
    threads: int = 0,
    merge_coincident_points: bool = True,
    reproducible_order: bool = False,
    redistribute: Redistribution | bool = "off",
    progress: Progress | bool | None = None,
    **options: Any,
) -> OptimizeResult:
    """Move the points of a mesh so that its elements become better.

    Unless allow_inversion, neither the objective nor the number of invalid elements nor the worst element becomes
    worse.

    mesh: a vtkDataSet with explicit points, a composite data set, a file name or (points, cells). It is not changed.
    objectives: what to optimize: names of metrics, or pairs of a name and a dict with any of "template" (how the values
        of the elements are aggregated: "default", "sum of squares", "sum of squared reciprocals", "sum of
        reciprocals", "sum", "power mean", "maximum"), "weight" (above 0; 1) and "target" ("ideal", "reference", "size",
        "tensor"; the default is the one given below, if it is one, else "ideal"). The default is ["imr"].
    preset: "fast clean-up", "best shape", "uniform size", "low interpolation error", "untangle then improve", "preserve
        shape" (of the reference) or "worst element". It replaces objectives, scalarization, optimizer and options,
        which cannot be given with it. "best shape" is the default if none of them and no target is given.
    scalarization: how several objectives are combined into one: "exponential sum" (the default), "objective product",
        "equal sum", "weighted sum", "weighted min-max", "exponential weighted", "lexicographic", "rao".
    optimizer: "automatic" (the default), "local newton", "local conjugate gradient", "fletcher-reeves",
        "polak-ribiere", "l-bfgs", "newton-cg".
    reference, size, tensor: the target element, see quality(); several may be given.
    fixed: points that stay in place: one number or truth value per point, n, or the name of a point array.
    boundary: "fixed"; "sliding" (points on flat or straight parts of the boundary move along them, see flat_angle);
        "on surface" (also points on curved but smooth parts, see feature_angle); or "free".
    flat_angle: largest angle, in degrees, between any facets of a flat part, 0 to 90.
    feature_angle: least angle, in degrees, between facets at a feature, 0 to 180.
    keep_features: whether corners, sharp edges, borders and patches of a surface in space are kept, and with the
        boundary "on surface" those of the boundary: corners stay, other points slide on their curve or patch.
    smooth_surface: whether they slide on a smooth surface through the points of the input, or on its facets.
    surface_tolerance: with the boundary "on surface", how far the new boundary may be from the old one, and the old one
        from the new one (with a geometry, only the new one from that), as a fraction of the diagonal of the bounding
        box, 0 to 1; 0: any distance. The same of interfaces of regions, with any boundary.
    leave_surface: with the preset "worst element" and the boundary "on surface", whether points of the boundary near
        the worst elements, corners too, may leave the surface within surface_tolerance, where sliding does not improve
        these elements any more. Needs keep_features and a surface_tolerance above 0; not with a geometry or limits.
    show_features: whether the result has the point array `FeatureKind` (0 within a patch, 1 on a curve, 2 corner) and
        the point and cell array `PatchId`.
    feature_kinds: kinds of the points instead of those found: 0, 1, 2, or -1 as found; one per point, or the name of a
        point array.
    regions: numbers of regions, whose interfaces are kept, within surface_tolerance: one per cell, or the name of a
        cell array.
    geometry: a surface of triangles or quadrilaterals that points slide on instead of the surface of the mesh, after
        they are placed on it; its features are matched to those of the mesh.
    limits: largest displacement of points, in the mesh's unit: a number (0: no limit), one per point (negative: no
        limit), or the name of a point array.
    element_weights: weights of the elements, at least 0: one per cell, or the name of a cell array.
    project_to_surface: whether the points of a surface in space stay on it.
    untangle_first: whether a mesh with inverted elements is untangled first where the objectives cannot repair it.
    allow_inversion: whether steps may invert valid elements.
    worst_metric: the metric by which the worst element is found, which never gets worse by it and which the
        preset "worst element" and improve_worst improve. The default is the scaled Jacobian where the worst element is
        improved in a mesh with quadrilaterals, hexahedra or wedges, but no pyramids; else the metric of the first
        objective.
    hold_worst: whether the worst element of a valid mesh must not get worse; False: a smaller objective may cost single
        elements.
    time_limit: seconds; 0 is no limit.
    threads: number of threads; 0 is all cores. The result does not depend on it.
    merge_coincident_points: whether points at the same place on facets that match are treated as one, as on the seams
        of a mesh in pieces; the result keeps them all. False: they stay apart, as a crack or a contact needs it.
    reproducible_order: work in the order that does not depend on how a mesh is spread over processes, as several of
        them do unless the mesh is gathered.
    redistribute: on several processes (pvbatch --sym under MPI, where each calls this function with its piece): divide
        the mesh anew among them, also where the first one has all of it; "off", "k-d tree" (or True), "pt-scotch".
    options: properties of vtkMeshOptimizer. Stopping: maximum_iterations (300), gradient_norm (1e-6), relative_change
        (1e-5), two_digits (False), reduction (1: off), best_known (None: estimated), stop_when_valid (False).
        Scalarization: c (0: automatic), exponent (1), tolerance (0.01), utopia (one number per objective). Metrics:
        power (8), combination ("mean", "worst", "power mean"), beta (0). Methods: culling (1e-3), patch_iterations
        (1), relaxation (1.4), improve_worst (0), rescale_untangling (True).

    Raises Error for wrong arguments and for meshes that the filter refuses.

    >>> result = tautline.optimize("part.vtu", ["imr", ("si", {"weight": 2})], scalarization="weighted sum")
    >>> result.statistics["imr"]["worst_after"], result.reason
    """
    filter_ = _vtk.vtkMeshOptimizer()
    messages = watch(filter_)
    inputs = InputArrays(filter_, as_mesh(mesh))
    given = {"reference": reference, "size": size, "tensor": tensor}
    custom = {"objectives": objectives, "scalarization": scalarization, "optimizer": optimizer, **options}
    _set_method(filter_, preset, custom, [name for name, value in given.items() if value is not None])
    messages.raise_errors()
    filter_.SetBoundary(pick("boundary", boundary, BOUNDARIES))
    filter_.SetFlatAngle(within("flat_angle", flat_angle, 0, 90))
    filter_.SetFeatureAngle(within("feature_angle", feature_angle, 0, 180))
    filter_.SetKeepFeatures(bool(keep_features))
    filter_.SetSmoothSurface(bool(smooth_surface))
    filter_.SetSurfaceTolerance(within("surface_tolerance", surface_tolerance, 0, 1))
    filter_.SetLeaveSurface(bool(leave_surface))
    filter_.SetShowFeatures(bool(show_features))
    filter_.SetProjectToSurface(bool(project_to_surface))
    filter_.SetUntangleFirst(bool(untangle_first))
    filter_.SetAllowInversion(bool(allow_inversion))
    filter_.SetHoldWorst(bool(hold_worst))
    if worst_metric is not None:
        filter_.SetWorstMetricByName(worst_metric)
        messages.raise_errors()
    set_time_limit(filter_, time_limit)
    set_threads(filter_, threads)
    filter_.SetMergeCoincidentPoints(bool(merge_coincident_points))
    filter_.SetReproducibleOrder(bool(reproducible_order))
    set_redistribution(filter_, redistribute)
    if _is_number(size):
        size = np.full(inputs.mesh.GetNumberOfCells(), size)
    if _is_number(limits):
        filter_.SetMaximumDisplacement(within("limits", number("limits", limits), 0, np.inf))
        limits = None
    inputs.use(_SIZE, size, "size", ANY)
    inputs.use(_TENSOR, tensor, "tensor", ANY)
    inputs.use(_FIXED, fixed, "fixed", POINTS)
    inputs.use(_LIMITS, limits, "limits", POINTS)
    inputs.use(_WEIGHTS, element_weights, "element weights", CELLS)
    inputs.use(_KINDS, feature_kinds, "feature kinds", POINTS)
    inputs.use(_REGIONS, regions, "regions", CELLS)
    filter_.SetInputDataObject(0, inputs.mesh)
    if geometry is not None:
        filter_.SetInputDataObject(3, as_mesh(geometry))
    if reference is not None:
        filter_.SetInputDataObject(1, as_mesh(reference))
    run(filter_, messages)
    output = inputs.remove_from(filter_.GetOutputDataObject(0))
    return OptimizeResult(
        mesh=output,
        history=history_of(filter_),
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


def _is_number(value: Any) -> bool:
    return value is not None and not isinstance(value, str) and np.ndim(value) == 0


def _set_method(filter_: Any, preset: str | None, custom: dict[str, Any], targets: list[str]) -> None:
    """Set the preset, or the objectives, the method and the options; `targets` are those given to optimize()."""
    chosen = {name: value for name, value in custom.items() if value is not None}
    method = ("objectives", "scalarization", "optimizer")
    check_options({name: value for name, value in chosen.items() if name not in method}, _OPTIONS)
    if preset is None:
        preset = "custom" if chosen or targets else "best shape"
    preset = picked("preset", preset, PRESETS)
    filter_.SetPreset(PRESETS.index(preset))
    if preset != "custom":
        if chosen:
            raise Error(f"the preset {preset!r} decides on {', '.join(chosen)}: give one or the other")
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
    set_options(filter_, chosen, _OPTIONS)


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
    filter_.AddObjectiveByName(name, template, weight, TARGETS.index(target))


def _best_known(filter_: Any, value: float | None) -> None:
    filter_.SetUseBestKnown(value is not None)
    if value is not None:
        filter_.SetBestKnown(within("best_known", value, -np.inf, np.inf))


def _utopia(filter_: Any, values: Any) -> None:
    for value in np.atleast_1d(values):
        filter_.AddUtopia(within("utopia", float(value), -np.inf, np.inf))


_OPTIONS = {
    "maximum_iterations": number_option("SetMaximumIterations", 0, _MAX_ITERATIONS, int),
    "gradient_norm": number_option("SetGradientNorm", 0, 1),
    "relative_change": number_option("SetRelativeChange", 0, 1),
    "two_digits": flag_option("SetTwoDigits"),
    "reduction": number_option("SetReduction", 0, 1),
    "best_known": _best_known,
    "stop_when_valid": flag_option("SetStopWhenValid"),
    "c": number_option("SetC", 0, np.inf),
    "exponent": number_option("SetExponent", np.nextafter(0, 1), np.inf),
    "tolerance": number_option("SetTolerance", 0, np.inf),
    "utopia": _utopia,
    "power": number_option("SetPower", np.nextafter(0, 1), np.inf),
    "combination": lambda filter_, value: filter_.SetCombination(pick("combination", value, COMBINATIONS)),
    "beta": number_option("SetBeta", -np.inf, np.inf),
    "culling": number_option("SetCulling", 0, 1),
    "patch_iterations": number_option("SetPatchIterations", 1, 1000, int),
    "relaxation": number_option("SetRelaxation", 1, 1.99),
    "improve_worst": number_option("SetImproveWorst", 0, 1),
    "rescale_untangling": flag_option("SetRescaleUntangling"),
}


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


def add_commands(commands: Any) -> None:
    """Add `optimize` to the subparsers of the command line."""
    parser = _commands.add_command(
        commands, "optimize", _run_optimize, "move points so that elements become better",
        example='part.vtu --preset "best shape" -o better.vtu',
        details="Neither the number of inverted elements nor the worst element becomes worse. Exits with 1 if some "
        "elements remain inverted.",
    )
    _commands.add_moving_points(parser)
    _commands.add_reproducible_order(parser)
    parser.add_argument("--preset", choices=PRESETS[1:], help="without --objective, the default is best shape")
    parser.add_argument("--objectives", "--objective", action="append", type=_objective, metavar="NAME[,KEY=VALUE...]",
                        help="a metric, optionally with template=, weight= and target=; may be repeated")  # fmt: skip
    parser.add_argument("--scalarization", choices=SCALARIZATIONS, help="(default: exponential sum)")
    parser.add_argument("--optimizer", choices=OPTIMIZERS, help="(default: automatic)")
    parser.add_argument("--maximum-iterations", "--iterations", type=int, help="the maximum (default: 300)")
    parser.add_argument("--reference", metavar="FILE", help="target: the same cells of this mesh")
    parser.add_argument("--size", metavar="ARRAY", help="target: the size in this array")
    parser.add_argument("--tensor", metavar="ARRAY", help="target: the metric tensor in this array")
    parser.add_argument(
        "--boundary",
        choices=BOUNDARIES,
        default="fixed",
        help="sliding: points move within its flat parts; on surface: on smooth curved ones, too (default: fixed)",
    )
    parser.add_argument("--flat-angle", type=float, metavar="DEGREES", default=1.0,
                        help="facets that differ by at most this are one plane (default: 1)")  # fmt: skip
    parser.add_argument("--worst-metric", metavar="NAME", help="the metric by which the worst element is found")
    _commands.add_flag(parser, "hold_worst", "whether the worst element must not get worse")
    parser.add_argument("--feature-angle", type=float, metavar="DEGREES", default=40.0,
                        help="edges that bend more are sharp (default: 40)")  # fmt: skip
    _commands.add_flag(parser, "keep_features", "whether points of a surface stay on sharp edges", "--no-features")
    _commands.add_flag(parser, "smooth_surface", "whether points slide on a smooth surface, not on facets", "--facets")
    parser.add_argument("--surface-tolerance", type=float, metavar="FRACTION", default=0.001,
                        help="how far, in diagonals, a boundary may slide off itself (default: 0.001)")  # fmt: skip
    _commands.add_flag(parser, "leave_surface", "whether points near the worst elements may leave the boundary by that")
    parser.add_argument("--show-features", action="store_true", help="add the arrays FeatureKind and PatchId")
    parser.add_argument("--feature-kinds", metavar="ARRAY", help="point array: 0 patch, 1 curve, 2 corner, -1 as found")
    parser.add_argument("--regions", metavar="ARRAY", help="cell array of regions, whose interfaces are kept")
    parser.add_argument("--geometry", metavar="FILE", help="a surface that points slide on instead of their own")
    parser.add_argument("--limits", metavar="LENGTH|ARRAY", type=_commands.number_or_name,
                        help="largest displacement: a length or a point array (default: 0, no limit)")  # fmt: skip
    parser.add_argument("--element-weights", metavar="ARRAY", help="cell array of weights of the elements")
    _commands.add_flag(parser, "project_to_surface", "whether points of a surface in space stay on it")
    _commands.add_flag(parser, "untangle_first", "whether inverted elements are untangled first where the objectives "
                       "cannot repair them")  # fmt: skip
    parser.add_argument("--allow-inversion", action="store_true", help="steps may invert valid elements")
    _commands.add_extras(parser, "of the optimizer, without a preset", _EXTRAS)


_EXTRAS: tuple[_commands.Extra, ...] = (
    ("gradient_norm", float, "end when the norm of the gradient has fallen by this factor (default: 1e-6)"),
    ("relative_change", float, "end at this relative change of the objective in an iteration (default: 1e-5)"),
    ("two_digits", bool, "whether to end when all mean qualities keep two decimals"),
    ("reduction", float, "end at this part of the possible reduction, 0 to 1 (default: 1, off)"),
    ("best_known", float, "the least objective that is known, of --reduction (default: estimated)"),
    ("stop_when_valid", bool, "whether to end when all elements are valid"),
    ("c", float, "parameter of exponential sum (default: 0, automatic)"),
    ("exponent", float, "of exponential weighted (default: 1)"),
    ("tolerance", float, "relative rise of an objective for later ones, of lexicographic (default: 0.01)"),
    ("utopia", _commands.numbers, "best value of each objective, of scalarizations that have one (default: 0)"),
    ("power", float, "exponent of the power mean (default: 8)"),
    ("combination", COMBINATIONS, "of the values at the corners of a cell (default: mean)"),
    ("beta", float, "least area or volume of an element, of the untangling metric (default: 0)"),
    ("culling", float, "leave out points that move less than this part of an edge (default: 1e-3)"),
    ("patch_iterations", int, "steps in each patch of the local optimizers (default: 1)"),
    ("relaxation", float, "factor of a step of local newton, 1 to 1.99 (default: 1.4)"),
    ("improve_worst", float, "then improve the worst element, the mean worse by at most this part (default: 0, off)"),
    ("rescale_untangling", bool, "whether untangling objectives are scaled up at the start (default: yes)"),
)


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


def _run_optimize(arguments: argparse.Namespace) -> int:
    names = ("preset", "scalarization", "optimizer", "maximum_iterations", "reference", "size", "tensor", "fixed",
             "boundary", "flat_angle", "worst_metric", "hold_worst", "feature_angle", "keep_features", "smooth_surface",
             "surface_tolerance", "leave_surface", "show_features", "feature_kinds", "regions", "geometry",
             "limits", "element_weights", "project_to_surface", "untangle_first", "allow_inversion",
             "time_limit", "threads", "merge_coincident_points", "reproducible_order")  # fmt: skip
    options = _commands.given(arguments, names) | _commands.given_extras(arguments, _EXTRAS)
    result = optimize(arguments.mesh, arguments.objectives, **options)
    _commands.finish(arguments, result, result.summary, table_rows(result.history))
    return 1 if result.inverted else 0
