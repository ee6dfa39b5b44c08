# SPDX-License-Identifier: BSD-3-Clause
"""solve_on_ranks.py FILE: for pvbatch --sym on any number of MPI ranks, see test_solve_on_ranks.py.

Solves on a cube whose pieces are on the ranks: fewer pieces than ranks, as many, and more; cut in slabs, by a k-d tree
and at random; with and without ghost cells. More pieces than ranks are also one data set on each rank, as ParaView's
readers make it, with and without global ids. The same with the mesh redistributed by each partitioner. The first rank
writes numbers and fields to FILE as JSON.
"""

import json
import sys
import zlib

import numpy as np
import tautline
from rank_meshes import CONTROLLER, CUTS, RANK, RANKS, add_global_ids, appended, divided, piece, quadratic, simplices
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPartitionedDataSet, vtkUnstructuredGrid
from wording import wording

N = 5  # cubes of six tetrahedra each along an edge
MOVED = 0.15  # of the edge of a cube
TIGHT = 1e-11
CG_JACOBI, GMRES_AMG, DIRECT = 1, 14, 17  # combinations of Solver Study
JACOBI = 0  # preconditioner of Condition Estimator
EXPRESSION = 2  # SourceType, GivenType
DIVISIONS = {1: "k-d tree", 2: "pt-scotch"}  # Redistribute


def cube() -> tuple:
    """Points, corners of the tetrahedra; inner points are moved."""
    places, cells = simplices(N)
    inner = ((places > 0) & (places < N)).all(axis=1)
    shift = np.random.default_rng(4).uniform(-MOVED, MOVED, places.shape)
    return (places + inner[:, None] * shift) / N, cells


POINTS, CELLS = cube()


def mesh(cut: str, pieces: int, ghosts: bool, together: bool = False, ids: bool = False):
    """The data of this rank: a data set, or with more pieces than ranks several in a partitioned data set.

    together: they are one data set, whose points stay apart.
    """
    of_cell = divided(POINTS[CELLS].mean(axis=1), cut, pieces)
    grids = [piece(POINTS, CELLS, of_cell == number, ghosts) for number in range(RANK, pieces, RANKS)]
    if together:
        grid = appended(grids)
        if ids:
            add_global_ids(grid)
        return grid
    if pieces <= RANKS:
        return grids[0] if grids else vtkUnstructuredGrid()
    partitions = vtkPartitionedDataSet()
    for number, grid in enumerate(grids):
        partitions.SetPartition(number, grid)
    return partitions


def grids_of(data) -> list:
    if isinstance(data, vtkPartitionedDataSet):
        return [data.GetPartition(i) for i in range(data.GetNumberOfPartitions()) if data.GetPartition(i)]
    return [data]


def gathered(pairs: list) -> dict:
    """The pairs of place and value of all ranks as a dict, on the first; values of one place must be equal."""
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


def field(output, name: str, of_cells: bool = False) -> list:
    """The values of the whole mesh, in its order, on the first rank. Ghosts have the values of their originals."""
    pairs = []
    for grid in grids_of(output):
        if grid.GetNumberOfPoints():
            data = grid.GetCellData() if of_cells else grid.GetPointData()
            places = vtk_to_numpy(data.GetArray("cell" if of_cells else "place"))
            values = vtk_to_numpy(data.GetArray(name))
            pairs += zip(places.tolist(), values.tolist())
    found = gathered(pairs)
    assert RANK > 0 or len(found) == len(CELLS if of_cells else POINTS), (name, len(found))
    return [value for _, value in sorted(found.items())]


def run(kind: str, data, redistribution: int):
    filter_ = getattr(tautline, f"vtk{kind}")()
    filter_.SetInputDataObject(0, data)
    filter_.SetRedistribute(redistribution)
    if kind != "ConditionEstimator":
        filter_.SetRelativeTolerance(TIGHT)
    return filter_


def numbers(data, redistribution: int = 0) -> dict:
    """The results of the three filters."""
    solve = run("EllipticSolver", data, redistribution)
    solve.SetSourceType(EXPRESSION)
    solve.SetSourceExpression("x*y + z")
    solve.SetGivenType(EXPRESSION)
    solve.SetGivenExpression("x + 2*y")
    solve.Update()
    estimate = run("ConditionEstimator", data, redistribution)
    estimate.SetPreconditioner(JACOBI)
    estimate.SetComputeShares(True)
    estimate.Update()
    study = run("SolverStudy", data, redistribution)
    for combination in (CG_JACOBI, GMRES_AMG, DIRECT):
        study.AddCombination(combination)
    study.Update()
    table = study.GetStudy()
    column = {name: [table.GetValueByName(i, name).ToDouble() for i in range(table.GetNumberOfRows())]
              for name in ("N converged", "N iterations", "N condition") if RANK == 0}
    return {
        "unknowns": [filter_.GetUnknowns() for filter_ in (solve, estimate, study)],
        "solution": field(solve.GetOutputDataObject(0), "Solution"),
        "gradient": field(solve.GetOutputDataObject(0), "Gradient", of_cells=True),
        "condition": [estimate.GetCondition(), estimate.GetPreconditionedCondition()],
        "shares": field(estimate.GetOutputDataObject(0), "Share", of_cells=True),
        "eigenvalues": field(estimate.GetOutputDataObject(0), "LargestEigenvalue", of_cells=True),
        "excess": field(estimate.GetOutputDataObject(0), "Excess", of_cells=True),
        "study": column,
        "divided": [filter_.GetSummary().count(wording("redistributed")) for filter_ in (solve, estimate, study)],
    }


def curved_solution(cut: str, ids: bool, redistribution: int) -> dict:
    """A mesh of quadratic tetrahedra, whose edges are bent, in as many pieces as there are ranks."""
    points, cells = quadratic(*simplices(3))
    points = points / 3
    points = points + 0.2 * points * (1 - points) * np.sin(np.pi * points[:, [1, 2, 0]])
    of_cell = divided(points[cells[:, :4]].mean(axis=1), cut, RANKS)
    grid = piece(points, cells, of_cell == RANK)
    if ids and grid.GetNumberOfCells():
        add_global_ids(grid)
    solve = run("EllipticSolver", grid, redistribution)
    solve.SetSourceType(EXPRESSION)
    solve.SetSourceExpression("x*y + z")
    solve.Update()
    output = solve.GetOutputDataObject(0)
    places, values = (vtk_to_numpy(output.GetPointData().GetArray(name)) for name in ("place", "Solution"))
    found = gathered(list(zip(places.tolist(), values.tolist())))
    return {"unknowns": solve.GetUnknowns(), "solution": [value for _, value in sorted(found.items())]}


results = {"ranks": RANKS}
for cut in CUTS:
    for ids in (False, True):
        for redistribution in (0, *DIVISIONS):
            results[f"quadratic, {cut}, {ids}, {redistribution}"] = curved_solution(cut, ids, redistribution)
for cut in CUTS:
    for pieces in sorted({1, max(1, RANKS - 1), RANKS, 2 * RANKS + 1}):
        for ghosts in (False, True):
            results[f"{cut}, {pieces} pieces, ghosts {int(ghosts)}"] = numbers(mesh(cut, pieces, ghosts))
    for ghosts in (False, True):
        for ids in (False, True):
            case = f"{cut}, {2 * RANKS + 1} pieces together, ghosts {int(ghosts)}, ids {int(ids)}"
            results[case] = numbers(mesh(cut, 2 * RANKS + 1, ghosts, True, ids))
    for redistribution in DIVISIONS:
        for pieces in sorted({1, RANKS, 2 * RANKS + 1}):
            case = f"{cut}, {pieces} pieces, redistribution {redistribution}"
            results[case] = numbers(mesh(cut, pieces, redistribution == 1), redistribution)
        result = tautline.solve(mesh(cut, RANKS, False), source="x*y + z", given="x + 2*y", relative_tolerance=TIGHT,
                                redistribute=DIVISIONS[redistribution])  # fmt: skip
        results[f"function, {cut}, {redistribution}"] = field(result.mesh, "Solution")
if RANK == 0:
    results["points"] = zlib.crc32(POINTS.tobytes())
    with open(sys.argv[1], "w", encoding="utf-8") as out:
        json.dump(results, out)
