# SPDX-License-Identifier: BSD-3-Clause
"""make_ratios.py README [--write]: measures the ratios that README.md states, on the samples, and compares.

The table stands between the comments <!-- ratios --> and <!-- end of ratios -->; --write inserts it. Iterations, angles
and counts do not depend on the machine or the number of threads; times would, and are in CONTRIBUTING.md.
"""

import re
import sys
from pathlib import Path

import tautline as tl

DATA = Path(__file__).resolve().parents[2] / "Data"
PLACE = re.compile(r"(<!-- ratios -->\n)(.*?)(<!-- end of ratios -->)", re.DOTALL)
TURN = {"rotate": 120}


def rows():
    """Task, number before, after and their ratio as texts."""
    valid = tl.untangle(DATA / "bracket-tangled.vtu")
    assert valid.inverted == 0
    yield "Untangle Mesh, bracket", "inverted elements", f"{valid.inverted_before}", f"{valid.inverted}", "0"
    better = tl.optimize(valid)
    worst = better.statistics["imr"]
    yield ("Optimize Mesh, the same", "worst inverse mean ratio", f"{worst['worst_before']:.1f}",
           f"{worst['worst_after']:.1f}", f"{worst['worst_after'] / worst['worst_before']:.2f}")  # fmt: skip
    first, last = (
        tl.solve(mesh, source="1", solver="cg", preconditioner="jacobi").iterations for mesh in (valid, better)
    )
    yield "Solve PDE on it", "iterations of CG", f"{first}", f"{last}", f"{last / first:.2f}"
    best = tl.improve(better)
    yield ("Improve Mesh, the same", "smallest dihedral angle", f"{best.smallest_angle_before:.1f}°",
           f"{best.smallest_angle:.1f}°", f"{best.smallest_angle / best.smallest_angle_before:.2f}")  # fmt: skip
    plate = DATA / "plate.vtu"
    plain, hybrid = (tl.warp(plate, transform=TURN, method=method) for method in ("femwarp", "hybrid"))
    counts = f"{plain.inverted}", f"{hybrid.inverted}"
    yield "Warp Mesh, hole turned by 120°", "inverted: FEMWARP, hybrid", *counts, "0"


def table() -> str:
    lines = ["| task | measured | before | after | ratio |", "|---|---|---|---|---|"]
    return "\n".join(lines + [f"| {' | '.join(row)} |" for row in rows()]) + "\n"


def main(page: Path, write: bool) -> int:
    text, measured = page.read_text(encoding="utf-8"), table()
    made = PLACE.sub(lambda match: match[1] + measured + match[3], text)
    print(measured)
    if measured not in made:
        print(f"{page} has no place for the ratios")
        return 1
    if write:
        page.write_text(made, encoding="utf-8")
    elif made != text:
        print(f"these are not the ratios of {page}: make_ratios.py {page} --write inserts them")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), "--write" in sys.argv[2:]))
