# SPDX-License-Identifier: BSD-3-Clause
"""Opening and saving each format as ParaView users do, a series of files, an error with an empty output."""

import os
import shutil
from pathlib import Path

from paraview import simple

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())
DATA = Path(os.environ["TAUTLINE_DATA_DIR"])
OUTPUT = Path(os.environ["TAUTLINE_TEST_DIR"]) / "reader-proxies"
OUTPUT.mkdir(parents=True, exist_ok=True)


def cells(source):
    source.UpdatePipeline()
    return source.GetDataInformation().GetNumberOfCells()


# the factory finds the reader by the ending, and by the content where two formats share one
EXPECTED = {
    "cube.1.ele": 171, "cube.1.node": 171, "quadratic.1.face": 6, "cube.smesh": 6, "box.poly": 7, "plate.poly": 9,
    "zoo.mesh": 5, "zoo.sol": 5, "part.msh": 243, "part22-binary.msh": 243, "tent.msh": 4, "house.off": 7,
}
for name, count in EXPECTED.items():
    found = cells(simple.OpenDataFile(str(DATA / name)))
    assert found == count, (name, found)

# all cells
reader = simple.OpenDataFile(str(DATA / "part.msh"))
reader.LowerCells = 1
assert cells(reader) == 295
assert "Reference" in reader.CellData.keys()

# save and open again
for source, name in ((reader, "saved.msh"), (reader, "saved.mesh"), (reader, "saved.node")):
    simple.SaveData(str(OUTPUT / name), proxy=source)
    again = simple.OpenDataFile(str(OUTPUT / name))
    again.LowerCells = 1
    assert cells(again) == 295, name
house = simple.OpenDataFile(str(DATA / "house.off"))
simple.SaveData(str(OUTPUT / "saved.off"), proxy=house)
assert cells(simple.OpenDataFile(str(OUTPUT / "saved.off"))) == 7

# files of one name are a series in time
for step, name in enumerate(("part.msh", "tent.msh")):
    shutil.copy(DATA / name, OUTPUT / f"step{step}.msh")
series = simple.OpenDataFile([str(OUTPUT / f"step{step}.msh") for step in range(2)])
assert len(series.TimestepValues) == 2
series.UpdatePipeline(series.TimestepValues[1])
assert series.GetDataInformation().GetNumberOfCells() == 4

# the mesh of a case, beside ParaView's reader of its fields; its points written back
case = OUTPUT / "elbow"
shutil.rmtree(case, ignore_errors=True)
shutil.copytree(DATA / "elbow", case)
assert type(simple.OpenDataFile(str(case / "elbow.foam"))).__name__ == "OpenFOAMReader"
elbow = OpenFOAMMeshReader(FileName=str(case / "elbow.foam"))  # noqa: F821
assert cells(elbow) == 506
elbow.UpdatePropertyInformation()
assert elbow.Patches.splitlines()[2] == "2 walls (wall, 232 faces)", elbow.Patches
assert tuple(elbow.CellData["Patch"].GetRange()) == (-1, 2)
points = case / "constant" / "polyMesh" / "points"
before = points.read_bytes()
higher = simple.Transform(Input=elbow)
higher.Transform.Scale = [1, 1, 2]
simple.SaveData(str(case / "elbow.foam"), proxy=higher, KeepOriginal=1)
assert points.with_name("points.orig").read_bytes() == before != points.read_bytes()
again = OpenFOAMMeshReader(FileName=str(case / "elbow.foam"), PatchFaces=0)  # noqa: F821
assert cells(again) == 200 and again.GetDataInformation().GetBounds() == (0, 2, 0, 2, 0, 2)

# an error leaves an empty output
(OUTPUT / "broken.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n")
broken = simple.OpenDataFile(str(OUTPUT / "broken.off"))
assert cells(broken) == 0
