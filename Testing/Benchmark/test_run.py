"""test_run.py BUILD OUTPUT: builds the benchmarks, runs them on a tiny mesh and reads what they wrote."""

import csv
import json
import math
import subprocess
import sys
from pathlib import Path


def main(build: Path, output: Path) -> int:
    subprocess.run(["cmake", "--build", str(build), "--target", "benchmarks"], check=True)
    script = Path(__file__).with_name("run.py")
    run = [sys.executable, str(script), "--build", str(build), "--output", str(output)]
    subprocess.run([*run, "--size", "4", "--repeats", "1"], check=True)

    content = json.loads((output / "benchmark.json").read_text())
    measured, ratios = content["measured"], content["ratios"]
    assert measured["elements tetrahedra"] == 6 * 4**3, measured
    assert measured["elements hexahedra"] == 4**3, measured
    assert all(math.isfinite(x) for x in (*measured.values(), *ratios.values())), content
    assert ratios and all(measured[key] > 0 for key in measured if key.endswith((" value", " gradient")))
    # The one thing about the numbers that is the same on every machine: they time the same quantity.
    assert measured["difference from the plain loop"] < 1e-12, measured
    assert measured["difference from vtkMeshQuality"] < 1e-12, measured
    with open(output / "benchmark.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert {row["name"]: float(row["value"]) for row in rows} == measured | ratios
    return 0


if __name__ == "__main__":
    sys.exit(main(*map(Path, sys.argv[1:])))
