# SPDX-License-Identifier: BSD-3-Clause
"""Find similar silhouettes.

Each silhouette of a list is matched with every other one; the most similar one is of the same class.

Shell: tautline silhouette fish.png --spacing 10 -o before.vtu
Shell: tautline silhouette clover.png --spacing 10 -o after.vtu
Shell: tautline retrieval silhouettes.csv --best 1
Look at: the rate, the percentage of queries whose nearest shape is of their class.
Picture: edges
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
result = tl.retrieval(data / "silhouettes.csv", best=1)
print(result.summary)
fish = tl.silhouette(data / "fish.png", spacing=10)
clover = tl.silhouette(data / "clover.png", spacing=10)
tl.write(fish, "before.vtu")
tl.write(clover, "after.vtu")
assert result.rate == 100
