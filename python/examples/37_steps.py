# SPDX-License-Identifier: BSD-3-Clause
"""Steps in a file.

Read, grade, untangle, optimize and write, as a file that is checked before it runs; the shell runs the same file.

Shell: tautline run steps.toml
Look at: the file; its arguments are the arguments of the Python functions.
Picture: imr clip
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
steps = """
[[step]]
do = "read"
file = "before.vtu"

[[step]]
do = "untangle"

[[step]]
do = "optimize"
preset = "best shape"

[[step]]
do = "criteria"
criteria = "fem"
stop = false

[[step]]
do = "write"
file = "after.vtu"
"""
tl.write(data / "bracket-tangled.vtu", "before.vtu")
Path("steps.toml").write_text(steps)
result = tl.run_steps("steps.toml")
print(result.summary if hasattr(result, "summary") else result)
assert tl.quality("after.vtu").inverted == 0
