# SPDX-License-Identifier: BSD-3-Clause
"""The functions silhouette, match and retrieval: deformable shapes in images."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any, ClassVar, Iterable, Literal, get_args

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
from ._arguments import check_options, number, pick, set_time_limit
from ._arrays import Array, cell_array, columns, point_array, table_rows
from ._errors import Error, interruptible, run, watch
from ._files import check_input, check_target, file_name, replace_bytes
from ._interrupts import Progress
from ._results import Result

Foreground = Literal["automatic", "bright", "dark"]
FOREGROUNDS: tuple[Foreground, ...] = get_args(Foreground)
Locations = Literal["grid", "near grid", "contour"]
LOCATIONS: tuple[Locations, ...] = get_args(Locations)
Reflection = Literal["forbidden", "whole", "free"]
REFLECTIONS: tuple[Reflection, ...] = get_args(Reflection)
Setting = Literal["custom", "dissertation", "felzenszwalb", "highest"]
SETTINGS: tuple[Setting, ...] = get_args(Setting)
#: The properties of vtkShapeAlgorithm by option.
_OPTIONS = {
    "lambda_": "Lambda", "a": "DeformationWeight", "b": "DistortionWeight", "signed_distortion": "SignedDistortion",
    "smoothing": "Smoothing", "directed_edges": "DirectedEdges", "rotation": "RotationWeight",
    "descriptor": "DescriptorWeight", "ordering": "OrderingWeight", "contour_points": "ContourPoints",
    "centre_tolerance": "CentreTolerance", "max_solutions": "MaximumSolutions", "coarse_to_fine": "CoarseToFine",
    "rotations": "Rotations", "scales": "Scales", "time_limit": "TimeLimit", "threads": "Threads",
}  # fmt: skip


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

    mesh: the triangulated polygon, with `BoundaryOrder`, `EliminationOrder` and `EliminationStep`.
    outline: the traced outline.
    centre, max_distance: center of mass of the area inside the outline, 3, and the largest distance of the outline from
        it, pixels.
    components, holes: number of components of the foreground, of which the largest is taken, and of its holes, which
        are ignored.
    summary: the result in words.
    """

    mesh: vtkUnstructuredGrid
    outline: vtkPolyData
    centre: Array
    max_distance: float
    components: int
    holes: int
    summary: str


@interruptible
def silhouette(
    image: Any,
    spacing: float = 25.0,
    *,
    threshold: float | None = None,
    foreground: Foreground = "automatic",
    time_limit: float = 0.0,
    progress: Progress | bool | None = None,
) -> SilhouetteResult:
    """Trace the silhouette in an image and triangulate a polygon around it (dissertation sections 5.2.1 and 5.2.2).

    image: a vtkImageData, a file name or an array [row, column] or [row, column, channel].
    spacing: ideal distance between vertices along the outline, pixels, above 0.
    threshold: grey value between the shape and the background; None: midway between the extremes.
    foreground: "bright", "dark", or "automatic": the side with fewer pixels on the border of the image.
    time_limit: seconds; 0 is no limit.

    Raises Error for wrong arguments, and for images without a shape.

    >>> shape = tautline.silhouette("fish.png", spacing=12)
    >>> shape.mesh.GetNumberOfCells(), shape.centre
    """
    mesher = _vtk.vtkSilhouetteMesher()
    mesher.SetSpacing(number("spacing", spacing))
    mesher.SetForeground(pick("foreground", foreground, FOREGROUNDS))
    set_time_limit(mesher, time_limit)
    if threshold is not None:
        mesher.SetUseThreshold(True)
        mesher.SetThreshold(number("threshold", threshold))
    mesher.SetInputData(as_image(image))
    run(mesher)
    mesh = mesher.GetOutputDataObject(0)
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

    mesh: the triangles of the source in the target, with `Displacement` and, per triangle, the terms of the energy.
    points, displacement: positions of the vertices in the target, n x 3, and these minus their positions in the source,
        n x 3.
    energy, statistics: the least energy, and all columns of the filter's table by name (see vtkShapeMatcher).
    triangles: per triangle, m, without weights: edge_cost, deformation, distortion; and their weighted sum, energy.
    rank, exact: rank of the solution by its energy (1: the least), and whether no placement of the vertices is better.
    summary: the result in words.
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


@interruptible
def match(
    source: Any,
    target: Any,
    *,
    spacing: float = 25.0,
    locations: Locations = "grid",
    grid: tuple[int, int] = (30, 30),
    reflection: Reflection = "forbidden",
    foreground: Foreground = "automatic",
    grey_gradient: bool = False,
    progress: Progress | bool | None = None,
    **options: Any,
) -> MatchResult:
    """Find a deformable shape in an image: the placement of least energy (dissertation chapter 5).

    source: the result of silhouette(), its mesh, or an image: a vtkImageData, a file name or an array.
    target: an image.
    spacing: ideal distance between vertices, pixels, above 0, if the source is an image.
    locations: candidate positions: "grid" over the image, "near grid" (near the outline only) or "contour" (points on
        the outline, fastest).
    grid: number of columns and rows of the grid, at least 2.
    reflection: "forbidden" (reflected triangles count as flat), "whole" (the shape or its mirror image) or "free"
        (triangles may be reflected at no cost).
    foreground: see silhouette().
    grey_gradient: use the gradient of the grey values instead of that of the silhouette.
    options: properties of vtkShapeAlgorithm: a (weight of the deformation, 12), b (weight of the distortion, 3),
        lambda_ (constant of the edge cost, 0.1), signed_distortion (False), smoothing (standard deviation of the
        Gaussian filter, pixels, 1.5), directed_edges (False), weights rotation, descriptor and ordering (0 each),
        contour_points (60), centre_tolerance (theta / d_max, 1/3; 0: no rule), max_solutions (to try for this rule,
        1000), coarse_to_fine (fast, not exact; False), rotations and scales (to try, 1 each), time_limit (seconds; 0:
        none; the best so far is returned then, or Error raised if the search has not begun), threads (0: all cores).

    Raises Error for wrong arguments, and for images without a shape.

    >>> found = tautline.match("fish.png", "fish-bent.png", locations="contour")
    >>> found.energy, found.displacement
    """
    matcher = _vtk.vtkShapeMatcher()
    messages = watch(matcher)
    matcher.SetSpacing(number("spacing", spacing))
    matcher.SetGreyGradient(bool(grey_gradient))
    _configure(matcher, locations, grid, reflection, foreground, options)
    if isinstance(source, SilhouetteResult):
        source = source.mesh
    is_mesh = isinstance(source, vtkDataSet) and not isinstance(source, vtkImageData)
    matcher.SetInputDataObject(0, source if is_mesh else as_image(source))
    matcher.SetInputDataObject(1, as_image(target))
    run(matcher, messages)
    mesh = matcher.GetOutputDataObject(0)
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

    names, labels: names and classes of the n shapes.
    distances: distance of each query (row) to each target (column), n x n; -1 where the run ended before.
    ranking: per query the numbers of the other shapes, the nearest first, n x (n - 1).
    rate, correct_at: percentage of the best matches that have the class of the query, and per rank the number of
        queries for which the match has their class.
    classes, confusion: percentage of the best matches of each class (row) that have each class (column), in the order
        of `classes`.
    tables: the filter's tables by name: Distances, Ranking, Statistics, Confusion.
    sheet: a picture of each query, in a grey frame, with its best matches (at most 10), in a green frame if they are of
        its class, in a red one if not: size x size x 3 bytes, the top row first. save_sheet() writes it.
    summary: the result in words.
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

    folder: a folder with a list labels.csv; a folder of images without one, whose classes are their file names up to
        the first digit or blank; or another list (.csv). A list has the columns file (relative to the list, or to the
        folder images beside it) and class. Images are PNG, JPEG, TIFF, BMP, binary PGM and PPM files; other files of
        a folder are skipped.

    Returns a block per image, with the field arrays `Label` and `File`; the images are placed side by side, by their
    origins. Raises Error for a list or an image that cannot be read.
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


@interruptible
def retrieval(
    shapes: Any,
    labels: Iterable[Any] | None = None,
    *,
    setting: Setting = "highest",
    spacing: float = 25.0,
    symmetric: bool = False,
    shortlist: int = 0,
    neighbors: int = 0,
    best: int = 10,
    sheet_size: int = 1200,
    locations: Locations = "grid",
    grid: tuple[int, int] = (30, 30),
    reflection: Reflection = "forbidden",
    foreground: Foreground = "automatic",
    progress: Progress | bool | None = None,
    **options: Any,
) -> RetrievalResult:
    """Match each of a set of silhouettes with each other one and rank them by similarity (dissertation section 5.3).

    shapes: a folder or list, see read_silhouettes(), a multiblock data set of images, or a sequence of images.
    labels: the class of each shape, if the set does not have them.
    setting: "highest" (highest recognition rate, and the fastest), "dissertation", "felzenszwalb", or "custom", which
        uses the arguments below.
    spacing: see match().
    symmetric: whether the distance is the sum of both directions.
    shortlist: with "highest", how many others each shape is matched with, those whose descriptors are distributed
        most alike; 0: all. Other distances are -1.
    neighbors: replace the distances by those after diffusion over graphs of so many nearest neighbours, which depend
        on the whole set; 0: do not.
    best: number of matches per query that count, at least 1.
    sheet_size: width and height of the sheet of pictures, pixels, 64 to 20,000.
    locations, grid, reflection, foreground, options: see match().

    Raises Error for wrong arguments, and for images without a shape (with its name).

    >>> result = tautline.retrieval("silhouettes.csv", best=1)
    >>> result.rate
    """
    found = _vtk.vtkShapeRetrieval()
    messages = watch(found)
    found.SetSetting(pick("setting", setting, SETTINGS))
    found.SetSpacing(number("spacing", spacing))
    found.SetSymmetric(bool(symmetric))
    found.SetShortlist(_count("shortlist", shortlist))
    found.SetNeighbors(_count("neighbors", neighbors))
    found.SetBestMatches(int(number("best", best)))
    found.SetSheetSize(int(number("sheet_size", sheet_size)))
    _configure(found, locations, grid, reflection, foreground, options)
    found.SetInputDataObject(0, _as_set(shapes, labels))
    run(found, messages)
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


def _count(name: str, value: Any) -> int:
    count = int(number(name, value))
    if count < 0:
        raise Error(f"{name} is {count}; it must be at least 0")
    return count


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
        images = [as_image(image) for image in shapes]
        shapes = vtkMultiBlockDataSet()
        for i, image in enumerate(images):
            shapes.SetBlock(i, image)
            shapes.GetMetaData(i).Set(vtkCompositeDataSet.NAME(), f"shape {i}")
    if labels is None:
        return shapes
    labels = list(labels)
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


def _configure(
    algorithm: Any, locations: str, grid: Any, reflection: str, foreground: str, options: dict[str, Any]
) -> None:
    algorithm.SetLocations(pick("locations", locations, LOCATIONS))
    algorithm.SetReflection(pick("reflection", reflection, REFLECTIONS))
    algorithm.SetForeground(pick("foreground", foreground, FOREGROUNDS))
    try:
        grid_columns, grid_rows = (int(n) for n in grid)
    except (TypeError, ValueError):
        raise Error(f"grid is {grid!r}; columns and rows are expected") from None
    algorithm.SetGridSize(grid_columns, grid_rows)
    check_options(options, _OPTIONS)
    for name, value in {"time_limit": 0, **options}.items():
        checked = number(name, value)
        whole = isinstance(getattr(algorithm, f"Get{_OPTIONS[name]}")(), int)
        getattr(algorithm, f"Set{_OPTIONS[name]}")(int(checked) if whole else checked)


def _texts(table: vtkTable, name: str) -> list[str]:
    column = table.GetColumnByName(name)
    return [column.GetValue(i) for i in range(column.GetNumberOfValues())] if column else []


def _numbers(table: vtkTable, column: int) -> Array:
    return np.asarray(vtk_to_numpy(table.GetColumn(column)), float)


# --- the shell ----------------------------------------------------------------------------------------------


def add_commands(commands: Any) -> None:
    """Add `silhouette`, `match` and `retrieval` to the subparsers of the command line."""
    parser = _commands.add_command(
        commands, "silhouette", _run_silhouette, "trace the silhouette in an image, triangulate it", threads=False,
        example="fish.png --spacing 12 -o fish.vtu",
        details="The largest component of the foreground counts.",
    )
    parser.add_argument("image")
    _add_spacing(parser)
    parser.add_argument("--threshold", type=float, help="grey value between the shape and the background")
    parser.add_argument("--foreground", choices=FOREGROUNDS, default="automatic")
    _commands.add_output(parser)
    _commands.add_time_limit(parser)

    parser = _commands.add_command(
        commands, "match", _run_match, "find a deformable shape in an image",
        example="fish.png fish-bent.png --locations contour --spacing 12 -o found.vtu",
        details="Prints the least energy and, with --output, writes the triangles in the target.",
    )
    parser.add_argument("source", help="an image")
    parser.add_argument("target", help="an image")
    _add_spacing(parser)
    _add_matching(parser)
    parser.add_argument("--grey-gradient", action="store_true",
                        help="use the gradient of the grey values instead of that of the silhouette")  # fmt: skip
    _commands.add_extras(parser, "of the energy and the search", _EXTRAS)
    _commands.add_output(parser, "write the detected mesh", False)
    _commands.add_time_limit(parser)

    parser = _commands.add_command(
        commands, "retrieval", _run_retrieval, "rank a set of silhouettes by similarity, compute the recognition rate",
        example="silhouettes.csv --best 1",
        details="Each is matched with each other one (dissertation, section 5.3).",
    )
    parser.add_argument("shapes", help="a folder of images, or a list (.csv) with the columns file and class")
    parser.add_argument("--labels", metavar="CLASS,...", type=lambda text: text.split(","),
                        help="the class of each shape, if the set does not have them")  # fmt: skip
    parser.add_argument("--setting", choices=SETTINGS, default="highest", help="custom: by the options of the match")
    _add_spacing(parser)
    _add_matching(parser)
    parser.add_argument("--symmetric", action="store_true", help="the distance is the sum of both directions")
    _commands.add_extras(parser, "of the energy and the search, with --setting custom", _EXTRAS)
    parser.add_argument("--shortlist", type=int, default=0,
                        help="match each shape with so many others only; 0: all (default: 0)")  # fmt: skip
    parser.add_argument("--neighbors", type=int, default=0,
                        help="neighbours for the diffusion of distances; 0: none (default: 0)")  # fmt: skip
    parser.add_argument("--best", type=int, default=10, help="number of matches per query that count (default: 10)")
    parser.add_argument("--csv", metavar="FILE", help="write the best matches of each shape")
    parser.add_argument("--sheet", metavar="FILE.png", help="write a picture of the shapes with their best matches")
    parser.add_argument("--sheet-size", type=int, default=1200, metavar="PIXELS",
                        help="its width and height (default: 1200)")  # fmt: skip
    _commands.add_time_limit(parser)


def _add_spacing(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--spacing", type=float, default=25.0, help="of the vertices, pixels (default: 25)")


def _add_matching(parser: argparse.ArgumentParser) -> None:
    """Add the candidate positions and what may be reflected."""
    parser.add_argument("--locations", choices=LOCATIONS, default="grid")
    parser.add_argument("--grid", type=int, nargs=2, default=(30, 30), metavar=("COLUMNS", "ROWS"))
    parser.add_argument("--reflection", choices=REFLECTIONS, default="forbidden")
    parser.add_argument("--foreground", choices=FOREGROUNDS, default="automatic")


_EXTRAS: tuple[_commands.Extra, ...] = (
    ("a", float, "weight of the deformation (default: 12)"),
    ("b", float, "weight of the distortion (default: 3)"),
    ("lambda_", float, "constant of the edge cost (default: 0.1)"),
    ("signed_distortion", bool, "whether the distortion tells growing from shrinking"),
    ("smoothing", float, "standard deviation of the Gaussian filter, pixels (default: 1.5)"),
    ("directed_edges", bool, "whether edges must have the shape on their inner side"),
    ("rotation", float, "weight of 1 - cos(angle a triangle turns by) (default: 0)"),
    ("descriptor", float, "weight of the difference between surroundings of vertices (default: 0)"),
    ("ordering", float, "weight of unequal lengths along the outline, of contour (default: 0)"),
    ("contour_points", int, "points of --locations contour (default: 60)"),
    ("centre_tolerance", float, "theta / d_max; 0: no rule (default: 1/3)"),
    ("max_solutions", int, "to try for this rule (default: 1000)"),
    ("coarse_to_fine", bool, "whether to search coarsely first: fast, not exact"),
    ("rotations", int, "orientations to try, 1 to 360 (default: 1)"),
    ("scales", int, "sizes to try, odd, 1 to 31 (default: 1)"),
)


def _run_silhouette(arguments: argparse.Namespace) -> None:
    options = _commands.given(arguments, ("spacing", "threshold", "foreground", "time_limit"))
    result = silhouette(arguments.image, **options)
    _commands.finish(arguments, result, result.summary)


def _run_match(arguments: argparse.Namespace) -> None:
    names = ("spacing", "locations", "grid", "reflection", "foreground", "grey_gradient", "time_limit", "threads")
    options = _commands.given(arguments, names) | _commands.given_extras(arguments, _EXTRAS)
    result = match(arguments.source, arguments.target, **options)
    _commands.finish(arguments, result, result.summary)


def _run_retrieval(arguments: argparse.Namespace) -> None:
    if arguments.sheet:
        _check_sheet(arguments.sheet)
    names = ("labels", "setting", "spacing", "locations", "grid", "reflection", "foreground", "symmetric", "shortlist",
             "neighbors", "best", "sheet_size", "time_limit", "threads")  # fmt: skip
    options = _commands.given(arguments, names) | _commands.given_extras(arguments, _EXTRAS)
    result = retrieval(arguments.shapes, **options)
    ranks = "right at rank " + ", ".join(f"{k}: {n}" for k, n in enumerate(result.correct_at, 1))
    rows = table_rows(columns(result.tables["Ranking"]))
    _commands.finish(arguments, result, f"{result.summary}\n{ranks}", rows)
    if arguments.sheet:
        result.save_sheet(arguments.sheet)
