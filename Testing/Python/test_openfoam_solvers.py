# SPDX-License-Identifier: BSD-3-Clause
"""Solvers of OpenFOAM diverge on perturbed meshes and converge after the repair, in as many iterations as before.

Skipped where OpenFOAM or the tutorials are not installed (Debian: openfoam, openfoam-examples).
"""

import shutil
import sys
from pathlib import Path

from checks import OUT, SKIPPED, run_tests, slow

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "OpenFoam"))
from solve_case import CASES, ENVIRONMENT, MESHES, faults, solve_case, table  # noqa: E402

FOLDER = OUT / "openfoam-solvers"


def check(name: str) -> None:
    """A case behaves as it should, and would not without the repair."""
    shutil.rmtree(FOLDER / name, ignore_errors=True)
    outcomes = solve_case(name, FOLDER / name)
    print(table(name, outcomes), flush=True)
    assert not faults(outcomes), faults(outcomes)
    original, perturbed, repaired = (outcomes[mesh] for mesh in MESHES)
    assert faults(dict(zip(MESHES, (original, perturbed, perturbed))))
    assert faults(dict(zip(MESHES, (original, original, repaired))))


def test_polyhedra() -> None:
    """A steady flow through the sample."""
    check("elbow")


def test_hexahedra() -> None:
    """Conduction of heat in a tutorial."""
    check("flange")


@slow
def test_layer() -> None:
    """A steady turbulent flow in one layer of cells."""
    check("pitzDaily")


if not all(shutil.which(case.solver) for case in CASES.values()) or not Path(ENVIRONMENT["FOAM_TUTORIALS"]).is_dir():
    print("skipped: OpenFOAM and its tutorials are not installed")
    sys.exit(SKIPPED)
run_tests(globals())
