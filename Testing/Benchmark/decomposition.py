# SPDX-License-Identifier: BSD-3-Clause
"""decomposition.py [--cells N] [--parts 2,4,...] [--graph 2,32]: halos and messages of divisions of a large mesh.

Divides a cube of tetrahedra by a k-d tree and by PT-Scotch and counts what ranks with these parts send in a sweep of
Optimize Mesh, without ranks (vtkMeshDecomposition): the largest and the mean halo, neighbors, messages and bytes of a
part, and the points that move one after the other. The study `decomposition` does so for smaller meshes, with a model.
Prints a table. Needs about 560 bytes per cell with a k-d tree.
"""

import argparse
import itertools
import time
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_TETRA, vtkCellArray, vtkUnstructuredGrid

from tautline.studies.decomposition import counted_once

JITTER = 0.25  # of an edge
ROW = (
    "| {method} | {parts:,} | {cells:,.0f} | {halo:,} | {mean:,.0f} | {share:.3f} | {neighbors} | {messages:,} "
    "| {kb:,.0f} | {waiting:.1f} | {seconds:.0f} |"
)


def cube(cells: int) -> vtkUnstructuredGrid:
    """n^3 cubes of 6 tetrahedra each, with shifted points inside."""
    n = max(2, round((cells / 6) ** (1 / 3)))
    side = n + 1
    place = np.stack([axis.ravel() for axis in np.meshgrid(*[np.arange(side)] * 3, indexing="ij")], -1)
    inner = ((place > 0) & (place < n)).all(axis=1)
    x = place + JITTER * inner[:, None] * (np.random.default_rng(1).random(place.shape) - 0.5)
    corner = np.arange(n**3, dtype=np.int64)
    first = corner // (n * n) * side * side + corner // n % n * side + corner % n
    made = np.empty((6, n**3, 4), dtype=np.int64)
    for k, order in enumerate(itertools.permutations(range(3))):
        nodes = list(itertools.accumulate(((side * side, side, 1)[a] for a in order), initial=0))
        if np.linalg.det(np.eye(3)[list(order)]) < 0:
            nodes[1], nodes[2] = nodes[2], nodes[1]
        for place_in_cell, node in enumerate(nodes):
            made[k, :, place_in_cell] = first + node
    grid, points, array = vtkUnstructuredGrid(), vtkPoints(), vtkCellArray()
    points.SetData(numpy_to_vtk(x, deep=True))
    array.SetData(numpy_to_vtkIdTypeArray(np.arange(0, made.size + 1, 4, dtype=np.int64), deep=True),
                  numpy_to_vtkIdTypeArray(made.ravel(), deep=True))  # fmt: skip
    grid.SetPoints(points)
    grid.SetCells(VTK_TETRA, array)
    return grid


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cells", type=int, default=10_000_000)
    parser.add_argument("--parts", default="2,4,8,16,32,64,128,256,512,1024")
    parser.add_argument("--graph", default="2,32,1024", help="parts by PT-Scotch, which takes longer")
    options = parser.parse_args()
    mesh = cube(options.cells)
    print(f"{mesh.GetNumberOfCells():,} tetrahedra, {mesh.GetNumberOfPoints():,} points\n")
    print("| division | parts | cells of a part | largest halo | mean halo | over cells^(2/3) | neighbors | messages "
          "| kB | waiting % | CPU s |")  # fmt: skip
    print("|---" * 11 + "|", flush=True)
    for method, given in (("k-d tree", options.parts), ("graph", options.graph)):
        for parts in (int(n) for n in given.split(",") if n):
            began = time.process_time()
            d = counted_once(mesh, method, parts)
            each = d.cells / parts
            print(ROW.format(method=method, parts=parts, cells=each, halo=d.halo, mean=d.mean_halo,
                             share=d.mean_halo / each ** (2 / 3), neighbors=d.neighbors, messages=d.messages,
                             kb=d.bytes / 1000, waiting=100 * (d.slowest * parts / d.free - 1),
                             seconds=time.process_time() - began), flush=True)  # fmt: skip
    lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
    print("\n" + next(line for line in lines if line.startswith("VmHWM")))


if __name__ == "__main__":
    main()
