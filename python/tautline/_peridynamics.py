"""The verbs peridynamics and collar: nonlocal models on planar triangle meshes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Sequence

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkDataSet

import tautline

from ._errors import Error, run
from ._mesh import Mesh, as_mesh, columns, with_array
from ._metrics import pick, within
from ._quality import snake

BASES = ("constant", "linear", "discontinuous linear")
KERNELS = ("power", "constant", "gaussian", "conical", "table")
MODELS = ("scalar", "elastic")
READINGS = ("dissertation", "exact")
RULES = ("tables", "literal", "1/1", "3/3", "3/1")
_MOST_THREADS = 1024
_REGION, _SOURCE, _GIVEN, _GIVEN_POINTS = range(4)  # the filter's input arrays


@dataclass(frozen=True)
class Peridynamics:
    """What peridynamics() found."""

    #: The mesh with `Unknown`, `Neighbors`, `RowSum`, `Diagonal`, the extreme eigenvectors and `Solution`, on points
    #: (linear basis) or cells.
    mesh: vtkDataSet
    #: Largest over smallest eigenvalue; nan where the matrix is not positive definite or no spectrum was asked for.
    condition: float
    #: The eigenvalues and their absolute error bounds.
    smallest: float
    largest: float
    smallest_bound: float
    largest_bound: float
    #: Whether the smallest eigenvalue is positive beyond its bound, and whether both bounds meet the tolerance.
    definite: bool
    converged: bool
    #: Unknowns and entries of the matrix.
    rows: int
    nonzeros: int
    #: Of the dissertation's reading: norm of the unsymmetric part, which is dropped, over that of the matrix.
    asymmetry: float
    #: By how much the collar is narrower than the horizon.
    collar_deficit: float
    #: All of the table `Spectrum`, by name in snake case.
    statistics: dict[str, Any]
    #: The solution per point (linear basis) or cell, or None.
    solution: np.ndarray | None
    #: Entries of the matrix per pixel, first row on top, or None.
    sparsity: np.ndarray | None
    #: The result in words.
    summary: str


def peridynamics(
    mesh: Mesh,
    delta: float = 0.2,
    p: float = 1.0,
    basis: str = "linear",
    *,
    kernel: str = "power",
    width: float = 0.5,
    values: Sequence[float] = (),
    model: str = "scalar",
    reading: str = "exact",
    rules: str = "tables",
    tolerance: float = 1e-5,
    region: str | Sequence | None = "Reference",
    collar_value: float = 2,
    given_points: str | Sequence | None = None,
    constrained: bool = True,
    allow_thin_collar: bool = False,
    spectrum: bool = True,
    spectrum_tolerance: float = 1e-8,
    solve: bool = False,
    source: float | str | Sequence = 1.0,
    given: str | Sequence | None = None,
    sparsity: int = 0,
    memory_limit: float = 0.0,
    time_limit: float = 0.0,
    threads: int = 0,
) -> Peridynamics:
    """Condition number, rows and solution of a nonlocal (bond-based peridynamic) model.

    mesh: triangles in a plane with a collar of width delta (see collar()), given by `region`.
    delta: the horizon, above 0, in the unit of the mesh.
    p: exponent of the kernel r^-p: 0 to below 4 (linear basis) or 3 (the others); elastic: 6 or 5.
    basis: "constant", "linear" or "discontinuous linear".
    kernel: "power"; "constant"; "gaussian", exp(-(r / (width delta))^2); "conical", 1 - r / delta; "table", linear
        between `values` at equal distances from 0 to delta.
    model: "scalar", diffusion, dissertation (4.6); "elastic", (4.4) with its tensor kernel.
    reading: "exact", to the tolerance for each pair of triangles; "dissertation", with `rules`: "tables" reproduces
        its tables, "literal" is what its text says, or numbers of outer/inner points: "1/1", "3/3", "3/1".
    region: name or values of a cell array, collar_value in the collar; None: there is no collar.
    given_points: name or values of a point array, not 0 where the linear basis is given; None: at the points of the
        collar's cells.
    constrained: False: everything is unknown.
    allow_thin_collar: take a collar narrower than delta; what lies beyond the mesh then does not count.
    solve: solve for a `source` (a number, or name or values of an array) and the solution `given` in the collar
        (name or values of an array; None is 0).
    sparsity: largest width of the picture of the matrix in pixels, 0 for none.
    memory_limit: MiB; 0 is what is free. time_limit: seconds; 0 is none.
    threads: 0 is all cores. The result does not depend on it.

    Raises Error for wrong arguments and whatever cannot be done, with the remedy: no collar or one too thin, an
    exponent at the singular limit, inverted triangles, too little memory, time over.
    """
    data = as_mesh(mesh)
    stiffness = tautline.vtkPeridynamicStiffness()
    stiffness.SetHorizon(float(delta))
    stiffness.SetExponent(float(p))
    stiffness.SetBasis(pick("basis", basis, BASES))
    stiffness.SetKernel(pick("kernel", kernel, KERNELS))
    stiffness.SetGaussianWidth(float(width))
    for value in values:
        stiffness.AddKernelValue(float(value))
    stiffness.SetElastic(bool(pick("model", model, MODELS)))
    stiffness.SetReading(pick("reading", reading, READINGS))
    stiffness.SetRules(pick("rules", rules, RULES))
    stiffness.SetTolerance(float(tolerance))
    stiffness.SetCollarValue(float(collar_value))
    stiffness.SetConstrained(bool(constrained))
    stiffness.SetAllowThinCollar(bool(allow_thin_collar))
    stiffness.SetComputeSpectrum(bool(spectrum))
    stiffness.SetSpectrumTolerance(within("spectrum_tolerance", spectrum_tolerance, 1e-14, 0.1))
    stiffness.SetSolve(bool(solve))
    stiffness.SetSparsityPixels(int(within("sparsity", sparsity, 0, 4096)))
    stiffness.SetMemoryLimit(within("memory_limit", memory_limit, 0, 1e12))
    stiffness.SetTimeLimit(within("time_limit", time_limit, 0, 1e9))
    stiffness.SetThreads(int(within("threads", threads, 0, _MOST_THREADS)))

    def use(slot: int, array: Any, name: str, **options: Any) -> None:
        nonlocal data
        data, where, found = with_array(data, array, name, **options)
        stiffness.SetInputArrayToProcess(slot, 0, 0, where, found)

    if region is None:
        stiffness.SetInputArrayToProcess(_REGION, 0, 0, vtkDataObject.FIELD_ASSOCIATION_CELLS, "None")
    elif not (isinstance(region, str) and region == "Reference"):  # that is the filter's own default
        use(_REGION, region, "given region")
    if np.ndim(source) == 0 and not isinstance(source, str):
        stiffness.SetUniformSource(float(source))
    else:
        use(_SOURCE, source, "given source")
    if given is not None:
        use(_GIVEN, given, "given solution")
    if given_points is not None:
        use(_GIVEN_POINTS, given_points, "given points", points_only=True)
    stiffness.SetInputDataObject(data)
    run(stiffness)
    return _result(stiffness, basis, solve, sparsity)


def _result(stiffness: Any, basis: str, solve: bool, sparsity: int) -> Peridynamics:
    output = stiffness.GetOutputDataObject(0)
    if output.GetNumberOfCells() == 0:
        raise Error("the mesh has no triangle")
    for fields in (output.GetPointData(), output.GetCellData()):
        for name in ("given region", "given source", "given solution", "given points"):
            fields.RemoveArray(name)
    table = columns(stiffness.GetOutputDataObject(1))
    facts = {snake(name): values[0].item() for name, values in table.items()}
    solution = picture = None
    if solve:
        fields = output.GetPointData() if basis == "linear" else output.GetCellData()
        solution = vtk_to_numpy(fields.GetArray("Solution"))
    if sparsity:
        image = stiffness.GetOutputDataObject(2)
        width = image.GetDimensions()[0]
        picture = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(width, width)[::-1]
    return Peridynamics(
        mesh=output,
        condition=facts["condition"] or float("nan"),
        smallest=facts["smallest"],
        largest=facts["largest"],
        smallest_bound=facts["smallest_bound"],
        largest_bound=facts["largest_bound"],
        definite=bool(facts["definite"]),
        converged=bool(facts["converged"]),
        rows=facts["rows"],
        nonzeros=facts["nonzeros"],
        asymmetry=facts["asymmetry"],
        collar_deficit=facts["collar_deficit"],
        statistics=facts,
        solution=solution,
        sparsity=picture,
        summary=stiffness.GetSummary(),
    )


def collar(mesh: Mesh, width: float = 0.2, *, element_size: float = 0.0, threads: int = 0) -> vtkDataSet:
    """The mesh with a collar of triangles around it and in its holes, for peridynamics().

    mesh: triangles in a plane; its points and triangles come first in the result, unchanged.
    width: least width of the collar, above 0.
    element_size: edge of the collar's triangles; 0 is the mean edge of the boundary.

    The cell array `Reference` is 1 in the mesh and 2 in the collar. Raises Error for wrong arguments and a
    boundary that crosses itself.
    """
    made = tautline.vtkHorizonCollar()
    made.SetWidth(float(width))
    made.SetElementSize(float(element_size))
    made.SetThreads(int(within("threads", threads, 0, _MOST_THREADS)))
    made.SetInputDataObject(as_mesh(mesh))
    run(made)
    return made.GetOutput()


def add_commands(commands: Any) -> None:
    """Add `peridynamics` and `collar` to the subparsers of the command line; each sets `run`."""
    made = commands.add_parser("peridynamics", help="condition number of a nonlocal stiffness matrix")
    made.add_argument("mesh", metavar="FILE", help="triangles in a plane with a collar, see the verb collar")
    made.add_argument("-o", "--output", metavar="FILE", help="write the mesh with the data of the rows")
    made.add_argument("--delta", type=float, default=0.2, help="the horizon (default: 0.2)")
    made.add_argument("-p", type=float, default=1.0, help="exponent of the kernel (default: 1)")
    made.add_argument("--basis", choices=BASES, default="linear")
    made.add_argument("--kernel", choices=KERNELS[:-1], default="power")
    made.add_argument("--width", type=float, default=0.5, help="of the Gaussian, in horizons (default: 0.5)")
    made.add_argument("--model", choices=MODELS, default="scalar")
    made.add_argument("--reading", choices=READINGS, default="exact")
    made.add_argument("--rules", choices=RULES, default="tables", help="of the dissertation's reading")
    made.add_argument("--tolerance", type=float, default=1e-5, help="of the exact reading (default: 1e-5)")
    made.add_argument("--region", default="Reference", metavar="ARRAY", help="cell array, 2 in the collar")
    made.add_argument("--collar", action="store_true", help="put a collar of width delta around the mesh first")
    made.add_argument("--allow-thin-collar", action="store_true")
    made.add_argument("--solve", action="store_true", help="solve for a source of 1 and 0 in the collar")
    made.add_argument("--memory-limit", type=float, default=0.0, metavar="MIB")
    made.add_argument("--time-limit", type=float, default=0.0, metavar="SECONDS")
    made.add_argument("--threads", type=int, default=0, help="0, the default, is all cores")
    made.set_defaults(run=_run_peridynamics)

    made = commands.add_parser("collar", help="put a collar around a planar triangle mesh")
    made.add_argument("mesh", metavar="FILE")
    made.add_argument("-o", "--output", metavar="FILE", required=True)
    made.add_argument("--width", type=float, default=0.2, help="least width (default: 0.2)")
    made.add_argument("--element-size", type=float, default=0.0, help="edge of its triangles (default: the boundary's)")
    made.add_argument("--threads", type=int, default=0, help="0, the default, is all cores")
    made.set_defaults(run=_run_collar)


def _run_peridynamics(arguments: Any) -> int:
    mesh = as_mesh(arguments.mesh)
    if arguments.collar:
        mesh = collar(mesh, arguments.delta, threads=arguments.threads)
    names = ("delta", "p", "basis", "kernel", "width", "model", "reading", "rules", "tolerance", "region")
    names += ("allow_thin_collar", "solve", "memory_limit", "time_limit", "threads")
    result = peridynamics(mesh, **{name: getattr(arguments, name) for name in names})
    print(result.summary)
    if arguments.output:
        print("\n".join(tautline.write(result, arguments.output)))
    return 0


def _run_collar(arguments: Any) -> int:
    made = collar(arguments.mesh, arguments.width, element_size=arguments.element_size, threads=arguments.threads)
    print(f"{made.GetNumberOfCells()} triangles, {made.GetNumberOfPoints()} points")
    print("\n".join(tautline.write(made, arguments.output)))
    return 0
