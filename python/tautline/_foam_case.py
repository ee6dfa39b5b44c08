# SPDX-License-Identifier: BSD-3-Clause
"""A copy of a case of OpenFOAM with other points."""

from __future__ import annotations

import gzip
import os
import shutil
import zlib
from pathlib import Path
from typing import Callable

from ._binary_coordinates import changed
from ._errors import Error
from ._files import replace_bytes, sync_folder, temporary_name

#: What is copied: the mesh and its properties, the settings, the first time step.
_PARTS = ("constant", "system", "0", "0.orig")
_MESH = "polyMesh"
_POINTS = Path("constant", _MESH, "points")


def copy_case(source: str, target: str, rewritten: Callable[[str, bytes], tuple[bytes, float]]) -> float:
    """Copy the case of a .foam file to the directory of another one, with other points.

    rewritten: the new content of the file of points, for its name and content, and the largest rounding, which is
    returned. Raises Error, before anything is written, if there is a case already, or if the mesh of the case moves.
    """
    old, new = (Path(os.path.abspath(file)).parent for file in (source, target))
    taken = [name for name in _PARTS if (new / name).exists()]
    if taken:
        raise Error(f"{target}: {new / taken[0]} exists: name a .foam in another, empty directory")
    moving = sorted(str(folder) for folder in old.glob(f"[0-9]*/{_MESH}"))
    if moving:
        raise changed(source, f"the mesh of the case moves: it has {moving[0]}")
    points, packed = old / _POINTS, old / f"{_POINTS}.gz"
    try:
        content = points.read_bytes() if points.exists() else gzip.decompress(packed.read_bytes())
    except (OSError, EOFError, zlib.error) as error:
        raise changed(source, f"{points}: {error}") from None
    made, rounding = rewritten(str(points), content)
    folder = new / temporary_name()
    try:
        folder.mkdir()
        for name in _PARTS:
            if (old / name).is_dir():
                shutil.copytree(old / name, folder / name)
        (folder / f"{_POINTS}.gz").unlink(missing_ok=True)
        replace_bytes(folder / _POINTS, made)
        for name in reversed(_PARTS):  # the mesh is the last
            if (folder / name).exists():
                os.rename(folder / name, new / name)
        sync_folder(str(new))
    except OSError as error:
        raise Error(f"{target}: cannot be written: {error.strerror or error}") from None
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    replace_bytes(target, b"")
    return rounding
