"""Formats of mesh generators for the verbs read and write, and the verb domain."""

from __future__ import annotations

from os import PathLike, fspath
from pathlib import Path
from typing import Any

import tautline
from vtkmodules.vtkCommonDataModel import vtkDataSet

from ._errors import Error, run, watch

_TETGEN = (".node", ".ele", ".face", ".edge", ".poly", ".smesh")
_READERS = {
    **dict.fromkeys(_TETGEN, "vtkTetGenReader"),
    **dict.fromkeys((".mesh", ".sol"), "vtkMeditReader"),
    ".msh": "vtkGmshReader",
    **dict.fromkeys((".off", ".coff", ".noff", ".cnoff"), "vtkOffReader"),
}
_WRITERS = {
    **dict.fromkeys(_TETGEN, "vtkTetGenWriter"),
    ".mesh": "vtkMeditWriter",
    ".msh": "vtkGmshWriter",
    ".off": "vtkOffWriter",
}


def _unknown(name: str, kind: str, ours: dict) -> Error:
    return Error(f"{name}: no {kind} for '{Path(name).suffix}'; there are {' '.join(sorted({*ours, *_io()._FORMATS}))}")


def read(file: str | PathLike, *, lower_cells: bool = False) -> vtkDataSet:
    """Read a file of TetGen, Triangle, Medit, Gmsh, FreeFem++ or OFF, by the ending of its name.

    With lower_cells, boundary triangles beside tetrahedra and edges beside triangles are kept. Raises
    Error with file and line.
    """
    name = fspath(file)
    ending = Path(name).suffix.lower()
    if ending not in _READERS:
        raise _unknown(name, "reader", _READERS)
    reader = getattr(tautline, _READERS[ending])()
    reader.SetLowerCells(lower_cells)
    reader.SetFileName(name)
    run(reader)
    return reader.GetOutput()


def write(mesh: vtkDataSet, file: str | PathLike, *, binary: bool = False) -> list[str]:
    """Write a mesh by the ending of the name; returns the files written.

    `binary` is for .msh. Raises Error when the format has no place for the mesh's cells.
    """
    name = fspath(file)
    ending = Path(name).suffix.lower()
    if ending not in _WRITERS:
        raise _unknown(name, "writer", _WRITERS)
    if not isinstance(mesh, vtkDataSet):
        raise Error(f"{name}: a vtkDataSet can be written, not a {type(mesh).__name__}")
    writer = getattr(tautline, _WRITERS[ending])()
    if binary and not hasattr(writer, "SetBinary"):
        raise Error(f"{name}: '{ending}' is always text")
    if hasattr(writer, "SetBinary"):
        writer.SetBinary(binary)
    writer.SetInputData(mesh)
    writer.SetFileName(name)
    messages = watch(writer)
    written = writer.Write()
    messages.raise_errors()
    if not written:
        raise Error(f"{name}: cannot be written")
    return [writer.GetFileWritten(i) for i in range(writer.GetNumberOfFilesWritten())]


def domains() -> list[str]:
    """The names of the domains."""
    source = tautline.vtkDomainSource
    return [source.GetDomainName(i) for i in range(source.GetNumberOfDomains())]


def domain(
    name: str,
    cells: int = 0,
    *,
    amount: float = 1.0,
    element_size: float = 0.1,
    aspect_ratio: float = 1.0,
    collar_width: float = 0.2,
    deformed_boundary: bool = False,
) -> vtkDataSet:
    """A domain of the dissertation as a mesh of about that many cells (0: as many as in its example).

    Point arrays `BoundaryMarker`, `Fixed` and, on moving domains, `Displacement` (times `amount`). Element size,
    aspect ratio and collar width are those of the square. With deformed_boundary, the moved boundary
    instead of the mesh. Raises Error for an unknown name, with the list of names.
    """
    source = tautline.vtkDomainSource()
    messages = watch(source)
    source.SetDomainByName(name)
    messages.raise_errors()
    if cells < 0:
        raise Error(f"the number of cells is {cells}; it cannot be negative")
    source.SetNumberOfCells(cells)
    source.SetAmount(amount)
    source.SetElementSize(element_size)
    source.SetAspectRatio(aspect_ratio)
    source.SetCollarWidth(collar_width)
    run(source, messages)
    return source.GetOutputDataObject(1 if deformed_boundary else 0)


def add_commands(commands) -> None:
    """Add `domain` and `convert` to the subparsers of the command line; each sets `run`."""
    parser = commands.add_parser("domain", help="mesh a domain of the dissertation")
    parser.add_argument("name", choices=domains(), metavar="NAME", help=", ".join(domains()))
    parser.add_argument("--cells", type=int, default=0, help="about how many (default: those of the example)")
    parser.add_argument("--amount", type=float, default=1.0, help="how much of its motion a boundary makes")
    parser.add_argument("--element-size", type=float, default=0.1, help="square: leg of the isotropic triangle")
    parser.add_argument("--aspect-ratio", type=float, default=1.0, help="square: ratio of the legs")
    parser.add_argument("--collar-width", type=float, default=0.2, help="square: width of the collar")
    parser.add_argument("-o", "--output", required=True, help="file to write, in the format of its ending")
    parser.set_defaults(run=_run_domain)

    parser = commands.add_parser("convert", help="read a mesh and write it in another format")
    parser.add_argument("input")
    parser.add_argument("output")
    parser.add_argument("--lower-cells", action="store_true", help="keep boundary faces and edges")
    parser.add_argument("--binary", action="store_true", help="write .msh as bytes")
    parser.set_defaults(run=_run_convert)


def _io():
    from . import _io as module  # knows VTK's formats too, and imports this one

    return module


def _write_any(mesh: vtkDataSet, file: str, **options: Any) -> list[str]:
    return _io().write(mesh, file, **options)


def _report(mesh: vtkDataSet, files: list[str]) -> int:
    print(f"{mesh.GetNumberOfPoints()} points, {mesh.GetNumberOfCells()} cells: {' '.join(files)}")
    return 0


def _run_domain(arguments) -> int:
    mesh = domain(
        arguments.name,
        arguments.cells,
        amount=arguments.amount,
        element_size=arguments.element_size,
        aspect_ratio=arguments.aspect_ratio,
        collar_width=arguments.collar_width,
    )
    return _report(mesh, _write_any(mesh, arguments.output))


def _run_convert(arguments) -> int:
    options = {"lower_cells": True} if arguments.lower_cells else {}
    mesh = _io().read(arguments.input, **options)
    return _report(mesh, _write_any(mesh, arguments.output, **({"binary": True} if arguments.binary else {})))
