# SPDX-License-Identifier: BSD-3-Clause
"""The plugin loads in pvpython, adds its proxies and the color maps of its arrays."""

import os

from paraview import simple

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())
assert "ElementQuality" in globals()

CELLS = 1  # vtkDataObject::CELL
LOW, HIGH = 1.0, 3.0  # the acceptable range of imr

# An array of that name that no filter has to compute: 0 is inverted, 9 worse than the range.
mesh = simple.Tetrahedralize(simple.Wavelet(WholeExtent=[0, 3, 0, 3, 0, 3]))
colored = simple.Calculator(mesh, AttributeType="Cell Data", ResultArrayName="imr", Function="9")
view = simple.CreateView("RenderView")
display = simple.Show(colored, view)
display.SetScalarColoring("imr", CELLS)
simple.Render(view)

table = simple.GetColorTransferFunction("imr")
assert (table.RGBPoints[0], table.RGBPoints[-4]) == (LOW, HIGH), table.RGBPoints[:]
assert table.AutomaticRescaleRangeMode == "Never"
assert table.UseBelowRangeColor and list(table.BelowRangeColor) == [0.05, 0.35, 1]

# An array of another filter keeps ParaView's own map.
assert simple.GetColorTransferFunction("pressure").AutomaticRescaleRangeMode != "Never"
