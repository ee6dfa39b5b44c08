# SPDX-License-Identifier: BSD-3-Clause
"""Sets of silhouettes for the studies: a set from the user's folder, or families generated from a seed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet

import tautline
from tautline._errors import Error

_NOTE = (
    "The dissertation's set is the 99 silhouettes of T. Sebastian, P. Klein and B. Kimia (Brown University). Give a "
    "folder with them by --data: it has a list labels.csv with the columns file and class, and a folder images. "
    "--unseen is for sets of other classes."
)
_SIZE = 128
_BEST = 10  # matches of a query that count
_MARGIN = 8  # pixels by which images of a folder grow at most on each side, with seeds after the first


def mask(curve: np.ndarray) -> np.ndarray:
    """255 inside a closed curve (n x 2), by counting crossings of each row."""
    y = np.arange(_SIZE, dtype=float)
    image = np.zeros((_SIZE, _SIZE))
    a, b = curve, np.roll(curve, -1, axis=0)
    for row in y:
        crosses = (a[:, 1] <= row) != (b[:, 1] <= row)
        if not crosses.any():
            continue
        p, q = a[crosses], b[crosses]
        x = np.sort(p[:, 0] + (row - p[:, 1]) / (q[:, 1] - p[:, 1]) * (q[:, 0] - p[:, 0]))
        image[int(row)] = 255.0 * (np.searchsorted(x, np.arange(_SIZE)) % 2)
    return image


#: Radius over angle of each family, as (order, amplitude, phase) of cosines.
_FAMILIES = {
    "disc": [(2, 0.08, 0.0)],
    "bean": [(1, 0.28, 0.0), (2, 0.22, 0.4), (3, 0.06, 1.0)],
    "bar": [(2, 0.55, 0.0), (4, 0.18, 0.0)],
    "clover": [(3, 0.33, 0.0)],
    "cross": [(4, 0.38, 0.0)],
    "star": [(5, 0.35, 0.0)],
    "wing": [(2, 0.3, 0.0), (3, 0.3, 0.9), (5, 0.1, 0.3)],
    "hand": [(1, 0.2, 0.0), (6, 0.22, 0.4), (2, 0.12, 1.2)],
    "boot": [(1, 0.3, 0.8), (3, 0.22, 0.0), (4, 0.14, 1.1)],
}


def families(per_class: int = 11, classes: int = 9, seed: int = 1) -> tuple[list[np.ndarray], list[str]]:
    """Deformed, bent, occluded, scaled and turned shapes of up to nine families: images and their classes."""
    random = np.random.default_rng(seed)
    images, labels = [], []
    t = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    for name, terms in list(_FAMILIES.items())[:classes]:
        for member in range(per_class):
            r = np.ones_like(t)
            for order, amplitude, phase in terms:
                r += amplitude * random.uniform(0.8, 1.2) * np.cos(order * t + phase + random.normal(0, 0.12))
            for order in range(2, 7):
                r += random.normal(0, 0.02) * np.cos(order * t + random.uniform(0, 2 * np.pi))
            x, y = r * np.cos(t), r * np.sin(t)
            y = y + random.normal(0, 0.12) * x**2  # bend
            angle, scale = random.normal(0, 0.25), random.uniform(24, 32)
            c, s = np.cos(angle), np.sin(angle)
            curve = np.stack([c * x - s * y, s * x + c * y], axis=1) * scale
            curve += _SIZE / 2 - 0.5 * (curve.min(axis=0) + curve.max(axis=0))
            image = mask(curve)
            if member % 4 == 3:  # occluded: a strip of the image is lost
                cut = int(_SIZE / 2 + random.uniform(0.55, 0.75) * scale)
                image = image.copy()
                image[:, cut:] = 0.0
            images.append(image)
            labels.append(name)
    return images, labels


def images_of(shapes: vtkMultiBlockDataSet) -> tuple[list[np.ndarray], list[str]]:
    """The images [row, column] of a set of tautline.read_silhouettes(), and the classes."""
    images, labels = [], []
    for i in range(shapes.GetNumberOfBlocks()):
        image = shapes.GetBlock(i)
        columns, rows, _ = image.GetDimensions()
        values = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(rows, columns, -1)[..., 0]
        images.append(values)
        labels.append(image.GetFieldData().GetAbstractArray("Label").GetValue(0))
    return images, labels


def moved(images: list[np.ndarray], seed: int) -> list[np.ndarray]:
    """Images with wider borders, by random numbers of pixels: the grid of locations lies elsewhere in the shape."""
    random = np.random.default_rng(seed)
    return [np.pad(image, random.integers(0, _MARGIN + 1, (2, 2)), constant_values=np.median(
        np.concatenate([image[0], image[-1], image[:, 0], image[:, -1]]))) for image in images]


def data_set(folder: str | None, small: bool, seed: int) -> tuple[list[np.ndarray], list[str], int, str]:
    """Images, classes, number of matches that count, description: from a folder, or the families if None.

    folder: has a list labels.csv, or images named by their class, see tautline.read_silhouettes(). With seed 1 its
    images are as they are, see moved() for others.
    small: fewer families of fewer members.
    """
    if folder is not None:
        if not Path(folder).is_dir():
            raise Error(f"{folder}: there is no such folder; it needs a list labels.csv, or images")
        images, labels = images_of(tautline.read_silhouettes(folder))
        text = f"The silhouettes in {Path(folder).name}"
        return (images, labels, _BEST, text) if seed == 1 else (
            moved(images, seed), labels, _BEST, f"{text}, with random borders of seed {seed}")
    per_class, classes = (4, 5) if small else (11, 9)
    shapes, labels = families(per_class, classes, seed)
    text = f"{len(shapes)} synthetic silhouettes of {classes} families, seed {seed}. {_NOTE}"
    return shapes, labels, min(_BEST, per_class - 1), text
