# SPDX-License-Identifier: BSD-3-Clause
"""parallel_solve.py FILE: for pvbatch on any number of MPI ranks, see test_parallel_solve.py.

Solves on a cube whose parts are on all ranks (of more than two, the last has nothing) and writes the results to FILE
as JSON.
"""

import json
import os
import sys
from pathlib import Path

import numpy as np
from paraview import servermanager, simple
from vtkmodules.vtkParallelCore import vtkMultiProcessController

sys.path.insert(0, str(Path(__file__).parent))
from parallel_tools import columns, parts, update  # noqa: E402

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())

# Runs on every rank: a cube of N^3 cubes of six tetrahedra each, in slabs, with a layer of ghost cells and global ids.
SLABS = """
import builtins
import itertools
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_TETRA, vtkCellArray
from vtkmodules.vtkParallelCore import vtkMultiProcessController

N, GHOSTS, IDS = {n}, {ghosts}, {ids}
controller = vtkMultiProcessController.GetGlobalController()
rank, ranks = controller.GetLocalProcessId(), controller.GetNumberOfProcesses()
parts = ranks - 1 if ranks > 2 else ranks
low, high = N * rank // parts, N * (rank + 1) // parts
if rank < parts:
    first, last = builtins.max(low - GHOSTS, 0), builtins.min(high + GHOSTS, N)
    grid = output.VTKObject
    k, j, i = np.meshgrid(np.arange(first, last + 1), np.arange(N + 1), np.arange(N + 1), indexing="ij")
    points = vtkPoints()
    points.SetData(numpy_to_vtk(np.stack([i, j, k], -1).reshape(-1, 3) / N, deep=True))
    grid.SetPoints(points)
    steps = (1, N + 1, (N + 1) ** 2)
    ck, cj, ci = (a.ravel() for a in np.meshgrid(np.arange(last - first), np.arange(N), np.arange(N), indexing="ij"))
    tetrahedra = []
    for order in itertools.permutations(range(3)):
        corners = list(itertools.accumulate((steps[a] for a in order), initial=ci + cj * steps[1] + ck * steps[2]))
        if np.linalg.det(np.eye(3)[list(order)]) < 0:
            corners[1], corners[2] = corners[2], corners[1]
        tetrahedra.append(np.stack(corners, -1))
    nodes = np.concatenate(tetrahedra).astype(np.int64)
    cells = vtkCellArray()
    offsets = np.arange(0, nodes.size + 1, 4, dtype=np.int64)
    cells.SetData(numpy_to_vtkIdTypeArray(offsets, deep=True), numpy_to_vtkIdTypeArray(nodes.ravel(), deep=True))
    grid.SetCells(VTK_TETRA, cells)
    layer = np.tile(ck + first, 6)
    ghost = numpy_to_vtk(((layer < low) | (layer >= high)).astype(np.uint8), deep=True)
    ghost.SetName("vtkGhostType")
    left = numpy_to_vtk((layer == 0).astype(float), deep=True)
    left.SetName("lowest layer")
    grid.GetCellData().AddArray(left)
    if GHOSTS:
        grid.GetCellData().AddArray(ghost)
    if IDS:
        numbers = (i + j * steps[1] + k * steps[2]).ravel().astype(np.int64)
        ids = numpy_to_vtkIdTypeArray(numbers, deep=True)
        ids.SetName("numbers")
        grid.GetPointData().SetGlobalIds(ids)
"""
RANKS = vtkMultiProcessController.GetGlobalController().GetNumberOfProcesses()
TIGHT = 1e-11
results = {}


def cube(n=8, ghosts=0, ids=0):
    return simple.ProgrammableSource(
        OutputDataSetType="vtkUnstructuredGrid", Script=SLABS.format(n=n, ghosts=ghosts, ids=ids)
    )


def field(filter_, name):
    """The values at all points of the cube, in an order that does not depend on the ranks, which must agree."""
    shared = {}
    for arrays in parts(filter_, sys.argv[1]):
        for point, value in zip(np.round(arrays["points"] * 1e6).astype(np.int64).tolist(), arrays[name].tolist()):
            assert shared.setdefault(tuple(point), value) == value, f"{name} differs between ranks at {point}"
    return [value for _, value in sorted(shared.items())]


def total(filter_, name):
    """The sum of a cell array over the cells that are not ghosts."""
    found = []  # no sum() of Python here: ParaView's scripts replace it by a collective one
    for arrays in parts(filter_, sys.argv[1]):
        own = arrays["vtkGhostType"] == 0 if "vtkGhostType" in arrays else slice(None)
        found.append(arrays[name][own].sum())
    return np.sum(found).item()


for ghosts, ids in ((0, 0), (1, 0), (0, 1), (1, 1)):
    mesh = cube(ghosts=ghosts, ids=ids)
    solved = SolvePDE(
        mesh, SourceType="Expression", SourceExpression="x*y + z", GivenType="Expression", GivenExpression="x + 2*y",
        RelativeTolerance=TIGHT,
    )  # fmt: skip
    update(solved)
    results[f"poisson {ghosts} {ids}"] = field(solved, "Solution")
    results[f"unknowns {ghosts} {ids}"] = solved.Unknowns
    gradients = [np.linalg.norm(arrays["Gradient"], axis=1).min() for arrays in parts(solved, sys.argv[1])]
    results[f"flattest {ghosts} {ids}"] = np.min(gradients).item()  # ghost cells have their gradients, too
elastic = SolvePDE(
    cube(ghosts=1), Equation="Linear Elasticity", BodyForce=[0, 0, -1], Preconditioner="GAMG",
    FixedPart="Part of the Boundary", FixedWhere="x < 0.01", RelativeTolerance=TIGHT,
)  # fmt: skip
results["elastic"] = field(update(elastic), "Displacement")
held = SolvePDE(
    cube(ids=1), FixedPart="Chosen Points Only", FixedPoints=["CELLS", "lowest layer"], GivenType="Expression",
    GivenExpression="x", Solver="MINRES", Preconditioner="ILU(0)", RelativeTolerance=TIGHT,
)  # fmt: skip
results["held"] = field(update(held), "Solution")
image = simple.Wavelet(WholeExtent=[0, 9, 0, 6, 0, 7])
hexahedra = SolvePDE(image, SourceType="Array", SourceArray=["POINTS", "RTData"], RelativeTolerance=TIGHT)
update(hexahedra)
results["image"] = [hexahedra.Unknowns, *hexahedra.PointData["Solution"].GetRange()]
history = servermanager.Fetch(hexahedra, idx=1)
results["history"] = history.GetNumberOfRows() == hexahedra.Iterations + 1

study = update(SolverStudy(cube(), Combinations=["1: CG + Jacobi", "15: MINRES + BoomerAMG", "17: Direct"]))
table = servermanager.Fetch(study, idx=1)
results["study"] = [table.GetValueByName(i, "N converged").ToDouble() for i in range(table.GetNumberOfRows())]
estimate = update(ConditionEstimator(cube(ghosts=1), Preconditioner="Jacobi"))
results["condition"] = [estimate.Condition, estimate.PreconditionedCondition]
results["shares"] = total(estimate, "Share")

# The values of a source in pieces, and of one that is whole on a rank.
image = update(
    MetricField(Metrics=["Mean ratio", "Condition number"], Dimensions=[21, 17, 1], Bounds=[-1, 2, -1, 2, 0, 0])
)
for name in ("mean_ratio", "condition_number", "Validity"):
    results[f"metric field {name}"] = field(image, name)
domain = update(MeshDomain(Domain="Square with Interaction Layer, Structured", ElementSize=0.1, LayerWidth=0.2))
results["domain points"] = [arrays["points"].ravel().tolist() for arrays in parts(domain, sys.argv[1])]
results["domain cells"] = domain.GetDataInformation().GetNumberOfCells()

# Tables of the whole mesh, whichever rank has a cell: the worst cells are known by their centres.
CRITERIA = """{"name": "test", "criteria": [
  {"metric": "mean_ratio", "weight": 2,
   "limits": {"all": {"ideal": 1, "good": 0.8, "warn": 0.72, "fail": 0.69, "worst": 0.5}}},
  {"metric": "imr", "weight": 1,
   "limits": {"all": {"ideal": 1, "good": 1.2, "warn": 1.35, "fail": 1.4, "worst": 2}}}]}"""
for ghosts in (0, 1):
    sheared = simple.Calculator(cube(ghosts=ghosts), ResultArrayName="d", Function="0.3*coordsX*coordsZ*kHat")
    moved = simple.WarpByVector(Input=sheared, Vectors=["POINTS", "d"])
    quality = update(ElementQuality(moved, Metrics=["Scaled Jacobian", "Size (area or volume)"], Criteria=CRITERIA))
    results[f"quality {ghosts}"] = {
        f"{port} {name}": values
        for port in (1, 2, 3, 5, 6)
        for name, values in columns(servermanager.Fetch(quality, idx=port)).items()
        if name != "WorstCells"  # their numbers depend on the ranks
    }
    results[f"quality {ghosts}"]["summary"] = quality.Summary.splitlines()[0]

# An error on one rank is an error on all, and none waits.
for options in (
    {"SourceType": "Expression", "SourceExpression": "1/(z - 1)"},  # on the uppermost part only
    {"PETScOptions": "-nonsense 1"},
    {"FixedPart": "Part of the Boundary", "FixedWhere": "x > 2"},
):
    wrong = update(SolvePDE(cube(), **options))
    results[f"refused {options}"] = wrong.GetDataInformation().GetNumberOfCells()
late = update(SolvePDE(cube(), Preconditioner="None", TimeLimit=1e-9))
# One process ends in the set-up with an error; several end together, in the iteration, with what they have.
cells = late.GetDataInformation().GetNumberOfCells()
results["late"] = "time limit" in late.Summary if RANKS > 1 else cells == 0

results["ranks"] = RANKS
with open(sys.argv[1], "w", encoding="utf-8") as out:
    json.dump(results, out)
