# SPDX-License-Identifier: BSD-3-Clause
"""Docstrings in the form of numpydoc, from paragraphs and entries "name: text"."""

from __future__ import annotations

import re
from textwrap import indent

from texts import WIDTH, wrapped

ENTRY = re.compile(r"^(\w+(?:, \w+)*): ")
SPACE = 4


def capitalized(text: str, keys: bool = False) -> str:
    """A sentence that begins a paragraph; names stay; with `keys`, lists of names also stay."""
    name = re.match(r"\w+_|\w\b" + (r"|\w+[,:]|\w+ \(" if keys else ""), text)
    return text[:1].upper() + text[1:] if text[:1].islower() and (not name or text.startswith("a ")) else text


def numpydoc(text: str, types: dict[str, str], returned: str, section: str = "Parameters") -> str:
    """A docstring without its quotation marks and indentation, by sections.

    text: a summary, then paragraphs: entries "name: text", "Returns ...", "Raises Error ...", ">>> ...", and others,
    which are notes after the entries.
    types: the text after the name of each entry. returned: the return type, or "".
    """
    parts = [part for part in re.split(r"\n\s*\n", text.strip("\n")) if part.strip()]
    summary, found = [parts[0]], {name: [] for name in (section, "Returns", "Raises", "Notes", "Examples")}
    before = True  # the entries
    for part in parts[1:]:
        if ENTRY.match(part) and all(name in types for name in ENTRY.match(part)[1].split(", ")):
            found[section] += entries(part, types, section == "Attributes")
            before = False
        elif part.startswith(">>>"):
            found["Examples"].append(part)
        else:
            words = " ".join(part.split()) if not re.search(r"\n\s", part) else part
            words, raises = split_raises(words)
            if words.startswith("Returns ") and returned:
                found["Returns"].append(described(returned, capitalized(words.removeprefix("Returns "))))
            elif words:
                (summary if before else found["Notes"]).append(paragraph(words))
            if raises:
                found["Raises"].append(described("Error", capitalized(raises)))
    if returned and returned != "None" and not found["Returns"]:
        found["Returns"].append(returned)
    blocks = ["\n\n".join(summary)]
    blocks += [title(name) + ("\n\n" if name in ("Notes", "Examples") else "\n").join(body)
               for name, body in found.items() if body]  # fmt: skip
    return "\n\n".join(blocks)


def split_raises(words: str) -> tuple[str, str]:
    """A paragraph without its sentences about errors, and these sentences."""
    place = words.find("Raises Error")
    if place < 0:
        return words, ""
    return words[:place].strip(), words[place:].removeprefix("Raises Error").lstrip(", ").strip()


def entries(part: str, types: dict[str, str], keys: bool) -> list[str]:
    """The entries of a paragraph, each with a line for its names and type."""
    found: list[list[str]] = []
    for line in part.split("\n"):
        match = ENTRY.match(line)
        if match and all(name in types for name in match[1].split(", ")):
            found.append([match[1], line[match.end() :]])
        elif found:
            found[-1].append(line.strip())
    made = []
    for names, *lines in found:
        type_ = "; ".join(dict.fromkeys(types[name] for name in names.split(", ")))
        made.append(described(f"{names} : {type_}" if type_ else names, capitalized(" ".join(lines).strip(), keys)))
    return made


def described(head: str, text: str) -> str:
    return f"{head}\n{wrapped(text, SPACE, SPACE, WIDTH - SPACE)}" if text else head


def paragraph(text: str) -> str:
    return text if "\n" in text else wrapped(text, 0, 0, WIDTH - SPACE)


def title(name: str) -> str:
    return f"{name}\n{'-' * len(name)}\n"


def type_of(annotation: str, default: str | None, choices: set[str]) -> str:
    """The type of a parameter in numpydoc's form, from its annotation and default."""
    names = [part.strip() for part in re.split(r" \| (?![^\[]*\])", annotation)]
    words = ["str" if name in choices else "array_like" if name == "Values" else name for name in names]
    words = list(dict.fromkeys(word for word in words if word != "None"))
    text = " or ".join(words)
    return text if default is None else f"{text}, optional" if default == "None" else f"{text}, default {default}"


def quoted_lines(text: str) -> str:
    """The docstring with quotation marks, for a function."""
    first, _, rest = text.partition("\n")
    body = indent(rest, " " * SPACE)
    return f'    """{first}\n{body}\n    """\n' if rest.strip() else f'    """{first}"""\n'
