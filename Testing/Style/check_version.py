# SPDX-License-Identifier: BSD-3-Clause
"""check_version.py SOURCE_TREE VERSION: documents that have to state the version state that of the project."""

import re
import sys
from pathlib import Path

#: File and the pattern of the version in it.
PLACES = (
    ("CITATION.cff", r"^version: (\S+)$"),
    ("CHANGELOG.md", r"^## (\d\S*) - "),
)


def main(top: Path, version: str) -> int:
    wrong = 0
    for name, pattern in PLACES:
        found = re.search(pattern, (top / name).read_text(encoding="utf-8"), re.MULTILINE)
        if not found or found[1] != version:
            wrong += 1
            print(f"{name} states version {found and found[1]}, the project's is {version}")
    return wrong


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), sys.argv[2]))
