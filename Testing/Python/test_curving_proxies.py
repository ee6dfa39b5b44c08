# SPDX-License-Identifier: BSD-3-Clause
"""Curve Mesh through ParaView: properties by name, the geometry, results, state file."""

import os
from pathlib import Path

from paraview import servermanager, simple
from wording import wording

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())
STATE = str(Path(os.environ["TAUTLINE_TEST_DIR"], "curving.pvsm"))

coarse = MeshDomain(Domain="Disk (2D)", NumberOfCells=100)  # noqa: F821, defined by the plugin
fine = MeshDomain(Domain="Disk (2D)", NumberOfCells=20000)  # noqa: F821
curved = CurveMesh(registrationName="Curved", Input=coarse, Order=3)  # noqa: F821
assert (curved.Surface, curved.FeatureAngle, curved.Serendipity, curved.MergeCoincidentPoints) == ("Smooth", 40, 0, 1)


def run(source):
    source.UpdatePipeline()
    source.UpdatePropertyInformation()
    return servermanager.Fetch(source)


grid = run(curved)
assert grid.GetCellType(0) == 69
assert curved.AddedNodes == grid.GetNumberOfPoints() - coarse.GetDataInformation().GetNumberOfPoints()
assert curved.LargestOffset > curved.MeanOffset > 0 == curved.InvalidAfter == curved.InvalidBefore
assert curved.DistanceBefore == curved.DistanceAfter == 0
assert wording("invalid-elements-certified") in curved.Summary, curved.Summary

curved.Geometry = fine
run(curved)
assert 0 < curved.DistanceAfter < 0.05 * curved.DistanceBefore, (curved.DistanceAfter, curved.DistanceBefore)
expected = curved.DistanceAfter
simple.SaveState(STATE)

curved.Geometry = None
curved.Surface, curved.Order = "Straight", 2
assert run(curved).GetCellType(0) == 22 and curved.LargestOffset == 0
curved.Order = 1
assert run(curved).GetCellType(0) == 5 and curved.AddedNodes == 0

simple.ResetSession()
simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())
simple.LoadState(STATE)
again = simple.FindSource("Curved")
run(again)
assert again.Order == 3 and again.DistanceAfter == expected
