# SPDX-License-Identifier: BSD-3-Clause
"""The gallery of the site: thumbnails by theme, and a page for each example in python/examples."""

import html
import json
import re
from pathlib import Path

GALLERY = "python/examples"
PICTURES = f"{GALLERY}/pictures"
INTRODUCTION = """# Gallery

Every example is a script in `python/examples`, which a test runs: `python3 02_untangle.py Data`. A page has the picture
before and after, what to look at, a state file for ParaView, the commands of the shell and the script in Python, some
also a program in C++. Colors of quality have one meaning everywhere: pale is good, dark red is bad, blue is inverted.
The seconds of processor time and the memory are for the whole script on one machine; most of them load the libraries.
"""
#: Examples by theme, by their numbers.
THEMES = {
    "Measure": ("01", "06", "08", "15", "24", "26", "27"),
    "Repair and improve": ("02", "03", "11", "13", "18", "19", "36", "38"),
    "Change the connectivity": ("04", "35"),
    "Target sizes and adaptation": ("16", "17", "39", "40", "41"),
    "Move the boundary": ("05", "10", "12", "14", "20", "21", "22", "23", "37"),
    "Solve": ("07", "28", "29", "30", "31"),
    "Nonlocal models": ("32", "33"),
    "Shapes in images": ("09", "34"),
    "Files": ("25",),
}
LABEL = re.compile(r"^(Shell|Look at|State|Picture): (.*)$", re.MULTILINE)
CONTINUED = re.compile(r"\\\n *")
STATE = """# {title}
from paraview.simple import *

before = OpenDataFile("before.vtu")  # which the script below writes
after = {call}
Show(after)
{last}Render()
"""
LAST_STEP = """GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
GetAnimationScene().GoToLast()
"""


def parts_of(script: str) -> tuple[str, str, dict[str, list[str]]]:
    """The title, the text and the labeled lines of an example; a backslash continues a line."""
    title, _, rest = script.split('"""')[1].partition("\n")
    joined = CONTINUED.sub("", rest)
    lines: dict[str, list[str]] = {}
    for key, value in LABEL.findall(joined):
        lines.setdefault(key, []).append(value)
    return title, LABEL.sub("", joined).strip(), lines


def state_of(title: str, call: str) -> str:
    """The Python state file of an example, which Testing/Docs/gallery_states.py runs."""
    return STATE.format(title=title, call=call, last=LAST_STEP if "TimeScheme" in call else "")


def example_page(script: Path, cost: dict) -> str:
    """Picture, text, what to look at, state, shell, Python and C++ of an example."""
    text = script.read_text(encoding="utf-8")
    title, rest, lines = parts_of(text)
    code = text.split('"""', 2)[2].strip()
    parts = [f"# {title.rstrip('.')}\n", rest + "\n"]
    if (script.parent / "pictures" / f"{script.stem}.png").exists():
        name = html.escape(f"{title.rstrip('.')}: before and after")
        parts.append(f'<img src="{PICTURES}/{script.stem}.png" alt="{name}">\n')
    if "Look at" in lines:
        look = lines["Look at"][0]
        parts.append(f"**What to look at.** {look[0].upper()}{look[1:]}\n")
    if "State" in lines:
        state = state_of(title, lines["State"][0])
        parts.append(f"## ParaView\n\nA file to open with *File > Load State*:\n\n```python\n{state}```\n")
    if "Shell" in lines:
        commands = "\n".join(lines["Shell"])
        parts.append(f"## Shell\n\n```sh\n{commands}\n```\n")
    parts.append(f"## Python\n\n`{GALLERY}/{script.name}`, {cost['seconds']} s and {cost['memory']} MiB:\n")
    parts.append(f"```python\n{code}\n```\n")
    program = script.parent / "cxx" / f"{script.stem}.cxx"
    if program.exists():
        body = program.read_text(encoding="utf-8").split("\n", 1)[1].strip()
        parts.append(f"## C++\n\n`{GALLERY}/cxx/{program.name}`, with the CMake file beside it:\n")
        parts.append(f"```cpp\n{body}\n```\n")
    return "\n".join(parts)


def card(script: Path) -> str:
    """The thumbnail of an example with its title, a link to its page."""
    title = html.escape(parts_of(script.read_text(encoding="utf-8"))[0].rstrip("."))
    picture = f'<img src="{PICTURES}/{script.stem}.png" alt="">'
    if not (script.parent / "pictures" / f"{script.stem}.png").exists():
        picture = ""
    return f'<a class="card" href="example-{script.stem}.html">{picture}<span>{title}</span></a>'


def gallery_pages(source: Path) -> dict[str, str]:
    """The texts of the pages by their names. Raises ValueError for an example without one theme."""
    scripts = {path.stem[:2]: path for path in sorted((source / GALLERY).glob("[0-9]*.py"))}
    listed = [number for numbers in THEMES.values() for number in numbers]
    if sorted(listed) != sorted(scripts):
        wrong = ", ".join(sorted(set(listed) ^ set(scripts))) or "one has several"
        raise ValueError(f"{Path(__file__).name}: each example needs one theme: {wrong}")
    facts = json.loads((source / GALLERY / "measured.json").read_text(encoding="utf-8"))
    parts, pages = [INTRODUCTION], {}
    for theme, numbers in THEMES.items():
        cards = "\n".join(card(scripts[number]) for number in numbers)
        parts.append(f'## {theme}\n\n<div class="cards">\n{cards}\n</div>\n')
        pages |= {f"example-{scripts[n].stem}": example_page(scripts[n], facts[scripts[n].stem]) for n in numbers}
    names = "\n".join(pages)
    parts.append(f"```{{toctree}}\n:hidden:\n{names}\n```\n")
    return pages | {"gallery": "\n".join(parts)}
