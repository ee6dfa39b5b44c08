# SPDX-License-Identifier: BSD-3-Clause
"""test_check_english.py: check_english.py finds its patterns in comments, strings and documents, not in code."""

import contextlib
import io
import sys
import tempfile
from pathlib import Path

import check_english

#: The ending of a file, its text, and the hits: line and name of the pattern.
TEXTS = (
    (".h", "// The points are those of the mesh.\n", [(1, "those of, that of")]),
    (".cxx", "/** The points are those\n * of the mesh. */\nint those; // of\n", [(1, "those of, that of")]),
    (".py", 'TEXT = ("the value is that "\n        f"of {name}")\n', [(1, "those of, that of")]),
    (".py", 'def those(of):\n    """A value."""\n', []),
    (".h", "/// Of a mesh the points.\n", [(1, "sentence begins with Of")]),
    (".md", "Two files. Of\nthese, one is read.\n", [(1, "sentence begins with Of")]),
    (".h", 'int a = Of (b); // The number of cells\nsetText("Number Of Cells");\n', []),
    (".cxx", '  throw Error("Such a mesh\\nis refused.");\n', [(1, "refuse")]),
    (".cxx", "  refuse(mesh); // with a message\n", []),
    (".xml", '<Documentation>The filter refuses it.</Documentation>\n<a name="b"/>\n', [(1, "refuse")]),
    (".py", "x = 1  # Starts anew.\n", [(1, "anew")]),
    (".py", 'text = f"The mesh was {wording(\'divided-anew\')} among {n} processes"\n', []),
    (".md", "Stop after so\nmany seconds.\n", [(1, "so many")]),
    (".sh", "# mend the cause, as recommended\n", [(1, "mend")]),
    (".h", "// Valid (but for\n// tangling).\n", [(1, "but for")]),
    (".h", "// The same but for the order.\n", [(1, "but for")]),
    (".h", "// Not for speed, but for memory.\n", []),
    (".h", "// The neighbours of a cell, by colour.\n", [(1, "British spelling"), (1, "British spelling")]),
    (".md", "The Licence of the package\n", [(1, "British spelling")]),
    (".cxx", "int colour = neighbour; // its color\n", []),
    (".cxx", 'read("neighbour", "the file neighbour", mesh.neighbours()); // `neighbour`, polyMesh/neighbour\n',
     [(1, "British spelling")]),
    (".py", '"""A result.\n\n    centre, radius : Array, float\n        The center.\n"""\n', []),
)  # fmt: skip


def check_tree(count: int) -> tuple[int, str]:
    """Exit code and output for a tree with this many times "that of", in files of two kinds."""
    with tempfile.TemporaryDirectory() as directory:
        top = Path(directory)
        (top / "Filters/Kernel").mkdir(parents=True)
        (top / "Filters/Kernel/Mesh.h").write_text("// Its size is that of the input.\n" * (count - 1))
        (top / "README.md").write_text("The result is that of the input.\n")
        (top / "CHANGELOG.md").write_text("The colour is that of the input.\n")
        text = io.StringIO()
        with contextlib.redirect_stdout(text):
            code = check_english.main(top)
        return code, text.getvalue()


def main() -> int:
    failed = 0
    for ending, text, expected in TEXTS:
        found = [hit[:2] for hit in check_english.hits(text, check_english.LANGUAGES.get(ending))]
        if found != expected:
            print(f"{ending} {text!r}: {found}, not {expected}")
            failed += 1
    missing = check_english.PATTERNS.keys() - {name for _, _, hits in TEXTS for _, name in hits}
    assert not missing, missing
    allowed = check_english.PATTERNS["those of, that of"][1]
    code, text = check_tree(allowed)
    assert code == 0 and "README.md:1: those of, that of: that of\n" in text, text
    assert f"{allowed} allowed: {allowed - 1} in Filters, 1 in README.md\n" in text, text
    code, text = check_tree(allowed + 1)
    assert code == 1 and text.endswith("2 files, 1 patterns occur too often\n"), text
    print(f"{len(TEXTS)} texts, {failed} wrong")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
