# SPDX-License-Identifier: BSD-3-Clause
"""Preset adapt of improve on twenty meshes with tags, interfaces and one flat element: regions keep their volumes, and
facets of each tag their area."""

import numpy as np
import tautline as tl
from checks import rejected, run_tests, wording
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList, vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_TETRA, VTK_TRIANGLE, vtkUnstructuredGrid

FACES = ((1, 2, 3), (0, 3, 2), (3, 0, 1), (2, 1, 0))
PATHS = ((1, 3), (3, 2), (2, 6), (6, 4), (4, 5), (5, 1))  # of a cube from corner 0 to 7: six tetrahedra
REGIONS = (
    lambda x: int(x[2] > 0.5),
    lambda x: int(x[0] > 0.5),
    lambda x: int(x[0] > 0.5) + 2 * int(x[1] > 0.5),
    lambda x: int(np.all((x > 0.25) & (x < 0.75))),
    lambda x: int(4 * x[2]),
)


def side_tag(corners: np.ndarray) -> int:
    """The number of the half of a side of the unit cube that a facet is on."""
    for axis in range(3):
        for side in (0, 1):
            if np.all(corners[:, axis] == side):
                return 100 + 4 * axis + 2 * side + int(corners[:, (axis + 1) % 3].mean() > 0.5)
    raise ValueError("a facet inside")


def tagged_cube(n: int, region, seed: int) -> vtkUnstructuredGrid:
    """The unit cube with n x n x n x 6 tetrahedra, inner points moved, and one flat tetrahedron on the side z = 1."""
    ticks = np.linspace(0, 1, n + 1)
    points = np.array([(x, y, z) for z in ticks for y in ticks for x in ticks])

    def number(i: int, j: int, k: int) -> int:
        return i + (n + 1) * (j + (n + 1) * k)

    cells = []
    for i, j, k in np.ndindex(n, n, n):
        corner = [number(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)) for c in range(8)]
        cells += [[corner[0], corner[a], corner[b], corner[7]] for a, b in PATHS]
    regions = [region(points[cell].mean(axis=0)) for cell in cells]
    uses: dict[tuple, list[int]] = {}
    for index, cell in enumerate(cells):
        for face in FACES:
            uses.setdefault(tuple(sorted(cell[c] for c in face)), []).append(regions[index])
    facets = {face: side_tag(points[list(face)]) for face, found in uses.items() if len(found) == 1}
    between = {face: 200 + sum(found) for face, found in uses.items() if len(set(found)) == 2}
    held = {p for face in (*facets, *between) for p in face}
    random = np.random.default_rng(seed)
    for p in set(range(len(points))) - held:
        points[p] += 0.4 / n * (random.random(3) - 0.5)
    # The flat element covers a square; its facets outside have the other diagonal.
    square = [number(1, 1, n), number(2, 1, n), number(2, 2, n), number(1, 2, n)]
    under = [face for face in facets if set(face) <= set(square)]
    diagonal = set(under[0]) & set(under[1])
    tag = facets.pop(under[0])
    facets.pop(under[1])
    other = tuple(p for p in square if p not in diagonal)
    facets.update({(*other, p): tag for p in diagonal})
    cells.append(square)
    regions.append(region(points[square].mean(axis=0) - [0, 0, 1e-3]))
    grid, places = vtkUnstructuredGrid(), vtkPoints()
    places.SetData(numpy_to_vtk(points, deep=True))
    grid.SetPoints(places)
    for cell in cells:
        grid.InsertNextCell(VTK_TETRA, 4, cell)
    for face in (*facets, *between):
        grid.InsertNextCell(VTK_TRIANGLE, 3, face)
    tags = numpy_to_vtk(np.array([*regions, *facets.values(), *between.values()], dtype=np.int32), deep=True)
    tags.SetName("tag")
    grid.GetCellData().AddArray(tags)
    return grid


def sizes_of(mesh) -> dict[tuple[int, int], float]:
    """The volume of each region, and the area of the facets of each tag: by corners and tag."""
    places, tags = vtk_to_numpy(mesh.GetPoints().GetData()), vtk_to_numpy(mesh.GetCellData().GetArray("tag"))
    sums: dict[tuple[int, int], float] = {}
    ids = vtkIdList()
    for cell, tag in enumerate(tags):
        mesh.GetCellPoints(cell, ids)
        x = places[[ids.GetId(k) for k in range(ids.GetNumberOfIds())]]
        normal = np.cross(x[1] - x[0], x[2] - x[0])
        size = normal @ (x[3] - x[0]) / 6 if len(x) == 4 else np.linalg.norm(normal) / 2
        sums[len(x), int(tag)] = sums.get((len(x), int(tag)), 0.0) + abs(size)
    return sums


def lengths_for(mesh, kind: int):
    """Finer, coarser, fine at a plane in one direction, and a bit finer than the mesh."""
    if kind < 3:
        return (0.1, 0.3, 0.15)[kind]
    x = vtk_to_numpy(mesh.GetPoints().GetData())[:, 0]
    tensors = np.zeros((len(x), 6))
    tensors[:, 0] = (0.06 + 0.3 * np.abs(x - 0.3)) ** -2
    tensors[:, 1:3] = 0.25**-2
    return tensors


def check_tags(first: int):
    for number in range(first, first + 5):
        mesh = tagged_cube(4 + 4 * (number % 2), REGIONS[number % 5], number)
        before = sizes_of(mesh)
        result = tl.improve(mesh, "adapt", edge_length=lengths_for(mesh, number % 4), boundary="sliding")
        after = sizes_of(result.mesh)
        assert set(after) == set(before), (number, set(before) ^ set(after))
        worst = max(abs(after[key] - before[key]) for key in before)
        assert worst < 1e-12, (number, worst)
        assert result.edges_in_range > 0.75 and result.worst_in_metric < 2, (number, result.summary)
        assert result.edges_in_range > result.edges_in_range_before


def test_first():
    check_tags(0)


def test_second():
    check_tags(5)


def test_third():
    check_tags(10)


def test_last():
    check_tags(15)


def test_part():
    """Cells that are not to change stay, with their points."""
    mesh = tagged_cube(4, REGIONS[0], 1)

    def corners_of(grid) -> list[frozenset]:
        return [frozenset(grid.GetPoint(p) for p in cell_points(grid, c)) for c in range(grid.GetNumberOfCells())]

    cells = corners_of(mesh)
    changing = np.array([np.mean(list(cell), axis=0)[0] < 0.5 for cell in cells])
    result = tl.improve(mesh, "adapt", edge_length=0.12, boundary="sliding", changing_cells=changing)
    new = set(corners_of(result.mesh))
    kept = [cell for cell, changes in zip(cells, changing, strict=True) if not changes and len(cell) == 4]
    # The flat tetrahedron is gone, wherever it is.
    assert sum(cell not in new for cell in kept) <= 1
    assert result.elements > 2 * result.elements_before


def cell_points(mesh, cell: int) -> list[int]:
    ids = vtkIdList()
    mesh.GetCellPoints(cell, ids)
    return [ids.GetId(k) for k in range(ids.GetNumberOfIds())]


def test_errors():
    mesh = tagged_cube(2, REGIONS[0], 0)
    rejected(wording("preset-adapt-needs"), tl.improve, mesh, "adapt")
    rejected(wording("an-adaptation-to-about"), tl.improve, mesh, "adapt", edge_length=1e-6)


run_tests(globals())
