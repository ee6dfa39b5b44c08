# SPDX-License-Identifier: BSD-3-Clause
"""The domains and the meshers as a ParaView user meets them."""

import os
from pathlib import Path

from paraview import simple

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())
DATA = Path(os.environ["TAUTLINE_DATA_DIR"])


def cells(proxy, port=0):
    proxy.UpdatePipeline()
    return proxy[port].GetDataInformation().GetNumberOfCells()


domain = MeshDomain(Domain="Square with Interaction Layer, Structured")
assert cells(domain) == 392
domain.Domain = "Rectangle, Structured"
domain.NumberOfCells = 3200
assert cells(domain) == 4 * 28 * 28
assert "Displacement" in domain.PointData.keys()

if "TetGenMesher" in globals():
    domain.Domain = "Moving Bar"
    assert abs(cells(domain) - 3200) < 160
    assert cells(domain, 1) > 0

    plate = simple.OpenDataFile(str(DATA / "plate.poly"))
    triangles = TriangleMesher(Input=plate, Size=0.2)
    assert cells(triangles) > 200
    assert cells(triangles, 1) > 80
    # a file with closed facets straight into tetrahedra, and on into the filters
    cube = simple.OpenDataFile(str(DATA / "cube.smesh"))
    tetrahedra = TetGenMesher(Input=cube, Volume=0.01)
    assert cells(tetrahedra) > 100
    assert cells(ElementQuality(Input=tetrahedra)) > 100
    surface = simple.Sphere(ThetaResolution=20, PhiResolution=20)
    filled = TetGenMesher(Input=surface, PreserveSurface=1)
    assert cells(filled, 1) == cells(surface)
