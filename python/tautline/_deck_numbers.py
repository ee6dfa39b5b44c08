# SPDX-License-Identifier: BSD-3-Clause
"""Numbers in decks: Abaqus and CalculiX read twenty characters of a number and no more, Nastran has fields."""

from __future__ import annotations

import re
from typing import Iterator

#: Abaqus, "Input syntax rules": real numbers take at most 20 characters; CalculiX ignores what follows them, such as
#: the last digit of an exponent.
WIDEST = 20
#: Characters of the fields of Nastran.
SMALL_FIELD, LARGE_FIELD = 8, 16
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


def value_of(text: bytes) -> float:
    """A number of any of the formats: 1.5, 1.5E3, 1.5D3, Nastran's 1.5+3; nothing is 0."""
    word = text.strip().decode("latin-1").upper().replace("D", "E")
    if not word:
        return 0.0
    try:
        return float(word)
    except ValueError:
        pass
    try:
        return float(re.sub(r"(?<=[\d.])([+-])", r"E\1", word))
    except ValueError:
        return float("nan")


def nastran_number(value: float, width: int) -> str:
    """A number in a field of this many characters: with as many digits as fit, with a point or Nastran's
    exponent without a letter."""
    found = []
    for form in ("f", "e"):
        for digits in range(_MOST_DIGITS, -1, -1):
            text = f"{value:.{digits}{form}}"
            if form == "e":
                text = _short_exponent(text)
            elif len(text) > width and text.lstrip("-").startswith("0."):
                text = text.replace("0.", ".", 1)
            text += "" if "." in text else "."
            if len(text) <= width:
                found.append(text)
                break
    return min(found, key=lambda text: abs(value_of(text.encode()) - value)).rjust(width)


def _short_exponent(text: str) -> str:
    """1.5e-03 as Nastran's 1.5-3."""
    mantissa, _, exponent = text.partition("e")
    mantissa = mantissa if "." in mantissa else mantissa + "."
    return f"{mantissa}{int(exponent):+d}"
