# SPDX-License-Identifier: BSD-3-Clause
"""Script of `./run gui` without arguments: opens the mesh TAUTLINE_SAMPLE with Element Quality applied."""

import os

from paraview import simple

SAMPLE = os.environ["TAUTLINE_SAMPLE"]

mesh = simple.OpenDataFile(SAMPLE, registrationName=os.path.basename(SAMPLE))
view = simple.GetActiveViewOrCreate("RenderView")
quality = simple.ElementQuality(registrationName="ElementQuality1", Input=mesh)
display = simple.Show(quality, view)
display.SetScalarBarVisibility(view, True)
simple.SetActiveSource(quality)
simple.ResetCamera(view)
simple.Render(view)
