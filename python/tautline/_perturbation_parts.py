# SPDX-License-Identifier: BSD-3-Clause
"""The function perturb: moves interior points at random."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataObject

from . import _commands, _vtk
from ._arguments import set_threads, set_time_limit, within
from ._arrays import POINTS, Array, InputArrays, Values, point_array
from ._errors import Error, interruptible, run
from ._interrupts import Progress
from ._io import Mesh, as_mesh
from ._results import Result

_FIXED = 0  # input array of vtkMeshPerturbation
_SEEDS = 2**31


@dataclass(frozen=True, repr=False, eq=False)
class PerturbResult(Result):
    """The result of perturb(). Of composite data, the numbers are those of all blocks.

    mesh: the mesh with the new points and the point array `Displacement`; shares the rest with the input.
    displacement: new minus old position, n x 3.
    movable, moved: number of interior points that were free to move, and of those that moved.
    inverted_before, inverted, tangled: number of inverted elements before and after, and the latter as a fraction of
        all elements.
    largest_displacement: the largest displacement, in the mesh's unit.
    summary: the result in words.
    """

    _per_element: ClassVar[tuple[str, ...]] = ("displacement",)
    mesh: vtkDataObject
    displacement: Array
    movable: int
    moved: int
    inverted_before: int
    inverted: int
    tangled: float
    largest_displacement: float
    summary: str


@interruptible
def perturb(
    mesh: Mesh,
    fraction: float = 0.5,
    percentage: float = 50.0,
    seed: int = 1,
    tangle: float = 0.0,
    fixed: Values | None = None,
    threads: int = 0,
    merge_coincident_points: bool = True,
    time_limit: float = 0.0,
    *,
    progress: Progress | bool | None = None,
) -> PerturbResult:
    """Move interior points at random, without inverting an element or until a fraction of the elements is inverted.

    mesh: a vtkDataSet with explicit points, a composite data set, a file name or (points, cells). It is not changed.
    fraction: largest displacement of a point, as a fraction of its distance to inversion, 0 to 1.
    percentage: percentage of the interior points that move, 0 to 100.
    seed: seed of the random numbers, -2^31 to 2^31 - 1; the same seed gives the same mesh.
    tangle: fraction of the elements to invert, 0 to 1; with 0 no element becomes inverted.
    fixed: points that stay in place besides the boundary: one number or truth value per point, n, or the name of a
        point array; points with values other than 0 stay.
    threads: number of threads; 0 is all cores. The result does not depend on it.
    merge_coincident_points: whether points at the same place on facets that match are treated as one, as on the seams
        of a mesh in pieces; the result keeps them all. False: they stay apart, as a crack or a contact needs it.
    time_limit: seconds; 0 is no limit.

    Raises Error for wrong arguments and for meshes that the filter refuses (quadratic cells, image data).

    >>> worse = tautline.perturb("part.vtu", fraction=0.8, seed=3)
    >>> worse.moved, worse.largest_displacement
    """
    filter_ = _vtk.vtkMeshPerturbation()
    inputs = InputArrays(filter_, as_mesh(mesh))
    filter_.SetFraction(within("fraction", fraction, 0, 1))
    filter_.SetPercentage(within("percentage", percentage, 0, 100))
    filter_.SetTangledFraction(within("tangle", tangle, 0, 1))
    filter_.SetSeed(int(within("seed", seed, -_SEEDS, _SEEDS - 1)))
    set_time_limit(filter_, time_limit)
    set_threads(filter_, threads)
    filter_.SetMergeCoincidentPoints(bool(merge_coincident_points))
    if fixed is not None and not isinstance(fixed, str) and np.ndim(fixed) != 1:
        raise Error(f"fixed has the shape {np.shape(fixed)}; one value for each point is expected")
    inputs.use(_FIXED, fixed, "fixed", POINTS)
    filter_.SetInputDataObject(inputs.mesh)
    run(filter_)
    output = inputs.remove_from(filter_.GetOutputDataObject(0))
    return PerturbResult(
        mesh=output,
        displacement=point_array(output, "Displacement"),
        movable=filter_.GetNumberOfMovablePoints(),
        moved=filter_.GetNumberOfMovedPoints(),
        inverted_before=filter_.GetInvertedBefore(),
        inverted=filter_.GetInvertedAfter(),
        tangled=filter_.GetTangledFractionReached(),
        largest_displacement=filter_.GetLargestDisplacement(),
        summary=filter_.GetSummary(),
    )


# --- the shell ----------------------------------------------------------------------------------------------


def add_commands(commands: Any) -> None:
    """Add `perturb` to the subparsers of the command line."""
    parser = _commands.add_command(
        commands, "perturb", _run, "move interior points at random",
        example="part.vtu --fraction 0.8 --seed 3 -o worse.vtu",
        details="For tests of methods that repair meshes.",
    )
    _commands.add_mesh(parser)
    _commands.add_output(parser)
    parser.add_argument("--fraction", type=float, default=0.5,
                        help="largest displacement over the distance to inversion, 0 to 1 (default: 0.5)")  # fmt: skip
    parser.add_argument("--percentage", type=float, default=50, help="of the points to move, 0 to 100 (default: 50)")
    parser.add_argument("--seed", type=int, default=1, help="seed of the random numbers (default: 1)")
    parser.add_argument("--tangle", type=float, default=0.0, help="fraction of elements to invert, 0 to 1 (default: 0)")
    parser.add_argument("--fixed", metavar="ARRAY", help="point array, not 0 where points stay")
    _commands.add_merge_points(parser)
    _commands.add_time_limit(parser)


def _run(arguments: argparse.Namespace) -> None:
    names = ("fraction", "percentage", "seed", "tangle", "fixed", "time_limit", "threads", "merge_coincident_points")
    result = perturb(arguments.mesh, **_commands.given(arguments, names))
    _commands.finish(arguments, result, result.summary)
