# SPDX-License-Identifier: BSD-3-Clause
"""Anisotropic FEMWARP with coefficients that vary in space, from the displacement gradients, on six moving domains."""

from __future__ import annotations

from ._report import Report
from ._deformed import EXAMPLES, Deformed, Moving, deform, parse, strip
from ._verdicts import all_of

AMOUNTS = (1.0, 1.5)
SMALL_CELLS = (400, 1500)  # triangles, tetrahedra
#: The domain and the amount of each case.
CASES = tuple((example.domain, amount) for amount in AMOUNTS for example in EXAMPLES)
SHOWN = "bar"  # in the picture strip
SOURCE = "4.9.1, 6"  # where the dissertation asks for other coefficients
#: Names of the compared variants, their titles, the method of METHODS and the coefficients.
CHOICES: dict[str, tuple[str, str, dict[str, str]]] = {
    "femwarp": ("FEMWARP", "femwarp", {}),
    "constant": ("constant, (4.19)", "anisotropic", {}),
    "principal": ("constant, principal directions", "anisotropic", {"coefficients": "principal directions"}),
    "local": ("local gradients", "anisotropic", {"coefficients": "local gradients"}),
}


def findings(report: Report, of: dict[str, list[Deformed]]) -> None:
    """One verdict per amount and question."""
    for amount in AMOUNTS:
        at = [i for i, (_, moved) in enumerate(CASES) if moved == amount]
        local, constant, isotropic = ([of[name][i].inverted for i in at] for name in ("local", "constant", "femwarp"))
        where = f"at {amount:g} times the motion"
        report.finding(SOURCE, f"Coefficients from local gradients invert fewer elements than constant ones {where}, "
                       "in all examples together", sum(local) < sum(constant),
                       f"{sum(local)} instead of {sum(constant)}", criterion="a smaller sum", own=True)
        for name, label, others in (("constant", "constant ones", constant), ("femwarp", "FEMWARP", isotropic)):
            report.finding(SOURCE, f"Coefficients from local gradients invert fewer elements than {label} {where}, in "
                           "each example", all_of(a < b or a == b == 0 for a, b in zip(local, others)),
                           ", ".join(f"{CASES[i][0]} {a} instead of {b}" for i, a, b in zip(at, local, others)),
                           criterion="fewer in each, or none with both", own=True,
                           reason=_why(of, at, name))


def _why(of: dict[str, list[Deformed]], at: list[int], name: str) -> str:
    """Why local coefficients are not always better: their effect on the worst shape where they invert more."""
    more = [i for i in at if of["local"][i].inverted >= of[name][i].inverted > 0]
    return ("beyond the dissertation's motion FEMWARP's gradients, from which they are, belong to a mesh with inverted "
            "elements; where they invert as many or more, the worst TMP shape is still " + ", ".join(
                f"{of['local'][i].worst:.3g} instead of {of[name][i].worst:.3g} ({CASES[i][0]})" for i in more))


def main(arguments: list[str]) -> int:
    given = parse("local_coefficients", __doc__, arguments, repeats=1)
    report = Report("local_coefficients", "Coefficients of FEMWARP that vary in space (4.9.1 and 6)", given)
    report.text(
        "The dissertation chooses constant coefficients by hand from the direction of the motion, and asks for better "
        "ones. Here FEMWARP first gives the displacements u of all points; then each element gets the tensor (1 + "
        "|grad u|^2 / mean |grad u|^2) (I / 20 + d d^T / |d|^2), with d its displacement, and FEMWARP is solved again. "
        "So elements that deform much are stiff along the motion, and those around them take a part of it."
    )
    for seed in report.seeds:
        run(report, given.small, given.repeats, seed)
    return report.finish()


def run(report: Report, small: bool, repeats: int, seed: int) -> None:
    """The study with one seed."""
    moving = [Moving(e.domain, SMALL_CELLS[e.domain == "sphere"] if small else 0, seed) for e in EXAMPLES]
    of: dict[str, list[Deformed]] = {}
    for name, (_, method, options) in CHOICES.items():
        of[name] = [
            deform(m.mesh, m.at(amount), method, repeats=repeats, **options) for amount in AMOUNTS for m in moving
        ]
    columns = [f"{domain} {amount:g}" for domain, amount in CASES]
    for file, title, value in (
        ("inverted", "Inverted elements", lambda w: w.inverted),
        ("worst", "Worst TMP shape", lambda w: w.worst),
        ("seconds", "CPU seconds", lambda w: w.seconds),
    ):
        report.table(file, title, ["coefficients", *columns],
                     [[CHOICES[name][0], *(float(value(w)) for w in runs)] for name, runs in of.items()])
    report.grid("inverted", "Inverted elements", [title for title, _, _ in CHOICES.values()],
                [f"{domain}\n{amount:g}" for domain, amount in CASES],
                [[float(w.inverted) for w in runs] for runs in of.values()])
    at = [domain for domain, _ in CASES].index(SHOWN)
    strip(report, "strip", [[(CHOICES[name][0], runs[at]) for name, runs in of.items()]], [None])
    findings(report, of)
    local, constant = (sum(w.seconds for w in of[name]) for name in ("local", "constant"))
    fewer = [sum(w.inverted for w in of[name][: len(EXAMPLES)]) for name in ("femwarp", "constant", "local")]
    report.text(
        f"Question (4.9.1 and 6): do coefficients that vary in space invert fewer elements? Result: at the "
        f"dissertation's motion FEMWARP inverts {fewer[0]} elements of the six examples, constant "
        f"coefficients {fewer[1]}, local gradients {fewer[2]}; they take {local / constant:.2g} times the CPU time of "
        "constant ones, for the first solve. The table has the larger motion."
    )
    worse = [
        f"{domain} at {amount:g} times the motion ({of['local'][i].inverted} instead of {of[name][i].inverted} with "
        f"{CHOICES[name][0]})"
        for i, (domain, amount) in enumerate(CASES)
        for name in ("femwarp", "constant")
        if of["local"][i].inverted > of[name][i].inverted
    ]
    report.text("Local gradients are not always better. They invert more elements in: " + "; ".join(worse) + "."
                if worse else "Local gradients never invert more elements here.")  # fmt: skip
