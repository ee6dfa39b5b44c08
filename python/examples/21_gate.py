# SPDX-License-Identifier: BSD-3-Clause
"""Open a gate.

The boundary motion of a gate in a channel is large for its mesh. All methods of deformation, with the inverted elements
of each.

Shell: tautline domain gate --cells 1000 -o before.vtu
Shell: tautline warp before.vtu --displacement Displacement --method femwarp -o femwarp.vtu
Shell: tautline warp before.vtu --displacement Displacement -o after.vtu
Look at: the table; which linear methods fail, while the hybrid one does not.
State: WarpMesh(Input=before, Motion="Displacement array", Displacement=["POINTS", "Displacement"])
Picture: imr
"""

import tautline as tl

before = tl.domain("gate", cells=1000)
inverted = {}
for method in ("femwarp", "jacobian stiffening", "inverse distance", "radial basis", "hybrid"):
    result = tl.warp(before, displacement="Displacement", method=method)
    inverted[method] = result.inverted
    tl.write(result, f"{method.replace(' ', '-')}.vtu")
    print(f"{method:20} {result.inverted:4} inverted")
tl.write(before, "before.vtu")
tl.write(result, "after.vtu")
assert inverted["hybrid"] == 0
