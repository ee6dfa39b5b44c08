# SPDX-License-Identifier: BSD-3-Clause
"""Shape and interpolation error simultaneously: section 3.4.2, Table 3.3, Figures 3.6 and 3.7."""

from __future__ import annotations

from ._common import MULTI, about, compare, judged, reduces, time_judged, worst_of
from ._pairs import Goals, Outcome, common_findings, everywhere, experiment, of_user, options
from ._report import Report, percent
from ._verdicts import GAIN_RULE, Verdict, all_of, faster, gain, is_not, less, quickest
from .shape_size import BAND, END

# Table 3.3, seconds after 1, 5, 10 and 20 iterations.
TIMES = {
    "imr": (27.1, 77.3, 143.5, 309.6),
    "ss": (66.1, 306.2, 583.1, 1226.5),
    "exponential-sum": (89.2, 400.5, 848.3, 1423.2),
    "objective-product": (88.9, 382.4, 734.6, 1425.0),
    "equal-sum": (70.7, 301.1, 599.2, 1217.6),
}
WORST_GAIN = 0.954  # of the exponential sum over SS alone, by the worst IMR
FOUR_TIMES = 4.0  # the time of the equal sum over the time of IMR alone, as in the text
TURN = 10  # the iteration after which the worst element by SS deteriorates with IMR alone
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
    report = Report(GOALS.name, GOALS.title, given)
    if given.mesh:
        return of_user(given, report)
    report.text("Larger SS are better; the tables have 1 / SS, to which the bound of the error is proportional.")
    findings(report, experiment(GOALS, given, report))
    return report.finish()


def findings(report: Report, found: Outcome) -> None:
    quality_findings(report, found)
    time_findings(report, found)
    common_findings(report, GOALS, found)


def quality_findings(report: Report, found: Outcome) -> None:
    """The findings on Figures 3.6 and 3.7."""
    runs = found.nlcg
    imr, ss = runs["imr"], runs["ss"]

    def finding(source: str, sentence: str, holds: Verdict, ours: str, criterion: str, stated: str = "") -> None:
        report.finding(source, sentence, holds, ours, criterion=criterion, stated=stated)

    holds, where = everywhere(found.others, lambda r: all_of(reduces(r[n], q) for n in MULTI for q in GOALS.means))
    finding("Figure 3.6", "The multiobjective methods improve the averages of both metrics", holds, where,
            f"average IMR and 1 / SS of all three are below the start on each domain {END}")
    holds, where = everywhere(found.others, lambda r: is_not(reduces(r["ss"], "imr_mean")))
    finding("Figure 3.6 (a)", "SS alone fails to improve the average IMR", holds,
            f"{where}; {compare(runs, 'imr_mean')}",
            f"the average IMR is not below the start on any domain {END}; a smaller change decides nothing")
    holds, where = everywhere(found.others, lambda r: worst_of(r, "ss", "imr_mean"))
    finding("Figure 3.6 (a)", "SS alone is the worst method when the average is measured by IMR", holds, where,
            f"its average IMR is the largest on each domain {END}")
    for quantity, what, source in (("ss_mean", "average", "Figure 3.6 (b)"), ("ss_worst", "worst element", "3.4.2")):
        holds, where = everywhere(found.others, lambda r, q=quantity: reduces(r["imr"], q))
        finding(source, f"IMR alone also improves the {what} by SS", holds, f"{where}; {compare(runs, quantity)}",
                f"{what} by 1 / SS below the start on each domain {END}")
    improved = 1 - runs["exponential-sum"].last("imr_worst") / ss.last("imr_worst")
    finding("3.4.2", "The exponential sum has a far better worst element by IMR than SS alone",
            judged(runs, ("exponential-sum", "ss"), gain(improved, WORST_GAIN)),
            f"{percent(improved)}; {compare(runs, 'imr_worst')}", GAIN_RULE, percent(WORST_GAIN))
    finding("Figure 3.7 (b)", "With IMR alone the worst element by SS gets slightly worse after 10 iterations",
            judged(runs, ["imr"], less(imr.at("ss_worst", TURN), imr.last("ss_worst"), 0.0)),
            f"largest 1 / SS: start {imr.first('ss_worst'):.6g}, iteration {TURN} {imr.at('ss_worst', TURN):.6g}, "
            f"end {imr.last('ss_worst'):.6g}",
            f"the largest 1 / SS at the end is above that after iteration {TURN}, by any amount")


def time_findings(report: Report, found: Outcome) -> None:
    """The findings on Table 3.3."""
    runs = found.nlcg
    times = {name: r.times() for name, r in runs.items()}
    ours = ", ".join(f"{n} {t}" for n, t in times.items())
    printed = ", ".join(f"{n} {row[-1]:g} s" for n, row in TIMES.items())
    for sentence, holds, criterion in (
        ("IMR alone is the fastest", quickest(times, "imr"), "least CPU time of all sweeps"),
        ("SS alone takes longer than IMR alone", faster(times["imr"], times["ss"]), "more CPU time for all sweeps"),
    ):
        report.finding("Table 3.3", sentence, time_judged(runs, runs, holds), ours, criterion=criterion, stated=printed)
    total, alone = times["equal-sum"], times["imr"]
    report.finding("Table 3.3", "The equal sum takes about four times as long as IMR alone",
                   time_judged(runs, ("equal-sum", "imr"), about(total, alone, FOUR_TIMES)),
                   f"{total.best / alone.best:.2f} times", criterion=f"the ratio of CPU times is {BAND}",
                   stated=f"{TIMES['equal-sum'][-1] / TIMES['imr'][-1]:.2f} times")
