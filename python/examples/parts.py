# SPDX-License-Identifier: BSD-3-Clause
"""Parts for the examples, from formulas: a wing, a blade, a vessel, a terrain, a corner and a channel."""

import numpy as np
import tautline as tl


def wing_section(points: int = 60, thickness: float = 0.12) -> np.ndarray:
    """The outline of a symmetric NACA section with chord 1, points x 2, counter-clockwise from the trailing edge."""
    angle = np.linspace(0, np.pi, points // 2 + 1)
    x = (1 + np.cos(angle)) / 2
    root = 0.2969 * np.sqrt(x) - 0.126 * x - 0.3516 * x**2 + 0.2843 * x**3 - 0.1036 * x**4
    upper = np.column_stack([x, 5 * thickness * root])
    return np.vstack([upper, (upper * [1, -1])[-2:0:-1]])


def closed_lines(*outlines: np.ndarray):
    """Closed polygons as one mesh of polylines, for triangle_mesh()."""
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

    points, cells = vtkPoints(), vtkCellArray()
    points.SetDataTypeToDouble()
    for outline in outlines:
        ids = [points.InsertNextPoint(x, y, 0) for x, y in outline]
        cells.InsertNextCell(len(ids) + 1)
        for i in [*ids, ids[0]]:
            cells.InsertCellPoint(i)
    lines = vtkPolyData()
    lines.SetPoints(points)
    lines.SetLines(cells)
    return lines


def flow_around_wing():
    """Triangles around a wing section in a channel of 4 x 2, and the outline of the section."""
    section = wing_section() + [-0.5, 0]
    channel = np.array([[-1.5, -1], [2.5, -1], [2.5, 1], [-1.5, 1]], float)
    return tl.triangle_mesh(closed_lines(channel, section), size=0.15, minimum_angle=20).mesh, section


def block(shape: tuple[int, int, int], place) -> tuple[np.ndarray, np.ndarray]:
    """Hexahedra of a grid with these numbers of cells; place maps its coordinates, n x 3 from 0 to 1, to points."""
    counts = [n + 1 for n in shape]
    grid = np.stack(np.meshgrid(*(np.linspace(0, 1, n) for n in counts), indexing="ij"), axis=-1).reshape(-1, 3)
    number = np.arange(len(grid)).reshape(counts)
    low, high = slice(None, -1), slice(1, None)
    corners = [(low, low, low), (high, low, low), (high, high, low), (low, high, low)]
    corners += [(i, j, high) for i, j, _ in corners]
    cells = np.stack([number[corner] for corner in corners], axis=-1).reshape(-1, 8)
    return place(grid), cells


def turbine_blade(twist: float = 45.0, shape: tuple[int, int, int] = (24, 4, 30)) -> tuple[np.ndarray, np.ndarray]:
    """Hexahedra in a twisted and tapered blade with the section of a wing."""

    def place(grid: np.ndarray) -> np.ndarray:
        along = 0.03 + 0.94 * grid[:, 0]
        half = 0.2969 * np.sqrt(along) - 0.126 * along - 0.3516 * along**2 + 0.2843 * along**3 - 0.1015 * along**4
        chord = 1 - 0.4 * grid[:, 2]
        x, y = (along - 0.5) * chord, (2 * grid[:, 1] - 1) * (0.6 * half + 0.01) * chord
        angle = np.radians(twist) * grid[:, 2]
        turned = [x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)]
        return np.column_stack([*turned, 3 * grid[:, 2]])

    return block(shape, place)


def vessel(radius: float = 0.3, around: int = 16, along: int = 40):
    """Tetrahedra in a bent tube, such as an artery, of length pi and the given radius."""
    turn = 2 * np.pi * np.arange(around) / around
    centre = np.linspace(0, np.pi, along + 1)
    ring = 1 + radius * np.cos(turn)
    x, y = (np.outer(f(centre), ring).ravel() for f in (np.cos, np.sin))
    points = np.column_stack([x, y, np.tile(radius * np.sin(turn), along + 1)])
    ends = np.array([[1, 0, 0], [-1, 0, 0]], float)
    number = np.arange((along + 1) * around).reshape(along + 1, around)
    a, b = number[:-1], number[1:]
    sides = np.stack([a, b, np.roll(b, -1, axis=1), np.roll(a, -1, axis=1)], axis=-1).reshape(-1, 4)
    walls = np.vstack([sides[:, [0, 1, 2]], sides[:, [0, 2, 3]]])
    first, last = number[0], number[-1]
    caps = [np.column_stack([np.full(around, len(points)), first, np.roll(first, -1)]),
            np.column_stack([np.full(around, len(points) + 1), np.roll(last, -1), last])]  # fmt: skip
    return tl.tet_mesh((np.vstack([points, ends]), np.vstack([walls, *caps])), volume=0.002).mesh


def terrain(cells: int = 40) -> tuple[np.ndarray, np.ndarray]:
    """Triangles on hills, stretched where the slope is steep."""
    side = np.linspace(0, 4, cells + 1)
    x, y = (axis.ravel() for axis in np.meshgrid(side, side, indexing="ij"))
    z = 0.8 * np.exp(-2 * ((x - 1.2) ** 2 + (y - 1.5) ** 2)) + 0.6 * np.exp(-3 * ((x - 2.8) ** 2 + (y - 2.6) ** 2))
    z += 0.05 * np.sin(3 * x) * np.cos(4 * y)
    number = np.arange((cells + 1) ** 2).reshape(cells + 1, -1)
    a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
    triangles = np.vstack([np.stack(t, axis=-1).reshape(-1, 3) for t in ((a, b, c), (a, c, d))])
    return np.column_stack([x, y, z]), triangles


def corner(cells: int = 10):
    """Right triangles in a square of side 2 without its lower right quarter; the inner corner is at the origin."""
    at = np.linspace(-1, 1, 2 * (cells // 2) + 1)
    columns = len(at)
    first = (np.arange(columns - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    triangles = np.stack([first, first + 1, first + columns + 1, first, first + columns + 1, first + columns], axis=1)
    points = np.column_stack([each.ravel() for each in np.meshgrid(at, at)])
    triangles = triangles.reshape(-1, 3)
    middle = points[triangles].mean(axis=1)
    triangles = triangles[(middle[:, 0] < 0) | (middle[:, 1] > 0)]
    used = np.unique(triangles)
    return tl.from_arrays(points[used], {"triangle": np.searchsorted(used, triangles)})


def channel(cells: int = 8):
    """Tetrahedra in a box of 2 x 1 x 1, with the point array `wall`, which is 1 on the lower side."""
    points, hexahedra = block((2 * cells, cells, cells), lambda grid: grid * [2, 1, 1])
    paths = [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]
    made = tl.from_arrays(points, {"tetrahedron": np.concatenate([hexahedra[:, path] for path in paths])})
    made.point_data["wall"] = (points[:, 2] == 0).astype(int)
    return made
