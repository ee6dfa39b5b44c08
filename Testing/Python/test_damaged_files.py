# SPDX-License-Identifier: BSD-3-Clause
"""Truncated and malformed files are errors: VTK's readers return what they have, or memory that nobody filled."""

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import tautline as tl
from checks import DATA, OUT, SLOW, rejected, shell, square, wording
from tautline import _reading
from vtkmodules.vtkCommonDataModel import (
    vtkMultiBlockDataSet,
    vtkPolyData,
    vtkRectilinearGrid,
    vtkStructuredGrid,
    vtkUnstructuredGrid,
)
from vtkmodules.vtkFiltersCore import vtkAppendFilter
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
from vtkmodules.vtkIOLegacy import vtkGenericDataObjectWriter

FOLDER = OUT / "damaged"
CUTS = 120 if SLOW else 40  # of each file
VERSIONS = (42, 51)  # that VTK writes
HEAD = "# vtk DataFile Version {}\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\n"
POINTS = "POINTS 4 double\n0 0 0 1 0 0 0 1 0 1 1 0\n"
TYPES = "CELL_TYPES 2\n5\n5\n"


def surface(mesh):
    made = vtkGeometryFilter()
    made.SetInputData(mesh)
    made.Update()
    return made.GetOutput()


def with_arrays(kind, dimensions=(4, 3, 2)):
    """A structured mesh with an array on its points."""
    image = tl.metric_field(dimensions=(dimensions[0] * dimensions[1] * dimensions[2], 1, 1)).mesh
    mesh = kind()
    if kind is vtkRectilinearGrid:
        axis = image.GetPointData().GetArray(0).NewInstance()
        axis.SetNumberOfValues(image.GetNumberOfPoints())
        for i in range(image.GetNumberOfPoints()):
            axis.SetValue(i, i)
        mesh.SetDimensions(image.GetNumberOfPoints(), 1, 1)
        mesh.SetXCoordinates(axis)
    else:
        append = vtkAppendFilter()
        append.AddInputData(image)
        append.Update()
        mesh.SetDimensions(*dimensions)
        mesh.SetPoints(append.GetOutput().GetPoints())
    mesh.GetPointData().ShallowCopy(image.GetPointData())
    return mesh


def meshes() -> dict:
    """A mesh of every type of data set, with arrays on points and cells."""
    grid = tl.quality(tl.domain("rectangle", cells=60)).mesh
    image = tl.metric_field(dimensions=(6, 5, 1)).mesh
    blocks = vtkMultiBlockDataSet()
    blocks.SetBlock(0, grid)
    return {
        "grid": grid,
        "surface": surface(grid),
        "image": image,
        "structured": with_arrays(vtkStructuredGrid),
        "rectilinear": with_arrays(vtkRectilinearGrid),
        "blocks": blocks,
    }


def signature(mesh) -> tuple:
    """Counts, and the values of every array, of a mesh."""
    if isinstance(mesh, vtkMultiBlockDataSet):
        return tuple(signature(mesh.GetBlock(i)) for i in range(mesh.GetNumberOfBlocks()))
    arrays = []
    for data in (mesh.GetPointData(), mesh.GetCellData()):
        for i in range(data.GetNumberOfArrays()):
            array = data.GetArray(i)
            arrays.append((array.GetName(), tuple(array.GetTuple(j) for j in range(array.GetNumberOfTuples()))))
    return mesh.GetNumberOfPoints(), mesh.GetNumberOfCells(), mesh.GetBounds(), tuple(arrays)


def is_beginning(part: tuple, whole: tuple) -> bool:
    """Whether a file cut between two sections was read: all of the points, and the first of the arrays or cells.

    The last number may be shorter: text does not show it.
    """
    if len(whole) == 1:  # the only block
        return len(part) == 1 and is_beginning(part[0], whole[0])
    same = part[0] == whole[0] and part[1] in (0, whole[1]) and part[2] == whole[2]
    if not same or not part[3]:
        return same
    *before, (name, values) = part[3]
    last = dict(whole[3]).get(name, ())
    return all(array in whole[3] for array in before) and len(values) == len(last) and values[:-1] == last[:-1]


def test_cut_legacy_files() -> None:
    file = FOLDER / "cut.vtk"
    rejected_cuts = cuts = 0
    for name, mesh in meshes().items():
        for version in VERSIONS:
            for binary in (False, True):
                writer = vtkGenericDataObjectWriter()
                writer.SetInputData(mesh)
                writer.SetFileVersion(version)
                writer.SetFileType(2 if binary else 1)
                writer.SetFileName(str(file))
                writer.Write()
                content = file.read_bytes()
                whole = signature(tl.read(file))
                for size in range(0, len(content) - 1, max(1, len(content) // CUTS)):
                    file.write_bytes(content[:size])
                    cuts += 1
                    try:
                        part = signature(tl.read(file))
                    except tl.Error as error:
                        assert str(file) in str(error), error
                        rejected_cuts += 1
                    else:
                        kind = f"{name}, version {version}, {'binary' if binary else 'text'}, {size} bytes"
                        assert is_beginning(part, whole), f"{kind}: read as {part[:3]}, not {whole[:3]}"
    print(f"  {rejected_cuts} of {cuts} cut files rejected")
    assert rejected_cuts > 0.95 * cuts


def test_chunks_of_legacy_files() -> None:
    """Numbers are counted right wherever a chunk of the file ends: within a number, after one, after a space."""
    file = FOLDER / "chunks.vtk"
    writer = vtkGenericDataObjectWriter()
    writer.SetInputData(square(5))
    writer.SetFileName(str(file))
    writer.Write()
    cells, chunk = square(5).GetNumberOfCells(), tl._legacy._CHUNK
    try:
        for tl._legacy._CHUNK in range(30, 60):  # longer than any number
            assert tl.read(file).GetNumberOfCells() == cells, tl._legacy._CHUNK
    finally:
        tl._legacy._CHUNK = chunk


def test_cut_xml_files() -> None:
    for name, ending in (("grid", ".vtu"), ("surface", ".vtp"), ("image", ".vti"), ("structured", ".vts"),
                         ("rectilinear", ".vtr")):  # fmt: skip
        file = FOLDER / f"cut{ending}"
        tl.write(meshes()[name], file)
        content = file.read_bytes()
        for size in range(0, len(content.rstrip()), max(1, len(content) // CUTS)):
            file.write_bytes(content[:size])
            rejected(str(file), tl.read, file)


def test_cut_surfaces() -> None:
    for ending in (".ply", ".stl", ".vtm"):
        file = FOLDER / f"cut{ending}"
        tl.write(meshes()["blocks" if ending == ".vtm" else "surface"], file)
        content = file.read_bytes()
        for size in range(0, len(content.rstrip()), max(1, len(content) // CUTS)):
            file.write_bytes(content[:size])
            rejected(str(file), tl.read, file)


def test_first_bytes() -> None:
    """The head of a large file, which announces its points."""
    file = FOLDER / "head.vtk"
    tl.write(square(300), file)
    file.write_bytes(file.read_bytes()[:100])
    rejected("truncated", tl.read, file)
    assert "truncated" in shell("quality", file, code=1)


def test_malformed_lists() -> None:
    cases = {
        "too few numbers": "CELLS 2 8\n3 0 1 2\n" + TYPES,
        "too many numbers": "CELLS 2 8\n3 0 1 2\n3 1 3 2 0\n" + TYPES,
        "words": "CELLS 2 8\n3 0 1 2\n3 a b c\n" + TYPES,
        "a size that is too large": "CELLS 2 8\n3 0 1 2\n30 1 3 2\n" + TYPES,
        "a negative size": "CELLS 2 8\n3 0 1 2\n-3 1 3 2\n" + TYPES,
        "a wrong total": "CELLS 2 7\n3 0 1 2\n3 1 3 2\n" + TYPES,
        "fewer cells than announced": "CELLS 3 8\n3 0 1 2\n3 1 3 2\nCELL_TYPES 3\n5\n5\n5\n",
        "an unknown point": "CELLS 2 8\n3 0 1 2\n3 1 4 2\n" + TYPES,
        "a negative point": "CELLS 2 8\n3 0 1 2\n3 1 -1 2\n" + TYPES,
        "too few types": "CELLS 2 8\n3 0 1 2\n3 1 3 2\nCELL_TYPES 1\n5\n",
        "no types": "CELLS 2 8\n3 0 1 2\n3 1 3 2\n",
    }
    offsets = {
        "offsets that decrease": "CELLS 3 6\nOFFSETS vtktypeint64\n0 6 3\nCONNECTIVITY vtktypeint64\n0 1 2 1 3 2\n",
        "offsets beyond the list": "CELLS 3 6\nOFFSETS vtktypeint64\n0 3 60\nCONNECTIVITY vtktypeint64\n0 1 2 1 3 2\n",
        "no list": "CELLS 3 6\nOFFSETS vtktypeint64\n0 3 6\n",
        "too many points": "CELLS 3 9\nOFFSETS vtktypeint64\n0 3 6\nCONNECTIVITY vtktypeint64\n0 1 2 1 3 2\n",
        "unknown point by offsets": "CELLS 3 6\nOFFSETS vtktypeint64\n0 3 6\nCONNECTIVITY vtktypeint64\n0 1 2 1 3 9\n",
    }
    file = FOLDER / "malformed.vtk"
    for version, lists, end in (("2.0", cases, ""), ("4.2", cases, ""), ("5.1", offsets, TYPES)):
        for case, text in lists.items():
            file.write_text(HEAD.format(version) + POINTS + text + end)
            # in a process of its own: a reader of VTK may crash
            done = subprocess.run([sys.executable, "-m", "tautline", "quality", file], capture_output=True, text=True)
            assert done.returncode == 1, f"{case}, version {version}: exit code {done.returncode}, {done.stdout}"
            assert str(file) in done.stderr, f"{case}, version {version}: {done.stderr}"
    for version in ("2.0", "3.0", "4.2"):
        file.write_text(HEAD.format(version) + POINTS + "CELLS 2 8\n3 0 1 2\n3 1 3 2\n" + TYPES)
        assert tl.read(file).GetNumberOfCells() == 2, version
    assert isinstance(tl.read(file), vtkUnstructuredGrid) and not isinstance(tl.read(file), vtkPolyData)


def test_not_a_file() -> None:
    """Pipes, devices and directories are rejected at once, by every reader."""
    folder = FOLDER / "not-files"
    folder.mkdir(exist_ok=True)
    start = time.monotonic()
    for ending in (".vtk", ".vtu", ".stl", ".msh", ".mesh", ".off", ".node"):
        paths = [folder / f"{kind}{ending}" for kind in ("pipe", "zero", "directory", "loop", "denied")]
        for path in paths:
            if path.is_symlink() or path.is_fifo():
                path.unlink()
        pipe, zero, directory, loop, _ = paths
        os.mkfifo(pipe)
        zero.symlink_to("/dev/zero")
        directory.mkdir(exist_ok=True)
        loop.symlink_to(loop.name)
        rejected(wording("is-not-a-regular-file"), tl.read, pipe)
        rejected(wording("is-not-a-regular-file"), tl.read, zero)
        rejected(wording("is-a-directory"), tl.read, directory)
        rejected(wording("cannot-be-read"), tl.read, loop)
        rejected(wording("there-is-no-such-file"), tl.read, folder / f"absent{ending}")
    rejected(wording("is-not-a-regular-file"), tl.silhouette, folder / "pipe.vtk")
    rejected(wording("is-not-a-regular-file"), tl.read_silhouettes, folder / "zero.vtk")
    (folder / "list.csv").write_text("file,class\npipe.vtk,a\n")
    rejected(wording("is-not-a-regular-file"), tl.read_silhouettes, folder / "list.csv")
    (folder / "blocks.vtm").write_text(
        '<VTKFile type="vtkMultiBlockDataSet"><vtkMultiBlockDataSet><DataSet index="0" file="pipe.vtu"/>'
        "</vtkMultiBlockDataSet></VTKFile>"
    )
    rejected(wording("is-not-a-regular-file"), tl.read, folder / "blocks.vtm")
    assert time.monotonic() - start < 5.0


def test_images() -> None:
    """A truncated image, and a file that is none of the formats, is rejected by name; VTK crashes on some."""
    folder = FOLDER / "images"
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(Path(DATA).parent / "Testing/Fuzz/Corpus/image", folder)
    files = sorted(folder.iterdir())
    blocks = tl.read_silhouettes(folder)
    assert blocks.GetNumberOfBlocks() == len(files) - 1, "all but the TGA file"
    rejected(wording("it-is-none-of-png-jpeg-tiff-2"), tl.silhouette, folder / "short.tga")
    for file in files:
        whole = file.read_bytes()
        for size in range(0, len(whole), max(1, len(whole) // CUTS)):
            file.write_bytes(whole[:size])
            rejected(str(file), tl.silhouette, file)
            if size > 8 and file.suffix != ".tga":
                rejected(f"{file}: the image cannot be read", tl.read_silhouettes, folder)
        file.write_bytes(whole)


POLYHEDRON = """<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">
<UnstructuredGrid><Piece NumberOfPoints="4" NumberOfCells="1"><Points>
<DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points><Cells>
<DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 3</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">4</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">42</DataArray>
<DataArray type="Int64" Name="faces" format="ascii">4 3 0 2 1 3 0 1 3 3 1 2 3 3 0 3 2</DataArray>
<DataArray type="Int64" Name="faceoffsets" format="ascii">17</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>
"""


def test_crash_of_a_reader() -> None:
    """VTK's reader crashes on a wrong number of corners of a face: an error here, with the name of the file."""
    file = FOLDER / "polyhedron.vtu"
    file.write_text(POLYHEDRON)
    assert tl.read(file).GetNumberOfCells() == 1
    file.write_text(POLYHEDRON.replace("4 3 0 2 1", "4 30000000 0 2 1"))
    rejected(f"{file}: " + wording("its-reader-ended-by"), tl.read, file)
    assert wording("its-reader-ended-by") in shell("quality", file, code=1)


def test_limits_of_a_reader() -> None:
    """A reader that needs too long or too much memory is ended."""
    file = FOLDER / "limits.ply"
    tl.write(surface(square(4)), file)
    assert tl.read(file).GetNumberOfCells() == 32
    for name, value, text in (("_SECONDS", 0.05, wording("reading-takes-more-than")), ("_MEMORY", 2**20, "")):
        before = getattr(_reading, name)
        setattr(_reading, name, value)
        try:
            if name == "_SECONDS":
                rejected(text, tl.read, file)
            else:
                rejected("limits.ply", tl.read, file)
        finally:
            setattr(_reading, name, before)
    folder = Path.cwd()
    os.chdir(FOLDER)
    try:
        rejected("limits.avs: ", tl.read, "limits.avs")
        Path("limits.avs").write_text("4 1 0 0 0\n1 0 0 0\n")
        rejected("limits.avs: " + wording("the-file-is-truncated"), tl.read, "limits.avs")
    finally:
        os.chdir(folder)


def test_readers_without_a_reason() -> None:
    """Readers of VTK that fail silently, or do not name the file: the message does, and is none of the executive."""
    for name, text in (
        ("silent.xmf", "<Xdmf/>"),
        ("silent.neu", "        CONTROL INFO 2.3.16\n"),
        ("silent.e", "CDF\x01"),
        ("silent.case", "FORMAT\ntype: ensight\n"),
    ):
        file = FOLDER / name
        file.write_text(text)
        for read in (tl.read, tl.times):
            rejected(name, read, file)
            try:
                read(file)
            except tl.Error as error:
                assert wording("update-piece") not in str(error), error


UCD = """# a comment
5 2 2 1 0
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 1 1 1
1 7 tet 1 2 3 4
2 7 tet 2 3 4 5
2 1 1
height, m
depth, m
1 0 0
2 0 0
3 0 0
4 1 0
5 1 0
1 1
density, kg
1 2.5
2 2.75
"""


def test_cut_ucd() -> None:
    """The counts of the header match the file; only the last number may be cut."""
    file = FOLDER / "cut.avs"
    file.write_text(UCD)
    mesh = tl.read(file)
    assert mesh.GetNumberOfCells() == 2 and mesh.GetPointData().GetArray("depth").GetValue(4) == 0
    ends = range(1, len(UCD) - len("2.75\n"), 1 if SLOW else 9)
    for end in ends:
        file.write_text(UCD[:end])
        rejected("cut.avs", tl.read, file)
    for old, new in (("5 2 2 1 0", "5 3 2 1 0"), ("5 2 2 1 0", "6 2 2 1 0"), ("5 2 2 1 0", "-5 2 2 1 0"),
                     ("tet 1 2 3 4", "hex 1 2 3 4"), ("2 1 1\n", "x 1 1\n")):  # fmt: skip
        file.write_text(UCD.replace(old, new, 1))
        rejected("cut.avs", tl.read, file)


def test_no_permission() -> None:
    if os.geteuid() != 0:
        print("  not run: needs root, to be another user")
        return
    for ending in (".vtu", ".vtk", ".mesh"):
        file = FOLDER / f"denied{ending}"
        tl.write(square(3), file)
        file.chmod(0)
        child = os.fork()
        if child == 0:
            try:
                os.setuid(65534)
                rejected(wording("cannot-be-read-permission-denied"), tl.read, file)
                os._exit(0)
            finally:
                os._exit(1)
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0, ending


def test_sample_files() -> None:
    """Complete files are read, whatever wrote them."""
    for file in sorted(Path(DATA).glob("*.vt?")):
        assert tl.read(file).GetNumberOfCells() > 0, file


FOLDER.mkdir(parents=True, exist_ok=True)
OUT.chmod(OUT.stat().st_mode | 0o055)
for test in [value for name, value in list(globals().items()) if name.startswith("test_")]:
    start = time.monotonic()
    test()
    print(f"{test.__name__} passed, {time.monotonic() - start:.1f} s", flush=True)
