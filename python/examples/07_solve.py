# SPDX-License-Identifier: BSD-3-Clause
"""What bad elements cost a solver.

The same equation on the bracket before and after the optimization: the conjugate gradients take fewer iterations.

Shell: tautline solve mesh.vtu --source 1 -o solved.vtu
Look at: the two numbers of iterations.
Picture: imr clip
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
valid = tl.untangle(data / "bracket-tangled.vtu")
count = {
    name: tl.solve(mesh, source="1", solver="cg", preconditioner="jacobi").iterations
    for name, mesh in (("untangled", valid), ("optimized", tl.optimize(valid)))
}
print("iterations", count)
tl.write(valid, "before.vtu")
tl.write(tl.optimize(valid), "after.vtu")
assert count["optimized"] < count["untangled"]
