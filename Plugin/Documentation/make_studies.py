#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the committed findings of the studies, their report and its summary.

make_studies.py DIR --write takes the results of `python3 -m tautline study all --record --out DIR`. Where a study
has no results there, and without DIR everywhere, it keeps the committed findings and pictures: after a reason was added
to python/studies/evidence/reasons.json, for instance. Without --write nothing is written; the code is 1 if a file is
not what this program makes.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
from pathlib import Path

from tautline.studies import _evidence, described
from tautline.studies._page import pages, study_in, study_of, summary_markdown
from tautline.studies.all import OPTIONS, studies

ROOT = Path(__file__).resolve().parent.parent.parent
REPORT = ROOT / "Plugin" / "Documentation" / "studies.html"
SECOND = REPORT.with_name("studies_more.html")
SITE = ROOT / "Plugin" / "Site" / "studies.md"
BEGIN, END = "<!-- summary: made by make_studies.py -->", "<!-- end of the summary -->"
WIDTH = 860  # pixels, of a picture


def check(name: str, folder: Path) -> None:
    """Reject results of a run whose options are not the record's."""
    expected = list(_evidence.size_of(name).options)
    options = (folder / OPTIONS).read_text(encoding="utf-8").split()
    if options[: len(expected)] != expected or set(options[len(expected) :: 2]) - {"--data"}:
        raise SystemExit(f"{folder} was run with '{' '.join(options)}', not with '{' '.join(expected)}'")


def main() -> int:
    made = argparse.ArgumentParser(description=__doc__)
    made.add_argument("results", nargs="?", type=Path, help="a folder of `study all`")
    made.add_argument("--write", action="store_true")
    given = made.parse_args()
    report = "".join(file.read_text(encoding="utf-8") for file in (REPORT, SECOND) if file.is_file())
    files: dict[Path, str | bytes] = {}
    found = {}

    def show(label: str, data: bytes) -> str:
        file = f"study_{label.replace('/', '_')}.png"
        files[REPORT.parent / file] = data
        return f"<img alt='{label}' src=\"{file}\">"

    for name in studies():
        folder = given.results / name if given.results else None
        if folder and (folder / OPTIONS).is_file():
            check(name, folder)
            found[name] = study_in(name, described(name), folder, WIDTH, show)
            files[_evidence.FOLDER / f"{name}.json"] = json.dumps(found[name].record, indent=1) + "\n"
        else:
            found[name] = study_of(name, described(name), report)
    files[REPORT], files[SECOND] = pages(found, SECOND.name)
    text = SITE.read_text(encoding="utf-8")
    table = f"{BEGIN}\n{summary_markdown(found.values())}\n{END}"
    files[SITE] = re.sub(rf"{re.escape(BEGIN)}.*{re.escape(END)}", lambda _: table, text, flags=re.DOTALL)
    files = {file: content.encode() if isinstance(content, str) else content for file, content in files.items()}
    wrong = [file for file, content in files.items() if not file.is_file() or file.read_bytes() != content]
    for file in wrong:
        print(f"{file.relative_to(ROOT)}: {'written' if given.write else 'is not what this program makes'}")
        if given.write:
            file.parent.mkdir(exist_ok=True)
            file.write_bytes(files[file])
    shown = set(re.findall(r'src="(study_[^"]+)"', (files[REPORT] + files[SECOND]).decode()))
    for file in REPORT.parent.glob("study_*.png"):
        if file.name not in shown:
            wrong.append(file)
            print(f"{file.relative_to(ROOT)}: {'removed' if given.write else 'is not in the report'}")
            if given.write:
                file.unlink()
    return 1 if wrong and not given.write else 0


if __name__ == "__main__":
    sys.exit(main())
