# SPDX-License-Identifier: BSD-3-Clause
"""Refine where the solution needs it.

The solution of Poisson's equation has a singularity at the inner corner. The mesh is adapted to it: solve, compute the
sizes from the solution, adapt, four times.

Shell: tautline adapt before.vtu --elements 600 --iterations 4 --largest-size 0.5 -o after.vtu
Look at: the triangles at the inner corner, and the estimated error.
Picture: edges
"""

import parts
import tautline as tl

before = parts.corner(10)
result = tl.adapt(before, {"source": 1}, 4, elements=600, largest_size=0.5)
for row in result.table():
    print(row["iteration"], row["elements"], f"{row['estimated_error']:.2e}")
tl.write(before, "before.vtu")
tl.write(result, "after.vtu")
uniform = tl.adapt(parts.corner(20), {"source": 1}, 1, elements=600).history["estimated_error"][0]
assert result.estimated_error < 0.6 * uniform
