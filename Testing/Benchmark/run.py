"""run.py --build DIR [--size N] [--repeats N] [--output DIR]: runs the benchmarks and reports ratios.

Every time is the best of several turns, in nanoseconds per element, and every ratio is between times of
one run. Single-thread times are CPU time; those of the thread speed-up are wall time. Prints a table;
writes benchmark.json (times and ratios) and benchmark.csv (the same, one per line) to the output
directory, by default DIR/benchmark.
"""

import argparse
import csv
import json
import subprocess
import sys
from pathlib import Path

KERNEL, FILTER, MEMORY = "kernel", "filter", ("memory-tautline", "memory-verdict")


def measure(program: Path, part: str, size: int, repeats: int) -> dict[str, float]:
    """The lines `key<tab>number` one part of the program prints."""
    command = [str(program), part, str(size), str(repeats)]
    output = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return {key: float(number) for key, number in (line.split("\t") for line in output.splitlines())}


def ratios(t: dict[str, float]) -> list[tuple[str, float, str]]:
    """What we promise and what else tells something: (what, number, aim)."""
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
        ("share of the statistics", rest / t["filter tautline"], ""),
        ("peak memory, vtkElementQuality, bytes per element", t["memory tautline peak"], ""),
        ("  of which neither input nor output", t["memory tautline working"], ""),
        ("peak memory, vtkMeshQuality, bytes per element", t["memory verdict peak"], ""),
    ]


def peridynamics(program: Path, n: int, repeats: int) -> dict[str, float]:
    """CPU and wall seconds of nonlocal matrices of the square with h = 1/n, delta = 0.2."""
    if n % 5:  # delta is a whole number of elements
        n += 5 - n % 5
    output = subprocess.run([str(program), str(n), str(repeats)], check=True, capture_output=True, text=True).stdout
    return {key: float(number) for key, number in (line.split("\t") for line in output.splitlines())}


def speedups(t: dict[str, float]) -> list[tuple[str, float]]:
    """Of each nonlocal matrix, two threads over one."""
    names = [key.removesuffix(" cpu") for key in t if key.endswith(" cpu")]
    return [(f"two threads over one, {name}", t[f"{name} wall 1"] / t[f"{name} wall 2"]) for name in names]


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
    print(f"\n{'ratio':54}{'':>10}{'aim':>10}")
    for what, number, aim in summary:
        print(f"{what:54}{number:10.2f}{aim:>10}")
    for key in ("difference from the plain loop", "difference from vtkMeshQuality"):
        print(f"{key:54}{times[key]:10.0e}")


def save(directory: Path, times: dict[str, float], summary: list[tuple[str, float, str]]) -> None:
    directory.mkdir(parents=True, exist_ok=True)
    content = {"measured": times, "ratios": {what.strip(): number for what, number, _ in summary}}
    (directory / "benchmark.json").write_text(json.dumps(content, indent=2) + "\n")
    with open(directory / "benchmark.csv", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("table", "name", "value"))
        writer.writerows((table, name, v) for table, rows in content.items() for name, v in rows.items())
    print(f"\nwrote {directory}/benchmark.json and .csv")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=Path, required=True, help="the build directory")
    parser.add_argument("--size", type=int, default=55, help="cubes along an edge; 6 tetrahedra each")
    parser.add_argument("--repeats", type=int, default=9, help="turns of which the best counts")
    parser.add_argument("--output", type=Path, help="where benchmark.json and .csv go")
    options = parser.parse_args()
    program = options.build / "bin" / "BenchmarkQuality"
    times: dict[str, float] = {}
    for part in (KERNEL, FILTER, *MEMORY):
        times |= measure(program, part, options.size, options.repeats)
    summary = ratios(times)
    elements = min(40, max(5, 2 * options.size // 3))  # 1 / h of the nonlocal matrices
    nonlocal_times = peridynamics(options.build / "bin" / "BenchmarkPeridynamics", elements, min(options.repeats, 3))
    times |= nonlocal_times
    summary += [(key, number, ">= 1.7" if "two threads" in key else "") for key, number in speedups(nonlocal_times)]
    show(times, summary)
    save(options.output or options.build / "benchmark", times, summary)
    return 0


if __name__ == "__main__":
    sys.exit(main())
