# SPDX-License-Identifier: BSD-3-Clause
"""make_ratios.py README [--write]: measures the ratios that README.md states, on the samples, and compares.

The table stands between the comments <!-- ratios --> and <!-- end of ratios -->; --write inserts it. Iterations, angles
and counts do not depend on the machine or the number of threads; times would, and are in the developer guide.
"""

import re
import sys
from pathlib import Path

import tautline as tl

DATA = Path(__file__).resolve().parents[2] / "Data"
PLACE = re.compile(r"(<!-- ratios -->\n)(.*?)(<!-- end of ratios -->)", re.DOTALL)
TURN = {"rotate": 120}
SLIDING = "slide on flat parts"


def rows():
    """Task, what is measured, and the numbers before and after as texts."""
    valid = tl.untangle(DATA / "bracket-tangled.vtu")
    yield "*Untangle Mesh*, tangled bracket", f"{valid.inverted_before}", f"{valid.inverted}", "inverted elements"
    bracket = DATA / "bracket.vtu"
    angles = [tl.improve(bracket, preset="aggressive", boundary=boundary) for boundary in ("fixed", SLIDING)]
    yield ("*Improve Mesh*, bracket, boundary fixed", f"{angles[0].smallest_angle_before:.1f}°",
           f"{angles[0].smallest_angle:.0f}°", "smallest dihedral angle")  # fmt: skip
    yield ("*Improve Mesh*, bracket, boundary slides",
           f"{angles[1].smallest_angle_before:.1f}°", f"{angles[1].smallest_angle:.0f}°",
           "smallest dihedral angle")  # fmt: skip
    bad = tl.perturb(DATA / "plate.vtu", fraction=0.98, percentage=100, seed=9)
    good = tl.optimize(bad)
    worst = good.statistics["imr"]
    yield ("*Optimize Mesh*, plate perturbed as in example 30",
           f"{worst['worst_before']:.0f}", f"{worst['worst_after']:.2f}",
           "worst inverse mean ratio")  # fmt: skip
    numbers = [tl.condition(mesh, preconditioner="jacobi").condition for mesh in (bad, good)]
    yield "*Condition Estimator*, the same", f"{numbers[0]:,.0f}", f"{numbers[1]:,.0f}", "condition number"
    counts = [tl.solve(mesh, source="1", solver="cg", preconditioner="none").iterations for mesh in (bad, good)]
    yield "*Solve PDE*, the same", f"{counts[0]}", f"{counts[1]}", "iterations of CG"
    plain, hybrid = (tl.warp(DATA / "plate.vtu", transform=TURN, method=name) for name in ("femwarp", "hybrid"))
    yield ("*Warp Mesh*, hole turned by 120°: by FEMWARP; by Hybrid, the default",
           f"{plain.inverted}", f"{hybrid.inverted}",
           "inverted elements")  # fmt: skip


def table() -> str:
    lines = ["| task | before | after | measured |", "|---|---|---|---|"]
    return "\n".join(lines + [f"| {' | '.join(row)} |" for row in rows()]) + "\n"


def main(page: Path, write: bool) -> int:
    text, measured = page.read_text(encoding="utf-8"), table()
    made = PLACE.sub(lambda match: match[1] + measured + match[3], text)
    print(measured)
    if measured not in made:
        print(f"{page} has no place for the figures")
        return 1
    if write:
        page.write_text(made, encoding="utf-8")
    elif made != text:
        print(f"these are not the figures of {page}: make_ratios.py {page} --write inserts them")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), "--write" in sys.argv[2:]))
