#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""check_licence.py SOURCE_TREE [--write]: every source file names its licence in its first lines, as SPDX has it.

--write inserts the line where it is missing: after #! and <?xml ...?>, before everything else.
"""

import sys
from pathlib import Path

LICENCE = "SPDX-License-Identifier: BSD-3-Clause"
DIRECTORIES = ("Filters", "Readers", "ServerManager", "Plugin", "Testing", "python", ".ci")
COMMENTS = {".h": "// {}", ".cxx": "// {}", ".py": "# {}", ".cmake": "# {}", ".sh": "# {}"}
NAMES = {"CMakeLists.txt": "# {}", "run": "# {}"}
FIRST_LINES = 2  # among which it is looked for


def comment_of(path: Path):
    """How a line of comment is written in this file, or None if the file needs no licence."""
    return NAMES.get(path.name) or COMMENTS.get(path.suffix)


def sources(top: Path):
    yield from (p for p in sorted(top.iterdir()) if p.is_file() and comment_of(p))
    for directory in DIRECTORIES:
        yield from (p for p in sorted((top / directory).rglob("*")) if p.is_file() and comment_of(p))


def with_licence(text: str, comment: str) -> str:
    """The text of a file with the line of its licence."""
    lines = text.split("\n")
    lines.insert(1 if lines[0].startswith("#!") else 0, comment.format(LICENCE))
    return "\n".join(lines)


def main(top: Path, write: bool) -> int:
    files, missing = list(sources(top)), 0
    for path in files:
        text = path.read_text(encoding="utf-8")
        if any(LICENCE in line for line in text.split("\n")[:FIRST_LINES]):
            continue
        if write:
            path.write_text(with_licence(text, comment_of(path)), encoding="utf-8")
            continue
        missing += 1
        print(f"{path} has no line '{LICENCE}': {Path(__file__).name} SOURCE_TREE --write inserts it")
    print(f"{len(files)} files, {missing} without licence")
    return 1 if missing or not files else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), "--write" in sys.argv[2:]))
