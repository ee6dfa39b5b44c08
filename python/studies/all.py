# SPDX-License-Identifier: BSD-3-Clause
"""All studies, and one HTML report of them: per table and figure the dissertation's numbers, ours, verdict, picture."""

from __future__ import annotations

import argparse
import contextlib
import io
import sys
import time
import traceback
from importlib import import_module
from pathlib import Path

from tautline._errors import Error
from tautline._files import make_folder, replace_text

from . import described, names
from ._evidence import minutes, size_of
from ._page import Study, page, study_in

#: Pixels, of the pictures in the report.
WIDTH = 900
#: The file of a study's folder with the options of the run that ended there.
OPTIONS = "options.txt"
#: The studies with silhouettes.
WITH_DATA = ("figures", "shapes")


def main(arguments: list[str]) -> int:
    made = argparse.ArgumentParser(prog="python3 -m tautline study all", description=__doc__)
    size = made.add_mutually_exclusive_group()
    size.add_argument("--small", action="store_true", help="small meshes: minutes; without verdicts")
    size.add_argument("--record", action="store_true",
                      help="the sizes of the committed report, chosen for half an hour of CPU time for each study")
    made.add_argument("--out", type=Path, default=Path("studies"), metavar="DIR",
                      help="directory of the report, report.html, and of a directory per study (%(default)s)")
    made.add_argument("--studies", nargs="+", metavar="NAME", help="these only (default: all)")
    made.add_argument("--resume", action="store_true",
                      help="go on where a run into the same directory stopped: leave out studies that ended with these "
                      "options, and in the others the calculations that ended")
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
    if not given.small:
        _announce(chosen, given.record)
    found = {name: result(name, given, f"{i} of {len(chosen)}") for i, name in enumerate(chosen, 1)}
    replace_text(given.out / "report.html", page(found, given.small))
    failed = [name for name, study in found.items() if study.error]
    print(f"{given.out / 'report.html'}: {len(found)} studies" + (f"; failed: {', '.join(failed)}" if failed else ""))
    return 1 if failed else 0


def studies() -> list[str]:
    """The names of the other studies."""
    return [name for name in names() if name != "all"]


def _announce(chosen: list[str], record: bool) -> None:
    """Say on the standard error how long the studies took in the committed run."""
    known = {name: minutes(name) for name in chosen}
    lines = [f"{name:24} " + ("not known" if time is None else f"{time:6.1f} min") +
             (", at a reduced size" if size_of(name).reduced and not record else "") for name, time in known.items()]
    total = sum(time for time in known.values() if time is not None)
    print("CPU time of the committed run:", *lines, f"together {total / 60:.1f} h" +
          ("" if record else "; the full size takes longer where they are reduced"), sep="\n", file=sys.stderr)


def result(name: str, given: argparse.Namespace, place: str) -> Study:
    """Run a study, unless it ended before, and read what it wrote; an error is part of the report."""
    folder = given.out / name
    options = ["--small"] if given.small else list(size_of(name).options) if given.record else []
    if given.data and name in WITH_DATA:
        options += ["--data", given.data]
    ended = folder / OPTIONS
    if given.resume and ended.is_file() and ended.read_text(encoding="utf-8").split() == options:
        return _read(name, folder, given.width)
    expected = None if given.small else minutes(name)
    print(f"{place}: {name}" + ("" if expected is None else f", {expected:.1f} min in the committed run") + " ...",
          file=sys.stderr, flush=True)
    for file in (ended, *folder.glob("*.png")):  # of an earlier run
        file.unlink(missing_ok=True)
    began = time.process_time()
    try:
        with contextlib.redirect_stdout(io.StringIO()):
            more = ["--out", str(folder), *(["--resume"] if given.resume else [])]
            import_module(f".{name}", __package__).main(options + more)
    except Exception as error:  # hours of other studies do not depend on it
        traceback.print_exc()
        return Study(name, described(name), None, {}, str(error) or type(error).__name__)
    print(f"{place}: {name}, {time.process_time() - began:.1f} CPU s", file=sys.stderr, flush=True)
    replace_text(ended, " ".join(options))
    return _read(name, folder, given.width)


def _read(name: str, folder: Path, width: int) -> Study:
    """The output of a study; files of another version are its error."""
    try:
        return study_in(name, described(name), folder, width)
    except (KeyError, TypeError, ValueError) as error:
        return Study(name, described(name), None, {}, f"{folder} cannot be read ({error}): remove it")
