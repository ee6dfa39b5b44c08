"""The verb warp: the interior of a mesh follows its boundary."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any, Mapping, Sequence, Union

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkDataSet
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkCommonTransforms import vtkLinearTransform, vtkTransform

import tautline

from ._errors import Error, run
from ._mesh import Mesh, as_mesh, cell_array, columns, point_array, with_array
from ._metrics import pick, within
from ._optimization import _OWN, _finish, _flag, _number, _without_own

METHODS = (
    "hybrid",
    "femwarp",
    "anisotropic femwarp",
    "small-step femwarp",
    "femwarp and untangling",
    "iterative stiffening",
    "jacobian stiffening",
    "biharmonic",
    "inverse distance",
    "radial basis",
    "weighted laplacian",
)
COEFFICIENTS = ("displacement sums", "principal directions")
CORRESPONDENCES = ("automatic", "same mesh", "same boundary", "point ids", "closest point")
PARTS = ("automatic", "whole boundary", "inner boundaries")
SOLVERS = ("automatic", "conjugate gradients", "gmres", "minres", "bicgstab", "direct")
PRECONDITIONERS = ("jacobi", "ssor", "ilu", "boomeramg", "icc", "gamg", "none")

_MOST_THREADS = 1024
_DISPLACEMENT, _MOVED, _FIXED, _TENSORS, _REGIONS = range(5)  # arrays of vtkMeshWarp
_BY_ARRAY, _BY_TARGET, _BY_TRANSFORM = range(3)  # its motions
_NUMBERED_PARTS, _ARRAY_VALUES = 3, 4  # its moved parts
_MANUAL, _PER_CELL, _PER_REGION = 2, 3, 4  # its coefficients
_TRANSLATION, _ROTATION, _SCALING, _BENDING = 1, 2, 3, 4  # its transforms
_KINDS = {"translate": _TRANSLATION, "rotate": _ROTATION, "scale": _SCALING, "bend": _BENDING}
_ALLOWED = {
    "translate": (),
    "rotate": ("axis", "center"),
    "scale": ("center",),
    "bend": ("axis", "direction", "center"),
}
_COUNTS = ("elements", "boundary_points", "moved_points", "inverted_after_warp", "inverted", "impossible",
           "crossings", "decoupled")  # fmt: skip

#: A transform: {"translate": (x, y, z)}, {"rotate": degrees, "axis": ..., "center": ...}, {"scale": factor or three,
#: "center": ...}, {"bend": degrees, "axis": ..., "direction": ..., "center": ...}, a 4 x 4 matrix or a VTK transform.
Transform = Union[Mapping[str, Any], Sequence, vtkLinearTransform]


@dataclass(frozen=True)
class Warped:
    """What warp() made. Of composite data, numbers are of all blocks."""

    #: The mesh with other points, `Displacement`, `TMP shape` and `Validity`.
    mesh: vtkDataObject
    #: Inverted or degenerate elements at the end and after the warp itself, and those that the moved boundary, not
    #: being valid itself, makes impossible.
    inverted: int
    inverted_after_warp: int
    impossible: int
    #: Per stage: amount, inverted, worst_shape, mean_shape, stage (list of str), iterations, seconds; of composite data
    #: block.
    history: dict[str, Any]
    #: elements, boundary_points, moved_points, largest_displacement, amount, inverted_after_warp, inverted, impossible,
    #: crossings, worst_shape, mean_shape, worst_imr_before, mean_imr_before, worst_imr, mean_imr, cxx to cxz, decoupled,
    #: regularization, reused, and assemble_, set_up_, solve_, improve_ and total_seconds. Of composite data
    #: a dict of these per block.
    statistics: dict[str, Any]
    #: New minus old position, n x 3.
    displacement: np.ndarray
    #: Per cell, 0 where the shape is that of the mesh before.
    shape: np.ndarray
    #: Per cell 1 valid, 0 degenerate, -1 inverted, -2 not measured.
    validity: np.ndarray
    #: The result in words.
    summary: str


def warp(
    mesh: Mesh,
    displacement: str | Sequence | None = None,
    method: str = "hybrid",
    amount: float = 1.0,
    *,
    target: Mesh | None = None,
    transform: Transform | None = None,
    correspondence: str = "automatic",
    target_ids: str | Sequence | None = None,
    moved: str | int | Sequence | None = None,
    values: Sequence[float] = (),
    fixed: str | Sequence | None = None,
    coefficients: str | Sequence = "displacement sums",
    regions: tuple[str | Sequence, Mapping[float, Sequence[float]]] | None = None,
    solver: str = "automatic",
    preconditioner: str = "boomeramg",
    time_limit: float = 0.0,
    threads: int = 0,
    **options: Any,
) -> Warped:
    """Move the interior of a mesh after its boundary, keeping its elements valid and their shapes.

    mesh: a vtkDataSet with explicit points, a file name or (points, cells), without inverted elements. It is not
        changed.
    displacement, target, transform: how the boundary moves; one of them.
        displacement: the name of a point array, or n x 3 (n x 2) numbers; what it says of inner points is not read.
        target: the mesh or its boundary in its new place, or any surface (in the plane a curve) to project it to.
        transform: of the points `moved`: {"translate": (x, y, z)}, {"rotate": degrees, "axis": (0, 0, 1)}, {"scale":
            factor or three}, {"bend": degrees, "axis": (0, 0, 1), "direction": (1, 0, 0)}, each about the middle of
            what moves or a "center"; a 4 x 4 matrix; or a vtkTransform.
    method: "hybrid" (anisotropic FEMWARP, then shape and validity), "femwarp", "anisotropic femwarp", "small-step
        femwarp", "femwarp and untangling", "iterative stiffening", "jacobian stiffening", "biharmonic", "inverse
        distance", "radial basis", "weighted laplacian".
    amount: of the motion, along its path; 0 is the mesh itself, 1 the whole.
    correspondence: of points to those of the target: "automatic", "same mesh", "same boundary", "point ids" (of
        target_ids: the name of a point array of the target, or point numbers), "closest point".
    moved: what a transform or projection moves, the rest of the boundary stays: "automatic" (the inner boundaries; all
        if there are none), "whole boundary", "inner boundaries"; numbers of boundary parts, the largest is 1; or the
        name of an array (of points or cells), or a value per point: not 0, or one of `values`.
    fixed: points that stay: truth values, one per point, or the name of a point array.
    coefficients: of "hybrid" and "anisotropic femwarp": "displacement sums", "principal directions", 3 or 6 numbers
        (alpha beta gamma, or xx yy zz xy yz xz), the name of a cell array of tensors, or rows of 1, 3, 6 or 9 per cell.
    regions: (cell array, {value: (alpha, beta, gamma)}); cells of other values have the coefficients, if numbers.
    solver, preconditioner: of the linear systems: "automatic", "conjugate gradients", "gmres", "minres", "bicgstab",
        "direct"; "jacobi", "ssor", "ilu", "boomeramg", "icc", "gamg", "none".
    time_limit: seconds; 0 is no limit.
    threads: 0 is all cores. The result does not depend on it.
    options: steps (1; 0: as needed), maximum_steps (100), tolerance (1e-10), poisson_ratio (0.3), stiffening_power (1),
        stiffening_factor (2), maximum_stiffenings (50), distance_power (3), support_radius (0: chosen), fit_tolerance
        (1e-3), untangle_first (True), untangling_beta (0), maximum_iterations (50): those of vtkMeshWarp.

    Raises Error for wrong arguments and whatever the filter refuses; elements that remain inverted are no error: see
    inverted, impossible and summary of the result.

    >>> result = tautline.warp("plate.vtu", transform={"rotate": 30})
    >>> result.inverted, result.statistics["worst_shape"]
    """
    filter_ = tautline.vtkMeshWarp()
    data = as_mesh(mesh)
    filter_.SetMethod(pick("method", method, METHODS))
    filter_.SetAmount(within("amount", amount, 0, np.inf))
    filter_.SetTimeLimit(within("time_limit", time_limit, 0, np.inf))
    filter_.SetThreads(int(within("threads", threads, 0, _MOST_THREADS)))
    filter_.SetAutomaticSolver(pick("solver", solver, SOLVERS) == 0)
    filter_.SetSolver(max(pick("solver", solver, SOLVERS) - 1, 0))
    filter_.SetPreconditioner(pick("preconditioner", preconditioner, PRECONDITIONERS))
    for name, value in options.items():
        if name not in _OPTIONS:
            raise Error(f"there is no option {name!r}; there are {', '.join(_OPTIONS)}")
        _OPTIONS[name](filter_, value)

    given = {"displacement": displacement, "target": target, "transform": transform}
    chosen = [name for name, value in given.items() if value is not None]
    if len(chosen) != 1:
        what = " and ".join(chosen) + " are given" if chosen else "nothing is given"
        raise Error(f"{what}: say how the boundary moves by one of displacement, target, transform")
    if displacement is not None:
        filter_.SetMotion(_BY_ARRAY)
        data = _set_array(filter_, data, _DISPLACEMENT, displacement, "displacement", True)
    elif target is not None:
        filter_.SetMotion(_BY_TARGET)
        filter_.SetCorrespondence(pick("correspondence", correspondence, CORRESPONDENCES))
        _set_target(filter_, as_mesh(target), target_ids)
    else:
        filter_.SetMotion(_BY_TRANSFORM)
        _set_transform(filter_, transform)
    data = _set_moved(filter_, data, moved, values)
    data = _set_array(filter_, data, _FIXED, fixed, "fixed", True)
    data = _set_coefficients(filter_, data, coefficients, regions)
    filter_.SetInputDataObject(0, data)
    run(filter_)
    output = _without_own(filter_.GetOutputDataObject(0))
    return Warped(
        mesh=output,
        inverted=filter_.GetInverted(),
        inverted_after_warp=filter_.GetInvertedAfterWarp(),
        impossible=filter_.GetImpossible(),
        history=_history(filter_),
        statistics=_statistics(filter_),
        displacement=point_array(output, "Displacement"),
        shape=cell_array(output, "TMP shape"),
        validity=cell_array(output, "Validity"),
        summary=filter_.GetSummary(),
    )


_OPTIONS = {
    "steps": _number("SetSteps", 0, 10000, int),
    "maximum_steps": _number("SetMaximumSteps", 1, 10000, int),
    "tolerance": _number("SetTolerance", np.nextafter(0, 1), 1),
    "poisson_ratio": _number("SetPoissonRatio", -1, 0.5),
    "stiffening_power": _number("SetStiffeningPower", 0, 10),
    "stiffening_factor": _number("SetStiffeningFactor", 1, 1e6),
    "maximum_stiffenings": _number("SetMaximumStiffenings", 0, 10000, int),
    "distance_power": _number("SetDistancePower", 0, 20),
    "support_radius": _number("SetSupportRadius", 0, np.inf),
    "fit_tolerance": _number("SetFitTolerance", 0, 1),
    "untangle_first": _flag("SetUntangleFirst"),
    "untangling_beta": _number("SetUntanglingBeta", 0, np.inf),
    "maximum_iterations": _number("SetMaximumIterations", 0, 1000000, int),
}


def _set_array(
    filter_: Any, data: vtkDataObject, index: int, values: Any, name: str, points_only: bool = False
) -> vtkDataObject:
    """Choose an array by name, or add one of numbers to a copy of the mesh; returns the mesh."""
    if values is None:
        return data
    if points_only and not isinstance(values, str) and isinstance(data, vtkDataSet):
        points = data.GetNumberOfPoints()
        if len(np.atleast_1d(values)) != points:
            raise Error(f"{name} has the shape {np.shape(values)}; a row for each of the {points} points is expected")
    data, where, found = with_array(data, values, _OWN + name, points_only=points_only)
    filter_.SetInputArrayToProcess(index, 0, 0, where, found)
    return data


def _set_target(filter_: Any, target: vtkDataObject, ids: Any) -> None:
    if ids is not None:
        target, _, found = with_array(target, ids, _OWN + "point ids", points_only=True)
        filter_.SetTargetIds(found)
    filter_.SetInputDataObject(1, target)


def _vector(name: str, value: Any, sizes: tuple[int, ...] = (3,)) -> list[float]:
    try:
        numbers = np.asarray(value, float).ravel()
    except (TypeError, ValueError):
        raise Error(f"{name} is {value!r}; numbers are expected") from None
    if numbers.size not in sizes or not np.isfinite(numbers).all():
        raise Error(f"{name} is {value!r}; {' or '.join(map(str, sizes))} finite numbers are expected")
    return numbers.tolist()


def _set_transform(filter_: Any, transform: Any) -> None:
    if isinstance(transform, vtkLinearTransform):
        filter_.SetTransform(transform)
        return
    if not isinstance(transform, Mapping):
        numbers = _vector("transform", transform, (16,))
        matrix, affine = vtkMatrix4x4(), vtkTransform()
        matrix.DeepCopy(numbers)
        affine.SetMatrix(matrix)
        filter_.SetTransform(affine)
        return
    kinds = [name for name in _KINDS if name in transform]
    if len(kinds) != 1:
        found = ", ".join(map(str, transform)) or "nothing"
        raise Error(f"transform has to have one of {', '.join(_KINDS)}; it has {found}")
    kind = kinds[0]
    unknown = [name for name in transform if name not in (kind, *_ALLOWED[kind])]
    if unknown:
        raise Error(f"a transform to {kind} has no {unknown[0]!r}; it has {', '.join((kind, *_ALLOWED[kind]))}")
    filter_.SetTransformKind(_KINDS[kind])
    if kind == "translate":
        filter_.SetTranslation(_flat("translate", transform[kind]))
    elif kind == "scale":
        factors = _vector("scale", transform[kind], (1, 2, 3))
        filter_.SetScaleFactors(factors * 3 if len(factors) == 1 else factors + [1.0] * (3 - len(factors)))
    else:
        filter_.SetAngle(_vector(kind, transform[kind], (1,))[0])
    if "axis" in transform:
        filter_.SetAxis(_vector("axis", transform["axis"]))
    if "direction" in transform:
        filter_.SetDirection(_flat("direction", transform["direction"]))
    if transform.get("center") is not None:
        filter_.OwnCenterOff()
        filter_.SetCenter(_flat("center", transform["center"]))


def _flat(name: str, value: Any) -> list[float]:
    """Three numbers; of two, in the plane, the third is 0."""
    numbers = _vector(name, value, (2, 3))
    return numbers + [0.0] * (3 - len(numbers))


def _set_moved(filter_: Any, data: vtkDataObject, moved: Any, values: Sequence[float]) -> vtkDataObject:
    for value in values:
        filter_.AddValue(float(value))
    if moved is None or (isinstance(moved, str) and moved in PARTS):
        filter_.SetMovedPart(PARTS.index(moved or "automatic"))
        return data
    per_point = isinstance(data, vtkDataSet) and np.shape(moved)[:1] == (data.GetNumberOfPoints(),)
    if isinstance(moved, str) or per_point:
        filter_.SetMovedPart(_ARRAY_VALUES)
        return _set_array(filter_, data, _MOVED, moved, "moved")
    filter_.SetMovedPart(_NUMBERED_PARTS)
    for number in np.atleast_1d(moved):
        if not np.issubdtype(type(number), np.integer):
            raise Error(f"moved is {moved!r}; numbers of boundary parts, a value per point or a name are expected")
        filter_.AddPart(int(number))
    return data


def _set_coefficients(filter_: Any, data: vtkDataObject, coefficients: Any, regions: Any) -> vtkDataObject:
    if isinstance(coefficients, str) and coefficients in COEFFICIENTS:
        filter_.SetCoefficients(COEFFICIENTS.index(coefficients))
    elif isinstance(coefficients, str) or np.ndim(coefficients) > 1 or np.size(coefficients) not in (3, 6):
        filter_.SetCoefficients(_PER_CELL)
        data = _set_array(filter_, data, _TENSORS, coefficients, "coefficients")
    else:
        numbers = _vector("coefficients", coefficients, (3, 6))
        filter_.SetCoefficients(_MANUAL)
        filter_.SetTensor(numbers + [0.0] * (6 - len(numbers)))
    if regions is not None:
        try:
            array, table = regions
            rows = [(float(value), *_vector("the coefficients of a region", row)) for value, row in table.items()]
        except (AttributeError, TypeError, ValueError):
            raise Error("regions are (cell array, {value: (alpha, beta, gamma)})") from None
        filter_.SetCoefficients(_PER_REGION)
        data = _set_array(filter_, data, _REGIONS, array, "regions")
        for row in rows:
            filter_.AddRegion(*row)
    return data


def _key(name: str) -> str:
    name = name[2:] if name.startswith("N ") else name
    if name == "Time (s)":
        return "seconds"
    return name.replace(" (s)", "_seconds").replace(" ", "_").replace("-", "_").lower()


def _history(filter_: Any) -> dict[str, Any]:
    history = {_key(name): column for name, column in columns(filter_.GetHistory()).items()}
    for name in ("inverted", "iterations"):
        history[name] = np.asarray(history.get(name, ())).astype(int)
    return history


def _statistics(filter_: Any) -> dict[str, Any]:
    table = {_key(name): column for name, column in columns(filter_.GetStatistics()).items()}
    blocks = table.pop("block", None)
    rows = [
        {name: int(column[row]) if name in _COUNTS else float(column[row]) for name, column in table.items()}
        for row in range(len(table.get("elements", ())))
    ]
    for facts in rows:
        facts["reused"] = bool(facts["reused"])
    if blocks is not None:
        return dict(zip(blocks, rows))
    return rows[0] if rows else {}


# --- the shell -------------------------------------------------------------------------------------


def add_commands(commands: Any) -> None:
    """Add `warp` to the subparsers of the command line; it sets `run`."""
    parser = commands.add_parser(
        "warp",
        help="move the interior of a mesh after its boundary",
        description="Move the interior of a mesh after its boundary: by an array, to a target, or by a transform.",
    )
    parser.add_argument("mesh", metavar="FILE")
    parser.add_argument("-o", "--output", metavar="FILE", required=True)
    parser.add_argument("--csv", metavar="FILE", help="write the history, a row per stage")
    motion = parser.add_mutually_exclusive_group(required=True)
    motion.add_argument("--displacement", metavar="ARRAY", help="point array that moves the boundary")
    motion.add_argument("--target", metavar="FILE", help="the boundary in its new place, or a surface to project it to")
    motion.add_argument("--translate", metavar="X,Y,Z", type=_numbers)
    motion.add_argument("--rotate", metavar="DEGREES", type=float)
    motion.add_argument("--scale", metavar="FACTOR[,FACTOR,FACTOR]", type=_numbers)
    motion.add_argument("--bend", metavar="DEGREES", type=float)
    parser.add_argument("--axis", metavar="X,Y,Z", type=_numbers, help="to rotate or bend about (default: 0,0,1)")
    parser.add_argument("--direction", metavar="X,Y,Z", type=_numbers, help="along the bar to bend (default: 1,0,0)")
    parser.add_argument("--center", metavar="X,Y,Z", type=_numbers, help="(default: the middle of what moves)")
    parser.add_argument("--moved", metavar="WHAT", help="automatic (the default), 'whole boundary', 'inner "
                        "boundaries', numbers of boundary parts (1,3), or the name of an array")  # fmt: skip
    parser.add_argument("--values", metavar="V,...", type=_numbers, default=(), help="of that array (default: not 0)")
    parser.add_argument("--correspondence", choices=CORRESPONDENCES, default="automatic")
    parser.add_argument("--target-ids", metavar="ARRAY", help="point array of the target with point ids")
    parser.add_argument("--fixed", metavar="ARRAY", help="point array, not 0 where points stay")
    parser.add_argument("--method", choices=METHODS, default="hybrid")
    parser.add_argument("--amount", type=float, default=1.0, help="of the motion (default: 1)")
    parser.add_argument("--coefficients", metavar="WHAT", default="displacement sums",
                        help="'displacement sums' (the default), 'principal directions', alpha,beta,gamma, six numbers "
                        "of a tensor, or a cell array")  # fmt: skip
    parser.add_argument("--steps", type=int, default=1, help="0: as many as are needed (default: 1)")
    parser.add_argument("--solver", choices=SOLVERS, default="automatic")
    parser.add_argument("--preconditioner", choices=PRECONDITIONERS, default="boomeramg")
    parser.add_argument("--time-limit", type=float, default=0.0, help="seconds; 0, the default, is no limit")
    parser.add_argument("--threads", type=int, default=0, help="0, the default, is all cores")
    parser.set_defaults(run=_run_warp)


def _numbers(text: str) -> list[float]:
    try:
        return [float(part) for part in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} are not numbers with commas between") from None


def _numbers_or_name(text: str, kind: type) -> Any:
    try:
        return [kind(part) for part in text.split(",")]
    except ValueError:
        return text


def _run_warp(arguments: argparse.Namespace) -> int:
    passed = ("displacement", "target", "method", "amount", "correspondence", "target_ids", "values", "fixed", "steps",
              "solver", "preconditioner", "time_limit", "threads")  # fmt: skip
    options = {name: getattr(arguments, name) for name in passed}
    options["coefficients"] = _numbers_or_name(arguments.coefficients, float)
    if arguments.moved:
        options["moved"] = _numbers_or_name(arguments.moved, int)
    given = [name for name in _KINDS if getattr(arguments, name) is not None]
    details = {name: getattr(arguments, name) for name in ("axis", "direction", "center")}
    if given:
        options["transform"] = {name: getattr(arguments, name) for name in given}
        options["transform"].update({name: value for name, value in details.items() if value is not None})
    elif any(value is not None for value in details.values()):
        raise Error("axis, direction and center belong to a transform: give --rotate, --scale or --bend, too")
    result = warp(arguments.mesh, **options)
    _finish(result, arguments)
    return 1 if result.inverted else 0
