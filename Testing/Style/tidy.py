# SPDX-License-Identifier: BSD-3-Clause
"""tidy.py TOP BUILD [--all | FILE...]: clang-tidy over Tautline's C++ sources, with the checks of .clang-tidy.

Without arguments: the sources that differ from the main branch, and for a header the sources of its name. The commands
are those of the build tree, for each source alone also where CMake compiles several at once. The tree must be
configured, and needs no compiled file.
"""

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

FOLDERS = ("Filters/", "Readers/", "Plugin/")
UNITED = re.compile(r'^#include "(.+)"$', re.MULTILINE)
#: Warnings are those of the compiler of the build, and so are the lists of dependencies.
LEFT_OUT = re.compile(r" (-W\S+|-MD|-M[TF] \S+)")
FINDING = re.compile(r"^\S+:\d+:\d+: (warning|error): ", re.MULTILINE)
MAIN = ("origin/HEAD", "origin/main", "main")


def database(top: Path, build: Path) -> dict[str, dict]:
    """The command of each source by its name in the repository."""
    done = subprocess.run(["ninja", "-C", build, "-t", "compdb"], capture_output=True, text=True, check=True)
    found: dict[str, dict] = {}
    for entry in json.loads(done.stdout):
        file = entry["file"]
        if not file.endswith(".cxx") or not os.path.isabs(file):  # others are generated
            continue
        united = UNITED.findall(Path(file).read_text(encoding="utf-8")) if "/Unity/" in file else [file]
        for source in united:
            name = os.path.relpath(source, top)
            if name.startswith(FOLDERS):
                command = LEFT_OUT.sub("", entry["command"]).replace(file, source)
                found.setdefault(name, {"directory": entry["directory"], "file": source, "command": command})
    return found


def git(top: Path, *arguments: str) -> list[str]:
    done = subprocess.run(["git", "-C", str(top), *arguments], capture_output=True, text=True)
    return done.stdout.split("\n")[:-1] if done.returncode == 0 else []


def changed(top: Path) -> list[str]:
    """Files that differ from the main branch, committed or not."""
    bases = (git(top, "merge-base", branch, "HEAD") for branch in MAIN)
    base = next((lines[0] for lines in bases if lines), "HEAD")
    if not git(top, "rev-parse", "--verify", base):
        sys.exit(f"git cannot read {top}: name the sources, or give --all")
    return git(top, "diff", "--name-only", base) + git(top, "ls-files", "--others", "--exclude-standard")


def chosen(names: list[str], sources: dict[str, dict]) -> list[str]:
    """The sources among these files, and those of their headers: Name.cxx, Name.Topic.cxx."""
    stems = {name.rpartition(".")[0] for name in names if name.endswith((".h", ".cxx"))}
    headers = {name.rpartition(".")[0] for name in names if name.endswith(".h")}

    def wanted(name: str) -> bool:
        first = name[: len(name) - len(Path(name).name)] + Path(name).name.split(".")[0]
        return name.rpartition(".")[0] in stems or first in headers

    return sorted(filter(wanted, sources))


def check(names: list[str], sources: dict[str, dict], top: Path) -> int:
    """Prints each finding once, as soon as it is found, and sources that clang cannot parse; returns their number."""
    seen = set()
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(os.cpu_count()) as pool:
        (Path(folder) / "compile_commands.json").write_text(json.dumps(list(sources.values())), encoding="utf-8")
        start = ["clang-tidy", "-p", folder, "--quiet", f"--config-file={top / '.clang-tidy'}"]

        def of_source(name: str) -> subprocess.CompletedProcess:
            return subprocess.run([*start, sources[name]["file"]], cwd=top, capture_output=True, text=True)

        for name, done in zip(names, pool.map(of_source, names)):
            starts = [match.start() for match in FINDING.finditer(done.stdout)]
            found = [done.stdout[i:j].rstrip() for i, j in zip(starts, [*starts[1:], len(done.stdout)])]
            if done.returncode and not found:
                found = [f"{name}: {done.stderr.strip()}"]
            for text in found:
                if text not in seen:
                    print(text, flush=True)
                seen.add(text)
    return len(seen)


def main(top: Path, build: Path, arguments: list[str]) -> int:
    if not shutil.which("clang-tidy"):
        print("no clang-tidy: apt-get install clang-tidy", file=sys.stderr)
        return 1
    sources = database(top, build)
    if arguments == ["--all"]:
        names = sorted(sources)
    elif arguments:
        names = chosen([os.path.relpath(Path(file).resolve(), top) for file in arguments], sources)
        if not names:
            print(f"no C++ source of {', '.join(FOLDERS)} among {' '.join(arguments)}", file=sys.stderr)
            return 1
    else:
        names = chosen(changed(top), sources)
    if not sources:
        print("the compile commands have no source of this tree", file=sys.stderr)
        return 1
    start = time.monotonic()
    count = check(names, sources, top)
    print(f"{len(names)} of {len(sources)} sources, {count} findings, {time.monotonic() - start:.0f} s")
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main(*(Path(argument).resolve() for argument in sys.argv[1:3]), sys.argv[3:]))
