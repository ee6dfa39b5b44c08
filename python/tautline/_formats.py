# SPDX-License-Identifier: BSD-3-Clause
"""The table of file formats: reader, writer and contents by the ending of the file name."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import Any

from . import _vtk


@dataclass(frozen=True)
class Format:
    """How files with an ending are read and written."""

    #: The classes; None where files are not read, or not written.
    reader: str | None
    writer: str | None
    #: The class of data that a file can hold; None: any mesh.
    holds: str | None
    #: The module of vtkmodules with both classes; None: our own compiled modules.
    module: str | None = None
    #: Another of our readers, for files of the same ending that it can read.
    other: str | None = None

    @property
    def own(self) -> bool:
        """Whether the classes are ours: a format of a mesh generator."""
        return self.module is None

    def make_reader(self, file: str = "") -> Any:
        """A new reader of a file."""
        if self.other and (reader := self._make(self.other)).CanReadFile(file):
            return reader
        return self._make(self.reader or "")

    def make_writer(self) -> Any:
        """A new writer."""
        return self._make(self.writer or "")

    def _make(self, name: str) -> Any:
        return getattr(_vtk if self.module is None else import_module(f"vtkmodules.{self.module}"), name)()


def _vtk_xml(data: str) -> Format:
    name = data.removeprefix("vtk").removesuffix("Set")
    return Format(f"vtkXML{name}Reader", f"vtkXML{name}Writer", data, "vtkIOXML")


def _vtk_pieces(data: str) -> Format:
    """The format of a file that names the files of its pieces; written by ParaView."""
    return Format(f"vtkXMLP{data.removeprefix('vtk')}Reader", None, data, "vtkIOXML")


_TETGEN = Format("vtkTetGenReader", "vtkTetGenWriter", "vtkDataSet")
_OFF = "vtkOffReader"
FLUENT_READER = "vtkFluentMeshReader"
_OWN_FORMATS = {
    **dict.fromkeys((".node", ".ele", ".face", ".edge", ".poly", ".smesh"), _TETGEN),
    ".mesh": Format("vtkMeditReader", "vtkMeditWriter", "vtkDataSet", other="vtkMfemReader"),
    ".meshb": Format("vtkMeditReader", "vtkMeditWriter", "vtkDataSet"),
    ".sol": Format("vtkMeditReader", None, "vtkDataSet"),
    ".msh": Format("vtkGmshReader", "vtkGmshWriter", "vtkDataSet", other=FLUENT_READER),
    **dict.fromkeys((".msh2", ".msh4"), Format("vtkGmshReader", None, "vtkDataSet")),
    ".inp": Format("vtkAbaqusReader", None, "vtkDataSet"),
    **dict.fromkeys((".bdf", ".nas", ".fem"), Format("vtkNastranReader", None, "vtkDataSet")),
    ".foam": Format("vtkFoamMeshReader", None, "vtkDataSet"),  # write() has a writer of points
    ".cas": Format(FLUENT_READER, None, "vtkDataSet"),
    ".pos": Format(None, "vtkGmshWriter", "vtkDataSet"),
    ".off": Format(_OFF, "vtkOffWriter", "vtkDataSet"),
    **dict.fromkeys((".coff", ".noff", ".cnoff"), Format(_OFF, None, "vtkDataSet")),
}

#: The formats by the ending, in lower case, of a file's name.
FORMATS = {
    ".vtk": Format("vtkGenericDataObjectReader", "vtkGenericDataObjectWriter", None, "vtkIOLegacy"),
    ".vtu": _vtk_xml("vtkUnstructuredGrid"),
    ".vtp": _vtk_xml("vtkPolyData"),
    ".vti": _vtk_xml("vtkImageData"),
    ".vtr": _vtk_xml("vtkRectilinearGrid"),
    ".vts": _vtk_xml("vtkStructuredGrid"),
    ".pvtu": _vtk_pieces("vtkUnstructuredGrid"),
    ".pvtp": _vtk_pieces("vtkPolyData"),
    ".vtm": _vtk_xml("vtkMultiBlockDataSet"),
    ".ply": Format("vtkPLYReader", "vtkPLYWriter", "vtkPolyData", "vtkIOPLY"),
    ".stl": Format("vtkSTLReader", "vtkSTLWriter", "vtkPolyData", "vtkIOGeometry"),
    ".obj": Format("vtkOBJReader", None, "vtkPolyData", "vtkIOGeometry"),
    **(_OWN_FORMATS if "TautlineReaders" in _vtk.MODULES else {}),
}
