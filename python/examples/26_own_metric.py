# SPDX-License-Identifier: BSD-3-Clause
"""Define a metric of your own.

The longest edge of each element divided by the shortest one, as a numpy function; all functions accept its name.

Look at: the new array, in the statistics and in the picture.
Picture: edge_span
"""

import sys
from pathlib import Path

import numpy as np
import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
PAIRS = {"triangle": [(0, 1), (1, 2), (2, 0)], "quadrilateral": [(0, 1), (1, 2), (2, 3), (3, 0)]}


def edge_span(corners, cell_type):
    lengths = [np.linalg.norm(corners[:, a] - corners[:, b], axis=1) for a, b in PAIRS[cell_type]]
    return np.max(lengths, axis=0) / np.min(lengths, axis=0)


tl.register_metric("edge_span", edge_span, label="Edge Span", cell_types=list(PAIRS), full=(1, 1e300),
                   acceptable=(1, 3))  # fmt: skip
result = tl.quality(data / "plate.vtu", "edge_span")
print(result.summary)
tl.write(data / "plate.vtu", "before.vtu")
tl.write(result, "after.vtu")
assert result.statistics["edge_span"]["minimum"] >= 1
