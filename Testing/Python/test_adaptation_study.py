# SPDX-License-Identifier: BSD-3-Clause
"""The study of adaptation in the small size; its verdicts follow from its numbers."""

from argparse import Namespace

from checks import OUT
from study_checks import Studies
from tautline.studies import _report, _verdicts, adaptation

studies = Studies(OUT / "studies_adaptation")
LAYERS = [name for name in adaptation.PROBLEMS if "layer" in name]
FILES = {name: f"errors_{name.replace(' ', '_')}" for name in adaptation.PROBLEMS}


def run_all():
    printed = studies.run("adaptation")
    assert "Findings: " in printed
    findings = len(FILES) * (2 * 3 + 2 * 2 + 1) + 2 * len(LAYERS)
    studies.check("adaptation", findings, tuple(FILES.values()), {file: 6 for file in FILES.values()})


def test_numbers():
    """Errors fall; where the layer is resolved, they are smaller on adapted meshes."""
    for name, file in FILES.items():
        rows = studies.rows("adaptation", file)
        errors = {label: [float(row["L2"]) for row in rows if row["mesh"] == label]
                  for label in adaptation.METHODS.values()}
        for mesh, (coarse, fine) in errors.items():
            assert fine < coarse, (name, mesh)
        assert errors["anisotropic adaptation"][1] < errors["uniform refinement"][1], name


def made(exponent: float, first: float, elements=(100, 400, 1600, 6400)) -> list:
    """Errors that fall with an exponent."""
    errors = [first * (n / elements[0]) ** exponent for n in elements]
    return [adaptation.Solved(n, n, error, error**0.5, 0.9) for n, error in zip(elements, errors)]


def holds(state, *arguments) -> list:
    report = _report.Report("adaptation", "verdicts", Namespace(out=studies.directory, small=False, format=[]))
    state(report, *arguments)
    return [finding.verdict == _verdicts.HOLDS for finding in report.findings]


def test_verdicts():
    """Each verdict holds for the expected numbers, and does not for others."""
    good = {"uniform": made(-2 / 3, 1), "isotropic": made(-1, 1), "anisotropic": made(-1.1, 0.4)}
    assert holds(adaptation.rate_findings, "corner", good) == [True] * 6
    assert holds(adaptation.gain_findings, "corner", good) == [True] * 4
    assert holds(adaptation.gain_findings, "corner", {**good, "isotropic": made(-0.7, 1)}) == [False, True] * 2
    slow = {**good, "isotropic": made(-0.8, 1)}
    assert holds(adaptation.rate_findings, "corner", slow) == [True, False, True, True, True, True]
    fast = {**good, "uniform": made(-1, 1)}
    assert holds(adaptation.rate_findings, "corner", fast)[::3] == [False, False]
    layer = holds(adaptation.gain_findings, "boundary layer", {**good, "anisotropic": made(-1, 0.1)})
    assert layer[2] and layer[5] and len(layer) == 6
    assert not holds(adaptation.gain_findings, "boundary layer", {**good, "anisotropic": made(-1, 0.9)})[2]
    assert holds(adaptation.count_findings, "corner", good) == [True]
    far = [each._replace(elements=2 * each.elements) for each in good["isotropic"]]
    assert holds(adaptation.count_findings, "corner", {**good, "isotropic": far}) == [False]
    lost = [each._replace(l2=float("nan")) for each in good["uniform"]]
    assert holds(adaptation.rate_findings, "corner", {**good, "uniform": lost})[0] is False


if __name__ == "__main__":
    run_all()
    test_numbers()
    test_verdicts()
