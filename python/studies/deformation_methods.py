# SPDX-License-Identifier: BSD-3-Clause
"""All methods of mesh deformation on the six moving domains of section 4.10."""

from __future__ import annotations

from typing import Callable

import numpy as np

from ._report import Report
from ._deformed import EXAMPLES, METHODS, Moving, Deformed, deform, parse, strip

AMOUNTS = (1.0, 1.5)
SMALL_CELLS = (400, 1500)  # triangles, tetrahedra
SHOWN = "bar"  # in the picture strip
PANELS = 4  # in a row of it
#: Methods with a second step that moves points until no element is inverted.
REPAIRING = ("hybrid", "hybrid-steps", "hybrid-literal", "small-steps", "untangled")


def table(
    report: Report, file: str, title: str, columns: list[str], of: dict[str, list[Deformed]], value: Callable
) -> list[list]:
    rows = [[METHODS[name][0], *(float(value(deformed)) for deformed in runs)] for name, runs in of.items()]
    report.table(file, title, ["method", *columns], rows)
    return rows


def findings(report: Report, of: dict[str, list[Deformed]], columns: list[str]) -> None:
    def left(name: str) -> str:
        """Domains with remaining inverted elements, or with a part of the motion only."""
        return ", ".join(f"{c} {w.inverted}" + (f" (to {w.reached:.3g} of it)" if w.reached < 1 else "")
                         for c, w in zip(columns, of[name]) if not w.complete) or "none anywhere"

    def worse(name: str) -> list[float]:
        """Worst shapes over those of the hybrid algorithm, where both meshes are valid."""
        return [a.worst / b.worst for a, b in zip(of[name], of["hybrid"]) if a.complete and b.complete]

    report.finding("4.10", "The hybrid algorithm leaves no inverted elements",
                   all(w.inverted == 0 for w in of["hybrid-steps"]),
                   f"in one step {left('hybrid')}; in as many as needed {left('hybrid-steps')}")
    fewer = [(a.inverted, f.inverted) for a, f in zip(of["anisotropic"], of["femwarp"])]
    report.finding("4.11", "Anisotropic FEMWARP inverts fewer elements than FEMWARP", all(a < f for a, f in fewer),
                   ", ".join(f"{c} {a} instead of {f}" for c, (a, f) in zip(columns, fewer)))
    report.finding("4.7", "FEMWARP generates many inverted elements", all(w.inverted > 0 for w in of["femwarp"]),
                   left("femwarp"))
    report.finding("4.7", "The biharmonic operator has no mechanism against inverted elements",
                   any(w.inverted for w in of["biharmonic"]), left("biharmonic"))
    possible = [i for i, w in enumerate(of["hybrid-steps"]) if w.complete]
    for name, label in (("small-steps", "Small-step FEMWARP"), ("untangled", "FEMWARP followed by untangling")):
        report.finding("4.7", f"{label} leaves no inverted elements, where a valid mesh is known to exist",
                       all(of[name][i].complete for i in possible), f"left {left(name)}")
        ratios = worse(name)
        report.finding("4.7", f"{label} does not preserve the shapes: the worst element is worse than the hybrid "
                       "algorithm's", min(ratios, default=0) > 1,
                       f"{min(ratios, default=0):.3g} to {max(ratios, default=0):.3g} times, worse in "
                       f"{sum(r > 1 for r in ratios)} of {len(ratios)}")
    others = [name for name in of if name not in REPAIRING]
    tangled = {name: sum(w.inverted > 0 for w in of[name]) for name in others}
    report.finding("4.7", "Every other method inverts elements somewhere", all(tangled.values()),
                   "number of " + str(len(columns)) + " cases: " + ", ".join(
                       f"{METHODS[n][0]} {count}" for n, count in tangled.items()))
    means = {name: float(np.mean([np.mean(w.shapes) for w in runs])) for name, runs in of.items()}
    report.text("Mean TMP shape over all: " + ", ".join(f"{METHODS[n][0]} {m:.3g}" for n, m in means.items()) + ".")


def main(arguments: list[str]) -> int:
    given = parse("deformation_methods", __doc__, arguments, repeats=1)
    report = Report("deformation_methods", "Methods of mesh deformation on six moving domains (sections 4.7 and 4.10)",
                    given.out, given.small)
    report.text(
        "The examples of the study `deformation` at the dissertation's largest motion and 1.5 times that, all methods "
        "with their defaults. At 1.5 times its motion the gate touches the opposite wall: no mesh is valid there, and "
        "methods that check this stop before. TMP shape is (4.22), of all elements, inverted ones too."
    )
    moving = [Moving(e.domain, SMALL_CELLS[e.domain == "sphere"] if given.small else 0) for e in EXAMPLES]
    cases = [(e.domain, m, amount) for amount in AMOUNTS for e, m in zip(EXAMPLES, moving)]
    columns = [f"{name} {amount:g}" for name, _, amount in cases]
    of = {name: [deform(m.mesh, m.at(amount), name, repeats=given.repeats) for _, m, amount in cases]
          for name in METHODS}
    rows = table(report, "inverted", "Inverted elements", columns, of, lambda w: w.inverted)
    table(report, "worst", "Worst TMP shape", columns, of, lambda w: w.worst)
    table(report, "mean", "Mean TMP shape", columns, of, lambda w: np.mean(w.shapes))
    table(report, "reached", "Fraction of the motion reached", columns, of, lambda w: w.reached)
    table(report, "seconds", "CPU seconds", columns, of, lambda w: w.seconds)
    report.grid("inverted", "Inverted elements", [row[0] for row in rows],
                [f"{name}\n{amount:g}" for name, _, amount in cases], [row[1:] for row in rows])
    at = [name for name, _, _ in cases].index(SHOWN)
    shown = [("before", cases[at][1].mesh)] + [(METHODS[n][0], runs[at]) for n, runs in of.items()]
    lines = [shown[i : i + PANELS] for i in range(0, len(shown), PANELS)]
    strip(report, "strip", lines, [None] * len(lines))
    findings(report, of, columns)
    return report.finish()
