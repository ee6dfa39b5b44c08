# SPDX-License-Identifier: BSD-3-Clause
"""The benchmark of reconnection: what BenchmarkReconnection measures, against what it must reach."""

import subprocess
from pathlib import Path

Row = tuple[str, float, str]

#: Cubes along an edge, 6 tetrahedra each, and with a tenth of it squares along an edge, 2 triangles each: in full and
#: for a quick test.
SIZES = (20, 4)
#: Per case its aims: the smallest angle in degrees. Slivers: of the preset.
ANGLES = {"slivers": 15, "swap": 0, "swap and smooth": 0, "aggressive": 28, "sliding": 32, "sliding, high target": 36,
          "triangles, slivers": 15, "triangles, swap": 0, "triangles, swap and smooth": 25, "triangles": 35,
          "triangles, sliding": 35}


def run(program: Path, unit: float, quick: bool) -> tuple[dict[str, float], list[Row]]:
    """The output of the program, and the table; `unit` is the yardstick in nanoseconds, see Yardstick.h."""
    text = subprocess.run([str(program), str(SIZES[quick])], check=True, stdout=subprocess.PIPE, text=True).stdout
    measured = {key: float(number) for key, number in (line.split("\t") for line in text.splitlines())}
    rows: list[Row] = []
    for case, angle in ANGLES.items():
        aim = f">= {angle}" if angle and not quick else ""
        rows += [(f"reconnection, {case}: smallest angle", measured[f"{case}: smallest angle"], aim),
                 ("  worst inverse mean ratio", measured[f"{case}: worst inverse mean ratio"], ""),
                 ("  microseconds per element", measured[f"{case}: microseconds per element"], ""),
                 ("  passes per element", 1e3 * measured[f"{case}: microseconds per element"] / unit, "")]
    return measured, rows
