# SPDX-License-Identifier: BSD-3-Clause
"""VTK data objects as bytes."""

from __future__ import annotations

from vtkmodules.vtkCommonCore import vtkCharArray
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkDataObjectTypes, vtkImageData, vtkTable
from vtkmodules.vtkParallelCore import vtkCommunicator

from ._arrays import leaves
from ._errors import Error
from ._views import viewed


class Packed:
    """A VTK data object as bytes, for pickle."""

    def __init__(self, data: vtkDataObject) -> None:
        buffer = vtkCharArray()
        if not vtkCommunicator.MarshalDataObject(data, buffer):
            raise Error(f"a {data.GetClassName()} cannot be written to bytes")
        self.content = bytes(memoryview(buffer))
        self.class_name = data.GetClassName()
        # The bytes have these rounded to six digits.
        self.grids = [(leaf.GetOrigin(), leaf.GetSpacing()) for leaf in _images(data)]

    def data(self) -> vtkDataObject:
        """The object again."""
        buffer = vtkCharArray()
        buffer.SetNumberOfValues(len(self.content))
        memoryview(buffer).cast("B")[:] = self.content
        data = vtkDataObjectTypes.NewDataObject(self.class_name)
        if not vtkCommunicator.UnMarshalDataObject(buffer, data):
            raise Error(f"a {self.class_name} cannot be made of its bytes")
        for image, (origin, spacing) in zip(_images(data), self.grids):
            image.SetOrigin(origin)
            image.SetSpacing(spacing)
        return viewed(data)


def _images(data: vtkDataObject) -> list[vtkImageData]:
    return [] if isinstance(data, vtkTable) else [leaf for leaf in leaves(data) if isinstance(leaf, vtkImageData)]
