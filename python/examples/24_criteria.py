# SPDX-License-Identifier: BSD-3-Clause
"""Does the mesh pass?

Limits of a finite-element program grade every element; the failed ones go to other programs as sets.

Shell: tautline quality bracket-tangled.vtu --criteria fem -o after.vtu
Shell: tautline quality bracket-tangled.vtu --criteria fem --groups -o groups.vtu
Look at: Grade, 2 is failed; with meshio the sets also go to Abaqus (.inp) and Salome (.med).
State: ElementQuality(Input=before, Criteria="fem")
Picture: Grade alone
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
before = tl.read(data / "bracket-tangled.vtu")
result = tl.quality(before, criteria="fem")
sets = result.groups()
print(result.verdict, {name: len(members) for name, members in sets.items()})
tl.write(before, "before.vtu")
tl.write(result, "after.vtu")
tl.write(result, "groups.vtu", groups=sets)
assert result.verdict == "failed" and len(sets["Inverted"]) == 41
