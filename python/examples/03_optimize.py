# SPDX-License-Identifier: BSD-3-Clause
"""Optimize a plate with a hole.

Points of a perturbed mesh of triangles and quadrilaterals move until the mean shape is best; the worst element does not
get worse.

Shell: tautline optimize before.vtu -o after.vtu
Look at: the elements around the hole.
State: OptimizeMesh(Input=before)
Picture: imr
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
before = tl.perturb(data / "plate.vtu", fraction=0.5, seed=7)
result = tl.optimize(before)
worst = result.statistics["imr"]
print("worst inverse mean ratio", worst["worst_before"], "to", worst["worst_after"], result.reason)
tl.write(before, "before.vtu")
tl.write(result, "after.vtu")
assert worst["worst_after"] <= worst["worst_before"]
