# SPDX-License-Identifier: BSD-3-Clause
"""Files that come back with new coordinates and are otherwise the same, byte by byte: write(template), the shell."""

import re
import shutil
import subprocess
import sys
import warnings
from importlib.util import find_spec

import numpy as np
import tautline as tl
from checks import DATA, OUT, points, refused, run_tests, shell, wording
from tautline._template import _nastran, _value

FOLDER = OUT / "templates"
FOLDER.mkdir(exist_ok=True)
#: A square of four triangles with a point inside, as every format has it. @ is x y z of that point.
MSH2 = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
1 1 "wall"
2 2 "fluid"
$EndPhysicalNames
$Nodes
5
1 0 0 0
2  1.0  0 0
3 1 1 0
40 0 1 0
5 .4 .5 0
$EndNodes
$Elements
8
1 1 2 1 1 1 2
2 1 2 1 1 2 3
3 1 2 1 1 3 40
4 1 2 1 1 40 1
5 2 2 2 1 1 2 5
6 2 2 2 1 2 3 5
7 2 2 2 1 3 40 5
8 2 2 2 1 40 1 5
$EndElements
$Comments
kept
$EndComments
"""
MSH41 = """$MeshFormat
4.1 0 8
$EndMeshFormat
$Nodes
2 5 1 5
1 1 1 4
1
2
3
4
0 0 0 0.1
1 0 0 0.2
1 1 0 0.3
0 1 0 0.4
2 1 0 1
5
0.4 0.5 0
$EndNodes
$Elements
1 4 1 4
2 1 2 4
1 1 2 5
2 2 3 5
3 3 4 5
4 4 1 5
$EndElements
"""
MEDIT = """MeshVersionFormatted 2
# Vertices 7 in a comment
Dimension 2
Vertices 5
0 0 3
1 0 3 1 1 3
0 1 3
0.400000 0.500000 0
Triangles 4
1 2 5 1
2 3 5 1
3 4 5 2
4 1 5 2
RequiredVertices 1
1
End
"""
SU2 = """NDIME= 2
NELEM= 4
5 0 1 4 0
5 1 2 4 1
5 2 3 4 2
5 3 0 4 3
NPOIN= 5 % inside last
\t0.0000000000e+00 \t0.0000000000e+00 \t0
\t1.0000000000e+00 \t0.0000000000e+00 \t1
\t1.0000000000e+00 \t1.0000000000e+00 \t2
\t0.0000000000e+00 \t1.0000000000e+00 \t3
\t4.0000000000e-01 \t5.0000000000e-01 \t4
NMARK= 1
MARKER_TAG= wall
MARKER_ELEMS= 1
3 0 1
"""
OFF = """OFF # a comment
5 4 0
0 0 0
1 0 0
1 1 0
0 1 0
.4 .5 0 # inside
3 0 1 4
3 1 2 4
3 2 3 4
3 3 0 4
"""
ABAQUS = """*HEADING
** 5, 0.4, 0.5
*NODE, NSET=NALL
1, 0., 0., 0.
2, 1., 0., 0.
3, 1., 1., 0.
4, 0., 1., 0.
      5,          0.4,         0.50,  0.
*ELEMENT, TYPE=CPS3, ELSET=EALL
1, 1,2,5
2, 2,3,5
3, 3,4,5
4, 4,1,5
*NSET, NSET=FIX, GENERATE
1, 4, 1
*MATERIAL, NAME=STEEL
*ELASTIC
210000., .3
*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL
*BOUNDARY
FIX, 1, 3
"""
NASTRAN = """$ a comment
SOL 101
BEGIN BULK
GRID    1               0.0     0.0     0.0             123456
GRID    2               1.0     0.0     0.0
GRID    3               1.0     1.0     0.0
GRID    4               0.0     1.0     0.0
GRID*                  5                             0.4             0.5
*                    0.0
CTRIA3  1       1       1       2       5
CTRIA3  2       1       2       3       5
CTRIA3  3       1       3       4       5
CTRIA3  4       1       4       1       5
PSHELL  1       1       0.1
MAT1    1       2.1+5           0.3
ENDDATA
"""
FILES = {
    "v2.msh": MSH2, "v41.msh": MSH41, "a.mesh": MEDIT, "a.su2": SU2, "a.off": OFF, "a.inp": ABAQUS, "a.bdf": NASTRAN,
}  # fmt: skip
#: What stands where the coordinates of the inner point were: patterns, with a group for each.
INNER = {
    "v2.msh": r"\n5 (\S+) (\S+) 0\n\$EndNodes", "v41.msh": r"\n5\n(\S+) (\S+) 0\n", "a.mesh": r"\n(\S+) (\S+) 0\nTri",
    "a.su2": r"\n\t(\S+) \t(\S+) \t4\n", "a.off": r"\n(\S+) (\S+) 0 # inside", "a.inp": r"5,( +\S+),( +\S+),  0.\n",
    "a.bdf": r"\nGRID\* {18}5 {16}(.{16})(.{16})\n",
}  # fmt: skip
MESHIO = find_spec("meshio") is not None


def readable() -> dict[str, str]:
    here = {form["ending"] for form in tl.formats() if form["read"]}
    return {name: text for name, text in FILES.items() if name[name.index(".") :] in here}


def moved(file):
    """The mesh of a file with its inner point at other coordinates, which need many digits."""
    mesh = tl.read(file)
    copy = mesh.NewInstance()
    copy.DeepCopy(mesh)
    assert np.allclose(copy.GetPoint(4), (0.4, 0.5, 0), atol=1e-15), file
    copy.GetPoints().SetPoint(4, 1 / 3, 2 / 3, 0)
    return copy


def test_every_format():
    """Only the two numbers change; written back again, the file is the first one or has them in full."""
    for name, text in readable().items():
        source, target = FOLDER / name, FOLDER / f"out-{name}"
        source.write_text(text)
        assert tl.write(moved(source), target, template=source) == [str(target)]
        found = target.read_text()
        numbers = re.search(INNER[name], found)
        assert numbers, (name, found)
        digits = 1e-10 if name in ("a.su2", "a.bdf") else 1e-16
        values = [_value(number.encode()) for number in numbers.groups()]
        assert np.allclose(values, (1 / 3, 2 / 3), rtol=0, atol=digits), (name, values)
        rest = [re.sub(INNER[name], lambda match: match[0].replace(match[1], "@").replace(match[2], "@"), content)
                for content in (found, text)]  # fmt: skip
        assert rest[0] == rest[1], name
        assert np.allclose(points(tl.read(target))[4], (1 / 3, 2 / 3, 0), atol=digits)
        tl.write(tl.read(source), target, template=source)
        assert target.read_text() == text, name


def test_layout():
    """Numbers in columns stay in their columns."""
    source = FOLDER / "columns.su2"
    source.write_text(SU2)
    mesh = moved(source)
    mesh.GetPoints().SetPoint(4, -1 / 3, 2e120, 0)
    tl.write(mesh, FOLDER / "out.su2", template=source)
    assert "\n\t-3.3333333333e-01 \t2.0000000000e+120 \t4\n" in (FOLDER / "out.su2").read_text()


def test_nastran_numbers():
    for value, width, text in ((1 / 3, 8, ".3333333"), (-1 / 3, 8, "-.333333"), (1e-7 / 3, 8, "3.3333-8"),
                               (1.0, 8, "1."), (-123456.7, 8, "-123457."), (1.25e300, 8, "1.25+300"),
                               (2 / 3, 16, ".666666666666667"), (-2.5e-9, 16, "-2.5-9")):  # fmt: skip
        found = _nastran(value, b" " * width).decode()
        assert len(found) == width and np.isclose(_value(found.encode()), value, rtol=1e-4), (value, found)
        assert abs(_value(found.encode()) - value) <= abs(_value(text.encode()) - value), (value, found)
    for text, value in (("1.5+3", 1500), ("-1.5-3", -0.0015), ("2.D1", 20), ("", 0), (" .5 ", 0.5), ("1E2", 100)):
        assert _value(text.encode()) == value


def test_small_fields():
    """Coordinates that eight characters round are announced."""
    if not MESHIO:
        return
    source = FOLDER / "small.bdf"
    source.write_text(re.sub(r"GRID\*.*\n\*.*\n", "GRID    5               .4      .5      0.0\n", NASTRAN))
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        tl.write(moved(source), FOLDER / "out.bdf", template=source)
    assert "GRID    5               .3333333.6666667" in (FOLDER / "out.bdf").read_text()
    assert len(told) == 1 and wording("round-coordinates") in str(told[0].message), told


def test_gmsh():
    """Files of Gmsh itself, text and binary, of versions 2 and 4.1, with a solid of several entities."""
    if not shutil.which("gmsh"):
        return
    (FOLDER / "part.geo").write_text(
        'SetFactory("OpenCASCADE"); Box(1) = {0, 0, 0, 1, 1, 1}; Box(2) = {1, 0, 0, 1, 1, 1}; Coherence;'
        'Mesh.MeshSizeMax = 0.4; Physical Volume("solid") = {1};\n'
    )
    for version in ("22", "41"):
        for binary in ([], ["-bin"]):
            file = FOLDER / "part.msh"
            command = ["gmsh", "-3", FOLDER / "part.geo", "-format", f"msh{version}", *binary, "-o", file]
            subprocess.run(command, check=True, capture_output=True)
            result = tl.perturb(file, fraction=0.5)
            tl.write(result, FOLDER / "back.msh", template=file)
            assert np.array_equal(points(tl.read(FOLDER / "back.msh")), points(result.mesh)), (version, binary)
            tl.write(tl.read(file), FOLDER / "again.msh", template=FOLDER / "back.msh")
            one, two = (tl.read(FOLDER / name, lower_cells=True) for name in ("again.msh", "part.msh"))
            assert np.array_equal(points(one), points(two)) and one.GetNumberOfCells() == two.GetNumberOfCells()
            if binary:
                size = file.stat().st_size
                assert (FOLDER / "back.msh").stat().st_size == size


def test_refused():
    """What is not the file that was read is refused, and nothing is written."""
    source, target = FOLDER / "v2.msh", FOLDER / "refused.msh"
    source.write_text(MSH2)
    mesh = moved(source)
    target.unlink(missing_ok=True)
    refused(wording("of-another-format"), tl.write, mesh, target, template=DATA / "bracket.vtu")
    refused(wording("no-other-options"), tl.write, mesh, target, template=source, binary=True)
    refused("v2.msh", tl.write, tl.domain("square"), target, template=source)
    mesh.GetPoints().SetPoint(4, np.nan, 0, 0)
    refused(wording("coordinate-is-not-finite"), tl.write, mesh, target, template=source)
    source.write_text(MSH2.replace("8 2 2 2 1 40 1 5", "8 2 2 2 1 1 5 40"))
    refused(wording("has-other-cells"), tl.write, moved(source), target, template=FOLDER / "v41.msh")
    refused(wording("cannot-be-templates"), tl.write, mesh, FOLDER / "a.ply", template=FOLDER / "b.ply")
    assert not target.exists()
    flat = FOLDER / "flat.su2"
    flat.write_text(SU2)
    mesh = moved(flat)
    mesh.GetPoints().SetPoint(4, 0.4, 0.5, 0.1)
    refused(wording("leaves-the-plane"), tl.write, mesh, FOLDER / "refused.su2", template=flat)


def test_vtk():
    """Files of VTK keep what they hold, without the arrays of the result."""
    result = tl.perturb(DATA / "bracket.vtu", fraction=0.3)
    tl.write(result, FOLDER / "bracket.vtu", template=DATA / "bracket.vtu")
    found, known = tl.read(FOLDER / "bracket.vtu"), tl.read(DATA / "bracket.vtu")
    assert np.array_equal(points(found), points(result.mesh)) and not np.array_equal(points(found), points(known))
    assert found.GetPointData().GetNumberOfArrays() == known.GetPointData().GetNumberOfArrays()
    assert found.GetCellData().GetNumberOfArrays() == known.GetCellData().GetNumberOfArrays()


def test_shell():
    """The moving commands write the file that was read with new coordinates."""
    for name, text in readable().items():
        source = FOLDER / name
        source.write_text(text)
        for command in ("optimize", "untangle", "perturb") if name == "v2.msh" else ("optimize",):
            target = FOLDER / f"{command}-{name}"
            shell(command, source, "-o", target)
            assert len(target.read_text().splitlines()) == len(text.splitlines()), (command, name)
            for word in ("wall", "RequiredVertices", "*MATERIAL", "PSHELL", "# inside", "kept"):
                assert (word in text) == (word in target.read_text()), (command, name, word)
        assert np.allclose(points(tl.read(FOLDER / f"optimize-{name}"))[4], (0.5, 0.5, 0), atol=1e-3), name


def test_losses():
    """Improve changes cells: the file is written anew, and what it lacks is listed."""
    source = FOLDER / "improve.msh"
    source.write_text(MSH2)
    command = [sys.executable, "-m", "tautline", "improve", source, "-o", FOLDER / "improved.msh"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0 and f"lacks 4 boundary cells and their groups of {source}" in done.stderr, done
    assert '"fluid"' in (FOLDER / "improved.msh").read_text()


run_tests(globals())
