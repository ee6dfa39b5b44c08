# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of meshio as meshes of VTK and back, where meshio is installed; its formats."""

from __future__ import annotations

import io
import os
import re
import sys
import warnings
from contextlib import redirect_stderr, redirect_stdout
from importlib import import_module
from importlib.util import find_spec
from typing import Any, Callable, cast

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkDataSet, vtkPointSet, vtkUnstructuredGrid

from ._arrays import Array
from ._deck_numbers import with_short_numbers
from ._errors import Error
from ._files import replacing_by_name
from ._grid_checks import check_block
from ._groups import Groups, element_sets, families, masks, members_of, with_groups

#: VTK's number and the number of points of meshio's cells, in the same order of points, except _ORDERS.
_CELLS = {
    "vertex": (1, 1), "line": (3, 2), "triangle": (5, 3), "quad": (9, 4), "tetra": (10, 4), "hexahedron": (12, 8),
    "wedge": (13, 6), "pyramid": (14, 5), "line3": (21, 3), "triangle6": (22, 6), "quad8": (23, 8), "tetra10": (24, 10),
    "hexahedron20": (25, 20), "wedge15": (26, 15), "pyramid13": (27, 13), "quad9": (28, 9), "hexahedron27": (29, 27),
    "triangle7": (34, 7),
}  # fmt: skip
#: meshio's wedges are like Gmsh's: the normal of their first triangle points inward. Their own inverses.
_ORDERS = {"wedge": [0, 2, 1, 3, 5, 4], "wedge15": [0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13]}
_BY_NUMBER = {number: (name, size) for name, (number, size) in _CELLS.items()}
#: Formats that meshio reads and VTK or Tautline do not: descriptions by ending.
MESHIO_FORMATS = {
    ".inp": "Abaqus",
    ".med": "Salome MED",
    ".vol": "Netgen",
    ".h5m": "MOAB",
    ".mdpa": "Kratos",
    ".ugrid": "UGRID",
    ".f3grid": "FLAC3D",
    ".xml": "DOLFIN",
}
#: Kratos' names end with the dimension of the space and the number of nodes.
_KRATOS_NAME = re.compile(r"([123])D(\d+)N?$")
_KRATOS_SURFACE = re.compile("Shell|Membrane|Plate|Surface", re.IGNORECASE)
_KRATOS_CELLS = {
    (1, 2): "line", (1, 3): "line3", (2, 3): "triangle", (2, 4): "quad", (2, 6): "triangle6", (2, 8): "quad8",
    (2, 9): "quad9", (3, 4): "tetra", (3, 5): "pyramid", (3, 6): "wedge", (3, 8): "hexahedron", (3, 10): "tetra10",
    (3, 15): "wedge15", (3, 20): "hexahedron20", (3, 27): "hexahedron27",
}  # fmt: skip
#: Text formats without counts, where a truncated line can be read as a whole one.
_LINES_ONLY = (".f3grid",)
#: Formats with one label for each cell, and the cell arrays it is taken from.
_ONE_LABEL = (".ugrid",)
_LABELS = ("Reference", "ugrid:ref", "BoundaryMarker")
_DIMENSION = {"line": 1, "triangle": 2, "quad": 2, "tetra": 3, "hexahedron": 3, "wedge": 3, "pyramid": 3}
_MISSING_DIMENSIONS = {"wedge15": 3, "pyramid13": 3, "triangle7": 2}
PACKAGE = "meshio (Debian: apt-get install python3-meshio)"
_MOAB = ".h5m"
_HDF5_FORMATS = (".med", _MOAB)
_HDF5_PACKAGE = "h5py (Debian: apt-get install python3-h5py)"
#: The cells of formats that do not support all of meshio's.
_ONLY_CELLS = {
    ".f3grid": ("FLAC3D", {"tetra", "pyramid", "wedge", "hexahedron", "triangle", "quad"}, 3),
    ".xml": ("DOLFIN", {"triangle", "tetra"}, 2),
    _MOAB: ("MOAB's format, as meshio writes it,", {"line", "triangle", "tetra"}, 0),
    ".med": ("Salome MED, as meshio writes it,", set(_CELLS) - {"quad9", "hexahedron27", "triangle7"}, 0),
    # meshio writes line3 as B33H, which has two nodes
    ".inp": ("Abaqus", set(_CELLS) - {"line3", "vertex", "pyramid", "pyramid13", "triangle7", "hexahedron27"}, 0),
}


def installed(ending: str = "") -> bool:
    """Whether meshio and its dependencies for the format can be imported."""
    return find_spec("meshio") is not None and (ending not in _HDF5_FORMATS or find_spec("h5py") is not None)


def check_installed(name: str) -> None:
    """Raise Error, with the names of the packages, if meshio or what it needs for the format is not installed."""
    ending = name[name.rfind(".") :].lower()
    if find_spec("meshio") is None:
        raise Error(f"{name}: this format needs {PACKAGE}, which is not installed")
    if not installed(ending):
        raise Error(f"{name}: meshio needs {_HDF5_PACKAGE} for '{ending}', which is not installed")


def is_meshio(mesh: Any) -> bool:
    """Whether an object is a mesh of meshio, without importing it."""
    module = sys.modules.get("meshio")
    return module is not None and isinstance(mesh, module.Mesh)


def read_meshio(name: str) -> vtkUnstructuredGrid:
    """Read a file. Raises Error if meshio is not installed or cannot read it; its printed messages become warnings."""
    meshio = _module(name)
    if name.lower().endswith(_LINES_ONLY):
        with open(name, "rb") as file:
            file.seek(-1, os.SEEK_END)
            if file.read() != b"\n":
                raise Error(f"{name}: the file ends within a line: it is truncated")
    if name.lower().endswith(".mdpa"):
        _name_kratos_elements(name)
    mesh = _quietly(name, "read", lambda: meshio.read(name))
    try:
        return from_meshio(mesh)
    except Error as error:
        raise Error(f"{name}: {error}") from None


def _name_kratos_elements(name: str) -> None:
    """Register the cells of the Kratos elements of a file with meshio, which reads Element2D3N as a line.

    Raises Error, with the line, for elements whose name does not give their cell, and for nodes that are not numbered
    from 1 on, because meshio uses their numbers as positions.
    """
    known = import_module("meshio.mdpa._mdpa")._mdpa_to_meshio_type
    nodes = None
    with open(name, encoding="latin-1") as file:
        for number, line in enumerate(file, 1):
            words = line.split()
            if words[:2] == ["Begin", "Nodes"]:
                nodes = 0
            elif words[:2] == ["End", "Nodes"]:
                nodes = None
            elif nodes is not None and words and not words[0].startswith("//"):
                nodes += 1
                if words[0] != str(nodes):
                    raise Error(f"{name}:{number}: node {words[0]} where {nodes} is expected: number them from 1 on")
            elif len(words) > 2 and words[0] == "Begin" and words[1] in ("Elements", "Conditions"):
                if not any(key in words[2] for key in known):
                    known[words[2]] = _kratos_cell(f"{name}:{number}", words[1] == "Conditions", words[2])


def _kratos_cell(place: str, boundary: bool, entity: str) -> str:
    found = _KRATOS_NAME.search(entity)
    if not found:
        raise Error(f"{place}: the cell of '{entity}' is not known: its name does not end like Element3D4N")
    dimension = int(found[1]) - (1 if boundary or _KRATOS_SURFACE.search(entity) else 0)
    kind = _KRATOS_CELLS.get((dimension, int(found[2])))
    if kind is None:
        raise Error(f"{place}: there is no cell of {dimension} dimensions and {found[2]} nodes for '{entity}'")
    return kind


def write_meshio(data: vtkDataSet, name: str, groups: Groups | None = None) -> list[str]:
    """Write a file. Raises Error if meshio is not installed or cannot write it.

    Groups are element sets in .inp and groups in .med, otherwise arrays of 0 and 1.
    """
    meshio = _module(name)
    ending = name[name.rfind(".") :].lower()
    sets = masks(groups or {}, data.GetNumberOfCells())
    if sets and ending not in (".inp", ".med"):
        data = cast(vtkDataSet, with_groups(data, groups or {}))
    made = meshio_of(data)
    if ending == ".med":
        tags, names = families(sets, data.GetNumberOfCells())
        made = _by_type(made, {"cell_tags": tags})
        made.cell_tags = names
    _check_cells(name, ending, made)
    if ending == _MOAB:
        made = _without_cell_data(name, _by_type(made, {}))
    made = _labeled(made) if ending in _ONE_LABEL else made
    with replacing_by_name(name) as temporary:
        _quietly(name, "write", lambda: meshio.write(temporary, made), temporary)
        if ending == ".inp":
            with open(temporary, encoding="latin-1") as file:
                lines = list(with_short_numbers(file))
            with open(temporary, "w", encoding="latin-1") as file:
                file.writelines(lines)
        if sets and ending == ".inp":
            with open(temporary, "a", encoding="ascii", errors="replace") as file:
                file.write(element_sets(sets))
    return [name]


def _check_cells(name: str, ending: str, mesh: Any) -> None:
    """Raise Error for cells that the format does not have; meshio ends with an assertion, or leaves them out."""
    title, known, least = _ONLY_CELLS.get(ending, ("", None, 0))
    if known is None:
        return
    found = {block.type for block in mesh.cells if len(block.data)}
    if found - known:
        raise Error(f"{name}: {title} has no cells {' '.join(sorted(found - known))}; write .vtu or .msh")
    if max((_DIMENSION.get(kind, 0) for kind in found), default=0) < least:
        raise Error(f"{name}: {title} has no meshes without cells of {least} dimensions; write .vtu or .msh")


def _labeled(mesh: Any) -> Any:
    """The mesh with only the labels as cell data; meshio would otherwise pick some integer array."""
    names = [name for name in _LABELS if name in mesh.cell_data]
    labels = {"Reference": [np.asarray(part).astype(np.int64) for part in mesh.cell_data[names[0]]]} if names else {}
    return type(mesh)(mesh.points, [(block.type, block.data) for block in mesh.cells], cell_data=labels)


def _without_cell_data(name: str, mesh: Any) -> Any:
    """The mesh without arrays of cells, which meshio cannot write to this format."""
    if mesh.cell_data:
        warnings.warn(f"{name}: the arrays of cells are left out: {', '.join(mesh.cell_data)}", stacklevel=6)
    return type(mesh)(mesh.points, [(block.type, block.data) for block in mesh.cells], point_data=mesh.point_data)


def _by_type(mesh: Any, more: dict[str, Array]) -> Any:
    """A mesh with one block for each type of cells, and more arrays of cells."""
    blocks = [block.type for block in mesh.cells]
    data = {name: np.concatenate(values) for name, values in mesh.cell_data.items()} | more
    types = np.repeat(np.arange(len(blocks)), [len(block.data) for block in mesh.cells])
    kinds = list(dict.fromkeys(blocks))
    of_kind = np.array([kinds.index(block) for block in blocks])[types] if blocks else types
    return type(mesh)(
        mesh.points,
        [(kind, np.concatenate([b.data for b in mesh.cells if b.type == kind])) for kind in kinds],
        point_data=mesh.point_data,
        cell_data={name: [values[of_kind == i] for i in range(len(kinds))] for name, values in data.items()},
    )


def _quietly(name: str, verb: str, action: Callable[[], Any], temporary: str = "") -> Any:
    """The result of an action of meshio, which prints messages and exits the program after some errors.

    temporary: the name of the file in these messages, if it differs from `name`.
    """
    said = io.StringIO()
    try:
        with redirect_stdout(said), redirect_stderr(said):
            result = action()
    except OSError as error:
        if temporary:  # not the format: a full disk
            raise
        raise Error(f"{name}: meshio cannot {verb} it: {error.strerror or error}") from None
    except (Exception, SystemExit) as error:
        reason = "" if isinstance(error, SystemExit) else str(error) or type(error).__name__
        text = " ".join(f"{reason} {said.getvalue()}".split()).replace(temporary or name, name)
        remedy = "; write .vtu or .msh" if verb == "write" else ""
        raise Error(f"{name}: meshio cannot {verb} it: {text or type(error).__name__}{remedy}") from None
    if text := " ".join(said.getvalue().split()).replace(temporary or name, name):
        warnings.warn(f"{name}: meshio: {text}", stacklevel=2)
    return result


def _module(name: str) -> Any:
    check_installed(name)
    return _imported()


def _imported() -> Any:
    """meshio, whose meshes of version 5.0 fail for some of the cells that its formats have."""
    meshio = import_module("meshio")
    known = getattr(import_module("meshio._mesh"), "topological_dimension", {})
    for kind, dimension in _MISSING_DIMENSIONS.items():
        known.setdefault(kind, dimension)
    return meshio


def from_meshio(mesh: Any) -> vtkUnstructuredGrid:
    """A grid of a mesh of meshio, with its point data, cell data and cell sets (arrays of 0 and 1).

    Raises Error for cells that VTK does not have.
    """
    xyz = np.asarray(mesh.points, float)
    if xyz.ndim != 2 or not 1 <= xyz.shape[1] <= 3 or not mesh.cells:
        raise Error("this mesh of meshio has no points or no cells")
    xyz = np.hstack([xyz, np.zeros((len(xyz), 3 - xyz.shape[1]))]) if xyz.shape[1] < 3 else xyz
    types, sizes, ids = [], [], []
    for block in mesh.cells:
        if block.type not in _CELLS:
            raise Error(f"cells {block.type!r} of meshio are not supported; there are {', '.join(_CELLS)}")
        number, size = _CELLS[block.type]
        rows = check_block(block.type, _as_array(block.type, block.data), size, len(xyz))
        types.append(np.full(len(rows), number, np.uint8))
        sizes.append(np.full(len(rows), size, np.int64))
        ids.append(_ordered(block.type, rows).ravel())
    grid = vtkUnstructuredGrid()
    points = vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(xyz), deep=True))
    grid.SetPoints(points)
    if types:
        cells = vtkCellArray()
        offsets = np.concatenate([[0], np.cumsum(np.hstack(sizes))])
        cells.SetData(numpy_to_vtkIdTypeArray(offsets, deep=True), numpy_to_vtkIdTypeArray(np.hstack(ids), deep=True))
        grid.SetCells(numpy_to_vtk(np.hstack(types), deep=True), cells)
    for name, values in mesh.point_data.items():
        _add(grid.GetPointData(), name, values)
    for name, blocks in mesh.cell_data.items():
        _add(grid.GetCellData(), name, np.concatenate([np.asarray(block) for block in blocks]))
    for name, blocks in mesh.cell_sets.items():
        _add(grid.GetCellData(), name, _membership(mesh, blocks))
    if names := getattr(mesh, "cell_tags", None):  # of MED
        for name, values in members_of(np.concatenate(mesh.cell_data["cell_tags"]), names).items():
            _add(grid.GetCellData(), name, values)
    return grid


def _as_array(kind: str, cells: Any) -> Array:
    try:
        return np.asarray(cells)
    except ValueError as error:  # rows of different lengths
        raise Error(f"cells {kind!r} of meshio are no array: {error}") from None


def _ordered(name: str, cells: Array) -> Array:
    """The points of cells in the order of VTK instead of meshio's, or the other way round."""
    return cells[:, _ORDERS[name]] if name in _ORDERS and cells.size else cells


def in_vtk_order(name: str, cells: Any) -> Any:
    """The points of cells of meshio, by the name of the cell, in the order of VTK; other values are unchanged."""
    if name not in _ORDERS or np.ndim(cells) != 2 or np.shape(cells)[1] != len(_ORDERS[name]):
        return cells
    return _ordered(name, np.asarray(cells))


def _membership(mesh: Any, chosen: Any) -> Array:
    """Per cell 1 in a set of cells, otherwise 0."""
    parts = []
    for block, members in zip(mesh.cells, chosen):
        part = np.zeros(len(block.data), np.uint8)
        if members is not None and len(members):
            part[np.asarray(members, int)] = 1
        parts.append(part)
    return np.concatenate(parts) if parts else np.zeros(0, np.uint8)


def _add(fields: Any, name: str, values: Any) -> None:
    numbers = np.ascontiguousarray(values)
    if numbers.dtype.kind not in "iufb":
        return
    numbers = numbers.astype(np.uint8) if numbers.dtype.kind == "b" else numbers
    array = numpy_to_vtk(numbers.reshape(len(numbers), -1) if numbers.ndim > 2 else numbers, deep=True)
    array.SetName(name)
    fields.AddArray(array)


def meshio_of(data: vtkDataSet) -> Any:
    """The mesh of meshio of a data set. Raises Error if meshio is not installed, and for cells that it lacks."""
    try:
        meshio = _imported()
    except ImportError:
        raise Error(f"{PACKAGE} is not installed") from None
    count = data.GetNumberOfPoints()
    if isinstance(data, vtkPointSet) and data.GetPoints():
        xyz = np.array(vtk_to_numpy(data.GetPoints().GetData()))
    else:
        xyz = np.array([data.GetPoint(i) for i in range(count)]).reshape(count, 3)
    blocks: list[tuple[str, list[list[int]]]] = []
    starts: list[int] = []
    for cell in range(data.GetNumberOfCells()):
        kind = _BY_NUMBER.get(data.GetCellType(cell))
        if kind is None:
            raise Error(f"meshio has no cells of VTK's type {data.GetCellType(cell)} (cell {cell})")
        ids = data.GetCell(cell).GetPointIds()
        if not blocks or blocks[-1][0] != kind[0]:
            blocks.append((kind[0], []))
            starts.append(cell)
        blocks[-1][1].append([ids.GetId(i) for i in range(kind[1])])
    bounds = starts[1:]
    return meshio.Mesh(
        xyz,
        [(name, _ordered(name, np.array(cells))) for name, cells in blocks],
        point_data=_arrays(data.GetPointData()),
        cell_data={name: np.split(values, bounds) for name, values in _arrays(data.GetCellData()).items() if blocks},
    )


def _arrays(fields: Any) -> dict[str, Array]:
    found = [fields.GetArray(i) for i in range(fields.GetNumberOfArrays())]
    return {array.GetName(): np.array(vtk_to_numpy(array)) for array in found if array and array.GetName()}
