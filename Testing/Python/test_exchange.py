# SPDX-License-Identifier: BSD-3-Clause
"""Files of solvers through VTK's readers and meshio, time steps, meshio's objects, the table of formats."""

import base64
import gzip
import re
import shutil
import subprocess
import sys
import warnings
import zlib
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import tautline as tl
from checks import DATA, OUT, points, rejected, run_tests, shell, square, wording
from tautline._meshio import MESHIO_FORMATS
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList, vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_POLYHEDRON, vtkMultiBlockDataSet, vtkUnstructuredGrid

BRACKET = DATA / "bracket.vtu"
FOLDER = OUT / "exchange"
FOLDER.mkdir(exist_ok=True)
UCD = """# a comment
4 1 1 1 0
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
1 7 tet 1 2 3 4
1 1
height, m
1 0
2 0
3 0
4 1
1 1
density, kg
1 2.5
"""
ENSIGHT_CASE = """FORMAT
type: ensight gold
GEOMETRY
model: 1 run*.geo
TIME
time set: 1
number of steps: 2
filename start number: 0
filename increment: 1
time values: 0.5 2.0
"""
ENSIGHT_GEO = """a mesh
of one tetrahedron
node id off
element id off
part
         1
part one
coordinates
         4
{x}
 1.00000e+00
 0.00000e+00
 0.00000e+00
 0.00000e+00
 0.00000e+00
 1.00000e+00
 0.00000e+00
 0.00000e+00
 0.00000e+00
 0.00000e+00
 1.00000e+00
tetra4
         1
         1         2         3         4
"""


SU2_CUBE = """% a comment
NDIME = 3
NZONE= 1
NELEM= 2 % of two kinds
12 0 1 2 3 4 5 6 7 0
14 4 5 6 7 8 1
NPOIN= 9 9 0
0 0 0 0
1 0 0 1
1 1 0 2
0 1 0 3
0 0 1 4
1 0 1 5
1 1 1 6
0 1 1 7
0.5 0.5 2.5 8
NMARK= 2
MARKER_TAG= lower wall
MARKER_ELEMS= 1
9 0 3 2 1
MARKER_TAG= 7x
MARKER_ELEMS= 2
5 4 5 8
5 5 6 8
"""


def same(one, other) -> None:
    """The same points and cells, up to single precision."""
    assert np.allclose(points(one), points(other), atol=1e-6)
    assert one.GetNumberOfCells() == other.GetNumberOfCells()
    for cell in range(0, one.GetNumberOfCells(), 97):
        ids = [[mesh.GetCell(cell).GetPointId(k) for k in range(4)] for mesh in (one, other)]
        assert ids[0] == ids[1] and one.GetCellType(cell) == other.GetCellType(cell)


def test_exodus():
    from vtkmodules.vtkIOExodus import vtkExodusIIWriter

    grid = vtkUnstructuredGrid()
    grid.DeepCopy(tl.read(BRACKET))
    values = numpy_to_vtk(np.arange(grid.GetNumberOfPoints(), dtype=float), deep=True)
    values.SetName("load")
    grid.GetPointData().AddArray(values)
    writer = vtkExodusIIWriter()
    writer.SetFileName(str(FOLDER / "run.e"))
    writer.SetInputData(grid)
    writer.Write()
    mesh = tl.read(FOLDER / "run.e")
    same(mesh, grid)
    assert np.allclose(vtk_to_numpy(mesh.GetPointData().GetArray("load")), np.arange(grid.GetNumberOfPoints()))
    assert tl.quality(mesh).inverted == 0
    assert tl.times(FOLDER / "run.e") in ([], [0.0])
    (FOLDER / "broken.e").write_bytes((FOLDER / "run.e").read_bytes()[:5000])
    rejected("broken.e: ", tl.read, FOLDER / "broken.e")


#: A file of the older kind of CGNS, ADF, of four tetrahedra, written by the library of CGNS, compressed.
ADF = (
    "eNrtWNFumzAUZe36sq/wD1SyjQOkD+tcAlWlNA8tm9a+TKS4G1JnJiDVsj/ZXvey/cX+YT/ST5jdksQBgpG6RlHKiRLA9wbsc88Bmz+/fv6m"
    "Ax8MwjwchxkD71iaxQkHFGKI0Gsa+fA8zMEouQXYARgfQPvAtAGG2AICIo40cTw8Er8mROKMBDr3X+UjYgTOgCCd71nInLfDI7pIgVD8p3ft"
    "jnO17TH7/lXORsmASSZOk/wTS0dJxEAFZ0kihypCyTWQyX58o6YVp8TF1plfBPvWaQAaAdcKOeogjIdy1O7x6HwYj9Mwnc6qv4Rq/EPepufy"
    "GmdEM2pUU5KnGOwDiEXlqM9HwVhps3QMLOoolChd0qaOxMETPslYBBjP0ymIOcgm430u5LMvzCaFo3Zwm3MzHniDMAgX3Njej+8XbyKPD6QC"
    "dZzK+sicZd1VOEcV31kOPWmrQLwWBfZsRypwiY1eH+4ahiG/M0YuE97IiIyvYkNhxKww0kdEywgu9dp8UkZs36t40vapjgGFPdL57D940kF0"
    "TyjwpfEAVYnB9AtrUqKMa7xZKwAXtfSmuxZvUsepKJE6RMeAwqB3nMaRmyRpFPMwZ9nqXEqdgOVZC4UjiEz8rJRIKXnLszydXOWTlEUzJeq4"
    "LcUrglx5T3T7ZINnZ/MRva/tmZy50zQNpysM2Dg7c1r6r7cW/3mw6j8PEh0Di0VC31vkXjTnekQ576V2VvGs/OcRaCzh7tAowbzH38OZN3W8"
    "b5FKfZNWZnC+jY1aLJhTGfu2MViu3eV2105sfatUO/F0xZ7RiLvDstp1T27vhn0W1ss0c6LyewIETXOz1isIYuxUGMMEvirNEosRn4X8Y+08"
    "6YRH7Ot9tJ6Tpo5sGCOEltcrso3qGFDYI0Wum3DOrvL4Ns6n9bnEpd16pfYpJbmxXhTrlZIKV/L6mDtZWxUiuBYV9lxY8aWFoGRkp3iXIFdz"
    "M4Z2iuOd4liN7xZtewWToEOHDh06dOjQocPW4h/1J1GW"
)  # fmt: skip


def test_adf():
    """CGNS of the older kind is read like the newer one; a file that is cut is an error."""
    content = zlib.decompress(base64.b64decode(ADF))
    file = FOLDER / "old.cgns"
    file.write_bytes(content)
    mesh = tl.read(file)
    assert mesh.GetNumberOfCells() == 4 and mesh.GetPoint(4) == (0.3, 0.3, 0.3)
    for size in (100, 1500, 4000):
        (FOLDER / "cut.cgns").write_bytes(content[:size])
        rejected("cut.cgns: ", tl.read, FOLDER / "cut.cgns")


def foam(folder):
    """A case of OpenFOAM of two cubes, with a field p that cannot be read."""

    def write(name: str, kind: str, text: str) -> None:
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        head = f"FoamFile\n{{\n version 2.0;\n format ascii;\n class {kind};\n object {file.name};\n}}\n"
        file.write_text(head + text)

    def listed(rows: list) -> str:
        return f"{len(rows)}\n(\n" + "\n".join(rows) + "\n)\n"

    corners = [f"({x} {y} {z})" for z in range(3) for y in range(2) for x in range(2)]
    faces = [(4, 5, 7, 6), (0, 2, 3, 1), (8, 9, 11, 10)]
    for b in (0, 4):
        faces += [(b, b + 1, b + 5, b + 4), (b + 1, b + 3, b + 7, b + 5), (b + 3, b + 2, b + 6, b + 7),
                  (b + 2, b, b + 4, b + 6)]  # fmt: skip
    write("constant/polyMesh/points", "vectorField", listed(corners))
    write("constant/polyMesh/faces", "faceList", listed([f"4({' '.join(map(str, face))})" for face in faces]))
    write("constant/polyMesh/owner", "labelList", listed(list("00100001111")))
    write("constant/polyMesh/neighbour", "labelList", listed(["1"]))
    walls = f"walls\n{{\n type wall;\n nFaces {len(faces) - 1};\n startFace 1;\n}}"
    write("constant/polyMesh/boundary", "polyBoundaryMesh", f"1\n(\n{walls}\n)\n")
    write("system/controlDict", "dictionary", "startTime 0;\n")
    write("0/p", "volScalarField", "internalField nonuniform List<scalar>\n3\n(\n1\nabc\n)\n;\n")
    (folder / "case.foam").touch()
    return folder / "case.foam"


def test_foam():
    """The mesh of a case with its patches; its points written back, into the case or a copy of it."""
    shutil.rmtree(FOLDER / "foam", ignore_errors=True)
    case = foam(FOLDER / "foam")
    mesh = tl.read(case)
    assert mesh.GetNumberOfCells() == 2 + 10 and set(mesh.cell_data) == {"Patch", "Face"}
    assert mesh.cell_data["Patch"].tolist() == [-1] * 2 + [0] * 10
    assert tl.read(case, lower_cells=False).GetNumberOfCells() == 2 and not tl.times(case)
    rejected(".foam", tl.read, case, binary=True)
    rejected("foam/constant/air", tl.read, case, region="air")
    rejected("processor0", tl.read, case, decomposed=True)
    rejected(wording("has-no-time-steps"), tl.read, case, time=1)

    mesh.GetPoints().SetPoint(4, 0.25, 0.125, 1.5)
    original = FOLDER / "foam" / "constant" / "polyMesh" / "points"
    text = original.read_text()
    rows = np.array(re.findall(r"^\((\d) (\d) (\d)\)$", text, re.MULTILINE), float)
    binary = text[: text.index("12\n(")].replace("ascii", "binary").encode() + b"12\n(" + rows.tobytes() + b")\n"
    for i, form in enumerate((text.encode(), binary)):
        original.write_bytes(form)
        copy = FOLDER / f"copy{i}" / "new.foam"
        shutil.rmtree(copy.parent, ignore_errors=True)
        copy.parent.mkdir()
        assert tl.write(mesh, copy) == [str(copy)]
        assert np.array_equal(points(tl.read(copy)), points(mesh)), form
        for name in ("constant/polyMesh/boundary", "0/p", "system/controlDict"):
            assert (copy.parent / name).read_bytes() == (FOLDER / "foam" / name).read_bytes()
        assert original.read_bytes() == form and sorted(file.name for file in copy.parent.iterdir()) == [
            "0", "constant", "new.foam", "system"]  # fmt: skip
        # the template is known, or named
        rejected(wording("name-a-foam-in-another"), tl.write, mesh, copy)
        rejected(wording("name-a-foam-in-another"), tl.write, mesh, copy, template=case)
    rejected(".foam", tl.write, mesh, FOLDER / "new.foam", template=False)
    original.write_bytes(binary[:-20])
    rejected("foam", tl.write, mesh, case)
    assert original.read_bytes() == binary[:-20]

    original.write_text(text)
    before = {file: file.read_bytes() for file in case.parent.rglob("*") if file.is_file() and file != original}
    assert tl.write(mesh, case, keep_original=True) == [str(original)]
    assert np.array_equal(points(tl.read(case)), points(mesh))
    kept = original.with_name("points.orig")
    assert kept.read_text() == text and all(file.read_bytes() == content for file, content in before.items())
    assert {file for file in case.parent.rglob("*") if file.is_file()} == {*before, original, kept}
    rejected("keep_original", tl.write, mesh, case, binary=True)
    mesh.GetPoints().InsertNextPoint(0, 0, 0)
    rejected(wording("foam-mesh-has-13-points"), tl.write, mesh, case)

    (case.parent / "constant" / "polyMesh" / "faces").write_text("4(0 1")
    rejected("polyMesh/faces:1: ", tl.read, case)


def polyhedra(*turned: int):
    """Cubes in a row as polyhedra; bit k of a number turns face k of its cube."""
    grid = vtkUnstructuredGrid()
    corners = vtkPoints()
    corners.SetDataTypeToDouble()
    for x in range(len(turned) + 1):
        for y, z in ((0, 0), (1, 0), (1, 1), (0, 1)):
            corners.InsertNextPoint(x, y, z)
    grid.SetPoints(corners)
    for cube, bits in enumerate(turned):
        a, b = ([4 * (cube + side) + k for k in range(4)] for side in (0, 1))
        faces = [a[::-1], b, *([a[k], a[(k + 1) % 4], b[(k + 1) % 4], b[k]] for k in range(4))]
        stream = vtkIdList()
        stream.InsertNextId(len(faces))
        for k, face in enumerate(faces):
            for number in (len(face), *(face[::-1] if bits >> k & 1 else face)):
                stream.InsertNextId(number)
        grid.InsertNextCell(VTK_POLYHEDRON, stream)
    return grid


def test_polyhedra():
    """Polyhedra are measured as seen from outside, whatever the sense in which a file lists their faces."""
    every = 63
    for turned, inverted in (
        ((0, 0, 0), 0),  # as they should be
        ((every, every, every), 0),  # as vtkCGNSReader lists them
        ((0, every, 0), 2),  # one is inverted, and stays inverted; the next one has its face
        ((every, 0, every), 2),
        ((1, 2, every), 0),  # without a sense
    ):
        assert tl.quality(polyhedra(*turned), metrics="pyramid_volume").inverted == inverted, turned
    try:
        from paraview.modules.vtkPVVTKExtensionsIOCGNSWriter import vtkCGNSWriter
    except ImportError:  # VTK without ParaView
        return
    file = FOLDER / "polyhedra.cgns"
    file.unlink(missing_ok=True)
    writer = vtkCGNSWriter()
    writer.SetFileName(str(file))
    writer.SetInputData(polyhedra(0, 0, 0))
    writer.Write()
    mesh = tl.read(file)
    assert [mesh.GetCellType(i) for i in range(mesh.GetNumberOfCells())] == [VTK_POLYHEDRON] * 3
    result = tl.quality(mesh, metrics="pyramid_volume")
    assert result.inverted == 0 and np.allclose(result.mesh.cell_data["pyramid_volume"], 1 / 6)


def test_foam_in_place():
    """The commands that move points write into the file that they read."""
    shutil.rmtree(FOLDER / "foam", ignore_errors=True)
    case = foam(FOLDER / "foam")
    file = case.parent / "constant" / "polyMesh" / "points"
    before = file.read_text()
    output = shell("untangle", case, "--in-place", "--keep-original")
    assert str(file) in output and file.read_text() == before
    assert file.with_name("points.orig").read_text() == before
    for arguments in ((case, "-o", FOLDER / "x.foam"), ("-",)):
        assert "--in-place" in shell("perturb", *arguments, "--in-place", code=2)
    deck = FOLDER / "in-place.msh"
    tl.write(square(3), deck)
    content = deck.read_bytes()
    shell("perturb", deck, "--in-place")
    assert deck.read_bytes() != content and tl.read(deck).GetNumberOfCells() == 18


def test_ucd():
    for ending in (".avs", ".ucd", ".inp"):
        (FOLDER / f"one{ending}").write_text(UCD)
        mesh = tl.read(FOLDER / f"one{ending}")
        assert mesh.GetNumberOfCells() == 1 and mesh.GetCellType(0) == 10 and mesh.GetPoint(3) == (0, 0, 1)
        assert mesh.GetPointData().GetArray("height").GetValue(3) == 1
    rejected(wording("has-no-time-steps"), tl.read, FOLDER / "one.avs", time=1)


def test_ensight():
    (FOLDER / "run.case").write_text(ENSIGHT_CASE)
    for step, corner in enumerate((0.0, 0.25)):
        (FOLDER / f"run{step}.geo").write_text(ENSIGHT_GEO.format(x=f" {corner:.5e}"))
    assert tl.times(FOLDER / "run.case") == [0.5, 2.0]
    assert tl.read(FOLDER / "run.case").GetPoint(0) == (0, 0, 0)
    assert tl.read(FOLDER / "run.case", time=1.9).GetPoint(0) == (0.25, 0, 0)
    shell("convert", FOLDER / "run.case", FOLDER / "late.vtu", "--time", 2)
    assert tl.read(FOLDER / "late.vtu").GetPoint(0) == (0.25, 0, 0)
    rejected(wording("time-is-x"), tl.read, FOLDER / "run.case", time="x")
    (FOLDER / "run1.geo").unlink()
    rejected("run.case: ", tl.read, FOLDER / "run.case", time=2)


def test_xdmf():
    try:
        from vtkmodules.vtkIOXdmf2 import vtkXdmfWriter
    except ImportError:  # Debian's VTK without ParaView
        (FOLDER / "run.xmf").write_text("<Xdmf/>")
        rejected(wording("run-xmf-this-vtk-has-no-reader"), tl.read, FOLDER / "run.xmf")
        return
    writer = vtkXdmfWriter()
    writer.SetFileName(str(FOLDER / "run.xmf"))
    writer.SetInputData(tl.read(BRACKET))
    writer.Write()
    same(tl.read(FOLDER / "run.xmf"), tl.read(BRACKET))
    (FOLDER / "broken.xmf").write_text("<Xdmf>")
    rejected("broken.xmf: ", tl.read, FOLDER / "broken.xmf")


def test_pvd():
    for step in range(3):
        tl.write(tl.perturb(BRACKET, seed=step + 1), FOLDER / f"step{step}.vtu")
    entries = "".join(f'<DataSet timestep="{step / 2}" part="0" file="step{step}.vtu"/>' for step in (2, 0, 1))
    (FOLDER / "run.pvd").write_text(f'<VTKFile type="Collection"><Collection>{entries}</Collection></VTKFile>')
    assert tl.times(FOLDER / "run.pvd") == [0, 0.5, 1]
    for time, seed in ((None, 1), (0.4, 2), (7, 3)):
        same(tl.read(FOLDER / "run.pvd", time=time), tl.perturb(BRACKET, seed=seed).mesh)
    entries = "".join(f'<DataSet timestep="0" part="{part}" file="step{part}.vtu"/>' for part in (0, 1))
    (FOLDER / "parts.pvd").write_text(f'<VTKFile type="Collection"><Collection>{entries}</Collection></VTKFile>')
    blocks = tl.read(FOLDER / "parts.pvd")
    assert isinstance(blocks, vtkMultiBlockDataSet) and tl.quality(blocks).inverted == 0
    (FOLDER / "none.pvd").write_text("<VTKFile/>")
    rejected(wording("names-no-files"), tl.read, FOLDER / "none.pvd")
    (FOLDER / "cut.pvd").write_text("<VTKFile")
    rejected("cut.pvd: ", tl.read, FOLDER / "cut.pvd")


def test_messages():
    """Nothing of VTK's objects and addresses; what converts a format that nothing reads."""
    for name in ("x.cgns", "x.neu", "x.cas", "x.e", "x.case", "x.xmf", "x.ucd", "x.tec", "x.pvti"):
        (FOLDER / name).write_bytes(b"nonsense, not a mesh\n" * 5)
        try:
            tl.read(FOLDER / name)
            raise AssertionError(f"{name} was read")
        except tl.Error as error:
            assert "0x" not in str(error) and "line " not in str(error).split(name)[0], error
            assert name in str(error), error
        (FOLDER / name).write_bytes(b"")
        rejected(wording("the-file-is-empty"), tl.read, FOLDER / name)
    rejected(wording("mesh-it-with-gmsh"), tl.read, FOLDER / "x.step")
    rejected(wording("no-reader-for-xyz"), tl.times, FOLDER / "x.xyz")
    rejected(wording("has-no-time-steps"), tl.read, BRACKET, time=1)
    assert tl.times(BRACKET) == []


def test_medit():
    """bamg writes version 0; MFEM's files have the same ending."""
    text = "MeshVersionFormatted 0\nDimension\n2\nVertices\n3\n0 0 1\n1 0 1\n0 1 1\nTriangles\n1\n1 2 3 1\nEnd\n"
    (FOLDER / "bamg.mesh").write_text(text)
    assert tl.quality(FOLDER / "bamg.mesh").mesh.GetNumberOfCells() == 1
    # without the keyword End: sfepy, libigl and meshio have such files
    (FOLDER / "open.mesh").write_text(text.removesuffix("End\n"))
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        assert tl.quality(FOLDER / "open.mesh").mesh.GetNumberOfCells() == 1
    assert len(told) == 1 and wording("ends-without-the-keyword-end") in str(told[0].message)
    (FOLDER / "open.mesh").write_text(text.removesuffix(" 1\nEnd\n"))
    rejected("open.mesh", tl.read, FOLDER / "open.mesh")
    (FOLDER / "mfem.mesh").write_text("MFEM mesh v1.0\n\ndimension\n2\n")
    rejected("mfem.mesh:5: ", tl.read, FOLDER / "mfem.mesh")  # by the reader of MFEM, which has the same ending
    result = tl.quality(DATA / "bracket.vtu", "imr")
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        tl.write(result, FOLDER / "binary.meshb", binary=True)
        tl.write(tl.read(FOLDER / "binary.meshb"), FOLDER / "again.meshb")
    assert len(told) == 1 and "imr" in str(told[0].message), told
    again = tl.read(FOLDER / "binary.meshb")
    assert np.array_equal(points(again), points(result.mesh))
    assert again.GetNumberOfCells() == result.mesh.GetNumberOfCells()
    if find_spec("meshio"):
        import meshio

        other = meshio.read(FOLDER / "binary.meshb")
        assert np.array_equal(other.points, points(again)) and len(other.cells[0].data) == again.GetNumberOfCells()
        meshio.write(FOLDER / "theirs.meshb", other)
        theirs = tl.quality(FOLDER / "theirs.meshb", "imr")
        assert np.array_equal(theirs.values["imr"], result.values["imr"])


def test_formats():
    rows = {row["ending"]: row for row in tl.formats()}
    assert rows[".vtu"] == {"ending": ".vtu", "format": "VTK", "read": True, "write": True, "times": False, "by": "VTK",
                            "comes_back": True}  # fmt: skip
    assert rows[".e"]["times"] and rows[".e"]["read"] and not rows[".e"]["write"]
    assert rows[".msh"]["by"] == "Tautline" and rows[".pvd"]["times"]
    assert len(shell("formats").splitlines()) == len(rows) + 2
    # Every format that is readable by the table has a reader here.
    for ending, row in rows.items():
        ucd = row["format"] == "AVS UCD"  # without meshio only this of the two formats
        (FOLDER / f"table{ending}").write_text("1 1 0 0 0\n1 0 0 0\n1 1 pt 1\n" if ucd else "nonsense")
        try:
            tl.read(FOLDER / f"table{ending}")
        except tl.Error as error:
            missing = wording("no-reader"), wording("not-installed-2")
            assert row["read"] == (not any(text in str(error) for text in missing)), error


def test_table():
    """The table of the documentation is what formats() lists where meshio and h5py are installed."""
    page = Path(__file__).parents[2] / "Plugin" / "Site" / "formats.md"
    if not (find_spec("meshio") and find_spec("h5py")):
        return
    shown = {True: "yes", False: "-"}
    lines = ["| Ending | Format | Read by | Written | Time steps | Comes back |", f"|{' --- |' * 6}"]
    for row in tl.formats():
        by = row["by"] if row["read"] or row["ending"] in (".xmf", ".xdmf") else "-"  # VTK of ParaView reads XDMF
        answers = [shown[row[key]] for key in ("write", "times", "comes_back")]
        values = [f"`{row['ending']}`", row["format"], by, *answers]
        lines.append(f"| {' | '.join(values)} |")
    text = page.read_text(encoding="utf-8")
    start, end = text.index("| Ending |"), text.index("\n<!-- end of formats -->")
    assert text[start:end].splitlines() == lines, "replace the table by\n" + "\n".join(lines)


def test_meshio():
    """meshio's objects and formats, forth and back; without meshio the messages name it."""
    mesh = tl.read(BRACKET)
    try:
        import meshio
    except ImportError:
        rejected(wording("meshio-debian-apt-get-install-python3-meshio"), tl.to_meshio, mesh)
        rejected(wording("which-is-not-installed"), tl.write, mesh, FOLDER / "x.mdpa")
        return
    measured = tl.quality(tl.perturb(mesh, seed=3), ["imr", "rr"])
    there = tl.to_meshio(measured)
    assert isinstance(there, meshio.Mesh) and there.cells[0].type == "tetra"
    back = tl.quality(there, ["imr", "rr"])
    assert (back.values["imr"] == measured.values["imr"]).all()
    assert (np.concatenate(there.cell_data["rr"]) == measured.values["rr"]).all()
    for ending in (".bdf", ".inp", ".su2", ".mdpa"):
        file = FOLDER / f"bracket{ending}"
        assert tl.write(mesh, file) == [str(file)]
        again = tl.read(file)
        assert np.allclose(points(again), points(mesh), rtol=1e-5, atol=1e-4), ending
        assert again.GetNumberOfCells() == mesh.GetNumberOfCells(), ending
        assert np.isclose(tl.quality(again).statistics["imr"]["mean"], tl.quality(mesh).statistics["imr"]["mean"],
                          rtol=1e-3), ending  # fmt: skip
    # A wedge as meshio has it: the normal of the first triangle points inwards.
    corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]]
    wedge = meshio.Mesh(corners, [("wedge", [[0, 1, 2, 3, 4, 5]])])
    assert tl.quality(wedge, "min_jacobian").values["min_jacobian"][0] > 0.1
    assert tl.to_meshio(tl.quality(wedge).mesh).cells[0].data.tolist() == [[0, 1, 2, 3, 4, 5]]
    for ending in (".inp", ".vtu"):
        meshio.write(FOLDER / f"wedge{ending}", wedge)
        assert tl.quality(FOLDER / f"wedge{ending}", "min_jacobian").values["min_jacobian"][0] > 0.1, ending
    plane = meshio.Mesh([[0, 0], [1, 0], [1, 1], [0, 1], [2, 0]], [("quad", [[0, 1, 2, 3]]), ("triangle", [[1, 4, 2]])],
                        cell_sets={"part": [[0], []]})  # fmt: skip
    grid = tl.quality(plane).mesh
    assert [grid.GetCellType(i) for i in range(2)] == [9, 5]
    assert vtk_to_numpy(grid.GetCellData().GetArray("part")).tolist() == [1, 0]
    rejected(wording("cells-triangle10-of-meshio-are-not-supported"), tl.quality,
            meshio.Mesh(np.zeros((10, 3)), [("triangle10", [list(range(10))])]))  # fmt: skip
    rejected(wording("meshio-cannot-read-it"), tl.read, broken(".vol"))
    rejected("broken.bdf:2: ", tl.read, broken(".bdf"))
    rejected(wording("use-the-points-0-to-9"), tl.quality, meshio.Mesh(np.zeros((3, 3)), [("triangle", [[0, 1, 9]])]))
    images = tl.metric_field(dimensions=(3, 3)).mesh
    rejected(wording("vtk-s-type-8"), tl.to_meshio, images)
    assert tl.to_meshio(square(2)).points.shape == (9, 3)


def test_round_trips():
    """Every format that the table has as writable comes back: cells and their sizes, of a mesh and of a result."""
    plane, solid = square(2), tl.read(DATA / "bracket.vtu")
    for row in tl.formats():
        if row["ending"] not in (*MESHIO_FORMATS, ".su2") or not row["write"]:
            continue
        for name, mesh in (("plane", plane), ("solid", solid)):
            for what in (mesh, tl.quality(mesh, ["imr", "rr"])):
                file = FOLDER / f"{name}{row['ending']}"
                file.write_text("older")
                if row["ending"] == ".f3grid" and mesh is plane:
                    rejected(wording("cells-of-3-dimensions"), tl.write, what, file)
                    assert file.read_text() == "older"
                    continue
                tl.write(what, file)
                found, known = tl.quality(file, "size"), tl.quality(mesh, "size")
                assert (found.validity > -2).sum() == mesh.GetNumberOfCells() and found.inverted == 0, file
                assert np.isclose(found.values["size"].sum(), known.values["size"].sum(), rtol=1e-4), file


def test_moab():
    """meshio writes lines, triangles and tetrahedra without arrays of cells: others are rejected, arrays announced."""
    if not find_spec("h5py") or not find_spec("meshio"):
        return
    file = FOLDER / "moab.h5m"
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        tl.write(tl.quality(square(2), "imr"), file)
    assert len(told) == 1 and wording("arrays-of-cells-are-left-out") in str(told[0].message), told
    quads = tl.from_arrays([[0, 0], [1, 0], [1, 1], [0, 1]], {"quadrilateral": [[0, 1, 2, 3]]})
    before = file.read_bytes()
    rejected(wording("has-no-cells-quad"), tl.write, quads, file)
    assert file.read_bytes() == before


def test_su2():
    """Cells below the largest dimension are markers, named by Reference; damages are named with their line."""
    cube = FOLDER / "cube.su2"
    cube.write_text(SU2_CUBE)
    mesh = tl.read(cube)
    assert mesh.GetNumberOfCells() == 2 and tl.quality(mesh, "size").values["size"].sum() == 1.5
    mesh = tl.read(cube, lower_cells=True)
    assert vtk_to_numpy(mesh.GetCellData().GetArray("Reference")).tolist() == [0, 0, 1, 2, 2]
    tl.write(mesh, FOLDER / "again.su2")
    again = tl.read(FOLDER / "again.su2", lower_cells=True)
    assert [again.GetFieldData().GetAbstractArray("Markers").GetValue(i) for i in (0, 1)] == ["lower wall", "7x"]
    assert (points(again) == points(mesh)).all() and again.GetNumberOfCells() == 5
    for old, new, text in (("NELEM= 2", "NELEM= 3", "cube.su2:7: "), ("NPOIN= 9 9 0", "NPOIN= 8", "cube.su2:16: "),
                           ("0 0 1 4", "x 0 1 4", "cube.su2:12: "), ("12 0 1 2 3", "12 0 1", "cube.su2:5: "),
                           ("14 4 5 6 7 8", "14 4 5 6 7 9", "cube.su2:6: "), ("NDIME = 3", "NDIME = 4", "cube.su2:2: "),
                           ("0 0 0 0\n", "nan 0 0 0\n", "cube.su2:8: ")):  # fmt: skip
        assert old in SU2_CUBE
        cube.write_text(SU2_CUBE.replace(old, new, 1))
        rejected(text, tl.read, cube)
    complete = (SU2_CUBE.index("NMARK") - 1, SU2_CUBE.index("NMARK"), len(SU2_CUBE) - 1)  # there or without markers
    for end in set(range(len(SU2_CUBE))) - set(complete):
        cube.write_bytes(SU2_CUBE.encode()[:end])
        rejected("cube.su2", tl.read, cube)
    if not find_spec("meshio"):
        return
    import meshio

    blocks = [("line", [[0, 1], [1, 2]]), ("triangle", [[0, 1, 2]]), ("quad", [[0, 2, 3, 4]])]
    corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [-1, 0.1, 0]]
    labels = {"Reference": [np.array([7, 8]), np.array([0]), np.array([0])], "other": [np.zeros(2), [0.5], [0.5]]}
    tl.write(meshio.Mesh(corners, blocks, cell_data=labels), FOLDER / "markers.su2")
    text = (FOLDER / "markers.su2").read_text()
    assert text.splitlines()[:4] == ["NDIME= 2", "NELEM= 2", "5 0 1 2", "9 0 2 3 4"]
    assert text.endswith("NMARK= 2\nMARKER_TAG= 7\nMARKER_ELEMS= 1\n3 0 1\nMARKER_TAG= 8\nMARKER_ELEMS= 1\n3 1 2\n")
    corners[3][2] = 0.5
    rejected(wording("no-surfaces-in-space"), tl.write, meshio.Mesh(corners, blocks), FOLDER / "markers.su2")
    assert (FOLDER / "markers.su2").read_text() == text


def test_unv():
    """Universal files: groups, lower cells, parabolic elements; damages are named with their line; Gmsh's own files."""
    nodes = "".join(f"{i} 1 1 11\n {x}.D+00 {y}.D+00 {z}.D+00\n" for i, (x, y, z) in enumerate(
        [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (5, 5, 5)], 3))  # fmt: skip
    nodes = f"    -1\n  2411\n{nodes}    -1\n"
    elements = "    -1\n  2412\n1 11 1 1 7 2\n0 1 1\n3 4\n2 91 4 1 7 3\n3 4 5\n8 111 6 1 7 4\n3 4 5 6\n{}    -1\n"
    group = "    -1\n  2467\n1 0 0 0 0 0 0 2\nsolid\n8 8 0 0 7 3 0 0\n    -1\n"
    file = FOLDER / "one.unv"
    file.write_text(nodes + elements.format("") + group)
    mesh = tl.read(file)
    assert (mesh.GetNumberOfPoints(), mesh.GetNumberOfCells(), mesh.GetCellType(0)) == (5, 1, 10)
    assert mesh.cell_data["Reference"].tolist() == [6] and mesh.cell_data["solid"].tolist() == [1]
    every = tl.read(file, lower_cells=True)
    assert every.cell_data["Reference"].tolist() == [1, 4, 6] and every.cell_data["solid"].tolist() == [0, 0, 1]
    for text, problem in (
        (nodes, wording("has-no-elements")),
        (elements.format(""), wording("has-no-nodes")),
        ((nodes + elements.format(""))[:-8], wording("ends-within-a-dataset")),
        (nodes + elements.format("9 111 1 1 7 4\n3 4 5 99\n"), "one.unv:23: element 9 uses node 99"),
        (nodes + elements.format("9 777\n"), "one.unv:23: "),
        (nodes + elements.format("9 111 1 1 7 5\n3 4 5 6 7\n"), "one.unv:23: elements with the descriptor 111 and 5"),
        (nodes.replace("5 1 1 11", "4 1 1 11") + elements.format(""), "one.unv:8: node 4 is given twice"),
        (nodes.replace("1.D+00", "nan", 1) + elements.format(""), "one.unv:6: three finite coordinates"),
        ("nonsense\n", wording("this-is-no-universal-file")),
    ):
        file.write_text(text)
        rejected(problem, tl.read, file)
    file.write_text(nodes + elements.format("9 136 1 1 7 2\n3 4\n"))
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        assert tl.read(file).GetNumberOfCells() == 1
    assert len(told) == 1 and wording("springs-masses") in str(told[0].message), told
    if not shutil.which("gmsh"):
        return
    box = 'SetFactory("OpenCASCADE"); Box(1) = {0, 0, 0, 1, 1, 1}; Mesh.MeshSizeMax = 0.6; Physical Volume("a") = {1};'
    for name, text in {
        "tetrahedra": box,
        "hexahedra": box + "Transfinite Curve {1:12} = 3; Transfinite Surface {1:6}; Recombine Surface {1:6};"
        "Transfinite Volume {1};",
        "wedges": 'SetFactory("OpenCASCADE"); Rectangle(1) = {0, 0, 0, 1, 1}; Transfinite Curve {1:4} = 3;\n'
        'Extrude {0, 0, 1} { Surface{1}; Layers {2}; Recombine; }\nPhysical Volume("solid") = {1};',
    }.items():  # fmt: skip
        (FOLDER / f"{name}.geo").write_text(text)
        for order in ("1", "2"):
            for form in ("unv", "msh2"):
                command = ["gmsh", "-3", FOLDER / f"{name}.geo", "-order", order, "-format", form]
                command += ["-setnumber", "Mesh.SecondOrderIncomplete", "1", "-o", FOLDER / f"{name}.{form}"]
                subprocess.run(command, check=True, capture_output=True)
            one, two = (tl.read(FOLDER / f"{name}.{form}") for form in ("unv", "msh2"))
            assert one.cells.keys() == two.cells.keys() and tl.quality(one).inverted == 0, (name, order)
            for kind in one.cells:
                places = [mesh.points[mesh.cells[kind]] for mesh in (one, two)]
                assert np.allclose(*places, atol=1e-12), (name, kind)


def test_kratos():
    """The names of elements give their cells; meshio takes three nodes for a line of second order."""
    if not find_spec("meshio"):
        return
    text = "Begin Nodes\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\nEnd Nodes\n"
    text += "Begin Elements Element2D3N\n1 0 1 2 3\n2 0 1 3 4\n"
    file = FOLDER / "plane.mdpa"
    file.write_text(text + "End Elements\n")
    assert tl.quality(file, "size").values["size"].tolist() == [0.5, 0.5]
    file.write_text(text + "End Elements\nBegin Conditions LineCondition2D2N\n1 0 1 2\nEnd Conditions\n")
    mesh = tl.read(file)
    assert [mesh.GetCellType(i) for i in range(3)] == [5, 5, 3]
    for old, new, place in (("Element2D3N", "Something", 7), ("2D3N", "2D5N", 7), ("\n3 1 1 0", "\n7 1 1 0", 4)):
        file.write_text(text.replace(old, new) + "End Elements\n")
        rejected(f"plane.mdpa:{place}: ", tl.read, file)


def test_endings():
    """Gmsh's other endings, and files that gzip has compressed."""
    text = (DATA / "part.msh").read_bytes()
    for ending in (".msh2", ".msh4"):
        (FOLDER / f"part{ending}").write_bytes(text)
        same(tl.read(FOLDER / f"part{ending}"), tl.read(DATA / "part.msh"))
    file = FOLDER / "part.msh.gz"
    file.write_bytes(gzip.compress(text))
    same(tl.read(file), tl.read(DATA / "part.msh"))
    assert tl.read(file, lower_cells=True).GetNumberOfCells() >= tl.read(file).GetNumberOfCells()
    for content in (file.read_bytes()[:-30], b"nonsense", gzip.compress(text[:300])):
        file.write_bytes(content)
        rejected(str(file), tl.read, file)
    (FOLDER / "part.ele.gz").write_bytes(gzip.compress(b"1 4 0"))
    rejected(wording("compressed-files-are-read-of"), tl.read, FOLDER / "part.ele.gz")


def test_abaqus():
    """Parts and instances, by every route of Python."""
    part = "*Part, name={0}\n*Node\n1, 0., 0.\n2, {1}, 0.\n3, {1}, {1}\n4, 0., {1}\n"
    part += "*Element, type=CPS4\n1, 1, 2, 3, 4\n"
    text = part.format("A", 1.0) + "*End Part\n" + part.format("B", 3.0) + "*End Part\n*Assembly, name=X\n"
    for instance in ("name=A-1, part=A\n", "name=B-1, part=B\n 10., 0., 0.\n", "name=A-2, part=A\n -5., 0., 0.\n"):
        text += f"*Instance, {instance}*End Instance\n"
    file = FOLDER / "job.inp"
    file.write_text(text + "*End Assembly\n")
    mesh = tl.read(file)
    assert tl.quality(mesh, "size").values["size"].tolist() == [1, 9, 1] and mesh.GetBounds()[:2] == (-5, 13)
    expected = "job.inp: " + wording("its-coordinates-cannot-be-replaced")
    rejected(expected, tl.write, mesh, FOLDER / "new.inp", template=file)
    file.write_text("*NGEN\n1, 2\n")
    rejected("job.inp:1: ", tl.read, file)
    rows = {row["ending"]: row for row in tl.formats()}
    assert rows[".inp"]["by"] == rows[".bdf"]["by"] == "Tautline" and rows[".bdf"]["read"]


def test_views():
    """A .pos file has a view for each array; it is written, not read."""
    measured = tl.quality(BRACKET, ["imr", "rr"])
    tl.write(measured, FOLDER / "bracket.pos")
    text = (FOLDER / "bracket.pos").read_text()
    assert text.count("View ") == 3 and text.count("\nSS(") == 3 * measured.mesh.GetNumberOfCells()
    last = text.split('View "imr" {', 1)[1].split("\n};", 1)[0].splitlines()[-1]
    value = float(last.split("){", 1)[1].split(",", 1)[0])
    assert value == measured.values["imr"][-1], (value, measured.values["imr"][-1])
    rejected(wording("write-msh"), tl.read, FOLDER / "bracket.pos")
    values = measured.values["imr"].copy()
    values[[3, 5]] = np.nan
    gaps = vtkUnstructuredGrid()
    gaps.CopyStructure(measured.mesh)
    gaps.GetCellData().AddArray(numpy_to_vtk(values, deep=True))
    gaps.GetCellData().GetArray(0).SetName("gaps")
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        tl.write(gaps, FOLDER / "gaps.pos")
    expected = f'gaps.pos: view "gaps": 2 of {len(values)} elements are left out'
    assert len(told) == 1 and expected in str(told[0].message), [str(each.message) for each in told]
    assert told[0].filename == __file__, told[0].filename
    rejected(wording("this-mesh-has-none"), tl.write, BRACKET, FOLDER / "none.pos")
    rejected(wording("views-are-written-as-text"), tl.write, measured, FOLDER / "none.pos", binary=True)
    assert not (FOLDER / "none.pos").exists()


def test_groups():
    """The elements that a criterion fails, as sets: arrays in VTK's files, element sets in .inp, groups in .med."""
    tangled = DATA / "bracket-tangled.vtu"
    result = tl.quality(tangled, criteria="fem")
    sets = result.groups()
    assert len(sets["Inverted"]) == 41 and len(sets["Degenerate"]) == 0 and list(sets)[2:] == ["Failed", "Warning"]
    assert (np.flatnonzero(result.grades == 2) == sets["Failed"]).all() and len(sets["Failed"]) >= 41
    assert list(tl.quality(tangled).groups()) == ["Inverted", "Degenerate"]
    tl.write(result, FOLDER / "sets.vtu", groups=sets)
    again = tl.read(FOLDER / "sets.vtu").GetCellData()
    for name, members in sets.items():
        assert np.flatnonzero(vtk_to_numpy(again.GetArray(name))).tolist() == members.tolist()
    assert result.mesh.GetCellData().GetArray("Inverted") is None
    for wrong, text in (({"a": [10**6]}, "there are 0 to"), ({"a": [0.5]}, "no list of numbers"), ({"": [1]}, "name"),
                        ({"a": [True, False]}, "mask of 2"), ({"a": [[1], [1, 2]]}, "no ")):  # fmt: skip
        rejected(text, tl.write, result, FOLDER / "none.vtu", groups=wrong)
    shell("quality", tangled, "--groups", "-o", FOLDER / "shell.vtu")
    assert tl.read(FOLDER / "shell.vtu").GetCellData().GetArray("Inverted").GetRange() == (0, 1)
    try:
        import meshio
    except ImportError:
        return
    # Two blocks of triangles around a quadrilateral: MED has one block of each type, triangles first.
    corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [2, 1, 0]]
    blocks = [("triangle", [[0, 1, 2]]), ("quad", [[0, 2, 3, 0]]), ("triangle", [[1, 4, 2], [4, 5, 2]])]
    plane = meshio.Mesh(corners, blocks)
    mixed = {"bad ones": [0, 3], "quads": [1], "none": []}
    tl.write(plane, FOLDER / "sets.inp", groups=mixed)
    assert (FOLDER / "sets.inp").read_text().endswith("*ELSET, ELSET=bad_ones\n1, 4\n*ELSET, ELSET=quads\n2\n")
    arrays = tl.read(FOLDER / "sets.inp").GetCellData()
    assert vtk_to_numpy(arrays.GetArray("bad_ones")).tolist() == [1, 0, 0, 1]
    tl.write(result, FOLDER / "bracket.inp", groups=sets)
    arrays = tl.read(FOLDER / "bracket.inp").GetCellData()
    assert np.flatnonzero(vtk_to_numpy(arrays.GetArray("Inverted"))).tolist() == sets["Inverted"].tolist()
    try:
        import h5py  # noqa: F401, which meshio needs for MED
    except ImportError:
        return
    tl.write(plane, FOLDER / "sets.med", groups=mixed | {"all": [0, 1, 2, 3]})
    arrays = tl.read(FOLDER / "sets.med").GetCellData()
    kinds = [tl.read(FOLDER / "sets.med").GetCellType(i) for i in range(4)]
    of_triangles = {"bad ones": [1, 0, 1], "quads": [0, 0, 0], "all": [1, 1, 1]}
    for name, members in of_triangles.items():
        values = vtk_to_numpy(arrays.GetArray(name))
        assert [v for v, kind in zip(values, kinds) if kind == 5] == members, name
    assert arrays.GetArray("none") is None


def broken(ending: str):
    file = FOLDER / f"broken{ending}"
    file.write_text("BEGIN BULK\nGRID,1,x,y\n")
    return file


def test_pyvista():
    """A mesh of PyVista is a vtkDataSet; one of another VTK is named as such."""

    class Other:
        def IsA(self, name):
            return name == "vtkDataSet"

    rejected(wording("this-other-is-of-another-vtk"), tl.quality, Other())

    class Derived(vtkUnstructuredGrid):  # as PyVista's classes are
        pass

    mesh = Derived()
    mesh.ShallowCopy(tl.read(BRACKET))
    assert tl.quality(mesh).inverted == 0


assert "meshio" not in sys.modules, "meshio is imported before it is needed"
run_tests(globals())
