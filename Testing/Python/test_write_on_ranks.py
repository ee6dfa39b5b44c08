# SPDX-License-Identifier: BSD-3-Clause
"""test_write_on_ranks.py PVBATCH: what MPI ranks save, one process converts; skipped without mpirun."""

import shutil

import tautline as tl
from on_ranks import OUT, run_with_output

FOLDER = OUT / "write-on-ranks"
CELLS, POINTS, SEAM = 4**3 * 6, 5**3, 5**2

for ranks in (2, 3):
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    found, text = run_with_output("write_on_ranks.py", ranks, str(FOLDER))
    # The formats of one process are rejected by name, and leave no file.
    assert found["saved"] == ["ghosts0.pvtu", "ghosts1.pvtu"], (ranks, found["saved"])
    for ending in ("vtu", "node", "mesh", "msh", "off"):
        assert f"No matching writer found for extension: {ending}" in text, (ranks, ending, text)
        assert not list(FOLDER.glob(f"cube*.{ending}")), (ranks, ending)
    for ghosts in (0, 1):
        mesh = tl.read(FOLDER / f"ghosts{ghosts}.pvtu")
        for ending in ("msh", "mesh", "node", "vtu"):
            file = FOLDER / f"converted{ghosts}.{ending}"
            tl.write(mesh, file)
            converted = tl.read(file)
            # Without the ghost cells; pieces have the points of seams of their own.
            count = converted.GetNumberOfCells(), converted.GetNumberOfPoints()
            print(ranks, "ranks, ghosts", ghosts, ending, count)
            assert count[0] == CELLS, (ranks, ghosts, ending, count)
            assert count[1] > POINTS + (ranks - 1) * (SEAM - 1), (ranks, ghosts, ending, count)
