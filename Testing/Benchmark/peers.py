# SPDX-License-Identifier: BSD-3-Clause
"""The optimizer next to other programs: what BenchmarkPeers measures, with ratios where a mesh is public.

The meshes of HexOpt (arXiv 2410.11656) are in the folder hex of the directory in the environment variable
TAUTLINE_TEST_DATA, the mesh of tetrahedra in its folder meshes. The disk and the box are made by the program, like the
meshes that peers were run on, which are not public: they are compared with our own methods only.
"""

import os
import subprocess
from pathlib import Path

DATA = os.environ.get("TAUTLINE_TEST_DATA")
Row = tuple[str, float, str]

# Mesh, the worst scaled Jacobian published by HexOpt, with a surface within this fraction of the diagonal.
HEXOPT = [("CAD4", 0.12), ("rkm012", 0.60)]
SURFACE = 1e-3
DISK, DISK_QUICK = 129_000, 600
BOX, BOX_QUICK = (28, 24, 16), (4, 4, 3)  # 10,752 hexahedra
ISOTROPIC, CUBES_QUICK = "disk3d_50k_p50", 4
RATIO = 1.001  # of the sum to the least of our methods
SLOWER = 2  # times the time of Newton's method that the default may take on a stretched mesh
SLOWED = 1.02  # of the default to local sweeps on isotropic tetrahedra
TURNS = 9  # of which the best counts, for a difference of some percent


def measure(program: Path, *arguments: object) -> dict[str, float]:
    text = subprocess.run([str(program), *map(str, arguments)], check=True, stdout=subprocess.PIPE, text=True).stdout
    return {key: float(number) for key, number in (line.split("\t") for line in text.splitlines())}


def of_hexopt(mesh: str, published: float, m: dict[str, float]) -> list[Row]:
    """The preset for the worst element on a mesh of HexOpt, next to the worst scaled Jacobian published for it."""
    return [
        (f"{mesh}: worst scaled Jacobian before", m["worst scaled Jacobian before"], ""),
        ("  after Worst element", m["worst scaled Jacobian"], ""),
        ("  / HexOpt's, published", m["worst scaled Jacobian"] / published, ">= 1"),
        ("  distance of the surface / diagonal", m["surface error / diagonal"], f"<= {SURFACE}"),
        ("  invalid hexahedra", m["invalid"], "<= 0"),
        ("  CPU seconds", m["seconds"], ""),
    ]


def of_methods(name: str, m: dict[str, float], least: float) -> list[Row]:
    """The default and Newton's method on a stretched mesh. least: the smallest sum that is known."""
    return [
        (f"{name}: mean IMR at the start", m["start mean"], ""),
        ("  mean IMR, default", m["default mean"], ""),
        ("  mean IMR, Newton-CG", m["Newton mean"], ""),
        ("  sum / least known, default", m["default sum"] / least, f"<= {RATIO}"),
        ("  sum / least known, Newton-CG", m["Newton sum"] / least, ""),
        ("  CPU seconds, default", m["default seconds"], ""),
        ("  CPU seconds, Newton-CG", m["Newton seconds"], ""),
        ("  seconds, default / Newton-CG", m["default seconds"] / m["Newton seconds"], f"<= {SLOWER}"),
    ]


def run(program: Path, repeats: int, quick: bool) -> tuple[dict[str, float], list[Row]]:
    """All meshes: what the program prints, and the table."""
    measured: dict[str, float] = {}
    rows: list[Row] = []

    def add(name: str, *arguments: object) -> dict[str, float]:
        m = measure(program, *arguments)
        measured.update({f"{name}: {key}": value for key, value in m.items()})
        print(f"{name}: " + ", ".join(f"{key} {value:.6g}" for key, value in m.items()), flush=True)
        return m

    for mesh, published in HEXOPT if DATA and not quick else ():
        file = Path(DATA, "hex", f"{mesh}.vtk")
        if not file.exists():
            print(f"{mesh}: left out, it is not in {DATA}")
            continue
        m = add(mesh, "worst", file)
        rows += of_hexopt(mesh, published, m)
    disk = DISK_QUICK if quick else DISK
    m = add("stretched disk", "disk", disk, repeats)
    rows += of_methods(f"disk of {m['elements']:.0f} triangles, r (1 + 0.3 sin(pi r))", m,
                       min(m["default sum"], m["Newton sum"]))
    box = BOX_QUICK if quick else BOX
    m = add("stretched box", "box", *box, repeats)
    rows += of_methods(f"box of {box[0]} x {box[1]} x {box[2]} hexahedra, y^3", m, m["least sum"])
    file = Path(DATA or "", "meshes", f"{ISOTROPIC}.vtk")
    turns = repeats if quick else max(repeats, TURNS)
    if DATA and file.exists() and not quick:
        name, m = ISOTROPIC, add("isotropic", "isotropic", file, turns)
    else:
        cubes = CUBES_QUICK if quick else 20
        name, m = f"{6 * cubes**3} perturbed tetrahedra", add("isotropic", "cubes", cubes, turns)
    rows += [
        (f"{name}: seconds, default / Local Newton", m["default seconds"] / m["local seconds"], f"<= {SLOWED}"),
        ("  sum, default / Local Newton", m["default sum"] / m["local sum"], ""),
    ]
    return measured, rows
