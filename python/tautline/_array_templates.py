# SPDX-License-Identifier: BSD-3-Clause
"""Files of arrays, HDF5 and netCDF, with other coordinates: Salome MED, MOAB, CGNS and Exodus.

The file is copied, and the arrays of coordinates are replaced in the copy: groups, families, boundary conditions and
results stay. HDF5 needs h5py; the older kind of netCDF files, which most Exodus files are, is handled here.
"""

from __future__ import annotations

import shutil
import struct
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from typing import Any, Callable, Iterator

import numpy as np

from ._arrays import Array
from ._binary_coordinates import as_read, changed, check_equal
from ._errors import Error
from ._files import replacing_by_name
from ._vtk_readers import ADF, EXODUS_ENDINGS

HDF5_PACKAGE = "h5py (Debian: apt-get install python3-h5py)"
_ADF_CONVERTER = "adf2hdf (Debian: apt-get install cgns-convert)"
_MED, _CGNS, _MOAB = ".med", ".cgns", ".h5m"
#: The formats whose files can be templates here.
ARRAY_TEMPLATES = (_MED, _CGNS, _MOAB, *EXODUS_ENDINGS)
_NETCDF = b"CDF"
_AXES = "xyz"


class _Column:
    """Coordinates of points along one axis, as they are in a file: a slice of an array of HDF5."""

    def __init__(self, data: Any, part: Any = Ellipsis) -> None:
        self._data, self._part = data, part

    def read(self) -> Array:
        """The numbers, one after the other."""
        return np.asarray(self._data[self._part], float).ravel()

    def write(self, values: Array) -> Array:
        """Replace the numbers; returns what is read afterwards."""
        old = self._data[self._part]
        self._data[self._part] = values.reshape(np.shape(old)).astype(old.dtype)
        return self.read()


class _NetcdfColumn(_Column):
    """Big-endian numbers of a netCDF file of the older kind, starting at a byte."""

    def __init__(self, file: Any, begin: int, count: int, dtype: str) -> None:
        self._file, self._begin, self._count, self._dtype = file, begin, count, np.dtype(dtype)

    def read(self) -> Array:
        self._file.seek(self._begin)
        content = self._file.read(self._count * self._dtype.itemsize)
        return np.frombuffer(content, self._dtype).astype(float)

    def write(self, values: Array) -> Array:
        self._file.seek(self._begin)
        self._file.write(values.astype(self._dtype).tobytes())
        return self.read()


#: The coordinates of each part of a mesh: a column for each axis.
_Parts = list[list[_Column]]


def rewrite_arrays(source: str, target: str, ending: str, before: list[Array], after: list[Array]) -> float:
    """Write the file `source` as `target` with other coordinates; see rewrite() in _template.

    before, after: the points of each block of the mesh. Blocks of Exodus share the points of the file.
    """
    with open(source, "rb") as file:
        head = file.read(len(ADF))
    older_netcdf = head.startswith(_NETCDF)
    if head == ADF:
        raise changed(source, f"it is CGNS of the older kind, ADF: convert it with {_ADF_CONVERTER}")
    if not older_netcdf and find_spec("h5py") is None:
        raise Error(f"{target}: the file {source} is copied with {HDF5_PACKAGE}, which is not installed")
    with replacing_by_name(target) as temporary:
        shutil.copyfile(source, temporary)
        if older_netcdf:
            with open(temporary, "r+b") as handle:
                return _replace(source, _netcdf_parts(source, handle), before, after)
        try:
            with import_module("h5py").File(temporary, "r+") as handle:
                return _replace(source, _FINDERS[ending](source, handle), before, after)
        except (OSError, KeyError, RuntimeError) as error:
            raise changed(source, f"h5py: {error}") from None


def _replace(source: str, parts: _Parts, before: list[Array], after: list[Array]) -> float:
    if len(parts) == 1 < len(before):
        before, after = [before[0]], [_combined(source, before, after)]
    if len(parts) != len(before):
        raise changed(source, f"it has {len(parts)} parts with points and the mesh {len(before)}")
    found = []
    for columns, old in zip(parts, before):  # check everything before anything is written
        values = [column.read() for column in columns]
        if any(len(value) != len(old) for value in values):
            raise changed(source, f"it has {len(values[0])} points and the mesh {len(old)}")
        found.append(np.stack([*values, *[np.zeros(len(old))] * (3 - len(values))], axis=1))
        check_equal(source, as_read(found[-1], old), old)
    rounding = 0.0
    for columns, old, new, numbers in zip(parts, before, after, found):
        if new[:, len(columns) :].any():
            raise Error(f"{source}: the mesh leaves the plane of the file, which has no z coordinates")
        for axis, column in enumerate(columns):
            moved = new[:, axis] != old[:, axis]
            if moved.any():
                with np.errstate(over="ignore"):
                    written = column.write(np.where(moved, new[:, axis], numbers[:, axis]))
                if not np.isfinite(written).all():
                    raise changed(source, "a coordinate is too large for its numbers, which have 4 bytes")
                rounding = max(rounding, float(np.abs(written - new[:, axis])[moved].max()))
    return rounding


def _combined(source: str, before: list[Array], after: list[Array]) -> Array:
    """The points of a file, of which every block has a full copy; a point moves with the blocks that use it."""
    made = after[0].copy()
    moved = (after[0] != before[0]).any(axis=1)
    for old, new in zip(before[1:], after[1:]):
        if not np.array_equal(old, before[0]):
            raise changed(source, "its blocks do not have the same points")
        own = (new != old).any(axis=1)
        both = moved & own & (new != made).any(axis=1)
        if both.any():
            raise changed(source, f"two blocks move point {int(np.flatnonzero(both)[0])} to different places")
        made[own] = new[own]
        moved |= own
    return made


# --- where the coordinates are, by format -------------------------------------------------------------------------


def _in_med(source: str, file: Any) -> _Parts:
    """ENS_MAA/mesh/step/NOE/COO: all x, then all y, then all z."""
    meshes = file["ENS_MAA"]
    if len(meshes) != 1:
        raise changed(source, f"it has {len(meshes)} meshes: save the one to move in a file of its own")
    mesh = meshes[next(iter(meshes))]
    step = mesh if "NOE" in mesh else mesh[next(iter(mesh))]
    coordinates = step["NOE"]["COO"]
    axes = int(mesh.attrs["ESP"])
    count = len(coordinates) // axes
    return [[_Column(coordinates, slice(k * count, (k + 1) * count)) for k in range(axes)]]


def _labeled(group: Any, label: str) -> Iterator[Any]:
    """The nodes of CGNS with a label, below another node."""
    for name in group:
        attributes = getattr(group[name], "attrs", {})
        if bytes(attributes.get("label", b"")).rstrip(b"\0 ").decode("latin-1") == label:
            yield group[name]


def _in_cgns(source: str, file: Any) -> _Parts:
    """Zones with Cartesian coordinates, in the order of the blocks that VTK reads."""
    parts: _Parts = []
    for base in _labeled(file, "CGNSBase_t"):
        for zone in _labeled(base, "Zone_t"):
            for grid in list(_labeled(zone, "GridCoordinates_t"))[:1]:
                names = [f"Coordinate{axis.upper()}" for axis in _AXES if f"Coordinate{axis.upper()}" in grid]
                if not names:
                    raise changed(source, "its coordinates are not Cartesian")
                parts.append([_Column(grid[name][" data"]) for name in names])
    return parts


def _in_moab(_: str, file: Any) -> _Parts:
    coordinates = file["tstt"]["nodes"]["coordinates"]
    return [[_Column(coordinates, (slice(None), k)) for k in range(coordinates.shape[1])]]


def _in_exodus(source: str, file: Any) -> _Parts:
    """coordx, coordy, coordz, or coord with a row for each axis."""
    if "coord" in file:
        return [[_Column(file["coord"], k) for k in range(len(file["coord"]))]]
    columns = [_Column(file[f"coord{axis}"]) for axis in _AXES if f"coord{axis}" in file]
    if not columns:
        raise changed(source, "it has no coordinates")
    return [columns]


_FINDERS: dict[str, Callable[[str, Any], _Parts]] = {
    _MED: _in_med,
    _CGNS: _in_cgns,
    _MOAB: _in_moab,
    **dict.fromkeys(EXODUS_ENDINGS, _in_exodus),
}


@dataclass
class _Header:
    """The header of a netCDF file of the older kind, read from front to back."""

    content: bytes
    at: int
    #: Whether counts and places of arrays have eight bytes.
    wide_counts: bool
    wide_places: bool

    def number(self, wide: bool = False) -> int:
        (value,) = struct.unpack_from(">Q" if wide else ">I", self.content, self.at)
        self.at += 8 if wide else 4
        return int(value)

    def count(self) -> int:
        return self.number(self.wide_counts)

    def skip(self, size: int) -> bytes:
        """Bytes that fill words of four."""
        found = self.content[self.at : self.at + size]
        self.at += -(-size // 4) * 4
        return found

    def name(self) -> str:
        return self.skip(self.count()).decode("latin-1")

    def entries(self) -> int:
        self.number()  # the kind of the list, 0 if it is absent
        return self.count()

    def skip_attributes(self) -> None:
        for _ in range(self.entries()):
            self.name()
            size = _SIZES[self.number()]
            self.skip(size * self.count())


#: Bytes of the types of netCDF, by their numbers; types of coordinates.
_SIZES = {1: 1, 2: 1, 3: 2, 4: 4, 5: 4, 6: 8, 7: 1, 8: 2, 9: 4, 10: 8, 11: 8}
_REALS = {5: ">f4", 6: ">f8"}
_WIDE_PLACES, _WIDE_COUNTS = 2, 5  # versions


def _netcdf_parts(source: str, file: Any) -> _Parts:
    try:
        return _in_netcdf(source, file)
    except (struct.error, KeyError, IndexError, ValueError):
        raise changed(source, "its header is damaged") from None


def _in_netcdf(source: str, file: Any) -> _Parts:
    """Exodus in a netCDF file of the older kind: the arrays of coordinates by the header."""
    content = file.read()
    version = content[len(_NETCDF)]
    header = _Header(content, len(_NETCDF) + 1, version >= _WIDE_COUNTS, version >= _WIDE_PLACES)
    header.count()  # of records
    sizes = []
    for _ in range(header.entries()):
        header.name()
        sizes.append(header.count())
    header.skip_attributes()
    found: dict[str, tuple[int, list[int], str]] = {}
    for _ in range(header.entries()):
        name = header.name()
        shape = [sizes[header.count()] for _ in range(header.count())]
        header.skip_attributes()
        kind = header.number()
        header.count()  # bytes
        begin = header.number(header.wide_places)
        if name in ("coord", *(f"coord{axis}" for axis in _AXES)):
            found[name] = begin, shape, _REALS[kind]
    if "coord" in found:
        begin, (axes, count), dtype = found["coord"]
        size = count * np.dtype(dtype).itemsize
        return [[_NetcdfColumn(file, begin + k * size, count, dtype) for k in range(axes)]]
    columns: list[_Column] = []
    for name in sorted(found):
        begin, (count,), dtype = found[name]
        columns.append(_NetcdfColumn(file, begin, count, dtype))
    if not columns:
        raise changed(source, "it has no coordinates")
    return [columns]
