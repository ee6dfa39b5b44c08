# SPDX-License-Identifier: BSD-3-Clause
"""The result and the inputs of triangle_mesh() and tet_mesh()."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any

from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkUnstructuredGrid

from . import _commands
from ._arrays import POINTS, InputArrays, Values
from ._io import Mesh, as_data_set
from ._results import Result

_SIZES = 0  # input array of vtkBoundaryMesher


@dataclass(frozen=True, repr=False, eq=False)
class MeshResult(Result):
    """The result of triangle_mesh() and tet_mesh().

    Attributes
    ----------
    mesh : vtkUnstructuredGrid
        The triangles or tetrahedra; the points of the boundary come first. Point array `BoundaryMarker`: the lowest
        marker of the segments or facets a point is on, 0 inside; tetrahedra of regions also have the cell array
        `Reference`.
    boundary : vtkPolyData
        The segments or facets, subdivided, on the same points, with the cell array `BoundaryMarker`.
    summary : str
        The result in words.
    """

    mesh: vtkUnstructuredGrid
    boundary: vtkPolyData
    summary: str


def triangle_mesh_input(filter_: Any, outline: Mesh, sizes: Values | None = None) -> None:
    """Set the outlines and the sizes.

    outline: lines, polylines or polygons in a plane z = constant: a vtkDataSet, a file name (such as .poly), the result
        of another function, or (points, cells). Their edges are kept, and subdivided where needed. Areas surrounded by
        an odd number of outlines are filled, unless the field array `Holes` marks the holes.
    sizes: longest edge at each point of the outline: one number per point, or the name of a point array.
    """
    _set_boundary(filter_, outline, sizes)


def tet_mesh_input(filter_: Any, surface: Mesh, sizes: Values | None = None) -> None:
    """Set the surface and the sizes.

    surface: triangles, quadrilaterals and polygons that share their points and close one or more volumes: a vtkDataSet,
        a file name (such as .smesh, .poly or .stl), the result of another function, or (points, cells). Inner surfaces
        divide the volume. The field arrays `Holes`, `Regions` and `FacetHoles` work as in TetGen's files.
    sizes: longest edge at each point of the surface: one number per point, or the name of a point array.
    """
    _set_boundary(filter_, surface, sizes)


def _set_boundary(filter_: Any, boundary: Mesh, sizes: Values | None) -> None:
    inputs = InputArrays(filter_, as_data_set(boundary))
    filter_.SetUseSizeArray(sizes is not None)
    inputs.use(_SIZES, sizes, "sizes", POINTS)
    filter_.SetInputDataObject(inputs.mesh)


def triangle_mesh_result(filter_: Any, mesh: vtkUnstructuredGrid) -> MeshResult:
    """The result of a filter that has run."""
    return _result(filter_, mesh, "triangles")


def tet_mesh_result(filter_: Any, mesh: vtkUnstructuredGrid) -> MeshResult:
    """The result of a filter that has run."""
    return _result(filter_, mesh, "tetrahedra")


def _result(filter_: Any, mesh: vtkUnstructuredGrid, cells: str) -> MeshResult:
    given, made = filter_.GetInputDataObject(0, 0).GetNumberOfPoints(), mesh.GetNumberOfPoints()
    summary = f"{mesh.GetNumberOfCells()} {cells} on {made} points, {given} of them from the boundary."
    return MeshResult(mesh=mesh, boundary=filter_.GetOutputDataObject(1), summary=summary)


# --- the shell ----------------------------------------------------------------------------------------------


def add_triangle_mesh_options(parser: argparse.ArgumentParser) -> None:
    """Add the outlines and the option of the sizes."""
    _add_boundary(parser, "outline")


def add_tet_mesh_options(parser: argparse.ArgumentParser) -> None:
    """Add the surface and the option of the sizes."""
    _add_boundary(parser, "surface")


def _add_boundary(parser: argparse.ArgumentParser, name: str) -> None:
    parser.add_argument(name, metavar="FILE", help=f"{name} to read; - is a .vtu from the standard input")
    parser.add_argument("--sizes", metavar="ARRAY", help="point array with the longest edge at each point")


def triangle_mesh_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """The values of these options."""
    return _commands.given(arguments, ("sizes",))


def tet_mesh_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """The values of these options."""
    return _commands.given(arguments, ("sizes",))


def finish_triangle_mesh(arguments: argparse.Namespace, result: MeshResult) -> None:
    """Print the result of the command."""
    _commands.finish(arguments, result, result.summary)


def finish_tet_mesh(arguments: argparse.Namespace, result: MeshResult) -> None:
    """Print the result of the command."""
    _commands.finish(arguments, result, result.summary)
