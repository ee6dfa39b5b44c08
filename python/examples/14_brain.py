# SPDX-License-Identifier: BSD-3-Clause
"""A brain whose ventricles move.

The dissertation's planar section of a brain: the boundary moves as measured in images, the mesh follows.

Shell: tautline domain brain --cells 3000 -o before.vtu
Shell: tautline warp before.vtu --displacement Displacement -o after.vtu
Look at: the elements between the ventricles.
State: WarpMesh(Input=before, Motion="Displacement array", Displacement=["POINTS", "Displacement"])
Picture: imr
"""

import tautline as tl

before = tl.domain("brain", cells=3000)
result = tl.warp(before, displacement="Displacement")
print(result.summary)
tl.write(before, "before.vtu")
tl.write(result, "after.vtu")
assert result.inverted == 0
