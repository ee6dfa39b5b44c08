"""Meshes in and out: the verbs read, write and domain."""

from __future__ import annotations

from os import PathLike, fspath
from pathlib import Path
from typing import Any

import tautline
from vtkmodules.vtkCommonCore import vtkCommand
from vtkmodules.vtkCommonDataModel import vtkDataSet

try:
    from tautline import Error
except ImportError:  # the package has none of its own yet

    class Error(RuntimeError):
        """What a verb raises: the message of the filter that failed."""


_READERS = {
    **dict.fromkeys((".node", ".ele", ".face", ".edge", ".poly", ".smesh"), "vtkTetGenReader"),
    **dict.fromkeys((".mesh", ".sol"), "vtkMeditReader"),
    ".msh": "vtkGmshReader",
    **dict.fromkeys((".off", ".coff", ".noff", ".cnoff"), "vtkOffReader"),
}
_WRITERS = {
    **dict.fromkeys((".node", ".ele", ".face", ".edge", ".poly", ".smesh"), "vtkTetGenWriter"),
    ".mesh": "vtkMeditWriter",
    ".msh": "vtkGmshWriter",
    ".off": "vtkOffWriter",
}
# VTK's own formats: ending, module, reader, writer
_VTK = {
    ".vtk": ("vtkIOLegacy", "vtkDataSetReader", "vtkDataSetWriter"),
    ".vtu": ("vtkIOXML", "vtkXMLUnstructuredGridReader", "vtkXMLUnstructuredGridWriter"),
    ".vtp": ("vtkIOXML", "vtkXMLPolyDataReader", "vtkXMLPolyDataWriter"),
    ".vti": ("vtkIOXML", "vtkXMLImageDataReader", "vtkXMLImageDataWriter"),
    ".vts": ("vtkIOXML", "vtkXMLStructuredGridReader", "vtkXMLStructuredGridWriter"),
    ".stl": ("vtkIOGeometry", "vtkSTLReader", "vtkSTLWriter"),
    ".obj": ("vtkIOGeometry", "vtkOBJReader", None),
    ".ply": ("vtkIOPLY", "vtkPLYReader", "vtkPLYWriter"),
}


class _Messages:
    """Collects the error messages of an algorithm and of its executive instead of printing them."""

    def __init__(self, algorithm) -> None:
        self.texts: list[str] = []

        def remember(_caller, _event, text):
            self.texts.append(text)

        remember.CallDataType = "string0"
        for source in (algorithm, algorithm.GetExecutive()):
            source.AddObserver(vtkCommand.ErrorEvent, remember)

    def raise_any(self) -> None:
        if self.texts:
            # "ERROR: In file.cxx, line 12\nvtkClass (0x...): what happened\n\n" -> "what happened"
            first = self.texts[0].strip()
            raise Error(first.split("): ", 1)[-1].strip())


def _vtk_class(module: str, name: str):
    return getattr(__import__(f"vtkmodules.{module}", fromlist=[name]), name)()


def _known(table: dict) -> str:
    return " ".join(sorted({*table, *_VTK}))


def read(file: str | PathLike, *, lower_cells: bool = False) -> vtkDataSet:
    """Read a mesh of any format Tautline or VTK knows, by the ending of its name.

    With lower_cells, boundary triangles beside tetrahedra and edges beside triangles are kept (formats
    of Tautline's own readers; VTK's keep them always). Raises Error, with file and line where known.
    """
    name = fspath(file)
    ending = Path(name).suffix.lower()
    if ending in _READERS:
        reader = getattr(tautline, _READERS[ending])()
        reader.SetLowerCells(lower_cells)
    elif ending in _VTK:
        reader = _vtk_class(*_VTK[ending][:2])
    else:
        raise Error(f"{name}: no reader for '{ending}'; there are {_known(_READERS)}")
    if not Path(name).is_file() and ending in _VTK:
        raise Error(f"{name}: cannot be opened")
    messages = _Messages(reader)
    reader.SetFileName(name)
    reader.Update()
    messages.raise_any()
    return reader.GetOutput()


def write(mesh: Any, file: str | PathLike, *, binary: bool = False) -> list[str]:
    """Write a vtkDataSet, or a result with a .mesh, by the ending of the name; returns the files written.

    `binary` matters to .msh. Raises Error when the format has no place for the mesh's cells.
    """
    name = fspath(file)
    ending = Path(name).suffix.lower()
    data = mesh if isinstance(mesh, vtkDataSet) else getattr(mesh, "mesh", None)
    if not isinstance(data, vtkDataSet):
        raise Error(f"a vtkDataSet is expected, not {type(mesh).__name__}")
    if ending in _WRITERS:
        writer = getattr(tautline, _WRITERS[ending])()
        if hasattr(writer, "SetBinary"):
            writer.SetBinary(binary)
    elif ending in _VTK and _VTK[ending][2]:
        writer = _vtk_class(_VTK[ending][0], _VTK[ending][2])
    else:
        raise Error(f"{name}: no writer for '{ending}'; there are {_known(_WRITERS)}")
    messages = _Messages(writer)
    writer.SetInputData(data)
    writer.SetFileName(name)
    written = writer.Write()
    messages.raise_any()
    if not written:
        raise Error(f"{name}: cannot be written")
    if hasattr(writer, "GetNumberOfFilesWritten"):
        return [writer.GetFileWritten(i) for i in range(writer.GetNumberOfFilesWritten())]
    return [name]


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
    messages = _Messages(source)
    source.SetDomainByName(name)
    messages.raise_any()
    if cells < 0:
        raise Error(f"the number of cells is {cells}; it cannot be negative")
    source.SetNumberOfCells(cells)
    source.SetAmount(amount)
    source.SetElementSize(element_size)
    source.SetAspectRatio(aspect_ratio)
    source.SetCollarWidth(collar_width)
    source.Update()
    messages.raise_any()
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
    return _report(mesh, write(mesh, arguments.output))


def _run_convert(arguments) -> int:
    mesh = read(arguments.input, lower_cells=arguments.lower_cells)
    return _report(mesh, write(mesh, arguments.output, binary=arguments.binary))
