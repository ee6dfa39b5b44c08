# SPDX-License-Identifier: BSD-3-Clause
"""Numbers in the decks of Abaqus and CalculiX, which read twenty characters of a number and no more."""

from __future__ import annotations

import re
from typing import Iterator

#: Abaqus, "Input syntax rules": real numbers take at most 20 characters; CalculiX ignores what follows them, such as
#: the last digit of an exponent.
WIDEST = 20
_MOST_DIGITS = 17  # of a double
_NODE = re.compile(r"\*NODE\s*(,|$)", re.IGNORECASE)


def deck_number(value: float) -> str:
    """A number with as many digits as twenty characters have room for: all of them, as a rule."""
    value = float(value) + 0.0  # -0 is 0
    text = repr(value)
    digits = _MOST_DIGITS
    while len(text) > WIDEST:
        digits -= 1
        text = f"{value:.{digits}g}"
    return text


def with_short_numbers(lines: Iterator[str]) -> Iterator[str]:
    """The lines of a deck, in which the coordinates of *NODE take at most twenty characters each."""
    inside = False
    for line in lines:
        if line.startswith("*"):
            inside = bool(_NODE.match(line)) or (inside and line.startswith("**"))
        elif inside and line.strip():
            number, *coordinates = line.split(",")
            line = ", ".join([number, *(deck_number(float(word)) for word in coordinates)]) + "\n"
        yield line
