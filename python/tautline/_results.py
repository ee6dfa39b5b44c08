# SPDX-License-Identifier: BSD-3-Clause
"""The base of all results: printing, copies, pickle, comparison, tables."""

from __future__ import annotations

import copy
from dataclasses import fields
from html import escape
from os import PathLike
from textwrap import shorten
from typing import TYPE_CHECKING, Any, Callable, ClassVar

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import (
    vtkCompositeDataSet,
    vtkDataObject,
    vtkDataSet,
    vtkTable,
)

from ._arrays import Array, cell_types, leaves, table_rows
from ._errors import Error
from ._files import file_name, replace_text
from ._packing import Packed
from ._pictures import picture_html
from ._tables import csv_text, json_text
from ._views import MeshViews, NamedDict, cell_data_of, cells_of, point_data_of, points_of, viewed

_MAX_WIDTH = 110  # characters of a line that is printed
_SUMMARY_LINES = 3
#: Attributes of the mesh that a result also has, unless it has a field of this name.
_VIEWS: dict[str, Callable[[Any], Any]] = {
    "points": points_of, "cells": cells_of, "point_data": point_data_of, "cell_data": cell_data_of,
}  # fmt: skip
_TIMES = "seconds"  # suffix of measured times, which differ from run to run


class Result:
    """The return value of a function. It prints in five lines, and in a notebook with a picture of the mesh.

    A result with a mesh has the numpy arrays of it: points, n x 3; cells, m x k by the name of the cell; point_data and
    cell_data, by the name of the array. They share memory with the mesh.

    copy.copy() shares meshes and arrays, copy.deepcopy() and pickle do not. Two results are equal if all their fields
    are equal, apart from measured times and the summary.
    """

    #: Fields with an array per point or cell, which to_dict() leaves out.
    _per_element: ClassVar[tuple[str, ...]] = ()

    if TYPE_CHECKING:
        # Not for results that have fields of these names.
        points: Any
        cells: Any
        point_data: Any
        cell_data: Any
    else:

        def __getattr__(self, name: str) -> Any:
            """The arrays of the mesh; see _VIEWS. Fields are found before this is called."""
            data = self.__dict__.get("mesh")
            if name not in _VIEWS or data is None:
                raise AttributeError(f"'{type(self).__name__}' object has no attribute '{name}'")
            if not isinstance(data, vtkDataSet):
                raise Error(f"a {data.GetClassName()} has no {name} of its own; take one of its blocks")
            return getattr(data, name) if isinstance(data, MeshViews) else _VIEWS[name](data)

        def __dir__(self) -> list[str]:
            return sorted({*super().__dir__(), *(_VIEWS if "mesh" in self.__dict__ else ())})

    def __repr__(self) -> str:
        lines = [type(self).__name__ + (f": {_size(data)}" if (data := getattr(self, "mesh", None)) else "")]
        words = [line.strip() for line in str(getattr(self, "summary", "")).splitlines() if line.strip()]
        lines += words[:_SUMMARY_LINES]
        if len(words) > _SUMMARY_LINES:
            lines[-1] += " ..."
        lines.append("fields: " + ", ".join(field.name for field in _fields(self)))
        return "\n".join(shorten(line, _MAX_WIDTH, placeholder=" ...") for line in lines)

    def _repr_html_(self) -> str:
        """For notebooks: a picture of the mesh beside the text."""
        text = f"<pre>{escape(repr(self))}</pre>"
        data = getattr(self, "mesh", None)
        return text + (picture_html(data) if data else "")

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return all(
            _equal(field.name, getattr(self, field.name), getattr(other, field.name))
            for field in _fields(self)
            if field.name != "summary"
        )

    __hash__ = None  # type: ignore[assignment]

    def __deepcopy__(self, memo: dict[int, Any]) -> Result:
        made = object.__new__(type(self))
        made.__dict__.update({name: _deep(value, memo) for name, value in self.__dict__.items()})
        return made

    def __getstate__(self) -> dict[str, Any]:
        return {name: _pack(value) for name, value in self.__dict__.items()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update({name: _unpack(value) for name, value in state.items()})

    def __copy__(self) -> Result:
        made = object.__new__(type(self))
        made.__dict__.update(self.__dict__)
        return made

    def table(self) -> list[dict[str, Any]]:
        """The main table as a list of rows, each a dict, as --csv writes it. Raises Error if there is none."""
        for name in ("rows", "spectrum"):
            if isinstance(found := getattr(self, name, None), list):
                return found
        if found := getattr(self, "history", None):
            return table_rows(found)
        raise Error(f"a {type(self).__name__} has no table")

    def to_dict(self) -> dict[str, Any]:
        """The fields as numbers, texts, lists and dicts, without meshes and arrays per point or cell."""
        names = [field.name for field in _fields(self) if field.name not in self._per_element]
        values = {name: getattr(self, name) for name in names}
        return {name: _plain(value) for name, value in values.items() if not isinstance(value, vtkDataObject)}

    def to_json(self, file: str | PathLike[str] | None = None) -> str:
        """to_dict() as JSON; `file`, if given, is replaced by it. Numbers that are not finite are texts."""
        text = json_text(self.to_dict())
        if file is not None:
            replace_text(file, text + "\n")
        return text

    def to_csv(self, file: str | PathLike[str]) -> None:
        """Replace a file by the table() as CSV, with numbers in full precision."""
        replace_text(file_name(file), csv_text(self.table()))

    def to_pandas(self) -> Any:
        """The table() as a DataFrame of pandas. Raises Error if pandas is not installed."""
        try:
            import pandas
        except ImportError:
            raise Error("pandas is not installed (Debian: apt-get install python3-pandas)") from None
        return pandas.DataFrame(self.table())


def _fields(result: Any) -> tuple[Any, ...]:
    return fields(result)  # of the dataclass that is derived from Result


def _size(data: vtkDataObject) -> str:
    if isinstance(data, (vtkDataSet, vtkCompositeDataSet)):
        return f"{data.GetClassName()}, {data.GetNumberOfPoints()} points, {data.GetNumberOfCells()} cells"
    return str(data.GetClassName())


def _map(value: Any, function: Any) -> Any:
    """A function on the values in dicts, lists and tuples."""
    if isinstance(value, dict):
        made = {key: function(inner) for key, inner in value.items()}
        return value.like(made) if isinstance(value, NamedDict) else made
    if isinstance(value, (list, tuple)):
        return type(value)(function(inner) for inner in value)
    return None


def _pack(value: Any) -> Any:
    if isinstance(value, vtkDataObject):
        return Packed(value)
    inner = _map(value, _pack)
    return np.array(value) if isinstance(value, np.ndarray) else value if inner is None else inner


def _unpack(value: Any) -> Any:
    if isinstance(value, Packed):
        return value.data()
    inner = _map(value, _unpack)
    return value if inner is None else inner


def _deep(value: Any, memo: dict[int, Any]) -> Any:
    if isinstance(value, vtkDataObject):
        made = value.NewInstance()
        made.DeepCopy(value)
        return viewed(made)
    inner = _map(value, lambda part: _deep(part, memo))
    return copy.deepcopy(value, memo) if inner is None else inner


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {str(key): _plain(inner) for key, inner in value.items() if not isinstance(inner, vtkDataObject)}
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    return [_plain(inner) for inner in value] if isinstance(value, (list, tuple)) else value


def _equal(name: str, one: Any, other: Any) -> bool:
    if name.endswith(_TIMES):
        return True
    if isinstance(one, vtkDataObject):
        return isinstance(other, vtkDataObject) and _same_data(one, other)
    if isinstance(one, dict):
        same = isinstance(other, dict) and list(one) == list(other)
        return same and all(_equal(str(key), one[key], other[key]) for key in one)
    if isinstance(one, (list, tuple)):
        same = type(one) is type(other) and len(one) == len(other)
        return same and all(_equal("", *pair) for pair in zip(one, other))
    return _same_values(one, other)


def _same_values(one: Any, other: Any) -> bool:
    a, b = np.asarray(one), np.asarray(other)
    if a.shape != b.shape or a.dtype.kind != b.dtype.kind:
        return False
    return bool(np.array_equal(a, b, equal_nan=a.dtype.kind == "f"))


def _same_data(one: vtkDataObject, other: vtkDataObject) -> bool:
    """Whether two data objects are of one class and have the same points, cells and arrays."""
    if one.GetClassName() != other.GetClassName():
        return False
    if isinstance(one, vtkTable):
        return _same_arrays(one.GetRowData(), other.GetRowData())
    parts, others = list(leaves(one)), list(leaves(other))
    return len(parts) == len(others) and all(map(_same_leaf, parts, others))


def _same_leaf(one: vtkDataSet, other: vtkDataSet) -> bool:
    return (
        one.GetClassName() == other.GetClassName()
        and _grid_facts(one) == _grid_facts(other)
        and all(_same_values(a, b) for a, b in zip(_geometry(one), _geometry(other)))
        and _same_arrays(one.GetPointData(), other.GetPointData())
        and _same_arrays(one.GetCellData(), other.GetCellData())
    )


def _grid_facts(data: vtkDataSet) -> list[Any]:
    """Numbers of points and cells and, of an image, its grid."""
    facts = [data.GetNumberOfPoints(), data.GetNumberOfCells()]
    for name in ("GetExtent", "GetSpacing", "GetOrigin"):
        facts += list(getattr(data, name)()) if hasattr(data, name) else []
    return facts


def _geometry(data: vtkDataSet) -> list[Array]:
    """Coordinates, and types, offsets and corners of the cells."""
    found = [_numbers(data.GetPoints().GetData())] if hasattr(data, "GetPoints") and data.GetPoints() else []
    names = ("GetCells",) if hasattr(data, "GetCellTypesArray") else ("GetVerts", "GetLines", "GetPolys", "GetStrips")
    for name in names:
        cells = getattr(data, name)() if hasattr(data, name) else None
        if cells and not hasattr(cells, "GetOffsetsArray"):  # structured grid, since VTK 9.3: the extent is enough
            return found
        if cells:
            found += [_numbers(cells.GetOffsetsArray()), _numbers(cells.GetConnectivityArray())]
    if hasattr(data, "GetCellTypesArray") and cell_types(data):
        found.append(_numbers(cell_types(data)))
    return found


def _numbers(array: Any) -> Array:
    return np.asarray(vtk_to_numpy(array))


def _same_arrays(one: Any, other: Any) -> bool:
    names = [one.GetArrayName(i) for i in range(one.GetNumberOfArrays())]
    if sorted(map(str, names)) != sorted(str(other.GetArrayName(i)) for i in range(other.GetNumberOfArrays())):
        return False
    pairs = [(str(name), one.GetAbstractArray(name), other.GetAbstractArray(name)) for name in names]
    return all(_equal(name.split(" (")[0].replace("Time", _TIMES), _values(a), _values(b)) for name, a, b in pairs)


def _values(array: Any) -> Any:
    if array.IsA("vtkDataArray"):
        return _numbers(array)
    return [str(array.GetVariantValue(i)) for i in range(array.GetNumberOfValues())]
