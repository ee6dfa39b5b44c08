# SPDX-License-Identifier: BSD-3-Clause
"""Positions of the coordinates in binary files of Gmsh and Medit, and their replacement."""

from __future__ import annotations

import re
import struct
from dataclasses import dataclass

import numpy as np

from ._arrays import Array
from ._errors import Error

_DOUBLE = struct.calcsize("d")
_INT = struct.calcsize("i")
_SIZE = struct.calcsize("Q")
_GMSH, _MEDIT = (".msh", ".msh2", ".msh4"), ".meshb"
#: Versions of Gmsh's format with blocks of points, and with all numbers of a block first.
BLOCKS, NUMBERS_FIRST = 4.0, 4.1
_PARAMETRIC = "binary .msh with parametric nodes are not handled: save it without them, or as text"
#: Codes of sections of Medit.
_DIMENSION, _VERTICES, _END = 3, 4, 54


@dataclass(frozen=True)
class Runs:
    """Points in a file: their positions and numbers, run by run."""

    #: The byte of the first coordinate and the number of points of each run.
    runs: list[tuple[int, int]]
    #: Bytes from one point to the next.
    stride: int
    #: The type of a coordinate, and how many a point has.
    dtype: str = "<f8"
    dimension: int = 3


def changed(source: str, reason: str) -> Error:
    """The error for a file whose coordinates cannot be replaced."""
    return Error(f"{source}: its coordinates cannot be replaced: {reason}")


def check_equal(source: str, found: Array, before: Array) -> None:
    """Raise Error unless the coordinates in a file are the ones that were read from it."""
    wrong = (found != before).any(axis=1)
    if wrong.any():
        i = int(np.flatnonzero(wrong)[0])
        raise changed(source, f"point {i} is at {found[i].tolist()} in it and at {before[i].tolist()} as it is read")


def as_read(found: Array, old: Array) -> Array:
    """The coordinates of a file in single precision, if that is how they were read."""
    single = found.astype(np.float32).astype(float)
    return single if np.array_equal(single, old) else found


def coordinates_in(source: str, ending: str, content: bytes) -> Runs | None:
    """The points of a binary file; None for text. Raises Error for binary files that cannot be handled."""
    if ending in _GMSH:
        return _of_msh(source, content)
    return _of_meshb(source, content) if ending == _MEDIT else None


def with_coordinates(source: str, content: bytes, place: Runs, before: Array, after: Array) -> tuple[bytes, float]:
    """The content of a file with other coordinates, and the largest rounding of one. Raises Error, see rewrite()."""
    made = np.frombuffer(content, np.uint8).copy()
    count = sum(number for _, number in place.runs)
    if count != len(before):
        raise changed(source, f"it has {count} points and the mesh {len(before)}")
    out = np.flatnonzero((after[:, place.dimension :] != 0).any(axis=1))
    if len(out):
        raise Error(f"{source}: point {out[0]} leaves the plane of the file, which has no z coordinates")
    size = np.dtype(place.dtype).itemsize * place.dimension
    first, rounding = 0, 0.0
    for at, number in place.runs:
        rows = np.arange(number)[:, None] * place.stride + at + np.arange(size)[None]
        old, new = (coordinates[first : first + number] for coordinates in (before, after))
        found = np.zeros_like(old)
        found[:, : place.dimension] = np.ascontiguousarray(made[rows]).view(place.dtype)
        check_equal(source, as_read(found, old), old)
        new = np.where(new == old, found, new)  # unmoved coordinates stay as they are in the file
        with np.errstate(over="ignore"):
            numbers = np.ascontiguousarray(new[:, : place.dimension], place.dtype)
        if not np.isfinite(numbers).all():
            raise changed(source, "a coordinate is too large for its numbers, which have 4 bytes")
        if number:
            rounding = max(rounding, float(np.abs(numbers - new[:, : place.dimension]).max()))
        made[rows] = numbers.view(np.uint8).reshape(number, size)
        first += number
    return made.tobytes(), rounding


def _of_msh(source: str, content: bytes) -> Runs | None:
    head = re.match(rb"\$MeshFormat\s+(\S+) +1 +8", content)
    if not head:
        return None
    if b"\n$ParametricNodes" in content:
        raise changed(source, _PARAMETRIC)
    section = re.search(rb"\n\$Nodes\s*\n", content)
    version = float(head[1])
    one = content[content.index(b"\n", head.end()) + 1 :][:4]
    if not section or one != struct.pack("<i", 1) or not (version < BLOCKS or version >= NUMBERS_FIRST):
        raise changed(source, "binary .msh are handled in versions 2 and 4.1, of this machine's order of bytes")
    at = section.end()
    if version < BLOCKS:
        count = int(content[at : content.index(b"\n", at)])
        return Runs([(content.index(b"\n", at) + 1 + _INT, count)], _INT + 3 * _DOUBLE)
    runs = []
    blocks = struct.unpack_from("<Q", content, at)[0]
    at += 4 * _SIZE
    for _ in range(blocks):
        dimension, _, parametric = struct.unpack_from("<3i", content, at)
        count = struct.unpack_from("<Q", content, at + 3 * _INT)[0]
        if parametric and dimension:
            raise changed(source, _PARAMETRIC)
        at += 3 * _INT + _SIZE + count * _SIZE
        runs.append((at, count))
        at += 3 * _DOUBLE * count
    return Runs(runs, 3 * _DOUBLE)


def _of_meshb(source: str, content: bytes) -> Runs:
    """The reader has accepted the file: its sections are at the positions in its table."""
    order = "<" if content[:_INT] == struct.pack("<i", 1) else ">"
    version = struct.unpack_from(f"{order}i", content, _INT)[0]
    whole, position = ("q" if version >= least else "i" for least in (4, 3))
    real = f"{order}f{4 if version == 1 else _DOUBLE}"
    at, dimension = 2 * _INT, 3
    while at < len(content):
        code, following = struct.unpack_from(f"{order}i{position}", content, at)
        at += struct.calcsize(f"{order}i{position}")
        if code == _DIMENSION:
            dimension = struct.unpack_from(f"{order}i", content, at)[0]
        elif code == _VERTICES:
            count = struct.unpack_from(f"{order}{whole}", content, at)[0]
            integer = struct.calcsize(f"{order}{whole}")
            stride = dimension * np.dtype(real).itemsize + integer
            return Runs([(at + integer, count)], stride, real, dimension)
        if code == _END or not following:
            break
        at = following
    raise changed(source, "it has no vertices")
