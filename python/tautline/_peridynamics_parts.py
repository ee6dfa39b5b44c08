# SPDX-License-Identifier: BSD-3-Clause
"""Results of peridynamics(), interaction_layer() and horizon_neighbors(); arguments that are not one property each."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, Sequence, get_args

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkDataSet, vtkPolyData

from . import _commands, _vtk
from ._arguments import number, pick, picked, sequence, sets
from ._arrays import Array, InputArrays, Values, cell_array, columns, is_number, snake, table_rows
from ._errors import Error, run
from ._io import as_mesh
from ._results import Result

Model = Literal["scalar", "elastic", "state-based"]
MODELS: tuple[Model, ...] = get_args(Model)
PlaneState = Literal["strain", "stress"]
PLANE_STATES: tuple[PlaneState, ...] = get_args(PlaneState)
_REGION, _SOURCE = range(2)  # input arrays of vtkPeridynamicStiffness
_DEFAULT_REGION = "Reference"  # the filter's default
_LINEAR = 1  # its basis


@dataclass(frozen=True, repr=False, eq=False)
class PeridynamicsResult(Result):
    """The result of peridynamics().

    Attributes
    ----------
    mesh : vtkDataSet
        The mesh with `Unknown`, `Neighbors`, `RowSum`, `Diagonal`, the extreme eigenvectors and `Solution`, on the
        points (linear basis) or the cells.
    condition : float
        Largest over smallest eigenvalue; nan where the matrix is not positive definite or no spectrum was computed.
    smallest, largest, smallest_bound, largest_bound : float
        The extreme eigenvalues and their absolute error bounds.
    definite, converged : bool
        Whether the smallest eigenvalue is positive beyond its bound, and whether both bounds are within the tolerance.
    rows, nonzeros : int
        Number of unknowns, and of nonzero entries of the matrix.
    asymmetry : float
        For the dissertation's discretization: norm of the skew-symmetric part, which is dropped, over the norm of the
        matrix.
    layer_deficit : float
        Horizon minus width of the interaction layer, if the layer is narrower; otherwise 0.
    statistics : dict[str, Any]
        All columns of the table `Spectrum` by name in snake case.
    solution : Array | None
        The solution per point (linear basis) or cell, elastic with 3 components; None if not computed.
    dilatation, energy_density : Array | None
        For the solution of an elastic model, per cell at the centroid, 0 in the layer; None if not computed.
    iterations : int
        For the solution; 0 if not computed.
    residual : float
        relative, of the solution.
    preconditioned_condition : float
        Condition number of the preconditioned matrix, estimated from the iterations, from below; nan if not computed.
    sparsity : Array | None
        Number of entries of the matrix per pixel, with the first row on top; None if not computed.
    summary : str
        The result in words.
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


@sets("peridynamics", "KernelValues")
def set_values(filter_: Any, values: Sequence[float] = ()) -> None:
    """Set the table of the kernel.

    values: values of the kernel "table", at equal distances from 0 to delta.
    """
    for value in sequence("values", values):
        filter_.AddKernelValue(number("values", value))


@sets("peridynamics", "Elastic", "StateBased")
def set_model(filter_: Any, model: Model = "scalar") -> None:
    """Set the model.

    model: "scalar" (diffusion, dissertation (4.6)); "elastic" (bond-based, (4.4) with its tensor kernel); "state-based"
        (linear, ordinary; Silling et al., J. Elasticity 88 (2007)), which needs a layer of width 2 delta and the exact
        discretization.
    """
    model = picked("model", model, MODELS)
    filter_.SetElastic(model != "scalar")
    filter_.SetStateBased(model == "state-based")


@sets("peridynamics", "PlaneStress")
def set_plane(filter_: Any, plane: PlaneState = "strain") -> None:
    """Set the state of the plane.

    plane: for the state-based model: "strain" (a long body) or "stress" (a thin plate).
    """
    filter_.SetPlaneStress(bool(pick("plane", plane, PLANE_STATES)))


@sets("peridynamics", "RegionArray")
def set_region(filter_: Any, inputs: InputArrays, region: Values | None = "Reference") -> None:
    """Set the array of the interaction layer.

    region: name or values of a cell array that is layer_value in the interaction layer; None: there is no layer.
    """
    if region is None:
        filter_.SetInputArrayToProcess(_REGION, 0, 0, vtkDataObject.FIELD_ASSOCIATION_CELLS, "None")
    elif not (isinstance(region, str) and region == _DEFAULT_REGION):
        inputs.use(_REGION, region, "region")


@sets("peridynamics", "UniformSource", "SourceArray")
def set_source(filter_: Any, inputs: InputArrays, source: float | Values = 1.0) -> None:
    """Set the source.

    source: a number, or name or values of an array.
    """
    if is_number(source):
        filter_.SetUniformSource(number("source", source))
    else:
        inputs.use(_SOURCE, source, "source")


def peridynamics_result(filter_: Any, output: vtkDataSet) -> PeridynamicsResult:
    """The result of a filter that has run."""
    if output.GetNumberOfCells() == 0:
        raise Error("the mesh has no triangle")
    table = columns(filter_.GetOutputDataObject(1))
    facts = {name: values[0].item() for name, values in zip(map(snake, table), table.values())}
    solution = picture = None
    if filter_.GetSolve():
        fields = output.GetPointData() if filter_.GetBasis() == _LINEAR else output.GetCellData()
        solution = vtk_to_numpy(fields.GetArray("Solution"))
    if filter_.GetSparsityPixels():
        image = filter_.GetOutputDataObject(2)
        width = image.GetDimensions()[0]
        picture = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(width, width)[::-1]
    strained = bool(filter_.GetSolve() and filter_.GetElastic())
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

    Attributes
    ----------
    mesh : vtkPolyData
        The triangles that meet the disc, with the cell arrays `Case`, `CellId`, `Area`, `ChordArea` and `Missed`.
    case : Array
        Per triangle of it, k: 1 all three corners are inside, 2 two, 3 one, 0 none.
    cells : Array
        Per triangle, k: its number in the input.
    area : Array
        Per triangle, k: area of its part in the disc.
    missed : Array
        Per triangle, k: area minus the approximate area of the dissertation.
    horizon : vtkPolyData
        The circle, as a closed line.
    pieces : vtkPolyData
        The one or two triangles that replace each (Figure 4.5), with `Case` and `CellId`.
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


@sets("horizon_neighbors", "Center")
def set_center(filter_: Any, center: Sequence[float] = (0.5, 0.5, 0.0)) -> None:
    """Set the point.

    center: the point, 2 or 3 coordinates; one off the plane is projected to it.
    """
    numbers = np.asarray([number("center", value) for value in sequence("center", center)])
    if len(numbers) not in (2, 3):
        raise Error(f"center is {center!r}; 2 or 3 numbers are expected")
    filter_.SetCenter(*numbers, *[0.0] * (3 - len(numbers)))


def horizon_neighbors_result(filter_: Any, found: vtkPolyData) -> HorizonResult:
    """The result of a filter that has run."""
    return HorizonResult(
        mesh=found,
        case=cell_array(found, "Case"),
        cells=cell_array(found, "CellId"),
        area=cell_array(found, "Area"),
        missed=cell_array(found, "Missed"),
        horizon=filter_.GetOutputDataObject(1),
        pieces=filter_.GetOutputDataObject(2),
    )


def interaction_layer_result(_filter: Any, output: vtkDataSet) -> vtkDataSet:
    """The mesh with the layer; the cell array `Reference` is 1 in the mesh and 2 in the layer."""
    return output


# --- the shell ----------------------------------------------------------------------------------------------


def add_peridynamics_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of these arguments, and --add-layer."""
    parser.add_argument("--values", type=_commands.numbers, default=(), metavar="V,...",
                        help="of the kernel table, at equal distances from 0 to delta")  # fmt: skip
    parser.add_argument("--model", choices=MODELS, default="scalar")
    parser.add_argument("--plane", choices=PLANE_STATES, default="strain", help="of the state-based model")
    parser.add_argument("--region", default=_DEFAULT_REGION, metavar="ARRAY",
                        help="cell array, --layer-value in the interaction layer (default: %(default)s)")  # fmt: skip
    parser.add_argument("--source", type=_commands.number_or_name, default=1.0, metavar="F|ARRAY", help="(default: 1)")
    parser.add_argument("--add-layer", action="store_true",
                        help="first add an interaction layer of width delta (state-based: 2 delta)")  # fmt: skip


def peridynamics_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """The values of these options."""
    if arguments.add_layer:
        filter_ = _vtk.vtkInteractionLayer()
        filter_.SetWidth((2 if arguments.model == "state-based" else 1) * arguments.delta)
        filter_.SetMergeCoincidentPoints(arguments.merge_coincident_points)
        filter_.SetTimeLimit(arguments.time_limit)
        filter_.SetThreads(arguments.threads)
        filter_.SetInputDataObject(as_mesh(arguments.mesh))
        run(filter_)
        arguments.mesh = filter_.GetOutput()
    return _commands.given(arguments, ("values", "model", "plane", "region", "source"))


def finish_peridynamics(arguments: argparse.Namespace, result: PeridynamicsResult) -> None:
    """Print the result of the command."""
    _commands.finish(arguments, result, result.summary)


def finish_interaction_layer(arguments: argparse.Namespace, mesh: vtkDataSet) -> None:
    """Print the result of the command."""
    _commands.finish(arguments, mesh, _commands.counts(mesh))


def add_horizon_neighbors_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of these arguments."""
    parser.add_argument("--center", type=float, nargs="+", default=(0.5, 0.5, 0.0), metavar="X",
                        help="2 or 3 coordinates (default: 0.5 0.5 0)")  # fmt: skip


def horizon_neighbors_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """The values of these options."""
    return _commands.given(arguments, ("center",))


def finish_horizon_neighbors(arguments: argparse.Namespace, result: HorizonResult) -> None:
    """Print the result of the command."""
    counts = ", ".join(f"{np.count_nonzero(result.case == case)} of case {case}" for case in (1, 2, 3, 0))
    text = f"{len(result.case)} triangles: {counts}; area {result.area.sum():.6g}, missed {result.missed.sum():.6g}"
    _commands.finish(arguments, result, text, result.table())
