# SPDX-License-Identifier: BSD-3-Clause
"""The function formats; the commands convert and formats: read() and write() from a shell."""

from __future__ import annotations

import argparse
from typing import Any

from . import _commands
from ._errors import checked
from ._formats import FORMATS
from ._io import SU2, UNV, is_template, read, readable
from ._meshio import MESHIO_FORMATS, installed
from ._nastran import NASTRAN_ENDINGS
from ._tables import align
from ._vtk_readers import SERIES, SOLVER_FORMATS

_OWN = {
    ".node": "TetGen, Triangle", ".ele": "TetGen, Triangle", ".face": "TetGen, Triangle", ".edge": "TetGen, Triangle",
    ".poly": "TetGen, Triangle", ".smesh": "TetGen", ".mesh": "Medit, MFEM", ".meshb": "Medit, binary",
    ".sol": "Medit", ".msh": "Gmsh, FreeFem++, Fluent",
    ".pos": "Gmsh's views", ".msh2": "Gmsh", ".msh4": "Gmsh",
    ".off": "OFF", ".coff": "OFF", ".noff": "OFF", ".cnoff": "OFF", ".ply": "PLY", ".stl": "STL",
    ".obj": "Wavefront OBJ", ".foam": "OpenFOAM", ".cas": "Fluent",
}  # fmt: skip


@checked
def formats() -> list[dict[str, Any]]:
    """The formats of mesh files, made by asking the readers.

    Returns
    -------
    list[dict[str, Any]]
        A dict for each: ending; format (its name); read, write (whether it is possible here); times (whether files have
        time steps); by ("Tautline", "VTK" or "meshio", which reads it); comes_back (whether a file can be the template
        of write(), so that after a motion of points it comes back with new coordinates and is otherwise unchanged).

    Examples
    --------
    >>> [form["ending"] for form in tautline.formats() if form["write"]]
    """
    return [_facts(ending) | {"comes_back": is_template(ending)} for ending in sorted({*readable(), *FORMATS})]


def _facts(ending: str) -> dict[str, Any]:
    meshio = ending in MESHIO_FORMATS
    facts = {"ending": ending, "format": _OWN.get(ending, "VTK"), "read": True, "write": False, "times": False,
             "by": "VTK"}  # fmt: skip
    if ending in FORMATS:
        form = FORMATS[ending]
        facts |= {"read": form.reader is not None, "write": form.writer is not None}
        facts["by"] = "Tautline" if form.own else "VTK"
        if meshio:  # which writes what is read here
            facts |= {"format": MESHIO_FORMATS[ending], "write": installed(ending)}
        if ending == ".inp":  # of two formats: AVS UCD is read by VTK
            facts["format"] = f"{facts['format']}, AVS UCD"
        if ending in NASTRAN_ENDINGS:
            facts |= {"format": "Nastran", "write": True}
    elif ending == SU2:
        facts |= {"format": "SU2", "write": True, "by": "Tautline"}
    elif ending == UNV:
        facts |= {"format": "I-DEAS, Salome: universal file", "by": "Tautline"}
    elif ending == SERIES:
        facts |= {"format": "ParaView, files by time", "times": True, "by": "Tautline"}
    elif ending in SOLVER_FORMATS:
        solver = SOLVER_FORMATS[ending]
        facts |= {"format": solver.title, "read": solver.built(), "times": solver.times}
    elif meshio:
        here = installed(ending)
        facts |= {"format": MESHIO_FORMATS[ending], "read": here, "write": here, "by": "meshio"}
        if ending == ".inp":  # of two formats: AVS UCD is read by VTK
            facts["format"] = f"{facts['format']}, AVS UCD"
            if not here:
                facts |= {"format": "AVS UCD", "read": True, "by": "VTK"}
    return facts


def add_commands(commands: Any) -> None:
    """Add `convert` and `formats` to the subparsers of the command line."""
    parser = _commands.add_command(
        commands, "convert", _run, "convert a mesh to another file format", threads=False,
        example="part.vtu part.msh",
        details="Formats are found by the endings of the file names.",
    )
    parser.add_argument("input", metavar="FILE", help="mesh to read; - is a .vtu from the standard input")
    _commands.add_output(parser)
    parser.add_argument("--lower-cells", action="store_true", help="keep boundary faces and edges")
    parser.add_argument("--time", type=float, help="the time step to read, the nearest to this number")
    parser.add_argument("--binary", action="store_true", help="write .msh as bytes")
    parser.add_argument("--mfem", choices=("H1", "L2"), help="space of the nodes in a .mesh of MFEM")


    parser = _commands.add_command(
        commands, "formats", _run_formats, "list the formats of mesh files", example="", threads=False,
        details="Lists the formats that can be read and written here, with the program that does it.",
    )  # fmt: skip


def _run_formats(arguments: argparse.Namespace) -> None:
    rows = formats()
    shown = [["yes" if value is True else "-" if value is False else value for value in row.values()] for row in rows]
    _commands.finish(arguments, None, align(shown, list(rows[0])), facts={"formats": rows})


def _run(arguments: argparse.Namespace) -> None:
    chosen = {"lower_cells": arguments.lower_cells or None, "time": arguments.time}
    mesh = read(arguments.input, **{name: value for name, value in chosen.items() if value is not None})
    options: dict[str, Any] = {"binary": True} if arguments.binary else {}
    options |= {"mfem": arguments.mfem} if arguments.mfem else {}
    _commands.finish(arguments, mesh, _commands.counts(mesh), **options)
