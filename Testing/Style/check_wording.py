#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests find messages by ids of Testing/wording.json: every id is there and used, and no test pins a sentence itself.

usage: check_wording.py TOP
"""

import json
import re
import sys
from pathlib import Path

#: Two words or more in a literal that is looked for in a message.
PROSE = r'"(?:[^"\\\n]|\\.)*[A-Za-z]{2,} (?:[^"\\\n]|\\.)*[A-Za-z]{2,}(?:[^"\\\n]|\\.)*"'
PINS = {
    ".cxx": (
        rf"TAUTLINE_CHECK_THROWS\([^;]*,\s*{PROSE}\);",
        rf"\.has\({PROSE}\)",
        rf"\.find\({PROSE}\)\s*[!=]=\s*(?:std::string::|\w+\.)npos",
    ),
    ".py": (rf"\brejected\(\s*{PROSE},", rf"\bassert {PROSE} (?:not )?in "),
}
PINS[".h"] = PINS[".cxx"]


def main(top: Path) -> list[str]:
    """The problems, a line each."""
    file = top / "Testing/wording.json"
    content = file.read_text(encoding="utf-8")
    texts = json.loads(content)
    problems, used = [], set()
    if content != json.dumps(dict(sorted(texts.items())), indent=2, ensure_ascii=False) + "\n":
        problems.append(f"{file}: not sorted, or not indented by 2")
    for folder in ("Testing/Cxx", "Testing/Python"):
        for path in sorted((top / folder).rglob("*")):
            if path.suffix not in PINS:
                continue
            source = path.read_text(encoding="utf-8")
            used |= (found := set(re.findall(r'\bwording\(\s*"([^"]+)"\s*\)', source)))
            problems += [f"{path}: {file.name} has no {key}" for key in sorted(found - texts.keys())]
            for pattern in PINS[path.suffix]:
                for match in re.finditer(pattern, source):
                    line = source.count("\n", 0, match.start()) + 1
                    problems.append(f"{path}:{line}: use wording(id): {' '.join(match[0].split())[-80:]}")
    problems += [f"{file}: no test uses {key}" for key in sorted(texts.keys() - used)]
    return problems


if __name__ == "__main__":
    found = main(Path(sys.argv[1]))
    print("\n".join(found) if found else "each id is used, no test pins a sentence")
    sys.exit(bool(found))
