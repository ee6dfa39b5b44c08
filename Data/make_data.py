"""Makes the meshes of this directory again: python3 make_data.py [DIRECTORY]. Needs tautline and the program tetgen."""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import tautline as tl
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersCore import vtkDelaunay2D

SEED = 1
TANGLED = 0.005  # part of the elements

# --- bracket: an L of sheet metal with a fillet and three bolt holes, lengths in mm ---------------------
LENGTH, HEIGHT, WIDTH, THICK, FILLET = 60.0, 50.0, 40.0, 8.0, 8.0
BASE_HOLES = [((45.0, 10.0), 4.0), ((45.0, 30.0), 4.0)]  # centers (x, y) and radii, along z
UPRIGHT_HOLE = ((20.0, 33.0), 9.0)  # center (y, z) and radius, along x
ROUND, BEND = 24, 6  # edges of a circle and of the fillet
MAX_VOLUME, MAX_RATIO = 16.0, 1.4


class Surface:
    """Points and facets of a closed surface for tetgen."""

    def __init__(self) -> None:
        self.points: list[tuple[float, float, float]] = []
        self.facets: list[tuple[list[list[int]], list[tuple]]] = []

    def add(self, points) -> list[int]:
        self.points.extend(map(tuple, points))
        return list(range(len(self.points) - len(points), len(self.points)))

    def strip(self, first: list[int], second: list[int], skip=()) -> None:
        """Quadrilaterals between two closed loops of points, but for some edges."""
        n = len(first)
        for i in range(n):
            if i not in skip:
                self.facets.append(([[first[i], first[(i + 1) % n], second[(i + 1) % n], second[i]]], []))

    def poly(self) -> str:
        lines = [f"{len(self.points)} 3 0 0"]
        lines += [f"{i} {x:.9g} {y:.9g} {z:.9g}" for i, (x, y, z) in enumerate(self.points)]
        lines.append(f"{len(self.facets)} 0")
        for loops, holes in self.facets:
            lines.append(f"{len(loops)} {len(holes)}")
            lines += [" ".join(map(str, [len(loop), *loop])) for loop in loops]
            lines += [f"{i} {x:.9g} {y:.9g} {z:.9g}" for i, (x, y, z) in enumerate(holes, 1)]
        return "\n".join([*lines, "0", "0", ""])


def circle(center, radius) -> list[tuple[float, float]]:
    angles = np.arange(ROUND) * 2 * np.pi / ROUND
    return [(center[0] + radius * np.cos(a), center[1] + radius * np.sin(a)) for a in angles]


def bracket_surface() -> Surface:
    surface = Surface()
    middle = THICK + FILLET
    bend = [(middle - FILLET * np.sin(a), middle - FILLET * np.cos(a)) for a in np.linspace(0, np.pi / 2, BEND + 1)]
    profile = [(0, 0), (LENGTH, 0), (LENGTH, THICK), *bend, (THICK, HEIGHT), (0, HEIGHT)]
    front = surface.add([(x, 0.0, z) for x, z in profile])
    back = surface.add([(x, WIDTH, z) for x, z in profile])
    surface.facets += [([front], []), ([back], [])]
    bottom, top, inside, outside = 0, 2, len(profile) - 3, len(profile) - 1
    surface.strip(front, back, skip=(bottom, top, inside, outside))

    def pierced(edges, holes):
        """Two faces of the profile and the walls of the holes from one to the other."""
        rings = [[surface.add(ring(face)) for _, _, ring in holes] for face in range(2)]
        for face, edge in enumerate(edges):
            nxt = (edge + 1) % len(front)
            outer = [front[edge], front[nxt], back[nxt], back[edge]]
            surface.facets.append(([outer, *rings[face]], [center(face) for center, _, _ in holes]))
        for one, other in zip(*rings):
            surface.strip(one, other)

    levels = (0.0, THICK)
    pierced(
        (bottom, top),
        [
            (lambda f, c=c: (*c, levels[f]), r, lambda f, c=c, r=r: [(x, y, levels[f]) for x, y in circle(c, r)])
            for c, r in BASE_HOLES
        ],
    )
    c, r = UPRIGHT_HOLE
    hole = (lambda f: (levels[f], *c), r, lambda f: [(levels[f], y, z) for y, z in circle(c, r)])
    pierced((outside, inside), [hole])
    return surface


def tetrahedra(surface: Surface) -> tuple[np.ndarray, np.ndarray]:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "mesh.poly")
        path.write_text(surface.poly())
        subprocess.run(["tetgen", f"-pzQq{MAX_RATIO}a{MAX_VOLUME}", path], check=True)
        points, cells = (np.loadtxt(path.with_name(f"mesh.1.{end}"), skiprows=1) for end in ("node", "ele"))
    return points[:, 1:4], cells[:, 1:5].astype(int)


# --- plate: a sheet with a round hole, quadrilaterals around it, triangles beyond ------------------------
HALF_LENGTH, HALF_HEIGHT, HOLE, RIM, STEP = 5.0, 3.0, 1.0, 2.0, 0.26
AROUND, LAYERS = 48, 6


def plate() -> tuple[np.ndarray, dict[str, np.ndarray]]:
    angles = np.arange(AROUND) * 2 * np.pi / AROUND
    rings = [np.column_stack([r * np.cos(angles), r * np.sin(angles)]) for r in np.linspace(HOLE, RIM, LAYERS + 1)]
    number = np.arange(AROUND * (LAYERS + 1)).reshape(LAYERS + 1, AROUND)
    after = np.roll(number, -1, axis=1)
    quads = np.stack([number[:-1], number[1:], after[1:], after[:-1]], axis=-1).reshape(-1, 4)

    rows = round(2 * HALF_HEIGHT / (STEP * np.sqrt(3) / 2))
    columns = round(2 * HALF_LENGTH / STEP)
    outside = []
    for row in range(rows + 1):
        odd = row % 2 == 1
        x = np.linspace(-HALF_LENGTH, HALF_LENGTH, columns + 1)
        x = np.hstack([x[0], (x[1:] + x[:-1]) / 2, x[-1]]) if odd else x
        outside.append(np.column_stack([x, np.full(len(x), -HALF_HEIGHT + 2 * HALF_HEIGHT * row / rows)]))
    outside = np.vstack(outside)
    outside = outside[np.hypot(*outside.T) > RIM + 0.6 * STEP]

    points = np.vstack([*rings, outside])
    free = np.hstack([number[-1], np.arange(number.size, len(points))])
    sheet = vtkPolyData()
    sheet.SetPoints(vtkPoints())
    for x, y in points[free]:
        sheet.GetPoints().InsertNextPoint(x, y, 0)
    delaunay = vtkDelaunay2D()
    delaunay.SetInputData(sheet)
    delaunay.Update()
    polys = delaunay.GetOutput().GetPolys()
    triangles = free[vtk_to_numpy(polys.GetConnectivityArray()).reshape(-1, 3)]
    rim_only = (triangles <= number[-1, -1]).all(axis=1)  # those inside the rim
    triangles = triangles[~rim_only]
    (ax, ay), (bx, by) = ((points[triangles[:, k]] - points[triangles[:, 0]]).T for k in (1, 2))
    clockwise = ax * by < ay * bx  # vtkDelaunay2D leaves a few so
    triangles[clockwise] = triangles[clockwise][:, ::-1]
    return points, {"quadrilateral": quads, "triangle": triangles}


def make(name: str, mesh, folder: Path, tangle: float = 0.0) -> None:
    smooth = tl.quality(mesh, reversed_mesh="flip output")
    worse = tl.perturb(smooth.mesh, fraction=0.9, percentage=50, seed=SEED, tangle=tangle)
    for array in ("imr", "Validity"):
        worse.mesh.GetCellData().RemoveArray(array)
    worse.mesh.GetPointData().RemoveArray("Displacement")
    file = folder / name
    tl.write(worse, file)
    print(f"{file}: {worse.mesh.GetNumberOfPoints()} points, {file.stat().st_size} bytes\n{tl.quality(file).summary}")


# --- elbow: the case of OpenFOAM beside this file, with internal points moved at random until checkMesh fails ---
MOVED, DIGITS = 0.2, 6  # largest displacement along each axis; digits after the point


def failing_case(folder: Path) -> None:
    """A copy of the case; of its mesh, only the points differ."""
    source = Path(__file__).resolve().parent / "elbow"
    mesh = tl.read(source / "elbow.foam")
    patches = vtk_to_numpy(mesh.GetCellData().GetArray("Patch"))
    corners = vtkIdList()
    inside = np.ones(len(mesh.points), bool)
    for face in np.flatnonzero(patches >= 0):
        mesh.GetCellPoints(face, corners)
        inside[[corners.GetId(i) for i in range(corners.GetNumberOfIds())]] = False
    moves = np.random.RandomState(SEED).uniform(-MOVED, MOVED, mesh.points.shape)
    mesh.points[inside] = (mesh.points + moves).round(DIGITS)[inside]
    file = folder / "elbow-failing.foam"
    folder.mkdir()
    tl.write(mesh, file)
    print(f"{file}:\n{tl.quality(file, criteria='openfoam').summary}")


if __name__ == "__main__":
    target = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent
    bracket = tetrahedra(bracket_surface())
    make("bracket.vtu", bracket, target)
    make("bracket-tangled.vtu", bracket, target, TANGLED)
    make("plate.vtu", plate(), target)
    failing_case(target / "elbow-failing")
