# SPDX-License-Identifier: BSD-3-Clause
"""A mesh file with other coordinates: everything else stays as it is, byte by byte.

Markers, sets, materials, types of elements and comments of a solver's file are not in the mesh that is read from it.
After a motion of points, the file is copied and only its coordinates are replaced, in the format of its numbers.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Callable, Iterator

import numpy as np

from ._arrays import Array
from ._binary_coordinates import (
    BLOCKS,
    NUMBERS_FIRST,
    as_read,
    changed,
    check_equal,
    coordinates_in,
    with_coordinates,
)
from ._deck_numbers import LARGE_FIELD, SMALL_FIELD, WIDEST, deck_number, nastran_number
from ._deck_numbers import value_of as _value
from ._errors import Error
from ._files import replace_bytes
from ._unv import NODES, NODES_OF_ONE_LINE

#: Begin and end of each coordinate in the text; the three of a point one after the other, missing ones (z) left out.
_Span = tuple[int, int]
_TOKEN = re.compile(rb"\S+")
_NUMBER = re.compile(rb"([+-]?)(\d*)(\.?)(\d*)(?:([eEdD])([+-]?)(\d+))?")
_OTHER_SYSTEM = re.compile(rb"^CORD[123][RCS]", re.MULTILINE | re.IGNORECASE)
_PLACED = re.compile(rb"^\*(INSTANCE|SYSTEM)\b", re.MULTILINE | re.IGNORECASE)
#: Numbers keep the number of digits that they have in the file if it is fixed and at least this.
_FEWEST_DIGITS = 8
_UNV_SHORT, _UNV_HEAD = NODES_OF_ONE_LINE.encode(), 4  # numbers before the coordinates
_UNV_NODES = (*(number.encode() for number in NODES), _UNV_SHORT)
_VOLUME = 3  # dimension of an entity without parametric coordinates
_GRID_FIELD, _LARGE_GRID_FIELD = 24, 40  # where x begins


def rewrite(source: str, target: str, before: Array, after: Array) -> float:
    """Write the file `source` as `target` with other coordinates.

    before: the coordinates of the points as the reader of the format gives them, n x 3. after: the new ones. Returns
    the largest rounding of a coordinate by the fields of the file. Raises Error if the coordinates in the file are not
    `before`, and for a format that cannot be handled this way; then no file is written.
    """
    ending = Path(source).suffix.lower()
    content, rounding = rewritten(source, ending, Path(source).read_bytes(), before, after)
    replace_bytes(target, content)
    return rounding


def rewritten(source: str, ending: str, content: bytes, before: Array, after: Array) -> tuple[bytes, float]:
    """The content of a file of the format `ending` with other coordinates, and the largest rounding; see rewrite()."""
    if (place := coordinates_in(source, ending, content)) is not None:
        return with_coordinates(source, content, place, before, after)
    try:
        spans = list(LOCATORS[ending](content))
    except (RuntimeError, ValueError, IndexError):  # a generator ends where tokens are missing
        raise changed(source, "the section of the points is damaged") from None
    nastran = ending in _NASTRAN
    numbers = [[content[a:b] for a, b in point] for point in spans]
    try:
        _check(source, numbers, before)
    except Error as error:
        if reason := _other_coordinates(ending, content):
            raise changed(source, reason) from None
        raise error from None
    layout = None if nastran else _layout([text for point in numbers for text in point])
    parts: list[bytes] = []
    at, rounding = 0, 0.0
    for i in np.flatnonzero((before != after).any(axis=1)):
        if after[i, len(spans[i]) :].any():
            raise Error(f"{source}: point {i} leaves the plane of the file, which has no z coordinates")
        for axis, (a, b) in enumerate(spans[i]):
            if before[i, axis] == after[i, axis]:
                continue
            new = _nastran(after[i, axis], content[a:b]) if nastran else _text(after[i, axis], layout, b - a)
            if ending == _DECK and len(new.strip()) > WIDEST:
                new = deck_number(after[i, axis]).encode()
            rounding = max(rounding, abs(_value(new) - after[i, axis]))
            begin = a
            if layout and len(new) > b - a:  # in a column of fixed width, into the blanks before it
                begin -= min(len(new) - (b - a), _blanks_before(content, a) - 1)
            parts += [content[at:begin], new]
            at = b
    return b"".join([*parts, content[at:]]), rounding


def _other_coordinates(ending: str, content: bytes) -> str:
    """The reason why a model's points are in other coordinates than the mesh, with a remedy; "" if it is unknown."""
    if ending in _NASTRAN and _OTHER_SYSTEM.search(content):
        return (
            "points of GRID are in coordinate systems of their own: save the model with GRID in the basic system, "
            "or write .vtu or .msh"
        )
    if ending == _DECK and _PLACED.search(content):
        return (
            "the points belong to parts, which instances place in the model: save it without parts and assemblies "
            "(Abaqus/CAE: model attributes), or write .vtu or .msh"
        )
    return ""


def _check(source: str, numbers: list[list[bytes]], before: Array) -> None:
    """Raise Error unless the numbers found are the coordinates that were read."""
    if len(numbers) != len(before):
        raise changed(source, f"it has {len(numbers)} points and the mesh {len(before)}")
    found = np.array([[_value(text) for text in point] + [0.0] * (3 - len(point)) for point in numbers])
    check_equal(source, as_read(found.reshape(-1, 3), before), before)


# --- numbers ---------------------------------------------------------------------------------------------------


def _layout(texts: list[bytes]) -> tuple[int, str] | None:
    """Digits after the point and the letter of the exponent ("" without one) if all numbers have the same."""
    found = set()
    for text in texts:
        match = _NUMBER.fullmatch(text)
        if not match or not match[3]:
            return None
        found.add((len(match[4]), (match[5] or b"").decode()))
        if len(found) > 1:
            return None
    return found.pop() if found else None


def _text(value: float, layout: tuple[int, str] | None, width: int) -> bytes:
    """A number in the layout of the file; exact if the layout has too few digits. Shorter ones are right-aligned."""
    value = float(value) + 0.0  # -0 is 0
    if layout and layout[1] and layout[0] >= _FEWEST_DIGITS:
        text = f"{value:.{layout[0]}e}".replace("e", layout[1])
    elif layout and not layout[1] and layout[0] >= _FEWEST_DIGITS:
        text = f"{value:.{layout[0]}f}"
    else:
        text = repr(value)
    return text.encode().rjust(width) if layout else text.encode()


def _blanks_before(content: bytes, a: int) -> int:
    count = 0
    while a - count > 0 and content[a - count - 1] in b" ":
        count += 1
    return max(count, 1)


def _nastran(value: float, old: bytes) -> bytes:
    """A number in a field of Nastran: as many digits as the field has room for; for a free field all digits."""
    width = len(old)
    if width not in (SMALL_FIELD, LARGE_FIELD):
        text = repr(float(value))
        return (text if "." in text else text.replace("e", ".e") if "e" in text else text + ".").encode()
    return nastran_number(value, width).encode()


# --- positions of the coordinates, by format ------------------------------------------------------------------------


def _tokens(content: bytes, begin: int, end: int) -> Iterator[_Span]:
    for match in _TOKEN.finditer(content, begin, end):
        yield match.span()


def _msh(content: bytes) -> Iterator[list[_Span]]:
    """Gmsh's text, versions 1, 2, 4.0 and 4.1; FreeFem++'s, which begins with the numbers of points and elements."""
    section = re.search(rb"^\$(Nodes|NOD|ParametricNodes)\b[^\n]*\n", content, re.MULTILINE)
    if not section:
        yield from _freefem(content)
        return
    version = re.search(rb"^\$MeshFormat\s+(\S+)", content, re.MULTILINE)
    number = float(version[1]) if version else 1.0
    tokens = _tokens(content, section.end(), len(content))

    def take() -> _Span:
        return next(tokens)

    def whole() -> int:
        return int(content[slice(*take())])

    first = whole()
    if number < BLOCKS:
        for _ in range(first):
            take()
            yield [take(), take(), take()]
            if section[1] == b"ParametricNodes":
                dimension, _ = whole(), take()
                for _ in range(dimension if dimension < _VOLUME else 0):
                    take()
        return
    for _ in range(3 if number >= NUMBERS_FIRST else 1):  # number of points; the smallest and the largest number
        take()
    for _ in range(first):
        dimension, tag = whole(), whole()
        if number < NUMBERS_FIRST:
            dimension = tag
        parametric, count = whole(), whole()
        extra = dimension if parametric else 0
        if number >= NUMBERS_FIRST:
            for _ in range(count):
                take()
        for _ in range(count):
            if number < NUMBERS_FIRST:
                take()
            yield [take(), take(), take()]
            for _ in range(extra):
                take()


def _freefem(content: bytes) -> Iterator[list[_Span]]:
    tokens = _tokens(content, 0, len(content))
    count = int(content[slice(*next(tokens))])
    first = content.split(b"\n", 2)[1]
    dimension = len(first.split()) - 1
    next(tokens), next(tokens)
    for _ in range(count):
        yield [next(tokens) for _ in range(dimension)]
        next(tokens)


def _uncommented(content: bytes, sign: bytes) -> bytes:
    """The content with blanks instead of comments."""
    return re.sub(re.escape(sign) + rb"[^\n]*", lambda match: b" " * len(match[0]), content)


def _mfem(content: bytes) -> Iterator[list[_Span]]:
    """The vertices of MFEM's straight meshes."""
    text = _uncommented(content, b"#")
    section = re.search(rb"^\s*vertices\s+(\d+)\s+([123])\s", text, re.MULTILINE)
    if not section:
        return
    tokens = _tokens(text, section.end(), len(text))
    for _ in range(int(section[1])):
        yield [next(tokens) for _ in range(int(section[2]))]


def _medit(content: bytes) -> Iterator[list[_Span]]:
    text = _uncommented(content, b"#")
    if text.lstrip().startswith(b"MFEM"):
        yield from _mfem(content)
        return
    dimension = re.search(rb"\bDimension\s+(\d)", text)
    section = re.search(rb"(?<!\S)Vertices\s+(\d+)", text)
    if not dimension or not section:
        return
    tokens = _tokens(text, section.end(), len(text))
    for _ in range(int(section[1])):
        yield [next(tokens) for _ in range(int(dimension[1]))]
        next(tokens)


def _su2(content: bytes) -> Iterator[list[_Span]]:
    text = _uncommented(content, b"%")
    dimension = re.search(rb"^\s*NDIME\s*=\s*(\d)", text, re.MULTILINE)
    section = re.search(rb"^\s*NPOIN\s*=\s*(\d+)[^\n]*\n", text, re.MULTILINE)
    if not dimension or not section:
        return
    at, count = section.end(), int(section[1])
    while count and at < len(text):
        end = text.find(b"\n", at)
        end = len(text) if end < 0 else end
        spans = list(_tokens(text, at, end))
        if spans:
            yield spans[: int(dimension[1])]
            count -= 1
        at = end + 1


def _unv(content: bytes) -> Iterator[list[_Span]]:
    """The datasets of nodes of universal files: coordinates are in the second line of a node, or in its only one."""
    at, number, second = 0, b"", False
    inside = False
    for line in content.splitlines(keepends=True):
        text = line.strip()
        if text == b"-1":
            inside, number = not inside, b""
        elif inside and not number:
            number, second = text, False
        elif text and number in _UNV_NODES:
            if second or number == _UNV_SHORT:
                yield list(_tokens(content, at, at + len(line)))[0 if second else _UNV_HEAD :][:3]
            second = not second and number != _UNV_SHORT
        at += len(line)


def _never(_: bytes) -> Iterator[list[_Span]]:
    """For formats without text."""
    yield from ()


def _off(content: bytes) -> Iterator[list[_Span]]:
    text = _uncommented(content, b"#")
    header = re.match(rb"\s*((?:ST)?C?N?)OFF\b", text)
    tokens = _tokens(text, header.end() if header else 0, len(text))
    count = int(text[slice(*next(tokens))])
    next(tokens), next(tokens)
    at = next(tokens)[0] if count else 0
    while count:
        end = text.find(b"\n", at)
        end = len(text) if end < 0 else end
        spans = list(_tokens(text, at, end))
        if spans:
            yield spans[:3]
            count -= 1
        elif end == len(text):
            return
        at = end + 1


def _abaqus(content: bytes) -> Iterator[list[_Span]]:
    """The lines of *NODE of Abaqus and CalculiX: number, x, y, z."""
    inside, at = False, 0
    for line in content.splitlines(keepends=True):
        if line.startswith(b"*"):
            if not line.startswith(b"**"):
                inside = line[1:].split(b",")[0].strip().upper() == b"NODE"
        elif inside and line.strip():
            spans, place = [], at
            for field in line.split(b",")[:4]:
                inner = field.strip()
                begin = place + (field.index(inner) if inner else 0)
                spans.append((begin, begin + len(inner)))
                place += len(field) + 1
            yield spans[1:]
        at += len(line)


def _nastran_grids(content: bytes) -> Iterator[list[_Span]]:
    """GRID of Nastran in small, large and free fields."""
    lines = content.splitlines(keepends=True)
    places = np.cumsum([0] + [len(line) for line in lines]).tolist()
    for i, line in enumerate(lines):
        word = line[:SMALL_FIELD].strip().upper()
        if b"," in line[:SMALL_FIELD + 2] and line.upper().startswith((b"GRID,", b"GRID ", b"GRID*")):
            yield from _free_grid(line, places[i])
        elif word == b"GRID":
            yield _fields(line, places[i], _GRID_FIELD, 3, SMALL_FIELD)
        elif word == b"GRID*":
            row = _fields(line, places[i], _LARGE_GRID_FIELD, 2, LARGE_FIELD)
            more = lines[i + 1] if i + 1 < len(lines) and lines[i + 1][:1] in (b"*", b" ") else b""
            yield row + (_fields(more, places[i + 1], SMALL_FIELD, 1, LARGE_FIELD) if more else [])


def _fields(line: bytes, place: int, begin: int, count: int, width: int) -> list[_Span]:
    end = len(line.rstrip(b"\r\n"))
    return [(place + min(a, end), place + min(a + width, end)) for a in (begin + k * width for k in range(count))]


def _free_grid(line: bytes, place: int) -> Iterator[list[_Span]]:
    spans, at = [], place
    for field in line.rstrip(b"\r\n").split(b",")[:6]:
        inner = field.strip()
        begin = at + (field.index(inner) if inner else 0)
        spans.append((begin, begin + len(inner)))
        at += len(field) + 1
    yield spans[3:]


_NASTRAN = (".bdf", ".nas", ".fem")
_DECK = ".inp"
_GMSH = (".msh", ".msh2", ".msh4")
#: How the coordinates of each format are found.
LOCATORS: dict[str, Callable[[bytes], Iterator[list[_Span]]]] = {
    **dict.fromkeys(_GMSH, _msh),
    ".mesh": _medit,
    ".meshb": _never,
    ".su2": _su2,
    ".unv": _unv,
    ".off": _off,
    _DECK: _abaqus,
    ".bdf": _nastran_grids,
    ".nas": _nastran_grids,
    ".fem": _nastran_grids,
}
