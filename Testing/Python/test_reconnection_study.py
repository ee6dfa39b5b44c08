# SPDX-License-Identifier: BSD-3-Clause
"""The study of reconnection in the small size; its verdicts follow from its numbers."""

from argparse import Namespace

from checks import OUT
from study_checks import Studies
from tautline.studies import _report, _verdicts, reconnection

studies = Studies(OUT / "studies_reconnection")
TABLES = {domain: len(reconnection.STEPS) for domain in reconnection.DOMAINS} | {
    "refinement": len(reconnection.PLANAR),
    "reach": len(reconnection.TARGETS) * (len(reconnection.SOLIDS) + 1),
}


def run_all():
    printed = studies.run("reconnection")
    assert "Findings: " in printed
    text = (studies.directory / "reconnection" / "reconnection.txt").read_text(encoding="utf-8")
    assert text in printed
    studies.check("reconnection", 5 * len(reconnection.DOMAINS) + 3, (), TABLES)


def rows_of(domain: str) -> dict[str, list[float]]:
    return {
        row["mesh"]: [float(row[column]) for column in reconnection.COLUMNS]
        for row in studies.rows("reconnection", domain)
    }


def test_numbers():
    """Slivers are there before and not after; condition numbers are above 1."""
    for domain in reconnection.DOMAINS:
        rows = rows_of(domain)
        angle = {name: row[reconnection.ANGLE] for name, row in rows.items()}
        assert angle["with slivers"] < 2 and angle["remove slivers"] >= 15, angle
        assert angle["aggressive"] > 20, angle
        for row in rows.values():
            assert row[reconnection.CONDITION] > 1 and row[reconnection.PRECONDITIONED] > 1, row
            assert row[reconnection.ITERATIONS] >= 5, row


def holds(state, *arguments) -> list:
    """The verdicts of a function that states findings."""
    report = _report.Report("reconnection", "verdicts", Namespace(out=studies.directory, small=False, format=[]))
    state(report, *arguments)
    return [finding.verdict == _verdicts.HOLDS for finding in report.findings]


def test_reach():
    """Where the boundary slides, all domains reach the angle; the verdicts follow from the numbers."""
    rows = {row["mesh"]: [float(x) for x in list(row.values())[1:]] for row in studies.rows("reconnection", "reach")}
    assert holds(reconnection.reach_findings, rows) == [True, True], rows
    for name, row in rows.items():
        assert 0.89 * row[0] <= row[1] <= 1.11 * row[0] and row[2] < 12, (name, row)
        assert row[4] > (15 if "Delaunay" in name else 25), (name, row)
    for column, value, wrong in ((4, 35.0, 1), (4, 0.0, 0), (5, 1e3, 0)):
        bad = {key: list(row) for key, row in rows.items()}
        bad["bore, sliding"][column] = value
        assert not holds(reconnection.reach_findings, bad)[wrong]


def test_verdicts():
    """Slivers cost; each verdict holds for good numbers, and does not for numbers that contradict it."""
    state = reconnection.domain_findings
    for domain in reconnection.DOMAINS:
        assert holds(state, domain, rows_of(domain))[:3] == [True] * 3, rows_of(domain)
    good = {name: [10.0, 20.0, 2.0, 50.0, 5.0, 9.0] for name in reconnection.STEPS}
    good["with slivers"] = [10.0, 0.1, 90.0, 5e3, 500.0, 90.0]
    good["best shape (points move)"][reconnection.ANGLE] = 5.0
    assert holds(state, "any", good) == [True] * 5
    wrong = (("remove slivers", reconnection.CONDITION, 6e3, 0),
             ("remove slivers", reconnection.PRECONDITIONED, 501, 1),
             ("remove slivers", reconnection.ITERATIONS, 90, 2), ("aggressive", reconnection.ITERATIONS, 10, 3),
             ("best shape (points move)", reconnection.ANGLE, 20.0, 4))
    for name, column, value, index in wrong:
        bad = {key: list(row) for key, row in good.items()}
        bad[name][column] = value
        assert not holds(state, "any", bad)[index], (name, column)
    assert holds(reconnection.refinement_findings, {"a": [29.0, 100.0, 35.0, 100.0]}) == [True]
    for row in ([36.0, 100.0, 35.0, 100.0], [29.0, 99.0, 35.0, 100.0]):
        assert holds(reconnection.refinement_findings, {"a": row}) == [False]


if __name__ == "__main__":
    run_all()
    test_numbers()
    test_reach()
    test_verdicts()
