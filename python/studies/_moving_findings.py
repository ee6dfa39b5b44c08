# SPDX-License-Identifier: BSD-3-Clause
"""The findings of the study `deformation`: what chapter 4 states about the six moving domains."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Sequence

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

from ._common import QUALITY_MARGIN
from ._deformed import BINS, CHOSEN, ITERATIONS, LITERAL, SETTINGS, Deformed, Example, lowered, similarity
from ._meshes import points_of
from ._report import Report, percent
from ._verdicts import COUNT_TOLERANCE, GAIN_RULE, Open, Times, Verdict, all_of, any_of, faster, gain, less, same_count

FAR = 1.5  # times the dissertation's largest motion
STEPS = "hybrid-steps"  # at FAR times the motion
STARTS = ("FEMWARP", "anisotropic")
LARGEST = 1.0  # the dissertation's largest motion; verdicts take no larger one
MODERATE = 0.25  # times the largest motion: "small or moderate deformations" (section 4.7)
RANKS = 0.5  # least rank correlation of two quantities of which one is said to grow with the other
EQUAL = 1e-9  # relative, for values that are equal up to rounding
SCALE = 3.0  # of the mesh, for the invariance of the metric
_COUNT = f"within {COUNT_TOLERANCE:.0%} of the printed count"
FINER = 4  # times as many elements, to see how the counts depend on the mesh


@dataclass
class Left:
    """The results of (4.24) from the meshes of FEMWARP and of anisotropic FEMWARP, with a setting."""

    inverted: tuple[int, int]
    #: Until no element is inverted; NaN: some are left.
    iterations: tuple[float, float]

    def both(self) -> bool:
        return not any(math.isnan(n) for n in self.iterations)


@dataclass
class Sweep:
    """Motions of several amounts."""

    #: By the heading of the table its column.
    values: dict[str, np.ndarray]
    #: CPU seconds of (4.24) from either start; None: it failed.
    times: list[tuple[Times | None, Times | None]]
    #: Worst shapes (4.22) after FEMWARP and the hybrid algorithm; NaN: it failed.
    worst: list[tuple[float, float]]
    #: Worst shape of the hybrid algorithm at the largest motion when the last inverted element becomes valid.
    early: float = math.nan
    #: Inverted elements of both on a planar mesh of FINER times as many elements, at the largest motion.
    finer: tuple[int, ...] = ()

    def __getitem__(self, heading: str) -> np.ndarray:
        return self.values[heading]

    def tangled(self) -> np.ndarray:
        """The rows within the dissertation's motion in which FEMWARP inverts elements."""
        return np.flatnonzero((self["amount"] <= LARGEST) & (self["FEMWARP"] > 0))


def _listed(swept: Sweep, rows: Sequence[int], texts: Sequence[str]) -> str:
    return ", ".join(f"{text} at {swept['amount'][i]:g}" for i, text in zip(rows, texts)) or "no elements are inverted"


def first_step(report: Report, example: Example, swept: Sweep, runs: dict[str, Deformed], cells: int) -> None:
    """FEMWARP and anisotropic FEMWARP."""
    meshes, _, charts = (f"Figure {number}" for number in example.figures)
    title = example.title
    fem, anisotropic = (runs[f"{name}, amount 1"] for name in ("femwarp", "anisotropic"))
    unknown = [_unknown(swept, start, k) for k, start in enumerate(STARTS)]
    report.finding(example.section if title.startswith("Sphere") else meshes, f"{title}: FEMWARP inverts elements",
                   same_count(fem.inverted, example.femwarp), f"{fem.inverted} of {cells}", criterion=_COUNT,
                   stated=str(example.femwarp), reason=unknown[0])
    if example.anisotropic is not None:
        report.finding(meshes, f"{title}: anisotropic FEMWARP inverts {example.anisotropic or 'no'} elements",
                       same_count(anisotropic.inverted, example.anisotropic), f"{anisotropic.inverted} of {cells}",
                       criterion=_COUNT, stated=str(example.anisotropic),
                       reason=unknown[1])
    rows = swept.tangled()
    pairs = [(swept["anisotropic"][i], swept["FEMWARP"][i]) for i in rows]
    report.finding(charts, f"{title}: anisotropic FEMWARP inverts fewer elements than FEMWARP",
                   all_of(bool(n < f) for n, f in pairs),
                   _listed(swept, rows, [f"{n:.0f} instead of {f:.0f}" for n, f in pairs]),
                   criterion="fewer with each amount up to 1 at which FEMWARP inverts elements",
                   stated=f"{example.anisotropic} instead of {example.femwarp}" if example.anisotropic else "fewer")
    if example.fewer is not None:
        gains = [lowered(n, f) for n, f in pairs] if example.at_most else [lowered(anisotropic.inverted, fem.inverted)]
        up_to = "up to " if example.at_most else ""
        report.finding(charts, f"{title}: anisotropic FEMWARP reduces the number of inverted elements by "
                       f"{up_to}{percent(example.fewer)}", gain(max(gains, default=math.nan), example.fewer),
                       ", ".join(map(percent, gains)), criterion="the largest gain: " + GAIN_RULE,
                       stated=up_to + percent(example.fewer))
    ours = anisotropic.coefficients[: len(example.coefficients)]
    report.finding(example.section, f"{title}: the coefficients of anisotropic FEMWARP", _same_direction(
        ours, example.coefficients), ":".join(f"{c:.3g}" for c in ours), criterion="the ratio to the largest one by "
        f"(4.19), (4.21) with absolute displacements, within {COUNT_TOLERANCE:.0%}; 0 where it is 0 there",
        stated=":".join(f"{c:g}" for c in example.coefficients))


def _unknown(swept: Sweep, start: str, which: int) -> str:
    """Why a count differs: its dependence on the motion and on the number of elements."""
    counts = ", ".join(f"{count:.0f} at {a:g}" for a, count in zip(swept["amount"], swept[start]))
    finer = f", and {swept.finer[which]} at 1 with {FINER} times as many elements" if swept.finer else ""
    return ("the count depends on the number of elements near the moving part, which is not given, and on the length "
            f"of the motion, which is read from the figure: {counts}{finer}")


def _same_direction(ours: Sequence[float], theirs: Sequence[float]) -> Verdict:
    """Whether coefficients have the same ratios to the largest of them."""
    top = int(np.argmax(theirs))
    if not ours[top] > 0:
        return False
    pairs = [(o / ours[top], t / theirs[top]) for o, t in zip(ours, theirs)]
    return all_of(bool(abs(o - t) <= (COUNT_TOLERANCE * t if t else EQUAL)) for o, t in pairs)


def second_step(report: Report, example: Example, swept: Sweep, left: dict[str, Left]) -> None:
    """The untangling from either start."""
    title, meshes, charts = example.title, f"Figure {example.figures[0]}", f"Figure {example.figures[2]}"
    figures = "left from FEMWARP and anisotropic FEMWARP: " + "; ".join(
        f"{run.inverted[0]} and {run.inverted[1]} with {setting}" for setting, run in left.items())
    rule = (f"no inverted element within {ITERATIONS} iterations with one of the {len(SETTINGS)} settings of beta and "
            "the unit of length, which were chosen on the meshes of seed 1")
    local = (f"(4.24) has no barrier; after {ITERATIONS} iterations some elements are inverted with each beta and unit "
             "of length that was tried")
    report.finding(meshes, f"{title}: the hybrid algorithm leaves no inverted elements",
                   any_of(run.inverted[1] == 0 for run in left.values()), figures, criterion=rule, stated="0",
                   reason=local)
    report.finding("4.10", f"{title}: (4.24) also eliminates the inverted elements of FEMWARP's mesh",
                   any_of(run.inverted[0] == 0 for run in left.values()), figures, criterion=rule, stated="0",
                   reason=local)
    useful = {setting: run.iterations for setting, run in left.items() if run.both()}
    report.finding(example.section, f"{title}: each setting with which (4.24) untangles both meshes needs fewer "
                   "iterations after anisotropic FEMWARP", all_of(bool(n < f) for f, n in useful.values()),
                   "; ".join(f"{n:.0f} instead of {f:.0f} with {setting}" for setting, (f, n) in useful.items())
                   or "no setting untangles both", own=True, criterion="fewer at amount 1")
    rows = swept.tangled()
    counts = [tuple(swept[f"iterations {start}"][i] for start in STARTS) for i in rows]
    report.finding(example.section, f"{title}: after anisotropic FEMWARP, (4.24) needs fewer iterations to untangle it",
                   all_of(_fewer(n, f) for f, n in counts),
                   _listed(swept, rows, [f"{_text(n)} instead of {_text(f)}" for f, n in counts]),
                   criterion=f"fewer with each amount up to 1 at which FEMWARP inverts elements ({CHOSEN})",
                   stated="fewer")
    if example.faster is None:
        return
    pairs = [swept.times[i] for i in rows]
    texts = [f"{n or 'failed'} instead of {f or 'failed'}" for f, n in pairs]
    report.finding(charts, f"{title}: after anisotropic FEMWARP, (4.24) takes less time to untangle it",
                   all_of(_less_time(n, f) for f, n in pairs), _listed(swept, rows, texts),
                   criterion="less with each amount up to 1 at which FEMWARP inverts elements, beyond the noise",
                   stated="less")
    both = [lowered(n.best, f.best) for f, n in pairs if f is not None and n is not None and n.best > 0]
    report.finding(charts, f"{title}: it takes up to {percent(example.faster)} less time",
                   gain(max(both, default=math.nan), example.faster), ", ".join(map(percent, both)),
                   criterion="the largest gain over the amounts at which both are tangled: " + GAIN_RULE,
                   stated=percent(example.faster))


def _text(iterations: float) -> str:
    return "failed" if math.isnan(iterations) else f"{iterations:.0f}"


def _fewer(one: float, other: float) -> Verdict:
    if math.isnan(one) or math.isnan(other):
        return Open(f"(4.24) leaves inverted elements after {ITERATIONS} iterations")
    return bool(one < other)


def _less_time(one: Times | None, other: Times | None) -> Verdict:
    if one is None or other is None:
        return Open(f"(4.24) leaves inverted elements after {ITERATIONS} iterations: there is no time")
    return faster(one, other)


def shapes(report: Report, example: Example, swept: Sweep, runs: dict[str, Deformed]) -> None:
    """The worst elements, and our second step."""
    title, source = example.title, f"Figure {example.figures[1]}"
    fem, hybrid, ubn = (runs[f"{name}, amount 1"] for name in ("femwarp", LITERAL, "ubn"))
    failed = "" if hybrid.inverted == 0 else f"(4.24) failed: it leaves {hybrid.inverted} inverted elements"
    early = (f"the gain depends on when the optimization stops, which is not stated: it is "
             f"{percent(lowered(swept.early, fem.worst))} when the last inverted element becomes valid, and "
             f"{percent(lowered(hybrid.worst, fem.worst))} after {ITERATIONS} iterations")
    _better(report, source, f"{title}: the hybrid algorithm's worst element", "FEMWARP", hybrid, fem,
            example.than_femwarp, failed, early)
    against = f"{ubn.inverted} inverted elements"
    if example.than_ubn is None:
        report.finding(source, f"{title}: UBN finds no mesh without inverted elements", ubn.inverted > 0, against,
                       criterion="iterative stiffening leaves inverted elements", stated="a singular matrix",
                       reason="there UBN ended at a singular matrix, whose cause is not stated; ours solves every "
                       "system and ends with a valid mesh")
    else:
        if example.domain == "cylinder":
            report.finding(source, f"{title}: UBN leaves no inverted elements", ubn.inverted == 0, against,
                           criterion="iterative stiffening leaves none", stated="0")
        lost = failed or (f"UBN failed: it leaves {ubn.inverted} inverted elements" if ubn.inverted else "")
        _better(report, source, f"{title}: the hybrid algorithm's worst element", "UBN", hybrid, ubn, example.than_ubn,
                lost)
    if example.domain == "bending-bar":
        rows = swept.tangled()
        pairs = [swept.worst[i] for i in rows]
        report.finding(example.section, f"{title}: the results are the same with other amounts of bending",
                       all_of(Open("(4.24) failed") if math.isnan(h) else less(h, f, QUALITY_MARGIN) for f, h in pairs),
                       _listed(swept, rows, [f"{h:.4g} against {f:.4g}" for f, h in pairs]),
                       criterion="the hybrid algorithm's worst element is better than FEMWARP's with each amount up to "
                       "1 at which FEMWARP inverts elements", stated="consistent")
    ours, far, once = (runs[f"{name}, amount {a:g}"] for name, a in (("hybrid", 1.0), (STEPS, FAR), ("hybrid", FAR)))
    reached = f", up to {far.reached:.4g} of it" if far.reached < 1 else ""
    report.finding(example.section, f"{title}: our second step leaves no inverted elements, nor at {FAR:g} times the "
                   "motion in as many steps as needed", ours.inverted == far.inverted == 0,
                   f"{ours.inverted} at amount 1; at {FAR:g} {once.inverted} in one step, {far.inverted} in as many as "
                   f"needed{reached}", own=True, criterion="none at either amount")


def _better(report: Report, source: str, subject: str, name: str, one: Deformed, other: Deformed, printed: float,
            failed: str, reason: str = "") -> None:
    """Two findings: whether the worst element is better, and by how much."""
    ours = f"{percent(lowered(one.worst, other.worst))}: {one.worst:.4g} against {other.worst:.4g}"
    report.finding(source, f"{subject} is better than {name}'s",
                   Open(failed) if failed else less(one.worst, other.worst, QUALITY_MARGIN), ours,
                   criterion=f"the largest TMP shape of all elements is smaller by more than {QUALITY_MARGIN:.0%}",
                   stated="better")
    report.finding(source, f"{subject} is better than {name}'s by {percent(printed)}",
                   Open(failed) if failed else gain(lowered(one.worst, other.worst), printed), ours,
                   criterion=GAIN_RULE, stated=percent(printed), reason=reason)


def common(report: Report, sweeps: dict[str, Sweep], lefts: dict[str, dict[str, Left]]) -> None:
    """The statements on all examples together."""
    small = {title: [(s["FEMWARP"][i], s.worst[i][0]) for i in np.flatnonzero(s["amount"] <= MODERATE)]
             for title, s in sweeps.items()}
    report.finding("4.7", "FEMWARP creates good elements for small or moderate deformations",
                   all_of(bool(count == 0 and worst <= BINS[-1]) for found in small.values() for count, worst in found),
                   "; ".join(f"{title} {', '.join(f'{c:.0f} inverted, worst {w:.3g}' for c, w in found)}"
                             for title, found in small.items()),
                   criterion=f"no inverted element, and no TMP shape above {BINS[-1]:g}, at {MODERATE:g} times the "
                   "largest motion")
    first = str(SETTINGS[0])
    other = [f"{title}, {start}" for title, left in lefts.items() for k, start in enumerate(STARTS)
             if len({run.inverted[k] == 0 for run in left.values()}) > 1]
    report.finding("4.9.2", "Beta and the unit of length, which the dissertation does not give, decide whether (4.24) "
                   "untangles a mesh", bool(other), "of some settings only: " + ("; ".join(other) or "none") +
                   f"; untangled with {first}: " + ", ".join(
                       f"{title} {sum(n == 0 for n in left[first].inverted)} of 2" for title, left in lefts.items()),
                   own=True, criterion="a mesh at amount 1 that one setting untangles and another one does not")
    ranks = {}
    for title, s in sweeps.items():
        inverted = np.concatenate([s[start] for start in STARTS])
        iterations = np.concatenate([s[f"iterations {start}"] for start in STARTS])
        use = (inverted > 0) & ~np.isnan(iterations)
        if np.count_nonzero(use) > 2 and min(np.ptp(inverted[use]), np.ptp(iterations[use])) > 0:
            rank = float(np.corrcoef(_ranks(inverted[use]), _ranks(iterations[use]))[0, 1])
            ranks[title] = rank, np.count_nonzero(use)
    report.finding("4.11", "Fewer inverted elements before the optimization reduce the time to the solution",
                   all_of(rank >= RANKS for rank, _ in ranks.values()),
                   "rank correlations: " + ", ".join(f"{title} {rank:.2f} of {n} meshes"
                                                     for title, (rank, n) in ranks.items()),
                   criterion=f"per example a rank correlation of at least {RANKS:g} between the inverted elements and "
                   "the iterations of (4.24) until there are none, of all tangled meshes that it untangles")


def _ranks(values: np.ndarray) -> np.ndarray:
    """The rank of each value; equal values share the mean of theirs."""
    _, group, counts = np.unique(values, return_inverse=True, return_counts=True)
    last = np.cumsum(counts)
    return (last - 0.5 * (counts - 1))[group]


def invariance(initial: vtkDataSet, deformed: Deformed) -> dict[str, float]:
    """Relative changes of the metric (4.22) in a rotated and in a scaled mesh, and its value for a similar mesh."""
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    points = points_of(deformed.mesh)

    def change(moved: np.ndarray) -> float:
        values = similarity(initial, moved)
        return float(np.max(np.abs(values - deformed.shapes)) / np.max(deformed.shapes))

    same = similarity(initial, SCALE * points_of(initial) @ turn)
    return {"rotated": change(points @ turn), "scaled": change(SCALE * points), "similar": float(np.max(np.abs(same)))}


def metric(report: Report, changes: dict[str, float]) -> None:
    """The statements of section 4.9.2 on the metric (4.22)."""
    proof = "the formula has no size: |QT - adj(QT)^t| = |T - adj(T)^t| for a rotation Q"
    report.finding("4.9.2", "The TMP shape metric (4.22) is invariant to rotations", changes["rotated"] <= EQUAL,
                   f"changes by {changes['rotated']:.2g} of the largest value", criterion=f"at most {EQUAL:g}",
                   proof=proof)
    report.finding("4.9.2", "The TMP shape metric (4.22) is invariant to the scale", changes["scaled"] <= EQUAL,
                   f"changes by {changes['scaled']:.3g} of the largest value in a mesh {SCALE:g} times as large",
                   criterion=f"at most {EQUAL:g}", proof="the formula has no size",
                   reason="(4.22) is homogeneous: a factor s on T multiplies it by s^2 in the plane, by s^4 in space; "
                   "only where it is 0 it is invariant to the scale")
    report.finding("4.9.2", "The TMP shape metric (4.22) is 0 where the element has its initial shape",
                   changes["similar"] <= EQUAL, f"at most {changes['similar']:.2g} for a rotated mesh {SCALE:g} times "
                   "as large", criterion=f"at most {EQUAL:g}", proof="the formula has no size")
