# SPDX-License-Identifier: BSD-3-Clause
"""Shared by the studies of chapter 4: moving domains, deformed meshes, their measures and pictures."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Sequence

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._meshes import cells_of, points_of, sizes_of
from ._report import Report, parser
from ._verdicts import Times, timed


@dataclass(frozen=True)
class Example:
    """One of the six examples of section 4.10, with the numbers of the dissertation."""

    domain: str
    title: str
    section: str
    #: alpha, beta, gamma of its anisotropic FEMWARP; None: as ours come out of (4.19), (4.21).
    coefficients: tuple[float, ...]
    #: Inverted elements after FEMWARP and anisotropic FEMWARP.
    femwarp: int
    anisotropic: int | None
    #: By how much anisotropic FEMWARP has fewer inverted elements, and takes less time to untangle; percent, at most.
    fewer: float | None
    faster: float | None
    #: By how much the hybrid algorithm's worst element is better than FEMWARP's and UBN's; percent. None: UBN fails.
    than_femwarp: float
    than_ubn: float | None
    #: xmin xmax ymin ymax of the close-up, of the mesh that has moved, per amount.
    window: tuple[float, float, float, float]


EXAMPLES = (
    Example("cylinder", "Moving cylinder", "4.10.1", (1, 0), 38, 0, 91.2, 90.6, 45.5, 80.4, (1.1, 2.0, 0.2, 0.8)),
    Example("bar", "Moving bar", "4.10.2", (0, 1), 118, 17, 94.2, 63.7, 93.4, None, (0.2, 0.8, 0.05, 0.55)),
    Example("gate", "Moving gate", "4.10.3", (0, 1), 103, 14, None, 90.6, 9.85, None, (0.75, 1.25, 0.05, 0.6)),
    Example("cylinder-diagonal", "Diagonal cylinder", "4.10.4", (6, 1), 101, 15, 86.0, None, 41.8, 79.2,
            (1.1, 2.0, 0.3, 0.9)),
    Example("bending-bar", "Bending bar", "4.10.5", (1, 4), 159, 48, 63.2, None, 96.0, None, (0.4, 0.9, 0.4, 1.0)),
    Example("sphere", "Sphere in a cube", "4.10.6", (0, 0, 1), 120, None, None, 71.1, 86.2, None, (0.2, 0.8, 0.4, 1.0)),
)
#: Names in tables and charts, and the options of warp().
METHODS: dict[str, tuple[str, dict]] = {
    "femwarp": ("FEMWARP", {"method": "femwarp"}),
    "anisotropic": ("anisotropic FEMWARP", {"method": "anisotropic femwarp"}),
    "hybrid": ("hybrid", {"method": "hybrid"}),
    "hybrid-steps": ("hybrid, as many steps as needed", {"method": "hybrid", "steps": 0}),
    "hybrid-literal": ("hybrid, literally (4.24)", {"method": "hybrid", "untangle_first": False}),
    "small-steps": ("small-step FEMWARP", {"method": "small-step femwarp"}),
    "untangled": ("FEMWARP, untangled", {"method": "femwarp and untangling"}),
    "ubn": ("iterative stiffening (UBN)", {"method": "iterative stiffening"}),
    "jacobian": ("Jacobian stiffening", {"method": "jacobian stiffening"}),
    "biharmonic": ("biharmonic", {"method": "biharmonic"}),
    "inverse-distance": ("inverse distance", {"method": "inverse distance"}),
    "radial-basis": ("radial basis", {"method": "radial basis"}),
    "weighted-laplacian": ("weighted Laplacian", {"method": "weighted laplacian"}),
}
#: Upper ends of the bins of TMP shape in tables; what is above the last, or inverted, has columns of its own.
BINS = (0.1, 0.3, 1.0, 3.0, 10.0)
_WARM, _COLD = "#d62728", "#1f4e79"


@dataclass
class Deformed:
    """A deformed mesh and its measures."""

    mesh: vtkDataSet
    inverted: int  # elements that are not valid
    impossible: int  # elements that no positions of interior points make valid
    times: Times  # CPU seconds of the repetitions
    reached: float  # fraction of the motion: less than 1 where no further step was possible
    coefficients: tuple[float, float, float]
    shapes: np.ndarray  # (4.22) of every element, inverted ones too

    @property
    def seconds(self) -> float:
        """CPU seconds, the fastest of the repetitions."""
        return self.times.best

    @property
    def complete(self) -> bool:
        """Whether the whole motion was made and no element is inverted."""
        return self.inverted == 0 and self.reached >= 1.0

    @property
    def worst(self) -> float:
        return float(np.max(self.shapes))


def parse(name: str, text: str | None, arguments: Sequence[str], repeats: int = 3) -> argparse.Namespace:
    return parser(name, text, threads=None, repeats=repeats).parse_args(arguments)


class Moving:
    """A domain with a moving boundary, and its motion at any amount (bending and rotation are not proportional)."""

    def __init__(self, domain: str, cells: int = 0) -> None:
        self.domain, self.cells = domain, cells
        self.mesh = tautline.domain(domain, cells)

    def at(self, amount: float) -> np.ndarray:
        """The displacements of the boundary."""
        mesh = tautline.domain(self.domain, self.cells, amount=amount)
        return np.array(vtk_to_numpy(mesh.GetPointData().GetArray("Displacement")))


def similarity(initial: vtkDataSet, points: np.ndarray) -> np.ndarray:
    """The TMP shape metric (4.22) of each simplex with these points against the initial one; 0 is the same shape."""
    cells = cells_of(initial)
    dimension = cells.shape[1] - 1
    before, after = (
        (p[cells[:, 1:]] - p[cells[:, :1]])[:, :, :dimension].transpose(0, 2, 1) for p in (points_of(initial), points)
    )
    t = after @ np.linalg.inv(before)
    if dimension == 2:
        return 2 * ((t[:, 0, 0] - t[:, 1, 1]) ** 2 + (t[:, 0, 1] + t[:, 1, 0]) ** 2)
    cofactors = np.stack([np.cross(t[:, :, (k + 1) % 3], t[:, :, (k + 2) % 3]) for k in range(3)], axis=2)
    size = np.linalg.norm(t, axis=(1, 2))[:, None, None] / np.sqrt(3)
    return np.sum((size * t - cofactors) ** 2, axis=(1, 2))


def deform(initial: vtkDataSet, displacement: np.ndarray, method: str, *, repeats: int = 1, **more) -> Deformed:
    """The initial mesh with its boundary moved by a method of METHODS, by one thread."""
    options = {"threads": 1, **METHODS[method][1], **more}
    result, times = timed(repeats, lambda: tautline.warp(initial, displacement, **options))
    known = result.statistics
    return Deformed(
        result.mesh, result.inverted, result.impossible, times, known["amount"],
        tuple(known[f"c{k}{k}"] for k in "xyz"), similarity(initial, points_of(result.mesh)),
    )


def distribution(warped: Deformed) -> list[float]:
    """Numbers of elements by TMP shape: in the bins of BINS, above them, and inverted."""
    valid = warped.shapes[sizes_of(warped.mesh) > 0]
    counts = np.histogram(valid, [0, *BINS, np.inf])[0]
    return [*(float(c) for c in counts), float(warped.inverted)]


def bin_names() -> list[str]:
    return [*(f"< {b:g}" for b in BINS), f"> {BINS[-1]:g}", "inverted"]


def less(ours: float, other: float) -> float:
    """The difference of the other value and ours, in percent of the other one."""
    return 0.0 if other == 0 else 100 * (1 - ours / other)


# --- pictures -------------------------------------------------------------------------------------------


def section(mesh: vtkDataSet, axis: int, at: float) -> tuple[list[np.ndarray], np.ndarray]:
    """The polygons in which a plane cuts the tetrahedra of a mesh, and the cell of each."""
    p, cells = points_of(mesh), cells_of(mesh)
    others = [k for k in range(3) if k != axis]
    height = p[cells, axis] - at
    above = height > 0
    polygons, owners = [], []
    for cell in np.flatnonzero(above.any(axis=1) & ~above.all(axis=1)):
        up, down = np.flatnonzero(above[cell]), np.flatnonzero(~above[cell])
        # Edges across the plane, in their order around the polygon.
        pairs = [(a, b) for a in up for b in down]
        if len(pairs) == 4:
            pairs = [pairs[0], pairs[1], pairs[3], pairs[2]]
        corners = p[cells[cell]]
        ends = []
        for a, b in pairs:
            t = height[cell, a] / (height[cell, a] - height[cell, b])
            ends.append((corners[a] + t * (corners[b] - corners[a]))[others])
        polygons.append(np.array(ends))
        owners.append(cell)
    return polygons, np.array(owners, int)


def strip(report: Report, file: str, rows: Sequence[Sequence[tuple[str, vtkDataSet | Deformed]]],
          windows: Sequence[Sequence[float] | None], cut: tuple[int, float] = (1, 0.5)) -> None:
    """A picture of rows of meshes with inverted elements in red; volume meshes are cut by a plane (axis, position)."""
    drawings, titles = [], []
    for row in rows:
        for title, shown in row:
            mesh = shown.mesh if isinstance(shown, Deformed) else shown
            wrong = sizes_of(mesh) <= 0
            if cells_of(mesh).shape[1] == 4:
                polygons, owners = section(mesh, *cut)
                drawings.append((polygons, wrong[owners]))
            else:
                drawings.append((list(points_of(mesh)[:, :2][cells_of(mesh)]), wrong))
            part = f", to {shown.reached:.3g} of the motion" if mesh is not shown and shown.reached < 1 else ""
            titles.append(f"{title}\n{np.count_nonzero(wrong)} inverted{part}")
    places = [window for row, window in zip(rows, windows) for _ in row]
    report.polygons(file, titles, drawings, places, columns=max(len(row) for row in rows), colors=(_COLD, _WARM))
