# SPDX-License-Identifier: BSD-3-Clause
"""Operations that take much longer than test_interrupts.py waits for their end."""

from functools import lru_cache

import numpy as np
import tautline as tl
from checks import OUT, points, square

MANY = 1000000
OF_TETRAHEDRA = ["imr", "si", "rr", "mean_ratio", "scaled_jacobian", "condition_number", "edge_ratio", "tmp_shape"]


@lru_cache(maxsize=None)
def cube(n: int):
    """The unit cube of 6 n^3 tetrahedra."""
    axis = np.arange(n + 1) / n
    z, y, x = (a.ravel() for a in np.meshgrid(axis, axis, axis, indexing="ij"))
    k, j, i = (a.ravel() for a in np.meshgrid(*[np.arange(n)] * 3, indexing="ij"))
    first = (k * (n + 1) + j) * (n + 1) + i
    steps = (1, n + 1, (n + 1) ** 2)
    cells = []
    for a, b, c in ((0, 1, 2), (1, 2, 0), (2, 0, 1), (1, 0, 2), (0, 2, 1), (2, 1, 0)):
        corners = [first, first + steps[a], first + steps[a] + steps[b], first + sum(steps)]
        even = (a, b, c) in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
        cells.append(np.stack(corners if even else [corners[0], corners[2], corners[1], corners[3]], axis=1))
    return tl.from_arrays(np.column_stack([x, y, z]), {"tetrahedron": np.concatenate(cells)})


@lru_cache(maxsize=None)
def moved(n: int, amplitude: float):
    """A cube whose interior points are moved at random, by up to this many edges."""
    mesh = cube(n).NewInstance()
    mesh.DeepCopy(cube(n))
    xyz = points(mesh)
    inside = np.all((xyz > 1e-9) & (xyz < 1 - 1e-9), axis=1)
    xyz[inside] += np.random.default_rng(1).uniform(-amplitude, amplitude, (inside.sum(), 3)) / n
    return mesh


@lru_cache(maxsize=None)
def layered():
    """A square with an interaction layer."""
    return tl.interaction_layer(square(60), 0.3)


def bending(n: int) -> np.ndarray:
    """Displacements of the points of a cube."""
    x, y, z = points(cube(n)).T
    return np.column_stack([0.2 * np.sin(3 * y), 0.2 * np.cos(2 * z), 0 * x])


def spiral(n: int) -> np.ndarray:
    """The image of a spiral, whose outline is long."""
    y, x = (np.mgrid[:n, :n] - n / 2) / n
    radius = np.hypot(x, y)
    arm = np.sin(np.arctan2(y, x) - 120 * radius) > 0
    return np.where(arm & (radius < 0.45) & (radius > 0.02), 255.0, 0.0)


@lru_cache(maxsize=None)
def ellipse(n: int, stretch: float) -> np.ndarray:
    """The image of an ellipse."""
    y, x = (np.mgrid[:n, :n] - n / 2) / n
    return np.where((x * stretch) ** 2 + y**2 < 0.1, 255.0, 0.0)


def all_metrics() -> list[str]:
    return [metric["name"] for metric in tl.metrics()]


def optimize(optimizer: str, **options):
    endless = {"maximum_iterations": MANY, "relative_change": 0.0, "gradient_norm": 0.0, "culling": 0.0}
    return tl.optimize(moved(40, 0.1), ["imr"], optimizer=optimizer, **endless, **options)


#: The behavior of an operation at the time limit: it ends with an error, returns the best result so far, or either,
#: since an operation that keeps its best has none before its preparation ends, which a busy machine delays.
LIMIT, BEST, EITHER = "limit", "best", "either"
#: By name: an operation with the arguments progress and time_limit, and what it does at the time limit.
OPERATIONS = {
    "quality": (lambda **k: tl.quality(cube(70), all_metrics(), threads=1, **k), LIMIT),
    "compare": (lambda **k: tl.compare(cube(70), moved(70, 0.1), all_metrics(), threads=1, **k), LIMIT),
    "metric field": (
        lambda **k: tl.metric_field(OF_TETRAHEDRA, "tetrahedron", dimensions=(250, 250, 250), threads=1, **k),
        LIMIT,
    ),
    "perturb": (lambda **k: tl.perturb(cube(90), tangle=0.9, **k), LIMIT),
    "optimize local newton": (lambda **k: optimize("local newton", **k), BEST),
    "optimize l-bfgs": (lambda **k: optimize("l-bfgs", **k), BEST),
    "untangle": (lambda **k: tl.untangle(moved(90, 1.5), "thorough", **k), EITHER),
    "improve": (lambda **k: tl.improve(moved(50, 0.1), "aggressive", target_angle=50, **k), BEST),
    "adapt": (
        lambda **k: tl.adapt(cube(20), lambda mesh: np.tanh(20 * mesh.points[:, 0]), 10000, elements=50000, **k), BEST,
    ),
    "warp hybrid": (lambda **k: tl.warp(cube(40), bending(40), **k), BEST),
    "warp factorization": (lambda **k: tl.warp(cube(40), bending(40), "biharmonic", solver="direct", **k), BEST),
    "warp radial basis": (lambda **k: tl.warp(cube(40), bending(40), "radial basis", fit_tolerance=1e-9, **k), BEST),
    "solve factorization": (lambda **k: tl.solve(cube(60), solver="direct", **k), EITHER),
    "condition accurate": (lambda **k: tl.condition(cube(40), method="accurate", **k), EITHER),
    "solver study": (lambda **k: tl.solver_study(cube(40), **k), EITHER),
    "peridynamics": (lambda **k: tl.peridynamics(layered(), 0.3, **k), LIMIT),
    "interaction layer": (lambda **k: tl.interaction_layer(square(100), 0.5, element_size=1e-3, **k), LIMIT),
    "domain of triangles": (lambda **k: tl.domain("wrench", cells=4000000, **k), LIMIT),
    "domain of tetrahedra": (lambda **k: tl.domain("cylinder", cells=4000000, **k), LIMIT),
    "silhouette": (lambda **k: tl.silhouette(spiral(2000), 2, **k), LIMIT),
    "match": (lambda **k: tl.match(ellipse(600, 1), ellipse(600, 1.3), spacing=15, rotations=360, **k), EITHER),
    "match preparation": (
        lambda **k: tl.match(ellipse(2000, 1), ellipse(2000, 1.3), grid=(90, 90), rotations=360, **k), LIMIT,
    ),
    "match descriptors": (
        lambda **k: tl.match(ellipse(600, 1), ellipse(600, 1.3), descriptor=1, grid=(36, 36), rotations=360, **k),
        EITHER,
    ),
    "match contour": (
        lambda **k: tl.match(
            ellipse(600, 1), ellipse(600, 1.3), spacing=5, locations="contour", contour_points=1000, ordering=1, **k
        ),
        EITHER,
    ),
    "retrieval": (
        lambda **k: tl.retrieval(
            [ellipse(400, s) for s in np.linspace(1, 2, 30)], list("ab") * 15, setting="dissertation", **k
        ),
        EITHER,
    ),
}


def write_input() -> str:
    """The name of a mesh for the commands of the shell."""
    name = str(OUT / "interrupts.mesh")
    tl.write(cube(60), name)
    return name


def commands(mesh: str) -> dict[str, list[str]]:
    """Commands of the shell by name, each with an output file; their arguments."""
    return {
        "quality": ["quality", mesh, "-o", "out.vtu", "--threads", "1", "--metrics", ",".join(all_metrics())],
        "perturb": ["perturb", mesh, "-o", "out.mesh", "--tangle", "0.9"],
        "solve": ["solve", mesh, "-o", "out.vtu", "--solver", "direct"],
        "domain": ["domain", "cylinder", "-o", "out.mesh", "--cells", "4000000"],
    }
