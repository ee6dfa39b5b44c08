# SPDX-License-Identifier: BSD-3-Clause
"""The function improve: change the connectivity of tetrahedra or triangles so that the worst elements become better."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, get_args

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataObject

from . import _commands, _vtk
from ._arguments import check_options, flag_option, pick, picked, set_options, set_threads, set_time_limit, within
from ._arrays import CELLS, POINTS, Array, InputArrays, Values, cell_array, columns, table_rows
from ._errors import Error, interruptible, run, watch
from ._interrupts import Progress
from ._io import Mesh, as_mesh
from ._results import Result

#: In the filter's numbering.
Preset = Literal["custom", "remove slivers", "swap only", "swap and smooth", "aggressive"]
PRESETS: tuple[Preset, ...] = get_args(Preset)
Boundary = Literal["fixed", "sliding", "on surface"]
BOUNDARIES: tuple[Boundary, ...] = get_args(Boundary)
Objective = Literal["angles and shape", "angles", "shape", "sum"]
OBJECTIVES: tuple[Objective, ...] = get_args(Objective)
CellTransfer = Literal["copy", "conservative"]
CELL_TRANSFERS: tuple[CellTransfer, ...] = get_args(CellTransfer)
_FIXED, _REGIONS, _SIZES = 0, 1, 2  # input arrays of vtkMeshImprover
_MAX_ANGLE = 60.0
_MAX_FLAT_ANGLE = 1.0
_MAX_ROUNDS, _MAX_CELLS = 100, 2**62
_MAX_FEATURE_ANGLE, _MAX_SURFACE_ANGLE = 180.0, 90.0
_OPERATIONS = {name: flag_option("Set" + name.title()) for name in ("swap", "smooth", "contract", "insert", "compound")}


@dataclass(frozen=True, repr=False, eq=False)
class ImproveResult(Result):
    """The result of improve(). Of composite data, numbers are of all blocks.

    mesh: the new mesh with the data of the input, `OriginalCellId`, `min_angle` and `imr`.
    history: per pass (0 is the input): smallest_angle, largest_angle, worst_imr, elements, below_target, edge_removals
        (of triangles: flips), face_removals, boundary_swaps, contractions, insertions, moves, seconds; of composite
        data also block.
    remaining: the elements that are still below the target, the worst first: cell, smallest_angle, imr, x, y, z,
        quality (of the objective; of triangles the sine of the smallest angle), quality_bound (what facets or angles on
        the boundary and between regions allow), reason; of composite data also block. Empty if there are none.
    original_cell: per cell the cell of the input that it has its data from, m.
    min_angle, imr: per cell, m: smallest angle in degrees (of tetrahedra dihedral), inverse mean ratio.
    elements_before, elements: number of elements before and after.
    smallest_angle_before, smallest_angle: smallest angle in degrees before and after.
    worst_before, worst: worst inverse mean ratio before and after.
    worst_metric_before, worst_metric: worst value of the metric before and after; 0 without one.
    boundary_distance: largest distance between the boundary and that of the input; 0 unless it is "on surface".
    reason: the stopping criterion that ended the run.
    summary: the result in words.
    """

    _per_element: ClassVar[tuple[str, ...]] = ("original_cell", "min_angle", "imr")
    mesh: vtkDataObject
    history: dict[str, Any]
    remaining: dict[str, Any]
    original_cell: Array
    min_angle: Array
    imr: Array
    elements_before: int
    elements: int
    smallest_angle_before: float
    smallest_angle: float
    worst_before: float
    worst: float
    worst_metric_before: float
    worst_metric: float
    boundary_distance: float
    reason: str
    summary: str


@interruptible
def improve(
    mesh: Mesh,
    preset: Preset = "remove slivers",
    *,
    boundary: Boundary = "fixed",
    objective: Objective = "angles and shape",
    metric: str | None = None,
    target_angle: float | None = None,
    smallest_count: float = 0.9,
    largest_count: float = 1.1,
    flat_angle: float = 0.01,
    feature_angle: float = 40.0,
    surface_angle: float = 20.0,
    surface_distance: float = 5e-3,
    regions: Values | None = None,
    fixed: Values | None = None,
    edge_length: float | Values | None = None,
    edge_factor: float = 2.0,
    then_best_shape: bool = False,
    cell_transfer: CellTransfer = "copy",
    time_limit: float = 0.0,
    threads: int = 0,
    merge_coincident_points: bool = True,
    gather_below: int = 20_000,
    rounds: int = 12,
    progress: Progress | bool | None = None,
    **operations: bool,
) -> ImproveResult:
    """Improve the worst tetrahedra or triangles of a mesh by swaps, contraction, insertion and motion of points.

    The smallest angle and the worst inverse mean ratio never become worse. Triangles are a planar mesh or a surface.

    mesh: tetrahedra or triangles: a vtkUnstructuredGrid, vtkPolyData of triangles, a composite data set of these, a
        file name or (points, cells). It is not changed. Cells of lower dimension are left out; lines beside triangles
        mark edges that stay, triangles beside tetrahedra facets inside the mesh that stay.
    preset: "remove slivers" (changes only neighbourhoods of elements with dihedral angles below 15 or above 165
        degrees, of triangles with angles below 15), "swap only" (no point moves), "swap and smooth" (no point is
        inserted or removed), "aggressive" (every operation everywhere) or "custom" (the operations given).
    boundary: "fixed" (same points and facets), "sliding" (points slide in flat parts and along straight edges, facets
        there change; the shape stays) or, of tetrahedra, "on surface" (the same on curved parts: the boundary stays
        within surface_distance and surface_angle of that of the input, corners and sharp edges stay; the volume
        changes a little).
    objective: of tetrahedra, what the worst are improved for: "angles and shape" (the smaller of the sines of the
        dihedral angles and (mean ratio)^(3/2)), "angles" (the sines alone: larger smallest angles, longer tetrahedra)
        or "shape" ((mean ratio)^(3/2) alone). "sum": all are improved, for the sum of what their inverse mean ratios
        exceed 1, and the worst are held.
    metric: of tetrahedra, instead of an objective: the name of a metric, whose worst values are improved first and
        never become worse. Tetrahedra are worked on while the quality x / I (I / x where smaller is better, 1 / (1 + x)
        where I is 0), of the value x and the ideal value I, is below the sine of the target angle.
    target_angle: (dihedral) angle in degrees, at most 60, that every element should reach; None or 0: that of the
        preset, 15 for "remove slivers" and 33.4 (triangles: 40) for the others.
    smallest_count, largest_count: bounds of the number of elements as multiples of that of the input. Both 1: no
        point is inserted or removed.
    flat_angle: angle in degrees, 0 to 1, up to which facets are coplanar, with boundary "sliding".
    feature_angle: of a surface, and of a boundary "on surface": edges between facets that differ by more degrees, 0 to
        180, stay, and so do corners.
    surface_angle, surface_distance: of the same: how far the normals of changed facets turn from the input below, in
        degrees, 0 to 90, and how far facets are from it, 0 to 1 times the diagonal of the mesh. Points are on it.
    regions: the region of each cell, m, or the name of a cell array; facets (edges) between regions stay.
    fixed: points that stay in place: one number or truth value per point, n, or the name of a point array.
    edge_length: target length of edges, which bounds contraction and insertion; None: any length. A number; "input"
        (the mean length of the edges at each point); or per point a length, n, or a metric tensor in which edges of the
        target length have length 1, n x 6 in the order of VTK or n x 9; or the name of such a point array.
    edge_factor: how many times longer or shorter than the target new edges may be, above 1.
    then_best_shape: whether points move at the end for the best shape on average (inverse mean ratio), while the
        smallest dihedral angle and the worst inverse mean ratio stay as good as they are.
    cell_transfer: "copy" (a cell has the data of the cell of the input that contains its centroid) or "conservative"
        (real numbers are averages over the cells of the input, weighted by the volumes or areas that the cell shares
        with them: constants and, unless the boundary or a curved surface changes, the integral over the mesh stay;
        other data are of the cell that shares most).
    time_limit: seconds; 0 is no limit.
    threads: number of threads, which large meshes make use of; 0 is all cores. The result does not depend on it.
    merge_coincident_points: whether points at the same place on facets that match become one, as on the seams of a
        mesh in pieces. False: seams are boundary.
    gather_below, rounds: on several processes (pvbatch --sym under MPI, where each calls this function with its piece):
        a mesh of fewer tetrahedra is put together on the first process; others are improved in parts, divided anew so
        many times at most, 1 to 100. The tables are those of the first process, the numbers of all.
    operations: of the preset "custom": swap, smooth, contract, insert, compound (operations that pay off only after the
        points around moved); all True by default.

    Raises Error for wrong arguments and for meshes that the filter refuses: with other cells, or inverted ones (see
    untangle).

    >>> result = tautline.improve("slivers.vtu", "aggressive")
    >>> result.smallest_angle_before, result.smallest_angle
    """
    filter_ = _vtk.vtkMeshImprover()
    inputs = InputArrays(filter_, as_mesh(mesh))
    preset = picked("preset", preset, PRESETS)
    filter_.SetPreset(PRESETS.index(preset))
    check_options(operations, _OPERATIONS)
    if operations and preset != "custom":
        raise Error(f"{', '.join(operations)}: operations are chosen with preset='custom' only")
    set_options(filter_, operations, _OPERATIONS)
    filter_.SetBoundary(pick("boundary", boundary, BOUNDARIES))
    chosen = pick("objective", objective, OBJECTIVES)
    filter_.SetObjective(filter_.SUM if objective == "sum" else chosen)
    if metric is not None:
        if objective != OBJECTIVES[0]:
            raise Error("give either an objective or a metric")
        filter_.SetObjective(filter_.METRIC)
        messages = watch(filter_)
        filter_.SetMetricByName(metric)
        messages.raise_errors()
    if target_angle is not None:
        filter_.SetTargetAngle(within("target_angle", target_angle, 0, _MAX_ANGLE))
    filter_.SetSmallestCount(within("smallest_count", smallest_count, 0, 1))
    filter_.SetLargestCount(within("largest_count", largest_count, 1, np.inf))
    filter_.SetFlatAngle(within("flat_angle", flat_angle, 0, _MAX_FLAT_ANGLE))
    filter_.SetFeatureAngle(within("feature_angle", feature_angle, 0, _MAX_FEATURE_ANGLE))
    filter_.SetSurfaceAngle(within("surface_angle", surface_angle, 0, _MAX_SURFACE_ANGLE))
    filter_.SetSurfaceDistance(within("surface_distance", surface_distance, 0, 1))
    _set_size(filter_, inputs, edge_length)
    filter_.SetEdgeFactor(within("edge_factor", edge_factor, 1, np.inf))
    filter_.SetThenBestShape(bool(then_best_shape))
    filter_.SetCellTransfer(pick("cell_transfer", cell_transfer, CELL_TRANSFERS))
    set_time_limit(filter_, time_limit)
    set_threads(filter_, threads)
    filter_.SetMergeCoincidentPoints(bool(merge_coincident_points))
    filter_.SetGatherBelow(int(within("gather_below", gather_below, 0, _MAX_CELLS)))
    filter_.SetRounds(int(within("rounds", rounds, 1, _MAX_ROUNDS)))
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
        elements_before=filter_.GetElementsBefore(),
        elements=filter_.GetElementsAfter(),
        smallest_angle_before=filter_.GetSmallestAngleBefore(),
        smallest_angle=filter_.GetSmallestAngleAfter(),
        worst_before=filter_.GetWorstBefore(),
        worst=filter_.GetWorstAfter(),
        worst_metric_before=filter_.GetWorstMetricBefore(),
        worst_metric=filter_.GetWorstMetricAfter(),
        boundary_distance=filter_.GetBoundaryDistance(),
        reason=filter_.GetReason(),
        summary=filter_.GetSummary(),
    )


def _set_size(filter_: Any, inputs: InputArrays, edge_length: Any) -> None:
    """Choose where the target length of edges comes from."""
    if edge_length is None:
        return
    if isinstance(edge_length, str) and edge_length == "input":
        filter_.SetSize(filter_.LENGTH_OF_INPUT)
    elif np.ndim(edge_length) == 0 and not isinstance(edge_length, str):
        filter_.SetSize(filter_.EDGE_LENGTH)
        filter_.SetEdgeLength(within("edge_length", edge_length, 0, np.inf))
    else:
        filter_.SetSize(filter_.SIZE_ARRAY)
        inputs.use(_SIZES, edge_length, "edge_length", POINTS)


def _named(table: Any) -> dict[str, Any]:
    """The columns of a table by names of Python; ids and counts are integers."""
    renamed = {"Time (s)": "seconds"}
    real = ("seconds", "smallest_angle", "largest_angle", "worst_imr", "imr", "x", "y", "z", "quality", "quality_bound")
    found = columns(table)  # once: texts of many rows take a while
    names = {name: name.removeprefix("N ").lower().replace(" ", "_") for name in found} | renamed
    result = {names[name]: column for name, column in found.items()}
    return {
        name: column if isinstance(column, list) or name in real else column.astype(int)
        for name, column in result.items()
    }


# --- the shell ----------------------------------------------------------------------------------------------


def add_commands(commands: Any) -> None:
    """Add `improve` to the subparsers of the command line."""
    text = "change the connectivity of tetrahedra or triangles so that the worst become better"
    parser = _commands.add_command(
        commands, "improve", _run_improve, text,
        example='part.vtu --preset "remove slivers" -o better.vtu',
        details="Swaps, contracts and inserts; the smallest angle and the worst element never become worse.",
    )
    _commands.add_moving_points(parser)
    parser.add_argument("--preset", choices=PRESETS, default="remove slivers")
    for name in _OPERATIONS:
        parser.add_argument(f"--no-{name}", action="store_false", dest=name, help="with --preset custom")
    parser.add_argument("--flat-angle", type=float, metavar="DEGREES", default=0.01,
                        help="up to which facets are coplanar, with --boundary sliding (default: 0.01)")  # fmt: skip
    parser.add_argument(
        "--boundary",
        choices=BOUNDARIES,
        default="fixed",
        help="sliding: points move within its flat parts; on surface: on smooth curved ones, too (default: fixed)",
    )
    parser.add_argument("--objective", choices=OBJECTIVES, default=OBJECTIVES[0],
                        help="what the worst tetrahedra are improved for")  # fmt: skip
    parser.add_argument("--metric", metavar="NAME", help="a metric instead of an objective, its worst values first")
    parser.add_argument("--target-angle", type=float, metavar="DEGREES",
                        help="(dihedral) angle to be reached by all (default: that of the preset)")  # fmt: skip
    parser.add_argument("--feature-angle", type=float, metavar="DEGREES", default=40.0,
                        help="sharper edges of a surface or boundary stay (default: 40)")  # fmt: skip
    parser.add_argument("--surface-angle", type=float, metavar="DEGREES", default=20.0,
                        help="of normals from the input surface, at most (default: 20)")  # fmt: skip
    parser.add_argument("--surface-distance", type=float, metavar="FACTOR", default=5e-3,
                        help="from the input surface, relative to the diagonal (default: 5e-3)")  # fmt: skip
    parser.add_argument("--edge-length", type=_commands.number_or_name, metavar="LENGTH|ARRAY|input",
                        help="target length of edges: number, point array, or that of the input")  # fmt: skip
    parser.add_argument("--edge-factor", type=float, default=2.0, metavar="FACTOR",
                        help="how much longer or shorter new edges may be (default: 2)")  # fmt: skip
    parser.add_argument("--then-best-shape", action="store_true",
                        help="move points at the end for the best shape on average, the worst being held")  # fmt: skip
    parser.add_argument("--cell-transfer", choices=CELL_TRANSFERS, default="copy",
                        help="cell data of one cell, or averages that keep totals (default: copy)")  # fmt: skip
    parser.add_argument("--regions", metavar="ARRAY", help="cell array with regions, whose common facets stay")
    parser.add_argument("--smallest-count", type=float, default=0.9, metavar="FACTOR",
                        help="least number of elements, relative to the input (default: 0.9)")  # fmt: skip
    parser.add_argument("--largest-count", type=float, default=1.1, metavar="FACTOR",
                        help="largest number of elements, relative to the input (default: 1.1)")  # fmt: skip


def _run_improve(arguments: argparse.Namespace) -> None:
    names = (
        *("preset", "boundary", "objective", "metric", "target_angle", "regions", "smallest_count", "largest_count"),
        *("fixed", "edge_length", "edge_factor", "then_best_shape", "cell_transfer", "flat_angle", "feature_angle"),
        *("surface_angle", "surface_distance", "time_limit", "threads", "merge_coincident_points"),
    )
    left_out: dict[str, Any] = {name: False for name in _OPERATIONS if not getattr(arguments, name)}
    result = improve(arguments.mesh, **_commands.given(arguments, names), **left_out)
    _commands.finish(arguments, result, result.summary, table_rows(result.history))
