# SPDX-License-Identifier: BSD-3-Clause
"""A nonlocal model.

The matrix of a peridynamic model on a square with its interaction layer, its condition number and the solution.

Shell: tautline domain square --element-size 0.1 --layer-width 0.2 -o before.vtu
Shell: tautline peridynamics before.vtu --delta 0.2 --p 1 --solve -o after.vtu
Look at: the solution is given in the whole layer, not only on the boundary.
State: PeridynamicCondition(Input=before, Horizon=0.2, Exponent=1, Solve=1)
Picture: Solution
"""

import tautline as tl

before = tl.domain("square", element_size=0.1, layer_width=0.2)
result = tl.peridynamics(before, delta=0.2, p=1.0, solve=True)
print(result.summary)
tl.write(before, "before.vtu")
tl.write(result, "after.vtu")
assert result.condition > 1
