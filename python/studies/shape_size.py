# SPDX-License-Identifier: BSD-3-Clause
"""Shape and size simultaneously: section 3.4.1, Table 3.2, Figures 3.4 and 3.5."""

from __future__ import annotations

from ._common import (
    MULTI, QUALITY_MARGIN, about, best_of, compare, judged, reduces, time_judged, worst_of,
)
from ._pairs import Goals, Outcome, common_findings, everywhere, experiment, of_user, options
from ._report import Report, percent
from ._verdicts import GAIN_BAND, GAIN_RULE, Verdict, all_of, gain, less, quickest, slowest

# Table 3.2, seconds after 1, 5, 10 and 20 iterations.
TIMES = {
    "imr": (24.6, 75.9, 149.0, 290.3),
    "size": (21.0, 59.3, 105.6, 196.5),
    "exponential-sum": (56.4, 202.2, 390.1, 450.0),
    "objective-product": (28.9, 100.3, 197.8, 392.2),
    "equal-sum": (33.1, 117.5, 233.2, 439.5),
}
WORST_GAIN = 0.966  # of the exponential sum over the size alone, by the worst IMR
TWICE = 2.0  # the time of the objective product over the time of the size alone, as in the text
EARLY = 3  # "the first few iterations"
DETERIORATION = 2.0  # a worst element deteriorates significantly if its metric becomes this multiple of its best value
#: How averages and worst elements are compared.
END = f"after the last sweep, by more than {QUALITY_MARGIN:.0%}"
BAND = f"between {GAIN_BAND[0]:g} and {GAIN_BAND[1]:g} times the printed number"
GOALS = Goals(
    name="shape_size",
    title="Shape and size (section 3.4.1)",
    metrics=("imr", "size"),
    labels=("IMR", "size"),
    means=("imr_mean", "size_rms"),
    worsts=("imr_worst", "size_worst"),
    unit=("size_rms", 0.98, 3),  # the upper end of the axis of Figure 3.4 (b)
    axes=("Average element quality, shape (IMR)", "Average element quality, size (rms)"),
    times=TIMES,
)


def main(arguments: list[str]) -> int:
    given = options(GOALS, __doc__, arguments)
    report = Report(GOALS.name, GOALS.title, given)
    if given.mesh:
        return of_user(given, report)
    findings(report, experiment(GOALS, given, report))
    return report.finish()


def findings(report: Report, found: Outcome) -> None:
    quality_findings(report, found)
    time_findings(report, found)
    common_findings(report, GOALS, found)


def quality_findings(report: Report, found: Outcome) -> None:
    """The findings on Figures 3.4 and 3.5."""
    runs = found.nlcg
    imr, size = runs["imr"], runs["size"]

    def finding(source: str, sentence: str, holds: Verdict, ours: str, criterion: str, stated: str = "") -> None:
        report.finding(source, sentence, holds, ours, criterion=criterion, stated=stated)

    holds, where = everywhere(found.others, lambda r: worst_of(r, "size", "imr_mean"))
    finding("Figure 3.4 (a)", "Size alone is the worst method when the average is measured by shape (IMR)", holds,
            f"{where}; {compare(runs, 'imr_mean')}", f"its average IMR is the largest on each domain {END}")
    holds, where = everywhere(found.others, lambda r: worst_of(r, "imr", "size_rms"))
    finding("Figure 3.4 (b)", "Shape alone is the worst method when the average is measured by size", holds,
            f"{where}; {compare(runs, 'size_rms')}", f"its rms of the size is the largest on each domain {END}")
    holds, where = everywhere(found.others, lambda r: all_of(reduces(r[n], q) for n in MULTI for q in GOALS.means))
    finding("Figure 3.4", "The multiobjective methods improve the averages of both metrics", holds, where,
            f"average IMR and rms of the size of all three are below the start on each domain {END}")
    best = float(min(size.values["imr_worst"]))
    finding("Figure 3.5 (a)", "With size alone the worst element by IMR deteriorates significantly as iterations go on",
            judged(runs, ["size"], size.last("imr_worst") > DETERIORATION * best),
            f"worst IMR: start {size.first('imr_worst'):.4g}, best {best:.4g}, end {size.last('imr_worst'):.4g}",
            f"the worst IMR at the end is more than {DETERIORATION:g} times its smallest value")
    finding("Figure 3.5 (b)", "Shape alone improves the worst size for the first few iterations",
            judged(runs, ["imr"], less(imr.at("size_worst", EARLY), imr.first("size_worst"), QUALITY_MARGIN)),
            f"largest size: start {imr.first('size_worst'):.4g}, iteration {EARLY} {imr.at('size_worst', EARLY):.4g}, "
            f"end {imr.last('size_worst'):.4g}",
            f"the largest size after iteration {EARLY} is below the start by more than {QUALITY_MARGIN:.0%}")
    improved = 1 - runs["exponential-sum"].last("imr_worst") / size.last("imr_worst")
    finding("3.4.1", "The exponential sum has a far better worst element by IMR than size alone",
            judged(runs, ("exponential-sum", "size"), gain(improved, WORST_GAIN)), percent(improved),
            GAIN_RULE, percent(WORST_GAIN))
    finding("3.6", "The exponential sum has the best worst shape of the multiobjective methods",
            best_of(runs, "exponential-sum", MULTI, "imr_worst"),
            compare({n: runs[n] for n in MULTI}, "imr_worst"), f"its worst IMR is the smallest {END}")


def time_findings(report: Report, found: Outcome) -> None:
    """The findings on Table 3.2."""
    runs = found.nlcg
    times = {name: r.times() for name, r in runs.items()}
    ours = ", ".join(f"{n} {t}" for n, t in times.items())
    printed = ", ".join(f"{n} {row[-1]:g} s" for n, row in TIMES.items())
    for sentence, holds, criterion in (
        ("Size alone is the fastest", quickest(times, "size"), "least CPU time of all sweeps"),
        ("The exponential sum is the slowest", slowest(times, "exponential-sum"), "most CPU time of all sweeps"),
    ):
        report.finding("Table 3.2", sentence, time_judged(runs, runs, holds), ours, criterion=criterion, stated=printed)
    product, alone = times["objective-product"], times["size"]
    report.finding("Table 3.2", "The objective product takes about two times as long as size alone",
                   time_judged(runs, ("objective-product", "size"), about(product, alone, TWICE)),
                   f"{product.best / alone.best:.2f} times", criterion=f"the ratio of CPU times is {BAND}",
                   stated=f"{TIMES['objective-product'][-1] / TIMES['size'][-1]:.2f} times")
