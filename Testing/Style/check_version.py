# SPDX-License-Identifier: BSD-3-Clause
"""check_version.py SOURCE_TREE [VERSION]: documents state the version of the project, and one date of its release.

The version is that of CMakeLists.txt unless it is given.
"""

import re
import sys
from pathlib import Path

#: File, the pattern of the version in it, and how many of its numbers are there.
PLACES = (
    ("CITATION.cff", r"^version: (\S+)$", 3),
    ("CHANGELOG.md", r"^## (\d\S*) - ", 3),
    ("SECURITY.md", r"^\| (\d+\.\d+)\.x \| yes \|$", 2),
)
#: File and the pattern of the date in it.
DATES = (
    ("CITATION.cff", r"^date-released: (\d{4}-\d\d-\d\d)$"),
    ("CHANGELOG.md", r"^## \d\S* - (\d{4}-\d\d-\d\d)$"),
)


def first(top: Path, name: str, pattern: str):
    found = re.search(pattern, (top / name).read_text(encoding="utf-8"), re.MULTILINE)
    return found and found[1]


def main(top: Path, version: str) -> int:
    wrong = []
    for name, pattern, numbers in PLACES:
        wanted = ".".join(version.split(".")[:numbers])
        found = first(top, name, pattern)
        if found != wanted:
            wrong.append(f"{name} states version {found}, it should be {wanted}")
    dates = {name: first(top, name, pattern) for name, pattern in DATES}
    if None in dates.values() or len(set(dates.values())) > 1:
        wrong.append(f"the dates of the release differ or are missing: {dates}")
    print(*(wrong or [f"all documents state version {version}"]), sep="\n")
    return 1 if wrong else 0


if __name__ == "__main__":
    source = Path(sys.argv[1])
    project = first(source, "CMakeLists.txt", r"^project\(Tautline VERSION (\S+)")
    sys.exit(main(source, sys.argv[2] if len(sys.argv) > 2 else project))
