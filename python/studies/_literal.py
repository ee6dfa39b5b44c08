# SPDX-License-Identifier: BSD-3-Clause
"""Local conjugate gradients on the objectives as they are printed, with the terms of inverted elements.

Section 3.2.2 sums 1 / SI over all elements. The terms of inverted elements are negative, and tend to minus infinity as
such an element degenerates. vtkMeshOptimizer leaves these terms out. This module keeps them, in NumPy and for triangles
only: it shows what the printed objectives do.
"""

from __future__ import annotations

import math
from typing import Sequence

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

from ._memory import remembered
from ._meshes import cells_of, points_of, sizes_of

#: The sufficient decrease of a step, over the slope; the first step, over the shortest edge; and halvings of a step.
_DECREASE, _FIRST_STEP, _HALVINGS = 1e-4, 0.5, 30
#: Exponents of the exponential sum beyond which its smaller term is 0 in double precision.
_LARGEST_EXPONENT = 700.0


class _Patch:
    """The triangles at a vertex: the ends of their opposite edges."""

    def __init__(self, first: np.ndarray, second: np.ndarray, beta: float) -> None:
        self.first, self.second, self.beta = first, second, beta
        self.step = _FIRST_STEP * float(np.sqrt(((first - second) ** 2).sum(axis=1)).min())

    def sums(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The sums of 1 / SI and of the squared untangling metric (3.3), and their gradients, by rows."""
        a, b = self.first, self.second
        area = 0.5 * ((a[:, 0] - x[0]) * (b[:, 1] - x[1]) - (a[:, 1] - x[1]) * (b[:, 0] - x[0]))
        turn = 0.5 * np.stack([a[:, 1] - b[:, 1], b[:, 0] - a[:, 0]], axis=1)
        squares = ((a - x) ** 2).sum(axis=1) + ((b - x) ** 2).sum(axis=1) + ((a - b) ** 2).sum(axis=1)
        safe = np.where(area == 0, np.finfo(float).tiny, area)
        terms = squares / safe
        slopes = 2 * (2 * x - a - b) / safe[:, None] - (terms / safe)[:, None] * turn
        lack = np.maximum(self.beta - area, 0.0)
        return (np.array([terms.sum(), (lack**2).sum()]),
                np.array([slopes.sum(axis=0), (-2 * lack[:, None] * turn).sum(axis=0)]))


def _combined(sums: np.ndarray, scalarization: str, c: float) -> tuple[float, np.ndarray]:
    """The scalarized objective of both sums, and its derivatives by them."""
    shape, tangle = sums
    if scalarization == "si":
        return float(shape), np.array([1.0, 0.0])
    if scalarization == "untangle":
        return float(tangle), np.array([0.0, 1.0])
    if scalarization == "equal-sum":
        return float(shape + tangle), np.ones(2)
    if scalarization == "objective-product":
        return float(shape * tangle), np.array([tangle, shape])
    exponent = float(np.clip((shape - tangle) / c, -_LARGEST_EXPONENT, _LARGEST_EXPONENT))
    part = 1.0 / (1.0 + math.exp(-exponent))
    return float(max(shape, tangle) + c * math.log1p(math.exp(-abs(exponent)))), np.array([part, 1.0 - part])


def _moved(patch: _Patch, x: np.ndarray, rest: np.ndarray, scalarization: str, c: float, steps: int) -> np.ndarray:
    """The place of a vertex after steps of Polak-Ribiere conjugate gradients."""

    def value(place: np.ndarray) -> tuple[float, np.ndarray]:
        sums, gradients = patch.sums(place)
        combined, weights = _combined(rest + sums, scalarization, c)
        return combined, weights @ gradients

    now, gradient = value(x)
    direction = -gradient
    for _ in range(steps):
        if gradient @ direction >= 0:
            direction = -gradient
        length = float(np.hypot(*direction))
        if length == 0 or not math.isfinite(length):
            break
        step = patch.step / length
        for _ in range(_HALVINGS):
            there, slope = value(x + step * direction)
            if there < now + _DECREASE * step * (gradient @ direction):
                break
            step *= 0.5
        else:
            break
        x = x + step * direction
        direction = max(0.0, slope @ (slope - gradient) / (gradient @ gradient)) * direction - slope
        now, gradient = there, slope
    return x


@remembered
def literal(mesh: vtkDataSet, fixed: np.ndarray, method: str, sweeps: int, steps: int, beta: float,
            c: float) -> list[int]:
    """Inverted triangles before the first and after each sweep.

    fixed: whether a point stays. method: "si", "untangle", "exponential-sum", "objective-product", "equal-sum", of the
    whole mesh's objectives. beta: of the untangling metric.
    """
    points, cells = points_of(mesh)[:, :2], cells_of(mesh)
    around: list[list[tuple[int, int]]] = [[] for _ in points]
    for triangle in cells:
        for k in range(3):
            around[triangle[k]].append((triangle[(k + 1) % 3], triangle[(k + 2) % 3]))
    edges: Sequence[np.ndarray] = [np.array(pairs, int).reshape(-1, 2) for pairs in around]
    counts = [int(np.count_nonzero(sizes_of(mesh) <= 0))]
    for _ in range(sweeps):
        # Each triangle is in the patches of its three vertices.
        whole = sum(_Patch(points[e[:, 0]], points[e[:, 1]], beta).sums(points[v])[0]
                    for v, e in enumerate(edges) if len(e)) / 3
        for v in np.flatnonzero(~fixed):
            patch = _Patch(points[edges[v][:, 0]], points[edges[v][:, 1]], beta)
            rest = whole - patch.sums(points[v])[0]
            points[v] = _moved(patch, points[v], rest, method, c, steps)
            whole = rest + patch.sums(points[v])[0]
        a, b = points[cells[:, 1]] - points[cells[:, 0]], points[cells[:, 2]] - points[cells[:, 0]]
        counts.append(int(np.count_nonzero(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0] <= 0)))
    return counts
