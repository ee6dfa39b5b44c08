# SPDX-License-Identifier: BSD-3-Clause
"""Cases of OpenFOAM with other points: the case itself, or a copy of it."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from typing import Callable

from ._errors import Error
from ._files import replace_bytes, sync_folder, temporary_name

FOAM = ".foam"
#: Copied folders: the mesh and its properties, the settings, the first time step, the processors.
_PARTS = ("constant", "system", "0", "0.orig")
_PROCESSORS = "processor[0-9]*"


def write_case(target: str, source: str, write_points: Callable[[str], list[str]]) -> list[str]:
    """Write other points into the case of a .foam file: the one the mesh was read from, or a copy of it.

    source: the .foam file that the mesh was read from, "" if it is not known. A target in another directory, where
    there must be no case, gets a copy. write_points: writes the points into the case in the directory of a file.
    Returns the names of the files. Raises Error; then no file is written.
    """
    old, new = (Path(os.path.abspath(file)).parent for file in (source or target, target))
    if old == new or (new.is_dir() and old.is_dir() and os.path.samefile(old, new)):
        return write_points(target)
    parts = [*_PARTS, *sorted(folder.name for folder in old.glob(_PROCESSORS))]
    taken = [name for name in parts if (new / name).exists()]
    if taken:
        raise Error(f"{target}: {new / taken[0]} exists: name a .foam in another, empty directory")
    folder = new / temporary_name()
    try:
        folder.mkdir()
        for name in parts:
            if (old / name).is_dir():
                shutil.copytree(old / name, folder / name)
        write_points(str(folder / Path(target).name))
        for name in reversed(parts):  # the mesh is the last
            if (folder / name).exists():
                os.rename(folder / name, new / name)
        sync_folder(str(new))
    except OSError as error:
        raise Error(f"{target}: cannot be written: {error.strerror or error}") from None
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    replace_bytes(target, b"")
    return [target]
