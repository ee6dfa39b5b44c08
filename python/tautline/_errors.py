"""Errors of VTK objects as Python exceptions."""

from __future__ import annotations

import re
from typing import Any

from vtkmodules.vtkCommonCore import vtkCommand

_PREAMBLE = re.compile(r"^(ERROR|Warning): In .*?, line \d+\s*\n?\w+ \(.*?\): ", re.DOTALL)
_AFTERMATH = ("returned failure for request", "Algorithm vtk")


class Error(RuntimeError):
    """What every verb raises: bad arguments, files that cannot be read, errors of a filter."""


class Messages:
    """Keeps the errors and warnings of VTK objects, which then print nothing.

    >>> messages = Messages(filter, filter.GetExecutive())
    >>> filter.Update()
    >>> messages.raise_errors()
    """

    def __init__(self, *objects: Any) -> None:
        self.errors: list[str] = []
        self.warnings: list[str] = []
        for source in objects:
            source.AddObserver(vtkCommand.ErrorEvent, _keeper(self.errors))
            source.AddObserver(vtkCommand.WarningEvent, _keeper(self.warnings))

    def raise_errors(self) -> None:
        """Raise Error with all messages, if there are any; what the executive says of them is left out."""
        if not self.errors:
            return
        own = [text for text in self.errors if not all(part in text for part in _AFTERMATH)]
        raise Error("\n".join(dict.fromkeys(own or self.errors)))


def run(algorithm: Any, messages: Messages | None = None) -> Messages:
    """Update a filter, raise Error with its messages if it fails; returns the messages."""
    messages = messages or watch(algorithm)
    messages.raise_errors()
    algorithm.Update()
    messages.raise_errors()
    return messages


def watch(algorithm: Any) -> Messages:
    """Messages of a filter and of its executive."""
    return Messages(algorithm, algorithm.GetExecutive())


def plain(text: str) -> str:
    """The text of a VTK message without file, line, class and address."""
    return _PREAMBLE.sub("", text).strip()


def _keeper(texts: list[str]):
    def keep(_caller, _event, text):
        texts.append(plain(text))

    keep.CallDataType = "string0"
    return keep
