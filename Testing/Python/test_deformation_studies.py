# SPDX-License-Identifier: BSD-3-Clause
"""The studies of mesh deformation in the small size: their tables, findings, pictures and numbers."""

import dataclasses

import numpy as np
import tautline as tl
from checks import OUT
from study_checks import Studies, pictures, rejected_command
from tautline.studies import _deformed, _meshes, _moving_findings, _verdicts, _warped, target_matrices
from vtkmodules.util.numpy_support import vtk_to_numpy

studies = Studies(OUT / "studies_deformation")
# Per study: findings, pictures, and rows of its tables.
DOMAINS = [example.domain for example in _deformed.EXAMPLES]
STUDIES = {
    "rectangle_warp": (9, ("strip", "inverted"), {"inverted": 6, "propositions": 4}),
    "deformation": (93, (*(f"strip_{domain}" for domain in DOMAINS), "inverted", "iterations", "seconds", "quality"),
                    {**{f"sweep_{domain}": 2 for domain in DOMAINS}, **{f"quality_{domain}": 10 for domain in DOMAINS},
                     **{f"settings_{domain}": 4 for domain in DOMAINS}}),
    "deformation_methods": (15, ("strip", "inverted"), {"inverted": 13, "worst": 13, "mean": 13, "reached": 13}),
    "local_coefficients": (6, ("strip", "inverted"), {"inverted": 4, "worst": 4, "seconds": 4}),
    "target_matrices": (5, (), {"inverted": 6, "worst": 6, "mean": 6}),
    "box_rotation": (7, ("strip", "inverted"), {"inverted": 18, "imr_worst": 13, "imr_mean": 13, "seconds": 14}),
}


def stated(calls):
    """The calls on the examples with the printed counts of inverted elements."""
    made = []
    for function, arguments, named in calls:
        if function.__name__ == "findings":
            example, swept, left, runs, cells = arguments
            printed = {"femwarp, amount 1": example.femwarp, "anisotropic, amount 1": example.anisotropic or 0}
            runs = {name: dataclasses.replace(run, inverted=printed.get(name, run.inverted))
                    for name, run in runs.items()}
            made.append((function, (example, swept, left, runs, cells), named))
    return made


def run_all():
    for study, expected in STUDIES.items():
        studies.run(study)
        studies.check(study, *expected, stated(studies.calls[study]) if study == "deformation" else ())
    rejected_command("at least one is needed", "study", "deformation", "--repeats", "0")
    rejected_command("at least one is needed", "study", "deformation", "--seeds", "0")


def check_rectangle():
    whole = next(row for row in studies.rows("rectangle_warp", "inverted") if float(row["amount"]) == 1.0)
    assert float(whole["FEMWARP"]) > 0 == float(whole["anisotropic"]), whole
    for row in studies.rows("rectangle_warp", "propositions"):
        assert float(row["largest"]) <= float(row["to be at most"]), row
    found = {row["source"]: row["verdict"] for row in studies.rows("rectangle_warp", "findings")}
    assert all(found[f"Proposition {n}"] == "holds" for n in range(1, 5)), found
    assert found["Figure 4.20"] == "too small to decide", found
    uneven = {row["claim"]: row["verdict"] for row in studies.rows("rectangle_warp", "findings")}
    assert uneven["Anisotropic FEMWARP preserves the element spacing"] == "holds", uneven


def check_examples():
    for domain in DOMAINS:
        last = studies.rows("deformation", f"sweep_{domain}")[-1]
        assert float(last["FEMWARP"]) > float(last["anisotropic"]), last
        assert float(last["left FEMWARP"]) == float(last["left anisotropic"]) == float(last["impossible"]) == 0, last
        assert float(last["iterations FEMWARP"]) > float(last["iterations anisotropic"]) > 0, last
        quality = {row["method"]: row for row in studies.rows("deformation", f"quality_{domain}")}
        worst = {name: float(row["worst"]) for name, row in quality.items()}
        hybrid = min(worst["hybrid-literal, amount 1"], worst["hybrid, amount 1"])
        assert hybrid < min(worst["femwarp, amount 1"], worst["ubn, amount 1"]), worst
        elements = {sum(float(row[b]) for b in _deformed.bin_names()) for row in quality.values()}
        assert len(elements) == 1, f"each element is in one bin: {elements}"
        assert float(quality["hybrid-steps, amount 1.5"]["inverted"]) == 0, quality
    found = {row["claim"]: row["verdict"] for row in studies.rows("deformation", "findings")}
    metric = "The TMP shape metric (4.22) is invariant to "
    assert found[f"{metric}rotations"] == "holds" and found[f"{metric}the scale"] == "does not hold", found


def check_second_step():
    """(4.24) untangles the bar; a run that does not has no time; the history is of each iteration."""
    moving = _deformed.Moving("bar", 800)
    start = _deformed.deform(moving.mesh, moving.at(1.0), "anisotropic")
    whole = _deformed.untangled(moving.mesh, start.mesh, 300, 2)
    assert whole.history[0] == start.inverted > whole.history[-1] == 0 and whole.iterations == len(whole.history) - 1
    assert len(whole.times.runs) == 2 and min(whole.history[:-1]) > 0, whole
    failed = _deformed.untangled(moving.mesh, start.mesh, 1, 2)
    assert failed.times is None and np.isnan(failed.iterations) and failed.history[-1] > 0, failed
    assert _deformed.untangled(moving.mesh, moving.mesh, 1, 1).iterations == 0
    literal = _deformed.deform(moving.mesh, moving.at(1.0), _deformed.LITERAL, iterations=5)
    assert len(literal.history) == 6 and literal.history[:6] == whole.history[:6], (literal.history, whole.history)
    cells = [_deformed.Moving("bar", 800, seed).mesh.GetNumberOfCells() for seed in (1, 2, 3)]
    assert cells[0] == moving.mesh.GetNumberOfCells() and cells[2] < cells[0] < cells[1], cells


def check_failed_runs():
    """No verdict rests on a run that failed, on the only one that did not, on none, or on a tie."""
    failed, done = None, _verdicts.Times((1.0, 1.01))
    for pair in ((failed, failed), (failed, done), (done, failed), (done, done)):
        assert isinstance(_moving_findings._less_time(*pair), _verdicts.Open), pair
    assert _moving_findings._less_time(_verdicts.Times((0.5,)), done) is True
    assert _moving_findings._less_time(_verdicts.Times((2.0,)), done) is False
    for pair in ((np.nan, np.nan), (np.nan, 3.0), (3.0, np.nan)):
        assert isinstance(_moving_findings._fewer(*pair), _verdicts.Open), pair
    assert _moving_findings._fewer(2.0, 3.0) is True and _moving_findings._fewer(3.0, 3.0) is False


def check_methods():
    rows = {row["method"]: row for row in studies.rows("deformation_methods", "inverted")}
    left = {name: [float(n) for column, n in row.items() if column != "method"] for name, row in rows.items()}
    assert set(left) == {label for label, _ in _deformed.METHODS.values()} and len(left["hybrid"]) == 12
    assert all(n == 0 for n in left["hybrid, as many steps as needed"]) and all(n > 0 for n in left["FEMWARP"])
    reached = {row["method"]: row for row in studies.rows("deformation_methods", "reached")}
    assert all(float(n) == 1 for c, n in reached["hybrid, as many steps as needed"].items()
               if c not in ("method", "gate 1.5")), reached
    turned = {row["method"]: row for row in studies.rows("box_rotation", "inverted")}
    assert all(float(turned["hybrid"][angle]) == 0 for angle in ("30", "60", "90")), turned["hybrid"]
    # 75 and 56 of the mesh that TetGen 1.6 makes, more than twice as many with TetGen 1.5.
    assert float(turned["FEMWARP"]["90"]) > float(turned["radial basis"]["90"]) > 0, turned
    assert float(turned["OpenFOAM, displacementLaplacian"]["120"]) == 591


def check_local_coefficients():
    rows = {row["coefficients"]: row for row in studies.rows("local_coefficients", "inverted")}
    total = {name: sum(float(n) for column, n in row.items() if column.endswith(" 1")) for name, row in rows.items()}
    assert 2 * total["local gradients"] < total["constant, (4.19)"] < total["FEMWARP"], total
    assert all(row["verdict"] == "too small to decide" for row in studies.rows("local_coefficients", "findings"))


def check_target_matrices():
    """Coefficients that are the elements' areas undo the weights: FEMWARP. (4.22) by area is also FEMWARP."""
    moving = _deformed.Moving("bar", 400)
    displacement = moving.at(1.0)
    theirs = _meshes.points_of(_deformed.deform(moving.mesh, displacement, "femwarp").mesh)
    sizes = np.abs(_meshes.sizes_of(moving.mesh))
    alike = target_matrices.tensors(moving.mesh, "equal", (1.0, 1.0, 1.0))
    assert np.allclose(alike[:, 0] * sizes, sizes.mean()) and np.all(alike[:, 3:] == 0)
    undone = tl.warp(moving.mesh, displacement, method="anisotropic femwarp", coefficients=alike * sizes[:, None])
    assert np.abs(_meshes.points_of(undone.mesh) - theirs).max() < 1e-9
    assert target_matrices.distance(moving) < 1e-12
    unweighted = target_matrices.by_shape(moving.mesh, displacement, np.ones(len(sizes)))
    before = _deformed.similarity(moving.mesh, theirs).sum()
    assert _deformed.similarity(moving.mesh, _meshes.points_of(unweighted)).sum() < before
    found = {row["claim"]: row["verdict"] for row in studies.rows("target_matrices", "findings")}
    assert sorted(found.values()) == ["holds"] + 4 * ["too small to decide"], found


def check_similarity():
    """(4.22) by the study is the cell array of the filter, and 0 for a turn and another size."""
    for name in ("bar", "sphere"):
        moving = _deformed.Moving(name, 1000)
        result = tl.warp(moving.mesh, moving.at(0.5), method="hybrid")
        ours = _deformed.similarity(moving.mesh, _meshes.points_of(result.mesh))
        theirs = vtk_to_numpy(result.mesh.GetCellData().GetArray("TMP shape"))
        assert np.allclose(ours, theirs, rtol=1e-9, atol=1e-12), np.abs(ours - theirs).max()
        turn = np.array([[0.0, -3.0, 0.0], [3.0, 0.0, 0.0], [0.0, 0.0, 3.0]])
        same = _deformed.similarity(moving.mesh, _meshes.points_of(moving.mesh) @ turn)
        assert np.abs(same).max() < 1e-11, np.abs(same).max()


def check_section():
    """The plane through the middle cuts the box-in-box in 1 - 0.3^2."""
    mesh = tl.domain("box-in-box", 2000)
    for axis in range(3):
        polygons, owners = _deformed.section(mesh, axis, 0.513)
        area = 0.0
        for piece in polygons:
            x, y = piece.T
            area += 0.5 * abs(np.dot(x, np.roll(y, 1)) - np.dot(y, np.roll(x, 1)))
        assert abs(area - 0.91) < 1e-12 and len(set(owners)) == len(polygons), area


def check_harmonic():
    """Affine motions of the boundary are extended exactly, in the plane and in space."""
    for name, dimension in (("brain", 2), ("bore", 3)):
        mesh = tl.domain(name, 1000)
        points = _meshes.points_of(mesh)
        slope = np.array([[0.3, -0.2, 0.0], [0.1, 0.4, 0.0], [0.2, -0.3, 0.5 * (dimension == 3)]]) * (
            np.arange(3) < dimension,
        )
        wanted = points @ slope + [1.0, 2.0, 0.0]
        fixed = _warped.of_points(mesh, "Fixed") != 0
        found = _warped.harmonic(mesh, np.where(fixed[:, None], wanted, 7.0))
        assert np.abs(found - wanted).max() < 1e-10, f"{name}: {np.abs(found - wanted).max()}"


if __name__ == "__main__":
    check_similarity()
    check_section()
    check_harmonic()
    check_second_step()
    check_failed_runs()
    run_all()
    check_rectangle()
    check_examples()
    check_methods()
    check_local_coefficients()
    check_target_matrices()
    print(pictures())
