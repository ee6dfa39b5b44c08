# SPDX-License-Identifier: BSD-3-Clause
"""Heat a plate.

The heat equation on a plate with a hole: the left edge is hot, the right one cold.

Shell: tautline solve plate.vtu --source 0 --given "(5 - x) / 10" --fixed "abs(x) > 4.999" \
  --time-scheme crank-nicolson --time-step 5 --time-steps 20 -o after.vtu
Look at: the isotherms, which end at right angles at the hole.
State: SolvePDE(Input=before, SourceValue=0, FixedPart="Part of the Boundary", FixedWhere="abs(x) > 4.999", \
  GivenType="Expression", GivenExpression="(5 - x) / 10", \
  TimeScheme="Heat: Crank-Nicolson", TimeStep=5, NumberOfTimeSteps=20)
Picture: Solution
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
before = tl.read(data / "plate.vtu")
result = tl.solve(
    before, source=0, given="(5 - x) / 10", fixed="abs(x) > 4.999",  # from x = -5 to 5
    time_scheme="crank-nicolson", time_step=5, time_steps=20,
)  # fmt: skip
print(result.summary)
tl.write(before, "before.vtu")
tl.write(result, "after.vtu")
low, high = result.mesh.GetPointData().GetArray("Solution").GetRange()
assert -1e-3 <= low < high <= 1 + 1e-3
