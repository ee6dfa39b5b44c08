# SPDX-License-Identifier: BSD-3-Clause
"""The menus of ParaView have registered metrics: from a library (TAUTLINE_METRICS), and from Python."""

import os
import sys
from wording import wording

HEIGHT = "Height of the center"  # the label of a metric of the test
os.environ["TAUTLINE_METRICS"] = sys.argv[1]

import numpy as np  # noqa: E402
import tautline as tl  # noqa: E402
from paraview import servermanager, simple  # noqa: E402

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())

image = simple.Wavelet(WholeExtent=[0, 3, 0, 3, 0, 3])
cubes = simple.AppendDatasets(Input=image)
quality = ElementQuality(Input=cubes)  # noqa: F821, defined by the plugin
menu = quality.GetProperty("Metrics").GetAvailable()
assert menu[0] == "Inverse mean ratio" and menu[38] == "Minimum Jacobian", menu
assert menu[-2:] == ["My distortion", "Longest edge"], menu
quality.Metrics = ["My distortion", "Longest edge"]
quality.UpdatePipeline()
assert quality.CellData["longest_edge"].GetRange() == (1, 1)
assert max(map(abs, quality.CellData["my_distortion"].GetRange())) < 1e-12
table = servermanager.Fetch(quality, idx=1)
assert table.GetValueByName(0, "Label").ToString() == "My distortion"

# An objective, and the metric of the worst element.
tetrahedra = simple.Tetrahedralize(Input=cubes)
sheared = simple.WarpByVector(
    Input=simple.Calculator(tetrahedra, ResultArrayName="d", Function="0.1*sin(3*coordsX+5*coordsY*coordsZ)*iHat")
)
sheared.Vectors = ["POINTS", "d"]
optimizer = OptimizeMesh(Input=sheared)  # noqa: F821
assert wording("my-distortion") in optimizer.GetProperty("Metric1").GetAvailable()
worst = optimizer.GetProperty("WorstElementBy").GetAvailable()
assert worst[0] == "Automatic" and worst[1] == "Inverse mean ratio" and len(worst) == 62, worst
optimizer.Preset = "Custom"
optimizer.Metric1 = "My distortion"
optimizer.WorstElementBy = "My distortion"
optimizer.UpdatePipeline()


def distortion(source):
    measured = ElementQuality(Input=source)  # noqa: F821
    measured.Metrics = ["My distortion"]
    measured.UpdatePipeline()
    rows = servermanager.Fetch(measured, idx=1)
    return rows.GetValueByName(0, "RMS").ToDouble(), rows.GetValueByName(0, "Worst").ToDouble()


before, after = distortion(sheared), distortion(optimizer)
assert after[0] < before[0] and after[1] <= before[1], (before, after)

# One that Python registers now is in the menus of filters made afterwards; its number follows from its name.
tl.register_metric("height", lambda corners, cell: corners[:, :, 2].mean(axis=1), label="Height of the center",
                   rotation_invariant=False)  # fmt: skip
assert HEIGHT not in quality.GetProperty("Metrics").GetAvailable()
another = ElementQuality(Input=cubes)  # noqa: F821
another.Metrics = ["Height of the center"]
another.UpdatePipeline()
assert np.allclose(another.CellData["height"].GetRange(), (0.5, 2.5))

# A state file has numbers: they are the same in another session, whatever was registered before.
state = os.path.join(os.environ["TAUTLINE_TEST_DIR"], "user_metric.pvsm")
simple.SaveState(state)
with open(state, encoding="utf-8") as file:
    assert str(next(m["number"] for m in tl.metrics() if m["name"] == "height")) in file.read()
simple.ResetSession()
simple.LoadState(state)
loaded = [s for (name, _), s in simple.GetSources().items() if s.GetXMLName() == "ElementQuality"]
assert any(HEIGHT in s.GetProperty("Metrics").GetData() for s in loaded), loaded
print("ok")
