# SPDX-License-Identifier: BSD-3-Clause
"""Find a fish in a picture.

The shape of one fish, triangulated, is deformed to match the picture of another.

Shell: tautline silhouette fish.png --spacing 12 -o before.vtu
Shell: tautline match fish.png fish-bent.png --locations contour --spacing 12 -o after.vtu
Look at: each vertex of the triangulation lies on the other fish.
Picture: edges
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
fish = tl.silhouette(data / "fish.png", spacing=12)
found = tl.match(fish, data / "fish-bent.png", locations="contour")
print(found.summary)
tl.write(fish, "before.vtu")
tl.write(found, "after.vtu")
assert found.mesh.GetNumberOfCells() == fish.mesh.GetNumberOfCells()
