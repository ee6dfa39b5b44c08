# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of the steps of a session, for the documentation: screenshots.shot("name") in ParaView's Python shell.

Where the environment variable TAUTLINE_SCREENSHOTS names a directory, the whole screen is saved there as name.png.
step("name", places...) does the same with ParaView's window in the size of the tutorial's pictures; the places of the
widgets that the reader clicks are saved in name.json, in pixels from the window's corner. A place is the name of a
widget, or a pair with a part of it (WidgetPlaces.cxx), or a triple with a color, red, green and blue: the rectangle of
the widget's pixels with this color. A place that does not exist ends ParaView with an error, with or without pictures.
"""

import ctypes
import ctypes.util
import json
import os
import sys
import time
import traceback

import numpy
from paraview import simple
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGWriter

_Z_PIXMAP = 2
_ALL_PLANES = 0xFFFFFFFF
WIDE, HIGH = 1200, 860  # of the window
PANEL, BROWSER = 420, 200  # width of its panels, height of the pipeline browser
MESSAGES = b"pqClientMainWindow/outputWidgetDock"
SETTLED = 0.5  # seconds that the window has to draw itself for a picture


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
    """Save the screen with the window in the size of pictures; nothing without the environment variable."""
    folder = os.environ.get("TAUTLINE_SCREENSHOTS")
    if folder:
        os.makedirs(folder, exist_ok=True)
        if _widgets().tautlineResize(WIDE, HIGH, PANEL, BROWSER):
            simple.RenderAllViews()
            _wait(SETTLED)
        save(screen(), os.path.join(folder, f"{name}.png"))


def hide_messages() -> None:
    """Clears the window with the messages of an earlier session."""
    if "TAUTLINE_WIDGETS" in os.environ:
        _widgets().tautlineHideMessages()


def _widgets() -> ctypes.CDLL:
    """The library made of WidgetPlaces.cxx."""
    return ctypes.CDLL(os.environ["TAUTLINE_WIDGETS"])


def place(name: str, part: str = "", color: tuple = ()) -> list:
    """Left, top, width and height of a widget, a part of it, or its pixels of a color."""
    found = (ctypes.c_int * 4)()
    count = _widgets().tautlineWidgetPlace(name.encode(), part.encode(), found)
    if count != 1:
        raise LookupError(f"{name} has no part {part}" if count < 0 else f"there are {count} visible widgets {name}")
    left, top, wide, high = found
    if color:
        _wait(SETTLED)
        shown = screen()[top : top + high, left : left + wide].astype(int)
        rows, columns = (abs(shown - color).max(axis=2) <= 2).nonzero()
        if not len(rows):
            raise LookupError(f"{name} has no pixel of the color {color}")
        left, top = left + int(columns.min()), top + int(rows.min())
        wide, high = int(numpy.ptp(columns)) + 1, int(numpy.ptp(rows)) + 1
    return [left, top, wide, high]


def _wait(seconds: float) -> None:
    """Lets Qt handle what is left to do."""
    end = time.monotonic() + seconds
    while True:
        _widgets().tautlineHandleEvents()
        if time.monotonic() >= end:
            return
        time.sleep(0.02)


def _step(name: str, places: tuple, menu: str, high: int, browser: int) -> None:
    """What step() does, without its treatment of errors."""
    if not _widgets().tautlineResize(WIDE, high, PANEL, browser):
        raise LookupError("there is no main window")
    settled = SETTLED if "TAUTLINE_SCREENSHOTS" in os.environ else 0
    simple.RenderAllViews()
    _wait(settled)
    if not _widgets().tautlineOpenMenu(menu.encode()):
        raise LookupError(f"there is no menu {menu}")
    _wait(settled)
    for _ in range(2):  # the first time, panels scroll to the widgets
        marks = [place(*((one,) if isinstance(one, str) else one)) for one in places]
        _wait(settled)
    if _widgets().tautlineWidgetPlace(MESSAGES, b"", (ctypes.c_int * 4)()):
        raise RuntimeError("ParaView shows messages")
    folder = os.environ.get("TAUTLINE_SCREENSHOTS")
    if folder:
        os.makedirs(folder, exist_ok=True)
        save(screen()[:high, :WIDE], os.path.join(folder, f"{name}.png"))
        with open(os.path.join(folder, f"{name}.json"), "w", encoding="utf-8") as file:
            json.dump(marks, file)
    _widgets().tautlineOpenMenu(b"")


def step(name: str, *places, menu: str = "", high: int = HIGH, browser: int = BROWSER) -> None:
    """Saves the window, with the menus along a path open, and the places to click; heights in pixels."""
    try:
        _step(name, places, menu, high, browser)
    except BaseException:  # the shell would print it in its window, and the session go on
        traceback.print_exc(file=sys.__stderr__)
        os._exit(1)
