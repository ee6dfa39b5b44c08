# SPDX-License-Identifier: BSD-3-Clause
"""adaptation.py BUILD [--quick]: adaptation of meshes to analytic metrics, next to other programs.

Triangles: Adapt against bamg, the mesher of `adaptmesh` of FreeFem++ (Debian: freefem++), where that is installed. Both
start with the same uniform mesh, and adapt it five times to the metric at its points. Prints the share of edges of
length 1/sqrt(2) to sqrt(2), the smallest and the mean mean ratio, all in the analytic metric, and CPU seconds, of one
thread. The metrics come from BenchmarkAdaptation.cxx; bamg's smoothing of the metric is switched off.

Tetrahedra: the same of BenchmarkVolumeAdaptation.cxx against mmg3d, where a program of this
name, mmg3d_O3, is on the path; its gradation of the metric is switched off. Its time is the user time of the process.
"""

import argparse
import resource
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

Figures = dict[str, float]
Row = tuple[str, float, str]

#: Triangles of a mesh of unit ones, in full and for a quick test, and the number of adaptations.
SIZES = ((10000, 100000), (1000,))
ROUNDS = 5
VOLUME_CASES = ("linear", "polar-1", "polar-2", "cylinder-linear", "cylinder-polar-2")
MMG = ("mmg3d_O3", "mmg3d")
#: Per case the sizes along x (or away from the origin) and across, for FreeFem++; whether they are polar.
LAYER = "(0.001 + 2 * 0.099 * abs({} - 0.5))"
RADIAL = "(0.005 + 0.2 * abs(r - 0.5))"
HOLE = "(0.01 + 0.2 * (sqrt((x - 0.5)^2 + (y - 0.5)^2) - 0.1))"
CASES = {"linear": ("0.1", LAYER.format("y"), False),
         "polar-1": (LAYER.format("r"), "0.1", True),
         "polar-2": (LAYER.format("r"), "(0.1 * d + 0.025 * (1 - d))", True),
         "isotropic": (RADIAL, RADIAL, False),
         "plate": (HOLE, HOLE, False)}  # fmt: skip
SCRIPT = """
mesh Th = readmesh("{start}");
func xx = x + {offset};
func yy = y + {offset};
func r = sqrt(xx^2 + yy^2);
func d = min(10 * abs(r - 0.5), 1.0);
func a = {scale} / ({along})^2;
func b = {scale} / ({across})^2;
func c = {cosine};
func s = {sine};
real seconds = 0;
for (int i = 0; i < {rounds}; i++) {{
  fespace V(Th, P1);
  V m11 = a * c^2 + b * s^2, m12 = (a - b) * c * s, m22 = a * s^2 + b * c^2;
  real begin = clock();
  Th = adaptmesh(Th, m11, m12, m22, IsMetric=1, nbvx={points}, hmin=1e-9, hmax=10, anisomax=1e8, ratio=0, verbosity=0);
  seconds += clock() - begin;
}}
savemesh(Th, "{end}");
cout.precision(10);
cout << "seconds\\t" << seconds << endl;
"""
#: The compared quantities: larger is better.
COMPARED = ("unit edges", "smallest mean ratio", "mean of mean ratios")
#: CPU time over bamg's.
LARGEST_TIME_RATIO = 1.5


def figures(program: Path, *arguments: object) -> Figures:
    """The lines `key<tab>number` that the program prints."""
    command = [str(program), *map(str, arguments)]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return {key: float(number) for key, number in (line.split("\t") for line in text.splitlines())}


def bamg(program: Path, case: str, triangles: int) -> Figures:
    """The figures of bamg's mesh."""
    along, across, polar = CASES[case]
    with tempfile.TemporaryDirectory() as folder:
        start, end, script = (Path(folder, name) for name in ("start.msh", "end.msh", "run.edp"))
        scale = figures(program, "start", case, triangles, start)["scale"]
        script.write_text(SCRIPT.format(start=start, end=end, scale=scale, along=along, across=across,
                                        offset=1e-3 if polar else 0.0, cosine="xx / r" if polar else "1.0",
                                        sine="yy / r" if polar else "0.0", rounds=ROUNDS, points=4 * triangles))
        command = ["FreeFem++", "-nw", "-v", "0", str(script)]
        text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        seconds = next(float(line.split("\t")[1]) for line in text.splitlines() if line.startswith("seconds\t"))
        return figures(program, "evaluate", case, triangles, end) | {"seconds": seconds}


def mmg(program: Path, mmg3d: str, case: str, tetrahedra: int) -> Figures:
    """The figures of mmg3d's mesh."""
    with tempfile.TemporaryDirectory() as folder:
        mesh, metric, end = (Path(folder, name) for name in ("mesh.mesh", "mesh.sol", "end.mesh"))
        figures(program, "start", case, tetrahedra, mesh)
        seconds = 0.0
        for _ in range(ROUNDS):
            figures(program, "metric", case, tetrahedra, mesh, metric)
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            command = [mmg3d, "-v", "0", "-hgrad", "-1", "-in", str(mesh), "-sol", str(metric), "-out", str(end)]
            subprocess.run(command, check=True, capture_output=True)
            seconds += resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before.ru_utime
            shutil.move(end, mesh)
        return figures(program, "evaluate", case, tetrahedra, mesh) | {"seconds": seconds}


def show(case: str, name: str, found: Figures) -> None:
    elements = found.get("triangles", found.get("tetrahedra", 0.0))
    print(f"{case:17}{name:10}{elements:10.0f}{found['unit edges']:12.4f}{found['shortest edge']:10.3f}"
          f"{found['longest edge']:9.3f}{found['smallest mean ratio']:10.4f}{found['mean of mean ratios']:9.4f}"
          f"{found['seconds']:9.2f}", flush=True)  # fmt: skip


def compare(
    name: str, own: Figures, other: Figures | None, peer: str, measured: Figures, rows: list[Row], elements: str
) -> None:
    """Adds what was measured of a case, and its rows of the table."""
    measured |= {f"{name}: {key}": value for key, value in own.items()}
    aims = dict.fromkeys(COMPARED, "")
    if other:
        measured |= {f"{name}: {key} of {peer}": value for key, value in other.items()}
        aims = {key: f">= {other[key]:.4f}" for key in COMPARED}
    first, *rest = COMPARED
    rows.append((f"{name}: {first}", own[first], aims[first]))
    rows += [(f"  {key}", own[key], aims[key]) for key in rest]
    rows.append(("  microseconds per element and round", 1e6 * own["seconds"] / own[elements] / ROUNDS, ""))
    if other:
        rows.append((f"  time / {peer}", own["seconds"] / other["seconds"], f"<= {LARGEST_TIME_RATIO}"))


def run(program: Path, quick: bool) -> tuple[Figures, list[Row]]:
    """The measurements, and the table; prints the figures of all programs.

    program: BenchmarkAdaptation; BenchmarkVolumeAdaptation is beside it.
    """
    measured: Figures = {}
    rows: list[Row] = []
    peer = shutil.which("FreeFem++") is not None and not quick
    mmg3d = next((name for name in MMG if shutil.which(name) and not quick), None)
    if not peer:
        print("FreeFem++ is not installed (Debian: freefem++), or not asked for: no comparison with bamg")
    if not mmg3d:
        print("mmg3d_O3 is not on the path, or not asked for: no comparison with mmg")
    print(f"{'case':17}{'program':10}{'elements':>10}{'unit edges':>12}{'shortest':>10}{'longest':>9}{'worst q':>10}"
          f"{'mean q':>9}{'s':>9}")  # fmt: skip
    for elements in SIZES[quick]:
        for case in CASES:
            own, other = figures(program, "adapt", case, elements, ROUNDS), None
            show(case, "Tautline", own)
            if peer:
                other = bamg(program, case, elements)
                show("", "bamg", other)
            compare(f"adaptation, {case}, {elements} triangles", own, other, "bamg", measured, rows, "triangles")
        volume = program.with_name("BenchmarkVolumeAdaptation")
        for case in VOLUME_CASES[: 1 if quick else None]:
            own, other = figures(volume, "adapt", case, elements, ROUNDS), None
            show(case, "Tautline", own)
            if mmg3d:
                other = mmg(volume, mmg3d, case, elements)
                show("", "mmg3d", other)
            compare(f"adaptation, {case}, {elements} tetrahedra", own, other, "mmg3d", measured, rows, "tetrahedra")
    return measured, rows


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=Path, help="the build directory")
    parser.add_argument("--quick", action="store_true", help="a tiny mesh, without other programs")
    options = parser.parse_args()
    run(options.build / "bin" / "BenchmarkAdaptation", options.quick)
    return 0


if __name__ == "__main__":
    sys.exit(main())
