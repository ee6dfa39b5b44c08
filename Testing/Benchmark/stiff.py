# SPDX-License-Identifier: BSD-3-Clause
"""The study of stretched meshes: what BenchmarkStiff measures, against what it must reach.

Grids on the unit square or cube whose inner points are moved, and the meshes of the directory in the environment
variable TAUTLINE_TEST_DATA. Every figure is for the sum of squared inverse mean ratios with the boundary fixed, by the
default optimizer on one thread. Passes are of the yardstick (see Yardstick.h).
"""

import os
import subprocess
from pathlib import Path

DATA = os.environ.get("TAUTLINE_TEST_DATA")
Row = tuple[str, float, str]

# Grid, cells, CPU seconds to 1.00001 of the minimum.
AIMS = [("quads-sine", 64**2, 0.15), ("quads-power4", 64**2, 0.15), ("quads-sine", 256**2, 1.5),
        ("hexes-power3", 32**3, 3.0), ("quads-power4", 256**2, 5.0)]
TYPES = ("triangles", "quads", "tets", "hexes")
ASPECTS, CELLS = (1, 10, 100, 1000), 10_000  # of the first row of cells; cells of a grid of these
SIZES, ASPECT, HUGE = (1_000, 10_000, 100_000), 10, 1_000_000
QUICK_CELLS = 100
# Mesh, its minimum (0: found by Newton's method), passes of the fastest known peer to convergence.
FILES = [("meshes", "disk2d_20k_p50", 20037.088, 168), ("meshes", "disk3d_50k_p50", 82139.465, 136),
         ("meshes", "tri_20258", 0, None), ("meshes", "tire", 0, None), ("meshes", "large_box_hex_1000", 0, None),
         ("tangled", "hex_5_tangled", 0, None), ("tangled", "tet_4_tangled", 0, None),
         ("tangled", "tangled_quad", 0, None), ("hex", "CAD4", 0, None), ("hex", "rkm012", 0, None)]
FOLDERS = ("meshes", "tangled", "hex")  # whose meshes are optimized by each of our methods
COMPARED_MOST = 3e6  # bytes of a file, for a run of some minutes
SLOWER = 2  # times the time of the fastest of our methods that the default may take
WORST_RATIO = 1.001  # of the sum to the minimum


def measure(program: Path, *arguments: object) -> dict[str, float]:
    text = subprocess.run([str(program), *map(str, arguments)], check=True, stdout=subprocess.PIPE, text=True).stdout
    return {key: float(number) for key, number in (line.split("\t") for line in text.splitlines())}


def rows_of(name: str, m: dict[str, float], seconds: float | None = None, peer: float | None = None) -> list[Row]:
    """The rows of one mesh; its sum must be near the minimum, which the times do not show."""
    rows = [(f"{name}: sum / minimum", m["sum / minimum"], f"<= {WORST_RATIO}"),
            ("  at the start", m["sum at the start / minimum"], ""),
            ("  iterations", m["iterations"], ""), ("  passes", m["passes"], "")]
    if seconds:
        reached = m["seconds to 1.00001"] or float("1e9")  # 0 stands for never
        rows.append(("  CPU seconds to 1.00001 of the minimum", reached, f"<= {seconds}"))
    if peer:
        rows.append(("  passes / passes of Mesquite's Feasible Newton", m["passes"] / peer, "<= 1"))
    return rows


def compare(program: Path, repeats: int, measured: dict[str, float]) -> list[Row]:
    """The default against each of our methods, on all meshes of the directory: CPU time to 1.001 of the least sum."""
    rows: list[Row] = []
    for folder in FOLDERS if DATA else ():
        for file in sorted(Path(DATA, folder).glob("*.vtk")):
            if file.stat().st_size > COMPARED_MOST:
                continue
            try:
                m = measure(program, "compare", file, repeats)
            except subprocess.CalledProcessError:  # nothing is free to move, or some element stays invalid
                print(f"compare {file.stem}: left out")
                continue
            measured |= {f"compare {file.stem}: {key}": value for key, value in m.items()}
            print(f"compare {file.stem}: " + ", ".join(f"{key} {value:.6g}" for key, value in m.items()), flush=True)
            rows += [(f"{file.stem}: sum of the default / least of all methods", m["automatic sum / minimum"],
                      f"<= {WORST_RATIO}"),
                     ("  seconds of the default / fastest method", min(m["automatic / fastest"], 1e9), f"<= {SLOWER}")]
    return rows


def run(program: Path, repeats: int, quick: bool, huge: bool) -> tuple[dict[str, float], list[Row]]:
    """All meshes: what the program prints, and the table."""
    measured: dict[str, float] = {}
    rows: list[Row] = []

    def add(name: str, m: dict[str, float], seconds: float | None = None, peer: float | None = None) -> None:
        measured.update({f"{name}: {key}": value for key, value in m.items()})
        print(f"{name}: " + ", ".join(f"{key} {value:.6g}" for key, value in m.items()), flush=True)
        rows.extend(rows_of(name, m, seconds, peer))

    for grid, cells, seconds in AIMS[:2] if quick else AIMS:
        size = QUICK_CELLS if quick else cells
        add(f"{grid} {size}", measure(program, "grid", grid, size, "automatic", repeats), None if quick else seconds)
    for kind in TYPES:
        for aspect in ASPECTS:
            grid, cells = f"{kind}-aspect{aspect}", QUICK_CELLS if quick else CELLS
            add(f"{grid} {cells}", measure(program, "grid", grid, cells, "automatic", repeats))
        for cells in () if quick else (*SIZES, *([HUGE] if huge else [])):
            if cells != CELLS:
                grid = f"{kind}-aspect{ASPECT}"
                add(f"{grid} {cells}", measure(program, "grid", grid, cells, "automatic", 1))
    for folder, mesh, best, peer in FILES if DATA and not quick else ():
        file = Path(DATA, folder, f"{mesh}.vtk")
        if file.exists():
            add(mesh, measure(program, "file", file, "automatic", repeats, best), None, peer)
    if not quick:
        rows += compare(program, repeats, measured)
    return measured, rows
