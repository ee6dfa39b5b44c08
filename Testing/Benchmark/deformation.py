# SPDX-License-Identifier: BSD-3-Clause
"""The benchmark of warping: what BenchmarkDeformation measures, against what it must reach."""

import os
import subprocess
from pathlib import Path

Row = tuple[str, float, str]

# In full and for a quick test.
BOX_CELLS = (12_000, 6_000)
CUBES = (60, 10)  # 1,071,360 tetrahedra
DOMAINS = (1.0, 0.3)
HEXAHEDRA = (40, 8)  # along each edge of a cube
DEGREES = (30, 60, 90, 120, 180)
WALL_POINTS = (160, 100)  # of an airfoil


def run(program: Path, repeats: int, quick: bool) -> tuple[dict[str, float], list[Row]]:
    """All parts: what they print, under "part: key", and the table."""
    measured: dict[str, float] = {}

    def part(name: str, *arguments: object) -> dict[str, float]:
        environment = os.environ | {"OMP_NUM_THREADS": "1"}
        command = [str(program), name, *map(str, arguments)]
        text = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, env=environment).stdout
        result = {key: float(number) for key, number in (line.split("\t") for line in text.splitlines())}
        measured.update({f"{name}: {key}": value for key, value in result.items()})
        return result

    return measured, (_box(part, repeats, quick) + _domains(part, quick) + _stages(part, repeats, quick)
                      + _groups(part, quick) + _layers(part, quick))


def _box(part, repeats: int, quick: bool) -> list[Row]:
    m = part("box", BOX_CELLS[quick], repeats)
    rows: list[Row] = []
    for method in ("hybrid", "warp then untangle"):
        for degrees in DEGREES:
            key = f"{method}, {degrees} degrees"
            before = m[f"{key} inverted before"]
            rows += [(f"box in a box, {key}: inverted left, of {before:.0f}", m[f"{key} inverted left"], "<= 0"),
                     ("  seconds", m[f"{key} seconds"], "<= 2"),
                     ("  worst shape", m[f"{key} worst shape"], "")]
    return rows


def _domains(part, quick: bool) -> list[Row]:
    m = part("domains", DOMAINS[quick])
    rows: list[Row] = []
    for key in (key.removesuffix(" inverted left") for key in m if key.endswith(" inverted left")):
        impossible = m[f"{key} boundary crossings"] > 0
        rows += [(f"{key}: inverted left, of {m[f'{key} inverted before']:.0f}"
                  + (" (the boundary crosses itself)" if impossible else ""),
                  m[f"{key} inverted left"], "" if impossible else "<= 0"),
                 ("  seconds", m[f"{key} seconds"], "")]
    return rows


def _stages(part, repeats: int, quick: bool) -> list[Row]:
    m = part("stages", CUBES[quick], repeats)
    mesh = f"FEMWARP, {m['elements']:.0f} tetrahedra"
    turn, wave = m["turn seconds"], m["wave seconds"]
    return [
        (f"{mesh}: seconds", turn, ""),
        *((f"  {stage}, wall seconds", m[f"{stage} wall seconds"], "") for stage in ("assemble", "set-up", "solve")),
        ("  whole / set-up and solve", m["whole / set-up and solve"], "" if quick else "<= 3"),
        ("  bytes per element", m["bytes per element"], ""),
        ("  turned on / first position", m["turned on seconds"] / turn, "" if quick else "<= 0.25"),
        ("  shifted too / first position", m["shifted too seconds"] / turn, ""),
        ("  wave, larger / first position", m["wave, larger seconds"] / wave, "" if quick else "<= 0.25"),
        ("  wave, little later / first position", m["wave, little later seconds"] / wave, ""),
        ("  wave, another / first position", m["wave, another seconds"] / wave, ""),
    ]


def _groups(part, quick: bool) -> list[Row]:
    m = part("groups", HEXAHEDRA[quick])
    return [(f"inverse distance, {m['points']:.0f} points: groups / plain sums",
             m["seconds by groups"] / m["seconds by plain sums"], "" if quick else "<= 0.7")]


def _layers(part, quick: bool) -> list[Row]:
    m = part("layers", WALL_POINTS[quick])
    rows: list[Row] = []
    for key in (key.removesuffix(" inverted") for key in m if key.endswith(" inverted")):
        rows += [(f"{key}: inverted", m[f"{key} inverted"], "<= 0" if key.endswith(", Automatic") else ""),
                 ("  worst inverse mean ratio against the mesh at rest", m[f"{key} worst ratio"], ""),
                 ("  seconds", m[f"{key} seconds"], "")]
    return rows
