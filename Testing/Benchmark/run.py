# SPDX-License-Identifier: BSD-3-Clause
"""run.py --build DIR [--only PART] [--repeats N] [--output DIR]: runs the benchmarks and reports ratios.

Every time is the best of several turns, and every ratio is between times of one run. Single-thread times
are CPU time, except the thread speed-up, which is wall time. Prints tables; writes benchmark.json (times in
nanoseconds per element, and ratios) and benchmark.csv (the same, one per line) of the quality of
elements, optimization.json and .csv of the optimizer (see optimization.py), deformation.json and .csv of warping
(see deformation.py), reconnection.json and .csv of changes of the connectivity (see reconnection.py), stiff.json
and .csv of stretched meshes (see stiff.py), peers.json and .csv of meshes that other programs were run on (see
peers.py), hexes.json and .csv of meshes of hexahedra with a boundary that slides (see hexes.py), surfaces.json and
.csv of surfaces in space next to VTK's smoother (see surfaces.py), user-metric.json
and .csv of metrics of one's own, and curved.json and .csv of curved elements (see
curved.py), adaptation.json and .csv of adaptation to metrics, next to bamg and mmg3d where these are installed (see
adaptation.py), to the output directory, by default DIR/benchmark. Prints how the preset Aggressive of Improve Mesh
compares with the program gmsh, where that is installed (see gmsh_comparison.py). With --only calculix, repairs decks
that CalculiX rejects, and gives them to CalculiX again (see calculix_decks.py).
"""

import argparse
import csv
import json
import subprocess
import sys
from pathlib import Path

import adaptation
import curved
import deformation
import hexes
import optimization
import peers
import reconnection
import stiff

KERNEL, FILTER, MEMORY = "kernel", "filter", ("memory-tautline", "memory-verdict")


def measure(program: Path, part: str, size: int, repeats: int) -> dict[str, float]:
    """The lines `key<tab>number` one part of the program prints."""
    command = [str(program), part, str(size), str(repeats)]
    output = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return {key: float(number) for key, number in (line.split("\t") for line in output.splitlines())}


def yardstick(build: Path, repeats: int) -> dict[str, float]:
    """Nanoseconds per tetrahedron of the unit in which work is stated (Yardstick.h)."""
    command = [str(build / "bin" / "BenchmarkOptimization"), "yardstick", str(repeats)]
    key, number = subprocess.run(command, check=True, capture_output=True, text=True).stdout.split("\t")
    return {key: float(number)}


def ratios(t: dict[str, float]) -> list[tuple[str, float, str]]:
    """The promised ratios and other informative ones: (what, number, aim)."""
    gradient, value = t["tetrahedra imr gradient"], t["tetrahedra imr value"]
    rest = t["filter tautline"] - t["filter adapter"] - t["filter validity"] - t["filter values"]

    def speedup(kind: str) -> float:
        return t[f"{kind} wall 1"] / t[f"{kind} wall 2"]

    return [
        ("IMR value and gradient / memory floor, tetrahedra", gradient / t["tetrahedra floor"], "<= 3"),
        ("IMR value and gradient in plain loops, tetrahedra", gradient / t["tetrahedra plain imr"], ""),
        ("IMR value / memory floor, tetrahedra", value / t["tetrahedra floor"], ""),
        ("IMR value and gradient / memory floor, hexahedra",
         t["hexahedra imr gradient"] / t["hexahedra floor"], ""),
        ("two threads over one, IMR gradient, tetrahedra", speedup("tetrahedra imr gradient"), ">= 1.7"),
        ("two threads over one, IMR value, tetrahedra", speedup("tetrahedra imr value"), ">= 1.7"),
        ("two threads over one, IMR gradient, hexahedra", speedup("hexahedra imr gradient"), ">= 1.7"),
        ("vtkMeshQuality / vtkElementQuality, IMR", t["filter verdict"] / t["filter tautline"], ">= 10"),
        ("vtkMeshQuality / evaluation of IMR alone", t["filter verdict"] / t["filter values"], ""),
        ("share of the adapter in vtkElementQuality", t["filter adapter"] / t["filter tautline"], ""),
        ("share of the validity", t["filter validity"] / t["filter tautline"], ""),
        ("validity of hexahedra, millions a second", 1e3 / t["filter validity of hexahedra"], ">= 6"),
        ("share of the statistics", rest / t["filter tautline"], ""),
        ("peak memory, vtkElementQuality, bytes per element", t["memory tautline peak"], ""),
        ("  of which neither input nor output", t["memory tautline working"], ""),
        ("peak memory, vtkMeshQuality, bytes per element", t["memory verdict peak"], ""),
    ]


def shape_ratios(t: dict[str, float]) -> list[tuple[str, float, str]]:
    """Shape matching, in units of the yardstick: IMR and gradient of one tetrahedron in a plain loop (Yardstick.h)."""
    unit = t["yardstick"]
    return [
        ("match of two outlines, mean over shapes / yardstick", t["shapes outline mean"] / unit, "<= 6000"),
        ("preparation of an outline / yardstick", t["shapes outline prepared"] / unit, ""),
        ("match with an image, near the outline, similar shapes / yardstick", t["shapes contour like"] / unit, ""),
        ("match with an image, near the outline, mean / yardstick", t["shapes contour mean"] / unit, ""),
        ("exact grid match [s]", t["shapes grid"] / 1e9, "<= 3"),
        ("two threads over one, exact grid match", t["shapes grid wall 1"] / t["shapes grid wall 2"], ">= 1.7"),
        ("exact grid match without bounds / with", t["shapes grid plain"] / t["shapes grid"], ""),
    ]


def peridynamics(program: Path, n: int, repeats: int) -> dict[str, float]:
    """CPU and wall seconds of nonlocal matrices of the square with h = 1/n, delta = 0.2."""
    if n % 5:  # delta is a whole number of elements
        n += 5 - n % 5
    output = subprocess.run([str(program), str(n), str(repeats)], check=True, capture_output=True, text=True).stdout
    return {key: float(number) for key, number in (line.split("\t") for line in output.splitlines())}


def speedups(t: dict[str, float]) -> list[tuple[str, float]]:
    """For each nonlocal matrix, two threads over one."""
    names = [key.removesuffix(" cpu") for key in t if key.endswith(" cpu")]
    return [(f"two threads over one, {name}", t[f"{name} wall 1"] / t[f"{name} wall 2"]) for name in names]


def conditioning(program: Path, cells: int, repeats: int) -> dict[str, float]:
    """Seconds of assembly and of BoomerAMG's set-up on meshes of about this many cells."""
    output = subprocess.run([str(program), str(cells), str(repeats)], check=True, capture_output=True, text=True).stdout
    return {key: float(number) for key, number in (line.split("\t") for line in output.splitlines())}


def conditioning_ratios(t: dict[str, float]) -> list[tuple[str, float, str]]:
    """Assembly against what the solver does next, by threads, and in elements per second."""
    rows = []
    for kind in ("triangles poisson", "triangles in random order poisson", "tetrahedra poisson"):
        rows.append((f"assembly / BoomerAMG's set-up, {kind}",
                     t[f"assembly {kind} cpu"] / t[f"multigrid {kind} cpu"], "<= 0.5"))
        rows.append((f"mesh to linear system / BoomerAMG's set-up, {kind}",
                     t[f"system {kind} cpu"] / t[f"multigrid {kind} cpu"], ""))
    for key in t:
        if key.startswith("assembly") and key.endswith(" wall 1") and " again " not in key:
            kind = key.removeprefix("assembly ").removesuffix(" wall 1")
            cells = t[kind.split()[0]]
            rows.append((f"assembly, {kind} [million elements / s]", cells / t[f"assembly {kind} cpu"] / 1e6, ""))
            rows.append((f"two threads over one, assembly, {kind}", t[key] / t[key.replace(" 1", " 2")], ">= 1.5"))
            again = f"assembly {kind} again cpu"
            rows.append((f"assembly with known pattern / all, {kind}", t[again] / t[f"assembly {kind} cpu"], ""))
    return rows


def show(times: dict[str, float], summary: list[tuple[str, float, str]]) -> None:
    print(f"{times['elements tetrahedra']:.0f} tetrahedra, {times['elements hexahedra']:.0f} hexahedra; one thread\n")
    print(f"{'ns per element':34}{'value':>10}{'gradient':>10}{'/ floor':>10}{'/ plain':>10}")
    plain = times["tetrahedra plain imr"]
    for kind in ("tetrahedra", "hexahedra"):
        floor = times[f"{kind} floor"]
        print(f"{kind + ' memory floor':34}{'':>10}{floor:10.2f}{1:10.2f}")
        if kind == "tetrahedra":
            print(f"{kind + ' plain imr loop':34}{'':>10}{plain:10.2f}{plain / floor:10.2f}{1:10.2f}")
        for key, value in times.items():
            name = key.removesuffix(" value")
            if name == key or not key.startswith(kind):
                continue
            g = times[f"{name} gradient"]
            passes = f"{g / plain:10.2f}" if kind == "tetrahedra" else ""
            print(f"{name:34}{value:10.2f}{g:10.2f}{g / floor:10.2f}{passes}")
    for key, value in times.items():
        if key.startswith("filter"):
            print(f"{key:34}{value:10.2f}")
    for key, value in times.items():
        if key.startswith("peridynamics") and key.endswith("cpu"):
            print(f"{key:44}{value:10.3f} s")
    print(f"\n{'ratio':70}{'':>10}{'aim':>10}")
    for what, number, aim in summary:
        print(f"{what:70}{number:10.2f}{aim:>10}")
    for key in ("difference from the plain loop", "difference from vtkMeshQuality"):
        print(f"{key:70}{times[key]:10.0e}")


def show_table(rows: list[tuple[str, float, str]]) -> None:
    print(f"\n{'passes of one thread, unless stated otherwise':66}{'':>12}{'aim':>12}")
    for what, number, aim in rows:
        print(f"{what:66}{number:12.5g}{aim:>12}")
    print(f"{optimization.misses(rows)} aims missed")


def save(directory: Path, name: str, times: dict[str, float], ratios: dict[str, float]) -> None:
    directory.mkdir(parents=True, exist_ok=True)
    content = {"measured": times, "ratios": ratios}
    (directory / f"{name}.json").write_text(json.dumps(content, indent=2) + "\n")
    with open(directory / f"{name}.csv", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("table", "name", "value"))
        writer.writerows((table, key, v) for table, rows in content.items() for key, v in rows.items())
    print(f"\nwrote {directory}/{name}.json and .csv")


def run_quality(build: Path, output: Path, size: int, repeats: int) -> None:
    times: dict[str, float] = {}
    for part in (KERNEL, FILTER, *MEMORY):
        times |= measure(build / "bin" / "BenchmarkQuality", part, size, repeats)
    times |= yardstick(build, repeats)
    times |= measure(build / "bin" / "BenchmarkShapes", "shapes", size, repeats)
    elements = min(40, max(5, 2 * size // 3))  # 1 / h of the nonlocal matrices
    nonlocal_times = peridynamics(build / "bin" / "BenchmarkPeridynamics", elements, min(repeats, 3))
    times |= nonlocal_times
    elliptic = conditioning(build / "bin" / "BenchmarkElliptic", 6 * size**3, min(repeats, 5))
    times |= elliptic
    summary = ratios(times) + shape_ratios(times) + conditioning_ratios(elliptic)
    summary += [(key, number, ">= 1.7" if "two threads" in key else "") for key, number in speedups(nonlocal_times)]
    show(times, summary)
    save(output, "benchmark", times, {what.strip(): number for what, number, _ in summary})


def run_optimization(build: Path, output: Path, repeats: int, quick: bool, huge: bool) -> None:
    program = build / "bin" / "BenchmarkOptimization"
    times, rows = optimization.run(program, output, repeats, quick, huge)
    show_table(rows)
    mesh, table = "", {}
    for what, number, _ in rows:
        mesh = mesh if what.startswith(" ") else what.split(":")[0]
        table[f"{mesh}: {what.strip()}" if what.startswith(" ") else what] = number
    save(output, "optimization", times, table)


def run_table(output: Path, name: str, times: dict[str, float], rows: list[tuple[str, float, str]]) -> None:
    """Shows and saves rows, of which those that are indented belong to the one above that is not."""
    show_table(rows)
    head, table = "", {}
    for what, number, _ in rows:
        head = head if what.startswith(" ") else what.split(":")[0]
        table[f"{head}: {what.strip()}" if what.startswith(" ") else what] = number
    save(output, name, times, table)


def run_deformation(build: Path, output: Path, repeats: int, quick: bool) -> None:
    run_table(output, "deformation", *deformation.run(build / "bin" / "BenchmarkDeformation", repeats, quick))


def run_user_metric(build: Path, output: Path, size: int, repeats: int) -> None:
    """A user's metrics against the built-in ones, compiled for any machine and for this one."""
    times: dict[str, float] = {}
    rows: list[tuple[str, float, str]] = []
    for program in ("BenchmarkUserMetric", "BenchmarkUserMetricNative"):
        flags = "this machine" if program.endswith("Native") else "any machine"
        command = [str(build / "bin" / program), str(size), str(repeats)]
        output_text = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout
        for line in output_text.splitlines():
            name, built_in, own, ratio = line.split("\t")
            times |= {f"{name}, built-in": float(built_in), f"{name}, user's, {flags}": float(own)}
            rows.append((f"user's / built-in, {name}, {flags}", float(ratio), "<= 3"))
    show_table(rows)
    save(output, "user-metric", times, {what: number for what, number, _ in rows})


def run_curved(build: Path, output: Path, repeats: int, quick: bool) -> None:
    run_table(output, "curved", *curved.run(build / "bin" / "BenchmarkCurved", repeats, quick))


def run_stiff(build: Path, output: Path, repeats: int, quick: bool, huge: bool) -> None:
    run_table(output, "stiff", *stiff.run(build / "bin" / "BenchmarkStiff", repeats, quick, huge))


def run_peers(build: Path, output: Path, repeats: int, quick: bool) -> None:
    run_table(output, "peers", *peers.run(build / "bin" / "BenchmarkPeers", repeats, quick))


def run_hexes(build: Path, output: Path, quick: bool) -> None:
    run_table(output, "hexes", *hexes.run(build / "bin" / "BenchmarkHexes", quick))


def run_surfaces(build: Path, output: Path, quick: bool) -> None:
    sys.path.insert(0, str(build / "lib" / "python3" / "dist-packages"))
    import surfaces  # needs the package, which the other parts do not

    run_table(output, "surfaces", *surfaces.run(quick))


def run_reconnection(build: Path, output: Path, repeats: int, quick: bool) -> None:
    unit = yardstick(build, repeats)["yardstick"]
    run_table(output, "reconnection", *reconnection.run(build / "bin" / "BenchmarkReconnection", unit, quick))


def run_adaptation(build: Path, output: Path, quick: bool) -> None:
    run_table(output, "adaptation", *adaptation.run(build / "bin" / "BenchmarkAdaptation", quick))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=Path, required=True, help="the build directory")
    parts = ("quality", "optimization", "deformation", "adaptation", "reconnection", "reconnection-aims", "stiff",
             "peers", "hexes", "surfaces", "user-metric", "curved", "gmsh", "calculix")
    parser.add_argument("--only", choices=parts, help="one part; all but reconnection-aims and calculix otherwise")
    parser.add_argument("--size", type=int, default=55, help="quality: cubes along an edge; 6 tetrahedra each")
    parser.add_argument("--repeats", type=int, help="turns of which the best counts; 9, of the optimizer and warping 3")
    parser.add_argument("--quick", action="store_true", help="tiny meshes only, except for quality")
    parser.add_argument("--huge", action="store_true",
                        help="optimization: also 10,000,000 tetrahedra; stiff: also 1,000,000 cells; "
                        "reconnection-aims: also 1,000,000 tetrahedra")
    parser.add_argument("--output", type=Path, help="where the results go")
    parser.add_argument("--check-arguments", action="store_true", help="check the other arguments, and end")
    options = parser.parse_args()
    if options.check_arguments:
        return 0
    output = options.output or options.build / "benchmark"
    if not any((options.build / "bin").glob("Benchmark*")):
        parser.error(f"no benchmarks in {options.build / 'bin'}: ./run bench builds them and starts this script")
    if options.only in (None, "quality"):
        run_quality(options.build, output, options.size, options.repeats or 9)
    if options.only in (None, "deformation"):
        run_deformation(options.build, output, options.repeats or 3, options.quick)
    if options.only in (None, "adaptation"):
        run_adaptation(options.build, output, options.quick)
    if options.only in (None, "reconnection"):
        run_reconnection(options.build, output, options.repeats or 3, options.quick)
    if options.only == "reconnection-aims":  # minutes, and most of the meshes are not of the repository
        flags = [flag for flag, given in (("--quick", options.quick), ("--large", options.huge)) if given]
        command = [sys.executable, str(Path(__file__).with_name("reconnection_aims.py")), *flags]
        subprocess.run(command, check=True)
    if options.only in (None, "optimization"):
        run_optimization(options.build, output, options.repeats or 3, options.quick, options.huge)
    if options.only in (None, "stiff"):
        run_stiff(options.build, output, options.repeats or 3, options.quick, options.huge and not options.quick)
    if options.only in (None, "peers"):
        run_peers(options.build, output, options.repeats or 3, options.quick)
    if options.only in (None, "hexes"):
        run_hexes(options.build, output, options.quick)
    if options.only in (None, "surfaces"):
        run_surfaces(options.build, output, options.quick)
    if options.only in (None, "user-metric"):
        run_user_metric(options.build, output, 4 if options.quick else 30, options.repeats or 9)
    if options.only in (None, "curved"):
        run_curved(options.build, output, options.repeats or 5, options.quick)
    if options.only in (None, "gmsh"):
        subprocess.run([sys.executable, str(Path(__file__).with_name("gmsh_comparison.py"))], check=False)
    if options.only == "calculix":
        return subprocess.run([sys.executable, str(Path(__file__).with_name("calculix_decks.py"))]).returncode
    return 0


if __name__ == "__main__":
    sys.exit(main())
