# SPDX-License-Identifier: BSD-3-Clause
"""The studies of mesh deformation in the small size: their tables, findings, pictures and numbers."""

import numpy as np
import tautline as tl
from checks import OUT
from study_checks import Studies, pictures, refused_command
from tautline.studies import _deformed, _meshes, _warped
from vtkmodules.util.numpy_support import vtk_to_numpy

studies = Studies(OUT / "studies_deformation")
# Per study: findings, pictures, and rows of its tables.
STUDIES = {
    "rectangle_warp": (6, ("strip", "inverted"), {"inverted": 6, "propositions": 4}),
    "deformation": (24, ("strip_cylinder", "strip_sphere", "inverted", "iterations", "seconds", "quality"),
                    {"sweep_cylinder": 2, "sweep_bar": 2, "sweep_sphere": 2, "quality_sphere": 9}),
    "deformation_methods": (9, ("strip", "inverted"), {"inverted": 13, "worst": 13, "mean": 13, "reached": 13}),
    "local_coefficients": (6, ("strip", "inverted"), {"inverted": 4, "worst": 4, "seconds": 4}),
    "box_rotation": (7, ("strip", "inverted"), {"inverted": 18, "imr_worst": 13, "imr_mean": 13, "seconds": 14}),
}


def run_all():
    for study, expected in STUDIES.items():
        studies.run(study)
        studies.check(study, *expected)
    refused_command("at least one run", "study", "deformation", "--repeats", "0")


def check_rectangle():
    whole = next(row for row in studies.rows("rectangle_warp", "inverted") if float(row["amount"]) == 1.0)
    assert float(whole["FEMWARP"]) > 0 == float(whole["anisotropic"]), whole
    for row in studies.rows("rectangle_warp", "propositions"):
        assert float(row["largest"]) <= float(row["to be at most"]), row
    found = {row["source"]: row["verdict"] for row in studies.rows("rectangle_warp", "findings")}
    assert all(found[f"Proposition {n}"] == "holds" for n in range(1, 5)), found
    assert found["Figure 4.20"] == "too small to decide", found


def check_examples():
    for domain in ("cylinder", "bar", "sphere"):
        last = studies.rows("deformation", f"sweep_{domain}")[-1]
        assert float(last["FEMWARP"]) > 2 * float(last["anisotropic"]), last
        assert float(last["left FEMWARP"]) == float(last["left anisotropic"]) == 0, last
        quality = {row["method"]: row for row in studies.rows("deformation", f"quality_{domain}")}
        worst = {name: float(row["worst"]) for name, row in quality.items()}
        assert worst["hybrid, amount 1"] < min(worst["femwarp, amount 1"], worst["ubn, amount 1"]), worst
        elements = {sum(float(row[b]) for b in _deformed.bin_names()) for row in quality.values()}
        assert len(elements) == 1, f"each element is in one bin: {elements}"
        assert float(quality["hybrid-steps, amount 1.5"]["inverted"]) == 0, quality


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
    found = {row["finding"]: row["verdict"] for row in studies.rows("local_coefficients", "findings")}
    assert next(verdict for text, verdict in found.items() if "at 1 times the motion, in all" in text) == "holds", found


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
    run_all()
    check_rectangle()
    check_examples()
    check_methods()
    check_local_coefficients()
    print(pictures())
