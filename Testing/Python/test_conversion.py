# SPDX-License-Identifier: BSD-3-Clause
"""The command convert: formats, options, errors."""

import tautline as tl
from checks import DATA, OUT, run_tests, shell, wording

OUTPUT = OUT / "conversion"
OUTPUT.mkdir(parents=True, exist_ok=True)


def test_convert():
    text = shell("convert", DATA / "part.msh", OUTPUT / "part.mesh", "--lower-cells")
    assert tl.read(OUTPUT / "part.mesh", lower_cells=True).GetNumberOfCells() == 295 and "295 cells" in text
    shell("convert", DATA / "cube.1.node", OUTPUT / "cube.msh", "--binary")
    tl.write(tl.read(DATA / "cube.1.node"), OUTPUT / "binary.msh", binary=True)
    assert (OUTPUT / "cube.msh").read_bytes() == (OUTPUT / "binary.msh").read_bytes()
    assert wording("no-reader") in shell("convert", "thesis.docx", OUTPUT / "x.vtu", code=1)


run_tests(globals())
