# SPDX-License-Identifier: BSD-3-Clause
"""The intersection of a triangle with the horizon and its approximation: Figures 4.4 and 4.5."""

from __future__ import annotations

import numpy as np

from ._report import Report, pyplot

#: The triangles of the three cases by name: all inside, one vertex outside, one vertex inside the unit circle.
CASES = {
    "1": np.array([[0.10, 0.10], [0.60, 0.15], [0.25, 0.60]]),
    "2": np.array([[0.20, 0.10], [1.15, 0.35], [0.15, 0.80]]),
    "3": np.array([[0.45, 0.45], [1.30, 0.30], [0.55, 1.25]]),
}
_CIRCLE = 4096  # corners of the polygon that stands for the circle in exact areas


def _clip(polygon: np.ndarray, circle: np.ndarray) -> np.ndarray:
    """The part of a convex polygon inside another one, counterclockwise (Sutherland and Hodgman)."""
    for a, b in zip(circle, np.roll(circle, -1, axis=0)):
        if not len(polygon):
            break
        side = (b[0] - a[0]) * (polygon[:, 1] - a[1]) - (b[1] - a[1]) * (polygon[:, 0] - a[0])
        after, ends = np.roll(side, -1), np.roll(polygon, -1, axis=0)
        kept = []
        for p, q, s, t in zip(polygon, ends, side, after):
            if s >= 0:
                kept.append(p)
            if (s >= 0) != (t >= 0):
                kept.append(p + s / (s - t) * (q - p))
        polygon = np.array(kept)
    return polygon


def _area(polygon: np.ndarray) -> float:
    x, y = polygon.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def _crossing(inside: np.ndarray, outside: np.ndarray) -> np.ndarray:
    """Where an edge leaves the unit circle."""
    d = outside - inside
    a, b, c = d @ d, inside @ d, inside @ inside - 1
    return inside + (-b + np.sqrt(b * b - a * c)) / a * d


def chord_polygons(case: str) -> list[np.ndarray]:
    """The triangles whose areas approximate the intersection: section 4.3.1."""
    corners = CASES[case]
    outside = np.flatnonzero((corners**2).sum(axis=1) > 1)
    if case == "1":
        return [corners]
    if case == "2":
        far = int(outside[0])
        a, b = corners[(far + 1) % 3], corners[(far + 2) % 3]
        p, q = _crossing(a, corners[far]), _crossing(b, corners[far])
        return [np.array([a, b, q]), np.array([a, q, p])]
    near = next(i for i in range(3) if i not in outside)
    a = corners[near]
    return [np.array([a, _crossing(a, corners[(near + 1) % 3]), _crossing(a, corners[(near + 2) % 3])])]


def areas(case: str) -> tuple[float, float]:
    """The area by chords and the exact one."""
    t = np.linspace(0, 2 * np.pi, _CIRCLE, endpoint=False)
    circle = np.column_stack([np.cos(t), np.sin(t)])
    return sum(abs(_area(p)) for p in chord_polygons(case)), _area(_clip(CASES[case], circle))


def picture(report: Report, file: str, cases: tuple[str, ...]) -> None:
    """The triangles, the circle, and the area that counts."""
    if pyplot is None:
        return
    figure, axes = pyplot.subplots(1, len(cases), figsize=(4.2 * len(cases), 4.4), squeeze=False)
    t = np.linspace(-0.3, 2.0, 200)
    for axis, case in zip(axes[0], cases):
        for polygon in chord_polygons(case):
            axis.fill(*polygon.T, facecolor="#80b0e0", edgecolor="#1f4e79", linestyle="--")
        axis.fill(*CASES[case].T, fill=False, edgecolor="black")
        axis.plot(np.cos(t), np.sin(t), color="#c04000")
        found, exact = areas(case)
        axis.set_title(f"case {case}: {100 * found / exact:.1f} % of the area")
        axis.set_aspect("equal")
        axis.set_axis_off()
    report.save(figure, file)
