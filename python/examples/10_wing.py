# SPDX-License-Identifier: BSD-3-Clause
"""Pitch a wing by 25 degrees.

The mesh around the section follows it: FEMWARP inverts elements at the trailing edge, the hybrid method does not.

Shell: tautline warp before.vtu --rotate=-25 -o after.vtu
Look at: the elements around the trailing edge, and the wake that turns with it.
State: WarpMesh(Input=before, Motion="Transform", TransformKind="Rotation", Angle=-25)
Picture: imr
"""

import parts
import tautline as tl

before, section = parts.flow_around_wing()
plain = tl.warp(before, transform={"rotate": -25}, method="femwarp")
result = tl.warp(before, transform={"rotate": -25})
print("inverted:", plain.inverted, "by FEMWARP,", result.inverted, "by the hybrid method")
tl.write(before, "before.vtu")
tl.write(result, "after.vtu")
assert result.inverted == 0
