"""Studies that regenerate tables and figures of the dissertation: python3 -m tautline study NAME."""

from __future__ import annotations

from importlib import import_module
from pkgutil import iter_modules

from tautline._errors import Error


def names() -> list[str]:
    """The studies there are: the modules of this package whose names do not begin with _."""
    return sorted(found.name for found in iter_modules(__path__) if not found.name.startswith("_"))


def main(argv: list[str]) -> int:
    """Run the study argv[0] with the other arguments; `list` prints the names with a line on each."""
    if not argv or argv[0] in ("list", "-h", "--help"):
        for name in names():
            lines = (import_module(f"{__name__}.{name}").__doc__ or "").strip().splitlines()
            print(f"{name:16}{lines[0] if lines else ''}")
        return 0
    if argv[0] not in names():
        raise Error(f"there is no study '{argv[0]}'; there are {', '.join(names())}")
    return import_module(f"{__name__}.{argv[0]}").main(argv[1:]) or 0
