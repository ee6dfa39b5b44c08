# SPDX-License-Identifier: BSD-3-Clause
"""Improve the worst element.

A solver's time step depends on the worst element of a wrench. The preset "worst element" improves it as far as
possible; "best shape" improves the mean.

Shell: tautline optimize before.vtu --preset "worst element" -o after.vtu
Look at: the two numbers printed: worst and mean of both presets.
State: OptimizeMesh(Input=before, Preset="Worst element")
Picture: imr
"""

import tautline as tl

before = tl.perturb(tl.domain("wrench", cells=1500), fraction=0.9, percentage=100, seed=1).mesh
mean = tl.optimize(before, preset="best shape").statistics["imr"]
result = tl.optimize(before, preset="worst element")
worst = tl.quality(result).statistics["imr"]
print("best shape: worst", mean["worst_after"], "worst element: worst", worst["worst"])
tl.write(before, "before.vtu")
tl.write(result, "after.vtu")
assert worst["worst"] < 0.95 * mean["worst_after"]
