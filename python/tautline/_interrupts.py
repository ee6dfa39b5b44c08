# SPDX-License-Identifier: BSD-3-Clause
"""Ctrl-C and progress callbacks: how they end the computation of the compiled filters.

A filter runs inside updating(): there Ctrl-C, and a progress callback that returns False, end it within a moment. The
lowest of the shared files: it uses the compiled classes only.
"""

from __future__ import annotations

import signal
import sys
import threading
import time
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, Callable, Iterator, Optional, TextIO

from ._vtk import CLASSES

#: Is called with the fraction done, 0 to 1, and a text; False cancels the operation.
Progress = Callable[[float, str], Optional[bool]]

_SECONDS_BETWEEN_CALLS = 0.1
_SECONDS_BEFORE_BAR = 0.3  # shorter operations have no bar
_BAR_WIDTH, _TEXT_WIDTH = 30, 40
_ERASE_LINE = "\r\x1b[K"
_progress: ContextVar[Progress | None] = ContextVar("tautline_progress", default=None)


class Cancelled(Exception):
    """A progress callback has returned False. Becomes tautline.Aborted."""


class ProgressBar:
    """A progress callback that draws a bar in the last line of a terminal, and nothing without a terminal."""

    def __init__(self, stream: TextIO | None = None) -> None:
        self.stream = stream or sys.stderr
        self.terminal = self.stream.isatty()
        self.start = time.monotonic()
        self.drawn = False

    def __call__(self, fraction: float, text: str) -> None:
        """Draw the bar with the fraction done, 0 to 1, and a text."""
        elapsed = time.monotonic() - self.start
        if not self.terminal or elapsed < _SECONDS_BEFORE_BAR:
            return
        done = min(max(fraction, 0.0), 1.0)
        bar = ("#" * round(done * _BAR_WIDTH)).ljust(_BAR_WIDTH, ".")
        self.stream.write(f"{_ERASE_LINE}[{bar}] {done:4.0%} {elapsed:.0f} s  {text[:_TEXT_WIDTH]}")
        self.stream.flush()
        self.drawn = True

    def erase(self) -> None:
        """Remove the bar, before other output."""
        if self.drawn:
            self.stream.write(_ERASE_LINE)
            self.stream.flush()
            self.drawn = False


@contextmanager
def reporting(progress: Progress | bool | None) -> Iterator[None]:
    """Report the progress of the filters that run in the block, True by a bar on a terminal.

    None and False keep the callback of the enclosing block; so does True, if there is one.
    """
    if progress is None or progress is False or (progress is True and _progress.get()):
        yield
        return
    token = _progress.set(ProgressBar() if progress is True else progress)
    try:
        yield
    finally:
        _progress.reset(token)


@contextmanager
def part(begin: float, end: float) -> Iterator[None]:
    """A block whose progress, 0 to 1, the callback of the enclosing block gets as `begin` to `end`."""
    outer = _progress.get()
    if outer is None:
        yield
        return
    report = outer
    token = _progress.set(lambda fraction, text: report(begin + fraction * (end - begin), text))
    try:
        yield
    finally:
        _progress.reset(token)
        if isinstance(outer, ProgressBar):
            outer.erase()


@contextmanager
def updating(algorithm: Any) -> Iterator[None]:
    """A block in which Ctrl-C and the progress callback end the execution of a VTK algorithm.

    At its end it raises KeyboardInterrupt after Ctrl-C, Cancelled if the callback has returned False, and any exception
    of the callback. Handlers of SIGINT that are not Python's own are called instead.
    """
    interruption = CLASSES["vtkInterruption"]
    report = _Report(algorithm, _progress.get())
    signalled = False
    try:
        interruption.Begin(threading.current_thread() is threading.main_thread())
        report.begin()
        yield
    finally:
        report.end()
        signalled = interruption.End()
        if signalled:
            _raise_interrupt()
    if report.raised:
        raise report.raised
    if report.cancelled:
        raise Cancelled


def _raise_interrupt() -> None:
    """Do what Python does after SIGINT."""
    handler = signal.getsignal(signal.SIGINT)
    if callable(handler) and handler is not signal.default_int_handler:
        handler(signal.SIGINT, sys._getframe())
        raise Cancelled  # the filter's output is not a result
    raise KeyboardInterrupt


class _Report:
    """Calls a callback with the progress of an algorithm, and cancels where that returns False or raises."""

    def __init__(self, algorithm: Any, progress: Progress | None) -> None:
        self.algorithm = algorithm
        self.progress = progress
        self.raised: BaseException | None = None
        self.cancelled = False
        self.next = 0.0
        self.tags: list[int] = []

    def begin(self) -> None:
        if self.progress:
            for event in ("ProgressEvent", CLASSES["vtkInterruption"].PollEvent):
                self.tags.append(self.algorithm.AddObserver(event, self.call))

    def end(self) -> None:
        for tag in self.tags:
            self.algorithm.RemoveObserver(tag)
        self.tags.clear()
        if isinstance(self.progress, ProgressBar):
            self.progress.erase()

    def call(self, *_: Any) -> None:
        if not self.progress or self.cancelled or time.monotonic() < self.next:
            return
        text = self.algorithm.GetProgressText() or self.algorithm.GetClassName()
        try:
            self.cancelled = self.progress(self.algorithm.GetProgress(), text) is False
        except BaseException as error:  # VTK would print it, or end the process
            self.raised = error
            self.cancelled = True
        self.next = time.monotonic() + _SECONDS_BETWEEN_CALLS
        if self.cancelled:
            CLASSES["vtkInterruption"].Cancel()
            self.algorithm.SetAbortExecute(1)
