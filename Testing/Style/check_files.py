# SPDX-License-Identifier: BSD-3-Clause
"""check_files.py SOURCE_TREE: line ends, tabs, trailing space, lengths of files, functions and lines, clang-format."""

import os
import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

DIRECTORIES = ("Filters", "Readers", "ServerManager", "Plugin", "Testing", "python", ".ci", ".github")
CODE = {".h", ".cxx", ".py", ".cmake", ".in", ".sh"}
TEXT = CODE | {".xml", ".md", ".qrc", ".svg", ".txt", ".module", ".plugin", ".yml", ".yaml", ".cff"}
LONG_FILE = 1500  # lines, from which on a file is mentioned
MAX_FUNCTION = 100  # lines of a function of C++ outside the tests, without a table that it returns
NO_FUNCTION = re.compile(r"(inline )?(namespace|class|struct|union|enum|extern)\b")
CONFLICT = (b"<<<<<<< ", b">>>>>>> ")
CLANG_FORMAT = 14  # others break lines elsewhere
FORMATTED_AT_ONCE = 50  # files
MAX_COLUMNS = {".h": 100, ".cxx": 100, ".py": 120}  # clang-format leaves comments and texts as they are


def sources(top: Path):
    yield from (p for p in top.iterdir() if p.is_file() and (p.suffix in TEXT or p.name == "run"))
    for directory in DIRECTORIES:
        yield from (p for p in (top / directory).rglob("*") if p.suffix in TEXT or p.name == "run")


def complaints(path: Path):
    content = path.read_bytes()
    if not content:
        yield "is empty"
        return
    if b"\r" in content:
        yield "has carriage returns"
    if b"\t" in content:
        yield "has tabs"
    if not content.endswith(b"\n"):
        yield "does not end with a line end"
    lines = content.split(b"\n")
    if any(line.endswith(b" ") for line in lines) and path.suffix != ".md":
        yield "has spaces at a line's end"
    if any(line.startswith(CONFLICT) for line in lines):
        yield "has the marks of a conflict"
    columns = MAX_COLUMNS.get(path.suffix)
    for number, line in enumerate(lines, 1):
        if columns and len(line.decode()) > columns:
            yield f"has {len(line.decode())} columns in line {number}, {columns} are allowed"
    if path.suffix in (".h", ".cxx") and "Testing" not in path.parts:
        yield from long_functions(content.decode().split("\n"))


def long_functions(lines: list[str]):
    """Functions begin and end with a brace in the first column."""
    start = table = 0
    for number, line in enumerate(lines):
        if line == "{":
            start, table = number, 0
        elif start and line == "  return {":
            table = number
        elif start and line == "}":
            count = (table or number) - start - 1
            if count > MAX_FUNCTION and not NO_FUNCTION.match(lines[start - 1]):
                yield f"has a function of {count} lines at line {start}, {MAX_FUNCTION} are allowed"
            start = 0


def badly_formatted(paths) -> int:
    """The number of C++ files clang-format would change; 0 where there is none of the right version."""
    program = shutil.which(f"clang-format-{CLANG_FORMAT}") or shutil.which("clang-format")
    version = subprocess.run([program, "--version"], capture_output=True, text=True).stdout if program else ""
    if program and f"version {CLANG_FORMAT}." not in version:
        print(f"the format of C++ files is not checked: {program} is not of version {CLANG_FORMAT}")
        program = None
    if not program:
        return 0
    groups = [paths[i : i + FORMATTED_AT_ONCE] for i in range(0, len(paths), FORMATTED_AT_ONCE)]

    def of_group(group) -> str:
        return subprocess.run([program, "--dry-run", *group], capture_output=True, text=True).stderr

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        reports = "".join(pool.map(of_group, groups))
    wrong = sorted(set(re.findall(r"^(.+?):\d+:\d+: warning: code should be clang-formatted", reports, re.MULTILINE)))
    for path in wrong:
        print(f"{path} is not as clang-format has it: ./run format")
    return len(wrong)


def main(top: Path) -> int:
    files = sorted(sources(top))
    for path in files:
        count = path.read_bytes().count(b"\n")
        if count > LONG_FILE and path.suffix in CODE:
            print(f"{path} has {count} lines: could it be two files?")
    found = [f"{path} {complaint}" for path in files for complaint in complaints(path)]
    print("\n".join(found))
    wrong = len(found) + badly_formatted([p for p in files if p.suffix in (".h", ".cxx")])
    print(f"{len(files)} files, {wrong} complaints")
    return 1 if wrong or not files else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
