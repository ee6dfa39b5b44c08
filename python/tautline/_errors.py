"""Errors of VTK objects as Python exceptions."""

from __future__ import annotations

import re
from typing import Any

from vtkmodules.vtkCommonCore import vtkCommand

# VTK puts file, line, class and address before the text of a message.
_PREAMBLE = re.compile(r"^(ERROR|Warning): In .*?, line \d+\s*\n?\w+ \(.*?\): ", re.DOTALL)
# Parts of the executive's message that follows the message of a filter.
_CONSEQUENCE = ("returned failure for request", "Algorithm vtk")


class Error(RuntimeError):
    """Raised by every function of the package: wrong arguments, unreadable files, errors of a filter."""


class Messages:
    """Collects the errors and warnings of VTK objects, which are then not printed.

    >>> messages = Messages(filter, filter.GetExecutive())
    >>> filter.Update()
    >>> messages.raise_errors()
    """

    def __init__(self, *objects: Any) -> None:
        self.errors: list[str] = []
        self.warnings: list[str] = []
        for source in objects:
            source.AddObserver(vtkCommand.ErrorEvent, _collector(self.errors))
            source.AddObserver(vtkCommand.WarningEvent, _collector(self.warnings))

    def raise_errors(self) -> None:
        """Raise Error with all messages, if there are any, without the consequential ones of the executive."""
        if not self.errors:
            return
        causes = [text for text in self.errors if not all(part in text for part in _CONSEQUENCE)]
        raise Error("\n".join(dict.fromkeys(causes or self.errors)))


def run(algorithm: Any, messages: Messages | None = None) -> Messages:
    """Update a filter; returns its messages. Raises Error with them if it fails."""
    messages = messages or watch(algorithm)
    messages.raise_errors()
    algorithm.Update()
    messages.raise_errors()
    return messages


def watch(algorithm: Any) -> Messages:
    """The messages of a filter and of its executive, from now on."""
    return Messages(algorithm, algorithm.GetExecutive())


def plain(text: str) -> str:
    """The text of a VTK message without file, line, class and address."""
    return _PREAMBLE.sub("", text).strip()


def _collector(texts: list[str]):
    def collect(_caller, _event, text):
        texts.append(plain(text))

    collect.CallDataType = "string0"
    return collect
