# SPDX-License-Identifier: BSD-3-Clause
"""Parts of a study that ran before: results of its long functions, kept in files, so that it goes on where it stopped.

A result is found by the name of the function, its arguments (meshes by their points, cells and arrays) and the version
of this package. It is not found again after the package was changed without a new version: remove the folder then.
"""

from __future__ import annotations

import functools
import hashlib
import io
import pickle
from pathlib import Path
from typing import Any, Callable, TypeVar

from vtkmodules.vtkCommonCore import vtkObject
from vtkmodules.vtkCommonDataModel import vtkDataSet
from vtkmodules.vtkIOLegacy import vtkDataSetReader, vtkDataSetWriter

import tautline
from tautline._files import make_folder, replace_bytes

F = TypeVar("F", bound=Callable[..., Any])

_folder: list[Path] = []


def keep(folder: Path | None) -> None:
    """Keep results in a folder from now on, and use those that are there; None: keep nothing."""
    _folder[:] = [] if folder is None else [folder]


def remembered(function: F) -> F:
    """A function whose results are kept, and read where they were kept before."""

    @functools.wraps(function)
    def call(*arguments: Any, **options: Any) -> Any:
        if not _folder:
            return function(*arguments, **options)
        content = _packed((tautline.__version__, function.__module__, function.__qualname__, arguments,
                           sorted(options.items())))
        name = f"{function.__module__.split('.')[-1]}.{function.__name__}"
        file = _folder[0] / f"{name}-{hashlib.sha256(content).hexdigest()[:24]}.pickle"
        if file.is_file():
            return _Reader(io.BytesIO(file.read_bytes())).load()
        result = function(*arguments, **options)
        make_folder(file.parent)
        replace_bytes(file, _packed(result))
        return result

    return call  # type: ignore[return-value]


class _Writer(pickle.Pickler):
    """Writes meshes as legacy files in binary."""

    def persistent_id(self, made: Any) -> Any:
        if isinstance(made, vtkDataSet):
            writer = vtkDataSetWriter()
            writer.SetInputData(made)
            writer.WriteToOutputStringOn()
            writer.SetFileTypeToBinary()
            writer.Write()
            content = writer.GetOutputStdString()  # bytes, or a text where all of them are ASCII
            return content.encode("ascii") if isinstance(content, str) else bytes(content)
        if isinstance(made, vtkObject):
            raise pickle.PicklingError(f"a {made.GetClassName()} cannot be kept")
        return None


class _Reader(pickle.Unpickler):
    def persistent_load(self, content: bytes) -> vtkDataSet:
        reader = vtkDataSetReader()
        reader.ReadFromInputStringOn()
        reader.SetBinaryInputString(content, len(content))
        reader.ReadAllScalarsOn()
        reader.ReadAllVectorsOn()
        reader.ReadAllTensorsOn()
        reader.ReadAllFieldsOn()
        reader.Update()
        return reader.GetOutput()


def _packed(made: Any) -> bytes:
    stream = io.BytesIO()
    _Writer(stream, protocol=4).dump(made)
    return stream.getvalue()
