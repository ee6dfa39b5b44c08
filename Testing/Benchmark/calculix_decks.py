# SPDX-License-Identifier: BSD-3-Clause
"""calculix_decks.py [--keep FOLDER]: decks that CalculiX rejects, repaired by Tautline, and given to CalculiX again.

Twenty parts are meshed coarsely by Gmsh with tetrahedra of ten nodes (C3D10) and written as decks of CalculiX: own
weight, one end held. CalculiX ends with "nonpositive jacobian determinant" in each. `tautline untangle` repairs the
mesh of a deck, and CalculiX must run through then, with finite displacements, and the mid nodes must still be on curved
edges. Prints the table of the documentation; the exit status is 1 where fewer than `AIM` decks run. Without
Gmsh's Python module and CalculiX (Debian: python3-gmsh, calculix-ccx) nothing is done.
"""

import argparse
import importlib.util
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np
import tautline as tl

AIM = 18
#: Mid nodes may come nearer to the middle of their edge, on the average, by this factor.
LEAST_CURVATURE = 0.8
#: CalculiX has no business running longer, in seconds.
LONGEST_RUN = 300
#: Part (see curved_parts), edge length, points per circle.
DECKS = [
    ("bearing_block", 0.5, 6), ("block_with_holes", 0.7, 6), ("bracket", 0.7, 4), ("connecting_rod", 0.5, 5),
    ("dome", 0.7, 4), ("eccentric_ring", 0.7, 6), ("elbow", 0.35, 6), ("flange", 0.5, 6), ("hollow_cone", 0.7, 4),
    ("hollow_torus", 0.35, 6), ("impeller", 0.5, 6), ("lug", 0.7, 5), ("perforated_plate", 0.7, 5), ("pipe", 1.0, 6),
    ("pulley", 1.0, 6), ("rounded_box", 0.35, 6), ("spherical_shell", 0.7, 6), ("tank", 0.35, 6), ("tee", 0.5, 6),
    ("torus_segment", 0.7, 6),
]  # fmt: skip
#: Gmsh's number of the tetrahedron of ten nodes, and its nodes in the order of a deck.
TETRAHEDRON10 = 11
DECK_ORDER = [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]
#: Edges of a tetrahedron of a deck: ends, mid node.
EDGES = np.array([(0, 1, 4), (1, 2, 5), (2, 0, 6), (0, 3, 7), (1, 3, 8), (2, 3, 9)])
#: The lowest part of the longest extent is held.
HELD = 0.08
HEAD = "*HEADING\n{name}: tetrahedra of ten nodes, edge length {size}, {circle} points per circle (Gmsh)\n"
TAIL = """*MATERIAL, NAME=Steel
*ELASTIC
210000., .3
*DENSITY
7.8e-9
*SOLID SECTION, ELSET=Eall, MATERIAL=Steel
*BOUNDARY
Nheld, 1, 3
*STEP
*STATIC
*DLOAD
Eall, GRAV, 9810., 0., 0., -1.
*NODE PRINT, NSET=Nall
U
*END STEP
"""


def sixteen(numbers: np.ndarray) -> list[str]:
    """Numbers, sixteen in a line, as cards of a deck may have."""
    return [", ".join(map(str, numbers[i : i + 16])) + "," for i in range(0, len(numbers), 16)]


def write_deck(name: str, size: float, circle: int, file: Path) -> int:
    """Writes a part as a deck; the number of its elements. Uses Gmsh in this process."""
    import curved_parts
    import gmsh

    with curved_parts.meshed(name, size, circle):
        tags, nodes = gmsh.model.mesh.getElementsByType(TETRAHEDRON10)
        points, coordinates, _ = gmsh.model.mesh.getNodes()
        cells = np.array(nodes).reshape(-1, 10)[:, DECK_ORDER]
        used = np.isin(points, cells)
        points, places = np.array(points)[used], np.array(coordinates).reshape(-1, 3)[used]
    order = np.argsort(points)
    points, places = points[order], places[order]
    cells = np.searchsorted(points, cells) + 1
    axis = np.argmax(np.ptp(places, axis=0))
    along = places[:, axis] - places[:, axis].min()
    held = np.flatnonzero(along <= HELD * along.max()) + 1
    lines = ["*NODE, NSET=Nall"]
    lines += [f"{i}, {x:.12g}, {y:.12g}, {z:.12g}" for i, (x, y, z) in enumerate(places.tolist(), 1)]
    lines += ["*ELEMENT, TYPE=C3D10, ELSET=Eall"]
    lines += [", ".join(map(str, (i, *cell))) for i, cell in enumerate(cells.tolist(), 1)]
    lines += ["*NSET, NSET=Nheld", *sixteen(held)]
    file.write_text(HEAD.format(name=name, size=size, circle=circle) + "\n".join(lines) + "\n" + TAIL)
    return len(cells)


class Run(NamedTuple):
    """The result of CalculiX for a deck."""

    ended: bool  #: Whether it ran through, with finite displacements.
    rejected: int  #: Elements with a nonpositive determinant that it names; it ends at the first ones.
    displacement: float  #: The largest one.


def calculix(deck: Path) -> Run:
    """Gives a deck to CalculiX, in the folder of the deck, with one thread (its messages are in order then)."""
    done = subprocess.run(["ccx", deck.stem], cwd=deck.parent, capture_output=True, text=True, timeout=LONGEST_RUN,
                          env={**os.environ, "OMP_NUM_THREADS": "1"})  # fmt: skip
    rejected = len(set(re.findall(r"nonpositive jacobian\s+determinant in element\s+(\d+)", done.stdout)))
    results = deck.with_suffix(".dat")
    rows = results.read_text().splitlines() if results.exists() else []
    values = np.array([row.split()[1:] for row in rows if len(row.split()) == 4 and row.split()[0].isdigit()], float)
    ended = done.returncode == 0 and "Job finished" in done.stdout and values.size > 0 and np.isfinite(values).all()
    return Run(bool(ended), rejected, float(np.abs(values).max()) if values.size else 0)


def curvature(deck: Path) -> float:
    """The mean distance of the mid nodes from the middles of their edges, by the length of the edge."""
    points: dict[int, list[float]] = {}
    cells: list[list[int]] = []
    card = ""
    for line in deck.read_text().splitlines():
        if line.startswith("*"):
            card = line.split(",")[0].strip().upper()
        elif card == "*NODE":
            number, *place = line.split(",")
            points[int(number)] = [float(value) for value in place[:3]]
        elif card == "*ELEMENT":
            cells.append([int(number) for number in line.split(",")[1:11]])
    nodes = np.array([[points[number] for number in cell] for cell in cells])
    start, end, middle = (nodes[:, EDGES[:, i]] for i in range(3))
    return float((np.linalg.norm(middle - (start + end) / 2, axis=2) / np.linalg.norm(end - start, axis=2)).mean())


def generate(folder: Path) -> dict[str, int]:
    """Writes all decks; the numbers of their elements. One process each: Gmsh keeps nothing of the last part."""
    counts = {}
    for name, size, circle in DECKS:
        command = [sys.executable, __file__, "--write", name, str(size), str(circle), str(folder)]
        done = subprocess.run(command, check=True, capture_output=True, text=True)
        counts[name] = int(done.stdout.split()[-1])
    return counts


def repair(deck: Path, target: Path) -> tuple[bool, float]:
    """Repairs the mesh of a deck by the shell command; whether that is certified to be valid, and CPU seconds."""
    command = [sys.executable, "-m", "tautline", "untangle", str(deck), "-o", str(target), "--threads", "1"]
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    if not target.exists():
        print(f"  {deck.stem}: {(done.stderr or done.stdout).strip().splitlines()[-1]}", flush=True)
        return False, seconds
    return tl.quality(target, ["min_jacobian"]).inverted == 0, seconds


def run(folder: Path) -> int:
    """Prints the table; the number of decks that CalculiX rejects first and runs after the repair, still curved."""
    counts = generate(folder)
    print("| deck | elements | rejected by CalculiX | invalid (certified) | after the repair | curvature | seconds |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    good = 0
    for name, _, _ in DECKS:
        deck, repaired = folder / f"{name}.inp", folder / f"{name}-repaired.inp"
        first = calculix(deck)
        invalid = tl.quality(deck, ["min_jacobian"]).inverted
        valid, seconds = repair(deck, repaired)
        second = calculix(repaired) if repaired.exists() else Run(False, 0, 0)
        bend = curvature(repaired) / curvature(deck) if repaired.exists() else 0
        runs = not first.ended and first.rejected > 0 and second.ended and bend >= LEAST_CURVATURE
        good += runs
        verdict = f"runs, {'0 invalid' if valid else 'still invalid elements'}" if runs else "DOES NOT RUN"
        print(f"| {name} | {counts[name]} | {first.rejected} | {invalid} | {verdict} | {bend:.0%} | {seconds:.2f} |",
              flush=True)  # fmt: skip
    print(f"{good} of {len(DECKS)} decks run after the repair (aim: {AIM})")
    return good


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--keep", metavar="FOLDER", help="folder for the decks, which are removed without it")
    parser.add_argument("--write", nargs=4, metavar=("PART", "SIZE", "CIRCLE", "FOLDER"), help=argparse.SUPPRESS)
    options = parser.parse_args()
    if importlib.util.find_spec("gmsh") is None or shutil.which("ccx") is None:
        print("Gmsh's Python module or CalculiX is not installed (Debian: python3-gmsh, calculix-ccx): no decks")
        return 0
    if options.write:
        part, size, circle, folder = options.write
        print(write_deck(part, float(size), int(circle), Path(folder, f"{part}.inp")))
        return 0
    if options.keep:
        os.makedirs(options.keep, exist_ok=True)
        return 0 if run(Path(options.keep)) >= AIM else 1
    with tempfile.TemporaryDirectory(prefix="tautline-decks-") as temporary:
        return 0 if run(Path(temporary)) >= AIM else 1


if __name__ == "__main__":
    sys.exit(main())
