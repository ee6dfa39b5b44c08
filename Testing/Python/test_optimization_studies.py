# SPDX-License-Identifier: BSD-3-Clause
"""The studies of mesh optimization in the small size: their tables, findings, pictures and numbers."""

from importlib import import_module

import numpy as np
from checks import OUT, shell, wording
from study_checks import Studies, pictures, refused_command
from tautline.studies import _verdicts, names, smoothing_times
from wrong_data import verdicts

studies = Studies(OUT / "studies_optimization")
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


def run_all():
    for study, expected in STUDIES.items():
        assert wording("findings-of-the-dissertation") in studies.run(study)
        theirs = dissertation(studies.calls[study]) if study == "smoothing_times" else ()
        studies.check(study, *expected, theirs)
    found = verdicts(theirs, studies.directory / "dissertation")
    assert all(v == "holds" for (source, _), v in found.items() if source.startswith("Table 2.6")), found


def dissertation(calls):
    """The calls of the findings of smoothing_times with the times that the dissertation printed."""
    times = {(domain, metric): _verdicts.Times((float(seconds),))
             for domain, row in smoothing_times.TABLE_2_6.items()
             for metric, seconds in zip(smoothing_times.METRICS, row)}
    return [(function, (times, *others), named) for function, (_, *others), named in calls]


def check_list():
    assert set(STUDIES) <= set(names())
    listed = shell("study", "list")
    assert all(name in listed and import_module(f"tautline.studies.{name}").__doc__ for name in STUDIES)
    refused_command("there is no study 'nonsense'", "study", "nonsense", code=2)


def check_toy():
    for name in MULTI:
        inverted = [int(float(r["inverted"])) for r in studies.rows("toy", "curves") if r["method"] == name]
        assert inverted[0] == 2 and inverted[1] == inverted[-1] == 0, f"{name}: {inverted}"
    worst = {r["method"]: float(r["worst SI end"]) for r in studies.rows("toy", "toy")}
    assert abs(worst["Exponential sum (SI and untangling)"] - 0.125) < 1e-3, "right triangles again"


def check_smoothing():
    for study, second in (("shape_size", "size_rms"), ("shape_interpolation", "ss_mean")):
        for domain in ("disk3d", "disk2d", "barrier2d", "barrier3d"):
            shape, other = (studies.column(study, f"quality_{domain}", "method", q) for q in ("imr_mean", second))
            for name in MULTI:
                assert shape[name] < shape["start"] and other[name] < other["start"], f"{study} {domain} {name}"
            assert shape["imr"] == min(shape.values()), f"{study} {domain}: shape alone has the best shape"
    start = studies.column("shape_size", "quality_disk3d", "method", "size_rms")["start"]
    assert abs(start - 0.98) < 1e-9, "the unit of length"
    start = studies.column("shape_interpolation", "quality_disk3d", "method", "ss_mean")["start"]
    assert abs(start - 1.9) < 1e-9, "the unit of length"
    curves = [r for r in studies.rows("shape_size", "curves") if (r["method"], r["optimizer"]) == ("imr", "nlcg")]
    objective = [float(r["objective"]) for r in curves]
    assert all(b <= a for a, b in zip(objective, objective[1:])), "the objective falls"
    seconds = [float(r["cpu_seconds"]) for r in curves]
    assert all(b >= a for a, b in zip(seconds, seconds[1:])) and seconds[-1] > 0, "time goes on"
    # Row k is the mesh after iteration k: the first sweep shows in row 1.
    assert float(curves[0]["imr_mean"]) > float(curves[1]["imr_mean"]) > float(curves[-1]["imr_mean"])


def check_untangling():
    for table in ("table_3_4", "table_3_5"):
        last = list(studies.rows("shape_untangling", table)[0])[5]
        left = studies.column("shape_untangling", table, "method", last)
        assert all(n == 0 for method, n in left.items() if "and untangling" in method), f"{table}: {left}"
    start, end = (studies.column("shape_untangling", "table_3_5", "method", i) for i in ("0", "5"))
    assert start["Simultaneous untangling and smoothing"] > 0 == end["Simultaneous untangling and smoothing"]
    theirs = studies.column("shape_untangling", "table_3_5", "method", "1 dissertation")
    assert theirs["SI single objective"] == 1392 and theirs["Equal sum (SI and untangling)"] == 2
    left = studies.column("shape_size_untangling", "table_3_6", "method", "10")
    assert all(n == 0 for method, n in left.items() if "and untangling" in method), left
    for study in ("hydrocephalus", "bore"):
        start = studies.column(study, "inverted", "method", "0")
        assert set(start.values()) == {5.0}, f"{study}: the warp inverts the requested number of elements: {start}"
        assert wording("5-inverted-before") in (studies.directory / study / f"{study}.txt").read_text(encoding="utf-8")


def check_angles():
    for domain in ("wrench", "hinge"):
        rows = {r["metric"]: [float(r[b]) for b in ("< 20", "20 - 40", "40 - 80", "80 - 100", "> 100")]
                for r in studies.rows("smoothing_times", f"table_2_7_{domain}")}
        assert all(abs(sum(shares) - 100) < 1e-9 for shares in rows.values())
        assert all(rows[metric][2] > rows["initial"][2] + 10 for metric in ("imr", "rr", "si", "ss")), rows
        # In the plane SI is 1 / (4 sqrt(3) IMR), so that both have the same best mesh.
        assert np.allclose(rows["imr"], rows["si"], atol=0.5)
    assert float(studies.rows("smoothing_times", "table_2_6")[0]["IMR dissertation"]) == 55


if __name__ == "__main__":
    check_list()
    run_all()
    check_toy()
    check_smoothing()
    check_untangling()
    check_angles()
    print(pictures())
