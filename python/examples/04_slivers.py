# SPDX-License-Identifier: BSD-3-Clause
"""Remove slivers.

Improve Mesh changes which points are joined: afterwards no dihedral angle of the bracket is below 15 degrees.

Shell: tautline improve before.vtu -o after.vtu
Look at: the smallest dihedral angle.
State: ImproveMesh(Input=before)
Picture: min_angle clip
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
valid = tl.optimize(tl.untangle(data / "bracket-tangled.vtu"))
result = tl.improve(valid)
print("smallest dihedral angle", result.smallest_angle_before, "to", result.smallest_angle)
tl.write(valid, "before.vtu")
tl.write(result, "after.vtu")
assert result.smallest_angle > 15 > result.smallest_angle_before
