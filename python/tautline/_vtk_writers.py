# SPDX-License-Identifier: BSD-3-Clause
"""VTK's writers: their output is collected in memory and replaces the file as a whole.

VTK does not notice every failure of a disk, removes the older file after some and aborts the program after others.
"""

from __future__ import annotations

import itertools
import os
import re
import shutil
from contextlib import suppress
from tempfile import TemporaryDirectory
from typing import Any, Iterator
from xml.etree import ElementTree

from vtkmodules.vtkCommonDataModel import (
    vtkCompositeDataSet,
    vtkDataObject,
    vtkDataObjectTree,
    vtkDataSet,
    vtkMultiBlockDataSet,
    vtkMultiPieceDataSet,
)

from ._errors import Error, watch
from ._files import check_target, locked, replace_bytes, require_memory, sync_folder, temporary_name
from ._formats import FORMATS, Format
from ._grid_checks import without_marks, writable
from ._interrupts import updating
from ._vtk import CLASSES

# Types of blocks beside the meshes in the table of formats.
_OTHER_BLOCKS = {
    ".vtt": Format("vtkXMLTableReader", "vtkXMLTableWriter", "vtkTable", "vtkIOXML"),
    ".htg": Format("vtkXMLHyperTreeGridReader", "vtkXMLHyperTreeGridWriter", "vtkHyperTreeGrid", "vtkIOXML"),
}
# The last text of each format's files; VTK writes some files only in part and reports success.
_XML_END = b"</VTKFile>"
# Bytes per KiB of the data: a copy of it, and the file.
_MEMORY_OF_WRITERS = 2 * 1024
_STL_HEADER, _STL_TRIANGLE = 84, 50  # bytes


def write_data(data: vtkDataObject, name: str, form: Format) -> list[str]:
    """Write a data set, or composite data to a .vtk file. Raises Error if the file cannot be written."""
    check_target(name)
    replace_bytes(name, _content(data, name, form))
    return [name]


def write_composite(data: vtkMultiBlockDataSet, name: str) -> list[str]:
    """Write a .vtm file, and its blocks to a new directory beside it. Returns the names of all files.

    The directory is NAME, or NAME-1, ... if there is one; it is complete before the .vtm file refers to it. The
    directory of an older .vtm file is removed after that. Raises Error if a file cannot be written.
    """
    target = check_target(name)
    folder, stem = os.path.dirname(target) or ".", os.path.splitext(os.path.basename(target))[0]
    temporary = os.path.join(folder, temporary_name())
    root = ElementTree.Element("VTKFile", type="vtkMultiBlockDataSet", version="1.0")
    files: list[str] = []
    try:
        os.mkdir(temporary)
        try:
            _write_blocks(data, ElementTree.SubElement(root, "vtkMultiBlockDataSet"), temporary, stem, files)
            sync_folder(temporary)
            with locked(folder):
                directory = _publish(root, temporary, target, folder, stem)
        finally:
            shutil.rmtree(temporary, ignore_errors=True)
    except OSError as error:
        raise Error(f"{name}: cannot be written: {error.strerror}") from None
    return [name, *(os.path.join(folder, directory, file) for file in files)]


def _publish(root: ElementTree.Element, temporary: str, target: str, folder: str, stem: str) -> str:
    """Rename the directory of the blocks, write the .vtm file, remove the older blocks; returns the new name."""
    before = _older_directory(target, folder, stem)
    directory = _move_to_free_name(temporary, folder, stem)
    for entry in root.iter("DataSet"):
        if "file" in entry.attrib:
            entry.set("file", f"{directory}/{entry.get('file')}")
    ElementTree.indent(root)
    try:
        replace_bytes(target, b'<?xml version="1.0"?>\n' + ElementTree.tostring(root) + b"\n")
    except BaseException:
        shutil.rmtree(os.path.join(folder, directory), ignore_errors=True)
        raise
    if before:
        _remove_blocks(os.path.join(folder, before), stem)
    return directory


def block_files(name: str) -> list[str]:
    """The names of the files that a .vtm, .pvtu or .pvtp file refers to; none if it is damaged."""
    try:
        root = ElementTree.parse(name).getroot()
    except ElementTree.ParseError:
        return []
    named = [entry.get("file") for entry in root.iter("DataSet")]
    named += [entry.get("Source") for entry in root.iter("Piece")]
    return [os.path.join(os.path.dirname(name), file) for file in named if file]


def _content(data: vtkDataObject, name: str, form: Format) -> bytes:
    """The bytes that a writer of VTK writes to a file of that name."""
    writer = form.make_writer()
    for binary in ("SetFileTypeToBinary", "SetDataModeToBinary"):  # not appended data, see _io.py
        getattr(writer, binary, int)()
    if isinstance(data, vtkDataSet):
        data = writable(without_marks(data) if form.module == "vtkIOLegacy" else data)
    writer.SetInputData(data)
    messages = watch(writer)
    require_memory(_MEMORY_OF_WRITERS * data.GetActualMemorySize(), f"writing {name}")
    content, written = _through_memory(writer)
    if messages.errors or messages.warnings or not written or not _complete(content, data, form):
        reason = "; ".join(messages.errors + messages.warnings) or "VTK's writer failed"
        raise Error(f"{name}: cannot be written: {reason}")
    return content


def _through_memory(writer: Any) -> tuple[bytes, bool]:
    """The bytes a writer of VTK writes to a file in memory, and whether it wrote all of them."""
    memory = os.memfd_create("tautline")
    try:
        with TemporaryDirectory() as folder:  # of a link, because vtkPLYWriter accepts no other ending than .ply
            link = os.path.join(folder, "content.ply")
            os.symlink(f"/proc/self/fd/{memory}", link)
            writer.SetFileName(link)
            writer.Modified()  # as Write() does
            with updating(writer):
                failure = CLASSES["vtkUpdateGuard"].UpdateWholeExtent(writer)
            if failure:
                raise Error(failure)
            written = not writer.GetErrorCode()
        with open(f"/proc/self/fd/{memory}", "rb") as file:
            return file.read(), written
    finally:
        os.close(memory)


def _complete(content: bytes, data: vtkDataObject, form: Format) -> bool:
    if form.writer == "vtkSTLWriter":
        return len(content) >= _STL_HEADER and (len(content) - _STL_HEADER) % _STL_TRIANGLE == 0
    if form.module == "vtkIOXML":
        return content.rstrip().endswith(_XML_END)
    return content.endswith(b"\n") if form.module == "vtkIOLegacy" else bool(content)


def _write_blocks(
    data: vtkDataObjectTree, parent: ElementTree.Element, folder: str, stem: str, files: list[str]
) -> None:
    for index, block in enumerate(_children(data)):
        facts = {"index": str(index)}
        if data.HasMetaData(index) and data.GetMetaData(index).Has(vtkCompositeDataSet.NAME()):
            facts["name"] = data.GetMetaData(index).Get(vtkCompositeDataSet.NAME())
        if isinstance(block, vtkDataObjectTree):
            kind = "Piece" if isinstance(block, vtkMultiPieceDataSet) else "Block"
            _write_blocks(block, ElementTree.SubElement(parent, kind, facts), folder, stem, files)
            continue
        if block is not None:
            ending, form = _format_of(block)
            facts["file"] = f"{stem}_{len(files)}{ending}"
            replace_bytes(os.path.join(folder, facts["file"]), _content(block, facts["file"], form))
            files.append(facts["file"])
        ElementTree.SubElement(parent, "DataSet", facts)


def _children(data: vtkDataObjectTree) -> Iterator[vtkDataObject | None]:
    pieces = isinstance(data, vtkMultiPieceDataSet)
    count = data.GetNumberOfPieces() if pieces else data.GetNumberOfBlocks()
    for i in range(count):
        yield data.GetPieceAsDataObject(i) if pieces else data.GetBlock(i)


def _format_of(block: vtkDataObject) -> tuple[str, Format]:
    for ending, form in (FORMATS | _OTHER_BLOCKS).items():
        if form.module == "vtkIOXML" and block.IsA(form.holds):
            return ending, form
    raise Error(f"a .vtm file cannot hold a {block.GetClassName()}")


def _move_to_free_name(temporary: str, folder: str, stem: str) -> str:
    """Rename a directory to the first of STEM, STEM-1, ... that is free; returns that name."""
    names = itertools.chain([stem], (f"{stem}-{number}" for number in itertools.count(1)))
    free = next(name for name in names if not os.path.lexists(os.path.join(folder, name)))
    os.rename(temporary, os.path.join(folder, free))
    sync_folder(folder)
    return free


def _older_directory(target: str, folder: str, stem: str) -> str | None:
    """The directory of blocks, beside it, of the .vtm file that is there, if Tautline or VTK named it."""
    try:
        root = ElementTree.parse(target).getroot()
    except (OSError, ElementTree.ParseError):
        return None
    names = {entry.get("file", "").rpartition("/")[0] for entry in root.iter("DataSet")}
    found = [name for name in names if re.fullmatch(re.escape(stem) + r"(-\d+)?", name)]
    is_directory = len(found) == 1 and os.path.isdir(os.path.join(folder, found[0]))
    return found[0] if is_directory and not os.path.islink(os.path.join(folder, found[0])) else None


def _remove_blocks(directory: str, stem: str) -> None:
    """Remove the files of blocks, and the directory if nothing else is in it."""
    with suppress(OSError):
        for name in os.listdir(directory):
            if re.fullmatch(re.escape(stem) + r"(_\d+)+\.vt\w", name):
                os.unlink(os.path.join(directory, name))
        os.rmdir(directory)
