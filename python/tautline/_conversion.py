"""The command convert: read() and write() from a shell."""

from __future__ import annotations

import argparse
from typing import Any

from . import _commands
from ._io import read


def add_commands(commands: Any) -> None:
    """Add `convert` to the subparsers of the command line."""
    parser = _commands.add_command(
        commands, "convert", _run, "convert a mesh to another file format", threads=False,
        example="part.vtu part.msh",
        details="Formats are found by the endings of the file names.",
    )
    parser.add_argument("input", help="mesh to read; - is a .vtu from the standard input")
    parser.add_argument("output", help="mesh to write; - is a .vtu to the standard output")
    parser.add_argument("--lower-cells", action="store_true", help="keep boundary faces and edges")
    parser.add_argument("--binary", action="store_true", help="write .msh as bytes")


def _run(arguments: argparse.Namespace) -> None:
    mesh = read(arguments.input, **({"lower_cells": True} if arguments.lower_cells else {}))
    options: dict[str, Any] = {"binary": True} if arguments.binary else {}
    _commands.finish(arguments, mesh, _commands.counts(mesh), **options)
