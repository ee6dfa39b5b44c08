# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of OpenFOAM's tutorials: the same fields and verdict as checkMesh, and "Mesh OK" after a repair.

Skipped where OpenFOAM or the tutorials are not installed (Debian: openfoam, openfoam-examples). The scripts in
Testing/OpenFoam do the same with all tutorials.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import tautline as tl
from checks import OUT, SKIPPED, points, run_tests, shell

SCRIPTS = Path(__file__).resolve().parents[1] / "OpenFoam"
sys.path.insert(0, str(SCRIPTS))
import repair_cases  # noqa: E402
from compare_cases import Cases, Reading, compare, compare_mesh, meshes_of, page, verdict  # noqa: E402
from vtkmodules.util.numpy_support import vtk_to_numpy  # noqa: E402

FOLDER = OUT / "openfoam-checks"
ENVIRONMENT = {
    "FOAM_TUTORIALS": "/usr/share/doc/openfoam-examples/examples",
    "WM_PROJECT_DIR": "/usr/share/openfoam",
    **os.environ,
}
#: One layer, periodic in three directions, a wedge, and skewed faces.
TUTORIALS = (
    "incompressible/icoFoam/cavity/cavity",
    "DNS/dnsFoam/boxTurb16",
    "IO/fileHandler",
)
#: Several regions; and meshes in pieces, the second with parts of a periodic side on other processes.
IN_PIECES = ("heatTransfer/chtMultiRegionFoam/multiRegionHeater", "DNS/dnsFoam/boxTurb16")
PIECES = 3
#: Meshes that are compared at least.
LEAST = 45
#: Meshes that are made beside them, with faults of all kinds; the reader rejects these.
REJECTED = {"synthetic_corner_twice", "synthetic_face_twice", "synthetic_open_cell"}
#: checkMesh gives a mesh without any direction an aspect ratio of -1.
OTHER = {"synthetic_empty_odd"}
#: Meshes of repair_cases.py, and how far points of others are moved.
LISTED = ("synthetic_tetrahedra_moved_35", "synthetic_dual_of_hexes", "incompressible_icoFoam_cavity_cavityGrade")
MOVED = {"synthetic_dual_of_hexes": 1.2, "incompressible_icoFoam_cavity_cavityGrade": 1.0}
#: Meshes that points can repair.
REPAIRED = ("synthetic_hexes_moved_100", "synthetic_dual_moved_70", "synthetic_tetrahedra_moved_70",
            "synthetic_periodic_moved")  # fmt: skip


def made(name: str, *arguments: str) -> Path:
    """Cases, with the fields and the log of checkMesh."""
    cases = FOLDER / name
    command = [sys.executable, SCRIPTS / "make_cases.py", "--work", FOLDER / "work", "--cases", cases, *arguments]
    done = subprocess.run(command, env=ENVIRONMENT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return cases


def failed_checks(case: Path) -> int:
    """The verdict of checkMesh."""
    log = case / "log.again"
    with log.open("w", encoding="utf-8") as output:
        subprocess.run(["checkMesh", "-constant"], cwd=case, env=ENVIRONMENT, stdout=output, check=True)
    return verdict(log)


def boundary_points(mesh) -> np.ndarray:
    """The numbers of the points of patches."""
    patches = vtk_to_numpy(mesh.GetCellData().GetArray("Patch"))
    offsets, nodes = (vtk_to_numpy(array) for array in (mesh.GetCells().GetOffsetsArray(),
                                                        mesh.GetCells().GetConnectivityArray()))  # fmt: skip
    facets = np.flatnonzero(patches >= 0)
    return np.unique(np.concatenate([nodes[offsets[facet] : offsets[facet + 1]] for facet in facets]))


def test_agreement() -> None:
    """Every field and the number of failed checks."""
    found = [compare(file.parent) for file in sorted(CASES.glob("*/log.checkMesh"))]
    assert len(found) >= LEAST, len(found)
    assert {one.name for one in found if one.rejected} == REJECTED, [one.rejected for one in found]
    wrong = [one for one in found if not one.agrees and one.name not in REJECTED | OTHER]
    assert not wrong, [(one.name, one.failed, one.failed_by_checkmesh, one.wrong) for one in wrong]
    assert any(one.failed for one in found) and any(one.failed == 0 for one in found)


def test_pieces_and_regions() -> None:
    """Each region has its own mesh; pieces are compared put together by their addresses, and joined."""
    if not shutil.which("mpirun"):
        print("not compared: pieces, without mpirun")
        return
    folder = made("pieces", "--decompose", str(PIECES), *IN_PIECES)
    meshes = [mesh for file in sorted(folder.glob("*/log.checkMesh")) for mesh in meshes_of(file.parent)]
    assert len({mesh.region for mesh in meshes}) > 2, meshes
    for reading in Reading:
        of = [mesh for mesh in meshes if mesh.reading == reading]
        assert len(of) == len(meshes) / len(Reading), (reading, of)
        found = [compare_mesh(mesh, f"{mesh.case.name} {mesh.region}") for mesh in of]
        assert all(one.agrees for one in found), [one for one in found if not one.agrees]
    assert all(len(mesh.pieces) == PIECES for mesh in meshes)


def test_page() -> None:
    """The page counts each mesh once, and names those that differ."""
    cases = Cases()
    cases.add(CASES)
    before = len(cases.meshes)
    cases.add(CASES)
    assert len(cases.meshes) == before
    compared = [compare_mesh(mesh, name) for name, mesh in cases.meshes.values()]
    text = page(cases, compared)
    rejected = sum(one.rejected != "" for one in compared)
    agreeing = sum(one.agrees for one in compared)
    cells = sum(one.cells for one in compared)
    assert f"| all | {before} | {cells} | {agreeing} | {before - agreeing - rejected} | {rejected} |" in text
    rows = [line for line in text.split("## Meshes")[1].splitlines() if line.startswith("|synthetic")]
    assert len(rows) == sum(one.name.startswith("synthetic/") for one in compared)
    assert all(f"  - {one.name}" in text for one in compared if not one.agrees)


def test_untangle_polyhedra() -> None:
    for name in ("synthetic_dual_moved_70", "synthetic_hexes_moved_300"):
        tangled = tl.read(CASES / name / f"{name}.foam")
        result = tl.untangle(tangled)
        assert result.inverted_before > 5 and result.inverted == 0 and (result.validity != -1).all(), name
        moved = np.flatnonzero((points(tangled) != result.points).any(axis=1))
        assert not np.isin(moved, boundary_points(tangled)).any(), name


def test_repair() -> None:
    """OpenFOAM itself confirms it for the case that the shell has changed; the boundary is where it was."""
    for name in REPAIRED:
        case = CASES / name
        assert failed_checks(case) > 0, name
        before = {file: file.read_bytes() for file in (case / "constant/polyMesh").iterdir() if file.is_file()}
        foam = case / f"{name}.foam"
        mesh = tl.read(foam)
        shell("optimize", foam, "--preset", "finite volumes", "--in-place")
        assert failed_checks(case) == 0, name
        changed = {file.name for file, content in before.items() if file.read_bytes() != content}
        assert changed == {"points"}, (name, changed)
        moved = np.flatnonzero((points(mesh) != points(tl.read(foam))).any(axis=1))
        assert len(moved) and not np.isin(moved, boundary_points(mesh)).any(), name


def test_failing_meshes() -> None:
    """Meshes of the list that is kept, also one layer with moved points: they pass, with the boundary in place."""
    for name in LISTED:
        found = repair_cases.repair(CASES / name, FOLDER / "repair", MOVED.get(name, 0.0))
        assert found.failed_before > 0 == found.failed, found
        assert found.surface < repair_cases.SURFACE, found


if not shutil.which("checkMesh") or not Path(ENVIRONMENT["FOAM_TUTORIALS"]).is_dir():
    print("skipped: OpenFOAM and its tutorials are not installed")
    sys.exit(SKIPPED)
shutil.rmtree(FOLDER, ignore_errors=True)
CASES = made("cases", "--synthetic", *TUTORIALS)
run_tests(globals())
