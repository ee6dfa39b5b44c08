# SPDX-License-Identifier: BSD-3-Clause
"""Elements of equal size.

The target of every triangle of a wrench is the mean area; shape and size are optimized together.

Shell: tautline optimize before.vtu --preset "uniform size" -o after.vtu
Look at: the colors, Minimum Jacobian, which is twice the area of a triangle.
State: OptimizeMesh(Input=before, Preset="Uniform size")
Picture: min_jacobian
"""

import tautline as tl

before = tl.perturb(tl.domain("wrench", cells=1500), fraction=0.7, percentage=100, seed=3).mesh
result = tl.optimize(before, preset="uniform size")
areas = [tl.quality(mesh, "min_jacobian").statistics["min_jacobian"] for mesh in (before, result)]
print("standard deviation of the areas", *(area["standard_deviation"] for area in areas))
tl.write(before, "before.vtu")
tl.write(result, "after.vtu")
assert areas[1]["standard_deviation"] < areas[0]["standard_deviation"]
