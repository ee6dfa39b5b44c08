# SPDX-License-Identifier: BSD-3-Clause
"""run_examples.py KIND DOCUMENTATION WORK [--write]: runs the examples of the help pages and compares what they print.

KIND is pvpython or python3, and so is the interpreter that runs this. An example is a block of code after the comment
<!-- test: KIND -->; the block after "Output:" has what it prints. Numbers may differ by TOLERANCE. --write puts what is
printed in the pages. Each example runs in WORK, which has the sample meshes in Data.
"""

import contextlib
import io
import os
import re
import shutil
import sys
import traceback
from pathlib import Path

EXAMPLE = re.compile(
    r"<!-- test: (?P<kind>\w+) -->\n```python\n(?P<code>.*?)^```\n"
    r"(?:\nOutput:\n\n```text\n(?P<output>.*?)^```\n)?",
    re.MULTILINE | re.DOTALL,
)
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?")
TOLERANCE = 0.01  # relative


def same(printed: str, expected: str) -> bool:
    """The same text with nearly the same numbers; whole numbers are the same."""
    if NUMBER.sub("#", printed.strip()) != NUMBER.sub("#", expected.strip()):
        return False
    pairs = zip(NUMBER.findall(printed), NUMBER.findall(expected))
    return all(a == b or ("." in a and abs(float(a) - float(b)) <= TOLERANCE * abs(float(b))) for a, b in pairs)


def run(code: str, name: str) -> str:
    """The output of the code."""
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        exec(compile(code, name, "exec"), {})  # pylint: disable=exec-used
    return out.getvalue()


def run_page(page: Path, kind: str, write: bool) -> tuple:
    """(examples, wrong ones) of a page."""
    text = page.read_text(encoding="utf-8")
    count, wrong, pieces, end = 0, 0, [], 0
    for match in EXAMPLE.finditer(text):
        if match["kind"] != kind:
            continue
        count += 1
        try:
            printed = run(match["code"], page.name)
        except Exception:  # the other examples also run
            traceback.print_exc()
            wrong += 1
            continue
        expected = match["output"] or ""
        if not same(printed, expected):
            wrong += not write
            print(f"{page.name} prints\n{printed}instead of\n{expected}", flush=True)
        if match["output"] is not None:
            pieces += [text[end : match.start("output")], printed]
            end = match.end("output")
    if write:
        page.write_text("".join(pieces) + text[end:], encoding="utf-8")
    return count, wrong


def main(kind: str, pages: Path, work: Path, write: bool) -> int:
    data = pages.parents[1] / "Data"
    if work.exists() and not (work / "Data").is_symlink():
        print(f"{work} is not of these examples, and is left as it is: name a folder that does not exist")
        return 2
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    (work / "Data").symlink_to(data)
    os.chdir(work)
    results = [run_page(page, kind, write) for page in sorted(pages.glob("*.md"))]
    count, wrong = (sum(column) for column in zip(*results))
    print(f"{count} examples for {kind}, {wrong} wrong")
    return 1 if wrong or not count else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], Path(sys.argv[2]).resolve(), Path(sys.argv[3]).resolve(), "--write" in sys.argv))
