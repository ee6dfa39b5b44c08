# SPDX-License-Identifier: BSD-3-Clause
"""Even out a terrain.

Points slide on the surface, which keeps its shape: hills are not flattened.

Shell: tautline optimize before.vtu -o after.vtu
Look at: the height does not change; the triangles on the slopes become regular.
State: OptimizeMesh(Input=before)
Picture: imr
"""

import numpy as np
import parts
import tautline as tl

points, triangles = parts.terrain()
shift = 0.035 * np.random.default_rng(5).standard_normal((len(points), 2))
inside = np.all((points[:, :2] > 0) & (points[:, :2] < 4), axis=1)
moved = points + np.column_stack([shift * inside[:, None], np.zeros(len(points))])
before = tl.from_arrays(moved, triangles)
result = tl.optimize(before)
worst = result.statistics["imr"]
print("mean", worst["mean_before"], "to", worst["mean_after"])
tl.write(before, "before.vtu")
tl.write(result, "after.vtu")
assert worst["mean_after"] < worst["mean_before"]
assert abs(result.mesh.GetBounds()[5] - before.GetBounds()[5]) < 0.02
