# SPDX-License-Identifier: BSD-3-Clause
"""Checks whether the Jacobian determinants of cells are above given bounds, with no code of the kernel.

The shape functions come from VTK's own cells, are sampled and converted to Bernstein form by solving a linear system:
VTK's derivatives are wrong for quadratic pyramids (VTK 9.2). The determinant is a polynomial, which is sampled
and written in the same way, and is at least its smallest coefficient; where that does not prove a bound, the cell is
subdivided, until a corner value disproves the bound.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import product
from math import comb, factorial
from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkCell, vtkDataSet, vtkUnstructuredGrid

from ._arrays import Array

_LINE, _TRIANGLE, _TETRAHEDRON = 1, 2, 3
#: VTK's types of fixed order by shape, with their maximum order by axis.
_TRIANGLES = {5: 1, 22: 2, 34: 3}
_QUADRILATERALS = {9: (1, 1), 23: (2, 2), 28: (2, 2), 30: (2, 1)}
_TETRAHEDRA = {10: 1, 24: 2}
_HEXAHEDRA = {12: 1, 25: 2, 29: 2, 33: 2}
_WEDGES = {13: (1, 1), 26: (2, 2), 31: (2, 1), 32: (2, 2)}
_PYRAMIDS = {14: 1, 27: 2}
_LAGRANGE, _BEZIER, _LAST_SHAPE = 69, 76, 4  # triangle, quadrilateral, tetrahedron, hexahedron, wedge
_LAGRANGE_WEDGE, _WEDGE18 = 73, 32
_BUBBLES = {(0, 7): (3, 3, 0), (2, 15): (4, 4, 4), (4, 21): (3, 3, 2)}
#: Tolerance for a missed bound, relative to the largest coefficient.
SLACK = 1e-7
_ROUNDING = 1e-9  # of shape functions
_MOST_PIECES = 400_000
_MOST_LEVELS = 90
_POINTS_AT_ONCE = 20_000_000


@dataclass(frozen=True)
class Factor:
    """One of the simplices whose product is the reference cell, and the degree of a polynomial over it."""

    dimension: int
    degree: int


@dataclass(frozen=True)
class Domain:
    """The reference cell of a block of cells: the degrees of the map, and of its determinant."""

    of_map: tuple[Factor, ...]
    factors: tuple[Factor, ...]
    #: Whether VTK's coordinates collapse at the apex, where the determinant has a double zero that is divided out.
    collapsed: bool = False

    @property
    def surface(self) -> bool:
        return sum(factor.dimension for factor in self.factors) == _TRIANGLE


def _simplex(dimension: int, p: int) -> Domain:
    return Domain((Factor(dimension, p),), (Factor(dimension, dimension * (p - 1)),))


def _box(*orders: int) -> Domain:
    degrees = (Factor(_LINE, len(orders) * p - 1) for p in orders)
    return Domain(tuple(Factor(_LINE, p) for p in orders), tuple(degrees))


def _wedge(p: int, q: int) -> Domain:
    return Domain((Factor(_TRIANGLE, p), Factor(_LINE, q)), (Factor(_TRIANGLE, 3 * p - 2), Factor(_LINE, 3 * q - 1)))


def _pyramid(p: int) -> Domain:
    degrees = (3 * p - 1, 3 * p - 1, 3 * p - 3)
    return Domain((Factor(_LINE, p),) * 3, tuple(Factor(_LINE, d) for d in degrees), collapsed=True)


def domain_of(kind: int, nodes: int, orders: tuple[int, int, int]) -> Domain | None:
    """The degrees of a type of cells; None for cells that are not checked here.

    orders: of Lagrange and Bezier cells (HigherOrderDegrees), or zeros.
    """
    if kind in _TRIANGLES:
        return _simplex(_TRIANGLE, _TRIANGLES[kind])
    if kind in _TETRAHEDRA:
        return _simplex(_TETRAHEDRON, _TETRAHEDRA[kind])
    if kind in _QUADRILATERALS:
        return _box(*_QUADRILATERALS[kind])
    if kind in _HEXAHEDRA:
        return _box(*(_HEXAHEDRA[kind],) * 3)
    if kind in _WEDGES:
        return _wedge(*_WEDGES[kind])
    if kind in _PYRAMIDS:
        return _pyramid(_PYRAMIDS[kind])
    shape = kind - (_BEZIER if kind >= _BEZIER else _LAGRANGE)
    found = _orders(shape, nodes, orders) if 0 <= shape <= _LAST_SHAPE else None
    if found is None:
        return None
    p, q, r = found
    if shape in (0, 2):
        return _simplex(_TRIANGLE if shape == 0 else _TETRAHEDRON, p)
    return _wedge(p, r) if shape == _LAST_SHAPE else _box(*found[: shape if shape > 2 else 2])


def _orders(shape: int, nodes: int, given: tuple[int, int, int]) -> tuple[int, int, int] | None:
    if (shape, nodes) in _BUBBLES:
        return _BUBBLES[shape, nodes]
    uniform = [(p, p, p) for p in range(1, 11)]
    for orders in ([given] if min(given[:2]) > 0 else []) + uniform:
        p, q, r = orders
        triangle, square = comb(p + 2, 2), (p + 1) * (q + 1)
        if (triangle, square, comb(p + 3, 3), square * (r + 1), triangle * (r + 1))[shape] == nodes:
            return orders
    return None


# --- Bernstein polynomials over a simplex ------------------------------------------------------------------------


@lru_cache(maxsize=None)
def _exponents(dimension: int, degree: int) -> Array:
    """Exponents of the barycentric coordinates, a row for each polynomial."""
    rows = [row for row in product(range(degree + 1), repeat=dimension) if sum(row) <= degree]
    return np.array([(degree - sum(row), *row) for row in rows]).reshape(-1, dimension + 1)


def _values(factor: Factor, at: Array) -> Array:
    """Values of the polynomials (columns) at points."""
    rows = _exponents(factor.dimension, factor.degree)
    full = np.concatenate([1 - at.sum(axis=1, keepdims=True), at], axis=1)
    weights = np.array([factorial(factor.degree) / np.prod([factorial(k) for k in row]) for row in rows.tolist()])
    values: Array = weights * np.prod(full[:, None, :] ** rows[None], axis=2)
    return values


def _slopes(factor: Factor, at: Array) -> list[Array]:
    """Derivatives of the polynomials (columns) along each axis at points: differences of lower-degree polynomials."""
    rows = _exponents(factor.dimension, factor.degree)
    lower = Factor(factor.dimension, factor.degree - 1)
    values = _values(lower, at)
    place = {tuple(row): i for i, row in enumerate(_exponents(lower.dimension, lower.degree).tolist())}
    found = []
    for axis in range(1, factor.dimension + 1):
        slope = np.zeros((len(at), len(rows)))
        for column, row in enumerate(rows.tolist()):
            for changed, sign in ((axis, 1), (0, -1)):
                fewer = list(row)
                fewer[changed] -= 1
                if fewer[changed] >= 0:
                    slope[:, column] += sign * factor.degree * values[:, place[tuple(fewer)]]
        found.append(slope)
    return found


@lru_cache(maxsize=None)
def _samples(factor: Factor) -> Array:
    """Points that determine the polynomials: of Chebyshev on a line, a lattice in a simplex; all inside."""
    if factor.dimension == _LINE:
        angles = (2 * np.arange(factor.degree + 1) + 1) / (2 * factor.degree + 2)
        line: Array = ((1 - np.cos(np.pi * angles)) / 2)[:, None]
        return line
    rows = _exponents(factor.dimension, factor.degree)[:, 1:]
    lattice: Array = (rows + 1 / (factor.dimension + 1)) / (factor.degree + 1)
    return lattice


@lru_cache(maxsize=None)
def _fit(factor: Factor) -> Array:
    """From values at the samples to coefficients."""
    return np.linalg.inv(_values(factor, _samples(factor)))


@lru_cache(maxsize=None)
def _children(factor: Factor) -> list[Array]:
    """From the coefficients over a simplex to the coefficients over each part of its subdivision."""
    fit, at = _fit(factor), _samples(factor)
    parts = []
    for corners in _DIVISIONS[factor.dimension]:
        own = np.array(corners) / 2
        parts.append(fit @ _values(factor, own[0] + at @ (own[1:] - own[0])))
    return parts


#: Corners of the parts of a line, a triangle and a tetrahedron, by halves of edges. For the tetrahedron: J. Bey,
#: "Tetrahedral grid refinement", Computing 55 (1995).
_O, _X, _Y, _Z = (0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)
_XX, _YY, _ZZ, _XY, _XZ, _YZ = (2, 0, 0), (0, 2, 0), (0, 0, 2), (1, 1, 0), (1, 0, 1), (0, 1, 1)
_DIVISIONS: dict[int, list[tuple[tuple[int, ...], ...]]] = {
    _LINE: [((0,), (1,)), ((1,), (2,))],
    _TRIANGLE: [((0, 0), (1, 0), (0, 1)), ((1, 0), (2, 0), (1, 1)), ((0, 1), (1, 1), (0, 2)), ((1, 0), (1, 1), (0, 1))],
    _TETRAHEDRON: [(_O, _X, _Y, _Z), (_X, _XX, _XY, _XZ), (_Y, _XY, _YY, _YZ), (_Z, _XZ, _YZ, _ZZ),
                   (_X, _Y, _Z, _XZ), (_X, _XY, _Y, _XZ), (_Y, _Z, _XZ, _YZ), (_Y, _XY, _XZ, _YZ)],
}  # fmt: skip


def _along(matrix: Array, coefficients: Array, axis: int) -> Array:
    """Apply a matrix to one factor of arrays of coefficients."""
    moved: Array = np.moveaxis(np.tensordot(coefficients, matrix, axes=(axis, 1)), -1, axis)
    return moved


# --- cells ---------------------------------------------------------------------------------------------------------


def derivatives(mesh: vtkDataSet, cell: int, domain: Domain) -> Array | None:
    """The derivatives of the shape functions of a cell at the samples: points x axes x nodes.

    None if these functions are not of the degrees of the domain.
    """
    own = mesh.GetCell(cell)
    own = _same_functions(own) if own.GetCellType() == _WEDGE18 else own
    nodes = own.GetNumberOfPoints()

    def functions(parts: tuple[Array, ...]) -> list[float]:
        values = [0.0] * nodes
        own.InterpolateFunctions([*np.concatenate(parts), 0.0, 0.0][:3], values)
        return values

    sizes = [len(_samples(factor)) for factor in domain.of_map]
    made = np.array([functions(parts) for parts in product(*(_samples(factor) for factor in domain.of_map))])
    made = made.reshape(*sizes, nodes)
    for axis, factor in enumerate(domain.of_map):
        made = _along(_fit(factor), made, axis)
    elsewhere = [np.full((1, factor.dimension), 0.3 / factor.dimension) for factor in domain.of_map]
    check = made
    for axis, (factor, place) in enumerate(zip(domain.of_map, elsewhere)):
        check = _along(_values(factor, place), check, axis)
    if np.abs(check.ravel() - functions(tuple(place[0] for place in elsewhere))).max() > _ROUNDING:
        return None
    slopes = []
    at = [_samples(factor) for factor in domain.factors]
    for changed, factor in enumerate(domain.of_map):
        for slope in _slopes(factor, at[changed]):
            values = made
            for axis, other in enumerate(domain.of_map):
                values = _along(slope if axis == changed else _values(other, at[axis]), values, axis)
            slopes.append(values.reshape(-1, nodes))
    if domain.collapsed:  # both derivatives along the base vanish at the apex
        height = np.array([places[-1][0] for places in product(*at)])[:, None]
        slopes[0], slopes[1] = slopes[0] / (1 - height), slopes[1] / (1 - height)
    stacked: Array = np.stack(slopes, axis=1)
    return stacked


def _same_functions(wedge: vtkCell) -> vtkCell:
    """The Lagrange wedge with the nodes of a quadratic one, whose functions Python cannot get from VTK's class."""
    grid = vtkUnstructuredGrid()
    grid.SetPoints(wedge.GetPoints())
    grid.InsertNextCell(_LAGRANGE_WEDGE, wedge.GetNumberOfPoints(), list(range(wedge.GetNumberOfPoints())))
    return grid.GetCell(0)


def coefficients(domain: Domain, slopes: Array, places: Array) -> Array:
    """The coefficients of the determinants, or of the normals (last axis), of cells; places: cells x nodes x 3."""
    found = []
    at_once = max(1, _POINTS_AT_ONCE // slopes.size)
    for begin in range(0, len(places), at_once):
        jacobian = np.einsum("san,cnx->csax", slopes, places[begin : begin + at_once], optimize=True)
        normals = np.cross(jacobian[:, :, 0], jacobian[:, :, 1])
        values = normals if domain.surface else np.einsum("csx,csx->cs", normals, jacobian[:, :, 2])[..., None]
        made = values.reshape(len(jacobian), *(len(_samples(factor)) for factor in domain.factors), -1)
        for axis, factor in enumerate(domain.factors, 1):
            made = _along(_fit(factor), made, axis)
        found.append(made)
    return np.concatenate(found)


def squared(domain: Domain, normals: Array) -> tuple[Domain, Array]:
    """The squares of the lengths of normals: their domain, with twice the degrees, and coefficients."""
    twice = Domain(domain.of_map, tuple(Factor(factor.dimension, 2 * factor.degree) for factor in domain.factors))
    values = normals
    for axis, (factor, finer) in enumerate(zip(domain.factors, twice.factors), 1):
        values = _along(_values(factor, _samples(finer)), values, axis)
    squares = (values**2).sum(axis=-1)
    for axis, finer in enumerate(twice.factors, 1):
        squares = _along(_fit(finer), squares, axis)
    return twice, squares


def above(domain: Domain, determinants: Array, bounds: Array) -> Array:
    """Whether polynomials are at least their bounds everywhere; determinants: cells x coefficients of each factor."""
    proved = np.ones(len(bounds), bool)
    cells, pieces = np.arange(len(bounds)), determinants
    corners = np.ix_(*(np.flatnonzero((_exponents(f.dimension, f.degree) == f.degree).any(axis=1))
                       for f in domain.factors))  # fmt: skip
    axes = tuple(range(1, pieces.ndim))
    every: tuple[Any, ...] = (slice(None),)
    for level in range(_MOST_LEVELS):
        open_ = pieces.min(axis=axes) < bounds[cells]
        cells, pieces = cells[open_], pieces[open_]
        wrong = pieces[every + corners].min(axis=axes) < bounds[cells] if len(cells) else np.zeros(0, bool)
        proved[cells[wrong]] = False
        open_ = proved[cells]
        cells, pieces = cells[open_], pieces[open_]
        if not len(cells):
            return proved
        axis = level % len(domain.factors)
        parts = _children(domain.factors[axis])
        if len(cells) * len(parts) > _MOST_PIECES:
            break
        pieces = np.concatenate([_along(part, pieces, axis + 1) for part in parts])
        cells = np.tile(cells, len(parts))
    proved[cells] = False  # undecided
    return proved
