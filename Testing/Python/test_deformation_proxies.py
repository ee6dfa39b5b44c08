# SPDX-License-Identifier: BSD-3-Clause
"""Warp Mesh through ParaView: properties by name, transforms, selections, targets, time, animation, state file."""

import os
from pathlib import Path

from paraview import servermanager, simple
from wording import wording

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())
DATA = Path(os.environ["TAUTLINE_DATA_DIR"])
STATE = str(Path(os.environ["TAUTLINE_TEST_DIR"], "deformation.pvsm"))


def moved(filter_):
    """How many points moved, and how far at most."""
    filter_.UpdatePipeline()
    statistics = servermanager.Fetch(filter_, idx=2)
    assert statistics.GetNumberOfRows() == 1, "it failed"
    far = statistics.GetValueByName(0, "Largest displacement").ToDouble()
    return statistics.GetValueByName(0, "Moved points").ToInt(), round(far, 9)


plate = simple.OpenDataFile(str(DATA / "plate.vtu"))
warp = WarpMesh(registrationName="Warp", Input=plate)  # noqa: F821, defined by the plugin
assert (warp.Motion, warp.Method, warp.MovedPart) == ("Transform", "Hybrid", "Automatic")
assert moved(warp) == (0, 0)

# the transform of the box, of which all of the panel's numbers arrive
warp.Transform.Translate = [0.25, 0.125, 0]
count, far = moved(warp)
assert count == 48 and abs(far - (0.25**2 + 0.125**2) ** 0.5) < 1e-8, (count, far)
assert warp.CellData["Validity"].GetRange() == (1, 1)
warp.Transform.Translate = [0, 0, 0]
warp.Transform.Scale = [2, 2, 2]
assert moved(warp)[0] == 48
warp.Transform.Scale = [1, 1, 1]
warp.Transform = "RotateAroundOriginTransform"
assert moved(warp) == (0, 0)

# numbers
warp.TransformKind, warp.Angle, warp.OwnCenter, warp.Center = "Rotation", 30, 0, [0, 0, 0]
assert moved(warp)[0] == 48
warp.UpdatePropertyInformation()
assert wording("hybrid-all-1913-elements-are-valid") in warp.Summary and warp.Inverted == 0, warp.Summary
assert warp.WorstShape == warp.CellData["TMP shape"].GetRange()[1] > 0
warp.TransformKind, warp.Translation = "Translation", [0, 0.1, 0]
assert moved(warp) == (48, 0.1)
warp.TransformKind, warp.ScaleFactors = "Scaling", [2, 1, 1]
assert moved(warp)[0] > 40
warp.MovedPart, warp.TransformKind, warp.Direction = "Whole boundary", "Bending", [0, 1, 0]
count = moved(warp)[0]
assert count == 90, count  # points before the center are held

# what moves
warp.TransformKind, warp.MovedPart, warp.Parts = "Translation", "Boundary parts by number", [2]
assert moved(warp) == (48, 0.1)
warp.Parts = [1, 2]
everything = moved(warp)[0]
assert everything == 179
marked = simple.Calculator(plate, AttributeType="Point Data", ResultArrayName="side", Function="coordsX>1")
warp.Input = marked
warp.MovedPart, warp.MovedArray = "Values of an array", ["POINTS", "side"]
assert 10 < moved(warp)[0] < 100
warp.Values = [0]
assert 100 < moved(warp)[0] < everything
warp.MovedPart = "Selection"
warp.MovedSelection = simple.IDSelectionSource(FieldType="CELL", IDs=[n for i in range(1913) for n in (0, i)])
assert moved(warp)[0] == everything
warp.FixedSelection = simple.IDSelectionSource(FieldType="POINT", IDs=[n for i in range(1190) for n in (0, i)])
assert moved(warp)[0] == 0
warp.FixedSelection = None

# of blocks, the one that is selected
blocks = simple.GroupDatasets(Input=[plate, plate])
cells = [n for i in range(1913) for n in (1, 0, i)]
part = WarpMesh(Input=blocks, TransformKind="Translation", Translation=[0, 0.1, 0], MovedPart="Selection")  # noqa: F821
part.MovedSelection = simple.CompositeDataIDSelectionSource(FieldType="CELL", IDs=cells)
part.UpdatePipeline()
table = servermanager.Fetch(part, idx=2)
assert [table.GetValueByName(row, "Moved points").ToInt() for row in range(2)] == [179, 0]

# methods, coefficients and their rows
warp.MovedPart = "Inner boundaries"
for method in warp.GetProperty("Method").Available:
    warp.Method = method
    warp.UpdatePipeline()
    assert warp.CellData["Validity"].GetRange() == (1, 1), method
warp.Method = "Anisotropic FEMWARP"
shapes = set()
regions = simple.Calculator(marked, AttributeType="Cell Data", ResultArrayName="region", Function="1")
warp.Input = regions
for choice in ("From the motion, along the axes", "From the motion, principal directions", "One tensor", "Per region"):
    warp.Coefficients, warp.Tensor, warp.RegionArray = choice, [1, 5, 1, 0, 0, 0], ["CELLS", "region"]
    warp.Regions = [0, 1, 1, 1, 1, 7, 1, 1]
    warp.UpdatePipeline()
    shapes.add(round(warp.CellData["TMP shape"].GetRange()[1], 9))
assert len(shapes) >= 3, shapes
warp.AutomaticSolver, warp.Solver, warp.Preconditioner, warp.Tolerance = 0, "GMRES", "ILU(0)", 1e-9
assert moved(warp)[0] == 48

# to where Extract Surface has the mesh, and to a curve
target = simple.Transform(simple.ExtractSurface(plate))
target.Transform.Translate = [0.5, 0, 0]
to = WarpMesh(registrationName="To", Input=plate, Motion="Target data set", Target=target)  # noqa: F821
count, far = moved(to)
assert count == 179 and abs(far - 0.5) < 1e-6, (count, far)
to.UpdatePropertyInformation()
assert wording("the-target-corresponds-as-the-same-mesh") in to.Summary, to.Summary
to.Correspondence = "Closest point"
moved(to)
to.UpdatePropertyInformation()
assert wording("by-projection-48-points") in to.Summary, to.Summary

# by an array, which is found by itself; the amount is animated, and matrices are kept
array = WarpMesh(registrationName="Array", Input=to, Motion="Displacement array")  # noqa: F821
assert list(array.Displacement) == ["POINTS", "Automatic"], array.Displacement[:]
assert moved(array)[0] == 48
array.Displacement = ["POINTS", "Displacement"]
view = simple.CreateView("RenderView")
display = simple.Show(array, view)
assert list(display.ColorArrayName) == ["CELLS", "TMP shape"], display.ColorArrayName[:]
scene = simple.GetAnimationScene()
scene.PlayMode, scene.NumberOfFrames = "Sequence", 5
track = simple.GetAnimationTrack("Amount", proxy=array)
track.KeyFrames = [simple.CompositeKeyFrame(KeyTime=t, KeyValues=[t]) for t in (0.0, 1.0)]
far = []
for frame in range(5):
    scene.AnimationTime = frame / 4
    far.append(moved(array)[1])
    reused = servermanager.Fetch(array, idx=2).GetValueByName(0, "Reused").ToInt()
    assert reused == (frame > 0), (frame, reused)
assert far[0] == 0 and all(abs(far[i] - i * far[4] / 4) < 1e-8 for i in range(5)) and far[4] > 0, far

# files over time: the boundary of each, the interior of the first; the same forwards and backwards
files = []
turning = WarpMesh(Input=plate, TransformKind="Rotation", Method="FEMWARP")  # noqa: F821
for step in range(4):
    turning.Angle = 10 * step
    files.append(str(Path(os.environ["TAUTLINE_TEST_DIR"], f"turning{step}.vtu")))
    simple.SaveData(files[-1], proxy=turning, PointDataArrays=[], CellDataArrays=[], DataMode="Ascii")
over = WarpMesh(Input=simple.OpenDataFile(files), Motion="Time steps of the input", Method="FEMWARP")  # noqa: F821
assert list(simple.GetTimeKeeper().TimestepValues) == [0, 1, 2, 3]
for start in ("First time step", "Previous time step"):
    over.StartFrom = start
    found = {}
    for time in (0, 2, 3, 1, 2, 0, 3):
        over.UpdatePipeline(time)
        displacement = over.PointData["Displacement"].GetRange(-1)[1]
        assert found.setdefault(time, displacement) == displacement, (start, time)
    expected = [found[0] == 0, abs(found[2] - 0.3473) < 1e-3, found[1] < found[2] < found[3]]
    assert all(expected), (start, found)

expected = to.CellData["TMP shape"].GetRange()
simple.SaveState(STATE)
simple.ResetSession()
simple.LoadState(STATE)
again = simple.FindSource("To")
assert (again.Motion, again.Correspondence) == ("Target data set", "Closest point")
again.UpdatePipeline()
assert again.CellData["TMP shape"].GetRange() == expected
other = simple.FindSource("Warp")
assert list(other.Regions) == [0, 1, 1, 1, 1, 7, 1, 1] and list(other.Parts) == [1, 2]
assert other.Transform.__class__.__name__ == "RotateAroundOriginTransform", other.Transform
