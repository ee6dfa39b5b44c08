# SPDX-License-Identifier: BSD-3-Clause
"""Untangle a bracket.

41 of its 8,140 tetrahedra are inverted; afterwards none is inverted. The boundary does not move.

Shell: tautline untangle bracket-tangled.vtu -o after.vtu
Look at: the inverted elements (blue) inside the translucent surface, and the same elements afterwards: they are valid.
State: UntangleMesh(Input=before)
Picture: Validity inside
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
result = tl.untangle(data / "bracket-tangled.vtu")
print(result.inverted_before, "inverted before,", result.inverted, "after")
tl.write(data / "bracket-tangled.vtu", "before.vtu")
tl.write(result, "after.vtu")
assert (result.inverted_before, result.inverted) == (41, 0)
