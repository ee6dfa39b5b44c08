# SPDX-License-Identifier: BSD-3-Clause
"""test_run.py BUILD OUTPUT: builds the benchmarks, runs them on a tiny mesh and reads what they wrote."""

import csv
import json
import math
import os
import subprocess
import sys
from pathlib import Path

import optimization
import peers


def read(output: Path, name: str) -> tuple[dict[str, float], dict[str, float]]:
    """Both tables, after a check of the numbers and of the other file that has them."""
    content = json.loads((output / f"{name}.json").read_text())
    measured, ratios = content["measured"], content["ratios"]
    assert all(math.isfinite(x) for x in (*measured.values(), *ratios.values())), content
    with open(output / f"{name}.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert {row["name"]: float(row["value"]) for row in rows} == measured | ratios
    return measured, ratios


def check_quality(output: Path) -> None:
    measured, ratios = read(output, "benchmark")
    assert measured["elements tetrahedra"] == 6 * 4**3, measured
    assert measured["elements hexahedra"] == 4**3, measured
    assert ratios and all(measured[key] > 0 for key in measured if key.endswith((" value", " gradient")))
    # The one thing about the numbers that is the same on every machine: they time the same quantity.
    assert measured["difference from the plain loop"] < 1e-12, measured
    assert measured["difference from vtkMeshQuality"] < 1e-12, measured
    assert measured["tetrahedra"] == 6 * 4**3, measured
    assert ratios["assembly / BoomerAMG's set-up, triangles poisson"] > 0, ratios


def check_optimization(output: Path) -> None:
    measured, ratios = read(output, "optimization")
    passes = [key for key in measured if key.endswith(" passes")]
    assert len(passes) >= 10 and all(measured[key] > 0 for key in passes), measured
    assert measured["memory: elements"] == 6 * 4**3, measured
    # The result does not depend on the machine.
    shape = "shape disk2d-perturbed: "
    assert measured[shape + "95 % reduction"] >= 0.95, measured
    assert measured[shape + "close / best"] <= 1.0001, measured
    assert measured[shape + "best sum"] <= measured[shape + "best shape sum"] < measured[shape + "before sum"]
    for mesh in ("disk3d-tangled", "disk2d-tangled", "disk3d-scattered"):
        assert measured[f"untangle {mesh}: inverted before"] > 0, measured
        assert measured[f"untangle {mesh}: inverted left"] == 0, measured
        assert measured[f"converge {mesh}: inverted left"] == 0, measured
    for threads in ("one thread", "all threads"):
        assert measured[f"busy 20: surface {threads}"] > 0 and measured[f"busy 0: solid {threads}"] > 0, measured
    assert measured["busy 20: surface elements"] == 4800 and measured["busy 20: solid elements"] == 6000, measured
    for method in ("conjugate gradient", "Newton"):
        assert measured[f"sweeps disk2d-perturbed: {method} sweeps"] == 10, measured


def check_deformation(output: Path) -> None:
    measured, ratios = read(output, "deformation")
    left = [key for key in measured if key.endswith("inverted left")]
    assert len(left) == 22 and measured["stages: elements"] > 3000, measured
    for key in left:
        crosses = key.replace("inverted left", "boundary crossings")
        assert measured[key] == 0 or measured.get(crosses, 0) > 0, (key, measured)
    # No new solve for a part that turns on, or a motion that grows.
    for motion in ("turned on", "wave, larger"):
        assert measured[f"stages: {motion} iterations"] == 0, measured
    assert measured["groups: points"] == 9**3 and measured["groups: inverted"] == 0, measured


def check_reconnection(output: Path) -> None:
    measured, ratios = read(output, "reconnection")
    assert measured["triangles: smallest angle"] > 30 and measured["slivers: smallest angle"] > 10, measured
    # Quantities that never become worse with more operations, and swaps keep the number of triangles.
    assert measured["triangles, swap: elements"] == 2 * 40**2, measured
    assert measured["triangles, swap: smallest angle"] <= measured["triangles: smallest angle"], measured
    assert all(number > 0 for key, number in ratios.items() if key.endswith("passes per element")), ratios


def check_stiff(output: Path) -> None:
    measured, ratios = read(output, "stiff")
    reached = [key for key in ratios if key.endswith(": sum / minimum")]
    assert len(reached) == 18, ratios
    for key in reached:
        assert 1 - 1e-9 < ratios[key] <= 1.001, (key, ratios)
    assert measured["quads-aspect1 100: sum at the start / minimum"] == 1, measured
    # With ten rows the first has an aspect ratio of 608: an IMR of 304 in 8 cells, besides those at the ends.
    assert measured["quads-aspect1000 100: sum at the start / minimum"] > 8 * 304**2 / 100, measured


def check_surfaces(output: Path) -> None:
    measured, _ = read(output, "surfaces")
    for mesh in ("bar", "ball"):
        assert measured[f"{mesh}: smallest angle"] > measured[f"{mesh}: smallest angle before"] > 0, measured
        assert measured[f"{mesh}: distance / diagonal"] <= 1e-3, measured
        assert measured[f"{mesh}: change of the volume"] < 5e-3, measured


def check_peers(output: Path) -> None:
    measured, ratios = read(output, "peers")
    assert measured["stretched box: elements"] == measured["stretched box: least sum"] == 4 * 4 * 3, measured
    assert measured["isotropic: elements"] == 6 * 4**3, measured
    for mesh in ("stretched disk", "stretched box"):
        # The result does not depend on the machine: both methods find the same minimum, far below the start.
        start, default, newton = (measured[f"{mesh}: {key} sum"] for key in ("start", "default", "Newton"))
        assert abs(default / newton - 1) < 1e-3 and start > 1.05 * default, (mesh, measured)
    reached = [number for key, number in ratios.items() if "sum / least known" in key]
    assert len(reached) == 4 and all(1 - 1e-9 < number <= 1.001 for number in reached), ratios
    assert any("default / Local Newton" in key for key in ratios), ratios


def check_hexopt() -> None:
    """The rows of HexOpt's meshes, with numbers in the place of the program's: the ratios and the aims."""
    numbers = {"worst scaled Jacobian before": 0.07, "worst scaled Jacobian": 0.06, "surface error / diagonal": 2e-3,
               "invalid": 0.0, "seconds": 1.0}
    rows = peers.of_hexopt("CAD4", 0.12, numbers)
    assert [number for what, number, _ in rows if "published" in what] == [0.5], rows
    assert optimization.misses(rows) == 2, rows
    assert optimization.misses(peers.of_hexopt("CAD4", 0.12, numbers | {
        "worst scaled Jacobian": 0.13, "surface error / diagonal": 1e-3})) == 0


def check_user_metric(output: Path) -> None:
    measured, ratios = read(output, "user-metric")
    # Four metrics, two types of cells, with gradient and without; five that are optimized; two compilations.
    assert len(ratios) == 2 * (16 + 5) and all(number > 0 for number in (*measured.values(), *ratios.values())), ratios


def check_curved(output: Path) -> None:
    measured, ratios = read(output, "curved")
    timed = (" validity", " minimum", " mean-ratio", " inverse-condition", " scaled-jacobian")
    assert all(number > 0 for key, number in measured.items() if key.endswith(timed)), measured
    assert "hex27 scaled-jacobian" in measured and "pyr14 scaled-jacobian" not in measured, measured
    assert all(number == 0 for key, number in measured.items() if key.endswith(" undecided")), measured
    assert measured["tet10 elements"] == 40 and 0 < ratios["hex27: needed a subdivision"] <= 1, (measured, ratios)


def check_arguments(output: Path) -> None:
    """./run bench prints its help, and rejects wrong arguments, before it builds: which would take minutes."""
    script = Path(__file__).parents[2] / "run"
    absent = output / "absent"
    for arguments, code, text in ((["--help"], 0, "--only"), (["--only", "nothing"], 2, "'nothing'")):
        done = subprocess.run([str(script), "bench", *arguments], env=dict(os.environ, TAUTLINE_BUILD=str(absent)),
                              capture_output=True, text=True, timeout=60)  # fmt: skip
        assert done.returncode == code and text in done.stdout + done.stderr, done
        assert not absent.exists(), done


def main(build: Path, output: Path) -> int:
    check_arguments(output)
    subprocess.run(["cmake", "--build", str(build), "--target", "benchmarks"], check=True)
    script = Path(__file__).with_name("run.py")
    run = [sys.executable, str(script), "--build", str(build), "--output", str(output)]
    subprocess.run([*run, "--size", "4", "--repeats", "1", "--quick", "--huge"], check=True)

    check_quality(output)
    check_optimization(output)
    check_deformation(output)
    check_reconnection(output)
    check_stiff(output)
    check_peers(output)
    check_surfaces(output)
    check_hexopt()
    check_user_metric(output)
    check_curved(output)
    return 0


if __name__ == "__main__":
    sys.exit(main(*map(Path, sys.argv[1:])))
