# SPDX-License-Identifier: BSD-3-Clause
"""All studies, and one HTML report of them: per table and figure the dissertation's numbers, ours, verdict, picture."""

from __future__ import annotations

import argparse
import contextlib
import csv
import io
import os
import sys
import time
from importlib import import_module
from pathlib import Path

from tautline._errors import Error
from tautline._files import make_folder, replace_text

from . import described, names
from ._page import Study, page

#: Pixels, of the pictures in the report.
WIDTH = 900


def main(arguments: list[str]) -> int:
    made = argparse.ArgumentParser(prog="python3 -m tautline study all", description=__doc__)
    made.add_argument("--small", action="store_true", help="small meshes: minutes; without verdicts")
    made.add_argument("--out", type=Path, default=Path("studies"), metavar="DIR",
                      help="directory of the report, report.html, and of a directory per study (%(default)s)")
    made.add_argument("--studies", nargs="+", metavar="NAME", help="these only (default: all)")
    made.add_argument("--reuse", action="store_true", help="do not run studies whose results are in the directory")
    made.add_argument("--width", type=int, default=WIDTH, metavar="PIXELS",
                      help="largest width of the pictures in the report (%(default)s)")
    made.add_argument("--data", metavar="FOLDER", help="silhouettes for figures and shapes (default: synthetic)")
    given = made.parse_args(arguments)
    known = studies()
    chosen = given.studies or known
    for name in chosen:
        if name not in known:
            raise Error(f"there is no study '{name}'; there are {', '.join(known)}")
    make_folder(given.out)
    found = {name: result(name, given) for name in chosen}
    replace_text(given.out / "report.html", page(found, given.small, given.width))
    failed = [name for name, study in found.items() if study.error]
    print(f"{given.out / 'report.html'}: {len(found)} studies" + (f"; failed: {', '.join(failed)}" if failed else ""))
    return 1 if failed else 0


def studies() -> list[str]:
    """The names of the other studies."""
    return [name for name in names() if name != "all"]


def result(name: str, given: argparse.Namespace) -> Study:
    """Run a study, unless its results are to be reused, and read what it wrote; an error is part of the report."""
    folder = given.out / name
    text = described(name)
    if given.reuse and (folder / "findings.csv").is_file():
        return Study(name, text, folder, findings(folder))
    options = ["--out", str(folder)] + (["--small"] if given.small else [])
    if name == "shapes" and sys.platform == "linux" and not os.environ.get("DISPLAY"):
        options.append("--no-pictures")  # they are rendered
    if given.data and name in ("figures", "shapes"):
        options += ["--data", given.data]
    print(f"{name} ...", file=sys.stderr, flush=True)
    began = time.process_time()
    try:
        with contextlib.redirect_stdout(io.StringIO()):
            import_module(f".{name}", __package__).main(options)
    except Error as error:
        return Study(name, text, folder, [], str(error))
    print(f"{name}: {time.process_time() - began:.1f} CPU s", file=sys.stderr, flush=True)
    return Study(name, text, folder, findings(folder))


def findings(folder: Path) -> list[dict[str, str]]:
    """The findings of a study; those of older formats have yes and no for verdicts."""
    with open(folder / "findings.csv", encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    words = {"yes": "holds", "no": "does not hold"}
    return [{"source": row["source"], "finding": row["finding"], "figures": row.get("figures", ""),
             "verdict": row["verdict"] if "verdict" in row else words[row["holds"]]} for row in rows]
