# SPDX-License-Identifier: BSD-3-Clause
"""solve_on_ranks.py FILE: for pvbatch --sym on any number of MPI ranks, see test_solve_on_ranks.py.

Solves on a cube whose pieces are on the ranks: fewer pieces than ranks, as many, and more; cut in slabs, by a k-d tree
and at random; with and without ghost cells. The first rank writes numbers and fields to FILE as JSON.
"""

import json
import sys
import zlib

import numpy as np
import tautline
from rank_meshes import CONTROLLER, CUTS, RANK, RANKS, divided, piece, simplices
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPartitionedDataSet, vtkUnstructuredGrid

N = 5  # cubes of six tetrahedra each along an edge
MOVED = 0.15  # of the edge of a cube
TIGHT = 1e-11
CG_JACOBI, GMRES_AMG, DIRECT = 1, 14, 17  # combinations of Solver Study
JACOBI = 0  # preconditioner of Condition Estimator
EXPRESSION = 2  # SourceType, GivenType


def cube() -> tuple:
    """Points, corners of the tetrahedra; inner points are moved."""
    places, cells = simplices(N)
    inner = ((places > 0) & (places < N)).all(axis=1)
    shift = np.random.default_rng(4).uniform(-MOVED, MOVED, places.shape)
    return (places + inner[:, None] * shift) / N, cells


POINTS, CELLS = cube()


def mesh(cut: str, pieces: int, ghosts: bool):
    """What this rank has: a data set, or with more pieces than ranks several in a partitioned data set."""
    of_cell = divided(POINTS[CELLS].mean(axis=1), cut, pieces)
    grids = [piece(POINTS, CELLS, of_cell == number, ghosts) for number in range(RANK, pieces, RANKS)]
    if pieces <= RANKS:
        return grids[0] if grids else vtkUnstructuredGrid()
    together = vtkPartitionedDataSet()
    for number, grid in enumerate(grids):
        together.SetPartition(number, grid)
    return together


def grids_of(data) -> list:
    if isinstance(data, vtkPartitionedDataSet):
        return [data.GetPartition(i) for i in range(data.GetNumberOfPartitions()) if data.GetPartition(i)]
    return [data]


def gathered(pairs: list) -> dict:
    """The pairs of place and value of all ranks as a dict, on the first; those of one place must be equal."""
    text = json.dumps(pairs)
    lengths = [0] * RANKS
    file = f"{sys.argv[1]}.{RANK}"
    with open(file, "w", encoding="utf-8") as out:
        out.write(text)
    CONTROLLER.Barrier()
    found: dict = {}
    for rank in range(len(lengths) if RANK == 0 else 0):
        with open(f"{sys.argv[1]}.{rank}", encoding="utf-8") as part:
            for place, value in json.load(part):
                assert found.setdefault(place, value) == value, ("differs between pieces", place)
    CONTROLLER.Barrier()
    return found


def field(filter_, name: str, of_cells: bool = False, ghosts: bool = True) -> list:
    """The values of the whole mesh, in its order, on the first rank. ghosts: copies have them, too."""
    pairs = []
    for grid in grids_of(filter_.GetOutputDataObject(0)):
        if grid.GetNumberOfPoints():
            data = grid.GetCellData() if of_cells else grid.GetPointData()
            places = vtk_to_numpy(data.GetArray("cell" if of_cells else "place"))
            values = vtk_to_numpy(data.GetArray(name))
            copies = data.GetArray("vtkGhostType")
            taken = slice(None) if ghosts or not copies else vtk_to_numpy(copies) == 0
            pairs += zip(places[taken].tolist(), values[taken].tolist())
    found = gathered(pairs)
    assert RANK > 0 or len(found) == len(CELLS if of_cells else POINTS), (name, len(found))
    return [value for _, value in sorted(found.items())]


def run(kind: str, data):
    filter_ = getattr(tautline, f"vtk{kind}")()
    filter_.SetInputDataObject(0, data)
    if kind != "ConditionEstimator":
        filter_.SetRelativeTolerance(TIGHT)
    return filter_


def numbers(data) -> dict:
    """What the three filters find."""
    solve = run("EllipticSolver", data)
    solve.SetSourceType(EXPRESSION)
    solve.SetSourceExpression("x*y + z")
    solve.SetGivenType(EXPRESSION)
    solve.SetGivenExpression("x + 2*y")
    solve.Update()
    estimate = run("ConditionEstimator", data)
    estimate.SetPreconditioner(JACOBI)
    estimate.SetComputeShares(True)
    estimate.Update()
    study = run("SolverStudy", data)
    for combination in (CG_JACOBI, GMRES_AMG, DIRECT):
        study.AddCombination(combination)
    study.Update()
    table = study.GetStudy()
    column = {name: [table.GetValueByName(i, name).ToDouble() for i in range(table.GetNumberOfRows())]
              for name in ("N converged", "N iterations", "N condition") if RANK == 0}
    return {
        "unknowns": [filter_.GetUnknowns() for filter_ in (solve, estimate, study)],
        "solution": field(solve, "Solution"),
        "gradient": field(solve, "Gradient", of_cells=True),
        "condition": [estimate.GetCondition(), estimate.GetPreconditionedCondition()],
        "shares": field(estimate, "Share", of_cells=True, ghosts=False),
        "study": column,
    }


results = {"ranks": RANKS}
for cut in CUTS:
    for pieces in sorted({1, max(1, RANKS - 1), RANKS, 2 * RANKS + 1}):
        for ghosts in (False, True):
            results[f"{cut}, {pieces} pieces, ghosts {int(ghosts)}"] = numbers(mesh(cut, pieces, ghosts))
if RANK == 0:
    results["points"] = zlib.crc32(POINTS.tobytes())
    with open(sys.argv[1], "w", encoding="utf-8") as out:
        json.dump(results, out)
