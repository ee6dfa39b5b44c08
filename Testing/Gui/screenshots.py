# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of the steps of a session, for the documentation: session_checks.shot("name") in ParaView's Python shell.

Where the environment variable TAUTLINE_SCREENSHOTS names a directory, the whole screen is saved there as name.png.
"""

import ctypes
import ctypes.util
import os

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGWriter

_Z_PIXMAP = 2
_ALL_PLANES = 0xFFFFFFFF


class _XImage(ctypes.Structure):
    """The beginning of the structure XImage of Xlib."""

    _fields_ = [(name, ctypes.c_int) for name in ("width", "height", "xoffset", "format")]
    _fields_ += [("data", ctypes.c_void_p)]
    _fields_ += [(name, ctypes.c_int) for name in ("byte_order", "bitmap_unit", "bitmap_bit_order", "bitmap_pad")]
    _fields_ += [(name, ctypes.c_int) for name in ("depth", "bytes_per_line", "bits_per_pixel")]


def screen() -> numpy.ndarray:
    """The pixels of the screen, height x width x 3 bytes, from the top."""
    x11 = ctypes.CDLL(ctypes.util.find_library("X11"))
    for function in (x11.XOpenDisplay, x11.XDefaultRootWindow, x11.XGetImage):
        function.restype = ctypes.c_void_p
    display = ctypes.c_void_p(x11.XOpenDisplay(None))
    number = x11.XDefaultScreen(display)
    width, height = x11.XDisplayWidth(display, number), x11.XDisplayHeight(display, number)
    root = ctypes.c_void_p(x11.XDefaultRootWindow(display))
    planes = ctypes.c_ulong(_ALL_PLANES)
    address = x11.XGetImage(display, root, 0, 0, width, height, planes, _Z_PIXMAP)
    image = ctypes.cast(address, ctypes.POINTER(_XImage)).contents
    assert image.bits_per_pixel == 32, image.bits_per_pixel
    data = ctypes.string_at(image.data, image.bytes_per_line * height)
    pixels = numpy.frombuffer(data, numpy.uint8).reshape(height, image.bytes_per_line // 4, 4)[:, :width, 2::-1].copy()
    x11.XCloseDisplay(display)
    return pixels


def save(pixels: numpy.ndarray, file: str) -> None:
    image = vtkImageData()
    image.SetDimensions(pixels.shape[1], pixels.shape[0], 1)
    flipped = numpy.ascontiguousarray(pixels[::-1]).reshape(-1, 3)
    image.GetPointData().SetScalars(numpy_to_vtk(flipped, deep=True))
    writer = vtkPNGWriter()
    writer.SetFileName(file)
    writer.SetInputData(image)
    writer.Write()


def shot(name: str) -> None:
    """Save the screen as it is now; nothing without the environment variable."""
    folder = os.environ.get("TAUTLINE_SCREENSHOTS")
    if folder:
        os.makedirs(folder, exist_ok=True)
        save(screen(), os.path.join(folder, f"{name}.png"))
