# SPDX-License-Identifier: BSD-3-Clause
"""Stretch elements by a metric tensor.

In the metric of the tensor, target edges have length 1: short ones across the lower wall of a channel, long
ones along it.

Look at: the rows of flat triangles at the wall.
Picture: edges
"""

import numpy as np
import tautline as tl

before = tl.domain("rectangle", cells=800)
height = np.array([before.GetPoint(i)[1] for i in range(before.GetNumberOfPoints())])
across = 1 / (0.02 + 0.08 * height) ** 2
tensor = np.zeros((len(height), 6))
tensor[:, 0], tensor[:, 1], tensor[:, 2] = 1 / 0.07**2, across, 1
result = tl.optimize(before, [("mu_shape_size", {"target": "tensor"})], tensor=tensor)
low = [np.sum(np.array([mesh.GetPoint(i)[1] for i in range(mesh.GetNumberOfPoints())]) < 0.1)
       for mesh in (before, result.mesh)]  # fmt: skip
print("points in the lowest tenth:", *low)
tl.write(before, "before.vtu")
tl.write(result, "after.vtu")
assert low[1] > low[0]
