# SPDX-License-Identifier: BSD-3-Clause
"""partitions_on_ranks.py FILE FOLDER [write]: for pvbatch on any number of MPI ranks, see test_partitions_on_ranks.py.

With write, saves meshes in pieces to FOLDER: blocks, a collection, surfaces and a time series. Else reads them, runs
filters on them, and on pieces that some ranks do not have or that lack an array; the results go to FILE as JSON.
"""

import builtins  # (scripts of sources import into this module: not "max" or "sorted")
import json
import os
import sys
from pathlib import Path

import numpy as np
from paraview import servermanager, simple
from parallel_tools import DUMP, RANKS, update

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())
FILE, FOLDER = sys.argv[1], Path(sys.argv[2])
results = {"ranks": RANKS}

# Runs on every rank: two cubes of tetrahedra, or a square of triangles, whose inner points are moved at random.
PIECES = """
import numpy as np
from rank_meshes import RANK, RANKS, add_array, divided, piece, simplices
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet, vtkPartitionedDataSetCollection, vtkPolyData

KIND, D, N, T = "{kind}", {dimension}, 4, {time}
LAST = RANK == RANKS - 1
places, cells = simplices(N, D)
inner = np.logical_and(places > 0, places < N).all(axis=1)
points = np.zeros((len(places), 3))
points[:, :D] = places + 0.5 * inner[:, None] * (np.random.default_rng(1).random(places.shape) - 0.5)
points[:, 0] += 0.1 * T * np.sin(points[:, 1])
if "curved" in KIND:
    points[:, 2] = 0.1 * (points[:, 0] - N / 2) ** 2
owner = divided(points[cells].mean(axis=1), "slabs" if "lacking" in KIND else "random", RANKS)
if "last" in KIND:
    owner[:] = RANKS - 1


def block(k):
    grid = piece(points + [k * 2.0 * N, 0, 0], cells, owner == RANK)
    count = grid.GetNumberOfPoints()
    if count:
        add_array(grid.GetPointData(), "number", np.array(grid.GetPointData().GetArray("place")) + k * len(points))
        add_array(grid.GetCellData(), "count", np.array(grid.GetCellData().GetArray("cell")) + k * len(cells))
        add_array(grid.GetPointData(), "size", np.full(count, 0.1))
    if count and not ("lacking" in KIND and LAST and k == {blocks} - 1):
        add_array(grid.GetPointData(), "stay", np.zeros(count))
    if D == 2:
        surface = vtkPolyData()
        if count:
            surface.SetPoints(grid.GetPoints())
            surface.SetPolys(grid.GetCells())
            surface.GetPointData().ShallowCopy(grid.GetPointData())
            surface.GetCellData().ShallowCopy(grid.GetCellData())
        return surface
    return grid


made = block(0)
if output.IsA("vtkMultiBlockDataSet"):
    made = vtkMultiBlockDataSet()
    for k in range({blocks}):
        made.SetBlock(k, block(k))
elif output.IsA("vtkPartitionedDataSetCollection"):
    made = vtkPartitionedDataSetCollection()
    for k in range({blocks}):
        made.SetPartition(k, 0, block(k))
output.VTKObject.ShallowCopy(made)
"""
GRID, SURFACE = "vtkUnstructuredGrid", "vtkPolyData"
BLOCKS, COLLECTION = "vtkMultiblockDataSet", "vtkPartitionedDataSetCollection"
STEPS = 3


def mesh(type_: str, kind: str = "", dimension: int = 3, time: int = 0, blocks: int = 2):
    script = PIECES.format(kind=kind, dimension=dimension, time=time, blocks=blocks)
    return update(simple.ProgrammableSource(OutputDataSetType=type_, Script=script))


def write() -> None:
    # (Debian 12's libexpat does not read raw bytes in XML.)
    def to_file(name: str, proxy) -> None:
        simple.SaveData(str(FOLDER / name), proxy=proxy, DataMode="Binary")

    to_file("blocks.vtm", mesh(BLOCKS))
    to_file("collection.vtpc", mesh(COLLECTION))
    to_file("flat.pvtp", mesh(SURFACE, dimension=2))
    to_file("curved.pvtp", mesh(SURFACE, "curved", dimension=2))
    for step in range(STEPS):
        to_file(f"series_{step}.pvtu", mesh(GRID, time=step))


def values(filter_, name: str, time=None) -> list:
    """An array in the order of the whole mesh, of which copies of a point are the same."""
    whole = simple.MergeBlocks(filter_, MergePoints=0) if composite(filter_) else filter_
    simple.ProgrammableFilter(whole, Script=DUMP.format(file=FILE)).UpdatePipeline(time)
    found: dict = {}
    for rank in range(RANKS):
        arrays = np.load(f"{FILE}.{rank}.npz")
        if len(arrays["points"]):
            key = "number" if len(arrays[name]) == len(arrays["points"]) else "count"
            for number, value in zip(arrays[key].tolist(), arrays[name].tolist()):
                assert found.setdefault(number, value) == value, (name, number, value, found[number])
    return [value for _, value in builtins.sorted(found.items())]


def composite(filter_) -> bool:
    return filter_.GetDataInformation().GetCompositeDataSetType() != -1


def read(name: str) -> None:
    source = update(simple.OpenDataFile(str(FOLDER / name)))
    rough = update(PerturbMesh(source, Percentage=100, Fraction=0.6))
    tangled = update(PerturbMesh(source, TangledFraction=0.03))
    for case, filter_, array in (
        ("quality", ElementQuality(source, Metrics=["Inverse mean ratio"]), "imr"),
        ("perturbed", rough, "points"),
        ("tangled", tangled, "points"),
        ("optimized", OptimizeMesh(rough, ReproducibleOrder=int(name == "flat.pvtp")), "points"),
        ("sliding", OptimizeMesh(source, Boundary="Slide on flat parts"), "points"),
        ("worst", OptimizeMesh(rough, Preset="Worst element", MaximumIterations=5), "points"),
        ("untangled", UntangleMesh(tangled, ReproducibleOrder=int(name == "flat.pvtp")), "points"),
        ("compared", CompareMeshes(Input=source, Other=rough), "Change"),
        ("warped", WarpMesh(source, TransformKind="Rotation", Angle=8, OwnCenter=0, Method="FEMWARP",
                            AutomaticSolver=0), "points"),
    ):  # fmt: skip
        if name == "flat.pvtp" and case in ("sliding", "worst") or name == "curved.pvtp" and case == "warped":
            continue  # in an order of its own on one process; not possible
        results[f"{name} {case}"] = values(update(filter_), array)
        results[f"{name} {case} summary"] = filter_.Summary
    if name.endswith(".pvtp"):
        return  # the order of the points, which is another one on ranks, has an effect on Improve Mesh
    improved = update(ImproveMesh(rough, Preset="Aggressive"))
    results[f"{name} improved"] = [improved.GetDataInformation().GetNumberOfCells(), improved.WorstAfter]


def over_time() -> None:
    source = update(simple.OpenDataFile([str(FOLDER / f"series_{step}.pvtu") for step in range(STEPS)]))
    for case, filter_ in {
        "optimized": OptimizeMesh(source, ReproducibleOrder=1),
        "warped": WarpMesh(source, Motion="Time steps of the input", Method="FEMWARP", AutomaticSolver=0),
        "perturbed": PerturbMesh(source),
    }.items():
        for step in (0, STEPS - 1, 1):
            filter_.UpdatePipeline(step)
            results[f"series {case} {step}"] = values(filter_, "points", step)
    # The iterations as time steps, of blocks in partitions.
    played = OptimizeMesh(PerturbMesh(simple.OpenDataFile(str(FOLDER / "blocks.vtm"))), Animation=1)
    played.UpdatePipeline()
    results["steps"] = list(played.TimestepValues)
    played.UpdatePipelineInformation()
    results["steps afterwards"] = list(played.TimestepValues)
    for step in (0, 1, 3, 1000):
        played.UpdatePipeline(step)
        results[f"iteration {step}"] = values(played, "points", step)


def messages() -> None:
    """Items that some ranks lack, and names of the items that they have."""
    alone = ElementQuality(mesh(GRID, "last"), TargetType="Size from an array", SizeArray=["POINTS", "size"])
    results["size"] = values(update(alone), "imr")
    graded = update(ElementQuality(mesh(BLOCKS), Metrics=["Inverse mean ratio"]))
    results["names"] = graded.Summary
    worst = servermanager.Fetch(graded, idx=4).GetPointData()
    arrays = ((name, worst.GetArray(name)) for name in ("Process", "Block", "Partition", "Cell", "Value"))
    results["worst"] = {name: [array.GetTuple1(i) for i in range(array.GetNumberOfTuples())] for name, array in arrays}
    ids = simple.GenerateGlobalIds(mesh(GRID))
    results["global names"] = update(ElementQuality(ids)).Summary
    for type_, name in ((BLOCKS, "blocks"), (COLLECTION, "collection"), (GRID, "grid")):
        lacking = mesh(type_, "lacking", blocks=1 if type_ == GRID else 2)
        for filter_ in (OptimizeMesh(lacking), PerturbMesh(lacking), ImproveMesh(lacking)):
            filter_.FixedPoints = ["POINTS", "stay"]
            results[f"lacking {name} {filter_.GetXMLName()}"] = update(filter_).GetDataInformation().GetNumberOfCells()


if len(sys.argv) > 3:
    write()
else:
    for file in ("blocks.vtm", "collection.vtpc", "flat.pvtp", "curved.pvtp"):
        read(file)
    over_time()
    messages()
with open(FILE, "w", encoding="utf-8") as out:
    json.dump(results, out)
