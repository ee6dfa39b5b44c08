# SPDX-License-Identifier: BSD-3-Clause
"""The study of divisions for ranks in the small size: divisions, counts, the model, verdicts."""

import math
from argparse import Namespace

import numpy as np
import tautline as tl
from checks import OUT, rejected, wording
from study_checks import Studies, rejected_command
from tautline._errors import Messages
from tautline.studies import _report, _verdicts, decomposition
from vtkmodules.vtkCommonCore import vtkIntArray
from vtkmodules.vtkCommonDataModel import vtkTable

studies = Studies(OUT / "studies_decomposition")
METHODS = [method.replace(" ", "_").replace("-", "") for method in decomposition.METHODS]
DOMAINS = ("disk3d", "disk2d")
FINDINGS = 7 * len(DOMAINS) + len(decomposition.RANK_CELLS) + 7


def report_of() -> _report.Report:
    """A report in full size, which decides."""
    return _report.Report("decomposition", "verdicts", Namespace(out=studies.directory, small=False, format=[]))


def run_all() -> None:
    printed = studies.run("decomposition")
    assert wording("what-breaks-it") in printed
    parts = len(decomposition.SMALL_PARTS)
    tables = {f"{domain}_{method}": parts for domain in DOMAINS for method in METHODS}
    tables |= {"weak": parts + 1, "sizes": len(decomposition.SMALL_SIZES), "model": 3, "efficiency": 3, "anchor": 1}
    studies.check("decomposition", FINDINGS, ("halos",), tables)


def test_numbers() -> None:
    """Orders that hold on any mesh: random is the worst, the graph's halo is the smaller one; messages have points."""
    for domain in DOMAINS:
        halo = {m: studies.column("decomposition", f"{domain}_{m}", "parts", "largest halo") for m in METHODS}
        kilobytes = {m: studies.column("decomposition", f"{domain}_{m}", "parts", "kB") for m in METHODS}
        messages = {m: studies.column("decomposition", f"{domain}_{m}", "parts", "messages") for m in METHODS}
        for n in map(str, decomposition.SMALL_PARTS):
            assert halo["random"][n] > 2 * max(halo["graph"][n], halo["kd_tree"][n]), (domain, n, halo)
            assert all(1000 * kilobytes[m][n] >= 32 * messages[m][n] > 0 for m in METHODS), (domain, n)
        assert halo["graph"]["8"] < halo["slabs"]["8"], (domain, halo)
        near = studies.column("decomposition", f"{domain}_slabs", "parts", "neighbors")
        assert near["2"] == 1 and 2 <= near["8"] <= 5, near  # thin slabs touch those behind the next


def test_divisions() -> None:
    """Parts of equal numbers of cells; a grid in two halves has the halo that can be counted by hand."""
    from vtkmodules.vtkFiltersSources import vtkPlaneSource

    mesh = tl.domain("disk2d", 1500)
    cells = mesh.GetNumberOfCells()
    for method in ("slabs", "k-d tree", "curve"):
        for parts in (2, 3, 8):
            sizes = np.bincount(decomposition.divided(mesh, method, parts), minlength=parts)
            assert len(sizes) == parts and np.ptp(sizes) <= 2, (method, parts, sizes)
    sizes = np.bincount(decomposition.divided(mesh, "graph", 4))
    assert len(sizes) == 4 and sizes.max() < 1.2 * cells / 4, sizes
    plane = vtkPlaneSource()
    plane.SetResolution(8, 6)
    plane.Update()
    grid = plane.GetOutput()
    parts = (np.arange(48) % 8 >= 4).astype(np.int32)
    decomposer, table, array = tl.vtkMeshDecomposition(), vtkTable(), vtkIntArray()
    array.SetNumberOfValues(48)
    for cell, part in enumerate(parts):
        array.SetValue(cell, int(part))
    decomposer.Count(grid, array, table)
    of = {name: [table.GetValueByName(row, name).ToInt() for row in (0, 1)]
          for name in ("Cells", "Points", "Free Points", "Halo Points", "Neighbours")}
    assert of["Cells"] == [24, 24] and sum(of["Points"]) == 9 * 7 and sum(of["Free Points"]) == 7 * 5, of
    # Each of the 7 points between the parts is a copy on one side; an owned one needs points of the other side's cells.
    assert of["Neighbours"] == [1, 1] and 14 <= sum(of["Halo Points"]) <= 7 + 2 * 7 and min(of["Halo Points"]) > 0, of
    assert decomposer.GetFreePoints() == 35 and 4 <= decomposer.GetNumberOfSets() <= 9


def test_errors() -> None:
    decomposer, table, array = tl.vtkMeshDecomposition(), vtkTable(), vtkIntArray()
    messages = Messages(decomposer)
    mesh = tl.domain("disk2d", 500)
    for text, call in (("numbers of parts for", lambda: decomposer.Count(mesh, array, table)),
                       ("needs a mesh", lambda: decomposer.Count(None, array, table)),
                       ("needs a mesh", lambda: decomposer.DivideGraph(None, array))):
        call()
        rejected(text, messages.raise_errors)
        messages.errors.clear()
    decomposer.SetNumberOfParts(1000000)
    decomposer.DivideGraph(mesh, array)
    rejected(wording("cannot-have-1000000-parts"), messages.raise_errors)
    assert array.GetNumberOfValues() == 0
    for option in ("--latency=-1", "--bandwidth=0", "--latency=nan"):
        rejected_command("positive numbers are needed", "study", "decomposition", "--small", option)


def test_model() -> None:
    """By hand: seconds of each part; efficiency falls with ranks and grows with cells."""
    model = decomposition.Model(halo=6.0, exponent=2 / 3, neighbors=10, sets=20, points=0.2, waiting=1.5, sent=0.5,
                                second=1e-6, latency=1e-6, bandwidth=1e9)
    parts = model.parts_of(1000, 64)
    expected = {"points": 2e-4, "waiting": 1e-6 * 1.5 * (200 * 20) ** 0.5, "messages": 2e-4,
                "bytes": 32 * 0.5 * 600 / 1e9, "collective": 6 * (2 * 6e-6 + 64 * 16 / 1e9)}
    assert parts.keys() == expected.keys()
    assert all(abs(parts[name] / expected[name] - 1) < 1e-12 for name in parts), parts
    assert abs(model.efficiency(1000, 64) - 2e-4 / sum(expected.values())) < 1e-12
    functions = {"sqrt": math.sqrt, "ceil": math.ceil, "log2": math.log2}
    for cells, ranks in ((1000, 64), (20000, 100), (decomposition.ANCHOR_CELLS, decomposition.ANCHOR_RANKS)):
        seconds = eval(decomposition.FORMULA, functions | model.symbols() | {"n": cells, "P": ranks})
        assert abs(seconds / sum(model.parts_of(cells, ranks).values()) - 1) < 1e-12, (cells, ranks, seconds)
    assert model.efficiency(1000, 1024) < model.efficiency(1000, 64) < model.efficiency(10000, 64) < 1
    factor, exponent = decomposition.slope([10, 100, 1000], [3 * n**0.6 for n in (10, 100, 1000)])
    assert abs(factor - 3) < 1e-9 and abs(exponent - 0.6) < 1e-12
    report = report_of()
    weak = {n: decomposition.Division(1000 * n, 1.0, 600, 500.0, 10, 100, 9600, 20, 200 * n, 294, 0.1, [])
            for n in (16, 64, 256)}
    numbers = (model.exponent, {"slowest": model.slowest(1000), "halo": model.halo_of(1000)}, {1000: 0.81},
               model.parts_of(1000, 64))
    decomposition.scaling_findings(report, weak, *numbers)
    verdicts = [finding.verdict for finding in report.recorded]
    assert verdicts[:6] == [_verdicts.HOLDS] * 6, report.findings
    weak[256].slowest = 500
    weak[64].halo = 900
    decomposition.scaling_findings(report, weak, *numbers)
    verdicts = [finding.verdict for finding in report.recorded][len(verdicts):]
    assert verdicts[0] == verdicts[3] == _verdicts.DOES_NOT_HOLD, verdicts


def test_spread() -> None:
    """Where runs of PT-Scotch are on both sides of the k-d tree, nothing is decided."""
    assert decomposition.counted(tl.domain("disk2d", 500), "graph", 3).halos[1] > 0
    for halos, verdict in (([90, 95, 99], _verdicts.HOLDS), ([90, 99, 101], _verdicts.NOT_DECIDED),
                           ([100, 102, 103], _verdicts.DOES_NOT_HOLD)):
        report = report_of()
        one = decomposition.Division(1000, 1.0, 100, 90.0, 4, 10, 960, 10, 200, 210, 0.1, halos)
        decomposition.division_findings(report, {"any": {method: {8: one} for method in decomposition.METHODS}})
        found = {finding.claim: finding.verdict for finding in report.findings}
        assert found["The graph's largest halo is smaller than the k-d tree's, for every number of parts"] == verdict


if __name__ == "__main__":
    run_all()
    test_numbers()
    test_divisions()
    test_errors()
    test_model()
    test_spread()
