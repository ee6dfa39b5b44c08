# SPDX-License-Identifier: BSD-3-Clause
"""Files of arrays that come back with new coordinates: Exodus, and with h5py CGNS, Salome MED and MOAB; the source of a
result as its template."""

import shutil
import subprocess
import sys
import warnings
from importlib.util import find_spec

import numpy as np
import tautline as tl
from checks import DATA, OUT, points, rejected, run_tests, shell, wording
from tautline import _array_templates
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet, vtkUnstructuredGrid
from vtkmodules.vtkIOExodus import vtkExodusIIWriter

FOLDER = OUT / "array-templates"
FOLDER.mkdir(exist_ok=True)
BRACKET = DATA / "bracket.vtu"
H5PY, MESHIO = (find_spec(name) is not None for name in ("h5py", "meshio"))
#: Four tetrahedra around a point, in the numbers of CGNS.
TETRAHEDRA = [1, 2, 3, 5, 1, 4, 2, 5, 2, 4, 3, 5, 1, 3, 4, 5]
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0.3, 0.3, 0.3]])


def exodus(name: str, mesh) -> str:
    writer = vtkExodusIIWriter()
    writer.SetFileName(str(FOLDER / name))
    writer.SetInputData(mesh)
    writer.Write()
    return str(FOLDER / name)


def cgns(name: str, zones: int) -> str:
    """A file as the library of CGNS writes it: zones of four tetrahedra, with a boundary condition."""
    import h5py

    kinds = {"int32": "I4", "float64": "R8", "float32": "R4", "int8": "C1"}

    def node(parent, title: str, label: str, data=None):
        made = parent.create_group(title, track_order=True)
        kind = "MT" if data is None else kinds[str(data.dtype)]
        for key, text, size in (("name", title, 33), ("label", label, 33), ("type", kind, 3)):
            made.attrs.create(key, np.bytes_(text), dtype=f"S{size}")
        made.attrs.create("flags", np.array([1], np.int32))
        if data is not None:
            made.create_dataset(" data", data=data)
        return made

    def whole(*values: int):
        return np.array(values, np.int32)

    def text(value: str):
        return np.frombuffer(value.encode(), np.int8)

    with h5py.File(FOLDER / name, "w", track_order=True) as file:
        root = (("name", "HDF5 MotherNode", 33), ("label", "Root Node of HDF5 File", 33), ("type", "MT", 3))
        for key, value, size in root:
            file.attrs.create(key, np.bytes_(value), dtype=f"S{size}")
        file.create_dataset(" format", data=text("IEEE_LITTLE_32\0"))
        file.create_dataset(" hdf5version", data=text("HDF5 Version 1.10.8".ljust(33, "\0")))
        node(file, "CGNSLibraryVersion", "CGNSLibraryVersion_t", np.array([3.4], np.float32))
        base = node(file, "Base", "CGNSBase_t", whole(3, 3))
        for i in range(zones):
            zone = node(base, f"Zone {i}", "Zone_t", whole(5, 4, 0).reshape(3, 1))
            node(zone, "ZoneType", "ZoneType_t", text("Unstructured"))
            grid = node(zone, "GridCoordinates", "GridCoordinates_t")
            for axis, values in zip("XYZ", (CORNERS + [5 * i, 0, 0]).T):
                node(grid, f"Coordinate{axis}", "DataArray_t", np.ascontiguousarray(values))
            elements = node(zone, "Solid", "Elements_t", whole(10, 0))
            node(elements, "ElementRange", "IndexRange_t", whole(1, 4))
            node(elements, "ElementConnectivity", "DataArray_t", whole(*TETRAHEDRA))
            wall = node(node(zone, "ZoneBC", "ZoneBC_t"), "wall", "BC_t", text("BCWall"))
            node(wall, "PointRange", "IndexRange_t", whole(1, 2).reshape(2, 1))
    return str(FOLDER / name)


def contents(file: str) -> dict:
    """The arrays of a file of HDF5 by name."""
    import h5py

    found = {}
    with h5py.File(file) as handle:
        handle.visititems(lambda name, item: found.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
    return found


def grid_of(mesh) -> vtkUnstructuredGrid:
    grid = vtkUnstructuredGrid()
    grid.ShallowCopy(mesh)
    return grid


def test_exodus():
    """A copy of as many bytes, in which only the coordinates differ; two element blocks share their points."""
    source, target = exodus("one.e", grid_of(tl.read(BRACKET))), FOLDER / "out.e"
    result = tl.perturb(source, fraction=0.4)
    assert tl.write(result, target) == [str(target)]
    assert np.array_equal(points(tl.read(target)), points(result.mesh))
    old, new = (np.fromfile(file, np.uint8) for file in (source, target))
    assert len(old) == len(new)
    places = np.flatnonzero(old != new)
    assert len(places) and places.max() - places.min() < 3 * 8 * len(points(result.mesh))

    cells = {"tetrahedron": np.reshape(TETRAHEDRA, (4, 4)) - 1}
    blocks = vtkMultiBlockDataSet()
    for i in range(2):
        blocks.SetBlock(i, tl.from_arrays(CORNERS + [5 * i, 0, 0], cells))
    source = exodus("two.e", blocks)
    mesh = tl.read(source)
    assert mesh.GetNumberOfBlocks() == 2
    tl.write(tl.optimize(source), target)
    after = tl.read(target)
    for i in range(2):
        inner = points(after.GetBlock(i))[[4, 9]] - [[0, 0, 0], [5, 0, 0]]
        assert np.allclose(inner[0], inner[1], atol=1e-4) and np.abs(inner - 0.3).max() > 0.01, inner
    mesh.GetBlock(1).GetPoints().SetPoint(4, 0.1, 0.1, 0.1)
    mesh.GetBlock(0).GetPoints().SetPoint(4, 0.2, 0.1, 0.1)
    before = target.read_bytes()
    rejected(wording("to-different-places"), tl.write, mesh, target, template=source)
    assert target.read_bytes() == before


def test_damaged():
    """A header that does not fit: an error, and no file."""
    source = FOLDER / "damaged.e"
    content = (FOLDER / "one.e").read_bytes()
    for size in (4, 40, 200, 500):
        source.write_bytes(content[:size])
        with open(source, "rb") as file:
            rejected("damaged.e", _array_templates._netcdf_parts, str(source), file)
    mesh = tl.perturb(FOLDER / "one.e", fraction=0.4).mesh
    target = FOLDER / "none.e"
    target.unlink(missing_ok=True)
    rejected(wording("has-other-cells"), tl.write, tl.read(BRACKET), target, template=FOLDER / "two.e")
    mesh.GetPoints().SetPoint(0, np.nan, 0, 0)
    rejected(wording("coordinate-is-not-finite"), tl.write, mesh, target, template=FOLDER / "one.e")
    assert not target.exists()


def test_hdf5():
    """All arrays stay except the coordinates, which come from the result."""
    if not H5PY:
        return
    sources = [cgns("one.cgns", 1), cgns("two.cgns", 2)]
    if MESHIO:
        for ending in (".med", ".h5m"):
            sources += tl.write(BRACKET, FOLDER / f"one{ending}")
    for source in sources:
        target = source.replace("one.", "new.").replace("two.", "newer.")
        result = tl.perturb(source, fraction=0.4)
        tl.write(result, target)
        after, before = tl.read(target), tl.read(source)
        parts = [(after, result.mesh, before)]
        if isinstance(after, vtkMultiBlockDataSet):
            parts = [tuple(mesh.GetBlock(i) for mesh in parts[0]) for i in range(2)]
        for new, wanted, old in parts:
            assert np.array_equal(points(new), points(wanted)), source
            assert not np.array_equal(points(new), points(old)), source
        old, new = contents(source), contents(target)
        assert old.keys() == new.keys()
        changed = [name for name in old if not np.array_equal(old[name], new[name])]
        assert changed and all("oord" in name or "COO" in name for name in changed), changed


def test_without_h5py():
    """The error names the package, and the target is as it was."""
    target = FOLDER / "kept.med"
    target.write_text("older")
    found = _array_templates.find_spec
    _array_templates.find_spec = lambda name: None
    try:
        rejected(wording("apt-get-install-python3-h5py"), _array_templates.rewrite_arrays, str(BRACKET), str(target),
                ".med", [], [])  # fmt: skip
    finally:
        _array_templates.find_spec = found
    assert target.read_text() == "older"
    source = FOLDER / "old.cgns"
    source.write_bytes(_array_templates.ADF + b" Database Version A02011>")
    rejected(wording("cgns-convert"), _array_templates.rewrite_arrays, str(source), str(target), ".cgns", [], [])


def test_default():
    """The result of a motion is written as a copy of the file it comes from; a mesh or other formats are not."""
    text = "MeshVersionFormatted 2\nDimension 2\n# kept\nVertices\n5\n0 0 7\n1 0 7\n1 1 7\n0 1 7\n0.4 0.5 0\n"
    text += "Edges\n1\n1 2 9\nTriangles\n4\n1 2 5 3\n2 3 5 3\n3 4 5 4\n4 1 5 4\nEnd\n"
    source, target = FOLDER / "plane.mesh", FOLDER / "new.mesh"
    source.write_text(text)
    result = tl.optimize(tl.untangle(tl.read(source)))
    tl.write(result, target)
    assert "# kept" in target.read_text() and "Edges\n1\n1 2 9\n" in target.read_text()
    assert np.array_equal(points(tl.read(target)), points(result.mesh))
    for options, what in (({"template": False}, result), ({}, result.mesh), ({}, tl.quality(source, "imr"))):
        tl.write(what, target, **options)
        assert "# kept" not in target.read_text(), options
    for suffix in (".vtu", ".msh"):
        tl.write(result, FOLDER / f"new{suffix}")
        assert tl.read(FOLDER / f"new{suffix}").GetNumberOfCells() == 4
    # the file was replaced by one with other cells: the result is written again as a whole, with a warning
    source.write_text(text.replace("1 2 5 3\n", "2 5 1 3\n"))
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        tl.write(result, target)
    assert len(told) == 1 and wording("written-anew") in str(told[0].message), told
    assert "# kept" not in target.read_text() and tl.read(target).GetNumberOfCells() == 4
    # in the place of the file itself, and without it
    source.write_text(text)
    result = tl.optimize(source)
    tl.write(result, source)
    assert "# kept" in source.read_text()
    source.unlink()
    tl.write(result, target)
    assert "# kept" not in target.read_text()


def test_shell():
    """The moving commands write formats of which there are only copies, others do not."""
    source, target = FOLDER / "one.e", FOLDER / "shell.e"
    target.unlink(missing_ok=True)
    shell("perturb", source, "-o", target, "--fraction", 0.3)
    assert not np.array_equal(points(tl.read(target)), points(tl.read(source)))
    assert wording("no-writer-for-e") in shell("convert", BRACKET, target, code=1)
    command = [sys.executable, "-m", "tautline", "improve", source, "-o", target]
    assert wording("no-writer-for-e") in subprocess.run(command, capture_output=True, text=True).stderr
    rejected(wording("no-writer-for-e"), tl.write, tl.read(source), target)
    shutil.copy(source, FOLDER / "lost.e")
    result = tl.perturb(FOLDER / "lost.e", fraction=0.3)
    (FOLDER / "lost.e").unlink()
    rejected(wording("no-writer-for-e"), tl.write, result, target)


run_tests(globals())
