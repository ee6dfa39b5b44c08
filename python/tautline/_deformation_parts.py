# SPDX-License-Identifier: BSD-3-Clause
"""The result of warp(), and its arguments that are not one property each."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, Mapping, Sequence, Union, get_args

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkDataSet
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkCommonTransforms import vtkLinearTransform, vtkTransform

from . import _commands
from ._arguments import number, pick, sequence, sets
from ._arrays import ANY, POINTS, Array, InputArrays, Values, cell_array, columns, point_array, table_rows, with_array
from ._errors import Error
from ._io import Mesh, as_mesh
from ._names import find_name
from ._results import Result

#: Names of coefficients, and their numbers in vtkMeshWarp.
COEFFICIENTS = {"displacement sums": 0, "principal directions": 1, "local gradients": 5}
PARTS = ("automatic", "whole boundary", "inner boundaries")
Solver = Literal["automatic", "cg", "gmres", "minres", "bicgstab", "direct"]
SOLVERS: tuple[Solver, ...] = get_args(Solver)

_DISPLACEMENT, _MOVED, _TENSORS, _REGIONS = 0, 1, 3, 4  # input arrays of vtkMeshWarp
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
Transform = Union[Mapping[str, Any], Sequence[Any], vtkLinearTransform]


@dataclass(frozen=True, repr=False, eq=False)
class WarpResult(Result):
    """The result of warp(). For composite data, numbers cover all blocks.

    Attributes
    ----------
    mesh : vtkDataObject
        The mesh with the new points, `Displacement`, `TMP shape` and `Validity`.
    inverted, inverted_after_warp, impossible : int
        Number of inverted or degenerate elements at the end, and after the deformation without the final optimization;
        and of the elements that no interior point positions make valid, because the moved boundary itself is invalid.
    history : dict[str, Any]
        Per stage: amount, inverted, worst_shape, mean_shape, stage (list of str), iterations, seconds; for composite
        data also block.
    statistics : dict[str, Any]
        elements, boundary_points, moved_points, largest_displacement, amount, inverted_after_warp, inverted,
        impossible, crossings, worst_shape, mean_shape, worst_imr_before, mean_imr_before, worst_imr, mean_imr, cxx to
        cxz, decoupled, regularization, reused, and assemble_, set_up_, solve_, improve_ and total_seconds. For
        composite data, a dict of these per block.
    displacement : Array
        New minus old position, n x 3.
    shape : Array
        TMP shape metric per cell, m; 0 if the element has its undeformed shape.
    validity : Array
        Per cell, m: 1 valid, 0 degenerate, -1 inverted, -2 not measured.
    summary : str
        The result in words.
    """

    _per_element: ClassVar[tuple[str, ...]] = ("displacement", "shape", "validity")
    mesh: vtkDataObject
    inverted: int
    inverted_after_warp: int
    impossible: int
    history: dict[str, Any]
    statistics: dict[str, Any]
    displacement: Array
    shape: Array
    validity: Array
    summary: str


@sets(
    "warp", "Motion", "Displacement", "Target", "TargetIds", "TransformKind", "Transform", "Translation", "Angle",
    "Axis", "ScaleFactors", "Direction", "OwnCenter", "Center",
)  # fmt: skip
def set_motion(
    filter_: Any,
    inputs: InputArrays,
    displacement: Values | None = None,
    target: Mesh | None = None,
    transform: Transform | None = None,
    target_ids: Values | None = None,
) -> None:
    """Set the motion of the boundary; exactly one of the first three arguments is required.

    displacement: the name of a point array, or n x 3 (in the plane n x 2) numbers; values at interior points are
        ignored.
    target: the mesh or its boundary in the new position, or any surface (in the plane a curve) to project it to.
    transform: of the part `moved`: {"translate": (x, y, z)}, {"rotate": degrees, "axis": (0, 0, 1)}, {"scale":
        factor or three of them}, {"bend": degrees, "axis": (0, 0, 1), "direction": (1, 0, 0)}, each about a
        "center", by default the center of the moved points; a 4 x 4 matrix; or a vtkLinearTransform.
    target_ids: for the correspondence "point ids": the name of a point array of the target, with values of the mesh's
        point array of the same name or with point numbers of the mesh; or such point numbers, one per point of the
        target.
    """
    given = {"displacement": displacement, "target": target, "transform": transform}
    chosen = [name for name, value in given.items() if value is not None]
    if len(chosen) != 1:
        found = " and ".join(chosen) + " are given" if chosen else "nothing is given"
        raise Error(f"{found}: prescribe the motion of the boundary by one of displacement, target, transform")
    if displacement is not None:
        filter_.SetMotion(_BY_ARRAY)
        inputs.use(_DISPLACEMENT, displacement, "displacement", POINTS)
    elif target is not None:
        filter_.SetMotion(_BY_TARGET)
        _set_target(filter_, as_mesh(target), target_ids)
    else:
        filter_.SetMotion(_BY_TRANSFORM)
        _set_transform(filter_, transform)


def _set_target(filter_: Any, target: vtkDataObject, ids: Any) -> None:
    if ids is not None:
        target, _, found = with_array(target, ids, "point ids", POINTS)
        filter_.SetTargetIds(found)
    filter_.SetInputDataObject(1, target)


def _vector(name: str, value: Any, sizes: tuple[int, ...] = (3,)) -> list[float]:
    try:
        numbers: Array = np.asarray(value, float).ravel()
    except (TypeError, ValueError):
        raise Error(f"{name} is {value!r}; numbers are expected") from None
    if numbers.size not in sizes or not np.isfinite(numbers).all():
        raise Error(f"{name} is {value!r}; {' or '.join(map(str, sizes))} finite numbers are expected")
    return [float(value) for value in numbers]


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
    """Three numbers; the third of a vector in the plane is 0."""
    numbers = _vector(name, value, (2, 3))
    return numbers + [0.0] * (3 - len(numbers))


@sets("warp", "MovedPart", "Parts", "MovedArray", "Values")
def set_moved(
    filter_: Any, inputs: InputArrays, moved: int | Values | None = None, values: Sequence[float] = ()
) -> None:
    """Set the part that moves.

    moved: the part that a transform or projection moves; the rest of the boundary stays in place. "automatic" (the
        inner boundaries, or the whole boundary if there are none), "whole boundary", "inner boundaries"; numbers of
        boundary parts, of which 1 is the largest; the name of a point or cell array; or one value per point.
    values: values of the array `moved` on the moved part; the default is all but 0.
    """
    for value in sequence("values", values):
        filter_.AddValue(number("values", value))
    _set_part(filter_, inputs, moved)


def _set_part(filter_: Any, inputs: InputArrays, moved: Any) -> None:
    part = "automatic" if moved is None else find_name(moved, PARTS)
    if part is not None:
        filter_.SetMovedPart(PARTS.index(part))
        return
    data = inputs.mesh
    per_point = isinstance(data, vtkDataSet) and np.shape(moved)[:1] == (data.GetNumberOfPoints(),)
    if isinstance(moved, str) or per_point:
        filter_.SetMovedPart(_ARRAY_VALUES)
        inputs.use(_MOVED, moved, "moved", ANY)
        return
    filter_.SetMovedPart(_NUMBERED_PARTS)
    parts = np.atleast_1d(moved)
    if parts.dtype.kind not in "iu" or parts.ndim != 1 or (abs(parts) > np.iinfo(np.int32).max).any():
        raise Error(f"moved is {moved!r}; numbers of boundary parts, a value per point or a name are expected")
    for part_number in parts:
        filter_.AddPart(int(part_number))


@sets("warp", "Coefficients", "Tensor", "CellTensors", "RegionArray", "Regions")
def set_coefficients(
    filter_: Any,
    inputs: InputArrays,
    coefficients: Values = "displacement sums",
    regions: tuple[Values, Mapping[float, Sequence[float]]] | None = None,
) -> None:
    """Set the coefficients.

    coefficients: of "hybrid" and "anisotropic femwarp": "displacement sums", "principal directions", "local gradients"
        (they vary in space, from the gradients of the displacements that FEMWARP gives), 3 or 6 numbers
        (alpha beta gamma, or xx yy zz xy yz xz), the name of a cell array of tensors, or one row of 1, 3, 6 or 9
        numbers per cell.
    regions: (cell array, {value: (alpha, beta, gamma)}), the array by name or by one value per cell. Cells with other
        values have the `coefficients`, if these are numbers.
    """
    if isinstance(coefficients, str) and coefficients in COEFFICIENTS:
        filter_.SetCoefficients(COEFFICIENTS[coefficients])
    elif isinstance(coefficients, str) or np.ndim(coefficients) > 1 or np.size(coefficients) not in (3, 6):
        filter_.SetCoefficients(_PER_CELL)
        inputs.use(_TENSORS, coefficients, "coefficients", ANY)
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
        inputs.use(_REGIONS, array, "regions", ANY)
        for row in rows:
            filter_.AddRegion(*row)


@sets("warp", "AutomaticSolver", "Solver")
def set_solver(filter_: Any, solver: Solver = "automatic") -> None:
    """Set the solver.

    solver: the solver of the linear systems: "automatic", "cg", "gmres", "minres", "bicgstab", "direct".
    """
    number = pick("solver", solver, SOLVERS)
    filter_.SetAutomaticSolver(number == 0)
    filter_.SetSolver(max(number - 1, 0))


def warp_result(filter_: Any, output: vtkDataObject) -> WarpResult:
    """The result of a filter that has run."""
    return WarpResult(
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


def _key(name: str) -> str:
    """The name of a column of the filter's tables in snake case."""
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


# --- the shell ----------------------------------------------------------------------------------------------


def add_warp_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of these arguments."""
    numbers = _commands.numbers
    motion = parser.add_mutually_exclusive_group(required=True)
    motion.add_argument("--displacement", metavar="ARRAY", help="point array with the motion of the boundary")
    motion.add_argument("--target", metavar="FILE", help="the boundary in its new position, or a surface")
    motion.add_argument("--translate", metavar="X,Y,Z", type=numbers)
    motion.add_argument("--rotate", metavar="DEGREES", type=float)
    motion.add_argument("--scale", metavar="FACTOR[,FACTOR,FACTOR]", type=numbers)
    motion.add_argument("--bend", metavar="DEGREES", type=float)
    parser.add_argument("--axis", metavar="X,Y,Z", type=numbers, help="to rotate or bend about (default: 0,0,1)")
    parser.add_argument("--direction", metavar="X,Y,Z", type=numbers, help="of the bar to bend (default: 1,0,0)")
    parser.add_argument("--center", metavar="X,Y,Z", type=numbers, help="(default: center of the moved points)")
    parser.add_argument("--moved", metavar="PART", help="automatic (the default), 'whole boundary', 'inner "
                        "boundaries', numbers of boundary parts (1,3), or the name of an array")  # fmt: skip
    parser.add_argument("--values", metavar="V,...", type=numbers, default=(), help="of that array (default: not 0)")
    parser.add_argument("--target-ids", metavar="ARRAY", help="point array of the target with point ids")
    parser.add_argument("--coefficients", metavar="VALUES", default="displacement sums",
                        help="'displacement sums' (the default), 'principal directions', 'local gradients', "
                        "alpha,beta,gamma, six numbers of a tensor, or a cell array")  # fmt: skip
    parser.add_argument("--solver", choices=SOLVERS, default="automatic")


def warp_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """The values of these options."""
    options = _commands.given(arguments, ("displacement", "target", "target_ids", "values", "solver"))
    options["coefficients"] = _commands.numbers_or_text(arguments.coefficients)
    if arguments.moved:
        options["moved"] = _commands.numbers_or_text(arguments.moved, int)
    given = [name for name in _KINDS if getattr(arguments, name) is not None]
    details = _commands.given(arguments, ("axis", "direction", "center"))
    if given:
        options["transform"] = _commands.given(arguments, given)
        options["transform"].update({name: value for name, value in details.items() if value is not None})
    elif any(value is not None for value in details.values()):
        raise Error("axis, direction and center belong to a transform: add --rotate, --scale or --bend")
    return options


def finish_warp(arguments: argparse.Namespace, result: WarpResult) -> int:
    """Print the result of the command."""
    _commands.finish(arguments, result, result.summary, table_rows(result.history))
    return 1 if result.inverted else 0
