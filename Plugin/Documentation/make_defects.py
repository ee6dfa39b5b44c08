# SPDX-License-Identifier: BSD-3-Clause
"""make_defects.py [--write] [NAME...]: the pictures NAME.png of defects, and the numbers of Plugin/Site/good-enough.md.

Each defect is a small mesh, which is measured, repaired by the filter that the page names, and measured again. The row
of the page that shows good_enough_*.png has these numbers in bold, as **before to after**. Without an option, the
numbers of the page are compared with the measured ones, and the exit code is 1 if they differ; --write writes numbers
and pictures.
Needs the package tautline: eval "$(./run env)" first.
"""

import re
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

import numpy as np
import tautline as tl
from small_png import write

HERE = Path(__file__).resolve().parent
DATA = HERE.parents[1] / "Data"
PAGE = HERE.parent / "Site" / "good-enough.md"
NUMBERS = re.compile(r"\*\*(\S+ to \S+)\*\*")

SIZE, DPI = (3.2, 1.5), 120  # inches
INVERTED, BAD, GOOD, EDGE, PALE = (0.05, 0.35, 1.0), (0.72, 0.06, 0.11), (0.93,) * 3, (0.25,) * 3, (0.75,) * 3
LIGHT = np.array([0.3, -0.5, 0.8])  # direction to the light
VIEW = np.array([[0.9, 0.42, 0.0], [-0.15, 0.3, 0.94]])  # right and up of pictures of volumes
DEPTH = np.cross(VIEW[0], VIEW[1])
FACES = {
    "tetrahedron": [(0, 1, 2), (0, 1, 3), (1, 2, 3), (0, 2, 3)],
    "hexahedron": [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)],
}


# --- the meshes -----------------------------------------------------------------------------------------------------


def rings(center=(0.0, 0.0)):
    """Points and triangles of two rings of triangles about a point, which may be moved."""
    lattice = [(q, r) for q in range(-2, 3) for r in range(-2, 3) if abs(q + r) <= 2]
    number = {place: i for i, place in enumerate(lattice)}
    points = np.array([(q + r / 2, r * 0.75**0.5) for q, r in lattice])
    points[number[0, 0]] = center
    corners = [((q, r), (q + 1, r), (q, r + 1)) for q in range(-2, 2) for r in range(-2, 2)]
    corners += [((q + 1, r), (q + 1, r + 1), (q, r + 1)) for q in range(-3, 2) for r in range(-2, 2)]
    return points, [[number[place] for place in three] for three in corners if all(place in number for place in three)]


def inverted():
    return tl.from_arrays(*rings((1.4, 0.1)))


def needle():
    """The edge between two points is divided near one of them."""
    points, triangles = rings()
    first, second = (int(np.argmin(np.abs(points - place).sum(axis=1))) for place in ((0, 0), (1, 0)))
    new = len(points)
    points = np.vstack([points, (0.06, 0)])
    cells = []
    for three in triangles:
        if {first, second} <= set(three):
            cells += [[new if i == old else i for i in three] for old in (first, second)]
        else:
            cells.append(three)
    return tl.from_arrays(points, cells)


def cap():
    """A point in a triangle, near one of its edges."""
    points, triangles = rings()
    corners = [int(np.argmin(np.abs(points - place).sum(axis=1))) for place in ((0, 0), (1, 0), (0.5, 0.75**0.5))]
    new = len(points)
    points = np.vstack([points, (0.5, 0.04)])
    cells = [three for three in triangles if set(three) != set(corners)]
    cells += [[corners[i], corners[(i + 1) % 3], new] for i in range(3)]
    return tl.from_arrays(points, cells)


def grid(*counts):
    """Points and quadrilaterals or hexahedra of a block of unit cells."""
    axes = np.meshgrid(*(np.arange(count + 1.0) for count in counts), indexing="ij")
    points = np.stack([axis.ravel() for axis in axes], axis=1)
    number = np.arange(len(points)).reshape([count + 1 for count in counts])
    steps = [(0, 0), (1, 0), (1, 1), (0, 1)]
    if len(counts) == 3:
        steps = [(*step, up) for up in (0, 1) for step in steps]
    cells = [[number[tuple(np.add(first, step))] for step in steps] for first in np.ndindex(*counts)]
    return points, cells


def warped_face():
    points, cells = grid(2, 2, 2)
    points[(points == 1).all(axis=1)] += (0.45, 0.6, -0.62)
    return tl.from_arrays(points, {"hexahedron": cells})


def skewed():
    """The points inside are moved, in opposite directions in two layers."""
    points, cells = grid(3, 3, 3)
    inside = ((points > 0) & (points < 3)).all(axis=1)
    side = np.where(points[inside, 2] == 1, -1, 1)
    points[inside, :2] += np.outer(side, (0.6, 0.3))
    return tl.from_arrays(points, {"hexahedron": cells})


def non_orthogonal():
    """One layer of cells, as in a case of OpenFOAM in 2D."""
    points, cells = grid(6, 4, 1)
    inside = (points[:, 0] > 0) & (points[:, 0] < 6) & (points[:, 1] > 0) & (points[:, 1] < 4)
    points[inside, 0] += (points[inside, 1] - 2) * 0.8
    points[inside, 1] += np.where(points[inside, 0] > 3, 0.15, -0.15)
    points[:, 1] *= 0.4
    return tl.from_arrays(points, {"hexahedron": cells})


def size_jump():
    points, cells = grid(7, 3)
    points[:, 0] = np.array([0, 0.15, 0.3, 0.45, 0.6, 2.6, 4.6, 6.6])[points[:, 0].astype(int)]
    return tl.from_arrays(points, {"quad": cells})


#: How far the middle nodes of two edges from the center are moved.
BENT = {(0, 1): (-0.19, -0.05), (0, 2): (0.23, -0.28)}


def curved():
    """Six quadratic triangles about a point; the edges from it are bent."""
    angles = np.arange(6) * np.pi / 3
    points = [(0, 0), *zip(np.cos(angles), np.sin(angles))]
    cells = []
    middle = {}
    for i in range(6):
        corners = [0, 1 + i, 1 + (i + 1) % 6]
        nodes = []
        for a, b in zip(corners, corners[1:] + corners[:1]):
            key = (min(a, b), max(a, b))
            if key not in middle:
                middle[key] = len(points)
                points.append(tuple((np.array(points[a]) + points[b]) / 2))
            nodes.append(middle[key])
        cells.append(corners + nodes)
    points = np.array(points)
    for (a, b), (x, y) in BENT.items():
        points[middle[a, b]] += (x, y)
    return tl.from_arrays(points, {"triangle6": cells})


def node_outside():
    """The deck of negative-volume.md: a tetrahedron, divided at a node that lies outside."""
    points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (0.6, 0.6, 0.6)]
    cells = [(0, 1, 2, 4), (0, 3, 1, 4), (0, 2, 3, 4), (1, 3, 2, 4)]
    return tl.from_arrays(points, {"tetrahedron": cells})


# --- the drawings ---------------------------------------------------------------------------------------------------


def cells_of(mesh):
    """Name of the type and points of each cell, in the order of the mesh."""
    found = [(name, list(cell)) for name, cells in mesh.cells.items() for cell in cells]
    assert len(mesh.cells) == 1, "the order of cells of several types differs from the mesh"
    return found


def outline(points, cell, steps=12):
    """The polygon of a cell of the plane; edges of quadratic triangles as curves."""
    if len(cell) != 6:
        return points[cell]
    t = np.linspace(0, 1, steps, endpoint=False)[:, None]
    shapes = [(1 - t) * (1 - 2 * t), t * (2 * t - 1), 4 * t * (1 - t)]
    edges = [(0, 1, 3), (1, 2, 4), (2, 0, 5)]
    return np.vstack([sum(shape * points[cell[k]] for shape, k in zip(shapes, edge)) for edge in edges])


def draw_plane(axes, mesh, bad, invalid):
    from matplotlib.collections import PolyCollection  # needed for the pictures alone

    points = np.asarray(mesh.points)[:, :2]
    cells = [cell[:4] if kind == "hexahedron" else cell for kind, cell in cells_of(mesh)]
    for color, chosen in ((GOOD, ~(bad | invalid)), (BAD, bad & ~invalid), (INVERTED, invalid)):
        polygons = [outline(points, cells[i]) for i in np.flatnonzero(chosen)]
        axes.add_collection(PolyCollection(polygons, facecolors=[color], edgecolors=[EDGE], linewidths=0.7))
    used = np.vstack([outline(points, cell) for cell in cells])
    return used.min(axis=0), used.max(axis=0)


def draw_volume(axes, mesh, worst, color, whole=False):
    """A cell, filled, with the edges of the cells around it; returns the corners of its box, or of the whole mesh."""
    from matplotlib.collections import LineCollection, PolyCollection

    points, cells = np.asarray(mesh.points), cells_of(mesh)
    kind, shown = cells[worst]
    flat = points @ VIEW.T
    around = [cell for name, cell in cells if name == kind and set(cell) & set(shown)]
    edges = {tuple(sorted((cell[f[i - 1]], cell[f[i]]))) for cell in around for f in FACES[kind] for i in range(len(f))}
    own = {tuple(sorted((shown[f[i - 1]], shown[f[i]]))) for f in FACES[kind] for i in range(len(f))}
    near = flat if whole else flat[shown]
    if len(shown) == 4:  # only edges at the cell: those around it would hide it
        edges = {edge for edge in edges if set(edge) & set(shown)}
    axes.add_collection(LineCollection([flat[list(edge)] for edge in edges - own], colors=[PALE], linewidths=0.5))
    faces = sorted((points[[shown[k] for k in face]] for face in FACES[kind]), key=lambda face: (face @ DEPTH).mean())
    for face in faces:
        fan = [face[[0, k, k + 1]] for k in range(1, len(face) - 1)]
        normal = sum(np.cross(three[1] - three[0], three[2] - three[0]) for three in fan)
        bright = 0.75 + 0.25 * abs(normal @ LIGHT) / (np.linalg.norm(normal) * np.linalg.norm(LIGHT) + 1e-300)
        shade = (*(bright * np.array(color)), 0.8)
        axes.add_collection(PolyCollection([face @ VIEW.T], facecolors=[shade], edgecolors=[EDGE], linewidths=0.9))
    low, high = near.min(axis=0), near.max(axis=0)
    middle, half = (low + high) / 2, (high - low).max() * (0.55 if whole else 0.75)
    return middle - half, middle + half


def frame(axes, low, high):
    width, height = np.maximum(high - low, 1e-9)
    ratio = (SIZE[0] / 2) / SIZE[1]
    half = max(width / 2, height / 2 * ratio) * 1.04
    x, y = (low + high) / 2
    axes.set_xlim(x - half, x + half)
    axes.set_ylim(y - half / ratio, y + half / ratio)
    axes.set_axis_off()


@dataclass
class Defect:
    """A mesh, the metric that shows its defect, and the repair."""

    name: str
    mesh: Callable
    metric: str
    repair: Callable
    limit: float  # cells beyond it are drawn as bad
    larger_is_better: bool = False
    digits: int = 3
    counts: bool = False  # the number of invalid cells is stated, not the worst value
    layer: bool = False  # one layer of hexahedra, drawn as their first faces
    focus: tuple = ()  # the corners of the part of a plane mesh that is drawn
    whole: bool = False  # a small mesh of volumes is drawn as a whole

    def measured(self, mesh):
        found = tl.quality(mesh, self.metric)
        values = np.asarray(found.values[self.metric])
        worst = values.min() if self.larger_is_better else values.max()
        bad = values < self.limit if self.larger_is_better else values > self.limit
        return found, (str(found.inverted) if self.counts else f"{worst:.{self.digits}g}"), bad

    def numbers(self):
        """The two numbers before and after the repair as a text."""
        mesh = self.mesh()
        return f"{self.measured(mesh)[1]} to {self.measured(self.repair(mesh))[1]}"

    def draw(self, axes, mesh, shown=None):
        """Draws a plane mesh, or a cell of a volume mesh, by default the worst one; returns the cell."""
        found, _, bad = self.measured(mesh)
        invalid = np.asarray(found.cell_data["Validity"]) < 1
        if cells_of(mesh)[0][0] in FACES and not self.layer:
            values = np.asarray(found.values[self.metric])
            worst = int(values.argmin() if self.larger_is_better else values.argmax())
            shown = worst if shown is None else shown
            color = INVERTED if invalid[shown] else BAD if bad[shown] else GOOD
            frame(axes, *draw_volume(axes, mesh, shown, color, self.whole))
        else:
            box = draw_plane(axes, mesh, bad, invalid)
            frame(axes, *(np.array(self.focus) if self.focus else box))
        return shown

    def picture(self):
        """The image of the mesh before and after the repair."""
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        figure = Figure(figsize=SIZE, dpi=DPI, facecolor="white")
        mesh = self.mesh()
        cell = self.draw(figure.add_axes((0, 0, 0.47, 1)), mesh)
        self.draw(figure.add_axes((0.53, 0, 0.47, 1)), self.repair(mesh), cell if self.whole else None)
        figure.text(0.5, 0.5, "\u2192", ha="center", va="center", fontsize=14, color=EDGE)
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
        return np.asarray(canvas.buffer_rgba())[..., :3]


def on_flat_parts(preset):
    return lambda mesh: tl.optimize(mesh, preset, boundary="slide on flat parts")


UP = {"larger_is_better": True}
DEFECTS = [
    Defect("good_enough_inverted", inverted, "imr", tl.untangle, 3, counts=True),
    Defect("good_enough_sliver", lambda: tl.read(DATA / "bracket.vtu"), "min_angle",
           lambda mesh: tl.improve(mesh, "aggressive"), 15, **UP),
    Defect("good_enough_needle", needle, "min_angle", tl.improve, 20, focus=((-0.6, -0.95), (1.1, 0.95)), **UP),
    Defect("good_enough_cap", cap, "max_angle", tl.improve, 120, focus=((-0.3, -0.95), (1.3, 0.95))),
    Defect("good_enough_warped", warped_face, "face_flatness", tl.optimize, 0.9, **UP),
    Defect("good_enough_skewed", skewed, "scaled_jacobian", tl.optimize, 0.3, digits=2, **UP),
    Defect("good_enough_non_orthogonal", non_orthogonal, "non_orthogonality", on_flat_parts("finite volumes"), 65,
           layer=True),
    Defect("good_enough_size_jump", size_jump, "volume_ratio", on_flat_parts("uniform size"), 0.2, digits=2, **UP),
    Defect("good_enough_curved", curved, "min_jacobian", lambda mesh: tl.optimize(tl.untangle(mesh)), 0, counts=True,
           **UP),
    Defect("negative_volume", node_outside, "min_jacobian", tl.untangle, 0, counts=True, whole=True, **UP),
]  # fmt: skip


def main(write_all: bool, names: list) -> int:
    lines = PAGE.read_text(encoding="utf-8").split("\n") if PAGE.exists() else []
    wrong = [f"there is no defect {name}" for name in names if name not in {defect.name for defect in DEFECTS}]
    for defect in DEFECTS:
        if names and defect.name not in names:
            continue
        picture = f"{defect.name}.png"
        numbers = defect.numbers()
        rows = [i for i, line in enumerate(lines) if picture in line]
        print(f"{defect.name}: {defect.metric} {numbers}")
        if not defect.name.startswith("good_enough"):
            pass  # the picture of another page
        elif len(rows) != 1 or not NUMBERS.search(lines[rows[0]]):
            wrong.append(f"{PAGE.name} has no row of {picture} with numbers in bold")
        elif NUMBERS.search(lines[rows[0]])[1] != numbers:
            wrong.append(f"{PAGE.name} has other numbers in the row of {picture}: {numbers} measured")
            if write_all:
                lines[rows[0]] = NUMBERS.sub(f"**{numbers}**", lines[rows[0]], count=1)
        if write_all:
            write(defect.picture(), HERE / picture)
    if write_all:
        PAGE.write_text("\n".join(lines), encoding="utf-8")
        wrong = [problem for problem in wrong if "has other numbers" not in problem]  # written now
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main("--write" in sys.argv[1:], [name for name in sys.argv[1:] if not name.startswith("--")]))
