# SPDX-License-Identifier: BSD-3-Clause
"""Compare two meshes.

Which elements became worse? Change is a cell array: 1 is better, 0 equal, -1 worse.

Shell: tautline perturb bracket.vtu --fraction 0.4 --seed 1 -o worse.vtu
Shell: tautline compare bracket.vtu worse.vtu --csv changes.csv -o after.vtu
Look at: the elements that became better (green) and worse (orange).
State: CompareMeshes(Input=before, Other=OpenDataFile("worse.vtu"))
Picture: Change clip
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
worse = tl.perturb(data / "bracket.vtu", fraction=0.4, seed=1)
result = tl.compare(data / "bracket.vtu", worse)
print(result.summary)
tl.write(data / "bracket.vtu", "before.vtu")
tl.write(worse, "worse.vtu")
tl.write(result, "after.vtu")
result.to_csv("changes.csv")
assert result.difference["imr"].max() > 0
