# SPDX-License-Identifier: BSD-3-Clause
"""Improve Mesh through ParaView: properties by name, tables, state file, colors."""

import os
from pathlib import Path

from paraview import servermanager, simple
from wording import wording

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())
STATE = str(Path(os.environ["TAUTLINE_TEST_DIR"], "reconnection.pvsm"))


def column(source, port, name):
    """A column of a table."""
    table = servermanager.Fetch(source, idx=port)
    return [table.GetValueByName(row, name).ToDouble() for row in range(table.GetNumberOfRows())]


domain = MeshDomain(Domain="Disk (3D)", NumberOfCells=2000)  # noqa: F821, defined by the plugin
worse = PerturbMesh(Input=domain, Percentage=100, Fraction=0.9)  # noqa: F821
regions = simple.Calculator(worse, AttributeType="Cell Data", ResultArrayName="region", Function="1")
best = ImproveMesh(registrationName="Improved", Input=regions)  # noqa: F821
assert (best.Preset, best.Boundary, best.TargetAngle) == ("Remove slivers", "Fixed", 0)
best.UpdatePipeline()
best.UpdatePropertyInformation()
assert best.SmallestAngleAfter > best.SmallestAngleBefore and best.WorstAfter < best.WorstBefore
assert abs(best.CellData["min_angle"].GetRange()[0] - best.SmallestAngleAfter) < 1e-6
assert abs(best.CellData["imr"].GetRange()[1] - best.WorstAfter) < 1e-6
assert wording("smallest-dihedral-angle") in best.Summary, best.Summary
assert column(best, 1, "N elements")[-1] == best.ElementsAfter
assert len(column(best, 2, "Cell") if best.Remaining else []) == best.Remaining

# every property of the panel arrives
for preset in ("Swap only", "Swap and smooth", "Aggressive"):
    best.Preset = preset
    best.UpdatePipeline()
    assert preset != "Swap only" or column(best, 1, "N moves")[-1] == 0
    assert best.CellData["min_angle"].GetRange()[0] >= best.SmallestAngleBefore, preset
best.Preset, best.Smooth, best.Insert, best.Contract, best.Compound = "Custom", 0, 0, 0, 0
best.TargetAngle, best.Boundary, best.FlatAngle = 20, "Slide on flat parts", 1e-6
best.SmallestCount, best.LargestCount, best.Objective = 0.8, 1.3, "Shape"
best.FeatureAngle, best.SurfaceAngle, best.SurfaceTolerance = 30, 15, 0.01
best.Regions = ["CELLS", "region"]
best.UpdatePipeline()
best.UpdatePropertyInformation()
assert column(best, 1, "N moves")[-1] == 0 and column(best, 1, "N edge removals")[-1] > 0
assert wording("the-target-of-20-degrees") in best.Summary, best.Summary
expected = best.CellData["min_angle"].GetRange()

# cell data and average shape
averaged = ImproveMesh(Input=regions, Preset="Aggressive", CellTransfer="Conservative", ThenBestShape=1)  # noqa: F821
plain = ImproveMesh(Input=regions, Preset="Aggressive")  # noqa: F821
for one in (averaged, plain):
    one.UpdatePipeline()
sized = ImproveMesh(Input=regions, Preset="Aggressive", EdgeLengths="One length", EdgeLength=100)  # noqa: F821
sized.UpdatePipeline()
assert column(sized, 1, "N insertions")[-1] == 0 < column(plain, 1, "N insertions")[-1]
sized.EdgeLengths, sized.EdgeFactor = "Those of the input", 1.1
sized.UpdatePipeline()
assert column(sized, 1, "N insertions")[-1] < column(plain, 1, "N insertions")[-1]
lengths = simple.Calculator(worse, AttributeType="Point Data", ResultArrayName="length", Function="100")
sized = ImproveMesh(Input=lengths, Preset="Aggressive", EdgeLengths="Point array")  # noqa: F821
sized.SizeArray = ["POINTS", "length"]
sized.UpdatePipeline()
assert column(sized, 1, "N insertions")[-1] == 0
assert averaged.CellData["region"].GetRange() == (1, 1)
assert column(averaged, 1, "N moves")[-1] > column(plain, 1, "N moves")[-1]

# a metric; a boundary that changes within a distance
named = ImproveMesh(Input=worse, Preset="Aggressive", Objective="Metric", Metric="Radius ratio")  # noqa: F821
named.Boundary, named.SurfaceTolerance = "Slide on smooth parts", 0.01
named.UpdatePipeline()
named.UpdatePropertyInformation()
assert wording("radius-ratio-of-the-worst-tetrahedron") in named.Summary, named.Summary
assert 0 <= named.BoundaryDistance < 0.1 and wording("largest-distance-between-the") in named.Summary, named.Summary

# points that stay
fixed = simple.Calculator(worse, AttributeType="Point Data", ResultArrayName="stay", Function="1")
held = ImproveMesh(Input=fixed, Preset="Swap and smooth", FixedPoints=["POINTS", "stay"])  # noqa: F821
held.UpdatePipeline()
assert column(held, 1, "N moves")[-1] == 0

display = simple.Show(best, simple.CreateView("RenderView"))
assert list(display.ColorArrayName) == ["CELLS", "min_angle"], display.ColorArrayName[:]
chart = simple.CreateView("XYChartView")
lines = simple.Show(servermanager.OutputPort(best, 1), chart)
assert set(lines.SeriesVisibility) == {"Smallest angle", "Largest angle", "Worst imr"}, lines.SeriesVisibility[:]

simple.SaveState(STATE)
simple.ResetSession()
simple.LoadState(STATE)
again = simple.FindSource("Improved")
assert (again.Preset, again.Boundary, again.TargetAngle, again.LargestCount) == (
    "Custom",
    "Slide on flat parts",
    20,
    1.3,
)
assert list(again.Regions) == ["CELLS", "region"]
again.UpdatePipeline()
assert again.CellData["min_angle"].GetRange() == expected
