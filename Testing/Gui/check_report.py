# SPDX-License-Identifier: BSD-3-Clause
"""check_report.py FILE [picture] | FILE MESH [untangled]: the report that a session saved is complete.

It needs no other file. With "picture", for the report of another filter, only its pictures are checked. With MESH it
is the report of the package tautline for the mesh, measured with the criteria fem or, with "untangled", for the mesh
before and after untangle(): the same sections with the same numbers, texts, histograms and pictures.
"""

import base64
import re
import sys
from html.parser import HTMLParser
from pathlib import Path

VOID = {"meta", "img", "br", "rect", "line"}
HEADINGS = ["Source", "Pipeline", "Mesh", "Result", "Picture", "Histogram", "Statistics", "Distribution", "Angles"]
FEWEST_BARS = 34  # 32 bins, beyond, inverted
SHARED_OF_TWO = ["Mesh", "Before and after", "Histograms before and after", "Statistics", "Distribution before",
                 "Distribution after", "Angles before", "Angles after"]  # fmt: skip


class Outline(HTMLParser):
    """By the headings of the sections: the texts, the places and colors of the bars, the pictures; all in order."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.sections: dict[str, list[str]] = {"": []}
        self.heading = ""
        self.pictures: list[str] = []
        self.bars = 0
        self.feed(text)
        assert not self.open, self.open
        assert not re.search(r'(src|href)="(?!data:)', text), "another file is needed"

    def handle_starttag(self, tag, attributes):
        if tag not in VOID:
            self.open.append(tag)
        if tag == "img":
            self.pictures.append(dict(attributes)["src"])
        if tag in ("img", "rect", "line", "text"):
            self.sections[self.heading].append(repr(attributes))
        self.bars += tag == "rect"

    def handle_endtag(self, tag):
        if tag not in VOID:
            assert self.open.pop() == tag, tag

    def handle_data(self, data):
        if not self.open or not data.strip():
            return
        if self.open[-1] == "h2":
            self.heading = data
            assert data not in self.sections, f"two sections {data}"
            self.sections[data] = []
        elif self.open[-1] != "style":
            self.sections[self.heading].append(data.strip())

    @property
    def headings(self) -> list[str]:
        return [heading for heading in self.sections if heading]


def check_pictures(outline, number):
    assert len(outline.pictures) == number, f"{len(outline.pictures)} pictures, {number} are expected"
    for picture in outline.pictures:
        kind, data = picture.split(",", 1)
        assert kind == "data:image/png;base64" and base64.b64decode(data).startswith(b"\x89PNG"), kind


def differences(saved, expected, headings):
    """The headings of the sections that are not the same; an absent one is not."""
    return [name for name in headings if saved.sections.get(name, "absent") != expected.sections.get(name)]


def compare(saved, mesh, untangled):
    import tautline as tl

    if not untangled:
        expected = Outline(tl.report(mesh, criteria="fem").html)
        assert saved.headings == expected.headings, (saved.headings, expected.headings)
        headings = [name for name in expected.headings if name != "Pipeline"]
        # The reader is not a step of the package.
        steps, of_package = saved.sections["Pipeline"], expected.sections["Pipeline"]
        assert steps[-len(of_package) :] == of_package and "Criteria: fem" in of_package, (steps, of_package)
        other = Outline(tl.report(mesh, criteria="fem", histogram_bins=31).html)
        assert differences(saved, other, headings) == ["Histogram", "Distribution"], "no difference is found"
    else:
        expected = Outline(tl.report(tl.untangle(mesh), before=mesh).html)
        assert [name for name in expected.headings if name in SHARED_OF_TWO] == SHARED_OF_TWO, expected.headings
        assert [name for name in saved.headings if name in SHARED_OF_TWO] == SHARED_OF_TWO, saved.headings
        assert set(expected.sections["Result"]) < set(saved.sections["Result"]), "the result of the filter is first"
        assert saved.sections["Source"] == ["File before", Path(mesh).name], saved.sections["Source"]
        assert saved.sections["Pipeline"][-2:] == ["Untangle Mesh", "default settings"], saved.sections["Pipeline"]
        assert len(saved.sections["History"]) > 1, "the history of the run"
        headings = SHARED_OF_TWO
        other = Outline(tl.report(mesh, before=mesh).html)
        assert "Statistics" in differences(saved, other, headings), "no difference is found"
    differ = differences(saved, expected, headings)
    for name in differ:
        print(name, saved.sections.get(name), expected.sections.get(name), sep="\n")
    assert not differ, differ
    check_pictures(saved, 2 if untangled else 1)


def check_complete(outline, text):
    check_pictures(outline, 1)
    assert [heading for heading in outline.headings if heading in HEADINGS] == HEADINGS, outline.headings
    assert "8140" in outline.sections["Mesh"] and "imr" in outline.sections["Statistics"]
    assert "8099 valid elements, 41 inverted" in text
    assert outline.bars >= FEWEST_BARS


def main() -> None:
    file, *rest = sys.argv[1:]
    text = Path(file).read_text(encoding="utf-8")
    outline = Outline(text)
    if not rest:
        check_complete(outline, text)
    elif rest == ["picture"]:
        check_pictures(outline, 2)
    else:
        compare(outline, rest[0], rest[1:] == ["untangled"])
    print(f"{len(text)} characters, {len(outline.headings)} sections, {outline.bars} bars")


main()
