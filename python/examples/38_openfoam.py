# SPDX-License-Identifier: BSD-3-Clause
"""A case of OpenFOAM that diverges.

The points inside a bent duct of polyhedra have been moved at random: checkMesh fails, and simpleFoam diverges. The
preset "finite volumes" moves them until the checks pass. simpleFoam then converges in 40 iterations; on the mesh before
the perturbation it takes 38. Testing/OpenFoam/solve_case.py measured this; 38_openfoam.json has the residuals.

Shell: tautline optimize before.vtu --preset "finite volumes" -o after.vtu
State: OptimizeMesh(Input=before, Preset="Finite volumes")
Look at: the mesh cut open, colored by non-orthogonality, dark beyond 70 degrees; the checks that fail before; and the \
  residuals that are printed, of the same solver with the same settings.
Picture: non_orthogonality clip
"""

import json
import sys
from pathlib import Path

import numpy as np
import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
mesh = tl.read(data / "elbow" / "elbow.foam")
inside = np.ones(len(mesh.points), bool)
inside[np.concatenate([*mesh.cells["quadrilateral"], *mesh.cells["polygon"]])] = False  # the patches
mesh.points[inside] += 0.2 * np.random.RandomState(1).uniform(-1, 1, mesh.points.shape)[inside]
tl.write(mesh, "before.vtu")
result = tl.optimize("before.vtu", preset="finite volumes")
tl.write(result, "after.vtu")
checks = [tl.quality(one, "non_orthogonality").failed_checks for one in ("before.vtu", result)]
print("failed checks before and after:", *checks)
solved = json.loads(Path(__file__).with_suffix(".json").read_text())
for name, of in solved.items():
    print(name, "mesh:", of["ended"], "after", of["iterations"], "iterations, residual", of["residuals"][-1])
assert checks == [solved[name]["failed_checks"] for name in ("perturbed", "repaired")] == [5, 0]
