# SPDX-License-Identifier: BSD-3-Clause
"""Move a cylinder through a channel.

Ten positions of the cylinder, each deformed from the first mesh; a .pvd file has them as time steps.

Shell: tautline warp cylinder.msh --displacement Displacement --amount 0.5 -o step5.vtu
Shell: tautline warp cylinder.msh --displacement Displacement -o after.vtu
Look at: ParaView plays run.pvd; no step has an inverted element.
State: WarpMesh(Input=before, Motion="Displacement array", Displacement=["POINTS", "Displacement"])
Picture: imr
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
before = tl.read(data / "cylinder.msh")
entries = []
for step in range(11):
    result = tl.warp(before, displacement="Displacement", amount=step / 10)
    assert result.inverted == 0, step
    tl.write(result, f"step{step}.vtu")
    entries.append(f'<DataSet timestep="{step / 10}" part="0" file="step{step}.vtu"/>')
Path("run.pvd").write_text(f'<VTKFile type="Collection"><Collection>{"".join(entries)}</Collection></VTKFile>')
print("times", tl.times("run.pvd"))
tl.write(before, "before.vtu")
tl.write(result, "after.vtu")
assert len(tl.times("run.pvd")) == 11
