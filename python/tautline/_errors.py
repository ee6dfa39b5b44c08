# SPDX-License-Identifier: BSD-3-Clause
"""Errors of VTK objects as Python exceptions."""

from __future__ import annotations

import re
from functools import wraps
from inspect import Signature, signature
from typing import Any, Callable, Iterable, TypeVar, cast

from vtkmodules.vtkCommonCore import vtkCommand

from ._interrupts import Cancelled, reporting, updating
from ._names import closest
from ._vtk import CLASSES

# VTK puts file, line, class and address before the text of a message.
_PREAMBLE = re.compile(r"^(ERROR|Warning): In .*?, line \d+\s*\n?\w+ \(.*?\): ", re.DOTALL)
# Parts of the executive's message that follows the message of a filter.
_CONSEQUENCE = ("returned failure for request", "Algorithm vtk")
# Part of its message if a reader fails before data are requested; no help to a user.
_INTERNAL = "No update piece number has been set"
_NO_REASON = "a reader or filter of VTK failed without giving a reason: check that its file or input is complete"

#: Exit code of the shell for wrong usage.
WRONG_USAGE = 2

_RAGGED = "inhomogeneous shape"

_MEMORY_REMEDY = "take a smaller mesh, or a higher limit on the memory of the process"

Function = TypeVar("Function", bound=Callable[..., Any])


class Error(RuntimeError):
    """Raised by every function of the package for wrong arguments, unreadable files and errors of a filter."""

    #: Exit code on the shell.
    exit_code = 1


class Aborted(Error):
    """Raised when a progress callback returns False."""


class MissingKey(Error, KeyError):
    """Raised by dicts of results and meshes for a key that they do not have."""

    def __init__(self, what: str, key: Any, known: Iterable[str]) -> None:
        names = list(known)
        hint = nearest(str(key), names) + (f"; there are {', '.join(names)}" if names else "")
        super().__init__(f"there is no {what} {key!r}{hint}")
        self._arguments = (what, key, names)

    def __str__(self) -> str:
        return RuntimeError.__str__(self)  # KeyError's own has quotation marks

    def __reduce__(self) -> Any:
        return type(self), self._arguments


# As tracebacks show them, and as users write them in `except`.
Error.__module__ = Aborted.__module__ = MissingKey.__module__ = __package__


def nearest(name: str, known: Iterable[str]) -> str:
    """The addition to the message for an unknown name: the nearest one, or nothing."""
    found = closest(name, known)
    return f"; did you mean {found!r}?" if found else ""


def wrong_usage(text: str) -> Error:
    """The error for a name that does not exist and for other wrong usage, with which the shell exits with 2."""
    error = Error(text)
    error.exit_code = WRONG_USAGE
    return error


def unknown(what: str, name: str, known: Iterable[str]) -> Error:
    """The error for an unknown name: with the nearest one, and all of them."""
    names = list(known)
    return wrong_usage(f"there is no {what} {name!r}{nearest(name, names)}; there are {', '.join(names)}")


def checked(function: Function) -> Function:
    """A function that raises Error, not TypeError, for arguments that it does not have or that are missing.

    Nor does it raise MemoryError.
    """
    return cast(Function, _checked(function, signature(function)))


def interruptible(function: Function) -> Function:
    """checked(), for functions that can take long: with their argument `progress`, a keyword, which this handles."""

    @wraps(function)
    def call(*arguments: Any, **options: Any) -> Any:
        progress = options.pop("progress", None)
        if not (progress is None or isinstance(progress, bool) or callable(progress)):
            raise Error(f"progress is {progress!r}; True or a function is expected")
        try:
            with reporting(progress):
                return function(*arguments, **options)
        except Cancelled:
            raise Aborted("cancelled") from None

    return cast(Function, _checked(call, signature(function)))


def _checked(function: Callable[..., Any], known: Signature) -> Callable[..., Any]:
    parameters = known.parameters
    keywords = [p.name for p in parameters.values() if p.kind in (p.POSITIONAL_OR_KEYWORD, p.KEYWORD_ONLY)]
    others = any(p.kind is p.VAR_KEYWORD for p in parameters.values())

    @wraps(function)
    def call(*arguments: Any, **options: Any) -> Any:
        for name in options:
            if name not in keywords and not others:
                raise unknown(f"argument of {function.__name__}()", name, keywords)
        try:
            known.bind(*arguments, **options)
        except TypeError as error:
            raise Error(f"{function.__name__}(): {error}") from None
        try:
            return function(*arguments, **options)
        except ValueError as error:
            if _RAGGED in str(error):  # of numpy, wherever an argument is converted to an array
                raise Error(f"{function.__name__}(): an argument has rows of different lengths") from None
            raise
        except MemoryError:
            raise Error(f"Not enough memory: {_MEMORY_REMEDY}.") from None

    return call


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

    def raise_errors(self, without_reason: str = _NO_REASON) -> None:
        """Raise Error with all messages, if there are any, without the consequential ones of the executive.

        without_reason: the text where no other message is left.
        """
        if not self.errors:
            return
        errors = [text for text in self.errors if _INTERNAL not in text]
        causes = [text for text in errors if not all(part in text for part in _CONSEQUENCE)]
        if not causes and (len(errors) < len(self.errors) or without_reason != _NO_REASON):
            raise Error(without_reason)
        raise Error("\n".join(dict.fromkeys(causes or errors)))


def run(algorithm: Any, messages: Messages | None = None, without_reason: str = _NO_REASON) -> Messages:
    """Update a filter; returns its messages. Raises Error with them if it fails, see raise_errors().

    Raises Aborted if a progress callback has cancelled it, and KeyboardInterrupt after Ctrl-C.
    """
    messages = messages or watch(algorithm)
    messages.raise_errors()
    try:
        with updating(algorithm):
            failure = CLASSES["vtkUpdateGuard"].Update(algorithm)
    except Cancelled:
        raise Aborted("cancelled") from None
    if failure:
        raise Error(failure)  # VTK's own message comes with it, and contains less
    messages.raise_errors(without_reason)
    return messages


def watch(algorithm: Any) -> Messages:
    """The messages of a filter and of its executive, from now on."""
    return Messages(algorithm, algorithm.GetExecutive())


def plain(text: str) -> str:
    """The text of a VTK message without file, line, class and address."""
    return _PREAMBLE.sub("", text).strip()


def _collector(texts: list[str]) -> Callable[..., None]:
    def collect(_caller: Any, _event: str, text: str) -> None:
        texts.append(plain(text))

    setattr(collect, "CallDataType", "string0")  # by which VTK passes the text
    return collect
