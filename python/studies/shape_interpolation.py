# SPDX-License-Identifier: BSD-3-Clause
"""Shape and interpolation error simultaneously: section 3.4.2, Table 3.3, Figures 3.6 and 3.7."""

from __future__ import annotations

from ._common import MULTI, compare
from ._report import Report, percent
from ._pairs import Outcome, Goals, everywhere, experiment, options
from ._verdicts import Verdict, all_of, below, quickest

# Table 3.3, seconds after 1, 5, 10 and 20 iterations.
TIMES = {
    "imr": (27.1, 77.3, 143.5, 309.6),
    "ss": (66.1, 306.2, 583.1, 1226.5),
    "exponential-sum": (89.2, 400.5, 848.3, 1423.2),
    "objective-product": (88.9, 382.4, 734.6, 1425.0),
    "equal-sum": (70.7, 301.1, 599.2, 1217.6),
}
WORST_GAIN = 0.954  # of the exponential sum over SS alone, by the worst IMR
GOALS = Goals(
    name="shape_interpolation",
    title="Shape and interpolation error (section 3.4.2)",
    metrics=("imr", "ss"),
    labels=("IMR", "SS"),
    means=("imr_mean", "ss_mean"),
    worsts=("imr_worst", "ss_worst"),
    unit=("ss_mean", 1.9, 1),  # the start of Figure 3.6 (b); 1 / SS is a length
    axes=("Average element quality, shape (IMR)", "Average element quality, interpolation error (1 / SS)"),
    times=TIMES,
)


def main(arguments: list[str]) -> int:
    given = options(GOALS, __doc__, arguments)
    report = Report(GOALS.name, GOALS.title, given.out, given.small)
    report.text("Larger SS are better; the tables have 1 / SS, to which the bound of the error is proportional.")
    findings(report, experiment(GOALS, given, report))
    return report.finish()


def findings(report: Report, found: Outcome) -> None:
    runs = found.nlcg
    imr, ss = runs["imr"], runs["ss"]

    def finding(sentence: str, holds: Verdict, figures: str, source: str) -> None:
        report.finding(source, sentence, holds, figures)

    holds, where = everywhere(
        found.others, lambda r: all(r[n].last(q) < r[n].first(q) for n in MULTI for q in GOALS.means),
    )
    finding("The multiobjective methods improve the averages of both metrics", holds, where, "Figure 3.6")
    holds, where = everywhere(found.others, lambda r: r["ss"].last("imr_mean") >= r["ss"].first("imr_mean"))
    finding("SS alone fails to improve the average IMR", holds, f"{where}; {compare(runs, 'imr_mean')}",
            "Figure 3.6 (a)")
    holds, where = everywhere(
        found.others, lambda r: r["ss"].last("imr_mean") >= max(x.last("imr_mean") for x in r.values()),
    )
    finding("SS alone is the worst method when the average is measured by IMR", holds, where, "Figure 3.6 (a)")
    holds, where = everywhere(found.others, lambda r: r["imr"].last("ss_mean") < r["imr"].first("ss_mean"))
    finding("IMR alone improves the average of SS too", holds, f"{where}; {compare(runs, 'ss_mean')}", "Figure 3.6 (b)")
    gain = 1 - runs["exponential-sum"].last("imr_worst") / ss.last("imr_worst")
    finding("The exponential sum has a far better worst element by IMR (95.4 %) than SS alone", gain > 0.9,
        f"{percent(gain)}, the dissertation's {percent(WORST_GAIN)}; {compare(runs, 'imr_worst')}", "3.4.2")
    half = len(imr.iterations) // 2
    finding("With IMR alone the worst element by SS gets slightly worse after 10 iterations",
        imr.last("ss_worst") > imr.at("ss_worst", half),
        f"ss_worst: start {imr.first('ss_worst'):.6g}, iteration {half} {imr.at('ss_worst', half):.6g}, "
        f"end {imr.last('ss_worst'):.6g}", "Figure 3.7 (b)")
    times = {name: r.times() for name, r in runs.items()}
    finding("IMR alone is the fastest", quickest(times, "imr"), ", ".join(f"{n} {t}" for n, t in times.items()),
            "Table 3.3")
    total, alone = times["equal-sum"], times["imr"]
    finding("The equal sum takes about four times as long as IMR alone (within 3 to 5)",
        all_of((below(alone, total, 1 / 3), below(total, alone, 5))),
        f"{total.best / alone.best:.2f} times, the dissertation's {TIMES['equal-sum'][-1] / TIMES['imr'][-1]:.2f}",
        "Table 3.3")
