"""The command convert: read() and write() from a shell."""

from __future__ import annotations

import argparse
from typing import Any

from . import _commands
from ._io import read, write


def add_commands(commands: Any) -> None:
    """Add `convert` to the subparsers of the command line."""
    parser = _commands.add_command(commands, "convert", _run, "convert a mesh to another file format", threads=False)
    parser.add_argument("input")
    parser.add_argument("output", help="the ending of the file name decides on the format")
    parser.add_argument("--lower-cells", action="store_true", help="keep boundary faces and edges")
    parser.add_argument("--binary", action="store_true", help="write .msh as bytes")


def _run(arguments: argparse.Namespace) -> None:
    mesh = read(arguments.input, **({"lower_cells": True} if arguments.lower_cells else {}))
    files = write(mesh, arguments.output, **({"binary": True} if arguments.binary else {}))
    print(_commands.counts(mesh))
    print("\n".join(files))
