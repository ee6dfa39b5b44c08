# SPDX-License-Identifier: BSD-3-Clause
"""Which solver for this mesh?

Four combinations of solver and preconditioner solve the same problem; the fastest one that converges is recommended if
the times differ by more than the noise.

Shell: tautline solver-study plate.vtu --combinations 1,4,13,16 --no-conditions --csv study.csv
Look at: the numbers of iterations in the table.
State: SolverStudy(Input=before, Combinations=[1, 4, 13, 16], EstimateConditions=0)
Picture: edges table
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
before = tl.read(data / "plate.vtu")
study = tl.solver_study(before, combinations=[1, 4, 13, 16], conditions=False)
for row in study.table():
    print(row)
print("recommended:", study.recommended, study.why)
study.to_csv("study.csv")
tl.write(before, "before.vtu")
assert len(study.table()) == 4 and all(row["converged"] for row in study.table())
