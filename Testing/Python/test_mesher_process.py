# SPDX-License-Identifier: BSD-3-Clause
"""The program of the meshers ends with the process that started it; where it is missing, an error names the package."""

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import tautline as tl
from checks import DATA, OUT, rejected, run_tests, wording

CUBE = DATA / "cube.smesh"
OWN = Path(tl.__file__).parents[4]  # of lib/python3/dist-packages/tautline
START_SECONDS, END_SECONDS = 60, 20
ENDLESS = ["tet-mesh", str(CUBE), "--volume", "1e-8"]  # takes minutes


def children(process: int) -> list[int]:
    """The processes that a process has started, and those that these have started."""
    found = []
    for entry in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = entry.read_text().rpartition(")")[2].split()
        except OSError:  # it has ended
            continue
        if int(fields[1]) == process and fields[0] != "Z":
            found.append(int(entry.parent.name))
    return found + [child for process in found for child in children(process)]


def runs(process: int) -> bool:
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def wait_until(condition, seconds: float) -> bool:
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.05)
    return True


def check_end(number: int) -> None:
    """A signal to a command ends its mesher, and TetGen, which is a child of it, and removes the folder of TetGen."""
    with tempfile.TemporaryDirectory(dir=OUT) as folder:
        command = [sys.executable, "-m", "tautline", *ENDLESS, "-o", str(OUT / "never.vtu")]
        process = subprocess.Popen(command, env=dict(os.environ, TMPDIR=folder), stderr=subprocess.DEVNULL)
        try:
            # The program and the child of it with TetGen.
            assert wait_until(lambda: len(children(process.pid)) == 2, START_SECONDS), children(process.pid)
            assert wait_until(lambda: os.listdir(folder), START_SECONDS)
            started = children(process.pid)
            os.kill(process.pid, number)
            process.wait(END_SECONDS)
            assert wait_until(lambda: not any(map(runs, started)), END_SECONDS), f"{started} run after signal {number}"
            assert wait_until(lambda: not os.listdir(folder), END_SECONDS), os.listdir(folder)
        finally:
            process.kill()
            process.wait()


def test_terminated():
    check_end(signal.SIGTERM)


def test_killed():
    check_end(signal.SIGKILL)


def test_interrupted():
    check_end(signal.SIGINT)


def test_time_limit():
    """The limit of the filter ends the program as well."""
    rejected(wording("time-limit"), tl.tet_mesh, CUBE, volume=1e-8, time_limit=1)
    assert wait_until(lambda: not children(os.getpid()), END_SECONDS), children(os.getpid())


def test_missing():
    for name, text in {
        "/no/such/program": wording("there-is-none-at"),
        "/bin/true": wording("ended-without-a-result"),  # as a program that crashes
    }.items():
        os.environ["TAUTLINE_MESHER"] = name
        try:
            rejected(text, tl.tet_mesh, CUBE)
            rejected(name, tl.triangle_mesh, DATA / "plate.poly")
            rejected(name, tl.domain, "disk2d")
        finally:
            del os.environ["TAUTLINE_MESHER"]
    assert tl.tet_mesh(CUBE).mesh.GetNumberOfCells() > 0


def test_not_installed():
    """Without the package of the program: a copy of the libraries, with no program beside them."""
    top = OUT / "no-mesher"
    shutil.rmtree(top, ignore_errors=True)
    left_out = shutil.ignore_patterns("paraview-*", "cmake", "*.a")
    shutil.copytree(OWN / "lib", top / "lib", symlinks=True, ignore=left_out)
    script = "import tautline as tl; print(tl.quality(tl.domain('rectangle')).inverted); tl.domain('disk2d')"
    package = top / "lib/python3/dist-packages"
    environment = dict(os.environ, PYTHONPATH=str(package), LD_LIBRARY_PATH=str(top / "lib"))
    done = subprocess.run([sys.executable, "-c", script], env=environment, capture_output=True, text=True)
    assert done.stdout == "0\n" and done.returncode == 1, done
    assert wording("install-the-debian-package-meshers") in done.stderr, done.stderr


def test_version():
    """A program of another version is an error on both sides."""
    program = OUT / "other-mesher"
    own = OWN / "libexec/tautline/tautline-mesher"
    program.write_text(f'#!/bin/sh\nexec "{own}" 0.0.1 "$2"\n')
    program.chmod(0o755)
    os.environ["TAUTLINE_MESHER"] = str(program)
    try:
        rejected(wording("same-version-of-both"), tl.tet_mesh, CUBE)
    finally:
        del os.environ["TAUTLINE_MESHER"]


run_tests(globals())
