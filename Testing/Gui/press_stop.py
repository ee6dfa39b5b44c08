# SPDX-License-Identifier: BSD-3-Clause
"""Clicks on the button Stop of a run, from another process, as ParaView processes no events within a run.

usage: press_stop.py SECONDS: waits until the window over the button is there, then this long, and clicks. It is sent to
the window, so that no pointer is needed. Exit code 1: there was no such window, as no run began.
"""

import ctypes
import sys
import time

NAME = b"Tautline Stop"
WAIT_SECONDS = 60.0
BUTTON_PRESS, BUTTON_PRESS_MASK, LEFT = 4, 1 << 2, 1

X = ctypes.CDLL("libX11.so.6")
Window = ctypes.c_ulong


class Button(ctypes.Structure):
    _fields_ = [
        ("type", ctypes.c_int),
        ("serial", ctypes.c_ulong),
        ("send_event", ctypes.c_int),
        ("display", ctypes.c_void_p),
        ("window", Window),
        ("root", Window),
        ("subwindow", Window),
        ("time", ctypes.c_ulong),
        ("position", ctypes.c_int * 4),
        ("state", ctypes.c_uint),
        ("button", ctypes.c_uint),
        ("same_screen", ctypes.c_int),
        ("padding", ctypes.c_long * 12),
    ]


X.XOpenDisplay.restype = ctypes.c_void_p
X.XOpenDisplay.argtypes = [ctypes.c_char_p]
X.XDefaultRootWindow.restype = Window
X.XDefaultRootWindow.argtypes = [ctypes.c_void_p]
X.XQueryTree.argtypes = [ctypes.c_void_p, Window] + [ctypes.c_void_p] * 4
X.XFetchName.argtypes = [ctypes.c_void_p, Window, ctypes.c_void_p]
X.XFree.argtypes = [ctypes.c_void_p]
X.XSendEvent.argtypes = [ctypes.c_void_p, Window, ctypes.c_int, ctypes.c_long, ctypes.c_void_p]
X.XFlush.argtypes = [ctypes.c_void_p]
X.XSetErrorHandler.argtypes = [ctypes.c_void_p]
# Windows may disappear while the tree is searched.
ignore = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p)(lambda display, error: 0)


def name_of(display, window):
    text = ctypes.c_char_p()
    if not X.XFetchName(display, window, ctypes.byref(text)):
        return b""
    name = text.value
    X.XFree(text)
    return name


def find(display, window):
    """The window of this name, or 0."""
    if name_of(display, window) == NAME:
        return window
    root, parent, children, count = Window(), Window(), ctypes.POINTER(Window)(), ctypes.c_uint()
    if not X.XQueryTree(display, window, *map(ctypes.byref, (root, parent, children, count))):
        return 0
    inside = children[: count.value] if count.value else []
    if inside:
        X.XFree(children)
    return next((found for found in (find(display, child) for child in inside) if found), 0)


X.XSetErrorHandler(ignore)
display = X.XOpenDisplay(None)
root = X.XDefaultRootWindow(display)
end = time.monotonic() + WAIT_SECONDS
found = 0
while not found and time.monotonic() < end:
    time.sleep(0.05)
    found = find(display, root)
if not found:
    sys.exit("No window over the button Stop: no run began.")
time.sleep(float(sys.argv[1]))
click = Button(type=BUTTON_PRESS, window=found, root=root, button=LEFT, same_screen=1)
X.XSendEvent(display, found, 0, BUTTON_PRESS_MASK, ctypes.byref(click))
X.XFlush(display)
time.sleep(0.2)  # the connection stays until the event is delivered
