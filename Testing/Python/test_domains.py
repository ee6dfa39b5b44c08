# SPDX-License-Identifier: BSD-3-Clause
"""The functions domain and domains, the command domain: sizes, motions, errors."""

import tautline as tl
from checks import OUT, rejected, run_tests, shell, wording

OUTPUT = OUT / "domains"
OUTPUT.mkdir(parents=True, exist_ok=True)


def test_domain():
    assert len(tl.domains()) == 17
    square = tl.domain("square", element_size=0.1, aspect_ratio=4, layer_width=0.2)
    assert square.GetNumberOfCells() == 392
    assert square.GetCellData().GetArray("Reference").GetRange() == (1, 2)
    rejected(wording("there-is-no-domain-torus-there-are"), tl.domain, "torus")
    rejected(wording("cells-is-1-it"), tl.domain, "wrench", -1)
    rejected(wording("whole-numbers"), tl.domain, "square", aspect_ratio=2)
    if tl.vtkDomainSource.HasMeshing():
        cylinder = tl.domain("cylinder", cells=5000, amount=0.5)
        assert abs(cylinder.GetNumberOfCells() - 5000) < 250
        assert cylinder.GetPointData().GetArray("Displacement").GetRange(0) == (0.0, 0.3)
        moved = tl.domain("cylinder", cells=5000, amount=0.5, deformed_boundary=True)
        assert moved.GetNumberOfLines() > 0 and moved.GetNumberOfPoints() == cylinder.GetNumberOfPoints()
    else:
        rejected("TAUTLINE_MESHING=OFF", tl.domain, "cylinder")


def test_command():
    text = shell("domain", "rectangle", "--cells", 400, "-o", OUTPUT / "rectangle.msh")
    assert tl.read(OUTPUT / "rectangle.msh").GetNumberOfCells() == 400 and "400 cells" in text
    for wrong in (["torus", "-o", "x.msh"], ["wrench"], ["wrench", "--cells", "many"]):
        shell("domain", *wrong, code=2)


run_tests(globals())
