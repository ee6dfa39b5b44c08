"""The function improve: change the connectivity of a mesh of tetrahedra so that its worst elements become better."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any, Sequence

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataObject

from . import _commands, _vtk
from ._arguments import check_options, flag_option, pick, set_options, set_threads, set_time_limit, within
from ._arrays import CELLS, POINTS, InputArrays, cell_array, columns, table_rows
from ._errors import Error, interruptible, run
from ._io import Mesh, as_mesh

#: In the filter's numbering.
PRESETS = ("custom", "remove slivers", "swap only", "swap and smooth", "aggressive")
BOUNDARIES = ("fixed", "flat")
_FIXED, _REGIONS = 0, 1  # input arrays of vtkMeshImprover
_MAX_ANGLE = 60.0
_MAX_FLAT_TOLERANCE = 1.0
_OPERATIONS = {name: flag_option("Set" + name.title()) for name in ("swap", "smooth", "contract", "insert", "compound")}


@dataclass(frozen=True)
class ImproveResult:
    """The result of improve(). Of composite data, numbers are of all blocks."""

    #: The new mesh with the data of the input, `OriginalCellId`, `min_angle` and `imr`.
    mesh: vtkDataObject
    #: Per pass (0 is the input): smallest_angle, largest_angle, worst_imr, tetrahedra, below_target, edge_removals,
    #: face_removals, boundary_swaps, contractions, insertions, moves, seconds; of composite data also block.
    history: dict[str, Any]
    #: The tetrahedra that are still below the target, the worst first: cell, smallest_angle, imr, x, y, z, reason; of
    #: composite data also block. Empty if there are none.
    remaining: dict[str, Any]
    #: Per cell the cell of the input that it has its data from, m.
    original_cell: np.ndarray
    #: Per cell, m: smallest dihedral angle in degrees, inverse mean ratio.
    min_angle: np.ndarray
    imr: np.ndarray
    #: Number of tetrahedra before and after.
    tetrahedra_before: int
    tetrahedra: int
    #: Smallest dihedral angle in degrees before and after.
    smallest_angle_before: float
    smallest_angle: float
    #: Worst inverse mean ratio before and after.
    worst_before: float
    worst: float
    #: The stopping criterion that ended the run.
    reason: str
    #: The result in words.
    summary: str


@interruptible
def improve(
    mesh: Mesh,
    preset: str = "remove slivers",
    *,
    boundary: str = "fixed",
    target_angle: float | None = None,
    smallest_count: float = 0.9,
    largest_count: float = 1.1,
    flat_tolerance: float = 1e-8,
    regions: str | Sequence | None = None,
    fixed: str | Sequence | None = None,
    time_limit: float = 0.0,
    threads: int = 0,
    merge_coincident_points: bool = True,
    **operations: bool,
) -> ImproveResult:
    """Improve the worst tetrahedra of a mesh by swaps, contraction, insertion and motion of points.

    The smallest dihedral angle and the worst inverse mean ratio never become worse.

    mesh: tetrahedra: a vtkUnstructuredGrid, a composite data set of these, a file name or (points, cells). It is not
        changed. Cells of lower dimension are left out.
    preset: "remove slivers" (changes only neighbourhoods of tetrahedra with dihedral angles below 15 or above 165
        degrees), "swap only" (no point moves), "swap and smooth" (no point is inserted or removed), "aggressive" (every
        operation everywhere) or "custom" (the operations given).
    boundary: "fixed" (same points and facets) or "flat" (points slide in flat parts and along straight edges, facets
        there change; the shape stays).
    target_angle: dihedral angle in degrees, at most 60, that every tetrahedron should reach; None or 0: that of
        the preset, 15 for "remove slivers" and 33.4 for the others.
    smallest_count, largest_count: bounds of the number of tetrahedra as multiples of that of the input. Both 1: no
        point is inserted or removed.
    flat_tolerance: angle in degrees, 0 to 1, up to which facets are coplanar, with boundary "flat".
    regions: the region of each cell, m, or the name of a cell array; facets between regions stay.
    fixed: points that stay in place: one number or truth value per point, n, or the name of a point array.
    time_limit: seconds; 0 is no limit.
    threads: number of threads for measuring; 0 is all cores. The result does not depend on it.
    merge_coincident_points: whether points at the same place on facets that match become one, as on the seams of a
        mesh in pieces. False: seams are boundary.
    operations: of the preset "custom": swap, smooth, contract, insert, compound (operations that pay off only after the
        points around moved); all True by default.

    Raises Error for wrong arguments and for meshes that the filter refuses: with other cells, or inverted ones (see
    untangle).

    >>> result = tautline.improve("slivers.vtu", "aggressive")
    >>> result.smallest_angle_before, result.smallest_angle
    """
    filter_ = _vtk.vtkMeshImprover()
    inputs = InputArrays(filter_, as_mesh(mesh))
    filter_.SetPreset(pick("preset", preset, PRESETS))
    check_options(operations, _OPERATIONS)
    if operations and preset != "custom":
        raise Error(f"{', '.join(operations)}: operations are chosen with preset='custom' only")
    set_options(filter_, operations, _OPERATIONS)
    filter_.SetBoundary(pick("boundary", boundary, BOUNDARIES))
    if target_angle is not None:
        filter_.SetTargetAngle(within("target_angle", target_angle, 0, _MAX_ANGLE))
    filter_.SetSmallestCount(within("smallest_count", smallest_count, 0, 1))
    filter_.SetLargestCount(within("largest_count", largest_count, 1, np.inf))
    filter_.SetFlatTolerance(within("flat_tolerance", flat_tolerance, 0, _MAX_FLAT_TOLERANCE))
    set_time_limit(filter_, time_limit)
    set_threads(filter_, threads)
    filter_.SetMergeCoincidentPoints(bool(merge_coincident_points))
    inputs.use(_FIXED, fixed, "fixed", POINTS)
    inputs.use(_REGIONS, regions, "regions", CELLS)
    filter_.SetInputDataObject(0, inputs.mesh)
    run(filter_)
    output = inputs.remove_from(filter_.GetOutputDataObject(0))
    return ImproveResult(
        mesh=output,
        history=_named(filter_.GetHistory()),
        remaining=_named(filter_.GetRemainingTable()),
        original_cell=cell_array(output, "OriginalCellId"),
        min_angle=cell_array(output, "min_angle"),
        imr=cell_array(output, "imr"),
        tetrahedra_before=filter_.GetTetrahedraBefore(),
        tetrahedra=filter_.GetTetrahedraAfter(),
        smallest_angle_before=filter_.GetSmallestAngleBefore(),
        smallest_angle=filter_.GetSmallestAngleAfter(),
        worst_before=filter_.GetWorstBefore(),
        worst=filter_.GetWorstAfter(),
        reason=filter_.GetReason(),
        summary=filter_.GetSummary(),
    )


def _named(table: Any) -> dict[str, Any]:
    """The columns of a table by names of Python; ids and counts are integers."""
    renamed = {"Time (s)": "seconds"}
    real = ("seconds", "smallest_angle", "largest_angle", "worst_imr", "imr", "x", "y", "z")
    names = {name: name.removeprefix("N ").lower().replace(" ", "_") for name in columns(table)} | renamed
    result = {names[name]: column for name, column in columns(table).items()}
    return {
        name: column if isinstance(column, list) or name in real else column.astype(int)
        for name, column in result.items()
    }


# --- the shell ----------------------------------------------------------------------------------------------


def add_commands(commands: Any) -> None:
    """Add `improve` to the subparsers of the command line."""
    text = "change the connectivity of tetrahedra so that the worst become better"
    parser = _commands.add_command(commands, "improve", _run_improve, text)
    _commands.add_moving_points(parser)
    parser.add_argument("--preset", choices=PRESETS, default="remove slivers")
    for name in _OPERATIONS:
        parser.add_argument(f"--no-{name}", action="store_false", dest=name, help="with --preset custom")
    parser.add_argument("--flat-tolerance", type=float, metavar="DEGREES", default=1e-8,
                        help="up to which facets are coplanar, with --boundary flat (default: 1e-8)")  # fmt: skip
    parser.add_argument("--boundary", choices=BOUNDARIES, default="fixed")
    parser.add_argument("--target-angle", type=float, metavar="DEGREES",
                        help="dihedral angle to be reached by all (default: that of the preset)")  # fmt: skip
    parser.add_argument("--regions", metavar="ARRAY", help="cell array with regions, whose common facets stay")
    parser.add_argument("--smallest-count", type=float, default=0.9, metavar="FACTOR",
                        help="least number of tetrahedra, relative to the input (default: 0.9)")  # fmt: skip
    parser.add_argument("--largest-count", type=float, default=1.1, metavar="FACTOR",
                        help="largest number of tetrahedra, relative to the input (default: 1.1)")  # fmt: skip


def _run_improve(arguments: argparse.Namespace) -> None:
    names = ("preset", "boundary", "target_angle", "regions", "smallest_count", "largest_count")
    names += ("flat_tolerance", "fixed", "time_limit", "threads", "merge_coincident_points")
    left_out = {name: False for name in _OPERATIONS if not getattr(arguments, name)}
    result = improve(arguments.mesh, **_commands.given(arguments, names), **left_out)
    print(result.summary)
    _commands.save(result, arguments, table_rows(result.history))
