# SPDX-License-Identifier: BSD-3-Clause
"""reconnection_aims.py [--quick] [--large]: what Improve Mesh is to reach, mesh by mesh.

Prints a row per figure with its aim, and the number of aims missed. One thread, CPU seconds, unless stated otherwise.
The tire and the disks are those in the folder `meshes` of the directory TAUTLINE_TEST_DATA, left out without it.
--large: also the disk of a million tetrahedra. --quick: small generated meshes only, without aims.
"""

from __future__ import annotations

import argparse
import lzma
import os
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import tautline as tl
from gmsh_comparison import gmsh_box, sphere, tetgen, tetrahedra
from tautline.studies.reconnection import PLANAR, against_refinement

Row = tuple[str, float, str]

CELLS, QUICK_CELLS = 40_000, 600
PERTURBED = 0.97  # of the distance to inversion
SLIDING_TARGET = 38.8
DOMAINS = ("sphere", "bore", "barrier3d")
#: The angle, in degrees, that other domains and meshes are to reach with a sliding boundary.
SLIDING_ANGLE = 36.0
#: Wall time is the best of this many runs.
REPEATS = 3
GMSH_SIZE = 0.05
MEAN_ALLOWANCE = 1.02
LARGEST_COUNT = 1.1  # the default of improve()


def read(name: str) -> Any:
    """The tetrahedra of a mesh in TAUTLINE_TEST_DATA, compressed or not."""
    file = Path(os.environ["TAUTLINE_TEST_DATA"], "meshes", name)
    if file.exists():
        return tetrahedra(tl.read(file))
    with tempfile.TemporaryDirectory() as folder:
        plain = Path(folder, name)
        plain.write_bytes(lzma.decompress(file.with_name(name + ".xz").read_bytes()))
        return tetrahedra(tl.read(plain))


class Table:
    """Rows of figures: the label, the number, and the aim as text."""

    def __init__(self, aims: bool) -> None:
        self.aims = aims
        self.rows: list[Row] = []

    def add(self, label: str, number: float, aim: str = "") -> None:
        self.rows.append((label, float(number), aim if self.aims else ""))
        print(f"{label:74}{number:12.5g}{self.rows[-1][2]:>10}", flush=True)

    def improve(self, label: str, mesh: Any, angle: float | None, ratio: float | None, *, seconds: float | None = None,
                microseconds: float | None = None, **options: Any) -> Any:
        """Improves, and adds a row per figure; what is None has no aim."""
        count = options.get("largest_count", LARGEST_COUNT)
        start = time.process_time()
        result = tl.improve(mesh, options.pop("preset", "aggressive"), threads=1, **options)
        took = time.process_time() - start
        self.add(f"{label}: smallest angle", result.smallest_angle, f">= {angle:g}" if angle else "")
        self.add("  worst inverse mean ratio", result.worst, f"<= {ratio:g}" if ratio else "")
        self.add("  elements / elements of the input", result.elements / result.elements_before, f"<= {count:g}")
        self.add("  CPU seconds", took, f"<= {seconds:g}" if seconds else "")
        self.add("  microseconds per element", 1e6 * took / result.elements_before,
                 f"<= {microseconds:g}" if microseconds else "")  # fmt: skip
        return result


def on_files(table: Table) -> None:
    """The disk of 50,000 tetrahedra and the tire."""
    disk, tire = read("disk3d_50k_p50.vtk"), read("tire.vtk")
    table.improve("disk, 50,000, fixed", disk, 32, 1.58, microseconds=12)
    table.improve("disk, 50,000, sliding", disk, 38, 1.40, boundary="sliding", target_angle=SLIDING_TARGET)
    fixed = table.improve("tire, fixed", tire, 20, 3.2)
    # The best tetrahedron on any one facet of the boundary: no mesh with these facets is better.
    bound = np.degrees(np.arcsin(min(fixed.remaining["quality_bound"])))
    table.add("  angle that one facet allows, angles and shape together", bound)
    forced = fixed.summary.split("no mesh has a worst inverse mean ratio below ")[1].split()[0].rstrip(".")
    table.add("  worst inverse mean ratio that the facets force", float(forced))
    table.improve("tire, sliding", tire, 30, 2.2, boundary="sliding", target_angle=SLIDING_TARGET)


def on_large_disk(table: Table) -> None:
    """A million tetrahedra, and what two threads gain."""
    disk = read("disk3d_1m_p50.vtk")
    table.improve("disk, 1,000,000, target 28", disk, 28, None, seconds=12, target_angle=28)
    table.improve("disk, 1,000,000, slivers", disk, 15, None, seconds=4, preset="remove slivers")
    wall, cpu = {}, {}
    for threads in (1, 2):
        runs = []
        for _ in range(REPEATS):
            start, begin = time.perf_counter(), time.process_time()
            tl.improve(disk, "aggressive", threads=threads)
            runs.append((time.perf_counter() - start, time.process_time() - begin))
        wall[threads], cpu[threads] = (min(times) for times in zip(*runs))
        table.add(f"disk, 1,000,000, {threads} threads: wall seconds", wall[threads])
        table.add("  CPU seconds", cpu[threads])
    table.add("two threads over one, wall time", wall[1] / wall[2], ">= 1.6")


def on_generated(table: Table, cells: int, quick: bool) -> None:
    """Domains, and Delaunay meshes without any quality option or optimizer."""
    for name in DOMAINS:
        poor = tl.perturb(tl.domain(name, cells), PERTURBED, 100.0).mesh
        table.improve(f"{name}, fixed", poor, None, None)
        table.improve(f"{name}, sliding", poor, SLIDING_ANGLE, None, boundary="sliding", target_angle=SLIDING_TARGET)
    meshes: dict[str, Callable[[], Any]] = {"TetGen, no quality": lambda: tetgen(sphere(12 if quick else 32))}
    if not quick:
        meshes["Gmsh, not optimized"] = lambda: gmsh_box(GMSH_SIZE)
    for name, make in meshes.items():
        mesh = make()
        table.improve(f"{name}, fixed", mesh, None, None)
        table.improve(f"{name}, on the surface", mesh, SLIDING_ANGLE, None, boundary="on surface",
                      target_angle=SLIDING_TARGET, largest_count=1.5)  # fmt: skip
    poor = tl.perturb(tl.domain("disk3d", cells), PERTURBED, 100.0).mesh
    best = tl.optimize(tl.improve(poor, "aggressive").mesh, preset="best shape", threads=1).mesh
    own = tl.improve(poor, "aggressive", then_best_shape=True, threads=1).mesh
    means = [tl.quality(mesh, "imr").statistics["imr"]["mean"] for mesh in (own, best)]
    table.add("then best shape: mean / mean of Best shape on the improved mesh", means[0] / means[1],
              f"<= {MEAN_ALLOWANCE:g}")  # fmt: skip


def on_triangles(table: Table, cells: int) -> None:
    """Against Delaunay refinement with as many points."""
    rows = against_refinement(cells, 1)
    for name in PLANAR:
        theirs, count, ours, points = rows[name]
        table.add(f"triangles, {name}: smallest angle", ours, f">= {theirs:.4g}")
        table.add("  points / points of Delaunay refinement", points / count, "<= 1")


def missed(rows: list[Row]) -> int:
    """The number of aims that the figures miss."""
    signs = {">=": lambda number, limit: number >= limit, "<=": lambda number, limit: number <= limit}
    return sum(bool(aim) and not signs[aim.split()[0]](number, float(aim.split()[1])) for _, number, aim in rows)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--large", action="store_true")
    options = parser.parse_args()
    table = Table(aims=not options.quick)
    if "TAUTLINE_TEST_DATA" in os.environ and not options.quick:
        on_files(table)
        if options.large:
            on_large_disk(table)
    on_generated(table, QUICK_CELLS if options.quick else CELLS, options.quick)
    on_triangles(table, QUICK_CELLS if options.quick else CELLS)
    print(f"{missed(table.rows)} aims missed")
    return 0


if __name__ == "__main__":
    sys.exit(main())
