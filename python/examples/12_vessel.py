# SPDX-License-Identifier: BSD-3-Clause
"""Widen a vessel to an aneurysm.

The wall of a bent artery moves outward in its middle; the tetrahedra inside follow. The displacement is an
array of the
points, made with numpy.

Shell: tautline warp before.vtu --displacement Displacement -o after.vtu
Look at: no element is inverted, although the wall moves by its radius.
State: WarpMesh(Input=before, Motion="Displacement array", Displacement=["POINTS", "Displacement"])
Picture: imr
"""

import numpy as np
import parts
import tautline as tl
from vtkmodules.util.numpy_support import numpy_to_vtk

before = parts.vessel()
xyz = np.array([before.GetPoint(i) for i in range(before.GetNumberOfPoints())])
angle = np.arctan2(xyz[:, 1], xyz[:, 0])
axis = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(len(xyz))])
bulge = np.exp(-(((angle - np.pi / 2) / 0.4) ** 2))
displacement = numpy_to_vtk(bulge[:, None] * (xyz - axis), deep=True)
displacement.SetName("Displacement")
before.GetPointData().AddArray(displacement)
result = tl.warp(before, displacement="Displacement")
print(result.summary)
tl.write(before, "before.vtu")
tl.write(result, "after.vtu")
assert result.inverted == 0
