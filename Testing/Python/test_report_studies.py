# SPDX-License-Identifier: BSD-3-Clause
"""The studies figures, peridynamics_local, thread_scaling and rank_scaling, small, and the report of all studies."""

import base64
import contextlib
import csv
import io
import math
import re
import shutil
import subprocess
import sys
from html import escape
from pathlib import Path

import numpy as np
import tautline as tl
from checks import DATA, OUT, run_tests, wording
from study_checks import Studies, rejected_command
from tautline import __main__ as command_line
from tautline.studies import (
    _intersections,
    _inventory,
    _page,
    _report,
    _verdicts,
    figures,
    names,
    peridynamics_local,
    rank_scaling,
    thread_scaling,
    toy,
)

LARGEST_REPORT = 500_000  # characters of a file
studies = Studies(OUT / "studies_report")
PICTURES = ("figure_2_1", "figure_2_2", "figure_3_1", "figure_3_3", "figure_3_12", "figure_4_2", "figure_4_4",
            "figure_4_5", "figure_4_6", "figure_4_7", "figure_4_8", "figure_4_37_a", "figure_5_1", "figure_5_2",
            "figure_5_4", "figure_1_1", "figure_1_2", "figure_4_1", "figure_4_3", "figure_4_21", "figure_4_23")


def test_figures():
    studies.run("figures")
    studies.check("figures", 18, PICTURES, {}, printed())
    for row in studies.rows("figures", "findings"):
        # The text's smallest value of RR, 0.5, is not its formula's, and small sets have fewer shapes and elements.
        expected = "does not hold" if row["source"] == "2.4" else "holds"
        small = row["source"] in ("Figure 3.12", "Figure 5.2", "Figure 5.4")
        assert row["verdict"] == ("too small to decide" if small else expected), row


def printed():
    """The calls with the least value of RR that the text states, and the size of the dissertation's set."""
    made = []
    for function, arguments, named in studies.calls["figures"]:
        if function.__name__ == "contour_findings":
            arguments = ({**arguments[0], "rr": (0.5, *figures.APEX_2_1)}, *arguments[1:])
        if function.__name__ == "silhouette_findings":
            arguments = (*arguments[:-2], {str(i): 11 for i in range(9)}, True)
        made.append((function, arguments, named))
    return made


def test_intersections():
    """Areas against closed forms: a triangle inside, and a circular segment less."""
    found, exact = _intersections.areas("1")
    assert abs(found - exact) < 1e-12
    for case in ("2", "3"):
        pieces = _intersections.chord_polygons(case)
        ends = [p for piece in pieces for p in piece if abs(p @ p - 1) < 1e-12]
        angle = 2 * math.asin(0.5 * max(math.dist(p, q) for p in ends for q in ends))
        found, exact = _intersections.areas(case)
        assert abs(exact - found - 0.5 * (angle - math.sin(angle))) < 1e-5, case


def test_local():
    """The local condition number matches the five-point formula: cot^2(pi h / 2) at aspect ratio 1."""
    studies.run("peridynamics_local")
    tables = {"by_size": 5, "by_angle": 3, "times": 4}
    studies.check("peridynamics_local", 11, ("peridynamics_local",), tables, stated())
    local = studies.rows("peridynamics_local", "by_size")[0]
    for n in (10, 20):
        assert abs(float(local[str(n)]) * math.tan(math.pi / (2 * n)) ** 2 - 1) < 1e-4, local
    assert abs(peridynamics_local.sine(4) - math.sin(2 * math.atan(0.25))) < 1e-12


def stated():
    """The calls with numbers as the dissertation states them."""
    made = []
    for function, arguments, named in studies.calls["peridynamics_local"]:
        if function.__name__ == "findings":
            sizes = {n: n / 10 for n in (10, 20)}
            by_size = {m: {n: 10 * v**2 for n, v in sizes.items()} for m in arguments[0]}
            by_size["linear, p = 2.5"] = {n: 10 * v for n, v in sizes.items()}
            by_ratio = {m: {1: 10.0, 4: 10.5} for m in arguments[1]}
            by_ratio["linear, p = 2.5"] = {1: 10.0, 4: 15.0}
            by_ratio["local"] = {r: 40 / peridynamics_local.sine(r) for r in (1, 4)}
            arguments = (by_size, by_ratio)
        if function.__name__ == "local_findings":
            angles = {r: 40 / peridynamics_local.sine(r) for r in (1, 4, 16)}
            arguments = ({n: n**2 / 2 for n in (10, 20)}, angles)
        if function.__name__ == "horizon_findings":
            arguments = ({1: 20.0, 0.5: 30.0, 0.1: 39.0}, 40.0)
        made.append((function, arguments, named))
    return made


def test_threads():
    """Results are the same with 1 and 2 threads; other ones are seen, and a single number decides nothing."""
    studies.run("thread_scaling", "--threads", "2")
    studies.check("thread_scaling", 4, ("thread_scaling",), {"seconds": 4})
    _, (found,), _ = studies.calls["thread_scaling"][0]
    for results in found.values():
        assert list(results) == [1, 2] and thread_scaling.same(results) is True
        assert thread_scaling.same({**results, 3: np.nextafter(results[1], np.inf)}) is False
    assert isinstance(thread_scaling.same({1: np.zeros(3)}), _verdicts.Open)


def test_rank_scaling():
    """Two ranks reproduce the result of one; other numbers do not pass."""
    if not shutil.which("mpirun") or not shutil.which("pvbatch"):
        print("not run, without mpirun or pvbatch")
        return
    rejected_command("increasing numbers", "study", "rank_scaling", "--small", "--ranks", "2", "1")
    studies.run("rank_scaling", "--ranks", "1", "2")
    studies.check("rank_scaling", 3, ("rank_scaling",), {"seconds": 3})
    _, (found,), _ = studies.calls["rank_scaling"][0]
    for results in found.values():
        assert list(results) == [1, 2] and rank_scaling.same(results) is True
        assert rank_scaling.same({**results, 3: results[1] * (1 + 10 * rank_scaling.ROUNDING)}) is False
        assert rank_scaling.same({**results, 3: results[1][1:]}) is False
    assert isinstance(rank_scaling.same({1: np.zeros(3)}), _verdicts.Open)


def test_contours():
    """The best position makes the triangle equilateral, whichever side of the base it is on."""
    field = tl.metric_field(("imr",), vertices=figures.BASE_2_1, bounds=(-2, 0, -0.5, 1.5), dimensions=(81, 81))
    value, x, y = figures.best_position(field, (-2, 0, -0.5, 1.5), "imr")
    assert abs(value - 1) < 1e-3 and abs(x - math.sqrt(3) / 2) < 0.03 and abs(y - 0.5) < 0.03


def test_references():
    """The tables and figures that sources of findings name."""
    for text, expected in (
        ("Table 2.8, wrench", {"Table 2.8"}), ("Figures 2.2, 3.3", {"Figure 2.2", "Figure 3.3"}),
        ("Tables 2.9 and 2.12, Figure 4.7 (a)", {"Table 2.9", "Table 2.12", "Figure 4.7"}),
        ("Figures 4.24 to 4.26", {"Figure 4.24", "Figure 4.25", "Figure 4.26"}), ("2.7.3", set()),
    ):
        assert _page.references(text) == expected, text
    assert all(entry.study in names() for entry in _inventory.ENTRIES)
    assert len({entry.name for entry in _inventory.ENTRIES}) == len(_inventory.ENTRIES)


def run_report(folder: Path, *options: str) -> tuple[int, str]:
    """The exit code of `study all` and its report."""
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        code = command_line.main(["study", "all", "--small", "--out", str(folder), *options])
    return code, (folder / "report.html").read_text(encoding="utf-8")


def test_report():
    """The report of two studies: findings, tables, pictures, links; a study that fails is part of it."""
    code, page = run_report(OUT / "all", "--studies", "toy", "peridynamics_local")
    assert code == 0
    for study in ("toy", "peridynamics_local"):
        folder = OUT / "all" / study
        found = studies_in(folder)
        assert found and all(escape(sentence) in page for sentence in found), study
        drawn = len(list((OUT / "all").glob("*/*.png")))
        assert page.count("data:image/png") == drawn and (drawn > 0 or not _report.pyplot), drawn
    assert wording("condition-number-by-1-h") in page
    targets = set(re.findall(r" id='([^']+)'", page))
    links = set(re.findall(r"href='#([^']+)'", page))
    assert {"figure-3-2"} <= targets and {link for link in links if link not in targets} <= {
        _page._anchor(entry.name) for entry in _inventory.ENTRIES if entry.study not in ("toy", "peridynamics_local")}
    for picture in re.findall(r"base64,([^']+)'", page):
        assert base64.b64decode(picture).startswith(b"\x89PNG")

    before = toy.main
    toy.main = broken
    try:
        code, page = run_report(OUT / "all", "--studies", "toy")
        assert code == 1 and wording("the-reason-lt-why-gt") in page
    finally:
        toy.main = before
    # The study ended, so that it is not run again.
    before = peridynamics_local.main
    peridynamics_local.main = broken
    try:
        code, page = run_report(OUT / "all", "--studies", "peridynamics_local", "--resume")
        assert code == 0 and "peridynamics_local" in page
    finally:
        peridynamics_local.main = before
    rejected_command("there is no study 'nothing'", "study", "all", "--studies", "nothing", "--out", str(OUT / "none"))


def broken(_):
    raise tl.Error("the reason <why>")


def studies_in(folder: Path) -> list[str]:
    """The sentences of the findings of a study that ran."""
    with open(folder / "findings.csv", encoding="utf-8", newline="") as stream:
        return [row["claim"] for row in csv.DictReader(stream)]


def test_documentation():
    """The committed report and its summary are what the committed findings give, and its files are small."""
    folder = DATA.parent / "Plugin" / "Documentation"
    program = [sys.executable, str(folder / "make_studies.py")]
    made = subprocess.run(program, capture_output=True, text=True, check=False)
    assert made.returncode == 0, made.stdout + made.stderr
    page, more = ((folder / name).read_text(encoding="utf-8") for name in ("studies.html", "studies_more.html"))
    assert max(len(page), len(more)) < LARGEST_REPORT and all(f">{entry.name}<" in page for entry in _inventory.ENTRIES)
    assert all(f"name='{name}'" in more for name in re.findall(r"href='studies_more.html#([^']+)'", page))


run_tests(globals())
