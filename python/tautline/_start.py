# SPDX-License-Identifier: BSD-3-Clause
"""Ctrl-C while a command of the shell still imports the package: it ends with a message and the exit code of shells.

Python would print a traceback. Imports nothing of the package, which comes later.
"""

from __future__ import annotations

import os
import signal
import sys

#: Exit code after Ctrl-C, as of shells: 128 and the number of SIGINT.
INTERRUPTED = 130
_MODULE = __package__


def _end(*_: object) -> None:
    """Handle SIGINT: nothing has to be cleaned up yet."""
    os.write(2, b"tautline: interrupted\n")
    os._exit(INTERRUPTED)


#: How restore() finds the handler, also the one of the script `tautline`.
setattr(_end, "ends_start", True)


def is_command() -> bool:
    """Whether this process is python3 -m tautline and Python still looks for the module to run."""
    given = list(getattr(sys, "orig_argv", []))  # since Python 3.10
    named = given[given.index("-m") + 1 :][:1] if "-m" in given else []
    return bool(sys.argv) and sys.argv[0] == "-m" and (not given or named in ([_MODULE], [f"{_MODULE}.__main__"]))


def end_on_interrupt() -> None:
    """End the process on Ctrl-C, until restore(), unless SIGINT is ignored or has a handler of its own."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _end)


def restore() -> None:
    """Make Ctrl-C raise KeyboardInterrupt again, if it ends the start of a command."""
    if getattr(signal.getsignal(signal.SIGINT), "ends_start", False):
        signal.signal(signal.SIGINT, signal.default_int_handler)
