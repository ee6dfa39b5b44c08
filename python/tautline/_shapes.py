"""The verbs silhouette, match and retrieval, and their commands."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path
from typing import Any, Iterable

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
from vtkmodules.vtkIOImage import vtkImageReader2Factory

import tautline

from ._errors import Error, run, watch
from ._mesh import cell_array, point_array
from ._metrics import pick

FOREGROUNDS = ("automatic", "bright", "dark")
LOCATIONS = ("grid", "near grid", "contour")
REFLECTIONS = ("forbidden", "whole", "free")
SETTINGS = ("custom", "dissertation", "felzenszwalb", "highest")
_OPTIONS = {
    "lambda_": "Lambda", "a": "DeformationWeight", "b": "DistortionWeight", "signed_distortion": "SignedDistortion",
    "smoothing": "Smoothing", "directed_edges": "DirectedEdges", "rotation": "RotationWeight",
    "descriptor": "DescriptorWeight", "ordering": "OrderingWeight", "contour_points": "ContourPoints",
    "centre_tolerance": "CentreTolerance", "max_solutions": "MaximumSolutions", "coarse_to_fine": "CoarseToFine",
    "rotations": "Rotations", "scales": "Scales", "time_limit": "TimeLimit", "threads": "Threads",
}  # fmt: skip


def as_image(image: Any) -> vtkImageData:
    """A vtkImageData of an image, a file name or an array [row, column] or [row, column, channel].

    The first row of an array is at y = 0, the lower edge. Raises Error for what is none of these.
    """
    if isinstance(image, vtkImageData):
        return image
    if isinstance(image, (str, PathLike)):
        name = fspath(image)
        if not Path(name).is_file():
            raise Error(f"{name}: there is no such file")
        reader = vtkImageReader2Factory.CreateImageReader2(name)
        if reader is None:
            raise Error(f"{name}: not an image VTK can read")
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


@dataclass(frozen=True)
class SilhouetteMesh:
    """What silhouette() made."""

    #: The triangulated polygon, with `BoundaryOrder`, `EliminationOrder` and `EliminationStep`.
    mesh: vtkUnstructuredGrid
    #: The traced outline.
    outline: vtkPolyData
    #: Centre of mass of the area inside the outline, and the largest distance of the outline from it.
    centre: np.ndarray
    max_distance: float
    #: Components of the foreground, and holes in the largest one; both are ignored.
    components: int
    holes: int
    #: The result in words.
    summary: str


def silhouette(
    image: Any, spacing: float = 25.0, *, threshold: float | None = None, foreground: str = "automatic"
) -> SilhouetteMesh:
    """The triangulated polygon around what an image shows (dissertation sections 5.2.1 and 5.2.2).

    image: a vtkImageData, a file name or an array, see as_image().
    spacing: ideal distance of vertices along the outline, pixels, above 0.
    threshold: grey value between the shape and its surroundings; None: midway between the extremes.
    foreground: "bright", "dark", or "automatic": the side that fewer pixels of the border are on.

    Raises Error for wrong arguments, and for images without a shape.
    """
    mesher = tautline.vtkSilhouetteMesher()
    mesher.SetSpacing(_number("spacing", spacing))
    mesher.SetForeground(pick("foreground", foreground, FOREGROUNDS))
    if threshold is not None:
        mesher.SetUseThreshold(True)
        mesher.SetThreshold(_number("threshold", threshold))
    mesher.SetInputData(as_image(image))
    run(mesher)
    mesh = mesher.GetOutputDataObject(0)
    fields = mesh.GetFieldData()
    if not mesh.GetNumberOfPoints():
        raise Error("the image is empty")
    return SilhouetteMesh(
        mesh=mesh,
        outline=mesher.GetOutputDataObject(1),
        centre=vtk_to_numpy(fields.GetArray("CentreOfMass"))[0].copy(),
        max_distance=fields.GetArray("MaximumDistance").GetValue(0),
        components=mesher.GetNumberOfComponents(),
        holes=mesher.GetNumberOfHoles(),
        summary=mesher.GetSummary(),
    )


@dataclass(frozen=True)
class Match:
    """What match() found."""

    #: The source's triangles in the target, with `Displacement` and, per triangle, the terms of the energy.
    mesh: vtkUnstructuredGrid
    #: Places of the vertices in the target, n x 3, and where they came from: place minus source.
    points: np.ndarray
    displacement: np.ndarray
    #: The least energy, and everything in the filter's table by name (see vtkShapeMatcher).
    energy: float
    statistics: dict[str, float]
    #: Per triangle, unweighted: edge_cost, deformation, distortion; and their weighted sum, energy.
    triangles: dict[str, np.ndarray]
    #: Rank of the solution taken (1: the least energy); whether no placement is better.
    rank: int
    exact: bool
    #: The result in words.
    summary: str


def match(
    source: Any,
    target: Any,
    *,
    spacing: float = 25.0,
    locations: str = "grid",
    grid: tuple[int, int] = (30, 30),
    reflection: str = "forbidden",
    foreground: str = "automatic",
    grey_gradient: bool = False,
    **options: Any,
) -> Match:
    """Find a deformable shape in an image: the placement of least energy (dissertation chapter 5).

    source: what silhouette() gave, its mesh, or an image, see as_image().
    target: an image.
    spacing: distance of vertices, pixels, if the source is an image.
    locations: "grid" over the image, "near grid" (only near the outline) or "contour" (points on it, fastest).
    grid: columns and rows. reflection: "forbidden", "whole" or "free". foreground: see silhouette().
    grey_gradient: take the gradient of the grey values, not of the silhouette.
    options: a (12), b (3), lambda_ (0.1), centre_tolerance (1/3; 0: no rule), contour_points (60), smoothing (1.5),
        max_solutions, signed_distortion, directed_edges, rotation, descriptor, ordering, coarse_to_fine, rotations,
        scales, time_limit, threads: the properties of vtkShapeAlgorithm.

    Raises Error for wrong arguments, and for images without a shape.
    """
    matcher = tautline.vtkShapeMatcher()
    messages = watch(matcher)
    matcher.SetSpacing(_number("spacing", spacing))
    matcher.SetGreyGradient(bool(grey_gradient))
    _configure(matcher, locations, grid, reflection, foreground, options)
    if isinstance(source, SilhouetteMesh):
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
    return Match(
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


@dataclass(frozen=True)
class Retrieved:
    """What retrieval() found."""

    #: Names and classes of the shapes.
    names: list[str]
    labels: list[str]
    #: Distance of each query (row) to each target; -1 where the run ended before.
    distances: np.ndarray
    #: Per query the numbers of the others, nearest first.
    ranking: np.ndarray
    #: Percentage of the best matches that are of the query's class, and the queries right at each rank.
    rate: float
    correct_at: np.ndarray
    #: Percentage of the best matches of each class (row) that are of each class, in the order of `classes`.
    classes: list[str]
    confusion: np.ndarray
    #: The filter's tables by name: Distances, Ranking, Statistics, Confusion.
    tables: dict[str, vtkTable]
    #: The result in words.
    summary: str


def read_silhouettes(folder: str | PathLike) -> vtkMultiBlockDataSet:
    """The images of a folder, or of the list folder/labels.csv if there is one, or of another list (.csv)."""
    path = Path(fspath(folder))
    if path.is_dir() and (path / "labels.csv").is_file():
        path = path / "labels.csv"
    reader = tautline.vtkSilhouetteSetReader()
    reader.SetFileName(str(path))
    run(reader)
    return reader.GetOutputDataObject(0)


def retrieval(
    shapes: Any,
    labels: Iterable[Any] | None = None,
    *,
    setting: str = "highest",
    spacing: float = 25.0,
    symmetric: bool = False,
    best: int = 10,
    locations: str = "grid",
    grid: tuple[int, int] = (30, 30),
    reflection: str = "forbidden",
    foreground: str = "automatic",
    **options: Any,
) -> Retrieved:
    """Match each of a set of silhouettes with each other one (dissertation section 5.3).

    shapes: a folder or list, see read_silhouettes(), a multiblock of images, or a sequence of images, see as_image().
    labels: the class of each shape, if the set does not tell.
    setting: "highest" (rate, and the fastest), "dissertation", "felzenszwalb", or "custom": the options below.
    best: matches per query that count.
    The others are those of match(); symmetric: count both directions.

    Raises Error for wrong arguments, and for images without a shape (with its name).
    """
    found = tautline.vtkShapeRetrieval()
    messages = watch(found)
    found.SetSetting(pick("setting", setting, SETTINGS))
    found.SetSpacing(_number("spacing", spacing))
    found.SetSymmetric(bool(symmetric))
    found.SetBestMatches(int(_number("best", best)))
    _configure(found, locations, grid, reflection, foreground, options)
    found.SetInputDataObject(0, _as_set(shapes, labels))
    run(found, messages)
    tables = {name: found.GetOutputDataObject(i) for i, name in enumerate(
        ("Distances", "Ranking", "Statistics", "Confusion"))}  # fmt: skip
    names, classes = _texts(tables["Distances"], "Name"), _texts(tables["Confusion"], "Label")
    distances = np.array([_numbers(tables["Distances"], i + 2) for i in range(len(names))]).T
    order = np.where(distances < 0, np.inf, distances)
    np.fill_diagonal(order, -1.0)
    return Retrieved(
        names=names,
        labels=_texts(tables["Distances"], "Label"),
        distances=distances,
        ranking=np.argsort(order, axis=1, kind="stable")[:, 1:],
        rate=found.GetRecognitionRate(),
        correct_at=_numbers(tables["Statistics"], 1).astype(int),
        classes=classes,
        confusion=np.array([_numbers(tables["Confusion"], i + 1) for i in range(len(classes))]).T,
        tables=tables,
        summary=found.GetSummary(),
    )


def _as_set(shapes: Any, labels: Iterable[Any] | None) -> vtkMultiBlockDataSet:
    if isinstance(shapes, (str, PathLike)):
        shapes = read_silhouettes(shapes)
    if not isinstance(shapes, vtkMultiBlockDataSet):
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
        columns, rows = (int(n) for n in grid)
    except (TypeError, ValueError):
        raise Error(f"grid is {grid!r}; columns and rows are expected") from None
    algorithm.SetGridSize(columns, rows)
    for name, value in options.items():
        if name not in _OPTIONS:
            raise Error(f"there is no option '{name}'; there are {', '.join(sorted(_OPTIONS))}")
        number = _number(name, value)
        whole = isinstance(getattr(algorithm, f"Get{_OPTIONS[name]}")(), int)
        getattr(algorithm, f"Set{_OPTIONS[name]}")(int(number) if whole else number)


def _number(name: str, value: Any) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise Error(f"{name} is {value!r}; a number is expected") from None
    if not np.isfinite(number):
        raise Error(f"{name} is {number}; it must be finite")
    return number


def _texts(table: vtkTable, name: str) -> list[str]:
    column = table.GetColumnByName(name)
    return [column.GetValue(i) for i in range(column.GetNumberOfValues())] if column else []


def _numbers(table: vtkTable, column: int) -> np.ndarray:
    return vtk_to_numpy(table.GetColumn(column)).astype(float)


def add_commands(commands: Any) -> None:
    """Add `silhouette`, `match` and `retrieval` to the subparsers of the command line; each sets `run`."""
    parser = commands.add_parser("silhouette", help="the triangulated polygon around what an image shows")
    parser.add_argument("image")
    parser.add_argument("--spacing", type=float, default=25.0, help="of the vertices, pixels (default: 25)")
    parser.add_argument("--threshold", type=float, help="grey value between the shape and its surroundings")
    parser.add_argument("--foreground", choices=FOREGROUNDS, default="automatic")
    parser.add_argument("-o", "--output", required=True, help="mesh to write")
    parser.set_defaults(run=_run_silhouette)

    parser = commands.add_parser("match", help="find a shape in an image")
    parser.add_argument("source", help="an image")
    parser.add_argument("target", help="an image")
    parser.add_argument("--spacing", type=float, default=25.0, help="of the vertices, pixels (default: 25)")
    parser.add_argument("--locations", choices=LOCATIONS, default="grid")
    parser.add_argument("--grid", type=int, nargs=2, default=(30, 30), metavar=("COLUMNS", "ROWS"))
    _add_energy(parser)
    parser.add_argument("-o", "--output", help="write the detected mesh")
    parser.set_defaults(run=_run_match)

    parser = commands.add_parser("retrieval", help="match each of a set of silhouettes with each other one")
    parser.add_argument("shapes", help="a folder of images, or a list (.csv) with the columns file and class")
    parser.add_argument("--setting", choices=SETTINGS, default="highest")
    parser.add_argument("--best", type=int, default=10, help="matches per query that count (default: 10)")
    parser.add_argument("--threads", type=int, default=0, help="0, the default, is all cores")
    parser.add_argument("--csv", metavar="FILE", help="write the best matches of each shape")
    parser.set_defaults(run=_run_retrieval)


def _add_energy(parser: Any) -> None:
    parser.add_argument("-a", type=float, default=12.0, help="weight of the deformation (default: 12)")
    parser.add_argument("-b", type=float, default=3.0, help="weight of the distortion (default: 3)")
    parser.add_argument("--centre-tolerance", type=float, default=1 / 3, help="theta / d_max; 0: no rule")
    parser.add_argument("--threads", type=int, default=0, help="0, the default, is all cores")


def _run_silhouette(arguments: Any) -> int:
    result = silhouette(
        arguments.image, arguments.spacing, threshold=arguments.threshold, foreground=arguments.foreground
    )
    print(result.summary)
    print(" ".join(tautline.write(result, arguments.output)))
    return 0


def _run_match(arguments: Any) -> int:
    result = match(
        arguments.source,
        arguments.target,
        spacing=arguments.spacing,
        locations=arguments.locations,
        grid=tuple(arguments.grid),
        a=arguments.a,
        b=arguments.b,
        centre_tolerance=arguments.centre_tolerance,
        threads=arguments.threads,
    )
    print(result.summary)
    if arguments.output:
        print(" ".join(tautline.write(result, arguments.output)))
    return 0


def _run_retrieval(arguments: Any) -> int:
    result = retrieval(arguments.shapes, setting=arguments.setting, best=arguments.best, threads=arguments.threads)
    print(result.summary)
    print("right at rank " + ", ".join(f"{k}: {n}" for k, n in enumerate(result.correct_at, 1)))
    if arguments.csv:
        table = result.tables["Ranking"]
        names = [table.GetColumnName(i) for i in range(table.GetNumberOfColumns())]
        rows = [
            ",".join(table.GetValue(r, c).ToString() for c in range(len(names))) for r in range(table.GetNumberOfRows())
        ]
        try:
            Path(arguments.csv).write_text("\n".join([",".join(names), *rows]) + "\n", encoding="utf-8")
        except OSError as error:
            raise Error(f"{arguments.csv}: cannot be written: {error.strerror}") from None
        print(arguments.csv)
    return 0
