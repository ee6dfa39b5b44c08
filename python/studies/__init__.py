# SPDX-License-Identifier: BSD-3-Clause
"""Studies that regenerate the tables and figures of the dissertation: python3 -m tautline study NAME.

Python imports them as tautline.studies. A build tree and the documentation package have them, the installed package
does not. A study is a module of this package with `main(arguments)`; its name is the module's name, and the first line
of its docstring describes it.
"""

from __future__ import annotations

from importlib import import_module
from pkgutil import iter_modules

from tautline._errors import unknown


def names() -> list[str]:
    """The names of the studies."""
    return sorted(found.name for found in iter_modules(__path__) if not found.name.startswith("_"))


def described(name: str) -> str:
    """The description of a study."""
    return (import_module(f"{__name__}.{name}").__doc__ or "").strip().split("\n")[0]


def main(arguments: list[str]) -> int:
    """Run a study with its own arguments; `list` prints the names and descriptions."""
    if not arguments or arguments[0] in ("list", "-h", "--help"):
        for name in names():
            print(f"{name:22} {described(name)}")
        return 0
    if arguments[0] not in names():
        raise unknown("study", arguments[0], names())
    return import_module(f"{__name__}.{arguments[0]}").main(arguments[1:]) or 0
