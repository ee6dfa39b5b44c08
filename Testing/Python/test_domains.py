"""The verbs read, write and domain: results, files, exceptions."""

import argparse
import os
from pathlib import Path

import tautline
from tautline import _inputs as tl
from tautline import _io

DATA = Path(os.environ["TAUTLINE_DATA_DIR"])
OUTPUT = Path(os.environ["TAUTLINE_TEST_DIR"]) / "inputs"
OUTPUT.mkdir(parents=True, exist_ok=True)


def error(function, *arguments, **keywords):
    try:
        function(*arguments, **keywords)
    except tl.Error as raised:
        return str(raised)
    raise AssertionError(f"{function.__name__}{arguments} raised nothing")


cube = tl.read(DATA / "cube.1.node")
assert cube.GetNumberOfCells() == 171
everything = tl.read(DATA / "cube.1.node", lower_cells=True)
assert everything.GetNumberOfCells() > 171 + 132

# every ending that can be written comes back with as many points and cells
surface = tl.read(DATA / "house.off")
for ending in (".node", ".mesh", ".msh"):
    files = tl.write(cube, OUTPUT / f"cube{ending}")
    assert files and all(Path(file).is_file() for file in files), files
    again = tl.read(OUTPUT / f"cube{ending}")
    assert (again.GetNumberOfPoints(), again.GetNumberOfCells()) == (73, 171), ending
for ending in (".off", ".smesh"):
    tl.write(surface, OUTPUT / f"house{ending}")
    assert tl.read(OUTPUT / f"house{ending}").GetNumberOfCells() == 7, ending
text, binary = (OUTPUT / name for name in ("text.msh", "binary.msh"))
tl.write(cube, text)
tl.write(cube, binary, binary=True)
assert b"4.1 0 8" in text.read_bytes() and b"4.1 1 8" in binary.read_bytes()

# the verbs of the package hand these endings on
assert _io.write(cube, OUTPUT / "verb.msh", binary=True) and _io.read(OUTPUT / "verb.msh").GetNumberOfCells() == 171
assert _io.read(DATA / "cube.1.ele", lower_cells=True).GetNumberOfCells() > 171

(OUTPUT / "broken.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n")
assert error(tl.read, OUTPUT / "broken.off").endswith("broken.off:6: vertex is 7, from 0 to 2 are allowed")
assert "cannot be opened" in error(tl.read, OUTPUT / "none.msh")
assert "no reader for '.docx'" in error(tl.read, "thesis.docx")
assert "no writer for '.docx'" in error(tl.write, cube, "thesis.docx")
assert "171 tetrahedra" in error(tl.write, cube, OUTPUT / "cube.poly")
assert "tetrahedra" in error(tl.write, cube, OUTPUT / "cube.off")
assert "cannot be written" in error(tl.write, cube, OUTPUT / "no" / "such" / "folder.mesh")
assert "not a int" in error(tl.write, 7, OUTPUT / "seven.mesh")
assert "always text" in error(tl.write, cube, OUTPUT / "cube.mesh", binary=True)

assert len(tl.domains()) == 17
square = tl.domain("square", element_size=0.1, aspect_ratio=4, collar_width=0.2)
assert square.GetNumberOfCells() == 392
assert square.GetCellData().GetArray("Reference").GetRange() == (1, 2)
assert "there is no domain 'torus'; there are wrench, hinge" in error(tl.domain, "torus")
assert "negative" in error(tl.domain, "wrench", -1)
assert "whole numbers" in error(tl.domain, "square", aspect_ratio=2)
if tautline.vtkDomainSource.HasMeshing():
    cylinder = tl.domain("cylinder", cells=5000, amount=0.5)
    assert abs(cylinder.GetNumberOfCells() - 5000) < 250
    assert cylinder.GetPointData().GetArray("Displacement").GetRange(0) == (0.0, 0.3)
    moved = tl.domain("cylinder", cells=5000, amount=0.5, deformed_boundary=True)
    assert moved.GetNumberOfLines() > 0 and moved.GetNumberOfPoints() == cylinder.GetNumberOfPoints()
else:
    assert "TAUTLINE_MESHING=OFF" in error(tl.domain, "cylinder")

# the command line
parser = argparse.ArgumentParser(prog="tautline")
tl.add_commands(parser.add_subparsers(required=True))
arguments = parser.parse_args(["domain", "rectangle", "--cells", "400", "-o", str(OUTPUT / "rectangle.msh")])
assert arguments.run(arguments) == 0 and tl.read(OUTPUT / "rectangle.msh").GetNumberOfCells() == 400
arguments = parser.parse_args(["convert", str(DATA / "part.msh"), str(OUTPUT / "part.mesh"), "--lower-cells"])
assert arguments.run(arguments) == 0 and tl.read(OUTPUT / "part.mesh", lower_cells=True).GetNumberOfCells() == 295
for wrong in (["domain", "torus", "-o", "x.msh"], ["domain", "wrench"], ["domain", "wrench", "--cells", "many"]):
    try:
        parser.parse_args(wrong)
    except SystemExit as stopped:
        assert stopped.code == 2  # usage error
    else:
        raise AssertionError(wrong)
