# SPDX-License-Identifier: BSD-3-Clause
"""Two objectives at once.

Shape and size of the elements of a barrier conflict with each other; a scalarization decides. The table has both
for several
weights.

Look at: the table that is printed; neither objective improves without the other becoming worse.
Picture: imr
"""

import tautline as tl

before = tl.perturb(tl.domain("barrier2d", cells=1200), fraction=0.6, seed=6).mesh
size = tl.quality(before, "min_jacobian").statistics["min_jacobian"]["mean"] / 2  # twice the area
rows = []
for weight in (0.1, 1, 10):
    aims = ["imr", ("mu_size", {"target": "size", "weight": weight})]
    result = tl.optimize(before, aims, size=size, scalarization="weighted sum")
    measured = tl.quality(result, ["imr", "mu_size"], size=size).statistics
    rows.append((weight, measured["imr"]["mean"], measured["mu_size"]["mean"]))
    print("weight %g: mean imr %.4f, mean size %.4f" % rows[-1])
tl.write(before, "before.vtu")
tl.write(result, "after.vtu")
assert rows[0][1] < rows[2][1] and rows[0][2] > rows[2][2]
