# SPDX-License-Identifier: BSD-3-Clause
"""The worst corner of meshes of hexahedra whose boundary slides on their own surface: what BenchmarkHexes measures.

The meshes are in the folder hex of the directory in the environment variable TAUTLINE_TEST_DATA.
"""

import os
from pathlib import Path

from peers import Row, measure

DATA = os.environ.get("TAUTLINE_TEST_DATA")
MESHES = ("CAD4", "rkm012", "lower_arm")
# Degrees: features kept, and none.
ANGLES = {"features kept": 40, "features free": 180}
SURFACE = 1.2e-3  # of the diagonal; distances are also measured between the samples that are held
SECONDS = 20


def run(program: Path, quick: bool) -> tuple[dict[str, float], list[Row]]:
    """All meshes: what the program prints, and the table."""
    measured: dict[str, float] = {}
    rows: list[Row] = []
    for mesh in () if quick else MESHES:
        file = Path(DATA or "", "hex", f"{mesh}.vtk")
        if not DATA or not file.exists():
            print(f"{mesh}: left out, it is not in {DATA}")
            continue
        for what, angle in ANGLES.items():
            m = measure(program, file, angle)
            measured |= {f"{mesh}, {what}: {key}": value for key, value in m.items()}
            rows += [
                (f"{mesh}, {what}: worst scaled Jacobian before", m["worst before"], ""),
                ("  after Worst element", m["worst"], ""),
                ("  invalid hexahedra before", m["invalid before"], ""),
                ("  invalid hexahedra", m["invalid"], "<= 0"),
                ("  distance from mesh to surface / diagonal", m["from the mesh"], f"<= {SURFACE}"),
                ("  distance from surface to mesh / diagonal", m["from the surface"], f"<= {SURFACE}"),
                ("  mean inverse mean ratio before", m["mean inverse mean ratio before"], ""),
                ("  mean inverse mean ratio", m["mean inverse mean ratio"], ""),
                ("  CPU seconds", m["seconds"], f"<= {SECONDS}"),
            ]
    return measured, rows
