# SPDX-License-Identifier: BSD-3-Clause
"""The version stands in one place; a Python that cannot use the compiled modules gets one sentence; the command works;
the studies are part of the documentation package.

test_build.py VERSION COMMAND MANUAL: the project's version, the command tautline, the directory of its manual.
"""

import gzip
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import tautline
from checks import OUT, wording
from tautline import _build, _vtk
from tautline.__main__ import _parser

VERSION, COMMAND, MANUAL = sys.argv[1], sys.argv[2], Path(sys.argv[3])
PACKAGE = Path(tautline.__file__).parent
COMPLETE = """source {file}; COMP_WORDS=(tautline {words}); COMP_CWORD={last}; _tautline; echo "${{COMPREPLY[*]}}" """


def run(*command: str, **environment: str) -> subprocess.CompletedProcess:
    return subprocess.run(command, capture_output=True, text=True, env=dict(os.environ, **environment))


def check_version() -> None:
    assert tautline.__version__ == VERSION != "", tautline.__version__
    for command in ([COMMAND], [sys.executable, "-m", "tautline"]):
        done = run(*command, "--version")
        assert (done.returncode, done.stdout) == (0, f"tautline {VERSION}\n"), done


def check_sentences() -> None:
    """The message for each kind of wrong Python; none for the right one."""
    build = json.loads((PACKAGE / "build.json").read_text())
    assert _build.problem(build) == ""
    assert _build.problem({}).startswith("these are the sources")
    assert wording("built-for-python-2-1") in _build.problem(dict(build, python="2.1"))
    assert wording("built-with-vtk-1-2-3") in _build.problem(dict(build, vtk="1.2.3"))
    assert f"use {sys.executable} or pvpython" in _build.problem(dict(build, vtk="1.2.3"))


def copy_of_package(name: str, **record: str) -> Path:
    """The package as it is installed, without studies, with entries of its record of the build changed; its folder."""
    package = OUT / name / "tautline"
    package.mkdir(parents=True, exist_ok=True)
    for source in [*PACKAGE.glob("*.py"), *PACKAGE.glob("*.so")]:
        (package / source.name).unlink(missing_ok=True)
        (package / source.name).symlink_to(source)
    build = json.loads((PACKAGE / "build.json").read_text())
    (package / "build.json").write_text(json.dumps(dict(build, **record)))
    return package.parent


def check_wrong_python() -> None:
    """One line on standard error from the command, an ImportError with the same sentence from import."""
    path = str(copy_of_package("another", python="2.1"))
    done = run(sys.executable, "-m", "tautline", "metrics", PYTHONPATH=path)
    assert done.returncode == 1 and done.stdout == "", done
    assert re.fullmatch(r"tautline: .*built for Python 2\.1.*\n", done.stderr), done.stderr
    done = run(sys.executable, "-c", "import tautline", PYTHONPATH=path)
    assert wording("importerror-tautline-was-built-for-python-2") in done.stderr, done.stderr


def check_studies() -> None:
    """The studies run where the documentation package is installed; exit code 2 without it."""
    documents = OUT / "documents"
    (documents / "studies").unlink(missing_ok=True)
    command = (sys.executable, "-m", "tautline", "study", "list")
    path = dict(PYTHONPATH=str(copy_of_package("installed", documents="../../documents")),
                LD_LIBRARY_PATH=str(PACKAGE.parents[2]))  # fmt: skip
    done = run(*command, **path)
    assert done.returncode == 2 and wording("the-studies-are-not-installed") in done.stderr, done
    documents.mkdir(exist_ok=True)
    (documents / "studies").symlink_to(PACKAGE / "studies")
    done = run(*command, **path)
    assert done.returncode == 0 and "peridynamics_kernel" in done.stdout, done


def check_python_without_vtk() -> None:
    code = "import sys; sys.path.append(sys.argv[1]); sys.argv[0] = '-m'; import tautline"
    done = run(sys.executable, "-I", "-S", "-c", code, str(PACKAGE.parent))
    assert done.returncode == 1 and re.fullmatch(r"tautline: .* has no VTK: use .*\n", done.stderr), done.stderr


def check_manual() -> None:
    """Every command is in the manual page and every option in the completion."""
    page = gzip.decompress((MANUAL / "tautline.1.gz").read_bytes()).decode()
    assert f'"tautline {VERSION}"' in page.replace("\\", ""), page[:100]
    names = {name for action in _parser()._actions if action.choices for name in action.choices}
    assert names and {line[4:].replace("\\", "") for line in page.splitlines() if line.startswith(".SS ")} == names
    file = MANUAL / "tautline.bash"
    for words, expected in (("unt", "untangle"), ("warp --rot", "--rotate"), ("field --cell tet", "tetrahedron")):
        complete = COMPLETE.format(file=file, words=words, last=len(words.split()))
        assert run("bash", "-c", complete).stdout.split() == [expected], words
    assert set(run("bash", "-c", COMPLETE.format(file=file, words="''", last=1)).stdout.split()) >= names


if __name__ == "__main__":
    assert _vtk.MODULES
    check_version()
    check_sentences()
    check_wrong_python()
    check_studies()
    check_python_without_vtk()
    check_manual()
