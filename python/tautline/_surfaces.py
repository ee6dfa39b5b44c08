# SPDX-License-Identifier: BSD-3-Clause
"""Files .ply and .stl are checked before VTK reads them: its readers abort the program on some that are truncated."""

from __future__ import annotations

import os
import re
from typing import Literal

from ._errors import Error

_PLY_HEADER = re.compile(rb"ply\s.*?\nend_header[^\n]*\n", re.S)
_PLY_LARGEST_HEADER = 1 << 20
_PLY_BYTES = {
    "char": 1, "uchar": 1, "int8": 1, "uint8": 1, "short": 2, "ushort": 2, "int16": 2, "uint16": 2, "int": 4, "uint": 4,
    "int32": 4, "uint32": 4, "float": 4, "float32": 4, "double": 8, "float64": 8,
}  # fmt: skip
_STL_HEADER, _STL_TRIANGLE = 84, 50  # bytes


def check_surface(name: str) -> None:
    """Raise Error if a .ply or .stl file is truncated."""
    if name.lower().endswith(".ply"):
        _check_ply(name)
    elif name.lower().endswith(".stl"):
        _check_stl(name)


def _damaged(name: str, reason: str) -> Error:
    return Error(f"{name}: the file is truncated or damaged: {reason}")


def _check_stl(name: str) -> None:
    size = os.path.getsize(name)
    with open(name, "rb") as file:
        head = file.read(_STL_HEADER)
        announced = _STL_HEADER + _STL_TRIANGLE * int.from_bytes(head[-4:], "little")
        if len(head) == _STL_HEADER and size == announced:
            return
        if not head.lstrip().lower().startswith(b"solid"):
            raise _damaged(name, f"{announced if len(head) == _STL_HEADER else _STL_HEADER} bytes are expected")
        file.seek(max(0, size - _STL_HEADER))
        if b"endsolid" not in file.read().lower():
            raise _damaged(name, "endsolid is missing")


def _check_ply(name: str) -> None:
    with open(name, "rb") as file:
        head = _PLY_HEADER.match(file.read(_PLY_LARGEST_HEADER))
        if not head:
            raise _damaged(name, "there is no complete header")
        lines = [line.split() for line in head[0].decode("latin-1").splitlines()]
        file.seek(head.end())
        content = file.read()
    elements: list[tuple[int, list[list[str]]]] = []
    form = ""
    try:
        for words in filter(None, lines):
            if words[0] == "format":
                form = words[1]
            elif words[0] == "element":
                elements.append((int(words[2]), []))
            elif words[0] == "property":
                elements[-1][1].append(words[1:-1])
        if form == "ascii":
            complete = sum(1 for line in content.splitlines() if line.strip()) >= sum(count for count, _ in elements)
        else:
            complete = _ply_end(content, elements, "big" if "big" in form else "little") <= len(content)
    except (KeyError, ValueError, IndexError):
        raise _damaged(name, "the header or a list cannot be understood") from None
    if not complete:
        raise _damaged(name, "elements are missing")


def _ply_end(content: bytes, elements: list[tuple[int, list[list[str]]]], order: Literal["little", "big"]) -> int:
    """The end of the binary elements, as far as the content shows it."""
    at = 0
    for count, properties in elements:
        if all(kind[0] != "list" for kind in properties):
            at += count * sum(_PLY_BYTES[kind[0]] for kind in properties)
            continue
        for _ in range(count):
            for kind in properties:
                if kind[0] == "list":
                    width = _PLY_BYTES[kind[1]]
                    if at + width > len(content):
                        return at + width
                    at += width + int.from_bytes(content[at : at + width], order) * _PLY_BYTES[kind[2]]
                else:
                    at += _PLY_BYTES[kind[0]]
    return at
