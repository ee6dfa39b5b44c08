"""Measure a mesh: which elements are bad, and by how much?

Look at the inverse mean ratio of the worst elements: 1 is an equilateral tetrahedron, large values are bad, and an
inverted element is counted by itself.
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
result = tl.quality(data / "bracket-tangled.vtu", ["imr", "min_angle"])
print(result.summary)
print("inverted elements:", result.inverted)
tl.write(result, "after.vtu")
