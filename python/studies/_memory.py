# SPDX-License-Identifier: BSD-3-Clause
"""Parts of a study that ran before: results of its long functions, kept in files, so that it continues where it
stopped.

A result is found by the name of the function, its arguments (meshes by their points, cells and arrays) and the version
of this package. A change of the package without a new version is not detected: remove the folder then.
"""

from __future__ import annotations

import functools
import hashlib
import io
import pickle
import time
from pathlib import Path
from typing import Any, Callable, NamedTuple, TypeVar

from vtkmodules.vtkCommonCore import vtkObject
from vtkmodules.vtkCommonDataModel import vtkDataSet
from vtkmodules.vtkIOLegacy import vtkDataSetReader, vtkDataSetWriter

import tautline
from tautline._errors import Error
from tautline._files import make_folder, replace_bytes

F = TypeVar("F", bound=Callable[..., Any])

class Kept(NamedTuple):
    """A result, and the CPU seconds that it took."""

    result: Any
    seconds: float


_folder: list[Path] = []
#: CPU seconds of the results that were read since keep().
_saved = [0.0]


def keep(folder: Path | None) -> None:
    """Keep results in a folder from now on, and use those that are there; None: keep nothing."""
    _folder[:] = [] if folder is None else [folder]
    _saved[0] = 0.0


def saved() -> float:
    """CPU seconds that the results that were read since keep() had taken."""
    return _saved[0]


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
            kept = _read(file)
            _saved[0] += kept.seconds
            return kept.result
        began, before = time.process_time(), _saved[0]
        result = function(*arguments, **options)
        make_folder(file.parent)
        replace_bytes(file, _packed(Kept(result, time.process_time() - began + _saved[0] - before)))
        return _read(file).result  # as it is read later, so that what is made of it has the same name then

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


def _read(file: Path) -> Kept:
    """The result of a file. Raises Error, which names it, if it is damaged."""
    try:
        return Kept(*_Reader(io.BytesIO(file.read_bytes())).load())
    except Exception as error:
        raise Error(f"{file} cannot be read ({error}): remove it, or its folder") from None


def _packed(made: Any) -> bytes:
    stream = io.BytesIO()
    _Writer(stream, protocol=4).dump(made)
    return stream.getvalue()
