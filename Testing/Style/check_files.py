# SPDX-License-Identifier: BSD-3-Clause
"""check_files.py SOURCE_TREE: line ends, tabs, trailing space, lengths of files and lines, clang-format."""

import shutil
import subprocess
import sys
from pathlib import Path

DIRECTORIES = ("Filters", "Readers", "ServerManager", "Plugin", "Testing", "python", ".ci")
CODE = {".h", ".cxx", ".py", ".cmake", ".in", ".sh"}
TEXT = CODE | {".xml", ".md", ".qrc", ".svg", ".txt", ".module", ".plugin"}
MAX_LINES = 700
LICENCE = b"SPDX-License-Identifier"  # a line that does not count
CONFLICT = (b"<<<<<<< ", b">>>>>>> ")
CLANG_FORMAT = 14  # others break lines elsewhere
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
    count = sum(LICENCE not in line for line in lines) - 1
    if count > MAX_LINES and path.suffix in CODE:
        yield f"has {count} lines, {MAX_LINES} are allowed"


def badly_formatted(paths) -> int:
    """The number of C++ files clang-format would change; 0 where there is none of the right version."""
    program = shutil.which(f"clang-format-{CLANG_FORMAT}") or shutil.which("clang-format")
    version = subprocess.run([program, "--version"], capture_output=True, text=True).stdout if program else ""
    if program and f"version {CLANG_FORMAT}." not in version:
        print(f"the format of C++ files is not checked: {program} is not of version {CLANG_FORMAT}")
        program = None
    wrong = 0
    for path in paths if program else []:
        check = [program, "--dry-run", "-Werror", "--ferror-limit=1", str(path)]
        if subprocess.run(check, capture_output=True).returncode != 0:
            print(f"{path} is not as clang-format has it: ./run format")
            wrong += 1
    return wrong


def main(top: Path) -> int:
    files = sorted(sources(top))
    found = [f"{path} {complaint}" for path in files for complaint in complaints(path)]
    print("\n".join(found))
    wrong = len(found) + badly_formatted([p for p in files if p.suffix in (".h", ".cxx")])
    print(f"{len(files)} files, {wrong} complaints")
    return 1 if wrong or not files else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
