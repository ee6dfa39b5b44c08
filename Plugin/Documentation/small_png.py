# SPDX-License-Identifier: BSD-3-Clause
"""Small PNG files: pictures with at most 256 colors, written with a palette."""

import struct
import zlib
from pathlib import Path

import numpy as np

MAX_COLORS = 256
FINEST = 8  # shades of a channel are this far apart, or a multiple of it where there are too many colors
MOST_BYTES = 150_000  # of a picture (Testing/Docs/check_links.py)
COARSEST = 64
SHADE = 4  # shades of windows and smooth pictures are this far apart, before their colors are chosen


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def reduce_colors(image: np.ndarray, step: int = FINEST) -> tuple:
    """(palette, indices) of an image [row, column, channel]; shades are rounded until MAX_COLORS suffice."""
    while True:
        rounded = np.minimum((image[..., :3].astype(int) + step // 2) // step * step, 255)
        codes = rounded @ [65536, 256, 1]
        palette, indices = np.unique(codes, return_inverse=True)
        if len(palette) <= MAX_COLORS:
            return palette, indices.reshape(codes.shape).astype(np.uint8)
        step += FINEST


def mean_colors(image: np.ndarray, most: int = MAX_COLORS) -> tuple:
    """The same with the means of boxes of similar colors: rare colors, such as dark red elements, stay."""
    rounded = np.minimum((image[..., :3].astype(int) + SHADE // 2) // SHADE * SHADE, 255)
    colors, places, counts = np.unique(rounded.reshape(-1, 3), axis=0, return_inverse=True, return_counts=True)
    weights = np.sqrt(counts)
    everything = np.arange(len(colors))
    boxes = [(_spread(colors, weights, everything), everything)]
    while len(boxes) < most and max(spread for spread, _ in boxes) > 0:
        _, members = boxes.pop(max(range(len(boxes)), key=lambda i: boxes[i][0]))
        channel = np.ptp(colors[members], axis=0).argmax()
        middle = np.average(colors[members, channel], weights=weights[members])
        low = colors[members, channel] <= middle
        boxes += [(_spread(colors, weights, part), part) for part in (members[low], members[~low])]
    means = np.empty((len(colors), 3), int)
    for _, members in boxes:
        means[members] = np.round(np.average(colors[members], axis=0, weights=counts[members]))
    palette, indices = np.unique(means @ [65536, 256, 1], return_inverse=True)
    return palette, indices[places].reshape(rounded.shape[:2]).astype(np.uint8)


def _spread(colors: np.ndarray, weights: np.ndarray, members: np.ndarray) -> float:
    """For a box of colors: the sum of squares of the distances from their mean, with weights."""
    mean = np.average(colors[members], axis=0, weights=weights[members])
    return float((weights[members, None] * (colors[members] - mean) ** 2).sum())


def _bits(indices: np.ndarray, count: int) -> tuple:
    """Bits per pixel that `count` colors need, and the rows in them."""
    bits = next(b for b in (1, 2, 4, 8) if count <= 1 << b)
    per_byte = 8 // bits
    padded = np.pad(indices, ((0, 0), (0, -indices.shape[1] % per_byte)))
    shifts = bits * np.arange(per_byte - 1, -1, -1)
    return bits, (padded.reshape(len(indices), -1, per_byte).astype(int) << shifts).sum(axis=2).astype(np.uint8)


def _file(palette: np.ndarray, indices: np.ndarray) -> bytes:
    height, width = indices.shape
    colors = b"".join(int(code).to_bytes(3, "big") for code in palette)
    bits, packed = _bits(indices, len(palette))
    rows = np.concatenate([np.zeros((height, 1), np.uint8), packed], axis=1)  # filter 0 before each row
    header = struct.pack(">IIBBBBB", width, height, bits, 3, 0, 0, 0)
    chunks = [(b"IHDR", header), (b"PLTE", colors), (b"IDAT", zlib.compress(rows.tobytes(), 9)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(kind, data) for kind, data in chunks)


def write(image: np.ndarray, path: Path) -> None:
    """Writes an image [row, column, channel] of bytes, rows from above, with fewer shades if it is too large."""
    candidates = (reduce_colors(image, step) for step in range(FINEST, COARSEST + 1, FINEST))
    _write_first(candidates, path)


def write_smooth(image: np.ndarray, path: Path, counts=(MAX_COLORS, 128, 64, 32, 16), most: int = MOST_BYTES) -> None:
    """The same with `counts` colors that fit the image, for windows and for pictures with many shades."""
    _write_first((mean_colors(image, count) for count in counts), path, most)


def _write_first(candidates, path: Path, most: int = MOST_BYTES) -> None:
    for palette, indices in candidates:
        data = _file(palette, indices)
        if len(data) <= most:
            path.write_bytes(data)
            return
    raise ValueError(f"{path} has {len(data)} bytes with the fewest colors, {most} are allowed")


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
