# SPDX-License-Identifier: BSD-3-Clause
"""The function adapt: solve, compute a metric from the solution, adapt the mesh to it, and start over."""

from __future__ import annotations

import argparse
import time
from copy import copy
from dataclasses import dataclass
from typing import Any, Callable, ClassVar, Mapping, Sequence, Union

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkDataSet

from . import _commands, _vtk
from ._adaptation import metric as metric_of
from ._arguments import flag, number, sequence, text, whole, within
from ._arrays import Array, is_number, table_rows
from ._choices import IMPROVE_BOUNDARIES, METRIC_RECOVERIES, ImproveBoundary, MetricRecovery
from ._error_estimate import interpolation_error, simplices_of
from ._errors import Error, interruptible
from ._interrupts import Progress, part
from ._io import Mesh, as_data_set
from ._reconnection import improve
from ._results import Result
from ._tables import align
from ._views import point_data_of, viewed

#: Takes a mesh, and returns it, or another one, with a point array; or returns the values, one row per point.
Solver = Callable[[Any], Any]

_METRIC = "Adapt metric"  # the name of the intermediate tensors
_SOLUTION = "Solution"  # the name of a field that is given by its values
#: Cell arrays of improve(), which are about the mesh of the iteration before.
_OF_IMPROVE = ("OriginalCellId", "min_angle", "imr")
_COLUMNS = ("iteration", "target", "elements", "points", "edges_in_range", "worst_in_metric", "estimated_error",
            "solution_error", "gradient_error", "seconds")  # fmt: skip
_ALL_MADE, _NO_TIME = "All iterations were made.", "The time limit was reached."
_MOST_ELEMENTS = 5e7  # which take some 50 GB
#: Fraction of an iteration that is done at the end of each step.
_METRIC_END, _IMPROVE_END = 0.1, 0.7


@dataclass(frozen=True, repr=False, eq=False)
class AdaptResult(Result):
    """The result of adapt().

    Attributes
    ----------
    mesh : vtkDataObject
        The last mesh with what the solver adds: the solution on it.
    field : str
        The name of the point array that the mesh was adapted to.
    solution : Array
        Its values, a row per point.
    history : dict[str, Any]
        Per iteration (0 is the input): iteration, target (number of elements; nan with an error), elements, points,
        edges_in_range (fraction of the edges, 0 to 1, with 0.71 to 1.41 times the target length), worst_in_metric
        (largest inverse mean ratio in the metric), estimated_error (estimated norm in L2 of the error of the
        interpolation), solution_error and gradient_error (from solve() with `exact`), seconds. Unknown values are nan.
    elements : int
        The number of elements of the last mesh.
    estimated_error : float
        The estimated norm in L2 of the error of the interpolation, on the last mesh.
    reason : str
        The reason why the iterations ended.
    summary : str
        The result in words.
    """

    _per_element: ClassVar[tuple[str, ...]] = ("solution",)
    mesh: vtkDataObject
    field: str
    solution: Array
    history: dict[str, Any]
    elements: int
    estimated_error: float
    reason: str
    summary: str


@interruptible
def adapt(
    mesh: Mesh,
    solver: Union[Solver, Mapping[str, Any]],
    iterations: int = 5,
    *,
    field: str | None = None,
    elements: float | Sequence[float] | None = None,
    growth: float = 1.0,
    error: float | None = None,
    anisotropic: bool = True,
    norm: float = 2.0,
    recovery: MetricRecovery = "quadratic fit",
    smallest_size: float = 0.0,
    largest_size: float = 0.0,
    largest_anisotropy: float = 1000.0,
    gradation: float = 1.5,
    boundary: ImproveBoundary = "sliding",
    regions: str | None = None,
    changing_cells: str | None = None,
    feature_angle: float = 40.0,
    surface_angle: float = 20.0,
    surface_tolerance: float = 0.005,
    time_limit: float = 0.0,
    threads: int = 0,
    progress: Progress | bool | None = None,
) -> AdaptResult:
    """Adapt a mesh to the solution of a problem: solve, compute a metric of the solution, adapt, and solve again.

    Each iteration calls metric() with the Hessian of the field, improve() with the preset "adapt", and the solver.

    Parameters
    ----------
    mesh : Mesh
        Triangles or tetrahedra. Given as a vtkDataSet, a file name or (points, cells). It is not changed.
    solver : callable or Mapping[str, Any]
        A function that takes a mesh, a vtkDataSet with the attributes points, cells, point_data and cell_data, and
        returns it with a point array, another mesh, a result with a mesh, or the values as an array with a row per
        point. Arrays of the previous mesh are interpolated to the mesh that it gets. Or a dict of arguments of
        solve().
    iterations : int, default 5
        How often the mesh is adapted; the solver is called once more than that.
    field : str, optional
        The point array to adapt to. None: the solution of solve(), or the only point array that the solver adds.
    elements : float or Sequence[float], optional
        The target number of elements, for all iterations or one per iteration. None: the number of elements of the
        mesh.
    growth : float, default 1.0
        The ratio of the target numbers of consecutive iterations, if elements is not a sequence.
    error : float, optional
        Instead of elements: the target of the interpolation error, in the unit of the field; see metric().
    anisotropic : bool, default True
        False: the sizes are the same in all directions.
    norm : float, default 2.0
        The exponent p of the L^p norm of the error, at least 1; 0 is infinity.
    recovery : str, default "quadratic fit"
        "quadratic fit" or "double projection". How the Hessian is found; see metric().
    smallest_size, largest_size : float, default 0.0
        Limits of the sizes; 0 is 1e-6 and 0.1 times the diagonal of the bounding box.
    largest_anisotropy : float, default 1000.0
        The largest ratio of two sizes at a point.
    gradation : float, default 1.5
        The largest growth factor of sizes between neighbors, above 1; 0 is no limit.
    boundary : str, default "sliding"
        "fixed", "sliding" or "on surface"; see improve(). With "fixed" there are no new points on the boundary.
    regions : str, optional
        The name of a cell array with the region of each cell: facets between regions stay, and so does the volume of
        each region.
    changing_cells : str, optional
        The name of a cell array: cells where it is 0 stay as they are.
    feature_angle : float, default 40.0
        See improve().
    surface_angle : float, default 20.0
        See improve().
    surface_tolerance : float, default 0.005
        See improve().
    time_limit : float, default 0.0
        Stop after this many seconds, with the solution on the last mesh; 0 is no limit. A call of the solver is not
        interrupted.
    threads : int, default 0
        Number of threads; 0 is all cores. The result does not depend on it.
    progress : bool or callable, optional
        True: a bar on the terminal, if there is one. Otherwise a function, called ten times a second with the fraction
        done, 0 to 1, and a text; it cancels by returning False, which raises Aborted. Ctrl-C raises KeyboardInterrupt.

    Returns
    -------
    AdaptResult

    Raises
    ------
    Error
        For wrong arguments, for a solver that returns nothing, no mesh, no field or values that are not finite, if
        solve() does not converge, and for meshes that metric() or improve() do not accept.

    Examples
    --------
    >>> result = tautline.adapt("part.vtu", {"source": 1, "fixed": "x < 0.1"}, 4, elements=5000)
    >>> result.table()[-1]["elements"], result.mesh
    >>> result = tautline.adapt("part.vtu", lambda mesh: np.tanh(20 * mesh.points[:, 0]), elements=2000, growth=1.5)
    """
    count = whole("iterations", iterations, 1, 10_000)
    started = as_data_set(mesh)
    size = len(simplices_of(started))
    if not size:
        raise Error("the mesh has neither triangles nor tetrahedra: run Triangulate or Tetrahedralize first")
    limit = within("time_limit", time_limit, 0, np.inf)
    run = _Run(
        solver=_solver(solver, threads),
        field=None if field is None else text("field", field),
        targets=_targets(elements, growth, error, count, size),
        by_error=error is not None,
        metric=_metric_options(anisotropic, norm, recovery, smallest_size, largest_size, largest_anisotropy, gradation),
        improve=_improve_options(boundary, regions, changing_cells, feature_angle, surface_angle, surface_tolerance),
        threads=whole("threads", threads, 0, 1024),
        end=time.monotonic() + limit if limit else np.inf,
    )
    return run.result(started)


# --- arguments ----------------------------------------------------------------------------------------------


def _solver(solver: Any, threads: int) -> Solver:
    """The solver as a function."""
    if isinstance(solver, Mapping):
        if not _vtk.available("_elliptic"):
            raise Error("solve() was not built: give a function as the solver")
        from ._elliptic import solve  # loads PETSc

        options: dict[str, Any] = {"threads": threads, **solver}

        def solved(mesh: Any) -> Any:
            found = solve(mesh, **options)
            if not found.converged:
                raise Error(f"solve() did not converge: {found.reason}")
            return found

        return solved
    if not callable(solver):
        raise Error(f"solver is {solver!r}; a function of a mesh, or a dict of arguments of solve(), is expected")
    called: Solver = solver
    return called


def _targets(elements: Any, growth: Any, error: Any, count: int, size: int) -> list[float]:
    """The target value of the metric in each iteration."""
    positive = float(np.nextafter(0, 1))
    factor = within("growth", growth, positive, np.inf)
    if error is not None:
        if elements is not None or factor != 1.0:
            raise Error("give either error, or elements and growth")
        return [float(within("error", error, positive, np.inf))] * count
    if elements is None or is_number(elements):
        first = size if elements is None else within("elements", number("elements", elements), 1, np.inf)
        return [first * factor**k for k in range(count)]
    if factor != 1.0:
        raise Error("growth is for one number of elements, and elements are several")
    found = [within("elements", number("elements", each), 1, np.inf) for each in sequence("elements", elements)]
    if len(found) != count:
        raise Error(f"elements are {len(found)} numbers; one, or one for each of {count} iterations, is expected")
    return found


def _metric_options(anisotropic: Any, norm: Any, recovery: Any, smallest: Any, largest: Any, anisotropy: Any,
                    gradation: Any) -> dict[str, Any]:  # fmt: skip
    quotient = anisotropy if flag("anisotropic", anisotropic) else 1.0
    return {"norm": norm, "recovery": recovery, "smallest_size": smallest, "largest_size": largest,
            "largest_anisotropy": quotient, "gradation": gradation}  # fmt: skip


def _improve_options(boundary: Any, regions: Any, changing: Any, feature_angle: Any, surface_angle: Any,
                     tolerance: Any) -> dict[str, Any]:  # fmt: skip
    for name, value in (("regions", regions), ("changing_cells", changing)):
        if value is not None and not isinstance(value, str):
            raise Error(f"{name}: give the name of a cell array; the cells change with each iteration")
    return {"boundary": boundary, "regions": regions, "changing_cells": changing, "feature_angle": feature_angle,
            "surface_angle": surface_angle, "surface_tolerance": tolerance}  # fmt: skip


# --- the run ------------------------------------------------------------------------------------------------


@dataclass
class _Run:
    """The iterations, with checked arguments."""

    solver: Solver
    field: str | None
    targets: list[float]
    by_error: bool
    metric: dict[str, Any]
    improve: dict[str, Any]
    threads: int
    end: float

    def result(self, mesh: vtkDataSet) -> AdaptResult:
        """Run all iterations."""
        rows: list[dict[str, Any]] = []
        kept = {mesh.GetCellData().GetArrayName(i) for i in range(mesh.GetCellData().GetNumberOfArrays())}
        count, reason = len(self.targets), _ALL_MADE
        began = time.monotonic()
        with part(0.0, 1 / (count + 1)):
            solved = self.solution(mesh, 0, {"iteration": 0}, rows, began)
        for k, target in enumerate(self.targets, 1):
            if time.monotonic() >= self.end:
                reason = _NO_TIME
                break
            began = time.monotonic()
            made, facts = self.adapted(solved, target, k / (count + 1), 1 / (count + 1), kept)
            with part((k + _IMPROVE_END) / (count + 1), (k + 1) / (count + 1)):
                solved = self.solution(made, k, {"iteration": k, **facts}, rows, began)
        history = {name: np.array([row.get(name, np.nan) for row in rows]) for name in _COLUMNS}
        history |= {name: history[name].astype(int) for name in ("iteration", "elements", "points")}
        name = self.field or ""
        return AdaptResult(
            mesh=viewed(solved),
            field=name,
            solution=point_data_of(solved)[name],
            history=history,
            elements=rows[-1]["elements"],
            estimated_error=rows[-1]["estimated_error"],
            reason=reason,
            summary=_words(rows, name, reason),
        )

    def adapted(
        self, solved: vtkDataSet, target: float, begin: float, length: float, kept: set[str]
    ) -> tuple[vtkDataSet, dict[str, Any]]:
        """The next mesh, and its facts."""
        with part(begin, begin + _METRIC_END * length):
            tensors = metric_of(
                solved,
                "hessian",
                field=self.field,
                target="error" if self.by_error else "number of elements",
                target_value=target,
                array_name=_METRIC,
                threads=self.threads,
                **self.metric,
            )
        if tensors.elements > _MOST_ELEMENTS:
            raise Error(f"the target takes about {tensors.elements:.2g} elements, more than {_MOST_ELEMENTS:.0g}: give "
                        "a larger error, fewer elements, or a larger smallest_size")  # fmt: skip
        left = self.end - time.monotonic()
        with part(begin + _METRIC_END * length, begin + _IMPROVE_END * length):
            made = improve(
                tensors.mesh,
                "adapt",
                edge_length=_METRIC,
                threads=self.threads,
                time_limit=max(left, 1e-3) if np.isfinite(left) else 0.0,
                **self.improve,
            )
        mesh = made.mesh
        mesh.GetPointData().RemoveArray(_METRIC)
        for name in _OF_IMPROVE:
            if name not in kept:
                mesh.GetCellData().RemoveArray(name)
        return mesh, {
            "target": np.nan if self.by_error else target,
            "edges_in_range": made.edges_in_range or np.nan,
            "worst_in_metric": made.worst_in_metric or np.nan,
        }

    def solution(
        self, mesh: vtkDataSet, k: int, facts: dict[str, Any], rows: list[dict[str, Any]], began: float
    ) -> vtkDataSet:
        """Call the solver, check the field, and add a row of the history."""
        given = viewed(_copied(mesh))
        try:
            found = self.solver(given)
            solved = self.with_field(found, mesh, given)
            values = np.asarray(point_data_of(solved)[str(self.field)])
            wrong = np.count_nonzero(~np.isfinite(values.reshape(len(values), -1)).all(axis=1))
            if wrong:
                raise Error(f"{wrong} of {len(values)} values of the field '{self.field}' are NaN or infinite")
        except Error as problem:
            problem.args = (f"iteration {k}: {problem}",)
            raise
        rows.append({
            **facts,
            "elements": len(simplices_of(solved)),
            "points": solved.GetNumberOfPoints(),
            "estimated_error": interpolation_error(solved, values),
            "solution_error": getattr(found, "solution_error", np.nan),
            "gradient_error": getattr(found, "gradient_error", np.nan),
            "seconds": time.monotonic() - began,
        })  # fmt: skip
        return solved

    def with_field(self, found: Any, before: vtkDataSet, given: vtkDataSet) -> vtkDataSet:
        """The mesh with the field that the solver has returned; the field gets its name on the first call."""
        if found is None:
            raise Error("the solver returned nothing; return the mesh with the field, or its values at the points")
        if isinstance(found, np.ndarray):
            self.field = self.field or _SOLUTION
            if len(np.atleast_1d(found)) != given.GetNumberOfPoints() or found.dtype.kind not in "iufb":
                rows = f"a row for each of {given.GetNumberOfPoints()} points"
                raise Error(f"the solver returned an array of {found.dtype}, shape {found.shape}; {rows} is expected")
            point_data_of(given)[self.field] = np.asarray(found, float)
            return given
        try:
            solved = as_data_set(found)
        except Error as problem:
            raise Error(f"the solver returned no mesh: {problem}") from None
        arrays = point_data_of(solved)
        if self.field is None:
            self.field = _only_field(found, arrays, point_data_of(before))
        if self.field not in arrays:
            has = ", ".join(arrays) or "none"
            raise Error(f"the mesh that the solver returned has no point array '{self.field}'; it has {has}")
        return solved


def _only_field(found: Any, arrays: Any, before: Any) -> str:
    """The name of the array with the solution."""
    solution = getattr(found, "solution", None)
    if isinstance(solution, np.ndarray):  # a result of solve()
        same = [name for name in arrays if np.shares_memory(arrays[name], solution)]
        if same:
            return str(same[0])
    new = [name for name in arrays if name not in before and not isinstance(arrays[name], list)]
    if len(new) == 1:
        return str(new[0])
    which = f"has several new point arrays, {', '.join(new)}" if new else "has no new point array"
    raise Error(f"the mesh that the solver returned {which}: give field, the name of the array to adapt to")


def _copied(mesh: vtkDataSet) -> vtkDataSet:
    """A mesh that shares all arrays and can get further ones."""
    made = mesh.NewInstance()
    made.ShallowCopy(mesh)
    return made


def _words(rows: list[dict[str, Any]], field: str, reason: str) -> str:
    first, last = rows[0], rows[-1]
    lines = [f"{reason} {len(rows) - 1} adaptations to {field}: {first['elements']} to {last['elements']} elements."]
    lines.append(f"Estimated error of the interpolation in L2: {first['estimated_error']:.4g} to "
                 f"{last['estimated_error']:.4g}.")  # fmt: skip
    if np.isfinite(last["solution_error"]):
        lines.append("Error of the solution in L2: "
                     f"{first['solution_error']:.4g} to {last['solution_error']:.4g}; of its gradient: "
                     f"{first['gradient_error']:.4g} to {last['gradient_error']:.4g}.")  # fmt: skip
    if np.isfinite(last.get("edges_in_range", np.nan)):
        lines.append(f"Edges with 0.71 to 1.41 times the target length: {last['edges_in_range']:.1%}. Worst inverse "
                     f"mean ratio in the metric: {last['worst_in_metric']:.3g}.")  # fmt: skip
    return "\n".join(lines)


# --- the shell ----------------------------------------------------------------------------------------------

#: Options of the command solve that adapt lacks: its own options, and the ones for time steps.
_NOT_OF_SOLVE = ("help", "help_all", "json", "quiet", "output", "csv", "threads", "time_limit", "in_place",
                 "keep_original", "time_scheme", "time_step", "time_steps", "mass", "density", "initial", "velocity",
                 "series")  # fmt: skip


def add_commands(commands: Any) -> None:
    """Add `adapt` to the subparsers of the command line; it needs the commands of Solve PDE."""
    if not (_vtk.available("_adaptation") and _vtk.available("_elliptic")):
        return
    parser = _commands.add_command(
        commands, "adapt", _run, "adapt a mesh to the solution of a partial differential equation",
        example="triangles.vtu --fixed \"x < 0.01\" --elements 500 --iterations 3 -o adapted.vtu",
        details="Solves, computes a metric of the solution, adapts the mesh, and solves again. Takes the options of "
                "the command solve, which describe the equation.",
    )  # fmt: skip
    _commands.add_mesh(parser)
    _commands.add_output(parser, "mesh with the solution to write")
    parser.add_argument("--csv", metavar="FILE", help="write the history, a row per iteration")
    parser.add_argument("--iterations", type=int, default=5, metavar="N", help="number of adaptations (default: 5)")
    parser.add_argument("--field", metavar="ARRAY", help="point array to adapt to (default: the solution)")
    parser.add_argument("--elements", type=_commands.numbers, metavar="N[,N...]",
                        help="number of elements, or one per iteration (default: as many as the mesh has)")  # fmt: skip
    parser.add_argument("--growth", type=float, default=1.0, metavar="X",
                        help="factor of the target from one iteration to the next (default: 1)")  # fmt: skip
    parser.add_argument("--error", type=float, metavar="X", help="target of the interpolation error, not of elements")
    _commands.add_flag(parser, "anisotropic", "whether sizes differ by direction (default: yes)")
    parser.add_argument("--norm", type=float, default=2.0, metavar="P",
                        help="exponent of the L^p norm of the error; 0 is infinity (default: 2)")  # fmt: skip
    parser.add_argument("--recovery", choices=METRIC_RECOVERIES, default=METRIC_RECOVERIES[0],
                        help=f"how the Hessian is found (default: {METRIC_RECOVERIES[0]})")  # fmt: skip
    for name, value, words in (
        ("smallest-size", 0.0, "smallest size; 0 is 1e-6 of the diagonal"),
        ("largest-size", 0.0, "largest size; 0 is 1/10 of the diagonal"),
        ("largest-anisotropy", 1000.0, "largest ratio of two sizes at a point"),
        ("gradation", 1.5, "largest growth factor of sizes between neighbors; 0 is no limit"),
        ("feature-angle", 40.0, "edges between facets at a larger angle, in degrees, stay"),
        ("surface-angle", 20.0, "largest angle between new facets and the surface, in degrees"),
        ("surface-tolerance", 0.005, "largest distance of new facets from the surface, over the diagonal"),
    ):
        parser.add_argument(f"--{name}", type=float, default=value, metavar="X", help=f"{words} (default: {value:g})")
    parser.add_argument("--boundary", choices=IMPROVE_BOUNDARIES, default="sliding", help="boundary (default: sliding)")
    parser.add_argument("--regions", metavar="ARRAY", help="cell array with the region of each cell")
    parser.add_argument("--changing-cells", metavar="ARRAY", help="cell array; cells where it is 0 stay as they are")
    _commands.add_time_limit(parser)
    parser.set_defaults(of_solve=_add_solve_options(parser, commands.choices["solve"]))


def _add_solve_options(parser: argparse.ArgumentParser, solve: argparse.ArgumentParser) -> list[str]:
    """Add the options of the command solve; returns their names."""
    group = parser.add_argument_group("options of the command solve")
    chosen = [action for action in solve._actions if action.option_strings and action.dest not in _NOT_OF_SOLVE]
    for action in [copy(one) for one in chosen]:  # because an option belongs to one parser
        action.option_strings = [name for name in action.option_strings if name not in parser._option_string_actions]
        group._add_action(action)
    return [action.dest for action in chosen]


def _run(arguments: argparse.Namespace) -> None:
    names = ("iterations", "field", "growth", "error", "anisotropic", "norm", "recovery", "smallest_size",
             "largest_size", "largest_anisotropy", "gradation", "boundary", "regions", "changing_cells",
             "feature_angle", "surface_angle", "surface_tolerance", "time_limit", "threads")  # fmt: skip
    elements = arguments.elements[0] if arguments.elements and len(arguments.elements) == 1 else arguments.elements
    options = _commands.given(arguments, names) | {"elements": elements}
    result = adapt(arguments.mesh, _commands.given(arguments, arguments.of_solve), **options)
    shown = ("iteration", "elements", "points", "edges_in_range", "worst_in_metric", "estimated_error")
    rows = table_rows(result.history)
    lines = [[row[name].item() for name in shown] for row in rows]
    _commands.finish(arguments, result, f"{align(lines, shown)}\n\n{result.summary}", rows)
