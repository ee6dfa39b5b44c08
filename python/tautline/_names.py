# SPDX-License-Identifier: BSD-3-Clause
"""Names of methods and presets as users write them: in any case, and as ParaView's panels have them."""

from __future__ import annotations

import re
from difflib import get_close_matches
from typing import Any, Iterable

# Names by other ones: the labels of ParaView's panels where they differ, and older names. As in folded().
_LABELS = {
    "amg": ("boomeramg",),
    "conjugategradients": ("cg",),
    "ilu(0)": ("ilu",),
    "icc(0)": ("icc",),
    "incompletecholesky": ("icc",),
    "conjugategradient(fletcherreeves)": ("fletcher-reeves",),
    "conjugategradient(polakribiere)": ("polak-ribiere",),
    "fliptheoutput": ("flip output",),
    "meanofthecorners": ("mean",),
    "powermeanofthecorners": ("power mean",),
    "worstcorner": ("worst",),
    "asusualforthemetric": ("default",),
    "maximum(smooth)": ("maximum",),
    "idealelement": ("ideal",),
    "elementofareferencemesh": ("reference",),
    "elementofthereferencemesh": ("reference",),
    "sizefromanarray": ("size",),
    "metrictensorfromanarray": ("tensor",),
    "slideonflatparts": ("sliding",),
    "slideonsmoothparts": ("on surface",),
    "simultaneousuntanglingandsmoothing": ("simultaneous",),
    "elasticity,iterativestiffening": ("iterative stiffening",),
    "elasticity,jacobianbasedstiffening": ("jacobian stiffening",),
    "inversedistanceweighting": ("inverse distance",),
    "radialbasisfunctions": ("radial basis",),
    "linearelasticity": ("elasticity",),
    "generalsecondorder": ("elliptic",),
    "planestrain": ("strain",),
    "planestress": ("stress",),
    "ritzvalues": ("ritz",),
    "piecewiseconstant": ("constant",),
    "piecewiselinear": ("linear",),
    "asthetables": ("tables",),
    "asthetext:1outer,3inner": ("literal",),
    "1outer,1inner": ("1/1",),
    "3outer,3inner": ("3/3",),
    "3outer,1inner": ("3/1",),
    "highestrate": ("highest",),
    "wholeshape": ("whole",),
    "gridneartheoutline": ("near grid",),
    "pointsontheoutline": ("contour",),
}


def find_name(value: Any, allowed: Iterable[str]) -> str | None:
    """The allowed name that a text means; None if there is none.

    Case, blanks, hyphens and underscores do not count. The labels of ParaView's panels are understood, too.
    """
    if not isinstance(value, str):
        return None
    names = {folded(name): name for name in allowed}
    key = folded(value)
    keys = [key, *map(folded, _LABELS.get(key, ()))]
    return next((names[key] for key in keys if key in names), None)


def nearest_name(value: Any, allowed: Iterable[str]) -> str:
    """What to add to the message for an unknown name: the nearest one, or nothing."""
    names = {folded(name): name for name in allowed}
    found = get_close_matches(folded(str(value)), names, 1)
    return f" (did you mean {names[found[0]]!r}?)" if found else ""


def folded(name: str) -> str:
    """The name without what does not count."""
    return re.sub(r"[\s_-]", "", name).casefold()
