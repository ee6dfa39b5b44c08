# SPDX-License-Identifier: BSD-3-Clause
"""gallery_commands.py EXAMPLES DATA OUTPUT: the lines "Shell:" of the gallery write what the scripts write.

EXAMPLES is python/examples, DATA the folder of the samples. OUTPUT has a folder with the files of each script, which
their tests write. The commands of an example run one after the other in a folder with the samples and with the files
of the script that no command writes; each file that they write is compared with the script's file of this name.
"""

import contextlib
import re
import shlex
import shutil
import sys
from pathlib import Path

from gallery_arrays import file_differences, parts_of
from tautline.__main__ import _parser, main

LEAST = 25  # examples with commands
OUTPUTS = re.compile(r"(?: -o| --csv) (\S+)")
TARGETS = re.compile(r"^tautline convert \S+ (\S+)$")  # a command that names its output by its position
WRITE_STEP = re.compile(r'do = "write"\nfile = "([^"]+)"')
PASSING = (0, 1, 3)  # exit codes: done, invalid elements are left, the criteria are not met


def written(command: str, folder: Path) -> list[str]:
    """The files that a command writes."""
    words = shlex.split(command)
    if words[1] == "run":
        return WRITE_STEP.findall((folder / words[2]).read_text(encoding="utf-8"))
    return OUTPUTS.findall(command) + TARGETS.findall(command)


def check(script: Path, commands: list[str], data: Path, output: Path) -> list[str]:
    """The errors of the commands of one example."""
    work = output / "shell"
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir()
    files = [name for command in commands for name in written(command, output)]
    if not files:
        return ["the commands write no file"]
    for source in [*data.iterdir(), *output.iterdir()]:
        if source.is_file() and source.name not in files and not (work / source.name).exists():
            (work / source.name).symlink_to(source.resolve())
    lines = []
    for command in commands:
        words = shlex.split(command)
        assert words[0] == "tautline", f"{script.name}: {command}"
        print(script.name, command, flush=True)  # argparse ends the program at a wrong one
        _parser().parse_args(words[1:])
        code = run(words[1:], work)
        if code not in PASSING:
            lines.append(f"{command}: exit code {code}")
    for name in files:
        if not (output / name).exists():
            lines.append(f"{name}: the script does not write it")
        elif not (work / name).exists():
            lines.append(f"{name}: no command wrote it")
        else:
            lines += [f"{name}: {line}" for line in file_differences(work / name, output / name)]
    return lines


def run(words: list[str], folder: Path) -> int:
    with contextlib.chdir(folder):
        return main([*words, "--quiet"])


def main_test(examples: Path, data: Path, output: Path) -> int:
    count, wrong = 0, []
    for script in sorted(examples.glob("[0-9]*.py")):
        commands = parts_of(script.read_text(encoding="utf-8"))[2].get("Shell", [])
        if commands:
            found = check(script, commands, data, output / script.stem)
            wrong += [f"{script.name}: {line}" for line in found]
            count += 1
    print("\n".join(wrong))
    assert count >= LEAST, count
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main_test(*(Path(argument).resolve() for argument in sys.argv[1:])))
