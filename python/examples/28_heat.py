# SPDX-License-Identifier: BSD-3-Clause
"""Heat a plate.

The heat equation on a plate with a hole: the left edge is hot, the right one cold.

Shell: tautline solve plate.vtu --source 0 --given "x < -0.99" --fixed "abs(x) > 0.99" -o after.vtu
Look at: the isotherms, which end at right angles at the hole.
State: SolvePDE(Input=before)
Picture: Solution
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
before = tl.read(data / "plate.vtu")
left, right = before.GetBounds()[:2]
result = tl.solve(
    before, source=0, given=f"({right} - x) / {right - left}", fixed=f"(x < {left + 1e-6}) | (x > {right - 1e-6})",
    time_scheme="crank-nicolson", time_step=0.05 * (right - left) ** 2, time_steps=20,
)  # fmt: skip
print(result.summary)
tl.write(before, "before.vtu")
tl.write(result, "after.vtu")
low, high = result.mesh.GetPointData().GetArray("Solution").GetRange()
assert -1e-3 <= low < high <= 1 + 1e-3
