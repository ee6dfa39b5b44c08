# SPDX-License-Identifier: BSD-3-Clause
"""The cost of bad elements for a solver.

The same equation on the bracket before and after the optimization: the conjugate gradients take fewer iterations.

Shell: tautline untangle bracket-tangled.vtu -o before.vtu
Shell: tautline solve before.vtu --preconditioner jacobi
Shell: tautline optimize before.vtu -o optimized.vtu
Shell: tautline solve optimized.vtu --preconditioner jacobi -o after.vtu
Look at: the two numbers of iterations.
State: SolvePDE(Input=OptimizeMesh(Input=before), Preconditioner="Jacobi")
Picture: imr clip
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
valid = tl.untangle(data / "bracket-tangled.vtu")
optimized = tl.optimize(valid)
slow = tl.solve(valid, source=1, solver="cg", preconditioner="jacobi")
fast = tl.solve(optimized, source=1, solver="cg", preconditioner="jacobi")
print("iterations", slow.iterations, "on the untangled mesh,", fast.iterations, "on the optimized one")
tl.write(valid, "before.vtu")
tl.write(optimized, "optimized.vtu")
tl.write(fast, "after.vtu")
assert fast.iterations < slow.iterations
