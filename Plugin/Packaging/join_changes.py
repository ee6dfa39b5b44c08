#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""join_changes.py TOP check | TOP join VERSION [DATE]: the fragments of the change log, Plugin/Changes/*.md.

check reports malformed fragments. join writes them into CHANGELOG.md as the section of VERSION, sets the version and
the date in CMakeLists.txt, CITATION.cff and SECURITY.md, and deletes them. It changes nothing if a fragment is
malformed or a place of the version is missing. Plugin/Changes/README.md describes a fragment.
"""

import datetime
import re
import sys
from pathlib import Path

FOLDER = "Plugin/Changes"
GUIDE = "README.md"  # the only file of the folder that is not a fragment
KINDS = ("Added", "Changed", "Deprecated", "Removed", "Fixed", "Security")
NAME = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*\.md")
VERSION = re.compile(r"(0|[1-9]\d*)\.(0|[1-9]\d*)\.(0|[1-9]\d*)")
LINK = re.compile(r"\]\(([^)#\s]+)[^)]*\)")
OUTSIDE = re.compile(r"[a-z]+:")
SECTION = re.compile(r"^## ", re.MULTILINE)  # the new section is inserted before the first one
MAX_COLUMNS = 120
#: File, pattern with the old text as its second group, and the new text.
PLACES = (
    ("CMakeLists.txt", r"(^project\(Tautline VERSION )(\S+)", "{version}"),
    ("CITATION.cff", r"(^version: )(\S+)$", "{version}"),
    ("CITATION.cff", r"(^date-released: )(\S+)$", "{date}"),
    ("SECURITY.md", r"(^\| )(\d+\.\d+)(?=\.x \| yes \|$)", "{minor}"),
)


def complaints(top: Path, path: Path):
    """The errors in a fragment."""
    if not path.is_file() or not NAME.fullmatch(path.name):
        yield "is no file with a name of lowercase letters, digits and hyphens that ends with .md"
        return
    try:
        text = path.read_bytes().decode("utf-8")
    except UnicodeDecodeError:
        yield "is not UTF-8"
        return
    lines = text.split("\n")
    if lines[0] not in {f"### {kind}" for kind in KINDS}:
        yield f"does not begin with a line '### KIND', KIND one of {', '.join(KINDS)}"
    if len(lines) < 4 or lines[1] or not lines[2].startswith("- "):
        yield "has no blank line and list item after the kind"
    if lines[-1]:
        yield "does not end with a line end"
    for number, line in enumerate(lines[2:-1], 3):
        if not re.match(r"(- |  +)\S", line):
            yield f"has in line {number} neither an item ('- ') nor its continuation (two spaces)"
        if len(line) > MAX_COLUMNS or line != line.rstrip():
            yield f"has in line {number} more than {MAX_COLUMNS} columns, or spaces at the end"
    for target in LINK.findall(text):
        if not OUTSIDE.match(target) and not (top / target).exists():
            yield f"links to {target}, which does not exist; links are relative to the top of the repository"


def fragments(top: Path) -> tuple[list[Path], list[str]]:
    """The fragments in the order of their names, and their errors."""
    paths = sorted(path for path in (top / FOLDER).iterdir() if path.name != GUIDE)
    return paths, [f"{FOLDER}/{path.name} {text}" for path in paths for text in complaints(top, path)]


def section_of(paths: list[Path], version: str, date: str) -> str:
    """The section of a version: the items of well-formed fragments by kind."""
    items: dict[str, list[str]] = {}
    for path in paths:
        head, _, rest = path.read_text(encoding="utf-8").partition("\n\n")
        items.setdefault(head.removeprefix("### "), []).append(rest)
    parts = [f"### {kind}\n\n{''.join(items[kind])}" for kind in KINDS if kind in items]
    return f"## {version} - {date}\n\n" + "\n".join(parts)


def joined(top: Path, paths: list[Path], version: str, date: str) -> dict[Path, str]:
    """The new text of each file that states the version; raises ValueError where a file has no place for it."""
    log = top / "CHANGELOG.md"
    text = log.read_text(encoding="utf-8")
    first = SECTION.search(text)
    if not first or f"\n## {version} - " in text:
        raise ValueError(f"CHANGELOG.md has no section, or already has one for {version}")
    texts = {log: f"{text[:first.start()]}{section_of(paths, version, date)}\n{text[first.start():]}"}
    for name, pattern, new in PLACES:
        path = top / name
        value = new.format(version=version, date=date, minor=version.rpartition(".")[0])
        before = texts.get(path) or path.read_text(encoding="utf-8")
        texts[path], count = re.subn(pattern, rf"\g<1>{value}", before, flags=re.MULTILINE)
        if count != 1:
            raise ValueError(f"{name} has {count} places of the version that match {pattern}")
    return texts


def arguments_wrong(top: Path, version: str, date: str) -> str:
    """The error in the arguments of join, or an empty text."""
    old = re.search(PLACES[0][1], (top / PLACES[0][0]).read_text(encoding="utf-8"), re.MULTILINE)
    if not VERSION.fullmatch(version):
        return f"{version} is not a version MAJOR.MINOR.PATCH"
    if old and tuple(map(int, old[2].split("."))) >= tuple(map(int, version.split("."))):
        return f"{version} is not later than {old[2]}"
    try:
        return "" if datetime.date.fromisoformat(date).isoformat() == date else f"{date} is not a date YYYY-MM-DD"
    except ValueError:
        return f"{date} is not a date YYYY-MM-DD"


def join(top: Path, version: str, date: str) -> int:
    paths, wrong = fragments(top)
    said = arguments_wrong(top, version, date)
    if said:
        wrong.append(said)
    if not paths:
        wrong.append(f"{FOLDER} has no change to release")
    texts: dict[Path, str] = {}
    if not wrong:
        try:
            texts = joined(top, paths, version, date)
        except ValueError as error:
            wrong.append(str(error))
    if wrong:
        print(*wrong, "nothing was changed", sep="\n", file=sys.stderr)
        return 1
    for path, text in texts.items():
        new = path.with_name(f"{path.name}.new")
        new.write_text(text, encoding="utf-8")
        new.replace(path)
    for path in paths:  # only now, when their texts are in CHANGELOG.md
        path.unlink()
    print(f"changes joined: {len(paths)}; version {version}. Check the files, commit and tag them.")
    return 0


def main(arguments: list[str]) -> int:
    if len(arguments) == 2 and arguments[1] == "check":
        paths, wrong = fragments(Path(arguments[0]))
        print(*wrong, f"{len(paths)} changes, {len(wrong)} complaints", sep="\n")
        return 1 if wrong else 0
    if len(arguments) in (3, 4) and arguments[1] == "join":
        today = datetime.datetime.now(datetime.timezone.utc).date().isoformat()
        return join(Path(arguments[0]), arguments[2], arguments[3] if len(arguments) == 4 else today)
    print((__doc__ or "").partition(":")[0], file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
