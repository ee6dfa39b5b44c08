# SPDX-License-Identifier: BSD-3-Clause
"""Small elements where the surface is curved.

Metric Tensor computes sizes from the curvature of the bracket, by the distance that an edge may have from the surface.
Improve Mesh with the preset Adapt gives the edges these lengths; the fillet and the holes keep their shape.

Shell: tautline metric before.vtu --source curvature --chord-error 0.05 --smallest-size 1 --largest-size 8 \
    -o metric.vtu
Shell: tautline improve metric.vtu --preset adapt --edge-length Metric --boundary "on surface" -o after.vtu
Look at: the fillet and the holes, and the flat parts, which need few elements.
State: ImproveMesh(Input=MetricTensor(Input=before, Source="Curvature", ChordError=0.05, SmallestSize=1, \
    LargestSize=8), Preset="Adapt", SizeArray=["POINTS", "Metric"], Boundary="Slide on smooth parts")
Picture: edges
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
before = tl.read(data / "bracket.vtu")
metric = tl.metric(before, "curvature", chord_error=0.05, smallest_size=1, largest_size=8)
result = tl.improve(metric, "adapt", edge_length="Metric", boundary="on surface")
print(result.elements_before, "elements before,", result.elements, "after")
shares = [f"{share:.0%}" for share in (result.edges_in_range_before, result.edges_in_range)]
print("edges with about the target length:", shares[0], "before,", shares[1], "after")
tl.write(before, "before.vtu")
tl.write(metric, "metric.vtu")
tl.write(result, "after.vtu")
assert result.elements < 0.6 * result.elements_before and result.edges_in_range > 0.7
