# SPDX-License-Identifier: BSD-3-Clause
"""Fill a surface with tetrahedra.

TetGen fills the facets of a file, and Improve Mesh removes the slivers that are left.

Shell: tautline tet-mesh cube.smesh --volume 0.002 --radius-edge-ratio 1.6 --minimum-dihedral-angle 0 -o before.vtu
Shell: tautline improve before.vtu --preset aggressive -o after.vtu
Look at: the smallest dihedral angle.
State: ImproveMesh(Input=before, Preset="Aggressive")
Picture: min_angle clip
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
before = tl.tet_mesh(data / "cube.smesh", volume=0.002, radius_edge_ratio=1.6, minimum_dihedral_angle=0).mesh
result = tl.improve(before, "aggressive")
print("smallest dihedral angle", result.smallest_angle_before, "to", result.smallest_angle)
tl.write(before, "before.vtu")
tl.write(result, "after.vtu")
assert result.smallest_angle > result.smallest_angle_before
