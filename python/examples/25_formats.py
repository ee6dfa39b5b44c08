# SPDX-License-Identifier: BSD-3-Clause
"""Convert meshes between programs.

Gmsh's mesh with its regions to Medit, TetGen and VTK, and the metric as a view for Gmsh.

Shell: tautline convert part.msh part.mesh
Shell: tautline quality part.msh --metrics imr -o after.vtu
Look at: the regions, Reference, are kept.
Picture: Reference
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
before = tl.read(data / "part.msh")
for name in ("part.mesh", "part.node", "part.vtu"):
    tl.write(before, name)
    assert tl.read(name).GetNumberOfCells() == before.GetNumberOfCells(), name
measured = tl.quality(before, "imr")
tl.write(measured, "part.pos")
print([form["ending"] for form in tl.formats() if form["write"]])
tl.write(before, "before.vtu")
tl.write(measured, "after.vtu")
assert Path("part.pos").read_text().startswith('View "')
