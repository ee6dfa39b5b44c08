# SPDX-License-Identifier: BSD-3-Clause
"""The results of silhouette(), match() and retrieval(), images, and arguments that are not one property each."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any, ClassVar, Iterable

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkStringArray
from vtkmodules.vtkCommonDataModel import (
    vtkCompositeDataSet,
    vtkDataSet,
    vtkImageData,
    vtkMultiBlockDataSet,
    vtkPolyData,
    vtkTable,
    vtkUnstructuredGrid,
)
from vtkmodules.vtkIOImage import vtkPNGWriter

from . import _commands, _vtk
from ._arguments import number, sequence, sets
from ._arrays import Array, cell_array, columns, point_array, table_rows
from ._errors import Error, interruptible, run
from ._files import check_input, check_target, file_name, replace_bytes
from ._interrupts import Progress
from ._results import Result

def as_image(image: Any) -> vtkImageData:
    """The vtkImageData of a vtkImageData, a file name, or an array [row, column] or [row, column, channel].

    A file is PNG, JPEG, TIFF, BMP, binary PGM or PPM. The first row of an array is at y = 0, the lower edge of the
    image. Raises Error for anything else, and for a file that cannot be read.
    """
    if isinstance(image, vtkImageData):
        return image
    if isinstance(image, (str, PathLike)):
        name = file_name(image)
        check_input(name)
        reader = _vtk.vtkImageFileReader()
        reader.SetFileName(name)
        run(reader)
        return reader.GetOutput()
    try:
        array = np.asarray(image, float)
    except (TypeError, ValueError):
        raise Error(f"an image is expected, not {type(image).__name__}") from None
    if array.ndim not in (2, 3) or 0 in array.shape:
        raise Error(f"an image has the axes [row, column] or [row, column, channel], this array {array.shape}")
    made = vtkImageData()
    made.SetDimensions(array.shape[1], array.shape[0], 1)
    values = numpy_to_vtk(np.ascontiguousarray(array.reshape(array.shape[0] * array.shape[1], -1)), deep=True)
    values.SetName("Pixels")
    made.GetPointData().SetScalars(values)
    return made


@dataclass(frozen=True, repr=False, eq=False)
class SilhouetteResult(Result):
    """The result of silhouette().

    Attributes
    ----------
    mesh : vtkUnstructuredGrid
        The triangulated polygon, with `BoundaryOrder`, `EliminationOrder` and `EliminationStep`.
    outline : vtkPolyData
        The traced outline.
    centre, max_distance : Array, float
        Center of mass of the area inside the outline, 3, and the largest distance of the outline from it, pixels.
    components, holes : int
        Number of components of the foreground, of which the largest is taken, and of its holes, which are ignored.
    summary : str
        The result in words.
    """

    mesh: vtkUnstructuredGrid
    outline: vtkPolyData
    centre: Array
    max_distance: float
    components: int
    holes: int
    summary: str


def silhouette_input(filter_: Any, image: Any) -> None:
    """Set the image.

    image: a vtkImageData, a file name or an array [row, column] or [row, column, channel].
    """
    filter_.SetInputData(as_image(image))


@sets("silhouette", "UseThreshold", "Threshold")
def set_threshold(filter_: Any, threshold: float | None = None) -> None:
    """Set the threshold.

    threshold: gray value between the shape and the background; None: midway between the extremes.
    """
    if threshold is not None:
        filter_.SetUseThreshold(True)
        filter_.SetThreshold(number("threshold", threshold))


def silhouette_result(mesher: Any, mesh: vtkUnstructuredGrid) -> SilhouetteResult:
    """The result of a filter that has run."""
    fields = mesh.GetFieldData()
    if not mesh.GetNumberOfPoints():
        raise Error("the image is empty")
    return SilhouetteResult(
        mesh=mesh,
        outline=mesher.GetOutputDataObject(1),
        centre=vtk_to_numpy(fields.GetArray("CentreOfMass"))[0].copy(),
        max_distance=fields.GetArray("MaximumDistance").GetValue(0),
        components=mesher.GetNumberOfComponents(),
        holes=mesher.GetNumberOfHoles(),
        summary=mesher.GetSummary(),
    )


@dataclass(frozen=True, repr=False, eq=False)
class MatchResult(Result):
    """The result of match().

    Attributes
    ----------
    mesh : vtkUnstructuredGrid
        The triangles of the source in the target, with `Displacement` and, per triangle, the terms of the energy.
    points, displacement : Array
        Positions of the vertices in the target, n x 3, and these minus their positions in the source, n x 3.
    energy, statistics : float, dict[str, float]
        The smallest energy, and all columns of the filter's table by name (see vtkShapeMatcher).
    triangles : dict[str, Array]
        Per triangle, m, without weights: edge_cost, deformation, distortion; and their weighted sum, energy.
    rank, exact : int, bool
        Rank of the solution by its energy (1: the smallest), and whether it is proved that no placement is better.
    summary : str
        The result in words.
    """

    _per_element: ClassVar[tuple[str, ...]] = ("points", "displacement", "triangles")
    mesh: vtkUnstructuredGrid
    points: Array
    displacement: Array
    energy: float
    statistics: dict[str, float]
    triangles: dict[str, Array]
    rank: int
    exact: bool
    summary: str


def match_input(filter_: Any, source: Any, target: Any) -> None:
    """Set the shape and the image.

    source: the result of silhouette(), its mesh, or an image: a vtkImageData, a file name or an array.
    target: an image.
    """
    if isinstance(source, SilhouetteResult):
        source = source.mesh
    is_mesh = isinstance(source, vtkDataSet) and not isinstance(source, vtkImageData)
    filter_.SetInputDataObject(0, source if is_mesh else as_image(source))
    filter_.SetInputDataObject(1, as_image(target))


@sets("match retrieval", "GridSize")
def set_grid(filter_: Any, grid: tuple[int, int] = (30, 30)) -> None:
    """Set the size of the grid.

    grid: number of columns and rows of the grid, at least 2.
    """
    try:
        grid_columns, grid_rows = (int(n) for n in grid)
    except (TypeError, ValueError):
        raise Error(f"grid is {grid!r}; columns and rows are expected") from None
    filter_.SetGridSize(grid_columns, grid_rows)


def match_result(matcher: Any, mesh: vtkUnstructuredGrid) -> MatchResult:
    """The result of a filter that has run."""
    if not mesh.GetNumberOfPoints():
        raise Error("the source or the target is empty")
    table = matcher.GetOutputDataObject(1)
    names = {"EdgeCost": "edge_cost", "Deformation": "deformation", "Distortion": "distortion", "Energy": "energy"}
    return MatchResult(
        mesh=mesh,
        points=vtk_to_numpy(mesh.GetPoints().GetData()).copy(),
        displacement=point_array(mesh, "Displacement"),
        energy=matcher.GetEnergy(),
        statistics={
            table.GetColumnName(i): table.GetValue(0, i).ToDouble() for i in range(table.GetNumberOfColumns())
        },
        triangles={key: cell_array(mesh, name) for name, key in names.items()},
        rank=matcher.GetRank(),
        exact=bool(matcher.GetExact()),
        summary=matcher.GetSummary(),
    )


@dataclass(frozen=True, repr=False, eq=False)
class RetrievalResult(Result):
    """The result of retrieval().

    Attributes
    ----------
    names, labels : list[str]
        Names and classes of the n shapes.
    distances : Array
        Distance of each query (row) to each target (column), n x n; -1 where the run ended before.
    ranking : Array
        Per query the numbers of the other shapes, the nearest first, n x (n - 1).
    rate, correct_at : float, Array
        Percentage of the best matches that have the class of the query, and per rank the number of queries for which
        the match has their class.
    classes, confusion : list[str], Array
        Percentage of the best matches of each class (row) that have each class (column), in the order of `classes`.
    tables : dict[str, vtkTable]
        The filter's tables by name: Distances, Ranking, Statistics, Confusion.
    sheet : Array
        A picture of each query, in a gray frame, with its best matches (at most 10), in a green frame if they are of
        its class, in a red one if not: size x size x 3 bytes, the top row first. save_sheet() writes it.
    summary : str
        The result in words.
    """

    names: list[str]
    labels: list[str]
    distances: Array
    ranking: Array
    rate: float
    correct_at: Array
    classes: list[str]
    confusion: Array
    tables: dict[str, vtkTable]
    sheet: Array
    summary: str

    def save_sheet(self, file: str | PathLike[str]) -> None:
        """Write the sheet of pictures as a PNG file. Raises Error if it cannot be written, or is not named .png."""
        _check_sheet(file)
        image = vtkImageData()
        image.SetDimensions(self.sheet.shape[1], self.sheet.shape[0], 1)
        image.GetPointData().SetScalars(numpy_to_vtk(self.sheet[::-1].reshape(-1, 3), deep=True))
        writer = vtkPNGWriter()
        writer.WriteToMemoryOn()
        writer.SetInputData(image)
        writer.Write()
        replace_bytes(file, vtk_to_numpy(writer.GetResult()).tobytes())


@interruptible
def read_silhouettes(
    folder: str | PathLike[str],
    *,
    progress: Progress | bool | None = None,
) -> vtkMultiBlockDataSet:
    """Read a set of images with their classes.

    Parameters
    ----------
    folder : str or path
        A folder with a list labels.csv; a folder of images without one, whose classes are their file names up to the
        first digit or blank; or another list (.csv). A list has the columns file (relative to the list, or to the
        folder images beside it) and class. Images are PNG, JPEG, TIFF, BMP, binary PGM and PPM files; other files of a
        folder are skipped.
    progress : bool or callable, optional
        True: a bar on the terminal, if there is one. Otherwise a function, called ten times a second with the fraction
        done, 0 to 1, and a text; it cancels by returning False, which raises Aborted. Ctrl-C raises KeyboardInterrupt.

    Returns
    -------
    vtkMultiBlockDataSet
        A block per image, with the field arrays `Label` and `File`; the images are placed side by side, by their
        origins.

    Raises
    ------
    Error
        For a list or an image that cannot be read.
    """
    path = Path(file_name(folder))
    if path.is_dir() and (path / "labels.csv").is_file():
        path = path / "labels.csv"
    if not path.is_dir():
        check_input(path)
    reader = _vtk.vtkSilhouetteSetReader()
    reader.SetFileName(str(path))
    run(reader)
    return reader.GetOutputDataObject(0)


def retrieval_input(filter_: Any, shapes: Any, labels: Iterable[Any] | None = None) -> None:
    """Set the images.

    shapes: a folder or list, see read_silhouettes(), a multiblock data set of images, or a sequence of images.
    labels: the class of each shape, if the set does not have them.
    """
    filter_.SetInputDataObject(0, _as_set(shapes, labels))


def retrieval_result(found: Any, _distances: vtkTable) -> RetrievalResult:
    """The result of a filter that has run."""
    tables = {name: found.GetOutputDataObject(i) for i, name in enumerate(
        ("Distances", "Ranking", "Statistics", "Confusion"))}  # fmt: skip
    names, classes = _texts(tables["Distances"], "Name"), _texts(tables["Confusion"], "Label")
    distances = np.array([_numbers(tables["Distances"], i + 2) for i in range(len(names))]).T
    order = np.where(distances < 0, np.inf, distances)
    np.fill_diagonal(order, -1.0)
    return RetrievalResult(
        names=names,
        labels=_texts(tables["Distances"], "Label"),
        distances=distances,
        ranking=np.argsort(order, axis=1, kind="stable")[:, 1:],
        rate=found.GetRecognitionRate(),
        correct_at=_numbers(tables["Statistics"], 1).astype(int),
        classes=classes,
        confusion=np.array([_numbers(tables["Confusion"], i + 1) for i in range(len(classes))]).T,
        tables=tables,
        sheet=_sheet(found.GetOutputDataObject(len(tables))),
        summary=found.GetSummary(),
    )


def _check_sheet(file: str | PathLike[str]) -> None:
    check_target(file)
    if not str(file).lower().endswith(".png"):
        raise Error(f"{file}: the sheet of pictures is a PNG file; give it a name that ends in .png.")


def _sheet(image: vtkImageData) -> Array:
    columns_, rows, _ = image.GetDimensions()
    pixels = image.GetPointData().GetScalars()
    sheet: Array = np.empty((0, 0, 3), np.uint8)
    if pixels:
        sheet = vtk_to_numpy(pixels).reshape(rows, columns_, 3)[::-1].copy()
    return sheet


def _as_set(shapes: Any, labels: Iterable[Any] | None) -> vtkMultiBlockDataSet:
    if isinstance(shapes, (str, PathLike)):
        shapes = read_silhouettes(shapes)
    if not isinstance(shapes, vtkMultiBlockDataSet):
        if not isinstance(shapes, Iterable):
            raise Error(f"a set of shapes is a folder, a list of images or blocks, not {type(shapes).__name__}")
        images = [as_image(image) for image in sequence("shapes", shapes)]
        if not images:
            raise Error("shapes has no images")
        shapes = vtkMultiBlockDataSet()
        for i, image in enumerate(images):
            shapes.SetBlock(i, image)
            shapes.GetMetaData(i).Set(vtkCompositeDataSet.NAME(), f"shape {i}")
    if labels is None:
        return shapes
    labels = sequence("labels", labels)
    if len(labels) != shapes.GetNumberOfBlocks():
        raise Error(f"{len(labels)} labels for {shapes.GetNumberOfBlocks()} shapes")
    labelled = vtkMultiBlockDataSet()
    labelled.CopyStructure(shapes)
    for i, label in enumerate(labels):
        image = vtkImageData()
        image.ShallowCopy(shapes.GetBlock(i))
        text = vtkStringArray()
        text.SetName("Label")
        text.InsertNextValue(str(label))
        image.GetFieldData().AddArray(text)
        labelled.SetBlock(i, image)
    return labelled


def _texts(table: vtkTable, name: str) -> list[str]:
    column = table.GetColumnByName(name)
    return [column.GetValue(i) for i in range(column.GetNumberOfValues())] if column else []


def _numbers(table: vtkTable, column: int) -> Array:
    return np.asarray(vtk_to_numpy(table.GetColumn(column)), float)


# --- the shell ----------------------------------------------------------------------------------------------


def add_silhouette_options(parser: argparse.ArgumentParser) -> None:
    """Add the image, and the options of these arguments."""
    parser.add_argument("image")
    parser.add_argument("--threshold", type=float, help="gray value between the shape and the background")


def silhouette_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """The values of these options."""
    return _commands.given(arguments, ("threshold",))


def finish_silhouette(arguments: argparse.Namespace, result: SilhouetteResult) -> None:
    """Print the result of the command."""
    _commands.finish(arguments, result, result.summary)


def _add_grid(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--grid", type=int, nargs=2, default=(30, 30), metavar=("COLUMNS", "ROWS"))


def add_match_options(parser: argparse.ArgumentParser) -> None:
    """Add the images, and the options of these arguments."""
    parser.add_argument("source", help="an image")
    parser.add_argument("target", help="an image")
    _add_grid(parser)


def match_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """The values of these options."""
    return _commands.given(arguments, ("grid",))


def finish_match(arguments: argparse.Namespace, result: MatchResult) -> None:
    """Print the result of the command."""
    _commands.finish(arguments, result, result.summary)


def add_retrieval_options(parser: argparse.ArgumentParser) -> None:
    """Add the shapes, and the options of these arguments and of the sheet."""
    parser.add_argument("shapes", help="a folder of images, or a list (.csv) with the columns file and class")
    parser.add_argument("--labels", metavar="CLASS,...", type=lambda text: text.split(","),
                        help="the class of each shape, if the set does not have them")  # fmt: skip
    parser.add_argument("--sheet", metavar="FILE.png", help="write a picture of the shapes with their best matches")
    _add_grid(parser)


def retrieval_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """The values of these options."""
    if arguments.sheet:
        _check_sheet(arguments.sheet)
    return _commands.given(arguments, ("labels", "grid"))


def finish_retrieval(arguments: argparse.Namespace, result: RetrievalResult) -> None:
    """Print the result of the command."""
    ranks = "right at rank " + ", ".join(f"{k}: {n}" for k, n in enumerate(result.correct_at, 1))
    rows = table_rows(columns(result.tables["Ranking"]))
    _commands.finish(arguments, result, f"{result.summary}\n{ranks}", rows)
    if arguments.sheet:
        result.save_sheet(arguments.sheet)
