# SPDX-License-Identifier: BSD-3-Clause
"""The functions peridynamics and interaction_layer: nonlocal models on planar triangle meshes."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, Sequence, get_args

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkDataSet, vtkPolyData

from . import _commands, _vtk
from ._arguments import number, pick, picked, set_threads, set_time_limit, within
from ._arrays import POINTS, Array, InputArrays, Values, cell_array, columns, snake, table_rows
from ._errors import Error, interruptible, run
from ._interrupts import Progress
from ._io import Mesh, as_mesh
from ._results import Result

Basis = Literal["constant", "linear", "discontinuous linear"]
BASES: tuple[Basis, ...] = get_args(Basis)
Kernel = Literal["power", "constant", "gaussian", "conical", "table"]
KERNELS: tuple[Kernel, ...] = get_args(Kernel)
Model = Literal["scalar", "elastic", "state-based"]
MODELS: tuple[Model, ...] = get_args(Model)
PlaneState = Literal["strain", "stress"]
PLANE_STATES: tuple[PlaneState, ...] = get_args(PlaneState)
Discretization = Literal["dissertation", "exact"]
DISCRETIZATIONS: tuple[Discretization, ...] = get_args(Discretization)
Rules = Literal["tables", "literal", "1/1", "3/3", "3/1"]
RULES: tuple[Rules, ...] = get_args(Rules)
Preconditioner = Literal["jacobi", "local amg", "two-level"]
PRECONDITIONERS: tuple[Preconditioner, ...] = get_args(Preconditioner)
_REGION, _SOURCE, _GIVEN, _GIVEN_POINTS = range(4)  # input arrays of vtkPeridynamicStiffness
_DEFAULT_REGION = "Reference"  # the filter's default
_MAX_PIXELS = 4096


@dataclass(frozen=True, repr=False, eq=False)
class PeridynamicsResult(Result):
    """The result of peridynamics().

    mesh: the mesh with `Unknown`, `Neighbors`, `RowSum`, `Diagonal`, the extreme eigenvectors and `Solution`, on the
        points (linear basis) or the cells.
    condition: largest over smallest eigenvalue; nan where the matrix is not positive definite or no spectrum was
        computed.
    smallest, largest, smallest_bound, largest_bound: the extreme eigenvalues and their absolute error bounds.
    definite, converged: whether the smallest eigenvalue is positive beyond its bound, and whether both bounds are
        within the tolerance.
    rows, nonzeros: number of unknowns, and of nonzero entries of the matrix.
    asymmetry: of the dissertation's discretization: norm of the skew-symmetric part, which is dropped, over that of the
        matrix.
    layer_deficit: horizon minus width of the interaction layer, where the layer is narrower; else 0.
    statistics: all columns of the table `Spectrum` by name in snake case.
    solution: the solution per point (linear basis) or cell, elastic with 3 components; None if not computed.
    dilatation, energy_density: of the solution of an elastic model, per cell at the centroid, 0 in the layer; None if
        not computed.
    iterations: of the solution; 0 if not computed.
    residual: relative, of the solution.
    preconditioned_condition: condition number of the preconditioned matrix, estimated from the iterations, from below;
        nan if not computed.
    sparsity: number of entries of the matrix per pixel, with the first row on top; None if not computed.
    summary: the result in words.
    """

    _per_element: ClassVar[tuple[str, ...]] = ("solution", "dilatation", "energy_density", "sparsity")
    mesh: vtkDataSet
    condition: float
    smallest: float
    largest: float
    smallest_bound: float
    largest_bound: float
    definite: bool
    converged: bool
    rows: int
    nonzeros: int
    asymmetry: float
    layer_deficit: float
    statistics: dict[str, Any]
    solution: Array | None
    dilatation: Array | None
    energy_density: Array | None
    iterations: int
    residual: float
    preconditioned_condition: float
    sparsity: Array | None
    summary: str


@interruptible
def peridynamics(
    mesh: Mesh,
    delta: float = 0.2,
    p: float = 1.0,
    basis: Basis = "linear",
    *,
    kernel: Kernel = "power",
    width: float = 0.5,
    values: Sequence[float] = (),
    model: Model = "scalar",
    poisson_ratio: float = 0.25,
    plane: PlaneState = "strain",
    discretization: Discretization = "exact",
    rules: Rules = "tables",
    tolerance: float = 1e-5,
    region: Values | None = _DEFAULT_REGION,
    layer_value: float = 2,
    given_points: Values | None = None,
    constrained: bool = True,
    allow_thin_layer: bool = False,
    cut_bonds: bool = True,
    spectrum: bool = True,
    spectrum_tolerance: float = 1e-8,
    solve: bool = False,
    preconditioner: Preconditioner = "jacobi",
    source: float | Values = 1.0,
    given: Values | None = None,
    sparsity: int = 0,
    memory_limit: float = 0.0,
    time_limit: float = 0.0,
    threads: int = 0,
    merge_coincident_points: bool = True,
    progress: Progress | bool | None = None,
) -> PeridynamicsResult:
    """Assemble the matrix of a nonlocal (peridynamic) model, compute its condition number, and solve.

    mesh: triangles in a plane with an interaction layer (collar) of width delta, where the solution is given, see
        interaction_layer(): a vtkDataSet, a composite data set, a file name or (points, cells). It is not changed. The
        data sets of a composite one are one mesh.
    delta: the horizon, above 0, in the mesh's unit.
    p: exponent of the kernel r^-p: 0 to below 4 (linear basis) or 3 (the others); of the elastic model below 6 or 5.
    basis: "constant", "linear" or "discontinuous linear".
    kernel: "power"; "constant"; "gaussian", exp(-(r / (width delta))^2); "conical", 1 - r / delta; "table", linear
        between `values`.
    width: of the Gaussian kernel, in horizons.
    values: of the kernel "table", at equal distances from 0 to delta.
    model: "scalar" (diffusion, dissertation (4.6)); "elastic" (bond-based, (4.4) with its tensor kernel); "state-based"
        (linear, ordinary; Silling et al., J. Elasticity 88 (2007)), which needs a layer of width 2 delta and the exact
        discretization.
    poisson_ratio: of the state-based model, above -1 and below 0.5. The bond-based one has 1/4 (plane strain), 1/3
        (plane stress).
    plane: of the state-based model: "strain" (a long body) or "stress" (a thin plate).
    discretization: "exact" (each pair of triangles is integrated as `tolerance` states) or "dissertation"
        (by the quadrature `rules`).
    rules: "tables" reproduces the dissertation's tables, "literal" is what its text says, or the numbers of outer/inner
        points: "1/1", "3/3", "3/1".
    tolerance: of the refinement of the integral over each pair of triangles ("exact"), 1e-10 to 0.1. The matrix has
        larger errors, relative to its largest entry: at most 3e-3, 5e-4 and 1e-4 for 1e-3, 1e-5 and 1e-7 where the
        horizon is 1.5 elements, 7e-3, 8e-4 and 3e-4 where it is 0.3 elements.
    region: name or values of a cell array that is layer_value in the interaction layer; None: there is no layer.
    given_points: name or values of a point array, not 0 where the solution of the linear basis is given; None: at the
        points of the layer's cells.
    constrained: whether the solution in the layer is given; False: all values are unknown.
    allow_thin_layer: whether the layer may be narrower than delta; what lies beyond the mesh is then left out.
    cut_bonds: whether triangles do not interact where the mesh ends between them, as across a hole or a crack without a
        layer.
    spectrum: whether to compute the extreme eigenvalues.
    spectrum_tolerance: relative, of the eigenvalues, 1e-14 to 0.1.
    solve: whether to solve for `source` and the solution `given` in the layer.
    preconditioner: of the conjugate gradients that solve: "jacobi" is the diagonal. "local amg" and "two-level" combine
        an inverse for waves shorter than the horizon with a method for longer ones: "local amg" with algebraic
        multigrid for the local limit on the same triangles, "two-level" with a coarse grid whose cells are about half
        as wide as the horizon. Choose "two-level" for Poisson's ratios above 0.4. Both need values given in the layer.
    source: a number, or name or values of an array.
    given: name or values of an array; None is 0.
    sparsity: largest width of the picture of the matrix, pixels, 0 (no picture) to 4096.
    memory_limit: MiB; 0 is the free memory.
    time_limit: seconds; 0 is no limit.
    threads: number of threads; 0 is all cores. The result does not depend on it.
    merge_coincident_points: whether points at the same place on facets that match are treated as one, as on the seams
        of a mesh in pieces; the result keeps them all. False: they stay apart, as a crack or a contact needs it.

    Raises Error, with the remedy, for wrong arguments and where a model cannot be assembled: no layer or too thin a
    one, an exponent at the singular limit, inverted triangles, too little memory, the time limit.

    >>> mesh = tautline.interaction_layer(tautline.domain("rectangle", cells=400), width=0.2)
    >>> tautline.peridynamics(mesh, delta=0.2, p=1).condition
    """
    filter_ = _vtk.vtkPeridynamicStiffness()
    inputs = InputArrays(filter_, as_mesh(mesh))
    filter_.SetHorizon(float(delta))
    filter_.SetExponent(float(p))
    basis = picked("basis", basis, BASES)
    filter_.SetBasis(BASES.index(basis))
    filter_.SetKernel(pick("kernel", kernel, KERNELS))
    filter_.SetGaussianWidth(float(width))
    for value in values:
        filter_.AddKernelValue(float(value))
    model = picked("model", model, MODELS)
    filter_.SetElastic(model != "scalar")
    filter_.SetStateBased(model == "state-based")
    filter_.SetPoissonRatio(number("poisson_ratio", poisson_ratio))
    filter_.SetPlaneStress(bool(pick("plane", plane, PLANE_STATES)))
    filter_.SetDiscretization(pick("discretization", discretization, DISCRETIZATIONS))
    filter_.SetRules(pick("rules", rules, RULES))
    filter_.SetTolerance(float(tolerance))
    filter_.SetLayerValue(float(layer_value))
    filter_.SetConstrained(bool(constrained))
    filter_.SetAllowThinLayer(bool(allow_thin_layer))
    filter_.SetCutBonds(bool(cut_bonds))
    filter_.SetComputeSpectrum(bool(spectrum))
    filter_.SetSpectrumTolerance(within("spectrum_tolerance", spectrum_tolerance, 1e-14, 0.1))
    filter_.SetSolve(bool(solve))
    filter_.SetPreconditioner(pick("preconditioner", preconditioner, PRECONDITIONERS))
    filter_.SetSparsityPixels(int(within("sparsity", sparsity, 0, _MAX_PIXELS)))
    filter_.SetMemoryLimit(within("memory_limit", memory_limit, 0, 1e12))
    set_time_limit(filter_, time_limit)
    set_threads(filter_, threads)
    filter_.SetMergeCoincidentPoints(bool(merge_coincident_points))
    if region is None:
        filter_.SetInputArrayToProcess(_REGION, 0, 0, vtkDataObject.FIELD_ASSOCIATION_CELLS, "None")
    elif not (isinstance(region, str) and region == _DEFAULT_REGION):
        inputs.use(_REGION, region, "region")
    if np.ndim(source) == 0 and not isinstance(source, str):
        filter_.SetUniformSource(number("source", source))
    else:
        inputs.use(_SOURCE, source, "source")
    inputs.use(_GIVEN, given, "solution")
    inputs.use(_GIVEN_POINTS, given_points, "points", POINTS)
    filter_.SetInputDataObject(inputs.mesh)
    run(filter_)
    output = inputs.remove_from(filter_.GetOutputDataObject(0))
    if output.GetNumberOfCells() == 0:
        raise Error("the mesh has no triangle")
    return _result(filter_, output, basis, solve and model != "scalar", solve, sparsity)


def _result(
    filter_: Any, output: vtkDataSet, basis: str, strained: bool, solve: bool, sparsity: int
) -> PeridynamicsResult:
    table = columns(filter_.GetOutputDataObject(1))
    facts = {name: values[0].item() for name, values in zip(map(snake, table), table.values())}
    solution = picture = None
    if solve:
        fields = output.GetPointData() if basis == "linear" else output.GetCellData()
        solution = vtk_to_numpy(fields.GetArray("Solution"))
    if sparsity:
        image = filter_.GetOutputDataObject(2)
        width = image.GetDimensions()[0]
        picture = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(width, width)[::-1]
    return PeridynamicsResult(
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
        layer_deficit=facts["layer_deficit"],
        statistics=facts,
        solution=solution,
        dilatation=cell_array(output, "Dilatation") if strained else None,
        energy_density=cell_array(output, "EnergyDensity") if strained else None,
        iterations=facts["solver_iterations"],
        residual=facts["solver_residual"],
        preconditioned_condition=facts["preconditioned_condition"] or float("nan"),
        sparsity=picture,
        summary=filter_.GetSummary(),
    )


@dataclass(frozen=True, repr=False, eq=False)
class HorizonResult(Result):
    """The result of horizon_neighbors().

    mesh: the triangles that meet the disc, with the cell arrays `Case`, `CellId`, `Area`, `ChordArea` and `Missed`.
    case: per triangle of it, k: 1 all three corners are inside, 2 two, 3 one, 0 none.
    cells: per triangle, k: its number in the input.
    area: per triangle, k: area of its part in the disc.
    missed: per triangle, k: area minus that which the dissertation approximates.
    horizon: the circle, as a closed line.
    pieces: the one or two triangles that replace each (Figure 4.5), with `Case` and `CellId`.
    """

    mesh: vtkPolyData
    case: Array
    cells: Array
    area: Array
    missed: Array
    horizon: vtkPolyData
    pieces: vtkPolyData

    def table(self) -> list[dict[str, Any]]:
        """A row per triangle: cell, case, area, missed."""
        names = {"cell": self.cells, "case": self.case, "area": self.area, "missed": self.missed}
        return table_rows({name: values.tolist() for name, values in names.items()})


@interruptible
def horizon_neighbors(
    mesh: Mesh,
    center: Sequence[float] = (0.5, 0.5, 0.0),
    delta: float = 0.2,
    *,
    progress: Progress | bool | None = None,
) -> HorizonResult:
    """The triangles that the horizon of a point meets, by the cases of dissertation Figure 4.4.

    mesh: triangles in a plane: a vtkDataSet, a composite data set, a file name or (points, cells). It is not changed.
    center: the point, 2 or 3 coordinates; one off the plane is projected to it.
    delta: the horizon, above 0, in the mesh's unit.

    Raises Error for wrong arguments and for meshes that the filter refuses.

    >>> found = tautline.horizon_neighbors("square.vtu", (0.5, 0.5), 0.2)
    >>> found.area.sum(), found.missed.sum()
    """
    numbers = np.asarray([number("center", value) for value in np.ravel(center)])
    if len(numbers) not in (2, 3):
        raise Error(f"center is {center!r}; 2 or 3 numbers are expected")
    filter_ = _vtk.vtkHorizonNeighbors()
    filter_.SetCenter(*numbers, *[0.0] * (3 - len(numbers)))
    filter_.SetHorizon(number("delta", delta))
    filter_.SetInputDataObject(as_mesh(mesh))
    run(filter_)
    found = filter_.GetOutputDataObject(0)
    return HorizonResult(
        mesh=found,
        case=cell_array(found, "Case"),
        cells=cell_array(found, "CellId"),
        area=cell_array(found, "Area"),
        missed=cell_array(found, "Missed"),
        horizon=filter_.GetOutputDataObject(1),
        pieces=filter_.GetOutputDataObject(2),
    )


@interruptible
def interaction_layer(
    mesh: Mesh,
    width: float = 0.2,
    *,
    element_size: float = 0.0,
    time_limit: float = 0.0,
    threads: int = 0,
    merge_coincident_points: bool = True,
    progress: Progress | bool | None = None,
) -> vtkDataSet:
    """Add an interaction layer (collar, nonlocal boundary layer) of triangles around a mesh and in its holes.

    A nonlocal model has its boundary condition not on the boundary but in this layer, see peridynamics() and
    dissertation section 4.2.

    mesh: triangles in a plane: a vtkDataSet, a composite data set, a file name or (points, cells). It is not changed;
        its points and triangles come first in the result, with the same numbers. The data sets of a composite one are
        one mesh, in their order.
    width: least width of the layer, above 0, in the mesh's unit.
    element_size: edge length of the layer's triangles; 0 is the mean edge length of the boundary.
    time_limit: seconds; 0 is no limit.
    threads: number of threads; 0 is all cores. The result does not depend on it.
    merge_coincident_points: whether points at the same place on edges that match are treated as one, as on the seams of
        a mesh in pieces. The points keep their numbers; cells have the one with the smallest.

    The cell array `Reference` of the result is 1 in the mesh and 2 in the layer. Raises Error for wrong arguments and
    for a boundary that crosses itself.

    >>> tautline.interaction_layer("plate.vtu", width=0.1).GetNumberOfCells()
    """
    filter_ = _vtk.vtkInteractionLayer()
    filter_.SetWidth(float(width))
    filter_.SetElementSize(float(element_size))
    set_time_limit(filter_, time_limit)
    set_threads(filter_, threads)
    filter_.SetMergeCoincidentPoints(bool(merge_coincident_points))
    filter_.SetInputDataObject(as_mesh(mesh))
    run(filter_)
    return filter_.GetOutput()


# --- the shell ----------------------------------------------------------------------------------------------


def add_commands(commands: Any) -> None:
    """Add `peridynamics` and `interaction-layer` to the subparsers of the command line."""
    made = _commands.add_command(
        commands, "peridynamics", _run_peridynamics, "compute the condition number of a nonlocal stiffness matrix",
        example="square.vtu --delta 0.2 -p 2.5",
        details="The mesh has an interaction layer, see interaction-layer and --add-layer.",
    )
    made.add_argument("mesh", metavar="FILE", help="triangles in a plane with an interaction layer (collar)")
    _commands.add_output(made, "write the mesh with the data of the rows", False)
    made.add_argument("--delta", type=float, default=0.2, help="the horizon (default: 0.2)")
    made.add_argument("-p", type=float, default=1.0, help="exponent of the kernel (default: 1)")
    made.add_argument("--basis", choices=BASES, default="linear")
    made.add_argument("--kernel", choices=KERNELS, default="power")
    made.add_argument("--width", type=float, default=0.5, help="of the Gaussian, in horizons (default: 0.5)")
    made.add_argument("--values", type=_commands.numbers, default=(), metavar="V,...",
                      help="of the kernel table, at equal distances from 0 to delta")  # fmt: skip
    made.add_argument("--model", choices=MODELS, default="scalar")
    made.add_argument("--poisson-ratio", type=float, default=0.25, help="of the state-based model (default: 0.25)")
    made.add_argument("--plane", choices=PLANE_STATES, default="strain", help="of the state-based model")
    made.add_argument("--discretization", choices=DISCRETIZATIONS, default="exact",
                      help="exact integration, or the rules of the dissertation")  # fmt: skip
    made.add_argument("--rules", choices=RULES, default="tables", help="of the dissertation's discretization")
    made.add_argument("--tolerance", type=float, default=1e-5, help="of the exact integrals (default: 1e-5)")
    made.add_argument("--region", default=_DEFAULT_REGION, metavar="ARRAY",
                      help="cell array, --layer-value in the interaction layer (default: %(default)s)")  # fmt: skip
    made.add_argument("--layer-value", type=float, default=2.0, help="(default: 2)")
    made.add_argument("--given-points", metavar="ARRAY",
                      help="point array, not 0 where the solution is given (default: in the layer)")  # fmt: skip
    _commands.add_flag(made, "constrained", "whether the solution in the layer is given")
    made.add_argument("--add-layer", action="store_true",
                      help="first add an interaction layer of width delta (state-based: 2 delta)")  # fmt: skip
    made.add_argument("--allow-thin-layer", action="store_true", help="the layer may be narrower than delta")
    made.add_argument("--no-cut-bonds", dest="cut_bonds", action="store_false",
                      help="triangles interact across holes and cracks")  # fmt: skip
    _commands.add_flag(made, "spectrum", "whether to compute the extreme eigenvalues")
    made.add_argument("--spectrum-tolerance", type=float, default=1e-8, help="of these, relative (default: 1e-8)")
    made.add_argument("--solve", action="store_true", help="solve for --source and the solution given in the layer")
    made.add_argument("--source", type=_commands.number_or_name, default=1.0, metavar="F|ARRAY", help="(default: 1)")
    made.add_argument("--given", metavar="ARRAY", help="the solution in the layer (default: 0)")
    made.add_argument("--preconditioner", choices=PRECONDITIONERS, default="jacobi", help="of the solution")
    made.add_argument("--memory-limit", type=float, default=0.0, metavar="MIB",
                      help="0, the default, is the free memory")  # fmt: skip
    _commands.add_merge_points(made)
    _commands.add_time_limit(made)

    made = _commands.add_command(
        commands, "interaction-layer", _run_layer, "add an interaction layer (collar) around a planar triangle mesh",
        example="triangles.vtu --width 0.1 -o layer.vtu",
        details="Nonlocal models have their boundary condition in it.",
    )
    _commands.add_mesh(made)
    _commands.add_output(made)
    made.add_argument("--width", type=float, default=0.2, help="least width (default: 0.2)")
    made.add_argument("--element-size", type=float, default=0.0,
                      help="edge length of its triangles (default: that of the boundary)")  # fmt: skip
    _commands.add_merge_points(made)
    _commands.add_time_limit(made)


    made = _commands.add_command(
        commands, "horizon-neighbors", _run_horizon, "list the triangles that the horizon of a point meets",
        threads=False, example="square.vtu --center 0.5 0.5 --delta 0.2 --csv neighbors.csv",
        details="By the cases of dissertation Figure 4.4.",
    )  # fmt: skip
    _commands.add_mesh(made)
    _commands.add_output(made, "write these triangles", False)
    made.add_argument("--csv", metavar="FILE", help="write a row per triangle")
    made.add_argument("--center", type=float, nargs="+", default=(0.5, 0.5, 0.0), metavar="X",
                      help="2 or 3 coordinates (default: 0.5 0.5 0)")  # fmt: skip
    made.add_argument("--delta", type=float, default=0.2, help="the horizon (default: 0.2)")


def _run_horizon(arguments: argparse.Namespace) -> None:
    result = horizon_neighbors(arguments.mesh, arguments.center, arguments.delta)
    counts = ", ".join(f"{np.count_nonzero(result.case == case)} of case {case}" for case in (1, 2, 3, 0))
    text = f"{len(result.case)} triangles: {counts}; area {result.area.sum():.6g}, missed {result.missed.sum():.6g}"
    _commands.finish(arguments, result, text, result.table())


def _run_peridynamics(arguments: argparse.Namespace) -> None:
    mesh = as_mesh(arguments.mesh)
    if arguments.add_layer:
        options = _commands.given(arguments, ("time_limit", "threads", "merge_coincident_points"))
        width = (2 if arguments.model == "state-based" else 1) * arguments.delta
        mesh = interaction_layer(mesh, width, **options)
    names = ("delta", "p", "basis", "kernel", "width", "values", "model", "poisson_ratio", "plane", "discretization",
             "rules", "tolerance", "region", "layer_value", "given_points", "constrained", "allow_thin_layer",
             "cut_bonds", "spectrum", "spectrum_tolerance", "solve", "source", "given", "preconditioner",
             "memory_limit", "time_limit", "threads", "merge_coincident_points")  # fmt: skip
    result = peridynamics(mesh, **_commands.given(arguments, names))
    _commands.finish(arguments, result, result.summary)


def _run_layer(arguments: argparse.Namespace) -> None:
    names = ("width", "element_size", "time_limit", "threads", "merge_coincident_points")
    made = interaction_layer(arguments.mesh, **_commands.given(arguments, names))
    _commands.finish(arguments, made, _commands.counts(made))
