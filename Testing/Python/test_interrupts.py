# SPDX-License-Identifier: BSD-3-Clause
"""Ctrl-C, progress callbacks and time limits end every long function, and leave no partial file.

test_interrupts.py PART [NAME], where PART is signal, cancel, limit, shell or some, and NAME an operation. Every
operation would take much longer than the test waits. SIGINT is sent after the operation has reported its first
progress, by another process, because Python executes no other code meanwhile. The times to the end are printed; the
bound that is checked is generous, because the machine may be busy. The time that an operation computes between two
polls does not depend on that: it is CPU time of the calling thread, and has a bound of its own. So is what it computes
after its time limit: CPU time of the process.
"""

import os
import signal
import subprocess
import sys
import time
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Iterator

import tautline as tl
from checks import OUT, wording
from interrupted_operations import BEST, LIMIT, OPERATIONS, commands, cube, write_input
from tautline._interrupts import reporting
from tautline._vtk import CLASSES

INTERRUPTION = CLASSES["vtkInterruption"]

ENDS_WITHIN = 20.0  # seconds, on a busy machine; a second on an idle one
UNPOLLED = 0.7  # seconds of CPU time between two polls; a loop without a poll takes longer
DELAY = 0.5  # seconds from the first progress to SIGINT
TIME_LIMIT = 1.0
#: Seconds of CPU time of the whole process after the time limit: at most 1 on an idle machine, where processes do not
#: share the units of a core.
OVERRUN = 1.5
#: Where a result of 750,000 tetrahedra is made after the limit; 2.9 were measured on an idle machine.
OVERRUN_OF = {"improve": 4.0}
#: Work that continues in the background after its end, and delays the next operation. Its CPU time also counts.
IN_BACKGROUND = ("warp factorization", "solve factorization", "condition accurate", "solver study")
OVERRUN_IN_BACKGROUND = 4.0
#: Operations that the part `some` interrupts, in pvpython: one of each kind.
SOME = ("quality", "optimize local newton", "solve factorization")

#: The work of a child: the command of the shell in argv[1:], with a report of the first progress.
CHILD = """
import sys
from tautline import _interrupts
from tautline.__main__ import main
def progress(fraction, text):
    if not progress.begun:
        print("progress", flush=True)
    progress.begun = True
progress.begun = False
with _interrupts.reporting(progress):
    code = main(sys.argv[1:])
sys.exit(code)
"""


class SignalAtProgress:
    """A progress callback that has SIGINT sent to this process, DELAY after its first call."""

    def __init__(self) -> None:
        self.began: float | None = None
        self.sender: subprocess.Popen | None = None

    def __call__(self, fraction: float, text: str) -> None:
        if self.began is None:
            self.began = time.monotonic()
            self.sender = subprocess.Popen(["sh", "-c", f"sleep {DELAY}; kill -INT {os.getpid()}"])


@contextmanager
def polling(name: str) -> Iterator[None]:
    """A block in which no more than UNPOLLED is computed between two polls."""
    INTERRUPTION.MeasurePolls(True)
    try:
        yield
    finally:
        seconds = INTERRUPTION.GetLongestUnpolledSeconds()
        INTERRUPTION.MeasurePolls(False)
        print(f"  {name}: computes at most {seconds:.3f} s between two polls", flush=True)
        assert seconds < UNPOLLED, f"{name} computed {seconds:.2f} s without a poll"


def show(name: str, seconds: float, after: str) -> None:
    print(f"  {name}: ended {seconds:.2f} s after {after}", flush=True)
    assert seconds < ENDS_WITHIN, f"{name} ended only {seconds:.1f} s after {after}"


def check_signal(name: str) -> None:
    progress = SignalAtProgress()
    before = signal.getsignal(signal.SIGINT)
    try:
        with polling(name):
            OPERATIONS[name][0](progress=progress)
    except KeyboardInterrupt:
        show(name, time.monotonic() - progress.began - DELAY, "Ctrl-C")
    else:
        raise AssertionError(f"{name} was not interrupted")
    assert progress.sender.wait() == 0
    assert signal.getsignal(signal.SIGINT) is before
    # The next operation is not interrupted.
    assert tl.domain("wrench").GetNumberOfCells() > 0


def check_cancel(name: str) -> None:
    began: list[float] = []

    def progress(fraction: float, text: str) -> bool:
        assert 0 <= fraction <= 1 and text
        began.append(time.monotonic())
        return began[-1] - began[0] < DELAY

    try:
        with polling(name):
            OPERATIONS[name][0](progress=progress)
    except tl.Aborted:
        show(name, time.monotonic() - began[-1], "False")
    else:
        raise AssertionError(f"{name} was not cancelled")


def check_callbacks() -> None:
    class Special(Exception):
        pass

    def failing(fraction: float, text: str) -> None:
        raise Special

    for function, expected in ((failing, Special), (lambda *_: False, tl.Error)):
        try:
            tl.domain("wrench", progress=function)
        except expected:
            continue
        raise AssertionError(f"{expected} was not raised")
    assert tl.domain("wrench", progress=lambda *_: None).GetNumberOfCells() > 0


def check_writer() -> None:
    """VTK's writers of XML files do not ask whether they are to go on: they are ended, and the older file stays."""
    file = OUT / "interrupts.vtu"
    tl.write(tl.domain("wrench"), str(file))
    before = file.read_bytes()
    mesh = cube(60)
    cancelled: list[float] = []

    def progress(fraction: float, text: str) -> bool:
        if fraction > 0:
            cancelled.append(time.process_time())
        return not cancelled

    try:
        with reporting(progress):
            tl.write(mesh, str(file))
    except tl.Aborted:
        seconds = time.process_time() - cancelled[-1]
    else:
        raise AssertionError("the writer was not cancelled")
    print(f"  writer: computed {seconds:.3f} s after False", flush=True)
    assert len(cancelled) == 1 and seconds < UNPOLLED, (cancelled, seconds)
    assert file.read_bytes() == before and not list(OUT.glob(".interrupts*")), list(OUT.iterdir())
    tl.write(tl.domain("wrench"), str(file))  # the next one is not cancelled
    assert tl.read(str(file)).GetNumberOfCells() > 0
    file.unlink()


class CpuAtLimit:
    """The CPU time of this process at its time limit, read by another process: Python executes nothing meanwhile."""

    TICKS = 11, 12  # of the fields of /proc/PID/stat after the name: utime and stime

    def __init__(self) -> None:
        script = f"sleep {TIME_LIMIT}; cat /proc/{os.getpid()}/stat"
        self.reader = subprocess.Popen(["sh", "-c", script], stdout=subprocess.PIPE, text=True)

    def overrun(self) -> float:
        """Seconds of CPU time since then, of all threads."""
        now = sum(os.times()[:2])
        fields = self.reader.communicate()[0].rpartition(")")[2].split()
        return now - sum(int(fields[k]) for k in self.TICKS) / os.sysconf("SC_CLK_TCK")


def check_limit(name: str) -> None:
    operation, outcome = OPERATIONS[name]
    with suppress(tl.Aborted):  # makes the input, which is kept
        operation(progress=lambda *_: False)
    began = time.monotonic()
    cpu = CpuAtLimit()
    try:
        with polling(name):
            operation(time_limit=TIME_LIMIT)
    except tl.Error as error:
        assert outcome != BEST and wording("time-limit") in str(error), (name, str(error))
    else:
        assert outcome != LIMIT, f"{name} did not end at its time limit"
    overrun = cpu.overrun()
    show(name, time.monotonic() - began, f"the start, with a limit of {TIME_LIMIT} s")
    print(f"  {name}: {overrun:.2f} s of CPU time after the limit", flush=True)
    allowed = OVERRUN_IN_BACKGROUND if name in IN_BACKGROUND else OVERRUN_OF.get(name, OVERRUN)
    assert overrun < allowed, f"{name} computed {overrun:.2f} s after its time limit"


def check_shell() -> None:
    mesh = write_input()
    folder = OUT / "interrupts"
    folder.mkdir(exist_ok=True)
    for name, arguments in commands(mesh).items():
        for file in folder.iterdir():
            file.unlink()
        child = subprocess.Popen(
            [sys.executable, "-c", CHILD, *arguments], cwd=folder, text=True, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
        )  # fmt: skip
        # The first progress of these commands comes from the reader or the domain; later ones are as good.
        assert child.stdout.readline() == "progress\n", (name, child.communicate())
        time.sleep(DELAY)
        child.send_signal(signal.SIGINT)
        began = time.monotonic()
        errors = child.communicate(timeout=10 * ENDS_WITHIN)[1]
        assert (child.returncode, errors) == (130, "tautline: interrupted\n"), (name, child.returncode, errors)
        show(f"shell, {name}", time.monotonic() - began, "Ctrl-C")
        assert not list(folder.iterdir()), (name, list(folder.iterdir()))
    Path(mesh).unlink()


def check_start() -> None:
    """Ctrl-C while the command imports the package: no traceback, and the exit code of shells."""
    script = Path(tl.__file__).resolve().parents[0]
    for folder in Path(tl.__file__).parents:
        script = folder / "bin" / "tautline"
        if script.exists():
            break
    for command in ([sys.executable, "-m", "tautline"], [sys.executable, str(script)]):
        for library in ("vtkCommonCore", "vtkFiltersCore"):
            child = subprocess.Popen([*command, "domain", "disk", "--cells", "3000000", "-o", "/dev/null"], text=True,
                                     stderr=subprocess.PIPE, stdout=subprocess.DEVNULL)  # fmt: skip
            maps = Path(f"/proc/{child.pid}/maps")
            while library not in maps.read_text():  # the import of the package has begun, or has gone on
                time.sleep(0.001)
            child.send_signal(signal.SIGINT)
            errors = child.communicate(timeout=10 * ENDS_WITHIN)[1]
            assert (child.returncode, errors) == (130, "tautline: interrupted\n"), (command, library, errors)


if __name__ == "__main__":
    part, chosen = sys.argv[1], sys.argv[2:]
    checks = {"signal": check_signal, "cancel": check_cancel, "limit": check_limit}
    if part == "shell":
        check_start()
        check_callbacks()
        check_writer()
        check_shell()
    elif part == "some":
        for operation in SOME:
            check_signal(operation)
    else:
        for operation in chosen or OPERATIONS:
            # A limit in a process of its own: what a large mesh leaves in the heap would slow the next operation.
            if (operation in IN_BACKGROUND or part == "limit") and not chosen:
                subprocess.run([sys.executable, __file__, part, operation], check=True)
            else:
                checks[part](operation)
