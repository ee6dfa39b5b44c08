# SPDX-License-Identifier: BSD-3-Clause
"""Plot a metric over the position of a vertex.

The inverse mean ratio over the position of one corner of a triangle: flat near the ideal, infinite at the inversion.

Shell: tautline metric-field --metrics imr --bounds -1 2 0.05 2 0 0 --dimensions 121 79 1 -o after.vti
Look at: the level sets around the corner of the equilateral triangle.
Picture: imr
"""

import tautline as tl

result = tl.metric_field("imr", bounds=(-1, 2, 0.05, 2), dimensions=(121, 79))
valid = result.values["imr"][result.validity == 1]
print("smallest value", valid.min())
tl.write(result, "after.vti")
assert 1 <= valid.min() < 1.001
