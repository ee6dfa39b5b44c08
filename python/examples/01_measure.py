# SPDX-License-Identifier: BSD-3-Clause
"""Measure a mesh: which elements are bad, and by how much?

The inverse mean ratio of an equilateral tetrahedron is 1, large values are bad, and an inverted element is counted by
itself.

Shell: tautline quality bracket-tangled.vtu --metrics imr,min_angle -o after.vtu
Look at: the elements beyond 3 (dark red) and the inverted ones (blue) inside the translucent surface.
State: ElementQuality(Input=before, Metrics=["Inverse mean ratio", "Minimum angle"])
Picture: imr inside alone
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
result = tl.quality(data / "bracket-tangled.vtu", ["imr", "min_angle"])
print(result.summary)
print("inverted elements:", result.inverted)
tl.write(data / "bracket-tangled.vtu", "before.vtu")
tl.write(result, "after.vtu")
assert result.inverted == 41
