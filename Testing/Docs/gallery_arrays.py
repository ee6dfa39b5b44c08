# SPDX-License-Identifier: BSD-3-Clause
"""Whether two files of the gallery have the same content: points, cells, and the arrays of both."""

import re
import sys
from pathlib import Path

import numpy as np
import tautline as tl
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import VTK_POLYHEDRON

sys.path.append(str(Path(__file__).resolve().parents[2] / "Plugin" / "Site"))
from gallery_pages import parts_of, state_of  # noqa: E402, F401, the snippets as the page has them

DATE = re.compile(r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d\S*")  # in a report
TIMES = re.compile("seconds|rank|result")  # columns of a table that differ from run to run
MESHES = (".vtu", ".vti", ".mesh", ".node", ".msh")


def points_of_cells(mesh) -> np.ndarray:
    """The points of the cells, one after the other; for polyhedra sorted: copies of the mesh have another order."""
    points = vtk_to_numpy(mesh.GetCells().GetConnectivityArray()).copy()
    starts = vtk_to_numpy(mesh.GetCells().GetOffsetsArray())
    for cell in np.flatnonzero(vtk_to_numpy(mesh.GetCellTypesArray()) == VTK_POLYHEDRON):
        points[starts[cell] : starts[cell + 1]].sort()
    return points


def arrays_of(mesh) -> dict[str, np.ndarray]:
    """Everything that a picture of the mesh depends on, by names such as 'cell array imr'."""
    found = {"points": np.array([mesh.GetPoint(i) for i in range(mesh.GetNumberOfPoints())])}
    if mesh.IsA("vtkUnstructuredGrid"):
        found["types of the cells"] = vtk_to_numpy(mesh.GetCellTypesArray())
        found["offsets of the cells"] = vtk_to_numpy(mesh.GetCells().GetOffsetsArray())
        found["points of the cells"] = points_of_cells(mesh)
    for kind, data in (("point", mesh.GetPointData()), ("cell", mesh.GetCellData())):
        for i in range(data.GetNumberOfArrays()):
            if data.GetArray(i) is not None:
                found[f"{kind} array {data.GetArrayName(i)}"] = vtk_to_numpy(data.GetArray(i))
    return found


def differences(found, expected) -> list[str]:
    """How two meshes differ; nothing if they are bitwise the same."""
    one, other = arrays_of(found), arrays_of(expected)
    lines = [f"has {name}, the script does not" for name in one if name not in other]
    lines += [f"has no {name}" for name in other if name not in one]
    for name in one.keys() & other.keys():
        if one[name].shape != other[name].shape:
            lines.append(f"{name}: {one[name].shape} instead of {other[name].shape}")
        elif not np.array_equal(one[name], other[name], equal_nan=True):
            most = np.nanmax(np.abs(one[name].astype(float) - other[name]))
            lines.append(f"{name}: differs by up to {most:g}")
    return sorted(lines)


def table_of(file: Path) -> list[list[str]]:
    """The rows of a table, without the columns that have times."""
    rows = [line.split(",") for line in file.read_text(encoding="utf-8").splitlines()]
    kept = [i for i, name in enumerate(rows[0]) if not TIMES.search(name)]
    return [[row[i] for i in kept] for row in rows]


def file_differences(found: Path, expected: Path) -> list[str]:
    if found.suffix in MESHES:
        return differences(tl.read(found), tl.read(expected))
    if found.suffix == ".csv":
        same = table_of(found) == table_of(expected)
    else:
        one, other = (DATE.sub("", file.read_text(encoding="utf-8")) for file in (found, expected))
        same = one == other
    return [] if same else ["the text differs"]
