# SPDX-License-Identifier: BSD-3-Clause
"""Optimize Mesh and Untangle Mesh through ParaView: properties by name, tables, state file, animation, colors."""

import os
from pathlib import Path

from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from wording import wording

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())
DATA = Path(os.environ["TAUTLINE_DATA_DIR"])
STATE = str(Path(os.environ["TAUTLINE_TEST_DIR"], "optimization.pvsm"))
TANGLED = str(DATA / "bracket-tangled.vtu")

mesh = simple.OpenDataFile(str(DATA / "plate.vtu"))
worse = PerturbMesh(Input=mesh, Percentage=100, Fraction=0.9)  # noqa: F821, defined by the plugin
best = OptimizeMesh(registrationName="Best", Input=worse)  # noqa: F821
assert best.Preset == "Best shape"
best.UpdatePipeline()
before, after = best.CellData["imr_before"].GetRange(), best.CellData["imr"].GetRange()
assert after[1] < 0.8 * before[1], (before, after)
assert best.CellData["Validity"].GetRange() == (1, 1)
assert best.PointData["Displacement"].GetNumberOfComponents() == 3
history, statistics = servermanager.Fetch(best, idx=1), servermanager.Fetch(best, idx=2)
rows = history.GetNumberOfRows()
objective = [history.GetValueByName(row, "Objective").ToDouble() for row in range(rows)]
assert rows > 3 and objective == sorted(objective, reverse=True)
assert statistics.GetValueByName(0, "WorstAfter").ToDouble() == after[1]
best.UpdatePropertyInformation()
assert wording("inverse-mean-ratio-mean-2") in best.Summary and best.Reason.startswith("Converged"), best.Summary

# every property of the panel arrives
for preset in ("Fast clean-up", "Uniform size", "Low interpolation error", "Untangle then improve", "Worst element"):
    best.Preset = preset
    best.UpdatePipeline()
    assert best.CellData["Validity"].GetRange() == (1, 1), preset
best.Preset = "Preserve shape"
best.Reference = mesh
best.UpdatePipeline()
assert best.CellData["imr"].GetRange()[1] < 1.5, best.CellData["imr"].GetRange()
best.Preset = "Custom"
best.NumberOfObjectives = 2
best.Metric1, best.Template1, best.Weight1 = "Radius ratio", "Power mean", 2.0
best.Metric2, best.Template2, best.Target2 = "Size, barrier", "Sum", "Element of the reference mesh"
best.Scalarization, best.Optimizer = "Weighted sum", "L-BFGS"
best.MaximumIterations, best.RelativeChange, best.GradientNorm = 4, 0, 0
best.Utopia = [1.0, 2.0]
best.Boundary, best.FlatAngle = "Slide on flat parts", 2.0
best.UpdatePipeline()
history = servermanager.Fetch(best, idx=1)
assert history.GetNumberOfRows() == 5
names = [history.GetColumnName(i) for i in range(history.GetNumberOfColumns())]
assert names[:4] == ["Objective", "rr objective", "rr mean", "rr worst"], names
assert len(names) == 11, names

# points that stay: an array, a selection
fixed = simple.Calculator(worse, AttributeType="Point Data", ResultArrayName="stay", Function="coordsX>0")
held = OptimizeMesh(Input=fixed, FixedPoints=["POINTS", "stay"])  # noqa: F821
held.UpdatePipeline()
all_free = OptimizeMesh(Input=worse)  # noqa: F821
all_free.UpdatePipeline()
counts = []
for filter_ in (held, all_free):
    moved = simple.Threshold(Input=simple.Calculator(filter_, AttributeType="Point Data", Function="mag(Displacement)"))
    moved.Scalars, moved.LowerThreshold, moved.UpperThreshold = ["POINTS", "Result"], 1e-9, 1e9
    moved.UpdatePipeline()
    counts.append(moved.GetDataInformation().GetNumberOfCells())
assert 0 < counts[0] < 0.8 * counts[1], counts
points = worse.GetDataInformation().GetNumberOfPoints()
everything = simple.IDSelectionSource(FieldType="POINT", IDs=[n for i in range(points) for n in (0, i)])
held = OptimizeMesh(Input=worse, FixedSelection=everything)  # noqa: F821
held.UpdatePipeline()
held.UpdatePropertyInformation()
assert held.Reason == "No vertex is free to move.", held.Reason

# the iterations as time steps
moving = OptimizeMesh(registrationName="Moving", Input=worse, Animation=1)  # noqa: F821
moving.UpdatePipeline()
moving.UpdatePipelineInformation()
steps = list(moving.TimestepValues)
assert steps == list(range(len(steps))) and len(steps) == rows, steps
worst = []
for time in (0, 1, steps[-1]):
    moving.UpdatePipeline(time)
    worst.append(moving.CellData["imr"].GetRange()[1])
assert abs(worst[0] - before[1]) < 1e-9 and worst[2] == after[1] and worst[1] < worst[0], worst

# untangled, and the state file
tangled = simple.OpenDataFile(TANGLED)
untangled = UntangleMesh(registrationName="Untangled", Input=tangled, Effort="Thorough",
                          Method="Simultaneous untangling and smoothing")  # noqa: F821
untangled.UpdatePipeline()
assert untangled.CellData["Validity"].GetRange() == (1, 1) and untangled.CellData["Obstacle"].GetRange() == (0, 0)
untangled.UpdatePropertyInformation()
assert untangled.Summary == "All elements are valid; 41 were not.", untangled.Summary
assert (untangled.InvertedBefore, untangled.InvertedAfter) == (41, 0)
table = servermanager.Fetch(untangled, idx=1)
assert table.GetValueByName(table.GetNumberOfRows() - 1, "Inverted").ToDouble() == 0

# a known optimum of 0, which the objective cannot come close to, is not an unknown one
bracket = simple.OpenDataFile(str(DATA / "bracket.vtu"))
reasons = []
for use in (0, 1):
    known = OptimizeMesh(Input=bracket, Preset="Custom", Reduction=0.5, UseBestKnown=use, BestKnown=0)  # noqa: F821
    known.UpdatePipeline()
    known.UpdatePropertyInformation()
    reasons.append(known.Reason)
assert "reduction" in reasons[0] and "Converged" in reasons[1], reasons
simple.RenameSource("Known", known)

# a Geometry from an STL file, features and regions
STL = str(Path(os.environ["TAUTLINE_TEST_DIR"], "proxies-sphere.stl"))
simple.SaveData(STL, proxy=simple.Sphere(ThetaResolution=60, PhiResolution=60, Radius=0.52))
ball = simple.Sphere(ThetaResolution=12, PhiResolution=9)
geometry = OptimizeMesh(registrationName="Ball", Input=ball, Geometry=simple.STLReader(FileNames=[STL]))  # noqa: F821
radius = simple.Calculator(geometry, AttributeType="Point Data", ResultArrayName="radius", Function="mag(coords)")
radius.UpdatePipeline()
low, high = radius.PointData["radius"].GetRange()
assert 0.519 < low <= high < 0.5201, (low, high)
plain = simple.Calculator(ball, AttributeType="Point Data", ResultArrayName="radius", Function="mag(coords)")
plain.UpdatePipeline()
assert abs(plain.PointData["radius"].GetRange()[1] - 0.5) < 1e-6
halves = simple.Calculator(simple.PointDatatoCellData(Input=simple.Elevation(Input=worse, LowPoint=[0, 0, 0],
                           HighPoint=[1e-6, 0, 0])), AttributeType="Cell Data", ResultArrayName="side",
                           Function="round(Elevation)")  # fmt: skip
kept = OptimizeMesh(registrationName="Kept", Input=halves, Regions=["CELLS", "side"], ShowFeatures=1,  # noqa: F821
                    Boundary="Slide on smooth parts")  # fmt: skip
kept.UpdatePipeline()
kept.UpdatePropertyInformation()
shown = OptimizeMesh(Input=halves, ShowFeatures=1, Boundary="Slide on smooth parts")  # noqa: F821
shown.UpdatePipeline()
shown.UpdatePropertyInformation()
kinds = [vtk_to_numpy(servermanager.Fetch(one).GetPointData().GetArray("FeatureKind")) for one in (kept, shown)]
assert (kinds[0] > 0).sum() > (kinds[1] > 0).sum() > 0, kinds
assert kept.PointData["PatchId"].GetNumberOfComponents() == 1 and "Features: " in kept.Summary, kept.Summary

display = simple.Show(all_free, simple.CreateView("RenderView"))
assert list(display.ColorArrayName) == ["CELLS", "imr"], display.ColorArrayName[:]
chart = simple.CreateView("XYChartView")
lines = simple.Show(servermanager.OutputPort(all_free, 1), chart)
assert set(lines.SeriesVisibility) == {"Objective", "imr mean", "imr worst", "Inverted"}, lines.SeriesVisibility[:]

expected = best.CellData["rr"].GetRange()
simple.SaveState(STATE)
simple.ResetSession()
simple.LoadState(STATE)
again = simple.FindSource("Best")
assert (again.Preset, again.NumberOfObjectives, again.Metric1, again.Target2) == (
    "Custom",
    2,
    "Radius ratio",
    "Element of the reference mesh",
)
again.UpdatePipeline()
assert again.CellData["rr"].GetRange() == expected
assert (simple.FindSource("Known").UseBestKnown, simple.FindSource("Known").BestKnown) == (1, 0)
assert simple.FindSource("Moving").Animation == 1 and simple.FindSource("Untangled").Effort == "Thorough"
assert simple.FindSource("Untangled").Method == "Simultaneous untangling and smoothing"
ball = simple.FindSource("Ball")
assert ball.Geometry is not None and simple.FindSource("Kept").Regions[1] == "side"
