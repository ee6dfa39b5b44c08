# SPDX-License-Identifier: BSD-3-Clause
"""Universal files, .unv, of I-DEAS, Salome and Gmsh: nodes, elements and groups of elements."""

from __future__ import annotations

import warnings
from typing import Any, Iterator, NamedTuple, NoReturn

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkUnstructuredGrid

from ._arrays import Array
from ._errors import Error

_END = "-1"  # a line at both ends of a dataset
#: Datasets: nodes of two lines each, nodes of one line, elements with the place of their number of nodes, groups.
NODES, NODES_OF_ONE_LINE = ("2411", "781"), "15"
_ELEMENTS = {"2412": 5, "780": 7}
_GROUPS = ("2435", "2452", "2467", "2477")
_PROPERTY = 2  # the place of the physical property
_BEAMS = (11, 21, 22, 23, 24)  # have a line more
_SHELLS = range(41, 99)
_FIRST_OTHER = 121  # springs, masses, rigid bodies
_ELEMENT_ENTITY = 8  # in groups
_TURNED = [0, 2, 1, 3, 5, 4]
#: VTK's type, dimension and order of the points of the elements: the file's go round each face, through the edges.
_LINE, _LINE3 = (3, 1, [0, 1]), (21, 1, [0, 2, 1])
_FACES = {
    3: (5, 2, [0, 1, 2]),
    4: (9, 2, [0, 1, 2, 3]),
    6: (22, 2, [0, 2, 4, 1, 3, 5]),
    8: (23, 2, [0, 2, 4, 6, 1, 3, 5, 7]),
}
_SOLIDS = {
    111: (10, 3, [0, 1, 2, 3]),
    112: (13, 3, _TURNED),
    113: (26, 3, [0, 4, 2, 9, 13, 11, 5, 3, 1, 14, 12, 10, 6, 8, 7]),
    115: (12, 3, [0, 1, 2, 3, 4, 5, 6, 7]),
    116: (25, 3, [0, 2, 4, 6, 12, 14, 16, 18, 1, 3, 5, 7, 13, 15, 17, 19, 8, 9, 10, 11]),
    118: (24, 3, [0, 2, 4, 9, 1, 3, 5, 6, 7, 8]),
}


class _Element(NamedTuple):
    line: int
    label: int
    kind: int
    dimension: int
    reference: int
    nodes: list[int]


class _Lines:
    """The lines of a dataset, and the number of the line that was taken last."""

    def __init__(self, name: str, texts: list[str], begin: int, end: int) -> None:
        self.name, self.texts, self.at, self.end = name, texts, begin, end

    def fail(self, problem: str) -> NoReturn:
        raise Error(f"{self.name}:{self.at}: {problem}")

    def more(self) -> bool:
        while self.at < self.end and not self.texts[self.at].strip():
            self.at += 1
        return self.at < self.end

    def next(self, what: str) -> str:
        if not self.more():
            self.fail(f"the dataset ends before {what}")
        self.at += 1
        return self.texts[self.at - 1]

    def whole(self, what: str, least: int) -> list[int]:
        words = self.next(what).split()
        try:
            found = [int(word) for word in words]
        except ValueError:
            self.fail(f"whole numbers are expected for {what}")
        if len(found) < least:
            self.fail(f"{len(found)} numbers; {what} has {least}")
        return found

    def coordinates(self, words: list[str]) -> tuple[float, ...]:
        try:
            found = tuple(float(word.upper().replace("D", "E")) for word in words)
        except ValueError:
            self.fail("three coordinates are expected")
        if len(found) != 3 or not np.isfinite(found).all():
            self.fail("three finite coordinates are expected")
        return found


def read_unv(name: str, lower_cells: bool = False) -> vtkUnstructuredGrid:
    """Read a mesh. Raises Error, with the line, for a damaged file and for elements that are not known.

    lower_cells: also cells of a lower dimension than the largest. The cell array `Reference` is the physical property,
    groups of elements are arrays of 0 and 1.
    """
    with open(name, encoding="latin-1") as file:
        texts = file.read().split("\n")
    places: dict[int, int] = {}
    points: list[tuple[float, ...]] = []
    elements: list[_Element] = []
    groups: list[tuple[str, set[int]]] = []
    others = 0
    for number, lines in _datasets(name, texts):
        if number in NODES or number == NODES_OF_ONE_LINE:
            _read_nodes(lines, number == NODES_OF_ONE_LINE, places, points)
        elif number in _ELEMENTS:
            others += _read_elements(lines, _ELEMENTS[number], elements)
        elif number in _GROUPS:
            groups += _read_groups(lines)
    if not points or not elements:
        raise Error(f"{name}: has no {'elements' if points else 'nodes'} (datasets 2411 and 2412)")
    for element in elements:
        missing = [node for node in element.nodes if node not in places]
        if missing:
            raise Error(f"{name}:{element.line}: element {element.label} uses node {missing[0]}, which does not exist")
    if others:
        warnings.warn(f"{name}: {others} springs, masses and rigid elements are left out", stacklevel=5)
    highest = max(element.dimension for element in elements)
    kept = [element for element in elements if lower_cells or element.dimension == highest]
    return _grid(np.array(points), kept, places, groups)


def _datasets(name: str, texts: list[str]) -> Iterator[tuple[str, _Lines]]:
    """The numbers and the lines of the datasets."""
    at = 0
    while at < len(texts):
        if texts[at].strip() != _END:
            if texts[at].strip():
                raise Error(f"{name}:{at + 1}: -1 is expected, which begins a dataset: this is no universal file")
            at += 1
            continue
        begin = at + 2
        end = begin
        while end < len(texts) and texts[end].strip() != _END:
            end += 1
        if end >= len(texts):
            raise Error(f"{name}:{len(texts)}: the file ends within a dataset: it is truncated")
        yield texts[at + 1].strip(), _Lines(name, texts, begin, end)
        at = end + 1


def _read_nodes(lines: _Lines, short: bool, places: dict[int, int], points: list[tuple[float, ...]]) -> None:
    while lines.more():
        if short:
            words = lines.next("a node").split()
            label, place = (int(words[0]) if words[0].isdigit() else 0), lines.coordinates(words[4:7])
        else:
            label = lines.whole("a node", 1)[0]
            place = lines.coordinates(lines.next("coordinates").split())
        if label < 1 or label in places:
            lines.fail(f"node {label} is given twice" if label in places else f"the number of a node is {label}")
        places[label] = len(points)
        points.append(place)


def _read_elements(lines: _Lines, place: int, elements: list[_Element]) -> int:
    """Append the elements of a dataset; returns the number of elements that are not cells."""
    others = 0
    while lines.more():
        head = lines.whole("an element", place + 1)
        line, kind, count = lines.at, head[1], head[place]
        if kind in _BEAMS:
            lines.next("the section of a beam")
        nodes: list[int] = []
        while len(nodes) < count:
            nodes += lines.whole("the nodes of an element", 1)
        if kind >= _FIRST_OTHER:
            others += 1
            continue
        if kind in _BEAMS:
            cell = {2: _LINE, 3: _LINE3}.get(count)
        else:
            cell = _FACES.get(count) if kind in _SHELLS else _SOLIDS.get(kind)
        if cell is None or not len(nodes) == count == len(cell[2]):
            lines.at = line
            lines.fail(f"elements with the descriptor {kind} and {count} nodes are not known; save it as .med or .msh")
        ordered = [nodes[i] for i in cell[2]]
        elements.append(_Element(line, head[0], cell[0], cell[1], head[_PROPERTY], ordered))
    return others


def _read_groups(lines: _Lines) -> list[tuple[str, set[int]]]:
    """The names and the numbers of elements of the groups that have elements."""
    found: list[tuple[str, set[int]]] = []
    while lines.more():
        count = lines.whole("a group", 8)[-1]
        title = lines.next("the name of a group").strip()
        values: list[int] = []
        while len(values) < 4 * count:
            values += lines.whole("the members of a group", 4)
        members = {tag for kind, tag in zip(values[::4], values[1::4]) if kind == _ELEMENT_ENTITY}
        if members:
            found.append((title or f"group {len(found) + 1}", members))
    return found


def _grid(xyz: Array, elements: list[_Element], places: dict[int, int], groups: list[tuple[str, set[int]]]) -> Any:
    grid, points, cells = vtkUnstructuredGrid(), vtkPoints(), vtkCellArray()
    points.SetData(numpy_to_vtk(xyz, deep=True))
    grid.SetPoints(points)
    offsets = np.cumsum([0, *(len(element.nodes) for element in elements)])
    ids = np.array([places[node] for element in elements for node in element.nodes], np.int64)
    cells.SetData(numpy_to_vtkIdTypeArray(offsets, deep=True), numpy_to_vtkIdTypeArray(ids, deep=True))
    grid.SetCells(numpy_to_vtk(np.array([element.kind for element in elements], np.uint8), deep=True), cells)
    arrays = [("Reference", np.array([element.reference for element in elements], np.int64))]
    labels = np.array([element.label for element in elements])
    arrays += [(title, np.isin(labels, list(members)).astype(np.uint8)) for title, members in groups]
    arrays = arrays[:1] + [(title, values) for title, values in arrays[1:] if values.any()]
    for title, values in arrays:
        array = numpy_to_vtk(values, deep=True)
        array.SetName(title)
        grid.GetCellData().AddArray(array)
    return grid
