# SPDX-License-Identifier: BSD-3-Clause
"""Texts of Python: names, sentences, calls that fill lines."""

from __future__ import annotations

import json
import re
from textwrap import fill

WIDTH = 120
SHORT, LONG = 40, 100  # for the help of an option


class Failure(Exception):
    """An error in the XML, with its place."""


def snake(name: str) -> str:
    """MaximumIterations is maximum_iterations."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()


def first_sentence(text: str) -> str:
    """The shell's help of an option: the first sentence, or a part of it if it is long."""
    sentence = re.split(r"(?<=[^A-Z])\.(?= [A-Z\"]|$)", text, maxsplit=1)[0]
    ends = [match.start() for match in re.finditer(r"[;:] ", sentence) if match.start() > SHORT]
    ends = [end for end in ends if sentence[:end].count("(") == sentence[:end].count(")")]
    return sentence if len(sentence) < LONG or not ends else sentence[: ends[0]]


def folded(name: str) -> str:
    """A label without characters that do not matter, as in _names.py."""
    return re.sub(r"[\s_-]", "", name).casefold()


def listed(names: list[str], last: str = "or") -> str:
    """ "a", "b" or "c"."""
    quoted = [f'"{name}"' for name in names]
    return f" {last} ".join(filter(None, (", ".join(quoted[:-1]), quoted[-1])))


def uncapitalized(text: str) -> str:
    """A sentence that continues another one."""
    return text[0].lower() + text[1:] if text[1:2].islower() or text.startswith("A ") else text


def quoted(text: str) -> str:
    """A string of Python."""
    return json.dumps(text, ensure_ascii=False)


def wrapped(text: str, first: int, then: int, width: int = WIDTH) -> str:
    return fill(text, width, initial_indent=" " * first, subsequent_indent=" " * then, break_on_hyphens=False,
                break_long_words=False)  # fmt: skip


def call(head: str, parts: list[str], tail: str, space: int) -> str:
    """A call in one line, or with a line for each argument."""
    line = " " * space + head + ", ".join(parts) + tail
    if len(line) <= WIDTH:
        return line
    lines = "".join(f"{' ' * (space + 4)}{part},\n" for part in parts)
    return f"{' ' * space}{head}\n{lines}{' ' * space}{tail}"
