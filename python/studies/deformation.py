# SPDX-License-Identifier: BSD-3-Clause
"""FEMWARP, anisotropic FEMWARP and the hybrid algorithm on six moving domains: section 4.10, Figures 4.24 to 4.39."""

from __future__ import annotations

import math

import numpy as np

import tautline

from ._report import Report
from ._deformed import EXAMPLES, Example, Moving, Deformed, bin_names, deform, distribution, less, parse, strip
from ._verdicts import Times, all_of, same_count
from ._verdicts import faster as takes_less

AMOUNTS = (0.25, 0.5, 0.75, 1.0, 1.25)
SMALL_AMOUNTS = (0.5, 1.0)
FAR = 1.5  # times the dissertation's largest motion
RUNS = ("femwarp", "anisotropic", "hybrid", "ubn")
COMPARED = {"femwarp": "FEMWARP", "ubn": "UBN", "hybrid": "hybrid"}  # in Figures 4.25 to 4.38
STEPS = "hybrid-steps"  # at FAR times the motion
SMALL_CELLS = (800, 3000)  # triangles, tetrahedra
SMALL_EXAMPLES = ("cylinder", "bar", "sphere")
ISOTROPIC = {"coefficients": (1, 1, 1)}  # of the first step of the hybrid algorithm: it is FEMWARP
STARTS = ("FEMWARP", "anisotropic")
#: Within which counts of inverted elements are the dissertation's, whose meshes are other ones.
COUNT_TOLERANCE = 0.5
TRIALS = (1, 2, 3, 4, 6, 8, 12, 16, 20, 30, 50)  # iterations of (4.24)


def untangled_after(moving: Moving, displacement: np.ndarray, repeats: int, **more) -> tuple[float, Times | None]:
    """Iterations of (4.24) until no element is inverted, and CPU seconds; NaN, None: more than the last trial."""
    for iterations in TRIALS:
        options = {"method": "hybrid", "untangle_first": False, "maximum_iterations": iterations, "threads": 1, **more}
        history = tautline.warp(moving.mesh, displacement, **options).history
        if history["inverted"][history["stage"].index("optimize")] == 0:
            more["maximum_iterations"] = iterations
            run = deform(moving.mesh, displacement, "hybrid-literal", repeats=repeats, **more)
            return float(iterations), run.times
    return math.nan, None


def sweep(report: Report, example: Example, moving: Moving, amounts: tuple,
          repeats: int) -> tuple[dict[str, np.ndarray], list[tuple[Times | None, ...]]]:
    """Inverted elements after FEMWARP and anisotropic FEMWARP, and the cost of untangling each, by amount.

    The second result has the CPU seconds by (4.24) from either start, by amount.
    """
    rows, times = [], []
    for amount in amounts:
        displacement = moving.at(amount)
        counts = [deform(moving.mesh, displacement, m).inverted for m in ("femwarp", "anisotropic")]
        literal = [untangled_after(moving, displacement, repeats, **more) for more in (ISOTROPIC, {})]
        ours = [deform(moving.mesh, displacement, "hybrid", repeats=repeats, **more) for more in (ISOTROPIC, {})]
        times.append(tuple(t for _, t in literal))
        seconds = [math.nan if t is None else t.best for t in times[-1]]
        rows.append([amount, *counts, *(n for n, _ in literal), *seconds, *(w.seconds for w in ours),
                     *(float(w.inverted) for w in ours)])
    headings = ["amount"] + [f"{quantity}{start}" for quantity in ("", "iterations ", "s ", "own s ", "left ")
                             for start in STARTS]
    report.table(
        f"sweep_{example.domain}",
        f"{example.title}: inverted elements, iterations of (4.24) until there are none and CPU seconds then, CPU "
        "seconds with our second step and the remaining inverted elements",
        headings, rows,
    )
    return dict(zip(headings, np.array(rows, float).T)), times


def quality(report: Report, example: Example, runs: dict[str, Deformed]) -> None:
    """The distribution of TMP shape over the elements: Figures 4.25, 4.28, 4.31, 4.34, 4.36, 4.38."""
    rows = [[name, *distribution(w), float(np.mean(w.shapes)), w.worst] for name, w in runs.items()]
    report.table(f"quality_{example.domain}",
                 f"{example.title}: elements by TMP shape (4.22), 0 is the initial shape; mean and worst of all",
                 ["method", *bin_names(), "mean", "worst"], rows)


def findings(report: Report, example: Example, swept: dict[str, np.ndarray], times: list[tuple[Times | None, ...]],
             runs: dict[str, Deformed], cells: int) -> None:
    source = example.section
    fem, anisotropic, hybrid, ubn = (runs[f"{name}, amount 1"] for name in RUNS)
    title = example.title
    report.finding(source, f"{title}: FEMWARP inverts {example.femwarp} elements (within {COUNT_TOLERANCE:.0%})",
                   same_count(fem.inverted, example.femwarp, COUNT_TOLERANCE), f"{fem.inverted} of {cells}")
    there = "fewer" if example.anisotropic is None else f"{example.anisotropic} instead of {example.femwarp}"
    if example.fewer is not None:
        there += f", up to {example.fewer:g} % less"
    gains = {a: less(n, f) for a, f, n in zip(swept["amount"], swept["FEMWARP"], swept["anisotropic"]) if f > 0}
    report.finding(source, f"{title}: anisotropic FEMWARP inverts far fewer (there {there})",
                   anisotropic.inverted <= 0.5 * fem.inverted and min(gains.values(), default=0) >= 0,
                   f"{anisotropic.inverted} instead of {fem.inverted} at amount 1; less by " +
                   ", ".join(f"{gain:.1f} % at {amount:g}" for amount, gain in gains.items()))
    alpha = ":".join(f"{c:g}" for c in example.coefficients)
    ours = anisotropic.coefficients[: len(example.coefficients)]
    report.text(f"{title}: coefficients there {alpha}, by (4.19) here " + ":".join(f"{c:.3g}" for c in ours) + ".")
    far = runs[f"{STEPS}, amount {FAR:g}"]
    reached = f", up to {far.reached:.4g} of it" if far.reached < 1 else ""
    once = runs[f"hybrid, amount {FAR:g}"].inverted
    at = list(swept["amount"]).index(1.0)
    needed = swept["iterations anisotropic"][at]
    report.finding(source, f"{title}: the hybrid algorithm, literally (4.24), leaves none", not math.isnan(needed),
                   f"some are left after {TRIALS[-1]} iterations" if math.isnan(needed)
                   else f"none after {needed:.0f} iterations")
    report.finding(f"in addition to {source}", f"{title}: the hybrid algorithm with our second step leaves none, nor "
                   f"at {FAR:g} times the motion", hybrid.inverted == far.inverted == 0,
                   f"{hybrid.inverted} at amount 1; at {FAR:g} {once} in one step, {far.inverted} in as many as "
                   f"needed{reached}")
    report.finding(source, f"{title}: its worst element is better than FEMWARP's (there by {example.than_femwarp:g} %)",
                   hybrid.worst < fem.worst,
                   f"{less(hybrid.worst, fem.worst):.1f} %: {hybrid.worst:.4g} against {fem.worst:.4g}")
    against = f"{less(hybrid.worst, ubn.worst):.1f} %: {hybrid.worst:.4g} against {ubn.worst:.4g}"
    if example.than_ubn is None:
        report.finding(source, f"{title}: UBN's stiffening finds no mesh without inverted elements",
                       ubn.inverted > 0, f"{ubn.inverted} inverted; the hybrid's worst element is better by {against}")
    else:
        report.finding(source, f"{title}: its worst element is better than UBN's (there by {example.than_ubn:g} %)",
                       hybrid.worst < ubn.worst, against)
    if example.faster is not None:
        faster(report, example, swept, times)


def faster(report: Report, example: Example, swept: dict[str, np.ndarray],
           times: list[tuple[Times | None, ...]]) -> None:
    """Add the finding on the cost of untangling from either start, at the amounts at which FEMWARP inverts elements."""
    at = np.flatnonzero(swept["FEMWARP"] > 0)
    slow, fast = (np.nan_to_num(swept[f"iterations {start}"][at], nan=np.inf) for start in STARTS)
    seconds = [less(swept["s anisotropic"][i], swept["s FEMWARP"][i]) for i in at]

    def text(iterations: float) -> str:
        return f"over {TRIALS[-1]}" if math.isinf(iterations) else f"{iterations:.0f}"

    figures = [f"{text(f)} instead of {text(s)} iterations at {a:g}" + (f" ({p:.0f} % less time)" if p == p else "")
               for f, s, a, p in zip(fast, slow, swept["amount"][at], seconds)]
    fewer = np.all(fast <= slow) and np.any(fast < slow)
    report.finding(example.section, f"{example.title}: after anisotropic FEMWARP, (4.24) needs fewer iterations to "
                   "untangle it", fewer, ", ".join(figures))
    both = [times[i] for i in at if None not in times[i]]
    report.finding(example.section, f"{example.title}: ... and less time (there by up to {example.faster:g} %)",
                   all_of(takes_less(t, f) for f, t in both),
                   ", ".join(f"{t} instead of {f}" for f, t in both) or "nowhere were both untangled")


def pictures(report: Report, example: Example, moving: Moving, runs: dict[str, Deformed]) -> None:
    names = {"femwarp": "FEMWARP", "anisotropic": "anisotropic FEMWARP"}
    rows = {
        a: [(f"{label}, amount {a:g}", runs[f"{n}, amount {a:g}"]) for n, label in {**names, last: "hybrid"}.items()]
        for a, last in ((1.0, "hybrid"), (FAR, STEPS))
    }
    whole, near, far = ([(title, moving.mesh)] + rows[a] for title, a in (
        ("before", 1.0), ("before, close-up", 1.0), ("before", FAR)))
    strip(report, f"strip_{example.domain}", [whole, near, far], [None, example.window, None])


def main(arguments: list[str]) -> int:
    given = parse("deformation", __doc__, arguments)
    report = Report("deformation", "Six moving domains (section 4.10)", given.out, given.small)
    report.text(
        "The domains have the shapes of the dissertation's, which has no dimensions, and other meshes; amount 1 is its "
        "largest motion according to the figures. Coefficients follow from (4.19) and (4.21). TMP shape "
        "is (4.22) against the initial element; worst and mean are over all elements, inverted ones too. There "
        "are two variants of the second step: literally (4.24), as in the dissertation, with as many iterations as "
        f"needed until no element is inverted (at most {TRIALS[-1]}), and ours, which untangles first. UBN is its "
        "iterative stiffening only, as there. Times are CPU seconds of deformation and second step, the fastest of "
        f"{given.repeats} runs."
    )
    amounts = SMALL_AMOUNTS if given.small else AMOUNTS
    inverted, iterations, seconds, qualities = [], [], [], {}
    for example in [e for e in EXAMPLES if not given.small or e.domain in SMALL_EXAMPLES]:
        solid = example.domain == "sphere"
        moving = Moving(example.domain, SMALL_CELLS[solid] if given.small else 0)
        swept, times = sweep(report, example, moving, amounts, given.repeats)
        runs = {
            f"{name}, amount {a:g}": deform(moving.mesh, moving.at(a), name)
            for a, names in ((1.0, RUNS), (FAR, (*RUNS, STEPS)))
            for name in names
        }
        quality(report, example, runs)
        findings(report, example, swept, times, runs, moving.mesh.GetNumberOfCells())
        pictures(report, example, moving, runs)
        qualities[f"{example.title} ({example.section}), amount 1"] = {
            label: distribution(runs[f"{name}, amount 1"]) for name, label in COMPARED.items()}
        labels = {"FEMWARP": "FEMWARP", "anisotropic": "anisotropic FEMWARP"}
        inverted.append((f"{example.title} ({example.section})", "amount of the motion", "inverted elements",
                         {label: (swept["amount"], swept[key]) for key, label in labels.items()}))
        iterations.append((f"{example.title} ({example.section})", "amount of the motion",
                           f"iterations of (4.24) until untangled (none: over {TRIALS[-1]})",
                           {f"after {label}": (swept["amount"], swept[f"iterations {key}"])
                            for key, label in labels.items()}))
        seconds.append((f"{example.title} ({example.section})", "amount of the motion",
                        "CPU s of deformation and second step",
                        {f"{step}, {label}": (swept["amount"], swept[f"{quantity} {key}"])
                         for quantity, step in (("s", "(4.24)"), ("own s", "ours"))
                         for key, label in labels.items()}))
    report.lines("inverted", inverted, columns=3)
    report.lines("iterations", iterations, columns=3)
    report.lines("seconds", seconds, columns=3)
    report.bars("quality", bin_names(), "TMP shape (4.22)", "elements", qualities)
    return report.finish()
