# SPDX-License-Identifier: BSD-3-Clause
"""solve_on_ranks.py FILE: for pvbatch --sym on any number of MPI ranks, see test_solve_on_ranks.py.

Solves on a cube whose pieces are on the ranks: fewer pieces than ranks, as many, and more; cut in slabs, by a k-d tree
and at random; with and without ghost cells. The first rank writes numbers and fields to FILE as JSON.
"""

import itertools
import json
import sys
import zlib

import numpy as np
import tautline
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_TETRA, vtkCellArray, vtkPartitionedDataSet, vtkUnstructuredGrid
from vtkmodules.vtkParallelCore import vtkMultiProcessController

N = 5  # cubes of six tetrahedra each along an edge
MOVED = 0.15  # of the edge of a cube
TIGHT = 1e-11
CG_JACOBI, GMRES_AMG, DIRECT = 1, 14, 17  # combinations of Solver Study
JACOBI = 0  # preconditioner of Condition Estimator
EXPRESSION = 2  # SourceType, GivenType
CUTS = ("slabs", "tree", "random")

controller = vtkMultiProcessController.GetGlobalController()
RANK, RANKS = controller.GetLocalProcessId(), controller.GetNumberOfProcesses()


def cube() -> tuple:
    """Points, corners of the tetrahedra; inner points are moved."""
    generator = np.random.default_rng(4)
    k, j, i = np.meshgrid(np.arange(N + 1), np.arange(N + 1), np.arange(N + 1), indexing="ij")
    x = np.stack([i, j, k], -1).reshape(-1, 3).astype(float)
    inner = ((x > 0) & (x < N)).all(axis=1)
    x += inner[:, None] * generator.uniform(-MOVED, MOVED, x.shape)
    steps = (1, N + 1, (N + 1) ** 2)
    ck, cj, ci = (a.ravel() for a in np.meshgrid(np.arange(N), np.arange(N), np.arange(N), indexing="ij"))
    tetrahedra = []
    for order in itertools.permutations(range(3)):
        corners = list(itertools.accumulate((steps[a] for a in order), initial=ci + cj * steps[1] + ck * steps[2]))
        if np.linalg.det(np.eye(3)[list(order)]) < 0:
            corners[1], corners[2] = corners[2], corners[1]
        tetrahedra.append(np.stack(corners, -1))
    return x / N, np.concatenate(tetrahedra).astype(np.int64)


POINTS, CELLS = cube()


def divided(cut: str, pieces: int) -> np.ndarray:
    """The piece of each cell."""
    centres = POINTS[CELLS].mean(axis=1)
    if cut == "random":
        return np.random.default_rng(7).integers(0, pieces, len(CELLS))
    found = np.zeros(len(CELLS), int)
    left = [(np.arange(len(CELLS)), 0, pieces)]
    while left:
        cells, first, count = left.pop()
        if count == 1:
            found[cells] = first
            continue
        axis = 2 if cut == "slabs" else int(np.argmax(np.ptp(centres[cells], axis=0)))
        order = cells[np.argsort(centres[cells, axis], kind="stable")]
        half = count // 2
        middle = len(order) * half // count
        left += [(order[:middle], first, half), (order[middle:], first + half, count - half)]
    return found


def piece(own: np.ndarray, ghosts: bool) -> vtkUnstructuredGrid:
    """The flagged cells with points of their own; with ghosts also the cells that share a point with them."""
    grid = vtkUnstructuredGrid()
    taken = np.isin(CELLS, np.unique(CELLS[own])).any(axis=1) if ghosts else own
    used, local = np.unique(CELLS[taken], return_inverse=True)
    points = vtkPoints()
    points.SetData(numpy_to_vtk(POINTS[used], deep=True))
    grid.SetPoints(points)
    cells = vtkCellArray()
    offsets = np.arange(0, local.size + 1, 4, dtype=np.int64)
    local = local.reshape(-1).astype(np.int64)
    cells.SetData(numpy_to_vtkIdTypeArray(offsets, deep=True), numpy_to_vtkIdTypeArray(local, deep=True))
    grid.SetCells(VTK_TETRA, cells)
    for name, data, values in (("place", grid.GetPointData(), used.astype(np.int64)),
                               ("cell", grid.GetCellData(), np.flatnonzero(taken).astype(np.int64)),
                               ("vtkGhostType", grid.GetCellData(), (~own[taken]).astype(np.uint8))):
        if name != "vtkGhostType" or ghosts:
            array = numpy_to_vtk(values, deep=True)
            array.SetName(name)
            data.AddArray(array)
    return grid


def mesh(cut: str, pieces: int, ghosts: bool):
    """What this rank has: a data set, or with more pieces than ranks several in a partitioned data set."""
    of_cell = divided(cut, pieces)
    grids = [piece(of_cell == number, ghosts) for number in range(RANK, pieces, RANKS)]
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
    controller.Barrier()
    found: dict = {}
    for rank in range(len(lengths) if RANK == 0 else 0):
        with open(f"{sys.argv[1]}.{rank}", encoding="utf-8") as part:
            for place, value in json.load(part):
                assert found.setdefault(place, value) == value, ("differs between pieces", place)
    controller.Barrier()
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
