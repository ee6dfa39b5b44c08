# SPDX-License-Identifier: BSD-3-Clause
"""Flat elements in the boundary layer at a wall.

The sizes grow from the lower wall of a channel, and are ten times as long along the wall as across it.

Shell: tautline metric before.vtu --source distance --wall wall --wall-size 0.01 --wall-growth 1.4 \
    --tangential-ratio 10 --largest-size 0.3 --gradation 0 -o metric.vtu
Shell: tautline improve metric.vtu --preset adapt --edge-length Metric --boundary sliding -o after.vtu
Look at: the layers at the lower wall.
State: ImproveMesh(Input=MetricTensor(Input=before, Source="Distance", Wall=["POINTS", "wall"], WallSize=0.01, \
    WallGrowth=1.4, TangentialRatio=10, LargestSize=0.3, Gradation=0), Preset="Adapt", \
    SizeArray=["POINTS", "Metric"], Boundary="Slide on flat parts")
Picture: edges
"""

import parts
import tautline as tl

before = parts.channel(10)
layers = {"wall": "wall", "wall_size": 0.01, "wall_growth": 1.4, "tangential_ratio": 10, "largest_size": 0.3}
metric = tl.metric(before, "distance", gradation=0, **layers)
result = tl.improve(metric, "adapt", edge_length="Metric", boundary="sliding")
low = [int((mesh.points[:, 2] < 0.05).sum()) for mesh in (before, result)]
print("points in the lowest twentieth:", *low)
print("elements", result.elements_before, result.elements)
tl.write(before, "before.vtu")
tl.write(metric, "metric.vtu")
tl.write(result, "after.vtu")
assert low[1] > 2 * low[0]
