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

# The worst scaled Jacobian of the input, what HexOpt reaches (arXiv 2410.11656, to two decimals), the boundary fixed:
# there the facets bound it.
HEXAHEDRA = {"CAD4": (0.069, 0.12, 0.07), "rkm012": (0.467, 0.60, 0.57)}
folder = test_data("hex")
for name, (before, published, fixed) in HEXAHEDRA.items():
    mesh = tl.read(folder / f"{name}.vtk")
    worst = {"input": tl.quality(mesh, ["scaled_jacobian"]).values["scaled_jacobian"].min()}
    assert abs(worst["input"] - before) < 1e-3, worst
    for boundary in ("fixed", "on surface"):
        result = tl.optimize(mesh, preset="worst element", boundary=boundary)
        worst[boundary] = tl.quality(result.mesh, ["scaled_jacobian"]).values["scaled_jacobian"].min()
        assert result.inverted == 0, result.summary
        assert result.statistics["imr"]["mean_after"] < result.statistics["imr"]["mean_before"], result.summary
        print(name, boundary, worst[boundary], result.surface_error)
    assert worst["fixed"] > fixed and worst["on surface"] > published - 0.005, worst
