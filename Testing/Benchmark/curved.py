# SPDX-License-Identifier: BSD-3-Clause
"""Curved elements: microseconds of a certified verdict on the validity, of bounds and of certified metrics, by type.

What BenchmarkCurved measures on random elements of which a given share is invalid, and on the mesh cube-holes-inv of
MFEM where the directory in the environment variable TAUTLINE_TEST_DATA has it.
"""

import subprocess
from pathlib import Path

Row = tuple[str, float, str]

SIZE, SIZE_QUICK = 2000, 40  # elements of most types
#: Microseconds per element, one thread.
AIMS = {"tet10": 0.10, "tet20": 1.5, "hex27": 5.0, "hex64": 70.0, "wedge18": 1.5, "pyr14": 1.0, "cube-holes": 0.10}
#: Microseconds per element of the certified minimum of the mean ratio.
METRIC_AIMS = {"tet10": 6.0, "hex27": 100.0, "cube-holes": 6.0}
METRICS = ("mean-ratio", "inverse-condition", "scaled-jacobian")


def run(program: Path, repeats: int, quick: bool) -> tuple[dict[str, float], list[Row]]:
    command = [str(program), str(SIZE_QUICK if quick else SIZE), str(repeats)]
    text = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout
    lines = (line.removeprefix("curved ").split("\t") for line in text.splitlines())
    times = {key: float(number) for key, number in lines}
    rows: list[Row] = []
    for key in times:
        name, what = key.split(" ")
        if what == "elements":
            aim = f"<= {AIMS[name]:g}" if name in AIMS else ""
            rows.append((f"{name}: validity [us]", times[f"{name} validity"], aim))
            rows.append(("  bounds of the minimum to 1 % [us]", times[f"{name} minimum"], ""))
            for metric in METRICS:
                if f"{name} {metric}" in times:
                    aim = f"<= {METRIC_AIMS[name]:g}" if metric == "mean-ratio" and name in METRIC_AIMS else ""
                    rows.append((f"  minimum of the {metric} to 1e-3 [us]", times[f"{name} {metric}"], aim))
            rows.append(("  invalid", times[f"{name} invalid"] / times[key], ""))
            rows.append(("  needed a subdivision", times[f"{name} searched"], ""))
            rows.append(("  undecided", times[f"{name} undecided"], "<= 0"))
    return times, rows
