# SPDX-License-Identifier: BSD-3-Clause
"""Random outlines and random polygon soups: a mesher gives a mesh or an error, and goes on to the next one."""

import random
import time

import tautline
from vtkmodules.vtkCommonCore import vtkObject, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

SECONDS = 3.0
INPUTS = 20  # at least, on a busy machine too
vtkObject.GlobalWarningDisplayOff()


def cells(sizes, points):
    array = vtkCellArray()
    for size in sizes:
        array.InsertNextCell(size)
        for _ in range(size):
            array.InsertCellPoint(random.randrange(points))
    return array


def outlines():
    """Segments between points of a small grid or anywhere: crossing, doubled, open, without length."""
    data, points, count = vtkPolyData(), vtkPoints(), random.randint(1, 12)
    coordinate = random.choice((random.random, lambda: random.randint(0, 4)))
    for _ in range(count):
        points.InsertNextPoint(coordinate(), coordinate(), 0)
    data.SetPoints(points)
    data.SetLines(cells([2] * random.randint(1, 14), count))
    mesher = tautline.vtkTriangleMesher()
    mesher.SetMinimumAngle(20)
    return mesher, data


def soups():
    """Triangles and quadrilaterals between grid points: degenerate, open, through each other."""
    data, points, count = vtkPolyData(), vtkPoints(), random.randint(4, 10)
    for _ in range(count):
        points.InsertNextPoint(*(random.randint(0, 3) for _ in range(3)))
    data.SetPoints(points)
    data.SetPolys(cells([random.choice((3, 3, 4)) for _ in range(random.randint(4, 16))], count))
    mesher = tautline.vtkTetGenMesher()
    mesher.SetTimeLimit(2)
    return mesher, data


random.seed(20261121)
for make in (outlines, soups):
    meshes = runs = 0
    start = time.monotonic()
    while runs < INPUTS or time.monotonic() - start < SECONDS:
        mesher, data = make()
        mesher.SetInputData(data)
        mesher.Update()
        runs += 1
        meshes += mesher.GetOutput().GetNumberOfCells() > 0
    print(f"{make.__name__}: {runs} inputs, {meshes} meshes")
    assert make is soups or 0 < meshes < runs
