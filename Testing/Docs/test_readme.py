# SPDX-License-Identifier: BSD-3-Clause
"""test_readme.py SOURCE BUILD WORK PVPYTHON...: runs every example of README.md and Plugin/Site.

A comment before each block of code states how: <!-- test: sh -->, python3, pvpython (PVPYTHON and its arguments run
it), file NAME (saves it), install (runs it with this build tree), prefix (runs it and then checks that what it sets
exists), skip. The blocks of a page run one after the other in one directory, which has the sample meshes in Data.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

NOISE = 8  # of a color, 0 to 255
FILLED = 0.2  # of the middle of a picture, at least
BLOCK = re.compile(
    r"^(?:<!-- test: (?P<how>[^>]+?) -->\n)?```(?P<language>[\w{}]*)\n(?P<code>.*?)^```$", re.MULTILINE | re.DOTALL
)
WRONG = re.compile(r"Traceback|ERR\||ERROR")  # pvpython does not fail when a filter does
PATHS = '"$PYTHONPATH/tautline" "$PV_PLUGIN_PATH"/Tautline "$CMAKE_PREFIX_PATH"/include'
LOOK = f'for path in {PATHS}; do ls -d "$path"; done'


def run(command: list, work: Path, environment: dict) -> None:
    out, err = subprocess.PIPE, subprocess.STDOUT
    done = subprocess.run(command, cwd=work, env=environment, stdout=out, stderr=err, text=True)
    print(done.stdout, flush=True)
    if done.returncode != 0 or WRONG.search(done.stdout):
        sys.exit(f"this example does not work (exit code {done.returncode})")


def check_whole(picture: Path) -> None:
    """The drawing lies within the picture and fills it: no drawn pixel on its border, some in its middle half."""
    reader = vtkPNGReader()
    reader.SetFileName(str(picture))
    reader.Update()
    width, height, _ = reader.GetOutput().GetDimensions()
    pixels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).reshape(height, width, -1).astype(int)
    drawn = abs(pixels - pixels[-1, 0]).max(axis=2) > NOISE
    middle = drawn[height // 4 : 3 * height // 4, width // 4 : 3 * width // 4]
    if drawn[:, 0].any() or drawn[0].any() or drawn[-1].any() or middle.mean() < FILLED:
        sys.exit(f"{picture.name} does not show the whole mesh: {middle.mean():.2f} of its middle is drawn")


def environment_of(build: Path, home: Path) -> dict:
    """The variables that ./run env sets; python3 is the interpreter of this script."""
    environment = dict(os.environ, CMAKE_PREFIX_PATH=str(build), HOME=str(home))
    environment["PATH"] = f"{build / 'bin'}:{Path(sys.executable).parent}:{os.environ['PATH']}"
    environment["PYTHONPATH"] = str(build / "lib/python3/dist-packages")
    environment["PV_PLUGIN_PATH"] = str(next(build.glob("lib*/**/plugins"), ""))
    return environment


def run_page(page: Path, build: Path, work: Path, pvpython: list) -> int:
    """Run the examples of a page; returns their number."""
    environment = environment_of(build, work)
    ran = 0
    for block in BLOCK.finditer(page.read_text(encoding="utf-8")):
        how, code = block["how"], block["code"]
        if how is None and block["language"] in ("", "{toctree}", "{include}"):  # no example
            continue
        print(f"--- {page.name}: {how}\n{code}", flush=True)
        if how is None:
            sys.exit('this block has no comment "test: ..." before it')
        kind, _, name = how.partition(" ")
        if kind == "skip" or (kind == "pvpython" and not pvpython):
            continue
        if kind == "file":
            (work / name).write_text(code, encoding="utf-8")
            continue
        script = work / f"example.{kind}"
        changed = {"install": code.replace("install build", f"install '{build}'"), "prefix": code + LOOK}
        script.write_text(changed.get(kind, code))
        interpreters = {"python3": [sys.executable], "pvpython": pvpython}
        run([*interpreters.get(kind, ["bash", "-eu"]), str(script)], work, environment)
        ran += 1
    return ran


def main(source: Path, build: Path, work: Path, pvpython: list) -> None:
    shutil.rmtree(work, ignore_errors=True)
    for page in (source / "README.md", *sorted((source / "Plugin/Site").glob("*.md"))):
        directory = work / page.stem
        directory.mkdir(parents=True)
        (directory / "Data").symlink_to(source / "Data")
        ran = run_page(page, build, directory, pvpython)
        print(f"{page.name}: {ran} examples work")
        if page.name == "README.md" and not ran:
            sys.exit("README.md has no example")
        if (directory / "bracket.png").exists():
            check_whole(directory / "bracket.png")


if __name__ == "__main__":
    main(*(Path(argument).resolve() for argument in sys.argv[1:4]), sys.argv[4:])
