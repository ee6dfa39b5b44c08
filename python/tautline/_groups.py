# SPDX-License-Identifier: BSD-3-Clause
"""Sets of cells by name: cell arrays of 0 and 1, element sets of Abaqus, groups of MED."""

from __future__ import annotations

import re
from typing import Any, Mapping

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet, vtkDataObject, vtkDataSet

from ._arrays import Array, leaves
from ._errors import Error

#: Sets of cells: numbers of cells from 0, or a mask of one value per cell, by name.
Groups = Mapping[str, Any]

_LINE = 8  # numbers in a line of an element set; Abaqus takes 16
_NAME = re.compile(r"\W+", re.ASCII)  # characters that names of Abaqus do not have
_LONGEST_NAME = 80  # of Abaqus and MED


def masks(groups: Groups, cells: int) -> dict[str, Array]:
    """Per group 1 for its cells, otherwise 0. Raises Error for a wrong name or number."""
    if not isinstance(groups, Mapping):
        raise Error(f"groups is {groups!r}; a dict of numbers of cells, or masks, by name is expected")
    return {_checked_name(name): _mask(name, members, cells) for name, members in groups.items()}


def _checked_name(name: Any) -> str:
    if not isinstance(name, str) or not name.strip() or len(name) > _LONGEST_NAME:
        raise Error(f"the name of a group is {name!r}; a text of 1 to {_LONGEST_NAME} characters is expected")
    return name


def _mask(name: str, members: Any, cells: int) -> Array:
    try:
        ids = np.asarray(members)
    except ValueError as error:
        raise Error(f"the group '{name}' is no array of numbers: {error}") from None
    if ids.dtype == bool:
        if ids.shape != (cells,):
            raise Error(f"the group '{name}' is a mask of {ids.size} values; the mesh has {cells} cells")
        return ids.astype(np.uint8)
    ids = ids.astype(np.int64) if ids.size == 0 else ids
    if ids.ndim != 1 or not np.issubdtype(ids.dtype, np.integer):
        raise Error(f"the group '{name}' is no list of numbers of cells")
    if ids.size and (ids.min() < 0 or ids.max() >= cells):
        raise Error(f"the group '{name}' has the cells {ids.min()} to {ids.max()}; there are 0 to {cells - 1}")
    mask = np.zeros(cells, np.uint8)
    mask[ids] = 1
    return mask


def with_groups(data: vtkDataObject, groups: Groups) -> vtkDataObject:
    """A copy of a mesh that shares its arrays, and has a cell array of 0 and 1 for each group.

    The cells of composite data are numbered through its blocks.
    """
    made = data.NewInstance()
    if isinstance(data, vtkCompositeDataSet):
        made.RecursiveShallowCopy(data)
    else:
        made.ShallowCopy(data)
    parts: list[vtkDataSet] = list(leaves(made))
    ends = np.cumsum([part.GetNumberOfCells() for part in parts])
    for name, mask in masks(groups, int(ends[-1]) if parts else 0).items():
        for part, values in zip(parts, np.split(mask, ends[:-1])):
            array = numpy_to_vtk(values, deep=True)
            array.SetName(name)
            part.GetCellData().AddArray(array)
    return made


def element_sets(groups: Mapping[str, Array]) -> str:
    """The sets in Abaqus's form, with cells numbered from 1; a set without cells is left out."""
    parts = []
    for name, mask in groups.items():
        numbers = [str(i) for i in np.flatnonzero(mask) + 1]
        if numbers:
            rows = [", ".join(numbers[i : i + _LINE]) for i in range(0, len(numbers), _LINE)]
            parts.append(f"*ELSET, ELSET={_NAME.sub('_', name)}\n" + ",\n".join(rows) + "\n")
    return "".join(parts)


def families(groups: Mapping[str, Array], cells: int) -> tuple[Array, dict[int, list[str]]]:
    """MED's families: per cell the number of its combination of groups (0: none), and their names by that number."""
    if not groups:
        return np.zeros(cells, np.int64), {}
    rows = np.array(list(groups.values()))
    combinations, of_cell = np.unique(rows, axis=1, return_inverse=True)
    numbers = np.zeros(combinations.shape[1], np.int64)
    names: dict[int, list[str]] = {}
    for i, column in enumerate(combinations.T):
        if column.any():
            numbers[i] = -len(names) - 1  # families of cells are below 0
            names[int(numbers[i])] = [name for name, member in zip(groups, column) if member]
    return numbers[of_cell.ravel()], names


def members_of(tags: Array, names: Mapping[int, list[str]]) -> dict[str, Array]:
    """The inverse of families(): per group 1 for its cells, otherwise 0."""
    found: dict[str, Array] = {}
    for number, groups in names.items():
        for group in groups:
            found[group] = np.maximum(found.get(group, np.uint8(0)), (tags == number).astype(np.uint8))
    return found
