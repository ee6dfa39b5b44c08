# SPDX-License-Identifier: BSD-3-Clause
"""Common parts of all studies: verdicts, findings of several seeds, results that are kept, and the committed
findings."""

import math
from argparse import Namespace

import numpy as np
import tautline as tl
from checks import OUT, points, run_tests
from tautline.studies import _evidence, _findings, _memory, _page, _report, _verdicts, all as all_studies
from tautline.studies._findings import Finding
from tautline.studies._verdicts import DOES_NOT_HOLD, HOLDS, NOT_DECIDED, VARIES, Open, Times

MOST_OPEN = 30  # findings of the committed report that are not decided, of some 600


def is_open(verdict) -> bool:
    return isinstance(verdict, Open)


def test_verdicts():
    """A tie, a missing number, an empty set, and times within their noise decide nothing."""
    assert _verdicts.all_of([True, np.bool_(True)]) is True and _verdicts.all_of([True, Open("x"), False]) is False
    assert _verdicts.any_of([False, True, Open("x")]) is True and _verdicts.any_of([False, False]) is False
    assert _verdicts.all_of([True, Open("why"), Open("then")]).reason == "why"
    assert all(map(is_open, (_verdicts.all_of([]), _verdicts.any_of([]), _verdicts.any_of([False, Open("x")]))))
    assert is_open(_verdicts.less(1.0, 1.0, 0.0)) and is_open(_verdicts.less(1.0, 1.001, 0.01))
    assert _verdicts.less(1.0, 2.0, 0.01) is True and _verdicts.less(2.0, 1.0, 0.01) is False
    for missing in (math.nan, math.inf):
        assert is_open(_verdicts.less(missing, missing, 0.1)) and is_open(_verdicts.gain(missing, 0.5))
        assert is_open(_verdicts.close(missing, 1.0, 0.1))
    assert _verdicts.gain(0.4, 0.5) and _verdicts.gain(0.7, 0.5) and not _verdicts.gain(0.2, 0.5)
    # For a large gain, the remainder decides: 2 times faster is not 33 times faster.
    assert not _verdicts.gain(0.5, 0.97) and not _verdicts.gain(0.9, 0.97) and _verdicts.gain(0.95, 0.97)
    assert _verdicts.gain(0.993, 0.97)
    assert _verdicts.same_count(10, 13) and not _verdicts.same_count(0, 1) and not _verdicts.same_count(3, 0)
    assert is_open(_verdicts.same_count(math.nan, 3))
    assert _verdicts.gain(-0.4, -0.5) and not _verdicts.gain(0.4, -0.5)
    one, two = Times((1.0, 1.1)), Times((1.08, 1.2))
    assert is_open(_verdicts.faster(one, two)) and _verdicts.faster(one, Times((2.0,))) is True
    assert _verdicts.faster(Times((1.0, 1.01, 9.0)), Times((1.1, 1.11, 9.0))) is True  # a disturbed run does not count
    assert _verdicts.is_not(False) is True and is_open(_verdicts.is_not(Open("x")))
    assert is_open(_verdicts.unless("failed", True)) and _verdicts.unless("", False) is False
    try:
        bool(Open("neither"))
    except TypeError:
        pass
    else:
        raise AssertionError("a verdict that is not decided has a truth value")


def seeded(*verdicts: str, reasons=None) -> Finding:
    """The finding of seeds with these verdicts."""
    made = [Finding("Table 1.1", "a claim", "", "", "n 1", word, reasons[i] if reasons else "", False, (i + 1,))
            for i, word in enumerate(verdicts)]
    [found] = _findings.merged(made, len(verdicts))
    assert found.seeds == tuple(range(1, len(verdicts) + 1))
    return found


def test_seeds():
    """The verdict of several seeds is by their share."""
    for verdicts, expected in (
        ([HOLDS] * 3, HOLDS), ([DOES_NOT_HOLD] * 2, DOES_NOT_HOLD), ([HOLDS, HOLDS, DOES_NOT_HOLD], VARIES),
        ([HOLDS, NOT_DECIDED, NOT_DECIDED], NOT_DECIDED), ([HOLDS, HOLDS, NOT_DECIDED], HOLDS),
        ([NOT_DECIDED] * 2, NOT_DECIDED),
    ):
        assert seeded(*verdicts).verdict == expected, verdicts
    assert "2 of 3" in seeded(HOLDS, HOLDS, DOES_NOT_HOLD).reason
    texts = ["12 left, 1,200 s", "7 left, 900 s", "8 left, 1,000 s"]
    assert _findings.spread(dict(enumerate(texts, 1))) == "8 [7 to 12] left, 1,000 [900 to 1,200] s"
    assert _findings.spread({1: "-1e-3 a, 3, b", 2: "2e-3 a, 3, b"}) == "[-1e-3 to 2e-3] a, 3, b"
    assert _findings.spread({1: "none", 3: "1 left"}) == "seed 1: none | seed 3: 1 left"
    # A seed without the finding does not decide it.
    made = [Finding("Table 1.1", "a claim", "", "", "1", HOLDS, "", False, (1,))]
    assert _findings.merged(made, 2)[0].verdict == NOT_DECIDED
    reason = seeded(NOT_DECIDED, DOES_NOT_HOLD, DOES_NOT_HOLD, reasons=["failed", "why", "why"]).reason
    assert "why" in reason and "failed" not in reason


def given(folder: str, **more) -> Namespace:
    return Namespace(out=OUT / folder, small=False, format=["csv", "tex"], **more)


def test_report():
    """A study with two seeds: the table has medians, the CSV file all rows, the record everything."""
    report = _report.Report("seeds", "Two seeds", given("study_seeds", seeds=2))
    for seed in report.seeds:
        report.table("numbers", "Numbers", ["name", "count"], [["a_b", 10 * seed], ["c", math.nan]])
        report.finding("Table 3.1", "the count is 10", 10 * seed == 10, f"{10 * seed}", stated="10", reason="random")
        report.finding("Table 3.1", "the count is positive", seed > 0, f"{seed}", own=True)
    assert report.finish() == 0
    rows = (report.out / "numbers.csv").read_text().split()
    assert rows == ["seed,name,count", "1,a_b,10", "1,c,", "2,a_b,20", "2,c,"]
    record = _evidence.read(report.out / "seeds.json")
    assert record["parts"] == [{"file": "numbers", "title": "Numbers  [numbers]", "headings": ["name", "count"],
                                "rows": [["a_b", "[10 to 20]"], ["c", "-"]]}]
    first, second = _evidence.findings(record)
    assert (first.verdict, first.stated, second.verdict, second.own) == (VARIES, "10", HOLDS, True)
    assert r"a\_b & [10 to 20] \\" in (report.out / "numbers.tex").read_text()


calls = []


@_memory.remembered
def moved(mesh, by: float, label: str = ""):
    calls.append(by)
    return {"mesh": tl.warp(mesh, np.zeros((mesh.GetNumberOfPoints(), 3)), method="femwarp").mesh, "by": by}


def test_memory():
    """A result is read if it was kept for equal arguments, and computed otherwise."""
    mesh, other = (tl.domain("rectangle", n) for n in (60, 90))
    folder = OUT / "study_memory"
    for file in folder.glob("*"):
        file.unlink()
    moved(mesh, 1.0)
    moved(mesh, 1.0)
    assert len(calls) == 2
    _memory.keep(folder)
    try:
        first = moved(mesh, 1.0)
        again = moved(mesh, 1.0)
        assert len(calls) == 3 and again["by"] == 1.0
        assert np.array_equal(points(first["mesh"]), points(again["mesh"]))
        assert again["mesh"].GetNumberOfCells() == mesh.GetNumberOfCells()
        for arguments in ((mesh, 2.0), (other, 1.0), (mesh, 1.0, "x")):
            moved(*arguments)
        assert len(calls) == 6
    finally:
        _memory.keep(None)


def test_chapters():
    for source, number in (("Tables 3.4, 3.5", 3), ("4.10.1", 4), ("2.7.3, wrench", 2), ("Figure 4.24", 4), ("-", 0),
                           ("4.9, 6", 4), ("6", 6), ("500,000 vertices", 0)):
        assert _page.chapter(source) == number, source


def test_committed():
    """The committed findings: each study is there, each verdict that is not "holds" has a reason, few are open."""
    records = {name: _evidence.committed(name) for name in all_studies.studies()}
    missing = [name for name, record in records.items() if record is None]
    assert missing == sorted(_evidence.PENDING), missing
    records = {name: record for name, record in records.items() if record}
    findings = {name: _evidence.findings(record) for name, record in records.items()}
    for name, found in findings.items():
        options = records[name]["options"]
        assert not options["small"], name
        for finding in found:
            assert finding.verdict in _verdicts.WORDS[:-1], (name, finding)
            assert finding.own or _page.chapter(finding.source), (name, finding.source)
            assert finding.reason or finding.verdict == HOLDS, f"{name}: no reason why {finding.claim!r} does not hold"
    for name, entries in _evidence.read(_evidence.FOLDER / f"{_evidence.REASONS}.json").items():
        stated = {(finding.claim, finding.verdict) for finding in findings[name]}
        stale = [entry["claim"] for entry in entries if (entry["claim"], entry["verdict"]) not in stated]
        assert not stale, f"{name}: reasons for what is not found: {stale}"
    still = [f"{name}: {finding.claim}" for name, found in findings.items() for finding in found
             if finding.verdict == NOT_DECIDED]
    assert len(still) <= MOST_OPEN, still


run_tests(globals())
