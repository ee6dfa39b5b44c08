# SPDX-License-Identifier: BSD-3-Clause
"""Which element spoils the matrix?

The condition number of the stiffness matrix, and the share of each element in the largest eigenvalue: a flat element
stands out. Optimization lowers the condition number, as no flat element is left.

Shell: tautline perturb plate.vtu --fraction 0.98 --percentage 100 --seed 9 -o perturbed.vtu
Shell: tautline condition perturbed.vtu --preconditioner jacobi -o before.vtu
Shell: tautline optimize perturbed.vtu -o optimized.vtu
Shell: tautline condition optimized.vtu --preconditioner jacobi -o after.vtu
Look at: the dark red element in the close-up, which is a hundred times as stiff as the mean, and its share.
State: ConditionEstimator(Input=OptimizeMesh(Input=before), Preconditioner="Jacobi")
Picture: Excess near
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
perturbed = tl.perturb(data / "plate.vtu", fraction=0.98, percentage=100, seed=9).mesh
optimized = tl.optimize(perturbed).mesh
bad = tl.condition(perturbed, preconditioner="jacobi")
good = tl.condition(optimized, preconditioner="jacobi")
print("condition number", bad.condition, "after the optimization", good.condition)
tl.write(perturbed, "perturbed.vtu")
tl.write(optimized, "optimized.vtu")
tl.write(bad, "before.vtu")
tl.write(good, "after.vtu")
assert good.condition < bad.condition
