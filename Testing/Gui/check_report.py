# SPDX-License-Identifier: BSD-3-Clause
"""check_report.py FILE [picture]: the report that the test SaveReport saved has everything, and needs no other file.

With "picture", for the report of another filter, only the picture is checked, and that no other file is needed.
"""

import base64
import re
import sys
from html.parser import HTMLParser
from pathlib import Path

VOID = {"meta", "img", "br", "rect"}
HEADINGS = ["Mesh", "Result", "Histogram", "Statistics", "Distribution", "Angles", "Settings"]


class Outline(HTMLParser):
    """The elements that are open, the headings, the cells of the tables, the addresses of the pictures."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.headings: list[str] = []
        self.cells: list[str] = []
        self.pictures: list[str] = []
        self.bars = 0

    def handle_starttag(self, tag, attributes):
        if tag not in VOID:
            self.open.append(tag)
        if tag == "img":
            self.pictures.append(dict(attributes)["src"])
        self.bars += tag == "rect"

    def handle_endtag(self, tag):
        if tag not in VOID:
            assert self.open.pop() == tag, tag

    def handle_data(self, data):
        if self.open and self.open[-1] == "h2":
            self.headings.append(data)
        if self.open and self.open[-1] == "td":
            self.cells.append(data)


text = Path(sys.argv[1]).read_text(encoding="utf-8")
outline = Outline()
outline.feed(text)
assert not outline.open, outline.open
if sys.argv[2:] != ["picture"]:
    assert [h for h in outline.headings if h in HEADINGS] == HEADINGS, outline.headings
    assert "8140" in outline.cells and "imr" in outline.cells, "the mesh has 8140 cells"
    assert "8099 valid elements, 41 inverted" in text
    assert outline.bars >= 34, "32 bins, beyond, inverted"
(picture,) = outline.pictures
kind, data = picture.split(",", 1)
assert kind == "data:image/png;base64" and base64.b64decode(data).startswith(b"\x89PNG"), kind
assert not re.search(r'(src|href)="(?!data:)', text), "another file is needed"
print(f"{len(text)} characters, {len(outline.cells)} cells of tables")
