# SPDX-License-Identifier: BSD-3-Clause
"""Numbers with a range: every setter of every class rejects values outside with a message and keeps the older value."""

import math

from tautline import _vtk
from vtkmodules.vtkCommonCore import vtkObject
from wording import wording


def setters(made: vtkObject) -> list[str]:
    """The names of the properties with a range."""
    names = [name[3:-8] for name in dir(made) if name.startswith("Get") and name.endswith("MinValue")]
    return [name for name in names if hasattr(made, f"Set{name}")]


def outside(low: float, high: float) -> list[float]:
    """Values below and above a range, as far as the type has them."""
    whole = isinstance(low, int)
    beyond = [low - 1, high + 1] if whole else [low - max(1.0, abs(low)), high + max(1.0, abs(high)), math.nan]
    most = 2**31 - 1 if whole else 1e299
    return [value for value in beyond if value != value or abs(value) <= most]


def messages_of(made: vtkObject) -> list[str]:
    """The list to which the errors of an object are appended."""
    messages = []

    def append(_object, _event, text):
        messages.append(text)

    append.CallDataType = "string0"
    made.AddObserver("ErrorEvent", append)
    return messages


def check(name: str, kind: type) -> int:
    """Check the setters of a class; returns how many there are."""
    made = kind()
    messages = messages_of(made)
    count = 0
    for prop in setters(made):
        get, set_value = getattr(made, f"Get{prop}"), getattr(made, f"Set{prop}")
        low, high = getattr(made, f"Get{prop}MinValue")(), getattr(made, f"Get{prop}MaxValue")()
        for value in (low, high):
            messages.clear()
            set_value(value)
            assert get() == value and not messages, (name, prop, value, messages)
        for value in outside(low, high):
            messages.clear()
            set_value(value)
            assert get() == high, f"{name}: {prop} of {value} became {get()}"
            assert len(messages) == 1 and f"{prop} is " in messages[0], (name, prop, value, messages)
            assert wording("is-kept") in messages[0], messages
        if high > 1e300:  # no limit
            set_value(math.inf)
            assert get() == high, (name, prop, get())
        count += 1
    return count


def main() -> None:
    total = 0
    for name in sorted([*_vtk.CLASSES, *_vtk.LATER]):
        kind = getattr(_vtk, name)
        try:
            kind()
        except (TypeError, NotImplementedError):
            continue  # an abstract class
        total += check(name, kind)
    assert total > 100, total
    print(f"{total} properties")

    domain = _vtk.vtkDomainSource()
    messages = messages_of(domain)
    last = domain.GetNumberOfDomains() - 1
    for number in (-1, last + 1):
        domain.SetDomain(number)
        assert domain.GetDomain() == 0 and f"Domain is {number}; from 0 to {last} is allowed" in messages[-1], messages
    domain.SetElementSize(1e-9)
    assert domain.GetElementSize() == 0.1 and wording("elementsize-is-1e-09-from-0-0001") in messages[-1]


main()
