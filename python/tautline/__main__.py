# SPDX-License-Identifier: BSD-3-Clause
"""The functions of the package from a shell: python3 -m tautline COMMAND ..."""

from __future__ import annotations

import argparse
import sys
import warnings
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from . import __path__ as _folders, _build, _start, _vtk
from ._commands import EXIT_CODES, Parser, check_outputs, standard_input
from ._errors import Error
from ._interrupts import reporting

_EPILOG = """COMMAND --help explains a command, with an example; --help-all shows all its options. The file to write is
the option -o or the last argument. Names of methods and presets are case-insensitive.
The file name - is a .vtu mesh from the standard input or to the standard output:
  python3 -m tautline untangle part.vtu -o - | python3 -m tautline optimize - -o better.vtu
On a terminal, commands that take long show a progress bar, on stderr.

"""


def _program() -> str:
    """The name of the command as it was called."""
    return "tautline" if sys.argv and Path(sys.argv[0]).name == "tautline" else "python3 -m tautline"


#: The groups of the commands in the help.
_GROUPS = {
    "main commands": ("info", "quality", "untangle", "optimize", "convert"),
    "measure": ("report", "compare", "metrics", "criteria", "metric-field", "metric"),
    "change": ("improve", "adapt", "warp", "perturb"),
    "make and read meshes": ("domain", "triangle-mesh", "tet-mesh", "formats"),
    "equations": ("solve", "condition", "solver-study", "peridynamics", "interaction-layer", "horizon-neighbors"),
    "shapes": ("silhouette", "match", "retrieval"),
    "others": ("run", "study", "help"),
}


class _TopParser(Parser):
    """The parser of the commands; its help lists them in groups."""

    def short_usage(self) -> str:
        return f"{self.prog} COMMAND [FILE...] [OPTION...]"

    def _help_text(self) -> str:
        commands = next(a for a in self._actions if isinstance(a, argparse._SubParsersAction))
        texts = {choice.dest: choice.help or "" for choice in commands._choices_actions}
        width = max(map(len, texts))
        grouped = {name for names in _GROUPS.values() for name in names}
        groups = {**_GROUPS, "others": (*_GROUPS["others"], *(name for name in texts if name not in grouped))}
        lines = [f"usage: {self.short_usage()}", "", self.description or "", ""]
        for title, names in groups.items():
            lines += [f"{title}:", *(f"    {name:{width}}  {texts[name]}" for name in names if name in texts), ""]
        lines += ["options:", "    -h, --help     show this help", "    -V, --version  show the version", ""]
        return "\n".join([*lines, self.epilog or "", ""])


def _parser() -> argparse.ArgumentParser:
    """The commands of every capability that was built, and of the studies."""
    parser = _TopParser(
        prog=_program(),
        description="Measure, repair, deform and match meshes, and solve equations on them.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog=_EPILOG + EXIT_CODES,
    )
    parser.add_argument("-V", "--version", action="version", version=f"tautline {_build.VERSION}")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True, parser_class=Parser)
    for capability in filter(_vtk.available, _vtk.CAPABILITIES):
        import_module(f".{capability}", __package__).add_commands(commands)
    text = "regenerate tables and figures of the dissertation; `study list` lists the studies"
    study = commands.add_parser("study", add_help=False, help=text)
    study.add_argument("arguments", nargs=argparse.REMAINDER)
    study.set_defaults(run=_run_study, quiet=False, json=False)
    help_ = commands.add_parser("help", help="show this help, or the help of a command")
    help_.add_argument("name", metavar="COMMAND", nargs="?", choices=[*commands.choices], help="a command")

    def show(arguments: argparse.Namespace) -> int:
        (commands.choices[arguments.name] if arguments.name else parser).print_help()
        return 0

    help_.set_defaults(run=show, quiet=False, json=False)
    return parser


def _run_study(arguments: argparse.Namespace) -> int:
    """Run a study: a build tree has them in the package, an installation in the folder of the documentation package."""
    if _build.DOCUMENTS not in _folders:
        _folders.append(_build.DOCUMENTS)
    if find_spec(".studies", __package__) is None:
        print("tautline: the studies are not installed: install the documentation package (Debian: tautline-doc), or "
              "run the command in a checkout, after ./run build", file=sys.stderr)  # fmt: skip
        return 2
    return int(import_module(".studies", __package__).main(arguments.arguments))


def _show_warning(message: Warning | str, *_place: Any, **_options: Any) -> None:
    """A warning as a sentence, without the source line that issued it."""
    print(f"tautline: warning: {message}", file=sys.stderr)


def main(arguments: list[str] | None = None) -> int:
    """Run a command. Returns 0, 1 after an error, which is printed to stderr, or 130 after Ctrl-C.

    Wrong usage exits with 2.
    """
    parsed = _parser().parse_args(arguments)
    _vtk.CLASSES["vtkUpdateGuard"].EndWithMessage()
    try:
        _start.restore()
        check_outputs(parsed)
        with warnings.catch_warnings(), standard_input(parsed), reporting(not parsed.quiet):
            warnings.showwarning = _show_warning
            return parsed.run(parsed) or 0
    except Error as error:
        print(f"tautline: {error}", file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt:
        print("tautline: interrupted", file=sys.stderr)
        return _start.INTERRUPTED
    except BrokenPipeError:  # ... | head
        sys.stderr.close()
        return 1


if __name__ == "__main__":
    sys.exit(main())
