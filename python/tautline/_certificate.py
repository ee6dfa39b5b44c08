# SPDX-License-Identifier: BSD-3-Clause
"""Certificates: a proof for each element that it is valid, in a file that is bound to the mesh; and their check."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataSet
from vtkmodules.vtkFiltersCore import vtkConnectivityFilter

from ._arrays import Array, cell_array, cell_types
from ._build import VERSION
from ._determinants import SLACK, above, coefficients, derivatives, domain_of, squared
from ._errors import Error, checked, run
from ._files import file_name, replace_text
from ._io import Mesh, as_data_set
from ._vtk import CLASSES

FORMAT = "tautline certificate 1"
#: The largest gap between a bound and the minimum, relative to the largest coefficient of the determinant.
TOLERANCE = 1e-8
#: Exit code of the command for a mesh whose certificate does not hold.
REFUTED = 3
_VERDICTS = {1: "valid", 0: "degenerate", -1: "invalid", -2: "not measured", -3: "not finite"}
_FLAT = 1e-10  # of the extent
_MOST_LISTED = 5


@dataclass(frozen=True)
class Verification:
    """Whether a certificate holds for a mesh; true in conditions if it does.

    Attributes
    ----------
    holds : bool
        Whether the mesh is the certified one, every bound holds and all verdicts follow from the bounds.
    valid : int
        Elements that the certificate proves to be valid.
    cells : int
        Elements of the mesh.
    problems : list[str]
        The failures, in sentences; empty if everything holds.
    """

    holds: bool
    valid: int
    cells: int
    problems: list[str]
    _shown: ClassVar[str] = "holds"

    def __bool__(self) -> bool:
        return self.holds


@checked
def certificate(mesh: Mesh, file: str | PathLike[str] | None = None) -> dict[str, Any]:
    """A certificate of the validity of every element of a mesh, also of curved ones.

    Parameters
    ----------
    mesh : Mesh
        A vtkDataSet, a file name, the result of another function, or (points, cells).
    file : str or path, optional
        A JSON file to write it to.

    Returns
    -------
    dict[str, Any]
        format; program (name and version); points, cells (their numbers); sha256, of the coordinates, types and nodes
        of the cells; tolerance: the largest gap between a bound and the minimum, relative to the largest coefficient of
        the determinant; valid (number of elements); elements: for each element its verdict ("valid", "degenerate",
        "invalid", "not measured", "not finite") and the lower bound of its Jacobian determinant, or on surfaces in
        space of the component of its normal along the mean normal. An element is proved to be valid if its bound
        is positive.

    Examples
    --------
    >>> tautline.certificate("part.vtu", "part.json")["valid"]
    """
    grid = as_data_set(mesh)
    filter_ = CLASSES["vtkElementQuality"]()
    filter_.SetInputData(grid)
    filter_.AddMetricByName("min_jacobian")
    filter_.JacobianBoundsOn()
    run(filter_)
    validity = cell_array(filter_.GetOutputDataObject(0), "Validity")
    bounds = cell_array(filter_.GetOutputDataObject(0), "JacobianBound")
    made = {
        "format": FORMAT,
        "program": f"tautline {VERSION}",
        "points": grid.GetNumberOfPoints(),
        "cells": grid.GetNumberOfCells(),
        "sha256": mesh_hash(grid),
        "tolerance": TOLERANCE,
        "valid": int((validity == 1).sum()),
        "elements": [[_VERDICTS[int(verdict)], float(bound)] for verdict, bound in zip(validity, bounds)],
    }
    if file is not None:
        replace_text(file, certificate_text(made))
    return made


def certificate_text(made: dict[str, Any]) -> str:
    """A certificate as JSON, with a line for each element."""
    return json.dumps(made).replace('"elements": [[', '"elements": [\n[').replace("], [", "],\n[") + "\n"


@checked
def verify_certificate(mesh: Mesh, certificate: dict[str, Any] | str | PathLike[str]) -> Verification:
    """Check a certificate with an independent method; see certificate().

    The mesh must be the certified one, and each bound must hold: determinants are computed from the shape
    functions of VTK's own cells, written in Bernstein polynomials by solving linear systems, and compared with the
    bounds, less 1e-7 of the largest coefficient but at most half of a positive bound.

    Parameters
    ----------
    mesh : Mesh
        A vtkDataSet, a file name, the result of another function, or (points, cells).
    certificate : dict, str or path
        The return value of certificate(), or its file.

    Returns
    -------
    Verification

    Examples
    --------
    >>> assert tautline.verify_certificate("part.vtu", "part.json")
    """
    grid = as_data_set(mesh)
    given = certificate if isinstance(certificate, dict) else _read(file_name(certificate))
    verdicts, bounds = _contents(given)
    problems = []
    if given.get("sha256") != mesh_hash(grid) or len(verdicts) != grid.GetNumberOfCells():
        problems.append("The certificate is of another mesh: the hash of its points and cells differs.")
        return Verification(False, 0, grid.GetNumberOfCells(), problems)
    wrong, unproved, unchecked = _check(grid, verdicts, bounds)
    for cells, what in ((wrong, "are not above their bounds"),
                        (unproved, "have no bound that proves that they are valid"),
                        (unchecked, "are valid by it, but of a type that is not checked")):  # fmt: skip
        if len(cells):
            listed = ", ".join(map(str, cells[:_MOST_LISTED])) + (", ..." if len(cells) > _MOST_LISTED else "")
            problems.append(f"{len(cells)} elements {what} ({listed}).")
    invalid = sum(verdict != "valid" for verdict in verdicts)
    return Verification(not problems, len(verdicts) - invalid, len(verdicts), problems)


def mesh_hash(grid: vtkDataSet) -> str:
    """SHA-256 of the coordinates, and of the types and nodes of all cells, for any types of these numbers."""
    digest = hashlib.sha256()
    places = _places(grid)
    types, offsets, nodes = _cells(grid)
    for array, dtype in ((places, "<f8"), (types, "u1"), (offsets, "<i8"), (nodes, "<i8"), (_degrees(grid), "<i8")):
        digest.update(np.ascontiguousarray(array, dtype).tobytes())
    return digest.hexdigest()


def _places(grid: vtkDataSet) -> Array:
    if hasattr(grid, "GetPoints") and not isinstance(grid.GetPoints(), type(None)):
        return np.asarray(vtk_to_numpy(grid.GetPoints().GetData()), float)
    return np.array([grid.GetPoint(i) for i in range(grid.GetNumberOfPoints())], float).reshape(-1, 3)


def _cells(grid: vtkDataSet) -> tuple[Array, Array, Array]:
    """Types, offsets and nodes."""
    if grid.IsA("vtkUnstructuredGrid") and grid.GetNumberOfCells():
        cells = grid.GetCells()
        arrays = (cell_types(grid), cells.GetOffsetsArray(), cells.GetConnectivityArray())
        types, offsets, nodes = (vtk_to_numpy(array).ravel() for array in arrays)
        return types, offsets, nodes
    types = np.array([grid.GetCellType(c) for c in range(grid.GetNumberOfCells())], np.uint8)
    lists = []
    for c in range(grid.GetNumberOfCells()):
        ids = grid.GetCell(c).GetPointIds()
        lists.append([ids.GetId(i) for i in range(ids.GetNumberOfIds())])
    offsets = np.concatenate([[0], np.cumsum([len(row) for row in lists])]).astype(np.int64)
    return types, offsets, np.array([i for row in lists for i in row], np.int64)


def _degrees(grid: vtkDataSet) -> Array:
    found = grid.GetCellData().GetHigherOrderDegrees()
    degrees: Array = np.zeros((0, 3), np.int64) if found is None else vtk_to_numpy(found).astype(np.int64)
    return degrees


def _read(name: str) -> dict[str, Any]:
    try:
        found = json.loads(Path(name).read_text(encoding="utf-8"))
    except OSError as error:
        raise Error(f"{name}: {error.strerror}") from None
    except ValueError as error:
        raise Error(f"{name}: is no JSON: {error}") from None
    if not isinstance(found, dict) or found.get("format") != FORMAT:
        raise Error(f"{name}: is no certificate of this version ({FORMAT}): make it with --certificate")
    return found


def _contents(given: dict[str, Any]) -> tuple[list[str], Array]:
    try:
        verdicts = [str(verdict) for verdict, _ in given["elements"]]
        bounds = np.array([float(bound) for _, bound in given["elements"]])
    except (KeyError, TypeError, ValueError):
        raise Error("the certificate has no list of elements, each a verdict and a bound") from None
    if not set(verdicts) <= set(_VERDICTS.values()) or not np.isfinite(bounds).all():
        raise Error("the certificate has a verdict or a bound that no certificate has")
    return verdicts, bounds


def _check(grid: vtkDataSet, verdicts: list[str], bounds: Array) -> tuple[list[int], list[int], list[int]]:
    """The elements that are not above their bounds, elements that the bounds do not prove valid, and valid elements of
    an unchecked type."""
    types, offsets, nodes = _cells(grid)
    sizes, places = np.diff(offsets), _places(grid)
    degrees = _degrees(grid)
    judged = np.array([verdict in ("valid", "invalid", "degenerate") for verdict in verdicts], bool)
    judged &= ~np.isin(types, (0, 1, 2, 3, 4, 21, 68, 75))
    keys = np.column_stack([types.astype(int), sizes, degrees if len(degrees) else np.zeros((len(types), 3), int)])
    parts = _parts(grid)
    valid = np.array([verdict == "valid" for verdict in verdicts], bool)
    wrong: list[int] = []
    unproved: list[int] = np.flatnonzero(valid & (bounds <= 0)).tolist()
    unchecked: list[int] = []
    for key in np.unique(keys[judged], axis=0).tolist():
        cells = np.flatnonzero(judged & (keys == key).all(axis=1))
        domain = domain_of(key[0], key[1], (key[2], key[3], key[4]))
        slopes = None if domain is None else derivatives(grid, int(cells[0]), domain)
        if domain is None or slopes is None:
            unchecked += cells[valid[cells]].tolist()
            continue
        own = places[nodes[offsets[cells][:, None] + np.arange(key[1])]]
        found = coefficients(domain, slopes, own)
        axes = tuple(range(1, found.ndim - 1))
        if not domain.surface:
            values = found[..., 0]
            signs = _signs(values.mean(axis=axes), parts[cells])
            values = values * signs.reshape(-1, *[1] * len(axes))
        else:
            values = _along_normal(found, axes, places, parts[cells])
        scale = np.abs(values).max(axis=axes)
        least = bounds[cells] - np.where(bounds[cells] > 0, np.minimum(SLACK * scale, bounds[cells] / 2), SLACK * scale)
        wrong += cells[~above(domain, values, least)].tolist()
        # A normal that turns by more than a right angle may still have no zeros.
        turned = np.flatnonzero(valid[cells] & (bounds[cells] <= 0))
        if domain.surface and len(turned):
            finer, squares = squared(domain, found[turned])
            zero = SLACK**2 * np.abs(squares).max(axis=axes)
            proved = set(cells[turned[above(finer, squares, zero)]].tolist())
            unproved = [c for c in unproved if c not in proved]
    return sorted(wrong), unproved, sorted(unchecked)


def _along_normal(normals: Array, axes: tuple[int, ...], places: Array, parts: Array) -> Array:
    """The components of normals along the normal of the plane, or on a surface along the mean normal of each cell."""
    mean = normals.mean(axis=axes)
    extent = np.ptp(places, axis=0).max() if len(places) else 0
    own: Array = np.linalg.svd(places - places.mean(axis=0), full_matrices=False)[2][-1]
    if np.abs((places - places.mean(axis=0)) @ own).max() <= _FLAT * extent:
        sign = _signs(mean @ own, parts)
        directions = sign[:, None] * own
    else:
        directions = mean / np.maximum(np.linalg.norm(mean, axis=1, keepdims=True), np.finfo(float).tiny)
    product: Array = np.einsum("c...x,cx->c...", normals, directions)
    return product


def _signs(means: Array, parts: Array) -> Array:
    """The sign of most of the cells of each connected part: files list the nodes of cells in both orientations."""
    balance = np.zeros(parts.max(initial=0) + 1)
    np.add.at(balance, parts, np.sign(means))
    return np.where(balance[parts] < 0, -1.0, 1.0)


def _parts(grid: vtkDataSet) -> Array:
    """The number of the connected part of each cell."""
    plain = grid.NewInstance()
    plain.CopyStructure(grid)
    search = vtkConnectivityFilter()
    search.SetInputData(plain)
    search.SetExtractionModeToAllRegions()
    search.ColorRegionsOn()
    search.Update()
    found = search.GetOutput().GetCellData().GetArray("RegionId")
    parts: Array = np.zeros(grid.GetNumberOfCells(), int) if found is None else vtk_to_numpy(found).astype(int)
    return parts
