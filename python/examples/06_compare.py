# SPDX-License-Identifier: BSD-3-Clause
"""Compare two meshes.

Which elements became worse? The difference is a cell array, to be coloured.

Shell: tautline compare before.vtu after.vtu --csv changes.csv
Look at: the numbers of better and worse elements.
Picture: imr clip
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
worse = tl.perturb(data / "bracket.vtu", fraction=0.4, seed=1)
result = tl.compare(data / "bracket.vtu", worse)
print(result.summary)
tl.write(data / "bracket.vtu", "before.vtu")
tl.write(worse, "after.vtu")
assert result.difference["imr"].max() > 0
