# SPDX-License-Identifier: BSD-3-Clause
"""The function untangle on every mesh of the folder tangled of TAUTLINE_TEST_DATA, and the preset for the worst element
on meshes of the folder hex; skipped where they are absent."""

import tautline as tl
from checks import test_data

files = sorted(test_data("tangled").glob("*.vtk"))
assert files
for file in files:
    result = tl.untangle(file)
    assert result.inverted_before > 0 == result.inverted == tl.quality(result).inverted, (file, result.summary)
    print(f"{file.name}: {result.inverted_before} inverted, now none")

# The worst scaled Jacobian of the input; what it must be at least with the boundary fixed, where the facets bound it,
# with points that leave it by this many diagonals, and with points that slide on it without a limit. HexOpt reaches
# 0.12 and 0.60, and 0.32 on lower_arm with another surface mesh (arXiv 2410.11656).
HEXAHEDRA = {"CAD4": (0.069, {"fixed": 0.09, 0.001: 0.60, "unlimited": 0.60}),
             "rkm012": (0.467, {"fixed": 0.57, 0.001: 0.60}), "lower_arm": (0.103, {0.001: 0.28})}
folder = test_data("hex")
for name, (before, least) in HEXAHEDRA.items():
    mesh = tl.read(folder / f"{name}.vtk")
    found = tl.quality(mesh, ["scaled_jacobian"]).values["scaled_jacobian"].min()
    assert abs(found - before) < 1e-3, found
    for run, aim in least.items():
        tolerance = run if isinstance(run, float) else 0.0
        boundary = "fixed" if run == "fixed" else "on surface"
        result = tl.optimize(mesh, preset="worst element", boundary=boundary, surface_tolerance=tolerance)
        worst = tl.quality(result.mesh, ["scaled_jacobian"]).values["scaled_jacobian"].min()
        assert result.inverted == 0, result.summary
        imr, way = result.statistics["imr"], (worst - before) / (1 - before)
        assert imr["mean_after"] < (1.05 + way) * imr["mean_before"], result.summary
        error = result.surface_error / mesh.GetLength()
        print(name, run, worst, error)
        assert worst > aim, (name, run, worst)
        assert error <= tolerance or run == "unlimited", (name, run, error)
