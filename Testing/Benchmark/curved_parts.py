# SPDX-License-Identifier: BSD-3-Clause
"""Parts with curved surfaces as CAD models of OpenCASCADE, coarsely meshed with curved elements by Gmsh.

Gmsh puts the nodes of its elements onto the true surface. Where elements are as large as the radius of a fillet or a
hole, curved edges then cross the element behind them, and determinants of Jacobians become negative: what this package
repairs. The optimizer of Gmsh for curved elements is switched off. Needs Gmsh's Python module (Debian: python3-gmsh).
"""

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import gmsh
import numpy as np

Point = tuple[float, float, float]
#: Name of a part -> function that makes its model.
PARTS: dict[str, Callable[[], None]] = {}


def part(make: Callable[[], None]) -> Callable[[], None]:
    """Enters a function into PARTS."""
    PARTS[make.__name__] = make
    return make


def cut(body: int, *tools: int) -> int:
    """The body without the tools."""
    return int(gmsh.model.occ.cut([(3, body)], [(3, tool) for tool in tools])[0][0][1])


def fuse(body: int, *others: int) -> int:
    """The union of bodies."""
    return int(gmsh.model.occ.fuse([(3, body)], [(3, other) for other in others])[0][0][1])


def cylinder(start: Point, axis: Point, radius: float) -> int:
    return int(gmsh.model.occ.addCylinder(*start, *axis, radius))


def box(corner: Point, size: Point) -> int:
    return int(gmsh.model.occ.addBox(*corner, *size))


def edges_where(wanted: Callable[[np.ndarray], bool]) -> list[int]:
    """The curves whose bounding boxes (smallest x, y, z, largest x, y, z) are given."""
    gmsh.model.occ.synchronize()
    return [tag for _, tag in gmsh.model.getEntities(1) if wanted(np.array(gmsh.model.getBoundingBox(1, tag)))]


def upright(bounds: np.ndarray) -> bool:
    """Whether a curve is parallel to the z axis."""
    size = bounds[3:] - bounds[:3]
    return bool(size[2] > 0.01 and max(size[0], size[1]) < 1e-4)


def fillet(body: int, radius: float, wanted: Callable[[np.ndarray], bool]) -> int:
    return int(gmsh.model.occ.fillet([body], edges_where(wanted), [radius])[0][1])


def swept(profile: int, wire: int) -> None:
    """The profile (a surface) along a wire."""
    gmsh.model.occ.addPipe([(2, profile)], wire)
    gmsh.model.occ.remove([(2, profile)])


def revolved(points: list[Point], angle: float = 2 * math.pi) -> None:
    """A polygon in the plane x z, turned around the z axis."""
    occ = gmsh.model.occ
    corners = [occ.addPoint(*point) for point in points]
    lines = [occ.addLine(a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]
    face = occ.addPlaneSurface([occ.addCurveLoop(lines)])
    occ.revolve([(2, face)], 0, 0, 0, 0, 0, 1, angle)


@part
def torus() -> None:
    gmsh.model.occ.addTorus(0, 0, 0, 1, 0.35)


@part
def torus_segment() -> None:
    gmsh.model.occ.addTorus(0, 0, 0, 1, 0.3, angle=1.3 * math.pi)


@part
def plate_with_fillets() -> None:
    plate = fillet(box((0, 0, 0), (3, 2, 0.4)), 0.4, upright)
    cut(plate, cylinder((0.8, 1, -1), (0, 0, 3), 0.3), cylinder((2.1, 1, -1), (0, 0, 3), 0.45))


@part
def block_with_holes() -> None:
    block = box((0, 0, 0), (2, 2, 2))
    cut(block, gmsh.model.occ.addSphere(1, 1, 1, 0.6), cylinder((0.4, 0.4, -1), (0, 0, 4), 0.2),
        cylinder((-1, 1.6, 0.4), (4, 0, 0), 0.25))  # fmt: skip


@part
def spherical_shell() -> None:
    cut(gmsh.model.occ.addSphere(0, 0, 0, 1), gmsh.model.occ.addSphere(0, 0, 0, 0.8))


@part
def dome() -> None:
    outer, inner = (gmsh.model.occ.addSphere(0, 0, 0, radius, angle1=0) for radius in (1, 0.85))
    cut(cut(outer, inner), cylinder((0, 0, 0), (0, 0, 2), 0.25))


@part
def pipe() -> None:
    cut(cylinder((0, 0, 0), (0, 0, 3), 1), cylinder((0, 0, -1), (0, 0, 5), 0.8))


@part
def elbow() -> None:
    occ = gmsh.model.occ
    outer, inner = (occ.addTorus(0, 0, 0, 1.5, radius, angle=math.pi / 2) for radius in (0.5, 0.38))
    cut(outer, inner)


@part
def tee() -> None:
    run, branch = cylinder((-2, 0, 0), (4, 0, 0), 0.6), cylinder((0, 0, 0), (0, 0, 1.6), 0.5)
    cut(fuse(run, branch), cylinder((-3, 0, 0), (6, 0, 0), 0.48), cylinder((0, 0, 0), (0, 0, 3), 0.4))


@part
def flange() -> None:
    body = fuse(cylinder((0, 0, 0), (0, 0, 0.3), 1.2), cylinder((0, 0, 0), (0, 0, 1), 0.6))
    bolts = [cylinder((0.9 * math.cos(a), 0.9 * math.sin(a), -1), (0, 0, 3), 0.13)
             for a in np.arange(6) * math.pi / 3]  # fmt: skip
    cut(body, cylinder((0, 0, -1), (0, 0, 3), 0.4), *bolts)


@part
def gear() -> None:
    teeth = [cylinder((math.cos(a), math.sin(a), 0), (0, 0, 0.4), 0.14) for a in np.arange(12) * math.pi / 6]
    cut(fuse(cylinder((0, 0, 0), (0, 0, 0.4), 1), *teeth), cylinder((0, 0, -1), (0, 0, 3), 0.4))


@part
def notched_disk() -> None:
    notches = [cylinder((math.cos(a), math.sin(a), -1), (0, 0, 3), 0.17) for a in np.arange(8) * math.pi / 4]
    cut(cylinder((0, 0, 0), (0, 0, 0.35), 1), cylinder((0, 0, -1), (0, 0, 3), 0.3), *notches)


@part
def bracket() -> None:
    body = fuse(box((0, 0, 0), (2, 1, 0.3)), box((0, 0, 0), (0.3, 1, 1.6)))
    body = fillet(body, 0.25, lambda b: abs(b[0] - 0.3) < 1e-3 and abs(b[3] - 0.3) < 1e-3
                  and abs(b[2] - 0.3) < 1e-3 and abs(b[5] - 0.3) < 1e-3)  # fmt: skip
    cut(body, cylinder((1.4, 0.5, -1), (0, 0, 3), 0.25), cylinder((-1, 0.5, 1.1), (3, 0, 0), 0.2))


@part
def connecting_rod() -> None:
    body = fuse(cylinder((0, 0, 0), (0, 0, 0.4), 0.6), cylinder((2.5, 0, 0), (0, 0, 0.4), 0.4),
                box((0, -0.2, 0.05), (2.5, 0.4, 0.3)))  # fmt: skip
    cut(body, cylinder((0, 0, -1), (0, 0, 3), 0.4), cylinder((2.5, 0, -1), (0, 0, 3), 0.22))


@part
def lug() -> None:
    body = fuse(box((-0.5, -1.2, 0), (1, 1.2, 0.4)), cylinder((0, 0, 0), (0, 0, 0.4), 0.5))
    cut(body, cylinder((0, 0, -1), (0, 0, 3), 0.3))


@part
def pulley() -> None:
    body = cut(cylinder((0, 0, 0), (0, 0, 0.6), 1), gmsh.model.occ.addTorus(0, 0, 0.3, 1.02, 0.22))
    cut(body, cylinder((0, 0, -1), (0, 0, 3), 0.35))


@part
def hollow_cone() -> None:
    revolved([(1, 0, 0), (1.15, 0, 0), (0.5, 0, 1.6), (0.38, 0, 1.6)])


@part
def spring() -> None:
    occ = gmsh.model.occ
    angles = np.linspace(0, 3 * math.pi, 25)
    points = [occ.addPoint(math.cos(a), math.sin(a), 0.09 * a) for a in angles]
    wire = occ.addWire([occ.addSpline(points)])
    disk = occ.addDisk(1, 0, 0, 0.2, 0.2)
    occ.rotate([(2, disk)], 1, 0, 0, 1, 0, 0, math.pi / 2)
    swept(disk, wire)


@part
def hook() -> None:
    bend = gmsh.model.occ.addTorus(0, 0, 0, 0.7, 0.22, angle=math.pi)
    fuse(bend, cylinder((0.7, 0, 0), (0, -1.2, 0), 0.22), gmsh.model.occ.addSphere(-0.7, 0, 0, 0.22))


@part
def rounded_box() -> None:
    body = fillet(box((0, 0, 0), (1.6, 1.2, 0.8)), 0.2, lambda _: True)
    cut(body, gmsh.model.occ.addSphere(0.8, 0.6, 0.8, 0.35))


@part
def crossed_cylinders() -> None:
    body = fuse(cylinder((-1.5, 0, 0), (3, 0, 0), 0.5), cylinder((0, -1.5, 0), (0, 3, 0), 0.45),
                cylinder((0, 0, -1.5), (0, 0, 3), 0.4))  # fmt: skip
    cut(body, gmsh.model.occ.addSphere(0, 0, 0, 0.35))


@part
def half_ring() -> None:
    revolved([(0.8, 0, 0), (1.1, 0, 0), (1.1, 0, 0.5), (0.8, 0, 0.5)], 1.1 * math.pi)


@part
def impeller() -> None:
    hub = fuse(cylinder((0, 0, 0), (0, 0, 0.8), 0.4), cylinder((0, 0, 0), (0, 0, 0.15), 1.1))
    blades = []
    for turn in np.arange(5) * 2 * math.pi / 5:
        arc = cut(cylinder((0.7, 0, 0.1), (0, 0, 0.5), 0.45), cylinder((0.7, 0, 0), (0, 0, 1), 0.33),
                  box((0, -1, 0), (2, 1, 1)))  # fmt: skip
        gmsh.model.occ.rotate([(3, arc)], 0, 0, 0, 0, 0, 1, turn)
        blades.append(arc)
    cut(fuse(hub, *blades), cylinder((0, 0, -1), (0, 0, 3), 0.2))


@part
def hollow_torus() -> None:
    cut(gmsh.model.occ.addTorus(0, 0, 0, 1.2, 0.45), gmsh.model.occ.addTorus(0, 0, 0, 1.2, 0.33))


@part
def eccentric_ring() -> None:
    cut(cylinder((0, 0, 0), (0, 0, 0.5), 1), cylinder((0.25, 0, -1), (0, 0, 3), 0.65))


@part
def perforated_plate() -> None:
    holes = [cylinder((0.5 + 0.8 * i, 0.5 + 0.8 * j, -1), (0, 0, 3), 0.33) for i in range(3) for j in range(2)]
    cut(box((0, 0, 0), (2.6, 1.8, 0.25)), *holes)


@part
def tank() -> None:
    sphere = gmsh.model.occ.addSphere
    outer = fuse(cylinder((0, 0, 0), (0, 0, 1.2), 0.7), sphere(0, 0, 0, 0.7), sphere(0, 0, 1.2, 0.7))
    inner = fuse(cylinder((0, 0, 0), (0, 0, 1.2), 0.6), sphere(0, 0, 0, 0.6), sphere(0, 0, 1.2, 0.6))
    cut(outer, inner)


@part
def bearing_block() -> None:
    body = fuse(box((-1, -0.5, 0), (2, 1, 0.3)), cylinder((0, -0.5, 0.5), (0, 1, 0), 0.5))
    cut(body, cylinder((0, -1, 0.5), (0, 2, 0), 0.36), cylinder((0.75, 0, -1), (0, 0, 3), 0.14),
        cylinder((-0.75, 0, -1), (0, 0, 3), 0.14))  # fmt: skip


@contextmanager
def meshed(name: str, size: float, circle: int, order: int = 2) -> Iterator[None]:
    """The part in Gmsh's model of this process, meshed with elements of an edge length, points per circle and order."""
    gmsh.initialize()
    try:
        options = {"General.Verbosity": 1, "General.NumThreads": 1, "Mesh.RandomSeed": 1, "Mesh.HighOrderOptimize": 0,
                   "Mesh.MeshSizeMin": size, "Mesh.MeshSizeMax": size, "Mesh.MinimumCirclePoints": circle,
                   "Mesh.ElementOrder": order}  # fmt: skip
        for option, value in options.items():
            gmsh.option.setNumber(option, value)
        PARTS[name]()
        gmsh.model.occ.synchronize()
        gmsh.model.mesh.generate(3)
        yield
    finally:
        gmsh.finalize()


def write_mesh(name: str, size: float, circle: int, order: int, file: Path) -> None:
    """A part as a mesh file of Gmsh."""
    with meshed(name, size, circle, order):
        gmsh.write(str(file))
