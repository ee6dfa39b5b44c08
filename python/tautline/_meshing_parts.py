# SPDX-License-Identifier: BSD-3-Clause
"""The functions triangle_mesh and tet_mesh: meshes of what a boundary surrounds."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkUnstructuredGrid

from . import _commands, _vtk
from ._arguments import set_time_limit, within
from ._arrays import POINTS, InputArrays, Values
from ._errors import interruptible, run
from ._interrupts import Progress
from ._io import Mesh, as_data_set
from ._results import Result

_SIZES = 0  # input array of vtkBoundaryMesher
_MAX_ANGLE, _MAX_DIHEDRAL_ANGLE, _MAX_RATIO, _MAX_GRADATION = 35.0, 60.0, 100.0, 10.0


@dataclass(frozen=True, repr=False, eq=False)
class MeshResult(Result):
    """The result of triangle_mesh() and tet_mesh().

    mesh: the triangles or tetrahedra; the points of the boundary come first. Point array `BoundaryMarker`: the lowest
        marker of the segments or facets a point is on, 0 inside; tetrahedra of regions also have the cell array
        `Reference`.
    boundary: the segments or facets, subdivided, on the same points, with the cell array `BoundaryMarker`.
    summary: the result in words.
    """

    mesh: vtkUnstructuredGrid
    boundary: vtkPolyData
    summary: str


@interruptible
def triangle_mesh(
    outline: Mesh,
    size: float = 0.0,
    *,
    minimum_angle: float = 20.7,
    sizes: Values | None = None,
    gradation: float = 0.3,
    time_limit: float = 0.0,
    progress: Progress | bool | None = None,
) -> MeshResult:
    """Fill outlines in a plane with triangles of good quality (Triangle Mesher).

    outline: lines, polylines or polygons in a plane z = constant: a vtkDataSet, a file name (such as .poly), the result
        of another function, or (points, cells). Their edges are kept, and subdivided where it is needed. What an odd
        number of outlines surrounds is filled, unless the field array `Holes` marks what is not.
    size: longest edge allowed, in the mesh's unit; 0 is no bound.
    minimum_angle: smallest angle of a triangle, degrees, 0 to 35. Up to 20.7 the refinement ends for certain.
    sizes: longest edge at each point of the outline: one number per point, or the name of a point array.
    gradation: with `sizes`, by how much the allowed edge grows with the distance from these points, 0 to 10.
    time_limit: seconds; 0 is no limit.

    Raises Error for wrong arguments, and for outlines that cross or are not in a plane. Method: Shewchuk 2002.

    >>> plate = tautline.triangle_mesh("plate.poly", size=0.2)
    >>> plate.mesh.GetNumberOfCells()
    """
    filter_ = _vtk.vtkTriangleMesher()
    filter_.SetSize(within("size", size, 0, np.inf))
    filter_.SetMinimumAngle(within("minimum_angle", minimum_angle, 0, _MAX_ANGLE))
    filter_.SetGradation(within("gradation", gradation, 0, _MAX_GRADATION))
    return _run_mesher(filter_, outline, sizes, time_limit, "triangles")


@interruptible
def tet_mesh(
    surface: Mesh,
    volume: float = 0.0,
    *,
    radius_edge_ratio: float = 1.4,
    minimum_dihedral_angle: float = 10.0,
    preserve_surface: bool = False,
    sizes: Values | None = None,
    time_limit: float = 0.0,
    progress: Progress | bool | None = None,
) -> MeshResult:
    """Fill a closed surface with tetrahedra of good quality (TetGen Mesher).

    surface: triangles, quadrilaterals and polygons that share their points and close one or more volumes: a vtkDataSet,
        a file name (such as .smesh, .poly or .stl), the result of another function, or (points, cells). Inner surfaces
        part the volume. Field arrays `Holes`, `Regions` and `FacetHoles` as those of TetGen's files.
    volume: largest volume of a tetrahedron; 0 is no bound.
    radius_edge_ratio: largest ratio of circumradius and shortest edge, 0 to 100; 1.1 and less seldom ends, 0 is no
        bound.
    minimum_dihedral_angle: degrees, 0 to 60, aimed at.
    preserve_surface: whether facets stay as they are, without new points on them.
    sizes: longest edge at each point of the surface: one number per point, or the name of a point array.
    time_limit: seconds; 0 is no limit.

    Raises Error for wrong arguments, and for surfaces that are open or intersect themselves. Method: Si 2015.

    >>> cube = tautline.tet_mesh("cube.smesh", volume=0.01)
    >>> cube.mesh.GetNumberOfCells()
    """
    filter_ = _vtk.vtkTetGenMesher()
    filter_.SetVolume(within("volume", volume, 0, np.inf))
    filter_.SetRadiusEdgeRatio(within("radius_edge_ratio", radius_edge_ratio, 0, _MAX_RATIO))
    angle = within("minimum_dihedral_angle", minimum_dihedral_angle, 0, _MAX_DIHEDRAL_ANGLE)
    filter_.SetMinimumDihedralAngle(angle)
    filter_.SetPreserveSurface(bool(preserve_surface))
    return _run_mesher(filter_, surface, sizes, time_limit, "tetrahedra")


def _run_mesher(filter_: Any, boundary: Mesh, sizes: Values | None, time_limit: float, cells: str) -> MeshResult:
    inputs = InputArrays(filter_, as_data_set(boundary))
    set_time_limit(filter_, time_limit)
    filter_.SetUseSizeArray(sizes is not None)
    inputs.use(_SIZES, sizes, "sizes", POINTS)
    filter_.SetInputDataObject(inputs.mesh)
    run(filter_)
    mesh, skin = filter_.GetOutputDataObject(0), filter_.GetOutputDataObject(1)
    given, made = inputs.mesh.GetNumberOfPoints(), mesh.GetNumberOfPoints()
    summary = f"{mesh.GetNumberOfCells()} {cells} on {made} points, {given} of them those of the boundary."
    return MeshResult(mesh=mesh, boundary=skin, summary=summary)


# --- the shell ----------------------------------------------------------------------------------------------


def add_commands(commands: Any) -> None:
    """Add `triangle-mesh` and `tet-mesh` to the subparsers of the command line."""
    parser = _commands.add_command(
        commands, "triangle-mesh", _run_triangles, "fill outlines in a plane with triangles", threads=False,
        example="plate.poly --size 0.2 -o plate-mesh.vtu", details="Edges of the outlines are kept.",
    )  # fmt: skip
    _commands.add_mesh(parser)
    _commands.add_output(parser)
    parser.add_argument("--size", type=float, default=0.0, help="longest edge (default: 0, no bound)")
    parser.add_argument("--minimum-angle", type=float, default=20.7, metavar="DEGREES", help="(default: 20.7)")
    parser.add_argument("--sizes", metavar="ARRAY", help="point array with the longest edge at each point")
    parser.add_argument("--gradation", type=float, default=0.3, help="growth of edges away from these (default: 0.3)")
    _commands.add_time_limit(parser)
    parser = _commands.add_command(
        commands, "tet-mesh", _run_tetrahedra, "fill a closed surface with tetrahedra", threads=False,
        example="cube.smesh --volume 0.01 -o cube.vtu", details="By TetGen; the facets may be subdivided.",
    )  # fmt: skip
    _commands.add_mesh(parser)
    _commands.add_output(parser)
    parser.add_argument("--volume", type=float, default=0.0, help="largest volume (default: 0, no bound)")
    parser.add_argument("--radius-edge-ratio", type=float, default=1.4, help="0 is no bound (default: 1.4)")
    parser.add_argument("--minimum-dihedral-angle", type=float, default=10.0, metavar="DEGREES", help="(default: 10)")
    parser.add_argument("--preserve-surface", action="store_true", help="no new points on the surface")
    parser.add_argument("--sizes", metavar="ARRAY", help="point array with the longest edge at each point")
    _commands.add_time_limit(parser)


def _run_triangles(arguments: argparse.Namespace) -> None:
    names = ("size", "minimum_angle", "sizes", "gradation", "time_limit")
    result = triangle_mesh(arguments.mesh, **_commands.given(arguments, names))
    _commands.finish(arguments, result, result.summary)


def _run_tetrahedra(arguments: argparse.Namespace) -> None:
    names = ("volume", "radius_edge_ratio", "minimum_dihedral_angle", "preserve_surface", "sizes", "time_limit")
    result = tet_mesh(arguments.mesh, **_commands.given(arguments, names))
    _commands.finish(arguments, result, result.summary)
