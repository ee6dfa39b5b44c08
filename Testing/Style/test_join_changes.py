# SPDX-License-Identifier: BSD-3-Clause
"""test_join_changes.py SOURCE_TREE WORK: fragments are joined into the change log; malformed ones change nothing."""

import shutil
import subprocess
import sys
from pathlib import Path

VERSION = "27.3.1"
DATE = "2030-02-28"
STATED = ("CMakeLists.txt", "CITATION.cff", "CHANGELOG.md", "SECURITY.md")
GOOD = {
    "zebra.md": "### Added\n\n- The last one of **Added**.\n",
    "apple-2.md": "### Fixed\n\n- A repair, \\1 and [a link](CITATION.cff#top)\n  in two lines.\n- Another one.\n",
    "mango.md": "### Added\n\n- The first one of **Added**: ä, 90°.\n",
    "nut.md": "### Security\n\n- A guarantee ([forge](https://example.org/x)).\n",
}
SECTION = f"""## {VERSION} - {DATE}

### Added

- The first one of **Added**: ä, 90°.
- The last one of **Added**.

### Fixed

- A repair, \\1 and [a link](CITATION.cff#top)
  in two lines.
- Another one.

### Security

- A guarantee ([forge](https://example.org/x)).

"""
#: Malformed fragments, with a part of what is reported.
BAD = {
    "Upper.md": ("### Fixed\n\n- Text.\n", "no file with a name"),
    "note.txt": ("### Fixed\n\n- Text.\n", "no file with a name"),
    ".hidden.md": ("### Fixed\n\n- Text.\n", "no file with a name"),
    "empty.md": ("", "does not begin"),
    "kind.md": ("### Improved\n\n- Text.\n", "does not begin"),
    "level.md": ("## Fixed\n\n- Text.\n", "does not begin"),
    "space.md": ("### Fixed \n\n- Text.\n", "does not begin"),
    "no-item.md": ("### Fixed\n\nText.\n", "no blank line and list item"),
    "no-blank.md": ("### Fixed\n- Text.\n- Text.\n", "no blank line and list item"),
    "two-kinds.md": ("### Fixed\n\n- Text.\n### Added\n\n- Text.\n", "in line 4"),
    "gap.md": ("### Fixed\n\n- Text.\n\n- Text.\n", "in line 4"),
    "indent.md": ("### Fixed\n\n- Text\n goes on.\n", "in line 4"),
    "wide.md": (f"### Fixed\n\n- {'x' * 119}\n", "120 columns"),
    "trailing.md": ("### Fixed\n\n- Text. \n", "spaces at the end"),
    "no-end.md": ("### Fixed\n\n- Text.", "line end"),
    "link.md": ("### Fixed\n\n- See [this](../Site/nowhere.md).\n", "which does not exist"),
    "latin.md": (b"### Fixed\n\n- \xe4.\n", "UTF-8"),
}


def tree(source: Path, work: Path, changes: dict) -> Path:
    """A tree with what a release changes, and these fragments."""
    shutil.rmtree(work, ignore_errors=True)
    (work / "Plugin/Changes").mkdir(parents=True)
    for name in (*STATED, "Plugin/Changes/README.md"):
        shutil.copyfile(source / name, work / name)
    for name, text in changes.items():
        (work / "Plugin/Changes" / name).write_bytes(text if isinstance(text, bytes) else text.encode())
    return work


def run(source: Path, *arguments) -> subprocess.CompletedProcess:
    program = [sys.executable, str(source / "Plugin/Packaging/join_changes.py")]
    return subprocess.run([*program, *map(str, arguments)], capture_output=True, text=True)


def content(top: Path) -> dict:
    return {path.relative_to(top).as_posix(): path.read_bytes() for path in top.rglob("*") if path.is_file()}


def test_joined(source: Path, work: Path) -> None:
    top = tree(source, work, GOOD)
    before = content(top)
    assert run(source, top, "check").returncode == 0
    done = run(source, top, "join", VERSION, DATE)
    assert done.returncode == 0, done.stderr
    after = content(top)
    assert set(after) == {*STATED, "Plugin/Changes/README.md"}, sorted(after)
    old, new = before["CHANGELOG.md"].decode(), after["CHANGELOG.md"].decode()
    start = old.index("\n## ") + 1
    assert new == old[:start] + SECTION + old[start:], new
    for text in GOOD.values():  # nothing is lost
        assert text.partition("\n\n")[2] in new, text
    for name in STATED:
        lines = {line for line in after[name].splitlines() if line not in before[name].splitlines()}
        changed = sorted(line.decode() for line in lines)
        print(name, changed if name != "CHANGELOG.md" else len(changed))
        assert name == "CHANGELOG.md" or 1 <= len(changed) <= 2, (name, changed)
    check = [sys.executable, str(source / "Testing/Style/check_version.py"), str(top)]
    assert subprocess.run([*check, VERSION]).returncode == 0
    assert subprocess.run([*check, "27.4.0"], stdout=subprocess.DEVNULL).returncode == 1
    again = run(source, top, "join", "27.3.2", DATE)
    assert again.returncode == 1 and "no change to release" in again.stderr, again.stderr
    assert content(top) == after


def test_malformed(source: Path, work: Path) -> None:
    for name, (text, complaint) in BAD.items():
        top = tree(source, work, {**GOOD, name: text})
        before = content(top)
        for arguments in (("check",), ("join", VERSION, DATE)):
            done = run(source, top, *arguments)
            said = done.stdout + done.stderr
            assert done.returncode == 1 and complaint in said and name in said, (name, arguments, said)
            assert not any(good in said for good in GOOD), said
        assert content(top) == before, name
    top = tree(source, work, GOOD)
    (top / "Plugin/Changes/folder.md").mkdir()
    assert "folder.md is no file" in run(source, top, "join", VERSION, DATE).stderr


def test_arguments(source: Path, work: Path) -> None:
    top = tree(source, work, GOOD)
    before = content(top)
    wrong = (("0.0.1", DATE), ("27.3", DATE), ("v27.3.1", DATE), ("027.3.1", DATE), (VERSION, "2030-02-30"))
    for version, date in (*wrong, (VERSION, "20300228"), (VERSION, "today")):
        done = run(source, top, "join", version, date)
        assert done.returncode == 1 and "nothing was changed" in done.stderr, (version, date, done.stderr)
        assert content(top) == before
    (top / "CITATION.cff").write_text("cff-version: 1.2.0\n", encoding="utf-8")
    before = content(top)
    done = run(source, top, "join", VERSION, DATE)
    assert done.returncode == 1 and "CITATION.cff has 0 places" in done.stderr, done.stderr
    assert content(top) == before
    assert run(source, top).returncode == 2


def main(source: Path, work: Path) -> None:
    for test in (test_joined, test_malformed, test_arguments):
        test(source, work)
        print(f"{test.__name__}: passed")


if __name__ == "__main__":
    main(*(Path(argument).resolve() for argument in sys.argv[1:3]))
