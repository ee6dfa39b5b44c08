# SPDX-License-Identifier: BSD-3-Clause
"""Bend a bar.

The bar bends by the domain's displacement; the fluid around it is meshed.

Shell: tautline domain bending-bar --cells 1200 -o before.vtu
Shell: tautline warp before.vtu --displacement Displacement -o after.vtu
Look at: the elements at the tip of the bar.
State: WarpMesh(Input=before, Motion="Displacement array", Displacement=["POINTS", "Displacement"])
Picture: imr
"""

import tautline as tl

before = tl.domain("bending-bar", cells=1200)
result = tl.warp(before, displacement="Displacement")
print(result.summary)
tl.write(before, "before.vtu")
tl.write(result, "after.vtu")
assert result.inverted == 0
