# SPDX-License-Identifier: BSD-3-Clause
"""The benchmark of the optimizer: what BenchmarkOptimization measures, against what it must reach.

Figures are passes of CPU time of one thread (see Yardstick.h) unless their name states another unit. The environment
variable TAUTLINE_TEST_DATA names a directory with meshes in its folders meshes and tangled, which are used where they
exist; the others are made by the domain source and the perturbation filter and kept in the output directory.
"""

import lzma
import os
import shutil
import subprocess
from pathlib import Path

DATA = os.environ.get("TAUTLINE_TEST_DATA")
Row = tuple[str, float, str]

# Mesh, its best known sum of squared inverse mean ratios (0: found by hundreds of sweeps), passes to 95 % of the
# reduction, the largest worst value.
SHAPES = [("disk3d_1m_p50", 1590299.9, 3, 3.45), ("disk3d_50k_p50", 82139.465, 6, None),
          ("disk2d_20k_p50", 20037.088, 5, None), ("disk2d-perturbed", 0, 4, None)]
# Mesh, the valid mesh it was made of, passes to untangle, passes to untangle and converge.
TANGLED = [("disk3d_50k_t1", "disk3d_50k_p50", 8, None), ("disk2d_20k_t1", "disk2d_20k_p50", 8, None),
           ("disk3d-tangled", None, None, 60), ("disk2d-tangled", None, None, None),
           ("disk3d-scattered", None, None, 60)]
WORST = ["disk3d_1m_p50", "disk3d_50k_p50", "disk2d_20k_p50", "tire", "tri_20258", "large_box_hex_1000"]
# Cells of the meshes made here, in full and for a quick test.
CELLS = {"disk2d-perturbed": (500_000, 600), "disk3d-tangled": (1_000_000, 800),
         "disk2d-tangled": (1_000_000, 600), "disk3d-scattered": (250_000, 800)}
HUGE, HUGE_QUICK = 119, 4  # cubes along an edge: 10,110,954 tetrahedra
GIB = 2.0**30
BUSY, BUSY_REPEATS = 20, 15  # processes that compute meanwhile; the median of this many turns counts


class Optimization:
    """Runs the parts of the program and gathers what they print under "part mesh: key"."""

    def __init__(self, program: Path, output: Path, repeats: int, quick: bool) -> None:
        self.program, self.output, self.quick = program, output, quick
        self.repeats = repeats
        self.measured: dict[str, float] = {}
        output.mkdir(parents=True, exist_ok=True)

    def run(self, part: str, *arguments: object) -> dict[str, float]:
        command = [str(self.program), part, *map(str, arguments)]
        text = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout
        return {key: float(number) for key, number in (line.split("\t") for line in text.splitlines())}

    def measure(self, part: str, mesh: str, *arguments: object) -> dict[str, float] | None:
        """One part on one mesh; None, with a message, where there is no such mesh."""
        file = self.find(mesh)
        if file is None:
            where = f"it is not in {DATA}" if DATA else "TAUTLINE_TEST_DATA is not set"
            print(f"{part} {mesh}: left out, {where}")
            return None
        result = self.run(part, file, *arguments)
        self.measured |= {f"{part} {mesh}: {key}": value for key, value in result.items()}
        print(f"{part} {mesh}: " + ", ".join(f"{key} {value:.6g}" for key, value in result.items()), flush=True)
        return result

    def find(self, mesh: str) -> Path | None:
        if mesh in CELLS:
            file = self.output / f"{mesh}-{CELLS[mesh][self.quick]}.vtk"
            if not file.exists():
                part = file.with_suffix(".part")
                self.run("make", mesh, CELLS[mesh][self.quick], part)
                part.rename(file)
            return file
        for folder in ("meshes", "tangled") if DATA and not self.quick else ():
            file = Path(DATA, folder, f"{mesh}.vtk")
            if file.exists():
                return file
            packed, unpacked = Path(f"{file}.xz"), self.output / file.name
            if packed.exists():
                if not unpacked.exists():
                    with lzma.open(packed) as source, open(unpacked, "wb") as target:
                        shutil.copyfileobj(source, target)
                return unpacked
        return None

    def shapes(self) -> list[Row]:
        rows: list[Row] = []
        for mesh, best, passes, worst in SHAPES:
            if not (m := self.measure("shape", mesh, self.repeats, best)):
                continue
            rows += [
                (f"{mesh}: passes to 95 % of the reduction", m["95 % passes"], f"<= {passes}"),
                ("  reduction reached", m["95 % reduction"], ">= 0.95"),
                ("  passes of Fast clean-up", m["fast clean-up passes"], ""),
                ("  reduction by Fast clean-up", m["fast clean-up reduction"], ""),
                ("  passes to 1.0001 of the best", m["close passes"], "<= 45"),
                ("  sum reached / best", m["close / best"], "<= 1.0001"),
                ("  worst there", m["close worst"], f"<= {worst}" if worst else ""),
                ("  passes of Best shape", m["best shape passes"], ""),
                ("  sum of Best shape / best", m["best shape / best"], ""),
                ("  passes that are not optimization", m["overhead passes"], "<= 1"),
            ]
        for mesh, _, _, _ in SHAPES:
            if m := self.measure("objective", mesh, self.repeats):
                rows.append((f"{mesh}: value and gradient, passes", m["gradient"], "<= 0.25"))
        for mesh in ("disk3d_1m_p50", "disk2d-perturbed"):
            if m := self.measure("threads", mesh, self.repeats):
                for what in ("fast clean-up", "best shape"):
                    rows.append((f"{mesh}: two threads over one, {what}", m[f"{what} speed-up"], ">= 1.8"))
                    rows.append((f"  by CPU time of the main thread, {what}", m[f"{what} speed-up by CPU time"], ""))
        return rows

    def busy(self) -> list[Row]:
        rows: list[Row] = []
        for processes in (0, BUSY):
            m = self.run("busy", processes, self.repeats if self.quick else BUSY_REPEATS)
            self.measured |= {f"busy {processes}: {key}": value for key, value in m.items()}
            for mesh in ("surface", "solid"):
                rows.append((f"{mesh} of {m[f'{mesh} elements']:.0f}: all threads / one, {processes} busy processes",
                             m[f"{mesh} all threads"] / m[f"{mesh} one thread"], f"<= {1.3 if processes else 1}"))
        return rows

    def untangling(self) -> list[Row]:
        rows: list[Row] = []
        for mesh, valid, passes, converge in TANGLED:
            if not (m := self.measure("untangle", mesh, self.repeats)):
                continue
            rows += [
                (f"{mesh}: inverted left, of {m['inverted before']:.0f}", m["inverted left"], "<= 0"),
                ("  passes to untangle", m["untangle passes"], f"<= {passes}" if passes else ""),
                ("  passes of Best shape then", m["shape passes"], ""),
            ]
            sum_of_valid = self.measured.get(f"shape {valid}: best shape sum")
            if sum_of_valid:
                rows.append(("  sum then / sum from the valid mesh", m["shape sum"] / sum_of_valid, "<= 1.0001"))
            if c := self.measure("converge", mesh, self.repeats):
                rows += [
                    ("  passes to untangle and converge", c["converge passes"], f"<= {converge}" if converge else ""),
                    ("  inverted left by both", c["inverted left"], "<= 0"),
                    ("  sum / sum of the two filters", c["converge sum"] / m["shape sum"], ""),
                ]
        return rows

    def worst(self) -> list[Row]:
        rows: list[Row] = []
        for mesh in ["disk2d-perturbed"] if self.quick else WORST:
            if not (m := self.measure("worst", mesh)):
                continue
            before, after = (
                {key: m[f"{preset} {key}"] for key in ("mean", "worst", "worst movable")}
                for preset in ("best shape", "worst element"))
            rows += [
                (f"{mesh}: worst IMR after Worst element", after["worst"], f"< {before['worst']:.4f}"),
                ("  of elements that can move", after["worst movable"], f"< {before['worst movable']:.4f}"),
                ("  mean after / mean before", after["mean"] / before["mean"], "<= 1.01"),
                ("  passes / passes of Best shape", m["worst element passes"] / m["best shape passes"],
                 "<= 1.5" if mesh == WORST[0] else ""),
                ("  by the smallest angle", m["min_angle passes"] / m["best shape passes"], ""),
                ("  by the scaled Jacobian", m["scaled_jacobian passes"] / m["best shape passes"], ""),
            ]
        return rows

    def sweeps(self) -> list[Row]:
        mesh = "disk2d-perturbed" if self.quick else "disk3d_50k_p50"
        if not (m := self.measure("sweeps", mesh, self.repeats)):
            return []
        return [(f"{mesh}: 10 sweeps of IMR and size, {method}", m[f"{method} passes"], "<= 60")
                for method in ("conjugate gradient", "Newton")]

    def memory(self) -> list[Row]:
        m = self.run("memory", HUGE_QUICK if self.quick else HUGE)
        self.measured |= {f"memory: {key}": value for key, value in m.items()}
        return [
            (f"peak memory in GiB, {m['elements']:.0f} tetrahedra", m["memory peak"] / GIB, "<= 24"),
            ("  of which the input", m["memory input"] / GIB, ""),
            ("  passes of Best shape", m["memory passes"], ""),
        ]


def run(program: Path, output: Path, repeats: int, quick: bool, huge: bool) -> tuple[dict[str, float], list[Row]]:
    """All parts: what they print, and the table."""
    benchmark = Optimization(program, output, repeats, quick)
    benchmark.measured |= benchmark.run("yardstick", repeats)
    rows: list[Row] = [("yardstick, ns per element", benchmark.measured["yardstick"], "")]
    rows += benchmark.shapes() + benchmark.busy() + benchmark.untangling() + benchmark.worst() + benchmark.sweeps()
    return benchmark.measured, rows + (benchmark.memory() if huge else [])


def misses(rows: list[Row]) -> int:
    """How many aims are not met."""
    compare = {"<=": float.__le__, ">=": float.__ge__, "<": float.__lt__}
    aims = [(number, *aim.split()) for _, number, aim in rows if aim]
    return sum(not compare[sign](float(number), float(limit)) for number, sign, limit in aims)
