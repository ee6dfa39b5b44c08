# SPDX-License-Identifier: BSD-3-Clause
"""Slide boundary points.

With the boundary "sliding", points on flat and straight parts of the boundary move along them; corners stay.

Shell: tautline optimize bracket.vtu --boundary sliding -o after.vtu
Look at: the worst element with a fixed boundary, and with a sliding one.
State: OptimizeMesh(Input=before, Boundary="Slide on flat parts")
Picture: imr clip
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
before = tl.read(data / "bracket.vtu")
fixed = tl.optimize(before).statistics["imr"]
result = tl.optimize(before, boundary="sliding")
slid = result.statistics["imr"]
print("mean:", fixed["mean_before"], "fixed", fixed["mean_after"], "sliding", slid["mean_after"])
tl.write(before, "before.vtu")
tl.write(result, "after.vtu")
assert slid["mean_after"] < fixed["mean_after"] < fixed["mean_before"]
