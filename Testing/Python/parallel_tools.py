# SPDX-License-Identifier: BSD-3-Clause
"""Common parts of the scripts for pvbatch on MPI ranks."""

import numpy as np
from paraview import simple
from rank_meshes import RANKS


def update(filter_):
    filter_.UpdatePipeline()
    filter_.UpdatePropertyInformation()
    return filter_


# Runs on every rank: writes points and arrays of its part to a file.
DUMP = """
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkParallelCore import vtkMultiProcessController

data = self.GetInputDataObject(0, 0)
arrays = {{"points": np.zeros((0, 3))}}
if data.GetNumberOfPoints() > 0:
    # an image has no array of points
    image = data.IsA("vtkImageData")
    arrays["points"] = (
        np.array([data.GetPoint(i) for i in range(data.GetNumberOfPoints())])
        if image
        else vtk_to_numpy(data.GetPoints().GetData())
    )
    for fields in (data.GetPointData(), data.GetCellData()):
        for k in range(fields.GetNumberOfArrays()):
            arrays[fields.GetArrayName(k)] = vtk_to_numpy(fields.GetArray(k))
controller = vtkMultiProcessController.GetGlobalController()
np.savez("{file}." + str(controller.GetLocalProcessId()), **arrays)
controller.Barrier()  # the first rank reads the files
"""


def parts(filter_, file):
    """The arrays of each rank that has a part; files with the name `file` and more are written."""
    simple.ProgrammableFilter(filter_, Script=DUMP.format(file=file)).UpdatePipeline()
    found = (np.load(f"{file}.{rank}.npz") for rank in range(RANKS))
    return [arrays for arrays in found if len(arrays["points"])]


def columns(table):
    """The columns of a table by name, as lists."""
    found = (table.GetColumn(i) for i in range(table.GetNumberOfColumns()))
    return {
        column.GetName(): [
            value.ToString() if column.IsA("vtkStringArray") else value.ToDouble()
            for value in map(column.GetVariantValue, range(column.GetNumberOfValues()))
        ]
        for column in found
    }
