# SPDX-License-Identifier: BSD-3-Clause
"""Small PNG files: pictures with at most 256 colours, written with a palette."""

import struct
import zlib
from pathlib import Path

import numpy as np

MAX_COLOURS = 256
FINEST = 8  # shades of a channel are this far apart, or a multiple of it where there are too many colours


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def reduce_colours(image: np.ndarray) -> tuple:
    """(palette, indices) of an image [row, column, channel]; shades are rounded until MAX_COLOURS suffice."""
    step = FINEST
    while True:
        rounded = np.minimum((image[..., :3].astype(int) + step // 2) // step * step, 255)
        codes = rounded @ [65536, 256, 1]
        palette, indices = np.unique(codes, return_inverse=True)
        if len(palette) <= MAX_COLOURS:
            return palette, indices.reshape(codes.shape).astype(np.uint8)
        step += FINEST


def write(image: np.ndarray, path: Path) -> None:
    """Writes an image [row, column, channel] of bytes, rows from above."""
    palette, indices = reduce_colours(image)
    height, width = indices.shape
    colours = b"".join(int(code).to_bytes(3, "big") for code in palette)
    rows = np.concatenate([np.zeros((height, 1), np.uint8), indices], axis=1)  # filter 0 before each row
    header = struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)
    chunks = [(b"IHDR", header), (b"PLTE", colours), (b"IDAT", zlib.compress(rows.tobytes(), 9)), (b"IEND", b"")]
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(kind, data) for kind, data in chunks))


def read(path: Path) -> np.ndarray:
    """A PNG file as an image [row, column, channel], rows from above."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOImage import vtkPNGReader

    reader = vtkPNGReader()
    reader.SetFileName(str(path))
    reader.Update()
    image = reader.GetOutput()
    columns, rows, _ = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(rows, columns, -1)[::-1]


def shrink(image: np.ndarray, width: int) -> np.ndarray:
    """The image with fewer columns and the same proportions: each new pixel is the mean of the area it covers."""
    result = image[..., :3].astype(float)
    height = round(image.shape[0] * width / image.shape[1])
    for axis, size in ((0, height), (1, width)):
        old = result.shape[axis]
        sums = np.insert(np.cumsum(result, axis=axis), 0, 0, axis=axis)
        places = np.linspace(0, old, size + 1)
        below = np.minimum(places.astype(int), old - 1)
        shape = [-1 if i == axis else 1 for i in range(3)]
        part = (places - below).reshape(shape)
        at = np.take(sums, below, axis) * (1 - part) + np.take(sums, below + 1, axis) * part
        result = np.diff(at, axis=axis) * size / old
    return np.clip(np.round(result), 0, 255).astype(np.uint8)
