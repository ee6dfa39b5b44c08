# SPDX-License-Identifier: BSD-3-Clause
"""Turn a hole by 120 degrees.

FEMWARP, a linear method, inverts elements near the hole; the hybrid method untangles and improves them.

Shell: tautline warp plate.vtu --rotate 120 -o after.vtu
Look at: the rings of quadrilaterals around the hole.
State: WarpMesh(Input=before, Motion="Transform", TransformKind="Rotation", Angle=120)
Picture: imr
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
plain = tl.warp(data / "plate.vtu", transform={"rotate": 120}, method="femwarp")
hybrid = tl.warp(data / "plate.vtu", transform={"rotate": 120}, method="hybrid")
print("inverted:", plain.inverted, "by FEMWARP,", hybrid.inverted, "by the hybrid method")
tl.write(data / "plate.vtu", "before.vtu")
tl.write(hybrid, "after.vtu")
assert plain.inverted > hybrid.inverted == 0
