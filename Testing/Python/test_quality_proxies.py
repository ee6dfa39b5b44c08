# SPDX-License-Identifier: BSD-3-Clause
"""Element Quality through ParaView: properties by name, outputs by name, colored by itself, in numbers."""

import os

from paraview import servermanager, simple

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())

WORST_PORT = 4

# 27 cubes of unit size, sheared: each has the same mean ratio 3 / |T|^2 = 3 / 3.25 and volume 1.
image = simple.Wavelet(WholeExtent=[0, 3, 0, 3, 0, 3])
grid = simple.AppendDatasets(Input=image)
sheared = simple.WarpByVector(Input=simple.Calculator(grid, ResultArrayName="d", Function="0.5*coordsX*kHat"))
sheared.Vectors = ["POINTS", "d"]
quality = ElementQuality(Input=sheared)  # noqa: F821, defined by the plugin
quality.Metrics = ["Mean ratio", "Size (area or volume)", "Scaled Jacobian"]
quality.UpdatePipeline()
table = servermanager.Fetch(quality, idx=1)
assert [table.GetValueByName(row, "Metric").ToString() for row in range(3)] == ["mean_ratio", "size", "scaled_jacobian"]
mean = [table.GetValueByName(row, "Mean").ToDouble() for row in range(3)]
for value, expected in zip(mean, (3 / 3.25, 1.0, 1 / 1.25**0.5)):
    assert abs(value - expected) < 1e-6, (value, expected)
assert servermanager.Fetch(quality, idx=WORST_PORT).GetNumberOfPoints() == 30
assert quality.CellData["Validity"].GetRange() == (1, 1)
quality.UpdatePropertyInformation()
assert quality.Summary.startswith("27 valid elements, 0 inverted"), quality.Summary
assert not quality.Notice

# Against the unsheared mesh as reference the shear is what is measured: |T - I|^2 = 0.25.
quality.TargetType = "Element of a reference mesh"
quality.Reference = grid
quality.Metrics = ["Shape, size and orientation, non-barrier"]
quality.UpdatePipeline()
low, high = quality.CellData["mu_shape_size_orientation_nb"].GetRange()
assert abs(low - 0.25) < 1e-6 and abs(high - 0.25) < 1e-6, (low, high)

# A fresh display is colored by the first metric, although the input has active point scalars.
display = simple.Show(quality, simple.CreateView("RenderView"))
assert list(display.ColorArrayName) == ["CELLS", "mu_shape_size_orientation_nb"], display.ColorArrayName[:]

# The property Criteria takes what the function and the shell take; the verdict is in the summary.
CRITERIA_PORT = 6
quality.Criteria = "skewness"
quality.UpdatePipeline()
quality.UpdatePropertyInformation()
assert quality.Summary.startswith('Passed by the criteria "Equiangle skewness, shells and solids"'), quality.Summary
assert quality.CellData["Grade"].GetRange() == (0, 0)
assert servermanager.Fetch(quality, idx=CRITERIA_PORT).GetValueByName(0, "Graded").ToInt() == 27
