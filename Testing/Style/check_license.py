#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""check_license.py SOURCE_TREE [--write]: every source file names its license in its first lines, as SPDX has it.

REUSE.toml has the license of all other files, LICENSES its text. --write inserts the line where it is missing: after #!
and <?xml ...?>, before everything else.
"""

import re
import sys
from pathlib import Path

LICENSE = "SPDX-License-Identifier: BSD-3-Clause"
DIRECTORIES = ("Filters", "Readers", "ServerManager", "Plugin", "Testing", "python", ".ci")
COMMENTS = {".h": "// {}", ".cxx": "// {}", ".py": "# {}", ".cmake": "# {}", ".sh": "# {}"}
NAMES = {"CMakeLists.txt": "# {}", "run": "# {}"}
FIRST_LINES = 2  # among which it is looked for


def comment_of(path: Path):
    """How a line of comment is written in this file, or None if the file needs no license."""
    return NAMES.get(path.name) or COMMENTS.get(path.suffix)


def sources(top: Path):
    yield from (p for p in sorted(top.iterdir()) if p.is_file() and comment_of(p))
    for directory in DIRECTORIES:
        yield from (p for p in sorted((top / directory).rglob("*")) if p.is_file() and comment_of(p))


def with_license(text: str, comment: str) -> str:
    """The text of a file with the line of its license."""
    lines = text.split("\n")
    lines.insert(1 if lines[0].startswith("#!") else 0, comment.format(LICENSE))
    return "\n".join(lines)


def reuse_complaints(top: Path):
    """Violations of the REUSE specification beside the lines in sources: a license for every file, the text of each."""
    text = (top / "REUSE.toml").read_text(encoding="utf-8")
    named = set(re.findall(r'^SPDX-License-Identifier = "(.*)"$', text, re.MULTILINE))
    if 'path = "**"' not in text or text.count("[[annotations]]") != text.count("SPDX-FileCopyrightText"):
        yield "REUSE.toml does not have the copyright of every file"
    texts = {path.stem for path in (top / "LICENSES").iterdir()}
    if named != texts:
        yield f"REUSE.toml names {sorted(named)}, LICENSES has {sorted(texts)}"
    for path in re.findall(r'"([\w/]+)/\*\*"', text):
        if not (top / path).is_dir():
            yield f"REUSE.toml names {path}, which does not exist"
    if (top / "LICENSES" / "BSD-3-Clause.txt").read_bytes() != (top / "LICENSE").read_bytes():
        yield "LICENSES/BSD-3-Clause.txt is not LICENSE"


def main(top: Path, write: bool) -> int:
    files, missing = list(sources(top)), 0
    for path in files:
        text = path.read_text(encoding="utf-8")
        if any(LICENSE in line for line in text.split("\n")[:FIRST_LINES]):
            continue
        if write:
            path.write_text(with_license(text, comment_of(path)), encoding="utf-8")
            continue
        missing += 1
        print(f"{path} has no line '{LICENSE}': {Path(__file__).name} SOURCE_TREE --write inserts it")
    wrong = list(reuse_complaints(top))
    print(*wrong, f"{len(files)} files, {missing} without license", sep="\n")
    return 1 if missing or wrong or not files else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), "--write" in sys.argv[2:]))
