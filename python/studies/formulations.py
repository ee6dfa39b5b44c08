# SPDX-License-Identifier: BSD-3-Clause
"""Choices of the formulation: reciprocal and additive inverse (3.2.2), versions of conjugate gradients (3.3.2, 3.4)."""

from __future__ import annotations

from ._common import QUALITY_MARGIN, TYPICAL_C, Method, Run, improve, measure, methods
from ._pairs import start_mesh
from ._report import MESQUITE_PATCH_ITERATIONS, Report, parser
from ._verdicts import Open, Times, Verdict, all_of, faster, less
from .shape_interpolation import GOALS as SS_GOALS
from .shape_size import GOALS

DOMAINS = ("disk3d", "disk2d", "barrier2d", "barrier3d")
CELLS, SMALL_CELLS = 50_000, 1_000
SWEEPS = 20
REPEATS = 3
#: Conjugate gradients run until they have this part of the reduction that the best known mesh has.
REDUCTION = 0.9999
#: The best known mesh: by this optimizer, with this limit and relative change.
BEST, BEST_LIMIT, BEST_CHANGE = "l-bfgs", 2_000, 1e-9
LIMIT = 2_000
VERSIONS = ("polak-ribiere", "fletcher-reeves")
TEMPLATES = {"reciprocal": "sum of squared reciprocals", "additive inverse": "sum"}
QUANTITIES = ("ss_mean", "ss_worst", "imr_mean", "imr_worst")


def inverses(domain: str, cells: int, threads: int) -> dict[str, dict[str, float]]:
    """Qualities of the start, and after optimizing SS by its reciprocal and by its additive inverse."""
    mesh = start_mesh(SS_GOALS, domain, cells)
    found = {"start": measure(mesh, QUANTITIES)}
    for name, template in TEMPLATES.items():
        run = improve(mesh, Method("ss", "SS", ("ss",)), SWEEPS, QUANTITIES, template=template, trace=False,
                      patch_iterations=MESQUITE_PATCH_ITERATIONS, threads=threads)
        found[name] = {q: run.last(q) for q in (*QUANTITIES, "inverted")}
    return found


def versions(domain: str, cells: int, repeats: int, threads: int) -> dict[str, dict[str, Run]]:
    """By objective the runs of each version of conjugate gradients to the same objective."""
    mesh = start_mesh(GOALS, domain, cells)
    found = {}
    for method in methods("imr", "size", names=("IMR", "size")):
        if method.name == "size":
            continue  # it inverts elements
        best = improve(mesh, method, BEST_LIMIT, ("imr_mean",), optimizer=BEST, relative_change=BEST_CHANGE,
                       c=TYPICAL_C, trace=False, threads=threads)
        found[method.name] = {
            version: improve(mesh, method, LIMIT, ("imr_mean",), optimizer=version, reduction=REDUCTION, c=TYPICAL_C,
                             best_known=float(best.values["objective"][-1]), trace=False, repeats=repeats,
                             threads=threads) for version in VERSIONS}
    return found


def main(arguments: list[str]) -> int:
    given = parser("formulations", __doc__, CELLS, repeats=REPEATS).parse_args(arguments)
    report = Report("formulations", "Choices of the formulation (sections 3.2.2, 3.3.2, 3.4)", given)
    cells = given.cells or (SMALL_CELLS if given.small else CELLS)
    report.text(
        f"Meshes of about {cells:,} elements, perturbed as in the studies shape_size and shape_interpolation. SS by "
        "its "
        f"reciprocal (3.5) and by its additive inverse: {SWEEPS} sweeps of local conjugate gradients. Versions of "
        f"conjugate gradients: all vertices at once, until {REDUCTION:.2%} of the reduction of the best known mesh "
        f"({BEST.upper()}, relative change {BEST_CHANGE:g}) is reached; the local sweeps have Polak-Ribiere only."
    )
    quality = {domain: inverses(domain, cells, given.threads) for domain in DOMAINS}
    report.table("inverses", "SS by its reciprocal and by its additive inverse: 1 / SS and IMR of the valid elements",
                 ["domain", "objective", *QUANTITIES, "inverted"],
                 [[domain, name, *(row[q] for q in (*QUANTITIES, "inverted"))]
                  for domain, found in quality.items() for name, row in found.items()])
    runs = {domain: versions(domain, cells, given.repeats, given.threads) for domain in DOMAINS[:2]}
    report.table("versions", "CPU seconds and iterations of versions of conjugate gradients to the same objective",
                 ["domain", "objective", *(f"{v} {what}" for v in VERSIONS for what in ("s", "iterations"))],
                 [[domain, name, *(x for v in VERSIONS for x in (pair[v].times().best, int(pair[v].iterations[-1])))]
                  for domain, found in runs.items() for name, pair in found.items()])
    times = {f"{domain} {name}": {v: run.times() for v, run in pair.items()}
             for domain, found in runs.items() for name, pair in found.items()}
    unfinished = [f"{domain} {name} {v}" for domain, found in runs.items() for name, pair in found.items()
                  for v, run in pair.items() if run.failure or int(run.iterations[-1]) >= LIMIT]
    findings(report, quality, times, unfinished)
    return report.finish()


def findings(report: Report, quality: dict[str, dict[str, dict[str, float]]], times: dict[str, dict[str, Times]],
             unfinished: list[str]) -> None:
    """The findings on both choices; unfinished: the runs that did not reach the objective."""

    def poorer(quantity: str) -> Verdict:
        return all_of(less(found["reciprocal"][quantity], found["additive inverse"][quantity], QUALITY_MARGIN)
                      for found in quality.values())

    report.finding("3.2.2", "The additive inverse of SS yields poorer elements than its reciprocal", poorer("ss_worst"),
                   ", ".join(f"{domain} 1 / SS at most {found['reciprocal']['ss_worst']:.4g} and "
                             f"{found['additive inverse']['ss_worst']:.4g}" for domain, found in quality.items()),
                   criterion=f"the largest 1 / SS is larger by more than {QUALITY_MARGIN:.0%} on each domain")
    report.finding("3.2.2", "The reciprocal of SS yields a more even distribution of element qualities",
                   all_of(less(ratio(found["reciprocal"]), ratio(found["additive inverse"]), QUALITY_MARGIN)
                          for found in quality.values()),
                   ", ".join(f"{domain} {ratio(found['reciprocal']):.4g} and {ratio(found['additive inverse']):.4g}"
                             for domain, found in quality.items()),
                   criterion="the largest 1 / SS over the mean is smaller on each domain, by more than "
                   f"{QUALITY_MARGIN:.0%}")
    slow = {key: pair for key, pair in times.items() if not any(name.startswith(f"{key} ") for name in unfinished)}
    verdict = all_of(faster(pair[VERSIONS[0]], pair[VERSIONS[1]]) for pair in slow.values())
    if 2 * len(slow) <= len(times):
        verdict = Open(f"not all runs reached the objective: {', '.join(unfinished)}")
    report.finding("3.4", "The Polak-Ribiere method is faster than the Fletcher-Reeves method", verdict,
                   ", ".join(f"{key} {pair[VERSIONS[0]]} and {pair[VERSIONS[1]]}" for key, pair in times.items()),
                   criterion=f"less CPU time to {REDUCTION:.2%} of the possible reduction on both disks, with each "
                   "objective whose runs reach it")


def ratio(row: dict[str, float]) -> float:
    """The largest 1 / SS over the mean."""
    return row["ss_worst"] / row["ss_mean"]
