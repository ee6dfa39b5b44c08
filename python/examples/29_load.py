# SPDX-License-Identifier: BSD-3-Clause
"""Load a bracket.

Linear elasticity: one face is held, the weight acts downwards; the displacement is the input of Warp Mesh or
of ParaView's
Warp By Vector.

Shell: tautline optimize bracket.vtu -o before.vtu
Shell: tautline solve before.vtu --pde elasticity --source=0,0,-1e-6 --fixed "x < 0.01" \
  --solution-name Deflection -o after.vtu
Look at: Deflection, largest at the free end.
State: SolvePDE(Input=before, Equation="Linear Elasticity", BodyForce=[0, 0, -1e-6], \
  FixedPart="Part of the Boundary", FixedWhere="x < 0.01", SolutionName="Deflection")
Picture: Deflection
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
before = tl.optimize(data / "bracket.vtu").mesh
result = tl.solve(before, pde="elasticity", source=(0, 0, -1e-6), fixed="x < 0.01", youngs_modulus=1.0,
                  solution_name="Deflection")  # fmt: skip
displacement = result.mesh.GetPointData().GetArray("Deflection")
low, high = displacement.GetRange(2)
print("largest displacement downwards", -low, "in", result.iterations, "iterations")
tl.write(before, "before.vtu")
tl.write(result, "after.vtu")
assert result.converged and low < 0
