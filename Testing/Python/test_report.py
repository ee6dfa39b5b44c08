# SPDX-License-Identifier: BSD-3-Clause
"""The function and the command report: the numbers, what the file has, and that it needs no other file."""

import base64
import pickle
import re
from html.parser import HTMLParser
from pathlib import Path

import tautline as tl
from checks import DATA, OUT, rejected, run_tests, shell, wording

VOID = {"meta", "img", "br", "rect", "line"}


class Outline(HTMLParser):
    """The elements that are open, the headings, and rows by their first cell."""

    def __init__(self, text):
        super().__init__()
        self.open, self.headings, self.rows = [], [], {}
        self.row = None
        self.feed(text)
        assert not self.open, self.open

    def handle_starttag(self, tag, attributes):
        if tag not in VOID:
            self.open.append(tag)
        self.row = [] if tag == "tr" else self.row

    def handle_endtag(self, tag):
        assert tag in VOID or self.open.pop() == tag, tag
        if tag == "tr" and self.row:
            self.rows[self.row[0]] = self.row[1:]

    def handle_data(self, data):
        if self.open and self.open[-1] == "h2":
            self.headings.append(data)
        if self.open and self.open[-1] in ("td", "th"):
            self.row.append(data)


def pictures(html):
    assert not re.search(r'(src|href)="(?!data:)', html), "another file is needed"
    found = [base64.b64decode(data) for data in re.findall(r'base64,([^"]+)"', html)]
    assert all(picture.startswith(b"\x89PNG") for picture in found)
    return found


def test_one():
    mesh = DATA / "bracket-tangled.vtu"
    file = OUT / "report-one.html"
    html = tl.report(mesh, file, metrics=["imr", "scaled_jacobian"], criteria="fem")
    for shown in (repr(html), str(html), html._repr_html_()):
        assert len(shown) < 2000 and str(file) in shown and "8099 valid elements" in shown, shown
    assert html.file == str(file) and html.html == html and html.quality.verdict == "failed" and html.before is None
    assert pickle.loads(pickle.dumps(html)).title == html.title
    html.save(OUT / "report-saved.html")
    assert (OUT / "report-saved.html").read_text() == file.read_text()
    assert file.read_text(encoding="utf-8") == html
    outline = Outline(html)
    expected = ["Source", "Pipeline", "Mesh", "Result", "Picture", "Histogram", "Statistics", "Distribution", "Angles",
                "Criteria"]  # fmt: skip
    assert outline.headings == expected, outline.headings
    result = tl.quality(mesh, ["imr", "scaled_jacobian"], criteria="fem")
    assert outline.rows["File"] == [mesh.name]
    assert outline.rows["Cells"] == ["8140"] and outline.rows["x"] == ["0 to 60"]
    assert outline.rows["Element Quality"] == ["Metrics: Inverse mean ratio, Scaled Jacobian\nCriteria: fem"]
    assert outline.rows["Mean"] == [f"{one['mean']:.6g}" for one in result.statistics.values()]
    assert result.summary.splitlines()[1] in html, "the summary"
    assert len(pictures(html)) == 1 and html.count("<svg") == len(result.statistics)
    inverted = re.findall(r"inverted: (\d+) elements", html)
    assert inverted == [str(result.inverted)] * len(result.statistics)
    # Both axes, and the limits of the criteria.
    fail = tl.criteria("fem")["criteria"][0]["limits"]["all"]["fail"]
    for label in ("Inverse mean ratio", "1.5", "2.5", "10", "1000", f"fail {fail:g}"):
        assert f">{label}</text>" in html, label


def test_settings():
    mesh = DATA / "plate.vtu"
    assert Outline(tl.report(mesh)).rows["Element Quality"] == ["default settings"]
    html = tl.report(mesh, metrics="imr", histogram_bins=8, time_limit=20.0, threads=1)
    expected = "Histogram Bins: 8\nTime Limit: 20\nThreads: 1"
    assert Outline(html).rows["Element Quality"] == [expected], Outline(html).rows
    # Without a file there is no source.
    assert "Source" not in Outline(tl.report(tl.untangle(mesh).mesh)).headings


def test_before():
    before = DATA / "bracket-tangled.vtu"
    after = tl.untangle(before)
    html = tl.report(after, before=before, title="a & b")
    outline = Outline(html)
    assert wording("title-a-amp-b-title") in html
    assert wording("before-and-after") in outline.headings and "Histograms before and after" in outline.headings
    assert outline.rows["File before"] == [before.name] and "File" not in outline.rows
    measured = [tl.quality(mesh).statistics["imr"] for mesh in (before, after)]
    assert outline.rows["Worst"] == [f"{statistics['worst']:.6g}" for statistics in measured]
    assert outline.rows["Inverted"] == ["41", "0"] and outline.rows["Cells"] == ["8140", "8140"]
    change = tl.compare(before, after).statistics["imr"]
    assert outline.rows["imr"][:3] == [str(change[key]) for key in ("better", "worse", "equal")], outline.rows["imr"]
    first, second = pictures(html)
    assert first != second
    # With other cells only the statistics are compared.
    html = tl.report(DATA / "plate.vtu", before=before)
    assert wording("the-meshes-have-different-cells") in html and len(pictures(html)) == 2


def test_shell():
    plate, file = DATA / "plate.vtu", OUT / "report-shell.html"
    assert shell("report", plate, "--out", file, "--criteria", "ansys").strip() == str(file)
    assert "Criteria" in Outline(file.read_text(encoding="utf-8")).headings
    file = OUT / "report-quality.html"
    assert shell("quality", plate, "--report", file, "--criteria", "fem", code=3).rstrip().endswith(str(file))
    assert Outline(file.read_text(encoding="utf-8")).rows["Element Quality"] == ["Criteria: fem"]
    absent = OUT / "no-such-folder" / "report.html"
    assert "no-such-folder" in shell("report", plate, "--out", absent, code=1)
    assert "no-such-folder" in shell("quality", plate, "--report", absent, code=1)


def test_errors():
    rejected(wording("no-metric"), tl.report, DATA / "plate.vtu", metrics="no such")
    for mesh in (DATA / "plate.vtu", OUT / "no-such-mesh.vtu"):  # the name is checked first
        rejected(wording("cannot-be-written"), tl.report, mesh, Path("/no-such-folder/report.html"))


run_tests(globals())
