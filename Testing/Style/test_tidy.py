# SPDX-License-Identifier: BSD-3-Clause
"""test_tidy.py SOURCE_TREE WORK: ./run tidy checks the sources that were changed or named, also in a unity build.

ninja and clang-tidy are replaced by stand-ins: the first prints the commands of a small tree, the second reports lines
with the word DEFECT in a source and its headers.
"""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

NINJA = '#!/bin/sh\ncat "$2/compdb.json"\n'  # ninja -C BUILD -t compdb
TIDY = """#!{python}
import json, re, sys
from pathlib import Path
source, folder = Path(sys.argv[-1]), Path(sys.argv[sys.argv.index("-p") + 1])
entry = next(e for e in json.loads((folder / "compile_commands.json").read_text()) if e["file"] == str(source))
if entry["command"] != f"c++ -DX=1 -O3 -o o.o -c {{source}}":
    sys.exit("another command: " + entry["command"])
found = 0
for path in (source, *[source.parent / name for name in re.findall('#include "(.*)"', source.read_text())]):
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if "DEFECT" in line:
            print(f"{{path}}:{{number}}:1: error: a defect [check]\\n{{line}}\\n^")
            found = 1
sys.exit(found)
"""
FLAGS = "c++ -DX=1 -Wall -Wno-error=x -O3 -MD -MT o.o -MF o.o.d -o o.o -c "
SHARED = '#include "Shared.h"\n'
FILES = {
    "Filters/A/One.cxx": SHARED,
    "Filters/A/Two.cxx": SHARED,
    "Filters/A/Shared.cxx": SHARED,
    "Filters/A/Shared.Topic.cxx": SHARED,
    "Filters/A/Shared.h": "int shared();\n",
    "Plugin/Three.cxx": "int three;\n",
    "Testing/Four.cxx": "int four; // DEFECT, in a directory that is not checked\n",
}


class Checkout:
    """A checkout whose build tree compiles the sources of Filters/A at once."""

    def __init__(self, source: Path, work: Path):
        shutil.rmtree(work, ignore_errors=True)
        self.source, self.top, self.build, self.tools = source, work / "top", work / "build", work / "bin"
        for name, text in FILES.items():
            self.write(name, text)
        shutil.copyfile(source / ".clang-tidy", self.top / ".clang-tidy")
        united = self.build / "Unity/unity_0.cxx"
        united.parent.mkdir(parents=True)
        together = [self.top / name for name in FILES if name.startswith("Filters") and name.endswith(".cxx")]
        united.write_text("".join(f'/* generated */\n#include "{path}"\n' for path in together))
        compiled = (united, self.top / "Plugin/Three.cxx", self.top / "Testing/Four.cxx")
        entries = [{"directory": str(self.build), "file": str(path), "command": f"{FLAGS}{path}"} for path in compiled]
        (self.build / "compdb.json").write_text(json.dumps(entries))
        self.tools.mkdir()
        for name, text in (("ninja", NINJA), ("clang-tidy", TIDY.format(python=sys.executable))):
            (self.tools / name).write_text(text)
            (self.tools / name).chmod(0o755)

    def write(self, name: str, text: str) -> None:
        (self.top / name).parent.mkdir(parents=True, exist_ok=True)
        (self.top / name).write_text(text)

    def git(self, *arguments: str) -> None:
        user = ("-c", "user.name=Tester", "-c", "user.email=tester@localhost", "-c", "init.defaultBranch=main")
        nothing = dict(os.environ, GIT_CONFIG_GLOBAL=os.devnull, GIT_CONFIG_SYSTEM=os.devnull)
        command = ["git", "-C", str(self.top), *user, *arguments]
        subprocess.run(command, check=True, env=nothing, stdout=subprocess.DEVNULL)

    def tidy(self, *arguments: str) -> tuple[int, str]:
        program = [sys.executable, str(self.source / "Testing/Style/tidy.py"), str(self.top), str(self.build)]
        environment = dict(os.environ, PATH=f"{self.tools}:{os.environ['PATH']}")
        done = subprocess.run([*program, *arguments], cwd=self.top, env=environment, capture_output=True, text=True)
        return done.returncode, done.stdout + done.stderr


def main(source: Path, work: Path) -> None:
    tree = Checkout(source, work)
    tree.git("init", "-q")
    tree.git("add", "-A")
    tree.git("commit", "-q", "-m", "Start")
    code, said = tree.tidy()
    assert code == 0 and "0 of 5 sources, 0 findings" in said, said
    code, said = tree.tidy("--all")
    assert code == 0 and "5 of 5 sources, 0 findings" in said, said
    # A header counts once, and brings the sources of its name.
    tree.write("Filters/A/Shared.h", "int shared(); // DEFECT\n")
    code, said = tree.tidy()
    assert code == 1 and "2 of 5 sources, 1 findings" in said and said.count("Shared.h:1:1") == 1, said
    code, said = tree.tidy("--all")
    assert code == 1 and "5 of 5 sources, 1 findings" in said, said
    # Commits of a branch count, and so do files that are not added.
    tree.git("checkout", "-q", "-b", "topic")
    tree.write("Filters/A/Shared.h", FILES["Filters/A/Shared.h"])
    tree.write("Plugin/Three.cxx", "int three; // DEFECT\n")
    tree.git("commit", "-q", "-a", "-m", "Change")
    code, said = tree.tidy()
    assert code == 1 and "1 of 5 sources, 1 findings" in said and "Three.cxx:1:1" in said, said
    code, said = tree.tidy("Filters/A/Two.cxx", "Filters/A/One.cxx")
    assert code == 0 and "2 of 5 sources, 0 findings" in said, said
    code, said = tree.tidy("Testing/Four.cxx")
    assert code == 1 and "no C++ source" in said, said
    # A source that cannot be checked is no success.
    compiled = (tree.build / "compdb.json").read_text()
    (tree.build / "compdb.json").write_text(compiled.replace("-DX=1", "-DX=2"))
    code, said = tree.tidy("Filters/A/One.cxx")
    assert code == 1 and "One.cxx: another command" in said and "1 findings" in said, said
    print("./run tidy finds what is changed, named, and in all sources")


if __name__ == "__main__":
    if not shutil.which("git"):
        print("no git: skipped")
        sys.exit(77)
    main(*(Path(argument).resolve() for argument in sys.argv[1:3]))
