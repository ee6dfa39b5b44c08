# SPDX-License-Identifier: BSD-3-Clause
"""Reading of the formats of solvers that VTK reads: blocks, time steps."""

from __future__ import annotations

import os
import xml.etree.ElementTree as ElementTree
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import import_module
from math import isfinite
from pathlib import Path
from typing import Any, Callable, Iterator

from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet, vtkDataObject, vtkDataSet, vtkMultiBlockDataSet
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

from ._arrays import leaves
from ._errors import Aborted, Error, Messages, run, watch


@dataclass(frozen=True)
class SolverFormat:
    """How files with an ending are read."""

    #: The name of the format, its module of vtkmodules and its class of reader.
    title: str
    module: str
    reader: str
    #: The setter of the file name.
    setter: str = "SetFileName"
    #: Whether files can have time steps.
    times: bool = False

    def built(self) -> bool:
        """Whether this VTK has the reader."""
        try:
            return hasattr(import_module(f"vtkmodules.{self.module}"), self.reader)
        except ImportError:
            return False


_EXODUS = SolverFormat("Exodus II", "vtkIOExodus", "vtkExodusIIReader", times=True)
_XDMF = SolverFormat("XDMF 2", "vtkIOXdmf2", "vtkXdmfReader", times=True)
_CGNS = SolverFormat("CGNS", "vtkIOCGNSReader", "vtkCGNSReader", times=True)
_AVS = SolverFormat("AVS UCD", "vtkIOGeometry", "vtkAVSucdReader")
_TECPLOT = SolverFormat("Tecplot, text", "vtkIOGeometry", "vtkTecplotReader")
EXODUS_ENDINGS = (".e", ".exo", ".ex2", ".exii", ".g")
#: The formats by the ending, in lower case, of a file's name.
SOLVER_FORMATS = {
    **dict.fromkeys(EXODUS_ENDINGS, _EXODUS),
    ".cgns": _CGNS,
    **dict.fromkeys((".xmf", ".xdmf"), _XDMF),
    **dict.fromkeys((".avs", ".ucd"), _AVS),
    ".case": SolverFormat("EnSight", "vtkIOEnSight", "vtkGenericEnSightReader", "SetCaseFileName", True),
    ".neu": SolverFormat("Gambit neutral", "vtkIOGeometry", "vtkGAMBITReader"),
    **dict.fromkeys((".tec", ".tp"), _TECPLOT),
    ".pvti": SolverFormat("VTK, pieces", "vtkIOXML", "vtkXMLPImageDataReader"),
    ".pvtr": SolverFormat("VTK, pieces", "vtkIOXML", "vtkXMLPRectilinearGridReader"),
    ".pvts": SolverFormat("VTK, pieces", "vtkIOXML", "vtkXMLPStructuredGridReader"),
}
#: The ending of ParaView's lists of files by time.
SERIES = ".pvd"
#: How files begin.
_HDF5, _NETCDF = b"\x89HDF\r\n\x1a\n", b"CDF"
#: CGNS of the older kind: "@(#)" with the high bit of each byte set.
ADF = b"\xc0\xa8\xa3\xa9ADF"
_HEAD = 16  # bytes
_UCD_BINARY = b"\x07"
_UCD_NUMBERS = 5  # in the first line of a UCD file
_UCD_NODE, _UCD_CELL = 4, 3  # words in the line of a node; before the nodes of a cell
_UCD_SIZES = {"pt": 1, "line": 2, "tri": 3, "quad": 4, "tet": 4, "pyr": 5, "prism": 6, "hex": 8}


def is_ucd(name: str) -> bool:
    """Whether a file .inp is AVS UCD: Abaqus' files, which have that ending too, begin with a star."""
    with open(name, encoding="latin-1") as file:
        for line in file:
            words = line.split()
            if words and not words[0].startswith("#"):
                return len(words) >= _UCD_NUMBERS and all(word.isdecimal() for word in words[:_UCD_NUMBERS])
    return False


def _check_ucd(name: str) -> None:
    """Raise Error, with the line, if a UCD text file has fewer nodes, cells and values than its header announces.

    VTK's reader replaces missing values with zeros, or with the rest of another line.
    """
    with open(name, "rb") as file:
        content = file.read()
    if content[:1] == _UCD_BINARY:
        return
    lines = [(i + 1, line.split()) for i, line in enumerate(content.split(b"\n"))]
    rows = [(i, words) for i, words in lines if words and not words[0].startswith(b"#")]
    try:
        nodes, cells, *values = (int(word) for word in rows[0][1][:_UCD_NUMBERS])
    except (ValueError, IndexError):
        raise Error(f"{name}: is not AVS UCD: five numbers are expected in the first line") from None
    if len(values) != _UCD_NUMBERS - 2 or min(nodes, cells, *values) < 0:
        raise Error(f"{name}:{rows[0][0]}: the counts of nodes, cells and values are wrong")
    needed = [_UCD_NODE] * nodes + [_UCD_CELL] * cells
    for i, least in enumerate(needed, 1):
        if i >= len(rows):
            raise Error(f"{name}: the file is truncated: its header has {nodes} nodes and {cells} cells")
        number, words = rows[i]
        if least == _UCD_CELL and len(words) > 2:
            least += _UCD_SIZES.get(words[2].decode("latin-1").lower(), 0)
        if len(words) < least:
            raise Error(f"{name}:{number}: {len(words)} words; {least} are expected: is the file truncated?")
    at = 1 + nodes + cells
    for count, width in ((nodes, values[0]), (cells, values[1])):
        if not width:
            continue
        labels = int(rows[at][1][0]) if at < len(rows) and rows[at][1][0].isdigit() else 0
        end = at + 1 + labels + count
        short = [number for number, words in rows[at + 1 + labels : end] if len(words) < 1 + width]
        if end > len(rows) or short or not labels:
            place = f":{short[0]}" if short else ""
            raise Error(f"{name}{place}: the file is truncated: values are missing")
        at = end


def read_solver(name: str, form: SolverFormat, time: float | None) -> vtkDataObject:
    """The mesh of a file at the time step nearest to `time`, the first for None.

    Raises Error if there is no such reader in this VTK, if it fails, or if the file has no time steps.
    """
    with _named(name):
        reader, messages = _reader(name, form)
        steps = _steps(reader)
        if time is not None:
            _request(reader, _nearest(name, steps, time))
        elif steps:
            _request(reader, steps[0])
        run(reader, messages, _damaged(name, form))
    return _simplified(name, reader.GetOutputDataObject(0))


def times_of(name: str, form: SolverFormat) -> list[float]:
    """The time steps of a file; none where it has no times."""
    with _named(name):
        return _steps(_reader(name, form)[0])


def series(name: str) -> list[tuple[float, str]]:
    """Times and files of a .pvd file, in the order of time. Raises Error if it is damaged."""
    try:
        root = ElementTree.parse(name).getroot()
        entries = [(float(entry.get("timestep", "0")), entry.get("file", "")) for entry in root.iter("DataSet")]
    except (ElementTree.ParseError, ValueError) as error:
        raise Error(f"{name}: {error}") from None
    if not entries or not all(file for _, file in entries):
        raise Error(f"{name}: names no files")
    for time, file in entries:
        if not isfinite(time):
            raise Error(f"{name}: the time of {file} is not finite")
        if file.lower().endswith(".pvd"):
            raise Error(f"{name}: names {file}; files of a .pvd are meshes, not other .pvd")
    folder = Path(name).parent
    return sorted((time, os.path.join(folder, file)) for time, file in entries)


def read_series(name: str, time: float | None, read: Callable[[str], vtkDataObject]) -> vtkDataObject:
    """The mesh of a .pvd file at a time; several parts become blocks."""
    entries = series(name)
    times = sorted({when for when, _ in entries})
    chosen = times[0] if time is None else _nearest(name, times, time)
    parts = [read(file) for when, file in entries if when == chosen]
    return parts[0] if len(parts) == 1 else _blocks([(f"part {i}", part) for i, part in enumerate(parts)])


def check_content(name: str, form: SolverFormat) -> None:
    """Raise Error for a file of another format: some libraries would print to stderr or end the process.

    Also if this VTK has no such reader.
    """
    if not form.built():
        raise Error(f"{name}: this VTK has no reader for {form.title}; save the mesh as .vtu")
    with open(name, "rb") as file:
        head = file.read(_HEAD)
    if form is _AVS:
        _check_ucd(name)
    signatures = {_CGNS: (_HDF5, ADF), _EXODUS: (_HDF5, _NETCDF)}.get(form, ())
    if signatures and not head.startswith(signatures):
        raise Error(f"{name}: is not {form.title}, or damaged")
    if form is _XDMF:
        try:
            ElementTree.parse(name)
        except ElementTree.ParseError as error:
            raise Error(f"{name}: {error}") from None


@contextmanager
def _named(name: str) -> Iterator[None]:
    """Adds the file to the messages of a reader that do not name it."""
    try:
        yield
    except Aborted:
        raise
    except Error as error:
        text = str(error)
        raise error if name in text else Error(f"{name}: {text}") from None


def _damaged(name: str, form: SolverFormat) -> str:
    return f"{name}: the file is damaged, or is not {form.title}: its reader fails without giving a reason"


def _reader(name: str, form: SolverFormat) -> tuple[Any, Messages]:
    """The reader of a file, with its time steps, and its messages. Raises Error if there are errors."""
    check_content(name, form)
    reader = getattr(import_module(f"vtkmodules.{form.module}"), form.reader)()
    getattr(reader, form.setter)(name)
    messages = watch(reader)
    if form is _EXODUS:
        reader.SetSqueezePoints(0)  # points keep their numbers
    reader.UpdateInformation()
    messages.raise_errors(_damaged(name, form))
    if form is _EXODUS:
        for kind in (reader.NODAL, reader.ELEM_BLOCK):
            reader.SetAllArrayStatus(kind, 1)
        reader.UpdateInformation()
    return reader, messages


def _steps(reader: Any) -> list[float]:
    key = vtkStreamingDemandDrivenPipeline.TIME_STEPS()
    found = reader.GetOutputInformation(0)
    return [float(found.Get(key, i)) for i in range(found.Length(key))] if found.Has(key) else []


def _nearest(name: str, steps: list[float], time: float) -> float:
    if not steps:
        raise Error(f"{name}: has no time steps; leave out time")
    return min(steps, key=lambda step: abs(step - time))


def _request(reader: Any, step: float) -> None:
    reader.GetOutputInformation(0).Set(vtkStreamingDemandDrivenPipeline.UPDATE_TIME_STEP(), step)


def _simplified(name: str, data: Any) -> vtkDataObject:
    """The only block with cells of composite data, or all of them in one level with their names."""
    if isinstance(data, vtkDataSet):
        found = [("", data)]
    elif isinstance(data, vtkCompositeDataSet):
        found = [(title, leaf) for title, leaf in _named_leaves(data) if leaf.GetNumberOfCells()]
    else:
        found = []
    if not found or not found[0][1].GetNumberOfPoints():
        raise Error(f"{name}: holds no mesh")
    return found[0][1] if len(found) == 1 else _blocks(found)


def _named_leaves(data: vtkCompositeDataSet) -> list[tuple[str, vtkDataSet]]:
    names: list[str] = []
    walk = data.NewIterator()
    walk.InitTraversal()
    while not walk.IsDoneWithTraversal():
        if isinstance(walk.GetCurrentDataObject(), vtkDataSet):
            facts = walk.GetCurrentMetaData() if walk.HasCurrentMetaData() else None
            key = vtkCompositeDataSet.NAME()
            names.append(facts.Get(key) if facts and facts.Has(key) else f"block {len(names)}")
        walk.GoToNextItem()
    return list(zip(names, leaves(data)))


def _blocks(parts: list[tuple[str, vtkDataObject]]) -> vtkMultiBlockDataSet:
    made = vtkMultiBlockDataSet()
    for i, (title, part) in enumerate(parts):
        made.SetBlock(i, part)
        made.GetMetaData(i).Set(vtkCompositeDataSet.NAME(), title)
    return made
