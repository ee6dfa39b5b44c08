"""The demo writes mesh, table and a picture that shows something."""

import os
import runpy
import sys
from pathlib import Path

import tautline as tl
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

OUT = Path(os.environ["TAUTLINE_TEST_DIR"], "demo")

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=vars(simple))  # as if loaded at the start
sys.argv = ["demo.py", str(OUT)]
runpy.run_module("tautline.demo", run_name="__main__")
result = tl.quality(OUT / "quality.vtu")
assert 10 < result.inverted < 100 and (OUT / "quality.csv").read_text().startswith("metric,label,")

reader = vtkPNGReader()
reader.SetFileName(str(OUT / "quality.png"))
reader.Update()
pixels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).astype(int)[:, :3]
white = (pixels == 255).all(axis=1).mean()
magenta = ((pixels[:, 0] > 150) & (pixels[:, 1] < 20) & (pixels[:, 2] > 150)).mean()
assert 0.4 < white < 0.85, white
assert 0.002 < magenta < 0.1, magenta

better = tl.quality(OUT / "better.vtu")
assert better.inverted == 0
assert better.statistics["imr"]["mean"] < result.statistics["imr"]["mean"]
reader.SetFileName(str(OUT / "better.png"))
reader.Update()
pixels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).astype(int)[:, :3]
legend = ((pixels[:, 0] > 150) & (pixels[:, 1] < 20) & (pixels[:, 2] > 150)).mean()
assert 0.4 < (pixels == 255).all(axis=1).mean() < 0.85 and legend < 0.5 * magenta, (legend, magenta)
