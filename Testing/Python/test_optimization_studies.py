# SPDX-License-Identifier: BSD-3-Clause
"""The studies of mesh optimization in the small size: their tables, findings, pictures and numbers."""

from importlib import import_module

import numpy as np
import tautline
from checks import OUT, shell, wording
from study_checks import Studies, pictures, rejected_command
from tautline.studies import _common, _literal, _tangled, _verdicts, names, smoothing_times, toy
from wrong_data import verdicts

studies = Studies(OUT / "studies_optimization")
MULTI = ("exponential-sum", "objective-product", "equal-sum")

# Per study: findings, pictures, and rows of its tables.
STUDIES = {
    "toy": (6, ("meshes",), {"toy": 5, "sensitivity": 16, "sensitivity_counts": 2}),
    "shape_size": (13, ("average", "worst", "average_newton"),
                   {"times": 5, "times_newton": 5, "two_digits": 10, "quality_disk3d": 11, "quality_disk2d": 6,
                    "quality_barrier2d": 6, "quality_barrier3d": 6, "curves": 210}),
    "shape_interpolation": (13, ("average", "worst", "average_newton"),
                            {"times": 5, "times_newton": 5, "two_digits": 10, "quality_disk3d": 11, "curves": 210}),
    "shape_untangling": (20, ("meshes", "quality"),
                         {"table_3_4": 5, "table_3_4_newton": 5, "table_3_5": 6, "quality_barrier2d": 6,
                          "quality_disk3d": 7, "settings": 7, "literal": 4}),
    "shape_size_untangling": (10, ("average",), {"table_3_6": 6, "table_3_6_newton": 6, "quality": 7, "settings": 7}),
    "hydrocephalus": (9, ("domain", "close_up", "inverted"),
                      {"inverted": 5, "inverted_newton": 5, "quality": 6, "settings": 14, "literal": 2}),
    "bore": (5, ("inverted",), {"inverted": 5, "inverted_newton": 5, "quality": 6, "settings": 10}),
    "pareto": (8, ("pareto",), {"front": 15}),
    "formulations": (3, (), {"inverses": 12, "versions": 8}),
    "smoothing_times": (16, ("angles",),
                        {"meshes": 2, "shares_wrench": 28, "table_2_6": 2, "table_2_6_newton": 2, "table_2_7_wrench": 5,
                         "table_2_7_hinge": 5, "boundary": 8, "iterations_wrench": 4, "iterations_hinge": 4}),
}


def run_all():
    for study, expected in STUDIES.items():
        studies.run(study)
        theirs = (dissertation if study == "smoothing_times" else other_numbers)(studies.calls[study])
        studies.check(study, *expected, theirs)
    found = verdicts(theirs, studies.directory / "dissertation")
    assert all(v == "holds" for (source, _), v in found.items() if source.startswith("Table 2.6")), found


def dissertation(calls):
    """The calls of the findings of smoothing_times with the times that the dissertation printed."""
    times = {(domain, metric): _verdicts.Times((float(seconds),))
             for domain, row in smoothing_times.TABLE_2_6.items()
             for metric, seconds in zip(smoothing_times.METRICS, row)}
    return [(function, (times, *others), named) for function, (_, *others), named in calls
            if function.__name__ == "findings"]


def other_numbers(calls):
    """The calls with the printed iterations of Table 3.7 as the only setting, and with results that are dominated."""
    def other(value):
        if not isinstance(value, dict) or not all(isinstance(part, dict) for part in value.values()):
            return value
        first = next(iter(value.values()))
        if all(isinstance(part, float) for part in first.values()):
            return {key: dict.fromkeys(part, 1.0) for key, part in value.items()}
        if not all(isinstance(part, _common.Run) for part in first.values()) or "untangle" not in first:
            return value
        done = {"untangle": 33, "exponential-sum": 9, "equal-sum": 12}
        return {"printed": {name: made_run(name, [5] * done.get(name, 41) + [0] * (41 - done.get(name, 41)))
                            for name in first}}

    return [(function, tuple(map(other, arguments)), named) for function, arguments, named in calls]


def check_list():
    assert set(STUDIES) <= set(names())
    listed = shell("study", "list")
    assert all(name in listed and import_module(f"tautline.studies.{name}").__doc__ for name in STUDIES)
    rejected_command("there is no study 'nonsense'", "study", "nonsense", code=2)


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


def made_run(name, inverted, failure="", reason="The limit of iterations is reached."):
    """A run with these numbers of inverted elements."""
    values = {"inverted": np.array(inverted, float), "si_mean": np.full(len(inverted), 0.1)}
    method = _common.Method(name, name, ("si",))
    steps = np.arange(len(inverted))
    return _common.Run(method, "nlcg", steps, 1.0 * steps, values, None, failure or reason, failure=failure)


def check_failed_runs():
    """A failed run has no numbers after its end and decides nothing, nor does the only method that is left."""
    stuck = made_run("objective-product", [5, 2], "No step reduces the objective.")
    done = made_run("exponential-sum", [5, 1, 0], reason="Converged: the objective hardly changes anymore.")
    limit = made_run("equal-sum", [5, 1, 0])
    assert np.isnan(stuck.at("inverted", 9)) and np.isnan(stuck.last("inverted")) and stuck.at("inverted", 1) == 2
    assert done.at("inverted", 9) == 0 and np.isnan(limit.at("inverted", 9)), "only a converged run goes on as it ends"
    runs = {r.method.name: r for r in (stuck, done, limit)}
    assert _tangled.untangles(runs, ["exponential-sum"]) is True
    for verdict in (_tangled.untangles(runs, ["objective-product"]), _tangled.fails(runs, ["objective-product"]),
                    _tangled.sooner(runs, "exponential-sum", "objective-product"),
                    _common.time_judged(runs, runs, True)):
        assert isinstance(verdict, _verdicts.Open) and "failed: No step" in verdict.reason
    diverged = {"si": made_run("si", [5, 7], "Diverged: vertices left the domain in iteration 1.")}
    assert _tangled.fails(diverged, ["si"]) is True, "a method whose objective has no minimum fails"
    assert _tangled.untangles(diverged, ["si"]) is False
    # A survivor only, and a tie.
    left = {"exponential-sum": done, "equal-sum": made_run("equal-sum", [5, 1, 1])}
    assert isinstance(_tangled.better(left, "exponential-sum", left, "si_mean", 0.01), _verdicts.Open)
    assert _tangled.sooner(runs, "exponential-sum", "equal-sum") is False, "equal numbers are not fewer"
    never = {n: made_run(n, [5, 1, 1]) for n in ("exponential-sum", "equal-sum")}
    assert isinstance(_tangled.sooner(never, "exponential-sum", "equal-sum"), _verdicts.Open), "never twice"
    mixed = {"a": {"si": limit}, "b": {"si": made_run("si", [5, 1, 1])}}
    assert isinstance(_tangled.in_settings(mixed, lambda r: _tangled.untangles(r, ["si"])), _verdicts.Mixed)
    # Settings in which a run failed decide nothing, however many hold.
    survivors = {"a": {"si": done}, "b": {"si": done}, "c": {"si": stuck}}
    assert type(_tangled.in_settings(survivors, lambda r: _tangled.untangles(r, ["si"]))) is _verdicts.Open
    assert isinstance(_tangled.in_settings({"a": {"si": stuck}}, lambda r: _tangled.untangles(r, ["si"])),
                      _verdicts.Open)
    # A sweep less takes less time: no verdict.
    uneven = {"one": limit, "other": made_run("other", [5, 1, 1, 0])}
    assert isinstance(_common.time_judged(uneven, uneven, True), _verdicts.Open)


def check_error():
    """An error of the optimizer ends a run, which then failed."""
    mesh = toy.structured(1.0, toy.SHIFT)
    run = _tangled.untangle(mesh, _common.Method("nonsense", "nonsense", ("imr",)), 3, ("si_mean",), threads=1,
                            optimizer="newton", reduction=2.0)
    assert run.failure and len(run.iterations) == 1 and np.isnan(run.last("inverted")), run.reason


def check_literal():
    """The gradients of the printed objectives are right, and untangling removes the inverted elements of the toy."""
    mesh = toy.structured(1.0, toy.SHIFT)
    random = np.random.default_rng(1)
    patch = _literal._Patch(*random.uniform(size=(2, 6, 2)), 0.3)
    x, h = random.uniform(size=2), 1e-6
    _, gradients = patch.sums(x)
    for k, step in enumerate(h * np.eye(2)):
        slopes = (patch.sums(x + step)[0] - patch.sums(x - step)[0]) / (2 * h)
        assert np.allclose(slopes, gradients[:, k], rtol=1e-4), (slopes, gradients)
    for name in MULTI:
        sums = np.array([3.0, 2.0])
        _, weights = _literal._combined(sums, name, 5.0)
        slopes = [(_literal._combined(sums + step, name, 5.0)[0] - _literal._combined(sums - step, name, 5.0)[0]) / 2e-6
                  for step in 1e-6 * np.eye(2)]
        assert np.allclose(slopes, weights, rtol=1e-6), name
    edge = toy.SQUARES
    points = np.array([mesh.GetPoint(i) for i in range(mesh.GetNumberOfPoints())])
    fixed = np.isin(points[:, 0], (0, edge)) | np.isin(points[:, 1], (0, edge))
    assert _literal.literal(mesh, fixed, "untangle", 2, 5, 0.005, 1e6)[-1] == 0
    assert _literal.literal(mesh, fixed, "si", 2, 5, 0.005, 1e6)[-1] > 0, "as printed, SI alone does not untangle"


def check_own_mesh():
    """Two metrics on a user's mesh: tables without the dissertation's numbers, and no findings."""
    file = OUT / "own_mesh.vtu"
    tautline.write(tautline.perturb(tautline.domain("disk2d", 400)).mesh, str(file))
    studies.run("shape_size", "--mesh", str(file), "--metrics", "imr", "rr", "--iterations", "3", "--out",
                str(studies.directory / "own"))
    quality = studies.column("own", "quality", "method", "imr_mean")
    assert len(quality) == 6 and all(v < quality["start"] for m, v in quality.items() if m != "start"), quality
    assert not studies.rows("own", "findings")
    rejected_command("--metrics needs --mesh", "study", "shape_size", "--small", "--metrics", "imr", "rr")


def check_angles():
    for domain in ("wrench", "hinge"):
        rows = {r["metric"]: [float(r[b]) for b in ("< 20", "20 - 40", "40 - 80", "80 - 100", "> 100")]
                for r in studies.rows("smoothing_times", f"table_2_7_{domain}")}
        assert all(abs(sum(shares) - 100) < 1e-9 for shares in rows.values())
        assert all(rows[metric][2] > rows["initial"][2] + 10 for metric in ("imr", "rr", "si", "ss")), rows
        # In the plane SI is 1 / (4 sqrt(3) IMR), so that both have the same best mesh.
        assert np.allclose(rows["imr"], rows["si"], atol=0.5)
    assert float(studies.rows("smoothing_times", "table_2_6")[0]["IMR dissertation"]) == 55
    shares = [r for r in studies.rows("smoothing_times", "shares_wrench") if r["metric"] == "imr"]
    sweeps = [int(r["sweeps"]) for r in shares]
    assert sweeps == sorted(sweeps) and sweeps[0] == 0 < sweeps[1] < sweeps[-1], sweeps


if __name__ == "__main__":
    check_list()
    run_all()
    check_toy()
    check_smoothing()
    check_untangling()
    check_angles()
    check_failed_runs()
    check_error()
    check_literal()
    check_own_mesh()
    print(pictures())
