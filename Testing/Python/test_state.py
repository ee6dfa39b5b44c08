# SPDX-License-Identifier: BSD-3-Clause
"""A state file with Tautline's filter loads again once the plugin is loaded."""

import os
from pathlib import Path

from paraview import simple

STATE = str(Path(os.environ["TAUTLINE_TEST_DIR"], "quality.pvsm"))

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())
mesh = simple.Tetrahedralize(simple.Wavelet(WholeExtent=[0, 3, 0, 3, 0, 3]))
quality = ElementQuality(registrationName="Quality", Input=mesh)  # noqa: F821, defined by the plugin
display = simple.Show(quality, simple.CreateView("RenderView"))
display.SetScalarColoring("imr", 1)
before = quality.CellData["imr"].GetRange()
simple.SaveState(STATE)

simple.ResetSession()
assert simple.FindSource("Quality") is None
simple.LoadState(STATE)
again = simple.FindSource("Quality")
again.UpdatePipeline()
assert again.CellData["imr"].GetRange() == before
display = simple.GetDisplayProperties(again, simple.GetActiveView())
assert display.ColorArrayName[1] == "imr", display.ColorArrayName[:]
