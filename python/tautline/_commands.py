"""What the commands of the shell share: options, types of their values, output."""

from __future__ import annotations

import argparse
from typing import Any, Callable, Iterable

from ._files import check_stream_or_target, replace_text
from ._io import check_output, write
from ._tables import csv_text

#: A command: runs with the parsed arguments; the exit code is 0 for None.
Run = Callable[[argparse.Namespace], "int | None"]


def add_command(commands: Any, name: str, run: Run, text: str, *, threads: bool = True) -> argparse.ArgumentParser:
    """Add a command to the subparsers `commands`; `text` is its help."""
    parser = commands.add_parser(name, help=text, description=text[0].upper() + text[1:] + ".")
    parser.set_defaults(run=run)
    if threads:
        parser.add_argument("--threads", type=int, default=0, help="number of threads; 0, the default, is all cores")
    return parser


def add_metrics(parser: argparse.ArgumentParser) -> None:
    """Add the option of the metrics."""
    parser.add_argument("--metrics", type=_names, default=["imr"], metavar="NAME,...",
                        help="names of metrics, see the command metrics (default: imr)")  # fmt: skip


def add_time_limit(parser: argparse.ArgumentParser, default: float = 0.0) -> None:
    """Add the option of the time limit."""
    parser.add_argument("--time-limit", type=float, default=default, metavar="SECONDS",
                        help=f"0 is no limit (default: {default:g})")  # fmt: skip


def add_merge_points(parser: argparse.ArgumentParser) -> None:
    """Add the option of the points at the same place."""
    parser.add_argument("--merge-coincident-points", action=argparse.BooleanOptionalAction, default=True,
                        help="whether points at the same place on matching facets are one")  # fmt: skip


def _names(text: str) -> list[str]:
    return [name.strip() for name in text.split(",") if name.strip()]


def numbers(text: str) -> list[float]:
    """Numbers with commas between them, for argparse."""
    try:
        return [float(part) for part in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a list of numbers with commas between them") from None


def numbers_or_text(text: str, kind: type = float) -> Any:
    """A list of numbers if the text is numbers with commas between them, else the text."""
    try:
        return [kind(part) for part in text.split(",")]
    except ValueError:
        return text


def given(arguments: argparse.Namespace, names: Iterable[str]) -> dict[str, Any]:
    """The values of options by name."""
    return {name: getattr(arguments, name) for name in names}


def counts(mesh: Any) -> str:
    """The size of a mesh in words."""
    return f"{mesh.GetNumberOfPoints()} points, {mesh.GetNumberOfCells()} cells"


def check_outputs(arguments: argparse.Namespace) -> None:
    """Raise Error if a file that the command is to write cannot be written, before it does anything else."""
    if getattr(arguments, "output", None):
        check_output(arguments.output)
    for name in ("csv", "report"):
        if getattr(arguments, name, None):
            check_stream_or_target(getattr(arguments, name))


def save_text(file: str, text: str) -> None:
    """Write a text file and print its name. Raises Error if that fails."""
    replace_text(file, text, stream=True)
    print(file)


def save(mesh: Any, arguments: argparse.Namespace, rows: list[dict[str, Any]] | None = None) -> None:
    """Write the mesh to the file --output and the rows to the file --csv, where given, and print their names."""
    if getattr(arguments, "output", None):
        print("\n".join(write(mesh, arguments.output)))
    if getattr(arguments, "csv", None):
        save_text(arguments.csv, csv_text(rows or []))


def add_reproducible_order(parser: argparse.ArgumentParser) -> None:
    """Add --reproducible-order."""
    parser.add_argument("--reproducible-order", action="store_true", help="work as several processes do")


def add_moving_points(parser: argparse.ArgumentParser) -> None:
    """Add what the commands share that move points."""
    parser.add_argument("mesh", metavar="FILE")
    parser.add_argument("-o", "--output", metavar="FILE", required=True)
    parser.add_argument("--csv", metavar="FILE", help="write the history, a row per iteration or pass")
    parser.add_argument("--fixed", metavar="ARRAY", help="point array, not 0 where points stay")
    add_merge_points(parser)
    add_time_limit(parser)
