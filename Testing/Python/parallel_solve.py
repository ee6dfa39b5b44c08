# SPDX-License-Identifier: BSD-3-Clause
"""parallel_solve.py FILE: for pvbatch on any number of MPI ranks, see test_parallel_solve.py.

Solves on a cube whose parts are on all ranks (of more than two, the last has nothing) and writes the results to FILE
as JSON.
"""

import json
import os
import sys

import numpy as np
from paraview import servermanager, simple
from parallel_tools import RANKS, columns, parts, update

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())

# Runs on every rank: a cube of N^3 cubes of six tetrahedra each, in slabs, with a layer of ghost cells and global ids.
SLABS = """
import numpy as np
from rank_meshes import RANK, RANKS, add_array, add_global_ids, piece, simplices

N = {n}
places, cells = simplices(N)
places, cells = places[:, ::-1], cells[:, [1, 0, 2, 3]]  # layer by layer: equally bad cells are in the same order
takers = RANKS - 1 if RANKS > 2 else RANKS
layer = places[cells].min(axis=1)[:, 2]
own = layer * takers // N == RANK
grid = piece(places / N, cells, own, {ghosts} and RANKS > 1)
if grid.GetNumberOfPoints():
    lowest = layer[np.array(grid.GetCellData().GetArray("cell"))] == 0
    add_array(grid.GetCellData(), "lowest layer", lowest.astype(float))
    if {ids}:
        add_global_ids(grid)
    output.VTKObject.ShallowCopy(grid)
"""
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
    results[f"flattest {ghosts} {ids}"] = np.min(gradients).item()  # ghost cells also have their gradients
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
divided = SolvePDE(
    cube(ghosts=1), SourceType="Expression", SourceExpression="x*y + z", GivenType="Expression",
    GivenExpression="x + 2*y", RelativeTolerance=TIGHT, Redistribute="PT-Scotch",
)  # fmt: skip
results["divided"] = field(update(divided), "Solution")
results["division"] = divided.Summary.splitlines()[-1]
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

# Tables of the whole mesh, whichever rank has a cell: the worst cells are identified by their centers.
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
    results[f"rejected {options}"] = wrong.GetDataInformation().GetNumberOfCells()
late = update(SolvePDE(cube(), Preconditioner="None", TimeLimit=1e-9))
# One process ends in the set-up with an error; several end together, in the iteration, with what they have.
cells = late.GetDataInformation().GetNumberOfCells()
results["late"] = "time limit" in late.Summary if RANKS > 1 else cells == 0

results["ranks"] = RANKS
with open(sys.argv[1], "w", encoding="utf-8") as out:
    json.dump(results, out)
