# SPDX-License-Identifier: BSD-3-Clause
"""Move a ball in a box.

Tetrahedra between a cube and a ball that moves and shrinks: the same method in space.

Shell: tautline domain sphere --cells 3000 -o before.vtu
Shell: tautline warp before.vtu --displacement Displacement -o after.vtu
Look at: a clip through the middle.
State: WarpMesh(Input=before, Motion="Displacement array", Displacement=["POINTS", "Displacement"])
Picture: imr clip
"""

import tautline as tl

before = tl.domain("sphere", cells=3000)
result = tl.warp(before, displacement="Displacement")
print(result.summary)
tl.write(before, "before.vtu")
tl.write(result, "after.vtu")
assert result.inverted == 0
