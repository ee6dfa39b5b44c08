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
from compare_cases import compare, verdict  # noqa: E402
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
#: Meshes that are compared at least.
LEAST = 45
#: What is made beside them, with faults of all kinds; these the reader refuses.
REFUSED = {"synthetic_corner_twice", "synthetic_face_twice", "synthetic_open_cell"}
#: checkMesh gives a mesh without any direction an aspect ratio of -1.
OTHER = {"synthetic_empty_odd"}
#: Meshes that points can repair.
REPAIRED = ("synthetic_hexes_moved_100", "synthetic_dual_moved_70", "synthetic_tetrahedra_moved_70",
            "synthetic_periodic_moved")  # fmt: skip


def made() -> Path:
    """The cases, with the fields and the log of checkMesh."""
    cases = FOLDER / "cases"
    shutil.rmtree(FOLDER, ignore_errors=True)
    command = [sys.executable, SCRIPTS / "make_cases.py", "--work", FOLDER / "work", "--cases", cases, "--synthetic"]
    done = subprocess.run([*command, *TUTORIALS], env=ENVIRONMENT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return cases


def failed_checks(case: Path) -> int:
    """What checkMesh says."""
    log = case / "log.again"
    with log.open("w", encoding="utf-8") as output:
        subprocess.run(["checkMesh", "-constant"], cwd=case, env=ENVIRONMENT, stdout=output, check=True)
    return verdict(log)


def boundary_points(mesh) -> np.ndarray:
    """The numbers of the points of patches."""
    patches = vtk_to_numpy(mesh.GetCellData().GetArray("Patch"))
    ids = [mesh.GetCell(cell).GetPointIds() for cell in np.flatnonzero(patches >= 0)]
    return np.unique([of.GetId(k) for of in ids for k in range(of.GetNumberOfIds())])


def test_agreement() -> None:
    """Every field and the number of failed checks."""
    found = [compare(file.parent) for file in sorted(CASES.glob("*/log.checkMesh"))]
    assert len(found) >= LEAST, len(found)
    assert {one.name for one in found if one.refused} == REFUSED, [one.refused for one in found]
    wrong = [one for one in found if not one.agrees and one.name not in REFUSED | OTHER]
    assert not wrong, [(one.name, one.failed, one.failed_by_checkmesh, one.wrong) for one in wrong]
    assert any(one.failed for one in found) and any(one.failed == 0 for one in found)


def test_repair() -> None:
    """OpenFOAM itself says so, of the case that the shell has changed; the boundary is where it was."""
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


if not shutil.which("checkMesh") or not Path(ENVIRONMENT["FOAM_TUTORIALS"]).is_dir():
    print("skipped: OpenFOAM and its tutorials are not installed")
    sys.exit(SKIPPED)
CASES = made()
run_tests(globals())
