# SPDX-License-Identifier: BSD-3-Clause
"""test_faces_on_ranks.py PVBATCH: on 1 and 3 MPI ranks the metrics of finite volumes and the checks of checkMesh
have the values of one process, on cases of OpenFOAM, decomposed ones among them where OpenFOAM is installed, and on
plane meshes, also with ghost cells; skipped without mpirun.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
from on_ranks import OUT, run

#: Fewer than the processors of the decomposed cases, so that one rank reads two.
RANKS = 3
CLOSE = 1e-9
ROUNDING_OF_ANGLES = 1e-5  # degrees, of angles near 0
REPAIRED_CLOSE = 1e-3  # degrees, where rounding has grown in many iterations
DATA = Path(__file__).parents[2] / "Data"
ELBOW, FAILING = DATA / "elbow", DATA / "elbow-failing"
SCRIPTS = Path(__file__).parents[1] / "OpenFoam"
#: One layer; periodic in three directions, so that sides that belong together are on different processes.
TUTORIALS = ("incompressible/icoFoam/cavity/cavity", "DNS/dnsFoam/boxTurb16")
TUTORIAL_FOLDER = "/usr/share/doc/openfoam-examples/examples"


def decomposed_cases() -> list[Path]:
    """Cases of which one rank puts the whole together, and several read processors; none without OpenFOAM."""
    environment = {"FOAM_TUTORIALS": TUTORIAL_FOLDER, "WM_PROJECT_DIR": "/usr/share/openfoam", **os.environ}
    if not shutil.which("decomposePar") or not Path(environment["FOAM_TUTORIALS"]).is_dir():
        print("there is no OpenFOAM: decomposed cases are not compared")
        return []
    folder = OUT / "faces-on-ranks"
    shutil.rmtree(folder, ignore_errors=True)
    command = [sys.executable, SCRIPTS / "make_cases.py", "--work", folder / "work", "--cases", folder / "cases",
               "--decompose", "4", *TUTORIALS]  # fmt: skip
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    cases = [file.parent for file in sorted((folder / "cases").rglob("processor0"))][: len(TUTORIALS)]
    assert len(cases) == len(TUTORIALS), cases
    # Ranks read processors, or, with constant/polyMesh alone, parts of it.
    wholes = []
    for case in cases:
        wholes.append(case.with_name(f"{case.name}_whole"))
        shutil.copytree(case, wholes[-1], ignore=shutil.ignore_patterns("processor*"))
        shutil.rmtree(case / "constant" / "polyMesh")
    return [*cases, *wholes]


def foam_file(case: Path, folder: Path) -> str:
    copy = folder / case.name
    shutil.copytree(case, copy, dirs_exist_ok=True)
    (copy / f"{case.name}.foam").touch()
    return str(copy / f"{case.name}.foam")


copies = OUT / "faces-on-ranks-copies"
shutil.rmtree(copies, ignore_errors=True)
cases = [foam_file(case, copies) for case in (ELBOW, FAILING, *decomposed_cases())]
one = run("faces_on_ranks.py", 1, *cases)
assert any(one[cases[0]]["checks"]["Maximum"])
found = run("faces_on_ranks.py", RANKS, *cases)
for name in (*cases, "plane 0", "plane 1"):
    a, b = found[name], one[name]
    for metric, values in b["cells"].items():
        assert len(values) == len(a["cells"][metric]) > 0, (name, metric)
        tolerance = ROUNDING_OF_ANGLES if metric == "non_orthogonality" else CLOSE
        assert np.allclose(a["cells"][metric], values, rtol=CLOSE, atol=tolerance), (name, metric)
    for column, values in b["checks"].items():
        same = a["checks"][column] == values
        assert same or np.allclose(a["checks"][column], values, rtol=CLOSE, atol=CLOSE), (name, column)
    assert (a["faces"], a["inner faces"]) == (b["faces"], b["inner faces"]), name
    angles = a["angles of faces"], b["angles of faces"]
    assert np.allclose(*angles, rtol=CLOSE, atol=ROUNDING_OF_ANGLES), name
repaired = [results[f"repaired {cases[1]}"]["angles of faces"] for results in (found, one)]
assert np.allclose(*repaired, rtol=0, atol=REPAIRED_CLOSE), np.abs(np.subtract(*repaired)).max()
for results in (one, found):
    after = results[f"repaired {cases[1]}"]["checks"]
    offending = dict(zip(after["Check"], after["Offending"]))
    assert offending["non_orthogonality"] == offending["pyramid_volume"] == offending["face_skewness"] == 0, offending
    assert one[cases[1]]["checks"]["Offending"] != after["Offending"]
print(RANKS, "ranks:", {Path(name).stem: found[name]["faces"] for name in cases}, "faces")
