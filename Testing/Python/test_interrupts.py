"""Ctrl-C, progress callbacks and time limits end every long function, and leave no partial file.

Each operation would take much longer than the test waits. A child process runs it and reports its first progress; only
then SIGINT is sent. The times that pass until the end are printed; the bound that is checked is generous, as the
machine may be busy.
"""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

from checks import OUT, run_tests
from interrupted_operations import LIMITED, OPERATIONS

ENDS_WITHIN = 15.0  # seconds; each operation takes more than twice as long
STARTS_WITHIN = 100.0
KEYBOARD_INTERRUPT = "KeyboardInterrupt"
CHILD = Path(__file__).with_name("interrupted_operations.py")
# pvpython of the test's command line, with what runs it.
PVPYTHON = sys.argv[1:]


def start(command: list, **options) -> subprocess.Popen:
    """Start a child and wait for its first progress."""
    child = subprocess.Popen(
        [*map(str, command)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options
    )
    lines, began = [], time.monotonic()
    for line in child.stdout:
        lines.append(line)
        if line.startswith("progress"):
            return child
        assert time.monotonic() - began < STARTS_WITHIN, (command, lines)
    raise AssertionError((command, child.wait(), lines))


def interrupt(name: str, command: list, **options) -> tuple[int, str]:
    """Interrupt a child; its exit code and the rest of its output."""
    child = start(command, **options)
    began = time.monotonic()
    child.send_signal(signal.SIGINT)
    try:
        output = child.communicate(timeout=ENDS_WITHIN)[0]
    except subprocess.TimeoutExpired:
        child.kill()
        raise AssertionError(f"{name} did not end within {ENDS_WITHIN} s after SIGINT") from None
    print(f"  {name}: ended {time.monotonic() - began:.2f} s after SIGINT", flush=True)
    return child.returncode, output


def test_interrupt() -> None:
    for name in OPERATIONS:
        code, output = interrupt(name, [sys.executable, CHILD, "function", name])
        assert code == 0 and KEYBOARD_INTERRUPT in output, (name, code, output)


def test_cancel() -> None:
    for name in OPERATIONS:
        done = subprocess.run(
            [sys.executable, CHILD, "cancel", name], capture_output=True, text=True, timeout=STARTS_WITHIN
        )
        assert done.returncode == 0 and "Aborted" in done.stdout, (name, done.returncode, done.stdout, done.stderr)
        seconds = float(done.stdout.split("seconds")[1])
        print(f"  {name}: ended {seconds:.2f} s after False", flush=True)
        assert seconds < ENDS_WITHIN, (name, seconds)


def test_time_limit() -> None:
    for name, (_, expected) in LIMITED.items():
        done = subprocess.run(
            [sys.executable, CHILD, "limit", name], capture_output=True, text=True, timeout=STARTS_WITHIN
        )
        assert done.returncode == 0 and expected in done.stdout, (name, expected, done.stdout, done.stderr)
        print(f"  {name}: {done.stdout.split('seconds')[1].strip()} s with a limit of 1 s", flush=True)


def test_pvpython() -> None:
    for name in ("optimize local newton", "condition accurate", "quality") if PVPYTHON else ():
        code, output = interrupt(name, [*PVPYTHON, CHILD, "function", name])
        assert code == 0 and KEYBOARD_INTERRUPT in output, (name, code, output)


def test_shell() -> None:
    folder = OUT / "interrupts"
    for name in OPERATIONS:
        folder.mkdir(exist_ok=True)
        for file in folder.iterdir():
            file.unlink()
        code, output = interrupt(f"shell, {name}", [sys.executable, CHILD, "shell", name], cwd=folder)
        if code == 77:
            continue
        assert code == 130 and output.splitlines()[-1] == "tautline: interrupted", (name, code, output)
        assert "Traceback" not in output, output
        assert not list(folder.iterdir()), (name, list(folder.iterdir()))


if __name__ == "__main__":
    os.environ["TAUTLINE_INTERRUPT_TEST"] = "1"
    run_tests(globals())
