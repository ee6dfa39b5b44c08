# SPDX-License-Identifier: BSD-3-Clause
"""Decks of Nastran: points in large fields, linear and quadratic elements, their properties by Reference."""

from __future__ import annotations

from typing import Iterator

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataSet

from ._arrays import Array
from ._deck_numbers import LARGE_FIELD, SMALL_FIELD, nastran_number
from ._errors import Error
from ._files import replace_text

NASTRAN_ENDINGS = (".bdf", ".nas", ".fem")
#: VTK's types: the card, and the places of VTK's nodes in the order of the card, None where these are the same.
#: Nastran's wedges list a triangle in the opposite order; edges along the axis come before the edges of the second
#: face.
_WEDGE = (0, 2, 1, 3, 5, 4)
_CARDS: dict[int, tuple[str, tuple[int, ...] | None]] = {
    3: ("CROD", None), 5: ("CTRIA3", None), 22: ("CTRIA6", None), 9: ("CQUAD4", None), 23: ("CQUAD8", None),
    10: ("CTETRA", None), 24: ("CTETRA", None), 12: ("CHEXA", None), 14: ("CPYRAM", None), 27: ("CPYRAM", None),
    25: ("CHEXA", (*range(12), *range(16, 20), *range(12, 16))),
    13: ("CPENTA", _WEDGE), 26: ("CPENTA", (*_WEDGE, 8, 7, 6, 12, 14, 13, 11, 10, 9)),
}  # fmt: skip
_FIELDS = 8  # of a line, beside the name of the card
_LARGEST = 10**SMALL_FIELD - 1


def write_nastran(mesh: vtkDataSet, name: str) -> list[str]:
    """Write a deck with the points and elements of a mesh. Raises Error for cells that Nastran does not have."""
    count = mesh.GetNumberOfPoints()
    if max(count, mesh.GetNumberOfCells()) > _LARGEST:
        raise Error(f"{name}: Nastran's numbers of points and elements have {SMALL_FIELD} digits; write .vtu or .msh")
    replace_text(name, "\n".join(["BEGIN BULK", *_points(mesh), *_elements(mesh, name), "ENDDATA"]) + "\n")
    return [name]


def _points(mesh: vtkDataSet) -> Iterator[str]:
    for i in range(mesh.GetNumberOfPoints()):
        x, y, z = (nastran_number(value + 0.0, LARGE_FIELD) for value in mesh.GetPoint(i))
        yield f"GRID*   {i + 1:<{LARGE_FIELD}}{'':{LARGE_FIELD}}{x}{y}"
        yield f"*       {z}"


def _elements(mesh: vtkDataSet, name: str) -> Iterator[str]:
    references = _references(mesh)
    for cell in range(mesh.GetNumberOfCells()):
        kind, ids = mesh.GetCellType(cell), mesh.GetCell(cell).GetPointIds()
        if kind not in _CARDS:
            raise Error(f"{name}: Nastran has no cells of VTK's type {kind} (cell {cell}); write .vtu or .msh")
        card, order = _CARDS[kind]
        places = order or range(ids.GetNumberOfIds())
        fields = [cell + 1, references[cell], *(ids.GetId(i) + 1 for i in places)]
        for first in range(0, len(fields), _FIELDS):
            row = "".join(f"{field:<{SMALL_FIELD}}" for field in fields[first : first + _FIELDS])
            yield f"{card if first == 0 else '+':<{SMALL_FIELD}}{row}".rstrip()


def _references(mesh: vtkDataSet) -> Array:
    """The number of the property of each cell: its Reference if that is valid, otherwise 1."""
    found = mesh.GetCellData().GetArray("Reference")
    if found is None or found.GetNumberOfComponents() != 1:
        return np.ones(mesh.GetNumberOfCells(), int)
    values = vtk_to_numpy(found).astype(float)
    return np.where((values >= 1) & (values <= _LARGEST), values, 1).astype(int)
