"""The studies of mesh optimization in small: their tables, findings and pictures, and what the numbers say."""

import contextlib
import csv
import io
import math
import os
import shutil
from importlib import import_module
from pathlib import Path

import numpy as np
from tautline import __main__ as command_line
from tautline import studies
from tautline.studies import _common

OUT = Path(os.environ["TAUTLINE_TEST_DIR"]) / "studies_optimization"
MULTI = ("exponential-sum", "objective-product", "equal-sum")

# Per study: findings, pictures, and rows of its tables.
STUDIES = {
    "toy": (6, ("meshes",), {"toy": 5, "sensitivity": 8}),
    "shape_size": (10, ("average", "worst", "average_newton"),
                   {"times": 5, "times_newton": 5, "two_digits": 10, "quality_disk3d": 11, "quality_disk2d": 6,
                    "quality_barrier2d": 6, "quality_barrier3d": 6, "curves": 210}),
    "shape_interpolation": (8, ("average", "worst", "average_newton"),
                            {"times": 5, "times_newton": 5, "two_digits": 10, "quality_disk3d": 11, "curves": 210}),
    "shape_untangling": (14, ("meshes", "quality"),
                         {"table_3_4": 5, "table_3_4_newton": 5, "table_3_5": 6, "quality_barrier2d": 6,
                          "quality_disk3d": 7, "curves_disk3d": 105}),
    "shape_size_untangling": (6, ("average",), {"table_3_6": 6, "table_3_6_newton": 6, "quality": 7, "units": 12}),
    "hydrocephalus": (8, ("domain", "close_up", "inverted"),
                      {"inverted": 5, "inverted_newton": 5, "quality": 6, "units": 12}),
    "bore": (5, ("inverted",), {"inverted": 5, "inverted_newton": 5, "quality": 6, "units": 12}),
    "smoothing_times": (8, ("angles",),
                        {"table_2_6": 2, "table_2_6_newton": 2, "table_2_7_wrench": 5, "table_2_7_hinge": 5,
                         "boundary": 8, "iterations_wrench": 4, "iterations_hinge": 4}),
}


def rows_of(study, table):
    with open(OUT / study / f"{table}.csv", encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def column(study, table, head, name):
    """A column of numbers by the row's label."""
    return {row[head]: float(row[name]) for row in rows_of(study, table)}


def check_files(study, findings, pictures, tables):
    folder = OUT / study
    for table, count in tables.items():
        rows = rows_of(study, table)
        assert len(rows) == count, f"{study}/{table}: {len(rows)} rows, not {count}"
    for file in folder.glob("*.csv"):
        for row in rows_of(study, file.stem):
            for name, value in row.items():
                with contextlib.suppress(ValueError):
                    assert math.isfinite(float(value)), f"{file.name}: {name} is {value}"
    said = rows_of(study, "findings")
    assert len(said) == findings, f"{study}: {len(said)} findings, not {findings}"
    assert {row["holds"] for row in said} <= {"yes", "no"} and all(row["figures"] and row["finding"] for row in said)
    text = (folder / f"{study}.txt").read_text(encoding="utf-8")
    holding = sum(row["holds"] == "yes" for row in said)
    assert f"{holding} of {findings} hold" in text
    assert text.count("HOLDS (") == holding and text.count("DOES NOT HOLD (") == findings - holding
    if _common.pyplot:
        for picture in pictures:
            assert (folder / f"{picture}.png").stat().st_size > 5000, f"{study}/{picture}.png is empty"


def run_all():
    for study, expected in STUDIES.items():
        with contextlib.redirect_stdout(io.StringIO()) as said:
            assert command_line.main(["study", study, "--small", "--out", str(OUT / study)]) == 0
        assert "Findings of the dissertation" in said.getvalue()
        check_files(study, *expected)


def check_list():
    assert set(STUDIES) <= set(studies.names())
    with contextlib.redirect_stdout(io.StringIO()) as said:
        assert command_line.main(["study", "list"]) == 0
    assert all(name in said.getvalue() and import_module(f"tautline.studies.{name}").__doc__ for name in STUDIES)
    with contextlib.redirect_stderr(io.StringIO()) as said:
        assert command_line.main(["study", "nonsense"]) == 1
    assert "there is no study 'nonsense'" in said.getvalue()


def check_toy():
    for name in MULTI:
        inverted = [int(float(r["inverted"])) for r in rows_of("toy", "curves") if r["method"] == name]
        assert inverted[0] == 2 and inverted[1] == inverted[-1] == 0, f"{name}: {inverted}"
    worst = {r["method"]: float(r["worst SI end"]) for r in rows_of("toy", "toy")}
    assert abs(worst["Exponential sum (SI and untangling)"] - 0.125) < 1e-3, "right triangles again"


def check_smoothing():
    for study, second in (("shape_size", "size_rms"), ("shape_interpolation", "ss_mean")):
        for domain in ("disk3d", "disk2d", "barrier2d", "barrier3d"):
            shape, other = (column(study, f"quality_{domain}", "method", q) for q in ("imr_mean", second))
            for name in MULTI:
                assert shape[name] < shape["start"] and other[name] < other["start"], f"{study} {domain} {name}"
            assert shape["imr"] == min(shape.values()), f"{study} {domain}: shape alone has the best shape"
    start = column("shape_size", "quality_disk3d", "method", "size_rms")["start"]
    assert abs(start - 0.98) < 1e-9, "the unit of length"
    start = column("shape_interpolation", "quality_disk3d", "method", "ss_mean")["start"]
    assert abs(start - 1.9) < 1e-9, "the unit of length"
    curves = [r for r in rows_of("shape_size", "curves") if (r["method"], r["optimizer"]) == ("imr", "nlcg")]
    objective = [float(r["objective"]) for r in curves]
    assert all(b <= a for a, b in zip(objective, objective[1:])), "the objective falls"
    seconds = [float(r["cpu_seconds"]) for r in curves]
    assert all(b >= a for a, b in zip(seconds, seconds[1:])) and seconds[-1] > 0, "time goes on"
    # Row k is the mesh after iteration k: the first sweep shows in row 1.
    assert float(curves[0]["imr_mean"]) > float(curves[1]["imr_mean"]) > float(curves[-1]["imr_mean"])


def check_untangling():
    for table in ("table_3_4", "table_3_5"):
        last = list(rows_of("shape_untangling", table)[0])[5]
        left = column("shape_untangling", table, "method", last)
        assert all(n == 0 for method, n in left.items() if "and untangling" in method), f"{table}: {left}"
    start, end = (column("shape_untangling", "table_3_5", "method", i) for i in ("0", "5"))
    assert start["Simultaneous untangling and smoothing"] > 0 == end["Simultaneous untangling and smoothing"]
    theirs = column("shape_untangling", "table_3_5", "method", "1 dissertation")
    assert theirs["SI single objective"] == 1392 and theirs["Equal sum (SI and untangling)"] == 2
    left = column("shape_size_untangling", "table_3_6", "method", "10")
    assert all(n == 0 for method, n in left.items() if "and untangling" in method), left
    for study in ("hydrocephalus", "bore"):
        start = column(study, "inverted", "method", "0")
        assert set(start.values()) == {5.0}, f"{study}: the warp inverts as many elements as asked for: {start}"
        assert "5 inverted before, 0 after" in (OUT / study / f"{study}.txt").read_text(encoding="utf-8")


def check_angles():
    for domain in ("wrench", "hinge"):
        rows = {r["metric"]: [float(r[b]) for b in ("< 20", "20 - 40", "40 - 80", "80 - 100", "> 100")]
                for r in rows_of("smoothing_times", f"table_2_7_{domain}")}
        assert all(abs(sum(shares) - 100) < 1e-9 for shares in rows.values())
        assert all(rows[metric][2] > rows["initial"][2] + 10 for metric in ("imr", "rr", "si", "ss")), rows
        # In the plane SI is 1 / (4 sqrt(3) IMR), so that both have the same best mesh.
        assert np.allclose(rows["imr"], rows["si"], atol=0.5)
    assert float(rows_of("smoothing_times", "table_2_6")[0]["IMR dissertation"]) == 55


if __name__ == "__main__":
    shutil.rmtree(OUT, ignore_errors=True)
    check_list()
    run_all()
    check_toy()
    check_smoothing()
    check_untangling()
    check_angles()
    print("pictures" if _common.pyplot else "no pictures: matplotlib is missing")
