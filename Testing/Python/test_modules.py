# SPDX-License-Identifier: BSD-3-Clause
"""Files of the package import from lower floors only; a missing optional module is skipped, a broken one raises."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import tautline
from checks import OUT
from tautline import _vtk

PACKAGE = Path(tautline.__file__).parent
LIBRARIES = PACKAGE.parents[2]  # lib/ of lib/python3/dist-packages/tautline: the compiled modules need its libraries
LIST = "import tautline; print(*(n for n in ('warp', 'match', 'vtkShapeMatcher', 'quality') if hasattr(tautline, n)))"
PARTS = tuple(path.stem for path in PACKAGE.glob("_*_parts.py"))
#: The floors of the package below the capabilities, which do not import each other; _metrics serves three of them.
FLOORS = (
    ("_build", "_start"),
    ("_choices", "_vtk"),
    ("_cell_names", "_classes", "_deck_numbers", "_interrupts", "_names"),
    ("_errors",),
    ("_arrays", "_files", "_formats", "_tables"),
    ("_binary_coordinates", "_determinants", "_grid_checks", "_views"),
    ("_error_estimate", "_packing"),
    ("_arguments", "_foam_case", "_groups", "_legacy", "_pictures", "_reading", "_surfaces", "_unv", "_vtk_readers",
     "_vtk_writers"),
    ("_array_templates", "_meshio", "_nastran", "_su2", "_template"),
    ("_mesh",),
    ("_io", "_results"),
    ("_certificate", "_commands"),
    ("_html", "_metrics", "_state", "_state_runner"),  # the runner is a script that imports the whole package
    PARTS,
    ("_quality",),
)
#: Modules that call functions of several capabilities.
ABOVE = ("_adapt",)
TYPE_CHECKING = re.compile(r"^if TYPE_CHECKING:\n(    .*\n)+", re.MULTILINE)
IMPORT = re.compile(r"^\s*from \.(\w*) import (.*)$", re.MULTILINE)


def check_floors() -> None:
    floor = {file: number for number, files in enumerate(FLOORS) for file in files}
    floor = {file: len(FLOORS) for file in _vtk.CAPABILITIES} | floor | {file: len(FLOORS) + 1 for file in ABOVE}
    files = [path for path in PACKAGE.glob("_*.py") if not path.stem.startswith("__")]
    absent = {file for file in _vtk.CAPABILITIES if not _vtk.available(file)}  # which are generated with their modules
    assert {path.stem for path in files} == set(floor) - absent, "list new files in FLOORS or in CAPABILITIES"
    for path in files:
        text = TYPE_CHECKING.sub("", path.read_text(encoding="utf-8"))
        for module, names in IMPORT.findall(text):
            for imported in [module] if module else names.split(", "):
                assert floor[imported] < floor[path.stem], f"{path.name} must not import {imported}"


def copy_package(name: str) -> Path:
    """A copy of the Python files, with links to the compiled modules, in a directory of its own."""
    top = OUT / "modules" / name
    shutil.rmtree(top, ignore_errors=True)
    package = top / "tautline"
    shutil.copytree(PACKAGE, package, ignore=shutil.ignore_patterns("*.so", "__pycache__"))
    for module in PACKAGE.glob("*.so"):
        (package / module.name).symlink_to(module)
    return package


def run(package: Path, *arguments: str) -> subprocess.CompletedProcess:
    """Runs python3 with the copy of the package."""
    environment = dict(os.environ, PYTHONPATH=str(package.parent), LD_LIBRARY_PATH=str(LIBRARIES))
    return subprocess.run([sys.executable, *arguments], env=environment, capture_output=True, text=True)


def check_complete() -> None:
    package = copy_package("complete")
    done = run(package, "-c", f"{LIST}; print(tautline.__file__)")
    assert done.stdout.split() == ["warp", "match", "vtkShapeMatcher", "quality", str(package / "__init__.py")], done
    assert "    match " in run(package, "-m", "tautline", "--help").stdout


def check_missing() -> None:
    package = copy_package("missing")
    (package / "TautlineShapes.so").unlink()
    done = run(package, "-c", LIST)
    assert done.returncode == 0 and done.stdout.split() == ["warp", "quality"], done
    done = run(package, "-m", "tautline", "--help")
    assert done.returncode == 0 and "    warp " in done.stdout and "    match " not in done.stdout, done
    done = run(package, "-c", "import tautline._vtk; tautline._vtk.vtkShapeMatcher")
    message = "vtkShapeMatcher is in none of the compiled modules that were built: TautlineAdaptation, TautlineCore"
    assert message in done.stderr, done


def check_broken(name: str, expected: str, breaks) -> None:
    package = copy_package(name)
    breaks(package)
    for arguments in (("-c", "import tautline"), ("-m", "tautline", "--help")):
        done = run(package, *arguments)
        assert done.returncode == 1 and expected in done.stderr, done


def add_line(file: str, line: str):
    """A change that adds a line at the end of a file of the copy."""

    def change(package: Path) -> None:
        path = package / file
        path.write_text(f"{path.read_text(encoding='utf-8')}\n{line}\n", encoding="utf-8")

    return change


def spoil_library(package: Path) -> None:
    (package / "TautlineShapes.so").unlink()
    (package / "TautlineShapes.so").write_bytes(b"not a library")


check_floors()
check_complete()
check_missing()
check_broken("import", "No module named 'no_such_module'", add_line("_shapes.py", "import no_such_module"))
check_broken("syntax", "SyntaxError", add_line("_domains.py", "def"))
check_broken("name", "cannot import name", add_line("_deformation.py", "from ._arrays import no_such_name"))
check_broken("library", "TautlineShapes.so", spoil_library)
