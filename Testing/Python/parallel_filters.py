# SPDX-License-Identifier: BSD-3-Clause
"""parallel_filters.py FILE: for pvbatch on any number of MPI ranks, see test_parallel_filters.py.

Every filter that gathers its mesh, on a mesh in pieces, cut in several ways; the results go to FILE as JSON.
"""

import json
import os
import re
import sys

import numpy as np
from paraview import servermanager, simple
from parallel_tools import RANKS, columns, parts, update
from wording import wording

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())
WARP_ANGLE, METHOD_ANGLE, WARP_STEPS = 30, 8, 2
CRITERIA = """{"name": "test", "criteria": [{"metric": "mean_ratio", "weight": 2,
  "limits": {"all": {"ideal": 1, "good": 0.8, "warn": 0.72, "fail": 0.69, "worst": 0.5}}}]}"""
results = {}

# Runs on every rank: its part of a jittered cube of tetrahedra, or of a square of triangles. The points are in the
# order of their coordinates and the cells in the order of their points, as meshes without global ids are put together.
PIECES = """
import numpy as np
from rank_meshes import RANK, RANKS, add_array, add_global_ids, divided, piece, simplices

D, N, GHOSTS, IDS = {dimension}, {n}, {ghosts}, {ids}
takers = RANKS - 1 if RANKS > 3 else RANKS  # of more than three, the last has nothing
places, cells = simplices(N, D)
inner = np.logical_and(places > 0, places < N).all(axis=1)
x = np.zeros((len(places), 3))
x[:, :D] = places / N + 0.3 / N * inner[:, None] * (np.random.default_rng(1).random(places.shape) - 0.5)
order = np.lexsort(x.T[::-1])
rank_of = np.empty(len(order), dtype=np.int64)
rank_of[order] = np.arange(len(order))
x, cells = x[order], rank_of[cells]
cells = cells[np.lexsort(np.sort(cells, axis=1).T[::-1])]
own = divided(x[cells].mean(axis=1), "{cut}", takers, axis=1) == RANK
grid = piece(x, cells, own, GHOSTS and RANKS > 1)
if grid.GetNumberOfPoints():
    here = x[np.array(grid.GetPointData().GetArray("place"))]
    add_array(grid.GetPointData(), "stay", (here[:, 0] < 0.3).astype(float))
    add_array(grid.GetPointData(), "push", here[:, 1:2] * [0.1, 0, 0])
    numbers = np.array(grid.GetCellData().GetArray("cell"))
    add_array(grid.GetCellData(), "along", np.stack([1 + numbers % 5, 1 + numbers % 2, 0.2 + numbers % 3], -1))
    add_array(grid.GetCellData(), "region", (numbers % 4 == 0).astype(float))
    if IDS:
        add_global_ids(grid)
    output.VTKObject.ShallowCopy(grid)
"""


# The surface of a cube. All ranks but the last have one face each, which is flat, and some are seen from behind.
FACES = """
import numpy as np
from rank_meshes import RANK, RANKS, piece, simplices

N = 3
places, square = simplices(N, 2)
x, cells, faces = np.zeros((0, 3)), [], []
for face in range(6):
    axis, side = face // 2, face % 2
    points = np.full((len(places), 3), float(N * side))
    points[:, (axis + 1) % 3], points[:, (axis + 2) % 3] = places.T
    cells.append(len(x) + (square if side else square[:, ::-1]))
    faces += [face] * len(square)
    x = np.concatenate([x, points])
x, number_of = np.unique(x, axis=0, return_inverse=True)
own = np.minimum(faces, RANKS - 1) == RANK
output.VTKObject.ShallowCopy(piece(x, number_of.ravel()[np.concatenate(cells)], own, False))
"""


def mesh(cut, ghosts=0, ids=0, dimension=3, n=3):
    script = PIECES.format(cut=cut, ghosts=ghosts, ids=ids, dimension=dimension, n=n)
    return simple.ProgrammableSource(OutputDataSetType="vtkUnstructuredGrid", Script=script)


def values(filter_, names, key="place", ghosts=True):
    """Arrays in the order of the whole mesh; ranks that share a point or cell must agree."""
    found = {}
    for arrays in parts(filter_, sys.argv[1]):
        own = slice(None) if ghosts or "vtkGhostType" not in arrays else arrays["vtkGhostType"] == 0
        rows = np.concatenate([np.reshape(arrays[name], (len(arrays[key]), -1)) for name in names], axis=1)
        for number, row in zip(arrays[key][own].tolist(), rows[own].tolist()):
            assert found.setdefault(number, row) == row, (names, number, row, found[number])
    return [row for _, row in sorted(found.items())]


def table(filter_, port):
    """The columns of numbers, without times."""
    found = columns(servermanager.Fetch(filter_, idx=port))
    plain = {name: column for name, column in found.items() if "(s)" not in name and "Seconds" not in name}
    return {name: column for name, column in plain.items() if column and not isinstance(column[0], str)}


def motions(name, cut, **given):
    source = mesh(cut, **given)
    warped = update(WarpMesh(source, TransformKind="Rotation", Angle=WARP_ANGLE, Method="FEMWARP", AutomaticSolver=0))
    results[f"warp {name}"] = values(warped, ["points", "Displacement"])
    results[f"warp table {name}"] = table(warped, 2)
    if name != "tree":  # two partitions are enough for this many methods
        methods(name, source)
    for key, options in {
        "hybrid": {"Motion": "Displacement array", "Displacement": ["POINTS", "push"], "Method": "Hybrid"},
        "untangled": {"Motion": "Displacement array", "Displacement": ["POINTS", "push"],
                      "Method": "FEMWARP and untangling", "FixedPoints": ["POINTS", "stay"]},
        "literal": {"Motion": "Displacement array", "Displacement": ["POINTS", "push"], "Method": "Hybrid",
                    "UntangleFirst": 0},
    }.items():  # fmt: skip
        moved = update(WarpMesh(source, **options))
        results[f"{key} {name}"] = [values(moved, ["points"]), int(moved.InvertedAfterWarp), int(moved.Inverted),
                                    moved.Summary]  # fmt: skip
    options = {"Percentage": 80, "Fraction": 0.7, "TangledFraction": 0.02, "FixedPoints": ["POINTS", "stay"]}
    moved = update(PerturbMesh(source, **options))
    results[f"tangle {name}"] = [values(moved, ["points", "Displacement"]), moved.Summary]
    curved = update(CurveMesh(source, Order=3))
    results[f"curve {name}"] = [values(curved, ["Validity", "cell"], "cell"), int(curved.AddedNodes), curved.Summary]
    metric = update(MetricTensor(source, Source="Distance", TangentialRatio=4))
    results[f"metric {name}"] = [values(metric, ["Metric"]), metric.Elements, metric.Summary]
    pieces = update(PerturbMesh(source, **{**options, "TangledFraction": 0}))
    results[f"perturb {name}"] = [values(pieces, ["points", "Displacement"]), pieces.Summary]
    graded = update(ElementQuality(source, Metrics=["Mean ratio"], Criteria=CRITERIA))
    # Ghost cells are not graded.
    results[f"criteria {name}"] = values(graded, ["Grade", "QualityIndex", "mean_ratio"], "cell", ghosts=False)
    compared = update(CompareMeshes(Input=source, Other=moved, Metrics=["Mean ratio"]))
    arrays = ["Validity_after", "mean_ratio_difference", "Change"]
    results[f"compare {name}"] = [values(compared, arrays, "cell"), table(compared, 1), compared.Summary]
    carried = update(Transfer(Input=source, Source=moved, PointArrays=["Displacement"], CellArrays=["along"]))
    results[f"transfer {name}"] = [values(carried, ["Displacement"]), table(carried, 1), carried.Summary]
    worse = PerturbMesh(source, Percentage=100, Fraction=0.9)
    improved = update(ImproveMesh(worse, Preset="Aggressive"))
    cells = np.concatenate([arrays["smallest"] for arrays in parts(quality_of(improved), sys.argv[1])])
    # A mesh that is small is put together, and the summary states it.
    text, _, why = improved.Summary.partition("\nThe mesh was put together on the first process: ")
    assert RANKS == 1 or wording("gather-below") in why, improved.Summary
    results[f"improve {name}"] = [sorted(cells.tolist()), table(improved, 1), improved.WorstAfter, text]


def methods(name, source):
    """The ways of Warp Mesh that each rank works on by itself."""
    stays = {"FixedPoints": ["POINTS", "stay"]}
    turned = {"TransformKind": "Rotation", "Angle": METHOD_ANGLE, **stays}
    pushed = {"Motion": "Displacement array", "Displacement": ["POINTS", "push"], **stays}
    for case, options in {
        "anisotropic": {**pushed, "Method": "Anisotropic FEMWARP"},  # singular: nothing moves along y and z
        "principal": {**turned, "Method": "Anisotropic FEMWARP",
                      "Coefficients": "From the motion, principal directions"},
        "small steps": {**turned, "Method": "Small-step FEMWARP", "Steps": WARP_STEPS},
        "stiffening": {**turned, "Method": "Elasticity, iterative stiffening"},
        "jacobian": {**pushed, "Method": "Elasticity, Jacobian-based stiffening"},
        "cells": {**pushed, "Method": "Anisotropic FEMWARP", "Coefficients": "A tensor per cell",
                  "CellTensors": ["CELLS", "along"]},
        "regions": {**turned, "Method": "Anisotropic FEMWARP", "Coefficients": "Per region",
                    "RegionArray": ["CELLS", "region"], "Regions": [1, 1, 0.1, 5]},
        "gradients": {**pushed, "Method": "Anisotropic FEMWARP", "Coefficients": "From the motion, local gradients"},
        "biharmonic": {**turned, "Method": "Biharmonic"},
        "laplacian": {**pushed, "Method": "Weighted Laplacian"},
        "distances": {**pushed, "Method": "Inverse distance weighting"},
        "radial": {**turned, "Method": "Radial basis functions"},
        "rotations": {**pushed, "Method": "Inverse distance with rotations"},
        "automatic": {**turned, "Method": "Automatic"},
        "part": {**turned, "Method": "FEMWARP", "MovedPart": "Boundary parts by number", "Parts": [1]},
        "values": {**turned, "Method": "FEMWARP", "MovedPart": "Values of an array",
                   "MovedArray": ["POINTS", "place"]},
    }.items():
        warped = update(WarpMesh(source, **options))
        assert wording("put-together") not in warped.Summary, warped.Summary
        results[f"{case} {name}"] = [values(warped, ["points"]), values(warped, ["TMP shape"], "cell"),
                                     table(warped, 1), table(warped, 2)]  # fmt: skip


def quality_of(filter_):
    return simple.Calculator(
        ElementQuality(filter_, Metrics=["Mean ratio"]), AttributeType="Cell Data", ResultArrayName="smallest",
        Function="mean_ratio",
    )  # fmt: skip


def surface():
    """Pieces that are flat are parts of a surface in space, which has no inverted cells."""
    faces = simple.ProgrammableSource(OutputDataSetType="vtkUnstructuredGrid", Script=FACES)
    measured = update(ElementQuality(faces, Metrics=["Mean ratio"]))
    text = re.sub(r"element \d+( of process \d+)?", "element", measured.Summary)
    results["surface"] = [values(measured, ["Validity", "mean_ratio"], "cell"), table(measured, 1), text]


def nonlocal_models(name, cut, **options):
    source = mesh(cut, dimension=2, n=8, **options)
    layer = update(InteractionLayer(source, Width=0.3))
    results[f"layer {name}"] = [layer.GetDataInformation().GetNumberOfCells(), *layer.GetDataInformation().GetBounds()]
    condition = update(PeridynamicCondition(layer, Horizon=0.25, Solve=1))
    results[f"condition {name}"] = [condition.Condition, *condition.PointData["Solution"].GetRange()]
    bare = update(PeridynamicCondition(source, Horizon=0.25, Constrained=0))
    results[f"rows {name}"] = [values(bare, ["RowSum", "Neighbors"]), table(bare, 1)["Rows"]]
    horizon = update(HorizonNeighbors(source, Center=[0.5, 0.45, 0], Horizon=0.3))
    arrays = [found for found in parts(horizon, sys.argv[1])]
    results[f"horizon {name}"] = [sorted(found["Area"].tolist()) for found in arrays]


def failures():
    """An error on one rank is an error on all, none waits, and the next execution works."""
    source = mesh("slabs")
    far = simple.ProgrammableFilter(source, Script=BREAK)
    for filter_ in (PerturbMesh(far), WarpMesh(far), ImproveMesh(far), PeridynamicCondition(far)):
        update(filter_)
        results[f"rejected {filter_.GetXMLName()}"] = filter_.GetDataInformation().GetNumberOfCells()
    # The points of an image do not move.
    results["image"] = update(PerturbMesh(simple.Wavelet(WholeExtent=[0, 2, 0, 2, 0, 2]))).Summary
    # The filter before fails, on one rank only.
    failing = SolvePDE(source, SourceType="Expression", SourceExpression="1/(y - 1)")
    after = update(PerturbMesh(failing))
    results["upstream"] = [update(after).GetDataInformation().GetNumberOfCells(), after.Summary]


# The last rank with cells has one with a point that does not exist.
BREAK = """
import numpy as np
from vtkmodules.vtkParallelCore import vtkMultiProcessController
from vtkmodules.util.numpy_support import vtk_to_numpy
controller = vtkMultiProcessController.GetGlobalController()
ranks = controller.GetNumberOfProcesses()
grid = output.VTKObject
grid.DeepCopy(inputs[0].VTKObject)
if controller.GetLocalProcessId() == (ranks - 2 if ranks > 3 else ranks - 1):
    vtk_to_numpy(grid.GetCells().GetConnectivityArray())[0] = 100000
"""

for case, given in {
    "slabs": {"cut": "slabs", "ghosts": 1, "ids": 1},
    "tree": {"cut": "tree", "ghosts": 0, "ids": 0},
    "random": {"cut": "random", "ghosts": 1, "ids": 0},
}.items():
    motions(case, **given)
    nonlocal_models(case, **given)
surface()
failures()
results["ranks"] = RANKS
with open(sys.argv[1], "w", encoding="utf-8") as out:
    json.dump(results, out)
