# SPDX-License-Identifier: BSD-3-Clause
"""faces_on_ranks.py FILE CASE...: for pvbatch on any number of MPI ranks, see test_faces_on_ranks.py.

Metrics of finite volumes, and the checks of checkMesh, on cases of OpenFOAM in pieces; the results go to FILE as JSON.
"""

import json
import os
import sys

import numpy as np
from paraview import servermanager, simple
from parallel_tools import RANKS, columns, parts, update
from vtkmodules.util.numpy_support import vtk_to_numpy

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())
METRICS = {
    "non_orthogonality": "Non-orthogonality",
    "face_skewness": "Face skewness",
    "volume_ratio": "Volume ratio of neighbors",
    "face_weight": "Face interpolation weight",
    "cell_determinant": "Cell determinant",
    "fan_tet_quality": "Tetrahedron quality, fans",
    "orthogonal_quality": "Orthogonal quality",
    "cell_aspect_ratio": "Cell aspect ratio, of areas",
    "cell_volume": "Cell volume, of pyramids",
}
results = {"ranks": RANKS}

# Runs on every rank: a plane mesh of triangles and quadrilaterals, of which it has a part.
PLANE = """
import numpy as np
from rank_meshes import RANK, RANKS, divided, piece, simplices

places, cells = simplices(6, 2)
x = np.zeros((len(places), 3))
inner = np.logical_and(places > 0, places < 6).all(axis=1)
x[:, :2] = places + 0.6 * inner[:, None] * (np.random.default_rng(1).random(places.shape) - 0.5)
x = x @ np.array([[0.8, 0.6, 0.2], [-0.6, 0.8, 0.1], [0, 0, 1]])
own = divided(places[cells].mean(axis=1), "random", RANKS) == RANK
output.VTKObject.ShallowCopy(piece(x, cells, own, {ghosts} and RANKS > 1))
"""


def measured(name: str, mesh) -> None:
    quality = update(ElementQuality(Input=mesh, Metrics=list(METRICS.values()), FacestoShow="All"))
    found = [part for part in parts(quality, sys.argv[1]) if len(part["Validity"])]
    own = {}
    for part in found:
        of_volumes = part["cell_volume"] != 0
        if "vtkGhostType" in part:
            of_volumes &= part["vtkGhostType"] == 0
        for metric in METRICS:
            own.setdefault(metric, []).extend(part[metric][of_volumes].tolist())
    faces = servermanager.Fetch(quality, idx=8)
    patches, angles = (vtk_to_numpy(faces.GetCellData().GetArray(name)) for name in ("Patch", "non_orthogonality"))
    results[name] = {
        "cells": {metric: sorted(values) for metric, values in own.items()},
        "checks": columns(servermanager.Fetch(quality, idx=9)),
        "inner faces": int((patches < 0).sum()),
        "faces": len(patches),
        "angles of faces": np.sort(angles).tolist(),
    }


for case in sys.argv[2:]:
    measured(case, OpenFOAMMeshReader(FileName=case))
    if "failing" in case:  # the first process has the whole mesh
        repaired = OptimizeMesh(Input=OpenFOAMMeshReader(FileName=case), Preset="Finite volumes")
        measured(f"repaired {case}", repaired)
for ghosts in (0, 1):
    script = PLANE.format(ghosts=ghosts)
    measured(f"plane {ghosts}", simple.ProgrammableSource(OutputDataSetType="vtkUnstructuredGrid", Script=script))
assert np.isfinite(results["plane 0"]["cells"]["cell_volume"]).all()
with open(sys.argv[1], "w", encoding="utf-8") as file:
    json.dump(results, file)
