# SPDX-License-Identifier: BSD-3-Clause
"""gallery_commands.py EXAMPLES: the lines "Shell:" of the gallery are commands, with options that exist."""

import re
import shlex
import sys
from pathlib import Path

from tautline.__main__ import _parser

LEAST = 25  # commands
count = 0
for script in sorted(Path(sys.argv[1]).glob("[0-9]*.py")):
    for line in re.findall(r"^Shell: (.+)$", script.read_text(encoding="utf-8"), re.MULTILINE):
        for command in line.split("; "):
            words = shlex.split(command)
            assert words[0] == "tautline", f"{script.name}: {command}"
            print(script.name, command, flush=True)  # argparse ends the program at a wrong one
            _parser().parse_args(words[1:])
            count += 1
assert count >= LEAST, count
