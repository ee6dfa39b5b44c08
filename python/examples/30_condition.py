# SPDX-License-Identifier: BSD-3-Clause
"""Which element spoils the matrix?

The condition number of the stiffness matrix, and the share of each element in the largest eigenvalue: a flat element
stands out.

Shell: tautline perturb plate.vtu --fraction 0.98 --percentage 100 --seed 9 -o before.vtu
Shell: tautline condition before.vtu --preconditioner jacobi -o after.vtu
Look at: the dark elements, which are a hundred times as stiff as the mean, and their share.
State: ConditionEstimator(Input=before, Preconditioner="Jacobi")
Picture: Excess
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
before = tl.perturb(data / "plate.vtu", fraction=0.98, percentage=100, seed=9).mesh
bad = tl.condition(before, preconditioner="jacobi")
good = tl.condition(tl.optimize(before), preconditioner="jacobi")
print("condition number", bad.condition, "after the optimization", good.condition)
tl.write(before, "before.vtu")
tl.write(bad, "after.vtu")
assert good.condition < bad.condition
