# SPDX-License-Identifier: BSD-3-Clause
"""SU2's .su2 files: meshio 5.0 reads points only where they come before the elements, and fails with markers."""

from __future__ import annotations

import re
from typing import Any, NoReturn

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkDataSet, vtkUnstructuredGrid

from ._arrays import Array, cell_types
from ._errors import Error
from ._files import replace_text

#: Points and dimension of each type of cells; the types have VTK's numbers.
_CELLS = {3: (2, 1), 5: (3, 2), 9: (4, 2), 10: (4, 3), 12: (8, 3), 13: (6, 3), 14: (5, 3)}
#: The normal of the first triangle of SU2's wedge points inward, of VTK's outward. Its own inverse.
_WEDGE, _WEDGE_ORDER = 13, [0, 2, 1, 3, 5, 4]
_PLANE = 2  # dimensions
_KEYWORD = re.compile(r"\s*([A-Z_0-9]+)\s*=\s*(.*?)\s*")
#: The cell array that names the markers.
_LABELS = ("Reference", "BoundaryMarker")


class _Lines:
    """The lines of a file with data, and the number of the one that was taken last."""

    def __init__(self, name: str) -> None:
        with open(name, encoding="latin-1") as file:
            self.texts = file.read().split("\n")
        self.name, self.at = name, 0

    def next(self) -> str | None:
        while self.at < len(self.texts):
            self.at += 1
            if text := self.texts[self.at - 1].partition("%")[0].strip():
                return text
        return None

    def fail(self, problem: str) -> NoReturn:
        raise Error(f"{self.name}:{self.at}: {problem}")

    def whole(self, text: str, what: str, low: int, high: int | None = None) -> int:
        word = (text.split() or [""])[0]
        if not re.fullmatch(r"[+-]?\d+", word):
            self.fail(f"{what} is '{word}'; a whole number is expected")
        if int(word) < low or (high is not None and int(word) > high):
            self.fail(f"{what} is {word}; {low} to {high} is expected" if high is not None else f"{what} is {word}")
        return int(word)

    def record(self, what: str, count: int) -> list[str]:
        text = self.next()
        if text is None:
            self.fail(f"the file ends before {what}")
        words = text.split()
        if len(words) < count:
            self.fail(f"{len(words)} numbers; {what} has {count}")
        return words


def read_su2(name: str, lower_cells: bool = False) -> vtkUnstructuredGrid:
    """Read a mesh. Raises Error, with the line, for a damaged file and one of several zones.

    lower_cells: also the cells of the markers, with the cell array `Reference` (the number that is the name of the
    marker, otherwise its position from 1) and the field array `Markers` of the names.
    """
    lines = _Lines(name)
    dimension, points, cells, announced = 0, None, None, None  # type: int, Any, Any, int | None
    markers: list[Any] = []
    while (text := lines.next()) is not None:
        found = _KEYWORD.fullmatch(text)
        if not found:
            lines.fail(f"'{text[:40]}' where KEYWORD= is expected (is the count of the section before it right?)")
        keyword, value = found.groups()
        if keyword == "NDIME":
            dimension = lines.whole(value, keyword, 2, 3)
        elif keyword == "NZONE" and lines.whole(value, keyword, 1) > 1:
            lines.fail("a file of several zones is not supported: save one zone")
        elif keyword == "NELEM" and cells is None:
            cells = _read_cells(lines, lines.whole(value, keyword, 0))
        elif keyword == "NPOIN" and points is None:
            points = _read_points(lines, lines.whole(value, keyword, 0), dimension)
        elif keyword in ("NELEM", "NPOIN"):
            lines.fail(f"a second section {keyword}")
        elif keyword == "NMARK":
            announced = lines.whole(value, keyword, 0)
        elif keyword == "MARKER_TAG":
            markers.append((value, None))
        elif keyword == "MARKER_ELEMS":
            if not markers:
                lines.fail("MARKER_ELEMS without MARKER_TAG")
            markers[-1] = (markers[-1][0], _read_cells(lines, lines.whole(value, keyword, 0)))
        elif not value:
            lines.fail(f"{keyword} has no value")
        elif keyword.startswith("FFD"):
            break  # boxes of free-form deformation, which are the last
    if points is None or cells is None:
        lines.fail(f"the file ends without {'NPOIN' if points is None else 'NELEM'}")
    if announced is not None and announced != sum(own is not None for _, own in markers):
        lines.fail(f"NMARK is {announced}; {len(markers)} markers follow (is the file cut?)")
    for line, cell in [*cells, *(cell for _, own in markers for cell in own or ())]:
        if max(cell[1:]) >= len(points) or min(cell[1:]) < 0:
            lines.at = line
            lines.fail(f"a cell uses the points {min(cell[1:])} to {max(cell[1:])}; there are 0 to {len(points) - 1}")
    return _grid(points, cells, markers if lower_cells else [])


def _read_points(lines: _Lines, count: int, dimension: int) -> Array:
    if dimension == 0:
        lines.fail("NPOIN comes before NDIME")
    if count > len(lines.texts):
        lines.fail(f"there are not lines for {count} points")
    found = np.zeros((count, 3))
    width = dimension
    for i in range(count):
        words = lines.record("a point", width)
        width = len(words)  # with the number of the point, or without it
        try:
            found[i, :dimension] = [float(word) for word in words[:dimension]]
        except ValueError:
            lines.fail(f"the coordinates {' '.join(words[:dimension])[:60]} are not numbers")
        if not np.isfinite(found[i]).all():
            lines.fail("a coordinate is not finite")
    return found


def _read_cells(lines: _Lines, count: int) -> list[tuple[int, list[int]]]:
    """Line, type and points of each."""
    found = []
    for _ in range(count):
        words = lines.record("a cell", 1)
        if not all(word.lstrip("-").isdecimal() for word in words):
            lines.fail(f"'{' '.join(words)[:60]}' is no cell: type and points are expected")
        kind = int(words[0])
        if kind not in _CELLS:
            lines.fail(f"there is no type {kind} of cells; there are {' '.join(map(str, _CELLS))}")
        size = _CELLS[kind][0]
        if len(words) not in (size + 1, size + 2):
            lines.fail(f"a cell of the type {kind} has {size} points; {len(words) - 1} numbers follow the type")
        found.append((lines.at, [int(word) for word in words[: size + 1]]))
    return found


def _grid(points: Array, cells: list[Any], markers: list[Any]) -> vtkUnstructuredGrid:
    rows = [cell for _, cell in cells] + [cell for _, own in markers for _, cell in own or ()]
    rows = [[13, *(row[1 + i] for i in _WEDGE_ORDER)] if row[0] == _WEDGE else row for row in rows]
    grid = vtkUnstructuredGrid()
    made = vtkPoints()
    made.SetData(numpy_to_vtk(points, deep=True))
    grid.SetPoints(made)
    if rows:
        array = vtkCellArray()
        offsets = np.cumsum([0] + [len(row) - 1 for row in rows])
        ids = np.concatenate([row[1:] for row in rows])
        array.SetData(numpy_to_vtkIdTypeArray(offsets, deep=True), numpy_to_vtkIdTypeArray(ids, deep=True))
        grid.SetCells(numpy_to_vtk(np.array([row[0] for row in rows], np.uint8), deep=True), array)
    if markers:
        labels = [int(tag) if re.fullmatch(r"-?\d{1,9}", tag) else i + 1 for i, (tag, _) in enumerate(markers)]
        values = [0] * len(cells) + [label for label, (_, own) in zip(labels, markers) for _ in own or ()]
        reference = numpy_to_vtk(np.array(values, np.int64), deep=True)
        reference.SetName("Reference")
        grid.GetCellData().AddArray(reference)
        names = vtkStringArray()
        names.SetName("Markers")
        for tag, _ in markers:
            names.InsertNextValue(tag)
        grid.GetFieldData().AddArray(names)
    return grid


def write_su2(data: vtkDataSet, name: str) -> list[str]:
    """Write a mesh; cells of one dimension less than the largest are markers, named by the cell array `Reference`.

    Raises Error for cells that the format does not have, and for surfaces in space.
    """
    kinds = [data.GetCellType(i) for i in range(data.GetNumberOfCells())]
    if unknown := sorted({kind for kind in kinds if kind not in _CELLS}):
        raise Error(f"{name}: SU2 has no cells of VTK's type {' '.join(map(str, unknown))}; write .vtu or .msh")
    dimension = max((_CELLS[kind][1] for kind in kinds), default=_PLANE)
    array = next((data.GetCellData().GetArray(key) for key in _LABELS if data.GetCellData().HasArray(key)), None)
    rows: list[str] = []
    markers: dict[str, list[str]] = {}
    names = _marker_names(data)
    for i, kind in enumerate(kinds):
        if _CELLS[kind][1] < dimension - 1 or dimension < _PLANE:
            raise Error(f"{name}: SU2 has no cells of {_CELLS[kind][1]} dimensions in a mesh of {dimension}")
        ids = data.GetCell(i).GetPointIds()
        cell = [ids.GetId(k) for k in range(_CELLS[kind][0])]
        text = " ".join(map(str, [kind, *([cell[k] for k in _WEDGE_ORDER] if kind == _WEDGE else cell)]))
        if _CELLS[kind][1] == dimension:
            rows.append(text)
        else:
            label = int(array.GetTuple1(i)) if array else 1
            markers.setdefault(names.get(label, str(label)), []).append(text)
    points = [data.GetPoint(i) for i in range(data.GetNumberOfPoints())]
    if dimension == _PLANE and any(point[_PLANE] for point in points):
        raise Error(f"{name}: SU2 has no surfaces in space: its triangles and quadrilaterals are in the plane z = 0")
    lines = [f"NDIME= {dimension}", f"NELEM= {len(rows)}", *rows, f"NPOIN= {len(points)}"]
    lines += [" ".join(map(repr, point[:dimension])) for point in points] + [f"NMARK= {len(markers)}"]
    for tag, texts in markers.items():
        lines += [f"MARKER_TAG= {tag}", f"MARKER_ELEMS= {len(texts)}", *texts]
    replace_text(name, "\n".join(lines) + "\n")
    return [name]


def _marker_names(data: vtkDataSet) -> dict[int, str]:
    """The names of the markers of a file that was read."""
    names = data.GetFieldData().GetAbstractArray("Markers")
    texts = [names.GetValue(i) for i in range(names.GetNumberOfValues())] if isinstance(names, vtkStringArray) else []
    return {int(tag) if re.fullmatch(r"-?\d{1,9}", tag) else i + 1: tag for i, tag in enumerate(texts)}
