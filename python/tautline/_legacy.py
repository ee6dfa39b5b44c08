# SPDX-License-Identifier: BSD-3-Clause
"""Legacy .vtk files are checked before VTK reads them.

VTK's reader returns a mesh from a truncated file, with memory that nobody filled, or aborts the program. The scanner
follows the sections of a file and checks that the announced data are there; it reads none of them.
"""

from __future__ import annotations

import mmap
import re
from os import SEEK_END

from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkPointSet

from ._errors import Error
from ._grid_checks import POLY_LISTS, cell_lists

_HEADER = re.compile(rb"\s*# vtk DataFile Version (\d+)\.\d+[^\n]*\n[^\n]*\n\s*(ASCII|BINARY)\b[^\n]*\n?", re.I)
_WORD = re.compile(rb"\S+")
_REST_OF_LINE = re.compile(rb"[^\n]*\n?")
# Since this version a section of cells is a list of offsets, one more than cells, and a list of points.
_OFFSETS_VERSION = 5
# The bytes of a value in a binary file.
_BYTES = {
    "unsigned_char": 1, "signed_char": 1, "char": 1, "unsigned_short": 2, "short": 2, "unsigned_int": 4, "int": 4,
    "unsigned_long": 8, "long": 8, "float": 4, "double": 8, "vtkidtype": 4, "vtktypeint64": 8, "vtktypeuint64": 8,
}  # fmt: skip
_TEXTS = ("string", "utf8_string")
# A text starts with the number of its bytes; its first two bits give the size of this number.
_LENGTH_BYTES = (8, 4, 2, 1)
_BITS_IN_BYTE = 8
_CHUNK = 1 << 20
_CELLS = ("cells", *POLY_LISTS)
_FACTS = {"dimensions": 3, "origin": 3, "spacing": 3, "aspect_ratio": 3, "extent": 6}  # numbers
_TUPLES = {"vectors": 3, "normals": 3, "tensors": 9, "tensors6": 6, "global_ids": 1, "pedigree_ids": 1, "edge_flags": 1}
_MESHES = ("unstructured_grid", "polydata", "structured_grid", "rectilinear_grid", "structured_points")
_BLOCKS = ("multiblock", "multipiece", "partitioned", "partitioned_collection", "overlapping_amr")


def scan_legacy(name: str) -> dict[str, int]:
    """The announced numbers of points and cells, by the name of the section; nothing for composite data.

    Raises Error if the file is truncated or not a legacy file.
    """
    with open(name, "rb") as file:
        if file.seek(0, SEEK_END) == 0:
            raise Error(f"{name}: the file is empty")
        with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as content:
            return _Scanner(name, content).scan()


def check_counts(name: str, mesh: vtkDataObject, announced: dict[str, int]) -> None:
    """Raise Error if a mesh has other numbers of points and cells than its file."""
    if isinstance(mesh, vtkPointSet):
        found = {section: cells.GetNumberOfCells() for section, cells in cell_lists(mesh).items()}
        found["points"] = mesh.GetNumberOfPoints()
        for section, count in announced.items():
            if found.get(section, 0) != count:
                raise Error(f"{name}: {section.upper()} announces {count}, but {found.get(section, 0)} could be read")


class _Scanner:
    def __init__(self, name: str, content: mmap.mmap) -> None:
        self.name, self.content, self.size = name, content, len(content)
        self.at = 0
        self.version, self.binary = 0, False
        self.tuples = 0  # of the arrays that follow
        self.types = 0  # of the cells
        self.children, self.open = 0, 0
        self.composite = False
        self.counts: dict[str, int] = {}

    def scan(self) -> dict[str, int]:
        self._header()
        while word := self._word():
            if not self._section(word):
                return {}
        if self.children or self.open:
            raise self._damaged("blocks are missing")
        if not self.composite and self.counts.get("cells", 0) != self.types:
            raise self._damaged(f"{self.counts.get('cells', 0)} cells have {self.types} types")
        return {} if self.composite else self.counts

    def _header(self) -> None:
        found = _HEADER.match(self.content, self.at)
        if not found:
            raise self._damaged("no header of a legacy VTK file")
        self.version, self.binary = int(found[1]), found[2].upper() == b"BINARY"
        self.at = found.end()

    def _section(self, word: str) -> bool:
        """Skip a section whose first word was read; False if data starts that are not a mesh."""
        if word == "dataset":
            kind = self._word()
            if kind not in _MESHES + _BLOCKS:
                return False
        elif word == "points":
            self.counts[word] = self._count()
            self._values(3 * self.counts[word], self._word())
        elif word in _FACTS:
            self._text_values(_FACTS[word])
        elif word in ("x_coordinates", "y_coordinates", "z_coordinates"):
            self._values(self._count(), self._word())
        elif word in _CELLS:
            self._cells(word)
        elif word == "cell_types":
            self.types = self._count()
            self._values(self.types, "int")
        elif word in ("point_data", "cell_data"):
            self.tuples = self._count()
        elif word == "field":
            self._field()
        elif word == "metadata":
            self._metadata()
        elif word in ("children", "child", "endchild"):
            self._child(word)
        else:
            self._attribute(word)
        return True

    def _cells(self, section: str) -> None:
        count, size = self._count(), self._count()
        if self.version < _OFFSETS_VERSION:
            self.counts[section] = count
            self._values(size, "int")
            return
        self.counts[section] = max(0, count - 1)
        for part, values in (("offsets", count), ("connectivity", size)) if count else ():
            if self._word() != part:
                raise self._damaged(f"{part.upper()} is missing")
            self._values(values, self._word())

    def _attribute(self, word: str) -> None:
        if word == "scalars":
            self._word()
            kind, *components = self._rest_of_line().split()[:2] or ["?"]
            if self._word() != "lookup_table" or not self._word():
                raise self._damaged("LOOKUP_TABLE is missing")
            self._values(self.tuples * self._number(components[0] if components else "1"), kind.lower())
        elif word in ("color_scalars", "lookup_table"):
            self._word()
            count = self._count()
            self._values(4 * count if word == "lookup_table" else self.tuples * count, "unsigned_char")
        elif word == "texture_coordinates":
            self._word()
            self._values(self._count() * self.tuples, self._word())
        elif word in _TUPLES:
            self._word()
            self._values(_TUPLES[word] * self.tuples, self._word())
        else:
            raise self._damaged(f"unknown section '{word[:20]}'")

    def _field(self) -> None:
        self._word()
        left = self._count()
        while left:
            name = self._word()
            if name == "metadata":
                self._metadata()
                continue
            if name != "null_array":
                components, tuples = self._count(), self._count()
                self._values(components * tuples, self._word())
            left -= 1

    def _metadata(self) -> None:
        """Metadata of an array, up to the next empty line."""
        self._rest_of_line()
        while self._rest_of_line().strip():
            pass

    def _child(self, word: str) -> None:
        self.composite = True
        if word == "children":
            self.children += self._count()
        elif word == "child":
            missing = self._rest_of_line().split()[:1] == ["-1"]  # a block that is null
            self.children, self.open = self.children - 1, self.open + 1
            if not missing:
                self._header()
        else:
            self.open -= 1

    def _values(self, count: int, kind: str) -> None:
        """Skip values. Raises Error if the file has fewer."""
        if kind not in _BYTES and kind not in _TEXTS and kind != "bit":
            raise self._damaged(f"unknown type '{kind[:20]}'")
        if kind in _TEXTS:
            if self.binary:
                self._rest_of_line()
            for _ in range(count):
                self._binary_text() if self.binary else self._line_of_text()
        elif not self.binary:
            self._text_values(count)
        else:
            self._rest_of_line()
            bits = count if kind == "bit" else count * _BYTES[kind] * _BITS_IN_BYTE
            self._bytes((bits + _BITS_IN_BYTE - 1) // _BITS_IN_BYTE)

    def _bytes(self, count: int) -> bytes:
        """The start of bytes that are skipped."""
        if count > self.size - self.at:
            raise self._damaged(f"{count} bytes are announced, {self.size - self.at} are there")
        start = self.at
        self.at += count
        return self.content[start : min(self.at, start + max(_LENGTH_BYTES))]

    def _binary_text(self) -> None:
        first = self._bytes(1)[0]
        more = _LENGTH_BYTES[first >> 6] - 1
        length = int.from_bytes(bytes([first & 0x3F]) + self._bytes(more), "big")
        self._bytes(length)

    def _line_of_text(self) -> None:
        if self.at >= self.size:
            raise self._damaged("texts are missing")
        self._rest_of_line()

    def _text_values(self, count: int) -> None:
        """Skip numbers as text, in chunks that end between two of them."""
        left = count
        while left:
            chunk = self.content[self.at : self.at + _CHUNK]
            if self.at + len(chunk) < self.size and not chunk[-1:].isspace():
                chunk = chunk[: len(chunk) - len(chunk.split()[-1])]  # the last one may go on
            words = chunk.split(None, left)
            if not words or (len(words) < left and self.at + len(chunk) >= self.size):
                raise self._damaged(f"{count} values are announced, {count - left + len(words)} are there")
            rest = words.pop() if len(words) > left else b""
            left -= len(words)
            self.at += len(chunk) - len(rest)

    def _word(self) -> str:
        """The next word in lower case; empty at the end of the file."""
        found = _WORD.search(self.content, self.at)
        self.at = found.end() if found else self.size
        return found[0].decode("latin-1").lower() if found else ""

    def _rest_of_line(self) -> str:
        found = _REST_OF_LINE.match(self.content, self.at)
        self.at = found.end() if found else self.size
        return found[0].decode("latin-1") if found else ""

    def _count(self) -> int:
        return self._number(self._word())

    def _number(self, word: str) -> int:
        if not word.isdecimal():
            raise self._damaged(f"a number is expected, found '{word[:20]}'" if word else "the file ends")
        return int(word)

    def _damaged(self, reason: str) -> Error:
        return Error(f"{self.name}: the file is truncated or damaged, at byte {self.at}: {reason}")
