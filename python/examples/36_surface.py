# SPDX-License-Identifier: BSD-3-Clause
"""Better angles on a narrow terrain.

Improve Mesh on a surface: edges are swapped, split and contracted, and all points stay on the surface.

Shell: tautline improve before.vtu --preset aggressive -o after.vtu
Look at: the smallest angle, and the hills, which keep their shape.
State: ImproveMesh(Input=before, Preset="Aggressive")
Picture: imr
"""

import parts
import tautline as tl

points, triangles = parts.terrain(24)
before = tl.from_arrays(points * [1, 0.4, 1], triangles)
result = tl.improve(before, "aggressive")
print("smallest angle", result.smallest_angle_before, "to", result.smallest_angle)
tl.write(before, "before.vtu")
tl.write(result, "after.vtu")
assert result.smallest_angle > result.smallest_angle_before
