# SPDX-License-Identifier: BSD-3-Clause
"""Shape and size simultaneously: section 3.4.1, Table 3.2, Figures 3.4 and 3.5."""

from __future__ import annotations

from ._common import MULTI, compare
from ._report import Report, percent
from ._pairs import Outcome, Goals, everywhere, experiment, options
from ._verdicts import Verdict, all_of, below, quickest, slowest

# Table 3.2, seconds after 1, 5, 10 and 20 iterations.
TIMES = {
    "imr": (24.6, 75.9, 149.0, 290.3),
    "size": (21.0, 59.3, 105.6, 196.5),
    "exponential-sum": (56.4, 202.2, 390.1, 450.0),
    "objective-product": (28.9, 100.3, 197.8, 392.2),
    "equal-sum": (33.1, 117.5, 233.2, 439.5),
}
WORST_GAIN = 0.966  # of the exponential sum over the size alone, by the worst IMR
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
    report = Report(GOALS.name, GOALS.title, given.out, given.small)
    findings(report, experiment(GOALS, given, report))
    return report.finish()


def findings(report: Report, found: Outcome) -> None:
    runs = found.nlcg
    imr, size = runs["imr"], runs["size"]

    def finding(sentence: str, holds: Verdict, figures: str, source: str = "3.4.1") -> None:
        report.finding(source, sentence, holds, figures)

    holds, where = everywhere(
        found.others, lambda r: r["size"].last("imr_mean") >= max(x.last("imr_mean") for x in r.values()),
    )
    finding("Size alone is the worst method when the average is measured by shape (IMR)", holds,
        f"{where}; {compare(runs, 'imr_mean')}", "Figure 3.4 (a)")
    holds, where = everywhere(
        found.others, lambda r: r["imr"].last("size_rms") >= max(x.last("size_rms") for x in r.values()),
    )
    finding("Shape alone is the worst method when the average is measured by size", holds,
        f"{where}; {compare(runs, 'size_rms')}", "Figure 3.4 (b)")
    holds, where = everywhere(
        found.others,
        lambda r: all(r[n].last(q) < r[n].first(q) for n in MULTI for q in GOALS.means),
    )
    finding("The multiobjective methods improve the averages of both metrics", holds, where, "Figure 3.4")
    middle = min(range(len(size.iterations)), key=lambda i: size.values["imr_worst"][i])
    finding("With size alone the worst element by IMR deteriorates significantly as iterations go on",
        size.last("imr_worst") > 2 * size.values["imr_worst"][middle],
        f"imr_worst: start {size.first('imr_worst'):.4g}, best {size.values['imr_worst'][middle]:.4g} (iteration "
        f"{middle}), "
        f"end {size.last('imr_worst'):.4g}", "Figure 3.5 (a)")
    early = 3
    finding("Shape alone improves the worst size for the first few iterations",
        imr.at("size_worst", early) < imr.first("size_worst"),
        f"size_worst: start {imr.first('size_worst'):.4g}, iteration {early} {imr.at('size_worst', early):.4g}, "
        f"end {imr.last('size_worst'):.4g}", "Figure 3.5 (b)")
    gain = 1 - runs["exponential-sum"].last("imr_worst") / size.last("imr_worst")
    finding("The exponential sum has a far better worst element by IMR (96.6 %) than size alone", gain > 0.9,
        f"{percent(gain)}, the dissertation's {percent(WORST_GAIN)}")
    times = {name: r.times() for name, r in runs.items()}
    timing = ", ".join(f"{n} {t}" for n, t in times.items())
    finding("Size alone is the fastest", quickest(times, "size"), timing, "Table 3.2")
    product, alone = times["objective-product"], times["size"]
    finding("The objective product takes about two times as long as size alone (1.5 to 2.5)",
        all_of((below(alone, product, 1 / 1.5), below(product, alone, 2.5))),
        f"{product.best / alone.best:.2f} times, the dissertation's "
        f"{TIMES['objective-product'][-1] / TIMES['size'][-1]:.2f}", "Table 3.2")
    finding("The exponential sum is the slowest", slowest(times, "exponential-sum"), timing, "Table 3.2")
    others = min(runs[name].last("imr_worst") for name in MULTI[1:])
    finding("Of the multiobjective methods the exponential sum has the best worst shape (by 1 % at least)",
        runs["exponential-sum"].last("imr_worst") <= 0.99 * others,
        compare({n: runs[n] for n in MULTI}, "imr_worst"), "3.6, conclusions")
