# SPDX-License-Identifier: BSD-3-Clause
"""The proxies of the module Shapes and the reader of silhouette sets, as scripts and the GUI use them."""

import os
import subprocess
from pathlib import Path

from paraview import simple as pv
from wording import wording

DATA = Path(os.environ["TAUTLINE_DATA_DIR"])
pv.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], remote=False, ns=globals())

source = pv.PNGSeriesReader(FileNames=[str(DATA / "fish.png")])
target = pv.PNGSeriesReader(FileNames=[str(DATA / "fish-bent.png")])
mesh = SilhouettetoMesh(Input=source, Spacing=15)  # noqa: F821
mesh.UpdatePipeline()
cells = mesh.GetDataInformation().GetNumberOfCells()
assert cells > 10, cells
mesh.UpdatePropertyInformation()
assert "triangles" in mesh.Result, mesh.Result

match = MatchShape(Input=mesh, Target=target, Locations="Points on the outline", PointsontheOutline=80)  # noqa: F821
match.UpdatePipeline()
assert match.GetDataInformation().GetNumberOfCells() == cells
assert match.CellData.GetArray("Energy").GetRange()[0] >= 0
assert match.PointData.GetArray("Displacement").GetNumberOfComponents() == 3
assert match.DeformationWeighta == 12 and match.DistortionWeightb == 3

# The package tautline, with its defaults, finds the same match.
found = MatchShape(Input=source, Target=target, Spacing=12, Locations="Points on the outline")  # noqa: F821
found.UpdatePipeline()
code = """
import sys, tautline
print(repr(tautline.match(*sys.argv[1:], spacing=12, locations="contour").energy))
"""
files = [str(DATA / name) for name in ("fish.png", "fish-bent.png")]
python = {key: value for key, value in os.environ.items() if key != "PYTHONHOME"}
command = ["/usr/bin/python3", "-c", code, *files]
energy = float(subprocess.run(command, env=python, check=True, text=True, stdout=subprocess.PIPE).stdout)
shown = pv.servermanager.Fetch(found, idx=1).GetValueByName(0, "Energy").ToDouble()
assert shown == energy and abs(energy - 77.4341) < 1e-4, (shown, energy)

shapes = SilhouetteSetReader(FileName=str(DATA / "silhouettes.csv"))  # noqa: F821
found = ShapeRetrieval(Input=shapes, BestMatches=1)  # noqa: F821
found.UpdatePipeline()
found.UpdatePropertyInformation()
assert wording("4-shapes-of-2-classes") in found.Result, found.Result
table = found.GetClientSideObject().GetOutputDataObject(2)
assert table.GetNumberOfRows() == 1, table
distances = pv.servermanager.Fetch(found)
assert distances.GetNumberOfRows() == 4 and distances.GetNumberOfColumns() == 6
assert distances.GetValueByName(0, "fish-bent").ToDouble() < distances.GetValueByName(0, "clover").ToDouble()
sheet = pv.servermanager.Fetch(found, idx=4)
assert sheet.GetDimensions() == (1200, 1200, 1) and sheet.GetPointData().GetArray("Sheet").GetNumberOfComponents() == 3
opened = pv.OpenDataFile(str(DATA / "silhouettes.csv"))
print("ok")
