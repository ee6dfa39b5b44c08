# SPDX-License-Identifier: BSD-3-Clause
"""Files that come back with new coordinates and are otherwise the same, byte by byte: write(template), the shell."""

import re
import shutil
import struct
import subprocess
import sys
import warnings
from importlib.util import find_spec

import numpy as np
import tautline as tl
from checks import DATA, OUT, points, rejected, run_tests, shell, wording
from tautline import _io
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
MFEM = """MFEM mesh v1.0
# vertices
dimension
2
elements
4
1 2 0 1 4
1 2 1 2 4
2 2 2 3 4
2 2 3 0 4
boundary
1
7 1 0 1

vertices
5
2
0 0
1 0
1 1
0 1
0.4 0.5
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
UNV = """    -1
   164
         1Meter               2
    1.0000000000000000D+00    1.0000000000000000D+00
    -1
    -1
  2411
         1         1         1        11
   0.0000000000000000D+00   0.0000000000000000D+00   0.0000000000000000D+00
         2         1         1        11
   1.0000000000000000D+00   0.0000000000000000D+00   0.0000000000000000D+00
         3         1         1        11
   1.0000000000000000D+00   1.0000000000000000D+00   0.0000000000000000D+00
        40         1         1        11
   0.0000000000000000D+00   1.0000000000000000D+00   0.0000000000000000D+00
         5         1         1        11
   4.0000000000000002D-01   5.0000000000000000D-01   0.0000000000000000D+00
    -1
    -1
  2412
         7        21         2         1         7         2
         0         1         1
         1         2
        11        41         3         1         7         3
         1         2         5
        12        41         3         1         7         3
         2         3         5
        13        41         3         1         7         3
         3        40         5
        14        41         3         1         7         3
        40         1         5
    -1
    -1
  2467
         1         0         0         0         0         0         0         3
wall and more
         8        11         0         0         8         7         0         0
         7         1         0         0
    -1
"""
FILES = {
    "v2.msh": MSH2, "v41.msh": MSH41, "a.mesh": MEDIT, "m.mesh": MFEM, "a.su2": SU2, "a.off": OFF, "a.inp": ABAQUS,
    "a.bdf": NASTRAN, "a.unv": UNV,
}  # fmt: skip
#: The text in place of the coordinates of the inner point: patterns, with a group for each.
INNER = {
    "v2.msh": r"\n5 (\S+) (\S+) 0\n\$EndNodes", "v41.msh": r"\n5\n(\S+) (\S+) 0\n", "a.mesh": r"\n(\S+) (\S+) 0\nTri",
    "m.mesh": r"\n(\S+) (\S+)\n$",
    "a.su2": r"\n\t(\S+) \t(\S+) \t4\n", "a.off": r"\n(\S+) (\S+) 0 # inside", "a.inp": r"5,( +\S+),( +\S+),  0.\n",
    "a.unv": r"\n {9}5 [ 0-9]*\n {3}(\S+) {3}(\S+) {3}0.0000000000000000D",
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


def test_other_systems():
    """Points that the file has in other coordinates than the mesh: the error names the reason and a remedy."""
    source, target = FOLDER / "moved.bdf", FOLDER / "out-moved.bdf"
    target.unlink(missing_ok=True)
    system = "CORD2R         7       0      5.      0.      0.      5.      0.      1.\n"
    system += "              6.      0.      0.\n"
    grid = "GRID           6       7      0.      0.      0.\n"
    cell = "CTRIA3        99       1       1       2       6\n"
    source.write_text(NASTRAN.replace("ENDDATA", system + grid + cell + "ENDDATA"))
    mesh = tl.read(source)
    assert points(mesh)[:, 0].max() == 5, points(mesh)
    rejected(wording("in-the-basic-system"), tl.write, mesh, target, template=source)
    source, target = FOLDER / "moved.inp", FOLDER / "out-moved.inp"
    part = "*Part, name=A\n*Node\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 1., 1., 0.\n*Element, type=CPS3\n1, 1, 2, 3\n"
    part += "*End Part\n"
    placed = [f"*Instance, name=A-{i}, part=A\n {i}., 0., 0.\n*End Instance\n" for i in (1, 2)]
    for instances in (placed[0], "".join(placed)):
        source.write_text(f"*Heading\n{part}*Assembly, name=Assembly\n{instances}*End Assembly\n")
        rejected(wording("without-parts-and-assemblies"), tl.write, tl.read(source), target, template=source)


def test_parametric():
    """Gmsh's nodes with parametric coordinates, as text and binary: the same mesh; text comes back as it was."""
    rows = "1 0 0 0 0 1\n2 1 0 0 0 2\n3 1 1 0 1 5 .5\n40 0 1 0 2 6 .25 .75\n5 .4 .5 0 3 1\n"
    nodes = MSH2[MSH2.index("$Nodes") : MSH2.index("$Elements")]
    text = MSH2.replace(nodes, f"$ParametricNodes\n5\n{rows}$EndParametricNodes\n")
    source, target = FOLDER / "parametric.msh", FOLDER / "out-parametric.msh"
    source.write_text(text)
    tl.write(moved(source), target, template=source)
    assert target.read_text() == text.replace("5 .4 .5 0 3 1", f"5 {1 / 3!r} {2 / 3!r} 0 3 1")
    content = b"$MeshFormat\n2.2 1 8\n" + struct.pack("<i", 1) + b"\n$EndMeshFormat\n$ParametricNodes\n5\n"
    for row in rows.splitlines():
        words = row.split()
        content += struct.pack("<i3d2i", int(words[0]), *map(float, words[1:4]), *map(int, words[4:6]))
        content += b"".join(struct.pack("<d", float(word)) for word in words[6:])
    content += b"\n$EndParametricNodes\n$Elements\n1\n" + struct.pack("<9i", 2, 1, 2, 7, 2, 1, 1, 2, 5)
    source.write_bytes(content + b"\n$EndElements\n")
    mesh = tl.read(source)
    assert np.array_equal(points(mesh)[3:], [[0, 1, 0], [0.4, 0.5, 0]]) and mesh.GetNumberOfCells() == 1
    rejected(wording("parametric-nodes"), tl.write, mesh, target, template=source)
    source.write_text(text.replace("40 0 1 0 2 6 .25 .75", "40 0 1 0 2 6 .25"))
    rejected("parametric.msh:", tl.read, source)


def meshb(version: int, order: str) -> bytes:
    """A binary file of Medit, in two dimensions: the square of the text files, an edge and a section not read."""
    whole, position = ("q" if version >= least else "i" for least in (4, 3))
    real = "f" if version == 1 else "d"
    content = struct.pack(f"{order}2i", 1, version)

    def section(code: int, data: bytes) -> None:
        nonlocal content
        end = len(content) + struct.calcsize(f"={position}") + 4 + len(data)
        content += struct.pack(f"{order}i{position}", code, end) + data

    def records(layout: str, rows: list) -> bytes:
        return struct.pack(f"{order}{whole}", len(rows)) + b"".join(struct.pack(order + layout, *row) for row in rows)

    section(3, struct.pack(f"{order}i", 2))
    section(4, records(2 * real + whole, [(0, 0, 7), (1, 0, 8), (1, 1, 9), (0, 1, 9), (0.375, 0.5, 6)]))
    section(20, records(2 * whole, [(1, 1)]))
    section(6, records(4 * whole, [(1, 2, 5, 1), (2, 3, 5, 1), (3, 4, 5, 2), (4, 1, 5, 2)]))
    section(5, records(3 * whole, [(1, 2, 4)]))
    return content + struct.pack(f"{order}i{position}", 54, 0)


def test_meshb():
    """Binary files of Medit: only the coordinates of the inner point change, rounded where the file has 4 bytes."""
    source, target = FOLDER / "a.meshb", FOLDER / "out.meshb"
    for version in (1, 2, 3, 4):
        for order in "<>":
            content = meshb(version, order)
            source.write_bytes(content)
            mesh = tl.read(source)
            assert (mesh.GetNumberOfPoints(), mesh.GetNumberOfCells()) == (5, 4), (version, order)
            mesh.GetPoints().SetPoint(4, 1 / 3, 2 / 3, 0)
            with warnings.catch_warnings(record=True) as told:
                warnings.simplefilter("always")
                tl.write(mesh, target, template=source)
            assert len(told) == (version == 1), [str(one.message) for one in told]
            real = struct.Struct(f"{order}2{'f' if version == 1 else 'd'}")
            assert target.read_bytes() == content.replace(real.pack(0.375, 0.5), real.pack(1 / 3, 2 / 3)) != content
    mesh.GetPoints().SetPoint(4, 0.4, 0.5, 0.1)
    rejected(wording("leaves-the-plane"), tl.write, mesh, target, template=source)
    mesh.GetPoints().SetPoint(4, 1e300, 0.5, 0)
    source.write_bytes(meshb(1, "<"))
    rejected(wording("too-large-for-its-numbers"), tl.write, mesh, target, template=source)


def test_rejected():
    """A file other than the one that was read is rejected, and nothing is written."""
    source, target = FOLDER / "v2.msh", FOLDER / "rejected.msh"
    source.write_text(MSH2)
    mesh = moved(source)
    target.unlink(missing_ok=True)
    rejected(wording("of-another-format"), tl.write, mesh, target, template=DATA / "bracket.vtu")
    rejected(wording("no-other-options"), tl.write, mesh, target, template=source, binary=True)
    rejected("v2.msh", tl.write, tl.domain("square"), target, template=source)
    mesh.GetPoints().SetPoint(4, np.nan, 0, 0)
    rejected(wording("coordinate-is-not-finite"), tl.write, mesh, target, template=source)
    source.write_text(MSH2.replace("8 2 2 2 1 40 1 5", "8 2 2 2 1 1 5 40"))
    rejected(wording("has-other-cells"), tl.write, moved(source), target, template=FOLDER / "v41.msh")
    rejected(wording("cannot-be-templates"), tl.write, mesh, FOLDER / "a.ply", template=FOLDER / "b.ply")
    assert not target.exists()
    flat = FOLDER / "flat.su2"
    flat.write_text(SU2)
    mesh = moved(flat)
    mesh.GetPoints().SetPoint(4, 0.4, 0.5, 0.1)
    rejected(wording("leaves-the-plane"), tl.write, mesh, FOLDER / "rejected.su2", template=flat)


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
            for word in ("wall", "Meter", "RequiredVertices", "*MATERIAL", "PSHELL", "# inside", "kept"):
                assert (word in text) == (word in target.read_text()), (command, name, word)
        assert np.allclose(points(tl.read(FOLDER / f"optimize-{name}"))[4], (0.5, 0.5, 0), atol=1e-3), name


def test_without_meshio():
    """A file whose coordinates are replaced needs no meshio; where they cannot be, the error names the reason."""
    source, target, check = FOLDER / "alone.inp", FOLDER / "alone-moved.inp", _io.check_installed
    source.write_text(ABAQUS)

    def missing(name: str) -> None:
        raise tl.Error("meshio is missing")

    _io.check_installed = missing
    try:
        tl.write(tl.optimize(source), target)
        assert len(target.read_text().splitlines()) == len(source.read_text().splitlines())
        rejected(wording("points-are-those-of-parts"), tl.write, tl.untangle(DATA / "beam.inp"), target)
    finally:
        _io.check_installed = check


def test_losses():
    """Improve changes cells: the file is written without the template, and the missing parts are listed."""
    source = FOLDER / "improve.msh"
    source.write_text(MSH2)
    command = [sys.executable, "-m", "tautline", "improve", source, "-o", FOLDER / "improved.msh"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0 and f"lacks 4 boundary cells and their groups of {source}" in done.stderr, done
    assert '"fluid"' in (FOLDER / "improved.msh").read_text()


run_tests(globals())
