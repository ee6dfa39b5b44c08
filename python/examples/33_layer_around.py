# SPDX-License-Identifier: BSD-3-Clause
"""An interaction layer around a wrench.

Triangles of the width of the horizon are added around the wrench and in its holes.

Shell: tautline interaction-layer wrench.msh --width 0.2 -o after.vtu
Look at: Reference, 2 in the layer.
State: InteractionLayer(Input=before, Width=0.2)
Picture: Reference
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
before = tl.read(data / "wrench.msh")
result = tl.interaction_layer(before, width=0.2)
print(before.GetNumberOfCells(), "triangles, with the layer", result.GetNumberOfCells())
tl.write(before, "before.vtu")
tl.write(result, "after.vtu")
assert result.GetNumberOfCells() > before.GetNumberOfCells()
