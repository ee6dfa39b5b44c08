# SPDX-License-Identifier: BSD-3-Clause
"""An estimate of the interpolation error of a field, from its values on triangles or tetrahedra."""

from __future__ import annotations

import math
from itertools import combinations
from typing import Any

import numpy as np

from ._arrays import Array
from ._views import cells_of, points_of

_DEGREE = 4  # of the square of the error, in barycentric coordinates
_ZERO = 1e-12  # relative size of the determinant of a flat element


def simplices_of(mesh: Any) -> Array:
    """The tetrahedra of a mesh, m x 4; if there are none, the triangles, m x 3."""
    cells = cells_of(mesh)
    found = cells.get("tetrahedron", cells.get("triangle"))
    return np.zeros((0, 3), int) if found is None else np.asarray(found)


def interpolation_error(mesh: Any, values: Array) -> float:
    """The estimated norm in L2 of the difference between a field and its linear interpolant.

    values: the field at the points, n or n x c; the squares of components are added. The second differences along the
    edges come from the gradient, averaged at the points. Flat elements are left out.
    """
    cells = simplices_of(mesh)
    if not len(cells):
        return 0.0
    field = np.asarray(values, float).reshape(len(values), -1)
    corners = np.asarray(points_of(mesh), float)[cells]
    sides = corners[:, 1:] - corners[:, :1]
    gram = sides @ sides.transpose(0, 2, 1)
    dimension = gram.shape[1]
    determinants, longest = np.linalg.det(gram), np.einsum("mii->m", gram)
    good = determinants > _ZERO**2 * longest**dimension
    cells, sides, gram = cells[good], sides[good], gram[good]
    volumes = np.sqrt(determinants[good]) / math.factorial(dimension)
    scaled = np.linalg.solve(gram, sides)  # rows: contribution of a difference along a side to the gradient
    total = 0.0
    for component in field.T:
        gradients = np.einsum("mk,mkx->mx", component[cells[:, 1:]] - component[cells[:, :1]], scaled)
        total += float(volumes @ _squares(cells, corners[good], _averaged(cells, volumes, gradients, len(field))))
    return math.sqrt(total)


def _averaged(cells: Array, volumes: Array, gradients: Array, points: int) -> Array:
    """The gradients of the elements, averaged at the points by volume."""
    corners, weights = cells.ravel(), np.repeat(volumes, cells.shape[1])
    sums = [np.bincount(corners, np.repeat(volumes * part, cells.shape[1]), points) for part in gradients.T]
    divisors = np.maximum(np.bincount(corners, weights, points), np.finfo(float).tiny)
    return np.asarray(np.stack(sums, axis=1) / divisors[:, None])


def _squares(cells: Array, corners: Array, gradients: Array) -> Array:
    """Per element, the mean of the square of the error: of -1/2 times the sum of l_i l_j d_ij over the edges.

    l are the barycentric coordinates, and d_ij the second differences.
    """
    edges = list(combinations(range(cells.shape[1]), 2))
    at = gradients[cells]
    second = np.stack([((at[:, j] - at[:, i]) * (corners[:, j] - corners[:, i])).sum(axis=1) for i, j in edges], axis=1)
    # The mean of l_i l_j l_k l_l is (product of the factorials of the exponents) d! / (4 + d)!.
    weights = np.array([[(1, 2, 4)[len({*one} & {*other})] for other in edges] for one in edges])
    dimension = cells.shape[1] - 1
    factor = math.factorial(dimension) / math.factorial(_DEGREE + dimension) / 4
    return np.asarray(factor * np.einsum("me,ef,mf->m", second, weights, second))
