# SPDX-License-Identifier: BSD-3-Clause
"""The build that this package belongs to: its version, and the Python and VTK that its compiled modules need.

The file build.json beside this one is written when the package is built. It is the only source of the package's
version, which comes from the top CMakeLists.txt.
"""

import json
import os
import sys
from typing import Dict

_FOLDER = os.path.dirname(os.path.abspath(__file__))
_FILE = os.path.join(_FOLDER, "build.json")


def _read() -> Dict[str, str]:
    """The keys version, python (3.11), vtk (9.2.1), interpreter (a path) and documents (see below).

    Empty in a source tree.
    """
    if not os.path.exists(_FILE):
        return {}
    with open(_FILE, encoding="utf-8") as file:
        return dict(json.load(file))


def problem(build: Dict[str, str]) -> str:
    """Why the compiled modules of a build cannot be used by this Python, with the remedy, or an empty text."""
    if not build:
        return 'these are the sources of tautline; ./run build, then eval "$(./run env)", makes the package usable'
    here = "{}.{}".format(*sys.version_info)
    remedy = f"use {build['interpreter']} or pvpython"
    if here != build["python"]:
        return f"tautline was built for Python {build['python']}, this is Python {here} ({sys.executable}): {remedy}"
    try:
        from vtkmodules.vtkCommonCore import vtkVersion
    except ImportError:
        return f"{sys.executable} has no VTK: {remedy}"
    vtk = vtkVersion.GetVTKVersion()
    if vtk != build["vtk"]:
        return f"tautline was built with VTK {build['vtk']}, {sys.executable} has VTK {vtk}: {remedy}"
    return ""


def check() -> None:
    """Raise ImportError if this Python cannot use the compiled modules.

    A command (python3 -m tautline) ends with the sentence alone and exit code 1.
    """
    sentence = problem(_BUILD)
    if not sentence:
        return
    if sys.argv and sys.argv[0] == "-m":  # while Python looks for the module to run
        sys.exit(f"tautline: {sentence}")
    raise ImportError(sentence)


_BUILD = _read()

#: The version of the package.
VERSION = _BUILD.get("version", "")
#: The directory of the documentation package, whether it is installed or not; build.json has it relative to this one.
DOCUMENTS = os.path.normpath(os.path.join(_FOLDER, _BUILD.get("documents", "")))
