# SPDX-License-Identifier: BSD-3-Clause
"""Cases that OpenFOAM has made: checkMesh counts the same, and programs of OpenFOAM read what is written.

Skipped where blockMesh or the tutorials are not installed (Debian: openfoam, openfoam-examples).
"""

import gzip
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import tautline as tl
from checks import OUT, SKIPPED, points, run_tests, shell
from vtkmodules.util.numpy_support import vtk_to_numpy

FOLDER = OUT / "openfoam"
TUTORIALS = Path(os.environ.get("FOAM_TUTORIALS", "/usr/share/doc/openfoam-examples/examples"))
SETTINGS = Path(os.environ.get("WM_PROJECT_DIR", "/usr/share/openfoam"))
CAVITY = TUTORIALS / "incompressible/icoFoam/cavity/cavity"
CYCLIC = TUTORIALS / "DNS/dnsFoam/boxTurb16"
JUNCTION = TUTORIALS / "compressible/rhoPimpleFoam/RAS/TJunctionAverage"
#: VTK's types of cells by their names in the log of checkMesh.
TYPES = {"hexahedra": 12, "prisms": 13, "pyramids": 14, "tetrahedra": 10, "polyhedra": 42}
PARTS = 4
DECOMPOSITION = f"""FoamFile {{ version 2.0; format ascii; class dictionary; object decomposeParDict; }}
numberOfSubdomains {PARTS};
method simple;
coeffs {{ n (2 2 1); delta 0.001; }}
simpleCoeffs {{ n (2 2 1); delta 0.001; }}
"""


def openfoam(case: Path, program: str, *arguments: str) -> str:
    """The output of a program of OpenFOAM in the directory of a case."""
    environment = {**os.environ, "WM_PROJECT_DIR": str(SETTINGS)}
    done = subprocess.run([program, *arguments], cwd=case, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, (case, program, done.stdout[-2000:], done.stderr)
    return done.stdout


def made(source: Path, name: str) -> Path:
    """A new copy of a tutorial with the mesh of blockMesh."""
    case = FOLDER / name
    shutil.rmtree(case, ignore_errors=True)
    shutil.copytree(source, case)
    for file in case.rglob("*.gz"):
        file.with_suffix("").write_bytes(gzip.decompress(file.read_bytes()))
        file.unlink()
    openfoam(case, "blockMesh")
    (case / "case.foam").touch()
    return case


def copied(case: Path, name: str) -> Path:
    target = FOLDER / name
    shutil.rmtree(target, ignore_errors=True)
    return Path(shutil.copytree(case, target))


def facts(mesh) -> dict:
    """Points, cells and arrays, for comparison."""
    cells = mesh.GetCells()
    found = {
        "points": points(mesh),
        "connectivity": vtk_to_numpy(cells.GetConnectivityArray()),
        "offsets": vtk_to_numpy(cells.GetOffsetsArray()),
        **mesh.cell_data,
    }
    fields = mesh.GetFieldData()
    for i in range(fields.GetNumberOfArrays()):
        array = fields.GetAbstractArray(i)
        if array.GetName() != "FoamCase":
            values = [array.GetVariantValue(k).ToString() for k in range(array.GetNumberOfValues())]
            found[array.GetName()] = np.array(values)
    return found


def check_same(one, other) -> None:
    mine, its = facts(one), facts(other)
    assert mine.keys() == its.keys()
    for name, values in mine.items():
        assert np.array_equal(values, its[name]), name


def check_counts(case: Path, *options: str, **how) -> None:
    """Points, faces and cells by their type match checkMesh."""
    log = openfoam(case, "checkMesh", "-constant", *options)

    def count(name: str) -> int:
        return int(re.search(rf"^\s+{name}:\s+(\d+)", log, re.MULTILINE)[1])

    mesh = tl.read(case / "case.foam", **how)
    types = np.bincount(vtk_to_numpy(mesh.GetCellTypesArray()), minlength=max(TYPES.values()) + 1)
    assert mesh.GetNumberOfPoints() == count("points")
    assert {name: int(types[kind]) for name, kind in TYPES.items()} == {name: count(name) for name in TYPES}
    assert mesh.GetNumberOfCells() == count("cells") + count("faces") - count("internal faces")


def test_forms():
    """Text, bytes and compressed files give the same mesh."""
    for source in (CAVITY, CYCLIC):
        case = made(source, source.name)
        check_counts(case)
        mesh = tl.read(case / "case.foam")
        for form, compression in (("binary", "off"), ("ascii", "on"), ("binary", "on")):
            other = copied(case, f"{source.name}-{form}-{compression}")
            settings = other / "system" / "controlDict"
            text = re.sub(r"writeFormat.*;", f"writeFormat {form};", settings.read_text())
            text = re.sub(r"writeCompression.*;", f"writeCompression {compression};", text)
            settings.write_text(re.sub(r"writePrecision.*;", "writePrecision 17;", text))
            openfoam(other, "foamFormatConvert", "-constant")
            check_same(tl.read(other / "case.foam"), mesh)


def test_polyhedra():
    """The dual mesh of a case: polyhedra in the order of OpenFOAM."""
    case = made(JUNCTION, "dual")
    shutil.rmtree(case / "0", ignore_errors=True)
    openfoam(case, "polyDualMesh", "75", "-overwrite")
    check_counts(case)


def test_decomposed():
    """The processors' meshes are put together as before decomposePar; without its lists along their patches."""
    for source in (CAVITY, CYCLIC):
        case = made(source, f"{source.name}-parts")
        for folder in ("0", "0.orig"):
            shutil.rmtree(case / folder, ignore_errors=True)
        (case / "system" / "decomposeParDict").write_text(DECOMPOSITION)
        openfoam(case, "decomposePar")
        mesh = tl.read(case / "case.foam", decomposed=False)
        check_same(tl.read(case / "case.foam", decomposed=True), mesh)
        check_joined(copied(case, f"{source.name}-joined"), mesh)
        # written back, the processors have what the whole mesh has
        moved = tl.read(case / "case.foam", decomposed=True)
        moved.GetPoints().SetPoint(0, -1e-6, 0, 0)
        assert len(tl.write(moved, case / "case.foam")) == PARTS
        check_same(tl.read(case / "case.foam", decomposed=True), moved)


def check_joined(case: Path, mesh) -> None:
    """Without the lists of decomposePar there are as many points and cells, in order."""
    for file in case.glob("processor*/constant/polyMesh/*ProcAddressing*"):
        file.unlink()
    joined = tl.read(case / "case.foam", decomposed=True)
    assert joined.GetNumberOfPoints() == mesh.GetNumberOfPoints()
    assert joined.GetNumberOfCells() == mesh.GetNumberOfCells()
    assert joined.GetFieldData().GetArray("FacesOutOfOrder").GetValue(0) == 0
    for each in (mesh, joined):
        check_cyclic(each)


def check_cyclic(mesh) -> None:
    """The faces of both halves of a pair correspond by their numbers: they differ by the same vector."""
    patches = mesh.cell_data["Patch"]
    pairs = vtk_to_numpy(mesh.GetFieldData().GetArray("NeighbourPatch"))
    where = points(mesh)
    offsets, nodes = facts(mesh)["offsets"], facts(mesh)["connectivity"]
    for patch, other in enumerate(pairs):
        if other > patch:
            centers = [
                np.array([where[nodes[offsets[i] : offsets[i + 1]]].mean(axis=0) for i in np.flatnonzero(patches == p)])
                for p in (patch, other)
            ]
            steps = centers[1] - centers[0]
            assert len(steps) and np.abs(steps - steps[0]).max() < 1e-9 * np.abs(where).max()


def test_order():
    """Faces that are not in upper triangular order are counted as checkMesh counts them."""
    case = made(CAVITY, "order")
    folder = case / "constant" / "polyMesh"
    for first, second in ((0, 1), (10, 33)):
        for name in ("faces", "owner", "neighbour"):
            text = (folder / name).read_text()
            start = re.search(r"^\d+\s*\n\(\n", text, re.MULTILINE).end()
            lines = text[start:].split("\n")
            lines[first], lines[second] = lines[second], lines[first]
            (folder / name).write_text(text[:start] + "\n".join(lines))
        log = openfoam(case, "checkMesh", "-constant")
        expected = int(re.search(r"Writing (\d+) unordered faces", log)[1])
        found = tl.read(case / "case.foam").GetFieldData().GetArray("FacesOutOfOrder").GetValue(0)
        assert found == expected, (found, expected)


def test_written():
    """OpenFOAM reads the written case: everything is unchanged except the points inside."""
    case = made(JUNCTION, "written")
    folder = case / "constant" / "polyMesh"
    before = {file.name: file.read_bytes() for file in folder.iterdir()}
    shell("perturb", case / "case.foam", "--in-place", "--keep-original", "--fraction", 0.9)
    after = {file.name: file.read_bytes() for file in folder.iterdir()}
    assert after.pop("points.orig") == before["points"] != after["points"]
    assert all(content == after[name] for name, content in before.items() if name != "points")

    def skewness() -> float:
        return float(re.search(r"Max skewness = (\S+)", openfoam(case, "checkMesh", "-constant"))[1])

    worse = skewness()
    shell("optimize", case / "case.foam", "--in-place")
    assert skewness() < 0.8 * worse


if not shutil.which("blockMesh") or not CAVITY.is_dir() or not SETTINGS.is_dir():
    print("skipped: OpenFOAM or its tutorials are not installed (Debian: openfoam, openfoam-examples)")
    sys.exit(SKIPPED)
FOLDER.mkdir(exist_ok=True)
run_tests(globals())
