# SPDX-License-Identifier: BSD-3-Clause
"""Names of methods and presets as users write them: case-insensitive, also with the labels of ParaView's panels."""

from __future__ import annotations

import re
from difflib import SequenceMatcher, get_close_matches
from typing import Any, Iterable

from ._choices import LABELS

# Names by older names, and by labels of warp()'s solver, which is not one property. As in folded().
_LABELS = {
    "amg": ("boomeramg",),
    "conjugategradients": ("cg",),
}


def find_name(value: Any, allowed: Iterable[str]) -> str | None:
    """The allowed name that matches a text; None if there is none.

    Case, blanks, hyphens and underscores do not matter. The labels of ParaView's panels are also accepted.
    """
    if not isinstance(value, str):
        return None
    names = {folded(name): name for name in allowed}
    key = folded(value)
    keys = [key, *map(folded, LABELS.get(key, ()) + _LABELS.get(key, ()))]
    return next((names[key] for key in keys if key in names), None)


def nearest_name(value: Any, allowed: Iterable[str]) -> str:
    """The addition to the message for an unknown name: the nearest one, or nothing."""
    names = {folded(name): name for name in allowed}
    best = closest(folded(str(value)), names)
    return f" (did you mean {names[best]!r}?)" if best else ""


def closest(name: str, known: Iterable[str]) -> str:
    """The nearest of several names, with ties broken by the nearest length; "" if none is near."""
    names = list(known)
    found = get_close_matches(name, names, len(names)) if names else []
    near = {other: (SequenceMatcher(None, other, name).ratio(), -abs(len(other) - len(name))) for other in found}
    return max(near, key=lambda other: near[other], default="")


def folded(name: str) -> str:
    """The name without characters that do not matter."""
    return re.sub(r"[\s_-]", "", name).casefold()
