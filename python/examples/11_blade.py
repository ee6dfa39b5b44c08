# SPDX-License-Identifier: BSD-3-Clause
"""Repair a turbine blade of hexahedra.

A tenth of the hexahedra is folded, some of them between valid corners: the exact test also finds these.

Shell: tautline untangle before.vtu -o after.vtu
Look at: Minimum Jacobian, the smallest determinant anywhere in the element.
State: UntangleMesh(Input=before)
Picture: Validity
"""

import parts
import tautline as tl

blade = parts.turbine_blade()
before = tl.perturb(blade, tangle=0.1, seed=4)
result = tl.untangle(before)
measured = tl.quality(result, "min_jacobian")
print(result.inverted_before, "inverted before,", result.inverted, "after")
tl.write(before, "before.vtu")
tl.write(result, "after.vtu")
assert result.inverted_before >= 288 and result.inverted == 0
assert measured.statistics["min_jacobian"]["minimum"] > 0
