# SPDX-License-Identifier: BSD-3-Clause
"""test_typing.py SOURCE: the types of the package, by mypy, where it is installed."""

import shutil
import subprocess
import sys
from pathlib import Path

from checks import OUT, SKIPPED
from tautline import _vtk

SOURCE = Path(sys.argv[1])
PACKAGE = Path(_vtk.__file__).parent  # with the modules that are generated
USER = """\
import numpy as np
import tautline as tl

better = tl.optimize("part.vtu", preset="best shape", progress=True)
worst: float = better.statistics["imr"]["worst_after"]
tl.warp("part.vtu", np.zeros((3, 3)), "femwarp", fixed=np.zeros(3), preconditioner="boomeramg")
tl.vtkMeshWarp().SetAmount(1)
"""
#: A line that is wrong and mypy's message.
WRONG = {
    'tl.optimize("part.vtu", preset="best shpae")': 'Argument "preset" to "optimize" has incompatible type',
    'tl.untangle("part.vtu", "thorugh")': 'Argument 2 to "untangle" has incompatible type',
    'tl.solve("part.vtu", preconditioner="boomramg")': 'Argument "preconditioner" to "solve" has incompatible type',
    'tl.quality("part.vtu").verdit': '"QualityResult" has no attribute "verdit"',
    "tl.vtkMeshWrap()": 'Module has no attribute "vtkMeshWrap"',
    'tl.untangel("part.vtu")': 'Module has no attribute "untangel"',
}


def mypy(*arguments) -> subprocess.CompletedProcess:
    command = ["mypy", "--strict", f"--cache-dir={OUT / 'mypy'}", *map(str, arguments)]
    return subprocess.run(command, cwd=SOURCE, capture_output=True, text=True, env={"PATH": "/usr/bin:/bin",
                          "MYPYPATH": str(PACKAGE.parent)})  # fmt: skip


def test_package() -> None:
    done = mypy("-p", "tautline")
    assert done.returncode == 0, done.stdout + done.stderr


def test_users() -> None:
    file = OUT / "typed_user.py"
    file.write_text(USER)
    done = mypy(file)
    assert done.returncode == 0, done.stdout
    file.write_text(USER + "".join(f"{line}\n" for line in WRONG))
    found = mypy(file).stdout.splitlines()
    first = len(USER.splitlines()) + 1
    for number, (line, text) in enumerate(WRONG.items(), first):
        assert any(f":{number}: error: {text}" in said for said in found), (line, found)
    assert sum(": error: " in said for said in found) == len(WRONG), found


def check_classes() -> None:
    """The list of the classes for type checkers equals the classes that were built."""
    text = (PACKAGE / "_classes.py").read_text()
    listed = {line.split(" as ")[1] for line in text.splitlines() if line.startswith("from ._vtk")}
    built = {*_vtk.CLASSES, *_vtk.LATER}
    assert built <= listed, built - listed
    assert "TautlineMeshing" not in _vtk.MODULES or built == listed, listed - built


check_classes()
if shutil.which("mypy") is None:
    print("skipped: mypy is not installed")
    sys.exit(SKIPPED)
test_package()
test_users()
