"""The verbs read and write."""

from __future__ import annotations

from importlib import import_module
from os import PathLike, fspath
from pathlib import Path
from typing import Any

from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet, vtkDataObject, vtkDataSet

from ._errors import Error, plain, run, watch
from ._mesh import Mesh, as_mesh

try:
    from . import _inputs  # formats of mesh generators
except ImportError:
    _inputs = None

# VTK's own formats by ending: module, reader, writer, the class it holds (None: any).
_FORMATS = {
    ".vtk": ("vtkIOLegacy", "vtkGenericDataObjectReader", "vtkGenericDataObjectWriter", None),
    ".vtu": ("vtkIOXML", "vtkXMLUnstructuredGridReader", "vtkXMLUnstructuredGridWriter", "vtkUnstructuredGrid"),
    ".vtp": ("vtkIOXML", "vtkXMLPolyDataReader", "vtkXMLPolyDataWriter", "vtkPolyData"),
    ".vti": ("vtkIOXML", "vtkXMLImageDataReader", "vtkXMLImageDataWriter", "vtkImageData"),
    ".vtr": ("vtkIOXML", "vtkXMLRectilinearGridReader", "vtkXMLRectilinearGridWriter", "vtkRectilinearGrid"),
    ".vts": ("vtkIOXML", "vtkXMLStructuredGridReader", "vtkXMLStructuredGridWriter", "vtkStructuredGrid"),
    ".vtm": ("vtkIOXML", "vtkXMLMultiBlockDataReader", "vtkXMLMultiBlockDataWriter", "vtkMultiBlockDataSet"),
    ".ply": ("vtkIOPLY", "vtkPLYReader", "vtkPLYWriter", "vtkPolyData"),
    ".stl": ("vtkIOGeometry", "vtkSTLReader", "vtkSTLWriter", "vtkPolyData"),
    ".obj": ("vtkIOGeometry", "vtkOBJReader", None, "vtkPolyData"),
}

# VTK 9.1 and 9.2 with the expat of today's Debian 12 (VTK issue 19258).
_APPENDED = (
    "The file has appended data, which VTK before 9.3 cannot read with a recent libexpat: "
    "save it with the data mode Binary or Ascii."
)


def read(file: str | PathLike, **options: Any) -> vtkDataObject:
    """Read a mesh, in the format of the ending of its name.

    VTK's formats (.vtk .vtu .vtp .vti .vtr .vts .vtm .ply .stl .obj) take no options. Returns a
    vtkDataSet, of .vtm and some .vtk a composite data set. Raises Error if the file cannot be read.
    """
    name, ending = fspath(file), Path(file).suffix.lower()
    if ending not in _FORMATS:
        if _inputs:
            return _inputs.read(name, **options)
        raise Error(f"{name}: no reader for '{ending}'; there are {' '.join(sorted(_FORMATS))}")
    if options:
        raise Error(f"{name}: '{ending}' has no options, not {', '.join(options)}")
    if not Path(name).is_file():
        raise Error(f"{name}: there is no such file")
    reader = _make(ending, 1)
    reader.SetFileName(name)
    with _Quiet() as said:
        try:
            run(reader)
        except Error as error:
            details = [text for text in said() if text not in str(error)]
            details += [_APPENDED] if b"<AppendedData" in Path(name).read_bytes() else []
            raise Error("\n".join([f"{name}: {error}", *details])) from None
        mesh = reader.GetOutputDataObject(0)
    if not isinstance(mesh, (vtkDataSet, vtkCompositeDataSet)):
        raise Error(f"{name}: holds no mesh ({mesh.GetClassName() if mesh else 'nothing'})")
    return mesh


def write(mesh: Mesh, file: str | PathLike, **options: Any) -> list[str]:
    """Write a mesh in the format of the ending of the file's name; returns the files written.

    VTK's formats (.vtk .vtu .vtp .vti .vtr .vts .vtm .ply .stl) are written binary, compressed where the
    format can be, and take no options. Raises Error if the format cannot hold the mesh or if the
    file cannot be written.
    """
    name, ending = fspath(file), Path(file).suffix.lower()
    data = as_mesh(mesh)
    if ending not in _FORMATS and _inputs:
        return _inputs.write(data, name, **options)
    if ending not in _FORMATS or not _FORMATS[ending][2]:
        known = " ".join(sorted(key for key, value in _FORMATS.items() if value[2]))
        raise Error(f"{name}: no writer for '{ending}'; there are {known}")
    if options:
        raise Error(f"{name}: '{ending}' has no options, not {', '.join(options)}")
    wanted = _FORMATS[ending][3]
    if wanted and not data.IsA(wanted):
        ours = [e for e, f in _FORMATS.items() if f[2] and (f[3] is None or data.IsA(f[3]))]
        raise Error(f"{name}: '{ending}' cannot hold a {data.GetClassName()}; {' '.join(ours)} can")
    writer = _make(ending, 2)
    for binary in ("SetFileTypeToBinary", "SetDataModeToBinary"):  # appended data: see _APPENDED
        getattr(writer, binary, int)()
    writer.SetInputData(data)
    writer.SetFileName(name)
    messages = watch(writer)
    with _Quiet():
        written = writer.Write()
    if messages.errors or not written or not Path(name).is_file():
        reason = "; ".join(messages.errors) or "the directory does not exist or cannot be written to"
        raise Error(f"{name}: cannot be written: {reason}")
    return [name]


def _make(ending: str, which: int) -> Any:
    return getattr(import_module(f"vtkmodules.{_FORMATS[ending][0]}"), _FORMATS[ending][which])()


class _Quiet:
    """Keeps what VTK's helper objects, which nobody can watch, would print; gives it as a list."""

    def __enter__(self):
        self.window = vtkStringOutputWindow()
        self.before = vtkOutputWindow.GetInstance()
        vtkOutputWindow.SetInstance(self.window)
        self.verbosity = vtkLogger.GetCurrentVerbosityCutoff()
        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
        return lambda: [plain(text) for text in self.window.GetOutput().split("\n\n") if text.strip()]

    def __exit__(self, *_):
        vtkOutputWindow.SetInstance(self.before)
        vtkLogger.SetStderrVerbosity(self.verbosity)
