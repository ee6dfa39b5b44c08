# SPDX-License-Identifier: BSD-3-Clause
"""Optimize Mesh on surfaces in space, next to vtkSmoothPolyDataFilter with the input as its source.

A bar with rounded edges, as a CAD program triangulates it, and a sphere of shifted points are made here. Parts of the
Debian packages netgen-doc and gmsh-doc are added where these are installed, and the files in the folder surfaces of the
directory in the environment variable TAUTLINE_TEST_DATA.
"""

import gzip
import math
import os
import random
import tempfile
import time
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkCleanPolyData, vtkSmoothPolyDataFilter, vtkTriangleFilter
from vtkmodules.vtkFiltersGeneral import vtkDistancePolyDataFilter
from vtkmodules.vtkIOGeometry import vtkSTLReader
from vtkmodules.vtkIOPLY import vtkPLYReader

import tautline

Row = tuple[str, float, str]
DATA = os.environ.get("TAUTLINE_TEST_DATA")
PACKAGED = [Path("/usr/share/doc/netgen/examples/hinge.stl"), Path("/usr/share/doc/netgen/examples/part1.stl"),
            Path("/usr/share/doc/gmsh-doc/converters/stl_to_cartesian/lever.stl.gz")]
TOLERANCE = 1e-3  # of the diagonal: the default of Surface Tolerance
SHIFT = 0.5  # of the points of the sphere, in halves of an edge
DIVISIONS = 6  # of edges, for the places at which distances are measured


def surface_of(points: np.ndarray, triangles: np.ndarray) -> vtkPolyData:
    surface, places, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
    places.SetData(numpy_to_vtk(np.ascontiguousarray(points, float), deep=True))
    cells.SetData(3, numpy_to_vtkIdTypeArray(np.ascontiguousarray(triangles, np.int64).ravel(), deep=True))
    surface.SetPoints(places)
    surface.SetPolys(cells)
    return surface


def triangles_of(surface: vtkPolyData) -> np.ndarray:
    return vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)


def points_of(surface) -> np.ndarray:
    return vtk_to_numpy(surface.GetPoints().GetData()).astype(float)


def bar(sections: int, length: float, steps: int) -> vtkPolyData:
    """A square bar of side 2 whose edges are rounded in flat strips, with its inner points shifted along it."""
    numbers, profile = random.Random(1), []
    for corner in range(4):
        middle = math.radians(90 * corner + 45)
        for k in range(steps + 1):
            angle = math.radians(90 * (corner + k / steps))
            profile.append((math.cos(middle) / math.sqrt(2) + math.cos(angle) / 2,
                            math.sin(middle) / math.sqrt(2) + math.sin(angle) / 2))
    points, triangles, around = [], [], len(profile)
    for s in range(sections + 1):
        shift = 0.45 if 0 < s < sections else 0
        points += [(x, y, length * (s + numbers.uniform(-shift, shift))) for x, y in profile]
    for s in range(sections):
        for i in range(around):
            a, b = s * around + i, s * around + (i + 1) % around
            triangles += [(a, b, b + around), (a, b + around, a + around)]
    for first, z in ((0, 0.0), (sections * around, sections * length)):
        points.append((0, 0, z))
        for i in range(around):
            ends = (first + i, first + (i + 1) % around)
            triangles.append((*(ends if z else ends[::-1]), len(points) - 1))
    return surface_of(np.array(points), np.array(triangles))


def ball(n: int) -> vtkPolyData:
    """The surface of n x n x n cubes on a sphere, whose points were shifted on it at random."""
    numbers: dict[tuple[int, ...], int] = {}
    triangles = []
    for axis in range(3):
        for high in (False, True):
            for i in range(n):
                for j in range(n):
                    corners = []
                    for u, v in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
                        place = np.roll((n if high else 0, u, v), axis)
                        corners.append(numbers.setdefault(tuple(int(x) for x in place), len(numbers)))
                    corners = corners if high else corners[::-1]
                    triangles += [corners[:3], [corners[0], *corners[2:]]]
    points = 2 * np.array(list(numbers), float) / n - 1
    points += np.random.default_rng(1).uniform(-SHIFT, SHIFT, points.shape) / n
    return surface_of(points / np.linalg.norm(points, axis=1)[:, None], np.array(triangles))


def read(file: Path) -> vtkPolyData:
    with tempfile.TemporaryDirectory() as directory:
        if file.suffix == ".gz":
            unpacked = Path(directory, file.stem)
            unpacked.write_bytes(gzip.decompress(file.read_bytes()))
            file = unpacked
        reader = vtkPLYReader() if file.suffix == ".ply" else vtkSTLReader()
        reader.SetFileName(str(file))
        clean, triangles = vtkCleanPolyData(), vtkTriangleFilter()
        clean.SetInputConnection(reader.GetOutputPort())
        triangles.SetInputConnection(clean.GetOutputPort())
        triangles.PassLinesOff()
        triangles.PassVertsOff()
        triangles.Update()
    return surface_of(points_of(triangles.GetOutput()), triangles_of(triangles.GetOutput()))


def smallest_angle(points: np.ndarray, triangles: np.ndarray) -> float:
    """In degrees."""
    smallest = 180.0
    for k in range(3):
        a, b, c = (points[triangles[:, (k + i) % 3]] for i in range(3))
        sine, cosine = np.linalg.norm(np.cross(b - a, c - a), axis=1), ((b - a) * (c - a)).sum(axis=1)
        smallest = min(smallest, float(np.degrees(np.arctan2(sine, cosine)).min()))
    return smallest


def volume(points: np.ndarray, triangles: np.ndarray) -> float:
    a, b, c = (points[triangles[:, k]] - points[0] for k in range(3))
    return float((np.cross(a, b) * c).sum()) / 6


def distance(start: np.ndarray, to: np.ndarray, triangles: np.ndarray) -> float:
    """The largest one of places of a surface from another one with the same triangles."""
    a, b, c = (start[triangles[:, k]] for k in range(3))
    places = np.concatenate([((DIVISIONS - i - j) * a + i * b + j * c) / DIVISIONS
                             for i in range(DIVISIONS + 1) for j in range(DIVISIONS + 1 - i)])
    samples = surface_of(places, np.zeros((1, 3)))
    measure = vtkDistancePolyDataFilter()
    measure.SetInputData(0, samples)
    measure.SetInputData(1, surface_of(to, triangles))
    measure.SignedDistanceOff()
    measure.ComputeSecondDistanceOff()
    measure.Update()
    return float(vtk_to_numpy(measure.GetOutput().GetPointData().GetArray("Distance")).max())


def smoothed(surface: vtkPolyData) -> np.ndarray:
    smoother = vtkSmoothPolyDataFilter()
    smoother.SetInputData(surface)
    smoother.SetSourceData(surface)
    smoother.Update()
    return points_of(smoother.GetOutput())


def of_mesh(name: str, surface: vtkPolyData, measured: dict[str, float]) -> list[Row]:
    points, triangles = points_of(surface), triangles_of(surface)
    diagonal = float(np.linalg.norm(points.max(axis=0) - points.min(axis=0)))
    start = time.process_time()
    optimized = points_of(tautline.optimize(surface, "worst element", threads=1).mesh)
    seconds = time.process_time() - start
    peer = smoothed(surface)
    values = {
        "smallest angle before": smallest_angle(points, triangles),
        "smallest angle": smallest_angle(optimized, triangles),
        "smallest angle of vtkSmoothPolyDataFilter": smallest_angle(peer, triangles),
        "distance / diagonal": max(distance(optimized, points, triangles),
                                   distance(points, optimized, triangles)) / diagonal,
        "distance / diagonal of vtkSmoothPolyDataFilter": max(distance(peer, points, triangles),
                                                              distance(points, peer, triangles)) / diagonal,
        "change of the volume": abs(volume(optimized, triangles) / volume(points, triangles) - 1),
        "CPU seconds": seconds,
    }
    measured.update({f"{name}: {key}": value for key, value in values.items()})
    aims = {"smallest angle": f">= {values['smallest angle of vtkSmoothPolyDataFilter']:.5g}",
            "distance / diagonal": f"<= {TOLERANCE}"}
    return [(f"{name}, {len(triangles)} triangles: {key}" if i == 0 else f"  {key}", value, aims.get(key, ""))
            for i, (key, value) in enumerate(values.items())]


def run(quick: bool) -> tuple[dict[str, float], list[Row]]:
    """The measurements, and the table."""
    meshes = {"bar": bar(4, 2.0, 4), "ball": ball(6 if quick else 30)}
    files = [] if quick else [file for file in PACKAGED if file.exists()]
    if DATA and not quick:
        files += sorted(f for f in Path(DATA, "surfaces").glob("*") if f.suffix in (".stl", ".ply"))
    for file in files:
        meshes[file.name.split(".")[0]] = read(file)
    measured: dict[str, float] = {}
    rows: list[Row] = []
    for name, surface in meshes.items():
        rows += of_mesh(name, surface, measured)
    return measured, rows
