# SPDX-License-Identifier: BSD-3-Clause
"""A box that rotates in a box by 30 to 180 degrees: all methods, and published numbers of other programs."""

from __future__ import annotations

import math
import time

import numpy as np

import tautline

from ._common import QUANTITIES, measure
from ._meshes import sizes_of
from ._report import Report
from ._deformed import METHODS, Moving, Deformed, deform, parse, strip
from ._verdicts import Open, Times, all_of, faster

HALF_TURN = 180.0  # degrees at amount 1
ANGLES = (30, 60, 90, 120, 180)
SMALL_ANGLES = ANGLES[:-1]  # a coarse mesh cannot be rotated further
CELLS = 12_000
SMALL_CELLS = 1500
SECONDS = 2.0  # limit of a repair
#: Inverted elements by angle of other programs on a mesh of 12,600 tetrahedra; None: unknown.
PUBLISHED = {
    "OpenFOAM, displacementLaplacian": (1, 52, 269, 591, None),
    "OpenFOAM, displacementSBRStress": (2, 90, 435, 859, None),
    "thin plate spline": (0, 3, 151, 832, None),
    "foldover-free maps (36 s at 180 degrees)": (0, 0, 0, 0, 0),
}
MANY = 10  # inverted elements at least
STEP = 10  # degrees, of FEMWARP along the arc
SHOWN = (60, 120, 180)  # degrees, in the picture strip
STRIP = {"femwarp": "FEMWARP", "anisotropic": "anisotropic FEMWARP", "hybrid": "hybrid"}
QUALITY = ("imr_worst", "imr_mean")
#: Methods that are required to leave no inverted element.
REPAIRING = ("hybrid", "untangled")


def along_the_arc(box: Moving, angle: int) -> tuple[int, float, float]:
    """FEMWARP in steps along the arc, each from the mesh of the previous step as long as that is valid.

    Returns the number of inverted elements, the fraction of the rotation, CPU seconds.
    """
    began = time.process_time()
    mesh, before, left, done = box.mesh, box.at(0.0), 0, 0
    while done < angle and not left:
        done = min(done + STEP, angle)
        after = box.at(done / HALF_TURN)
        mesh = tautline.warp(mesh, after - before, method="femwarp", threads=1).mesh
        before, left = after, int(np.count_nonzero(sizes_of(mesh) <= 0))
    return left, done / angle, time.process_time() - began


def findings(report: Report, of: dict[str, list[Deformed]], angles: tuple[int, ...]) -> None:
    def counts(name: str) -> str:
        return ", ".join(f"{w.inverted} at {angle}" + (f" (to {w.reached:.3g} of it)" if w.reached < 1 else "")
                         for angle, w in zip(angles, of[name]))

    for name in REPAIRING:
        report.finding("4.9", f"{METHODS[name][0]}: no inverted element at any angle",
                       all(w.complete for w in of[name]), counts(name), own=True,
                       criterion="none, and the whole rotation is reached")
        report.finding("4.9", f"{METHODS[name][0]}: at most {SECONDS:g} s each",
                       all_of(faster(w.times, Times((SECONDS,))) if w.complete else
                              Open(f"{METHODS[name][0]} failed at {angle} degrees") for angle, w in
                              zip(angles, of[name])),
                       ", ".join(f"{w.seconds:.2f} s at {angle}" for angle, w in zip(angles, of[name])), own=True,
                       criterion="CPU time at each angle")
    turn = angles.index(90)
    report.finding("4.8.2",
                   "FEMWARP often generates a large number of inverted elements if deformations are not affine",
                   of["femwarp"][turn].inverted >= MANY, counts("femwarp"),
                   criterion=f"at least {MANY} at 90 degrees")
    fewer = [a.inverted <= f.inverted for a, f in zip(of["anisotropic"], of["femwarp"])]
    report.finding("4.9.1", "Anisotropic FEMWARP inverts no more than FEMWARP, though a rotation has no direction",
                   all_of(fewer), counts("anisotropic"), own=True, criterion="at each angle")
    early = next((angle for angle, w in zip(angles, of["radial-basis"]) if w.inverted), None)
    report.finding("published", "Radial basis functions fail at larger angles than Laplace's equation",
                   early is not None and of["radial-basis"][turn].inverted > 0
                   and of["radial-basis"][0].inverted <= of["femwarp"][0].inverted
                   and of["radial-basis"][1].inverted < of["femwarp"][1].inverted, counts("radial-basis"), own=True,
                   criterion="no more inverted elements at the smallest angle, fewer at the second, some at 90 degrees")


def main(arguments: list[str]) -> int:
    given = parse("box_rotation", __doc__, arguments)
    report = Report("box_rotation", "A box that rotates in a box", given)
    report.text(
        f"About {SMALL_CELLS if given.small else CELLS:,} tetrahedra between a fixed box and one that rotates about "
        "the vertical axis. The published numbers are of a mesh of 12,600 tetrahedra between boxes of unknown sizes; "
        "ours are chosen so that a thin plate spline inverts about as many elements (0, 7, 190, 840 at 30 to 120 "
        "degrees). The input of a method is the final position of the boundary, not its path; methods with steps "
        f"follow the chord. Times are CPU seconds of one thread, the fastest of {given.repeats} runs. IMR is the "
        "inverse mean ratio of the valid elements."
    )
    for seed in report.seeds:
        run(report, given.small, given.repeats, seed)
    return report.finish()


def run(report: Report, small: bool, repeats: int, seed: int) -> None:
    """The study with one seed."""
    angles = SMALL_ANGLES if small else ANGLES
    box = Moving("box-in-box", SMALL_CELLS if small else CELLS, seed)
    of = {name: [deform(box.mesh, box.at(angle / HALF_TURN), name, repeats=repeats)
                 for angle in angles] for name in METHODS}
    columns = [str(angle) for angle in angles]
    rows = [[METHODS[name][0], *(float(w.inverted) for w in runs)] for name, runs in of.items()]
    arc = [along_the_arc(box, angle) for angle in angles]
    in_steps = f"FEMWARP in steps of {STEP} degrees along the arc"
    rows.append([in_steps, *(float(left) for left, _, _ in arc)])
    rows += [[name, *(math.nan if n is None else float(n) for n in values[: len(angles)])]
             for name, values in PUBLISHED.items()]
    report.table("inverted", "Inverted elements by angle, published numbers below", ["method", *columns], rows)
    quality = {name: [measure(w.mesh, QUALITY) for w in runs] for name, runs in of.items()}
    for quantity in QUALITY:
        report.table(quantity, f"{'Worst' if 'worst' in quantity else 'Mean'} {QUANTITIES[quantity][0].upper()}",
                     ["method", *columns],
                     [[METHODS[name][0], *(found[quantity] for found in of_name)] for name, of_name in quality.items()])
    report.table("shape", "Worst TMP shape (4.22) of all elements", ["method", *columns],
                 [[METHODS[name][0], *(w.worst for w in runs)] for name, runs in of.items()])
    report.table("reached", "Fraction of the motion reached", ["method", *columns],
                 [*([METHODS[name][0], *(w.reached for w in runs)] for name, runs in of.items()),
                  [in_steps, *(reached for _, reached, _ in arc)]])
    report.table("seconds", "CPU seconds", ["method", *columns],
                 [*([METHODS[name][0], *(w.seconds for w in runs)] for name, runs in of.items()),
                  [in_steps, *(seconds for _, _, seconds in arc)]])
    known = angles[: len(PUBLISHED["thin plate spline"]) - 1]
    curves = {METHODS[name][0]: (angles, [w.inverted if w.reached >= 1 else math.nan for w in runs])
              for name, runs in of.items()}
    peers = {name: (known, values[: len(known)]) for name, values in PUBLISHED.items()}
    report.lines("inverted", [
        ("Tautline, where the whole rotation was reached", "degrees", "inverted elements", curves),
        ("published", "degrees", "inverted elements", peers),
    ])
    lines = []
    for angle in [angle for angle in SHOWN if angle in angles]:
        at = angles.index(angle)
        lines.append([("before", box.mesh)] + [
            (f"{label}, {angle} degrees", of[name][at]) for name, label in STRIP.items()])
    strip(report, "strip", lines, [None] * len(lines), cut=(2, 0.5))
    findings(report, of, angles)
