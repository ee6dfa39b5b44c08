"""What bad elements cost a solver.

The same equation on the bracket before and after the optimization: the conjugate gradients take fewer iterations. On
the shell: tautline solve mesh.vtu --source 1 -o solved.vtu
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
assert count["optimized"] < count["untangled"]
